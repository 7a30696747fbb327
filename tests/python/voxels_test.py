"""Layers as arrays of pixels, and meshes as arrays of voxels, with their position in space."""

import _thread
import copy
import pickle
import threading
import time

import numpy as np
import pytest
from conftest import box_arrays, joined, nested_boxes, open_box

import lamella


def mesh_of_torus(ring=9.0, tube=4.0, steps=64):
    """Vertices and faces of a torus around the z axis."""
    turn = np.arange(steps) * 2 * np.pi / steps
    around, across = np.meshgrid(turn, turn, indexing="ij")
    radius = ring + tube * np.cos(across)
    vertices = np.stack([radius * np.cos(around), radius * np.sin(around), tube * np.sin(across)], axis=-1)
    i, j = np.meshgrid(np.arange(steps), np.arange(steps), indexing="ij")
    a, b = i * steps + j, (i + 1) % steps * steps + j
    c, d = (i + 1) % steps * steps + (j + 1) % steps, i * steps + (j + 1) % steps
    faces = np.concatenate([np.stack([a, b, c], axis=-1).reshape(-1, 3), np.stack([a, c, d], axis=-1).reshape(-1, 3)])
    return vertices.reshape(-1, 3), faces


def centres(voxels):
    """The point at the centre of each voxel, as the documentation defines it."""
    k, j, i = np.indices(voxels.array.shape)
    steps = np.stack([i, j, k], axis=-1) * voxels.spacing
    return np.array(voxels.origin) + steps @ np.reshape(voxels.direction, (3, 3)).T


def within(points, layer):
    """Whether points (n, 2) are within an odd number of rings."""
    found = np.zeros(len(points), dtype=bool)
    x, y = points.T
    for ring in layer:
        for p, q in zip(ring, np.roll(ring, -1, axis=0)):
            if p[1] != q[1]:
                found ^= ((p[1] > y) != (q[1] > y)) & (x < p[0] + (y - p[1]) * (q[0] - p[0]) / (q[1] - p[1]))
    return found


def test_pixels_have_the_volume_of_the_layers():
    stack = lamella.slice(mesh_of_torus(), 0.1)
    pixels = stack.pixels(0.04)
    assert pixels.array.sum(dtype=np.int64) / 255 * 0.04**2 * 0.1 == pytest.approx(stack.volume, rel=1e-6)
    assert pixels.array.dtype == np.uint8 and len(pixels.array) == len(stack)


def test_pixels_lie_where_the_geometry_says():
    stack = lamella.slice(mesh_of_torus(), 1)
    pixels = stack.pixels((0.7, 0.9), dtype=bool)
    assert pixels.array.dtype == bool
    assert pixels.spacing == pytest.approx((0.7, 0.9, 1)) and pixels.origin[2] == pytest.approx(stack.z[0])
    for layer, array, points in zip(stack, pixels.array, centres(pixels)):
        assert np.array_equal(array, within(points[:, :, :2].reshape(-1, 2), layer).reshape(array.shape))
    assert 0 < pixels.array.mean() < 1


def test_rows_ascend_in_y_and_those_of_images_descend():
    stack = lamella.slice(mesh_of_torus(), 1)
    pixels = stack.pixels(0.5)
    for layer, array in zip(stack, pixels.array):
        image = layer.image(0.5, bounds=[(-13, -13), (13, 13)], antialias=64)
        assert np.abs(array[::-1].astype(int) - image).max() <= 1  # sums have another order


def test_pixels_of_a_shifted_grid_are_the_same():
    stack = lamella.slice(mesh_of_torus(), 1)
    pixels = stack.pixels(0.25, origin=(-15, -15), shape=(120, 110)).array
    shifted = stack.pixels(0.25, origin=(-15 + 4 * 0.25, -15 - 6 * 0.25), shape=(120, 110)).array
    assert np.array_equal(pixels[:, :-6, 4:], shifted[:, 6:, :-4]) and pixels.any()


def test_the_origin_is_the_centre_of_the_first_pixel():
    stack = lamella.slice(box_arrays(4, 3, 2, at=(10, 20, 30)), 1)
    pixels = stack.pixels(1)
    assert pixels.array.tolist() == [[[255] * 4] * 3] * 2
    assert pixels.origin == (10.5, 20.5, 30.5) and pixels.spacing == (1, 1, 1)
    half = stack.pixels(1, origin=(10, 20))
    assert half.origin == (10, 20, 30.5) and half.array.shape == (2, 4, 5)
    assert half.array[0, :, 2].tolist() == [128, 255, 255, 128] and half.array[0, 0, 0] == 64
    assert stack.pixels(1, shape=(5, 2)).array[0].tolist() == [[255, 255]] * 3 + [[0, 0]] * 2
    assert not stack.pixels(1, origin=(100, 100), shape=(2, 2)).array.any()


def test_numpy_takes_voxels_in_place_of_their_array():
    pixels = lamella.slice(box_arrays(4, 3, 2), 1).pixels(1)
    assert np.asarray(pixels) is pixels.array and np.sum(pixels) == pixels.array.sum()
    assert np.array(pixels, dtype=float).dtype == float
    again = pickle.loads(pickle.dumps(pixels))
    assert np.array_equal(again.array, pixels.array) and again.spacing == pixels.spacing
    assert copy.copy(pixels).origin == pixels.origin
    assert repr(pixels) == "<lamella.Voxels: 2 x 3 x 4 of uint8>"


def test_layers_without_a_common_distance_have_pixels_but_no_spacing():
    stack = lamella.slice(box_arrays(4, 3, 2), 0.5, first_layer_height=0.8)
    pixels = stack.pixels(1)
    assert pixels.array.shape == (len(stack), 3, 4)
    with pytest.raises(lamella.UsageError, match="^spacing: the layers of this stack have no common distance"):
        pixels.spacing
    assert stack[1:].pixels(1).spacing[2] == pytest.approx(0.5)
    assert stack[1:2].pixels(1).spacing[2] == pytest.approx(0.5)
    assert lamella.Stack([]).pixels(1).array.shape == (0, 1, 1)


def test_pixels_of_a_plate_count_once_where_parts_overlap():
    parts = [lamella.Part(box_arrays(2, 2, 1)), lamella.Part(box_arrays(2, 2, 1, at=(1, 0, 0)))]
    stack = lamella.slice(parts, 1)
    assert stack.pixels(1).array.tolist() == [[[255] * 3] * 2]
    assert stack.parts[1].pixels(1).origin == (1.5, 0.5, 0.5)


def test_voxels_are_the_pixels_of_layers_of_their_height():
    mesh = lamella.Mesh(*mesh_of_torus())
    stack = lamella.slice(mesh, 0.5)
    voxels = lamella.voxels(mesh, (0.4, 0.3, 0.5), labels=False)
    pixels = stack.pixels((0.4, 0.3))
    assert np.array_equal(voxels.array, pixels.array) and voxels.labels == ()
    assert voxels.origin == pytest.approx(pixels.origin) and voxels.spacing == pytest.approx(pixels.spacing)
    numbers = lamella.voxels(mesh, (0.4, 0.3, 0.5))
    assert np.array_equal(numbers.array, (voxels.array >= 128).astype(np.uint8)) and numbers.labels == ("part",)


def test_voxels_have_the_number_of_their_part(tmp_path):
    lamella.write(tmp_path / "left.stl", box_arrays(2, 2, 2))
    right = box_arrays(3, 2, 1, at=(2, 0, 0))
    voxels = lamella.voxels([str(tmp_path / "left.stl"), lamella.Mesh(*right), lamella.Part(right, position=(4, 0, 0), label="far")], 1)
    assert voxels.labels == ("left", "part", "far") and voxels.array.dtype == np.uint8
    assert voxels.array[0].tolist() == [[1, 1, 2, 2, 2, 0, 3, 3, 3]] * 2
    assert voxels.array[1, 0, :3].tolist() == [1, 1, 0]
    pair = lamella.voxels((lamella.Mesh(*right), lamella.Mesh(*right)), 1)
    assert pair.labels == ("part", "part 2") and (pair.array == 1).all()


def test_more_than_255_parts_take_wider_numbers():
    parts = [box_arrays(1, 1, 1, at=(i, 0, 0)) for i in range(256)]
    voxels = lamella.voxels([lamella.Mesh(*part) for part in parts], 1)
    assert voxels.array.dtype == np.uint16 and voxels.array[0, 0].tolist() == list(range(1, 257))
    assert lamella.voxels([lamella.Mesh(*part) for part in parts[:255]], 1).array.dtype == np.uint8


def rotation(axis, degrees):
    axis = np.array(axis) / np.linalg.norm(axis)
    k = np.array([(0, -axis[2], axis[1]), (axis[2], 0, -axis[0]), (-axis[1], axis[0], 0)])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


@pytest.mark.parametrize(
    "direction",
    [np.eye(3), np.diag([-1, -1, 1]), [(0, 0, 1), (1, 0, 0), (0, 1, 0)], np.diag([1, 1, -1]), rotation((1, 2, 3), 40)],
)
def test_voxels_of_any_direction_lie_where_the_geometry_says(direction):
    """A box, tilted so that no face is along the voxels; a point is in it if it is between its faces."""
    tilt = rotation((3, 1, -2), 25)
    vertices, faces = box_arrays(7, 5, 6)
    mesh = (vertices @ tilt.T + (50, -20, 10), faces)
    voxels = lamella.voxels(mesh, (0.5, 0.6, 0.4), direction=direction, labels=False)
    assert np.reshape(voxels.direction, (3, 3)) == pytest.approx(np.array(direction, dtype=float))
    inside = (centres(voxels) - (50, -20, 10)) @ tilt
    depth = np.minimum(inside, np.array([7, 5, 6]) - inside).min(axis=-1)
    assert (voxels.array[depth > 0.5] == 255).all() and (voxels.array[depth < -0.5] == 0).all()
    assert (depth > 0.5).sum() > 300 and (depth < -0.5).sum() > 300
    volume = voxels.array.sum(dtype=np.int64) / 255 * 0.5 * 0.6 * 0.4
    assert volume == pytest.approx(210, rel=0.01)
    same = lamella.voxels(mesh, voxels.spacing, origin=voxels.origin, shape=voxels.array.shape, direction=voxels.direction, labels=False)
    assert np.abs(same.array.astype(int) - voxels.array).max() <= 1 and same.origin == voxels.origin


def test_threads_change_nothing():
    mesh = lamella.Mesh(*mesh_of_torus())
    stack = lamella.slice(mesh, 0.5)
    for dtype in (bool, np.uint8):
        one, three = (stack.pixels(0.3, dtype=dtype, threads=threads).array for threads in (1, 3))
        assert np.array_equal(one, three)
    for labels in (True, False):
        one, three = (lamella.voxels([mesh, lamella.Part(mesh, position=(5, 2, 1))], 0.3, labels=labels, threads=threads).array
                      for threads in (1, 3))
        assert np.array_equal(one, three)


def test_defects_of_the_meshes_are_reported(tmp_path):
    lamella.write(tmp_path / "open.stl", open_box())
    with pytest.warns(lamella.DefectWarning, match="open.stl: .*do not close|open.stl: .*open") as caught:
        lamella.voxels([box_arrays(), tmp_path / "open.stl"], 5)
    assert len(caught) == 1 and caught[0].filename == __file__
    with pytest.warns(lamella.DefectWarning, match="no material"):
        lamella.voxels(box_arrays(inward=True), 5)


def test_hollows_are_empty():
    voxels = lamella.voxels(nested_boxes(), 1)
    assert voxels.array.sum() == 10**3 - 8**3 + 4**3 and voxels.array[1, 1, 1] == 0
    both = lamella.voxels([joined(box_arrays(4, 4, 4)), lamella.Part(box_arrays(2, 2, 2, at=(1, 1, 1)), role="negative")], 1)
    assert both.array.sum() == 4**3 - 2**3


def test_the_memory_is_checked_before_it_is_taken():
    stack = lamella.slice(box_arrays(), 5)
    with pytest.raises(lamella.LimitError, match="^an array of 40 x 60 x 2 voxels takes 4.8 kB of memory, above the 4.0 kB of `?max_memory"):
        stack.pixels(0.5, max_memory=4000)
    with pytest.raises(lamella.LimitError, match="TB|GB"):
        lamella.voxels(box_arrays(), 0.0005)


WRONG = [
    (lambda stack: stack.pixels(0), "pixel_size: 0 is not possible; expected a number above 0"),
    (lambda stack: stack.pixels(1e-9), "pixel_size: 2e+10 x 3e+10 along x, y are too many; there may be 65535 rows and columns"),
    (lambda stack: stack.pixels(1, shape=(70000, 1)), "shape: 1 x 70000 along x, y are too many; there may be 65535 rows and columns"),
    (lambda stack: stack.pixels(1, shape=(0, 1)), "shape: 0 is not possible; expected a whole number from 1 to 2147483646"),
    (lambda stack: stack.pixels(1, dtype=np.float32), "dtype: float32 is not possible; expected bool or numpy.uint8"),
    (lambda stack: stack.pixels(1, origin=(1, 2, 3)), "origin: expected two numbers (x, y), found 3 values"),
    (lambda stack: lamella.voxels([], 1), "meshes: expected a mesh or several, found none"),
    (lambda stack: lamella.voxels(box_arrays(), (1, 2)), "spacing: expected one length, or three (x, y, z), found 2 values"),
    (lambda stack: lamella.voxels(box_arrays(), 1, shape=(1, 2)), "shape: expected three whole numbers (layers, rows, columns), found 2 values"),
    (lambda stack: lamella.voxels(box_arrays(), 1, direction=np.eye(4)),
     "direction: expected nine numbers, or an array of the shape (3, 3), found (4, 4) of float64"),
    (lambda stack: lamella.voxels(box_arrays(), 1, direction=np.diag([1, 2, 1])),
     "direction: expected a matrix whose columns have the length 1 and are perpendicular to each other"),
    (lambda stack: lamella.voxels(lamella.Part(box_arrays()), 1, unit_mm=2), "unit_mm: each part has its own, such as lamella.Part(..., unit_mm=25.4)"),
    (lambda stack: lamella.voxels(box_arrays(), 1, origin=(0, 0, 1e20)), "voxels 1 mm high at z = 1e+20 mm are too low for double precision"),
]  # fmt: skip


@pytest.mark.parametrize("call, text", WRONG)
def test_wrong_arguments_are_named(call, text):
    stack = lamella.slice(box_arrays(), 5)
    with pytest.raises(lamella.UsageError) as caught:
        call(stack)
    assert str(caught.value) == text


class Stop(Exception):
    pass


def raise_it(*_):
    raise Stop


def test_progress_is_reported_and_may_stop_the_work():
    mesh = lamella.Mesh(*mesh_of_torus())
    stack = lamella.slice(mesh, 0.01)
    stages = []
    stack.pixels(0.1, progress=lambda stage, done, total: stages.append((stage, done, total)))
    assert stages[-1] == ("polygon", len(stack), len(stack))
    with pytest.raises(Stop):
        stack.pixels(0.02, progress=raise_it)
    with pytest.raises(Stop):
        lamella.voxels(mesh, 0.02, progress=raise_it)


@pytest.mark.parametrize("work", [lambda mesh, stack: lamella.voxels(mesh, 0.02), lambda mesh, stack: stack.pixels(0.02)])
def test_ctrl_c_stops_the_work(work):
    mesh = lamella.Mesh(*mesh_of_torus())
    stack = lamella.slice(mesh, 0.01)
    timer = threading.Timer(0.1, _thread.interrupt_main)
    timer.start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(20):
            work(mesh, stack)
    timer.join()
    assert time.monotonic() - began < 20
