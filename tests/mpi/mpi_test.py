"""lamella-mpi: the same bytes and statistics as by one process, and no output when a process dies."""

import json
import math
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, Result, binary_stl, box_triangles, open_box  # noqa: E402

MPI_PROGRAM = os.environ.get("LAMELLA_MPI_PROGRAM", "")
MPIRUN = os.environ.get("LAMELLA_MPIRUN", "mpirun")
PROCESSES_TEST = os.environ.get("LAMELLA_MPI_PROCESSES_TEST", "")
NUMBERS = [1, 2, 3, 5]


@unittest.skipUnless(MPI_PROGRAM and shutil.which(MPIRUN), "run by ctest, where there is an MPI")
class MpiTest(ProgramTest):
    def command(self, processes, *arguments):
        return [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-n", str(processes), *map(str, arguments)]

    def run_command(self, command):
        # Tests may run beside each other, and processes of MPI wait busily unless told not to.
        environment = dict(os.environ, OMPI_MCA_mpi_yield_when_idle="1")
        return Result(subprocess.run(command, cwd=self.folder, capture_output=True, timeout=240, env=environment))

    def by(self, processes, *arguments):
        return self.run_command(self.command(processes, MPI_PROGRAM, *arguments))

    def all_of(self, path):
        path = self.path(path)
        return {p.name: p.read_bytes() for p in path.iterdir()} if path.is_dir() else path.read_bytes()

    @staticmethod
    def figures(text):
        stats = json.loads(text)
        for varying in ["seconds", "peak_rss_bytes", "threads", "processes"]:
            stats.pop(varying, None)
        return stats


class Results(MpiTest):
    def test_the_same_bytes_and_statistics(self):
        self.succeed("make", "rook")
        for options in [["--format", "cli"], ["--format", "cli", "--short", "--units-mm", "0.01"], ["--format", "svg"],
                        ["--format", "json"], ["--format", "npz"], ["--format", "png"]]:
            common = ["slice", "rook.stl", *options, "--layer-height", "0.7", "-o", "out", "--stats", "stats.json"]
            if "--short" in options:
                common += ["--translate", "50,50,50"]
            self.succeed(*common)
            expected, figures = self.all_of("out"), self.figures(self.bytes_of("stats.json"))
            for processes in NUMBERS if options == ["--format", "cli"] else [3]:
                with self.subTest(options, processes=processes):
                    self.path("stats.json").unlink()
                    result = self.by(processes, *common)
                    self.assertEqual(result.code, 0, result.err)
                    self.assertEqual(self.all_of("out"), expected)
                    self.assertEqual(self.figures(self.bytes_of("stats.json")), figures)
                    self.assertEqual(result.text.count("written  out"), 1)
            path = self.path("out")
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def test_what_cannot_be_shared_out_is_read_by_all(self):
        self.succeed("make", "torus", "-o", "torus.obj")
        self.succeed("slice", "torus.obj", "-o", "one.cli", "--adaptive", "0.1:0.4")
        result = self.by(3, "slice", "torus.obj", "-o", "many.cli", "--adaptive", "0.1:0.4")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(self.bytes_of("many.cli"), self.bytes_of("one.cli"))

    def test_triangles_that_are_left_out_are_reported_of_all_shares(self):
        triangles = box_triangles(10, 20, 30)
        self.write("holes.stl", binary_stl(triangles[:5] + [((math.nan, 0, 0), (1, 0, 0), (0, 1, 0))] + triangles[5:]))
        one = self.succeed("slice", "holes.stl", "-o", "one.cli")
        many = self.by(3, "slice", "holes.stl", "-o", "many.cli")
        self.assertEqual(many.code, 0, many.err)
        warning = "holes.stl: left out 1 of 13 triangles, which have a corner that is NaN or infinite (the first is triangle 6 at byte 334)"
        for result in [one, many]:
            self.assertEqual(result.err.count(warning), 1, result.err)

    def test_losses_of_a_format_are_reported_once_with_the_counts_of_all_processes(self):
        self.box(size="2,2,6")
        for options in [["--slice-at", "top"],  # heights of cuts
                        ["--format", "cli-ascii", "--units-mm", "0.3", "--rotate-z", "20"]]:  # points and heights
            common = ["slice", "box.stl", "--layer-height", "0.7", *options, "-o"]
            one = self.succeed(*common, "one.cli")
            self.assertIn("warning: one.cli: ", one.err)
            refused = self.fail_with(4, "strict.cli: ", *common, "strict.cli", "--strict")
            for processes in NUMBERS:
                with self.subTest(options, processes=processes):
                    many = self.by(processes, *common, "many.cli")
                    self.assertEqual(many.code, 0, many.err)
                    self.assertEqual(many.err, one.err.replace("one.cli", "many.cli"))
                    strict = self.by(processes, *common, "strict.cli", "--strict")
                    self.assertEqual(strict.code, 4, strict.err)
                    self.assertIn(refused.err, strict.err)
                    self.assertFalse(self.path("strict.cli").exists())

    def peak_of(self, processes, *arguments):
        """Bytes that the largest of all processes of a job took."""
        watch = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL); "
                 "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
        command = [sys.executable, "-c", watch, *self.command(processes, MPI_PROGRAM, *arguments)]
        result = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=240,
                                env=dict(os.environ, OMPI_MCA_mpi_yield_when_idle="1"))
        self.assertEqual(result.returncode, 0, result.stderr)
        return 1024 * int(result.stdout)

    def test_no_process_takes_more_than_it_may(self):
        self.succeed("make", "lattice", "--cells", 12, "-o", "part.stl")  # 45 MB; to slice it whole takes 130 MB
        common = ["slice", "part.stl", "--threads", "1", "--layer-height", "0.2"]
        limit = 60_000_000
        for name in ["cli", "npz"]:  # written by all, and by the first process
            self.succeed(*common, "-o", f"expected.{name}")
            for processes in [1, 2, 3]:
                with self.subTest(name, processes=processes):
                    peak = self.peak_of(processes, *common, "-o", f"out.{name}", "--max-memory", limit)
                    self.assertLess(peak, 1.1 * limit)
                    self.assertEqual(self.bytes_of(f"out.{name}"), self.bytes_of(f"expected.{name}"))

    def test_standard_output(self):
        self.box()
        one = self.succeed("slice", "box.stl", "-o", "-", "--format", "svg")
        many = self.by(3, "slice", "box.stl", "-o", "-", "--format", "svg")
        self.assertEqual(many.code, 0, many.err)
        self.assertEqual(many.out, one.out)

    def test_messages_of_any_length(self):
        for processes in NUMBERS:
            result = subprocess.run(self.command(processes, PROCESSES_TEST), capture_output=True, timeout=120)
            self.assertEqual(result.returncode, 0, result.stderr)


class Failures(MpiTest):
    def fail_together(self, code, pattern, *arguments):
        before = self.listing()
        result = self.by(3, *arguments)
        self.assertEqual(result.code, code, result.err)
        errors = [line for line in result.err.splitlines() if line.startswith("lamella: error: ")]
        self.assertEqual(len(errors), 1, result.err)
        self.assertRegex(errors[0], pattern)
        self.assertEqual(self.listing(), before)

    def test_errors_are_reported_once(self):
        self.box()
        self.write("open.stl", binary_stl(open_box(1, 2, 3)))
        self.write("noise.stl", b"no mesh")
        self.fail_together(2, "--layer-hight", "slice", "box.stl", "-o", "out.cli", "--layer-hight", "1")
        self.fail_together(2, "standard input", "slice", "-", "-o", "out.cli")
        for option in ["--strategy", "--config", "--z-list"]:
            for path in ["-", "/dev/stdin"]:
                self.fail_together(2, f"{option} -: standard input reaches one of the processes", "slice", "box.stl", "-o", "out.cli", option, path)
        self.fail_together(2, "--batch is for lamella", "slice", "--batch", ".", "-o", "out", "--format", "cli")
        self.fail_together(3, "no such file", "slice", "missing.stl", "-o", "out.cli")
        self.fail_together(3, "noise.stl", "slice", "noise.stl", "-o", "out.cli")
        self.fail_together(4, "open.stl", "slice", "open.stl", "-o", "out.cli", "--strict")
        self.fail_together(5, "more than the 100 bytes that it may", "slice", "box.stl", "-o", "out.cli", "--max-output", "100")
        nothing = (math.nan, 0, 0), (1, 0, 0), (0, 1, 0)
        self.write("none.stl", binary_stl([nothing] * 5))
        self.fail_together(3, "holds no usable triangle: each of the 5", "slice", "none.stl", "-o", "out.cli")
        self.write("holes.stl", binary_stl([nothing, *box_triangles(1, 2, 3)]))
        self.fail_together(4, "left out 1 of 13", "slice", "holes.stl", "-o", "out.cli", "--strict")
        self.fail_together(6, "does not exist", "slice", "box.stl", "-o", "nowhere/out.cli")

    def test_processes_of_different_jobs_are_reported(self):
        self.box()
        one = [MPI_PROGRAM, "slice", "box.stl", "-o", "out.cli", "--layer-height"]
        result = self.run_command(self.command(1, *one, "0.1", ":", "-n", "1", *one, "0.2"))
        self.assertEqual(result.code, 2, result.err)
        self.assertIn("not given one job: options/layer-height is 0.1 in the one and 0.2 in the other", result.err)
        self.assertFalse(self.path("out.cli").exists())

    def processes_of(self, process):
        """The processes of the program: whose command it is."""
        found = []
        for entry in Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                if words[0].decode() == MPI_PROGRAM and Path(os.readlink(entry / "cwd")) == self.folder.resolve():
                    found.append(int(entry.name))
            except (FileNotFoundError, ProcessLookupError, PermissionError):
                continue
        return sorted(found)

    def test_a_process_that_dies_ends_the_job_without_an_output(self):
        self.write("part.stl", binary_stl(box_triangles(10, 20, 30)))
        self.write("out.cli", "old")
        for victim in [2, 0]:
            with self.subTest(victim):
                # Millions of layers: minutes of work, had it been left alone.
                process = subprocess.Popen(self.command(3, MPI_PROGRAM, "slice", "part.stl", "-o", "out.cli",
                                                        "--layer-height", "0.00003"), cwd=self.folder,
                                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                self.addCleanup(process.stderr.close)
                self.addCleanup(process.kill)
                # The temporary file is there: all processes are slicing.
                while not any(name.endswith(".tmp") for name in self.listing()):
                    self.assertIsNone(process.poll())
                    time.sleep(0.01)
                processes = self.processes_of(process)
                self.assertEqual(len(processes), 3)
                os.kill(processes[victim], signal.SIGKILL)
                self.assertNotEqual(process.wait(timeout=60), 0)
                self.assertIn(b"signal 9", process.stderr.read())
                self.assertEqual(self.bytes_of("out.cli"), b"old")
                self.assertEqual(self.processes_of(process), [])
                # Nobody but process 0 knows of the temporary file.
                left = [name for name in self.listing() if name.endswith(".tmp")]
                self.assertEqual(len(left), 1 if victim == 0 else 0, left)


if __name__ == "__main__":
    unittest.main()
