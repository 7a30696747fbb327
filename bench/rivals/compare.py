"""Slices the same parts and planes with Lamella and its rivals; each pair is a cell of the table."""

import statistics
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from bench.harness import lamella, parts, process
from bench.harness.layers import Agreement, agreement
from bench.rivals.job import Job


@dataclass
class Cell:
    """One slicer on one part."""

    part: str
    slicer: str
    ended: str  # "ok", "timeout", "skipped", "killed by SIGSEGV", "exit code 1", "no layers: ..."
    runs: int = 0
    seconds: Optional[float] = None  # wall time of the whole process, median
    slicing_seconds: Optional[float] = None  # cutting alone, if known
    processor_seconds: Optional[float] = None
    peak_rss_bytes: Optional[int] = None
    last_words: str = ""  # of a program that failed
    agreement: Optional[Agreement] = None  # None for Lamella, the reference

    @property
    def ok(self):
        return self.ended == "ok"

    @property
    def counts(self):
        """Returns whether its time may be compared with ours: it must have found the same layers."""
        return self.ok and (self.agreement is None or self.agreement.near)


class Comparison:
    def __init__(self, program, folder, timeout, threads, repeat_below=2.0, most_runs=5):
        self.program, self.folder, self.timeout, self.threads = program, Path(folder), timeout, threads
        self.repeat_below, self.most_runs = repeat_below, most_runs
        self.timed_out = set()  # (slicer, family); larger members are skipped

    def run(self, part, rivals, announce=lambda cell: None):
        """Returns all cells of one part, Lamella's first."""
        mesh = parts.make(part, self.program, self.folder.parent / "parts")
        mesh.read_bytes()  # all slicers then read from the cache
        work = self.folder / "work"
        work.mkdir(parents=True, exist_ok=True)
        cells, slicing = [], None
        for threads in dict.fromkeys((self.threads, 1)):
            cell, slicing = self.ours(part, mesh, work, threads)
            cells.append(cell)
            announce(cell)
        bottom = slicing.stats["input"]["bbox"][0][2]
        job = Job(mesh, work, part.layer_height, [layer["z"] for layer in slicing.stats["layers"]], bottom, self.threads)
        for rival in rivals:
            cells.append(self.theirs(part, rival, job, slicing.layers))
            announce(cells[-1])
        return cells

    def ours(self, part, mesh, work, threads):
        options = ["--threads", threads, "--layer-height", f"{part.layer_height:g}"]
        # To a file for the time of the whole process, as the others; into memory for the time of cutting alone.
        written = self.repeat(lambda: lamella.slice_part(self.program, mesh, work, *options, output=work / "ours.cli"))
        in_memory = self.repeat(lambda: lamella.slice_part(self.program, mesh, work, *options))
        failed = [run.outcome for run in (*written, *in_memory) if not run.ok]
        if failed:
            raise SystemExit(f"lamella on {part.name}: {failed[0].ended}\n{failed[0].text}")
        cell = measured(part.name, slicer_name(threads), [run.outcome for run in written])
        cell.slicing_seconds = statistics.median(
            run.stats["seconds"]["link"] + run.stats["seconds"]["slice"] for run in in_memory)
        return cell, in_memory[-1]

    def theirs(self, part, rival, job, expected):
        if part.family and (rival.name, part.family) in self.timed_out:
            return Cell(part.name, rival.name, "skipped")

        def once():
            for old in job.folder.iterdir():
                old.unlink()
            return process.run(rival.command(job), self.timeout, job.file("rival.log"))

        outcomes = self.repeat(once)
        cell = measured(part.name, rival.name, outcomes)
        if outcomes[-1].timed_out:
            self.timed_out.add((rival.name, part.family))
        if not cell.ok:
            return cell
        try:
            cell.agreement = agreement(rival.layers(job), expected, job.layer_height if rival.sinks else None)
            cell.slicing_seconds = rival.slicing_seconds(job, outcomes[-1].text)
        except (OSError, ValueError, KeyError, IndexError) as error:
            cell.ended = f"no layers: {error}"
        return cell

    def repeat(self, once):
        """Runs once if the slicer is slow, otherwise repeatedly until the total time is significant."""
        runs = []
        while True:
            runs.append(once())
            outcome = getattr(runs[-1], "outcome", runs[-1])
            spent = sum(getattr(run, "outcome", run).seconds for run in runs)
            if not outcome.ok or len(runs) >= self.most_runs or spent > self.repeat_below:
                return runs


def slicer_name(threads):
    return "lamella" if threads != 1 else "lamella-1"


def measured(part, slicer, outcomes):
    last = outcomes[-1]
    lines = [line.strip() for line in last.text.splitlines() if line.strip()]
    return Cell(part, slicer, last.ended, len(outcomes),
                seconds=statistics.median(outcome.seconds for outcome in outcomes),
                processor_seconds=statistics.median(outcome.user + outcome.system for outcome in outcomes),
                peak_rss_bytes=max(outcome.peak_rss_bytes for outcome in outcomes),
                last_words=" ".join(lines[-2:])[-200:] if lines and not (last.ok or last.timed_out) else "")
