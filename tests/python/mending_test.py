"""Repaired meshes, and checks of layers that were sliced with repairs."""

import pickle

import conftest
import numpy as np
import pytest
from conftest import box_arrays, joined, open_box

import lamella


def damaged():
    """A box with a flipped triangle, a repeated one, and a corner that is off by 0.001 mm in one triangle."""
    vertices, faces = joined(box_arrays(), box_arrays(5, 5, 5, at=(40, 0, 0)))
    faces = np.concatenate([faces, faces[3:4]])
    faces[0] = faces[0, ::-1]
    vertices = np.concatenate([vertices, [vertices[faces[5, 0]] + (0.001, 0, 0)]])
    faces[5, 0] = len(vertices) - 1
    return vertices, faces


REPAIRS = [
    {"weld_tolerance": 0.01},
    {"drop_duplicates": True},
    {"orient": True},
    {"weld_tolerance": 0.01, "drop_duplicates": True, "orient": True},
]


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
@pytest.mark.parametrize("repairs", REPAIRS)
def test_a_mended_mesh_gives_the_layers_of_slicing_with_the_same_repairs(repairs):
    expected = lamella.slice(damaged(), 0.7, **repairs)
    for threads in (1, 5):
        mended = lamella.mend(damaged(), threads=threads, **repairs)
        assert isinstance(mended, lamella.Mesh)
        assert mended.repairs == expected.repairs
        assert lamella.slice(mended, 0.7) == expected
        again = pickle.loads(pickle.dumps(mended))
        assert again.repairs == mended.repairs and lamella.slice(again, 0.7) == expected


def test_a_mended_mesh_is_a_mesh_for_everything(tmp_path):
    mended = lamella.mend(damaged(), weld_tolerance=0.01, drop_duplicates=True, orient=True)
    found = lamella.inspect(mended)
    assert found.sound and found.triangles == len(mended) == 24
    assert lamella.Slicer(mended).section(1).area == pytest.approx(625)
    lamella.write(tmp_path / "mended.ply", mended)
    assert lamella.read_mesh(tmp_path / "mended.ply").volume == pytest.approx(mended.volume) == pytest.approx(6125)
    assert lamella.verify(lamella.slice(mended, 0.7), mended)
    assert lamella.slice([lamella.Part(mended), lamella.Part(box_arrays())], 1).volume == pytest.approx(12125)


def test_counts_of_one_repair_after_another_are_added():
    once = lamella.mend(damaged(), drop_duplicates=True)
    twice = lamella.mend(once, weld_tolerance=0.01, orient=True)
    assert twice.repairs["drop_duplicates"] == once.repairs["drop_duplicates"]
    assert set(twice.repairs) == {"drop_duplicates", "weld_tolerance", "orient"}
    assert lamella.Mesh(*box_arrays()).repairs == {}


def test_a_mended_mesh_moves_as_others_do():
    mended = lamella.mend(damaged(), weld_tolerance=0.01, drop_duplicates=True, orient=True)
    turned = lamella.slice(mended, 1, direction=(1, 0, 0))
    assert turned.volume == pytest.approx(6125)
    assert turned.matrix @ (1, 0, 0, 1) == pytest.approx([*(turned.matrix @ (0, 0, 0, 1))[:2], 1, 1])


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_the_file_of_a_mended_mesh_is_named(tmp_path):
    path = tmp_path / "part.obj"
    lamella.write(path, lamella.Mesh(*damaged()))
    mended = lamella.mend(path, orient=True)
    assert mended.path == str(path) and mended.format == "obj"
    assert lamella.slice([lamella.Part(mended), lamella.Part(mended)], 1).parts[0].label.startswith("part")


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
@pytest.mark.parametrize("repairs", REPAIRS)
def test_layers_of_a_mended_mesh_agree_only_if_it_is_mended_for_the_check_too(tmp_path, repairs):
    stack = lamella.slice(damaged(), 0.7, **repairs)
    lamella.write(tmp_path / "part.json", stack)
    for layers in (stack, tmp_path / "part.json"):
        found = lamella.verify(layers, damaged(), **repairs)
        assert found.areas_agree and found.displaced == 0, found.findings
        assert found.ok or len(repairs) < 3, found.findings
    assert not lamella.verify(stack, damaged())


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_layers_whose_gaps_were_closed_agree_if_they_are_closed_for_the_check_too():
    stack = lamella.slice(open_box(), 1, close_gaps=50)
    assert stack.volume == pytest.approx(6000)
    assert lamella.verify(stack, open_box(), close_gaps=50)
    assert lamella.verify(stack, box_arrays())
    assert not lamella.verify(lamella.slice(box_arrays(20, 29, 10), 1), open_box(), close_gaps=50)
    plate = [lamella.Part(open_box()), lamella.Part(open_box(), position=(21, 0, 0))]
    assert lamella.verify(lamella.slice(plate, 1, close_gaps=50), plate, close_gaps=50)


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_vectors_of_a_mended_mesh_are_checked_against_the_mended_mesh(tmp_path):
    strategy = lamella.ScanStrategy()
    strategy.contours.thin_walls = "leave out"
    repairs = {"weld_tolerance": 0.01, "drop_duplicates": True, "orient": True}
    vertices, faces = damaged()
    inside_out = (vertices, faces[:, ::-1])
    lamella.write(tmp_path / "job.ilt", lamella.scan(lamella.slice(inside_out, 2.5, **repairs), strategy))
    found = lamella.verify_vectors(tmp_path / "job.ilt", inside_out, **repairs)
    assert found.outside == found.inverted_rings == 0, found.findings
    assert not lamella.verify_vectors(tmp_path / "job.ilt", inside_out)


@pytest.mark.parametrize(
    "keywords",
    [{"weld_tolerance": 0.1}, {"drop_duplicates": True}, {"orient": True}, {"close_gaps": 1}],
)
def test_repairs_need_a_mesh(keywords):
    (name,) = keywords
    with pytest.raises(lamella.UsageError, match=f"^{name} goes with a mesh, and none is given$"):
        lamella.verify(lamella.slice(box_arrays(), 1), **keywords)


def test_something_must_be_mended():
    for keywords in ({}, {"orient": False, "drop_duplicates": False}):
        with pytest.raises(lamella.UsageError, match="^mend: expected weld_tolerance, drop_duplicates or orient$"):
            lamella.mend(box_arrays(), **keywords)
    vertices, faces = box_arrays()
    with pytest.raises(lamella.InputError, match="^the mesh: nothing of the mesh is left after its repair$"):
        lamella.mend((vertices, np.concatenate([faces, faces[:, ::-1]])), drop_duplicates=True)


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_the_program_checks_with_the_same_options(program, tmp_path):
    part = tmp_path / "part.obj"
    vertices, faces = damaged()
    faces[6] = faces[6, ::-1]  # of a wall, so that areas of sections are wrong
    lamella.write(part, lamella.Mesh(vertices, faces))
    options = ["--weld-tolerance", "0.01", "--drop-duplicates", "--orient"]
    program.succeed("slice", part, "--layer-height", "0.7", *options, "-o", tmp_path / "part.cli")
    program.succeed("verify", tmp_path / "part.cli", "--mesh", part, *options)
    assert program("verify", tmp_path / "part.cli", "--mesh", part).returncode == 4
    lamella.write(part, lamella.Mesh(*open_box()))
    program.succeed("slice", part, "--layer-height", "1", "--close-gaps", "50", "-o", tmp_path / "part.cli")
    program.succeed("verify", tmp_path / "part.cli", "--mesh", part, "--close-gaps", "50")
    assert "--mesh part.stl" in program.error("verify", tmp_path / "part.cli", "--orient")


def test_negative_volumes_stay_negative(tmp_path):
    parts = [lamella.Part(box_arrays()), lamella.Part(box_arrays(5, 5, 20), position=(5, 5, -5), role="negative")]
    expected = lamella.slice(parts, 1)
    vertices, faces = box_arrays()
    faces[0] = faces[0, ::-1]
    mended = [lamella.Part(lamella.mend((vertices, faces), orient=True)), parts[1]]
    assert lamella.slice(mended, 1) == expected
    assert conftest.shoelace(expected[5][0]) == pytest.approx(600)
