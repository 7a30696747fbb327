"""Runs `lamella slice` and reads its statistics."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from bench.harness import process
from bench.harness.layers import Layer

TIMED_OUT = "exit code 5"  # a limit was hit


@dataclass
class Slicing:
    outcome: process.Outcome
    stats: Optional[dict]  # None if it did not finish

    @property
    def ok(self):
        return self.stats is not None

    @property
    def timed_out(self):
        return self.outcome.timed_out or self.outcome.ended == TIMED_OUT

    @property
    def seconds(self):
        """Returns the seconds within the program, from opening the file to the last layer."""
        return self.stats["seconds"]["total"]

    @property
    def layers(self):
        """Returns the layers; heights count from the bottom of the part."""
        bottom = self.stats["input"]["bbox"][0][2]
        return [Layer(layer["z"] - bottom, layer["contours"], layer["area_mm2"], layer["perimeter_mm"])
                for layer in self.stats["layers"]]

    @property
    def hashes(self):
        return [layer["hash"] for layer in self.stats["layers"]]


def slice_part(lamella, mesh, folder, *options, engine="sweep", timeout=None, output=None):
    """Slices into memory, or to `output`; `timeout` in seconds."""
    stats = Path(folder) / "stats.json"
    stats.unlink(missing_ok=True)
    command = [lamella, "slice", mesh, "--stats", stats, "--engine", engine, "--progress", "none", *options]
    if output is not None:
        command += ["--output", output]
    # The program stops by itself; a second limit from outside is for the case that it does not.
    outside = 3600.0
    if timeout is not None:
        command += ["--timeout", f"{timeout:g}"]
        outside = 1.5 * timeout + 20
    outcome = process.run(command, outside, Path(folder) / "lamella.log")
    return Slicing(outcome, json.loads(stats.read_text(encoding="utf-8")) if outcome.ok else None)
