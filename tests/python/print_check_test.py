"""Stack.check: islands, overhangs, cups and traps."""

import json
import pickle

import numpy as np
import pytest
from conftest import box_arrays

import lamella


def square(x, y, size):
    return np.array([(x, y), (x + size, y), (x + size, y + size), (x, y + size)], dtype=float)


def stack_of(*layers):
    """Layers of 1 mm with these rings."""
    return lamella.Stack([lamella.Layer(rings, i + 0.5, i, i + 1, i) for i, rings in enumerate(layers)])


def test_a_box_is_sound():
    found = lamella.slice(box_arrays(), 1).check()
    assert found and found.ok and found.findings == [] and found.islands == [] and found.cavities == []
    assert found.exposed.sum() == found.area[0] > 0


def test_an_island_and_a_trap():
    ring = [square(0, 0, 10), square(2, 2, 4)[::-1]]
    found = stack_of([square(0, 0, 10)], [*ring, square(12, 0, 1)], ring, [square(0, 0, 10)]).check()
    assert not found
    (island,) = found.islands
    assert (island.layer, island.bottom, island.top, island.centre) == (1, 1, 2, (12.5, 0.5))
    assert (island.volume, island.joins, island.support) == (1, False, False)
    (trap,) = found.cavities
    assert trap.trap and trap.volume == 32 and trap.area == 16
    assert found.area.tolist() == [100, 85, 84, 100] and found.largest_area[1] == 84
    assert len(found.findings) == 3
    assert pickle.loads(pickle.dumps(found)).islands == found.islands


def test_it_agrees_with_the_program(program, rook, tmp_path):
    stack = lamella.slice(rook, 0.5)
    found = stack.check(overhang_angle=30, touch=0.01)
    expected = json.loads(program.succeed("check", rook, "--layer-height", "0.5", "--overhang-angle", "30", "--touch", "0.01",
                                          "--json"))
    assert found.findings == expected["findings"]
    assert [island.volume for island in found.islands] == [island["volume_mm3"] for island in expected["list_of_islands"]]
    assert [cavity.trap for cavity in found.cavities] == [cavity["trap"] for cavity in expected["list_of_cavities"]]
    assert found.overhang_area.sum() == pytest.approx(expected["overhangs_mm2"])


def test_parts_that_are_supports_are_told_apart():
    part = lamella.Part(box_arrays(), label="part")
    support = lamella.Part(box_arrays(), label="support", role="support", position=(40, 0, 3))
    (island,) = lamella.slice([part, support], 0.5).check().islands
    assert island.support


@pytest.mark.parametrize("keywords", [{"touch": -1}, {"touch": "x"}, {"overhang_angle": 90}, {"overhang_angle": 0}])
def test_impossible_options_are_refused(keywords):
    with pytest.raises((lamella.UsageError, TypeError)):
        stack_of([square(0, 0, 1)]).check(**keywords)
