"""Measures the tables of the EECC paper again; writes paper.md, paper.html and paper.json.

    python3 -m bench.paper [options]            (from the root of the source tree; `make paper` does it)
"""

import argparse
import json
import os
import sys
from dataclasses import dataclass, field
from pathlib import Path

from bench.harness import machine, parts
from bench.paper import growth as growths
from bench.paper import images, report
from bench.paper.cell import ENGINES, Laboratory
from bench.rivals.__main__ import announce as announce_rival
from bench.rivals.compare import Comparison
from bench.rivals.cura import CURA
from bench.rivals.prusa_slicer import PRUSA_SLICER
from bench.rivals.slic3r import SLIC3R

FIGURES = Path(__file__).with_name("figures.json")
RIVALS = [CURA, SLIC3R, PRUSA_SLICER]  # the last one is not in the paper, but succeeds Slic3r


@dataclass
class Measured:
    parts: list
    cells: list = field(default_factory=list)
    order_parts: dict = field(default_factory=dict)
    order_cells: list = field(default_factory=list)
    split_cells: list = field(default_factory=list)  # sheets split as a whole, for the engines that this slows down
    rival_cells: list = field(default_factory=list)
    rival_titles: dict = field(default_factory=dict)
    images: dict = field(default_factory=dict)  # part name -> SVG
    false_match: str = ""
    growth: growths.Growth = field(default_factory=growths.Growth)


def main(arguments):
    options = parse(arguments)
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    folder = Path(options.out)
    work, parts_folder = folder / "work", folder.parent / "parts"
    work.mkdir(parents=True, exist_ok=True)
    here = machine.describe(options.lamella)
    tiny = options.tiny
    chosen = parts.TINY_PARTS if tiny else parts.PAPER_PARTS
    if options.parts:
        chosen = parts.named(options.parts, chosen)
    measured = Measured(chosen)

    def write():
        page = report.build_page(measured, figures, here, options.timeout)
        page.write(folder, "paper")
        if options.docs:
            page.write_to_documentation(options.docs, "paper")
        text = json.dumps(report.as_json(measured, here, options.timeout), indent=1)
        (folder / "paper.json").write_text(text + "\n", encoding="utf-8")

    measured.false_match = images.of_false_match(options.lamella, work)
    measured.images = {part.name: images.of_part(part, options.lamella, work, parts_folder)
                         for part in chosen if part.name in images.VIEWS}
    measured.growth = growths.measure(options.lamella, work, parts_folder, options.timeout, small=tiny, announce=announce_growth)

    def new_laboratory():
        return Laboratory(options.lamella, work, parts_folder, options.timeout, most_runs=2 if tiny else 5)

    laboratory = new_laboratory()
    sheets = {order: parts.sheet(4 if tiny else 100, order, 32 if tiny else None) for order in ("wall", "hole", "split", "shuffle")}
    measured.order_parts = {order: part.name for order, part in sheets.items()}
    for part in sheets.values():
        measured.order_cells += new_laboratory().cells(part, ENGINES, announce)
    for part in chosen:
        measured.cells += laboratory.cells(part, ENGINES, announce)
        write()  # an interrupted run leaves its results so far
    splitting = new_laboratory()
    for part in chosen:
        if part.family == "sheet" and "edge" not in part.name and part.name in figures["table5_seconds"]:
            measured.split_cells += splitting.cells(parts.sheet(part.make[2], "split"), ["ecc-edge-match", "eecc"], announce)
            write()
    measure_rivals(measured, figures, folder, options)
    write()
    print(f"The report is in {folder}/paper.html")
    wrong = [cell for cell in measured.cells + measured.order_cells + measured.split_cells if cell.ended not in ("ok", "timeout")]
    return 1 if wrong else 0


def measure_rivals(measured, figures, folder, options):
    present = [] if options.without_rivals else [rival for rival in RIVALS if rival.version() is not None]
    measured.rival_titles = {rival.name: rival.title for rival in present}
    comparison = Comparison(options.lamella, folder, options.rival_timeout, len(os.sched_getaffinity(0)))
    for part in measured.parts:
        if present and part.name in figures["table6_seconds"]:
            measured.rival_cells += comparison.run(part, present, announce_rival)


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.paper", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", type=Path, default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--out", default="out/paper", help="folder of the report (default: %(default)s)")
    parser.add_argument("--docs", metavar="FOLDER", help="write paper.md and its pictures for the documentation, too")
    parser.add_argument("--timeout", type=float, default=60, help="seconds for one run (default: %(default)s)")
    parser.add_argument("--rival-timeout", type=float, default=300, help="the same for Table 6 (default: %(default)s)")
    parser.add_argument("--parts", nargs="+", metavar="PART", help="which parts (default: all)")
    parser.add_argument("--without-rivals", action="store_true", help="leave Table 6 out")
    parser.add_argument("--tiny", action="store_true", help="tiny parts, to try the report itself")
    return parser.parse_args(arguments)


def announce(cell):
    taken = f" {cell.seconds:.4f} s" if cell.ok else (f", estimated {cell.estimate:.0f} s" if cell.estimate else "")
    print(f"{cell.part}: {cell.engine}: {cell.ended}{taken}", flush=True)


def announce_growth(sample):
    print(f"growth: {sample.engine}, {sample.order}, k {sample.k:.0f}, m {sample.m}: {sample.searches} searches, "
          f"{sample.comparisons} comparisons", flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
