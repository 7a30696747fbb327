"""lamella slice --shard and lamella merge: shares of equal work, put together to the bytes of a single run."""

import gzip
import json
import os
import shlex
import shutil
import subprocess

from program import COMMAND, SOURCE, UNPRIVILEGED, ProgramTest, binary_stl, box_triangles, main, needs_posix, open_box

CLUSTER = SOURCE / "examples" / "cluster"


class Shard(ProgramTest):
    def lattice(self, cells=4):
        self.succeed("make", "lattice", "--cells", cells, "-o", "part.stl")

    def slice_all(self, n, name, *options):
        for i in range(1, n + 1):
            self.succeed("slice", "part.stl", "-o", f"part.{i}.{name}", "--shard", f"{i}/{n}", *options)
        return [f"part.{i}.{name}" for i in range(1, n + 1)]

    def hashes(self, *arguments):
        return [layer["hash"] for layer in self.succeed("slice", *arguments, "--stats", "-").json()["layers"]]

    def stamp(self, name):
        return json.loads(self.bytes_of(name + ".shard"))

    def test_merged_files_are_those_of_a_single_run(self):
        self.lattice()
        for name, options in [("cli", []), ("cli", ["--format", "cli-ascii"]), ("cli", ["--short"]),
                              ("cli", ["--layer-height", "0.15", "--slice-at", "top", "--units-mm", "0.01"]),
                              ("cli", ["--heights", "0:5=0.1", "--layers", "10:80", "--copies", "2"])]:
            self.succeed("slice", "part.stl", "-o", "whole.cli", *options)
            for n in [1, 2, 5]:
                shards = self.slice_all(n, name, *options)
                written = [o for o in options if o in ("--format", "cli-ascii")]
                self.succeed("merge", "merged.cli", *reversed(shards), *written)
                self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"), options)

    def test_rounded_heights_of_shards_meet(self):
        # In single precision 17.2 is not what 17.3 less 0.1 is.
        self.succeed("make", "box", "--size", "1,1,51.6", "-o", "part.stl")
        shards = self.slice_all(3, "ovf", "--layer-height", "0.1")
        self.assertNotIn("overlap", self.succeed("merge", "merged.ovf", *shards).err)

    def test_what_cannot_be_read_twice_is_refused_and_what_is_packed_is_not(self):
        self.succeed("make", "box", "--size", "1,1,2", "-o", "part.stl")
        self.succeed("slice", "part.stl", "-o", "whole.cli")
        self.fail_with(2, "standard input and pipes", "merge", "merged.cli", "-", stdin=self.bytes_of("whole.cli"))
        self.write("whole.cli.gz", gzip.compress(self.bytes_of("whole.cli")))
        self.succeed("merge", "merged.cli", "whole.cli.gz")
        self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"))

    def test_other_formats_are_equal_by_their_layers(self):
        self.lattice()
        for name in ["slc", "json", "npz", "3mf", "svg"]:
            self.succeed("slice", "part.stl", "-o", f"whole.{name}", "--layer-height", "0.3")
            shards = self.slice_all(3, name, "--layer-height", "0.3")
            self.succeed("merge", f"merged.{name}", *shards)
            for kind in ["whole", "merged"]:
                self.succeed("convert", f"{kind}.{name}", f"{kind}-{name}.json")
            whole, merged = (json.loads(self.bytes_of(f"{kind}-{name}.json")) for kind in ("whole", "merged"))
            self.assertEqual(len(whole["layers"]), len(merged["layers"]), name)
            if name != "svg":  # its coordinates count from a corner of the box, which a merged file has anew
                self.assertEqual(whole["layers"], merged["layers"], name)
            self.succeed("compare", f"whole.{name}", f"merged.{name}")

    def test_copies_have_no_points_that_moving_made_equal(self):
        # Two boxes, one on the other: a plane just below their border leaves points that differ in their last digits.
        low = box_triangles(1, 1, 1)
        high = [tuple((x, y, z + 1) for x, y, z in triangle) for triangle in low]
        self.write("part.stl", binary_stl(low + high))
        options = ["--layer-height", 1 / 6, "--slice-at", "bottom", "--copies", 2, "--spacing", 6]
        self.succeed("slice", "part.stl", "-o", "whole.json", *options)
        whole = json.loads(self.bytes_of("whole.json"))["layers"]
        for layer in whole:
            for numbers in (ring for part in layer["parts"] for ring in part["rings"]):
                ring = list(zip(numbers[::2], numbers[1::2]))
                self.assertTrue(all(p != q for p, q in zip(ring, ring[1:] + ring[:1])), ring)
        self.succeed("merge", "merged.json", *self.slice_all(2, "json", *options))
        self.assertEqual(json.loads(self.bytes_of("merged.json"))["layers"], whole)

    def test_shards_are_of_equal_work_not_height(self):
        # A fine sphere on a tall plain box.
        self.succeed("make", "sphere", "--size", 10, "--detail", 6, "--translate", "0,0,105", "-o", "fine.stl")
        self.succeed("make", "box", "--size", "10,10,100", "-o", "plain.stl")
        both = [self.succeed("slice", "plain.stl", "fine.stl", "--shard", f"{i}/2", "--stats", "-").json()
                for i in (1, 2)]
        heights = [len(stats["layers"]) for stats in both]
        self.assertEqual(sum(heights), 1100)
        self.assertGreater(heights[0], 4 * heights[1])

    def test_shards_in_little_memory_are_the_same(self):
        self.lattice(7)
        for i in (1, 2, 3):
            self.succeed("slice", "part.stl", "-o", "a.cli", "--shard", f"{i}/3")
            self.succeed("slice", "part.stl", "-o", "b.cli", "--shard", f"{i}/3", "--max-memory", "55M", "--threads", 2,
                         "--stats", "b.json")
            self.assertIn("ranges", json.loads(self.bytes_of("b.json")))
            self.assertEqual(self.bytes_of("a.cli"), self.bytes_of("b.cli"))

    def test_finished_shards_are_skipped(self):
        self.lattice()
        first = self.succeed("slice", "part.stl", "-o", "a.cli", "--shard", "2/4", "--resume", "--threads", 1)
        self.assertIn("shard    2 of 4", first.text)
        before = self.path("a.cli").stat()
        # Whatever does not change the bytes does not matter, nor where the input lies.
        shutil.copy(self.path("part.stl"), self.path("moved.stl"))
        again = self.succeed("slice", "moved.stl", "-o", "a.cli", "--shard", "2/4", "--resume", "--threads", 2,
                             "--max-memory", "1G")
        self.assertEqual(again.text, "a.cli: shard 2/4 is finished\n")
        self.assertEqual(self.path("a.cli").stat().st_ino, before.st_ino)

        def redone(*options):
            result = self.succeed("slice", "part.stl", "-o", "a.cli", "--resume", *options)
            self.assertIn("sliced", result.text, options)
        redone("--shard", "3/4")
        redone("--shard", "3/5")
        redone("--shard", "3/5", "--layer-height", "0.2")
        redone("--shard", "3/5", "--layer-height", "0.2", "--rotate-x", "5")
        self.succeed("make", "lattice", "--cells", 5, "-o", "part.stl")
        redone("--shard", "3/5")
        data = bytearray(self.bytes_of("a.cli"))
        data[-1] ^= 1
        self.write("a.cli", bytes(data))
        redone("--shard", "3/5")
        self.path("a.cli").unlink()
        redone("--shard", "3/5")
        self.write("a.cli.shard", "{")
        redone("--shard", "3/5")

    def test_finished_shards_have_the_statistics_and_the_report_that_are_asked_for(self):
        self.lattice()
        shard = ["slice", "part.stl", "-o", "a.cli", "--shard", "2/4", "--resume"]
        self.succeed(*shard)
        for more in [["--stats", "a.json"], ["--stats", "a.json", "--stats", "b.json"], ["--report", "a.html"]]:
            if more[0] == "--report" and self.run_program(*shard, *more).code == 2:
                continue  # a program without the viewer
            self.path(more[-1]).unlink(missing_ok=True)
            self.assertIn("sliced", self.succeed(*shard, *more).text, more)
            self.assertTrue(self.path(more[-1]).exists())
            self.assertIn("is finished", self.succeed(*shard, *more).text, more)
        self.write("a.json", "{}")
        self.assertIn("sliced", self.succeed(*shard, "--stats", "a.json").text)

    @needs_posix("pipes and devices with names")
    def test_a_shard_whose_statistics_failed_is_not_finished(self):
        self.lattice()
        shard = ["slice", "part.stl", "-o", "a.cli", "--shard", "2/4", "--resume", "--stats"]
        self.assertEqual(self.run_program(*shard, "/dev/full").code, 6)
        self.assertNotIn("a.cli.shard", self.listing())
        self.assertIn("sliced", self.succeed(*shard, "a.json").text)

    def test_the_place_of_the_stamp_is_seen_to_before(self):
        self.lattice()
        shard = ["slice", "part.stl", "--shard", "1/2", "-o"]
        self.fail_with(2, "--stats and the stamp of the shard contradict", *shard, "a.cli", "--stats", "./a.cli.shard")
        os.link(self.path("part.stl"), self.path("b.cli.shard"))
        self.fail_with(2, "b.cli.shard: the output would overwrite the input", *shard, "b.cli")
        self.path("c.cli.shard").mkdir()
        self.fail_with(6, "cannot write 'c.cli.shard': it is a folder", *shard, "c.cli")
        self.fail_with(6, r"cannot write '.*\.cli\.shard': the name is too long", *shard, "d" * 247 + ".cli")

    def test_merge_reports_what_is_missing_or_cannot_be_read(self):
        self.lattice()
        a, b = self.slice_all(2, "cli")
        layers, whole = self.stamp(b), self.bytes_of(b)
        self.path(b).unlink()
        begin, end = layers["layers"]
        self.fail_with(3, f"{b}: there is no such file.* layers {begin} to {end - 1} of {layers['of']} are missing", "merge", "m.cli", a, b)
        self.write(b, whole)
        for origin in ["x", None, [1]]:
            self.write(b + ".shard", json.dumps({**layers, "origin": origin}))
            self.fail_with(3, f"{b}.shard: is no stamp", "merge", "m.cli", a, b)
        for name in ["x" * 246 + ".cli", "x" * 251 + ".cli"]:  # a stamp would have too long a name
            self.path(a).rename(self.path(name))
            self.path(a + ".shard").unlink(missing_ok=True)
            self.path(b + ".shard").unlink(missing_ok=True)
            self.succeed("merge", "m.cli", name, b)
            self.path(name).rename(self.path(a))
        locked = self.path("locked")
        locked.mkdir()
        self.path(b).rename(locked / b)
        locked.chmod(0)
        self.addCleanup(locked.chmod, 0o700)
        result = self.run_program("merge", "n.cli", a, f"locked/{b}", **UNPRIVILEGED)
        self.assertEqual(result.code, 3)
        self.assertIn("no permission", result.err)

    def test_a_stamp_whose_file_is_gone_does_not_outlive_the_next_run(self):
        self.lattice()
        shard = ["slice", "part.stl", "-o", "a.cli", "--shard", "1/2"]
        self.succeed(*shard)
        self.path("a.cli").unlink()
        self.fail_with_listing(5, *shard, "--max-output", "1")
        self.assertNotIn("a.cli.shard", self.listing())

    def fail_with_listing(self, code, *arguments):
        self.assertEqual(self.run_program(*arguments).code, code)

    def test_shards_of_one_job_may_be_asked_for_in_other_words(self):
        self.lattice()
        self.succeed("slice", "part.stl", "-o", "a.cli", "--shard", "1/2", "--translate", "1,2,3")
        self.write("moved.toml", 'format = "cli"\nunits-mm = 0.001\n[[input]]\npath = "part.stl"\ntranslate = [1, 2, 3]\n')
        self.succeed("slice", "-o", "b.cli", "--shard", "2/2", "--config", "moved.toml", "--engine", "eecc")
        self.succeed("merge", "m.cli", "a.cli", "b.cli")
        self.succeed("slice", "part.stl", "-o", "whole.cli", "--translate", "1,2,3")
        self.assertEqual(self.bytes_of("m.cli"), self.bytes_of("whole.cli"))
        self.write("usual.toml", self.succeed("strategy", "show").text)
        self.succeed("slice", "part.stl", "--scan", "-o", "c.cli", "--shard", "1/2")
        self.succeed("slice", "part.stl", "--scan", "--strategy", "usual.toml", "-o", "d.cli", "--shard", "2/2")
        self.succeed("merge", "n.cli", "c.cli", "d.cli")

    def test_merge_obeys_options_of_the_output_also_where_files_could_be_joined(self):
        self.lattice()
        files = self.slice_all(2, "cli")
        self.succeed("merge", "short.cli", *files, "--short")
        self.succeed("slice", "part.stl", "-o", "whole.cli", "--short")
        self.succeed("compare", "short.cli", "whole.cli")
        self.assertEqual(len(self.bytes_of("short.cli")), len(self.bytes_of("whole.cli")))
        self.succeed("merge", "units.cli", *files, "--units-mm", "0.01")
        self.assertIn(b"$$UNITS/0.01", self.bytes_of("units.cli"))
        self.fail_with(5, "m.cli: would take more than the 1000 bytes that it may", "merge", "m.cli", *files, "--max-output", "1000")
        self.assertFalse(self.path("m.cli").exists())

    def test_shards_are_files_that_merge_can_read(self):
        self.lattice()
        for name in ["a.html", "a.dxf", "a.geojson", "a.sl1"]:
            self.fail_with(2, "files that lamella merge can read", "slice", "part.stl", "-o", name, "--shard", "1/2")

    def test_merge_refuses_what_does_not_belong_together(self):
        self.lattice()
        a, b, c, d = self.slice_all(4, "cli")
        begin, end = self.stamp(c)["layers"]
        self.fail_with(3, f"layers {begin} to {end - 1} of {self.stamp(a)['of']} are in none", "merge", "m.cli", a, b, d)
        self.fail_with(3, "layers 0 to", "merge", "m.cli", b, c, d)
        self.fail_with(3, "are in none", "merge", "m.cli", a, b, c)
        self.fail_with(3, f"{b} holds those up to .*; name each shard once", "merge", "m.cli", a, b, b, c, d)
        self.fail_with(2, "overwrite", "merge", a, a, b)
        self.succeed("slice", "part.stl", "-o", "other.cli", "--shard", "4/4", "--units-mm", "0.01")
        self.fail_with(3, 'not shards of one job: by their stamps options/units-mm is 0.001 in the one and 0.01 in the other', "merge", "m.cli", a, b, c, "other.cli")
        self.succeed("make", "lattice", "--cells", 3, "-o", "part.stl")
        self.succeed("slice", "part.stl", "-o", "other.cli", "--shard", "4/4")
        self.fail_with(3, 'not shards of one job.*inputs/0/hash is "', "merge", "m.cli", a, b, c, "other.cli")
        self.write(d, self.bytes_of(d) + b"x")
        self.fail_with(3, "not as it was", "merge", "m.cli", a, b, c, d)
        self.path(d + ".shard").unlink()
        self.fail_with(3, "has no stamp", "merge", "m.cli", a, b, c, d)

    def test_merge_of_files_without_stamps(self):
        self.lattice()
        self.succeed("slice", "part.stl", "-o", "whole.cli")
        for name, layers in [("a", ":50"), ("b", "50:90"), ("c", "90:"), ("overlap", "49:90"), ("gap", "51:90")]:
            self.succeed("slice", "part.stl", "-o", f"{name}.cli", "--layers", layers)
        self.succeed("merge", "merged.cli", "b.cli", "c.cli", "a.cli")
        self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"))
        self.fail_with(3, "a.cli and gap.cli: between them is a gap", "merge", "m.cli", "a.cli", "gap.cli", "c.cli")
        self.fail_with(3, "a.cli and overlap.cli: overlap", "merge", "m.cli", "a.cli", "overlap.cli", "c.cli")
        self.succeed("slice", "part.stl", "-o", "fine.cli", "--layers", "50:90", "--units-mm", "0.01")
        self.fail_with(3, "units of 0.001 and of 0.01 mm", "merge", "m.cli", "a.cli", "fine.cli", "c.cli")
        self.succeed("slice", "part.stl", "-o", "named.cli", "--layers", "50:90", "--label", "other")
        self.fail_with(3, "different parts", "merge", "m.cli", "a.cli", "named.cli", "c.cli")
        self.succeed("slice", "part.stl", "-o", "moved.cli", "--layers", "50:90", "--translate", "1,0,0")
        self.fail_with(3, r"their headers differ: found \$\$DIMENSION", "merge", "m.cli", "a.cli", "moved.cli", "c.cli")
        self.succeed("slice", "part.stl", "-o", "text.cli", "--layers", "50:90", "--format", "cli-ascii")
        self.fail_with(3, "one is cli, the other cli-ascii", "merge", "m.cli", "a.cli", "text.cli", "c.cli")
        self.fail_with(3, "no such file", "merge", "m.cli", "a.cli", "nowhere.cli")

    def test_merge_joins_only_files_that_are_laid_out_as_it_knows_them(self):
        self.lattice()
        for name, layers in [("a", ":50"), ("b", "50:")]:
            self.succeed("slice", "part.stl", "-o", f"{name}.cli", "--layers", layers)
            self.succeed("slice", "part.stl", "-o", f"{name}-text.cli", "--layers", layers, "--format", "cli-ascii")
        binary, text = self.bytes_of("b.cli"), self.bytes_of("b-text.cli")
        header = text[:text.index(b"$$LAYERS/")]
        count = int(text[text.index(b"$$LAYERS/") + 9:].split(b"\n")[0])
        without_zero = text.replace(b"$$LAYERS/%d" % count, b"$$LAYERS/%d" % (count - 1))
        zero = without_zero.index(b"$$LAYER/")
        without_zero = without_zero[:zero] + without_zero[without_zero.index(b"$$LAYER/", zero + 1):]
        others = {"binary behind": binary + b"\n", "padded": binary + bytes(4),
                  "binary user data": binary.replace(b"$$LAYERS/", b"$$USERDATA/x,1,$$HEADEREND\n$$LAYERS/", 1),
                  "no layer below": without_zero,
                  "comment": text.replace(b"$$GEOMETRYSTART\n", b"$$GEOMETRYSTART\n// $$LAYER/7 //\n"),
                  "comment in the head": header + b"// $$LAYERS/9 //\n" + text[len(header):]}
        for name, content in others.items():
            with self.subTest(name):
                self.write("b-other.cli", content)
                self.succeed("info", "b-other.cli")
                first = "a.cli" if name.startswith(("binary", "padded")) else "a-text.cli"
                merged = ["merge", "m.cli", first, "b-other.cli"] + ([] if first == "a.cli" else ["--format", "cli-ascii"])
                self.fail_with(3, "b-other.cli: is not laid out as Lamella writes it", *merged)
                self.succeed("merge", "m.json", first, "b-other.cli")

    def test_an_output_that_was_forgotten_is_no_reason_to_lose_a_file(self):
        self.lattice()
        for name, layers in [("a", ":50"), ("b", "50:90"), ("c", "90:")]:
            self.succeed("slice", "part.stl", "-o", f"{name}.cli", "--layers", layers)
        before = self.bytes_of("a.cli"), self.bytes_of("c.cli")
        self.fail_with(2, "a.cli: is to be written, but holds layers that adjoin those of b.cli", "merge", "a.cli", "b.cli", "c.cli")
        self.fail_with(2, "c.cli: is to be written, but holds layers that adjoin those of b.cli", "merge", "c.cli", "a.cli", "b.cli")
        self.assertEqual((self.bytes_of("a.cli"), self.bytes_of("c.cli")), before)
        for _ in range(2):  # an earlier result may be replaced, and so may what is no slice file
            self.succeed("merge", "merged.cli", "a.cli", "b.cli", "c.cli")
        self.write("notes.cli", "nothing")
        self.succeed("merge", "notes.cli", "a.cli", "b.cli", "c.cli")

    def test_merged_layers_are_numbered_through(self):
        self.lattice()
        shards = self.slice_all(2, "cli")
        self.succeed("merge", "merged.json", *shards)
        indices = [layer["index"] for layer in json.loads(self.bytes_of("merged.json"))["layers"]]
        self.assertEqual(indices, list(range(len(indices))))
        self.succeed("merge", "pictures", *shards, "--format", "png")

    def test_merge_grants_no_more_than_roundings_between_files(self):
        self.lattice()
        self.succeed("slice", "part.stl", "-o", "a.json", "--layers", ":50")
        for move, what in (("0,0,0.04", "between them is a gap"), ("0,0,-0.04", "overlap")):
            self.succeed("slice", "part.stl", "-o", "b.json", "--layers", "50:", "--translate", move)
            self.fail_with(3, what, "merge", "m.json", "a.json", "b.json")

    def test_merge_takes_shards_with_open_contours_and_without_some_of_the_parts(self):
        self.write("part.stl", binary_stl(open_box(4, 4, 4)))
        self.succeed("slice", "part.stl", "-o", "whole.svg", "--layer-height", "1")
        merged = self.succeed("merge", "merged.svg", *self.slice_all(2, "svg", "--layer-height", "1"))
        self.assertRegex(merged.err, r"part\.1\.svg: 2 contours are open")
        self.succeed("compare", "whole.svg", "merged.svg")
        self.succeed("make", "box", "--size", "4,4,8", "-o", "part.stl")
        self.succeed("make", "box", "--size", "4,4,2", "-o", "low.stl")
        for name, options in (("ovf", []), ("3mf", ["--format", "3mf-toolpath"])):
            plate = ["slice", "part.stl", "low.stl", "--translate", "9,0,0", "--layer-height", "1", *options]
            self.succeed(*plate, "-o", f"whole.{name}")
            shards = [f"shard.{i}.{name}" for i in (1, 2)]
            for i, shard in enumerate(shards, 1):
                self.succeed(*plate, "-o", shard, "--shard", f"{i}/2")
            self.succeed("merge", f"merged.{name}", *shards, *options)
            self.succeed("compare", f"whole.{name}", f"merged.{name}")

    def test_merge_refuses_layers_that_are_exposed_otherwise(self):
        self.succeed("make", "box", "--size", "4,4,4", "-o", "part.stl")
        self.write("strong.toml", "[parameters.hatch]\npower_w = 333\n")
        for name in ("ovf", "ilt"):
            scan = ["slice", "part.stl", "--layer-height", "1", "--scan"]
            self.succeed(*scan, "-o", f"a.{name}", "--layers", ":2")
            self.succeed(*scan, "-o", f"b.{name}", "--layers", "2:", "--strategy", "strong.toml")
            self.fail_with(3, rf"a\.{name} and b\.{name}: the part part core hatch has power_w 200 in one and 333 in the other",
                           "merge", f"m.{name}", f"a.{name}", f"b.{name}")

    def test_shards_may_differ_in_what_leaves_the_layers_alone(self):
        self.lattice()
        self.succeed("slice", "part.stl", "-o", "a.cli", "--shard", "1/2", "--inspect", "--max-output", "1G")
        self.succeed("slice", "part.stl", "-o", "b.cli", "--shard", "2/2", "--stats", "b.json")
        self.succeed("merge", "merged.cli", "a.cli", "b.cli")
        self.succeed("slice", "part.stl", "-o", "whole.cli")
        self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"))

    def test_what_cannot_be_shared_out(self):
        self.succeed("make", "box", "--size", "10,10,1", "-o", "part.stl")
        self.fail_with(2, "10 layers cannot be divided into 11", "slice", "part.stl", "-o", "a.cli", "--shard", "1/11")
        for share in ["0/3", "4/3", "3", "a/b", "1/0"]:
            self.fail_with(2, "share such as 2/8|whole number", "slice", "part.stl", "-o", "a.cli", "--shard", share)
        self.fail_with(2, "--resume goes with --shard", "slice", "part.stl", "-o", "a.cli", "--resume")
        self.fail_with(2, "--resume goes with --output", "slice", "part.stl", "--stats", "a.json", "--shard", "1/2", "--resume")
        self.fail_with(2, "from a file", "slice", "-", "-o", "a.cli", "--shard", "1/2")

    def folder_of_the_program(self):
        """A folder in which scripts find the program."""
        folder = self.path("bin")
        folder.mkdir()
        self.write("bin/lamella", f"#!/bin/sh\nexec {shlex.join(COMMAND)} \"$@\"\n").chmod(0o755)
        return folder

    def test_the_array_script_slices_and_merges(self):
        """The script of the Slurm example, with the variables that Slurm sets."""
        self.lattice()
        self.succeed("slice", "part.stl", "-o", "whole.cli")
        bin_ = self.folder_of_the_program()
        environment = dict(os.environ, PATH=f"{bin_}:{os.environ['PATH']}", PART="part.stl", SHARDS="3",
                           SLURM_CPUS_PER_TASK="2", SLURM_MEM_PER_NODE="2048")
        for index in [3, 1, 2, 2]:
            subprocess.run(["bash", CLUSTER / "slice.sbatch"], cwd=self.folder, check=True, capture_output=True,
                           env=dict(environment, SLURM_ARRAY_TASK_ID=str(index)))
        subprocess.run(["bash", CLUSTER / "merge.sbatch"], cwd=self.folder, check=True, capture_output=True,
                       env=environment)
        self.assertEqual(self.bytes_of("part.cli"), self.bytes_of("whole.cli"))

    def test_the_indexed_job_slices_and_merges(self):
        """The commands of the Kubernetes example, with the variable that it sets."""
        self.lattice()
        self.succeed("slice", "part.stl", "-o", "whole.cli")
        manifest = (CLUSTER / "indexed-job.yaml").read_text()
        try:
            import yaml
        except ImportError:
            self.skipTest("needs PyYAML (python3-yaml)")
        jobs = [job for job in yaml.safe_load_all(manifest)]
        slice_job, merge_job = (job["spec"] for job in jobs)
        self.assertEqual(slice_job["completionMode"], "Indexed")
        bin_ = self.folder_of_the_program()
        for spec, indices in [(slice_job, range(slice_job["completions"])), (merge_job, [0])]:
            container = spec["template"]["spec"]["containers"][0]
            for index in indices:
                environment = dict(os.environ, PATH=f"{bin_}:{os.environ['PATH']}", JOB_COMPLETION_INDEX=str(index))
                environment.update({e["name"]: e["value"] for e in container["env"] if "value" in e})
                environment["DATA"] = str(self.folder)
                subprocess.run(container["command"], cwd=self.folder, check=True, capture_output=True,
                               env=environment)
        self.assertEqual(self.bytes_of("part.cli"), self.bytes_of("whole.cli"))


if __name__ == "__main__":
    main()
