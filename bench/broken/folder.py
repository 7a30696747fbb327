"""Reads the meshes of a folder by `lamella info`."""

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

EXTENSIONS = (".stl", ".3mf", ".amf", ".obj", ".ply", ".off")


@dataclass
class Mesh:
    path: Path
    bounds: tuple  # two corners
    closed: bool

    @property
    def name(self):
        return self.path.name


def meshes_of(folder, lamella):
    """Returns the readable meshes, in the order of their names."""
    if folder is None:
        return
    for path in sorted(Path(folder).iterdir()):
        if path.suffix.lower() not in EXTENSIONS:
            continue
        told = subprocess.run([str(lamella), "info", "--json", str(path)], capture_output=True, text=True, check=False)
        if told.returncode != 0:
            print(f"{path.name}: not compared: {told.stderr.strip()}", flush=True)
            continue
        facts = json.loads(told.stdout)
        yield Mesh(path, tuple(map(tuple, facts["bbox"])), facts["closed"])
