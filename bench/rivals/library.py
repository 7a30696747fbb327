"""Libraries that cut meshes, each in a small program of ours: it reads the mesh and a list of heights and writes JSON.

    PROGRAM MESH HEIGHTS RESULT

RESULT has `seconds: {read, slice}` and `layers: [{z, contours, perimeter_mm}]`.
"""

import json
import subprocess
from pathlib import Path

from bench.harness.layers import Layer
from bench.rivals.job import Rival


def library_rival(name, title, program, threaded=False):
    """Returns the rival; `program` is a command with the words before its operands."""
    def command(job):
        job.file("heights.txt").write_text("".join(f"{z!r}\n" for z in job.z), encoding="utf-8")
        return [*program, job.mesh, job.file("heights.txt"), result(job)]

    def result(job):
        return job.file(f"{name}.json")

    def told(job):
        return json.loads(result(job).read_text(encoding="utf-8"))

    def layers(job):
        return [Layer(layer["z"] - job.bottom, layer["contours"], perimeter_mm=layer["perimeter_mm"])
                for layer in told(job)["layers"]]

    return Rival(name=name, title=title, writes="nothing: contours in memory",
                 compared="rings and lengths of every layer",
                 version=lambda: answer([*program, "--version"]), command=command, layers=layers,
                 slicing_seconds=lambda job, text: told(job)["seconds"]["slice"], threaded=threaded)


def answer(command):
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=60)
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def cgal(folder):
    """Returns CGAL as a rival; `folder` has the program built here."""
    return library_rival("cgal", "CGAL Polygon_mesh_slicer", [Path(folder) / "cgal_slicer"])


def vtk():
    # Debian's packages belong to Debian's interpreter, whichever comes first in the path.
    return library_rival("vtk", "VTK vtkCutter", ["/usr/bin/python3", "-B", Path(__file__).with_name("vtk_slicer.py")])
