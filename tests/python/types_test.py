"""Types as users' tools see them: by mypy, and by its comparison of stubs with what there is at run time."""

import os
import subprocess
import sys
from pathlib import Path

from conftest import PACKAGE, samples

HERE = Path(__file__).parent


def run(*command, **keywords):
    result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300, cwd=PACKAGE,
                            env={**os.environ, "PYTHONPATH": PACKAGE}, **keywords)
    return result.returncode, result.stdout + result.stderr


def mypy(tmp_path, *arguments):
    return run(sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), *arguments)


def test_the_package_is_typed_throughout(tmp_path):
    code, text = mypy(tmp_path, "-p", "lamella")
    assert code == 0, text


def test_stubs_are_what_the_extension_is(tmp_path):
    # It writes a cache beside the package otherwise.
    code, text = run(sys.executable, "-m", "mypy.stubtest", "lamella._lamella", "--concise", "--allowlist",
                     str(HERE / "stubtest_allowlist.txt"))
    assert code == 0, text


GOOD = """
import io
import numpy as np
import numpy.typing as npt
import lamella

class Polydata:
    points: npt.NDArray[np.float64] = np.zeros((3, 3))
    faces: npt.NDArray[np.int64] = np.array([3, 0, 1, 2])

class Scan:
    vertices: npt.NDArray[np.float64] = np.zeros((3, 3))
    faces: npt.NDArray[np.int64] = np.array([(0, 1, 2)])

def listen(stage: str, done: int, total: int) -> None: ...

stack: lamella.Stack = lamella.slice("part.stl", 0.1, progress=listen)
lamella.slice(Scan(), z=[1, 2, 3])
lamella.slice(Polydata())
lamella.slice(b"solid")
with open("part.stl", "rb") as file:
    lamella.write(io.BytesIO(), lamella.slice(file), format="cli")
some: lamella.Stack = stack[[1, 2]]
many: lamella.Stack = stack[stack.area > 3]
both: lamella.Layer = stack.at(1) | stack[0] - stack[1]
lamella.slice((Scan.vertices, Scan.faces), offsets=np.arange(3))
layer: lamella.Layer = stack[0]
part: lamella.Stack = stack[1:2]
points: npt.NDArray[np.float64] = layer.points
area: float = max(layer.area for layer in stack)
for streamed in lamella.iter_layers("part.stl"):
    height: float = streamed.z
up = np.array([0.0, 0.0, 1.0])
lamella.slice("part.stl", direction=up)
lamella.Slicer("part.stl", rule="section_below").section(origin=up * 3, normal=up)
lamella.Part("part.stl", rotation=np.zeros(3), position=up, scale=np.ones(3))
fullest: lamella.Layer = stack[stack.area.argmax()]
left: int = len(lamella.scan(stack))
grown: lamella.Layer = layer.offset(1, "round", arc_tolerance=0.01)
several: list[lamella.Layer] = layer.offset([1, 2])
pixels: npt.NDArray[np.uint8] = layer.image(0.1, bounds=stack.bounds)
layered: lamella.Voxels = stack.pixels(0.1, dtype=bool, origin=(0, 0), shape=(10, 20))
both_parts: lamella.Voxels = lamella.voxels(["part.stl", lamella.Part("part.stl")], 0.1, direction=np.eye(3))
lamella.voxels((Scan.vertices, Scan.faces), layered.spacing, origin=layered.origin, shape=(1, 2, 3), direction=layered.direction)
rule = lamella.HatchRule(pattern="stripes", distance=0.1)
mended: lamella.Mesh = lamella.mend("part.stl", orient=True)
rims: list[npt.NDArray[np.float64]] = lamella.inspect(mended).places["boundary_loops"]
strategy: lamella.ScanStrategy = lamella.ScanStrategy.from_toml("seed = 1")
"""

def test_the_samples_of_the_page_are_typed(tmp_path):
    program = tmp_path / "samples.py"
    program.write_text("\n".join(samples("docs/python.md")))
    code, text = mypy(tmp_path, "--ignore-missing-imports", str(program))  # of packages that samples use
    assert code == 0, text


BAD = {
    "lamella.slice(5)": "arg-type",
    "lamella.slice('part.stl', layer_hight=1)": "call-arg",
    "lamella.slice('part.stl')[0].point": "attr-defined",
    "lamella.slice('part.stl', progress=lambda: None)": "arg-type",
    "text: str = lamella.slice('part.stl')[0].area": "assignment",
    "key: Hashable = lamella.slice('part.stl')": "assignment",
    "lamella.slice('part.stl', at='centre')": "arg-type",
    "lamella.slice('part.stl')[0].offset(1, 'sharp')": "call-overload",
    "stack: lamella.Stack = lamella.read_mesh('part.stl')": "assignment",
    "lamella.read(io.StringIO())": "arg-type",
    "lamella.write(open('part.cli', 'w'), lamella.read_layers('part.cli'))": "arg-type",
    "text: str = lamella.slice('part.stl')[[1, 2]]": "assignment",
    "lamella.HatchRule(pattern='stripe')": "arg-type",
    "lamella.HatchRule().order = 'row'": "assignment",
    "lamella.Slicer('part.stl', rule='above')": "arg-type",
    "lamella.inspect('part.stl').places['loops']": "typeddict-item",
    "lamella.mend('part.stl', close_gaps=1)": "call-arg",
}


def test_users_get_types(tmp_path):
    program = tmp_path / "good.py"
    program.write_text(GOOD)
    code, text = mypy(tmp_path, str(program))
    assert code == 0, text


def test_mistakes_of_users_are_explained(tmp_path):
    program = tmp_path / "bad.py"
    program.write_text("import io\nfrom typing import Hashable\nimport lamella\n" + "\n".join(BAD) + "\n")
    code, text = mypy(tmp_path, str(program))
    assert code == 1
    for line, (mistake, kind) in enumerate(BAD.items(), start=4):
        assert f"bad.py:{line}: error" in text and f"[{kind}]" in text, mistake + "\n" + text
