"""Ctrl-C: the program stops, says so with exit code 130, and leaves no file."""

import fcntl
import json
import os
import signal
import subprocess
import time

from program import COMMAND, STOPPING_SIGNALS, ProgramTest, binary_stl, box_triangles, main, needs_posix


class Interrupt(ProgramTest):
    def start(self, *arguments):
        process = subprocess.Popen([*COMMAND, *arguments], cwd=self.folder, stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        return process

    def test_a_run_that_is_stopped_leaves_nothing(self):
        self.succeed("make", "rook")
        for number in STOPPING_SIGNALS:
            with self.subTest(number):
                # Half a million layers: minutes of work and gigabytes of output, had it been left alone.
                process = self.start("slice", "rook.stl", "-o", "rook.svg", "--layer-height", "0.0001",
                                     "--progress", "json")
                for line in process.stderr:
                    event = json.loads(line)
                    if event["stage"] == "slice" and event["done"] > 0:
                        break
                process.send_signal(number)
                out, err = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 130)
                self.assertEqual(out, b"")
                self.assertEqual(json.loads(err.splitlines()[-1])["exit_code"], 130)
                self.assertEqual(self.listing(), ["rook.stl"])

    def start_and_get_stuck(self):
        """Slices until the program waits for somebody to read standard error, in the midst of writing."""
        self.succeed("make", "rook")
        error_read, error_write = os.pipe()
        fcntl.fcntl(error_write, fcntl.F_SETPIPE_SZ, 4096)
        process = subprocess.Popen([*COMMAND, "slice", "rook.stl", "-o", "rook.svg", "--layer-height", "0.0001",
                                    "--progress", "json"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=error_write)
        self.addCleanup(process.kill)
        lines = self.enterContext(os.fdopen(error_read))
        while not self.has_unfinished_file(process):
            json.loads(lines.readline())
        self.fill(error_write)
        os.close(error_write)
        self.wait_until_stuck(process)
        return process

    def wait_until_stuck(self, process):
        before, now = -1, self.processor_ticks(process)
        while before != now:
            time.sleep(0.5)
            before, now = now, self.processor_ticks(process)
        self.assertIsNone(process.poll())

    @staticmethod
    def fill(pipe):
        """Leaves no room for another byte. The pipe is opened once more, so that it stays blocking for the program."""
        with open(f"/proc/self/fd/{pipe}", "wb", buffering=0, opener=lambda path, flags: os.open(
                path, flags & ~(os.O_CREAT | os.O_TRUNC) | os.O_NONBLOCK)) as writer:
            while writer.write(b"."):
                pass

    @staticmethod
    def processor_ticks(process):
        with open(f"/proc/{process.pid}/stat") as stat:
            user, system = stat.read().rpartition(")")[2].split()[11:13]
        return int(user) + int(system)

    def test_a_run_that_is_stuck_leaves_nothing_either(self):
        process = self.start_and_get_stuck()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=60), 130)
        self.assertEqual(self.listing(), ["rook.stl"])

    @needs_posix("signals")
    def test_processor_time_that_is_used_up_is_a_limit_and_leaves_nothing(self):
        self.succeed("make", "rook")
        process = self.start("slice", "rook.stl", "-o", "rook", "--format", "png", "--layer-height", "0.001", "--progress", "json")
        while process.poll() is None and not self.has_unfinished_file(process):
            time.sleep(0.01)
        process.send_signal(signal.SIGXCPU)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 5)
        last = [json.loads(line) for line in err.splitlines()][-1]
        self.assertEqual(last["exit_code"], 5)
        self.assertIn("processor time", last["error"])
        self.assertEqual(self.listing(), ["rook.stl"])

    @needs_posix("signals")
    def test_other_signals_that_end_a_program_leave_nothing_either(self):
        """Ctrl-\\, and what batch systems announce their limits by."""
        self.succeed("make", "rook")
        for name in ["SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGVTALRM", "SIGPROF"]:
            with self.subTest(name):
                process = self.start("slice", "rook.stl", "-o", "rook", "--format", "png", "--layer-height", "0.001")
                while process.poll() is None and not self.has_unfinished_file(process):
                    time.sleep(0.01)
                process.send_signal(signal.Signals[name])
                process.communicate(timeout=60)
                self.assertEqual(process.returncode, -signal.Signals[name])
                self.assertEqual([one for one in self.listing() if not one.startswith("core")], ["rook.stl"])

    def test_a_second_signal_leaves_nothing_either(self):
        process = self.start_and_get_stuck()
        process.send_signal(signal.SIGINT)
        time.sleep(0.3)  # those of one moment count as one
        process.send_signal(STOPPING_SIGNALS[-1])
        self.assertEqual(process.wait(timeout=60), 130)
        self.assertEqual(self.listing(), ["rook.stl"])

    @needs_posix("pipes and devices with names")
    def test_whoever_does_not_read_what_is_reported_keeps_no_run_from_ending(self):
        self.box()
        reading, writing = os.pipe()
        self.addCleanup(os.close, reading)
        self.addCleanup(os.close, writing)
        self.fill(writing)
        missing = ["slice", "missing.stl", "-o", "x.cli", "--progress", "json"]
        for arguments, stuck in [(["info", "box.stl"], "stdout"), (["slice", "box.stl", "-o", "box.cli"], "stdout"),
                                 (["--help"], "stdout"), (missing, "stderr")]:
            with self.subTest(arguments):
                process = subprocess.Popen([*COMMAND, *arguments], cwd=self.folder,
                                           **{"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, stuck: writing})
                self.addCleanup(process.kill)
                self.wait_until_it_hears(process, signal.SIGTERM)
                self.wait_until_stuck(process)
                process.send_signal(signal.SIGTERM)
                self.assertEqual(process.wait(timeout=60), 130)

    @needs_posix("pipes and devices with names")
    def test_waiting_for_a_configuration_file_can_be_stopped(self):
        os.mkfifo(self.path("pipe"))
        process = self.start("slice", "box.stl", "-o", "box.cli", "--config", "pipe")
        self.wait_until_it_hears(process, signal.SIGTERM)
        process.send_signal(signal.SIGTERM)
        self.assertIn(b"cancelled", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 130)

    def wait_until_it_hears(self, process, number):
        """The program blocks the signals that it waits for."""
        end = time.monotonic() + 60
        while time.monotonic() < end and process.poll() is None:
            status = self.path(f"/proc/{process.pid}/status").read_text()
            blocked = next(line for line in status.splitlines() if line.startswith("SigBlk:"))
            if int(blocked.split()[1], 16) >> (number - 1) & 1:
                return
            time.sleep(0.01)
        self.fail("it hears no signal")

    def test_waiting_for_standard_input_can_be_stopped(self):
        process = self.start("slice", "-", "-o", "out.cli")
        # More than a pipe holds: once it is written, the program is known to be reading.
        process.stdin.write(binary_stl(box_triangles(1, 1, 1) * 5000))
        process.stdin.flush()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=60), 130)
        self.assertIn(b"cancelled", process.stderr.read())
        self.assertEqual(self.listing(), [])
        process.stdin.close()
        process.stdout.close()
        process.stderr.close()


if __name__ == "__main__":
    main()
