"""What a slicer is asked to do."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional


@dataclass
class Job:
    mesh: Path
    folder: Path  # for what it writes
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
    writes: str  # what it leaves behind
    compared: str  # what of it is compared with our layers
    version: Callable[[], Optional[str]]  # None: not there
    command: Callable[[Job], list]
    layers: Callable[[Job], list]  # what it found, read from what it left
    slicing_seconds: Callable[[Job, str], Optional[float]]  # cutting alone; from the files and the printed text
    threaded: bool
    sinks: bool = False  # it leaves out lowest layers that are too small for a wall, and puts the others lower
