"""The job of a slicer."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional


@dataclass
class Job:
    mesh: Path
    folder: Path  # for its output
    layer_height: float
    z: list  # heights of the cuts in the coordinates of the mesh
    bottom: float  # of the part
    threads: int

    def file(self, name):
        return self.folder / name


@dataclass
class Rival:
    name: str
    title: str
    writes: str  # output
    compared: str  # content of the output that is compared with our layers
    version: Callable[[], Optional[str]]  # None: not installed
    command: Callable[[Job], list]
    layers: Callable[[Job], list]  # reads the layers from the output
    slicing_seconds: Callable[[Job, str], Optional[float]]  # time of cutting alone, from the files and the printed text
    threaded: bool
    sinks: bool = False  # it omits lowest layers that are too small for a wall, and lowers the others
