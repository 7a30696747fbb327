"""lamella slice --shard and lamella merge: shares of equal work, put together to the bytes of a single run."""

import json
import os
import shutil
import subprocess

from program import PROGRAM, SOURCE, ProgramTest, main

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
            self.assertIn("slabs", json.loads(self.bytes_of("b.json")))
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

    def test_merge_refuses_what_does_not_belong_together(self):
        self.lattice()
        a, b, c, d = self.slice_all(4, "cli")
        begin, end = self.stamp(c)["layers"]
        self.fail_with(3, f"layers {begin} to {end - 1} of {self.stamp(a)['of']} are in none", "merge", "m.cli", a, b, d)
        self.fail_with(3, "layers 0 to", "merge", "m.cli", b, c, d)
        self.fail_with(3, "are in none", "merge", "m.cli", a, b, c)
        self.fail_with(3, "another file holds", "merge", "m.cli", a, b, b, c, d)
        self.fail_with(2, "overwrite", "merge", a, a, b)
        self.succeed("slice", "part.stl", "-o", "other.cli", "--shard", "4/4", "--units-mm", "0.01")
        self.fail_with(3, 'not shards of one job.*"options"', "merge", "m.cli", a, b, c, "other.cli")
        self.succeed("make", "lattice", "--cells", 3, "-o", "part.stl")
        self.succeed("slice", "part.stl", "-o", "other.cli", "--shard", "4/4")
        self.fail_with(3, 'not shards of one job.*"inputs"', "merge", "m.cli", a, b, c, "other.cli")
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
        self.fail_with(3, r"their heads differ: found \$\$DIMENSION", "merge", "m.cli", "a.cli", "moved.cli", "c.cli")
        self.succeed("slice", "part.stl", "-o", "text.cli", "--layers", "50:90", "--format", "cli-ascii")
        self.fail_with(3, "one is cli, the other cli-ascii", "merge", "m.cli", "a.cli", "text.cli", "c.cli")
        self.fail_with(3, "no such file", "merge", "m.cli", "a.cli", "nowhere.cli")

    def test_what_cannot_be_shared_out(self):
        self.succeed("make", "box", "--size", "10,10,1", "-o", "part.stl")
        self.fail_with(2, "10 layers cannot be divided into 11", "slice", "part.stl", "-o", "a.cli", "--shard", "1/11")
        for share in ["0/3", "4/3", "3", "a/b", "1/0"]:
            self.fail_with(2, "share such as 2/8|whole number", "slice", "part.stl", "-o", "a.cli", "--shard", share)
        self.fail_with(2, "--resume goes with --shard", "slice", "part.stl", "-o", "a.cli", "--resume")
        self.fail_with(2, "from a file", "slice", "-", "-o", "a.cli", "--shard", "1/2")

    def test_the_array_script_slices_and_merges(self):
        """The script of the Slurm example, with the variables that Slurm sets."""
        self.lattice()
        self.succeed("slice", "part.stl", "-o", "whole.cli")
        bin_ = self.path("bin")
        bin_.mkdir()
        (bin_ / "lamella").symlink_to(PROGRAM)
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
        bin_ = self.path("bin")
        bin_.mkdir()
        (bin_ / "lamella").symlink_to(PROGRAM)
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
