"""What the tests of the Python package share: the package as it was built, the program, and small bodies."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = os.environ.get("LAMELLA_PYTHON_PACKAGE", str(ROOT / "build" / "python"))
sys.path.insert(0, PACKAGE)
PROGRAM = os.environ.get("LAMELLA_PROGRAM", str(ROOT / "build" / "lamella"))


class Program:
    def __call__(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, check=False, timeout=240)

    def succeed(self, *arguments):
        result = self(*arguments)
        assert result.returncode == 0, result.stderr.decode()
        return result.stdout

    def error(self, *arguments):
        """The text of the error that it ends with."""
        result = self(*arguments)
        lines = [line for line in result.stderr.decode().splitlines() if line.startswith("lamella: error: ")]
        assert len(lines) == 1, result.stderr.decode()
        return lines[0].removeprefix("lamella: error: ")


@pytest.fixture(scope="session")
def program():
    return Program()


@pytest.fixture(scope="session")
def bodies(program, tmp_path_factory):
    """STL files of test bodies, by name and options."""
    folder = tmp_path_factory.mktemp("bodies")

    def body(*arguments):
        path = folder / ("_".join(str(argument) for argument in arguments).replace("/", "") + ".stl")
        if not path.exists():
            program.succeed("make", *arguments, "-o", path)
        return path

    return body


@pytest.fixture(scope="session")
def rook(bodies):
    return bodies("rook")


@pytest.fixture
def jobs(program, rook, tmp_path):
    """A folder with layers and scan vectors of the program."""
    program.succeed("slice", rook, "-o", tmp_path / "part.cli", "--layer-height", 2)
    for name in ("program.ilt", "program.ovf"):
        program.succeed("scan", tmp_path / "part.cli", "-o", tmp_path / name)
    return tmp_path


def samples(page):
    """The samples of a page of the documentation, in order."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def box_arrays(x=20.0, y=30.0, z=10.0, at=(0.0, 0.0, 0.0), inward=False):
    """Vertices (8, 3) and faces (12, 3) of a box with one corner at `at`."""
    vertices = np.array([(i * x, j * y, k * z) for k in (0, 1) for j in (0, 1) for i in (0, 1)]) + at
    squares = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = np.array([corners for a, b, c, d in squares for corners in ((a, b, c), (a, c, d))])
    return vertices, faces[:, ::-1] if inward else faces


def joined(*bodies):
    """Several bodies in one pair of arrays."""
    vertices, faces, count = [], [], 0
    for body_vertices, body_faces in bodies:
        vertices.append(body_vertices)
        faces.append(body_faces + count)
        count += len(body_vertices)
    return np.concatenate(vertices), np.concatenate(faces)


def nested_boxes():
    """A box with a hollow, and a box in the hollow: every layer has three rings within one another."""
    return joined(
        box_arrays(10, 10, 10),
        box_arrays(8, 8, 8, at=(1, 1, 1), inward=True),
        box_arrays(4, 4, 4, at=(3, 3, 3)),
    )


def open_box():
    """A box without one of its walls: every layer has an open chain."""
    vertices, faces = box_arrays()
    return vertices, faces[:-2]


def shoelace(ring):
    x, y = ring[:, 0], ring[:, 1]
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2


def run_python(code, *arguments):
    """Runs code in an interpreter of its own; its output."""
    result = subprocess.run(
        [sys.executable, "-B", "-c", code, *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": PACKAGE},
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    return result.stdout
