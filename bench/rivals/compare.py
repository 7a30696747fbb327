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
    user_seconds: Optional[float] = None  # of the processors
    system_seconds: Optional[float] = None
    peak_rss_bytes: Optional[int] = None
    fresh_bytes: Optional[int] = None
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
    """`older`, if not None, is an older program of ours, which is measured in turn with `program`."""

    def __init__(self, program, older, folder, timeout, threads, repeat_below=2.0, most_runs=5):
        self.programs = [program] if older is None else [program, older]
        self.folder, self.timeout, self.threads = Path(folder), timeout, threads
        self.repeat_below, self.most_runs = repeat_below, most_runs
        self.timed_out = set()  # (slicer, family); larger members are skipped

    def run(self, part, rivals, announce=lambda cell: None):
        """Returns all cells of one part, Lamella's first."""
        mesh = parts.make(part, self.programs[0], self.folder.parent / "parts")
        mesh.read_bytes()  # all slicers then read from the cache
        work = self.folder / "work"
        work.mkdir(parents=True, exist_ok=True)
        cells, slicing = [], None
        for threads in dict.fromkeys((self.threads, 1)):
            ours, slicing = self.ours(part, mesh, work, threads)
            for cell in ours:
                cells.append(cell)
                announce(cell)
        bottom = slicing.stats["input"]["bbox"][0][2]
        job = Job(mesh, work, part.layer_height, [layer["z"] for layer in slicing.stats["layers"]], bottom, self.threads)
        for rival in rivals:
            cells.append(self.theirs(part, rival, job, slicing.layers))
            announce(cells[-1])
        return cells

    def ours(self, part, mesh, work, threads):
        """Returns a cell for each of our programs, and the layers of the first one."""
        options = ["--threads", threads, "--layer-height", f"{part.layer_height:g}"]

        def once(program, **output):
            run = lamella.slice_part(program, mesh, work, *options, **output)
            if not run.ok:
                raise SystemExit(f"{program} on {part.name}: {run.outcome.ended}\n{run.outcome.text}")
            return run

        # To a file for the time of the whole process, as the others; into memory for the time of cutting alone.
        written = self.repeat(*(lambda program=program: once(program, output=work / "ours.cli") for program in self.programs))
        in_memory = self.repeat(*(lambda program=program: once(program) for program in self.programs))
        cells = []
        for age, (to_file, to_memory) in enumerate(zip(written, in_memory)):
            cell = measured(part.name, slicer_name(threads, older=age > 0), [run.outcome for run in to_file])
            cell.slicing_seconds = statistics.median(
                run.stats["seconds"]["link"] + run.stats["seconds"]["slice"] for run in to_memory)
            if age > 0:
                cell.agreement = agreement(to_memory[-1].layers, in_memory[0][-1].layers, None)
            cells.append(cell)
        return cells, in_memory[0][-1]

    def theirs(self, part, rival, job, expected):
        if part.family and (rival.name, part.family) in self.timed_out:
            return Cell(part.name, rival.name, "skipped")

        def once():
            for old in job.folder.iterdir():
                old.unlink()
            return process.run(rival.command(job), self.timeout, job.file("rival.log"))

        outcomes, = self.repeat(once)
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

    def repeat(self, *once):
        """Calls each function once if the slicer is slow, otherwise in turn until the time of the first one is
        significant. Returns the results of each."""
        runs = [[] for _ in once]
        while True:
            for call, results in zip(once, runs):
                results.append(call())
            outcome = getattr(runs[0][-1], "outcome", runs[0][-1])
            spent = sum(getattr(run, "outcome", run).seconds for run in runs[0])
            if not outcome.ok or len(runs[0]) >= self.most_runs or spent > self.repeat_below:
                return runs


def slicer_name(threads, older=False):
    return ("older-lamella" if older else "lamella") + ("" if threads != 1 else "-1")


def measured(part, slicer, outcomes):
    last = outcomes[-1]
    lines = [line.strip() for line in last.text.splitlines() if line.strip()]
    return Cell(part, slicer, last.ended, len(outcomes),
                seconds=statistics.median(outcome.seconds for outcome in outcomes),
                user_seconds=statistics.median(outcome.user for outcome in outcomes),
                system_seconds=statistics.median(outcome.system for outcome in outcomes),
                peak_rss_bytes=max(outcome.peak_rss_bytes for outcome in outcomes),
                fresh_bytes=statistics.median(outcome.fresh_bytes for outcome in outcomes),
                last_words=" ".join(lines[-2:])[-200:] if lines and not (last.ok or last.timed_out) else "")
