"""Compares reading mesh files into meshes with other readers; writes read_meshes.md, .html and report.json.

    python3 -m bench.read_meshes [options]      (from the root of the source tree; `make read-meshes` does it)
"""

import argparse
import json
import statistics
from pathlib import Path

from bench.harness import machine, process
from bench.harness.page import Page, Table, brief
from bench.read_meshes import files
from bench.read_meshes.readers import readers


def main(arguments):
    options = parse(arguments)
    folder = Path(options.out)
    expected = files.make(options.lamella, options.body, folder / "files")
    present = [(reader, reader.version()) for reader in readers(options.programs, options.lamella)]
    absent = [reader.title for reader, version in present if version is None]
    present = [(reader, version) for reader, version in present if version is not None]
    cells = []
    for one in files.FORMATS:
        if not options.formats or one.name in options.formats:
            cells += measure(one, present, folder, expected, options)
    here = machine.describe(options.lamella)
    build_page(cells, present, absent, here, expected, options).write(folder, "read_meshes")
    (folder / "report.json").write_text(json.dumps({"machine": here, "triangles": expected, "cells": cells}, indent=1) + "\n",
                                        encoding="utf-8")
    print(f"The report is in {folder}/read_meshes.html")
    if any(cell["reader"] == "lamella" and not cell["counts"] for cell in cells):
        raise SystemExit("Lamella read other triangles than there are")


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.read_meshes", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--programs", default="build-bench/bench/read_meshes",
                        help="folder of the built readers (default: %(default)s)")
    parser.add_argument("--out", default="out/read_meshes", help="folder of the report (default: %(default)s)")
    parser.add_argument("--body", nargs=argparse.REMAINDER, default=["sheet", "--holes", "484"], metavar="...",
                        help="what `lamella make` makes, with its options; the last one here (default: a sheet of a million "
                             "triangles)")
    parser.add_argument("--formats", nargs="+", choices=[one.name for one in files.FORMATS], help="default: all")
    parser.add_argument("--rounds", type=int, default=5, help="readings by each (default: %(default)s)")
    parser.add_argument("--timeout", type=float, default=120, help="seconds for one reading (default: %(default)s)")
    return parser.parse_args(arguments)


def measure(one, present, folder, expected, options):
    """Runs all readers of a format alternately, several times; the first run of each fills the cache and does not
    count."""
    path = folder / "files" / one.file
    chosen = [reader for reader, _ in present if one.name in reader.formats]
    runs = {reader.name: [] for reader in chosen}
    for _ in range(options.rounds + 1):
        for reader in chosen:
            if not any(run["ended"] != "ok" for run in runs[reader.name]):
                runs[reader.name].append(read(reader, path, folder, options.timeout))
    cells = []
    for reader in chosen:
        last = runs[reader.name][-1]
        good = [run for run in runs[reader.name][1:] if run["ended"] == "ok"]
        cell = {"format": one.name, "reader": reader.name, "ended": last["ended"], "triangles": last.get("triangles"),
                "counts": bool(good) and last.get("triangles") == expected}
        if good and last["ended"] == "ok":
            cell["seconds"] = statistics.median(run["seconds"] for run in good)
            cell["spread"] = [min(run["seconds"] for run in good), max(run["seconds"] for run in good)]
            cell["peak_rss_bytes"] = max(run["peak_rss_bytes"] for run in good)
        cells.append(cell)
        print(f"{one.title}: {reader.title}: {cell['ended']}, {cell.get('seconds', float('nan')):.4f} s", flush=True)
    return cells


def read(reader, path, folder, timeout):
    outcome = process.run([*reader.command, path], timeout, folder / f"{reader.name}.log")
    if not outcome.ok:
        return {"ended": outcome.ended}
    seconds, triangles = reader.told(outcome.text, outcome.seconds)
    return {"ended": "ok", "seconds": seconds, "triangles": triangles, "peak_rss_bytes": outcome.peak_rss_bytes}


def build_page(cells, present, absent, here, expected, options):
    page = Page("From a mesh file to a mesh")
    page.say(f"A body of {expected:,} triangles (`lamella make {' '.join(options.body)}`), read from the page cache by each "
             f"program in turn, {options.rounds} times; the median of the seconds that the reading takes within the "
             "process, and the peak memory of the process. A time counts where as many triangles were read; else it "
             "stands in brackets.")
    page.show(Table(["", ""], [[name, text] for name, text in here.items()], texts=2))
    page.say("Read by " + ", ".join(f"{reader.title} {version}" for reader, version in present) + "."
             + (f" Not installed: {', '.join(absent)}." if absent else ""))
    for one in files.FORMATS:
        rows = [cell for cell in cells if cell["format"] == one.name]
        if not rows:
            continue
        page.heading(one.title)
        table = Table(["reader", "seconds", "times Lamella", "peak MB"])
        ours = next((cell.get("seconds") for cell in rows if cell["reader"] == "lamella"), None)
        for cell in rows:
            table.add(cell["reader"], *numbers(cell, ours))
        page.show(table)
    return page


def numbers(cell, ours):
    if "seconds" not in cell:
        return cell["ended"], "", ""
    seconds = f"{cell['seconds']:.4f}"
    return (seconds if cell["counts"] else f"({seconds}, {cell['triangles']} triangles)",
            brief(cell["seconds"] / ours) if ours and cell["counts"] else "",
            f"{cell['peak_rss_bytes'] / 1e6:.0f}")


if __name__ == "__main__":
    import sys
    main(sys.argv[1:])
