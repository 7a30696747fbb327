"""Measures the npm package against the program and manifold-3d, and the playground; writes web.md, web.html, report.json.

    python3 -m bench.web [options]      (from the root of the source tree; `make web-bench` does it)
"""

import argparse
import json
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

from bench.harness import machine, parts
from bench.harness.page import Page, Table, brief

HERE = Path(__file__).parent
SHEET, HEAD = parts.sheet(225), parts.Part("head", "head", ("head",), layer_height=1)
LATTICE = parts.Part("lattice-8", "lattice", ("lattice", "--cells", "8"))
PARTS = [SHEET, LATTICE, HEAD]
MILLION = parts.Part("lattice-14", "lattice of 1.4 million triangles", ("lattice", "--cells", "14"))
MANIFOLD_LAYERS = 20  # its time for all layers is extrapolated


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.web", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--web", default="build/web", help="what `make web` has built (default: %(default)s)")
    parser.add_argument("--out", default="out/web", help="folder of the report (default: %(default)s)")
    parser.add_argument("--parts", nargs="+", choices=[part.name for part in PARTS], help="default: all")
    parser.add_argument("--rounds", type=int, default=7, help="runs of each kind (default: %(default)s)")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    folder = Path(options.out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    tools = folder / "tools"
    tools.mkdir(exist_ok=True)
    for name in ("package.json", "package-lock.json", "measure.mjs", "browser.mjs"):
        shutil.copy(HERE / name, tools)
    if not (tools / "node_modules").exists():
        subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"], cwd=tools, check=True)
    chosen = [part for part in PARTS if not options.parts or part.name in options.parts]
    web = Path(options.web).resolve()
    rows = output_of(tools, "measure.mjs", json.dumps({
        "program": str(Path(options.lamella).resolve()), "package": str(web / "package"), "folder": str(folder),
        "rounds": options.rounds, "manifoldLayers": MANIFOLD_LAYERS,
        "parts": [{"name": part.name, "height": part.layer_height,
                   "path": str(parts.make(part, options.lamella, folder / "parts"))} for part in chosen]}))
    mesh = parts.make(MILLION, options.lamella, folder / "parts")
    visits = output_of(tools, "browser.mjs", str(web / "playground.html"), str(min(options.rounds, 5)), str(mesh),
                       str(MILLION.layer_height))
    sizes = {"package, packed": packed_bytes(web / "package", folder), "lamella.wasm": (web / "package/lamella.wasm").stat().st_size,
             "playground.html": (web / "playground.html").stat().st_size}
    here = machine.describe(options.lamella)
    page_of(chosen, rows, visits, sizes, here, options).write(folder, "web")
    (folder / "report.json").write_text(json.dumps({"machine": here, "parts": rows, "playground": visits, "bytes": sizes},
                                                   indent=1) + "\n", encoding="utf-8")
    print(f"The report is in {folder}/web.html")


def output_of(tools, script, *arguments):
    done = subprocess.run(["node", script, *arguments], cwd=tools, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


def packed_bytes(package, folder):
    done = subprocess.run(["npm", "pack", "--silent", str(package)], cwd=folder, check=True, stdout=subprocess.PIPE, text=True)
    archive = folder / done.stdout.strip()
    size = archive.stat().st_size
    archive.unlink()
    return size


def page_of(chosen, rows, visits, sizes, here, options):
    page = Page("The npm package and the playground")
    page.say(f"Seconds in Node.js, the fastest of {options.rounds} runs that alternate. Program and package read an STL file and "
             "write a CLI file with equal bytes; the program's time includes its start. `slice()` gives layers as arrays. "
             f"manifold-3d gets an indexed mesh: it first builds its own, then slices {MANIFOLD_LAYERS} of the layers, which is "
             "extrapolated to all; each area agrees with ours.")
    page.show(Table(["", ""], [[name, text] for name, text in here.items()], texts=2))
    table = Table(["part", "layers", "program, 1 thread", "program", "package, 1 thread", "package", "slice()", "manifold-3d builds",
                   "manifold-3d slices"])
    ratios = Table(["part", "package to program, 1 thread", "package to program", "manifold-3d, build and slices, to slice()",
                    "its slices alone to slice()"])
    for part in chosen:
        row = rows[part.name]
        best = {name: min(values) for name, values in row.items() if isinstance(values, list)}
        table.add(part.title, row["layers"], *(brief(best[name]) for name in (
            "native1", "native", "wasm1", "wasm", "arrays", "manifoldBuild", "manifoldSlice")))
        ratios.add(part.title, *(f"{brief(value)} x" for value in (
            best["wasm1"] / best["native1"], best["wasm"] / best["native"],
            (best["manifoldBuild"] + best["manifoldSlice"]) / best["arrays"], best["manifoldSlice"] / best["arrays"])))
        print(f"{part.title}: {', '.join(ratios.rows[-1][1:])}")
    page.show(table)
    page.show(ratios)
    page.heading("Size")
    size_table = Table(["", "MB"])
    for name, size in sizes.items():
        size_table.add(name, brief(size / 1e6))
    page.show(size_table)
    page.heading("Playground")
    page.say(f"Seconds in Chromium without a graphics card, the median of {len(visits)} visits: the first paint of the page, and, from "
             f"the moment at which it gets the file of a {MILLION.title}, the first layers on the screen, the end of slicing, "
             "and the viewer with all layers.")
    shown = Table(["first paint", "first layers", "sliced", "viewer"], texts=0)
    shown.add(*(brief(statistics.median(visit[name] for visit in visits)) for name in ("paint", "first", "sliced", "viewer")))
    print(f"playground: {' '.join(shown.rows[0])}")
    page.show(shown)
    return page


if __name__ == "__main__":
    main(sys.argv[1:])
