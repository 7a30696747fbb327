"""Single planes through a mesh that is prepared once: the layers of slicing, and planes of any direction."""

import threading

import numpy as np
import pytest
from conftest import box_arrays, run_python

import lamella


@pytest.fixture(scope="module")
def slicer(rook):
    return lamella.Slicer(rook)


def test_a_level_section_is_the_layer_of_slicing(rook, slicer):
    stack = lamella.slice(rook, 0.7)
    for layer in stack:
        section = slicer.section(layer.z)
        assert section.hash == layer.hash and len(section) == len(layer)
        assert (section.index, section.z, section.bottom, section.top) == (0, layer.z, layer.z, layer.z)
    assert slicer.section(np.float32(5)).area > 0
    assert len(slicer.section(-1)) == 0 and len(slicer.section(1e9)) == 0


def test_the_rule_decides_where_the_plane_meets_a_face():
    vertices, faces = box_arrays()
    top = max(z for _, _, z in vertices)
    assert lamella.Slicer((vertices, faces)).section(top).area == 0
    assert lamella.Slicer((vertices, faces), rule="section_below").section(top).area > 0


def test_a_tilted_section_is_the_layer_along_its_normal(rook, slicer):
    for normal in [(1, 0, 0), (0, -2, 0), (1, 1, 1), (0.1, -0.7, 3)]:
        section = slicer.section(origin=(1, 2, 9), normal=normal)
        unit = np.array(normal) / np.linalg.norm(normal)
        along = lamella.slice(rook, z=[unit @ (1, 2, 9)], direction=normal)[0]
        assert section.layer.area == pytest.approx(along.area, rel=1e-9)
        assert len(section.polylines) == len(section.layer)
        points = np.concatenate(section.polylines)
        assert np.abs((points - (1, 2, 9)) @ unit).max() < 1e-9
        low, high = slicer.mesh.bounds
        assert (points >= low - 1e-9).all() and (points <= high + 1e-9).all()
        for line, ring in zip(section.polylines, section.layer):
            assert len(line) == len(ring)


def test_a_plane_that_misses_the_mesh_gives_nothing(slicer):
    section = slicer.section(origin=(1e6, 0, 0), normal=(1, 0, 0))
    assert section.polylines == [] and len(section.layer) == 0


def test_threads_share_a_slicer(slicer):
    heights = np.linspace(0.3, 20, 50)
    expected = [slicer.section(z).hash for z in heights]
    found = [None] * 4

    def cut(place):
        found[place] = [slicer.section(z).hash for z in heights]

    threads = [threading.Thread(target=cut, args=(place,)) for place in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4


def test_memory_does_not_grow_with_sections(rook):
    code = """
import sys, threading
import numpy as np
import lamella
slicer = lamella.Slicer(sys.argv[1])
def cut(seed):
    for z in np.random.default_rng(seed).uniform(0, 26, 1250):
        slicer.section(z).area
def cut_by_eight(seed):
    threads = [threading.Thread(target=cut, args=(seed + i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmRSS"))
first = cut_by_eight(0)
print(cut_by_eight(8) - first)
"""
    assert int(run_python(code, rook)) < 4096  # kB


def test_what_is_no_plane_is_named(slicer):
    for arguments, text in [
        ({}, "expected z, or origin and normal"),
        ({"origin": (0, 0, 0)}, "expected z, or origin and normal"),
        ({"z": 1, "normal": (0, 0, 1)}, "z contradicts origin and normal"),
        ({"origin": (0, 0), "normal": (0, 0, 1)}, "origin: expected three numbers"),
        ({"origin": (0, 0, 0), "normal": (0, 0, 0)}, "has no direction; expected three numbers"),
        ({"z": float("nan")}, "z: "),
    ]:
        with pytest.raises(lamella.UsageError, match=text):
            slicer.section(**arguments)
    with pytest.raises(TypeError, match="z: "):
        slicer.section("high")
    with pytest.raises(lamella.UsageError, match='rule: "sideways"'):
        lamella.Slicer(box_arrays(), rule="sideways")
    with pytest.raises(lamella.InputError):
        lamella.Slicer("missing.stl")
    assert repr(slicer).startswith("<lamella.Slicer: ")


def test_a_normal_has_a_direction():
    slicer = lamella.Slicer(box_arrays())
    for normal in ((0, 0, 0), np.zeros(3)):
        with pytest.raises(lamella.UsageError, match=r"^normal: \(0, 0, 0\) has no direction; expected three numbers"):
            slicer.section(origin=(0, 0, 0), normal=normal)
    assert slicer.section(origin=np.array([0, 0, 5]), normal=np.array([0, 0, 1])).layer.area == 600
