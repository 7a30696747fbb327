"""lamella check, and slice --check: islands, overhangs and enclosed resin."""

import json

from program import ProgramTest, main, needs_posix


def triangles_of(*boxes):
    """The triangles of boxes (x, y, z, X, Y, Z), outwards."""
    triangles = []
    for x, y, z, X, Y, Z in boxes:
        corners = [(x, y, z), (X, y, z), (X, Y, z), (x, Y, z), (x, y, Z), (X, y, Z), (X, Y, Z), (x, Y, Z)]
        for a, b, c, d in [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]:
            triangles += [(corners[a], corners[b], corners[c]), (corners[a], corners[c], corners[d])]
    return triangles


class Check(ProgramTest):
    def boxes(self, name, *boxes):
        lines = ["solid boxes"]
        for triangle in triangles_of(*boxes):
            lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {x} {y} {z}" for x, y, z in triangle), "endloop", "endfacet"]
        self.path(name).write_text("\n".join([*lines, "endsolid boxes", ""]))
        return name

    def table(self):
        """A leg on the plate, another one that begins in the resin, and a board on both."""
        return self.boxes("table.stl", (0, 0, 0, 2, 2, 6), (8, 0, 3, 10, 2, 6), (0, 0, 5, 10, 2, 6))

    def tube(self):
        """A box of 10 x 10 x 5 mm with walls of 1 mm, open at the top."""
        return self.boxes("tube.stl", (0, 0, 0, 10, 10, 1), (0, 0, 0, 1, 10, 5), (9, 0, 0, 10, 10, 5), (0, 0, 0, 10, 1, 5),
                          (0, 9, 0, 10, 10, 5))

    def test_an_island_is_found_with_its_heights_place_and_volume(self):
        found = self.succeed("check", self.table(), "--layer-height", "0.5", "--json").json()
        self.assertEqual((found["ok"], found["layers"], found["islands"], found["cups"]), (False, 12, 1, 0))
        (island,) = found["list_of_islands"]
        self.assertEqual((island["layer"], island["z"]), (6, [3, 5]))
        for found_at, at in zip(island["centre"], [9, 1]):
            self.assertAlmostEqual(found_at, at, delta=1e-9)
        self.assertEqual((island["area_mm2"], island["joins"], island["support"]), (4, True, False))
        self.assertAlmostEqual(island["volume_mm3"], 8, delta=1e-9)
        self.assertEqual(found["overhangs"], 1)
        self.assertAlmostEqual(found["widest_overhang_mm"], 3, delta=0.15)
        text = self.succeed("check", "table.stl", "--layer-height", "0.5").text
        self.assertIn("1 island, material that begins in the resin without support: at z = 3 mm around (9, 1)", text)
        self.assertIn("z = 3 to 5 mm around (9, 1): 4 mm2, 8 mm3; then it joins the rest", text)

    def test_strict_fails_after_the_report(self):
        result = self.run_program("check", self.table(), "--strict", "--json")
        self.assertEqual(result.code, 4)
        self.assertEqual(result.json()["islands"], 1)
        self.assertIn("table.stl: the check failed", result.err)
        self.succeed("check", self.boxes("box.stl", (0, 0, 0, 3, 3, 3)), "--strict")

    def test_cups_and_traps(self):
        found = self.succeed("check", self.tube(), "--layer-height", "0.5", "--json").json()
        self.assertEqual((found["cups"], found["traps"], found["cups_mm3"]), (1, 0, 8 * 8 * 4))
        closed = self.boxes("closed.stl", (0, 0, 0, 10, 10, 1), (0, 0, 0, 1, 10, 5), (9, 0, 0, 10, 10, 5), (0, 0, 0, 10, 1, 5),
                            (0, 9, 0, 10, 10, 5), (0, 0, 4, 10, 10, 5))
        found = self.succeed("check", closed, "--layer-height", "0.5", "--json").json()
        self.assertEqual((found["cups"], found["traps"], found["traps_mm3"]), (0, 1, 8 * 8 * 3))
        upside_down = self.succeed("check", "tube.stl", "--rotate-x", "180", "--layer-height", "0.5", "--json").json()
        self.assertEqual((upside_down["cups"], upside_down["list_of_cavities"][0]["on_plate"]), (1, True))

    def test_touch_and_angle(self):
        self.boxes("step.stl", (0, 0, 0, 4, 4, 1), (3.9, 0, 1, 6, 4, 2))
        for options, islands in [([], 0), (["--touch", "0.3"], 0), (["--touch", "0.5"], 1)]:
            found = self.succeed("check", "step.stl", "--layer-height", "0.5", "--json", *options).json()
            self.assertEqual(found["islands"], islands, options)
        for angle, overhangs in [("10", 0), ("20", 1), ("80", 1)]:
            found = self.succeed("check", "step.stl", "--layer-height", "0.5", "--json", "--overhang-angle", angle).json()
            self.assertEqual(found["overhangs"], overhangs, angle)
        self.fail_with(2, "--overhang-angle|overhang", "check", "step.stl", "--overhang-angle", "90")
        self.fail_with(2, "--touch|touch", "check", "step.stl", "--touch", "-1")

    def test_a_slice_file_is_checked_like_its_mesh(self):
        self.table()
        self.succeed("slice", "table.stl", "-o", "table.json", "--layer-height", "0.5")
        of_mesh = self.succeed("check", "table.stl", "--layer-height", "0.5", "--json").json()
        of_layers = self.succeed("check", "table.json", "--json").json()
        self.assertEqual({**of_layers, "path": "table.stl"}, of_mesh)
        self.succeed("slice", "table.stl", "-o", "job.cli", "--layer-height", "0.5", "--scan")
        self.fail_with(3, "has scan vectors", "check", "job.cli")

    def test_a_job_of_pixels_is_checked_like_its_mesh(self):
        self.boxes("tower.stl", (0, 0, 0, 8, 8, 1), (0, 0, 1, 1, 8, 4), (7, 0, 1, 8, 8, 4), (1, 0, 1, 7, 1, 4), (1, 7, 1, 7, 8, 4),
                   (3, 3, 2, 5, 5, 4), (0, 0, 4, 8, 8, 5))
        self.succeed("slice", "tower.stl", "-o", "tower.goo", "--layer-height", "0.5", "--display-size", "20,10", "--resolution",
                     "400x200", "--antialias", "1")
        of_mesh = self.succeed("check", "tower.stl", "--layer-height", "0.5", "--json").json()
        of_pixels = self.succeed("check", "tower.goo", "--json").json()
        for count in ["layers", "islands", "cups", "traps", "empty_layers"]:
            self.assertEqual(of_pixels[count], of_mesh[count], count)
        self.assertEqual((of_mesh["islands"], of_mesh["traps"]), (1, 1))
        for pixels, mesh in zip(of_pixels["list_of_islands"] + of_pixels["list_of_cavities"],
                                of_mesh["list_of_islands"] + of_mesh["list_of_cavities"]):
            self.assertEqual(pixels["layer"], mesh["layer"])
            self.assertAlmostEqual(pixels["volume_mm3"], mesh["volume_mm3"], delta=0.02 * mesh["volume_mm3"])

    def test_a_page_marks_what_was_found_in_meshes_and_files(self):
        self.succeed("slice", self.table(), "-o", "table.json", "--layer-height", "0.5")
        self.succeed("slice", "table.stl", "-o", "table.goo", "--layer-height", "0.5", "--display-size", "20,10", "--resolution", "400x200")
        for name in "table.stl", "table.json", "table.goo":
            with self.subTest(name):
                height = ["--layer-height", "0.5"] if name.endswith("stl") else []
                self.assertIn("1 island", self.succeed("check", name, *height, "--report", "page.html").text)
                page = self.path("page.html").read_text()
                self.assertIn("Check of the print", page)
                self.assertIn("then it joins the rest", page)
        self.assertTrue(self.succeed("check", "table.json", "--report", "-").text.lower().startswith("<!doctype html>"))
        self.fail_with(2, "both would go to standard output", "check", "table.json", "--report", "-", "--stats", "-")

    def test_layers_of_a_file_stay_where_they_are_and_take_steps(self):
        self.succeed("slice", self.table(), "-o", "table.json", "--layer-height", "0.5")
        self.assertEqual(self.succeed("check", "table.json", "--json").json()["islands"], 1)
        self.assertEqual(self.succeed("check", "table.json", "--json", "--largest-only").json()["islands"], 0)
        for options in ["--layer-height", "0.5"], ["--rotate-x", "90"], ["--layers", "1:5"], ["--slice-at", "top"]:
            self.fail_with(2, "table.json: holds layers, and these stay where they are", "check", "table.json", *options)

    def test_slice_checks_while_it_slices(self):
        self.table()
        alone = self.succeed("check", "table.stl", "--layer-height", "0.5", "--json").json()
        both = self.succeed("slice", "table.stl", "--layer-height", "0.5", "--check", "-o", "table.cli", "--stats", "stats.json",
                            "--report", "page.html")
        self.assertIn("1 island, material that begins", both.text)
        check = json.loads(self.path("stats.json").read_text())["check"]
        self.assertEqual(check, {key: value for key, value in alone.items() if key not in ("path", "ok", "layers")})
        page = self.path("page.html").read_text()
        self.assertIn("Check of the print", page)
        self.assertIn("then it joins the rest", page)
        self.boxes("floating.stl", (0, 0, 0, 2, 2, 6), (8, 0, 3, 10, 2, 6))
        self.fail_with(4, "1 island, material that begins", "slice", "floating.stl", "--check", "--strict", "-o", "other.cli")
        self.assertFalse(self.path("other.cli").exists())
        self.fail_with(2, "needs all layers", "slice", "table.stl", "--check", "--shard", "1/2", "-o", "shard.cli")
        self.fail_with(2, "--touch goes with --check", "slice", "table.stl", "--touch", "1", "-o", "other.cli")

    def test_statistics_have_the_areas_of_each_layer(self):
        self.table()
        self.succeed("check", "table.stl", "--layer-height", "0.5", "--stats", "areas.json")
        stats = json.loads(self.path("areas.json").read_text())
        self.assertEqual(stats["check"]["islands"], 1)
        self.assertEqual([layer["area_mm2"] for layer in stats["layers"]], [4] * 6 + [8] * 4 + [20] * 2)
        self.assertEqual([layer["exposed_mm2"] for layer in stats["layers"]], [4] + [0] * 5 + [4] + [0] * 3 + [12, 0])

    @needs_posix("a pipe")
    def test_standard_input(self):
        self.table()
        found = self.succeed("check", "-", "--json", "--layer-height", "0.5", stdin=self.path("table.stl").read_bytes()).json()
        self.assertEqual(found["islands"], 1)


if __name__ == "__main__":
    main()
