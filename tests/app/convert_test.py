"""lamella convert: from one slice format to another."""

from program import ProgramTest, main


class Convert(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("make", "torus", "-o", "torus.stl")
        self.succeed("slice", "torus.stl", "-o", "torus.cli", "--layer-height", "0.5", "--label", "ring")

    def test_every_pair_of_formats(self):
        names = {"cli": "a.cli", "cli-ascii": "b.cli", "svg": "c.svg", "slc": "d.slc", "json": "e.json",
                 "npz": "f.npz", "3mf": "g.3mf"}
        for name, path in names.items():
            self.succeed("slice", "torus.stl", "-o", path, "--format", name, "--layer-height", "0.5")
        whole = self.succeed("info", "torus.cli", "--json").json()
        for source in names.values():
            for target in names:
                with self.subTest(source=source, target=target):
                    self.succeed("convert", source, "out", "--format", target)
                    if target == "3mf":  # info takes such a package for meshes
                        self.succeed("convert", "out", "found.json")
                    found = self.succeed("info", "found.json" if target == "3mf" else "out", "--json").json()
                    for key in ["layers", "contours", "open_chains"]:
                        self.assertEqual(found[key], whole[key])
                    self.assertAlmostEqual(found["volume_mm3"], whole["volume_mm3"], delta=1)

    def test_layers_of_files_are_the_same_for_any_number_of_threads(self):
        self.succeed("make", "sheet", "--holes", "100", "--segments", "64", "-o", "sheet.stl")
        self.succeed("slice", "sheet.stl", "-o", "sheet.cli", "--layer-height", "0.1")
        for part in (1, 2):
            self.succeed("slice", "sheet.stl", "-o", f"{part}.cli", "--layer-height", "0.1", "--shard", f"{part}/2")
        self.assertGreater(len(self.bytes_of("sheet.cli")), 2 << 20, "several pieces")
        outcomes = set()
        for threads in (1, 2, 3, 7, 16):
            def run(*arguments):
                return self.succeed(*arguments, "--threads", threads).out

            for source, target in [("sheet.cli", "a.svg"), ("a.svg", "b.cli"), ("sheet.cli", "c.json"),
                                   ("c.json", "d.npz"), ("d.npz", "e.3mf"), ("sheet.cli", "page.html")]:
                run("convert", source, target)
            run("scan", "sheet.cli", "-o", "job.cli", "--hatch-distance", "0.2")
            run("merge", "merged.cli", "1.cli", "2.cli")
            run("merge", "merged.svg", "1.cli", "2.cli")
            texts = [run("verify", "sheet.cli", "--mesh", "sheet.stl"), run("compare", "sheet.cli", "c.json"),
                     run("verify", "job.cli"), run("compare", "job.cli", "job.cli")]
            files = ["a.svg", "b.cli", "c.json", "d.npz", "e.3mf", "page.html", "job.cli", "merged.cli", "merged.svg"]
            outcomes.add(tuple(map(self.bytes_of, files)) + tuple(texts))
            for file in ["merged.cli", "merged.svg"]:
                (self.folder / file).unlink()
        self.assertEqual(len(outcomes), 1)

    def test_the_label_is_kept_or_set(self):
        self.succeed("convert", "torus.cli", "kept.cli")
        self.assertEqual(self.succeed("info", "kept.cli", "--json").json()["label"], "ring")
        self.succeed("convert", "torus.cli", "set.cli", "--label", "wheel")
        self.assertEqual(self.succeed("info", "set.cli", "--json").json()["label"], "wheel")

    def test_standard_input_and_output(self):
        self.succeed("convert", "torus.cli", "torus.svg")
        piped = self.succeed("convert", "-", "-", "--format", "svg", stdin=self.bytes_of("torus.cli"))
        self.assertEqual(piped.out, self.bytes_of("torus.svg"))

    def test_formats_that_others_read(self):
        for name in ["dxf", "geojson"]:
            self.succeed("convert", "torus.cli", "out." + name)

    def test_what_a_format_has_no_place_for_is_reported(self):
        self.write("open.json", """{"format": "lamella layers", "version": 1, "parts": [{"label": "a"}],
            "layers": [{"z": 1, "bottom": 0, "top": 2, "parts": [{"rings": [[0, 0, 4, 0, 0, 4]],
                        "chains": [[5, 5, 6, 6]], "hatches": [0, 0, 1, 1]}]}]}""")
        for name, lost in {"cli": 0, "json": 0, "npz": 0, "dxf": 1, "svg": 1, "slc": 2, "3mf": 2}.items():
            with self.subTest(format=name):
                told = self.succeed("convert", "open.json", "out." + name).err
                self.assertEqual(told.count("left out"), lost, told)

    HATCHED = """{"format": "lamella layers", "version": 1, "parts": [{"label": "a"}],
        "layers": [{"z": 1, "bottom": 0, "top": 2, "parts": [{"rings": [[0, 0, 4, 0, 0, 4]],
                    "hatches": [0, 0, 1, 1, 0, 1, 1, 2]}]}]}"""

    def test_steps_that_change_contours_report_their_hatches(self):
        self.write("hatched.json", self.HATCHED)
        told = self.succeed("convert", "hatched.json", "out.json", "--offset", "0.1").err
        self.assertRegex(told, r"warning: hatched\.json: 2 hatch lines left out")
        self.fail_with(4, "2 hatch lines left out", "convert", "hatched.json", "no.json", "--offset", "0.1", "--strict")
        self.assertEqual(self.succeed("convert", "hatched.json", "out.json", "--min-area", "1", "--strict").err, "")

    def test_what_is_odd_about_the_file_is_an_error_where_it_is_asked_to_be(self):
        self.write("odd.json", self.HATCHED.replace("[[0, 0, 4, 0, 0, 4]]", "[[0, 0, 4, 0, 0, 4], [1, 1, 2, 2]]").replace("hatches", "no"))
        for command in [["convert", "odd.json", "out.cli"], ["scan", "odd.json", "-o", "out.cli"]]:
            odd = r"odd\.json: 1 contour had too few different points; it was dropped"
            self.assertRegex(self.succeed(*command).err, "warning: " + odd)
            self.fail_with(4, odd, *command, "--strict")

    def test_contours_that_vanish_are_counted(self):
        layers = self.succeed("info", "torus.cli", "--json").json()
        text = self.succeed("convert", "torus.cli", "out.cli", "--offset=-100").text
        self.assertIn(f"; {layers['contours']} rings lost", text)

    def test_what_rounding_loses_is_reported(self):
        self.succeed("convert", "torus.cli", "exact.json")
        self.assertEqual(self.succeed("convert", "exact.json", "near.cli", "--strict").err, "")
        told = self.succeed("convert", "exact.json", "coarse.cli", "--format", "cli-ascii", "--units-mm", "1").err
        self.assertRegex(told, r"warning: coarse\.cli: rounding moved points by up to 0\.\d+ mm, merged \d+ of them")
        self.fail_with(4, "rounding moved", "convert", "exact.json", "no.cli", "--format", "cli-ascii", "--units-mm", "1",
                       "--strict")
        self.fail_with(4, "open contour was left out", "convert", self.open_layer(), "no.slc", "--strict")

    def open_layer(self):
        self.write("open.json", self.HATCHED.replace('"hatches"', '"chains": [[5, 5, 6, 6]], "hatches"'))
        return "open.json"

    def test_heights_that_rounding_moves_are_reported(self):
        self.box()
        coarse = ["--translate", "1,1,0", "--short", "--units-mm", "0.05", "--layer-height"]
        moved = r"rounding moved heights of layers by up to 0\.02 mm, first in layer 0"
        self.assertRegex(self.succeed("slice", "box.stl", "-o", "box.cli", *coarse, "0.17").err, f"warning: box.cli: {moved}")
        self.fail_with(4, "rounding moved", "slice", "box.stl", "-o", "no.cli", *coarse, "0.17", "--strict")
        self.assertNotIn("heights", self.succeed("slice", "box.stl", "-o", "box.cli", *coarse, "0.2").err)
        told = self.succeed("slice", "box.stl", "--scan", "-o", "box.ilt", *coarse, "0.17").err
        self.assertEqual(told.count("moved heights"), 1)
        self.assertIn("(and in 1 more of its files)", told)

    def test_what_is_made_of_the_layers_is_reported(self):
        self.write("two.json", """{"format": "lamella layers", "version": 1, "parts": [{"label": "a"}, {"label": "b"}],
            "layers": [{"z": 1, "bottom": 0, "top": 2, "parts": [
                {"rings": [[0, 0, 4, 0, 4, 4, 0, 4], [2, 2, 6, 2, 6, 6, 2, 6]]},
                {"rings": [[10, 0, 14, 0, 14, 4, 10, 4], [12, 2, 16, 2, 16, 6, 12, 6], [20, 0, 21, 0, 21, 1, 20, 1]]}]}]}""")
        text = self.succeed("convert", "two.json", "out.json", "--fill", "nonzero", "--min-area", "2").text
        self.assertIn("changed 1 layer by --fill, --min-area: area 65 to 56 mm2 in all, 4 rings united; 1 ring lost\n", text)
        self.assertNotIn("changed", self.succeed("convert", "two.json", "out.json").text)

    def test_bad_input(self):
        self.fail_with(3, "nowhere", "convert", "nowhere.cli", "out.svg")
        self.fail_with(2, "svg", "convert", "torus.cli", "out.step")
        self.fail_with(2, "overwrite", "convert", "torus.cli", "torus.cli")
        self.fail_with(6, "no/such", "convert", "torus.cli", "no/such/out.svg")
        self.fail_with(3, r"torus\.stl", "convert", "torus.stl", "out.svg")
        self.fail_with(2, "--short", "convert", "torus.cli", "out.svg", "--short")


if __name__ == "__main__":
    main()
