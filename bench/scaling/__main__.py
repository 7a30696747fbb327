"""Measures communication and time of lamella-mpi on this machine and predicts them for a cluster.

    python3 -m bench.scaling [options]      (from the root of the source tree; `make scaling` does it)

All processes share one machine here, with one thread each, so with more processes than processors only CPU time counts,
not wall time. A process alone reads a mesh that fits into memory once, so the runs with the fewest processes that share
the file give the rates; the model predicts every run of several processes, and the report compares it with the measured points.
"""

import argparse
import json
import os
import subprocess
from pathlib import Path

from bench.harness import machine

TRIANGLE = 36  # bytes in a message


def parse():
    parser = argparse.ArgumentParser(prog="python3 -m bench.scaling", description=__doc__.splitlines()[0])
    parser.add_argument("--lamella", default="build/lamella")
    parser.add_argument("--out", default="out/scaling", help="folder of all files (default: %(default)s)")
    parser.add_argument("--cells", type=int, nargs="+", default=[12, 20], help="of the lattices (default: %(default)s)")
    parser.add_argument("--processes", type=int, nargs="+", default=[1, 2, 3, 5, 8], help="default: %(default)s")
    parser.add_argument("--rounds", type=int, default=3, help="default: %(default)s")
    parser.add_argument("--network", type=float, default=1.0, help="bytes a second of a process's link, GB (default: 1)")
    parser.add_argument("--disk", type=float, default=10.0, help="bytes a second of the shared disk, GB (default: 10)")
    return parser.parse_args()


def run(wishes, folder, part, processes):
    command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(processes), wishes.lamella + "-mpi", "slice", part,
               "-o", folder / "out.cli", "--threads", "1", "--stats", folder / "stats.json", "--progress", "none"]
    subprocess.run(list(map(str, command)), check=True, capture_output=True,
                   env=dict(os.environ, OMPI_MCA_mpi_yield_when_idle="1"))
    return json.loads((folder / "stats.json").read_text())


def figures(stats):
    """Returns the quantities of a run that the model describes."""
    processes = stats["processes"]
    triangles = sum(r["triangles_read"] for r in processes)
    sliced = [r["triangles_sliced"] for r in processes]
    points = [r["points"] for r in processes]
    return {"processes": len(processes), "triangles": triangles, "sliced": sum(sliced), "planes": len(stats["layers"]),
            "points": sum(points), "sent": sum(r["bytes_sent"] for r in processes), "balance": max(points) / (sum(points) / len(points)),
            "read": max(r["seconds"]["read"] for r in processes), "slice": max(r["seconds"]["slice"] for r in processes),
            "exchange": max(r["seconds"]["exchange"] for r in processes),
            "total": stats["seconds"]["total"], "bytes": (Path(stats["options"]["output"])).stat().st_size}


class Model:
    """Rates from runs of a few processes; everything else follows from counts."""

    def __init__(self, runs):
        # Of the mean process of each run: its triangles in the file and in its range, its points, its seconds.
        shares = [{key: m[key] / m["processes"] for key in ["triangles", "sliced", "points"]} for m in runs]
        times = [m["slice"] / m["balance"] for m in runs]
        self.read_rate = sum(s["triangles"] for s in shares) / sum(m["read"] for m in runs)
        # Slicing: a time for each triangle and for each point, by least squares over two or more parts.
        a = sum(s["sliced"] ** 2 for s in shares)
        b = sum(s["sliced"] * s["points"] for s in shares)
        c = sum(s["points"] ** 2 for s in shares)
        u = sum(s["sliced"] * time for s, time in zip(shares, times))
        v = sum(s["points"] * time for s, time in zip(shares, times))
        det = a * c - b * b
        fits = det > 1e-6 * a * c and (u * c - v * b) / det > 0 and (v * a - u * b) / det > 0
        self.triangle, self.point = ((u * c - v * b) / det, (v * a - u * b) / det) if fits else (0, v / c)
        # The equation for `sliced` of `predict`, solved for the cut triangles.
        borders = [(m["processes"] - 1) / (m["planes"] - 1) for m in runs]
        cut = sum((m["sliced"] - border * m["points"]) / (1 - border) for m, border in zip(runs, borders))
        self.cut = cut / sum(m["triangles"] for m in runs)
        self.out_bytes = sum(m["bytes"] for m in runs) / sum(m["points"] for m in runs)

    def predict(self, triangles, planes, points, processes, balance=1.0):
        # Each cut triangle goes to one range, and to one more for each bound between ranges that is among its planes.
        # It has a point on each plane, so all triangles together span points - cut gaps between planes. The triangles
        # of the file are in no order, so one in `processes` is already in its range.
        cut = self.cut * triangles
        sliced = cut + (processes - 1) * (points - cut) / (planes - 1)
        return {"sliced": sliced, "sent": TRIANGLE * sliced * (processes - 1) / processes,
                "read": triangles / processes / self.read_rate,
                "slice": balance * (self.triangle * sliced + self.point * points) / processes,
                "bytes": self.out_bytes * points}


def cluster(model, scale, wishes):
    """Predicts 10^9 triangles on 64 processes: a lattice as measured, with more cells and as many more planes."""
    factor = (1e9 / scale["triangles"]) ** (1 / 3)
    planes, points = scale["planes"] * factor, scale["points"] * factor**3
    lines = []
    for processes in [1, 8, 64]:
        p = model.predict(1e9, planes, points, processes, 1.05)
        link, disk = wishes.network * 1e9, wishes.disk * 1e9
        times = {"read": max(p["read"], 3 * 50e9 / disk), "exchange": p["sent"] / processes / link, "slice": p["slice"],
                 "write": max(p["bytes"] / disk, p["bytes"] / processes / link)}
        lines.append((processes, p["sent"], times, sum(times.values())))
    return planes, points, lines


def report(measured, model, scale, wishes):
    text = ["| triangles | processes | to be sliced | predicted | sent, MB | predicted | balance | read, s | predicted | slice, s | "
            "predicted |", "|---|---|---|---|---|---|---|---|---|---|---|"]
    for m in measured:
        p = model.predict(m["triangles"], m["planes"], m["points"], m["processes"], m["balance"])
        text.append(f"| {m['triangles']:,} | {m['processes']} | {m['sliced']:,} | {p['sliced']:,.0f} | {m['sent'] / 1e6:.1f} | "
                    f"{p['sent'] / 1e6:.1f} | {m['balance']:.2f} | {m['read']:.3f} | {p['read']:.3f} | {m['slice']:.3f} | "
                    f"{p['slice']:.3f} |")
    planes, points, lines = cluster(model, scale, wishes)
    text += ["", f"10^9 triangles, {planes:,.0f} planes, {points:.2g} points, one thread a process, links of {wishes.network:g} GB/s, "
             f"a shared disk of {wishes.disk:g} GB/s:", "", "| processes | sent, GB | read, s | exchange, s | slice, s | write, s | "
             "all, s |", "|---|---|---|---|---|---|---|"]
    for processes, sent, times, total in lines:
        text.append(f"| {processes} | {sent / 1e9:.1f} | {times['read']:.1f} | {times['exchange']:.1f} | {times['slice']:.1f} | "
                    f"{times['write']:.1f} | {total:.0f} |")
    return "\n".join(text) + "\n"


def main():
    wishes = parse()
    folder = Path(wishes.out)
    folder.mkdir(parents=True, exist_ok=True)
    measured = []
    for cells in wishes.cells:
        part = folder / f"lattice-{cells}.stl"
        subprocess.run([wishes.lamella, "make", "lattice", "--cells", str(cells), "--shuffle", "1", "-o", str(part)], check=True,
                       capture_output=True)
        subprocess.run([wishes.lamella, "slice", part, "-o", folder / "one.cli"], check=True, capture_output=True)
        for processes in wishes.processes:
            runs = [figures(run(wishes, folder, part, processes)) for _ in range(wishes.rounds)]
            if (folder / "out.cli").read_bytes() != (folder / "one.cli").read_bytes():
                raise SystemExit(f"{processes} processes wrote other bytes than one process")
            best = {key: min(r[key] for r in runs) for key in runs[0]}
            measured.append(best)
            print(f"{best['triangles']:,} triangles, {processes} processes: {best['total']:.2f} s", flush=True)
        part.unlink()
    shared = [m for m in measured if m["processes"] > 1]
    fewest = min(m["processes"] for m in shared)
    model = Model([m for m in shared if m["processes"] == fewest])
    text = report(shared, model, shared[-1], wishes)
    print(text)
    (folder / "scaling.md").write_text(text)
    (folder / "scaling.json").write_text(json.dumps(
        {"machine": machine.describe(wishes.lamella), "measured": measured, "model": vars(model)}, indent=1) + "\n")


if __name__ == "__main__":
    main()
