"""Layers made to take long: every command that reads layers keeps its limit of memory, and stops when it is told to."""

import random
import re
import struct
import subprocess
import sys

from program import COMMAND, ProgramTest, main, needs_posix

MEMORY = 100_000_000
BESIDE = 60_000_000  # the program, its threads and a copy of the input
WAIT = 60            # far more than a program needs to stop on a busy machine
# Runs a command, sends it a signal after so many seconds (0: none), and prints its exit code, the most memory that it had,
# and the seconds from the signal to the end.
MEASURED = """
import resource, signal, subprocess, sys, time
process = subprocess.Popen(sys.argv[2:], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
waited = 0
try:
    process.wait(float(sys.argv[1]) or None)
except subprocess.TimeoutExpired:
    process.send_signal(signal.SIGINT)
    begin = time.monotonic()
    process.wait()
    waited = time.monotonic() - begin
print(process.returncode, 1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, waited)
"""
STEPS = (["--fill", "nonzero"], ["--offset=-0.05"], ["--simplify", "0.2"], ["--largest-only"])
COMMANDS = {
    "slice": [["MESH", "-o", "OUT.json", *more] for more in (*(["--layer-height", "1", *step] for step in (
        [], *STEPS, ["--close-gaps", "5"], ["--scan"], ["--inspect"])), ["--adaptive", "0.1:1"])],
    "info": [["LAYERS"]],
    "check": [["LAYERS"], ["MESH", "--layer-height", "1"]],
    "verify": [["LAYERS"], ["LAYERS", "--scan"], ["LAYERS", "--mesh", "MESH"], ["LAYERS", "--mesh", "MESH", "--offset=-0.05"]],
    "compare": [["LAYERS", "OTHER", "--area-difference"]],
    "convert": [["LAYERS", "OUT.svg", *more] for more in ([], *STEPS)] + [["LAYERS", "OUT.geojson"], ["LAYERS", "OUT.zip", "--format", "png-zip"]],
    "scan": [["LAYERS", "-o", "OUT.ilt"], ["LAYERS", "-o", "OUT.cli", "--pattern", "hexagons"]],
    "merge": [["OUT.cli", "LAYERS"]],
    "view": [["LAYERS", "-o", "OUT.html"]],
}
WITHOUT_LAYERS = {"strategy", "printers", "resin", "make", "completion", "help"}


def chords(seed, size):
    """Rings of three corners, which are random."""
    chance = random.Random(seed)
    return [[(chance.uniform(0, 100), chance.uniform(0, 100)) for _ in range(3)] for _ in range(size)]


def comb(seed, size):
    """A ring whose teeth nearly lie on one another."""
    chance = random.Random(seed)
    return [[(100 * (i % 2) + chance.uniform(0, 1e-6), 50 + chance.uniform(-1e-6, 1e-6)) for i in range(size)]]


def chains(seed, size):
    """Chains of two points with gaps between any two of them."""
    chance = random.Random(seed)
    points = [(chance.uniform(0, 100), chance.uniform(0, 100)) for _ in range(size)]
    return [[p, (p[0] + chance.uniform(-3, 3), p[1] + chance.uniform(-3, 3))] for p in points]


LAYERS = {"chords": (chords, 1000, True), "comb": (comb, 10_000, True), "chains": (chains, 20_000, False)}


class HostileLayers(ProgramTest):
    def write_layers(self, name, lines, closed):
        texts = [f"$$POLYLINE/1,{1 if closed else 2},{len(line) + closed}," +
                 ",".join(f"{x:.9g},{y:.9g}" for x, y in line + line[:closed]) + "\n" for line in lines]
        self.write(name, "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n" +
                   "".join(f"$$LAYER/{z}\n{''.join(texts)}" for z in (1, 2)) + "$$GEOMETRYEND\n")

    def write_mesh(self, name, lines, closed):
        """Walls of a height of 2 on these lines."""
        records = []
        for line in lines:
            for (x0, y0), (x1, y1) in zip(line, line[1:] + line[:1] if closed else line[1:]):
                for corners in (((x0, y0, 0), (x1, y1, 0), (x1, y1, 2)), ((x0, y0, 0), (x1, y1, 2), (x0, y0, 2))):
                    records.append(struct.pack("<12fH", 0, 0, 0, *(c for corner in corners for c in corner), 0))
        self.write(name, b" " * 80 + struct.pack("<I", len(records)) + b"".join(records))

    def measured(self, seconds, *arguments):
        result = subprocess.run([sys.executable, "-c", MEASURED, str(seconds), *COMMAND, *arguments, "--threads", "2"],
                                cwd=self.folder, capture_output=True, check=True, text=True, timeout=240)
        code, memory, waited = result.stdout.split()
        return int(code), int(memory), float(waited)

    def commands(self):
        """The words of all rows."""
        for command, rows in COMMANDS.items():
            for row in rows:
                names = {"MESH": "mesh.stl", "LAYERS": "layers.cli", "OTHER": "other.cli"}
                yield [command, *(names.get(word, word.replace("OUT", "out")) for word in row)]

    def write_all(self, name):
        make, size, closed = LAYERS[name]
        self.write_layers("layers.cli", make(1, size), closed)
        self.write_layers("other.cli", make(2, size), closed)
        self.write_mesh("mesh.stl", make(1, size), closed)

    def test_the_table_has_all_commands(self):
        listed = set(re.findall(r"(?m)^  ([a-z]+) {2,}", self.succeed("--help").text))
        self.assertEqual(set(COMMANDS) | WITHOUT_LAYERS, listed)

    def test_commands_keep_the_limit_of_memory(self):
        for name in LAYERS:
            self.write_all(name)
            for words in self.commands():
                with self.subTest(name, words=words):
                    code, memory, _ = self.measured(0, *words, "--max-memory", str(MEMORY))
                    self.assertIn(code, (0, 4, 5))
                    self.assertLess(memory, MEMORY + BESIDE)

    @needs_posix("a process that gets a signal while others do not")
    def test_commands_stop_when_they_are_told_to(self):
        self.write_all("chords")
        stopped = 0
        for words in self.commands():
            with self.subTest(words=words):
                code, _, waited = self.measured(0.3, *words)
                self.assertIn(code, (0, 4, 5, 130))
                self.assertLess(waited, WAIT)
                stopped += code == 130
        self.assertGreater(stopped, 3)


if __name__ == "__main__":
    main()
