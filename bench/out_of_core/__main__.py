"""Measures time and memory for a mesh larger than memory: slices a lattice of 100 million triangles with 1 GB.

    python3 -m bench.out_of_core [options]      (from the root of the source tree; `make out-of-core` does it)
"""

import argparse
import json
import math
import shutil
import statistics
from pathlib import Path

from bench.harness import machine, process


def main(arguments):
    options = parse(arguments)
    folder = Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in machine.describe(options.lamella).items():
        print(f"{name}: {text}")
    bench = Bench(options, folder)
    report = {"machine": machine.describe(options.lamella)}
    if not options.without_ratio:
        report["ratio"] = bench.ratio()
    report["large"] = bench.large()
    (folder / "out_of_core.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


def parse(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m bench.out_of_core", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella", help="the program (default: %(default)s)")
    parser.add_argument("--areas", default="build-bench/bench/out_of_core/stream_areas",
                        help="the program that checks (default: %(default)s)")
    parser.add_argument("--out", default="out/out_of_core", help="folder of all files (default: %(default)s)")
    parser.add_argument("--cells", type=int, default=61, help="of the large lattice (default: %(default)s, 5 GB)")
    parser.add_argument("--memory", default="1G", help="what slicing may take (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=2, help="default: %(default)s")
    parser.add_argument("--fitting-cells", type=int, default=26, help="of the lattice that fits (default: %(default)s)")
    parser.add_argument("--fitting-memory", default="300M", help="what that one is sliced with (default: %(default)s)")
    parser.add_argument("--layer-height", type=float, default=0.1, help="mm (default: %(default)s)")
    parser.add_argument("--rounds", type=int, default=3, help="of the comparison (default: %(default)s)")
    parser.add_argument("--timeout", type=float, default=3600, help="seconds for one run (default: %(default)s)")
    parser.add_argument("--without-ratio", action="store_true", help="leave the comparison out")
    parser.add_argument("--keep", action="store_true", help="leave the mesh and the slice file where they are")
    return parser.parse_args(arguments)


def bytes_of(text):
    return float(text[:-1]) * {"k": 1e3, "M": 1e6, "G": 1e9}[text[-1]]


class Bench:
    def __init__(self, options, folder):
        self.options = options
        self.folder = folder

    def run(self, *command):
        outcome = process.run(command, self.options.timeout, self.folder / "log.txt", memory=1 << 46)
        if not outcome.ok:
            raise SystemExit(f"{' '.join(map(str, command))}: {outcome.ended}: {outcome.text}")
        return outcome

    def make(self, cells):
        mesh = self.folder / f"lattice-{cells}.stl"
        outcome = self.run(self.options.lamella, "make", "lattice", "--cells", cells, "-o", mesh)
        size = mesh.stat().st_size
        print(f"made {mesh.name}: {(size - 84) // 50:,} triangles, {size / 1e9:.2f} GB in {outcome.seconds:.1f} s, "
              f"peak memory {outcome.peak_rss_bytes / 1e6:.0f} MB", flush=True)
        return mesh

    def slice(self, mesh, memory=None):
        output, stats = self.folder / f"{mesh.stem}.cli", self.folder / f"{mesh.stem}.json"
        limit = ["--max-memory", memory] if memory else []
        outcome = self.run(self.options.lamella, "slice", mesh, "-o", output, "--stats", stats, "--threads",
                           self.options.threads, "--layer-height", self.options.layer_height, *limit)
        told = json.loads(stats.read_text(encoding="utf-8"))
        return {"seconds": outcome.seconds, "ranges": told.get("ranges", 0), "peak_rss_bytes": outcome.peak_rss_bytes,
                "seconds_of": told["seconds"], "layers": told["layers"], "output": output,
                "output_bytes": output.stat().st_size}

    def ratio(self):
        """Slices a mesh that fits into memory, whole and in ranges of planes, alternately."""
        mesh = self.make(self.options.fitting_cells)
        times = {"whole": [], "ranges": []}
        self.slice(mesh)  # fills the cache
        for _ in range(self.options.rounds):
            whole = self.slice(mesh)
            ranges = self.slice(mesh, self.options.fitting_memory)
            if whole["ranges"] != 0 or ranges["ranges"] < 2:
                raise SystemExit("the one that should fit does not, or the one that should not does")
            if whole["layers"] != ranges["layers"]:
                raise SystemExit("the layers differ")
            times["whole"].append(whole["seconds"])
            times["ranges"].append(ranges["seconds"])
        seconds = {name: statistics.median(all_) for name, all_ in times.items()}
        told = {"seconds": seconds, "ratio": seconds["ranges"] / seconds["whole"], "ranges": ranges["ranges"],
                "peak_rss_bytes": {"whole": whole["peak_rss_bytes"], "ranges": ranges["peak_rss_bytes"]}}
        print(f"whole: {seconds['whole']:.2f} s, {whole['peak_rss_bytes'] / 1e6:.0f} MB; with "
              f"{self.options.fitting_memory} in {ranges['ranges']} ranges: {seconds['ranges']:.2f} s, "
              f"{ranges['peak_rss_bytes'] / 1e6:.0f} MB: {told['ratio']:.2f} times the time", flush=True)
        self.remove(mesh, whole["output"])
        return told

    def large(self):
        mesh = self.make(self.options.cells)
        sliced = self.slice(mesh, self.options.memory)
        limit = bytes_of(self.options.memory)
        print(f"sliced with {self.options.memory} on {self.options.threads} threads: {len(sliced['layers'])} layers, "
              f"{sliced['output_bytes'] / 1e9:.2f} GB, {sliced['ranges']} ranges, {sliced['seconds']:.1f} s "
              f"({', '.join(f'{name} {s:.1f}' for name, s in sliced['seconds_of'].items() if s)}), "
              f"peak memory {sliced['peak_rss_bytes'] / 1e6:.0f} MB, {sliced['peak_rss_bytes'] / limit:.0%} of the limit",
              flush=True)
        worst = self.check(mesh, sliced["layers"])
        print(f"areas agree with those computed from the triangles to {worst:.1e} of their size", flush=True)
        self.remove(mesh, sliced["output"])
        if sliced["peak_rss_bytes"] > 1.1 * limit:
            raise SystemExit("more memory than was allowed")
        told = {key: sliced[key] for key in ("seconds", "seconds_of", "ranges", "peak_rss_bytes", "output_bytes")}
        return dict(told, layers=len(sliced["layers"]), largest_area_error=worst)

    def check(self, mesh, layers):
        areas = [float(line) for line in self.run(self.options.areas, mesh, self.options.layer_height).text.split()]
        if len(areas) != len(layers):
            raise SystemExit(f"{len(layers)} layers were sliced, and there are {len(areas)}")
        worst = 0
        for layer, area in zip(layers, areas):
            error = math.fabs(layer["area_mm2"] - area) / max(area, 1e-9)
            worst = max(worst, error)
            if layer["open_chains"] or error > 1e-9:
                raise SystemExit(f"layer {layer['index']}: area {layer['area_mm2']}, expected {area}; "
                                 f"{layer['open_chains']} open chains")
        return worst

    def remove(self, *paths):
        for path in paths:
            if not self.options.keep:
                path.unlink()
        free = shutil.disk_usage(self.folder).free
        print(f"{free / 1e9:.0f} GB of disk are free", flush=True)


if __name__ == "__main__":
    import sys
    main(sys.argv[1:])
