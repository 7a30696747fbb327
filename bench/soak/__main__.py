"""Slices random good and bad files by `lamella slice --batch`, again and again, under a memory limit.

usage: python3 -m bench.soak [--minutes N] [--files N] [--memory MB] [--seed N] [--program FILE]

A round is one batch of many files: bodies made by `lamella make`, whole, cut off, with bytes changed, empty, or not a
mesh. During and after each round these are checked: every file has one result, in order; whole files give the same
result as before; no process, zombie or temporary file is left; the workers' memory does not grow with the number of
files. Ends with exit code 1 at the first violation, keeping the files.
"""

import argparse
import collections
import json
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BODIES = ["torus --segments 24", "torus --segments 60", "sphere --detail 2", "sphere --detail 4", "box --size 9,7,5",
          "cylinder --segments 90", "lattice --cells 2", "calibration", "dodecahedra"]
FLAWS = ["whole", "whole", "whole", "cut off", "changed", "empty", "noise", "count", "missing", "folder"]


class Failed(Exception):
    pass


def make_bodies(program, folder):
    """Writes files of each body as binary and ASCII STL, PLY and OBJ."""
    files = []
    for i, body in enumerate(BODIES):
        for ending, options in [("stl", []), ("ascii.stl", ["--ascii"]), ("ply", []), ("obj", [])]:
            path = folder / f"{i}.{ending}"
            subprocess.run([program, "make", *body.split(), "-o", path, *options], check=True, capture_output=True)
            files.append(path)
    return files


def spoilt(content, flaw, chance):
    if flaw == "cut off":
        return content[:chance.randrange(1, len(content))]
    if flaw == "changed":
        changed = bytearray(content)
        for _ in range(chance.randrange(1, 30)):
            changed[chance.randrange(len(changed))] = chance.randrange(256)
        return bytes(changed)
    if flaw == "noise":
        return chance.randbytes(chance.randrange(1, 5000))
    if flaw == "count":
        return content[:80] + chance.randbytes(4) + content[84:]
    return content if flaw == "whole" else b""


def fill(folder, bodies, number, chance):
    """Puts files into the folder; returns for each the whole body that it contains, or None."""
    listed = []
    for i in range(number):
        body = chance.choice(bodies)
        flaw = chance.choice(FLAWS)
        path = folder / f"{i:06}-{flaw.replace(' ', '-')}{''.join(body.suffixes)}"
        if flaw == "folder":
            path.mkdir()
        elif flaw != "missing":
            path.write_bytes(spoilt(body.read_bytes(), flaw, chance))
        listed.append((path, body if flaw == "whole" else None))
    return listed


def children(pid):
    try:
        return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except (FileNotFoundError, ProcessLookupError):
        return []


def resident_bytes(pid):
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * resource.getpagesize()
    except (FileNotFoundError, ProcessLookupError):
        return 0


class Watch(threading.Thread):
    """Samples the memory of a process and its workers until it ends."""

    def __init__(self, process):
        super().__init__()
        self.process = process
        self.most = 0
        self.least = []  # smallest memory among the workers at each sample: that of a worker without a large file
        self.start()

    def run(self):
        while self.process.poll() is None:
            workers = [size for size in map(resident_bytes, children(self.process.pid)) if size > 0]
            if workers:
                self.most = max(self.most, *workers)
                self.least.append(min(workers))
            time.sleep(0.05)

    def growth(self):
        """Returns the growth from the second to the last quarter of the run, in bytes, of the smallest memory, because
        any sample may coincide with a large file."""
        quarter = len(self.least) // 4
        if quarter < 5:
            return 0
        return min(self.least[-quarter:]) - min(self.least[quarter:2 * quarter])


def run_batch(program, folder, listed, memory, chance):
    names = folder / "list"
    names.write_bytes(b"\0".join(os.fsencode(path) for path, _ in listed))
    limits = ["--max-triangles", "200000", "--timeout", "20", "--max-output", "50M", "--layer-height", "0.5"]
    command = [program, "slice", "--batch", names, "-o", folder / "out/{index}.cli", "--jobs",
               str(chance.randrange(1, 5)), *limits]
    with open(folder / "results", "wb") as out, open(folder / "errors", "wb") as errors:
        process = subprocess.Popen(command, stdout=out, stderr=errors,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (memory, memory)))
        watch = Watch(process)
        process.wait()
        watch.join()
    return process.returncode, watch


def check(listed, folder, code, known, outcomes):
    records = [json.loads(line) for line in (folder / "results").read_text().splitlines()]
    if code not in (0, 7):
        raise Failed(f"the batch ended with {code}: {(folder / 'errors').read_text()[-500:]}")
    if len(records) != len(listed):
        raise Failed(f"{len(listed)} files, {len(records)} results")
    for (path, body), record in zip(listed, records):
        outcomes[record["error"]["kind"] if not record["ok"] else "sliced"] += 1
        if record["path"] != str(path):
            raise Failed(f"the result of {record['path']} came where that of {path} was due")
        if not record["ok"] and record["error"]["kind"] in ("internal", "crash", "cancelled"):
            raise Failed(f"{path}: {record['error']}")
        if record["ok"] != Path(record["output"] or "/nowhere").exists():
            raise Failed(f"{path}: told as {record}, but its output says otherwise")
        if body is not None and known.setdefault(body, (record["ok"], record.get("hash"))) != (True, record.get("hash")):
            raise Failed(f"{path}: {record}, but {known[body]} before")
    expected = sum(record["ok"] for record in records)
    left = sorted(os.listdir(folder / "out"))
    if len(left) != expected:
        raise Failed(f"{expected} outputs, but {len(left)} files are there, such as {left[:3]}")
    if children(os.getpid()):
        raise Failed(f"processes are left: {children(os.getpid())}")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--files", type=int, default=2000, help="of a round")
    parser.add_argument("--memory", type=int, default=1000, help="address space of each process, MB")
    parser.add_argument("--seed", type=int, default=random.randrange(10**9))
    parser.add_argument("--program", default=str(ROOT / "build/lamella"))
    return parser.parse_args()


def main():
    wishes = arguments()
    chance = random.Random(wishes.seed)
    folder = Path(tempfile.mkdtemp(prefix="lamella-soak-"))
    (folder / "bodies").mkdir()
    bodies = make_bodies(wishes.program, folder / "bodies")
    known, outcomes = {}, collections.Counter()
    most_growth, most_memory, rounds = 0, 0, 0
    print(f"seed {wishes.seed}, {len(bodies)} bodies, in {folder}", flush=True)
    end = time.monotonic() + 60 * wishes.minutes
    while time.monotonic() < end:
        (folder / "in").mkdir()
        listed = fill(folder / "in", bodies, wishes.files, chance)
        code, watch = run_batch(wishes.program, folder, listed, wishes.memory * 10**6, chance)
        try:
            check(listed, folder, code, known, outcomes)
            if watch.growth() > 16e6:
                raise Failed(f"a worker's memory grew by {watch.growth() / 1e6:.1f} MB")
        except Failed as failure:
            print(f"round {rounds}: {failure}\nseed {wishes.seed}; the files are in {folder}")
            return 1
        most_growth = max(most_growth, watch.growth())
        most_memory = max(most_memory, watch.most)
        rounds += 1
        shutil.rmtree(folder / "in")
        shutil.rmtree(folder / "out")
    shutil.rmtree(folder)
    print(f"{rounds} rounds, {sum(outcomes.values())} files: "
          + ", ".join(f"{count} {kind}" for kind, count in outcomes.most_common()))
    print(f"most memory of a process {most_memory / 1e6:.1f} MB, most growth within a round {most_growth / 1e6:.1f} MB; "
          "no process, no temporary file was left")
    return 0


if __name__ == "__main__":
    sys.exit(main())
