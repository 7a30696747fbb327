"""Slice files: the bytes of the program, and the same layers when they are read."""

import gzip
import os
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import box_arrays, nested_boxes

import lamella

EXACT = ["layers.json", "layers.npz"]

ROUNDED = ["layers.cli", "layers.svg", "layers.slc", "layers.3mf"]

WRITTEN_ONLY = ["layers.dxf", "layers.geojson"]


@pytest.mark.parametrize("name", EXACT + ROUNDED + WRITTEN_ONLY)
@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_slice_files_have_the_bytes_of_the_program(program, rook, tmp_path, name):
    program.succeed("slice", rook, "-o", tmp_path / ("program_" + name), "--layer-height", 0.5)
    expected = (tmp_path / ("program_" + name)).read_bytes()
    lamella.write(tmp_path / name, lamella.slice(rook, 0.5))
    assert (tmp_path / name).read_bytes() == expected
    for threads in (1, 2, 7):
        with lamella.iter_layers(rook, 0.5) as layers:
            lamella.write(tmp_path / name, layers, threads=threads)
        assert (tmp_path / name).read_bytes() == expected
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([name, "program_" + name])


@pytest.mark.parametrize("name", EXACT + ROUNDED)
def test_slice_files_read_back(rook, tmp_path, name):
    stack = lamella.slice(rook, 0.5)
    lamella.write(tmp_path / name, stack)
    back = lamella.read(tmp_path / name)
    assert isinstance(back, lamella.Stack)
    assert Path(back.path) == tmp_path / name and back.format == name.partition(".")[2]
    comparison = lamella.compare(stack, back, tolerance=0 if name in EXACT else 0.001)
    assert comparison and comparison.layers == len(stack)
    if name in EXACT:
        assert back == stack and back.resolution == 0 and comparison.same == len(stack)
    assert np.allclose(back.area, stack.area, rtol=1e-3)
    assert lamella.compare(stack, back) and lamella.verify(back, rook).ok


def test_numpy_arrays_in_single_precision_are_compared_as_such(tmp_path):
    mesh = lamella.Mesh(*box_arrays(1.1, 2.2, 3.3))
    lamella.write(tmp_path / "double.npz", lamella.slice(mesh, layer_height=0.7))
    arrays = dict(np.load(tmp_path / "double.npz"))
    arrays["points"] = arrays["points"].astype(np.float32)
    np.savez(tmp_path / "single.npz", **arrays)
    assert lamella.verify(tmp_path / "single.npz", mesh).ok
    assert lamella.compare(tmp_path / "double.npz", tmp_path / "single.npz")


@pytest.mark.parametrize("name", ["layers.json", "layers.npz", "layers.svg"])
@pytest.mark.parametrize("at", ["bottom", "middle", "top"])
def test_the_rule_of_the_plane_is_kept_with_the_cuts(rook, tmp_path, name, at):
    stack = lamella.slice(rook, 0.5, at=at)
    assert stack.rule == ("section_below" if at == "top" else "section_above")
    assert lamella.verify(stack, rook).ok
    for layers in stack, lamella.iter_layers(rook, 0.5, at=at):
        lamella.write(tmp_path / name, layers)
        back = lamella.read(tmp_path / name)
        assert back.rule == stack.rule
        assert lamella.verify(pickle.loads(pickle.dumps(back)), rook).ok


def test_the_rule_of_the_plane_goes_with_layers(tmp_path):
    stack = lamella.slice(nested_boxes(), 1, at="top")
    assert lamella.Stack(list(stack)).rule == "section_below"
    by_hand = lamella.Layer(list(stack[0]), 0.5, 0, 0.5)
    for what in [list(stack), (layer.offset(0.1) for layer in stack), [layer.union(by_hand) for layer in stack],
                 [by_hand, *stack[1:]], pickle.loads(pickle.dumps(list(stack))), stack[3], iter(lamella.iter_layers(nested_boxes(), 1, at="top")),
                 list(lamella.scan(stack))]:  # fmt: skip
        lamella.write(tmp_path / "out.json", what)
        assert lamella.read(tmp_path / "out.json").rule == "section_below"
    assert lamella.Stack([by_hand]).rule == "section_above"
    with pytest.raises(lamella.UsageError, match="cut by the same rule"):
        lamella.Stack([lamella.slice(nested_boxes(), 1)[0], stack[1]])


def test_layers_without_thickness_are_refused_where_files_need_one(tmp_path):
    square = [(0, 0), (9, 0), (9, 9), (0, 9)]
    flat = lamella.Stack([lamella.Layer([square], z=z) for z in (1, 2)])
    for name in ("a.cli", "a.svg", "a.slc", "a.3mf", "a.sl1"):
        with pytest.raises(lamella.UsageError, match="the layer at z = 1 mm has no thickness.* bottom= and top="):
            lamella.write(tmp_path / name, flat)
    with pytest.raises(lamella.UsageError, match="no thickness.* bottom= and top="):
        lamella.write(tmp_path / "a.ovf", lamella.scan(flat))
    assert list(tmp_path.iterdir()) == []
    for name in ("a.json", "a.npz"):
        lamella.write(tmp_path / name, flat)
        assert lamella.read_layers(tmp_path / name) == flat
    lamella.write(tmp_path / "a.geojson", flat)


def test_the_kind_of_a_file_can_be_asked_for(tmp_path, rook):
    stack = lamella.slice(rook, 5)
    lamella.write(tmp_path / "a.cli", stack)
    assert isinstance(lamella.read_mesh(rook), lamella.Mesh)
    assert len(lamella.read_layers(tmp_path / "a.cli")) == len(stack)
    with pytest.raises(lamella.InputError, match="a.cli: is a slice file .*: it holds layers already"):
        lamella.read_mesh(tmp_path / "a.cli")
    with pytest.raises(lamella.InputError, match="stl: found a mesh"):
        lamella.read_layers(rook)


def test_layers_are_written_from_whatever_has_them(tmp_path):
    stack = lamella.slice(box_arrays(), 1)

    def written(what):
        lamella.write(tmp_path / "out.json", what)
        return lamella.read(tmp_path / "out.json")

    assert written(stack[3]) == stack[3:4]
    assert written(list(stack)) == written(tuple(stack)) == written(layer for layer in stack) == stack
    assert written(layer for layer in lamella.iter_layers(box_arrays(), 1)) == stack
    shifted = written(layer.offset(1) for layer in stack)
    assert shifted.area.tolist() == [layer.offset(1).area for layer in stack]
    with pytest.raises(lamella.UsageError, match="ascend"):
        lamella.write(tmp_path / "out.json", [stack[1], stack[0]])


def test_what_is_left_of_a_stream_is_written(tmp_path):
    stack = lamella.slice(box_arrays(), 1)
    layers = lamella.iter_layers(box_arrays(), 1)
    assert [next(layers), next(layers)] == list(stack[:2])
    lamella.write(tmp_path / "rest.json", layers)
    assert lamella.read(tmp_path / "rest.json") == stack[2:]
    with pytest.raises(lamella.UsageError, match="closed or at its end"):
        lamella.write(tmp_path / "nothing.json", layers)


def test_a_stream_that_is_closed_while_it_is_written_leaves_no_file(tmp_path, rook):
    layers = lamella.iter_layers(rook, 0.1)
    with pytest.raises(lamella.CancelledError, match="closed while it was written"):
        lamella.write(tmp_path / "out.cli", layers, progress=lambda *_: layers.close())
    assert list(tmp_path.iterdir()) == []


def test_names_that_are_no_text_work(rook, tmp_path):
    name = f"{tmp_path}/odd \udcff name"
    os.link(rook, name + ".stl")
    stack = lamella.slice(Path(name + ".stl"), 5)
    assert lamella.slice(name + ".stl", 5) == stack
    lamella.write(name + ".json", stack)
    assert lamella.read(name + ".json").path == name + ".json"


def test_nothing_is_left_of_a_file_that_fails(tmp_path, rook):
    class Stop(Exception):
        pass

    def progress(stage, done, total):
        raise Stop

    for name, format in (("out.cli", ""), ("pictures", "png")):
        with pytest.raises(Stop) as caught:
            lamella.write(tmp_path / name, lamella.slice(rook, 5), format=format, progress=progress)
        assert list(tmp_path.iterdir()) == [], f"while {caught.value!r} is kept, with all that led to it"


def test_mesh_formats_are_those_that_the_program_takes(program):
    told = program.succeed("slice", "--help").decode()
    assert lamella.mesh_formats() and all(f".{name}" in told for name in lamella.mesh_formats())


def test_formats_are_those_of_the_program(program):
    names = [name for name, _, _ in lamella.layer_formats()]
    assert {"cli", "svg", "3mf", "npz", "png", "html"} <= set(names)
    text = program.succeed("help", "slice").decode()
    assert all(name in text for name in names)


@pytest.mark.parametrize("name", ["part.svg", "part.cli", "part.json"])
def test_slice_files_may_be_compressed(rook, tmp_path, name):
    stack = lamella.slice(rook, 2)
    lamella.write(tmp_path / name, stack)
    for threads in (1, 7):
        lamella.write(tmp_path / (name + ".gz"), stack, threads=threads)
        assert gzip.decompress((tmp_path / (name + ".gz")).read_bytes()) == (tmp_path / name).read_bytes()
    assert lamella.read(tmp_path / (name + ".gz")) == lamella.read(tmp_path / name)
    with pytest.raises(lamella.UsageError, match="npz is not written compressed with gzip"):
        lamella.write(tmp_path / "part.npz.gz", stack)
