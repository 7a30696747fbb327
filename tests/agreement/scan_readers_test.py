#!/usr/bin/env python3
"""Scan vectors as readers see them that share no code with ours: zipfile and the layout of the Common Layer Interface,
the schema of the Open Vector Format with Protocol Buffers' own code, the schemas of 3MF with toolpaths with libxml2. All
must hold what the JSON of layers has, at their resolution.

Needs LAMELLA_SAMPLES, the program that writes them.
"""

import configparser
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

FOREIGN = Path(__file__).resolve().parent / "foreign"
TOOLPATH = "{http://schemas.3mf.io/3dmanufacturing/toolpath/2026/03}"
CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
PRODUCTION = "{http://schemas.microsoft.com/3dmanufacturing/production/2015/06}"
OWN = "{urn:x-lamella:exposure}"


def points_of(numbers):
    return [(numbers[i], numbers[i + 1]) for i in range(0, len(numbers), 2)]


def read_common_layer(data):
    """The labels, and for each layer what each part has: (rings with their first point once, hatch points)."""
    end = data.index(b"$$HEADEREND") + len(b"$$HEADEREND")
    units, labels = 0.0, {}
    for line in data[:end].decode("ascii").splitlines():
        if line.startswith("$$UNITS/"):
            units = float(line[len("$$UNITS/"):])
        elif line.startswith("$$LABEL/"):
            number, label = line[len("$$LABEL/"):].split(",", 1)
            labels[int(number)] = label.strip('"')
    layers, at = [], end
    while at < len(data):
        (command,) = struct.unpack_from("<H", data, at)
        at += 2
        if command == 127:
            (z,) = struct.unpack_from("<f", data, at)
            at += 4
            layers.append((z * units, {number: ([], []) for number in labels}))
        elif command == 130:
            part, direction, count = struct.unpack_from("<iii", data, at)
            points = points_of([units * v for v in struct.unpack_from(f"<{2 * count}f", data, at + 12)])
            at += 12 + 8 * count
            assert direction in (0, 1) and points[0] == points[-1]
            layers[-1][1][part][0].append(points[:-1])
        elif command == 132:
            part, count = struct.unpack_from("<ii", data, at)
            layers[-1][1][part][1].extend(
                points_of([units * v for v in struct.unpack_from(f"<{4 * count}f", data, at + 8)]))
            at += 8 + 16 * count
        else:
            raise AssertionError(f"command {command} at byte {at}")
    return labels, layers


class ScanReaders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name)
        subprocess.run([os.environ["LAMELLA_SAMPLES"], str(cls.path)], check=True)
        document = json.loads((cls.path / "rook.json").read_text())
        cls.labels = [part["label"] for part in document["parts"]]
        cls.layers = document["layers"]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def expected(self, label, layer):
        part = self.layers[layer]["parts"][self.labels.index(label)]
        return [points_of(ring) for ring in part["rings"]], points_of(part.get("hatches", []))

    def assert_points(self, found, expected, tolerance):
        self.assertEqual(len(found), len(expected))
        for a, b in zip(found, expected):
            self.assertLessEqual(max(abs(a[0] - b[0]), abs(a[1] - b[1])), tolerance)

    def assert_vectors(self, found, label, layer, tolerance):
        rings, hatches = self.expected(label, layer)
        self.assertEqual(len(found[0]), len(rings), f"{label}, layer {layer}")
        for ring, other in zip(found[0], rings):
            self.assert_points(ring, other, tolerance)
        self.assert_points(found[1], hatches, tolerance)

    def test_samples_hold_all_kinds_of_vectors(self):
        self.assertEqual(self.labels, ["rook downskin hatch", "rook core hatch", "rook upskin hatch",
                                       "rook core contour 3", "rook core contour 2", "rook core contour 1"])
        for label in self.labels:
            self.assertTrue(any(any(self.expected(label, i)) for i in range(len(self.layers))), label)

    def test_ilt_is_an_archive_of_common_layer_files_with_parameters(self):
        with zipfile.ZipFile(self.path / "rook.ilt") as archive:
            self.assertIsNone(archive.testzip())
            parameters = configparser.ConfigParser()
            parameters.optionxform = str
            parameters.read_string(archive.read("modelsection_param.txt").decode("latin-1"))
            self.assertEqual(set(archive.namelist()), {"modelsection_param.txt", *parameters.sections()})
            self.assertEqual(parameters.sections(),
                             [f"modelsection_001_s1_{kind}.cli" for kind in ("us", "vs", "skin", "kv", "vk")])
            self.assertEqual(dict(parameters["modelsection_001_s1_vs.cli"]),
                             {"LaserSpeed": "800.0 mm/s", "LaserPower": "200.0 watt", "FocusShift": "0.0 mm",
                              "PointDistance": "0.0 \u00b5m", "ExposureTime": "0.0 \u00b5s"})
            seen = []
            for name in parameters.sections():
                labels, layers = read_common_layer(archive.read(name))
                self.assertEqual(len(layers), len(self.layers) + 1)
                for i, (z, parts) in enumerate(layers[1:]):
                    self.assertAlmostEqual(z, self.layers[i]["top"], delta=1e-5)
                    for number, label in labels.items():
                        self.assert_vectors(parts[number], label, i, 1e-5)
                seen += labels.values()
            self.assertEqual(seen, self.labels)

    def test_open_vector_format_is_read_with_its_schema(self):
        subprocess.run(["protoc", f"--proto_path={FOREIGN / 'open_vector_format'}", f"--python_out={self.path}",
                        "open_vector_format.proto", "ovf_lut.proto"], check=True)
        sys.path.insert(0, str(self.path))
        import open_vector_format_pb2 as ovf  # pylint: disable=import-error,import-outside-toplevel
        import ovf_lut_pb2 as tables  # pylint: disable=import-error,import-outside-toplevel
        from google.protobuf.internal.decoder import _DecodeVarint32

        data = (self.path / "rook.ovf").read_bytes()

        def message(kind, place):
            size, begin = _DecodeVarint32(data, place)
            result = kind()
            self.assertEqual(result.ParseFromString(data[begin:begin + size]), size)
            return result

        def position(place):
            return struct.unpack_from("<q", data, place)[0]

        self.assertEqual(data[:4], bytes([0x4C, 0x56, 0x46, 0x21]))
        job_table = message(tables.JobLUT, position(4))
        job = message(ovf.Job, job_table.jobShellPosition)
        self.assertEqual(len(job.work_planes), 0)
        self.assertEqual(job.num_work_planes, len(self.layers))
        self.assertEqual([part.name for part in job.parts_map.values()], ["rook"])
        self.assertEqual(sorted((key, params.name, params.laser_power_in_w, params.laser_speed_in_mm_per_s)
                                for key, params in job.marking_params_map.items()),
                         [(1, "downskin", 120, 1200), (2, "hatch", 200, 800), (3, "upskin", 180, 900),
                          (4, "contour 3", 120, 500), (5, "contour 2", 120, 500), (6, "contour", 120, 500)])
        areas = {0: "hatch", 1: "contour", 2: "contour"}
        skins = {0: "core", 1: "downskin", 2: "upskin"}
        for i, place in enumerate(job_table.workPlanePositions):
            table = message(tables.WorkPlaneLUT, position(place))
            plane = message(ovf.WorkPlane, table.workPlaneShellPosition)
            self.assertEqual((plane.work_plane_number, plane.num_blocks), (i, len(table.vectorBlocksPositions)))
            self.assertAlmostEqual(plane.z_pos_in_mm, self.layers[i]["top"], delta=1e-5)
            found = {label: ([], []) for label in self.labels}
            keys = []
            for block in (message(ovf.VectorBlock, at) for at in table.vectorBlocksPositions):
                keys.append(block.marking_params_key)
                label = self.labels[block.marking_params_key - 1]
                kind = areas[block.lpbf_metadata.part_area]
                self.assertIn(f"{skins[block.lpbf_metadata.skin_type]} {kind}", label)
                self.assertEqual(block.meta_data.part_key, 1)
                if block.WhichOneof("vector_data") == "line_sequence":
                    points = points_of(block.line_sequence.points)
                    self.assertEqual(points[0], points[-1])
                    found[label][0].append(points[:-1])
                else:
                    found[label][1].extend(points_of(block._hatches.points))
            self.assertEqual(keys, sorted(keys))
            for label, vectors in found.items():
                self.assert_vectors(vectors, label, i, 1e-5)

    def validate(self, schema, document):
        path = self.path / "document.xml"
        path.write_bytes(document)
        # A number so large is more than libxml2 counts to, and means the same.
        rules = self.path / schema
        rules.write_text((FOREIGN / "3mf_toolpath" / schema).read_text().replace('"2147483647"', '"unbounded"'))
        result = subprocess.run(["xmllint", "--nonet", "--noout", "--schema", str(rules), str(path)],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_3mf_with_toolpaths_is_valid_and_holds_the_vectors(self):
        with zipfile.ZipFile(self.path / "rook.3mf-toolpath") as archive:
            self.assertIsNone(archive.testzip())
            model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
            relations = ElementTree.fromstring(archive.read("3D/_rels/3dmodel.model.rels"))
            toolpath = model.find(f"{CORE}resources/{TOOLPATH}toolpathresource")
            self.validate("toolpath_2026_03.xsd", ElementTree.tostring(toolpath))
            self.assertEqual(model.find(f"{CORE}build").get(f"{TOOLPATH}toolpathid"), toolpath.get("id"))
            unit = float(toolpath.get("unitfactor"))
            labels = {}
            for profile in toolpath.iter(f"{TOOLPATH}toolpathprofile"):
                number = profile.get(f"{OWN}contour")
                name = f"{profile.get(f'{OWN}region')} {profile.get(f'{OWN}kind')}"
                labels[profile.get("uuid")] = f"rook {name}" + (f" {number}" if number != "0" else "")
            self.assertEqual(list(labels.values()), self.labels)
            items = {item.get(f"{PRODUCTION}UUID") for item in model.iter(f"{CORE}item")}
            layers = list(toolpath.iter(f"{TOOLPATH}toolpathlayer"))
            self.assertEqual([layer.get("path") for layer in layers], [r.get("Target") for r in relations])
            self.assertEqual(len(layers), len(self.layers))
            for i, listed in enumerate(layers):
                self.assertAlmostEqual(int(listed.get("ztop")) * unit, self.layers[i]["top"], delta=0.00051)
                text = archive.read(listed.get("path")[1:])
                self.validate("toolpath_layer_2026_03.xsd", text)
                layer = ElementTree.fromstring(text)
                self.assertEqual({part.get("uuid") for part in layer.iter(f"{TOOLPATH}part")}, items)
                profiles = {p.get("id"): labels[p.get("uuid")] for p in layer.iter(f"{TOOLPATH}profile")}
                found = {label: ([], []) for label in self.labels}
                for segment in layer.iter(f"{TOOLPATH}segment"):
                    rings, hatches = found[profiles[segment.get("profileid")]]
                    if segment.get("type") == "loop":
                        rings.append([(int(p.get("x")) * unit, int(p.get("y")) * unit) for p in segment])
                    else:
                        self.assertEqual(segment.get("type"), "hatch")
                        for hatch in segment:
                            for end in "12":
                                hatches.append((int(hatch.get(f"x{end}")) * unit, int(hatch.get(f"y{end}")) * unit))
                for label, vectors in found.items():
                    self.assert_vectors(vectors, label, i, 0.00051)


if __name__ == "__main__":
    unittest.main()
