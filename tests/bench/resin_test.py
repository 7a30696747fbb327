"""The comparison of printers' jobs: pictures that are not the same do not count."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from bench.harness import parts
from bench.resin import __main__ as program
from bench.resin import images, slicers

LAMELLA = Path(os.environ["LAMELLA_PROGRAM"])


class Jobs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.mesh = parts.make(parts.TINY_PARTS[0], LAMELLA, self.folder)

    def job(self, *options):
        output = self.folder / f"{len(list(self.folder.iterdir()))}.sl1"
        subprocess.run([LAMELLA, "slice", self.mesh, "-o", output, "--layer-height", "0.5", "--display-size", "40,50",
                        "--resolution", "80x100", "--progress", "none", *options], check=True, capture_output=True)
        return output

    def test_equal_jobs_agree(self):
        agreement = images.compare(self.job(), self.job())
        self.assertTrue(agreement.good)
        self.assertEqual((agreement.images, agreement.largest, agreement.apart), (5, 0, 0))

    def test_a_part_that_lies_elsewhere_is_found(self):
        for options in (["--rotate-z", "2"], ["--scale", "1.01"]):
            agreement = images.compare(self.job(), self.job(*options))
            self.assertFalse(agreement.good)
            self.assertIn("pixels differ", agreement.text())

    def test_layers_that_are_missing_are_reported(self):
        agreement = images.compare(self.job(), self.job("--layers", "0:3"))
        self.assertFalse(agreement.good)
        self.assertEqual(agreement.text(), "3 images instead of 5")

    def test_a_thin_last_layer_may_be_missing(self):
        self.assertTrue(images.compare(self.job(), self.job("--layers", "0:4")).good)

    def test_images_of_another_size_do_not_agree(self):
        agreement = images.compare(self.job(), self.job("--resolution", "100x125"))
        self.assertFalse(agreement.good)
        self.assertEqual(agreement.text(), "pictures of another size")

    def test_a_display_is_as_large_as_the_part_and_a_tenth(self):
        self.assertEqual(slicers.pixel_mm([[0, 0, 0], [256, 1, 1]]), 0.11)
        self.assertEqual(slicers.pixel_mm([[-81, -81, 0], [81, 81, 1]]), 0.11)


class Report(unittest.TestCase):
    def test_the_program_leaves_its_report(self):
        with tempfile.TemporaryDirectory() as folder:
            program.main(["--lamella", str(LAMELLA), "--out", folder, "--parts", "box", "--rounds", "1"])
            told = json.loads(Path(folder, "report.json").read_text(encoding="utf-8"))
            self.assertEqual([cell["slicer"] for cell in told["cells"]][:2], ["lamella", "layers"])
            self.assertTrue(Path(folder, "resin.html").exists())
            self.assertEqual(list(Path(folder).glob("*.sl1*")), [])

    def test_a_time_for_other_images_stands_in_brackets(self):
        ours = program.Cell("box", "lamella", "ok", 1, 1, 10**6, 10**6)
        other = program.Cell("box", "prusa-slicer", "ok", 3, 3, 10**6, 10**6, images.Agreement(5, 5, 200, 0.1))
        self.assertEqual(program.row(other, ours)[:2], ("(3.000)", "(3.00)"))
        other.agreement = images.Agreement(5, 5, 1, 1e-5)
        self.assertEqual(program.row(other, ours)[:2], ("3.000", "3.00"))

    def test_nor_does_one_with_nothing_to_compare_with(self):
        ours = program.Cell("box", "lamella", "exit code 1")
        other = program.Cell("box", "prusa-slicer", "ok", 3, 3, 10**6, 10**6)
        self.assertEqual(program.row(other, ours)[:2], ("(3.000)", ""))
        self.assertEqual(program.row(ours, ours)[0], "exit code 1")


if __name__ == "__main__":
    unittest.main()
