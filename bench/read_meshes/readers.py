"""The readers of meshes and their formats. To add a format of Lamella, add its name to its list and a file to
files.py."""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional

from bench.rivals.library import answer
from bench.rivals.program import version

PLAIN = ("stl", "stl-ascii", "ply", "ply-ascii", "obj", "off")
ALL = (*PLAIN, "3mf", "amf")
PYTHON = "/usr/bin/python3"  # Debian's packages belong to Debian's interpreter, whichever comes first in the path
PYTHON_READER = Path(__file__).with_name("python_reader.py")


@dataclass(frozen=True)
class Reader:
    name: str
    title: str
    formats: tuple
    command: tuple  # without the file
    version: Callable[[], Optional[str]]  # None: not installed
    told: Callable[[str, float], tuple]  # returns seconds and triangles from the output and the time of the process


def reported_by_us(text, _):
    """Reads the last line, which is JSON of our readers."""
    told = json.loads(text.strip().splitlines()[-1])
    return told["seconds"], told["triangles"]


def reported_by_admesh(text, seconds):
    """Reads the number in its table. The time is that of the whole process, which does little else."""
    return seconds, int(re.search(r"Number of facets\s*:\s*(\d+)", text).group(1))


def python_reader(library, formats):
    command = (PYTHON, "-B", PYTHON_READER, library)
    return Reader(library, library, formats, command, lambda: answer([*command, "--version"]), reported_by_us)


def readers(folder, lamella):
    """Returns all readers. `folder` has the programs built here; `lamella` is the program itself."""
    folder = Path(folder)
    return [
        Reader("lamella", "Lamella", ALL, (folder / "lamella_reader",),
               lambda: version([lamella, "--version"], r"(\d[\w.]*)"), reported_by_us),
        Reader("assimp", "assimp", ALL, (folder / "assimp_reader",),
               lambda: answer([folder / "assimp_reader", "--version"]), reported_by_us),
        Reader("lib3mf", "lib3mf", ("3mf",), (folder / "lib3mf_reader",),
               lambda: answer([folder / "lib3mf_reader", "--version"]), reported_by_us),
        Reader("admesh", "ADMesh", ("stl", "stl-ascii"), ("admesh", "--no-check"),
               lambda: version(["admesh", "--version"], r"(\d[\d.]*\d)"), reported_by_admesh),
        python_reader("numpy-stl", ("stl", "stl-ascii")),
        python_reader("meshio", PLAIN),
        python_reader("vtk", ("stl", "stl-ascii", "ply", "ply-ascii", "obj")),
    ]
