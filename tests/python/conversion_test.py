"""Conversion of files."""

import numpy as np
import pytest
from conftest import box_arrays, nested_boxes

import lamella


def test_conversion_is_that_of_the_program(program, rook, tmp_path):
    lamella.write(tmp_path / "rook.cli", lamella.slice(rook, 0.5))
    program.succeed("convert", tmp_path / "rook.cli", tmp_path / "program.svg")
    lamella.convert(tmp_path / "rook.cli", tmp_path / "rook.svg")
    assert (tmp_path / "rook.svg").read_bytes() == (tmp_path / "program.svg").read_bytes()
    program.succeed("convert", tmp_path / "rook.svg", tmp_path / "program.cli", "--units-mm", 0.01)
    lamella.convert(tmp_path / "rook.svg", tmp_path / "rook.cli", units_mm=0.01)
    assert (tmp_path / "rook.cli").read_bytes() == (tmp_path / "program.cli").read_bytes()
    for format in ("3mf", "3mf-toolpath"):
        for made, folder in [("convert", "a"), ("scan", "b")]:
            (tmp_path / folder).mkdir(exist_ok=True)
            output = ["-o"] if made == "scan" else []
            program.succeed(made, tmp_path / "rook.cli", *output, tmp_path / folder / "rook.3mf", "--format", format)
        lamella.convert(tmp_path / "rook.cli", tmp_path / "rook.3mf", format=format)
        assert (tmp_path / "rook.3mf").read_bytes() == (tmp_path / "a/rook.3mf").read_bytes()
        layers = lamella.read(tmp_path / "rook.cli")
        lamella.write(tmp_path / "rook.3mf", lamella.scan(layers, part=layers.label), format=format)
        assert (tmp_path / "rook.3mf").read_bytes() == (tmp_path / "b/rook.3mf").read_bytes()
    with pytest.raises(lamella.UsageError, match="would overwrite the input"):
        lamella.convert(tmp_path / "rook.cli", tmp_path / "rook.cli")


@pytest.mark.parametrize("rule", ["nonzero", "evenodd", "positive"])
def test_conversion_fills_as_the_program_does(program, tmp_path, rule):
    lamella.write(tmp_path / "nested.json", [lamella.slice(nested_boxes(), 1), lamella.slice(box_arrays(), z=np.arange(0.5, 10))])
    options = ["--fill", rule]
    program.succeed("convert", tmp_path / "nested.json", tmp_path / "program.3mf", *options)
    lamella.convert(tmp_path / "nested.json", tmp_path / "python.3mf", fill=rule)
    assert (tmp_path / "python.3mf").read_bytes() == (tmp_path / "program.3mf").read_bytes()
    with pytest.raises(lamella.UsageError, match='^fill: "odd" is none of'):
        lamella.convert(tmp_path / "nested.json", tmp_path / "x.3mf", fill="odd")


def test_first_layers_shrink_as_the_program_shrinks_them(program, tmp_path):
    lamella.write(tmp_path / "box.stl", box_arrays())
    parts = [lamella.slice(nested_boxes(), 1), lamella.slice(box_arrays(), z=np.arange(0.5, 10))]
    lamella.write(tmp_path / "nested.json", parts)
    program.succeed("convert", tmp_path / "nested.json", tmp_path / "program.json", "--fill", "nonzero", "--bottom-offset", "0.4:3")
    lamella.convert(tmp_path / "nested.json", tmp_path / "python.json", fill="nonzero", bottom_offset=(0.4, 3))
    assert (tmp_path / "python.json").read_bytes() == (tmp_path / "program.json").read_bytes()
    program.succeed("slice", tmp_path / "box.stl", "--layer-height", 0.5, "--bottom-offset", "0.4:3", "-o", tmp_path / "program.json")
    stack = lamella.slice(tmp_path / "box.stl", 0.5, bottom_offset=(0.4, 3))
    assert lamella.compare(stack, tmp_path / "program.json")
    with lamella.iter_layers(tmp_path / "box.stl", 0.5, bottom_offset=(0.4, 3)) as layers:
        assert list(layers) == list(stack)
    assert stack[:6].area.max() < stack[6].area and list(stack[6:]) == list(lamella.slice(tmp_path / "box.stl", 0.5)[6:])
    for wrong in [(0.4, 0), (-1, 3), 0.4, (0.4,)]:
        with pytest.raises((lamella.UsageError, TypeError), match="^bottom_offset: "):
            lamella.slice(box_arrays(), bottom_offset=wrong)


def test_supports_and_parts_above_the_plate_shrink_by_its_height():
    low, high = lamella.Part(box_arrays()), lamella.Part(box_arrays(at=(20, 0, 2)))
    first, second = lamella.slice([low, high], 1, bottom_offset=(0.5, 2)).parts
    assert first.area[0] < first.area[1] < first.area[2] == second.area[2]


def test_filling_says_what_it_leaves_out(tmp_path, jobs):
    lamella.write(tmp_path / "inward.json", lamella.Stack([lamella.Layer([[(0, 0), (0, 4), (4, 4), (4, 0)]], 1, 0, 2)]))
    with pytest.warns(lamella.DefectWarning, match="no contour is left in any of 1 layer: fill or bottom_offset removed"):
        lamella.convert(tmp_path / "inward.json", tmp_path / "x.json", fill="positive")
    with pytest.raises(lamella.UsageError, match="holds scan vectors .*, and fill is for contours: fill before scan$"):
        lamella.convert(jobs / "program.ilt", tmp_path / "x.ovf", fill="nonzero")
