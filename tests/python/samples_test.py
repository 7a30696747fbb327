"""The samples of the documentation run as they stand."""

import contextlib
import io
import re
import runpy
import shutil

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
