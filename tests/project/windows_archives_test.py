"""The archives that `make windows` makes: one folder each, with what somebody needs who has only this archive.

usage: windows_archives_test.py [BUILD] [unittest arguments]; BUILD is the folder with the archives. Without it, only the icon
is tested.
"""

import posixpath
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv[1]) if len(sys.argv) > 1 and Path(sys.argv[1]).is_dir() else None
VERSION = re.search(r'LAMELLA_VERSION "(.*)"', (ROOT / "include/lamella/core/version.hpp").read_text(encoding="utf-8"))[1]


def icon():
    """What the script makes of the drawing."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lamella.ico"
        subprocess.run([sys.executable, "-B", ROOT / "tools/windows/make_icon.py", ROOT / "app/lamella.svg", path], check=True)
        return path.read_bytes()


def images_of(data):
    """The size of each image of an icon, and its bytes."""
    reserved, kind, count = struct.unpack_from("<3H", data)
    assert (reserved, kind) == (0, 1)
    for i in range(count):
        width, height, _, _, planes, bits, size, offset = struct.unpack_from("<4B2H2I", data, 6 + 16 * i)
        assert (width, planes, bits) == (height, 1, 32)
        yield width or 256, data[offset:offset + size]


class Icon(unittest.TestCase):
    def test_it_has_a_sound_image_of_each_size(self):
        sizes = []
        for size, image in images_of(icon()):
            self.assertEqual(image[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(struct.unpack_from(">2I", image, 16), (size, size))
            self.assertEqual(image[-8:-4], b"IEND")
            sizes.append(size)
        self.assertEqual(sizes, [16, 24, 32, 48, 64, 256])


class Archives(unittest.TestCase):
    def contents(self, name):
        if BUILD is None:
            self.skipTest("no folder with archives was given; `make windows` makes them")
        path = BUILD / f"{name}-{VERSION}-windows-x86_64.zip"
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            self.assertEqual({one.split("/")[0] for one in names}, {f"{name}-{VERSION}"})
            return {one.partition("/")[2]: archive.read(one) for one in names}

    def test_the_program_comes_with_what_its_users_read_and_nothing_else(self):
        files = self.contents("lamella")
        self.assertLessEqual({"lamella.exe", "lamella.ps1", "README.txt", "LICENSE.txt", "LICENSES-third-party.txt",
                              "licences/expat.txt", "docs/windows.html", "docs/program.html", "docs/tutorial.html"}, set(files))
        self.assertEqual([name for name in files if name.endswith((".a", ".hpp", ".h", ".md", ".cmake", ".bash"))], [])
        for name in ("README.txt", "LICENSE.txt", "lamella.ps1"):
            self.assertEqual(files[name].count(b"\n"), files[name].count(b"\r\n"), name)
        for _, image in images_of(icon()):
            self.assertIn(image, files["lamella.exe"])

    def test_links_of_the_pages_lead_to_pages_and_images_of_the_archive(self):
        files = self.contents("lamella")
        pages = {name: data.decode() for name, data in files.items() if name.startswith("docs/") and name.endswith(".html")}
        for name, page in pages.items():
            for target in re.findall(r'(?:href|src)="([^"]+)"', page):
                if "://" in target:
                    continue
                path, _, heading = target.partition("#")
                found = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
                self.assertIn(found, files, f"{name}: {target}")
                if heading:
                    self.assertIn(f'id="{heading}"', pages[found], f"{name}: {target}")

    def test_the_commands_of_the_readme_work_one_after_the_other(self):
        files = self.contents("lamella")
        commands = re.findall(r"^ {4}lamella (.*?)\r$", files["README.txt"].decode(), re.MULTILINE)
        self.assertGreater(len(commands), 12)
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "lamella.exe").write_bytes(files["lamella.exe"])
            for command in commands:
                done = subprocess.run([ROOT / "tools/wine.sh", "./lamella.exe", *command.split()], cwd=folder, capture_output=True,
                                      timeout=240, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, b""), command)
            made = {path.name for path in Path(folder).iterdir()}
        self.assertLessEqual({"rook.html", "rook.cli", "rook.svg", "rook.3mf", "rook.ilt", "images", "plate.cli", "layers"}, made)

    def test_the_sdk_has_libraries_headers_and_cmake_files(self):
        files = self.contents("lamella-sdk")
        for name in ("lib/liblamella.a", "lib/liblamella-io.a", "bin/liblamella-c.dll", "lib/libexpat.a", "lib/cmake/lamella/lamella-config.cmake",
                     "include/lamella/core/version.hpp", "share/licences/expat.txt", "share/doc/lamella/LICENSE"):
            self.assertIn(name, files)
        self.assertNotIn("bin/lamella.exe", files)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[1 if BUILD is None else 2:])
