"""lamella slice --max-output: a slice file that would become too large is not written."""

from program import ProgramTest, main

FORMATS = ["cli", "cli-ascii", "svg", "slc", "3mf", "dxf", "geojson", "json", "npz", "svg-layers", "png",
           "png-zip", "sl1", "sl1s"]


class MaxOutput(ProgramTest):
    def total(self, path):
        path = self.path(path)
        return sum(p.stat().st_size for p in path.iterdir()) if path.is_dir() else path.stat().st_size

    def test_every_format(self):
        self.succeed("make", "torus")
        for name in FORMATS:
            with self.subTest(name):
                common = ["slice", "torus.stl", "--format", name, "--layer-height", "0.5"]
                self.path("free").mkdir()
                self.succeed(*common, "-o", "free/job")  # some formats repeat the name
                size = self.total("free/job")
                self.fail_with(5, f"would take more than the {size // 2} bytes that it may", *common, "-o", "job",
                               "--max-output", size // 2)
                self.succeed(*common, "-o", "job", "--max-output", size)
                self.assertEqual(self.total("job"), size)
                # What is there already stays when the next one is too large.
                self.fail_with(5, "would take more", *common, "-o", "job", "--max-output", "100")
                self.assertEqual(self.total("job"), size)
            self.doCleanups()
            self.setUp()
            self.succeed("make", "torus")

    def test_convert_has_it_too(self):
        self.box()
        self.succeed("slice", "box.stl", "-o", "box.cli")
        self.fail_with(5, "would take more than the 1000 bytes", "convert", "box.cli", "box.svg", "--max-output", "1k")
        self.succeed("convert", "box.cli", "box.svg", "--max-output", "1M")


if __name__ == "__main__":
    main()
