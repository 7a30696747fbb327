"""Pictures of layers: SVG in notebooks, bounded in size, and drawings by matplotlib."""

import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from conftest import PACKAGE

import lamella

SVG = "{http://www.w3.org/2000/svg}"


def paths(picture):
    root = ElementTree.fromstring(picture)
    assert root.tag == f"{SVG}svg"
    return [path.get("d") for path in root.iter(f"{SVG}path")], root


def test_a_layer_is_a_picture_of_its_rings_and_chains():
    square = [(0, 0), (10, 0), (10, 5), (0, 5)]
    layer = lamella.Layer([square, [(2, 1), (2, 2), (4, 2), (4, 1)]], z=1.5, chains=[[(6, 1), (8, 3)]])
    (rings, hatches, chains), root = paths(layer._repr_svg_())
    assert rings.count("M") == rings.count("z") == 2 and chains.count("M") == 1 and hatches == ""
    assert int(root.get("width")) == 360 and int(root.get("height")) == 184
    assert "z = 1.5 mm" in root.find(f"{SVG}title").text
    numbers = np.array(re.findall(r"-?[\d.]+", rings), dtype=float).reshape(-1, 2)
    assert (numbers.min(axis=0) == 4).all() and numbers.max(axis=0).tolist() == [356, 180]


def test_pictures_are_bounded(bodies):
    layer = lamella.slice(bodies("sheet", "--holes", 400, "--segments", 1024))[0]
    assert len(layer.points) > 400_000
    picture = layer._repr_svg_()
    assert len(picture) < 400_000 and picture.count("M") <= 401
    noise = np.random.default_rng(1).uniform(0, 100, (300_000, 2))
    assert len(lamella.Layer([noise], z=0)._repr_svg_()) < 400_000


def test_nothing_is_shown_as_nothing():
    picture = lamella.Layer([], z=2)._repr_svg_()
    assert "0 contours" in ElementTree.fromstring(picture).find(f"{SVG}text").text
    assert "0 layers" in lamella.Stack([])._repr_html_()
    point = lamella.Layer([], z=2, chains=[[(1, 1), (1, 2)]])
    assert "M" in point._repr_svg_()


def test_a_stack_shows_a_few_layers_at_one_scale(rook):
    shown = lamella.slice(rook, 0.5)._repr_html_()
    assert shown.count("<svg") == 5 and shown.count("<figcaption>") == 5 and len(shown) < 200_000
    root = ElementTree.fromstring(shown)
    assert "layers" in root.find("p").text
    assert len(lamella.slice(rook, 10)[:2]._repr_html_().split("<svg")) == 3


def test_layers_are_drawn_by_matplotlib(rook):
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib.pyplot import close, subplots

    layer = lamella.slice(rook)[100]
    axes = layer.plot()
    assert len(axes.patches) == 1 and axes.get_aspect() in ("equal", 1.0)
    low, high = layer.points.min(axis=0), layer.points.max(axis=0)
    assert axes.get_xlim()[0] <= low[0] and axes.get_ylim()[1] >= high[1]
    figure, given = subplots()
    assert lamella.Layer([], z=0, chains=[[(0, 0), (1, 1)]]).plot(given) is given
    close("all")


def test_scan_vectors_are_drawn_by_exposure_region_or_order():
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib.pyplot import close

    layer = next(lamella.scan([lamella.Layer([[(0, 0), (10, 0), (10, 10), (0, 10)]], z=0.5, bottom=0, top=1)]))
    lines = sum(len(part.get_segments()) for part in layer.plot().collections)
    assert lines == len(layer.vectors)
    regions = {exposure.region for exposure in layer.exposures}
    assert {text.get_text() for text in layer.plot(by="region").get_legend().get_texts()} == regions
    assert len(layer.plot(by="order").collections[0].get_array()) == len(layer.vectors)
    assert layer.plot(by="time").collections[0].get_array().tolist() == layer.seconds.tolist()
    with pytest.raises(lamella.UsageError, match='by: "colour"'):
        layer.plot(by="colour")
    for thing in (1, "axes", layer):
        with pytest.raises(TypeError, match="axes: expected axes of matplotlib"):
            layer.plot(thing)
    close("all")


def test_times_of_lines_are_those_of_the_figures():
    squares = [[(x, 0), (x + 5, 0), (x + 5, 5), (x, 5)] for x in (0, 10)]
    layer = next(lamella.scan([lamella.Layer(squares, z=0.5, bottom=0, top=1)]))
    seconds = layer.seconds
    assert len(seconds) == len(layer.vectors) and (np.diff(seconds) > 0).all() and seconds[0] > 0
    ends = np.flatnonzero(np.diff(layer.exposure, append=-1))  # the last line of each exposure
    spent = [figures.build_seconds for figures in layer.figures]
    assert len(spent) > 1 and seconds[ends] == pytest.approx(np.cumsum(spent), rel=1e-12)
    assert len(next(lamella.scan([lamella.Layer([], z=0.5, bottom=0, top=1)])).seconds) == 0


def element(page, name):
    return json.loads(re.search(rf'<script type="application/json" id="{name}">(.*?)</script>', page, re.DOTALL).group(1))


def test_a_page_of_layers_is_written_and_opened(rook, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or True)
    stack = lamella.slice(rook, 1)
    path = stack.show()
    assert opened == [Path(path).as_uri()]
    page = Path(path).read_text(encoding="utf-8")
    assert element(page, "table")["z"] == pytest.approx(stack.z) and page.count('class="data"') == len(stack)
    assert element(page, "head")["title"] == "layers.html"
    monkeypatch.setattr("webbrowser.open", lambda address: False)
    with pytest.warns(RuntimeWarning, match="no browser was found to open .*layers.html") as caught:
        stack.show()
    assert [warning.filename for warning in caught] == [__file__]
    vectors = tmp_path / "vectors.html"
    lamella.write(vectors, lamella.scan(stack[:3]))
    assert vectors.read_text(encoding="utf-8").count('class="data"') == 3


def test_a_notebook_shows_them(rook, tmp_path):
    # A real kernel, since only it decides which of the representations it takes.
    pytest.importorskip("nbconvert")
    pytest.importorskip("ipykernel")
    cells = [f"import lamella; stack = lamella.slice({str(rook)!r}, 1)", "stack", "stack[3]"]
    notebook = {"nbformat": 4, "nbformat_minor": 4, "metadata": {"kernelspec": {"name": "python3", "display_name": ""}},
                "cells": [{"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": source}
                          for source in cells]}
    (tmp_path / "shown.ipynb").write_text(json.dumps(notebook), encoding="utf-8")
    subprocess.run(
        [sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output", "done.ipynb", "shown.ipynb"],
        cwd=tmp_path, check=True, timeout=240, capture_output=True,
        env={**os.environ, "PYTHONPATH": PACKAGE, "HOME": str(tmp_path), "JUPYTER_PLATFORM_DIRS": "1"},
    )  # fmt: skip
    done = json.loads((tmp_path / "done.ipynb").read_text(encoding="utf-8"))["cells"]
    assert "<figcaption>" in "".join(done[1]["outputs"][0]["data"]["text/html"])
    assert "<svg" in "".join(done[2]["outputs"][0]["data"]["image/svg+xml"])
