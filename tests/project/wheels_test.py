"""The wheels that `make wheels` makes install without packages of the system, and pass the tests of the Python package.

usage: wheels_test.py BUILD FOLDER [unittest arguments]: the folder of a build, which has the program, and that of the wheels

The interpreter that runs this is the one that the wheels are for. It must have NumPy and pytest, which the environments of
the tests borrow. The ARM64 wheel runs in an emulator, with Debian's packages for ARM64, unpacked into BUILD/wheels-arm64.
"""

import base64
import csv
import email
import hashlib
import importlib.util
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv[1]).resolve()
WHEELS = Path(sys.argv[2]).resolve()
PROGRAM = BUILD / "lamella"
VERSION = f"{sys.version_info[0]}{sys.version_info[1]}"

OLDEST_GLIBC = (2, 28)
# The libraries that wheels for glibc may need of the system (PEP 600).
OF_THE_SYSTEM = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2",
                 "ld-linux-aarch64.so.1"}
# What pytest consists of; a clean environment borrows it, and NumPy.
BORROWED = ["numpy", "pytest", "_pytest", "pluggy", "iniconfig", "packaging", "attr", "py", "pygments", "tomli",
            "exceptiongroup", "typing_extensions"]
# Tests that start neither an interpreter nor need packages beyond NumPy.
IN_EMULATOR = ["layers", "slicing", "scanning", "arguments"]
# The interpreter for ARM64, NumPy and what they load.
OF_ARM64 = """libc6 libgcc-s1 libstdc++6 python3.11-minimal libpython3.11-minimal libpython3.11-stdlib libexpat1 zlib1g libffi8
    libbz2-1.0 liblzma5 libssl3 libuuid1 python3-numpy libblas3 liblapack3 libgfortran5""".split()


def run(*command, **options):
    result = subprocess.run([str(part) for part in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            check=False, **options)
    if result.returncode != 0:
        raise AssertionError(f"{command} ended with {result.returncode}\n{result.stdout[-6000:]}")
    return result.stdout


def symbols_of(module):
    return run("readelf", "--dyn-syms", "--wide", module)


def borrow(site):
    """Links the packages that the tests need into a folder of packages."""
    for name in BORROWED:
        found = importlib.util.find_spec(name)
        if found is not None and found.origin:
            path = Path(found.origin)
            path = path.parent if path.name == "__init__.py" else path
            if not (site / path.name).exists():
                (site / path.name).symlink_to(path)


class Wheels(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def wheel(self, processor):
        found = list(WHEELS.glob(f"lamella-*-cp{VERSION}-cp{VERSION}-manylinux_2_28_{processor}.whl"))
        if not found:
            self.skipTest(f"there is no wheel for {processor} in {WHEELS}")
        self.assertEqual(len(found), 1)
        return found[0]

    def each(self):
        """The processors that there are wheels for, and the wheels."""
        processors = [processor for processor in ("x86_64", "aarch64") if list(WHEELS.glob(f"*_{processor}.whl"))]
        self.assertTrue(processors, f"no wheels in {WHEELS}")
        return [(processor, self.wheel(processor)) for processor in processors]

    def module(self, processor):
        with zipfile.ZipFile(self.wheel(processor)) as wheel:
            return Path(wheel.extract(f"lamella/_lamella.cpython-{VERSION}-{processor}-linux-gnu.so", self.folder))

    def test_a_wheel_needs_only_the_c_library_in_the_version_of_its_tag(self):
        for processor, _ in self.each():
            module = self.module(processor)
            listing = run("readelf", "--dynamic", "--version-info", "--wide", module)
            needed = set(re.findall(r"\(NEEDED\).*\[(.+)\]", listing))
            self.assertLessEqual(needed, OF_THE_SYSTEM)
            self.assertFalse("RUNPATH" in listing, processor)
            self.assertEqual(re.findall(r"UND (?!Py|_Py|__)(\w+)$", symbols_of(module), re.MULTILINE), [])
            versions = {tuple(map(int, version.split("."))) for version in re.findall(r"Name: GLIBC_([0-9.]+)", listing)}
            self.assertTrue(versions)
            self.assertLessEqual(max(versions), OLDEST_GLIBC)
            self.assertEqual(re.findall(r"Name: (?!GLIBC_)(\S+)", listing), [])

    def test_a_module_shows_other_modules_nothing_of_its_libraries(self):
        for processor, _ in self.each():
            symbols = symbols_of(self.module(processor))
            shown = re.findall(r"(?:GLOBAL|WEAK|UNIQUE) +DEFAULT +[0-9]+ (\S+)", symbols)
            self.assertEqual(shown, ["PyInit__lamella"])

    def test_a_wheel_has_the_package_its_licences_and_a_record_that_fits(self):
        for processor, path in self.each():
            with zipfile.ZipFile(path) as wheel:
                content = {name: wheel.read(name) for name in wheel.namelist()}
            info = next(name.split("/")[0] for name in content if ".dist-info/" in name)
            record = {name: (digest, size) for name, digest, size in
                      csv.reader(io.StringIO(content[f"{info}/RECORD"].decode()))}
            self.assertEqual(set(record), set(content))
            for name, data in content.items():
                if name != f"{info}/RECORD":
                    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
                    self.assertEqual(record[name], (f"sha256={digest}", str(len(data))), name)
            modules = {f"lamella/{file.name}" for file in (ROOT / "python/lamella").iterdir() if file.is_file()}
            modules.add(f"lamella/_lamella.cpython-{VERSION}-{processor}-linux-gnu.so")
            self.assertEqual({name for name in content if not name.startswith(info)}, modules)
            header = email.message_from_bytes(content[f"{info}/METADATA"])
            self.assertEqual((header["Name"], header["Requires-Dist"]), ("lamella", "numpy"))
            tags = email.message_from_bytes(content[f"{info}/WHEEL"])
            self.assertEqual((tags["Root-Is-Purelib"], tags["Tag"]),
                             ("false", f"cp{VERSION}-cp{VERSION}-manylinux_2_28_{processor}"))
            notices = {name: content[f"{info}/{name}"].decode() for name in ("LICENSE", "LICENSES-third-party.txt")}
            for notice in ("pybind11 (the Python package)", "Expat (", "libdeflate (", "zlib (", "{fmt} (", "xxHash",
                           "fast_float", "libc++", "Zig's run-time library"):
                self.assertIn(notice, notices["LICENSES-third-party.txt"])

    def test_the_wheel_installs_into_a_clean_environment_and_passes_the_tests_of_the_package(self):
        if os.uname().machine != "x86_64":
            self.skipTest("this interpreter is not for x86-64")
        environment = self.folder / "environment"
        run(sys.executable, "-m", "venv", "--without-pip", environment)
        python = environment / "bin/python"
        site = Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('platlib'))").strip())
        run(sys.executable, "-m", "pip", "--python", python, "install", "--no-index", "--no-deps", self.wheel("x86_64"))
        borrow(site)
        self.assertIn(str(site), run(python, "-c", "import lamella; print(lamella.__file__)", cwd=self.folder))
        tests = [ROOT / f"tests/python/{topic}_test.py"
                 for topic in (*IN_EMULATOR, "errors", "files", "package", "running", "samples", "sections")]
        # Python before 3.14 unwinds daemon threads when it ends, which modules by LLVM's libraries do not survive.
        run(python, "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "not daemon_thread", *tests, cwd=self.folder,
            env=dict(os.environ, LAMELLA_PYTHON_PACKAGE=str(site), LAMELLA_PROGRAM=str(PROGRAM)))

    def test_the_wheel_for_arm64_passes_tests_of_the_package_in_an_emulator(self):
        wheel = self.wheel("aarch64")
        emulator = shutil.which("qemu-aarch64")
        if emulator is None or VERSION != "311":
            self.skipTest("Debian's Python for ARM64 or the emulator is missing")
        system = BUILD / "wheels-arm64"
        if not (system / "complete").exists():
            shutil.rmtree(system, ignore_errors=True)
            packages = system / "packages"
            packages.mkdir(parents=True)
            run("apt-get", "--quiet=2", "download", *(f"{name}:arm64" for name in OF_ARM64), cwd=packages)
            for package in packages.iterdir():
                run("dpkg-deb", "--extract", package, system)
            shutil.rmtree(packages)
            # Debian's alternatives would make these links.
            library = system / "usr/lib/aarch64-linux-gnu"
            for name in ("blas", "lapack"):
                (library / f"lib{name}.so.3").symlink_to(f"{name}/lib{name}.so.3")
            (system / "complete").touch()
        site = self.folder / "site"
        run(sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--target", site, "--python-version", VERSION,
            "--platform", "manylinux_2_28_aarch64", "--only-binary=:all:", wheel)
        borrow(site)
        (site / "numpy").unlink()  # Debian's for ARM64 is in the folder of the interpreter
        tests = [ROOT / f"tests/python/{topic}_test.py" for topic in IN_EMULATOR]
        # Further interpreters do not start in the emulator, and it does not keep limits of memory.
        chosen = "not between_processes and not memory_that_runs_out"
        run(emulator, "-L", system, system / "usr/bin/python3.11", "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider",
            "-k", chosen, *tests, cwd=self.folder, env=dict(os.environ, PYTHONPATH=str(site), LAMELLA_PYTHON_PACKAGE=str(site),
                                      LAMELLA_PROGRAM=str(PROGRAM)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
