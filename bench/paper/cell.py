"""One engine on one part: run, checked against the sweep, and estimated if the time limit is too short."""

import statistics
from dataclasses import dataclass, field
from pathlib import Path
from typing import Optional

from bench.harness import lamella, parts

ENGINES = ["conventional", "ecc", "ecc-edge-match", "eecc", "sweep"]
REFERENCE = "sweep"
# Their work is proportional to the number of planes. With edge matching, most work is done on a triangle's first plane.
PROPORTIONAL = ["conventional", "ecc"]
# Relative to the largest layer, for engines with another order or rounding. Equal hashes need no tolerance.
AREA_TOLERANCE = 1e-9


@dataclass
class Cell:
    part: str
    engine: str
    ended: str  # "ok", "timeout", "wrong", or how the process ended
    runs: int = 0
    seconds: Optional[float] = None  # from opening the file to the last layer, median
    peak_rss_bytes: Optional[int] = None
    layers: int = 0
    points: int = 0
    triangles: int = 0
    matching: Optional[dict] = None
    check: str = ""  # result of checking the layers
    estimate: Optional[float] = None  # of `seconds`, if they could not be measured
    estimated_from: str = ""
    lower_bound: bool = False  # the estimate is one: lists of few planes fit the cache, those of all may not
    searches_estimate: Optional[float] = None  # the same for matching["searches"]

    @property
    def ok(self):
        return self.ended == "ok"

    @property
    def sign(self):
        """Returns the sign before a figure of this cell."""
        return "" if self.ok else ("≥ " if self.lower_bound else "≈ ")

    @property
    def best_known(self):
        """Returns measured or estimated seconds of a cell that is not wrong."""
        return self.seconds if self.ok else (self.estimate if self.ended == "timeout" else None)


@dataclass
class Laboratory:
    program: Path
    folder: Path  # for temporary files: listings, statistics
    parts_folder: Path
    timeout: float
    most_runs: int
    repeat_below: float = 1.0
    latest: dict = field(default_factory=dict)  # (engine, family) -> the cell of the next smaller part

    def cells(self, part, engines, announce=lambda cell: None):
        mesh = parts.make(part, self.program, self.parts_folder)
        mesh.read_bytes()  # all engines then read from the cache
        reference = self.slice(part, mesh, REFERENCE)[-1]
        if not reference.ok:
            raise SystemExit(f"{REFERENCE} on {part.name}: {reference.outcome.ended}\n{reference.outcome.text}")
        found = []
        for engine in engines:
            found.append(self.cell(part, mesh, engine, reference))
            announce(found[-1])
        return found

    def cell(self, part, mesh, engine, reference):
        smaller = self.latest.get((engine, part.family)) if part.family else None
        if smaller is None or smaller.ended != "timeout":
            cell = self.judged(part, engine, self.slice(part, mesh, engine), reference)
        else:
            cell = Cell(part.name, engine, "timeout")
        if cell.ended == "timeout":
            self.estimate(cell, part, mesh, reference, smaller)
        self.latest[(engine, part.family)] = cell
        return cell

    def slice(self, part, mesh, engine, *options):
        """Runs once if the engine is slow, otherwise repeatedly until the total time is significant."""
        runs = []
        while True:
            runs.append(lamella.slice_part(self.program, mesh, self.folder, *self.plan(part, options), engine=engine,
                                           timeout=self.timeout))
            spent = sum(run.outcome.seconds for run in runs)
            if not runs[-1].ok or len(runs) >= self.most_runs or spent > self.repeat_below:
                return runs

    @staticmethod
    def plan(part, options):
        return options if "--z-list" in options else ("--layer-height", f"{part.layer_height:g}", *options)

    @staticmethod
    def judged(part, engine, runs, reference):
        last = runs[-1]
        if not last.ok:
            return Cell(part.name, engine, "timeout" if last.timed_out else last.outcome.ended, len(runs))
        stats = last.stats
        check = checked(stats["layers"], reference.stats["layers"])
        return Cell(part.name, engine, "ok" if check else "wrong", len(runs),
                    seconds=statistics.median(run.seconds for run in runs),
                    peak_rss_bytes=max(run.outcome.peak_rss_bytes for run in runs),
                    layers=len(stats["layers"]), points=stats["points"], triangles=stats["input"]["triangles"],
                    matching=stats.get("matching"), check=check)

    def estimate(self, cell, part, mesh, reference, smaller):
        """Estimates from some of the planes, because planes influence one another only through the cache; otherwise
        from the next smaller part of the family, as work grows with the square of the triangles."""
        planes = reference.stats["layers"]
        cell.triangles = reference.stats["input"]["triangles"]
        cell.layers = len(planes)
        given_up = smaller is not None and smaller.estimated_from.startswith("the square")
        samples = [] if given_up else self.some_planes(part, mesh, cell.engine, planes)
        if None in samples:
            cell.ended = "wrong"
        elif len(samples) > 1 or (samples and cell.engine in PROPORTIONAL):
            # A line through two measurements, or through one and the origin.
            first = samples[0] if len(samples) > 1 else Sample(0, 0.0, 0)
            last = samples[-1]
            further = (len(planes) - last.planes) / (last.planes - first.planes)
            # At least the time limit, which was exceeded: lists of few planes fit the cache, those of all may not.
            cell.estimate = max(self.timeout, last.total + max(0.0, last.seconds - first.seconds) * further)
            cell.lower_bound = True
            cell.searches_estimate = last.searches + (last.searches - first.searches) * further
            cell.estimated_from = f"{' and '.join(str(one.planes) for one in samples)} of {len(planes)} planes"
        elif smaller is not None and smaller.best_known:
            cell.estimate = smaller.best_known * (cell.triangles / smaller.triangles) ** 2
            cell.estimated_from = f"the square of the triangles, from {smaller.part}"
            cell.lower_bound = smaller.lower_bound

    def some_planes(self, part, mesh, engine, planes):
        """Returns samples of two numbers of planes, if the time limit allows; [None] means a wrong result."""
        samples, count = [], max(1, len(planes) // 30)
        while len(samples) < 2:
            chosen = evenly(planes, count)
            listed = self.folder / "heights.txt"
            listed.write_text("".join(f"{layer['z']!r}\n" for layer in chosen), encoding="utf-8")
            run = self.slice(part, mesh, engine, "--z-list", listed)[-1]
            if not run.ok:
                break
            if not checked(run.stats["layers"], chosen):
                return [None]
            seconds = run.stats["seconds"]
            samples.append(Sample(count, seconds["link"] + seconds["slice"], run.stats.get("matching", {}).get("searches", 0),
                                  seconds["total"]))
            # Aims at half of the time limit: the fewer the planes, the more of their lists fit the cache.
            count = min(int(count * self.timeout / 2 / max(run.outcome.seconds, 1e-3)), len(planes) // 2)
            if count <= samples[-1].planes:
                break
        return samples


@dataclass
class Sample:
    """Cost of some of the planes."""

    planes: int
    seconds: float  # for lists and layers, which grow with the number of planes
    searches: int
    total: float = 0.0


def evenly(items, count):
    """Returns `count` of the items, evenly spread."""
    return [items[int((i + 0.5) * len(items) / count)] for i in range(count)]


def checked(layers, reference):
    """Returns how the layers were found equal to the reference's, or "" if they differ."""
    if len(layers) != len(reference):
        return ""
    if [layer["hash"] for layer in layers] == [layer["hash"] for layer in reference]:
        return "hashes"
    largest = max((abs(layer["area_mm2"]) for layer in reference), default=0.0)
    same = all(mine["contours"] == theirs["contours"] and mine["open_chains"] == theirs["open_chains"]
               and abs(mine["area_mm2"] - theirs["area_mm2"]) <= AREA_TOLERANCE * largest
               for mine, theirs in zip(layers, reference))
    return f"contours, and areas within {AREA_TOLERANCE:g}" if same else ""
