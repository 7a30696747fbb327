"""lamella slice --timeout: a run that takes too long ends by itself, says how far it came, and leaves no file."""

import json
import os
import subprocess

from program import COMMAND, ON_WINDOWS, ProgramTest, main


class Timeout(ProgramTest):
    def test_every_engine_is_stopped(self):
        # Half a million layers: minutes of work with any engine, had it been left alone.
        self.succeed("make", "rook")
        for engine in self.engines():
            with self.subTest(engine):
                self.fail_with(5, r"rook\.stl: stopped after 0\.3 s \(--timeout\) in the stage (read|weld|link|slice), of which "
                                  r"\d+ % was done; nothing was written", "slice", "rook.stl", "-o", "rook.cli",
                               "--layer-height", "0.0001", "--engine", engine, "--timeout", "0.3")

    def test_an_older_result_stays(self):
        self.succeed("make", "rook")
        self.write("rook.cli", "old")
        result = self.run_program("slice", "rook.stl", "-o", "rook.cli", "--layer-height", "0.0001", "--stats",
                                  "rook.json", "--timeout=0.2")
        self.assertEqual(result.code, 5)
        self.assertEqual(self.bytes_of("rook.cli"), b"old")
        self.assertEqual(self.listing(), ["rook.cli", "rook.stl"])

    def test_a_run_that_ends_in_time_is_as_without_it(self):
        self.box()
        self.succeed("slice", "box.stl", "-o", "a.cli")
        for seconds in ["240", "1e300"]:
            result = self.succeed("slice", "box.stl", "-o", "b.cli", "--timeout", seconds)
            self.assertEqual(result.err, "")
            self.assertEqual(self.bytes_of("a.cli"), self.bytes_of("b.cli"))

    def stuck(self, *arguments):
        """What a program says on standard error that waits for standard input, until its time is up."""
        process = subprocess.Popen([*COMMAND, "slice", "-", "-o", "out.cli", "--timeout", "0.1", *arguments],
                                   cwd=self.folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        self.assertEqual(process.wait(timeout=60), 5)
        self.assertEqual(self.listing(), [])
        process.stdin.close()
        with process.stderr as err:
            return err.read().decode()

    def test_waiting_for_standard_input_is_stopped(self):
        self.assertIn("lamella: error: standard input: stopped after 0.1 s (--timeout)", self.stuck())
        last = json.loads(self.stuck("--progress", "json").splitlines()[-1])
        self.assertEqual(last["exit_code"], 5)
        self.assertIn("stopped after 0.1 s (--timeout)", last["error"])

    def test_waiting_for_a_list_or_a_configuration_file_is_stopped(self):
        self.box()
        self.make_pipe("pipe")

        def is_stopped(option):
            result = self.run_program("slice", "box.stl", "-o", "box.cli", "--timeout", "0.2", option, "pipe")
            self.assertEqual(result.code, 5, result.err)
            self.assertIn("pipe: stopped after 0.2 s (--timeout)", result.err)  # not of the mesh
            self.assertEqual(self.listing(), ["box.stl", "pipe"])
        for option in ["--z-list", "--config", "--strategy"]:
            with self.subTest(option):
                is_stopped(option)
                with open(self.path("pipe"), "r+b", buffering=0):  # the other end is open, and nothing comes
                    is_stopped(option)

    def test_whoever_does_not_take_the_figures_is_not_waited_for(self):
        self.box()
        os.mkfifo(self.path("pipe"))
        reading, writing = os.pipe()
        self.addCleanup(os.close, reading)
        self.addCleanup(os.close, writing)
        os.set_blocking(writing, False)
        with open(writing, "wb", buffering=0, closefd=False) as pipe:
            while pipe.write(b"."):
                pass
        os.set_blocking(writing, True)
        cases = [(["--stats", "-"], writing), ([], writing)]
        if not ON_WINDOWS:  # whose pipes have other names
            cases.append((["--stats", "pipe"], subprocess.DEVNULL))
        for more, stdout in cases:
            with self.subTest(more):
                process = subprocess.Popen([*COMMAND, "slice", "box.stl", "-o", "box.cli", "--timeout", "2", "--progress", "json",
                                            *more], cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE)
                self.addCleanup(process.kill)
                err = process.communicate(timeout=60)[1].decode()
                self.assertEqual(process.returncode, 5, err)
                last = [json.loads(line) for line in err.splitlines()][-1]
                self.assertEqual(last["exit_code"], 5)
                self.assertIn("box.stl: stopped after 2 s (--timeout) while results were written; box.cli is complete", last["error"])
                self.path("box.cli").unlink()

    def test_progress_as_json_ends_with_the_error(self):
        self.succeed("make", "rook")
        result = self.run_program("slice", "rook.stl", "-o", "rook.cli", "--layer-height", "0.0001", "--engine",
                                  "eecc", "--progress", "json", "--timeout", "0.3")
        events = [json.loads(line) for line in result.err.splitlines()]
        self.assertEqual(events[-1]["exit_code"], 5)
        self.assertIn(f"in the stage {events[-2]['stage']}", events[-1]["error"])

    def test_only_a_time_makes_sense(self):
        self.box()
        for text in ["0", "-1", "soon", "nan", "inf"]:
            self.fail_with(2, "--timeout", "slice", "box.stl", "-o", "box.cli", f"--timeout={text}")


if __name__ == "__main__":
    main()
