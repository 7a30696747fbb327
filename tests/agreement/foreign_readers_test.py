"""Slice files in the hands of programs that are not ours: NumPy, GDAL, Shapely, ezdxf, lib3mf, Info-ZIP.

Each must find the layers that our exact JSON has, to the resolution of its format.
"""

import csv
import ctypes
import json
import subprocess
import sys
from pathlib import Path

import ezdxf
import numpy
import shapely.geometry
import shapely.wkt
from osgeo import ogr

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, main  # noqa: E402

ogr.UseExceptions()
csv.field_size_limit(1 << 30)


def area(ring):
    x, y = numpy.asarray(ring).T
    return float(numpy.dot(x, numpy.roll(y, -1)) - numpy.dot(y, numpy.roll(x, -1))) / 2


class ForeignReaders(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("make", "rook", "-o", "part.stl")
        self.slice("exact.json")
        self.layers = json.loads(self.bytes_of("exact.json"))["layers"]
        self.areas = []
        self.tolerances = []
        for layer in self.layers:
            rings = [numpy.reshape(ring, (-1, 2)) for ring in layer["parts"][0]["rings"]]
            self.areas.append(sum(area(ring) for ring in rings))
            around = sum(numpy.hypot(*(ring - numpy.roll(ring, -1, 0)).T).sum() for ring in rings)
            self.tolerances.append(1e-9 + around * 0.00075)
        self.assertGreater(max(self.areas), 1)

    def slice(self, name):
        self.succeed("slice", "part.stl", "-o", name, "--layer-height", "1")
        return str(self.path(name))

    def assert_areas(self, areas):
        self.assertEqual(len(areas), len(self.areas))
        for found, expected, tolerance in zip(areas, self.areas, self.tolerances):
            self.assertAlmostEqual(found, expected, delta=tolerance)

    def test_numpy_finds_the_same_doubles(self):
        arrays = numpy.load(self.slice("part.npz"))
        self.assertEqual(arrays["z"].tolist(), [layer["z"] for layer in self.layers])
        self.assertEqual(arrays["top"].tolist(), [layer["top"] for layer in self.layers])
        self.assertTrue(arrays["closed"].all())
        rings = [(i, ring) for i, layer in enumerate(self.layers) for ring in layer["parts"][0]["rings"]]
        self.assertEqual(arrays["layer"].tolist(), [i for i, _ in rings])
        offsets = arrays["offsets"]
        for k, (_, ring) in enumerate(rings):
            self.assertEqual(arrays["points"][offsets[k]:offsets[k + 1]].ravel().tolist(), ring)
        again = self.path("compressed.npz")
        numpy.savez_compressed(again, **{name: arrays[name] for name in arrays})
        self.succeed("convert", "compressed.npz", "again.json", "--label", "part")
        self.assertEqual(json.loads(self.bytes_of("again.json"))["layers"], self.layers)

    def test_numpy_reads_what_went_through_a_pipe(self):
        self.slice("part.npz")
        piped = self.succeed("slice", "part.stl", "-o", "-", "--format", "npz", "--layer-height", "1")
        self.assertEqual(piped.out, self.bytes_of("part.npz"))

    def test_gdal_reads_geojson_and_well_known_text(self):
        for name in ["part.geojson", "part.csv"]:
            with self.subTest(name):
                source = ogr.Open(self.slice(name))
                features = [(float(f.GetField("z")), f.GetGeometryRef().GetArea()) for f in source.GetLayer()]
                self.assert_areas([a for _, a in features])
                for (z, _), layer in zip(features, self.layers):
                    self.assertAlmostEqual(z, layer["z"], delta=1e-8)

    def test_gdal_reads_dxf(self):
        source = ogr.Open(self.slice("part.dxf"))
        names = {feature.GetField("Layer") for feature in source.GetLayer()}
        self.assertEqual(len(names), sum(1 for layer in self.layers if layer["parts"][0]["rings"]))

    def test_shapely_finds_valid_polygons(self):
        found = []
        self.slice("part.geojson")
        for feature in json.loads(self.bytes_of("part.geojson"))["features"]:
            polygons = shapely.geometry.shape(feature["geometry"])
            self.assertTrue(polygons.is_valid)
            for polygon in polygons.geoms:
                self.assertTrue(polygon.exterior.is_ccw)
                self.assertFalse(any(hole.is_ccw for hole in polygon.interiors))
            found.append(polygons.area)
        self.assert_areas(found)
        with open(self.slice("part.csv"), newline="") as table:
            self.assert_areas([shapely.wkt.loads(row["WKT"]).area for row in csv.DictReader(table)])

    def test_ezdxf_finds_closed_polylines(self):
        document = ezdxf.readfile(self.slice("part.dxf"))
        self.assertEqual(document.units, 4)
        self.assertFalse(document.audit().errors)
        by_layer = {f"LAYER_{layer['index']:05}": 0.0 for layer in self.layers}
        for line in document.modelspace():
            self.assertTrue(line.is_closed)
            by_layer[line.dxf.layer] += area([(p.x, p.y) for p in line.points()])
        self.assert_areas(list(by_layer.values()))

    def test_lib3mf_finds_slice_stacks_and_nothing_to_warn_of(self):
        library = ctypes.CDLL("lib3MF.so.1")

        def call(name, *arguments):
            self.assertEqual(getattr(library, "lib3mf_" + name)(*arguments), 0, name)

        def number(name, *arguments, kind=ctypes.c_uint32):
            value = kind()
            call(name, *arguments, ctypes.byref(value))
            return value.value

        def pointer(name, *arguments):
            return ctypes.c_void_p(number(name, *arguments, kind=ctypes.c_void_p))

        model = pointer("createmodel")
        reader = pointer("model_queryreader", model, b"3mf")
        call("reader_readfromfileutf8", reader, self.slice("part.3mf").encode())
        self.assertEqual(number("reader_getwarningcount", reader), 0)
        objects = pointer("model_getmeshobjects", model)
        self.assertTrue(number("resourceiterator_movenext", objects, kind=ctypes.c_int))
        body = pointer("resourceiterator_getcurrent", objects)
        stack = pointer("model_getslicestackById", model, number("meshobject_getslicestackid", body))
        found = []
        for i in range(number("slicestack_getslicecount", stack)):
            one = pointer("slicestack_getslice", stack, i)
            top = number("slice_gettopz", one, kind=ctypes.c_float)
            self.assertAlmostEqual(top, self.layers[i]["top"], delta=1e-5)
            vertices = (ctypes.c_float * (2 * max(1, number("slice_getvertexcount", one))))()
            call("slice_getvertices", one, vertices, len(vertices) // 2)
            points = numpy.reshape(numpy.array(vertices, dtype=float), (-1, 2))
            total = 0.0
            for polygon in range(number("slice_getpolygoncount", one)):
                indices = (ctypes.c_uint32 * number("slice_getpolygonindexcount", one, polygon))()
                call("slice_getpolygonindices", one, polygon, indices, len(indices))
                total += area(points[list(indices)])
            found.append(total)
        self.assert_areas(found)

    def test_info_zip_finds_no_errors(self):
        for name in ["part.npz", "part.3mf"]:
            found = subprocess.run(["unzip", "-t", self.slice(name)], capture_output=True, text=True)
            self.assertEqual(found.returncode, 0, found.stdout)


if __name__ == "__main__":
    main()
