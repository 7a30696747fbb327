"""Measures the cost of writing pages, and their time until display; writes pages.md, pages.html and report.json.

    python3 -m bench.pages [options]      (from the root of the source tree; `make page-bench` does it)
"""

import argparse
import json
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

from bench.harness import machine, parts, process
from bench.harness.page import Page, Table, brief

HERE = Path(__file__).parent
PACKAGES = HERE.parents[1] / "tests" / "viewer"  # for driving the browser
PARTS = [part for part in parts.ALL_PARTS if part.name in ("rook", "lattice", "sheet-1225", "head", "sole")]
TIMEOUT = 600  # seconds


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.pages", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--out", default="out/pages", help="folder of the report (default: %(default)s)")
    parser.add_argument("--parts", nargs="+", choices=[part.name for part in PARTS], help="default: all")
    parser.add_argument("--rounds", type=int, default=5, help="visits of each page (default: %(default)s)")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    folder = Path(options.out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    chosen = [part for part in PARTS if not options.parts or part.name in options.parts]
    rows = {part.name: written(part, folder, options) for part in chosen}
    visits = visit([rows[part.name]["page"] for part in chosen], folder, options.rounds)
    for row in rows.values():
        row["visits"] = visits[row["page"]]
    here = machine.describe(options.lamella)
    page_of(chosen, rows, here, options).write(folder, "pages")
    (folder / "report.json").write_text(json.dumps({"machine": here, "parts": rows}, indent=1) + "\n", encoding="utf-8")
    print(f"The report is in {folder}/pages.html")


def written(part, folder, options):
    """Returns CPU seconds of the page and of a slice file of the same layers, and the size of the page."""
    mesh = parts.make(part, options.lamella, folder / "parts")
    height = ["--layer-height", part.layer_height]

    def run(*command):
        done = process.run([options.lamella, *command], TIMEOUT, folder / f"{part.name}.log")
        if not done.ok:
            raise SystemExit(f"{part.name}: {done.ended}: {done.text}")
        return done.user + done.system

    page = folder / f"{part.name}.html"
    return {"page": str(page), "page_seconds": run("view", mesh, *height, "-o", page),
            "slice_seconds": run("slice", mesh, *height, "-o", folder / f"{part.name}.cli"),
            "bytes": page.stat().st_size}


def visit(pages, folder, rounds):
    work = folder / "browser"
    work.mkdir(exist_ok=True)
    for file in [PACKAGES / "package.json", PACKAGES / "package-lock.json", HERE / "first_picture.mjs"]:
        shutil.copy(file, work)
    if not (work / "node_modules").exists():
        subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=work, check=True)
    done = subprocess.run(["node", "first_picture.mjs", str(rounds), *pages], cwd=work, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


def page_of(chosen, rows, here, options):
    page = Page("Pages")
    page.say("Written: processor seconds of `lamella view`, beside those of `lamella slice` to a Common Layer file of the "
             f"same layers. Shown: seconds in Chromium without a graphics card, the median of {options.rounds} visits, from "
             "going to the page until the first layer is drawn, and until the first picture of the stack in space; the page "
             "shows both side by side.")
    page.show(Table(["", ""], [[name, text] for name, text in here.items()], texts=2))
    table = Table(["part", "page MB", "view s", "slice s", "first layer s", "stack s"])
    for part in chosen:
        row = rows[part.name]
        shown = [statistics.median(one[what] for one in row["visits"]) / 1000 for what in ("layer", "stack")]
        table.add(part.title, brief(row["bytes"] / 1e6), brief(row["page_seconds"]), brief(row["slice_seconds"]),
                  *(brief(seconds) for seconds in shown))
        print(f"{part.title}: {' '.join(table.rows[-1][1:])}")
    page.show(table)
    return page


if __name__ == "__main__":
    main(sys.argv[1:])
