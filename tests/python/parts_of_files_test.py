"""Files of several parts."""

import json
import pickle

import numpy as np
import pytest
from conftest import box_arrays

import lamella


def test_parts_stay_apart_in_files(tmp_path):
    z = np.arange(0.5, 10)
    stacks = [lamella.slice(box_arrays(size, 5, 10, at=(20.0 * size, 0, 0)), z=z) for size in (1, 2)]
    named = [lamella.Stack(list(stack), label=label) for stack, label in zip(stacks, ["left", "right"])]
    path = tmp_path / "two.cli"
    lamella.write(path, named)
    back = lamella.read(path)
    assert [part.label for part in back.parts] == ["left", "right"]
    assert [part.area.tolist() for part in back.parts] == [[5.0] * 10, [10.0] * 10]
    assert back.area.tolist() == [15.0] * 10
    again = tmp_path / "again.cli"
    lamella.write(again, back)
    assert [part.label for part in lamella.read(again).parts] == ["left", "right"]
    with pytest.raises(lamella.UsageError, match="the same planes"):
        lamella.write(path, [named[0], named[1][:5]])


@pytest.mark.parametrize("change", [{"bottom": 0.25}, {"top": 0.75}, {"index": 7}])
def test_parts_of_other_layers_are_refused(tmp_path, change):
    square = [(0, 0), (1, 0), (1, 1)]
    heads = {"z": 0.5, "bottom": 0, "top": 1, "index": 0}
    one, other = (lamella.Stack([lamella.Layer([square], **header)]) for header in (heads, {**heads, **change}))
    (name,) = change
    with pytest.raises(lamella.UsageError, match={"bottom": "bottoms", "top": "tops", "index": "indices"}[name]):
        lamella.write(tmp_path / "two.cli", [one, other])
    assert list(tmp_path.iterdir()) == []


def test_stacks_with_parts_keep_them(tmp_path):
    stacks = [lamella.Stack(list(lamella.slice(box_arrays(at=(x, 0, 0)), 1)), label=f"at {x}") for x in (0, 50)]
    lamella.write(tmp_path / "two.json", stacks)
    both = lamella.read(tmp_path / "two.json")
    some = both[2:8:2]
    assert [part.label for part in some.parts] == ["at 0", "at 50"]
    assert [part[0] for part in some.parts] == [stack[2] for stack in stacks]
    assert [len(part) for part in pickle.loads(pickle.dumps(some)).parts] == [3, 3]
    lamella.write(tmp_path / "twice.json", [both, both])
    assert [part.label for part in lamella.read(tmp_path / "twice.json").parts] == ["at 0", "at 50"] * 2


def test_slices_of_stacks_have_the_bounds_of_what_there_is(bodies, tmp_path):
    cone = lamella.slice(bodies("sphere", "--size", 20), 1)
    assert (cone[:5].bounds == cone.bounds).all(), "those of the mesh"
    lamella.write(tmp_path / "cone.json", cone)
    for stack in [lamella.read(tmp_path / "cone.json"), lamella.Stack(list(cone))]:
        for few in [stack[:5], stack[:9][:5], pickle.loads(pickle.dumps(stack[:9]))[:5]]:
            assert (few.bounds == lamella.Stack(list(few)).bounds).all() and (few.bounds[1] < stack.bounds[1]).all()
    lamella.write(tmp_path / "twice.json", [cone, cone])
    few = lamella.read(tmp_path / "twice.json")[:5]
    assert all((part.bounds == few.bounds).all() for part in few.parts)
    assert lamella.Stack([]).bounds.tolist() == [[0, 0, 0], [0, 0, 0]]


def test_a_part_without_contours_leaves_the_box_of_a_file_alone(tmp_path):
    full = lamella.slice(box_arrays(at=(50, 60, 0)), 5)
    empty = lamella.Stack([lamella.Layer([], layer.z, layer.bottom, layer.top, layer.index) for layer in full])
    lamella.write(tmp_path / "out.geojson", [empty, full])
    assert json.loads((tmp_path / "out.geojson").read_text())["bbox"] == [50, 60, 70, 90]
    assert empty.bounds.tolist() == [[0, 0, 0], [0, 0, 10]]
    lamella.write(tmp_path / "out.cli", [empty, empty])
    assert b"$$DIMENSION/0.000000,0.000000,0.000000,0.000000,0.000000,10.000000" in (tmp_path / "out.cli").read_bytes()
