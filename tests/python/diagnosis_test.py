"""Where defects of meshes and contours are: what the program finds, and verify."""

import json

import numpy as np
import pytest
from conftest import box_arrays, joined, open_box

import lamella


def crossing_boxes():
    """Two boxes that pass through each other, the second one inside out, and a triangle twice."""
    vertices, faces = joined(box_arrays(), box_arrays(5, 5, 30, at=(3, 3, -5), inward=True))
    return vertices, np.concatenate([faces, faces[:1]])


@pytest.mark.parametrize("body", [open_box, crossing_boxes])
@pytest.mark.parametrize("threads", [1, 7])
def test_defects_and_their_places_are_those_of_the_program(program, tmp_path, body, threads):
    lamella.write(tmp_path / "body.stl", lamella.Mesh(*body()))
    expected = json.loads(program.succeed("info", tmp_path / "body.stl", "--json", "--self-intersections"))
    found = lamella.inspect(tmp_path / "body.stl", self_intersections=True, threads=threads)
    for kind, count in expected["defects"].items():
        if hasattr(found, kind):
            assert getattr(found, kind) == count
    for kind, places in expected["places"].items():
        here = found.places[kind]
        assert len(here) == len(places)
        if kind == "boundary_loops":
            assert [loop[0].tolist() for loop in here] == [loop["start"] for loop in places]
            assert [len(loop) for loop in here] == [loop["edges"] for loop in places]
        else:
            assert np.array_equal(here, np.reshape(places, np.shape(here)))
    met = expected["self_intersections"]
    assert found.self_intersections[:4] == tuple(met[key] for key in ("crossing", "overlapping", "touching", "flat_triangles"))
    assert [list(one.triangles) for one in found.self_intersections.first] == [one["triangles"] for one in met["first"]]
    assert [(one.kind, list(one.at)) for one in found.self_intersections.first] == [(one["kind"], one["at"]) for one in met["first"]]


def test_places_are_bounded_and_counts_complete():
    mesh = lamella.Mesh(*crossing_boxes())
    found = lamella.inspect(mesh, self_intersections=True, keep=1)
    assert len(found.self_intersections.first) == 1, "of those that cross or overlap; none touch"
    assert found.self_intersections.crossing > 2 and found.duplicate_triangles == 1
    row = found.places["duplicate_triangles"][0]
    assert set(mesh.faces[row].tolist()) == set(mesh.faces[0].tolist())
    assert lamella.inspect(mesh).self_intersections is None
    inside_out = lamella.inspect(box_arrays(inward=True))
    assert inside_out.places["inverted_shells"].tolist() == [[[0, 0, 0], [20, 30, 10]]]


def square(x, y, side):
    return np.array([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], dtype=float)


def test_a_layer_tells_which_contour_is_defective_and_where():
    rings = [square(0, 0, 10), square(2, 2, 3), square(20, 0, 5)[::-1], square(9, 9, 4)]
    layer = lamella.Layer(rings, 1, 0, 2, chains=[[(40, 1), (50, 1)]])
    found = layer.diagnose()
    by_kind = {}
    for defect in found:
        by_kind.setdefault(defect.kind, []).append(defect)
    assert {kind: len(defects) for kind, defects in by_kind.items()} == {"open": 1, "crossing": 2, "misoriented": 1, "overlapping": 2}
    counted = lamella.verify(lamella.Stack([layer]))
    assert (counted.open_chains, counted.crossings, counted.misoriented, counted.overlapping) == (1, 2, 1, 2)
    (chain,) = by_kind["open"]
    assert not layer.closed[chain.contour] and chain.at == (40, 1) and chain.other == chain.contour
    (clockwise,) = by_kind["misoriented"]
    assert layer[clockwise.contour].min(axis=0).tolist() == [20, 0]
    assert sorted(defect.at for defect in by_kind["crossing"]) == [(9, 10), (10, 9)]
    one, other = by_kind["crossing"][0].contour, by_kind["crossing"][0].other
    assert {tuple(layer[one].min(axis=0)), tuple(layer[other].min(axis=0))} == {(0, 0), (9, 9)}
    assert lamella.Layer([square(0, 0, 10)], 1).diagnose() == []


def test_rounding_may_invert_a_thin_ring():
    layer = lamella.Layer([[(0, 0), (10, 1e-3), (10, 0)]], 1)
    assert [defect.kind for defect in layer.diagnose()] == ["misoriented"]
    assert layer.diagnose(resolution=0.01) == []


def test_crossings_that_are_not_listed_are_counted():
    layer = lamella.Layer([square(0, 0, 10)], 1, chains=[[(-1, 1), (11, 1), (11, 2), (-1, 2)]])
    with pytest.warns(lamella.DefectWarning, match="^the layer at z = 1 mm has 4 crossings; 1 of them are listed$"):
        assert [defect.kind for defect in layer.diagnose(crossings=1)] == ["open", "crossing"]
