"""The parts that are sliced, as the program makes them; the smallest first."""

import subprocess
from dataclasses import dataclass
from pathlib import Path

LAYER_HEIGHT_MM = 0.1


@dataclass(frozen=True)
class Part:
    name: str
    title: str
    make: tuple  # arguments of `lamella make`
    family: str = ""  # parts of one family differ only in size
    layer_height: float = LAYER_HEIGHT_MM

    def path(self, folder):
        return Path(folder) / f"{self.name}.stl"


def sheet(holes, order="hole", segments=None):
    """Returns a sheet of the paper in the order of its tables (docs/paper.md), or a similar one."""
    suffix = "" if order == "hole" else f"-{order}"
    options = () if segments is None else ("--segments", str(segments))
    if segments is not None:
        suffix += f"-{segments}"
    return Part(f"sheet-{holes}{suffix}", f"sheet {holes}", ("sheet", "--holes", str(holes), "--order", order, *options),
                family=f"sheet{suffix}")


def on_edge(part):
    return Part(f"{part.name}-edge", f"{part.title} on edge", (*part.make, "--rotate-x", "90"))


# The parts of the paper, smallest first, and a lattice that is as large as its sole in all three directions.
PAPER_PARTS = [
    Part("calibration", "calibration", ("calibration",)),
    Part("dodecahedra", "dodecahedra", ("dodecahedra",)),
    Part("rook", "rook", ("rook",)),
    sheet(100),
    on_edge(sheet(100)),
    sheet(225),
    Part("head", "head", ("head",)),
    Part("sole", "lattice sole", ("sole",)),
    sheet(484),
    sheet(729),
    sheet(1225),
]
LATTICE = Part("lattice", "lattice", ("lattice", "--cells", "12"))
ALL_PARTS = [*PAPER_PARTS[:8], LATTICE, *PAPER_PARTS[8:]]
# For tests of the reports themselves.
TINY_PARTS = [Part("box", "box", ("box", "--size", "20,30,2.5")), sheet(4, segments=32)]


def named(names, parts):
    """Returns the `parts` with these names, in the order of `parts`."""
    known = {part.name: part for part in parts}
    unknown = [name for name in names if name not in known]
    if unknown:
        raise SystemExit(f"no part {', '.join(unknown)}; there are: {', '.join(known)}")
    return [part for part in parts if part.name in names]


def make(part, lamella, folder):
    """Returns the STL file of a part; this program makes it unless it exists."""
    path = part.path(folder)
    if not path.exists() or path.stat().st_mtime < Path(lamella).stat().st_mtime:
        Path(folder).mkdir(parents=True, exist_ok=True)
        half_made = path.with_suffix(".part.stl")
        subprocess.run([str(lamella), "make", *part.make, "-o", str(half_made)], check=True, capture_output=True)
        half_made.rename(path)
    return path
