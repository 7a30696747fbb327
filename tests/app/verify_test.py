"""lamella verify: a right file passes, each kind of wrong file does not."""

import json
import math

from program import ProgramTest, binary_stl, box_triangles, main

KEYS = ["path", "ok", "warnings", "layers", "contours", "open_chains", "crossings", "misoriented", "overlapping",
        "volume_mm3", "max_area_error_mm2", "displaced", "height_overlaps", "hatches", "heights", "findings",
        "hint"]


def ascii_cli(*polylines):
    """One layer of 1 mm with the given (direction, points)."""
    lines = ["$$HEADERSTART", "$$ASCII", "$$UNITS/1", "$$VERSION/200", "$$LABEL/1,part", "$$LAYERS/000002",
             "$$HEADEREND", "$$GEOMETRYSTART", "$$LAYER/0.0", "$$LAYER/1.0"]
    for direction, points in polylines:
        numbers = ",".join(f"{float(c)}" for p in points for c in p)
        lines.append(f"$$POLYLINE/1,{direction},{len(points)},{numbers}")
    return "\n".join(lines + ["$$GEOMETRYEND", ""])


def walls(points, height):
    """Of a body around these points, or of a hole where they run clockwise: no floors, which cuts do not need."""
    for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1]):
        yield (ax, ay, 0), (bx, by, 0), (bx, by, height)
        yield (ax, ay, 0), (bx, by, height), (ax, ay, height)


def pyramid(size, height):
    """A frustum of four sides: at height h each stands 0.8 h inwards, for a size twice the height."""
    top = [(0.4 * size, 0.4 * size, height), (0.6 * size, 0.4 * size, height), (0.6 * size, 0.6 * size, height),
           (0.4 * size, 0.6 * size, height)]
    base = [(0, 0, 0), (size, 0, 0), (size, size, 0), (0, size, 0)]
    yield base[0], base[2], base[1]
    yield base[0], base[3], base[2]
    yield top[0], top[1], top[2]
    yield top[0], top[2], top[3]
    for i in range(4):
        j = (i + 1) % 4
        yield base[i], base[j], top[j]
        yield base[i], top[j], top[i]


def even_triangles(n, angle=0.3, more=0.1):
    """Of sides of some 8.7 mm, side by side, each turned by so much more."""
    for k in range(n):
        angles = [angle + more * k + i * math.tau / 3 for i in range(3)]
        yield [(20 * k + 5 * math.cos(a), 5 * math.sin(a)) for a in angles]


SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)]
SMALL = [(2, 2), (4, 2), (4, 4), (2, 4), (2, 2)]


class Vectors(ProgramTest):
    OPTIONS = ["--layer-height", "0.5", "--contours", "2", "--skin-layers", "2"]

    def verify(self, *arguments, code=0):
        result = self.run_program("verify", "--json", *arguments)
        self.assertEqual(result.code, code, result.err)
        found = result.json()
        self.assertEqual(list(found), ["path", "ok", "warnings", "vectors"])
        self.assertEqual(found["ok"], code == 0)
        return found["vectors"]

    def setUp(self):
        super().setUp()
        self.succeed("make", "rook", "-o", "rook.stl")

    def test_what_was_scanned_is_right_in_every_format(self):
        counts = set()
        for extension in ["cli", "json", "npz", "ilt", "ovf"]:
            with self.subTest(extension):
                job = f"job.{extension}"
                self.succeed("slice", "rook.stl", "--scan", *self.OPTIONS, "-o", job)
                found = self.verify(job, "--mesh", "rook.stl", "--scan", *self.OPTIONS[2:])
                counts.add((found["contour_vectors"], found["hatch_vectors"]))
                self.assertEqual(found["unreached_layers"], 0)
                self.assertIsNone(self.verify(job)["unreached_mm2"])
        self.assertEqual(len(counts), 1)

    def test_every_pattern_fills_its_region(self):
        for pattern in ["lines", "meander", "chessboard", "hexagons"]:
            with self.subTest(pattern):
                options = ["--pattern", pattern, "--skin-layers", "2"]
                self.succeed("slice", "rook.stl", "--layer-height", "1", "--scan", *options, "-o", "job.cli")
                self.verify("job.cli", "--mesh", "rook.stl", "--scan", *options)

    def test_holes_with_corners_of_60_degrees_that_were_rounded_are_right(self):
        # At the limit of mitres the last digit decides whether a tip is cut off, alike in holes that are turned alike.
        options = ["--scan", "--contours", "3", "--contour-distance", "0.3"]
        for angle in [0.6, 0.7, 0.9, 1.1]:
            triangles = list(walls([(-10, -10), (240, -10), (240, 10), (-10, 10)], 1))
            for hole in even_triangles(12, angle, 0):
                triangles += walls(hole[::-1], 1)
            self.write("plate.stl", binary_stl(triangles))
            self.succeed("slice", "plate.stl", "-o", "plate.svg")
            self.succeed("scan", "plate.svg", "-o", "job.cli", *options[1:])
            self.verify("job.cli", "--mesh", "plate.stl", "--tolerance", "0.001", *options)

    def test_another_strategy_or_mesh_is_noticed(self):
        self.succeed("slice", "rook.stl", "--scan", *self.OPTIONS, "-o", "job.ilt")
        right = ["--mesh", "rook.stl", "--scan", *self.OPTIONS[2:]]
        self.assertGreater(self.verify("job.ilt", *right, "--hatch-border", "0.1", code=4)["outside"], 1000)
        self.assertGreater(self.verify("job.ilt", *right, "--shortest", "0.3", code=4)["too_short"], 10)
        self.assertGreater(self.verify("job.ilt", *right, "--hatch-distance", "0.05", code=4)["unreached_layers"], 10)
        self.assertGreater(self.verify("job.ilt", *right, "--rotate-x", "180", code=4)["outside"], 1000)
        text = self.run_program("verify", "job.ilt", *right, "--hatch-border", "0.1").text
        self.assertRegex(text, r"(?m)^  [\d]+ vectors are nearer to the edge of the material than the strategy says.*; the first in layer 0 ")

    def test_what_was_made_of_the_layers_is_checked(self):
        compensated = ["--offset=-0.2", "--offset-corners", "round"]
        self.succeed("slice", "rook.stl", "--layer-height", "1", *compensated, "-o", "layers.npz")
        self.succeed("slice", "rook.stl", "--layer-height", "1", *compensated, "--scan", "-o", "job.cli")
        for name in ["layers.npz", "job.cli"]:
            self.succeed("verify", name, "--mesh", "rook.stl", *compensated)
        thinned = ["--rotate-x", "30", "--simplify", "0.05"]
        self.succeed("slice", "rook.stl", "--layer-height", "0.5", *thinned, "-o", "thinned.cli")
        self.succeed("verify", "thinned.cli", "--mesh", "rook.stl", *thinned)
        self.assertEqual(self.run_program("verify", "layers.npz", "--mesh", "rook.stl").code, 4)
        self.assertEqual(self.run_program("verify", "layers.npz", "--mesh", "rook.stl", "--offset=-0.201").code, 4)
        self.assertIn("--mesh part.stl", self.run_program("verify", "layers.npz", *compensated).err)

    def test_simplified_contours_have_their_lines_granted(self):
        self.succeed("make", "cylinder", "-o", "cylinder.stl")
        steps = ["--simplify", "0.3", "--scan", "--pattern", "lines", "--hatch-distance", "0.05", "--shortest", "0.02"]
        self.succeed("slice", "cylinder.stl", "--layer-height", "5", *steps, "-o", "job.json")
        self.verify("job.json", "--mesh", "cylinder.stl", *steps)

    def test_regions_that_a_file_has_nothing_of_have_their_slack(self):
        self.succeed("make", "box", "--size", "3,0.3,0.1", "-o", "thin.stl")
        rule = 'distance = 0.05\nborder = {}\nshortest = 0\npattern = "meander"\n'
        self.write("thin.toml", f"accepted_mm2 = 1\n[hatch]\n{rule.format(0)}[downskin]\nlayers = 1\n[downskin.hatch]\n{rule.format(0.15)}")
        for name in ["job.json", "job.ovf"]:
            self.succeed("slice", "thin.stl", "--strategy", "thin.toml", "-o", name)
            self.verify(name, "--strategy", "thin.toml")

    def test_a_cut_rounded_to_beside_the_mesh_is_compared_with_what_is_there(self):
        self.succeed("make", "box", "--size", "5", "--translate", "0,0,0.3", "-o", "box.stl")
        self.succeed("slice", "box.stl", "--slice-at", "bottom", "--layer-height", "0.5", "--scan", "-o", "job.cli")
        self.verify("job.cli", "--mesh", "box.stl", "--slice-at", "bottom", "--scan")

    def test_files_that_say_where_layers_were_cut_are_believed(self):
        self.succeed("make", "box", "--size", "1,1,5", "--translate", "0,0,-2", "-o", "box.stl")
        self.succeed("slice", "box.stl", "--layer-height", "0.1", "--slice-at", "top", "-o", "top.json")
        self.succeed("verify", "top.json", "--mesh", "box.stl", "--slice-at", "top")

    def test_a_part_of_the_layers_has_the_lines_of_the_whole(self):
        self.succeed("slice", "rook.stl", "--scan", "--layers", "40:60", "-o", "part.cli")
        self.verify("part.cli", "--mesh", "rook.stl", "--scan")

    def test_only_what_was_checked_is_reported(self):
        self.succeed("slice", "rook.stl", "--layer-height", "1", "--scan", "--contours", "0", "-o", "job.cli")
        text = self.succeed("verify", "job.cli").text
        self.assertIn("no closed contour around them", text)
        self.assertNotIn("lie within the outermost contours", text)
        self.assertIn("was not checked", text)
        self.assertIn("all vectors lie within rook.stl", self.succeed("verify", "job.cli", "--mesh", "rook.stl").text)

    def test_layers_know_no_strategy(self):
        self.succeed("slice", "rook.stl", "--layer-height", "1", "-o", "rook.cli")
        result = self.run_program("verify", "rook.cli", "--contours", "2")
        self.assertEqual(result.code, 4)
        self.assertRegex(result.err, r"rook\.cli: the check failed")
        self.assertIn("there are no scan vectors, and the strategy makes some", result.text)

    def test_a_job_without_vectors_has_one_exit_code(self):
        self.write("hair.stl", binary_stl(box_triangles(0.01, 6, 4)))
        for name in ("hair.cli", "hair.ilt", "hair.ovf", "hair.build.3mf", "hair.json", "hair.npz"):
            format = ["--format", "3mf-toolpath"] if name.endswith("3mf") else []
            self.succeed("slice", "hair.stl", "--layer-height", "1", "--scan", "-o", name, *format)
            self.assertEqual(self.run_program("verify", name, "--scan").code, 4, name)


class Verify(ProgramTest):
    def verify(self, *arguments, code=0, **keywords):
        result = self.run_program("verify", "--json", *arguments, **keywords)
        self.assertEqual(result.code, code, result.err)
        found = result.json()
        self.assertEqual(list(found), KEYS + (["open_layers"] if found["open_chains"] else []))
        self.assertEqual(found["ok"], code == 0)
        return found

    def test_what_was_sliced_is_right(self):
        self.succeed("make", "torus", "-o", "torus.stl")
        for name in ["torus.cli", "torus.svg"]:
            for arguments in [[], ["--rotate-x", "90"], ["--direction", "1,1,0"]]:
                with self.subTest(name, arguments=arguments):
                    self.succeed("slice", "torus.stl", "-o", name, "--layer-height", "0.4", *arguments)
                    found = self.verify(name, "--mesh", "torus.stl", *arguments)
                    self.assertIsNotNone(found["max_area_error_mm2"])
                    self.assertIsNone(self.verify(name)["max_area_error_mm2"])

    def test_corners_of_60_degrees_that_were_rounded_before_they_were_moved_are_right(self):
        self.write("part.stl", binary_stl([t for triangle in even_triangles(12) for t in walls(triangle, 1)]))
        self.succeed("slice", "part.stl", "-o", "part.svg")
        for offset, code in [("0.3", 0), ("0.29", 4)]:
            self.succeed("convert", "part.svg", "moved.svg", "--offset", offset)
            self.verify("moved.svg", "--mesh", "part.stl", "--offset", "0.3", code=code)

    def test_cuts_at_the_bottom_and_at_the_top(self):
        self.succeed("make", "sphere", "-o", "ball.stl")
        for at in ["bottom", "middle", "top"]:
            with self.subTest(at):
                self.succeed("slice", "ball.stl", "-o", "ball.cli", "--slice-at", at, "--layer-height", "0.5")
                self.verify("ball.cli", "--mesh", "ball.stl", "--slice-at", at)
        self.verify("ball.cli", "--mesh", "ball.stl", "--slice-at", "bottom", code=4)

    def test_cuts_that_a_format_does_not_keep_are_reported_and_their_cure_is_named(self):
        self.succeed("make", "rook", "-o", "rook.stl")
        for where in ["top", "bottom"]:
            for name in ["a.cli", "a.slc", "a.3mf"]:
                with self.subTest(where=where, name=name):
                    options = ["slice", "rook.stl", "--layer-height", "2", "--slice-at", where, "-o", name]
                    err = self.succeed(*options).err
                    self.assertRegex(err, rf"{name}: \d+ layers were cut at the {where}, the lowest at z = .* json and npz")
                    self.path(name).unlink()
                    self.fail_with(4, f"layers were cut at the {where}", *options, "--strict")
                    self.succeed(*options)
                    found = self.run_program("verify", name, "--mesh", "rook.stl")
                    self.assertEqual(found.code, 4)
                    self.assertIn(f"does not keep where layers were cut; the middle was assumed: add --slice-at {where}",
                                  found.text)
                    self.assertNotIn("--tolerance", found.text)
                    self.assertIn(where, self.run_program("verify", name, "--mesh", "rook.stl", "--json").json()["hint"])
                    self.succeed("verify", name, "--mesh", "rook.stl", "--slice-at", where)
        for name in ["a.json", "a.npz", "a.svg"]:
            self.assertEqual(self.succeed("slice", "rook.stl", "--slice-at", "top", "--snap", "1e-6", "--strict", "-o", name).err, "")

    def test_listed_cuts_that_a_format_does_not_keep_are_reported(self):
        self.succeed("make", "rook", "-o", "rook.stl")
        self.write("z.txt", "1\n2\n4\n5\n9\n")
        result = self.succeed("slice", "rook.stl", "--z-list", "z.txt", "-o", "a.cli")
        self.assertRegex(result.err, r"3 layers were cut elsewhere than in the middle, the lowest at z = 2 mm")
        found = self.run_program("verify", "a.cli", "--mesh", "rook.stl")
        self.assertEqual(found.code, 4)
        self.assertIn("cli does not keep where layers were cut; the middle was assumed: where they were", found.text)
        self.succeed("slice", "rook.stl", "--z-list", "z.txt", "-o", "a.json", "--strict")
        self.succeed("verify", "a.json", "--mesh", "rook.stl")

    def test_tops_with_a_box_of_planes_are_tops(self):
        self.write("frustum.stl", binary_stl(list(pyramid(20, 10))))
        planes = "".join(f"$$LAYER/{100 * i}\n$$POLYLINE/1,1,5," + ",".join(
            f"{x}" for x in [80 * i, 80 * i, 20000 - 80 * i, 80 * i, 20000 - 80 * i, 20000 - 80 * i, 80 * i,
                             20000 - 80 * i, 80 * i, 80 * i]) + "\n" for i in range(1, 100))
        for box in ["0,0,0.1,20,20,9.9", "0,0,0.1,20,20,10"]:
            with self.subTest(box):
                self.write("tops.cli", f"$$HEADERSTART\n$$ASCII\n$$UNITS/0.001\n$$LABEL/1,part\n$$DIMENSION/{box}\n"
                                       f"$$HEADEREND\n$$GEOMETRYSTART\n{planes}$$GEOMETRYEND\n")
                # By the second box the heights are bottoms, which is a guess: the option knows better.
                self.succeed("verify", "tops.cli", "--mesh", "frustum.stl", "--slice-at", "top", "--strict")

    def test_formats_that_keep_cuts_keep_the_rule_of_the_plane(self):
        self.succeed("make", "rook", "-o", "rook.stl")
        for name, other in {"rook.json": "other.npz", "rook.npz": "other.json", "rook.svg": "other.svg"}.items():
            for at in ["bottom", "middle", "top"]:
                with self.subTest(name, at=at):
                    self.succeed("slice", "rook.stl", "-o", name, "--slice-at", at, "--layer-height", "1")
                    self.verify(name, "--mesh", "rook.stl")
                    self.succeed("convert", name, other)
                    self.verify(other, "--mesh", "rook.stl")

    def test_single_precision_of_a_format_is_granted(self):
        self.succeed("make", "rook", "-o", "rook.stl")
        self.succeed("slice", "rook.stl", "-o", "rook.slc", "--layer-height", "1")
        self.verify("rook.slc", "--mesh", "rook.stl")

    def test_another_mesh_is_noticed(self):
        self.succeed("slice", self.box(), "-o", "box.cli")
        self.box("wider.stl", "21,30,10")
        found = self.verify("box.cli", "--mesh", "wider.stl", code=4)
        self.assertGreater(found["max_area_error_mm2"], 20)

    def test_layers_that_are_missing_are_reported(self):
        self.box(size="20,30,2")
        self.succeed("slice", "box.stl", "-o", "low.json", "--layer-height", "0.1", "--layers", ":5")
        self.assertEqual(self.verify("low.json", "--mesh", "box.stl")["heights"]["layers"], [0, 0.5])
        self.assertRegex(self.succeed("verify", "low.json", "--mesh", "box.stl").text,
                         r"layers from z = 0 to 0\.5 mm, of a mesh from 0 to 2 mm: 25 % of its height")
        self.succeed("slice", "box.stl", "-o", "all.json", "--layer-height", "0.1")
        job = json.loads(self.bytes_of("all.json"))
        del job["layers"][7]
        self.write("gap.json", json.dumps(job))
        self.assertEqual(self.verify("gap.json", "--mesh", "box.stl", code=4)["heights"]["gaps"], 1)
        self.assertIn("a gap between layers", self.run_program("verify", "gap.json", "--mesh", "box.stl").text)

    def test_layers_beyond_the_mesh_are_reported(self):
        self.succeed("make", "box", "--size", "20,20,53.15", "-o", "high.stl")
        self.succeed("make", "box", "--size", "20,20,20", "-o", "low.stl")
        self.succeed("slice", "high.stl", "-o", "high.cli")
        text = self.run_program("verify", "high.cli", "--mesh", "low.stl").text
        self.assertIn("  layers from z = 0 to 53.1 mm, of a mesh from 0 to 20 mm: 100 % of its height; 331 layers lie above it\n", text)
        self.assertIn("400 mm2 instead of 0 mm2, 400 mm2 off", text)
        found = self.run_program("verify", "high.cli", "--mesh", "low.stl", "--translate", "0,0,30", "--json").json()["heights"]
        self.assertEqual((found["layers_above"], found["layers_below"]), (31, 300))
        self.assertNotIn("above it", self.succeed("verify", "high.cli", "--mesh", "high.stl").text)

    def test_a_sound_file_from_elsewhere(self):
        self.write("a.cli", ascii_cli((1, SQUARE), (0, SMALL[::-1])))
        found = self.verify("a.cli")
        self.assertEqual((found["contours"], found["misoriented"], found["crossings"]), (2, 0, 0))
        self.assertAlmostEqual(found["volume_mm3"], 96)

    def test_layers_that_overlap_in_height_are_noticed(self):
        self.succeed("make", "box", "--size", "6,5,1", "-o", "box.stl")
        self.succeed("slice", "box.stl", "-o", "right.json")
        layers = json.loads(self.bytes_of("right.json"))
        layers["layers"][3]["top"] += 0.03
        self.write("wrong.json", json.dumps(layers))
        for mesh in ([], ["--mesh", "box.stl"]):
            result = self.run_program("verify", "wrong.json", *mesh)
            self.assertEqual(result.code, 4, result.err)
            self.assertIn(b"1 layer begins within the height of another one: layer 4 (z 0.45 mm) begins at "
                          b"z = 0.4 mm, layer 3 (z 0.35 mm) ends at 0.43 mm", result.out)

    def test_layers_that_were_rounded_before_need_a_tolerance(self):
        self.succeed("make", "sphere", "--size", "3", "-o", "ball.stl")
        self.succeed("slice", "ball.stl", "-o", "ball.cli")
        self.succeed("convert", "ball.cli", "ball.json")
        wrong = self.run_program("verify", "ball.json", "--mesh", "ball.stl")
        self.assertEqual(wrong.code, 4)
        self.assertIn(b"say by how much with --tolerance", wrong.out)
        self.assertRegex(self.run_program("verify", "ball.json", "--mesh", "ball.stl", "--json").json()["findings"][0],
                         "^30 layers are of another area .* mm2 off$")
        self.succeed("verify", "ball.json", "--mesh", "ball.stl", "--tolerance", "0.0005")
        self.succeed("make", "sphere", "--size", "3.1", "-o", "larger.stl")
        self.assertEqual(
            self.run_program("verify", "ball.json", "--mesh", "larger.stl", "--tolerance", "0.0005").code, 4)
        self.fail_with(2, "negative", "verify", "ball.json", "--tolerance=-1")

    def test_what_was_warned_of_is_reported_and_counts_if_asked(self):
        text = ascii_cli((1, SQUARE)).replace("$$LAYERS/000002", "$$LAYERS/000003")
        self.write("odd.cli", text)
        found = self.run_program("verify", "--json", "odd.cli")
        self.assertEqual(found.code, 0, found.err)
        self.assertRegex(found.json()["warnings"][0], "announces 3 layers")
        strict = self.run_program("verify", "--strict", "odd.cli")
        self.assertEqual(strict.code, 4)
        self.assertIn(b"announces 3 layers", strict.out)
        self.write("even.cli", ascii_cli((1, SQUARE)))
        self.succeed("verify", "--strict", "even.cli")

    def test_lines_that_no_exposure_has_are_reported(self):
        text = ascii_cli((1, SQUARE)).replace("$$GEOMETRYEND", "$$HATCHES/1,1,1.0,1.0,90.0,1.0\n$$GEOMETRYEND")
        self.write("lines.cli", text)
        result = self.succeed("verify", "lines.cli")
        self.assertIn(b"1 hatch line was not checked", result.out)
        self.assertEqual(self.succeed("verify", "--json", "lines.cli").json()["hatches"], 1)

    def test_an_open_chain(self):
        self.write("a.cli", ascii_cli((2, SQUARE[:3])))
        found = self.verify("a.cli", code=4)
        self.assertEqual(found["open_chains"], 1)
        self.assertEqual([layer["open_gaps"] for layer in found["open_layers"]], [1])

    def test_a_hole_that_runs_the_wrong_way(self):
        self.write("a.cli", ascii_cli((0, SQUARE[::-1])))
        self.assertEqual(self.verify("a.cli", code=4)["misoriented"], 1)

    def test_a_body_within_another_is_reported_and_is_no_error(self):
        inner = [(2, 2), (8, 2), (8, 8), (2, 8), (2, 2)]
        self.write("a.cli", ascii_cli((1, SQUARE), (1, inner)))
        found = self.verify("a.cli")
        self.assertEqual((found["overlapping"], found["misoriented"]), (1, 0))

    def test_contours_that_cross(self):
        shifted = [(x + 5, y + 5) for x, y in SQUARE]
        self.write("a.cli", ascii_cli((1, SQUARE), (1, shifted)))
        self.assertEqual(self.verify("a.cli", code=4)["crossings"], 2)

    def test_the_text_says_whether_all_is_well(self):
        self.succeed("slice", self.box(), "-o", "box.cli")
        self.assertRegex(self.succeed("verify", "box.cli", "--mesh", "box.stl").text, r"^box\.cli: ok\n")
        self.write("a.cli", ascii_cli((2, SQUARE[:3])))
        result = self.run_program("verify", "a.cli")
        self.assertEqual(result.code, 4)
        self.assertRegex(result.text, r"^a\.cli: NOT ok\n")
        self.assertRegex(result.err, r"^lamella: error: a\.cli: ")

    def test_where_a_mesh_stands_needs_a_mesh(self):
        self.write("a.cli", ascii_cli((1, SQUARE)))
        self.fail_with(2, "--mesh", "verify", "a.cli", "--rotate-x", "90")
        self.fail_with(3, "nowhere", "verify", "nowhere.cli")
        self.fail_with(3, "nowhere", "verify", "a.cli", "--mesh", "nowhere.stl")
        self.fail_with(2, "standard input", "verify", "-", "--mesh", "-")

    def test_a_mesh_is_no_slice_file(self):
        self.fail_with(3, r"box\.stl", "verify", self.box())


if __name__ == "__main__":
    main()
