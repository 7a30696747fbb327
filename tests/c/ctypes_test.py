"""The C interface from Python's ctypes, as from any language that calls C.

usage: ctypes_test.py SHARED_LIBRARY
"""

import ctypes
import sys
import tempfile
import unittest
from ctypes import POINTER, byref, c_char_p, c_double, c_size_t, c_uint32, c_uint64, c_void_p
from pathlib import Path


class Layer(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("index", c_uint64), ("z", c_double), ("bottom", c_double), ("top", c_double), ("points", POINTER(c_double)),
                ("point_count", c_size_t), ("offsets", POINTER(c_uint64)), ("contour_count", c_size_t), ("rings", c_size_t),
                ("area_mm2", c_double)]


class Ctypes(unittest.TestCase):
    def test_a_pyramid_is_sliced_and_written(self):
        vertices = (c_double * 15)(0, 0, 0, 8, 0, 0, 8, 8, 0, 0, 8, 0, 4, 4, 4)
        triangles = (c_uint32 * 18)(0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4)
        mesh, layers, layer = c_void_p(), c_void_p(), Layer(ctypes.sizeof(Layer))
        self.call("make_mesh", vertices, c_size_t(5), triangles, c_size_t(6), byref(mesh))
        self.call("slice", mesh, c_double(2), None, byref(layers))
        self.assertEqual(LIBRARY.lamella_layer_count(layers), 2)
        self.call("get_layer", layers, c_size_t(0), byref(layer))
        self.assertEqual(layer.points[0:8], [1, 1, 7, 1, 7, 7, 1, 7])
        self.assertEqual((layer.z, layer.bottom, layer.top, layer.rings, layer.area_mm2), (1, 0, 2, 1, 36))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "pyramid-\u00e9.svg"
            self.call("write_layers", layers, str(path).encode(), None, None)
            self.assertIn("<svg", path.read_text(encoding="utf-8"))
        LIBRARY.lamella_free_layers(layers)
        LIBRARY.lamella_free_mesh(mesh)

    def test_an_error_has_a_text(self):
        mesh = c_void_p()
        self.assertEqual(LIBRARY.lamella_read_mesh(b"missing.stl", None, byref(mesh)), 3)
        self.assertEqual(LIBRARY.lamella_error(), b"missing.stl: there is no such file")
        self.assertIsNone(mesh.value)

    def call(self, name, *arguments):
        self.assertEqual(getattr(LIBRARY, f"lamella_{name}")(*arguments), 0, LIBRARY.lamella_error())


if __name__ == "__main__":
    LIBRARY = ctypes.CDLL(sys.argv.pop(1))
    LIBRARY.lamella_error.restype = c_char_p
    LIBRARY.lamella_layer_count.restype = c_size_t
    LIBRARY.lamella_free_layers.argtypes = LIBRARY.lamella_free_mesh.argtypes = [c_void_p]
    unittest.main()
