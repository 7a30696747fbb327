"""The result of a slicer for a mesh: areas of its layers, and their rings for drawing."""

import json
from dataclasses import dataclass, field
from typing import Callable, Optional

from bench.harness import lamella, process
from bench.harness.layers import Layer
from bench.rivals import cura, layered_svg, prusa_slicer, toolpath
from bench.rivals.cura import CURA
from bench.rivals.prusa_slicer import PRUSA_SLICER
from bench.rivals.slic3r import SLIC3R


@dataclass
class Drawing:
    """One layer: rings and chains in the coordinates of the mesh."""

    rings: list = field(default_factory=list)
    chains: list = field(default_factory=list)  # contours that are not closed
    width: float = 0.0  # of a tool path along the rings; 0: rings are contours


@dataclass
class View:
    slicer: str
    title: str
    ended: str  # "ok", "timeout", "exit code 3", ...
    layers: list = field(default_factory=list)  # harness.layers.Layer
    draw: Optional[Callable[[float], Optional[Drawing]]] = lambda z: None  # by height above the bottom of the part
    last_words: str = ""
    open_chains: Optional[int] = None

    @property
    def ok(self):
        return self.ended == "ok"


def our_view(program, mesh, folder, name, title, layer_height, policies, timeout):
    file = folder / f"{name}.json"
    run = lamella.slice_part(program, mesh, folder, "--layer-height", f"{layer_height:g}", *policies, timeout=timeout,
                             output=file)
    if not run.ok:
        return View(name, title, run.outcome.ended, last_words=last_words(run.outcome))
    found = json.loads(file.read_text(encoding="utf-8"))["layers"]
    bottom = run.stats["input"]["bbox"][0][2]
    drawings = {height(layer["z"] - bottom): drawing(layer) for layer in found}
    return View(name, title, "ok", run.layers, lambda z: drawings.get(height(z)),
                open_chains=run.stats["open_chains"])


def drawing(layer):
    contours = {kind: [list(zip(row[0::2], row[1::2])) for part in layer["parts"] for row in part.get(kind, [])]
                for kind in ("rings", "chains")}
    return Drawing(contours["rings"], contours["chains"])


@dataclass
class Reading:
    """Reads the result of a rival: height and rings of each layer, position of the middle of the mesh in them, from its
    smallest and largest coordinates, and the width of the path."""

    rings: Callable
    middle: Callable
    width: float = 0.0


def path_rings(path):
    """Returns the rings of a tool path, layers by their number."""
    def read(job):
        return [((number + 0.5) * job.layer_height, rings) for number, rings in enumerate(toolpath.read_rings(*path(job)))]
    return read


READINGS = {
    "slic3r": Reading(lambda job: layered_svg.read_rings(job.file("slic3r.svg")),
                      lambda low, high: ((high[0] - low[0]) / 2, (high[1] - low[1]) / 2)),
    "prusa-slicer": Reading(path_rings(prusa_slicer.path), lambda low, high: (500.0, 500.0), prusa_slicer.WIDTH_MM),
    "cura": Reading(path_rings(cura.path), lambda low, high: (0.0, 0.0), cura.WIDTH_MM),
}
RIVALS = [SLIC3R, PRUSA_SLICER, CURA]


def their_view(rival, job, bounds, timeout):
    outcome = process.run(rival.command(job), timeout, job.file("rival.log"))
    view = View(rival.name, rival.title, outcome.ended, last_words=last_words(outcome))
    if not outcome.ok:
        return view
    reading = READINGS[rival.name]
    try:
        view.layers = rival.layers(job)
        rings = {height(z): moved(one, reading.middle(*bounds), bounds) for z, one in reading.rings(job)}
    except (OSError, ValueError, KeyError, IndexError) as error:
        view.ended = f"no layers: {error}"
        return view
    view.draw = lambda z: Drawing(rings[height(z)], width=reading.width) if height(z) in rings else None
    return view


def moved(rings, middle, bounds):
    """Moves rings to the position of the mesh."""
    dx, dy = ((low + high) / 2 - at for low, high, at in zip(*bounds, middle))
    return [[(x + dx, y + dy) for x, y in ring] for ring in rings]


def height(z):
    return round(z, 3)


def last_words(outcome):
    lines = [line.strip() for line in outcome.text.splitlines() if line.strip()]
    return " ".join(lines[-2:])[-200:] if lines and not (outcome.ok or outcome.timed_out) else ""


@dataclass
class Difference:
    share: float  # sum of the differences of all layers over the sum of their true areas
    worst_z: float  # height of the largest difference
    worst_mm2: float  # area found minus true area


def difference(view, expected, layer_height, sinks):
    """Compares with the `expected` layers. Some programs omit the lowest layers and lower the rest: these are also
    compared one and two layers higher, and the smallest difference counts."""
    tries = []
    for lowered in range(3 if sinks else 1):
        found = [Layer(layer.z + lowered * layer_height, layer.contours, layer.area_mm2) for layer in view.layers]
        tries.append(difference_as_it_stands(found, expected))
    return min(tries, key=lambda one: one.share)


def difference_as_it_stands(found, expected):
    """Compares without moving layers. A layer of only one side counts as empty on the other."""
    theirs = {height(layer.z): layer.area_mm2 for layer in found}
    ours = {height(layer.z): layer.area_mm2 for layer in expected}
    off = {z: theirs.get(z, 0.0) - ours.get(z, 0.0) for z in theirs.keys() | ours.keys()}
    total = sum(map(abs, ours.values()))
    worst = max(sorted(off), key=lambda z: abs(off[z]))
    return Difference(sum(map(abs, off.values())) / total if total else float("inf"), worst, off[worst])
