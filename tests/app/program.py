"""What the tests of the program share: starting it in a folder of its own, and small STL files."""

import contextlib
import json
import os
import re
import resource
import signal
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("LAMELLA_PROGRAM", str(SOURCE / "build" / "lamella"))
# A program for another system runs in an emulator.
EMULATOR = os.environ.get("LAMELLA_EMULATOR", "").split()
COMMAND = [*EMULATOR, PROGRAM]
# Wine is such an emulator. Its processes are those of this system: limits, permissions, pipes and devices that they inherit
# are as here.
ON_WINDOWS = PROGRAM.endswith(".exe")
# The signals that stop a program. Wine passes the first on as Ctrl-C; Windows knows no other.
STOPPING_SIGNALS = [signal.SIGINT] if ON_WINDOWS else [signal.SIGINT, signal.SIGTERM]
# Permissions hold for the program also where root runs the tests: it stays root, which may enter the folder of a private
# checkout, but lacks the capabilities that let root read and write everything.
UNPRIVILEGED = {"launcher": ["setpriv", "--bounding-set=-dac_override,-dac_read_search"]} if os.geteuid() == 0 else {}
# Limits on processes hold for other users than root only. This one may still enter the folder of a private checkout.
OTHER_USER = {"launcher": ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--inh-caps=+dac_read_search",
                           "--ambient-caps=+dac_read_search"]} if os.geteuid() == 0 else {}


def needs_posix(what):
    """For tests that need something that only POSIX has."""
    return unittest.skipIf(ON_WINDOWS, f"needs POSIX: {what}")


def limited(**limits):
    """For programs that may have only so much of something, such as DATA=1000."""
    # Python ignores the signal of files that are too large. The program has to do so itself, but Wine does not.
    return {"restore_signals": not ON_WINDOWS,
            "preexec_fn": lambda: [resource.setrlimit(getattr(resource, f"RLIMIT_{name}"), (limit, limit))
                                   for name, limit in limits.items()]}


def windows_path(path):
    """As programs for Windows know a path of this system."""
    return "Z:" + str(path).replace("/", "\\")


def windows_start(*settings):
    """The command that starts a program for Windows with settings of tests/app/windows_start.cpp."""
    return [*EMULATOR, os.environ["LAMELLA_WINDOWS_START"], *settings, "--", PROGRAM]


class Result:
    def __init__(self, finished):
        self.code = finished.returncode
        self.out = finished.stdout
        self.err_bytes = finished.stderr
        self.err = finished.stderr.decode("utf-8", "replace")

    @property
    def text(self):
        return self.out.decode("utf-8")

    def json(self):
        return json.loads(self.text)


class ProgramTest(unittest.TestCase):
    """Every test runs in an empty folder, self.folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="lamella-test-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_program(self, *arguments, stdin=b"", launcher=(), **keywords):
        start = COMMAND
        if ON_WINDOWS and (folder := keywords.get("env", {}).get("TMPDIR")):
            start = windows_start(f"TMP={windows_path(folder)}")
        command = [*launcher, *start] + [str(a) for a in arguments]
        return Result(subprocess.run(command, input=stdin, capture_output=True, timeout=240,
                                     **{"cwd": self.folder, **keywords}))

    def succeed(self, *arguments, **keywords):
        result = self.run_program(*arguments, **keywords)
        self.assertEqual(result.code, 0, f"{arguments}: {result.err}")
        return result

    def engines(self):
        """The names of all engines, as the help has them."""
        text = " ".join(self.succeed("slice", "--help").text.split())
        return re.search(r"--engine NAME the slicing algorithm: (.*?) \(default", text)[1].split(", ")

    def fail_with(self, code, pattern, *arguments, **keywords):
        """One line of error, nothing on standard output, no file that was not there before."""
        before = self.listing()
        result = self.run_program(*arguments, **keywords)
        self.assertEqual(result.code, code, f"{arguments}: {result.err}")
        self.assertRegex(result.err, pattern)
        lines = [line for line in result.err.splitlines() if not line.startswith("lamella: warning: ")]
        self.assertEqual(len(lines), 1, result.err)
        self.assertTrue(lines[0].startswith("lamella: error: "), result.err)
        self.assertEqual(result.out, b"")
        self.assertEqual(self.listing(), before)
        return result

    def listing(self):
        return sorted(p.relative_to(self.folder).as_posix() for p in self.folder.rglob("*"))

    def has_unfinished_file(self, process):
        """Whether the process is writing a file: one without a name in the folder, or one with a temporary name."""
        return any(name.startswith(str(self.folder)) and name.endswith(" (deleted)")
                   for name in self.open_files(process)) or any(name.endswith(".tmp") for name in self.listing())

    @staticmethod
    def open_files(process):
        """What the process has open at this moment. It runs on: what is listed may be closed before it is asked for."""
        names = []
        try:
            for link in Path(f"/proc/{process.pid}/fd").iterdir():
                with contextlib.suppress(FileNotFoundError):
                    names.append(os.readlink(link))
        except FileNotFoundError:
            pass  # it has ended
        return names

    def make_pipe(self, name):
        """A pipe with a name that nobody writes to. For Wine such a pipe is empty unless somebody could."""
        os.mkfifo(self.path(name))
        if ON_WINDOWS:
            self.addCleanup(open(self.path(name), "r+b", buffering=0).close)

    def path(self, name):
        return self.folder / name

    def bytes_of(self, name):
        return self.path(name).read_bytes()

    def write(self, name, content):
        path = self.path(name)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def box(self, name="box.stl", size="20,30,10"):
        self.succeed("make", "box", "--size", size, "-o", name)
        return name


def binary_stl(triangles):
    """A binary STL file of triangles given as three corners each."""
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for corner in t for c in corner), 0) for t in triangles)
    return b"made for a test".ljust(80) + struct.pack("<I", len(triangles)) + body


def box_triangles(x, y, z):
    """The twelve triangles of a box with one corner at the origin, counter-clockwise seen from outside."""
    p = [(i * x, j * y, k * z) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [(p[a], p[b], p[c]) for q in faces for a, b, c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]


def open_box(x, y, z):
    """A box without one of its walls: every layer has an open chain."""
    return box_triangles(x, y, z)[:-2]


main = unittest.main
