"""What is made of layers between slicing and writing, from the command line: --fill, --offset, --largest-only and so on."""

import json
import math

from program import ProgramTest, binary_stl, box_triangles, main


def moved(triangles, x, y):
    return [tuple((px + x, py + y, pz) for px, py, pz in triangle) for triangle in triangles]


class LayerSteps(ProgramTest):
    def setUp(self):
        super().setUp()
        # 20 x 30, another one that shares 10 x 10 with it, and a speck of 2 x 1; 10 high.
        box = box_triangles(20, 30, 10)
        self.write("heap.stl", binary_stl(box + moved(box, 10, 20) + moved(box_triangles(2, 1, 10), 50, 0)))
        self.write("inside_out.stl", binary_stl([t[::-1] for t in box]))

    def stats(self, *options, part="heap.stl"):
        return self.succeed("slice", part, "--layer-height", "1", *options, "--stats", "-").json()

    def assert_areas(self, stats, area):
        for layer in stats["layers"]:
            self.assertAlmostEqual(layer["area_mm2"], area, places=6)
        self.assertAlmostEqual(stats["volume_mm3"], 10 * area, places=5)

    def test_nothing_is_made_of_them_unasked(self):
        stats = self.stats()
        self.assert_areas(stats, 1202)
        self.assertNotIn("changes", stats)

    def test_fill_rules(self):
        for rule, area in {"nonzero": 1102, "positive": 1102, "evenodd": 1002, "none": 1202}.items():
            with self.subTest(rule=rule):
                stats = self.stats("--fill", rule)
                self.assert_areas(stats, area)
                self.assertEqual(stats["options"]["fill"], rule)
        changes = self.stats("--fill", "nonzero")["changes"]
        self.assertEqual((changes["changed_layers"], changes["groups_united"], changes["rings_united"]), (10, 10, 20))
        self.assertAlmostEqual(changes["area_before_mm2"] - changes["area_after_mm2"], 1000, places=6)

    def test_a_layer_of_several_parts_counts_once(self):
        parts = ["heap.stl", "heap.stl", "--layer-height", "1"]
        changes = self.succeed("slice", *parts, "--fill", "nonzero", "--stats", "-").json()["changes"]
        self.assertEqual((changes["changed_layers"], changes["rings_united"]), (10, 40))
        self.succeed("slice", *parts, "-o", "two.json")
        done = self.succeed("convert", "two.json", "--fill", "nonzero", "united.json")
        self.assertIn("changed 10 layers by --fill: area ", done.text)

    def test_a_body_inside_out_is_turned_or_dropped(self):
        self.assert_areas(self.stats("--fill", "nonzero", part="inside_out.stl"), 600)
        self.assert_areas(self.stats("--fill", "positive", part="inside_out.stl"), 0)
        self.assertEqual(self.stats("--fill", "nonzero", part="inside_out.stl")["changes"]["rings_reversed"], 10)

    def test_offsets(self):
        self.assert_areas(self.stats("--offset", "1"), 2 * 22 * 32 - 12 * 12 + 4 * 3)
        self.assert_areas(self.stats("--offset", "-1"), 2 * 18 * 28 - 8 * 8)

    def test_the_first_layers_shrink(self):
        self.succeed("make", "box", "--size", "10,20,2", "--translate", "0,0,3", "-o", "block.stl")
        cut = ["slice", "block.stl", "--layer-height", "0.5"]
        self.succeed(*cut, "--bottom-offset", "0.4:1", "--stats", "stats.json", "-o", "block.json")
        areas = [layer["area_mm2"] for layer in json.loads(self.path("stats.json").read_text())["layers"]]
        for area, inset in zip(areas, [0.3, 0.1, 0, 0]):  # cut at 0.25 and 0.75 mm above the plate
            self.assertAlmostEqual(area, (10 - 2 * inset) * (20 - 2 * inset), delta=1e-6)
        self.succeed("verify", "block.json", "--mesh", "block.stl", "--bottom-offset", "0.4:1")
        self.assertEqual(self.run_program("verify", "block.json", "--mesh", "block.stl").code, 4)
        self.succeed(*cut, "-o", "plain.json")
        self.succeed("convert", "plain.json", "shrunk.json", "--bottom-offset", "0.4:1")
        self.succeed("compare", "shrunk.json", "block.json")
        for wrong in ["0.4", "0:1", "0.4:0", "-1:1", "a:b"]:
            self.fail_with(2, "--bottom-offset", *cut, "-o", "x.json", f"--bottom-offset={wrong}")

    def test_corners_of_offsets(self):
        mitred = 2 * 22 * 32 - 12 * 12 + 4 * 3
        self.assert_areas(self.stats("--offset", "1", "--offset-corners", "mitre"), mitred)
        self.assert_areas(self.stats("--offset", "1", "--offset-corners", "bevel"), mitred - 10 * 0.5)
        for layer in self.stats("--offset", "1", "--offset-corners", "round")["layers"]:
            self.assertAlmostEqual(layer["area_mm2"], mitred - 10 * (1 - math.pi / 4), delta=0.02)
        self.fail_with(2, "--offset-corners goes with --offset or --bottom-offset", "slice", "heap.stl", "--offset-corners", "round", "-o", "x.cli")

    def test_the_largest_body_and_the_smallest_area(self):
        self.assert_areas(self.stats("--fill", "nonzero", "--largest-only"), 1100)
        self.assert_areas(self.stats("--min-area", "2.1"), 1200)
        self.assert_areas(self.stats("--min-area", "1.9"), 1202)
        self.assertEqual(self.stats("--min-area", "2.1")["changes"]["rings_dropped"], 10)

    def test_simplified_contours_have_fewer_points(self):
        self.succeed("make", "cylinder", "-o", "cylinder.stl", "--segments", "360")
        exact = self.stats(part="cylinder.stl")
        simple = self.stats("--simplify", "0.05", part="cylinder.stl")
        self.assertLess(10 * simple["points"], exact["points"])
        self.assertEqual(simple["changes"]["points_dropped"], exact["points"] - simple["points"])
        for a, b in zip(simple["layers"], exact["layers"]):
            self.assertAlmostEqual(a["area_mm2"], b["area_mm2"], delta=0.05 * b["perimeter_mm"])

    def test_steps_are_taken_in_their_order_whatever_the_order_on_the_command_line(self):
        steps = ["--fill", "nonzero", "--offset", "-0.7", "--largest-only"]
        one, two = self.stats(*steps), self.stats(*steps[4:], *steps[2:4], *steps[:2])
        self.assertEqual([layer["hash"] for layer in one["layers"]], [layer["hash"] for layer in two["layers"]])
        self.assert_areas(one, 2 * 18.6 * 28.6 - 8.6 * 8.6)

    def test_converting_takes_the_same_steps(self):
        self.succeed("slice", "heap.stl", "--layer-height", "1", "-o", "heap.json")
        for steps in [["--fill", "nonzero"], ["--offset", "0.5"], ["--largest-only"], ["--min-area", "3"], ["--simplify", "1"]]:
            with self.subTest(steps=steps):
                self.succeed("slice", "heap.stl", "--layer-height", "1", "-o", "sliced.json", *steps)
                self.succeed("convert", "heap.json", "converted.json", *steps)
                self.assertEqual(self.bytes_of("sliced.json"), self.bytes_of("converted.json"))

    def test_values_that_make_no_sense(self):
        for option, value in [("--fill", "some"), ("--offset", "x"), ("--offset", "inf"), ("--min-area", "0"),
                              ("--min-area", "-1"), ("--simplify", "-1")]:
            with self.subTest(option=option, value=value):
                self.fail_with(2, "error", "slice", "heap.stl", option, value, "-o", "x.cli")


if __name__ == "__main__":
    main()
