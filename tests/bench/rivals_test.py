"""The comparison with other slicers: nothing that went wrong is hidden, and other layers do not count."""

import json
import os
import sys
import tempfile
import unittest
from pathlib import Path

from bench.harness import parts
from bench.harness.layers import Layer
from bench.rivals import __main__ as program
from bench.rivals import report
from bench.rivals.compare import Comparison
from bench.rivals.job import Rival

LAMELLA = Path(os.environ["LAMELLA_PROGRAM"])
MACHINE = {"processor": "p", "threads": "2", "memory": "1 GiB", "system": "s", "program": "lamella 0",
           "date": "2026-01-01"}


def stand_in(name, source, layers=lambda job: []):
    """A real program in the place of a slicer."""
    return Rival(name=name, title=name.capitalize(), writes="", compared="", version=lambda: "1",
                 command=lambda job: [sys.executable, "-c", source], layers=layers,
                 slicing_seconds=lambda job, text: None, threaded=False)


class Rivals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "rivals"
        self.box = parts.TINY_PARTS[0]

    def cells(self, rival, timeout=60.0, part=None):
        comparison = Comparison(LAMELLA, self.folder, timeout, threads=2, most_runs=2)
        return comparison.run(part or self.box, [rival])

    def table(self, cells, rival):
        page = report.build_page(cells, [self.box], [(rival, "1")], {}, MACHINE, 60, 2)
        return page.markdown()

    def test_lamella_comes_first_and_is_what_ratios_are_taken_to(self):
        same = stand_in("same", "", lambda job: [Layer(z - job.bottom, 1, 600.0) for z in job.z])
        cells = self.cells(same)
        self.assertEqual([cell.slicer for cell in cells], ["lamella", "lamella-1", "same"])
        self.assertTrue(all(cell.counts for cell in cells))
        self.assertTrue(cells[2].agreement.exact)
        self.assertIn("| Lamella, 1 thread", self.table(cells, same))

    def test_a_crash_stays_in_the_table_and_in_the_chart(self):
        crash = stand_in("crash", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
        cells = self.cells(crash)
        self.assertFalse(cells[2].counts)
        self.assertIn("killed by SIGSEGV", self.table(cells, crash))
        self.assertIn("killed by SIGSEGV", report.time_chart(cells, {"lamella": "L", "lamella-1": "L1", "crash": "C"},
                                                             {"box": "box"}))

    def test_a_failure_is_reported_in_the_words_of_the_program(self):
        refusal = stand_in("refusal", "raise SystemExit('the first layer is empty')")
        cells = self.cells(refusal)
        self.assertEqual(cells[2].ended, "exit code 1")
        self.assertIn("it says: the first layer is empty", self.table(cells, refusal))

    def test_other_layers_are_shown_in_brackets(self):
        half = stand_in("half", "", lambda job: [Layer(z - job.bottom, 1, 300.0) for z in job.z])
        cells = self.cells(half)
        self.assertFalse(cells[2].counts)
        self.assertRegex(self.table(cells, half), r"\| Half +\| +\([\d.]+\) ")

    def test_output_that_cannot_be_read_is_a_failure(self):
        broken = stand_in("broken", "", lambda job: Path(job.file("nothing")).read_text(encoding="utf-8"))
        self.assertIn("no layers", self.cells(broken)[2].ended)

    def test_after_a_timeout_larger_ones_of_the_family_are_not_tried(self):
        slow = stand_in("slow", "import time; time.sleep(600)")
        comparison = Comparison(LAMELLA, self.folder, 0.3, threads=2, most_runs=2)
        small, large = (parts.sheet(holes, segments=16) for holes in (1, 4))
        self.assertEqual(comparison.run(small, [slow])[2].ended, "timeout")
        self.assertEqual(comparison.run(large, [slow])[2].ended, "skipped")
        self.assertEqual(comparison.run(self.box, [slow])[2].ended, "timeout")

    def test_the_program_leaves_its_report(self):
        program.main(["--lamella", str(LAMELLA), "--out", str(self.folder), "--parts", "box", "--rivals"])
        told = json.loads((self.folder / "report.json").read_text(encoding="utf-8"))
        self.assertEqual({cell["slicer"] for cell in told["cells"]}, {"lamella", "lamella-1"})
        self.assertTrue((self.folder / "rivals.html").exists())

    def test_an_unknown_part_or_rival_is_refused(self):
        for arguments in (["--parts", "nothing"], ["--rivals", "nothing"]):
            with self.assertRaises(SystemExit) as refusal:
                program.main(["--lamella", str(LAMELLA), "--out", str(self.folder), *arguments])
            self.assertIn("there are", str(refusal.exception))


if __name__ == "__main__":
    unittest.main()
