"""Counts how the work grows, without timing: Table 7 and section 4.1.

The two sizes of a sheet are independent. In split order, which is harder than the paper's, no two of the first half of
a plane's intersections are adjacent, so the lists of a plane, k, grow to half the triangles that cross it. Every wall
triangle crosses all planes, so m is the number of planes.
"""

from dataclasses import dataclass, field

from bench.harness import lamella, parts
from bench.paper import fit

COUNTING = ["ecc", "ecc-edge-match", "eecc"]
THICKNESS_MM = 3
SEGMENTS = 64


@dataclass
class Sample:
    engine: str
    order: str
    k: float  # half the number of triangles that cross a plane
    m: int  # number of planes that cross a wall triangle
    triangles: int  # number of triangles cut
    searches: int
    comparisons: int
    intersections: int
    bytes: int  # of nodes, lists and edges
    node_bytes: int
    peak_rss_bytes: int


@dataclass
class Growth:
    against_k: list = field(default_factory=list)
    against_m: list = field(default_factory=list)
    of_memory: list = field(default_factory=list)


def measure(program, folder, parts_folder, timeout, small=False, announce=lambda sample: None):
    """Measures all sheets; `small` is for tests of the report."""
    holes = [4, 16] if small else [4, 16, 36, 64, 100, 196]
    planes = [2, 6] if small else [1, 3, 10, 30, 100]
    memory_planes = [2, 6] if small else [10, 30, 100]
    growth = Growth()

    def samples(into, part, engines, m):
        for engine in engines:
            sample = count(program, folder, parts_folder, timeout, part, engine, m)
            if sample:
                into.append(sample)
                announce(sample)

    for order in ("split", "hole", "wall", "shuffle"):
        for h in holes:
            samples(growth.against_k, parts.sheet(h, order, SEGMENTS), COUNTING, 5)
    for m in planes:
        samples(growth.against_m, parts.sheet(16, "split", SEGMENTS), COUNTING, m)
    for m in memory_planes:
        samples(growth.of_memory, parts.sheet(100, "wall", SEGMENTS), [*COUNTING, "sweep"], m)
    return growth


def count(program, folder, parts_folder, timeout, part, engine, m):
    mesh = parts.make(part, program, parts_folder)
    run = lamella.slice_part(program, mesh, folder, "--layer-height", f"{THICKNESS_MM / m!r}", engine=engine,
                             timeout=timeout)
    if not run.ok:
        return None
    matching = run.stats.get("matching", {})
    order = part.make[part.make.index("--order") + 1]
    intersections = sum(matching["inserted"].values()) if matching else run.stats["points"]
    return Sample(engine, order, intersections / m / 2, m, intersections // m, matching.get("searches", 0),
                  matching.get("comparisons", 0), intersections, matching.get("bytes", 0),
                  matching.get("node_bytes", 0), run.outcome.peak_rss_bytes)


def exponent(samples, x, y):
    law = fit.power_law([(x(sample), y(sample)) for sample in samples])
    return None if law is None else law[1]


def bytes_per_intersection(samples, size):
    """Returns the slope, which excludes memory that does not grow with the intersections."""
    line = fit.straight_line([(sample.intersections, size(sample)) for sample in samples])
    return None if line is None else line[1]
