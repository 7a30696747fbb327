"""Compares Lamella with other slicers; writes rivals.md, rivals.html and report.json.

    python3 -m bench.rivals [options]           (from the root of the source tree; `make rivals` does it)
"""

import argparse
import json
import os
import sys
from pathlib import Path

from bench.harness import machine, parts
from bench.rivals import library, report
from bench.rivals.compare import Comparison
from bench.rivals.cura import CURA
from bench.rivals.prusa_slicer import PRUSA_SLICER
from bench.rivals.slic3r import SLIC3R

PARTS = parts.ALL_PARTS


def main(arguments):
    options = parse(arguments)
    chosen = parts.named(options.parts, [*parts.TINY_PARTS, *PARTS]) if options.parts else PARTS
    present, absent = find(options)
    folder = Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    here = machine.describe(options.lamella)
    threads = len(os.sched_getaffinity(0))
    comparison = Comparison(options.lamella, options.older, folder, options.timeout, threads)
    cells = []
    for part in chosen:
        cells += comparison.run(part, [rival for rival, _ in present], announce)
        # After each part, so that an interrupted run leaves its results so far.
        sliced = [one for one in chosen if any(cell.part == one.name for cell in cells)]
        page = report.build_page(cells, sliced, present, absent, here, options.timeout, threads)
        page.write(folder, "rivals")
        if options.docs:
            page.write_to_documentation(options.docs, "benchmarks")
        (folder / "report.json").write_text(
            json.dumps(report.as_json(cells, present, absent, here, options.timeout, threads), indent=1) + "\n",
            encoding="utf-8")
    print(f"The report is in {folder}/rivals.html")


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.rivals", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--older", metavar="PROGRAM", help="an older lamella, to be measured in turn with this one")
    parser.add_argument("--libraries", default="build-bench/bench/rivals",
                        help="folder of the built cgal_slicer (default: %(default)s)")
    parser.add_argument("--out", default="out/rivals", help="folder of the report (default: %(default)s)")
    parser.add_argument("--docs", metavar="FOLDER", help="write benchmarks.md and its charts for the documentation, too")
    parser.add_argument("--timeout", type=float, default=300, help="seconds for one run (default: %(default)s)")
    parser.add_argument("--parts", nargs="+", metavar="PART", help="which parts (default: all)")
    parser.add_argument("--rivals", nargs="*", metavar="RIVAL", help="which rivals (default: all that are installed)")
    return parser.parse_args(arguments)


def find(options):
    """Returns rivals with their versions, and the missing ones."""
    rivals = [library.cgal(options.libraries), PRUSA_SLICER, CURA, library.vtk(), SLIC3R]
    if options.rivals is not None:
        unknown = set(options.rivals) - {rival.name for rival in rivals}
        if unknown:
            raise SystemExit(f"no rival {', '.join(sorted(unknown))}; there are: "
                             f"{', '.join(rival.name for rival in rivals)}")
        rivals = [rival for rival in rivals if rival.name in options.rivals]
    present, absent = [], {}
    for rival in rivals:
        version = rival.version()
        if version is None:
            absent[rival.title] = "it is not installed (tools/packages-rivals.txt)"
        else:
            present.append((rival, version))
    return present, absent


def announce(cell):
    taken = "" if cell.seconds is None else f" {cell.seconds:.3f} s"
    layers = "" if cell.agreement is None else f", layers: {cell.agreement.text()}"
    print(f"{cell.part}: {cell.slicer}: {cell.ended}{taken}{layers}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
