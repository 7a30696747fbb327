"""The tables of the EECC paper: fits, layout, and a whole run on tiny parts."""

import json
import os
import tempfile
import unittest
from pathlib import Path

from bench.harness import parts
from bench.paper import __main__ as program
from bench.paper import fit, growth, tables
from bench.paper.cell import ENGINES, Cell, Laboratory, checked

LAMELLA = Path(os.environ["LAMELLA_PROGRAM"])
FIGURES = json.loads(program.FIGURES.read_text(encoding="utf-8"))


def layer(contours=1, area=5.0, mark="a"):
    return {"hash": mark, "contours": contours, "open_chains": 0, "area_mm2": area}


class Fits(unittest.TestCase):
    def test_a_power_law_is_found_again(self):
        factor, exponent = fit.power_law([(x, 3 * x**1.5) for x in (1, 2, 5, 100)])
        self.assertAlmostEqual(factor, 3)
        self.assertAlmostEqual(exponent, 1.5)

    def test_a_line_needs_two_places(self):
        self.assertIsNone(fit.straight_line([(1, 2), (1, 3)]))
        self.assertIsNone(fit.power_law([]))
        intercept, slope = fit.straight_line([(0, 7), (10, 27)])
        self.assertAlmostEqual(intercept, 7)
        self.assertAlmostEqual(slope, 2)


class Figures(unittest.TestCase):
    def test_they_are_about_parts_and_engines_that_there_are(self):
        names = {part.name for part in parts.PAPER_PARTS}
        for key in ("table1_seconds", "table2_searches", "table3_cases", "table5_seconds", "table6_seconds"):
            self.assertLessEqual(set(FIGURES[key]), names, key)
        for engines in FIGURES["table5_seconds"].values():
            self.assertLessEqual(set(engines), set(ENGINES))

    def test_percentages_make_a_whole(self):
        self.assertAlmostEqual(sum(FIGURES["table4_percent"].values()), 100, delta=0.02)


class Cells(unittest.TestCase):
    def test_layers_with_equal_hashes_or_equal_areas_are_right(self):
        self.assertEqual(checked([layer()], [layer()]), "hashes")
        self.assertIn("areas", checked([layer(mark="b")], [layer()]))

    def test_other_areas_other_counts_and_missing_layers_are_wrong(self):
        for wrong in ([layer(area=5.001, mark="b")], [layer(contours=2, mark="b")], []):
            self.assertEqual(checked(wrong, [layer()]), "")

    def test_a_ratio_says_what_was_only_estimated(self):
        measured = Cell("p", "ecc", "ok", seconds=2.0)
        estimated = Cell("p", "ecc", "timeout", estimate=40.0)
        self.assertEqual(tables.compared(10.0, measured, 14400), "10.0 / 2.00 = 5.00")
        self.assertEqual(tables.compared(10.0, estimated, 14400), "10.0 / ≈ 40.0 = ≈ 0.250")
        bound = Cell("p", "ecc", "timeout", estimate=40.0, lower_bound=True)
        self.assertEqual(tables.compared(10.0, bound, 14400), "10.0 / ≥ 40.0")
        self.assertEqual(tables.compared(None, measured, 14400), "> 14,400 / 2.00 = > 7,200")
        self.assertEqual(tables.compared(10.0, Cell("p", "ecc", "wrong"), 14400), "10.0 / wrong")
        self.assertEqual(tables.compared("", measured, 14400), "not given / 2.00")

    def test_a_part_of_the_planes_gives_the_searches_of_all(self):
        """Of a sheet all planes are alike, so the estimate of a count is exact."""
        with tempfile.TemporaryDirectory() as folder:
            part = parts.TINY_PARTS[1]
            # The longer the limit, the longer a machine may pause and half of the planes still seem to fit.
            laboratory = Laboratory(LAMELLA, Path(folder), Path(folder) / "parts", timeout=3600, most_runs=1)
            measured = laboratory.cells(part, ["ecc"])[0]
            estimated = Cell(part.name, "ecc", "timeout")
            mesh = part.path(Path(folder) / "parts")
            laboratory.estimate(estimated, part, mesh, laboratory.slice(part, mesh, "sweep")[-1], None)
        self.assertEqual(estimated.estimated_from, "1 and 15 of 30 planes")
        self.assertEqual(estimated.searches_estimate, measured.matching["searches"])

    def test_beyond_that_the_square_of_the_triangles_is_taken(self):
        with tempfile.TemporaryDirectory() as folder:
            part = parts.TINY_PARTS[1]
            laboratory = Laboratory(LAMELLA, Path(folder), Path(folder) / "parts", timeout=60, most_runs=1)
            mesh = parts.make(part, LAMELLA, Path(folder) / "parts")
            smaller = Cell("smaller", "ecc", "timeout", triangles=270, estimate=10.0,
                           estimated_from="the square of the triangles, from smallest")
            cell = Cell(part.name, "ecc", "timeout")
            laboratory.estimate(cell, part, mesh, laboratory.slice(part, mesh, "sweep")[-1], smaller)
        self.assertAlmostEqual(cell.estimate, 40.0)

    def test_searches_of_all_planes_follow_from_two_numbers_of_planes(self):
        """Also with edge matching, where most of them are on the first plane of a triangle."""
        with tempfile.TemporaryDirectory() as folder:
            part = parts.TINY_PARTS[1]
            laboratory = Laboratory(LAMELLA, Path(folder), Path(folder) / "parts", timeout=60, most_runs=1)
            cells = {engine: laboratory.cells(part, [engine])[0] for engine in ("ecc", "eecc")}
            mesh = part.path(Path(folder) / "parts")
            reference = laboratory.slice(part, mesh, "sweep")[-1]
            for engine, measured in cells.items():
                estimated = Cell(part.name, engine, "timeout")
                laboratory.estimate(estimated, part, mesh, reference, None)
                self.assertAlmostEqual(estimated.searches_estimate, measured.matching["searches"], delta=30)


class Run(unittest.TestCase):
    def test_tiny_parts_fill_every_table(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "paper"
            code = program.main(["--lamella", str(LAMELLA), "--out", str(out), "--tiny", "--timeout", "2",
                                 "--without-rivals"])
            self.assertEqual(code, 0)
            told = json.loads((out / "paper.json").read_text(encoding="utf-8"))
            text = (out / "paper.md").read_text(encoding="utf-8")
            self.assertTrue((out / "paper.html").exists())
        self.assertEqual(len(told["cells"]), len(parts.TINY_PARTS) * len(ENGINES))
        for number in range(1, 8):
            self.assertIn(f"## Table {number}", text)
        self.assertIn("Section 4.1", text)

    def test_edge_matching_takes_the_planes_out_of_the_searches(self):
        """Table 7, counted: in split order every search of ECC grows with k, and EECC searches the less often."""
        with tempfile.TemporaryDirectory() as folder:
            found = growth.measure(LAMELLA, Path(folder), Path(folder) / "parts", 60, small=True)

        def exponent(samples, engine, x, y):
            return growth.exponent([s for s in samples if s.engine == engine and s.order == "split"], x, y)

        for engine in ("ecc", "eecc"):
            self.assertAlmostEqual(exponent(found.against_k, engine, lambda s: s.k, lambda s: s.comparisons / s.searches),
                                   1.0, delta=0.1)
        for engine, power in (("ecc", 1.0), ("eecc", 0.0)):
            self.assertAlmostEqual(exponent(found.against_m, engine, lambda s: s.m, lambda s: s.searches / s.triangles),
                                   power, delta=0.1)


if __name__ == "__main__":
    unittest.main()
