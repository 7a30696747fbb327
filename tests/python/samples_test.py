"""The samples of the documentation run as they stand."""

import contextlib
import importlib.util
import io
import re
import runpy
import shutil
import sys
import types

import numpy as np
import pytest
from conftest import ROOT, samples

import lamella


@pytest.fixture
def folder(rook, tmp_path, monkeypatch):
    shutil.copy(rook, tmp_path / "part.stl")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_readme_shows_the_example(folder):
    example = ROOT / "examples/python/slice_part.py"
    assert samples("README.md") == [example.read_text(encoding="utf-8")]
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        runpy.run_path(str(example))
    assert printed.getvalue() == "531 layers, 19155.1 mm3\n"
    assert lamella.verify("part.cli", "part.stl").ok


class ImageOfItk:
    """What the samples need of SimpleITK.Image. Its wrapper takes sequences of numbers of these lengths and no others."""

    def __init__(self, array):
        assert array.ndim == 3 and array.flags.c_contiguous
        self.array, self.given = array, {}

    def GetSize(self):  # noqa: N802
        return self.array.shape[::-1]

    def __getattr__(self, name):
        action, field = name[:3], name[3:]
        if action == "Get":
            return lambda: self.given[field]
        length = {"Origin": 3, "Spacing": 3, "Direction": 9}[field]

        def assign(numbers):
            assert action == "Set" and len(numbers) == length and all(type(number) is float for number in numbers)
            self.given[field] = tuple(numbers)

        return assign


def write_image_of_itk(image, path):
    assert set(image.given) == {"Origin", "Spacing", "Direction"}


def write_tiff(path, data, *, imagej, resolution, metadata):
    """The same for tifffile.imwrite. Files of ImageJ have no bool, and axes for each dimension."""
    assert imagej and data.dtype == np.uint8 and len(metadata["axes"]) == data.ndim and len(resolution) == 2


@pytest.fixture
def stand_ins(monkeypatch):
    """Modules in place of the packages that are not installed."""
    for name, functions in (
        ("SimpleITK", {"GetImageFromArray": ImageOfItk, "WriteImage": write_image_of_itk}),
        ("tifffile", {"imwrite": write_tiff}),
    ):
        if importlib.util.find_spec(name) is None:
            monkeypatch.setitem(sys.modules, name, types.SimpleNamespace(**functions))


@pytest.mark.usefixtures("stand_ins")
def test_the_samples_of_the_page_run(folder, capsys):
    shown = samples("docs/python.md")
    assert len(shown) >= 10
    names = {}
    for sample in shown:
        exec(compile(sample, "docs/python.md", "exec"), names)
    out = capsys.readouterr().out
    for comment in re.findall(r"# (<lamella.*?)\.\.\.", "".join(shown)) + ["missing.stl: there is no such file"]:
        assert comment in out
    assert (folder / "fine.cli").exists()


def test_the_sample_of_the_package_runs(folder):
    text = lamella.__doc__
    code = "\n".join(line[4:] for line in text.splitlines() if line.startswith("    "))
    with contextlib.redirect_stdout(io.StringIO()):
        exec(code, {})
    assert lamella.read_layers("part.cli").point_counts.sum() > 0
