#!/usr/bin/env python3
"""A program for another system, in an emulator: the bytes of its files are those of the program for this system."""

import json
import os
import re
import subprocess
import unittest
from pathlib import Path

from program import ON_WINDOWS, ProgramTest, main, windows_path, windows_start

NATIVE = os.environ.get("LAMELLA_NATIVE_PROGRAM", "")


@unittest.skipUnless(Path(NATIVE).is_file(), "there is no program for this system to compare with")
class OtherSystem(ProgramTest):
    def bytes_below(self, folder):
        return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}

    def expect_same(self, *arguments):
        """Both programs are run in folders of their own, with the same inputs."""
        for name in ["here", "there"]:
            self.path(name).mkdir(exist_ok=True)
        here = subprocess.run([NATIVE, *arguments], cwd=self.path("here"), capture_output=True, timeout=240)
        there = self.run_program(*arguments, cwd=self.path("there"))
        self.assertEqual((there.code, there.err), (here.returncode, here.stderr.decode()), arguments)
        self.assertEqual(self.bytes_below(self.path("there")), self.bytes_below(self.path("here")), arguments)

    def formats(self):
        text = " ".join(self.succeed("slice", "--help").text.split())
        return re.search(r"--format NAME .*?: (.*?)[;\[.]", text)[1].replace(" or ", ", ").split(", ")

    def test_the_bytes_of_every_slice_format_are_the_same(self):
        self.expect_same("make", "rook", "-o", "rook.stl")
        listed = subprocess.run([NATIVE, "slice", "--help"], capture_output=True, text=True).stdout
        formats = [name for name in ["cli", "cli-ascii", "slc", "svg", "svg-layers", "3mf", "json", "npz", "dxf", "geojson", "html",
                                     "png", "png-zip", "sl1", "ilt", "ovf"] if re.search(rf"\b{name}\b", listed)]
        self.assertGreater(len(formats), 10)
        for name in formats:
            scanned = ["--scan"] if name in ["ilt", "ovf"] else []
            with self.subTest(name):
                self.expect_same("slice", "rook.stl", "-o", f"out.{name}", "--format", name, "--layer-height", "0.7", *scanned)

    def test_meshes_repairs_and_scan_vectors_are_the_same(self):
        for body in ["lattice", "sheet", "torus", "head"]:
            with self.subTest(body):
                self.expect_same("make", body, "-o", f"{body}.stl")
                self.expect_same("slice", f"{body}.stl", "-o", f"{body}.cli", "--layer-height", "1")
        self.expect_same("scan", "torus.cli", "-o", "scanned.cli", "--pattern", "chessboard")
        self.expect_same("slice", "lattice.stl", "-o", "open.json", "--fill", "--offset", "-0.1", "--layer-height", "1")

    def test_words_of_the_command_line_arrive_unchanged(self):
        for word in ["", "a b", 'a"b', '"', '""', "a\\", "a b\\", 'a\\"b', 'a b\\\\"', "a\\\\b", "\\\\a\\b c\\", "\ta", "'", "ä 歯", "a*?"]:
            with self.subTest(word):
                self.expect_same("make", "box", "--size", word)
                self.expect_same("make", word, word)

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_names_in_any_script_and_separators_of_windows(self):
        self.path("Gehäuse").mkdir()
        self.succeed("make", "box", "-o", "Gehäuse\\Zahnrad-ß.stl")
        self.succeed("slice", "Gehäuse/Zahnrad-ß.stl", "-o", "歯車.cli", "--layer-height", "1")
        self.assertEqual(self.listing(), ["Gehäuse", "Gehäuse/Zahnrad-ß.stl", "歯車.cli"])
        self.succeed("convert", "歯車.cli", windows_path(self.path("шестерня.svg")))
        self.assertTrue(self.path("шестерня.svg").is_file())
        self.fail_with(3, "歯車2.cli: there is no such file", "info", "歯車2.cli")

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_long_paths_and_those_with_prefixes(self):
        deep = "/".join(10 * [60 * "d"])
        self.path(deep).mkdir(parents=True)
        self.box()
        below = windows_path(self.path(deep))
        self.assertGreater(len(below), 600)
        for output in [f"{deep}/a.cli", rf"{below}\b.cli", rf"\\?\{below}\c.cli", rf"\\?\unix{self.path('d.cli')}"]:
            with self.subTest(output):
                self.succeed("slice", "box.stl", "-o", output)
                self.succeed("info", output)
        self.succeed("slice", "box.stl", "-o", f"{deep}/images", "--format", "png", "--layer-height", "5")
        self.assertEqual(sorted(path.name for path in self.path(deep).iterdir()), ["a.cli", "b.cli", "c.cli", "images"])
        self.fail_with(3, r"\\\\nowhere\\share\\a\.stl: there is no such file", "info", r"\\nowhere\share\a.stl")

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_files_that_are_read_only_or_in_use_are_named(self):
        self.box()
        self.succeed("slice", "box.stl", "-o", "box.cli")
        before = self.bytes_of("box.cli")
        used = windows_start(f"open={windows_path(self.path('box.cli'))}")
        done = subprocess.run([*used, "slice", "box.stl", "-o", "box.cli"], cwd=self.folder, capture_output=True, timeout=240)
        self.assertEqual(done.returncode, 6)
        self.assertIn(b"cannot write 'box.cli': another program has the file open; close it there", done.stderr)
        done = subprocess.run([*used, "info", "box.cli"], cwd=self.folder, capture_output=True, timeout=240)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.path("box.cli").chmod(0o444)
        self.fail_with(6, "'box.cli'.*write-protected", "slice", "box.stl", "-o", "box.cli")
        self.assertEqual(self.bytes_of("box.cli"), before)

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_a_pattern_stands_for_the_files_that_it_matches(self):
        self.path("teile").mkdir()
        for name in ["teile/B.STL", "teile/a.stl", "teile/ä b.stl", "teile/.hidden.stl", "teile/a.stlx", "teile/c.stl.txt"]:
            self.box("box.stl")
            self.path("box.stl").rename(self.path(name))
        self.path("teile/folder.stl").mkdir()

        def described(*words):
            return [json.loads(line)["path"] for line in self.succeed("info", "--json", *words).text.splitlines()]

        self.assertEqual(described("teile/*.stl"), ["teile/a.stl", "teile/B.STL", "teile/ä b.stl"])
        self.assertEqual(described(r"teile\?.stl"), [r"teile\a.stl", r"teile\B.STL"])
        self.assertEqual(described("teile/? b.s*", "teile/*.stlx"), ["teile/ä b.stl", "teile/a.stlx"])
        self.assertEqual(described(windows_path(self.path("teile")) + r"\**l"),
                         [windows_path(self.path(f"teile/{name}")) for name in ["a.stl", "B.STL", "ä b.stl"]])
        parts = self.succeed("slice", "teile/*.stl", "--stats", "-", "--layer-height", "5").json()["parts"]
        self.assertEqual(len(parts), 3)
        for words in [["info", "*.stl"], ["slice", "nowhere/*.stl", "-o", "a.cli"]]:
            self.fail_with(2, r"no file has a name of this form; only the last part of a path may have \* and \?", *words)
        self.fail_with(3, r"\*/a.stl: there is no such file", "info", "*/a.stl")
        self.fail_with(2, "takes one argument", "view", "teile/*.stl")

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_names_of_devices_are_refused_as_outputs(self):
        self.box()
        for name in ["aux.cli", "NUL.cli", "con.svg.gz", "COM1.cli", "lpt9.x.json", "com¹.cli", r"out\prn.cli", "Aux .cli"]:
            with self.subTest(name):
                self.fail_with(6, "stand for a device of this system; choose another name", "slice", "box.stl", "-o", name,
                               "--layer-height", "5")
        self.fail_with(6, "stand for a device", "slice", "box.stl", "-o", "aux", "--format", "png", "--layer-height", "5")
        self.fail_with(6, "stand for a device", "make", "box", "-o", "aux.stl")
        for name in ["auxiliary.cli", "com.cli", "com10.cli", "my.aux.cli"]:
            self.succeed("slice", "box.stl", "-o", name, "--layer-height", "5")
            self.assertTrue(self.path(name).is_file())
        self.succeed("slice", "box.stl", "-o", "NUL", "--format", "cli", "--layer-height", "5")

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_a_network_folder_that_cannot_be_reached_is_named(self):
        self.box()
        self.fail_with(6, r"cannot write '\\\\nohost\\share\\x.cli': the network folder '\\\\nohost\\share' cannot be reached; "
                          "check its name and the network", "slice", "box.stl", "-o", r"\\nohost\share\x.cli")
        self.fail_with(6, "the folder 'nowhere' does not exist; create it first", "slice", "box.stl", "-o", "nowhere/x.cli")

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_a_command_with_a_file_can_be_copied(self):
        self.path("Jürgen Müller").mkdir()
        self.box("Jürgen Müller/Teil 1.stl")
        name = windows_path(self.path("Jürgen Müller/Teil 1.stl"))
        result = self.fail_with(2, "is a file; say what to do with it", name)
        self.assertIn(f'such as: lamella view "{name}"', result.err)

    def test_lists_with_crlf(self):
        self.box("a.stl")
        self.box("b.stl")
        self.write("list", b"a.stl\r\n# not this one\r\nb.stl\r\n")
        result = self.succeed("slice", "--batch", "list", "-o", "out", "--format", "cli")
        self.assertEqual(len(result.out.splitlines()), 2)
        self.assertEqual(sorted(path.name for path in self.path("out").iterdir()), ["a.cli", "b.cli"])

    def test_standard_streams_carry_bytes_unchanged(self):
        self.box("box.stl")
        sliced = self.succeed("slice", "-", "-o", "-", "--format", "cli", "--layer-height", "0.01",
                              stdin=self.bytes_of("box.stl")).out
        self.succeed("slice", "box.stl", "-o", "box.cli", "--layer-height", "0.01")
        self.assertEqual(sliced, self.bytes_of("box.cli"))


if __name__ == "__main__":
    main()
