"""pip installs the package from the source tree, without network."""

import os
import shutil
import subprocess
import sys

from conftest import ROOT


def test_it_installs_and_runs(rook, tmp_path):
    # By rooms, without optimisation, and by the compiler that is quickest then: installing is tried, and need not wait
    # for fast code.
    environment = dict(os.environ, CMAKE_ARGS="-D LAMELLA_WERROR=ON -D CMAKE_UNITY_BUILD=ON -D CMAKE_CXX_FLAGS_RELEASE=-O0")
    if shutil.which("clang++"):
        environment["CXX"] = "clang++"
    subprocess.run([sys.executable, "-m", "pip", "install", str(ROOT), "--no-build-isolation", "--no-deps", "--no-index",
                    "--target", str(tmp_path / "site")], check=True, timeout=1700, env=environment)
    code = "import sys, lamella; print(lamella.__file__); print(len(lamella.slice(sys.argv[1])))"
    run = subprocess.run([sys.executable, "-B", "-c", code, str(rook)], capture_output=True, text=True, check=True,
                         cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path / "site")})
    path, layers = run.stdout.split()
    assert path == str(tmp_path / "site" / "lamella" / "__init__.py") and layers == "531"
    installed = {path.name for path in (tmp_path / "site" / "lamella").iterdir()}
    assert {path.name for path in (ROOT / "python" / "lamella").iterdir() if path.is_file()} <= installed
    # Nothing is left in the tree but what is ignored there.
    assert not (ROOT / "lamella.egg-info").exists()
