"""Plates of several parts: the bytes of the program, with the parts apart."""

import json
import pickle

import numpy as np
import pytest
from conftest import box_arrays, joined, nested_boxes, open_box

import lamella

STRATEGY = {"upskin": {"layers": 2}, "downskin": {"layers": 1}}


@pytest.fixture(scope="module")
def plate(program, tmp_path_factory):
    """The parts of a plate, the same plate as arguments of the program, and a folder."""
    folder = tmp_path_factory.mktemp("plate")
    program.succeed("make", "torus", "-o", folder / "gear.stl")
    lamella.write(folder / "box.stl", lamella.Mesh(*box_arrays(10, 8, 6)))
    lamella.write(folder / "foot.stl", lamella.Mesh(*box_arrays(3, 3, 4)))
    parts = [
        lamella.Part(folder / "gear.stl", rotation=(0, 0, 30), position=(10, 0, 0), label="left"),
        lamella.Part(folder / "box.stl", scale=(1, 2, 1.5), rotation=(10, 90, 20), position=(0, 70, 9), copies=3, spacing=2),
        lamella.Part(folder / "foot.stl", position=(60, 0, 0), role="support"),
    ]
    arguments = [
        folder / "gear.stl", "--rotate", "0,0,30", "--translate", "10,0,0", "--label", "left",
        folder / "box.stl", "--scale", "1,2,1.5", "--rotate", "10,90,20", "--translate", "0,70,9",
        "--copies", 3, "--spacing", 2,
        folder / "foot.stl", "--translate", "60,0,0", "--support",
    ]  # fmt: skip
    return parts, arguments, folder


@pytest.mark.parametrize("name", ["plate.cli", "plate.3mf", "plate.npz"])
def test_a_plate_has_the_bytes_of_the_program(program, plate, tmp_path, name):
    parts, arguments, _ = plate
    program.succeed("slice", *arguments, "--layer-height", 0.5, "-o", tmp_path / ("program_" + name))
    expected = (tmp_path / ("program_" + name)).read_bytes()
    for threads in (1, 2, 7):
        for layers in (lamella.slice(parts, 0.5, threads=threads), lamella.iter_layers(parts, 0.5, threads=threads)):
            lamella.write(tmp_path / name, layers, threads=threads)
            assert (tmp_path / name).read_bytes() == expected


@pytest.mark.parametrize("name, selection", [("job.ilt", None), ("job.cli", (3, 9))])
def test_vectors_of_a_plate_have_the_bytes_of_the_program(program, plate, tmp_path, name, selection):
    parts, arguments, _ = plate
    strategy = ["--skin-layers", "2"]
    some = [] if selection is None else ["--layers", "{}:{}".format(*selection)]
    program.succeed("slice", *arguments, "--layer-height", 0.5, *some, "--scan", *strategy, "-o", tmp_path / ("program_" + name))
    expected = (tmp_path / ("program_" + name)).read_bytes()
    tables = {"upskin": {"layers": 2}, "downskin": {"layers": 2}}
    streamed = lamella.iter_layers(parts, 0.5, layers=selection)
    assert streamed.labels == ["left", "box", "box 2", "box 3", "foot"]
    lamella.write(tmp_path / name, lamella.scan(streamed, tables))
    assert (tmp_path / name).read_bytes() == expected
    if selection is None:
        lamella.write(tmp_path / name, lamella.scan(lamella.slice(parts, 0.5), tables))
        assert (tmp_path / name).read_bytes() == expected


def test_vectors_of_a_file_of_several_parts_have_the_bytes_of_the_program(program, plate, tmp_path):
    parts, arguments, _ = plate
    lamella.write(tmp_path / "plate.3mf", lamella.slice(parts, 0.5))
    program.succeed("scan", tmp_path / "plate.3mf", "-o", tmp_path / "program.ilt")
    lamella.write(tmp_path / "job.ilt", lamella.scan(lamella.read_layers(tmp_path / "plate.3mf")))
    assert (tmp_path / "job.ilt").read_bytes() == (tmp_path / "program.ilt").read_bytes()


def test_layers_and_stacks_tell_the_parts_apart(program, plate):
    parts, arguments, _ = plate
    stack = lamella.slice(parts, 0.5)
    stats = json.loads(program.succeed("slice", *arguments, "--layer-height", 0.5, "--stats", "-"))
    assert stack.hashes == [layer["hash"] for layer in stats["layers"]]
    labels = [part["label"] for part in stats["parts"]]
    assert [part.label for part in stack.parts] == labels == ["left", "box", "box 2", "box 3", "foot"]
    assert [part.support for part in stack.parts] == [False] * 4 + [True]
    assert stack.label == "" and (stack.matrix == np.eye(4)).all()
    for i, layer in enumerate(stack):
        assert layer.parts == [part[i] for part in stack.parts]
        assert sum(part.area for part in layer.parts) == pytest.approx(layer.area)
    for part in stack.parts:
        assert part.bounds[0].tolist() >= stack.bounds[0].tolist()
        assert all(layer.parts == [layer] for layer in part)
    left, box, second, _, foot = stack.parts
    assert left.hashes == lamella.slice(parts[0], z=stack.z).hashes
    corner = np.array([0, 0, 0, 1])
    assert (foot.matrix @ corner)[:3].tolist() == [60, 0, 0]
    offset = second.bounds[0] - box.bounds[0]
    assert offset[0] > 0 and offset[1] == offset[2] == 0
    assert ((second.matrix - box.matrix) @ corner)[:3] == pytest.approx(offset)
    assert [part.label for part in stack[:3].parts] == labels and len(stack[:3].parts[0]) == 3


def test_parts_survive_pickling(plate):
    stack = lamella.slice(plate[0], 1)
    again = pickle.loads(pickle.dumps(stack))
    assert [part.label for part in again.parts] == [part.label for part in stack.parts]
    assert again[0].parts == stack[0].parts
    assert pickle.loads(pickle.dumps(stack[0])).parts == stack[0].parts


def test_one_part_is_a_stack_of_its_own():
    arrays = box_arrays()
    for plate in (lamella.Part(arrays, position=(1, 2, 3)), [lamella.Part(arrays, matrix=[[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])]):
        stack = lamella.slice(plate, 1)
        assert stack == lamella.slice((arrays[0] + (1, 2, 3), arrays[1]), 1)
        assert stack.parts == [stack] and stack.label == "part" and stack[0].parts == [stack[0]]
        assert stack.matrix[:3, 3].tolist() == [1, 2, 3]


def test_matrix_scale_rotation_and_position_apply_in_this_order():
    turned = [[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    part = lamella.Part(box_arrays(2, 4, 6), matrix=turned, scale=2, rotation=(90, 0, 0), position=(100, 0, 0))
    assert lamella.slice(part, 0.5).bounds.tolist() == [[102, -12, 0], [110, 0, 4]]


def test_direction_and_transform_place_the_whole_plate():
    parts = [lamella.Part(box_arrays(2, 4, 6)), lamella.Part(box_arrays(1, 1, 1), position=(10, 0, 0))]
    stack = lamella.slice(parts, 0.5, direction=(1, 0, 0), transform=np.diag([2, 2, 2, 1]))
    assert [np.ptp(part.bounds, axis=0).tolist() for part in stack.parts] == [[12, 8, 4], [2, 2, 2]]
    assert stack.bounds[1, 2] - stack.bounds[0, 2] == 22
    for part, made in zip(stack.parts, parts):
        assert part.matrix[:3, :3].tolist() == stack.matrix[:3, :3].tolist()


def test_meshes_that_were_read_and_arrays_can_be_parts(program, plate):
    _, _, folder = plate
    mesh = lamella.read_mesh(folder / "gear.stl")
    arrays = (mesh.vertices, mesh.faces)
    stack = lamella.slice([lamella.Part(mesh), lamella.Part(arrays), lamella.Part(arrays, label="copy")], 1)
    assert [part.label for part in stack.parts] == ["gear", "part", "copy"]
    assert stack.parts[0] == stack.parts[1] == stack.parts[2] == lamella.slice(mesh, 1)


def test_the_objects_of_a_file_are_parts(program, tmp_path, plate):
    _, _, folder = plate
    amf = "".join(
        f'<object id="{i}"><metadata type="name">{name}</metadata><mesh><vertices>'
        + "".join(f"<vertex><coordinates><x>{x}</x><y>{y}</y><z>{z}</z></coordinates></vertex>" for x, y, z in vertices)
        + "</vertices><volume>"
        + "".join(f"<triangle><v1>{a}</v1><v2>{b}</v2><v3>{c}</v3></triangle>" for a, b, c in faces)
        + "</volume></mesh></object>"
        for i, (name, (vertices, faces)) in enumerate({"one": box_arrays(), "two": box_arrays(at=(50, 0, 0))}.items(), 1)
    )
    (tmp_path / "two.amf").write_text(f'<?xml version="1.0"?><amf unit="millimeter">{amf}</amf>', encoding="utf-8")
    stack = lamella.slice(lamella.Part(tmp_path / "two.amf"), 1)
    assert [part.label for part in stack.parts] == ["one", "two"]
    assert lamella.slice(tmp_path / "two.amf", 1).parts[0].label == "part"
    program.succeed("slice", tmp_path / "two.amf", "--layer-height", 1, "-o", tmp_path / "program.cli")
    lamella.write(tmp_path / "two.cli", stack)
    assert (tmp_path / "two.cli").read_bytes() == (tmp_path / "program.cli").read_bytes()


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_a_plate_is_mended_as_by_the_program(program, tmp_path):
    lamella.write(tmp_path / "open.stl", lamella.Mesh(*open_box()))
    lamella.write(tmp_path / "nested.stl", lamella.Mesh(*joined(nested_boxes(), box_arrays(5, 5, 5, at=(-1, -1, 0)))))
    program.succeed(
        "slice", tmp_path / "open.stl", tmp_path / "nested.stl", "--translate", "50,0,0", "--layer-height", 1,
        "--orient", "--close-gaps", 40, "--fill", "nonzero", "-o", tmp_path / "program.3mf",
    )  # fmt: skip
    parts = [lamella.Part(tmp_path / "open.stl"), lamella.Part(tmp_path / "nested.stl", position=(50, 0, 0))]
    stack = lamella.slice(parts, 1, orient=True, close_gaps=40, fill="nonzero")
    lamella.write(tmp_path / "python.3mf", stack)
    assert (tmp_path / "python.3mf").read_bytes() == (tmp_path / "program.3mf").read_bytes()
    assert stack.repairs["close_gaps"]["closed"] == 10 and stack.repairs["fill"]["layers"] == 5
    with lamella.iter_layers(parts, 1, orient=True, close_gaps=40, fill="nonzero") as layers:
        assert list(layers) == list(stack) and layers.repairs == stack.repairs


def test_a_negative_part_is_subtracted_from_all_others(program, tmp_path):
    lamella.write(tmp_path / "box.stl", lamella.Mesh(*box_arrays()))
    lamella.write(tmp_path / "drill.stl", lamella.Mesh(*box_arrays(4, 4, 40, at=(0, 0, -5))))
    program.succeed(
        "slice", tmp_path / "box.stl", "--copies", 2, tmp_path / "drill.stl", "--translate", "23,8,0", "--negative",
        "--layer-height", 1, "-o", tmp_path / "program.3mf",
    )  # fmt: skip
    parts = [
        lamella.Part(tmp_path / "box.stl", copies=2),
        lamella.Part(tmp_path / "drill.stl", position=(23, 8, 0), role="negative"),
    ]
    stack = lamella.slice(parts, 1)
    for threads in (1, 2, 7):
        lamella.write(tmp_path / "python.3mf", lamella.iter_layers(parts, 1, threads=threads))
        assert (tmp_path / "python.3mf").read_bytes() == (tmp_path / "program.3mf").read_bytes()
    assert [part.area.tolist() for part in stack.parts] == [[600.0] * 10, [592.0] * 10]
    assert stack.bounds.tolist() == [[0, 0, 0], [45, 30, 10]]
    found = lamella.verify(stack, parts)
    assert found.ok and found.max_area_error < 1e-9
    assert not lamella.verify(stack, parts[0]).areas_agree


def test_a_plate_may_be_closed_where_volumes_are_subtracted():
    parts = [lamella.Part(open_box()), lamella.Part(box_arrays(4, 4, 40, at=(4, 4, -5)), role="negative")]
    stack = lamella.slice(parts, 1, close_gaps=40)
    assert stack.repairs["close_gaps"]["closed"] == 10 and stack.area.tolist() == [600 - 16] * 10


def test_a_part_that_bounds_no_material_is_reported_though_another_part_surrounds_it():
    parts = [lamella.Part(box_arrays()), lamella.Part(box_arrays(4, 4, 4, inward=True), position=(4, 4, 2))]
    texts = []
    for layers in (lamella.iter_layers(parts, 1), lamella.slice(parts, 1)):
        with pytest.warns(lamella.DefectWarning, match="4 rings bound no material in 4 of 10 layers") as caught:
            for _ in lamella.scan(layers):
                pass
        texts.append([str(one.message).partition(": ")[2] for one in caught if str(one.message).startswith("layers: ")])
    assert texts[0] == texts[1] != []


def test_warnings_name_the_file(tmp_path):
    lamella.write(tmp_path / "open.stl", lamella.Mesh(*open_box()))
    parts = [lamella.Part(box_arrays(), position=(50, 0, 0)), lamella.Part(tmp_path / "open.stl")]
    with pytest.warns(lamella.DefectWarning) as caught:
        lamella.slice(parts, 1)
    assert [str(one.message).partition(": ")[0] for one in caught] == [str(tmp_path / "open.stl")]
    with pytest.raises(lamella.DefectError, match="open.stl: the mesh has defects"):
        lamella.slice(parts, 1, strict=True)
    with pytest.warns(lamella.DefectWarning, match='^part "hole": 10 open chains'):
        lamella.slice([lamella.Part(box_arrays(), position=(50, 0, 0)), lamella.Part(open_box(), label="hole")], 1)


@pytest.mark.parametrize(
    "call, error, text",
    [
        (lambda: lamella.Part("a.stl", role="modifier"), lamella.UsageError, 'role: "modifier" is none of "solid", "support" and "negative"'),
        (lambda: lamella.Part("a.stl", position=(1, 2)), lamella.UsageError,
         "position: expected three numbers (x, y, z), found 2 values"),
        (lambda: lamella.Part("a.stl", scale=0), lamella.UsageError, "scale: 0 is not possible; expected a number above 0"),
        (lambda: lamella.Part("a.stl", copies=0), lamella.UsageError,
         "copies: 0 is not possible; expected a whole number, 1 or more"),
        (lambda: lamella.slice([lamella.Part(box_arrays()), "a.stl"], 1), TypeError,
         "part: expected a lamella.Part, as the others of the plate are, found 'a.stl'"),
        (lambda: lamella.slice([lamella.Part(box_arrays())], 1, unit_mm=2), lamella.UsageError,
         "unit_mm: each part of a plate has its own, such as lamella.Part(..., unit_mm=25.4)"),
        (lambda: lamella.slice(lamella.Part(box_arrays(), matrix=np.diag([1, 1, 1, 2])), 1), lamella.UsageError,
         "matrix: the last row of a transform must be 0, 0, 0, 1, and this one is 0, 0, 0, 2: meshes are moved, rotated and "
         "scaled, but not projected"),
        (lambda: lamella.slice(lamella.Part(box_arrays(), label="far", position=(1e200, 0, 0)), 1), lamella.UsageError,
         "reaches beyond 1e+100 mm"),
        (lambda: lamella.scan(lamella.slice([lamella.Part(box_arrays())] * 2, 5), part="both"), lamella.UsageError,
         "part: names one part, and the layers hold 2, which have labels of their own"),
    ],
)  # fmt: skip
def test_what_does_not_fit_a_plate_is_an_error(call, error, text):
    with pytest.raises(error) as caught:
        call()
    assert text in str(caught.value)


def test_a_mistyped_keyword_of_a_part_is_explained():
    with pytest.raises(TypeError, match="unexpected keyword argument 'postion'; did you mean 'position'?"):
        lamella.Part(box_arrays(), postion=(1, 2, 3))


def test_layers_of_a_plate_that_are_taken_alone_say_what_they_lose(tmp_path):
    plate = lamella.slice([lamella.Part(box_arrays(), label="left"), lamella.Part(box_arrays(), position=(40, 0, 0), role="support")], 1)
    lost = "lose the labels and roles of the parts, which become one"
    with pytest.warns(lamella.DefectWarning, match=f"10 layers of plates {lost}"):
        lamella.write(tmp_path / "a.cli", (layer for layer in plate))
    with pytest.raises(lamella.DefectError, match=lost):
        lamella.write(tmp_path / "b.cli", list(plate), strict=True)
    assert not (tmp_path / "b.cli").exists()
    with pytest.warns(lamella.DefectWarning, match="a layer of a plate loses"):
        plate[0].offset(-0.1)
    with pytest.warns(lamella.DefectWarning, match="a layer of a plate loses") as caught:
        list(lamella.scan(list(plate)))
    assert len(caught) == 1
    assert len(lamella.Stack([part[0] for part in plate.parts[:1]])) == 1


@pytest.mark.parametrize("meshes", [["a.stl", "b.stl"], [box_arrays(), "b.stl"], [lamella.Mesh(*box_arrays())] * 3])
def test_a_list_of_meshes_is_no_plate_by_itself(meshes):
    with pytest.raises(TypeError, match="part: several meshes make up a plate: put each of them into a lamella.Part"):
        lamella.slice(meshes, 1)
