"""PrusaSlicer: one wall, no infill, as G-code. It has no option for threads and uses all that it may."""

import datetime
import re

from bench.rivals import toolpath
from bench.rivals.job import Rival
from bench.rivals.program import version

WIDTH_MM = 0.45


def command(job):
    height = f"{job.layer_height:g}"
    # Gaps and thin walls would be filled with strokes that are not contours.
    return ["prusa-slicer", "--export-gcode", "--loglevel", "3",
            "--layer-height", height, "--first-layer-height", height,
            "--perimeters", "1", "--perimeter-generator", "classic", "--gap-fill-enabled=0", "--thin-walls=0",
            "--external-perimeter-extrusion-width", f"{WIDTH_MM}", "--first-layer-extrusion-width", f"{WIDTH_MM}",
            "--fill-density", "0", "--top-solid-layers", "0", "--bottom-solid-layers", "0",
            "--skirts", "0", "--brim-width", "0",
            "--bed-shape", "0x0,1000x0,1000x1000,0x1000", "--max-print-height", "1000", "--center", "500,500",
            "--output", job.file("prusa.gcode"), job.mesh]


def is_wall(comment):
    return "perimeter" in comment.lower() if comment.startswith(";TYPE:") else None


def slicing_seconds(_job, text):
    """Reads the log: cutting is the first stage, making walls the second."""
    times = [re.search(rf"^\[(\S+ \S+)\].*\] +{stage}", text, re.MULTILINE)
             for stage in ("Slicing volumes", "Generating perimeters")]
    if None in times:
        return None
    start, end = (datetime.datetime.strptime(time[1], "%Y-%m-%d %H:%M:%S.%f") for time in times)
    return (end - start).total_seconds()


def path(job):
    """Returns its tool path, and how to read it."""
    return job.file("prusa.gcode"), lambda line: line.startswith(";LAYER_CHANGE"), is_wall


PRUSA_SLICER = Rival(
    name="prusa-slicer", title="PrusaSlicer",
    writes="G-code of one wall",
    compared="rings and areas of every layer, from the tool path",
    version=lambda: version(["prusa-slicer", "--help"], r"PrusaSlicer-(\d[\w.]*)"),
    command=command,
    layers=lambda job: toolpath.read_layers(*path(job), WIDTH_MM, job.layer_height),
    slicing_seconds=slicing_seconds,
    threaded=True)
