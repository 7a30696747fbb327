"""lamella slice: what it writes, what it tells, and that nothing but the solid decides the bytes."""

import json
import math
import os
import re

from program import ON_WINDOWS, ProgramTest, binary_stl, box_triangles, main, needs_posix, open_box

STATS_KEYS = ["lamella", "options", "input", "engine", "threads", "seconds", "peak_rss_bytes", "points",
              "contours", "open_chains", "volume_mm3", "hash", "findings", "layers"]
INPUT_KEYS = ["path", "triangles", "vertices", "bbox", "unit", "volume_mm3", "defects"]
DEFECT_KEYS = ["boundary_edges", "nonmanifold_edges", "orientation_conflicts", "duplicate_triangles",
               "degenerate_triangles", "inverted_shells"]
SECONDS_KEYS = ["read", "weld", "link", "slice", "polygon", "scan", "format", "write", "order", "end", "total"]
MATCHING_KEYS = ["searches", "comparisons", "inserted", "by_edge_link", "node_bytes", "bytes"]
CASES = ["new", "front", "back", "link", "close"]
PAPER_ENGINES = ["conventional", "ecc", "ecc-edge-match", "eecc"]
LAYER_KEYS = ["index", "z", "thickness", "contours", "holes", "points", "area_mm2", "perimeter_mm",
              "open_chains", "hash"]


def tilted_steps():
    """Two boxes on one another, 10 x 10 x 2.5 and 5 x 8 x 2.5 mm, rotated by 30 degrees about x."""
    upper = [tuple((x + 2, y + 1, z + 2.5) for x, y, z in t) for t in box_triangles(5, 8, 2.5)]
    cos, sin = math.cos(math.pi / 6), math.sin(math.pi / 6)
    return [tuple((x, cos * y - sin * z, sin * y + cos * z) for x, y, z in t)
            for t in box_triangles(10, 10, 2.5) + upper]


class Slice(ProgramTest):
    def stats(self, *arguments, **keywords):
        return self.succeed("slice", *arguments, "--stats", "-", **keywords).json()

    def test_a_box_gives_layers_of_its_section(self):
        stats = self.stats(self.box(), "--layer-height", "0.5")
        self.assertEqual(len(stats["layers"]), 20)
        for i, layer in enumerate(stats["layers"]):
            self.assertEqual(layer["index"], i)
            self.assertAlmostEqual(layer["z"], 0.25 + 0.5 * i, places=9)
            self.assertAlmostEqual(layer["thickness"], 0.5, places=9)
            self.assertEqual((layer["contours"], layer["holes"], layer["open_chains"]), (1, 0, 0))
            self.assertAlmostEqual(layer["area_mm2"], 600, places=3)
            self.assertAlmostEqual(layer["perimeter_mm"], 100, places=3)
        self.assertAlmostEqual(stats["volume_mm3"], 6000, places=2)
        self.assertAlmostEqual(stats["input"]["volume_mm3"], 6000, places=2)

    def test_statistics_have_exactly_the_documented_keys(self):
        stats = self.stats(self.box(), "--inspect")
        self.assertEqual(list(stats), STATS_KEYS)
        self.assertEqual(list(stats["input"]), INPUT_KEYS)
        self.assertEqual(list(stats["input"]["defects"]), DEFECT_KEYS)
        self.assertEqual(list(stats["seconds"]), SECONDS_KEYS)
        for layer in stats["layers"]:
            self.assertEqual(list(layer), LAYER_KEYS)
            self.assertRegex(layer["hash"], "^[0-9a-f]{16}$")
        self.assertEqual(stats["input"]["vertices"], 8)
        self.assertEqual(stats["input"]["triangles"], 12)
        self.assertEqual(set(stats["input"]["defects"].values()), {0})
        self.assertGreater(stats["peak_rss_bytes"], 1 << 20)
        self.assertGreater(stats["seconds"]["total"], 0)

    def test_nothing_is_welded_unless_asked(self):
        stats = self.stats(self.box())
        self.assertEqual(stats["seconds"]["weld"], 0)
        self.assertIsNone(stats["input"]["vertices"])
        self.assertIsNone(stats["input"]["defects"])

    def test_totals_are_the_sums_of_the_layers(self):
        self.succeed("make", "torus", "-o", "torus.stl")
        stats = self.stats("torus.stl", "--layer-height", "0.7")
        for key in ["points", "contours", "open_chains"]:
            self.assertEqual(stats[key], sum(layer[key] for layer in stats["layers"]))
        self.assertAlmostEqual(stats["volume_mm3"],
                               sum(layer["area_mm2"] * layer["thickness"] for layer in stats["layers"]))
        self.assertTrue(any(layer["holes"] == 1 for layer in stats["layers"]))

    def test_the_summary_says_what_was_done_and_where_the_result_is(self):
        result = self.succeed("slice", self.box(), "-o", "box.cli")
        self.assertIn("12 triangles", result.text)
        self.assertIn("20 x 30 x 10 mm", result.text)
        self.assertIn("100 layers", result.text)
        self.assertIn("box.cli", result.text)
        self.assertEqual(result.err, "")

    def test_every_format_can_be_written_and_read_back(self):
        self.box()
        for name, arguments in {"a.cli": [], "b.cli": ["--short"], "c.cli": ["--format", "cli-ascii"],
                                "d.svg": []}.items():
            with self.subTest(name):
                self.succeed("slice", "box.stl", "-o", name, "--layer-height", "1", *arguments)
                found = self.succeed("info", name, "--json").json()
                self.assertEqual((found["layers"], found["contours"]), (10, 10))
                self.assertAlmostEqual(found["volume_mm3"], 6000, delta=3)

    def test_a_folder_of_svg_files_has_one_for_each_layer(self):
        self.succeed("slice", self.box(), "-o", "layers", "--format", "svg-layers", "--layer-height", "1")
        self.assertEqual(len([p for p in self.path("layers").iterdir() if p.suffix == ".svg"]), 10)

    def test_the_bytes_do_not_depend_on_threads_nor_on_the_order_of_triangles(self):
        self.succeed("make", "torus", "-o", "torus.stl")
        self.succeed("make", "torus", "-o", "mixed.stl", "--shuffle", "7")
        self.assertNotEqual(self.bytes_of("torus.stl"), self.bytes_of("mixed.stl"))
        for extension in ["cli", "svg"]:
            written = set()
            for mesh in ["torus.stl", "mixed.stl"]:
                for threads in [1, 2, 7]:
                    self.succeed("slice", mesh, "-o", f"out.{extension}", "--threads", threads)
                    written.add(self.bytes_of(f"out.{extension}"))
            self.assertEqual(len(written), 1, extension)

    def test_hashes_agree_between_whole_and_part(self):
        self.succeed("make", "torus", "-o", "torus.stl")
        whole = self.stats("torus.stl")["layers"]
        part = self.stats("torus.stl", "--layers", "20:30")["layers"]
        self.assertEqual(part, whole[20:30])

    def test_standard_input_and_output(self):
        self.box()
        self.succeed("slice", "box.stl", "-o", "box.cli")
        result = self.succeed("slice", "-", "-o", "-", "--format", "cli", stdin=self.bytes_of("box.stl"))
        self.assertEqual(result.out, self.bytes_of("box.cli"))
        self.assertIn("100 layers", result.err)

    def test_every_engine_gives_the_same_layers(self):
        self.succeed("make", "torus", "-o", "torus.stl", "--shuffle", "7", "--segments", "32")
        arguments = ["torus.stl", "--rotate", "20,30,0", "--layer-height", "0.5"]
        expected = self.stats(*arguments)
        self.assertEqual(expected["engine"], "sweep")
        for engine in self.engines():
            with self.subTest(engine):
                stats = self.stats(*arguments, "--engine", engine)
                self.assertEqual(stats["engine"], engine)
                self.assertEqual(stats["layers"], expected["layers"])
        self.succeed("slice", "torus.stl", "-o", "sweep.cli")
        self.succeed("slice", "torus.stl", "-o", "eecc.cli", "--engine", "eecc")
        self.assertEqual(self.bytes_of("sweep.cli"), self.bytes_of("eecc.cli"))
        self.fail_with(2, "eecc", "slice", "torus.stl", "-o", "a.cli", "--engine", "eec")

    def test_the_engines_of_the_paper_report_what_they_counted(self):
        self.succeed("make", "sheet", "-o", "sheet.stl", "--holes", "9", "--segments", "16", "--order", "split")
        self.assertNotIn("matching", self.stats("sheet.stl"))
        walls, layers, contours = 2 * 9 * 16 + 8, 30, 10
        for engine in PAPER_ENGINES:
            with self.subTest(engine):
                stats = self.stats("sheet.stl", "--engine", engine)
                self.assertEqual(list(stats), STATS_KEYS[:-2] + ["matching", "findings", "layers"])
                self.assertGreater(stats["seconds"]["weld"], 0)
                matching = stats["matching"]
                self.assertEqual(list(matching), MATCHING_KEYS)
                inserted, linked = matching["inserted"], matching["by_edge_link"]
                self.assertEqual([list(inserted), list(linked)], [CASES, CASES])
                self.assertEqual(sum(inserted.values()), walls * layers)
                self.assertEqual(inserted["close"], contours * layers)
                self.assertGreaterEqual(matching["comparisons"], inserted["back"])
                searches = {"conventional": (walls - contours) * layers, "ecc": walls * layers,
                            "ecc-edge-match": walls + contours * (layers - 1), "eecc": walls + contours * (layers - 1)}
                self.assertEqual(matching["searches"], searches[engine])
                if engine != "conventional":
                    self.assertEqual(matching["searches"] + sum(linked.values()), sum(inserted.values()))

    def test_a_mesh_that_was_inspected_is_not_welded_again(self):
        result = self.succeed("slice", self.box(), "-o", "box.cli", "--engine", "eecc", "--inspect", "--progress",
                              "json")
        events = [json.loads(line) for line in result.err.splitlines()]
        self.assertEqual(sum(e["stage"] == "weld" and e["done"] == 0 for e in events), 1)

    def test_slice_at_moves_the_cuts(self):
        self.box()
        first = {at: self.stats("box.stl", "--slice-at", at, "--layer-height=1")["layers"][0]["z"]
                 for at in ["bottom", "middle", "top"]}
        self.assertEqual(first, {"bottom": 0, "middle": 0.5, "top": 1})

    def test_a_page_snaps_level_faces_like_a_slice_file(self):
        self.write("tilted.stl", binary_stl(tilted_steps()))
        view = ["view", "tilted.stl", "--rotate-x", "-30", "--layer-height", "0.5", "--slice-at", "bottom"]
        self.assertRegex(self.succeed(*view).err, "level faces lie within rounding of a plane .*--snap")
        self.assertEqual(self.succeed(*view, "--snap", "1e-5").err, "")

    def test_a_plane_that_touches_a_knife_edge_loses_nothing(self):
        self.succeed("make", "torus", "-o", "torus.stl")
        result = self.succeed("slice", "torus.stl", "--layer-height", "0.1", "--slice-at", "bottom", "--strict", "-o", "t.json")
        self.assertEqual(result.err, "")
        self.assertEqual(self.succeed("verify", "t.json", "--mesh", "torus.stl", "--slice-at", "bottom").code, 0)

    def test_a_snap_distance_of_half_a_layer_is_refused(self):
        self.succeed("make", "box", "--size", "10", "-o", "box.stl")
        self.succeed("slice", "box.stl", "--snap", "0.0499", "--strict", "-o", "box.json")
        self.succeed("verify", "box.json", "--mesh", "box.stl", "--snap", "0.0499")
        for snap in ["0.05", "1", "1e9"]:
            refused = r"the snap distance is \S+ mm, half of the layer height or more: layer 0 is 0.1 mm high"
            self.fail_with(2, refused, "slice", "box.stl", "--snap", snap, "-o", "lost.json")
            self.fail_with(2, refused, "view", "box.stl", "--layer-height", "0.1", "--snap", snap)
            self.fail_with(2, refused, "verify", "box.json", "--mesh", "box.stl", "--snap", snap)
        self.succeed("slice", "box.stl", "--scan", "-o", "box.ovf")
        self.fail_with(2, refused, "verify", "box.ovf", "--scan", "--mesh", "box.stl", "--snap", "1")
        heights = ["--heights", "0:5=0.5,5:10=1"]
        self.fail_with(2, "layer 0 is 0.5 mm high", "slice", "box.stl", *heights, "--snap", "0.3", "-o", "lost.json")

    def test_level_faces_that_rounding_has_bent_are_warned_of_and_cut_as_faces_where_it_snaps(self):
        self.write("tilted.stl", binary_stl(tilted_steps()))
        options = ["tilted.stl", "--rotate-x", "-30", "--layer-height", "0.5", "--slice-at", "bottom"]
        result = self.succeed("slice", *options, "-o", "tilted.json")
        warning = (r"tilted\.stl: [0-9.]+ mm2 of level faces lie within rounding of a plane in (\d+) of 10 layers, first "
                   r"at z = [0-9.e-]+ mm: .*; --snap (1e-\d) counts them as on the plane\n$")
        self.assertRegex(result.err, "^lamella: warning: " + warning)
        layers, snap = re.search(warning, result.err).groups()
        stats = self.stats(*options)
        self.assertLess(stats["layers"][0]["area_mm2"], 99)
        [near] = stats["near_faces"]
        [found] = stats["findings"]
        self.assertEqual((found["kind"], found["path"], found["layers"]), ("near_faces", near["path"], near["layers"]))
        self.assertEqual(found["amount_mm2"], near["area_mm2"])
        self.assertIn(found["text"], result.err)
        self.assertEqual((near["path"], near["layers"]), ("tilted.stl", int(layers)))
        self.assertGreaterEqual(near["area_mm2"], 100 - 1e-3)
        self.assertLess(near["farthest_mm"], float(snap))
        self.fail_with(4, "tilted.stl: .* of level faces lie within rounding .*--snap", "slice", *options, "-o", "t.cli",
                       "--strict")
        self.assertRegex(self.succeed("verify", "tilted.json", "--mesh", "tilted.stl", "--rotate-x", "-30").text,
                         "mm2 of level faces lie within rounding .*--snap")
        # The two faces of the lower box, and that of the upper one.
        for way in [[], ["--engine", "eecc"], ["--copies", "2"], ["--strict"]]:
            snapped = self.succeed("slice", *options, *way, "--snap", snap, "-o", "snapped.json", "--stats", "stats.json")
            self.assertEqual(snapped.err, "")
            stats = json.loads(self.bytes_of("stats.json"))
            self.assertNotIn("near_faces", stats)
            times = 2 if "--copies" in way else 1
            for layer, area in [(0, 100), (4, 100), (5, 40), (9, 40)]:
                self.assertAlmostEqual(stats["layers"][layer]["area_mm2"], times * area, places=3)
        self.succeed("slice", *options, "--snap", snap, "-o", "snapped.json")
        self.succeed("verify", "snapped.json", "--mesh", "tilted.stl", "--rotate-x", "-30", "--snap", snap)
        # Shards give the same bytes, and so does a mesh that does not fit.
        whole = self.bytes_of("snapped.json")
        for number in range(1, 4):
            self.succeed("slice", *options, "--snap", snap, "--shard", f"{number}/3", "-o", f"{number}.json")
        self.succeed("merge", "merged.json", "1.json", "2.json", "3.json")
        self.assertEqual(self.bytes_of("merged.json"), whole)
        self.fail_with(2, "--snap says how a mesh is cut", "verify", "snapped.json", "--snap", snap)

    def test_the_first_layer_may_have_its_own_height(self):
        layers = self.stats(self.box(), "--layer-height", "1", "--first-layer-height", "2")["layers"]
        self.assertEqual([layers[0]["thickness"], layers[1]["thickness"]], [2, 1])
        self.assertEqual(layers[0]["z"], 1)

    def test_a_range_of_heights_selects_layers(self):
        layers = self.stats(self.box(), "--layer-height", "1", "--z-range", "2:4")["layers"]
        self.assertEqual([layer["index"] for layer in layers], [2, 3])
        layers = self.stats("box.stl", "--layer-height", "1", "--z-range", "7:")["layers"]
        self.assertEqual([layer["index"] for layer in layers], [7, 8, 9])

    def test_a_list_of_heights_says_where_to_cut(self):
        self.box()
        self.write("z.txt", "# heights\n0.25\n\n  1.5 # the second\r\n9e0\n")
        self.write("z.json", "[0.25, 1.5, 9]")
        for name in ["z.txt", "z.json"]:
            layers = self.stats("box.stl", "--z-list", name)["layers"]
            self.assertEqual([layer["z"] for layer in layers], [0.25, 1.5, 9])
        layers = self.stats("box.stl", "--z-list", "z.txt", "--layers", "1:2")["layers"]
        self.assertEqual([(layer["index"], layer["z"]) for layer in layers], [(1, 1.5)])

    def test_a_single_height_makes_a_layer_with_a_thickness_in_every_format(self):
        self.succeed("make", "sphere", "-o", "ball.stl")
        self.write("z.txt", "3\n")
        for at, bottom in {"bottom": 3, "middle": 2.95, "top": 2.9}.items():
            for name in ["ball.cli", "ball.slc", "ball.3mf", "ball.svg", "ball.json"]:
                with self.subTest(name, at=at):
                    self.succeed("slice", "ball.stl", "-o", name, "--z-list", "z.txt", "--slice-at", at)
                    self.succeed("verify", name, "--mesh", "ball.stl", "--slice-at", at)
                    self.succeed("convert", name, "read.json")
                    (layer,) = json.loads(self.bytes_of("read.json"))["layers"]
                    self.assertAlmostEqual(layer["bottom"], bottom, delta=1e-6)
                    self.assertAlmostEqual(layer["top"], bottom + 0.1, delta=1e-6)

    def test_what_single_precision_loses_far_from_the_origin_is_reported(self):
        self.succeed("make", "sphere", "-o", "ball.stl")
        far = ["slice", "ball.stl", "--layer-height", "1", "--translate", "1e7,0,0"]
        for name in ["ball.cli", "ball.slc"]:
            with self.subTest(name):
                told = self.succeed(*far, "-o", name).err
                self.assertRegex(told, r"warning: ball\.\w+: rounding moved points by up to 0\.\d+ mm, merged \d+ of")
                self.fail_with(4, "rounding moved points", *far, "-o", "no" + name, "--strict")
                self.assertEqual(self.succeed("slice", "ball.stl", "-o", name, "--strict").err, "")
        self.succeed(*far, "-o", "ball.svg", "--strict")

    def test_layers_that_single_precision_cannot_distinguish_are_refused(self):
        self.succeed("make", "sphere", "-o", "ball.stl")
        self.fail_with(2, "its top, z = .* mm, is not above the height before it", "slice", "ball.stl", "-o", "x.cli", "--layer-height", "0.1",
                       "--translate", "0,0,1e7")

    def test_placement_is_unit_scale_rotation_translation(self):
        self.box(size="1,2,3")
        stats = self.stats("box.stl", "--unit", "cm", "--scale", "1,1,2", "--rotate", "90,0,0", "--translate",
                           "-1,2,3", "--layer-height=1")
        low, high = stats["input"]["bbox"]
        # 10 x 20 x 60 mm after scaling; a quarter turn about x swaps y and z.
        self.assertEqual([round(h - l, 6) for l, h in zip(low, high)], [10, 60, 20])
        self.assertEqual(stats["options"]["translate"], [-1, 2, 3])
        self.assertEqual(stats["input"]["unit"], "cm")

    def test_turning_about_one_axis_is_turning_about_three_by_nothing_else(self):
        self.box()
        self.assertEqual(self.stats("box.stl", "--rotate-x", "30")["layers"],
                         self.stats("box.stl", "--rotate", "30,0,0")["layers"])

    def test_a_direction_keeps_its_matrix(self):
        stats = self.stats(self.box(), "--direction", "1,0,0", "--layer-height", "1")
        self.assertEqual(len(stats["layers"]), 20)
        self.assertAlmostEqual(stats["layers"][3]["area_mm2"], 300, places=3)
        matrix = stats["options"]["matrix"]
        self.assertEqual(len(matrix), 4)
        # The direction (1, 0, 0) becomes (0, 0, 1).
        self.assertEqual([row[0] for row in matrix], [0, 0, 1, 0])

    def test_a_mirrored_part_keeps_its_material(self):
        stats = self.stats(self.box(), "--scale", "-1,1,1", "--layer-height", "1")
        self.assertAlmostEqual(stats["volume_mm3"], 6000, places=2)

    def test_open_chains_are_counted_and_warned_about(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        result = self.succeed("slice", "open.stl", "-o", "open.cli", "--layer-height", "1")
        self.assertEqual(len(result.err.splitlines()), 1)
        self.assertRegex(result.err, r"^lamella: warning: open\.stl: 10 open chains in 10 of 10 layers")
        self.assertIn("lamella info open.stl", result.err)

    def test_a_job_without_any_contour_is_warned_of(self):
        self.write("box.stl", binary_stl(box_triangles(20, 30, 10)))
        self.write("larger.stl", binary_stl(box_triangles(40, 40, 20)))
        job = ["slice", "box.stl", "larger.stl", "--negative", "--translate=-5,-5,-5", "--layer-height", "1"]
        nothing = "no contour is in any of 10 layers: no plane cuts the mesh, or negative volumes remove all of it"
        self.assertIn(f"box.stl and 1 more file: {nothing}", self.succeed(*job, "-o", "x.json").err)
        self.fail_with(4, nothing, *job, "-o", "y.json", "--strict")

    def test_bodies_that_are_inside_out_are_warned_about_wherever_they_stand(self):
        whole = r"10 rings bound no material in 10 of 10 layers, first at z = 0\.5 mm \(6000 mm3 lost\): .*triangles face inwards"
        self.write("inverted.stl", binary_stl([(a, c, b) for a, b, c in box_triangles(20, 30, 10)]))
        result = self.succeed("slice", "inverted.stl", "-o", "inverted.cli", "--layer-height", "1")
        self.assertRegex(result.err, rf"^lamella: warning: inverted\.stl: {whole}, which --orient corrects, .*; see lamella info inverted\.stl\n$")
        for name, x in [("left", -30), ("right", 40)]:
            inverted = [tuple((px + x, py, pz) for px, py, pz in (a, c, b)) for a, b, c in box_triangles(20, 30, 10)]
            self.write(f"{name}.stl", binary_stl(box_triangles(20, 30, 10) + inverted))
            for words in [["-o", "x.cli"], ["-o", "x.slc"], ["-o", "x.3mf"], ["-o", "x.html"], ["-o", "x.ovf", "--scan"],
                          ["-o", "x.cli", "--offset=-0.1"], ["-o", "x.cli", "--max-memory", "50M"], ["-o", "x.json", "--scan", "--simplify", "0.01"]]:
                result = self.succeed("slice", f"{name}.stl", "--layer-height", "1", *words)
                self.assertRegex(result.err, rf"^lamella: warning: {name}\.stl: {whole}", words)
                if "--max-memory" not in words: # which excludes --orient, as that needs the whole mesh
                    self.assertNotIn(f"{name}.stl", self.succeed("slice", f"{name}.stl", "--layer-height", "1", *words, "--orient").err, words)
            stats = self.stats(f"{name}.stl", "--layer-height", "1", "--threads", "1")
            self.assertEqual([stats["inverted_rings"], stats["inverted_mm3"], stats["volume_mm3"]], [10, 6000, 0])
            self.assertEqual({(layer["inverted_rings"], layer["inverted_mm2"]) for layer in stats["layers"]}, {(1, 600)})
            self.fail_with(4, "1 inverted shell", "slice", f"{name}.stl", "-o", "strict.cli", "--strict")
            # Who says by a rule what is material has said what becomes of them.
            for rule in ["nonzero", "positive"]:
                self.assertEqual(self.succeed("slice", f"{name}.stl", "-o", "x.cli", "--layer-height", "1", "--fill", rule).err, "")
        self.assertNotIn("inverted_rings", self.stats(self.box(), "--layer-height", "1"))
        # A hole is no reason to worry, nor is a part that was mirrored.
        self.succeed("make", "torus")
        self.assertEqual(self.succeed("slice", "torus.stl", "-o", "torus.cli", "--scale", "-1,1,1").err, "")

    def test_strict_refuses_a_defect_before_writing(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        self.fail_with(4, "boundary edges", "slice", "open.stl", "-o", "open.cli", "--strict")
        self.succeed("slice", self.box(), "-o", "box.cli", "--strict")

    def test_figures_alone_need_no_output(self):
        self.box()
        before = self.listing()
        self.stats("box.stl")
        self.assertEqual(self.listing(), before)

    def test_options_of_the_slice_file_say_nothing_without_one(self):
        self.box()
        for words in [["--units-mm", "3"], ["--short"], ["--max-output", "1"], ["--antialias", "3"], ["--format", "cli"]]:
            self.fail_with(2, f"{words[0]} goes with --output", "slice", "box.stl", "--stats", "s.json", *words)

    def test_two_results_do_not_go_to_one_file(self):
        self.box()
        for other in ["./x.json", str(self.path("x.json"))]:
            self.fail_with(2, "--output and --stats contradict", "slice", "box.stl", "-o", "x.json", "--stats", other)
        self.succeed("slice", "box.stl", "-o", "-", "--format", "cli", "--stats", "./-")
        self.write("x.json", "{}")
        self.path("link.json").symlink_to("x.json")
        self.fail_with(2, "--output and --stats contradict", "slice", "box.stl", "-o", "x.json", "--stats", "link.json")

    def test_options_name_all_formats_that_take_them(self):
        self.box()
        self.fail_with(2, "--units-mm goes with the formats cli, cli-ascii, ilt, 3mf-toolpath, not with svg", "slice",
                       "box.stl", "-o", "x.svg", "--units-mm", "0.01")
        self.fail_with(2, "--short goes with the formats cli, ilt, not with svg", "slice", "box.stl", "-o", "x.svg", "--short")

    def test_messages_call_standard_input_by_its_name(self):
        result = self.succeed("slice", "-", "-o", "x.cli", stdin=binary_stl(open_box(20, 30, 10)))
        self.assertRegex(result.err, r"^lamella: warning: standard input: 100 open chains .* mm\n$")
        self.assertIn("read     standard input: 10 triangles", result.text)

    def test_statistics_go_to_a_file_beside_the_result(self):
        self.box()
        result = self.succeed("slice", "box.stl", "-o", "box.cli", "--stats", "box.json")
        self.assertIn("100 layers", result.text)
        self.assertEqual(len(json.loads(self.bytes_of("box.json"))["layers"]), 100)
        self.assertEqual(self.listing(), ["box.cli", "box.json", "box.stl"])

    @needs_posix("permissions")
    def test_statistics_follow_links_and_keep_permissions_as_results_do(self):
        self.box()
        self.path("kept").mkdir()
        for name in ["box.cli", "box.json"]:
            self.write(f"kept/{name}", "old").chmod(0o640)
            self.path(name).symlink_to(f"kept/{name}")
        self.succeed("slice", "box.stl", "-o", "box.cli", "--stats", "box.json")
        for name in ["box.cli", "box.json"]:
            self.assertTrue(self.path(name).is_symlink(), name)
            self.assertEqual(self.path(f"kept/{name}").stat().st_mode & 0o777, 0o640, name)
        self.assertEqual(len(json.loads(self.bytes_of("kept/box.json"))["layers"]), 100)

    def test_a_place_that_takes_no_statistics_is_found_before_anything_is_written(self):
        self.box()
        self.write("box.cli", "old")
        self.fail_with(6, "'nodir' does not exist", "slice", "box.stl", "-o", "box.cli", "--stats", "nodir/s.json")
        self.fail_with(6, "it is a folder", "slice", "box.stl", "-o", "box.cli", "--stats", str(self.folder))
        self.assertEqual(self.bytes_of("box.cli"), b"old")

    @needs_posix("pipes and devices with names")
    def test_statistics_that_fail_at_the_end_leave_a_complete_slice_file_and_say_so(self):
        self.box()
        self.box("page.stl")
        self.fail_after_output("box.cli", "slice", "box.stl", "-o", "box.cli", "--stats", "/dev/full")
        self.fail_after_output("scan.json", "scan", "box.cli", "-o", "scan.json", "--stats", "/dev/full")
        if self.run_program("view", "box.stl").code == 0:
            self.fail_after_output("page.cli", "slice", "page.stl", "-o", "page.cli", "--report", "/dev/full")
        result = self.run_program("slice", "--batch", ".", "-o", "out", "--format", "cli", "--stats", "/dev/full")
        self.assertNotIn("; out/", result.text)  # refused before anything is sliced
        result = self.run_program("slice", "box.stl", "--stats", "/dev/full")
        self.assertRegex(result.err, "cannot write '/dev/full': the disk is full; free some space or choose another place\n$")

    def fail_after_output(self, output, *arguments):
        result = self.run_program(*arguments)
        self.assertEqual(result.code, 6)
        self.assertIn(f"cannot write '/dev/full': the disk is full; free some space or choose another place; {output} is complete\n",
                      result.err)
        self.succeed("info", output)

    def test_g_code_is_no_format_and_the_error_names_programs_that_write_it(self):
        self.box()
        for name in ["out.gcode", "out.GCODE", "out.bgcode"]:
            self.fail_with(2, f"'{name}': Lamella writes layers and scan vectors, and no G-code; programs such as PrusaSlicer and Cura do$",
                           "slice", "box.stl", "-o", name)

    def test_layers_beyond_the_part_are_reported_beside_those_that_there_are(self):
        self.box()
        self.fail_with(2, "this part has layers 0 to 99; 1000:2000 is beyond them$", "slice", "box.stl", "-o", "a.cli", "--layers", "1000:2000")

    def test_one_word_says_that_a_folder_is_no_file(self):
        self.box()
        self.path("folder.cli").mkdir()
        self.fail_with(3, "folder.cli: is a folder, expected a file", "slice", "folder.cli", "-o", "a.cli")
        self.fail_with(6, "folder.cli': it is a folder; give the name of a file", "slice", "box.stl", "-o", "folder.cli")
        for name in ["png", "svg-layers"]:
            self.fail_with(2, f"{name} writes a folder, so standard output is not possible; give the path of a folder",
                           "slice", "box.stl", "-o", "-", "--format", name)

    def test_what_steps_changed_is_summed_up(self):
        self.box()
        command = ["slice", "box.stl", "-o", "a.cli"]
        text = self.succeed(*command, "--offset=-1").text
        self.assertIn("\nchanged  100 layers by --offset: area 60000 to 50400 mm2 in all; no ring lost\n", text)
        text = self.succeed(*command, "--offset=-10", "--layer-height", "5").text
        self.assertIn("\nchanged  2 layers by --offset: area 1200 to 0 mm2 in all; 2 rings lost\n", text)
        self.assertIn("\nchanged  0 layers by --fill\n", self.succeed(*command, "--fill", "nonzero").text)

    def test_a_missing_folder_of_temporary_files_is_named(self):
        self.box()
        self.fail_with(6, r"temporary file in the folder '(Z:\\|/)nonexist'.*TMP", "slice", "box.stl", "-o", "-", "--format", "npz",
                       env=os.environ | {"TMPDIR": "/nonexist"})

    def test_warnings_of_files_name_them(self):
        for name in ["a.stl", "b.stl"]:
            self.write(name, binary_stl(box_triangles(20, 30, 10)) + b"more")
        result = self.succeed("slice", "a.stl", "b.stl", "-o", "plate.cli")
        self.assertEqual([line.split(": ")[2] for line in result.err.splitlines()], ["a.stl", "b.stl"], result.err)

    def test_steps_that_leave_nothing_are_warned_about(self):
        self.box()
        for option in ["--offset=-100", "--min-area=1000"]:
            result = self.succeed("slice", "box.stl", "-o", "box.cli", option)
            self.assertRegex(result.err, r"^lamella: warning: box\.stl: no contour is left in any of 100 layers: .* of 100\n$")
            self.fail_with(4, "no contour is left in any of 100 layers", "slice", "box.stl", "-o", "strict.cli", option, "--strict")
            self.assertFalse(self.path("strict.cli").exists())
        # What leaves some contours, or found none, is as it was asked for.
        self.assertEqual(self.succeed("slice", "box.stl", "-o", "box.cli", "--offset=-1").err, "")

    def test_closed_contours_within_open_ones_need_not_be_inside_out(self):
        # A box with a hollow; the outer wall has a hole.
        hollow = [tuple((x + 5, y + 5, z) for x, y, z in t) for t in box_triangles(10, 10, 10)]
        self.write("open.stl", binary_stl(open_box(20, 30, 10) + [(a, c, b) for a, b, c in hollow]))
        result = self.succeed("slice", "open.stl", "-o", "open.cli", "--layer-height", "1")
        self.assertIn("10 open chains", result.err)
        self.assertIn("10 rings bound no material", result.err)
        self.assertIn("triangles face inwards, which --orient corrects, or contours around them are open", result.err)

    def test_a_list_of_heights_may_begin_with_a_byte_order_mark(self):
        self.box()
        for text in ["1\n2\n", "[1, 2]"]:
            self.write("z.txt", b"\xef\xbb\xbf" + text.encode())
            self.assertEqual([layer["z"] for layer in self.stats("box.stl", "--z-list", "z.txt")["layers"]], [1, 2])

    def test_an_existing_result_is_replaced(self):
        self.box()
        self.write("box.cli", "old")
        self.succeed("slice", "box.stl", "-o", "box.cli")
        self.assertNotEqual(self.bytes_of("box.cli"), b"old")

    def test_progress_as_json_is_one_object_a_line_and_never_falls(self):
        self.succeed("make", "torus", "-o", "torus.stl")
        result = self.succeed("slice", "torus.stl", "-o", "torus.cli", "--progress", "json", "--inspect")
        events = [json.loads(line) for line in result.err.splitlines()]
        self.assertGreater(len(events), 3)
        done, totals = {}, {}
        for event in events:
            self.assertEqual(list(event), ["stage", "done", "total", "seconds"])
            stage = event["stage"]
            self.assertGreaterEqual(event["done"], done.get(stage, 0))
            self.assertLessEqual(event["done"], event["total"])
            self.assertEqual(event["total"], totals.setdefault(stage, event["total"]))
            done[stage] = event["done"]
        self.assertEqual(done, totals)
        self.assertEqual(sorted(e["seconds"] for e in events), [e["seconds"] for e in events])
        self.assertIn("slice", done)

    def test_with_json_progress_warnings_are_objects_too(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        result = self.succeed("slice", "open.stl", "-o", "open.cli", "--progress", "json")
        events = [json.loads(line) for line in result.err.splitlines()]
        self.assertEqual(sum("warning" in event for event in events), 1)
        result = self.run_program("slice", "open.stl", "-o", "open2.cli", "--progress", "json", "--strict")
        last = json.loads(result.err.splitlines()[-1])
        self.assertEqual((result.code, last["exit_code"]), (4, 4))

    def test_there_is_no_progress_where_standard_error_is_no_terminal(self):
        self.assertEqual(self.succeed("slice", self.box(), "-o", "box.cli", "--layer-height=0.001").err, "")

    def test_names_of_files_may_be_anything(self):
        names = ["čřšřěá.stl", "with blanks.stl", "-dash.stl", "quote'.stl"]
        if not ON_WINDOWS:  # which does not permit these
            names += ["new\nline.stl", "quote\"'.stl"]
        for name in names:
            with self.subTest(name):
                self.write(name, binary_stl(box_triangles(20, 30, 10)))
                result = self.succeed("slice", "--stats", "-", "--layer-height=1", "--", name)
                self.assertEqual(result.json()["input"]["path"], name)
                self.succeed("slice", "-o", f"{name}.cli", "--", name)
        if ON_WINDOWS:
            return
        self.write(b"latin-\xe9.stl".decode("utf-8", "surrogateescape"), binary_stl(box_triangles(1, 1, 1)))
        result = self.succeed("slice", b"latin-\xe9.stl".decode("utf-8", "surrogateescape"), "--stats", "-")
        self.assertIn("latin-", result.json()["input"]["path"])

    def test_the_locale_changes_nothing(self):
        self.box()
        outputs = set()
        for locale in ["C", "de_DE.UTF-8", "tr_TR.UTF-8"]:
            stats = self.succeed("slice", "box.stl", "-o", "-", "--format", "cli-ascii", "--layer-height", "0.3",
                                 env={"LC_ALL": locale}).out
            outputs.add(stats)
        self.assertEqual(len(outputs), 1)

    def test_the_volume_tends_to_that_of_the_mesh(self):
        self.succeed("make", "sphere", "-o", "ball.stl", "--size", "20")
        stats = self.stats("ball.stl", "--layer-height", "0.01")
        self.assertTrue(math.isclose(stats["volume_mm3"], stats["input"]["volume_mm3"], rel_tol=1e-5))

    def test_numbers_in_the_summary_are_readable(self):
        self.succeed("make", "torus", "-o", "torus.stl", "--segments", "256")
        self.assertTrue(re.search(r"\d,\d{3} triangles", self.succeed("slice", "torus.stl", "-o", "t.cli").text))


if __name__ == "__main__":
    main()
