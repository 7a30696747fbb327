"""Ctrl-C: the program stops, says so with exit code 130, and leaves no file."""

import fcntl
import json
import signal
import struct
import subprocess
import termios
import time

from program import PROGRAM, ProgramTest, binary_stl, box_triangles, main


class Interrupt(ProgramTest):
    def start(self, *arguments):
        process = subprocess.Popen([PROGRAM] + list(arguments), cwd=self.folder, stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        return process

    def test_a_run_that_is_stopped_leaves_nothing(self):
        self.succeed("make", "rook")
        for number in [signal.SIGINT, signal.SIGTERM]:
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
        process = self.start("slice", "rook.stl", "-o", "rook.svg", "--layer-height", "0.0001",
                             "--progress", "json")
        fcntl.fcntl(process.stderr, fcntl.F_SETPIPE_SZ, 4096)
        while not any(name.endswith(".tmp") for name in self.listing()):
            json.loads(process.stderr.readline())
        waiting = 0
        for _ in range(20):  # until nothing more comes for a while
            time.sleep(0.5)
            before, waiting = waiting, self.unread(process.stderr)
            if before == waiting > 3500:
                break
        self.assertGreater(waiting, 3500)
        return process

    @staticmethod
    def unread(pipe):
        return struct.unpack("i", fcntl.ioctl(pipe, termios.FIONREAD, bytes(4)))[0]

    def test_a_run_that_is_stuck_leaves_nothing_either(self):
        process = self.start_and_get_stuck()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=60), 130)
        self.assertEqual(self.listing(), ["rook.stl"])
        process.communicate()

    def test_a_second_signal_leaves_nothing_either(self):
        process = self.start_and_get_stuck()
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=60), 130)
        self.assertEqual(self.listing(), ["rook.stl"])
        process.communicate()

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
