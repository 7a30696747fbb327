"""CuraEngine: one wall, no infill, as G-code."""

import re
from pathlib import Path

from bench.rivals import toolpath
from bench.rivals.job import Rival
from bench.rivals.program import version

# Cura's own table of settings with their defaults (Debian package cura).
SETTINGS = Path("/usr/share/cura/resources/definitions/fdmprinter.def.json")
WIDTH_MM = 0.4


def command(job):
    changed = {
        "layer_height": f"{job.layer_height:g}", "layer_height_0": f"{job.layer_height:g}",
        "wall_line_count": 1, "wall_line_width_0": WIDTH_MM,
        "infill_sparse_density": 0, "infill_line_distance": 0, "top_layers": 0, "bottom_layers": 0,
        "adhesion_type": "none", "support_enable": "false",
        "machine_width": 1000, "machine_depth": 1000, "machine_height": 1000, "machine_center_is_zero": "true",
        "center_object": "true",
    }
    settings = [word for key, value in changed.items() for word in ("-s", f"{key}={value}")]
    return ["CuraEngine", "slice", "-v", f"-m{job.threads}", "-j", SETTINGS, "-o", job.file("cura.gcode"), *settings,
            "-e0", "-l", job.mesh]


def is_wall(comment):
    if comment.startswith(";TYPE:"):
        return comment.startswith(";TYPE:WALL-OUTER")
    # Between parts it prints that the following is no mesh.
    return None


def slicing_seconds(_job, text):
    """Returns the time of its first stage: from triangles to polygons."""
    found = re.search(r"^Progress: slice accomplished in ([\d.]+)s", text, re.MULTILINE)
    return float(found[1]) if found else None


def path(job):
    """Returns its tool path, and how to read it."""
    return job.file("cura.gcode"), lambda line: line.startswith(";LAYER:"), is_wall


CURA = Rival(
    name="cura", title="CuraEngine",
    writes="G-code of one wall",
    compared="rings and areas of every layer, from the tool path",
    version=lambda: version(["CuraEngine", "help"], r"version (\S+)") if SETTINGS.exists() else None,
    command=command,
    layers=lambda job: toolpath.read_layers(*path(job), WIDTH_MM, job.layer_height),
    slicing_seconds=slicing_seconds,
    threaded=True,
    sinks=True)
