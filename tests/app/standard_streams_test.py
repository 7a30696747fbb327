"""Standard input, output and error: closed, sockets, pipes that do not block, and who may use them."""

import json
import os
import select
import signal
import socket
import subprocess
import threading

from program import (COMMAND, ON_WINDOWS, STOPPING_SIGNALS, ProgramTest, binary_stl, box_triangles, main, needs_posix, open_box,
                     windows_start)

CONTENTS = {"box.stl": binary_stl(box_triangles(2, 3, 1)), "z.txt": b"0.25\n0.75\n", "job.toml": b"layer-height = 0.5\n",
            "list": b"box.stl\n"}


class StandardStreams(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, content in CONTENTS.items():
            self.write(name, content)

    def start(self, *arguments, closed=(), **keywords):
        def close():
            for number in closed:
                os.close(number)
        # Wine itself needs these streams, unless a program for Windows starts the other.
        start = windows_start("closed=" + "".join(map(str, closed))) if ON_WINDOWS and closed else COMMAND
        process = subprocess.Popen([*start, *arguments], cwd=self.folder, preexec_fn=None if ON_WINDOWS else close,
                                   stderr=subprocess.PIPE, **{"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, **keywords})
        self.addCleanup(process.kill)
        return process

    def end_of(self, process):
        out, err = process.communicate(timeout=60)
        return process.returncode, out, err.decode()

    def test_standard_input_that_is_closed_is_an_error(self):
        for arguments in [["slice", "-", "-o", "y.cli"], ["info", "-"], ["verify", "-"], ["convert", "-", "y.svg"],
                          ["slice", "box.stl", "-o", "y.cli", "--z-list", "-"], ["slice", "box.stl", "-o", "y.cli", "--config", "-"],
                          ["slice", "--batch", "-", "-o", "out", "--format", "cli"]]:
            with self.subTest(arguments):
                code, _, err = self.end_of(self.start(*arguments, closed=[0]))
                self.assertEqual(code, 3, err)
                self.assertRegex(err, "^lamella: error: standard input.* closed")
        self.assertEqual(self.listing(), sorted(CONTENTS))

    def test_errors_name_standard_streams_in_words(self):
        self.succeed("slice", "box.stl", "-o", "top.json", "--slice-at", "top", "--layer-height", "0.5")
        layers, opened = self.bytes_of("top.json"), binary_stl(open_box(2, 3, 1))
        job = ["--format", "cli", "-o", "-"]
        for code, named, arguments, stdin in [
                (4, "standard output", ["convert", "top.json", "-", "--format", "cli", "--strict"], b""),
                (4, "standard output", ["convert", "-", "-", "--format", "cli", "--strict"], layers),
                (4, "standard output", ["slice", "-", *job, "--slice-at", "top", "--strict"], CONTENTS["box.stl"]),
                (5, "standard output", ["slice", "-", *job, "--max-output", "100"], CONTENTS["box.stl"]),
                (4, "standard input", ["slice", "-", *job, "--strict"], opened),
                (2, "standard input", ["slice", "-", *job, "--layer-height", "9"], opened),
                (2, "standard input", ["slice", "-", "box.stl", *job, "--z-range", "7:8"], opened)]:
            with self.subTest(arguments):
                self.fail_with(code, f"^lamella: error: {named}: [^-]", *arguments, stdin=stdin)

    def test_a_run_without_standard_streams_does_its_work(self):
        self.succeed("slice", "box.stl", "-o", "expected.cli")
        for closed in [[0], [1], [0, 1], [0, 1, 2]]:
            with self.subTest(closed):
                code, out, err = self.end_of(self.start("slice", "box.stl", "-o", "y.cli", "--report", "y.html", closed=closed))
                self.assertEqual((code, err), (0, ""))
                self.assertEqual(self.bytes_of("y.cli"), self.bytes_of("expected.cli"))
                self.path("y.cli").unlink()
        for arguments in [["make", "box", "-o", "y.stl"], ["convert", "expected.cli", "y.svg"], ["view", "box.stl"]]:
            self.assertEqual(self.end_of(self.start(*arguments, closed=[1]))[0], 0)

    def test_a_result_for_a_closed_standard_output_is_an_error(self):
        for arguments in [["slice", "box.stl", "-o", "-", "--format", "cli"], ["slice", "box.stl", "--stats", "-"],
                          ["info", "box.stl"], ["--help"], ["make", "box", "-o", "-"]]:
            with self.subTest(arguments):
                code, _, err = self.end_of(self.start(*arguments, closed=[1]))
                self.assertEqual(code, 6, err)
                self.assertRegex(err, "^lamella: error: .*standard output.* closed")

    @needs_posix("signals")
    def test_a_reader_of_results_that_has_gone_ends_a_run_in_silence(self):
        """As `lamella help --man | head -1` does; whoever ignores the signal gets an error."""
        for arguments in [["help", "--man"], ["slice", "--help"], ["info", "box.stl", "--json"], ["slice", "box.stl", "-o", "-", "--format", "cli"],
                          ["slice", "box.stl", "-o", "box.cli"]]:
            for ignored in [False, True]:
                with self.subTest(arguments, ignored=ignored):
                    reading, writing = os.pipe()
                    os.close(reading)
                    # Python ignores the signal, and restores it for its children unless it is told not to.
                    process = subprocess.run([*COMMAND, *arguments], cwd=self.folder, stdout=writing, stderr=subprocess.PIPE,
                                             restore_signals=not ignored, timeout=60)
                    os.close(writing)
                    if ignored:
                        self.assertEqual(process.returncode, 6)
                        self.assertTrue(process.stderr)
                    else:
                        self.assertEqual((process.returncode, process.stderr), (-signal.SIGPIPE, b""))
        self.assertEqual(self.listing(), sorted([*CONTENTS, "box.cli"]))

    def test_a_signal_ends_a_run_that_waits_for_standard_input(self):
        reading, writing = os.pipe()
        self.addCleanup(os.close, writing)
        for arguments in [["slice", "-", "-o", "y.cli"], ["info", "-"]]:
            process = self.start(*arguments, stdin=reading)
            os.write(writing, b"solid")
            self.assertTrue(self.waits_for_more(process, reading))
            process.send_signal(STOPPING_SIGNALS[-1])
            self.assertIn(self.end_of(process)[0], [130, -signal.SIGTERM])
        os.close(reading)

    @staticmethod
    def waits_for_more(process, reading):
        """Once it takes what is written for it, it is at its standard input, and then there is nothing more."""
        while process.poll() is None:
            if not select.select([reading], [], [], 0)[0]:
                return True
        return False

    READERS = [("box.stl", ["info", "-", "--json"]), ("box.stl", ["slice", "-", "--stats", "-", "--layer-height", "0.5"]),
               ("z.txt", ["slice", "box.stl", "--z-list", "-", "--stats", "-"]),
               ("job.toml", ["slice", "box.stl", "--config", "-", "--stats", "-"]),
               ("list", ["slice", "--batch", "-", "-o", "out", "--format", "cli", "--layer-height", "0.5"])]

    def test_a_socket_will_do_as_standard_input(self):
        for name, arguments in self.READERS:
            with self.subTest(arguments):
                ours, theirs = socket.socketpair()
                process = self.start(*arguments, stdin=theirs)
                theirs.close()
                ours.sendall(CONTENTS[name])
                ours.close()
                self.check_layers(self.end_of(process))

    def test_a_pipe_that_does_not_block_will_do_as_standard_input(self):
        for name, arguments in self.READERS:
            with self.subTest(arguments):
                reading, writing = os.pipe()
                os.set_blocking(reading, False)
                process = self.start(*arguments, stdin=reading)
                os.close(reading)

                def write():
                    for byte in CONTENTS[name]:
                        os.write(writing, bytes([byte]))
                    os.close(writing)
                writer = threading.Thread(target=write)
                writer.start()
                self.check_layers(self.end_of(process))
                writer.join()

    def check_layers(self, end):
        code, out, err = end
        self.assertEqual(code, 0, err)
        told = json.loads(out)
        layers = told.get("layers", 2)
        self.assertEqual(layers if isinstance(layers, int) else len(layers), 2)
        self.assertFalse(self.path("-").exists())

    def test_only_one_can_read_standard_input(self):
        for first, second, arguments in [("FILE", "FILE", ["slice", "-", "-", "-o", "y.cli"]),
                                         ("FILE", "--z-list", ["slice", "-", "-o", "y.cli", "--z-list", "-"]),
                                         ("--batch", "--config", ["slice", "--batch", "-", "--config", "-", "-o", "y"]),
                                         ("FILE", "--mesh", ["verify", "-", "--mesh", "-"]),
                                         ("FIRST", "SECOND", ["compare", "-", "-"]),
                                         ("SHARD", "SHARD", ["merge", "y.cli", "-", "-"])]:
            with self.subTest(arguments):
                self.fail_with(2, f"{first} - and {second} - contradict each other: standard input holds one file only", *arguments)

    @needs_posix("pipes and devices with names")
    def test_what_the_system_calls_standard_output_is_it(self):
        for arguments in [["slice", "box.stl", "-o", "-", "--format", "cli"], ["make", "box", "-o", "-"],
                          ["slice", "box.stl", "-o", "x.cli", "--stats", "-"]]:
            with self.subTest(arguments):
                expected = self.succeed(*arguments)
                for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"]:
                    result = self.succeed(*[name if a == "-" else a for a in arguments])
                    if "--stats" not in arguments:  # which tell of seconds
                        self.assertEqual(result.out, expected.out)
                    else:
                        self.assertEqual(result.json()["layers"], expected.json()["layers"])
        self.succeed("slice", "box.stl", "-o", "x.cli")
        converted = self.succeed("convert", "x.cli", "/dev/stdout", "--format", "svg")
        self.assertEqual(converted.out, self.succeed("convert", "x.cli", "-", "--format", "svg").out)
        self.fail_with(2, "contradict.*standard output", "slice", "box.stl", "-o", "-", "--format", "cli", "--stats", "/dev/stdout")

    def test_only_one_can_write_standard_output(self):
        self.fail_with(2, "--output - and --report - contradict.*standard output", "slice", "box.stl", "-o", "-", "--format", "cli",
                       "--report", "-")


if __name__ == "__main__":
    main()
