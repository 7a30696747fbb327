"""Who reads meshes, and which formats. A new format of Lamella is a name in its list and a file in files.py."""

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
    command: tuple  # and then the file
    version: Callable[[], Optional[str]]  # None: not there
    told: Callable[[str, float], tuple]  # seconds and triangles from what it printed and how long the process took


def told_by_us(text, _):
    """The last line is JSON of ours."""
    told = json.loads(text.strip().splitlines()[-1])
    return told["seconds"], told["triangles"]


def told_by_admesh(text, seconds):
    """Its table has the number; the time is that of the whole process, which does nothing else of weight."""
    return seconds, int(re.search(r"Number of facets\s*:\s*(\d+)", text).group(1))


def python_reader(library, formats):
    command = (PYTHON, "-B", PYTHON_READER, library)
    return Reader(library, library, formats, command, lambda: answer([*command, "--version"]), told_by_us)


def readers(folder, lamella):
    """`folder` is where the build has put the programs, `lamella` the program itself."""
    folder = Path(folder)
    return [
        Reader("lamella", "Lamella", ALL, (folder / "lamella_reader",),
               lambda: version([lamella, "--version"], r"(\d[\w.]*)"), told_by_us),
        Reader("assimp", "assimp", ALL, (folder / "assimp_reader",),
               lambda: answer([folder / "assimp_reader", "--version"]), told_by_us),
        Reader("lib3mf", "lib3mf", ("3mf",), (folder / "lib3mf_reader",),
               lambda: answer([folder / "lib3mf_reader", "--version"]), told_by_us),
        Reader("admesh", "ADMesh", ("stl", "stl-ascii"), ("admesh", "--no-check"),
               lambda: version(["admesh", "--version"], r"(\d[\d.]*\d)"), told_by_admesh),
        python_reader("numpy-stl", ("stl", "stl-ascii")),
        python_reader("meshio", PLAIN),
        python_reader("vtk", ("stl", "stl-ascii", "ply", "ply-ascii", "obj")),
    ]
