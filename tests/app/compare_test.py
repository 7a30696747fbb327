"""lamella compare: how far two slice files are from each other."""

import json

from program import ProgramTest, main


class Compare(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("make", "torus", "-o", "torus.stl")
        self.slice("torus.json")

    def slice(self, name, *words):
        self.succeed("slice", "torus.stl", "-o", name, "--layer-height", "0.5", *words)

    def differ(self, *words):
        result = self.run_program("compare", *words)
        self.assertEqual(result.code, 4, result.err)
        return result

    def test_a_file_is_the_same_as_itself(self):
        found = self.succeed("compare", "torus.json", "torus.json", "--json").json()
        self.assertTrue(found["agree"])
        self.assertEqual(found["same"], found["layers"])
        self.assertEqual(found["tolerance_mm"], 0)
        self.assertEqual(found["differences"], [])

    def test_formats_agree_up_to_their_rounding(self):
        for name in ["torus.cli", "torus.svg", "torus.npz", "torus.3mf", "torus.slc"]:
            with self.subTest(name):
                self.slice(name)
                self.assertTrue(self.succeed("compare", "torus.json", name, "--json").json()["agree"])
        self.differ("torus.json", "torus.svg", "--tolerance", "0")

    def test_points_half_way_between_two_units_agree(self):
        self.succeed("make", "box", "--size", "0.3125,0.3125,1", "--translate", "2,3,0", "-o", "small.stl")
        self.succeed("slice", "small.stl", "--layer-height", "0.5", "-o", "small.json")
        for name in ["small.svg", "small.3mf", "small.cli"]:
            self.succeed("convert", "small.json", name)
            self.succeed("compare", "small.json", name)

    def test_a_part_that_was_moved_is_reported_with_how_far_and_where(self):
        self.slice("moved.json", "--translate", "0.25,0,0")
        found = self.differ("torus.json", "moved.json", "--json").json()
        self.assertEqual(found["differing"], found["layers"])
        self.assertAlmostEqual(found["largest_difference"]["distance_mm"], 0.25, places=2)
        self.assertEqual(found["first_difference"]["z"], found["differences"][0]["z"])
        self.succeed("compare", "torus.json", "moved.json", "--tolerance", "0.25")
        self.assertRegex(self.differ("torus.json", "moved.json").text, r"largest difference: .* mm apart at \(")

    def test_areas_that_one_file_has_and_the_other_has_not(self):
        same = self.succeed("compare", "torus.json", "torus.json", "--area-difference", "--json").json()
        self.assertEqual((same["area_difference_mm2"], same["area_differences"]), (0, []))
        self.slice("moved.json", "--translate", "100,0,0")
        for other in ("moved.json", "part.json"):
            with self.subTest(other):
                if other == "part.json":
                    self.slice(other, "--layers", "2:5")
                found = self.differ("torus.json", other, "--area-difference", "--json").json()
                areas = [sum(abs(d["area_mm2"][k]) for k in (0, 1)) for d in found["differences"]]
                told = [d["area_mm2"] for d in found["area_differences"]]
                if other == "moved.json":  # no longer over one another
                    self.assertEqual([d["z"] for d in found["area_differences"]], [d["z"] for d in found["differences"]])
                    for area, expected in zip(told, areas):
                        self.assertAlmostEqual(area, expected, places=6)
                else:
                    self.assertEqual(len(told), found["layers"] - 3)
                self.assertAlmostEqual(found["area_difference_mm2"], sum(told), places=9)
                text = self.differ("torus.json", other, "--area-difference").text
                self.assertEqual(text.count(" mm2\n"), len(told) + (2 if other == "moved.json" else 0))
                self.assertIn(f"mm2 in all, in {len(told)} layers", text)
        self.assertNotIn("area_difference_mm2", self.differ("torus.json", "part.json", "--json").json())

    def test_layers_that_one_file_does_not_have(self):
        self.slice("part.json", "--layers", "2:5")
        found = self.differ("torus.json", "part.json", "--json").json()
        self.assertEqual({d["in"] for d in found["differences"]}, {"first"})
        self.assertEqual(found["same"], 3)
        first = found["differences"][0]
        self.assertGreater(first["contours"][0], 0)
        self.assertGreater(first["area_mm2"][0], 1)
        self.assertEqual((first["contours"][1], first["area_mm2"][1]), (0, 0))
        self.assertIn("only torus.json has contours", self.differ("torus.json", "part.json").text)

    def test_the_same_layers_cut_at_other_heights_are_reported(self):
        self.slice("low.json", "--slice-at", "bottom")
        self.slice("low.cli", "--slice-at", "bottom")
        result = self.differ("low.json", "low.cli")
        self.assertRegex(result.err, r"low\.json and low\.cli are cut at different heights: the layer from z = (\S+) to "
                                     r"\S+ mm at \1 mm in the first and at .* in the middle")
        self.slice("part.json", "--layers", "2:5")
        self.assertNotIn("different heights", self.differ("torus.json", "part.json").err)

    def test_hatch_lines_heights_and_parameters_are_compared(self):
        scan = ["--scan", "--hatch-distance", "0.5"]
        self.write("strong.toml", "[parameters.hatch]\npower_w = 333\n")
        self.slice("job.ovf", *scan)
        self.assertIn("agree", self.succeed("compare", "job.ovf", "job.ovf").text)
        self.slice("turned.ovf", *scan, "--hatch-angle", "1")
        found = self.differ("job.ovf", "turned.ovf", "--json").json()
        self.assertEqual((found["agree"], found["same"], found["parameters"]), (False, 0, []))
        self.assertRegex(self.differ("job.ovf", "turned.ovf").text, "hatch lines")
        self.slice("strong.ovf", *scan, "--strategy", "strong.toml")
        result = self.differ("job.ovf", "strong.ovf")
        self.assertIn("part core hatch: power_w 200 against 333", result.text)
        found = self.differ("job.ovf", "strong.ovf", "--json").json()
        self.assertEqual(found["differing"], 0)
        self.assertEqual((found["only_first"], found["only_second"]), ([], []))
        self.assertEqual(found["parameters"], [{"part": "part core hatch", "parameter": "power_w", "first": 200, "second": 333}])
        # Another name makes no other job; another power does, and what one job alone exposes.
        self.slice("named.ovf", *scan, "--label", "other")
        self.succeed("compare", "job.ovf", "named.ovf")
        self.slice("named.ovf", *scan, "--label", "other", "--strategy", "strong.toml")
        self.assertIn("part core hatch: power_w 200 against 333", self.differ("job.ovf", "named.ovf").text)
        self.slice("skins.ovf", *scan, "--skin-layers", "1")
        found = self.differ("job.ovf", "skins.ovf", "--json").json()
        self.assertEqual((found["only_first"], found["only_second"]), ([], ["part downskin hatch", "part upskin hatch"]))
        self.assertIn("part upskin hatch: only in skins.ovf", self.differ("job.ovf", "skins.ovf").text)
        for name in ("job.cli", "job.ilt", "job.json"):  # have no place for all of them
            self.slice(name, *scan)
            self.succeed("compare", "job.ovf", name)
        other = json.loads(self.bytes_of("torus.json"))
        other["layers"][-1]["top"] += 0.25
        self.write("thicker.json", json.dumps(other))
        found = self.differ("torus.json", "thicker.json", "--json").json()
        self.assertEqual([d["height_distance_mm"] for d in found["differences"]], [0.25])
        self.assertIn("bottom or top 0.25 mm apart", self.differ("torus.json", "thicker.json").text)

    def test_the_order_of_exposures_is_compared_between_files_of_one_format(self):
        self.write("before.toml", "[contours]\nbefore_hatch = true\n")
        job = ["slice", self.box(), "--layer-height", "2", "-o"]
        self.succeed(*job, "after.ovf", "--scan")
        for name in "before.ovf", "before.ilt":
            self.succeed(*job, name, "--strategy", "before.toml")
        same = self.run_program("compare", "after.ovf", "before.ovf", "--json")
        self.assertEqual((same.code, json.loads(same.out)["exposures_in_order"]), (4, False))
        other = self.succeed("compare", "after.ovf", "before.ilt", "--json").json()
        self.assertEqual((other["agree"], other["exposures_in_order"]), (True, True))

    def test_what_cannot_be(self):
        self.fail_with(3, "missing.cli", "compare", "torus.json", "missing.cli")
        self.fail_with(2, "needs SECOND", "compare", "torus.json")
        self.fail_with(2, "one file only", "compare", "-", "-")
        self.fail_with(2, "negative", "compare", "torus.json", "torus.json", "--tolerance=-1")


if __name__ == "__main__":
    main()
