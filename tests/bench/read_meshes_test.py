"""What the comparison of readers of meshes can be asked for."""

import tempfile
import unittest
from pathlib import Path

from bench.read_meshes.__main__ import parse
from bench.read_meshes.readers import readers


class Options(unittest.TestCase):
    def test_a_body_has_options_of_its_own(self):
        options = parse(["--formats", "obj", "ply", "--rounds", "9", "--body", "sphere", "--detail", "400"])
        self.assertEqual(options.body, ["sphere", "--detail", "400"])
        self.assertEqual(options.formats, ["obj", "ply"])
        self.assertEqual(options.rounds, 9)

    def test_a_sheet_is_the_body_unless_another_is_named(self):
        self.assertEqual(parse([]).body, ["sheet", "--holes", "484"])


class Versions(unittest.TestCase):
    def test_the_program_reports_more_than_its_version(self):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder, "lamella")
            program.write_text("#!/bin/sh\necho lamella 1.2.3\necho MIT licence\n", encoding="utf-8")
            program.chmod(0o755)
            ours = next(reader for reader in readers(folder, program) if reader.name == "lamella")
            self.assertEqual(ours.version(), "1.2.3")

    def test_without_the_program_there_is_none(self):
        ours = next(reader for reader in readers("none", "none/lamella") if reader.name == "lamella")
        self.assertIsNone(ours.version())


if __name__ == "__main__":
    unittest.main()
