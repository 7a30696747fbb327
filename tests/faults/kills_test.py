"""Programs that are killed at any moment, and programs that write to the same place: the result is always a whole one."""

import itertools
import os
import random
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import PROGRAM, ProgramTest, binary_stl, box_triangles  # noqa: E402

AT_LENGTH = "LAMELLA_FAULTS_AT_LENGTH" in os.environ
FORMATS = ["cli", "svg", "3mf", "npz", "svg-layers", "png", "sl1"]


def content(path):
    if path.is_dir():
        return {p.name: p.read_bytes() for p in path.iterdir()}
    return path.read_bytes() if path.exists() else None


class Kills(ProgramTest):
    def start(self, *arguments, **keywords):
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, **keywords)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        return process

    def test_at_random_moments(self):
        self.succeed("make", "torus")
        seed = random.randrange(10**6)
        chance = random.Random(seed)
        counts = {"before": 0, "after": 0}
        for name in FORMATS:
            command = ["slice", "torus.stl", "-o", "out", "--format", name, "--layer-height", "0.05"]
            start = time.monotonic()
            self.succeed(*command)
            took = time.monotonic() - start
            new = content(self.path("out"))
            self.succeed(*command, "--scale", "1.1")
            old = content(self.path("out"))
            self.assertNotEqual(old, new)
            for _ in range(20 if AT_LENGTH else 8):
                process = self.start(*command)
                time.sleep(chance.uniform(0, took))
                process.send_signal(signal.SIGKILL)
                process.wait()
                now = content(self.path("out"))
                self.assertIn(now, [old, new], f"{name}, seed {seed}")
                counts["after" if now == new else "before"] += 1
                if now == new:
                    self.succeed(*command, "--scale", "1.1")
            self.succeed(*command)
            self.assertEqual(content(self.path("out")), new)
            self.path("out").rename(self.path(f"{name}-done"))
        print(f"\nkilled before the result was there: {counts['before']}, after: {counts['after']}", file=sys.stderr)

    def test_a_folder_that_a_killed_run_left_is_removed_by_the_next_run_only_if_nobody_works_there(self):
        self.succeed("make", "rook")
        slow = ["slice", "rook.stl", "-o", "out", "--format", "png", "--layer-height", "0.002"]
        quick = ["slice", "rook.stl", "-o", "out", "--format", "png", "--layer-height", "5"]
        killed, living = (self.start_and_wait_for_a_folder(slow) for _ in range(2))
        killed.kill()
        killed.wait()
        self.assertEqual(len(self.hidden_folders()), 2)
        for _ in range(2):
            self.succeed(*quick)
            self.assertEqual(len(self.hidden_folders()), 1, "that of the living run")
        self.assertIsNone(living.poll())
        living.send_signal(signal.SIGINT)
        self.assertEqual(living.wait(timeout=60), 130)
        self.assertEqual(self.hidden_folders(), [])

    def start_and_wait_for_a_folder(self, command):
        before = len(self.hidden_folders())
        process = self.start(*command)
        deadline = time.monotonic() + 60
        while len(self.hidden_folders()) == before:
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.005)
        return process

    def hidden_folders(self):
        return [p for p in os.listdir(self.folder) if p.startswith(".out.")]

    def test_signals_at_random_moments_leave_a_shard_with_its_stamp_or_neither_half_of_it(self):
        self.succeed("make", "torus")
        command = ["slice", "torus.stl", "-o", "o.cli", "--shard", "1/2", "--layer-height", "0.05", "--stats", "s.json"]
        start = time.monotonic()
        self.succeed(*command)
        took = time.monotonic() - start
        seed = random.randrange(10**6)
        chance = random.Random(seed)
        signals = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
        end = time.monotonic() + (50 if AT_LENGTH else 6)
        for i in itertools.count():
            if time.monotonic() > end:
                break
            for name in ["o.cli", "s.json"] + (["o.cli.shard"] if i % 8 else []):
                self.path(name).unlink(missing_ok=True)
            stamp_alone = self.path("o.cli.shard").exists()
            # Every other run is sent its signal while it is hardly begun. Blocked from before its begin in half of the runs,
            # the signal can never end the program by itself.
            blocked = i % 4 < 2
            process = self.start(*command, preexec_fn=(
                lambda: signal.pthread_sigmask(signal.SIG_BLOCK, signals)) if blocked else None)
            time.sleep(chance.uniform(0, 0.003 if i % 2 else 1.2 * took))
            number = chance.choice(signals)
            process.send_signal(number)
            code = process.wait(timeout=60)
            error = process.stderr.read().decode()
            there = [name in self.listing() for name in ["o.cli", "s.json", "o.cli.shard"]]
            where = f"run {i}, seed {seed}: {number}, code {code}, {there}, {error}"
            self.assertEqual(self.listing_of_temporaries(), [], where)
            if code == 0:
                self.assertEqual(there, [True] * 3, where)
            elif code == 130:
                self.assertTrue(not there[2] or (stamp_alone and not there[0]), where)
                self.assertEqual("o.cli is complete" in error, there[0], where)
                if not there[0]:
                    self.assertFalse(there[1], where)
            else:  # before the first statement of the program
                self.assertEqual((code, blocked), (-number, False), where)
                self.assertEqual(there, [False, False, stamp_alone], where)
        self.assertGreater(i, 10)

    def test_several_runs_on_one_output(self):
        self.succeed("make", "torus")
        for name in FORMATS:
            with self.subTest(name):
                wholes = []
                commands = [["slice", "torus.stl", "-o", "out", "--format", name, "--layer-height", "0.2",
                             f"--translate={i},0,0"] for i in range(4)]
                for command in commands:
                    self.succeed(*command)
                    wholes.append(content(self.path("out")))
                for _ in range(10 if AT_LENGTH else 3):
                    processes = [self.start(*command) for command in commands]
                    while any(p.poll() is None for p in processes):
                        pass
                    self.assertEqual([p.returncode for p in processes], [0] * 4,
                                     [p.stderr.read() for p in processes])
                    self.assertIn(content(self.path("out")), wholes)
                    self.assertEqual(self.listing_of_temporaries(), [])
                self.path("out").rename(self.path(f"{name}-done"))

    def listing_of_temporaries(self):
        return [p for p in self.listing() if ".tmp" in p or ".part" in p]

    def test_a_batch_is_done_again_after_a_kill(self):
        self.path("in").mkdir()
        for i in range(300):
            self.write(f"in/{i:03}.stl", binary_stl(box_triangles(1 + i, 2, 3)))
        command = ["slice", "--batch", "in", "-o", "out", "--format", "cli"]
        self.succeed(*command)
        expected = {p.name: p.read_bytes() for p in self.path("out").iterdir()}
        for _ in range(10 if AT_LENGTH else 3):
            for path in self.path("out").iterdir():
                path.unlink()
            process = self.start(*command)
            while process.poll() is None and len(list(self.path("out").iterdir())) < 50:
                pass
            process.kill()
            process.wait()
            # Workers end by themselves, take their temporary files along, and finish nothing after that.
            before = None
            deadline = time.monotonic() + 60
            while before != (before := sorted(p.name for p in self.path("out").iterdir())) or any(
                    name.endswith(".tmp") for name in before):
                self.assertLess(time.monotonic(), deadline, before)
                time.sleep(0.2)
            for path in self.path("out").iterdir():
                self.assertEqual(path.read_bytes(), expected[path.name], path)
            self.succeed(*command)
            self.assertEqual({p.name: p.read_bytes() for p in self.path("out").iterdir()}, expected)


if __name__ == "__main__":
    unittest.main()
