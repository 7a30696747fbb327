"""lamella slice with policies for broken meshes, and with layers of varying height."""

from program import ProgramTest, binary_stl, box_triangles, main, open_box


class Repair(ProgramTest):
    def stats(self, *arguments):
        return self.succeed("slice", *arguments, "--stats", "-", "--threads", "2").json()

    def test_nothing_is_mended_unasked(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        stats = self.stats("open.stl", "--layer-height", "1")
        self.assertEqual(stats["open_chains"], 10)
        self.assertNotIn("repairs", stats)
        self.assertNotIn("gaps", stats)

    def test_what_is_missing_is_reported(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        stats = self.stats("open.stl", "--layer-height", "1")
        for of in [stats["layers"][0], stats["layers"][9]]:
            self.assertEqual(of["open_gaps"], 1)
            self.assertAlmostEqual(of["longest_open_gap_mm"], 30, places=4)
            self.assertAlmostEqual(of["open_gaps_mm"], 30, places=4)
        self.assertEqual(stats["open_gaps"], 10)
        self.assertAlmostEqual(stats["longest_open_gap_mm"], 30, places=4)
        self.assertAlmostEqual(stats["open_gaps_mm"], 300, places=3)
        told = self.succeed("slice", "open.stl", "--layer-height", "1", "-o", "open.cli").err
        self.assertIn("the longest gap is 30 mm", told)
        found = self.run_program("verify", "open.cli", "--json").json()
        self.assertEqual([layer["index"] for layer in found["open_layers"]], list(range(10)))
        self.assertEqual([round(layer["longest_open_gap_mm"], 3) for layer in found["open_layers"]], [30] * 10)
        self.assertRegex(self.run_program("verify", "open.cli").text, r"300 mm are missing .* in 10 layers; the longest gap, of 30 mm")
        # What is closed has none.
        mended = self.stats("open.stl", "--layer-height", "1", "--close-gaps", "30.5")
        self.assertNotIn("open_gaps", mended)
        self.assertNotIn("open_gaps", mended["layers"][0])

    def test_closing_gaps_reports_every_join(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        stats = self.stats("open.stl", "--layer-height", "1", "--close-gaps", "30.5")
        self.assertEqual(stats["open_chains"], 0)
        self.assertAlmostEqual(stats["volume_mm3"], 6000, places=2)
        gaps = stats["gaps"]
        self.assertEqual((gaps["closed"], gaps["layers"]), (10, 10))
        self.assertAlmostEqual(gaps["longest_mm"], 30, places=4)
        self.assertAlmostEqual(gaps["total_mm"], 300, places=3)
        [join] = stats["layers"][0]["gaps"]
        self.assertAlmostEqual(join["length_mm"], 30, places=4)
        self.assertEqual([round(v) for v in join["from"] + join["to"]], [20, 0, 20, 30])
        text = self.succeed("slice", "open.stl", "--layer-height", "1", "--close-gaps", "30.5", "-o", "open.cli").text
        self.assertRegex(text, r"gaps +10 closed in 10 layers")
        self.succeed("verify", "open.cli")
        # A shorter reach closes nothing.
        self.assertEqual(self.stats("open.stl", "--layer-height", "1", "--close-gaps", "29")["open_chains"], 10)

    def test_a_vertex_on_an_edge_of_a_neighbour_is_named_with_its_cure(self):
        box = box_triangles(10, 10, 10)
        a, b, c = box[0]
        on = tuple((p + q) / 2 for p, q in zip(a, b))
        self.write("split.stl", binary_stl([(a, on, c), (on, b, c), *box[1:]]))
        told = self.succeed("slice", "split.stl", "--direction", "1,2,3", "--layer-height", "1", "-o", "split.json").err
        self.assertRegex(told, r"contours do not close, though no gap is longer than [0-9.e-]+ mm: .*T-junctions.*; "
                               r"--close-gaps 1e-6 closes them")
        info = self.succeed("info", "split.stl").text
        self.assertRegex(info, r"3 boundary edges: .*; 1 of 1 rim is no wider than rounding, .*T-junctions.*: "
                               r"lamella slice --close-gaps 1e-6 closes their contours")
        self.assertEqual(self.succeed("info", "split.stl", "--json").json()["defects"]["slits"], 1)
        self.succeed("slice", "split.stl", "--direction", "1,2,3", "--layer-height", "1", "--close-gaps", "1e-6",
                     "-o", "split.json")
        self.succeed("verify", "split.json")

    def test_a_tolerance_closes_cracks(self):
        torn = [tuple((x + 0.001 * (i % 3), y, z) for x, y, z in t) for i, t in enumerate(box_triangles(20, 30, 10))]
        self.write("torn.stl", binary_stl(torn))
        self.assertGreater(self.stats("torn.stl", "--layer-height", "1")["open_chains"], 0)
        stats = self.stats("torn.stl", "--layer-height", "1", "--weld-tolerance", "0.01")
        self.assertEqual(stats["open_chains"], 0)
        [repair] = stats["repairs"]
        self.assertEqual(repair["path"], "torn.stl")
        self.assertGreater(repair["weld_tolerance"]["joined_vertices"], 0)
        self.assertLessEqual(repair["weld_tolerance"]["longest_move_mm"], 0.01)
        self.assertIsNone(repair["orient"])
        self.assertAlmostEqual(stats["volume_mm3"], 6000, delta=2)

    def test_orientation_and_duplicates(self):
        triangles = box_triangles(20, 30, 10)
        self.write("sound.stl", binary_stl(triangles))
        sound = self.stats("sound.stl", "--layer-height", "1")
        broken = [t[::-1] if i % 4 == 1 else t for i, t in enumerate(triangles)]
        broken += broken[3:6]
        self.write("broken.stl", binary_stl(broken))
        self.assertGreater(self.stats("broken.stl", "--layer-height", "1")["open_chains"], 0)
        stats = self.stats("broken.stl", "--layer-height", "1", "--orient", "--drop-duplicates")
        self.assertEqual([layer["hash"] for layer in stats["layers"]], [layer["hash"] for layer in sound["layers"]])
        [repair] = stats["repairs"]
        self.assertEqual(repair["drop_duplicates"]["repeated_triangles"], 3)
        self.assertEqual(repair["orient"]["flipped_triangles"], 3)
        text = self.succeed("slice", "broken.stl", "--orient", "--drop-duplicates", "-o", "x.cli").text
        self.assertRegex(text, r"dropped +3 triangles repeated")
        self.assertRegex(text, r"oriented +3 triangles flipped")

    def test_strict_looks_at_the_mesh_before_it_is_mended(self):
        self.write("twice.stl", binary_stl(box_triangles(20, 30, 10) + box_triangles(20, 30, 10)))
        self.fail_with(4, "defects", "slice", "twice.stl", "--drop-duplicates", "--strict", "-o", "x.cli")

    def test_a_mesh_of_which_nothing_is_left(self):
        triangles = box_triangles(20, 30, 10)
        self.write("both.stl", binary_stl(triangles + [t[::-1] for t in triangles]))
        self.fail_with(3, "both.stl: nothing of the mesh is left", "slice", "both.stl", "--drop-duplicates", "-o",
                       "x.cli")

    def test_values_that_make_no_sense(self):
        self.box()
        for option, value in [("--weld-tolerance", "0"), ("--weld-tolerance", "-1"), ("--close-gaps", "0"),
                              ("--close-gaps", "nan"), ("--heights", "0:5"), ("--heights", "5:0=0.1"),
                              ("--heights", "0:5=0.1,3:6=0.2"), ("--heights", ""), ("--adaptive", "0.2:0.1"),
                              ("--adaptive", "x"), ("--adaptive", "0.1:"), ("--adaptive", ":0.1"), ("--cusp", "0")]:
            with self.subTest(option=option, value=value):
                self.fail_with(2, "error", "slice", "box.stl", option, value, "-o", "x.cli")
        self.fail_with(2, "contradict", "slice", "box.stl", "--heights", "0:5=0.1", "--adaptive", "0.1:0.2", "-o", "x.cli")
        self.fail_with(2, "contradict", "slice", "box.stl", "--layer-height", "1", "--adaptive", "0.1:0.2", "-o", "x.cli")

    def test_ranges_of_heights(self):
        layers = self.stats(self.box(), "--heights", "0:2=0.5,2:4=1", "--layer-height", "2")["layers"]
        self.assertEqual([round(layer["thickness"], 6) for layer in layers], [0.5] * 4 + [1] * 2 + [2] * 3)
        self.assertEqual([layer["index"] for layer in layers], list(range(9)))
        some = self.stats("box.stl", "--heights", "0:2=0.5,2:4=1", "--layer-height", "2", "--layers", "3:5")["layers"]
        self.assertEqual([layer["index"] for layer in some], [3, 4])
        self.succeed("slice", "box.stl", "--heights", "0:2=0.5", "--layer-height", "2", "-o", "box.cli")

    def test_adaptive_layers(self):
        self.succeed("make", "sphere", "-o", "sphere.stl")
        layers = self.stats("sphere.stl", "--adaptive", "0.1:0.8", "--cusp", "0.08")["layers"]
        thickness = [layer["thickness"] for layer in layers]
        self.assertLess(thickness[0], 0.11)
        self.assertGreater(max(thickness), 0.4)
        self.assertLessEqual(max(thickness), 0.8 + 1e-9)
        self.assertGreaterEqual(min(thickness), 0.1 - 1e-9)
        self.assertGreater(thickness[len(thickness) // 2], thickness[1])


if __name__ == "__main__":
    main()
