"""Slice files in the hands of programs that are not ours: NumPy, GDAL, Shapely, ezdxf, lib3mf, svgelements, librsvg,
Info-ZIP.

Each must find the layers that our exact JSON has, to the resolution of its format.
"""

import ctypes
import json
import subprocess
import sys
from pathlib import Path

import ezdxf
import matplotlib.image
import numpy
import shapely.geometry
import svgelements
from osgeo import ogr

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "app"))
from program import ProgramTest, main  # noqa: E402

ogr.UseExceptions()


def area(ring):
    x, y = numpy.asarray(ring).T
    return float(numpy.dot(x, numpy.roll(y, -1)) - numpy.dot(y, numpy.roll(x, -1))) / 2


SLIC3R = "{http://slic3r.org/namespaces/slic3r}"


def bounds(points):
    return numpy.concatenate([points.min(axis=0), points.max(axis=0)])


def svg_rings(element):
    """The closed rings of a shape, with its transforms, in pixels of the document."""
    rings = []
    for part in svgelements.Path(element).as_subpaths():
        path = svgelements.Path(part)
        assert isinstance(path[-1], svgelements.Close), path
        assert all(isinstance(segment, (svgelements.Move, svgelements.Line, svgelements.Close)) for segment in path)
        rings.append(numpy.array([(segment.end.x, segment.end.y) for segment in path[:-1]]))
    return rings


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
        for name in ["part.geojson"]:
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

    def rings_of(self, layer):
        return [numpy.reshape(ring, (-1, 2)) for ring in layer["parts"][0]["rings"]]

    def assert_bounds(self, found, layer, tolerance):
        """Of rings in the coordinates of the part."""
        expected = bounds(numpy.concatenate(self.rings_of(layer)))
        self.assertLess(abs(bounds(numpy.concatenate(found)) - expected).max(), tolerance)

    def test_svgelements_finds_the_layers_of_one_svg(self):
        # A pixel is a millimetre then, but for the digits of an inch that svgelements leaves out.
        document = svgelements.SVG.parse(self.slice("part.svg"), ppi=25.4)
        self.assertAlmostEqual(document.width, document.viewbox.width, delta=1e-4)
        corner = numpy.array([float(v) for v in document.values["data-lamella-origin"].split()])
        groups = [e for e in document if isinstance(e, svgelements.Group)]
        self.assertEqual(len(groups), len(self.layers))
        found = []
        for group, layer in zip(groups, self.layers):
            self.assertAlmostEqual(float(group.values[SLIC3R + "z"]), layer["top"], delta=1e-4)
            self.assertAlmostEqual(float(group.values[SLIC3R + "slice-z"]), layer["z"], delta=1e-4)
            self.assertAlmostEqual(float(group.values[SLIC3R + "layer-height"]), layer["top"] - layer["bottom"],
                                   delta=1e-4)
            rings = []
            for shape in group:
                self.assertIsInstance(shape, svgelements.Polygon)
                ring, = svg_rings(shape)
                self.assertEqual(shape.values[SLIC3R + "type"], "contour" if area(ring) > 0 else "hole")
                self.assertEqual(shape.fill, "white" if area(ring) > 0 else "black")
                rings.append(ring + corner)
            self.assertEqual(len(rings), len(self.rings_of(layer)))
            self.assert_bounds(rings, layer, 0.0011)
            found.append(sum(area(ring) for ring in rings))
        self.assert_areas(found)

    def test_svgelements_finds_a_layer_in_each_svg_image(self):
        folder = Path(self.slice_images())
        found = []
        for layer in self.layers:
            document = svgelements.SVG.parse(folder / f"layer_{layer['index']:05}.svg", ppi=25.4)
            box = document.viewbox
            self.assertAlmostEqual(document.width, box.width, delta=1e-4)
            self.assertAlmostEqual(document.height, box.height, delta=1e-4)
            rings = []
            for shape in document.elements(lambda e: isinstance(e, svgelements.Path)):
                self.assertEqual(shape.values["fill-rule"], "evenodd")
                # From the upper left corner downwards, as a viewer has it; the part's y runs upwards.
                rings += [(ring + (box.x, box.y)) * (1, -1) for ring in svg_rings(shape)]
            self.assertEqual(len(rings), len(self.rings_of(layer)))
            self.assert_bounds(rings, layer, 0.0011)
            found.append(sum(area(ring) for ring in rings))
        self.assert_areas(found)

    def slice_images(self):
        self.succeed("slice", "part.stl", "-o", "pictures", "--format", "svg-layers", "--layer-height", "1")
        return str(self.path("pictures"))

    def painted(self, source, *options):
        """Rows and columns of red, green, blue and alpha, from 0 to 1."""
        image = str(self.path("picture.png"))
        subprocess.run(["rsvg-convert", source, *options, "-o", image], check=True)
        return matplotlib.image.imread(image)

    def some_layers(self):
        """Those with holes, and a few others."""
        holes = [i for i, layer in enumerate(self.layers) if any(area(ring) < 0 for ring in self.rings_of(layer))]
        self.assertTrue(holes)
        return holes + list(range(0, len(self.layers), 10))

    def test_librsvg_paints_the_layers_of_one_svg(self):
        source = self.slice("part.svg")
        scale = 20
        for i in self.some_layers():
            pixels = self.painted(source, "--export-id", f"layer{i}", "--zoom", str(scale))
            white = (pixels[..., 0] * pixels[..., 3]).sum() / scale**2
            self.assertAlmostEqual(white, self.areas[i], delta=self.tolerances[i])

    def test_librsvg_paints_svg_images(self):
        folder = Path(self.slice_images())
        dots_per_mm = 20
        resolution = str(25.4 * dots_per_mm)
        self.write("fill.css", "path { stroke: none; fill: #000000 } rect { fill: #ffffff }")
        for i in self.some_layers():
            pixels = self.painted(folder / f"layer_{i:05}.svg", "--dpi-x", resolution, "--dpi-y", resolution,
                                  "--stylesheet", self.path("fill.css"))
            black = (1 - pixels[..., :3].mean(axis=2)).sum() / dots_per_mm**2
            self.assertAlmostEqual(black, self.areas[i], delta=2 * self.tolerances[i])

    def test_info_zip_finds_no_errors(self):
        for name in ["part.npz", "part.3mf"]:
            found = subprocess.run(["unzip", "-t", self.slice(name)], capture_output=True, text=True)
            self.assertEqual(found.returncode, 0, found.stdout)


if __name__ == "__main__":
    main()
