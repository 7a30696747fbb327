"""A measured process ends as it ends, and the report says how."""

import sys
import tempfile
import unittest
from pathlib import Path

from bench.harness import process


class Process(unittest.TestCase):
    def run_python(self, source, timeout=60.0, memory=None):
        with tempfile.TemporaryDirectory() as folder:
            return process.run([sys.executable, "-c", source], timeout, Path(folder) / "log", memory)

    def test_output_of_both_kinds_is_kept(self):
        outcome = self.run_python("import sys; print('out', flush=True); sys.stderr.write('err')")
        self.assertTrue(outcome.ok)
        self.assertEqual(outcome.text, "out\nerr")
        self.assertGreater(outcome.seconds, 0)

    def test_an_exit_code_is_reported(self):
        self.assertEqual(self.run_python("raise SystemExit(3)").ended, "exit code 3")

    def test_a_crash_is_reported_by_its_signal(self):
        self.assertEqual(self.run_python("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)").ended,
                         "killed by SIGSEGV")

    def test_at_the_limit_it_is_stopped_with_its_children(self):
        source = "import subprocess, sys; subprocess.run([sys.executable, '-c', 'import time; time.sleep(600)'])"
        outcome = self.run_python(source, timeout=0.5)
        self.assertTrue(outcome.timed_out)
        self.assertFalse(outcome.ok)

    def test_memory_beyond_the_limit_fails_the_process_alone(self):
        outcome = self.run_python("bytearray(2**31)", memory=2**30)
        self.assertEqual(outcome.ended, "exit code 1")
        self.assertIn("MemoryError", outcome.text)

    def test_peak_memory_is_the_childs_own(self):
        ballast = bytearray(2**28)  # a driver that has grown
        ballast[::4096] = b"x" * len(ballast[::4096])
        self.assertLess(self.run_python("pass").peak_rss_bytes, 2**27)
        self.assertGreater(self.run_python("len(bytes([1]) * 2**28)").peak_rss_bytes, 2**28)

    def test_a_program_that_is_not_there_is_reported(self):
        with tempfile.TemporaryDirectory() as folder:
            outcome = process.run([str(Path(folder) / "nothing")], 10, Path(folder) / "log")
        self.assertEqual(outcome.ended, "exit code 127")
        self.assertIn("No such file", outcome.text)


if __name__ == "__main__":
    unittest.main()
