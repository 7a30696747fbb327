"""Compares image jobs for resin printers with PrusaSlicer's; writes resin.md, resin.html and report.json.

    python3 -m bench.resin [options]            (from the root of the source tree; `make resin` does it)
"""

import argparse
import dataclasses
import json
import statistics
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from bench.harness import machine, parts, process
from bench.harness.page import Page, Table, brief
from bench.resin import images, slicers

PARTS = parts.named(["rook", "head", "sole", "lattice", "sheet-100"], parts.ALL_PARTS)


@dataclass
class Cell:
    part: str
    slicer: str
    ended: str
    seconds: Optional[float] = None  # the medians of the runs
    processor_seconds: Optional[float] = None
    peak_rss_bytes: Optional[int] = None
    file_bytes: Optional[int] = None
    agreement: Optional[images.Agreement] = None  # of a rival's job with ours, if both finished

    @property
    def counts(self):
        """Returns whether a rival's time counts: its images must equal ours."""
        return self.slicer in slicers.OURS or (self.agreement is not None and self.agreement.good)


def main(arguments):
    options = parse(arguments)
    chosen = parts.named(options.parts, [*parts.TINY_PARTS, *parts.ALL_PARTS]) if options.parts else PARTS
    folder = Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    asked = [slicers.lamella(options.lamella, "lamella", "Lamella, as SL1S", ".sl1s"),
             slicers.lamella(options.lamella, "goo", "Lamella, as .goo", ".goo"), slicers.check_of(options.lamella),
             slicers.lamella(options.lamella, "layers", "Lamella, layers as CLI", ".cli"), slicers.prusa_slicer()]
    present = [(slicer, slicer.version()) for slicer in asked]
    present = [(slicer, version) for slicer, version in present if version is not None]
    here = machine.describe(options.lamella)
    cells = []
    for part in chosen:
        cells += measure(part, [slicer for slicer, _ in present], folder, options)
        # After each part, so that an interrupted run leaves its results so far.
        done = [one for one in chosen if any(cell.part == one.name for cell in cells)]
        build_page(cells, done, present, here, options).write(folder, "resin")
        told = {"machine": here, "versions": {slicer.title: version for slicer, version in present},
                "cells": [dataclasses.asdict(cell) for cell in cells]}
        (folder / "report.json").write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
    print(f"The report is in {folder}/resin.html")
    if len(present) < len(asked):
        print("PrusaSlicer is not installed (tools/packages-rivals.txt): there was nothing to compare with")


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.resin", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--out", default="out/resin", help="folder of the report (default: %(default)s)")
    parser.add_argument("--parts", nargs="+", metavar="PART", help="which parts (default: some of all kinds)")
    parser.add_argument("--resolution", default="2560x1620", type=pixels, help="of the display (default: an SL1S, %(default)s)")
    parser.add_argument("--layer-height", type=float, help="in mm (default: that of the part, mostly 0.1)")
    parser.add_argument("--rounds", type=int, default=3, help="runs of each (default: %(default)s)")
    parser.add_argument("--timeout", type=float, default=300, help="seconds for one run (default: %(default)s)")
    return parser.parse_args(arguments)


def pixels(text):
    columns, rows = text.split("x")
    return int(columns), int(rows)


def measure(part, present, folder, options):
    """Runs all alternately, several times; one that fails is not tried again."""
    mesh = parts.make(part, options.lamella, folder)
    told = subprocess.run([options.lamella, "info", mesh, "--json"], capture_output=True, text=True, check=True).stdout
    job = slicers.Job(mesh, options.layer_height or part.layer_height, options.resolution,
                      slicers.pixel_mm(json.loads(told)["bbox"], options.resolution))
    runs = {slicer.name: [] for slicer in present}
    for _ in range(options.rounds):
        for slicer in present:
            if all(run.ok for run in runs[slicer.name]):
                output = output_of(slicer, folder, part)
                output.unlink(missing_ok=True)
                log = folder / f"{slicer.name}.log"
                runs[slicer.name].append(process.run(slicer.command(job, output), options.timeout, log))
    cells = [cell_of(part, slicer, runs[slicer.name], output_of(slicer, folder, part)) for slicer in present]
    ours = present[0]
    for slicer, cell in zip(present, cells):
        if slicer.name not in slicers.OURS and cell.ended == cells[0].ended == "ok":
            cell.agreement = images.compare(output_of(ours, folder, part), output_of(slicer, folder, part))
        print(f"{part.name}: {slicer.title}: {cell.ended}" + ("" if cell.seconds is None else f", {cell.seconds:.3f} s")
              + ("" if cell.agreement is None else f", {cell.agreement.text()}"), flush=True)
    for slicer in present:
        output_of(slicer, folder, part).unlink(missing_ok=True)
    return cells


def output_of(slicer, folder, part):
    return folder / f"{part.name}-{slicer.name}{slicer.suffix}"


def cell_of(part, slicer, runs, output):
    cell = Cell(part.name, slicer.name, runs[-1].ended)
    if runs[-1].ok:
        cell.seconds = statistics.median(run.seconds for run in runs)
        cell.processor_seconds = statistics.median(run.user + run.system for run in runs)
        cell.peak_rss_bytes = max(run.peak_rss_bytes for run in runs)
        cell.file_bytes = output.stat().st_size
    return cell


def build_page(cells, done, present, here, options):
    page = Page("Pictures for resin printers beside PrusaSlicer's")
    page.say(f"From an STL file to a job of {options.resolution[0]} x {options.resolution[1]} pixels with anti-aliasing, which the part fills "
             "but for a tenth; layers of {options.layer_height or 0.1:g} mm, no supports, no pad, nothing made smaller or larger on purpose. Whole "
             f"processes in turn, medians of {options.rounds} runs; limit for one run: {options.timeout:g} s. The second row "
             "is the same part in runs of pixels, without compression, the third is lamella check, the fourth a slice file "
             "without pictures.",
             f"{here['processor']}, {here['threads']} threads, {here['memory']}; {here['system']}; {here['date']}; "
             + ", ".join(f"{slicer.title} {version}" for slicer, version in present if slicer.images) + ".",
             f"{images.LOOKED_AT} images of each job are compared, pixel by pixel; a time counts when there are as many "
             f"images, or one fewer, and differences add up to less than {images.MOST_APART:g} of the covered area, and "
             "stands in brackets otherwise. The last layer is not looked at: where the part ends within it, programs cut it "
             "elsewhere.")
    for part in done:
        page.heading(part.title)
        table = Table(["", "seconds", "to Lamella's", "processor s", "peak MB", "file MB", "pictures"])
        rows = {cell.slicer: cell for cell in cells if cell.part == part.name}
        for slicer, _ in present:
            table.add(slicer.title, *row(rows[slicer.name], rows["lamella"]))
        page.show(table)
    return page


def row(cell, ours):
    if cell.seconds is None:
        return cell.ended, "", "", "", "", ""
    ratio = brief(cell.seconds / ours.seconds) if ours.seconds else ""
    values = [f"{cell.seconds:.3f}", ratio]
    if not cell.counts:
        values = [f"({value})" if value else "" for value in values]
    return (*values, f"{cell.processor_seconds:.2f}", f"{cell.peak_rss_bytes / 1e6:.0f}", f"{cell.file_bytes / 1e6:.1f}",
            cell.agreement.text() if cell.agreement else "")


if __name__ == "__main__":
    main(sys.argv[1:])
