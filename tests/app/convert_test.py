"""lamella convert: from one slice format to another."""

from program import ProgramTest, main


class Convert(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("make", "torus", "-o", "torus.stl")
        self.succeed("slice", "torus.stl", "-o", "torus.cli", "--layer-height", "0.5", "--label", "ring")

    def test_every_pair_of_formats(self):
        names = {"cli": "a.cli", "cli-ascii": "b.cli", "svg": "c.svg"}
        for name, path in names.items():
            self.succeed("slice", "torus.stl", "-o", path, "--format", name, "--layer-height", "0.5")
        whole = self.succeed("info", "torus.cli", "--json").json()
        for source in names.values():
            for target in names:
                with self.subTest(source=source, target=target):
                    self.succeed("convert", source, "out", "--format", target)
                    found = self.succeed("info", "out", "--json").json()
                    for key in ["layers", "contours", "open_chains"]:
                        self.assertEqual(found[key], whole[key])
                    self.assertAlmostEqual(found["volume_mm3"], whole["volume_mm3"], delta=1)

    def test_the_label_is_kept_or_set(self):
        self.succeed("convert", "torus.cli", "kept.cli")
        self.assertEqual(self.succeed("info", "kept.cli", "--json").json()["label"], "ring")
        self.succeed("convert", "torus.cli", "set.cli", "--label", "wheel")
        self.assertEqual(self.succeed("info", "set.cli", "--json").json()["label"], "wheel")

    def test_standard_input_and_output(self):
        self.succeed("convert", "torus.cli", "torus.svg")
        piped = self.succeed("convert", "-", "-", "--format", "svg", stdin=self.bytes_of("torus.cli"))
        self.assertEqual(piped.out, self.bytes_of("torus.svg"))

    def test_bad_input(self):
        self.fail_with(3, "nowhere", "convert", "nowhere.cli", "out.svg")
        self.fail_with(2, "svg", "convert", "torus.cli", "out.gcode")
        self.fail_with(2, "overwrite", "convert", "torus.cli", "torus.cli")
        self.fail_with(6, "no/such", "convert", "torus.cli", "no/such/out.svg")
        self.fail_with(3, r"torus\.stl", "convert", "torus.stl", "out.svg")
        self.fail_with(2, "--short", "convert", "torus.cli", "out.svg", "--short")


if __name__ == "__main__":
    main()
