"""lamella info, of meshes and of slice files."""

import json
import zipfile

from program import ProgramTest, binary_stl, box_triangles, main, open_box

MESH_KEYS = ["path", "format", "unit", "triangles", "vertices", "bbox", "volume_mm3", "area_mm2", "closed",
             "shells", "cavities", "defects", "boundary_length_mm", "places", "shell_list", "self_intersections"]


class Info(ProgramTest):
    def info(self, *arguments, **keywords):
        return self.succeed("info", "--json", *arguments, **keywords).json()

    def test_a_3mf_file_of_slices_is_a_slice_file(self):
        self.succeed("slice", self.box(), "-o", "box.3mf")
        self.assertEqual(self.succeed("info", "box.3mf", "--json").json()["format"], "3mf")
        self.assertIn("slice file", self.succeed("info", "box.3mf").text)

    def test_a_box(self):
        found = self.info(self.box())
        self.assertEqual(list(found), MESH_KEYS)
        self.assertEqual((found["path"], found["format"], found["unit"]), ("box.stl", "stl-binary", "mm"))
        self.assertEqual((found["triangles"], found["vertices"], found["shells"]), (12, 8, 1))
        self.assertEqual([round(b - a, 6) for a, b in zip(*found["bbox"])], [20, 30, 10])
        self.assertAlmostEqual(found["volume_mm3"], 6000, places=3)
        self.assertAlmostEqual(found["area_mm2"], 2200, places=3)
        self.assertTrue(found["closed"])
        self.assertEqual(set(found["defects"].values()), {0})

    def test_several_files_are_described_one_after_the_other(self):
        one, other = self.box("a.stl"), self.box("b.stl", size="1,2,3")
        self.succeed("slice", one, "-o", "a.cli")
        texts = [self.succeed("info", name).text for name in [one, "a.cli", other]]
        self.assertEqual(self.succeed("info", one, "a.cli", other).text, "".join(texts))
        lines = self.succeed("info", "--json", one, other).text.splitlines()
        self.assertEqual([json.loads(line)["path"] for line in lines], [one, other])
        result = self.run_program("info", "none.stl", one, self.write("open.stl", binary_stl(open_box(1, 1, 1))), "--strict")
        self.assertEqual(result.code, 3)
        self.assertIn("a.stl", result.text)
        self.assertRegex(result.err, r"error: none\.stl: there is no such file\nlamella: error: .*open\.stl: the mesh has defects\n$")
        self.fail_with(2, "several files and --report contradict", "info", one, other, "--report", "page.html")

    def test_supports_are_included_where_they_are_asked_for(self):
        corners = [(x + dx, y, z) for dx in (0, 10) for x, y, z in [(0, 0, 0), (3, 0, 0), (0, 3, 0), (0, 0, 3)]]
        vertices = "".join("<vertex><coordinates><x>%d</x><y>%d</y><z>%d</z></coordinates></vertex>" % c for c in corners)
        tetrahedron, support = (
            "".join("<triangle><v1>%d</v1><v2>%d</v2><v3>%d</v3></triangle>" % tuple(first + v for v in t)
                    for t in [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]) for first in (0, 4))
        self.write("part.amf", f"<amf><object id='0'><mesh><vertices>{vertices}</vertices><volume>{tetrahedron}</volume>"
                               f"<volume type='support'>{support}</volume></mesh></object></amf>")
        include = ["--include", "support"]
        self.assertEqual(self.info("part.amf")["triangles"], 4)
        self.assertIn("1 body was left out as no material: 1 support; --include support", self.succeed("info", "part.amf").err)
        self.assertEqual(self.info("part.amf", *include)["triangles"], 8)
        self.assertEqual(self.succeed("info", "part.amf", *include).err, "")
        for words, triangles in ([], 4), (include, 8):
            stats = self.succeed("slice", "part.amf", "-o", "part.cli", "--stats", "-", *words).json()
            self.assertEqual(stats["input"]["triangles"], triangles)
            self.succeed("verify", "part.cli", "--mesh", "part.amf", *words)
        self.succeed("view", "part.amf", "-o", "part.html", *include)
        self.fail_with(2, "--include.*'thing', expected one of support", "info", "part.amf", "--include", "thing")

    def test_the_text_names_what_matters(self):
        text = self.succeed("info", self.box()).text
        for word in ["12", "20 x 30 x 10 mm", "6000 mm3", "closed", "defects"]:
            self.assertIn(word, text)

    def test_an_open_box_has_boundary_edges_and_no_volume(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        found = self.info("open.stl")
        self.assertFalse(found["closed"])
        self.assertEqual(found["defects"]["boundary_edges"], 4)
        text = self.succeed("info", "open.stl").text
        self.assertRegex(text, "4 boundary edges: .*hole")
        self.assertIn("not closed", text)

    def test_a_cavity_is_reported_and_is_no_defect(self):
        hollow = [tuple((x + 5, y + 5, z + 2) for x, y, z in t[::-1]) for t in box_triangles(3, 4, 5)]
        self.write("hollow.stl", binary_stl(box_triangles(20, 30, 10) + hollow))
        found = self.info("hollow.stl")
        self.assertEqual((found["shells"], found["cavities"]), (2, 1))
        self.assertEqual(set(found["defects"].values()), {0})
        self.assertAlmostEqual(found["volume_mm3"], 6000 - 60, places=3)
        self.assertRegex(self.succeed("info", "hollow.stl").text, r"shells +2, 1 of them a cavity\n")
        self.assertEqual(self.info(self.box())["cavities"], 0)
        self.assertRegex(self.succeed("info", "box.stl").text, r"shells +1\n")

    def test_places_of_defects(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        found = self.info("open.stl")
        self.assertEqual(found["defects"]["boundary_loops"], 1)
        [loop] = found["places"]["boundary_loops"]
        self.assertEqual((loop["edges"], loop["closed"]), (4, True))
        self.assertAlmostEqual(loop["length_mm"], 80, places=4)
        self.assertAlmostEqual(found["boundary_length_mm"], 80, places=4)
        [shell] = found["shell_list"]
        self.assertEqual((shell["kind"], shell["inside"], shell["depth"]), ("open", None, 0))
        self.assertRegex(self.succeed("info", "open.stl").text, r"a rim of 4 edges, 80 mm long")

    def test_shells_report_what_they_lie_in(self):
        hollow = [tuple((x + 5, y + 5, z + 2) for x, y, z in t[::-1]) for t in box_triangles(3, 4, 5)]
        self.write("hollow.stl", binary_stl(hollow + box_triangles(20, 30, 10)))
        shells = self.info("hollow.stl")["shell_list"]
        self.assertEqual([s["kind"] for s in shells], ["cavity", "body"])
        self.assertEqual([s["inside"] for s in shells], [1, None])
        self.assertAlmostEqual(shells[0]["volume_mm3"], -60, places=3)

    def test_self_intersections(self):
        self.assertIsNone(self.info(self.box())["self_intersections"])
        found = self.info("--self-intersections", "box.stl")["self_intersections"]
        self.assertEqual((found["crossing"], found["overlapping"], found["touching"]), (0, 0, 0))
        moved = [tuple((x + 5, y + 5, z + 5) for x, y, z in t) for t in box_triangles(20, 10, 10)]
        self.write("two.stl", binary_stl(box_triangles(20, 30, 10) + moved))
        found = self.info("--self-intersections", "two.stl")["self_intersections"]
        self.assertGreater(found["crossing"], 0)
        self.assertEqual([pair["shells"] for pair in found["shells"]], [[0, 1]])
        self.assertEqual(found["shells"][0]["crossing"], found["crossing"])
        self.assertIn(found["first"][0]["kind"], ["crossing", "overlapping"])
        text = self.succeed("info", "--self-intersections", "two.stl").text
        self.assertRegex(text, r"\d+ crossings: .*pass through")
        self.assertRegex(text, r"1 pair of shells")

    def test_strict_turns_a_defect_into_an_exit_code(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        result = self.run_program("info", "--strict", "open.stl")
        self.assertEqual(result.code, 4)
        self.assertIn("boundary edges", result.text)
        self.succeed("info", "--strict", self.box())

    def test_a_duplicate_and_a_degenerate_triangle(self):
        triangles = box_triangles(1, 1, 1)
        self.write("odd.stl", binary_stl(triangles + [triangles[0], ((0, 0, 0), (0, 0, 0), (1, 0, 0))]))
        found = self.info("odd.stl")
        self.assertEqual(found["triangles"], 14)
        self.assertEqual(found["defects"]["duplicate_triangles"], 1)
        self.assertEqual(found["defects"]["degenerate_triangles"], 1)

    def test_a_unit(self):
        found = self.info(self.box(), "--unit", "cm")
        self.assertEqual(found["unit"], "cm")
        self.assertAlmostEqual(found["volume_mm3"], 6e6, delta=1)

    def test_ascii_and_standard_input(self):
        self.succeed("make", "box", "--ascii", "-o", "box.stl")
        found = self.info("-", stdin=self.bytes_of("box.stl"))
        self.assertEqual((found["path"], found["format"], found["triangles"]), ("-", "stl-ascii", 12))

    def test_lines_of_no_exposure_are_reported(self):
        self.write("lines.cli", "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$LAYERS/2\n$$HEADEREND\n$$GEOMETRYSTART\n"
                   "$$LAYER/0.0\n$$LAYER/1.0\n$$POLYLINE/1,1,4,0,0,9,0,9,9,0,0\n$$HATCHES/1,2,1,1,8,1,2,2,8,2\n$$GEOMETRYEND\n")
        self.assertEqual(self.succeed("info", "lines.cli", "--json").json()["hatches"], 2)
        self.assertIn(b"2 lines of no exposure", self.succeed("info", "lines.cli").out)

    def test_slice_files(self):
        self.box()
        for name in ["box.cli", "box.svg"]:
            with self.subTest(name):
                self.succeed("slice", "box.stl", "-o", name, "--layer-height", "1")
                found = self.info(name)
                self.assertEqual((found["layers"], found["contours"], found["open_chains"]), (10, 10, 0))
                for value, expected in zip(found["z_range"], [0, 10]):
                    self.assertAlmostEqual(value, expected, places=4)
                self.assertAlmostEqual(found["volume_mm3"], 6000, delta=1)
                self.assertIn("slice file", self.succeed("info", name).text)
                self.assertEqual(self.info("-", stdin=self.bytes_of(name))["layers"], 10)

    def test_regions_of_scan_vectors_are_reported(self):
        def vectors(command):
            return f"$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n$$LAYER/1\n{command}\n" \
                   "$$GEOMETRYEND\n"

        files = {"cyl_1_md.cli": "$$HATCHES/1,2,0,0,5,5,0,1,5,6", "cyl_1_c1md.cli": "$$POLYLINE/1,1,5,0,0,5,0,5,5,0,5,0,0",
                 "cyl_1_dn.cli": "$$HATCHES/1,1,0,0,3,4"}
        with zipfile.ZipFile(self.path("a.ilt"), "w") as archive:
            for name, command in files.items():
                archive.writestr(name, vectors(command))
            archive.writestr("modelsection_param.txt", "".join(
                f"[{name}]\nLaserSpeed = 800 mm/s\nLaserPower = 200 watt\n" for name in files))
        found = self.info("a.ilt")
        self.assertEqual(found["parts"], ["cyl_1 core hatch", "cyl_1 core contour 1", "cyl_1 downskin hatch"])
        self.assertEqual(list(found["regions"]), ["core", "downskin"])
        self.assertEqual((found["regions"]["core"]["contour_vectors"], found["regions"]["core"]["hatch_vectors"]), (4, 2))
        self.assertEqual(found["regions"]["downskin"], {"contour_vectors": 0, "hatch_vectors": 1, "marked_mm": 5})
        self.assertRegex(self.succeed("info", "a.ilt").text, r"(?m)^  downskin +0 vectors on contours, 1 in hatches, 5\.0 mm")

    def test_bad_files(self):
        self.write("empty", b"")
        self.fail_with(3, "empty", "info", "empty")
        self.fail_with(3, "nowhere", "info", "nowhere")
        self.fail_with(3, "lamella: error: ", "info", ".")
        self.write("cut.cli", "$$HEADERSTART\n")
        self.fail_with(3, r"cut\.cli", "info", "cut.cli")


if __name__ == "__main__":
    main()
