"""Shows broken meshes as Lamella and other slicers slice them; writes broken.md, broken.html and report.json.

    python3 -m bench.broken [options]           (from the root of the source tree; `make broken` does it)
"""

import argparse
import json
import os
import sys
from pathlib import Path

from bench.broken import report
from bench.broken.cases import cases
from bench.broken.folder import meshes_of
from bench.broken.study import Study
from bench.broken.triangles import read_stl
from bench.broken.views import RIVALS
from bench.harness import machine, parts

RING = parts.Part("ring", "ring", ("torus", "--size", "24", "--thickness", "8", "--segments", "48", "--rotate", "70,0,30"))


def main(arguments):
    options = parse(arguments)
    folder = Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    present, absent = find(options.rivals)
    study = Study(options.lamella, folder / "work", [rival for rival, _ in present], options.timeout,
                  len(os.sched_getaffinity(0)))
    found, public = [], []

    def write():
        """Called after each mesh, so that an interrupted run leaves its results so far."""
        report.build_page(found, public, present, absent, machine.describe(options.lamella)).write(folder, "broken")
        (folder / "report.json").write_text(json.dumps(report.as_json(found, public, present), indent=1) + "\n",
                                            encoding="utf-8")

    chosen = [case for case in cases(read_stl(parts.make(RING, options.lamella, folder / "parts")))
              if options.cases is None or case.name in options.cases]
    for case in chosen:
        found.append(study.case(case))
        announce(found[-1])
        write()
    for mesh in meshes_of(options.folder, options.lamella):
        public.append(study.mesh(mesh))
        announce(public[-1])
        write()
    print(f"The report is in {folder}/broken.html")


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.broken", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--out", default="out/broken", help="folder of the report (default: %(default)s)")
    parser.add_argument("--timeout", type=float, default=120, help="seconds for one run (default: %(default)s)")
    parser.add_argument("--cases", nargs="*", metavar="CASE", help="which of the broken bodies (default: all)")
    parser.add_argument("--rivals", nargs="*", metavar="RIVAL", help="which rivals (default: all that are installed)")
    parser.add_argument("--folder", help="meshes of yours, compared as well")
    return parser.parse_args(arguments)


def find(chosen):
    """Returns the available rivals with their versions, and the titles of the missing ones."""
    unknown = set(chosen or []) - {rival.name for rival in RIVALS}
    if unknown:
        raise SystemExit(f"no rival {', '.join(sorted(unknown))}; there are: {', '.join(rival.name for rival in RIVALS)}")
    versions = [(rival, rival.version()) for rival in RIVALS if chosen is None or rival.name in chosen]
    return ([(rival, version) for rival, version in versions if version is not None],
            [rival.title for rival, version in versions if version is None])


def announce(finding):
    for view, off in finding.rows:
        said = view.ended if off is None else f"{100 * off.share:.3f}% off"
        print(f"{finding.name}: {view.title}: {said}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
