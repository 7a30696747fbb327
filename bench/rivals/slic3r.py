"""Slic3r 1.3, which writes its slices as SVG. Only these are requested: no tool path is made."""

from bench.rivals import layered_svg
from bench.rivals.job import Rival
from bench.rivals.program import version


def command(job):
    height = f"{job.layer_height:g}"
    return ["slic3r", "--no-gui", "--export-svg", "--threads", job.threads,
            "--layer-height", height, "--first-layer-height", height, "--nozzle-diameter", "0.35",
            "--perimeters", "1", "--fill-density", "0%", "--top-solid-layers", "0", "--bottom-solid-layers", "0",
            "--skirts", "0", "--brim-width", "0", "--dont-arrange", "--output", job.file("slic3r.svg"), job.mesh]


SLIC3R = Rival(
    name="slic3r", title="Slic3r",
    writes="slices as SVG",
    compared="rings, areas and lengths of every layer",
    version=lambda: version(["slic3r", "--version"], r"(\d+\.\d+\.\d+)"),
    command=command,
    layers=lambda job: layered_svg.read_layers(job.file("slic3r.svg")),
    slicing_seconds=lambda job, text: None,
    threaded=True)
