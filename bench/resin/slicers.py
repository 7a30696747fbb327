"""The slicers for image jobs and their options: the same layers in the middle of the same display."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional

from bench.rivals.program import version

OURS = ("lamella", "goo", "check", "layers")


@dataclass(frozen=True)
class Job:
    mesh: Path
    layer_height: float
    pixels: tuple[int, int]
    pixel_mm: float

    @property
    def display(self):
        return tuple(f"{side * self.pixel_mm:.6g}" for side in self.pixels)


@dataclass(frozen=True)
class Slicer:
    name: str
    title: str
    suffix: str  # of its output
    images: bool  # the output is a job of images
    command: Callable[[Job, Path], list]
    version: Callable[[], Optional[str]]  # None: not installed


def pixel_mm(box, pixels):
    """Returns a size with few digits with which a part with this box fills the display except for a tenth."""
    (left, front, _), (right, back, _) = box
    return float(f"{1.1 * max((right - left) / pixels[0], (back - front) / pixels[1]):.3g}")


def lamella(program, name, title, suffix):
    """A job of images, or a slice file without images for the suffix .cli."""
    def command(job, output):
        return [program, "slice", job.mesh, "-o", output, "--layer-height", f"{job.layer_height:g}", "--progress", "none",
                *(["--display-size", ",".join(job.display), "--resolution", "{}x{}".format(*job.pixels),
                   "--orientation", "landscape", "--mirror", "none"] if suffix != ".cli" else [])]

    return Slicer(name, title, suffix, suffix == ".sl1s", command, lambda: version([program, "--version"], r"(\d[\w.]*)"))


def check_of(program):
    """The check of the print, with the areas of all layers."""
    def command(job, output):
        return [program, "check", job.mesh, "--layer-height", f"{job.layer_height:g}", "--stats", output, "--progress", "none"]

    return Slicer("check", "Lamella, the check", ".json", False, command, lambda: version([program, "--version"], r"(\d[\w.]*)"))


def prusa_slicer():
    def command(job, output):
        width, height = job.display
        return ["prusa-slicer", "--export-sla", "--loglevel", "1", "--supports-enable=0", "--pad-enable=0",
                # Disables everything that moves or omits pixels intentionally.
                "--slice-closing-radius", "0", "--elefant-foot-compensation", "0",
                "--layer-height", f"{job.layer_height:g}", "--initial-layer-height", f"{job.layer_height:g}",
                "--bed-shape", f"0x0,{width}x0,{width}x{height},0x{height}", "--max-print-height", "1000",
                "--display-width", width, "--display-height", height, "--display-pixels-x", job.pixels[0],
                "--display-pixels-y", job.pixels[1], "--display-orientation", "landscape", "--no-display-mirror-x", "--no-display-mirror-y",
                "--center", f"{float(width) / 2:.9g},{float(height) / 2:.9g}", "--output", output, job.mesh]

    return Slicer("prusa-slicer", "PrusaSlicer", ".sl1", True, command,
                  lambda: version(["prusa-slicer", "--help"], r"PrusaSlicer-(\d[\w.]*)"))
