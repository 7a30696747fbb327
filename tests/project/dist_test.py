"""What `make dist` makes can be built, installed and run: a source archive, a Debian package, a wheel.

usage: dist_test.py BUILD [unittest arguments], the folder of a build
"""

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv[1]).resolve()
PAGE = "viewer/viewer_page.cpp"
HTML = "viewer/viewer.html"

# As BUILD is, where it was built from nothing: a compiler cache has the objects of these sources.
ALIKE = ["-D", "CMAKE_BUILD_TYPE=Release", "-D", "CMAKE_UNITY_BUILD=ON", "-D", "LAMELLA_WERROR=ON"]


def run(*command, **options):
    result = subprocess.run([str(part) for part in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            check=False, **options)
    if result.returncode != 0:
        raise AssertionError(f"{command} ended with {result.returncode}\n{result.stdout}")
    return result.stdout


class Dist(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        page = BUILD / PAGE
        if not page.exists() or "constexpr char page" not in page.read_text(encoding="utf-8"):
            raise unittest.SkipTest("the viewer could not be built, and is a part of the archive")
        if not (ROOT / ".git").exists():
            raise unittest.SkipTest("the archive is made in a checkout by git, and this is none")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.dist = Path(folder.name) / "dist"
        run(ROOT / "tools/dist.sh", BUILD, cls.dist, env=dict(os.environ, CMAKE_ARGS=" ".join(ALIKE)))

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def made(self, pattern):
        found = list(self.dist.glob(pattern))
        self.assertEqual(len(found), 1, f"{pattern} among {os.listdir(self.dist)}")
        return found[0]

    def slice_and_view(self, program):
        run(program, "make", "box", "-o", "box.stl", cwd=self.folder)
        run(program, "slice", "box.stl", "-o", "box.cli", cwd=self.folder)
        run(program, "verify", "box.cli", "--mesh", "box.stl", cwd=self.folder)
        run(program, "view", "box.cli", cwd=self.folder)
        page = (self.folder / "box.html").read_text(encoding="utf-8")
        self.assertIn('<script type="application/json" id="table">', page)
        self.assertRegex(page, "three.js authors\n\nPermission is hereby granted")

    def test_the_archive_has_the_tracked_files_and_the_page_and_no_trace_of_its_making(self):
        archive = self.made("lamella-*.tar.gz")
        name = archive.name.removesuffix(".tar.gz")
        with tarfile.open(archive) as tar:
            members = tar.getmembers()
        files = [member.name for member in members if not member.isdir()]
        tracked = run("git", "-c", f"safe.directory={ROOT}", "ls-files", "-z", cwd=ROOT).split("\0")[:-1]
        self.assertEqual(sorted(files), sorted(f"{name}/{file}" for file in [*tracked, PAGE, HTML]))
        self.assertEqual({(member.uid, member.gid, member.uname, member.gname) for member in members}, {(0, 0, "", "")})
        self.assertEqual({oct(member.mode) for member in members}, {"0o644", "0o755"})
        self.assertEqual(len({member.mtime for member in members}), 1)
        paths = [member.name.split("/") for member in members]
        self.assertEqual(paths, sorted(paths))
        self.assertEqual(archive.read_bytes()[4:8], bytes(4), "gzip's own time")

    def test_the_archive_builds_without_node_and_npm_and_has_the_viewer(self):
        shutil.unpack_archive(self.made("lamella-*.tar.gz"), self.folder)
        source = next(self.folder.glob("lamella-*"))
        build = source / "build"
        environment = dict(os.environ, CCACHE_BASEDIR=str(source))
        # CMake looks beyond PATH, too: what it would find in their place can only fail.
        run("cmake", "-S", source, "-B", build, "-G", "Ninja", *ALIKE, "-D", "LAMELLA_NODE=/bin/false", "-D",
            "LAMELLA_NPM=/bin/false", "-D", "LAMELLA_PYTHON=OFF", "-D", "LAMELLA_TESTS=OFF", "-D", "LAMELLA_MPI=OFF",
            env=environment)
        run("cmake", "--build", build, "--target", "lamella_app", env=environment)
        self.slice_and_view(build / "lamella")

    def test_the_debian_package_installs_into_a_clean_root_and_runs(self):
        if os.geteuid() != 0:
            self.skipTest("dpkg installs for root only")
        package = self.made("lamella_*.deb")
        root = self.folder / "root"
        database = root / "var/lib/dpkg"
        for name in ("info", "updates"):
            (database / name).mkdir(parents=True)
        # What the package depends on is there as it is on this machine, where packages for other processors may be,
        # too, and nothing else.
        architecture = run("dpkg", "--print-architecture").strip()
        depends = run("dpkg-deb", "--field", package, "Depends").strip()
        needed = [dependency.split()[0] for dependency in depends.split(", ")]
        self.assertEqual(needed, ["libc6"])  # all else is in the program
        there = [run("dpkg-query", "--status", f"{name}:{architecture}") for name in needed]
        (database / "status").write_text("\n".join(there), encoding="utf-8")
        environment = dict(os.environ, PATH=f"{os.environ['PATH']}:/usr/sbin:/sbin")
        run("dpkg", f"--root={root}", "--install", package, env=environment)
        installed = {str(path.relative_to(root)) for path in (root / "usr").rglob("*") if not path.is_dir()}
        self.assertEqual(installed, {
            "usr/bin/lamella",
            "usr/share/bash-completion/completions/lamella",
            "usr/share/doc/lamella/copyright",
            "usr/share/fish/vendor_completions.d/lamella.fish",
            "usr/share/man/man1/lamella.1",
            "usr/share/zsh/vendor-completions/_lamella",
        })
        for notice in ["The Lamella authors", "Niels Lohmann", "Yann Collet", "three.js authors", "Expat maintainers",
                       "Eric Biggers", "Victor Zverovich"]:
            self.assertIn(notice, (root / "usr/share/doc/lamella/copyright").read_text(encoding="utf-8"))
        version = run("dpkg-query", f"--admindir={database}", "--show", "--showformat=${Version}", "lamella")
        self.assertEqual(run(root / "usr/bin/lamella", "--version").split()[1], version)
        self.slice_and_view(root / "usr/bin/lamella")

    def test_the_wheel_installs_into_an_environment_and_slices(self):
        environment = self.folder / "environment"
        python = environment / "bin/python"
        run("/usr/bin/python3", "-m", "venv", "--system-site-packages", "--without-pip", environment)
        run(python, "-m", "pip", "install", "--no-index", self.made("lamella-*.whl"))
        run(BUILD / "lamella", "make", "rook", "-o", "rook.stl", cwd=self.folder)
        code = "import lamella; print(lamella.__file__); print(len(lamella.slice('rook.stl')))"
        path, layers = run(python, "-B", "-c", code, cwd=self.folder).split()
        self.assertTrue(Path(path).is_relative_to(environment), path)
        self.assertEqual(layers, "531")
        notices = {path.name for path in Path(path).parent.parent.glob("lamella-*.dist-info/**/LICENSE*")}
        self.assertEqual(notices, {"LICENSE", "LICENSES-third-party.txt"})
        modules = {path.name for path in (ROOT / "python/lamella").iterdir() if path.is_file()}
        self.assertLessEqual(modules, {path.name for path in Path(path).parent.iterdir()})

    def test_building_the_wheel_leaves_nothing_beside_the_sources(self):
        shutil.unpack_archive(self.made("lamella-*.tar.gz"), self.folder)
        source = next(self.folder.glob("lamella-*"))
        before = {path.name for path in source.iterdir()}
        run("/usr/bin/python3", "-B", "setup.py", "--quiet", "egg_info", cwd=source)
        made = {path.name for path in source.iterdir()} - before
        self.assertEqual(len(made), 1, made)
        self.assertRegex(made.pop(), "^build-")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
