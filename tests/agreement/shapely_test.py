"""What is made of layers, against Shapely (GEOS): unions by winding rule, offsets, what is left out."""

import itertools
import json
import math
import random
import sys
from pathlib import Path

import shapely.geometry
from shapely.geometry import LinearRing, LineString, MultiPolygon, Polygon
from shapely.ops import polygonize, unary_union

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, main  # noqa: E402

# They have holes near the plate. Where they are absent, the bodies of the program are enough.
PUBLIC_MESHES = [Path(__file__).resolve().parents[3] / "shared/meshes" / name for name in (
    "prusa-i3__x-carriage.stl", "prusa-mini__MINI-z-carriage-front.stl", "voron2__Voron_Design_Cube_v7.stl",
    "numpy-stl__rear_case.stl")]
IS_MATERIAL = {"nonzero": lambda w: w != 0, "evenodd": lambda w: w % 2 != 0, "positive": lambda w: w > 0}


def winding(rings, x, y):
    count = 0
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
            if (ay > y) != (by > y) and ax + (y - ay) / (by - ay) * (bx - ax) > x:
                count += 1 if by > ay else -1
    return count


def signed_area(ring):
    return math.copysign(Polygon(ring).area, 1 if LinearRing(ring).is_ccw else -1)


def rings_of(layer):
    return [list(zip(ring[0::2], ring[1::2])) for part in layer["parts"] for ring in part["rings"]]


def off_by(a, b):
    """The Hausdorff distance of two rings, as lines: GEOS is wrong about rings."""
    return LineString(a + a[:1]).hausdorff_distance(LineString(b + b[:1]))


def material(rings, rule):
    """Where the winding number of the rings fulfils the rule: the plane cut up by all lines, cell by cell."""
    lines = unary_union([LineString(ring + ring[:1]) for ring in rings])
    cells = [cell for cell in polygonize(lines)
             if IS_MATERIAL[rule](winding(rings, *cell.representative_point().coords[0]))]
    return unary_union(cells)


def polygons(rings):
    """Of rings that do not cross: counter-clockwise ones are bodies, the others holes, which may hold bodies again."""
    shape = Polygon()
    for ring in sorted(map(Polygon, rings), key=lambda ring: -ring.area):
        shape = shape.union(ring) if ring.exterior.is_ccw else shape.difference(ring)
    return shape


def blob(numbers, extent=10.0):
    """A ring of any shape around a place: it may cross itself, run either way, or lie on a coarse grid."""
    x, y, size = numbers.uniform(0, extent), numbers.uniform(0, extent), numbers.uniform(0.5, 5)
    kind = numbers.randrange(4)
    if kind == 0:
        x, y, w, h = (numbers.randint(0, 10) for _ in range(4))
        ring = [(x, y), (x + w + 1, y), (x + w + 1, y + h + 1), (x, y + h + 1)]
    elif kind == 1:
        ring = [(numbers.uniform(x - size, x + size), numbers.uniform(y - size, y + size))
                for _ in range(numbers.randint(3, 7))]
    else:
        count = numbers.randint(3, 40)
        ring = [(x + size * numbers.uniform(0.5, 1) * math.cos(2 * math.pi * i / count),
                 y + size * numbers.uniform(0.5, 1) * math.sin(2 * math.pi * i / count)) for i in range(count)]
    ring = [(float(px), float(py)) for px, py in ring]
    return ring[::-1] if numbers.random() < 0.3 else ring


class Layers(ProgramTest):
    def given(self, layers):
        """A slice file of these layers, each a list of rings."""
        self.write("given.json", json.dumps({
            "format": "lamella layers", "version": 1, "units": "mm", "parts": [{"label": "part"}],
            "layers": [{"index": i, "z": i + 0.5, "bottom": i, "top": i + 1,
                        "parts": [{"rings": [[v for p in ring for v in p] for ring in rings]}]}
                       for i, rings in enumerate(layers)]}))

    def made(self, *options, source="given.json", result="made.json"):
        self.succeed("convert", source, result, *options)
        return [[list(zip(ring[0::2], ring[1::2])) for ring in layer["parts"][0]["rings"]]
                for layer in json.loads(self.bytes_of(result))["layers"]]

    def blobs(self, seed, count=150):
        numbers = random.Random(seed)
        return [[blob(numbers) for _ in range(numbers.randint(1, 8))] for _ in range(count)]

    def united(self, seed, count=150):
        """Layers without overlaps, and their material."""
        self.given(self.blobs(seed, count))
        layers = self.made("--fill", "nonzero", result="united.json")
        return layers, [polygons(rings) for rings in layers]

    def test_unions_by_the_winding_rule(self):
        layers = self.blobs(1)
        self.given(layers)
        for rule in IS_MATERIAL:
            for i, (rings, found) in enumerate(zip(layers, self.made("--fill", rule))):
                with self.subTest(rule=rule, layer=i):
                    expected = material(rings, rule)
                    self.assertAlmostEqual(polygons(found).symmetric_difference(expected).area, 0, delta=1e-6)
                    self.assertAlmostEqual(sum(map(signed_area, found)), expected.area, delta=1e-6)

    def test_areas_that_one_layer_has_and_the_other_has_not(self):
        first, second = self.blobs(7), self.blobs(8)
        self.given(first)
        self.succeed("convert", "given.json", "first.json")
        self.given(second)
        found = json.loads(self.run_program("compare", "first.json", "given.json", "--area-difference", "--json").out)
        told = {area["z"]: area["area_mm2"] for area in found["area_differences"]}
        for i, (a, b) in enumerate(zip(first, second)):
            with self.subTest(layer=i):
                expected = material(a, "positive").symmetric_difference(material(b, "positive")).area
                self.assertAlmostEqual(told.get(i + 0.5, 0), expected, delta=1e-6)

    def test_offsets_lie_between_round_ones_of_once_and_twice_the_distance(self):
        _, before = self.united(2)
        for distance in (0.05, 0.4, 1.5):
            for sign in (1, -1):
                made = self.made("--offset", f"{sign * distance}", source="united.json")
                for i, (shape, rings) in enumerate(zip(before, made)):
                    with self.subTest(distance=sign * distance, layer=i):
                        found = polygons(rings)
                        once, twice = (shape.buffer(sign * f * distance, resolution=64) for f in (1, 2))
                        less, more = (once, twice) if sign > 0 else (twice, once)
                        # Round buffers are polygons themselves: within once and twice by a little.
                        slack = 1e-3 * distance * (1 + shape.length)
                        self.assertLess(less.difference(found).area, slack)
                        self.assertLess(found.difference(more).area, slack)

    def test_offsets_of_blunt_corners_are_those_of_geos(self):
        numbers = random.Random(3)
        boxes = [[[(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
                  for x, y, w, h in (tuple(numbers.uniform(1, 9) for _ in range(4)) for _ in range(5))] for _ in range(100)]
        self.given(boxes)
        before = [polygons(rings) for rings in self.made("--fill", "nonzero", result="united.json")]
        for distance in (0.3, -0.3):
            for shape, rings in zip(before, self.made("--offset", f"{distance}", source="united.json")):
                expected = shape.buffer(distance, join_style=2, mitre_limit=2)
                # GEOS leaves out points that move the line by up to a hundredth of the distance.
                off = 0.01 * abs(distance) * shape.length
                self.assertAlmostEqual(polygons(rings).symmetric_difference(expected).area, 0, delta=off)

    def test_offsets_with_round_corners_are_those_of_geos(self):
        _, before = self.united(9)
        for distance in (0.05, 0.4, 1.5):
            for sign in (1, -1):
                made = self.made("--offset", f"{sign * distance}", "--offset-corners", "round", source="united.json")
                for i, (shape, rings) in enumerate(zip(before, made)):
                    with self.subTest(distance=sign * distance, layer=i):
                        expected = shape.buffer(sign * distance, resolution=64)
                        off = 1e-3 * (2 + distance) * (expected.length + 1)  # chords of either, and what GEOS leaves out
                        self.assertLess(polygons(rings).symmetric_difference(expected).area, off)

    def test_first_layers_shrink_as_geos_shrinks_them(self):
        """Elephant's foot: the inset falls from the plate to the height of the ramp, and holes grow."""
        bodies = {"sheet": ("sheet", "--holes", "9"), "rook": ("rook",), "calibration": ("calibration",),
                  "lattice": ("lattice", "--cells", "2"), "torus": ("torus",), "box": ("box", "--size", "10,8,3")}
        for name, made in bodies.items():
            self.succeed("make", *made, "-o", f"{name}.stl")
        shared = [mesh for mesh in PUBLIC_MESHES if mesh.exists()]
        for mesh, inset, height in itertools.product([self.path(f"{name}.stl") for name in bodies] + shared, (0.1, 0.3), (0.5, 1.5)):
            for corners, join_style in (("round", 1), ("bevel", 3)):
                with self.subTest(mesh=mesh.name, inset=inset, height=height, corners=corners):
                    self.check_bottom(mesh, inset, height, corners, join_style)

    def check_bottom(self, mesh, inset, height, corners, join_style):
        cut = ["slice", mesh, "--layer-height", "0.2", "--layers", "0:12", "--fill", "nonzero"]
        self.succeed(*cut, "-o", "plain.json")
        self.succeed(*cut, "--bottom-offset", f"{inset}:{height}", "--offset-corners", corners, "-o", "shrunk.json")
        plain, shrunk = (json.loads(self.bytes_of(f"{name}.json"))["layers"] for name in ("plain", "shrunk"))
        self.assertEqual(len(plain), len(shrunk))
        plate = plain[0]["bottom"]
        changed = 0
        for before, after in zip(plain, shrunk):
            above = before["z"] - plate
            if above >= height:
                self.assertEqual(before, after)
                continue
            changed += 1
            shape, found = (polygons(rings_of(layer)) for layer in (before, after))
            distance = inset * (1 - above / height)
            expected = shape.buffer(-distance, join_style=join_style, resolution=64)
            # GEOS leaves out points that move the line by up to a hundredth of the distance; arcs have chords.
            off = (0.01 * distance + 0.001) * shape.length + 1e-6
            self.assertLess(found.symmetric_difference(expected).area, off)
            self.assertLess(found.difference(shape).area, 1e-9 * (1 + shape.area))
        self.assertGreater(changed, 1)

    def test_simplified_contours_stay_near_and_apart(self):
        layers, before = self.united(4)
        for distance in (0.01, 0.2, 1.0):
            left_out = 0
            for i, (old, shape, new) in enumerate(zip(layers, before, self.made("--simplify", f"{distance}", source="united.json"))):
                with self.subTest(distance=distance, layer=i):
                    self.assertEqual(len(new), len(old))
                    for ring in new:
                        was, off = min(((one, off_by(ring, one)) for one in old if set(ring) <= set(one)), key=lambda found: found[1])
                        self.assertLessEqual(off, distance * (1 + 1e-9))
                        self.assertEqual(LinearRing(ring).is_ccw, LinearRing(was).is_ccw)
                        left_out += len(was) - len(ring)
                    for a, b in itertools.combinations(map(Polygon, new), 2):
                        shared = a.intersection(b).area  # rings that do not cross are apart or one within the other
                        self.assertLess(min(shared, abs(shared - a.area), abs(shared - b.area)), 1e-6)
                    self.assertAlmostEqual(polygons(new).symmetric_difference(shape).area, 0, delta=2 * distance * shape.length)
            self.assertGreater(left_out, 100)

    def test_the_largest_body_and_those_that_are_not_too_small(self):
        layers, shapes = self.united(5)
        largest = self.made("--largest-only", source="united.json")
        not_small = self.made("--min-area", "2", source="united.json")
        for old, shape, one, some in zip(layers, shapes, largest, not_small):
            bodies = list(shape.geoms) if isinstance(shape, MultiPolygon) else [shape]
            most = max(bodies, key=lambda body: Polygon(body.exterior).area)
            self.assertAlmostEqual(polygons(one).symmetric_difference(most).area, 0, delta=1e-9)
            self.assertEqual(sorted(map(sorted, some)), sorted(sorted(ring) for ring in old if Polygon(ring).area >= 2))

    def test_bodies_with_their_holes_have_the_area_of_the_rings(self):
        layers, _ = self.united(6)
        self.succeed("convert", "united.json", "united.geojson")
        features = json.loads(self.bytes_of("united.geojson"))["features"]
        self.assertEqual(len(features), len(layers))
        for rings, feature in zip(layers, features):
            told = shapely.geometry.shape(feature["geometry"])
            rounding = 0.0005 * sum(LinearRing(ring).length for ring in rings)
            self.assertAlmostEqual(told.area, polygons(rings).area, delta=rounding)


if __name__ == "__main__":
    main()
