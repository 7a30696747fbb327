"""Measures how jobs gain from cores, or takes the results of another machine; writes cores.md and cores.html.

    python3 -m bench.cores [options]      (from the root of the source tree; `make cores` does it)

The program build-bench/bench/cores measures, and needs only the C library. It can be copied to another machine and run there with --json FILE;
--results FILE then makes the pages of these results.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

from bench.harness.chart import Series, scatter
from bench.harness.page import Chart, Page, Table, brief


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.cores", description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build-bench/bench/cores", help="that measures (default: %(default)s)")
    parser.add_argument("--out", default="out/cores", help="folder of the report (default: %(default)s)")
    parser.add_argument("--results", help="results of --json, perhaps of another machine (default: measure)")
    parser.add_argument("--docs", help="the folder docs: write cores.md and its charts there, too")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    folder = Path(options.out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    results = Path(options.results) if options.results else folder / "cores.json"
    if not options.results:
        subprocess.run([options.program, "--json", str(results)], check=True)
    page = page_of(json.loads(results.read_text(encoding="utf-8")))
    page.write(folder, "cores")
    if options.docs:
        page.write_to_documentation(options.docs, "cores")
    print(f"The report is in {folder}/cores.html")


def page_of(results):
    threads = results["threads"]
    page = Page("Cores")
    page.say("This page shows how much faster the commands of the program become with more threads.")
    page.say("Each time is the shortest wall time of several runs on the machine named below, from the start to the end of a "
             "process. [Benchmarks](benchmarks.md) gives medians instead. They are larger, because in some runs the system "
             "allocates memory slowly. All outputs of a job were equal.")
    page.say("**times**: the time of one thread divided by the time of all threads; **efficiency** is this number divided by "
             "the number of threads.",
             "**lower bound**: the larger of two times: (a) the processor time of the run with one thread, divided by the "
             "number of threads; (b) the time to read the inputs on all threads and then write the output on one thread, at "
             "the speeds measured on this machine.",
             "**MB** is the peak memory of the process.",
             "**no file** writes only statistics (`--stats`), for which each layer is measured and hashed; it can take "
             "longer than writing a CLI file.",
             "**lattice 26** is a lattice with 26 cells in each direction. **head 7.5 million** is the test part `head`, "
             "subdivided to 7.5 million triangles.")
    page.say(f"Machine: {results['machine']}.")
    page.heading("Large parts")
    page.show(Chart("cores", "Seconds with 1 to all threads; lines: the lower bound", scatter(
        [Series(job["job"], [(run["threads"], run["wall_s"]) for run in job["runs"]],
                limit=tuple((run["threads"], run["limit_s"]) for run in job["runs"])) for job in results["growing"]],
        "Seconds, and the lower bound as a line", "threads", "s")))
    page.show(table_of(results["growing"], threads))
    page.heading("Other jobs")
    page.show(table_of(results["others"], [run["threads"] for run in results["others"][0]["runs"]]))
    return page


def table_of(jobs, threads):
    table = Table(["job", *(f"{n} thread{'' if n == 1 else 's'} s" for n in threads), "times", "efficiency", "lower bound s",
                   "to the lower bound", "MB 1 thread", "MB all"])
    for job in jobs:
        one, last = job["runs"][0], job["runs"][-1]
        times = one["wall_s"] / last["wall_s"]
        table.add(job["job"], *(brief(run["wall_s"]) for run in job["runs"]), f"{times:.1f}", f"{100 * times / last['threads']:.0f} %",
                  brief(last["limit_s"]), f"{last['wall_s'] / last['limit_s']:.1f} x", f"{one['peak_bytes'] / 1e6:.0f}",
                  f"{last['peak_bytes'] / 1e6:.0f}")
    return table


if __name__ == "__main__":
    main(sys.argv[1:])
