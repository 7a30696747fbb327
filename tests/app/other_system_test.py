#!/usr/bin/env python3
"""A program for another system, in an emulator: the bytes of its files are those of the program for this system."""

import os
import re
import subprocess
import unittest
from pathlib import Path

from program import ON_WINDOWS, ProgramTest, main

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

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_names_in_any_script_and_separators_of_windows(self):
        self.path("Gehäuse").mkdir()
        self.succeed("make", "box", "-o", "Gehäuse\\Zahnrad-ß.stl")
        self.succeed("slice", "Gehäuse/Zahnrad-ß.stl", "-o", "歯車.cli", "--layer-height", "1")
        self.assertEqual(self.listing(), ["Gehäuse", "Gehäuse/Zahnrad-ß.stl", "歯車.cli"])
        windows = "Z:" + str(self.path("шестерня.svg")).replace("/", "\\")
        self.succeed("convert", "歯車.cli", windows)
        self.assertTrue(self.path("шестерня.svg").is_file())
        self.fail_with(3, "歯車2.cli: there is no such file", "info", "歯車2.cli")

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
