"""The examples in examples/python do what they say."""

import os
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import PACKAGE, ROOT
from matplotlib.image import imread

import lamella

EXAMPLES = ROOT / "examples" / "python"


def run(name, *arguments):
    result = subprocess.run([sys.executable, "-B", str(EXAMPLES / name), *map(str, arguments)], capture_output=True,
                            text=True, check=False, timeout=300, env={**os.environ, "PYTHONPATH": PACKAGE})
    assert result.returncode == 0, result.stderr
    return result.stdout


def numbers(text):
    return [float(number) for number in re.findall(r"(?<![\w.])\d+(?:\.\d+)?", text)]


def test_every_example_is_run_here():
    tests = (ROOT / "tests/python/examples_test.py").read_text() + (ROOT / "tests/python/samples_test.py").read_text()
    names = [path.name for path in EXAMPLES.glob("*.py")]
    assert len(names) >= 5 and all(name in tests for name in names)


def test_a_layer_is_drawn(bodies, tmp_path):
    image = tmp_path / "layer.png"
    path = bodies("calibration")
    text = run("plot_layer.py", path, 3, image)
    layer = lamella.slice(path, z=[3.05])[0]
    assert f"{layer.area:.3f} mm2" in text and (layer.parent >= 0).any()
    # How much of the box around it is filled with the colour of material.
    image = np.round(imread(image)[:, :, :3] * 255)
    material = np.abs(image - (176, 196, 222)).max(axis=2) <= 2
    rows, columns = np.nonzero(material)
    drawn = material.sum() / (np.ptp(rows) * np.ptp(columns))
    assert drawn == pytest.approx(layer.area / np.ptp(layer.points, axis=0).prod(), rel=0.1)


def test_area_over_height(rook, tmp_path):
    image = tmp_path / "area.png"
    layers, volume, step = numbers(run("area_over_height.py", rook, 0.5, image).replace("mm3", ""))
    stack = lamella.slice(rook, 0.5)
    assert (layers, volume) == (len(stack), pytest.approx(stack.volume, abs=1e-3))
    assert step == pytest.approx(stack.z[np.abs(np.diff(stack.area)).argmax()], abs=1e-3)
    assert imread(image).std() > 0
    assert numbers(run("area_over_height.py", rook, 50, image))[0] == 1


def test_scan_vectors_are_drawn(bodies, tmp_path):
    image = tmp_path / "scan.png"
    path = bodies("box", "--size", "20,30,10")
    number, lines = numbers(run("plot_scan.py", path, 5, image).rpartition(": layer")[2])
    (layer,) = lamella.scan([lamella.slice(path, layer_height=0.1)[int(number)]])
    assert number in (49, 50) and lines == len(layer.vectors)
    assert imread(image).std() > 0


def test_narrow_places_get_less_power(bodies):
    path = bodies("box", "--size", "20,30,1")
    layers = list(lamella.scan(lamella.slice(path, 0.1)))
    lines, length, reduced, before, after = numbers(run("power_by_width.py", path, 0.1, 4))
    assert lines == sum(len(layer.vectors) for layer in layers)
    assert length == pytest.approx(sum(f.marked_mm for layer in layers for f in layer.figures), abs=1e-3)
    assert before == pytest.approx(sum(f.energy_j for layer in layers for f in layer.figures), abs=1e-3)
    assert 0.6 * before < after < before and 0 < reduced < lines


def test_a_batch_gives_what_a_single_run_gives(bodies, tmp_path):
    for name in ("rook", "calibration", "dodecahedra"):
        (tmp_path / f"{name}.stl").write_bytes(bodies(name).read_bytes())
    lines = run("batch_with_dask.py", tmp_path, 0.5).splitlines()
    assert [line.partition(":")[0] for line in lines] == ["calibration.stl", "dodecahedra.stl", "rook.stl"]
    for line in lines:
        path = tmp_path / line.partition(":")[0]
        single = lamella.slice(path, 0.5)
        assert f"{len(single)} layers, {single.volume:.3f} mm3" in line
        expected = tmp_path / "single.cli"
        lamella.write(expected, single)
        assert path.with_suffix(".cli").read_bytes() == expected.read_bytes()


def test_layers_travel_to_dask_and_back(rook):
    from dask.distributed import Client, LocalCluster

    stack = lamella.slice(rook, 0.5)
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        back = client.submit(lambda layers: layers, stack).result()
        areas = client.gather(client.map(lambda layer: layer.area, list(stack)))
    assert back == stack and areas == stack.area.tolist()
