"""What slicers leave behind, read back as layers."""

import math
import tempfile
import unittest
from pathlib import Path

from bench.rivals import cura, layered_svg, prusa_slicer, toolpath

SVG = """<svg xmlns:slic3r="http://slic3r.org/namespaces/slic3r">
  <g id="layer0" slic3r:z="{0}">
    <polygon slic3r:type="contour" points="20,30 0,30 0,0 20,0" style="fill: white" />
    <polygon slic3r:type="hole" points="5,5 5,10 10,10 10,5" style="fill: black" />
  </g>
  <g id="layer1" slic3r:z="{1}">
  </g>
</svg>
"""

# A square of 20 mm with a hole of 10 mm, walls 0.4 mm wide: their middles run 0.2 mm inside of the material.
OUTER = [(0.2, 0.2), (19.8, 0.2), (19.8, 19.8), (0.2, 19.8)]
HOLE = [(4.8, 4.8), (4.8, 15.2), (15.2, 15.2), (15.2, 4.8)]


def moves(ring, extruded, close=True):
    """G-code of a ring, and how far the filament has come."""
    lines = ["G0 X{:g} Y{:g}".format(*ring[0])]
    for x, y in ring[1:] + (ring[:1] if close else []):
        extruded += 1
        lines.append(f"G1 X{x:g} Y{y:g} E{extruded:g}")
    return lines, extruded


class Readers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "file"

    def write(self, text):
        self.path.write_text(text, encoding="utf-8")
        return self.path

    def test_rings_of_an_svg_layer_are_counted_and_measured(self):
        for heights in ((0.05, 0.15), ("5e-08", "1.5e-07")):
            layers = layered_svg.read_layers(self.write(SVG.format(*heights)))
            self.assertEqual(len(layers), 1, "a layer without rings is none")
            self.assertAlmostEqual(layers[0].z, 0.05)
            self.assertEqual(layers[0].contours, 2)
            self.assertAlmostEqual(layers[0].area_mm2, 600 - 25)
            self.assertAlmostEqual(layers[0].perimeter_mm, 100 + 20)

    def test_a_tool_path_gives_back_what_its_walls_enclose(self):
        # Corners come back rounded.
        area = 400 - (4 - math.pi) * 0.2**2 - (10.4**2 - 4 * 10.4 * 0.2 + math.pi * 0.2**2)
        for hole_ring in (HOLE, HOLE[::-1]):  # printers run them in either direction
            outer, extruded = moves(OUTER, 0)
            hole, _ = moves(hole_ring, extruded)
            text = "\n".join(["G92 E0", ";LAYER:0", ";TYPE:WALL-OUTER", *hole, *outer,
                              ";TYPE:SKIN", *moves(OUTER, 100)[0], ";LAYER:1"])
            layers = toolpath.read_layers(self.write(text), lambda line: line.startswith(";LAYER:"), cura.is_wall, 0.4,
                                          0.1)
            self.assertEqual([layer.contours for layer in layers], [2], "skin is no wall, an empty layer is none")
            self.assertAlmostEqual(layers[0].z, 0.05)
            self.assertAlmostEqual(layers[0].area_mm2, area)

    def test_rings_end_at_a_retraction_and_need_not_quite_close(self):
        first, extruded = moves(OUTER, 0, close=False)
        second, _ = moves(HOLE, extruded - 0.5, close=False)
        text = "\n".join([";LAYER_CHANGE", ";TYPE:External perimeter", *first, f"G1 E{extruded - 0.5:g}", *second])
        layers = toolpath.read_layers(self.write(text), lambda line: line.startswith(";LAYER_CHANGE"),
                                      prusa_slicer.is_wall, 0.4, 0.1)
        self.assertEqual(layers[0].contours, 2)

    def test_a_step_too_short_to_extrude_is_of_the_path(self):
        first, _ = moves(OUTER, 0)
        x, y = OUTER[2]
        first.insert(3, f"G1 X{x - 0.05:g} Y{y:g}")
        text = "\n".join([";LAYER:0", ";TYPE:WALL-OUTER", *first])
        layers = toolpath.read_layers(self.write(text), lambda line: line.startswith(";LAYER:"), cura.is_wall, 0.4, 0.1)
        self.assertEqual(layers[0].contours, 1)

    def test_prusa_slicer_reports_when_its_first_stage_begins_and_ends(self):
        text = ("[2026-01-01 23:59:59.500000] [0x1] [info]    Slicing volumes... Resident memory: 74MB\n"
                "20 => Generating perimeters\n"
                "[2026-01-02 00:00:01.250000] [0x1] [info]    Generating perimeters... Resident memory: 75MB\n")
        self.assertAlmostEqual(prusa_slicer.slicing_seconds(None, text), 1.75)
        self.assertIsNone(prusa_slicer.slicing_seconds(None, "nothing of the kind"))

    def test_cura_reports_the_time_of_its_first_stage(self):
        text = "slice of mesh took 0.070 seconds\nProgress: slice accomplished in 0.105s\n"
        self.assertAlmostEqual(cura.slicing_seconds(None, text), 0.105)
        self.assertIsNone(cura.slicing_seconds(None, ""))


if __name__ == "__main__":
    unittest.main()
