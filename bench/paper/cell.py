"""One engine on one part: run, checked against the sweep, and estimated where the limit is too short."""

import statistics
from dataclasses import dataclass, field
from pathlib import Path
from typing import Optional

from bench.harness import lamella, parts

ENGINES = ["conventional", "ecc", "ecc-edge-match", "eecc", "sweep"]
REFERENCE = "sweep"
# Relative to the largest layer; for engines that order or round otherwise. Equal hashes need no tolerance.
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
    check: str = ""  # how the layers were found right
    estimate: Optional[float] = None  # of `seconds`, where that could not be measured
    estimated_from: str = ""
    searches_estimate: Optional[float] = None  # of matching["searches"], likewise

    @property
    def ok(self):
        return self.ended == "ok"

    @property
    def intersections(self):
        """Triangles crossing planes; 0 for engines that do not count them."""
        return sum(self.matching["inserted"].values()) if self.matching else 0


@dataclass
class Laboratory:
    program: Path
    folder: Path  # for what is left over: listings, statistics
    parts_folder: Path
    timeout: float
    repeat_below: float = 1.0
    most_runs: int = 5
    beyond: dict = field(default_factory=dict)  # (engine, family) -> the last cell that could be measured or not

    def cells(self, part, engines, tell=lambda cell: None):
        mesh = parts.make(part, self.program, self.parts_folder)
        mesh.read_bytes()  # so that all read from memory
        reference = self.slice(part, mesh, REFERENCE)[-1]
        if not reference.ok:
            raise SystemExit(f"{REFERENCE} on {part.name}: {reference.outcome.ended}\n{reference.outcome.text}")
        found = []
        for engine in engines:
            found.append(self.cell(part, mesh, engine, reference))
            tell(found[-1])
        return found

    def cell(self, part, mesh, engine, reference):
        smaller = self.beyond.get((engine, part.family)) if part.family else None
        if smaller is None:
            runs = self.slice(part, mesh, engine)
            cell = self.judged(part, engine, runs, reference)
            if cell.ended != "timeout":
                return cell
        else:
            cell = Cell(part.name, engine, "timeout")
        self.estimate(cell, part, mesh, reference, smaller)
        if part.family:
            self.beyond[(engine, part.family)] = cell
        return cell

    def slice(self, part, mesh, engine, *options):
        """Once when it takes long; else until the sum of times is no accident."""
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
        """From some of the planes, for planes do not influence one another but for the cache; else from the next smaller
        part of the family, whose work grows with the square of the triangles."""
        planes = reference.stats["layers"]
        cell.triangles = reference.stats["input"]["triangles"]
        cell.layers = len(planes)
        given_up = smaller is not None and smaller.estimated_from.startswith("the square")
        few = evenly(planes, max(1, len(planes) // 30))
        run = None if given_up else self.some_planes(part, mesh, cell.engine, few)
        if run is not None and run.ok:
            # As many as half of the limit should hold: the fewer the planes, the more of their lists fit the cache.
            count = int(len(few) * self.timeout / 2 / max(run.outcome.seconds, 1e-3))
            more = evenly(planes, min(count, len(planes) // 2))
            second = self.some_planes(part, mesh, cell.engine, more) if len(more) > len(few) else None
            if second is not None and second.ok:
                few, run = more, second
            if not checked(run.stats["layers"], few):
                cell.ended = "wrong"
                return
            seconds, share = run.stats["seconds"], len(planes) / len(few)
            # Reading and welding are done once, however many planes there are.
            cell.estimate = seconds["total"] + (seconds["link"] + seconds["slice"]) * (share - 1)
            cell.estimated_from = f"{len(few)} of {len(planes)} planes"
            if "matching" in run.stats:
                cell.searches_estimate = run.stats["matching"]["searches"] * share
        elif smaller is not None and smaller.estimate:
            cell.estimate = smaller.estimate * (cell.triangles / smaller.triangles) ** 2
            cell.estimated_from = f"the square of the triangles, from {smaller.part}"

    def some_planes(self, part, mesh, engine, layers):
        listed = self.folder / "heights.txt"
        listed.write_text("".join(f"{layer['z']!r}\n" for layer in layers), encoding="utf-8")
        return self.slice(part, mesh, engine, "--z-list", listed)[-1]


def evenly(items, count):
    """`count` of the items, spread over all of them."""
    return [items[int((i + 0.5) * len(items) / count)] for i in range(count)]


def checked(layers, reference):
    """How the layers were found to be the reference's: "" when they are not."""
    if len(layers) != len(reference):
        return ""
    if [layer["hash"] for layer in layers] == [layer["hash"] for layer in reference]:
        return "hashes"
    largest = max((abs(layer["area_mm2"]) for layer in reference), default=0.0)
    same = all(mine["contours"] == theirs["contours"] and mine["open_chains"] == theirs["open_chains"]
               and abs(mine["area_mm2"] - theirs["area_mm2"]) <= AREA_TOLERANCE * largest
               for mine, theirs in zip(layers, reference))
    return f"contours, and areas within {AREA_TOLERANCE:g}" if same else ""
