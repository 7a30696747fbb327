"""Slice files that are written compressed."""

import gzip
import unittest

from program import ProgramTest

COMPRESSED = [("cli", "cli"), ("cli-ascii", "cli"), ("svg", "svg"), ("dxf", "dxf"), ("geojson", "geojson"), ("json", "json")]


class GzipTest(ProgramTest):
    def test_the_contents_are_those_of_the_file_without_gz_for_any_threads(self):
        self.succeed("make", "rook", "-o", "part.stl")
        for format, extension in COMPRESSED:
            options = ["--layer-height", "0.5", "--format", format]
            self.succeed("slice", "part.stl", "-o", f"plain.{extension}", *options)
            written = set()
            for threads in [1, 2, 7]:
                self.succeed("slice", "part.stl", "-o", f"part.{extension}.gz", "--threads", threads, *options)
                written.add(self.bytes_of(f"part.{extension}.gz"))
            self.assertEqual([gzip.decompress(bytes) for bytes in written], [self.bytes_of(f"plain.{extension}")], format)
            self.assertLess(len(written.pop()), len(self.bytes_of(f"plain.{extension}")), format)

    def test_the_extension_before_gz_names_the_format(self):
        self.succeed("make", "box", "-o", "part.stl")
        self.succeed("slice", "part.stl", "-o", "part.SVG.GZ")
        self.succeed("convert", "part.SVG.GZ", "part.json.gz")
        self.succeed("convert", "part.json.gz", "again.svg")
        self.assertEqual(gzip.decompress(self.bytes_of("part.SVG.GZ")), self.bytes_of("again.svg"))
        self.succeed("verify", "part.json.gz", "--mesh", "part.stl")

    def test_shards_and_what_they_are_merged_to_may_be_compressed(self):
        self.succeed("make", "rook", "-o", "part.stl")
        self.succeed("slice", "part.stl", "-o", "whole.cli", "--layer-height", "0.5")
        for i in [1, 2]:
            self.succeed("slice", "part.stl", "-o", f"{i}.cli.gz", "--layer-height", "0.5", "--shard", f"{i}/2")
        self.succeed("merge", "merged.cli", "2.cli.gz", "1.cli.gz")
        self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"))
        self.succeed("merge", "merged.cli.gz", "2.cli.gz", "1.cli.gz")
        self.succeed("compare", "merged.cli.gz", "whole.cli")

    def test_vectors_may_be_compressed(self):
        self.succeed("make", "box", "--size", "3,3,1", "-o", "part.stl")
        for name in ["job.cli", "job.cli.gz"]:
            self.succeed("slice", "part.stl", "--scan", "-o", name)
        self.assertEqual(gzip.decompress(self.bytes_of("job.cli.gz")), self.bytes_of("job.cli"))

    def test_other_formats_are_refused_before_anything_is_read(self):
        for name, format in [("part.npz.gz", "npz"), ("part.3mf.gz", "3mf"), ("part.html.gz", "html")]:
            error = self.fail_with(2, "gzip", "slice", "missing.stl", "-o", name).err
            self.assertIn(
                f"'{name}': {format} is not written compressed with gzip, as cli, cli-ascii, svg, dxf, geojson, json are; "
                "leave out .gz",
                error,
            )
        self.fail_with(2, "has no extension that determines the format|is that of no format", "slice", "missing.stl", "-o", "part.gz")


if __name__ == "__main__":
    unittest.main()
