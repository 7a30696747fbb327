"""lamella view and the reports of slice and info: what they write, and what a build without the viewer says."""

import json
import re

from program import ON_WINDOWS, ProgramTest, binary_stl, box_triangles, main, open_box


def element(page, name):
    return json.loads(re.search(rf'<script type="application/json" id="{name}">(.*?)</script>', page, re.DOTALL).group(1))


class View(ProgramTest):
    def setUp(self):
        super().setUp()
        self.box()
        self.viewer = self.run_program("view", "box.stl").code == 0
        self.path("box.html").unlink(missing_ok=True)

    def need_viewer(self):
        if not self.viewer:
            self.skipTest("this program was built without the viewer")

    def page(self, name):
        return self.path(name).read_text(encoding="utf-8")

    def test_a_build_without_the_viewer_says_why(self):
        if self.viewer:
            self.skipTest("this program has the viewer")
        for command in (["view", "box.stl"], ["slice", "box.stl", "-o", "box.html"], ["info", "box.stl", "--report", "r.html"],
                        ["slice", "box.stl", "-o", "box.cli", "--report", "r.html"]):
            self.fail_with(2, "no viewer, and pages need it: .* when Lamella was built", *command)

    def test_a_page_does_not_get_the_name_of_another_format(self):
        self.succeed("slice", "box.stl", "-o", "box.cli")
        for option, command in [("-o", ["view", "box.stl", "-o"]), ("--report", ["info", "box.stl", "--report"]),
                                ("--report", ["slice", "box.stl", "-o", "a.cli", "--report"])]:
            for name in ["rook.svg", "rook.cli", "rook.pdf"]:
                self.fail_with(2, f'{option}: "{name}" has the extension of another format; what is written is .html or .htm',
                               *command, name)
        self.need_viewer()
        for name in ["page.HTM", "page"]:
            self.succeed("view", "box.stl", "-o", name)

    def test_a_mesh_becomes_a_page_of_its_name_here(self):
        self.need_viewer()
        result = self.succeed("view", "box.stl", "--layer-height", "0.5")
        self.assertRegex(result.text, "^box.html: 20 layers of box.stl")
        page = self.page("box.html")
        table = element(page, "table")
        self.assertEqual(table["area_mm2"], [600] * 20)
        self.assertEqual(table["z"][:2], [0.25, 0.75])
        self.assertEqual(element(page, "head")["title"], "box.stl")
        self.assertEqual(page.count('class="data"'), 20)
        self.assertEqual([section["title"] for section in element(page, "notes")["sections"]], ["Mesh", "Input", "The run"])

    def test_a_page_refers_to_nothing_outside(self):
        self.need_viewer()
        self.succeed("view", "box.stl")
        page = re.sub(r"<script.*?</script>", "", self.page("box.html"), flags=re.DOTALL)
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:)([^"]*)"', page), [])
        self.assertEqual(re.findall(r"url\((?!data:)", page), [])
        self.assertIn("default-src 'none'", page)

    def test_every_way_to_the_same_layers_gives_the_same_data(self):
        self.need_viewer()
        self.succeed("slice", "box.stl", "-o", "box.cli", "--units-mm", "0.001")
        self.succeed("slice", "box.stl", "-o", "sliced.html")
        self.succeed("convert", "box.cli", "converted.html")
        self.succeed("view", "box.cli", "-o", "viewed.html")
        self.succeed("slice", "box.stl", "--report", "reported.html")
        def data(name):
            return re.findall(r'class="data">(.*?)<', self.page(name))

        expected = data("sliced.html")
        self.assertEqual(len(expected), 100)
        for name in ("converted.html", "viewed.html", "reported.html"):
            self.assertEqual(data(name), expected, name)

    def test_steps_that_change_contours_report_their_hatches(self):
        self.need_viewer()
        part = '{"rings": [[0, 0, 9, 0, 9, 9, 0, 9]], "hatches": [0, 1, 9, 1]}'
        self.write("hatched.json", f"""{{"format": "lamella layers", "version": 1, "units": "mm", "parts": [{{"label": "a"}}, {{"label": "b"}}],
            "layers": [{{"index": 0, "z": 0.1, "bottom": 0, "top": 0.2, "parts": [{part}, {part}]}}]}}""")
        told = self.succeed("view", "hatched.json", "-o", "page.html", "--offset", "0.1").err
        self.assertRegex(told, r"warning: hatched\.json: 2 hatch lines left out: the contours that they fill were changed")
        self.assertEqual(self.succeed("view", "hatched.json", "-o", "page.html").err, "")

    def test_what_is_odd_or_lost_is_reported(self):
        self.need_viewer()
        self.write("cut.stl", binary_stl(box_triangles(10, 20, 30))[:-7])
        self.assertIn("warning: cut.stl: ", self.succeed("view", "cut.stl").err)
        self.write("odd.json", """{"format": "lamella layers", "version": 1, "parts": [{"label": "a"}], "layers": [
            {"z": 1, "bottom": 0, "top": 2, "parts": [{"rings": [[0, 0, 4, 0, 0, 4], [1, 1, 2, 2]]}]}]}""")
        self.assertIn("warning: odd.json: 1 contour had too few", self.succeed("view", "odd.json").err)
        self.succeed("slice", "box.stl", "-o", "box.cli")
        for arguments in [["convert", "box.cli", "none.cli"], ["view", "box.cli"], ["view", "box.stl"]]:
            self.assertRegex(self.succeed(*arguments, "--offset", "-50").err,
                             r"box.(cli|stl): no contour is left in any of 100 layers: --offset")
        self.fail_with(4, "no contour is left in any of 100 layers", "convert", "box.cli", "none.cli", "--offset", "-50", "--strict")

    def test_the_pages_of_a_batch_have_the_names_of_their_files(self):
        self.need_viewer()
        self.path("parts").mkdir()
        for name in ["a.stl", "b.stl"]:
            self.write(f"parts/{name}", self.bytes_of("box.stl"))
        self.succeed("slice", "--batch", "parts", "-o", "pages", "--format", "html")
        for name in ["a", "b"]:
            self.assertEqual(element(self.page(f"pages/{name}.html"), "head")["title"], f"{name}.stl")

    def test_the_page_of_a_plate_is_named_by_its_first_file_and_the_number_of_the_others(self):
        self.need_viewer()
        for name in ["one.stl", "two.stl", "three.stl"]:
            self.write(name, self.bytes_of("box.stl"))
        for files, title in [(["one.stl", "--copies", "2"], "one.stl"), (["one.stl", "--copies", "2", "two.stl", "--translate", "100,0,0"], "one.stl and 1 more"),
                             (["one.stl", "two.stl", "--translate", "100,0,0", "three.stl", "--translate", "200,0,0"], "one.stl and 2 more")]:
            self.succeed("slice", *files, "-o", "plate.html", "--report", "report.html")
            for page in ["plate.html", "report.html"]:
                self.assertEqual(element(self.page(page), "head")["title"], title)

    def test_threads_do_not_change_a_page(self):
        self.need_viewer()
        self.succeed("make", "rook", "-o", "rook.stl")
        for threads in ("1", "3"):
            self.succeed("slice", "rook.stl", "-o", threads + ".html", "--threads", threads)
        self.assertEqual(self.bytes_of("1.html"), self.bytes_of("3.html"))

    def test_a_report_beside_a_slice_file_reports_the_run(self):
        self.need_viewer()
        self.succeed("slice", "box.stl", "-o", "box.cli", "--report", "report.html", "--inspect")
        sections = {s["title"]: {f["name"]: f["value"] for f in s["facts"]} for s in element(self.page("report.html"), "notes")["sections"]}
        self.assertEqual(sections["Input"]["Triangles"], "12")
        self.assertEqual(sections["Mesh"]["Surface"], "closed, without defects")
        self.assertRegex(sections["The run"]["Slicing"], r"^\d+\.\d{3} s$")
        self.succeed("verify", "box.cli", "--mesh", "box.stl")

    def test_a_page_of_scan_vectors_reports_what_is_exposed_and_how_long(self):
        self.need_viewer()
        options = ["--layer-height", "2.5", "--scan", "--hatch-distance", "0.5", "--skin-layers", "1", "--label", "bracket"]
        self.succeed("slice", "box.stl", "-o", "job.ovf", "--report", "report.html", "--stats", "stats.json", *options)
        self.succeed("view", "job.ovf", "-o", "viewed.html")
        self.succeed("slice", "box.stl", "-o", "layers.npz", "--layer-height", "2.5", "--label", "bracket")
        self.succeed("scan", "layers.npz", "-o", "scanned.html", "--hatch-distance", "0.5", "--skin-layers", "1")
        stats = json.loads(self.bytes_of("stats.json"))
        for name in ("report.html", "viewed.html", "scanned.html"):
            page = self.page(name)
            exposures = [part["exposure"] for part in element(page, "head")["parts"]]
            self.assertEqual({exposure["part"] for exposure in exposures}, {"bracket"})
            self.assertEqual([(exposure["region"], exposure["kind"]) for exposure in exposures if exposure["kind"] == "hatch"],
                             [("downskin", "hatch"), ("core", "hatch"), ("upskin", "hatch")])
            self.assertEqual([exposure["parameters"]["power_w"] for exposure in exposures], [120, 200, 180, 120])
            table = element(page, "table")
            self.assertEqual(sum(table["vectors"]), stats["scan"]["contour_vectors"] + stats["scan"]["hatch_vectors"])
            self.assertEqual(table["hatches"], table["hatches_shown"])
            for key in ("marked_mm", "jumped_mm", "build_seconds", "energy_j"):
                for i, layer in enumerate(stats["layers"]):
                    # Formats keep coordinates and speeds in single precision.
                    self.assertAlmostEqual(table[key][i] / layer["scan"][key], 1, places=4 if name == "viewed.html" else 12)
            for key in ("area_mm2", "overlapping", "misoriented", "open_chains", "crossings"):
                self.assertEqual(table[key], [0] * 4, key)
        self.assertIn("Scan vectors", [section["title"] for section in element(self.page("report.html"), "notes")["sections"]])

    def test_jobs_that_report_no_speed_of_jumps_have_a_time_without_them(self):
        self.need_viewer()
        self.succeed("slice", "box.stl", "-o", "job.ilt", "--layer-height", "2.5", "--scan", "--hatch-distance", "0.5")
        self.succeed("view", "job.ilt", "-o", "job.html")
        page = self.page("job.html")
        self.assertEqual({part["exposure"]["parameters"]["jump_speed_mm_s"] for part in element(page, "head")["parts"]}, {0})
        for seconds, marked in zip(element(page, "table")["build_seconds"], element(page, "table")["marked_mm"]):
            self.assertTrue(marked / 800 < seconds < marked / 500)

    def test_defects_have_their_places(self):
        self.need_viewer()
        self.write("open.stl", binary_stl(open_box(20, 30, 10)))
        self.succeed("view", "open.stl")
        self.succeed("info", "open.stl", "--report", "mesh.html")
        streamed = self.succeed("info", "open.stl", "--report", "-")
        self.assertEqual(streamed.out, self.bytes_of("mesh.html"))
        self.assertIn("4 boundary edges", streamed.err)
        for name in ("open.html", "mesh.html"):
            notes = element(self.page(name), "notes")
            places = notes["places"]
            facts = {fact["name"]: fact["value"] for section in notes["sections"] for fact in section["facts"]}
            self.assertEqual((facts["Boundary edges"], facts["Non-manifold edges"]), ("4", "none"))
            self.assertIn(" 4 boundary edges: the surface has holes", self.succeed("info", "open.stl").text)
            self.assertIn("the surface has holes", places[0]["text"])
            self.assertEqual([(place["kind"], place["found"]) for place in places], [("boundary loop", 1)])
            self.assertEqual(sorted(places[0]["points"]), [[20, y, z] for y in (0, 30) for z in (0, 10)])
        self.assertEqual(element(self.page("open.html"), "table")["open_chains"], [1] * 100)
        header = element(self.page("mesh.html"), "head")
        self.assertEqual((header["triangles"], header["shown"], header["shells"][0]["kind"]), (10, 10, "open"))

    def test_a_surface_whose_triangles_cross_is_not_called_one_without_defects(self):
        self.need_viewer()
        moved = [tuple((x + 5, y + 5, z + 5) for x, y, z in t) for t in box_triangles(20, 10, 10)]
        self.write("two.stl", binary_stl(box_triangles(20, 30, 10) + moved))
        for options, surface in ((), "closed, without defects"), (["--self-intersections"], "closed, but triangles cross or overlap"):
            self.succeed("info", "two.stl", "--report", "mesh.html", *options)
            notes = element(self.page("mesh.html"), "notes")
            self.assertEqual(notes["sections"][0]["facts"][0]["value"], surface)
        self.assertEqual({(place["kind"], place["found"]) for place in notes["places"]}, {("self-intersection", len(notes["places"]))})

    def test_names_of_files_cannot_break_out_of_a_page(self):
        self.need_viewer()
        name = "&lt;b&gt; '${1}'.stl" if ON_WINDOWS else "<script>alert(1)<script>.stl"
        self.box(name)
        self.succeed("view", name, "-o", "page.html")
        page = self.page("page.html")
        self.assertNotIn("<script>alert", page)
        self.assertEqual(element(page, "head")["title"], name)

    def test_standard_output(self):
        self.need_viewer()
        result = self.succeed("view", "box.stl", "-o", "-")
        self.assertTrue(result.text.startswith("<!doctype html>"))
        self.assertTrue(result.text.rstrip().endswith("</html>"))
        self.assertIn("100 layers", result.err)

    def test_standard_input(self):
        self.need_viewer()
        self.succeed("slice", "box.stl", "-o", "box.cli")
        for name in ["box.stl", "box.cli"]:
            result = self.succeed("view", "-", "-o", "piped.html", stdin=self.bytes_of(name))
            self.assertIn("100 layers of standard input", result.text)
            page = self.page("piped.html")
            self.assertEqual(element(page, "head")["title"], "standard input")
            self.assertEqual(element(page, "head")["layers"], 100)

    def test_what_cannot_be_done(self):
        self.fail_with(2, "give one with --output", "view", "-")
        self.path("box.htm").hardlink_to(self.path("box.stl"))
        self.fail_with(2, "overwrite|same file", "view", "box.stl", "-o", "box.htm")
        self.fail_with(3, "missing.stl", "view", "missing.stl")
        for name in ["look.html", "box.html"]:
            self.write(name, "threads = 1\n")
            self.fail_with(2, f"{name}: the output would overwrite the input", "view", "box.stl", "--config", name,
                           *(["-o", name] if name == "look.html" else []))
        self.succeed("slice", "box.stl", "-o", "box.cli")
        self.fail_with(2, "are for meshes", "view", "box.cli", "--layer-height", "0.2")
        self.fail_with(2, "are for meshes", "view", "box.cli", "--slice-at", "middle")
        self.fail_with(2, "are for meshes", "view", "box.cli", "--snap", "0.001")
        self.fail_with(2, "are for meshes", "info", "box.cli", "--report", "r.html")
        self.fail_with(2, "--output and --report", "slice", "box.stl", "-o", "a.html", "--report", "a.html")


if __name__ == "__main__":
    main()
