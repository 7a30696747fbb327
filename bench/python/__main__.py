"""Measures slicing from Python by Lamella and by other packages; writes python.md, .html and report.json.

    python3 -m bench.python [options]      (from the root of the source tree; `make python-bench` does it)
"""

import argparse
import json
import statistics
import sys
from pathlib import Path

from bench.harness import machine, parts, process
from bench.harness.page import Page, Table, brief

HERE = Path(__file__).parent
PYTHON = "/usr/bin/python3"  # Debian's packages belong to Debian's interpreter
PARTS = [part for part in parts.ALL_PARTS if part.name in ("rook", "sheet-100", "lattice", "sheet-1225")]
TOLERANCE = 1e-6  # of areas and lengths; VTK computes in single precision


def slicers(options):
    """Returns name, title, command without operands; Lamella first, the library that it wraps second."""
    rivals = HERE.parent / "rivals"
    return [
        ("lamella", "lamella, from the file", [PYTHON, "-B", HERE / "lamella_slicer.py", "file"]),
        ("library", "the library in C++", [Path(options.programs) / "python" / "library_slicer"]),
        ("arrays", "lamella, from arrays", [PYTHON, "-B", HERE / "lamella_slicer.py", "arrays"]),
        ("planes", "lamella.Slicer, plane by plane", [PYTHON, "-B", HERE / "lamella_slicer.py", "planes"]),
        ("numpy-bulk", "NumPy, all planes at once", [PYTHON, "-B", HERE / "numpy_slicer.py", "bulk"]),
        ("numpy-planes", "NumPy, plane by plane, as trimesh", [PYTHON, "-B", HERE / "numpy_slicer.py", "planes"]),
        ("vtk", "VTK vtkCutter", [PYTHON, "-B", rivals / "vtk_slicer.py"]),
        ("vtk-planes", "VTK vtkPlaneCutter, plane by plane", [PYTHON, "-B", HERE / "vtk_planes.py"]),
        ("cgal", "CGAL Polygon_mesh_slicer", [Path(options.programs) / "rivals" / "cgal_slicer"]),
    ]


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.python", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--package", default="build/python", help="folder of the package (default: %(default)s)")
    parser.add_argument("--programs", default="build-bench/bench", help="folder of built slicers (default: %(default)s)")
    parser.add_argument("--out", default="out/python", help="folder of the report (default: %(default)s)")
    parser.add_argument("--parts", nargs="+", choices=[part.name for part in PARTS], help="default: all")
    parser.add_argument("--slicers", nargs="+", help="names of those to run beside lamella (default: all)")
    parser.add_argument("--rounds", type=int, default=5, help="runs of each (default: %(default)s)")
    parser.add_argument("--slow", type=float, default=20, help="what takes so many seconds runs once (default: %(default)s)")
    parser.add_argument("--timeout", type=float, default=600, help="seconds for one run (default: %(default)s)")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    folder = Path(options.out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    chosen = [slicer for slicer in slicers(options)
              if not options.slicers or slicer[0] == "lamella" or slicer[0] in options.slicers]
    cells = []
    for part in PARTS:
        if not options.parts or part.name in options.parts:
            cells += measure(part, chosen, folder, options)
    here = machine.describe(options.lamella)
    page_of(cells, chosen, here, options).write(folder, "python")
    (folder / "report.json").write_text(json.dumps({"machine": here, "cells": cells}, indent=1) + "\n", encoding="utf-8")
    print(f"The report is in {folder}/python.html")
    if any(cell["slicer"] in ("lamella", "arrays", "planes", "library") and not cell["agrees"] for cell in cells):
        raise SystemExit("Lamella's layers differ among themselves")


def measure(part, chosen, folder, options):
    """Runs all slicers alternately, several times. The first run of each fills caches and counts only if it is slow."""
    mesh = parts.make(part, options.lamella, folder / "parts")
    heights = folder / f"{part.name}.heights"
    heights.write_text("".join(f"{z!r}\n" for z in planes(mesh, part, options)), encoding="utf-8")
    runs = {name: [] for name, _, _ in chosen}
    for _ in range(options.rounds + 1):
        for name, _, command in chosen:
            past = runs[name]
            if not past or (past[-1]["ended"] == "ok" and total(past[0]) < options.slow):
                past.append(run(command, mesh, heights, folder / f"{name}.json", options))
    ours = runs["lamella"][-1]["layers"]
    cells = []
    for name, title, _ in chosen:
        counted = runs[name][1:] or runs[name]
        cell = {"part": part.name, "slicer": name, "ended": runs[name][-1]["ended"], "runs": len(counted)}
        cell["agrees"] = cell["ended"] == "ok" and agrees(ours, runs[name][-1]["layers"])
        if cell["ended"] == "ok":
            for stage in ("read", "slice"):
                seconds = [one["seconds"][stage] for one in counted]
                cell[stage] = {"least": min(seconds), "median": statistics.median(seconds), "most": max(seconds)}
            if "processor_seconds" in counted[0]:
                cell["processor_seconds"] = min(one["processor_seconds"] for one in counted)
            cell["peak_rss_bytes"] = max(one["peak_rss_bytes"] for one in counted)
            print(f"{part.title}: {title}: slice {cell['slice']['least']:.4f} s, read {cell['read']['least']:.4f} s, "
                  f"{'agrees' if cell['agrees'] else 'DIFFERS'}", flush=True)
        else:
            print(f"{part.title}: {title}: {cell['ended']}", flush=True)
        cells.append(cell)
    return cells


def planes(mesh, part, options):
    """Returns the heights at which the package cuts the part."""
    code = "import sys, lamella; print(*lamella.iter_layers(sys.argv[1], float(sys.argv[2])).z.tolist())"
    done = process.run(["env", f"PYTHONPATH={Path(options.package).resolve()}", PYTHON, "-B", "-c", code, mesh,
                        part.layer_height], 120, Path(options.out) / "planes.log")
    if not done.ok:
        raise SystemExit(f"the package in {options.package} does not run: {done.text}")
    return [float(z) for z in done.text.split()]


def run(command, mesh, heights, result, options):
    done = process.run(["env", f"PYTHONPATH={Path(options.package).resolve()}", *command, mesh, heights, result],
                       options.timeout, result.with_suffix(".log"))
    if not done.ok:
        return {"ended": done.ended}
    return {"ended": "ok", "peak_rss_bytes": done.peak_rss_bytes, **json.loads(result.read_text(encoding="utf-8"))}


def total(one):
    return sum(one["seconds"].values())


def agrees(ours, theirs):
    """Returns whether numbers of rings are equal in every layer, and lengths and areas, if given, agree."""
    def near(a, b):
        return abs(a - b) <= TOLERANCE * max(1.0, abs(a))

    return len(ours) == len(theirs) and all(
        a["contours"] == b["contours"] and near(a["perimeter_mm"], b["perimeter_mm"])
        and near(a["area_mm2"], b.get("area_mm2", a["area_mm2"])) for a, b in zip(ours, theirs))


def page_of(cells, chosen, here, options):
    page = Page("Slicing in Python")
    page.say(f"The same planes through the same STL files, each slicer in a process of its own and in turn, up to "
             f"{options.rounds} times: the least seconds within the process, since whatever else runs can only add to them. \"read\" makes a mesh of the file, "
             "\"slice\" makes closed rings of the mesh. Rings, lengths and, where a slicer tells them, areas of every "
             "layer are compared before a time counts; one that does not count stands in brackets.")
    page.show(Table(["", ""], [[name, text] for name, text in here.items()], texts=2))
    for part in PARTS:
        rows = {cell["slicer"]: cell for cell in cells if cell["part"] == part.name}
        if not rows:
            continue
        page.heading(part.title)
        table = Table(["slicer", "slice s", "times lamella", "read s", "file to rings, times lamella", "peak MB"])
        for name, title, _ in chosen:
            table.add(title, *numbers(rows[name], rows["lamella"]))
        page.show(table)
        if rows["lamella"]["ended"] == rows.get("library", {}).get("ended") == "ok":
            wall, processor = overheads(rows["lamella"], rows["library"])
            page.say(f"The package against the library in C++, least of each: {wall:+.1%} of time, {processor:+.1%} of "
                     "processor time, which other programs disturb less.")
            print(f"{part.title}: the package adds {wall:+.1%} of time, {processor:+.1%} of processor time")
    return page


def overheads(package, library):
    """Returns the overhead of the package over the library, as fractions of wall time and CPU time."""
    return (package["slice"]["least"] / library["slice"]["least"] - 1,
            package["processor_seconds"] / library["processor_seconds"] - 1)


def numbers(cell, ours):
    if cell["ended"] != "ok":
        return cell["ended"], "", "", "", ""
    seconds, both = cell["slice"]["least"], cell["slice"]["least"] + cell["read"]["least"]
    ours_both = ours["slice"]["least"] + ours["read"]["least"]
    if not cell["agrees"]:
        return f"({seconds:.4f})", "", f"{cell['read']['median']:.4f}", "", f"{cell['peak_rss_bytes'] / 1e6:.0f}"
    return (f"{seconds:.4f}", brief(seconds / ours["slice"]["least"]), f"{cell['read']['median']:.4f}",
            brief(both / ours_both), f"{cell['peak_rss_bytes'] / 1e6:.0f}")


if __name__ == "__main__":
    main(sys.argv[1:])
