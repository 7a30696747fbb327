"""Broken meshes beside other slicers: truth comes from the sound solid, and nothing that a slicer lost is hidden."""

import math
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

from bench.broken import report
from bench.broken.__main__ import RING
from bench.broken.cases import LAYER_HEIGHT_MM, Case, cases
from bench.broken.image import image
from bench.broken.study import Study
from bench.broken.triangles import bounds, box, gem, read_stl, section_areas, turned, write_stl
from bench.broken.views import Drawing, View, difference
from bench.harness import parts
from bench.harness.layers import Layer
from bench.rivals.job import Rival

LAMELLA = Path(os.environ["LAMELLA_PROGRAM"])
BLOCK = box((1, 2, 3), (5, 5, 5))


def case(name="block", triangles=BLOCK):
    return Case(name, name, "nothing", triangles, (), [(1, BLOCK)])


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


class Truth(Folder):
    def test_areas_come_from_the_triangles(self):
        self.assertEqual(section_areas(BLOCK, [3, 4.5, 5]), [12, 12, 0])
        self.assertEqual(section_areas(list(map(turned, BLOCK)), [4]), [-12])
        self.assertAlmostEqual(section_areas(gem(7, 8, 20.25), [10.125])[0], 20.25**2 / 2)

    def test_a_solid_is_a_sum_of_meshes(self):
        two = Case("two", "", "", BLOCK, (), [(1, BLOCK), (1, box((0, 0, 3), (1, 1, 5))), (-1, box((2, 3, 3), (3, 4, 4)))])
        self.assertEqual(two.planes()[0], 3.125)
        self.assertEqual(two.true_areas(), [12.0] * 4 + [13.0] * 4)

    def test_files_keep_the_triangles(self):
        write_stl(self.folder / "block.stl", BLOCK)
        self.assertEqual(read_stl(self.folder / "block.stl"), BLOCK)
        self.assertEqual(bounds(BLOCK), ((1, 2, 3), (5, 5, 5)))


class Differences(unittest.TestCase):
    expected = [Layer(0.125, 0, 10.0), Layer(0.375, 0, 20.0), Layer(0.625, 0, 30.0)]

    def off(self, layers, sinks=False):
        return difference(View("", "", "ok", layers), self.expected, LAYER_HEIGHT_MM, sinks)

    def test_layers_that_are_missing_are_empty(self):
        off = self.off(self.expected[:2])
        self.assertEqual((off.share, off.worst_z, off.worst_mm2), (0.5, 0.625, -30.0))

    def test_errors_do_not_cancel(self):
        self.assertEqual(self.off([Layer(0.125, 0, 20.0), Layer(0.375, 0, 10.0), self.expected[2]]).share, 20 / 60)

    def test_only_programs_that_sink_are_tried_higher(self):
        sunk = [Layer(0.125, 0, 20.0), Layer(0.375, 0, 30.0)]
        self.assertEqual(self.off(sunk, sinks=True).share, 10 / 60)
        self.assertEqual(self.off(sunk).share, 50 / 60)


class Lamella(Folder):
    def test_what_is_mended_has_the_areas_of_what_was_meant(self):
        study = Study(LAMELLA, self.folder / "work", [], 60, 2)
        ring = read_stl(parts.make(RING, LAMELLA, self.folder / "parts"))
        sound = {"sound", "repeated", "wall", "double-wall", "fin", "edge", "point"}
        for one in cases(ring):
            with self.subTest(one.name):
                finding = study.case(one)
                as_is, mended = finding.rows[0][1], finding.rows[-1][1]
                self.assertLess(mended.share, 0.005)
                self.assertEqual(as_is.share < 0.001, one.name in sound)

    def test_open_chains_are_counted_and_drawn(self):
        finding = Study(LAMELLA, self.folder / "work", [], 60, 2).case(case(triangles=BLOCK[:-1]))
        self.assertEqual(finding.rows[0][0].open_chains, 8, "one in every layer")
        self.assertEqual([len(drawing.chains) for drawing in finding.drawings], [1])
        self.assertIn("1 open", report.layer_image(finding))


class Others(Folder):
    def finding(self, source, layers=lambda job: []):
        stand_in = Rival(name="slic3r", title="Another", writes="", compared="", version=lambda: "1",
                         command=lambda job: [sys.executable, "-c", source, job.file("slic3r.svg")], layers=layers,
                         slicing_seconds=lambda job, text: None, threaded=False)
        return Study(LAMELLA, self.folder / "work", [stand_in], 60, 2).case(case())

    def table(self, finding):
        machine = {"program": "lamella 0"}
        page = report.build_page([finding], [], [], [], machine)
        return page.markdown()

    def test_a_crash_stays_in_the_tables_and_in_the_image(self):
        finding = self.finding("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
        self.assertEqual(self.table(finding).count("killed by SIGSEGV"), 2)
        self.assertIn("killed by SIGSEGV", report.layer_image(finding))

    def test_output_that_is_not_there_is_reported(self):
        self.assertIn("no layers", self.table(self.finding("", lambda job: open(job.file("slic3r.svg"), encoding="utf-8"))))

    def test_rings_are_drawn_where_the_mesh_is(self):
        lines = ['<g id="layer0" slic3r:z="0.125">', '<polygon points="0,0 4,0 4,3 0,3" />', "</g>"]
        finding = self.finding(f"import sys; open(sys.argv[1], 'w').write({chr(10).join(lines)!r})",
                               lambda job: [Layer(0.125, 1, 100.0)])
        _, off = finding.rows[-1]
        self.assertEqual(finding.drawings[-1].rings, [[(1, 2), (5, 2), (5, 5), (1, 5)]])
        self.assertAlmostEqual(off.share, 172 / 96)
        self.assertEqual(json_slicer(finding)["areas_mm2"], [[0.125, 100.0]])


def json_slicer(finding):
    return report.as_json([finding], [], [])["broken"][0]["slicers"][-1]


class Images(unittest.TestCase):
    def test_contours_are_filled_paths_are_wide_and_open_ends_are_dots(self):
        square = [(0, 0), (10, 0), (10, 10), (0, 10)]
        text = image("p", [("ours", Drawing([square], [square[:3]]), ""), ("path", Drawing([square], width=0.5), ""),
                             ("none", None, "gone")], ((0, 0, 0), (10, 10, 1)))
        self.assertEqual(len(re.findall("<circle", text)), 2)
        self.assertEqual(text.count('fill-rule="nonzero"'), 1)
        wide = [float(width) for width in re.findall(r'stroke-width="(\d+\.\d+)"/>', text)]
        self.assertTrue(any(math.isclose(width, 0.5 * 180 / 11.6, abs_tol=0.1) for width in wide))
        self.assertIn("gone", text)


if __name__ == "__main__":
    unittest.main()
