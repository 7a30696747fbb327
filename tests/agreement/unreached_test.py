"""The area that no vector reaches, of `slice`, of `verify` and of Shapely (GEOS), which shares no code with them.

A tower of prisms has a shape on each layer: walls, tapers, wedges, fins and bent walls of all angles and thicknesses. Shapely
grows the vectors in the file by what docs/strategies.md says that they reach.
"""

import json
import math
import os
import random
import sys
import unittest
from pathlib import Path

try:
    from shapely.geometry import LineString, MultiLineString, Polygon
    from shapely.ops import unary_union
except ImportError:
    unary_union = None

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, main  # noqa: E402

LARGE = os.environ.get("LAMELLA_LARGE_SAMPLE") == "1"
LAYERS = 60 if LARGE else 20
HEIGHT = 0.05
MITRE = 2  # of Shapely's join styles
ROUND_CHORDS = 32
SHARPEST = 30  # degrees, of corners that count as reached
# A trunk with branches of 0.06 to 0.24 mm, whose middle lines once left the material at the inner corners.
BRANCHES = [(2.507, 1.561), (0.4655, 2.3548), (0.0767, 4.8391), (-0.0418, 4.8206), (0.3362, 2.4051), (0.1291, 2.4856),
            (-0.499, 5.7797), (-0.558, 5.7685), (0.0631, 2.5112), (-1.5107, 3.1231), (-1.5325, 3.0672), (0.0764, 2.4417),
            (0.534, 0.0416), (0.593, 0.0529), (0.1424, 2.416), (0.3469, 2.3365), (0.6888, 0.1518), (0.8073, 0.1703),
            (0.4762, 2.2862), (2.4856, 1.505)]
PATTERNS = ["lines", "meander", "stripes", "chessboard", "hexagons"]


def wall_along(line, thick):
    """A wall along a line, with a thickness at each point."""
    left, right = [], []
    for i, (x, y) in enumerate(line):
        (ax, ay), (bx, by) = line[max(0, i - 1)], line[min(i + 1, len(line) - 1)]
        length = math.hypot(bx - ax, by - ay)
        nx, ny = -(by - ay) / length * thick[i] / 2, (bx - ax) / length * thick[i] / 2
        left.append((x + nx, y + ny))
        right.append((x - nx, y - ny))
    return right + left[::-1]


def wall(numbers):
    return wall_along([(0, 0), (numbers.uniform(1, 6), 0)], [numbers.uniform(0.1, 0.4)] * 2)


def taper(numbers):
    return wall_along([(0, 0), (numbers.uniform(1, 6), 0)], [numbers.uniform(0.1, 0.4), numbers.uniform(0.02, 0.4)])


def wedge(numbers):
    angle = math.radians(numbers.choice([1, 3, 8, 15, 25, 29, 31, 45, 80]))
    length = numbers.uniform(1, 6)
    return [(0, 0), (length, 0), (length * math.cos(angle), length * math.sin(angle))]


def fin(numbers):
    """A block with a fin that may taper to nothing."""
    base, tip, out = numbers.uniform(0.1, 0.5), numbers.uniform(0, 0.4), numbers.uniform(1, 4)
    return [(0, 0), (2, 0), (2, 1), (2 + out, 1 + (base - tip) / 2), (2 + out, 1 + (base + tip) / 2 + 1e-6), (2, 1 + base),
            (2, 2), (0, 2)]


def bent_wall(numbers):
    line, way = [(0, 0)], 0
    for _ in range(numbers.randint(2, 4)):
        way += numbers.uniform(-1.1, 1.1)
        x, y = line[-1]
        line.append((x + 1.5 * math.cos(way), y + 1.5 * math.sin(way)))
    thick = numbers.uniform(0.1, 0.4)
    return wall_along(line, [thick * numbers.uniform(0.8, 1.2) for _ in line])


SHAPES = [wall, taper, wedge, fin, bent_wall]


def turned(ring, numbers):
    angle, x0, y0 = numbers.uniform(0, 2 * math.pi), numbers.uniform(-20, 20), numbers.uniform(-20, 20)
    c, s = math.cos(angle), math.sin(angle)
    return [(x * c - y * s + x0, x * s + y * c + y0) for x, y in ring]


def random_shape(numbers, kind):
    """A ring that does not cross itself, turned and moved, with the coordinates that the mesh file has."""
    while True:
        ring = [(round(x, 5), round(y, 5)) for x, y in turned(kind(numbers), numbers)]
        if Polygon(ring).is_valid and Polygon(ring).area > 0.01:
            return ring


def cross(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def triangles(ring):
    """Ear by ear: indices of the corners."""
    rest, result = list(range(len(ring))), []
    while len(rest) > 3:
        for k in range(len(rest)):
            a, b, c = rest[k - 1], rest[k], rest[(k + 1) % len(rest)]
            inside = any(all(cross(ring[p], ring[q], ring[other]) >= 0 for p, q in ((a, b), (b, c), (c, a)))
                         for other in rest if other not in (a, b, c))
            if cross(ring[a], ring[b], ring[c]) > 0 and not inside:
                result.append((a, b, c))
                del rest[k]
                break
        else:
            raise ValueError("no ear")
    return [*result, tuple(rest)]


def tower(rings, height=HEIGHT):
    """An OBJ file with a prism of each ring, one on the other."""
    vertices, faces = [], []
    for layer, ring in enumerate(rings):
        first, n = len(vertices) + 1, len(ring)
        for z in (layer * height, (layer + 1) * height):
            vertices += [(x, y, z) for x, y in ring]
        for a, b, c in triangles(ring):
            faces += [(first + a, first + c, first + b), (first + n + a, first + n + b, first + n + c)]
        for i in range(n):
            k = (i + 1) % n
            faces += [(first + i, first + k, first + n + k), (first + i, first + n + k, first + n + i)]
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices) + "".join("f %d %d %d\n" % face for face in faces)


def corner_piece(before, p, after, reach):
    """What a ring reaches beside a corner, besides the strips along its sides and a circle."""
    u = (p[0] - before[0], p[1] - before[1])
    v = (after[0] - p[0], after[1] - p[1])
    lu, lv = math.hypot(*u), math.hypot(*v)
    turn = math.atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1])
    side = -reach if turn > 0 else reach
    a = (p[0] - side * u[1] / lu, p[1] + side * u[0] / lu)
    b = (p[0] - side * v[1] / lv, p[1] + side * v[0] / lv)
    corner = math.pi - abs(turn)
    far = reach * math.tan(abs(turn) / (2 if corner >= math.radians(SHARPEST) else 4))
    return Polygon([p, a, (a[0] + far * u[0] / lu, a[1] + far * u[1] / lu), (b[0] - far * v[0] / lv, b[1] - far * v[1] / lv), b])


def grown_rings(rings, reach):
    pieces = []
    for ring in rings:
        pieces.append(LineString([*ring, ring[0]]).buffer(reach, ROUND_CHORDS))
        pieces += [corner_piece(ring[i - 1], ring[i], ring[(i + 1) % len(ring)], reach).buffer(0) for i in range(len(ring))]
    return unary_union([piece.buffer(0) for piece in pieces]).buffer(0)  # GEOS may leave shells within shells


def reached(contours, lines_of_contours, hatches, contour_reach, hatch_reach):
    pieces = [grown_rings(contours, contour_reach)]
    if lines_of_contours:
        pieces.append(MultiLineString(lines_of_contours).buffer(contour_reach, ROUND_CHORDS))
    pieces += [LineString(line).buffer(hatch_reach, ROUND_CHORDS) for line in hatches]
    return unary_union([piece.buffer(0) for piece in pieces]).buffer(0)  # GEOS may leave shells within shells


class Rule:
    """The numbers of a strategy."""

    def __init__(self, numbers, pattern):
        self.pattern = pattern
        self.distance = numbers.choice([0.05, 0.08, 0.1, 0.12, 0.15, 0.17])
        self.angle = numbers.uniform(0, 180)
        self.contours = numbers.choice([1, 1, 2, 3])
        self.overlap = numbers.choice([0, 0.1])
        self.thin_walls = numbers.choice(["line", "leave out"])
        self.beam_offset, self.contour_distance, self.border, self.shortest, self.spot = 0.05, 0.1, 0.05, 0.1, 0.08

    def text(self):
        return f"""[contours]
count = {self.contours}
beam_offset = {self.beam_offset}
distance = {self.contour_distance}
thin_walls = "{self.thin_walls}"
[hatch]
pattern = "{self.pattern}"
distance = {self.distance}
angle_degrees = {self.angle!r}
border = {self.border}
shortest = {self.shortest}
overlap = {self.overlap}
"""

    def unreached(self, shape, vectors):
        """The area of the shape that the vectors do not reach."""
        farthest = max(4 * self.beam_offset, 2 * self.spot)
        of_contours = max(self.beam_offset, self.contour_distance / 2) if self.contours > 1 else self.beam_offset
        of_hatches = min(self.distance, farthest)
        bare = shape.difference(reached(*vectors, min(of_contours, farthest), of_hatches))
        inside = self.beam_offset + (self.contours - 1) * self.contour_distance + self.border
        half = math.hypot(self.shortest, self.distance) / 2
        inset = shape.buffer(-inside - half, join_style=MITRE, mitre_limit=2).buffer(0)
        rings = [list(ring.coords)[:-1] for body in getattr(inset, "geoms", [inset]) for ring in [body.exterior, *body.interiors]]
        wide = unary_union([inset, grown_rings([ring for ring in rings if ring], half)]).buffer(0)
        spots = bare.intersection(wide)
        largest_tip = self.shortest ** 2 + of_hatches ** 2 / 2
        return bare.difference(wide).area + sum(spot.area for spot in getattr(spots, "geoms", [spots])
                                                if spot.area > largest_tip)


def vectors_of(file):
    """Of each layer: contours, lines of contours, hatch lines."""
    def points(numbers):
        return list(zip(numbers[::2], numbers[1::2]))

    result = {}
    for layer in file["layers"]:
        contours, lines, hatches = result.setdefault(layer["index"], ([], [], []))
        for part, vectors in zip(file["parts"], layer["parts"]):
            contours += [points(ring) for ring in vectors["rings"]]
            ends = points(vectors.get("hatches", []))
            (hatches if part["label"].endswith(" hatch") else lines).extend(zip(ends[::2], ends[1::2]))
    return result


@unittest.skipUnless(unary_union, "Shapely is not installed")
class UnreachedTest(ProgramTest):
    def compare(self, seed, kind, pattern):
        numbers = random.Random(seed)
        rule = Rule(numbers, pattern)
        rings = [random_shape(numbers, kind) for _ in range(LAYERS)]
        self.write("tower.obj", tower(rings))
        self.write("rule.toml", rule.text())
        name = f"{kind.__name__}, {pattern}, seed {seed}"
        self.succeed("slice", "tower.obj", "--layer-height", HEIGHT, "--strategy", "rule.toml", "-o", "v.json", "--stats", "s.json")
        stats = json.loads(self.bytes_of("s.json"))
        vectors = vectors_of(json.loads(self.bytes_of("v.json")))
        total = 0
        for index, ring in enumerate(rings):
            shape = Polygon(ring)
            found = stats["layers"][index]["scan"]["unreached_mm2"]
            expected = rule.unreached(shape, vectors.get(index, ([], [], [])))
            total += expected
            self.assertAlmostEqual(found, expected, delta=1e-3 * shape.area + 2e-4, msg=f"{name}, layer {index}")
        checked = self.run_program("verify", "v.json", "--strategy", "rule.toml", "--mesh", "tower.obj", "--json").json()
        found = checked["vectors"]["unreached_mm2"]
        self.assertAlmostEqual(found, total, delta=1e-3 * sum(Polygon(ring).area for ring in rings), msg=name)

    def test_slice_verify_and_shapely_agree(self):
        seeds = range(1000, 1010 if LARGE else 1001)
        for seed in seeds:
            for i, pattern in enumerate(PATTERNS):
                kinds = SHAPES if LARGE else [SHAPES[i]]
                for kind in kinds:
                    with self.subTest(seed=seed, pattern=pattern, kind=kind.__name__):
                        self.compare(seed, kind, pattern)


class CasesTest(ProgramTest):
    """Shapes and numbers that once passed all checks although material had no vector."""

    def job(self, *arguments, mesh="tower.obj", name="v.ovf"):
        """The unreached area of `slice` and of `verify`, and whether the file passes both."""
        stats = ["--stats", "s.json"]
        sliced = self.run_program("slice", mesh, "--scan", *arguments, "-o", name, *stats)
        self.assertEqual(sliced.code, 0, sliced.err)
        of_slice = json.loads(self.bytes_of("s.json"))["scan"]
        strict = self.run_program("slice", mesh, "--scan", *arguments, "--strict", "-o", "strict.ovf").code
        options = [a for i, a in enumerate(arguments) if a != "--layer-height" and arguments[i - 1] != "--layer-height"]
        checked = self.run_program("verify", name, "--scan", *options, "--mesh", mesh, "--json").json()["vectors"]
        return of_slice, checked, strict

    def assert_same(self, of_slice, checked, strict, area):
        self.assertAlmostEqual(of_slice["unreached_mm2"], checked["unreached_mm2"], delta=1e-3 * area)
        self.assertEqual(of_slice["unreached_layers"], checked["unreached_layers"])
        self.assertEqual(strict, 4 if of_slice["unreached_layers"] else 0)
        self.assertEqual(checked["outside"], 0)

    def test_wedges_tapers_and_walls(self):
        degree = math.radians(1)
        shapes = {
            "wedge of 1 degree": ([(0, 0), (10, 0), (10 * math.cos(degree), 10 * math.sin(degree))], []),
            "taper": (wall_along([(0, 0), (10, 0)], [0.19, 0.35]), []),
            "triangle of 2.2 degrees": ([(0, 0), (9, 0), (9, 0.35)], []),
            "wall of 0.28 mm": (turned(wall_along([(0, 0), (10.5, 0)], [0.27, 0.27]), random.Random(1)), []),
            "wall and squares": (wall_along([(0, 0), (4.6, 0)], [0.25, 0.25]),
                                 ["--pattern", "chessboard", "--hatch-distance", "0.2", "--shortest", "0", "--hatch-angle", "41.9993"]),
            "wall and distance 0.08": (wall_along([(0, 0), (4, 0)], [0.26, 0.26]), ["--hatch-distance", "0.08"]),
            "wall and angle 6": (wall_along([(0, 0), (4, 0)], [0.28, 0.28]),
                                 ["--pattern", "lines", "--hatch-distance", "0.17", "--hatch-angle", "6"]),
        }
        for name, (ring, options) in shapes.items():
            with self.subTest(name):
                self.write("tower.obj", tower([ring], 6 * HEIGHT))
                self.assert_same(*self.job("--layer-height", str(HEIGHT), *options), 6 * Polygon(ring).area if unary_union else 6)

    def test_lines_along_narrow_branches_stay_inside(self):
        self.write("tower.obj", tower([BRANCHES], 0.1))
        self.assert_same(*self.job("--layer-height", "0.1", "--contours", "1", "--beam-offset", "0", "--pattern", "hexagons",
                                   "--hatch-distance", "0.33", "--hatch-border", "0.1", "--cell-size", "1", "--shortest", "0.3"), 2)

    def test_bands_that_the_numbers_leave_bare(self):
        self.box("box.stl", "20,20,1")
        for least, options in ((150, ["--hatch-border", "3"]), (150, ["--contours", "2", "--contour-distance", "3"]),
                               (300, ["--hatch-distance", "5"])):
            with self.subTest(options=options):
                of_slice, checked, strict = self.job("--layer-height", "1", *options, mesh="box.stl")
                self.assertGreater(of_slice["unreached_mm2"], least)
                self.assert_same(of_slice, checked, strict, 400)

    def test_walls_exactly_as_thick_as_two_beam_offsets(self):
        numbers = random.Random(7)
        rings = [turned([(0, 0), (10, 0), (10, 0.1), (0, 0.1)], numbers) for _ in range(40)]
        self.write("tower.obj", tower(rings))
        of_slice, checked, strict = self.job("--layer-height", str(HEIGHT))
        self.assertEqual(of_slice["contour_vectors"], checked["contour_vectors"] + checked["hatch_vectors"])
        self.assert_same(of_slice, checked, strict, 40)
        self.assertLess(of_slice["unreached_mm2"], 0.1)

    def test_parts_that_overlap(self):
        self.box("box.stl", "10,10,2")
        result = self.succeed("slice", "box.stl", "box.stl", "--layer-height", "1", "--scan", "-o", "v.ovf")
        self.assertIn("parts overlap in 200 mm2 on 2 layers", result.err)
        self.fail_with(4, "parts overlap", "slice", "box.stl", "box.stl", "--layer-height", "1", "--scan", "--strict", "-o",
                       "s.ovf")

    def test_overlapping_parts_are_united_on_request(self):
        self.box("box.stl", "10,10,2")
        self.box("both.stl", "15,10,2")
        two = ["slice", "box.stl", "box.stl", "--translate", "5,0,0", "--layer-height", "1", "--scan", "--strict"]
        self.fail_with(4, "parts overlap in 100 mm2 on 2 layers, .* unite them by --unite-parts", *two, "-o", "v.ovf")
        self.succeed(*two, "--unite-parts", "-o", "v.ovf", "--stats", "two.json")
        self.succeed("slice", "both.stl", "--layer-height", "1", "--scan", "-o", "one.ovf", "--stats", "one.json")
        two, one = (json.loads(self.bytes_of(f"{name}.json"))["scan"] for name in ("two", "one"))
        self.assertAlmostEqual(two["marked_mm"], one["marked_mm"], places=3)
        self.succeed("verify", "v.ovf", "--scan", "--mesh", "both.stl")
        self.succeed("slice", "box.stl", "box.stl", "--translate", "5,0,0", "--layer-height", "1", "-o", "layers.json")
        self.write("unite.toml", "unite_parts = true\n")
        self.succeed("scan", "layers.json", "--strategy", "unite.toml", "--strict", "-o", "again.ovf")
        self.assertEqual(self.bytes_of("again.ovf"), self.bytes_of("v.ovf"))


if __name__ == "__main__":
    main()
