"""Meshes of any kind in, layers out: the same as the program's."""

import csv
import json
import pickle

import numpy as np
import pytest
from conftest import ROOT, box_arrays, nested_boxes, open_box, shoelace

import lamella


def statistics(program, *arguments):
    return json.loads(program.succeed("slice", *arguments, "--stats", "-"))["layers"]


@pytest.mark.parametrize(
    "options, keywords",
    [
        ([], {}),
        (["--layer-height", "0.25"], {"layer_height": 0.25}),
        (["--layer-height", "0.2", "--first-layer-height", "0.3"], {"layer_height": 0.2, "first_layer_height": 0.3}),
        (["--slice-at", "top"], {"at": "top"}),
        (["--slice-at", "bottom"], {"at": "bottom"}),
        (["--snap", "0.02"], {"snap": 0.02}),
        (["--z-range", "10:12"], {"z_range": (10, 12)}),
        (["--layers", "3:9"], {"layers": (3, 9)}),
        (["--heights", "0:5=0.2,5:10=0.05"], {"heights": [(0, 5, 0.2), (5, 10, 0.05)]}),
        (["--adaptive", "0.05:0.4", "--cusp", "0.1"], {"adaptive": (0.05, 0.4), "cusp": 0.1}),
        (["--direction", "1,1,2"], {"direction": (1, 1, 2)}),
        (["--direction", "1,0,0"], {"direction": (1, 0, 0)}),
        (["--scale", "2"], {"transform": np.diag([2, 2, 2, 1])}),
        (["--unit", "inch"], {"unit_mm": 25.4, "layer_height": None}),
        (["--unit", "inch", "--direction", "1,2,3", "--layer-height", "5"], {"unit_mm": 25.4, "direction": (1, 2, 3), "layer_height": 5}),
        (["--engine", "eecc", "--layer-height", "2"], {"engine": "eecc", "layer_height": 2}),
    ],
)
def test_layers_are_those_of_the_program(program, rook, options, keywords):
    expected = statistics(program, rook, *options)
    stack = lamella.slice(rook, **keywords)
    assert stack.hashes == [layer["hash"] for layer in expected]
    assert stack.z.tolist() == [layer["z"] for layer in expected]
    assert [layer.index for layer in stack] == [layer["index"] for layer in expected]
    assert stack.area.tolist() == [layer["area_mm2"] for layer in expected]
    assert stack.perimeter.tolist() == [layer["perimeter_mm"] for layer in expected]


def test_layers_of_the_bodies_have_the_hashes_of_the_table(program, bodies):
    with open(ROOT / "tests/fixtures/layer_hashes.tsv", encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader((line for line in table if not line.startswith("#")), delimiter="\t"))
    rows = [row for row in rows if not row["mesh"].startswith("meshes/")]
    assert rows
    for row in rows:
        part = bodies(row["mesh"], *row["options"].split())
        options = ["--layer-height", row["height_mm"], "--rotate", row["rotated"]]
        # The program knows the hash of a whole stack, and this module those of its layers.
        expected = json.loads(program.succeed("slice", part, *options, "--stats", "-"))
        assert (len(expected["layers"]), expected["hash"]) == (int(row["layers"]), row["hash"])
        for threads in (1, 7):
            stack = lamella.slice(part, float(row["height_mm"]), transform=expected["options"].get("matrix"), threads=threads)
            assert stack.hashes == [layer["hash"] for layer in expected["layers"]], row


def test_paths_may_be_text_or_path_objects(rook):
    class OfBytes:
        def __fspath__(self):
            return bytes(rook)

    stack = lamella.slice(rook, 2)
    assert lamella.slice(str(rook), 2) == lamella.slice(OfBytes(), 2) == stack


class LikeTrimesh:
    def __init__(self, vertices, faces):
        self.vertices = vertices
        self.faces = faces


def test_arrays_of_any_kind_are_meshes():
    vertices, faces = box_arrays()
    expected = lamella.slice((vertices, faces), 1)
    assert len(expected) == 10
    for part in [
        [vertices, faces],
        (vertices.tolist(), faces.tolist()),
        (vertices.astype(np.float32), faces.astype(np.int32)),
        (np.asfortranarray(vertices), faces.astype(np.uint64)),
        (np.repeat(vertices, 2, axis=0)[::2], np.asfortranarray(faces)),
        LikeTrimesh(vertices, faces),
        vertices[faces],
        lamella.Mesh(vertices, faces),
    ]:
        assert lamella.slice(part, 1) == expected


def test_vertices_that_are_equal_need_not_be_shared():
    vertices, faces = box_arrays()
    apart = lamella.slice((vertices[faces].reshape(-1, 3), np.arange(36).reshape(-1, 3)), 1)
    assert apart.open_chains.sum() == 0
    assert apart == lamella.slice((vertices, faces), 1)


def test_vertices_without_faces_do_not_count():
    vertices, faces = box_arrays()
    more = np.concatenate([[(-100.0, 0, -7)], vertices, [(0, 0, 99)]])
    mesh = lamella.Mesh(more, faces + 1)
    assert mesh.bounds.tolist() == [[0, 0, 0], [20, 30, 10]] and len(mesh.vertices) == 8
    assert len(lamella.Mesh(np.concatenate([[(np.nan, np.inf, 1e300)], vertices]), faces + 1).vertices) == 8
    with pytest.raises(lamella.InputError, match="^vertex 1 is "):
        lamella.Mesh(np.concatenate([[(np.nan, 0, 0)], vertices * np.inf]), faces + 1)
    assert lamella.slice((more, faces + 1), 1) == lamella.slice((vertices, faces), 1)


def test_a_box_has_the_rings_of_a_box():
    stack = lamella.slice(box_arrays(20, 30, 10), 1)
    assert stack.area.tolist() == [600.0] * 10
    assert stack.perimeter.tolist() == [100.0] * 10
    assert stack.volume == 6000.0
    # Where the plane cuts the diagonals of the walls there are points, too; the corners are among them.
    corners = {(0.0, 0.0), (20.0, 0.0), (20.0, 30.0), (0.0, 30.0)}
    assert all(corners <= set(map(tuple, layer[0])) for layer in stack)


def test_heights_are_absolute_and_offsets_are_not():
    part = box_arrays(z=10.0, at=(0, 0, 5.0))
    assert lamella.slice(part, 1).z.tolist() == [5.5 + i for i in range(10)]
    assert lamella.slice(part, z=[6.0, 7.25]).z.tolist() == [6.0, 7.25]
    assert lamella.slice(part, offsets=np.array([1.0, 2.25])).z.tolist() == [6.0, 7.25]


def test_a_single_height_makes_a_layer_with_a_thickness():
    (layer,) = lamella.slice(box_arrays(), z=[3.0], at="bottom")
    assert (layer.bottom, layer.z, layer.top) == (3.0, 3.0, 3.1)


def test_directions_and_transforms_keep_their_matrix():
    part = nested_boxes()
    transform = np.array([[1, 0, 0, 5], [0, 2, 0, 0], [0, 0, 3, -1], [0, 0, 0, 1.0]])
    stack = lamella.slice(part, 0.5, transform=transform, direction=(0, 1, 0))
    corners = np.c_[part[0], np.ones(len(part[0]))] @ stack.matrix.T
    assert np.allclose(corners.min(axis=0)[:3], stack.bounds[0])
    assert np.allclose(corners.max(axis=0)[:3], stack.bounds[1])
    assert np.isclose(stack.bounds[1][2] - stack.bounds[0][2], 20)
    assert np.isclose(stack.volume, 6 * (1000 - 512 + 64))


def test_what_moves_and_turns_is_put_together_before_it_is_applied():
    part = nested_boxes()
    third = np.diag([1 / 3, 1 / 3, 1 / 3, 1])
    whole = lamella.slice(part, 0.5, transform=third, direction=(1, 2, 3))
    assert lamella.slice(part, 0.5, transform=whole.matrix) == whole


@pytest.mark.parametrize("engine", [engine.name for engine in lamella.engines()])
def test_all_engines_give_the_same(bodies, engine):
    path = bodies("sheet", "--holes", 4, "--segments", 24)
    assert np.allclose(lamella.slice(path, engine=engine).area, lamella.slice(path).area, rtol=1e-9)


def test_the_first_engine_is_the_default(program):
    names = [engine.name for engine in lamella.engines()]
    assert names[0] == "sweep"
    assert len(set(names)) == len(names) > 1


@pytest.mark.parametrize("threads", [1, 2, 7])
def test_threads_leave_no_trace(rook, threads):
    assert lamella.slice(rook, 0.5, threads=threads) == lamella.slice(rook, 0.5)


def test_open_chains_are_kept_and_warned_of():
    with pytest.warns(lamella.DefectWarning, match="the mesh: 10 open chains in 10 of 10 layers") as caught:
        stack = lamella.slice(open_box(), 1)
    assert caught[0].filename == __file__
    assert stack.open_chains.tolist() == [1] * 10
    assert not stack[0].closed.any()
    with pytest.raises(lamella.DefectError, match="the mesh has defects: 4 boundary edges"):
        lamella.slice(open_box(), 1, strict=True)


def test_level_faces_within_rounding_of_a_plane_are_warned_of_and_cut_where_it_snaps():
    vertices, faces = box_arrays()
    bent = np.array(vertices, dtype=float)
    bent[:, 2] += 1e-7 * (1 + np.arange(len(bent)) % 2)
    options = {"z": [0, 1, 2], "at": "bottom"}
    with pytest.warns(lamella.DefectWarning, match="of level faces lie within rounding .*; snap=1e-6 counts them"):
        lamella.slice((bent, faces), **options)
    with pytest.raises(lamella.DefectError, match="level faces lie within rounding .*; snap=1e-6"):
        lamella.slice((bent, faces), **options, strict=True)
    expected = lamella.slice((vertices, faces), **options)
    snapped = lamella.slice((bent, faces), **options, snap=1e-6)
    assert [layer.area for layer in snapped] == pytest.approx([layer.area for layer in expected])
    assert [layer.area for layer in lamella.iter_layers((bent, faces), **options, snap=1e-6)] == pytest.approx(
        [layer.area for layer in expected]
    )
    assert lamella.verify(snapped, (bent, faces), snap=1e-6).ok
    with pytest.raises(lamella.UsageError, match="snap"):
        lamella.slice((vertices, faces), **options, snap=-1)


def test_streamed_layers_are_the_same(rook):
    stack = lamella.slice(rook, 0.5)
    with lamella.iter_layers(rook, 0.5) as layers:
        assert layers.z.tolist() == stack.z.tolist()
        assert (layers.bounds == stack.bounds).all()
        assert len(layers) == len(stack)
        assert next(layers) == stack[0] and len(layers) == len(stack) - 1
        assert list(layers) == list(stack[1:])
        assert len(layers) == 0
        assert list(layers) == []


def test_areas_come_from_the_rings():
    stack = lamella.slice(nested_boxes(), 1)
    for layer in stack:
        assert np.isclose(layer.area, sum(shoelace(ring) for ring in layer))
    assert stack.area.tolist() == [100.0, 36.0, 36.0, 52.0, 52.0, 52.0, 52.0, 36.0, 36.0, 100.0]


def damaged(path):
    """Writes a box without its last triangle, with a triangle twice, one flipped, and a crack at a corner."""
    vertices, faces = box_arrays()
    corners = vertices[faces].copy()
    corners[0] = corners[0, ::-1]
    corners = np.concatenate([corners[:-1], corners[3:4]])
    corners[5, 0] += 1e-3
    rows = [f"facet normal 0 0 0 outer loop {' '.join(f'vertex {x} {y} {z}' for x, y, z in triangle.tolist())} endloop endfacet" for triangle in corners]
    path.write_text("solid damaged\n" + "\n".join(rows) + "\nendsolid damaged\n", encoding="utf-8")
    return path


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
@pytest.mark.parametrize(
    "options, keywords",
    [
        ([], {}),
        (["--weld-tolerance", "0.01"], {"weld_tolerance": 0.01}),
        (["--drop-duplicates"], {"drop_duplicates": True}),
        (["--orient"], {"orient": True}),
        (["--close-gaps", "30"], {"close_gaps": 30}),
        (["--orient", "--direction", "1,2,3"], {"orient": True, "direction": (1, 2, 3)}),
        (
            ["--weld-tolerance", "0.01", "--drop-duplicates", "--orient", "--close-gaps", "50"],
            {"weld_tolerance": 0.01, "drop_duplicates": True, "orient": True, "close_gaps": 50},
        ),
    ],
)
def test_meshes_and_layers_are_mended_as_by_the_program(program, tmp_path, options, keywords):
    part = damaged(tmp_path / "damaged.stl")
    expected = json.loads(program.succeed("slice", part, "--layer-height", "0.7", *options, "--stats", "-"))
    counts = {
        repair: {name: value for name, value in found.items() if name != "places"}
        for repair, found in expected.get("repairs", [{}])[0].items()
        if isinstance(found, dict)
    }
    if "gaps" in expected:
        counts["close_gaps"] = {name: pytest.approx(value) for name, value in expected["gaps"].items()}
        assert expected["gaps"]["closed"] > 0
    hashes = [layer["hash"] for layer in expected["layers"]]
    for threads in (1, 7):
        stack = lamella.slice(part, 0.7, threads=threads, **keywords)
        assert stack.hashes == hashes
        assert stack.repairs == counts
        assert pickle.loads(pickle.dumps(stack)).repairs == counts
        with lamella.iter_layers(part, 0.7, threads=threads, **keywords) as stream:
            assert [layer.hash for layer in stream] == hashes
            assert stream.repairs == counts


def test_mending_leaves_the_mesh_of_the_caller_as_it_is(tmp_path):
    mesh = lamella.read(damaged(tmp_path / "damaged.stl"))
    faces = mesh.faces.tolist()
    with pytest.warns(lamella.DefectWarning):
        assert lamella.slice(mesh, 1, orient=True).repairs["orient"]["flipped_triangles"] > 0
    assert mesh.faces.tolist() == faces


def test_a_mesh_of_which_mending_leaves_nothing_is_an_error():
    vertices, faces = box_arrays()
    both = (vertices, np.concatenate([faces, faces[:, ::-1]]))
    with pytest.raises(lamella.InputError, match="^the mesh: nothing of the mesh is left after its repair$"):
        lamella.slice(both, 1, drop_duplicates=True)


@pytest.mark.parametrize(
    "keywords, error, text",
    [
        ({"close_gaps": 0}, lamella.UsageError, "close_gaps: 0 is not possible; expected a number above 0"),
        ({"weld_tolerance": -1}, lamella.UsageError, "weld_tolerance: -1 is not possible; expected a number above 0"),
        ({"orient": 1}, TypeError, "orient: expected True or False, found 1"),
        ({"drop_duplicates": None}, TypeError, "drop_duplicates: expected True or False, found None"),
    ],
)
def test_what_is_to_be_mended_is_checked(rook, keywords, error, text):
    for function in (lamella.slice, lamella.iter_layers):
        with pytest.raises(error) as raised:
            function(rook, 1, **keywords)
        assert str(raised.value) == text


def test_one_height_needs_no_list():
    assert lamella.slice(box_arrays(), z=5) == lamella.slice(box_arrays(), z=[5])
    assert lamella.slice(box_arrays(), offsets=np.float64(5)) == lamella.slice(box_arrays(), offsets=[5])


def test_a_range_of_layers_may_have_no_end(program, rook):
    stack = lamella.slice(rook, 2, layers=(2, None))
    assert stack.hashes == [layer["hash"] for layer in statistics(program, rook, "--layer-height", "2", "--layers", "2:")]
    with pytest.raises(TypeError, match="^layers: expected a whole number, 0 or more, found None$"):
        lamella.slice(rook, 2, layers=(None, 2))


def test_transforms_that_flatten_a_mesh_are_errors():
    flat = np.diag([0.0, 1, 1, 1])
    turned = np.eye(4)
    turned[:3, :3] = np.diag([1, 0, 1]) @ np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]])
    for matrix in flat, turned, np.diag([1.0, 1, 0, 1]):
        for call in (
            lambda: lamella.slice(box_arrays(), 0.5, transform=matrix),
            lambda: lamella.slice([lamella.Part(box_arrays(), matrix=matrix)], 0.5),
        ):
            with pytest.raises(lamella.UsageError, match="a transform that flattens it"):
                call()
