"""Layers and stacks: their arrays, how long these live, and how they travel."""

import copy
import copyreg
import gc
import inspect
import mmap
import multiprocessing
import pickle

import numpy as np
import pytest
from conftest import box_arrays, nested_boxes, open_box, shoelace

import lamella


@pytest.fixture
def layer():
    """Of three rings within one another."""
    return lamella.slice(nested_boxes(), 1)[5]


def test_shapes_and_types(layer):
    assert layer.points.dtype == np.float64 and layer.points.shape == (layer.offsets[-1], 2)
    assert layer.offsets.dtype == np.int64 and layer.offsets.shape == (len(layer) + 1,)
    assert layer.closed.dtype == np.bool_ and layer.closed.shape == (len(layer),)
    assert layer.parent.dtype == np.int64 and layer.parent.shape == (len(layer),)
    assert layer.hatches.shape == (0, 2, 2)
    assert layer.rings == len(layer) == 3


def test_contours_are_pieces_of_the_points(layer):
    for i, contour in enumerate(layer):
        assert np.shares_memory(contour, layer.points)
        assert (contour == layer.points[layer.offsets[i] : layer.offsets[i + 1]]).all()
    assert (layer[-1] == layer[2]).all()
    for index in (3, -4):
        with pytest.raises(IndexError):
            layer[index]


@pytest.mark.parametrize("give", [lambda mesh: lamella.slice(mesh, 0.01), lambda mesh: list(lamella.iter_layers(mesh, 0.01))])
def test_what_is_kept_of_a_layer_keeps_no_other_layer_in_memory(give):
    # A cylinder: 1,000 layers, 16 MB.
    turns = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    rim = np.column_stack([np.cos(turns), np.sin(turns)])
    vertices = np.concatenate([np.column_stack([rim, np.full(1000, z)]) for z in (0, 10)])
    this = np.arange(1000)
    following = np.roll(this, -1)
    cap = np.array([(0, i, i + 1) for i in range(1, 999)])
    faces = np.concatenate([
        np.column_stack([this, following, following + 1000]), np.column_stack([this, following + 1000, this + 1000]), cap[:, ::-1], cap + 1000,
    ])  # fmt: skip
    mesh = lamella.Mesh(vertices, faces)

    def kept(rounds):
        return [give(mesh)[500][0] for _ in range(rounds)]

    def resident():
        with open("/proc/self/statm") as figures:
            return int(figures.read().split()[1]) * mmap.PAGESIZE

    first = kept(4)  # what is free afterwards is used again
    before = resident()
    more = kept(16)
    assert resident() - before < 64e6  # of 256 MB
    assert all((contour == first[0]).all() for contour in more)


def test_arrays_are_not_copies_and_cannot_be_written(layer):
    for name in ("points", "offsets", "parent"):
        array = getattr(layer, name)
        assert np.shares_memory(array, getattr(layer, name))
        assert not array.flags.owndata and not array.flags.writeable
        with pytest.raises(ValueError):
            array[0] = 0
        with pytest.raises(ValueError):
            array.setflags(write=True)


def test_arrays_outlive_everything_else():
    mesh = lamella.Mesh(*nested_boxes())
    vertices, faces = mesh.vertices, mesh.faces
    stack = lamella.slice(mesh, 1)
    layer = stack[5]
    arrays = {name: getattr(layer, name) for name in ("points", "offsets", "parent", "closed")}
    arrays["ring"] = layer[1]
    arrays["part"] = layer.points[3:7, 1]
    kept = {name: array.copy() for name, array in arrays.items()}
    kept_vertices, kept_faces = vertices.copy(), faces.copy()
    del mesh, stack, layer
    gc.collect()
    # What was freed would be used again by these.
    others = [lamella.slice(nested_boxes(), 0.01) for _ in range(3)]
    for name, array in arrays.items():
        assert (array == kept[name]).all(), name
    assert (vertices == kept_vertices).all() and (faces == kept_faces).all()
    del others


def test_parents_are_the_rings_around(layer):
    areas = [shoelace(ring) for ring in layer]
    outer, hole, inner = (int(np.argmin(np.abs(np.array(areas) - area))) for area in (100, -64, 16))
    assert layer.parent[outer] == -1
    assert layer.parent[hole] == outer
    assert layer.parent[inner] == hole
    assert sorted(layer.polygons()) == sorted([(outer, [hole]), (inner, [])])


@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_chains_have_no_parent():
    layer = lamella.slice(open_box(), 1)[0]
    assert layer.parent.tolist() == [-1]
    assert layer.closed.tolist() == [False]
    assert (layer.rings, layer.open_chains, layer.area) == (0, 1, 0)


def test_an_empty_layer_has_empty_arrays():
    layer = lamella.Layer([], z=1.0)
    assert layer.points.shape == (0, 2)
    assert layer.offsets.tolist() == [0]
    assert layer.parent.shape == layer.closed.shape == (0,)
    assert list(layer) == []
    assert pickle.loads(pickle.dumps(layer)) == layer


def test_layers_are_made_of_arrays():
    square = np.array([(0, 0), (4, 0), (4, 4), (0, 4)], float)
    hole = np.array([(1, 1), (1, 2), (2, 2), (2, 1)])
    chain = [(5, 5), (6, 6)]
    layer = lamella.Layer([hole, np.roll(square, 1, axis=0)], z=2.0, bottom=1.5, top=2.5, index=7, chains=[chain])
    assert (layer.index, layer.z, layer.bottom, layer.top, layer.thickness) == (7, 2.0, 1.5, 2.5, 1.0)
    assert (layer[0] == square).all(), "in normal form the smallest point is the first"
    assert layer.closed.tolist() == [True, True, False]
    assert (layer.area, layer.perimeter) == (15.0, 20 + np.sqrt(2))
    assert layer.parent.tolist() == [-1, 0, -1]
    for wrong in ([[1, 2, 3]], [np.zeros((3, 3))], [np.full((3, 2), np.nan)]):
        with pytest.raises(lamella.Error):
            lamella.Layer(wrong, z=0)
    for heights in ({"z": np.nan}, {"z": 1, "bottom": 2}, {"z": 1, "top": 0.5}):
        with pytest.raises(lamella.UsageError):
            lamella.Layer([square], **heights)


def test_contours_are_cleaned(tmp_path):
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    plain = lamella.Layer([square], z=0.5, bottom=0, top=1, chains=[[(5, 5), (6, 6)]])
    repeating = [square[0], *np.repeat(square, 2, axis=0), square[0]]
    for ring in (repeating, [*square, square[0]]):
        layer = lamella.Layer(
            [ring, [(1, 1), (2, 2), (1, 1)], [(7, 7)]], 0.5, 0, 1, chains=[[(5, 5), (6, 6), (6, 6)], [(8, 8), (8, 8)]]
        )
        assert layer == plain
        lamella.write(tmp_path / "layer.json", layer)
        assert lamella.read(tmp_path / "layer.json")[0] == layer


def with_state(thing, change):
    """A pickled thing, some of whose state is something else."""
    make, arguments, state = thing.__reduce_ex__(2)[:3]
    changed = list(state)
    for place, value in change.items():
        changed[place] = value
    made = make(*arguments)
    made.__setstate__(tuple(changed))
    return made


def test_hatch_lines_that_are_left_out_are_warned_of(layer):
    hatched = with_state(layer, {7: np.array([(1.0, 1), (2, 2), (1, 2), (2, 3)])})
    assert len(hatched.hatches) == 2
    other = lamella.Layer([[(0, 0), (1, 0), (0, 1)]], z=0)
    made = [lambda: hatched.offset(0.1), lambda: hatched.union(other), lambda: other.union(hatched),
            lambda: hatched.intersection(other), lambda: hatched.difference(other),
            lambda: hatched.symmetric_difference(other)]  # fmt: skip
    for make in made:
        with pytest.warns(lamella.DefectWarning, match="^2 hatch lines left out") as caught:
            assert len(make().hatches) == 0
        assert caught[0].filename == __file__
    for same in (hatched.offset(0), hatched.filled(), hatched.simplified(0)):  # warns of nothing
        assert same == hatched


def test_equality_and_hashes(layer):
    again = lamella.slice(nested_boxes(), 1)
    assert layer == again[5] and layer is not again[5]
    assert layer != again[4] and layer != 5
    assert len({layer, again[5], again[4]}) == 2
    assert len(layer.hash) == 16 and int(layer.hash, 16) >= 0
    lower, upper = (lamella.Layer([[(0, 0), (1, 0), (0, 1)]], z=z) for z in (1, 2))
    assert lower.hash == upper.hash, "hashes are of contours"
    assert lower != upper, "but layers at other heights are others"


def test_what_can_be_made_of_a_layer():
    overlapping = lamella.Layer([np.array([(0, 0), (4, 0), (4, 4), (0, 4.0)]) + shift for shift in (0, 2)], z=0)
    assert overlapping.area == 32
    assert np.isclose(overlapping.filled().area, 28)
    assert np.isclose(overlapping.filled("evenodd").area, 24)
    square = lamella.Layer([[(0, 0), (2, 0), (4, 0), (4, 4), (0, 4)]], z=0)
    assert np.isclose(square.offset(1).area, 36)
    assert np.isclose(square.offset(-1).area, 4)
    assert np.isclose(square.offset(1, "bevel").area, 34)
    assert np.isclose(square.offset(1, corners="round").area, 32 + np.pi, atol=0.01)
    with pytest.raises(lamella.UsageError, match='"sharp" is none of "mitre", "bevel" and "round"'):
        square.offset(1, "sharp")
    assert len(square.simplified(0.01).points) == 4
    other = lamella.Layer([[(3, 1), (9, 1), (9, 2), (3, 2)]], z=5)
    for name, area in [("union", 21), ("intersection", 1), ("difference", 15), ("symmetric_difference", 20)]:
        made = getattr(square, name)(other)
        assert np.isclose(made.area, area) and made.z == 0
    assert square.intersection(square) == square
    with pytest.raises(lamella.UsageError, match='"zigzag" is none of "nonzero", "evenodd" and "positive"'):
        square.filled("zigzag")


def test_stacks_are_sequences():
    stack = lamella.slice(box_arrays(), 1)
    assert len(stack) == len(list(stack)) == 10
    assert stack[0] == next(iter(stack)) and stack[-1] == stack[9]
    assert stack[0] in stack
    assert [layer.z for layer in reversed(stack)] == stack.z.tolist()[::-1]
    assert stack[2:8:3].z.tolist() == [2.5, 5.5]
    assert isinstance(stack[2:4], lamella.Stack) and len(stack[4:2]) == 0
    with pytest.raises(IndexError):
        stack[10]
    with pytest.raises(ValueError):
        stack[::-1]
    assert lamella.Stack(list(stack)) == stack
    with pytest.raises(lamella.UsageError, match="ascend"):
        lamella.Stack([stack[1], stack[0]])


def test_stacks_are_indexed_as_arrays():
    stack = lamella.slice(nested_boxes(), 1)
    layers = np.array([layer.index for layer in stack])
    chosen = [1, 4, 5], [0, -1], [], np.array([2, 3], dtype=np.uint8), stack.z > 4, (stack.z > 4).tolist(), np.arange(10)
    for index in chosen:
        some = stack[index]
        expected = layers[index] if len(index) else []
        assert isinstance(some, lamella.Stack) and [layer.index for layer in some] == list(expected)
        assert (some.bounds == stack.bounds).all() and some.matrix.tolist() == stack.matrix.tolist()
    for index in ([10], [-11], np.ones(9, dtype=bool)):
        with pytest.raises(IndexError):
            stack[index]
    for index in ([3, 3], [2, 1], [0, -10], [0.5], [[1, 2]], ["a"]):
        with pytest.raises(lamella.UsageError, match="^index: expected whole numbers that ascend"):
            stack[index]


def test_parts_are_indexed_with_their_stack(tmp_path):
    stack = lamella.slice(nested_boxes(), 1)
    lamella.write(tmp_path / "two.json", [stack, stack])
    both = lamella.read_layers(tmp_path / "two.json")[[1, 7]]
    assert [part.z.tolist() for part in both.parts] == [[1.5, 7.5]] * 2


def test_the_layer_at_a_height_is_found():
    stack = lamella.slice(nested_boxes(), 1)[1:]
    for z, index in [(1, 1), (1.2, 1), (2, 2), (9.999, 9), (10, 9)]:
        assert stack.at(z).index == index
    for z in (0.99, 10.01, -1):
        with pytest.raises(lamella.UsageError, match="they reach from 1 to 10 mm"):
            stack.at(z)
    with pytest.raises(lamella.UsageError, match="the stack is empty"):
        stack[:0].at(1)
    flat = lamella.slice(nested_boxes(), z=[1, 2])
    assert flat.at(2) == flat[1]


def test_operators_combine_layers():
    one, other = lamella.slice(nested_boxes(), 1)[4], lamella.Layer([[(0, 0), (5, 0), (5, 5), (0, 5)]], 4.5)
    assert one | other == one.union(other) and one & other == one.intersection(other)
    assert one - other == one.difference(other) and one ^ other == one.symmetric_difference(other)
    with pytest.raises(TypeError):
        one | 5


def test_stacks_have_arrays_over_their_layers():
    stack = lamella.slice(nested_boxes(), 1)
    for name in ("z", "bottom", "top", "area", "perimeter", "open_chains"):
        assert getattr(stack, name).tolist() == [getattr(layer, name) for layer in stack]
    assert stack.contours.tolist() == [len(layer) for layer in stack]
    assert stack.point_counts.tolist() == [len(layer.points) for layer in stack]
    assert np.isclose(stack.volume, (stack.area * (stack.top - stack.bottom)).sum())


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_pickled_layers_are_the_same(layer, protocol):
    assert pickle.loads(pickle.dumps(layer, protocol)) == layer
    stack = lamella.slice(nested_boxes(), 1, direction=(1, 0, 0))
    travelled = pickle.loads(pickle.dumps(stack, protocol))
    assert travelled == stack
    assert (travelled.matrix == stack.matrix).all() and (travelled.bounds == stack.bounds).all()
    assert travelled.label == stack.label
    mesh = lamella.Mesh(*nested_boxes())
    assert lamella.slice(pickle.loads(pickle.dumps(mesh, protocol)), 1) == lamella.slice(mesh, 1)


def test_what_cannot_be_pickled_so_is_a_type_error(layer):
    """pybind11's own way of doing it ends the process."""
    strategy = lamella.ScanStrategy()
    (scanned,) = lamella.scan([layer], strategy)
    things = [layer, lamella.Stack([layer]), lamella.Mesh(*nested_boxes()), strategy, strategy.hatch, strategy.support,
              strategy.hatch.parameters, scanned.exposures[0], scanned.figures[0]]  # fmt: skip
    with lamella.iter_layers(nested_boxes(), 1) as stream:
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            with pytest.raises(TypeError):
                pickle.dumps(stream, protocol)
        for thing in (*things, stream):
            for reduce in (thing.__reduce__, lambda thing=thing: copyreg._reduce_ex(thing, 0)):
                with pytest.raises(TypeError):
                    reduce()


@pytest.mark.parametrize("base", [lamella.Stack, lamella.Layer, lamella.Mesh, lamella.LayerStream, lamella.Exposure,
                                  lamella.ScanFigures, lamella.ParameterSet, lamella.HatchRule, lamella.ContourRule,
                                  lamella.SkinRule, lamella.SupportRule, lamella.ScanStrategy])  # fmt: skip
def test_objects_that_are_not_made_yet_are_a_type_error(base):
    class Early(base):
        pass

    early = Early.__new__(Early)
    for name in [name for name in dir(base) if isinstance(getattr(base, name), property)]:
        with pytest.raises(TypeError, match="has not been called"):
            getattr(early, name)


def test_copies_are_the_same(layer):
    assert copy.copy(layer) == copy.deepcopy(layer) == layer


def test_pickles_of_something_else_are_refused(layer):
    stack = lamella.Stack([layer])
    mesh = lamella.Mesh(*nested_boxes())
    points = layer.points
    for thing, place, values in [
        (layer, 1, [np.nan, layer.top + 1, "high"]),
        (layer, 2, [-np.inf, np.nan]),
        (layer, 3, [np.inf, None]),
        (layer, 4, [points + np.inf, points[:, 0], points.reshape(-1, 1), points.reshape(-1, 4), points.astype(str), None]),
        (layer, 5, [np.array([0, 99]), np.array([0, 8, 4, 24]), np.array([0.0, 4.5, 8, 24]), layer.offsets.reshape(2, 2)]),
        (layer, 6, [4, -1]),
        (layer, 7, [points[:3], points[0]]),
        (stack, 0, [[None], [layer, layer], [5]]),
        (stack, 2, [np.full((2, 3), np.inf) * [[-1], [1]], np.zeros((3, 2))]),
        (stack, 3, [np.diag([1, 1, np.nan, 1]), np.zeros((4, 4))]),
        (stack, 9, [[None], [lamella.Stack([])]]),
        (stack, 10, [5]),
        (mesh, 0, [mesh.vertices[:, :2], mesh.vertices.ravel(), mesh.vertices * np.nan]),
        (mesh, 1, [mesh.faces + 99, mesh.faces[:, :2], mesh.faces.astype(float), mesh.faces.astype(np.int64) - 1]),
        (mesh, 9, [5, {"orient": 5}]),
        (mesh, 10, [np.diag([1, 1, np.inf, 1])]),
    ]:  # fmt: skip
        for value in values:
            with pytest.raises(lamella.Error):
                with_state(thing, {place: value})
    for thing in (layer, stack, mesh):
        with pytest.raises(lamella.InputError, match="this is no pickled"):
            type(thing).__new__(type(thing)).__setstate__(())


def area_of(layer):
    return layer.area


def test_layers_travel_between_processes():
    stack = lamella.slice(nested_boxes(), 1)
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map(area_of, stack) == stack.area.tolist()


def test_they_say_what_they_are(rook):
    stack = lamella.slice(rook, 10)
    assert repr(stack) == "<lamella.Stack of 5 layers from z = 0 to 50 mm: 5 contours, " + str(stack.point_counts.sum()) + " points>"
    assert repr(stack[0]).startswith("<lamella.Layer 0 at z = 5 mm: 1 contours, ")
    assert repr(lamella.read(rook)) == f"<lamella.Mesh of 94080 triangles, 31.75 x 31.75 x 53.15 mm, from {rook}>"
    assert repr(lamella.iter_layers(rook, 10)) == "<lamella.LayerStream: 5 of 5 layers left>"


def test_layers_of_files_that_round_heights_are_pickled(tmp_path):
    mesh = lamella.Mesh([[0, 0, 0.7], [5, 0, 0.7], [0, 5, 0.7], [0, 0, 2.7]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    lamella.write(tmp_path / "a.svg", lamella.slice(mesh, 0.1, at="bottom"))
    read = lamella.read(tmp_path / "a.svg")
    assert all(layer.bottom <= layer.z <= layer.top for layer in read)
    assert pickle.loads(pickle.dumps(read)) == read


def ring_with_a_hole():
    square = np.array([(0, 0), (8, 0), (8, 6), (0, 6)], dtype=float)
    return lamella.Layer([square, (square[::-1] / 4) + (2, 2)], z=1, bottom=0.5, top=1.5)


def test_bounds_and_areas_are_those_of_the_contours():
    layer = ring_with_a_hole()
    assert layer.bounds.tolist() == [[0, 0], [8, 6]]
    assert layer.areas.tolist() == [48, -3] and layer.areas.sum() == layer.area
    chain = lamella.Layer([], 1, chains=[[(1, 2), (3, 4)]])
    assert chain.bounds.tolist() == [[1, 2], [3, 4]] and chain.areas.tolist() == [0]
    assert np.isnan(lamella.Layer([], 1).bounds).all() and lamella.Layer([], 1).areas.shape == (0,)
    stack = lamella.slice(nested_boxes(), 1)
    assert np.array_equal(np.max([layer.bounds for layer in stack], axis=0)[1], stack.bounds[1, :2])


def test_offsets_by_several_distances_are_those_one_by_one():
    layer = ring_with_a_hole()
    distances = [-0.5, 0, 0.25, -9]
    for corners in ("mitre", "bevel", "round"):
        several = layer.offset(np.array(distances), corners, arc_tolerance=0.01)
        assert several == [layer.offset(distance, corners, arc_tolerance=0.01) for distance in distances]
    assert layer.offset([]) == [] and layer.offset(0) == layer


def test_corners_of_offsets_have_limits():
    layer = lamella.Layer([[(0, 0), (8, 0), (0, 8)]], 1)  # corners of 90 and of 45 degrees
    sharp = layer.offset(1, mitre_limit=4)
    assert layer.offset(1).area < sharp.area
    assert layer.offset(1, mitre_limit=1).area < layer.offset(1).area
    assert len(layer.offset(1, "round", arc_tolerance=0.1).points) < len(layer.offset(1, "round").points)
    with pytest.raises(lamella.UsageError, match="^mitre_limit: 0.5 is not possible; expected a number, 1 or more$"):
        layer.offset(1, mitre_limit=0.5)
    with pytest.raises(lamella.UsageError, match="^arc_tolerance: 0 is not possible; expected a number above 0$"):
        layer.offset(1, arc_tolerance=0)


def test_images_have_the_area_of_the_material():
    layer = ring_with_a_hole()
    pixels = layer.image(0.5)
    assert pixels.shape == (12, 16) and pixels.dtype == np.uint8
    assert pixels.sum() == 255 * layer.area / 0.25
    assert pixels[-1, 0] == 255 and pixels[-5, 5] == 0  # y = 0.25 and x = 2.75, y = 2.25
    tilted = lamella.Layer([[(0, 0), (8, 0), (0, 6)]], 1)
    assert tilted.image((0.1, 0.2)).shape == (30, 80)
    assert tilted.image((0.1, 0.2)).sum() * 0.02 / 255 == pytest.approx(24, rel=1e-3)
    assert set(np.unique(tilted.image(0.1, antialias=1))) == {0, 255}


def test_images_of_the_same_bounds_have_the_same_pixels():
    layer = ring_with_a_hole()
    shifted = layer.image(0.5, bounds=[(-1, -1), (9, 8)])
    assert shifted.shape == (18, 20)
    assert np.array_equal(shifted[4:16, 2:18], layer.image(0.5)) and shifted.sum() == layer.image(0.5).sum()
    stack = lamella.slice(nested_boxes(), 1)
    assert {layer.image(0.3, bounds=stack.bounds).shape for layer in stack} == {(34, 34)}
    assert lamella.Layer([], 1).image(1).shape == (0, 0)
    assert lamella.Layer([], 1).image(1, bounds=[(0, 0), (3, 2)]).tolist() == [[0] * 3] * 2
    for wrong in ([(0, 0)], [(9, 0), (0, 9)], [(0, 0), (1, np.inf)]):
        with pytest.raises(lamella.UsageError, match="^bounds: "):
            layer.image(1, bounds=wrong)
    with pytest.raises(lamella.UsageError, match="^pixel_mm: 8e.06 x 6e.06 pixels are too many"):
        layer.image(1e-6)
    with pytest.raises(lamella.UsageError, match="^pixel_mm: "):
        layer.image(5e-324)


def test_classes_are_named_as_users_find_them():
    for name in ("Layer", "Stack", "Mesh", "LayerStream", "ScanStrategy", "HatchRule", "ParameterSet", "Exposure"):
        cls = getattr(lamella, name)
        assert (cls.__module__, cls.__qualname__) == ("lamella", name)
    layer = ring_with_a_hole()
    assert b"_lamella" not in pickle.dumps(layer)
    assert list(inspect.signature(lamella.Layer).parameters) == ["rings", "z", "bottom", "top", "index", "chains"]
    assert list(inspect.signature(lamella.Mesh).parameters) == ["vertices", "faces"]
    assert inspect.signature(lamella.HatchRule).parameters["pattern"].default == "stripes"


def test_numbers_of_numpy_are_indices():
    stack = lamella.slice(nested_boxes(), 1)
    assert stack[stack.area.argmax()] == stack[0] and stack[np.int32(2)] == stack[2]
    assert stack[5][np.int64(1)].tolist() == stack[5][1].tolist()
