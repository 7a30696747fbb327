"""Inspection, verification and comparison."""

import json

import numpy as np
import pytest
from conftest import box_arrays, joined, open_box

import lamella


def test_inspection_is_that_of_the_program(program, rook):
    expected = json.loads(program.succeed("info", rook, "--json"))
    found = lamella.inspect(rook)
    for name in ("path", "format", "triangles", "vertices", "closed", "shells"):
        assert getattr(found, name) == expected[name], name
    assert found.volume == expected["volume_mm3"] and found.area == expected["area_mm2"]
    assert found.bounds.tolist() == expected["bbox"]
    for name, count in expected["defects"].items():
        if hasattr(found, name):
            assert getattr(found, name) == count, name
    assert found.sound and found.defects == ""


def test_defects_are_reported_in_words():
    vertices, faces = open_box()
    found = lamella.inspect((vertices, np.concatenate([faces, faces[:1], [(0, 0, 1)]])))
    assert not found.closed and not found.sound
    assert found.defects == (
        "4 boundary edges, 3 non-manifold edges, 3 orientation conflicts, 1 duplicate triangle, "
        "1 degenerate triangle"
    )
    assert lamella.inspect(box_arrays(inward=True)).inverted_shells == 1


def test_verification_finds_what_is_wrong(program, rook, tmp_path):
    stack = lamella.slice(rook, 0.5)
    found = lamella.verify(stack, rook)
    assert found.ok and found.layers == len(stack) and found.max_area_error < 1e-9
    lamella.write(tmp_path / "rook.cli", stack)
    expected = json.loads(program.succeed("verify", tmp_path / "rook.cli", "--mesh", rook, "--json"))
    found = lamella.verify(tmp_path / "rook.cli", rook)
    assert (found.ok, found.contours, found.crossings) == (True, expected["contours"], 0)
    assert found.max_area_error == expected["max_area_error_mm2"]

    moved = lamella.Stack([lamella.Layer([ring + (i % 2) for ring in layer], layer.z, layer.bottom, layer.top)
                           for i, layer in enumerate(lamella.slice(box_arrays(), 1))])
    found = lamella.verify(moved, box_arrays())
    assert (found.ok, found.areas_agree, found.displaced) == (False, True, len(moved) // 2)
    grown = lamella.Stack([lamella.Layer([ring * 1.01 for ring in layer], layer.z, layer.bottom, layer.top)
                           for layer in moved])
    found = lamella.verify(grown, box_arrays())
    assert not found.ok and not found.areas_agree and found.findings
    back = lamella.read(tmp_path / "rook.cli")
    formerly_rounded = lamella.Stack(list(back))
    assert not lamella.verify(formerly_rounded, rook).ok and lamella.verify(formerly_rounded, rook, tolerance=5e-4).ok
    bow_tie = lamella.Stack([lamella.Layer([[(0, 0), (1, 1), (1, 0), (0, 1)]], z=0)])
    assert lamella.verify(bow_tie).crossings == 1


def test_comparison_reports_where_layers_differ():
    stack = lamella.slice(box_arrays(), 1)
    assert lamella.compare(stack, stack).same == len(stack)
    moved = lamella.Stack([
        layer if i != 4 else lamella.Layer([layer[0] + (0.25, 0)], layer.z, layer.bottom, layer.top, layer.index)
        for i, layer in enumerate(stack)
    ])
    found = lamella.compare(stack, moved)
    assert not found and len(found.differences) == 1 and found.same == len(stack) - 1
    difference = found.differences[0]
    assert (difference.z, difference.distance) == (4.5, 0.25)
    assert difference.first == stack[4] and difference.second == moved[4]
    assert lamella.compare(stack, moved, tolerance=0.3)
    shorter = lamella.compare(stack, stack[:6])
    assert [difference.z for difference in shorter.differences] == [6.5, 7.5, 8.5, 9.5]
    assert all(difference.second is None for difference in shorter.differences)


def test_comparison_warns_of_other_cuts_between_the_same_heights():
    middle, bottom = (lamella.slice(box_arrays(), 1, at=at) for at in ("middle", "bottom"))
    with pytest.warns(lamella.DefectWarning, match=r"z = 0 to 1 mm at 0\.5 mm in the first and at 0 mm in the second"):
        assert not lamella.compare(middle, bottom)


def test_filled_layers_agree_with_the_filled_sections_of_the_mesh():
    mesh = joined(box_arrays(4, 4, 4), box_arrays(4, 4, 4, at=(2, 2, 0)))
    stack = lamella.slice(mesh, 1, fill="nonzero")
    assert stack.repairs["fill"] == {
        "layers": 4, "groups_united": 4, "rings_united": 8, "rings_reversed": 0, "rings_dropped": 0,
        "area_before_mm2": 128, "area_after_mm2": 112,
    }  # fmt: skip
    assert not lamella.verify(stack, mesh).areas_agree
    assert lamella.verify(stack, mesh, fill="nonzero").ok
    with pytest.raises(lamella.UsageError, match="^fill goes with a mesh, and none is given$"):
        lamella.verify(stack, fill="nonzero")


def test_shrunken_first_layers_agree_with_shrunken_sections_of_the_mesh():
    stack = lamella.slice(box_arrays(), 1, bottom_offset=(0.4, 3))
    assert not lamella.verify(stack, box_arrays()).areas_agree
    assert lamella.verify(stack, box_arrays(), bottom_offset=(0.4, 3)).ok
    with pytest.raises(lamella.UsageError, match="^bottom_offset goes with a mesh, and none is given$"):
        lamella.verify(stack, bottom_offset=(0.4, 3))
