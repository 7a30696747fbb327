"""Common Layer Interface and SLC, decoded by programs that share no code with ours.

Each must find the layers that our exact JSON has, to the resolution of its format.
"""

import json
import math
import sys
from pathlib import Path

import slice_file_decoders as decoders

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, main  # noqa: E402

# Two parts with what slicing does not make: open contours, hatches, and a layer without anything.
HAND_MADE = json.dumps({
    "format": "lamella layers", "version": 1, "parts": [{"label": "left"}, {"label": "right"}],
    "layers": [
        {"z": 1.25, "bottom": 1, "top": 1.5, "parts": [
            {"rings": [[1, 1, 9, 1, 9, 8.5, 1, 8.5], [3, 3, 3, 5, 5, 5]], "chains": [[1, 2, 3, 4.25, 6, 5]],
             "hatches": [1, 1, 2, 2, 3.5, 1, 4, 7]},
            {"rings": [[11, 1, 12.125, 1, 11, 4]]}]},
        {"z": 1.6, "bottom": 1.5, "top": 1.7, "parts": [{"rings": []}, {"rings": []}]},
        {"z": 2, "bottom": 1.7, "top": 2.3, "parts": [
            {"rings": []}, {"rings": [[11, 2, 15, 2, 13, 6.5]], "hatches": [11, 2, 13, 4]}]}]})


def pairs(flat):
    return list(zip(flat[::2], flat[1::2]))


def area(points):
    return sum(x * v - u * y for (x, y), (u, v) in zip(points, points[1:] + points[:1])) / 2


def perimeter(points):
    return sum(math.dist(p, q) for p, q in zip(points, points[1:] + points[:1]))


class CliAndSlc(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("make", "rook", "-o", "rook.stl")
        self.succeed("make", "torus", "-o", "torus.stl")
        # Of both signs, and of positive coordinates only, which the short form needs.
        self.succeed("slice", "rook.stl", "--label", "rook", "torus.stl", "--label", "ring", "--translate",
                     "-70,20,0.3", "-o", "plate.json", "--layer-height", "0.7")
        self.succeed("slice", "torus.stl", "--translate", "60,50,9", "-o", "positive.json", "--layer-height", "0.5")
        self.write("hand.json", HAND_MADE)

    def decoded(self, name, format, *options):
        self.succeed("convert", name, "out", "--format", format, *options)
        return getattr(decoders, "slc" if format == "slc" else "cli")(self.bytes_of("out"))

    def exact(self, name):
        exact = json.loads(self.bytes_of(name))
        self.assertGreater(len(exact["layers"]), 2)
        return [part.get("label", "") for part in exact["parts"]], exact["layers"]

    def assert_rings(self, found, expected, rounding):
        """`found`: lists of points without the last one, in mm. Areas have the signs of their directions."""
        self.assertEqual(len(found), len(expected))
        for ring, exact in zip(found, expected):
            self.assertAlmostEqual(area(ring), area(exact), delta=1e-9 + rounding * perimeter(exact))
            self.assertLessEqual(len(ring), len(exact))  # rounding may make one of two points
            for axis in range(2):
                for bound in (min, max):
                    self.assertAlmostEqual(bound(p[axis] for p in ring), bound(p[axis] for p in exact), delta=rounding)

    def check_cli(self, name, format, rounding, *options):
        """`rounding`: how far, in mm, the form may move a coordinate. Heights have their own."""
        labels, exact = self.exact(name)
        file = self.decoded(name, format, *options)
        unit = file.header["units"]
        self.assertEqual(list(file.header["labels"].items()), list(enumerate(labels, 1)))
        self.assertEqual(file.header["layers"], len(file.layers))
        self.assertEqual(len(file.layers), len(exact) + 1)
        bottom = file.layers[0]
        self.assertFalse(bottom.contours or bottom.hatches)
        self.assertAlmostEqual(bottom.z * unit, exact[0]["bottom"], delta=rounding)
        box = file.header["dimension"]
        every = [(x * unit, y * unit) for layer in file.layers for c in layer.contours for x, y in c.points]
        every += [(x * unit, y * unit) for layer in file.layers for _, a, b in layer.hatches for x, y in (a, b)]
        for axis in range(2):
            self.assertAlmostEqual(box[axis], min(p[axis] for p in every), delta=rounding + 1e-6)
            self.assertAlmostEqual(box[3 + axis], max(p[axis] for p in every), delta=rounding + 1e-6)
        self.assertAlmostEqual(box[2], exact[0]["bottom"], delta=1e-6)
        self.assertAlmostEqual(box[5], exact[-1]["top"], delta=1e-6)
        for layer, truth in zip(file.layers[1:], exact):
            self.assertAlmostEqual(layer.z * unit, truth["top"], delta=rounding)
            for part, of_part in enumerate(truth["parts"], 1):
                self.check_contours([c for c in layer.contours if c.part == part], of_part, unit, rounding)
                hatches = [(x * unit, y * unit) for p, a, b in layer.hatches if p == part for x, y in (a, b)]
                expected = pairs(of_part.get("hatches", []))
                self.assertEqual(len(hatches), len(expected))
                for p, q in zip(hatches, expected):
                    self.assertAlmostEqual(p[0], q[0], delta=rounding)
                    self.assertAlmostEqual(p[1], q[1], delta=rounding)
            self.assertLessEqual({c.part for c in layer.contours}, set(range(1, len(labels) + 1)))

    def check_contours(self, contours, truth, unit, rounding):
        rings = []
        chains = []
        for contour in contours:
            points = [(x * unit, y * unit) for x, y in contour.points]
            if contour.direction == 2:
                self.assertNotEqual(points[0], points[-1])
                chains.append(points)
                continue
            self.assertEqual(points[0], points[-1])
            self.assertEqual(contour.direction, 1 if area(points[:-1]) > 0 else 0)
            rings.append(points[:-1])
        # Outer rings, then holes, then open lines.
        order = [{1: 0, 0: 1, 2: 2}[contour.direction] for contour in contours]
        self.assertEqual(order, sorted(order))
        exact = sorted((pairs(ring) for ring in truth["rings"]), key=lambda ring: area(ring) < 0)
        self.assert_rings(rings, exact, rounding)
        expected = [pairs(chain) for chain in truth.get("chains", [])]
        self.assertEqual([len(chain) for chain in chains], [len(chain) for chain in expected])
        for chain, exact in zip(chains, expected):
            for p, q in zip(chain, exact):
                self.assertAlmostEqual(p[0], q[0], delta=rounding)
                self.assertAlmostEqual(p[1], q[1], delta=rounding)

    def test_long_binary_cli(self):
        for name in ["plate.json", "positive.json", "hand.json"]:
            with self.subTest(name):
                self.check_cli(name, "cli", 1e-5)

    def test_short_binary_cli(self):
        for name in ["positive.json", "hand.json"]:
            with self.subTest(name):
                self.check_cli(name, "cli", 0.00251, "--short", "--units-mm", "0.005")

    def test_ascii_cli(self):
        for name in ["plate.json", "positive.json", "hand.json"]:
            with self.subTest(name):
                self.check_cli(name, "cli-ascii", 0.000501)
                self.check_cli(name, "cli-ascii", 0.0126, "--units-mm", "0.025")

    def test_slc(self):
        rounding = 1e-5
        for name in ["plate.json", "positive.json", "hand.json"]:
            with self.subTest(name):
                _, exact = self.exact(name)
                file = self.decoded(name, "slc")
                self.assertEqual(file.header["-SLCVER"], ["2.0"])
                self.assertEqual(file.header["-UNIT"], ["MM"])
                self.assertEqual(file.header["-TYPE"], ["PART"])
                self.assertLessEqual(len(" ".join(file.header["-PACKAGE"])), 32)
                self.assertEqual(len(file.layers), len(exact))
                lowest, thickness, compensation, _ = file.header["table"][0]
                self.assertEqual(lowest, file.layers[0].z)
                self.assertAlmostEqual(thickness, exact[0]["top"] - exact[0]["bottom"], delta=rounding)
                self.assertEqual(compensation, 0)
                self.assertAlmostEqual(file.header["top"], exact[-1]["top"], delta=rounding)
                for layer, truth in zip(file.layers, exact):
                    self.assertAlmostEqual(layer.z, truth["bottom"], delta=rounding)
                    self.assertTrue(all(c.points[0] == c.points[-1] for c in layer.contours))
                    self.assert_rings([c.points[:-1] for c in layer.contours],
                                      [pairs(ring) for part in truth["parts"] for ring in part["rings"]], rounding)
                extents = file.header["-EXTENTS"]
                rings = [p for layer in exact for part in layer["parts"] for ring in part["rings"] for p in pairs(ring)]
                for axis in range(2):
                    self.assertLessEqual(extents[axis][0], min(p[axis] for p in rings) + rounding)
                    self.assertGreaterEqual(extents[axis][1], max(p[axis] for p in rings) - rounding)
                self.assertAlmostEqual(extents[2][0], exact[0]["bottom"], delta=rounding)
                self.assertAlmostEqual(extents[2][1], exact[-1]["top"], delta=rounding)


if __name__ == "__main__":
    main()
