"""A terminal, in Wine a console of Windows: the progress bar, errors, and Ctrl-C that somebody types."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time
import unittest

from program import COMMAND, ON_WINDOWS, ProgramTest, main, needs_posix


class Terminal(ProgramTest):
    def run_in_terminal(self, *arguments, typed=b"", after="", columns=0):
        """The exit code and what is shown. Once `after` is shown, somebody types. 0 columns: the terminal does not know."""
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24 if columns else 0, columns, 0, 0))
        process = subprocess.Popen([*COMMAND, *arguments], cwd=self.folder, stdin=theirs, stdout=theirs, stderr=theirs,
                                   start_new_session=True, preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
        self.addCleanup(process.kill)
        os.close(theirs)
        shown = b""
        end = time.monotonic() + 120
        while time.monotonic() < end:
            if select.select([ours], [], [], 0.2)[0]:
                try:
                    got = os.read(ours, 4096)
                except OSError:  # the program has ended
                    break
                if not got:
                    break
                shown += got
                if typed and after in self.text_of(shown):
                    os.write(ours, typed)
                    typed = b""
            elif process.poll() is not None:
                break
        code = process.wait(timeout=60)
        os.close(ours)
        return code, self.text_of(shown)

    @staticmethod
    def text_of(shown):
        """Without the movements of the cursor; a console moves it over blanks that are there."""
        text = shown.decode("utf-8", "replace").replace("\x1b[1C", " ")
        return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)

    def test_progress_is_a_bar(self):
        self.succeed("make", "lattice")
        code, text = self.run_in_terminal("slice", "lattice.stl", "-o", "lattice.cli", "--scan", "--threads", "1")
        self.assertEqual(code, 0, text)
        self.assertRegex(text, r"slicing +\[#+\.+\] +\d+ % +\d+ s")
        self.assertIn("written  lattice.cli", text)

    @needs_posix("a size of the terminal")
    def test_the_bar_fits_the_terminal(self):
        self.succeed("make", "lattice")
        for columns, bar in [(40, r"\[#*\.*\]"), (20, r"\d+ %"), (5, "slic")]:
            code, text = self.run_in_terminal("slice", "lattice.stl", "-o", "lattice.cli", "--scan", "--threads", "1", columns=columns)
            self.assertEqual(code, 0, text)
            lines = [line for line in text.split("\r") if line.startswith("slic")]
            self.assertTrue(any(re.search(bar, line) for line in lines), text)
            self.assertLess(max(len(line) for line in lines if "\n" not in line), columns, text)

    @unittest.skipUnless(ON_WINDOWS, "this is no program for Windows")
    def test_a_window_that_shows_a_dropped_file_waits_for_a_key(self):
        """The console is the program's own, as if Explorer had made it."""
        self.box()
        for words, shown in [(["box.stl"], 'lamella view "box.stl"'), ([], "lamella make rook")]:
            code, text = self.run_in_terminal(*words, typed=b"x", after="Press a key to close this window.")
            self.assertIn(shown, re.sub(r"[\r\n]+", "", text))  # the console divides long lines
            self.assertIn("Press a key", text)
            self.assertEqual(code, 2 if words else 0, text)

    @needs_posix("a size of the terminal")
    def test_help_is_as_wide_as_the_terminal(self):
        for columns, longest in [(40, 40), (64, 64), (90, 90), (200, 100)]:
            _, text = self.run_in_terminal("slice", "--help", columns=columns)
            widths = [len(line) for line in text.replace("\r", "").splitlines()]
            self.assertLessEqual(max(widths), longest)
            self.assertGreater(max(widths), longest - 8)

    def test_errors_are_shown(self):
        code, text = self.run_in_terminal("info", "Gehäuse.stl")
        self.assertEqual((code, text.strip()), (3, "lamella: error: Gehäuse.stl: there is no such file"))

    def test_ctrl_c_ends_the_program_and_leaves_nothing(self):
        self.succeed("make", "rook")
        code, text = self.run_in_terminal("slice", "rook.stl", "-o", "rook.svg", "--layer-height", "0.0005", typed=b"\x03", after="%  ")
        self.assertEqual(code, 130, text)
        self.assertIn("lamella: error: cancelled", text)
        self.assertEqual(self.listing(), ["rook.stl"])


if __name__ == "__main__":
    main()
