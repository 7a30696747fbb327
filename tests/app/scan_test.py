"""lamella slice --scan, lamella scan and lamella strategy: scan vectors and what says how they are made."""

import json
import re
import zipfile

from program import SOURCE, ProgramTest, binary_stl, box_triangles, main, open_box

HATCHED = ["--hatch-distance", "0.2", "--contours", "2", "--skin-layers", "2"]


class Strategy(ProgramTest):
    def check(self, text, pattern, code=2):
        self.write("s.toml", text)
        for command in (["strategy", "check", "s.toml"], ["strategy", "show", "s.toml"],
                        ["slice", "box.stl", "--strategy", "s.toml", "-o", "x.cli"]):
            self.fail_with(code, pattern, *command)

    def test_what_is_shown_is_a_strategy_that_shows_the_same(self):
        text = self.succeed("strategy", "show").text
        self.write("default.toml", text)
        self.assertEqual(self.succeed("strategy", "check", "default.toml").text, "default.toml: is a strategy\n")
        self.assertEqual(self.succeed("strategy", "show", "default.toml").text, text)
        changed = text.replace("count = 1 ", "count = 4 ").replace('"stripes"', '"hexagons"').replace("power_w = 200.0", "power_w = 250")
        changed = changed.replace("power_w = 200 ", "power_w = 250 ").replace("before_hatch = false", "before_hatch = true")
        self.assertNotEqual(changed, text)
        self.write("changed.toml", changed)
        again = self.succeed("strategy", "show", "changed.toml").text
        self.assertRegex(again, r"count = 4 ")
        self.assertRegex(again, r'pattern = "hexagons"')
        self.assertRegex(again, r"power_w = 250 ")
        self.assertRegex(again, r"before_hatch = true")
        self.assertEqual(self.succeed("strategy", "show", "-", stdin=again.encode()).text, again)

    def test_every_key_is_shown_with_a_comment_and_is_in_the_documentation(self):
        page = (SOURCE / "docs" / "strategies.md").read_text(encoding="utf-8")
        keys = 0
        for line in self.succeed("strategy", "show").text.splitlines():
            if re.match(r"\w+ = ", line):
                keys += 1
                self.assertRegex(line, r"^\w+ = \S+ +# \w")
                self.assertIn(f"`{line.split()[0]}`", page)
        self.assertGreater(keys, 70)

    def test_sets_of_parameters_are_found_by_their_names(self):
        self.write("s.toml", '[hatch]\nparameters = "fast"\n[upskin.hatch]\nparameters = "fast"\n'
                             '[parameters.fast]\npower_w = 300\n[parameters.contour]\nspeed_mm_s = 7\n')
        text = self.succeed("strategy", "show", "s.toml").text
        self.assertEqual(text.count('parameters = "fast"'), 2)
        self.assertEqual(text.count("[parameters.fast]"), 1)
        self.assertRegex(text, r"\[parameters.contour\]\npower_w = 120 .*\nspeed_mm_s = 7 ")

    def test_what_is_wrong_is_reported_with_its_line(self):
        self.box()
        self.check("[hatch]\ndistanze = 1\n", r's\.toml:2: \[hatch\] has no "distanze"; did you mean distance\?')
        self.check("[hatches]\n", r's\.toml:1: a strategy has no "hatches"; did you mean hatch\?')
        self.check("[upskin]\nborder = 1\n", r's\.toml:2: \[upskin\] has no "border"; there are layers, narrowest, overlap, hatch')
        self.check('[hatch]\n\ndistance = "wide"\n', r's\.toml:3: hatch\.distance is "wide", but has to be a number')
        self.check("[contours]\ncount = 1.5\n", r"s\.toml:2: contours\.count is 1\.5, but has to be a whole number")
        self.check("[contours]\ncount = -1\n", r"s\.toml:2: contours\.count is -1, but has to be a whole number")
        self.check("[contours]\ncount = 1.0\n", r"s\.toml:2: contours\.count is 1, but has to be a whole number, 0 or more, written without a point")
        self.check("[contours]\ncount = 101\n", r"s\.toml:2: contours\.count is 101, but has to be at most 100")
        self.check('[contours]\nbefore_hatch = "no"\n', r's\.toml:2: contours\.before_hatch is "no", but has to be true or false')
        self.check('[hatch]\npattern = "stripe"\n', r's\.toml:2: hatch\.pattern is "stripe", .*did you mean stripes\?')
        self.check("[hatch]\nangle_degrees = 1\ndistance = -0.1\n", r"s\.toml:3: hatch\.distance is -0\.1, but has to be above 0")
        self.check("[hatch]\ncell = 0.1\n", r"s\.toml:2: hatch\.cell is 0\.1, but has to be above 0\.2, twice the overlap")
        self.check("[hatch]\ncell = 1e17\n", r"s\.toml:2: hatch\.cell is 1e\+17, but has to be at most 1e\+09 mm")
        self.check("[upskin.hatch]\nborder = -1\n", r"s\.toml:2: upskin\.hatch\.border is -1, but has to be 0 or more")
        self.check("[parameters.hatch]\npower_w = 1\nspeed_mm_s = 0\n",
                   r"s\.toml:3: parameters\.hatch\.speed_mm_s is 0, but has to be above 0")
        self.check("[support.hatch]\ndistance = 0\n", r"s\.toml:2: support\.hatch\.distance is 0, but has to be above 0")
        self.check("[support]\ncount = 1\n", r's\.toml:2: \[support\] has no "count"; there are contours, hatch')
        self.check("[support.contours]\ncount = 101\n", r"s\.toml:2: support\.contours\.count is 101, but has to be at most 100")
        self.check("hatch = 3\n", r"s\.toml:1: hatch is 3, but has to be a table: \[hatch\]")
        self.check('[hatch]\nparameters = "hach"\n', r's\.toml:2: hatch\.parameters is "hach", but there is no \[parameters\.hach\]; did')
        self.check("[parameters.hach]\npower_w = 1\n", r"s\.toml:1: \[parameters\.hach\] is used nowhere; did you mean hatch\?")
        self.check("[hatch\n", r"s\.toml:1: expected TOML")
        self.check("[\x15hatch]\n", r"s\.toml:1: expected TOML")
        self.check("[hatch]\n\u0249erlap = 1\n", r"s\.toml:2: expected TOML")
        self.check("[hatch]\ndistance = 1\ndistance = 2\n", r"s\.toml:3: expected TOML")
        self.fail_with(3, r"missing\.toml", "strategy", "check", "missing.toml")
        self.fail_with(3, r"missing\.toml", "slice", "box.stl", "--strategy", "missing.toml", "-o", "x.cli")
        self.fail_with(2, "needs FILE", "strategy", "check")
        self.fail_with(2, "none of show, check", "strategy", "shown")


class Scan(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("part.stl", binary_stl(box_triangles(10, 6, 4)))

    def stats(self, *options):
        return self.succeed("slice", "part.stl", "--layer-height", "1", "--stats", "-", *options).json()

    @staticmethod
    def without_parameters(name, parts):
        return (f"lamella: warning: {name}: parameters of scan vectors, such as power and speed, were left out for {parts} parts: "
                "the format cannot store them; ilt, ovf and 3mf-toolpath can\n")

    def parameters_left_out(self, name, parts):
        """What writing a job of so many parts says of the parameters that its format has no place for."""
        if name.endswith((".json", ".cli")):
            return self.without_parameters(name, parts)
        return ""

    def test_powers_and_speeds_are_not_lost_in_silence(self):
        slicing = ["slice", "part.stl", "--layer-height", "1", "--scan"]
        self.succeed(*slicing, "-o", "job.ilt")
        self.fail_with(4, "parameters of scan vectors", "convert", "job.ilt", "x.json", "--strict")
        self.fail_with(4, "parameters of scan vectors", *slicing, "--strict", "-o", "x.cli")
        self.succeed(*slicing, "-o", "job.cli")
        for name in ("back.ilt", "back.ovf"):
            result = self.succeed("convert", "job.cli", name)
            self.assertRegex(result.err, r"^lamella: warning: \S+: \d parts have no parameters of scan vectors, such as power")
        self.write("strong.toml", "[parameters.hatch]\npower_w = 1e300\n")
        self.fail_with(2, r'power_w of parameters "hatch" is 1e\+300; numbers of ovf reach to 3\.4e\+38', "slice", "part.stl",
                       "--layer-height", "1", "--strategy", "strong.toml", "-o", "x.ovf")
        self.assertNotIn("x.ovf", self.listing())

    def test_a_job_of_vectors_is_read_back(self):
        result = self.succeed("slice", "part.stl", "--label", "bracket", "--layer-height", "1", "-o", "job.cli", "--scan", *HATCHED)
        self.assertRegex(result.text, r"(?m)^scan     [\d,]+ vectors, [\d.]+ m marked, [\d.]+ mm jumped, [\d.]+ s, [\d.]+ J$")
        self.assertEqual(result.err, self.without_parameters("job.cli", 5))
        info = self.succeed("info", "job.cli").text
        self.assertIn("bracket core contour 1", info)
        self.succeed("convert", "job.cli", "job.json")
        parts = json.loads(self.bytes_of("job.json"))
        labels = [part["label"] for part in parts["parts"]]
        self.assertEqual(labels, [f"bracket {name}" for name in ("downskin hatch", "core hatch", "upskin hatch", "core contour 2",
                                                                 "core contour 1")])
        # Two layers below and two above are skin, and there are four.
        lines = {label: sum(len(layer["parts"][i].get("hatches", [])) // 4 for layer in parts["layers"])
                 for i, label in enumerate(labels)}
        self.assertEqual(lines["bracket core hatch"], 0)
        self.assertGreater(lines["bracket downskin hatch"], 50)
        self.assertGreater(lines["bracket upskin hatch"], 50)

    def test_figures(self):
        plain = self.stats()
        self.assertNotIn("scan", plain)
        self.assertEqual(plain["seconds"]["scan"], 0)
        stats = self.stats("--scan", *HATCHED)
        for key in ("points", "contours", "volume_mm3"):
            self.assertEqual(stats[key], plain[key])
        scan = stats["scan"]
        self.assertEqual(plain["points"], 4 * 8, "four corners of each layer, and the diagonals of sides")
        self.assertEqual(scan["contour_vectors"], 2 * 4 * 4, "where the beam need not stop at diagonals")
        self.assertEqual(list(scan["regions"]), ["core", "upskin", "downskin"])
        self.assertAlmostEqual(scan["energy_j_mm3"], scan["energy_j"] / 240)
        self.assertEqual(scan["strategy"]["hatch"]["distance"], 0.2)
        self.assertEqual(scan["strategy"]["upskin"]["layers"], 2)
        for key in ("contour_vectors", "hatch_vectors"):
            self.assertEqual(sum(region[key] for region in scan["regions"].values()), scan[key])
            self.assertEqual(sum(layer["scan"][key] for layer in stats["layers"]), scan[key])
        for key in ("marked_mm", "jumped_mm", "build_seconds", "energy_j"):
            self.assertAlmostEqual(sum(region[key] for region in scan["regions"].values()), scan[key])
            self.assertAlmostEqual(sum(layer["scan"][key] for layer in stats["layers"]), scan[key])
            self.assertGreater(scan[key], 0)
        # Contours of 9.9 and 9.7 mm by 5.9 and 5.7 mm, at 120 W and 500 mm/s.
        contours = self.stats("--scan", "--contours", "2", "--pattern", "lines", "--shortest", "100")["scan"]
        self.assertAlmostEqual(contours["marked_mm"], 4 * 2 * (9.9 + 5.9 + 9.7 + 5.7), places=6)
        self.assertAlmostEqual(contours["energy_j"], contours["marked_mm"] / 500 * 120, places=6)

    def test_options_go_before_the_file(self):
        self.write("s.toml", "[hatch]\ndistance = 0.3\nshortest = 0.7\n[upskin]\nlayers = 5\n")
        strategy = self.stats("--strategy", "s.toml", "--hatch-distance", "0.4", "--pattern", "lines")["scan"]["strategy"]
        self.assertEqual(strategy["hatch"]["shortest"], 0.7)
        self.assertEqual(strategy["upskin"]["layers"], 5)
        for hatch in (strategy["hatch"], strategy["upskin"]["hatch"], strategy["downskin"]["hatch"]):
            self.assertEqual((hatch["distance"], hatch["pattern"]), (0.4, "lines"))
        changed = self.stats("--scan", "--contours", "3", "--beam-offset", "0.2", "--contour-distance", "0.3", "--cell-size", "2",
                             "--hatch-angle", "10", "--hatch-turn", "-5", "--hatch-border", "0.4", "--shortest", "0.6",
                             "--skin-layers", "7")["scan"]["strategy"]
        contours, hatch = changed["contours"], changed["hatch"]
        self.assertEqual((contours["count"], contours["beam_offset"], contours["distance"]), (3, 0.2, 0.3))
        self.assertEqual([hatch[key] for key in ("cell", "angle_degrees", "turn_degrees", "border", "shortest")], [2, 10, -5, 0.4, 0.6])
        self.assertEqual((changed["upskin"]["layers"], changed["downskin"]["layers"]), (7, 7))

    def plate_3mf(self, name="plate.3mf"):
        """A bracket, and a foot beside it that is marked as support."""
        def box(number, attributes, x):
            corners = [(x + i % 2 * 4, i // 2 % 2 * 3, i // 4 * 2) for i in range(8)]
            faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6),
                     (1, 3, 5), (3, 7, 5)]
            return (f'<object id="{number}" {attributes}><mesh><vertices>'
                    + "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in corners) + "</vertices><triangles>"
                    + "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces) + "</triangles></mesh></object>")
        model = ('<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
                 + box(1, 'name="bracket"', 0) + box(2, 'name="foot" type="support"', 10)
                 + '</resources><build><item objectid="1"/><item objectid="2"/></build></model>')
        with zipfile.ZipFile(self.path(name), "w") as archive:
            archive.writestr("[Content_Types].xml", '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default '
                             'Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default '
                             'Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>')
            archive.writestr("_rels/.rels", '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                             '<Relationship Id="m" Target="/3D/3dmodel.model" '
                             'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
            archive.writestr("3D/3dmodel.model", model)

    def test_what_a_3mf_file_marks_as_support_is_exposed_as_such(self):
        self.plate_3mf()
        self.write("s.toml", "[upskin]\nlayers = 1\n[support.contours]\ncount = 2\n[support.hatch]\ndistance = 0.5\n")
        options = ["--layer-height", "1", "--strategy", "s.toml", "--hatch-distance", "0.3"]
        labels = ["bracket core hatch", "bracket upskin hatch", "bracket core contour 1", "foot support hatch",
                  "foot support contour 2", "foot support contour 1"]
        for name in ("job.json", "job.cli", "job.ilt", "job.ovf", "job.3mf"):
            chosen = ["--format", "3mf-toolpath"] if name == "job.3mf" else []
            result = self.succeed("slice", "plate.3mf", "--include", "support", "-o", name, *chosen, *options, "--stats", "stats.json")
            self.assertEqual(result.err, self.parameters_left_out(name, 6))
            self.succeed("convert", name, "back.json")
            self.assertEqual([part["label"] for part in json.loads(self.bytes_of("back.json"))["parts"]], labels)
        stats = json.loads(self.bytes_of("stats.json"))["scan"]
        self.assertEqual(list(stats["regions"]), ["core", "upskin", "support"])
        self.assertEqual(stats["regions"]["support"]["contour_vectors"], 2 * stats["regions"]["core"]["contour_vectors"])
        # Contours of 3.9 and 3.7 mm by 2.9 and 2.7 mm; the hatch is 3.6 mm by 2.6 mm.
        support = stats["regions"]["support"]["marked_mm"] / 2
        self.assertAlmostEqual(support, 2 * (3.9 + 2.9 + 3.7 + 2.7) + 3.6 * 2.6 / 0.5, delta=4)
        self.assertEqual(stats["strategy"]["support"]["hatch"]["distance"], 0.5)
        self.assertEqual(stats["strategy"]["hatch"]["distance"], 0.3)
        # Without being asked for they are left out.
        result = self.succeed("slice", "plate.3mf", "-o", "job.json", *options)
        self.assertIn("support", result.err)
        self.assertNotIn("support", self.bytes_of("job.json").decode())

    def test_slices_of_3mf_keep_the_mark_of_supports(self):
        self.plate_3mf()
        self.succeed("slice", "plate.3mf", "--include", "support", "-o", "sliced.json", "--layer-height", "1", "--scan", *HATCHED)
        self.succeed("slice", "plate.3mf", "--include", "support", "-o", "layers.3mf", "--layer-height", "1")
        self.succeed("convert", "layers.3mf", "again.3mf")
        self.succeed("scan", "again.3mf", "-o", "scanned.json", *HATCHED)
        sliced, scanned = (json.loads(self.bytes_of(name))["parts"] for name in ("sliced.json", "scanned.json"))
        self.assertEqual([part["label"] for part in scanned], [part["label"] for part in sliced])
        self.assertIn("foot support hatch", [part["label"] for part in scanned])

    def test_names_of_vectors_without_parameters_are_kept(self):
        self.succeed("slice", "part.stl", "--label", "bracket", "-o", "job.npz", "--layer-height", "1", "--scan", *HATCHED)
        self.succeed("convert", "job.npz", "job.json")
        for name in ("back.ovf", "back.ilt", "back.3mf"):
            chosen = ["--format", "3mf-toolpath"] if name == "back.3mf" else []
            self.succeed("convert", "job.npz", name, *chosen)
            self.succeed("convert", name, "back.json")
            job, back = (json.loads(self.bytes_of(file)) for file in ("job.json", "back.json"))
            # A part without vectors has no place in these.
            used = [part for i, part in enumerate(job["parts"])
                    if any(any(map(layer["parts"][i].get, ("rings", "chains", "hatches"))) for layer in job["layers"])]
            self.assertEqual(back["parts"], job["parts"] if name == "back.ilt" else used, name)

    def test_any_file_can_be_said_to_be_a_support(self):
        self.succeed("slice", "part.stl", "part.stl", "--support", "--translate", "20,0,0", "--label", "foot", "-o", "job.json",
                     "--layer-height", "1", "--scan")
        self.assertEqual([part["label"] for part in json.loads(self.bytes_of("job.json"))["parts"]],
                         ["part core hatch", "part core contour 1", "foot support hatch", "foot support contour 1"])
        self.write("job.toml", '[[input]]\npath = "part.stl"\n[[input]]\npath = "part.stl"\nsupport = true\ntranslate = [20, 0, 0]\n'
                               'label = "foot"\n')
        self.succeed("slice", "--config", "job.toml", "-o", "configured.json", "--layer-height", "1", "--scan")
        self.assertEqual(self.bytes_of("configured.json"), self.bytes_of("job.json"))
        shard = ["slice", "part.stl", "-o", "a.cli", "--shard", "1/2", "--resume", "--layer-height", "1", "--scan"]
        self.assertIn("sliced", self.succeed(*shard).text)
        self.assertIn("sliced", self.succeed(*shard, "--support").text)  # it is no longer what was asked for

    def test_options_that_make_no_sense(self):
        self.fail_with(2, "--hatch-distance goes with --scan or --strategy", "slice", "part.stl", "-o", "x.cli", "--hatch-distance", "1")
        for option, value in {"--hatch-distance": "-1", "--beam-offset": "-1", "--contour-distance": "0", "--contours": "101",
                              "--cell-size": "0", "--hatch-border": "-1", "--shortest": "-0.1", "--skin-layers": "1001"}.items():
            self.fail_with(2, f"{option} is {value}, but has to be", "slice", "part.stl", "-o", "x.cli", "--scan", option, value)
        self.fail_with(2, "--pattern: \"stripe\" is none of .*did you mean stripes", "slice", "part.stl", "-o", "x.cli", "--scan",
                       "--pattern", "stripe")
        self.fail_with(2, "--contours: ", "slice", "part.stl", "-o", "x.cli", "--scan", "--contours", "-1")
        self.fail_with(2, "--cell-size is 0.1, but has to be above 0.2, twice the overlap", "slice", "part.stl", "-o", "x.cli", "--scan",
                       "--cell-size", "0.1")
        self.write("s.toml", "[upskin.hatch]\noverlap = 0.5\n")
        self.fail_with(2, "--cell-size is 0.7, but has to be above 1, twice the overlap", "slice", "part.stl", "-o", "x.cli",
                       "--strategy", "s.toml", "--cell-size", "0.7")

    def test_the_same_bytes_for_any_division(self):
        self.succeed("make", "sphere", "--size", "12", "--detail", "3", "-o", "ball.stl")
        options = ["--layer-height", "0.5", "--scan", *HATCHED]
        self.succeed("slice", "ball.stl", "-o", "whole.cli", *options, "--threads", "1")
        self.succeed("slice", "ball.stl", "-o", "threads.cli", *options, "--threads", "4")
        self.assertEqual(self.bytes_of("threads.cli"), self.bytes_of("whole.cli"))
        shards = [f"shard.{i}.cli" for i in (1, 2, 3)]
        for i, name in enumerate(shards, 1):
            self.succeed("slice", "ball.stl", "-o", name, *options, "--shard", f"{i}/3", "--resume")
        self.succeed("merge", "merged.cli", *shards)
        self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"))
        self.path("parts").mkdir()
        self.path("ball.stl").rename(self.path("parts/ball.stl"))
        self.succeed("slice", "--batch", "parts", "-o", "out", "--format", "cli", *options)
        self.assertEqual(self.bytes_of("out/ball.cli"), self.bytes_of("whole.cli"))

    def test_a_finished_shard_is_sliced_again_where_its_strategy_is_another(self):
        command = ["slice", "part.stl", "-o", "a.cli", "--shard", "1/2", "--resume", "--layer-height", "1", "--strategy", "s.toml"]
        self.write("s.toml", "[hatch]\ndistance = 0.3\n")
        self.assertIn("sliced", self.succeed(*command).text)
        self.write("s.toml", "# the same in other words\n[hatch]\ndistance = 0.30\n")
        self.assertIn("is finished", self.succeed(*command).text)
        self.write("s.toml", "[hatch]\ndistance = 0.4\n")
        self.assertIn("sliced", self.succeed(*command).text)

    def test_chosen_layers_have_the_vectors_of_the_whole(self):
        for name, layers in (("whole.npz", ":"), ("few.npz", "1:3")):
            self.succeed("slice", "part.stl", "-o", name, "--layer-height", "1", "--layers", layers, "--scan", *HATCHED)
            self.succeed("convert", name, f"{name}.json")
        whole, few = (json.loads(self.bytes_of(f"{name}.npz.json"))["layers"] for name in ("whole", "few"))
        self.assertEqual(few, whole[1:3])

    def test_what_a_format_has_no_place_for_is_counted(self):
        for name in ("job.slc", "job.3mf", "job.svg", "job.dxf", "job.geojson"):
            result = self.succeed("slice", "part.stl", "-o", name, "--layer-height", "2", "--scan")
            self.assertRegex(result.err, rf"(?m)^lamella: warning: {name}: \d+ hatch lines were left out, the lowest at z = 1 mm: the "
                                         "format cannot store them$")
            self.fail_with(4, "hatch lines were left out", "slice", "part.stl", "-o", f"x{name}", "--layer-height", "2", "--scan",
                           "--strict")

    # ---------------------------------------------------------------------------------- layers that are there

    def test_layers_that_are_there_have_the_vectors_of_slicing(self):
        self.succeed("slice", "part.stl", "part.stl", "--translate", "20,0,0", "-o", "layers.npz", "--layer-height", "1")
        self.succeed("slice", "part.stl", "part.stl", "--translate", "20,0,0", "-o", "sliced.json", "--layer-height", "1", "--scan", *HATCHED)
        result = self.succeed("scan", "layers.npz", "-o", "scanned.json", "--stats", "stats.json", *HATCHED)
        self.assertRegex(result.text, r"scanned\.json: 4 layers from layers\.npz \(npz\) as json, .*\n  [\d,]+ vectors, ")
        self.assertEqual(json.loads(self.bytes_of("scanned.json"))["layers"], json.loads(self.bytes_of("sliced.json"))["layers"])
        stats = json.loads(self.bytes_of("stats.json"))
        sliced = self.stats("part.stl", "--translate", "20,0,0", "--scan", *HATCHED)
        for key in ("hatch_vectors", "jumped_mm", "energy_j", "energy_j_mm3", "regions", "strategy"):
            self.assertEqual(stats["scan"][key], sliced["scan"][key])
        self.assertEqual([layer["scan"] for layer in stats["layers"]], [layer["scan"] for layer in sliced["layers"]])

    def test_what_no_vectors_are_made_of_is_counted(self):
        self.succeed("slice", "part.stl", "-o", "vectors.json", "--scan", "--layer-height", "2")
        self.fail_with(3, r"holds scan vectors already \(part core hatch\)", "scan", "vectors.json", "-o", "x.cli")
        # Hatches of files that call them otherwise.
        self.write("hatched.json", self.bytes_of("vectors.json").replace(b"part core", b"hatched"))
        self.assertRegex(self.succeed("scan", "hatched.json", "-o", "again.cli").err, r"\d+ hatch lines left out: layers are hatched anew")
        self.fail_with(4, "hatched anew", "scan", "hatched.json", "-o", "x.cli", "--strict")
        self.write("open.stl", binary_stl(open_box(3, 4, 5)))
        self.succeed("slice", "open.stl", "-o", "open.json", "--layer-height", "1")
        result = self.succeed("scan", "open.json", "-o", "open.cli", "--stats", "stats.json")
        self.assertRegex(result.err, r"open\.json: 5 open contours left out in 5 of 5 layers, first at z = 0\.5 mm: only closed contours")
        stats = json.loads(self.bytes_of("stats.json"))
        self.assertEqual(stats["open_gaps"], 5)
        self.assertGreater(stats["longest_open_gap_mm"], 0)
        self.fail_with(4, "open.json: 5 open contours left out", "scan", "open.json", "-o", "x.cli", "--strict")
        self.succeed("slice", "open.stl", "part.stl", "--translate", "20,0,0", "-o", "two.npz", "--layer-height", "1")
        self.assertRegex(self.succeed("scan", "two.npz", "-o", "two.cli").err, r'left out in 5 of 5 layers of the part "open", first')

    def test_an_accepted_area_that_is_no_area_is_refused_with_its_line(self):
        self.box()
        for value in "-1", "nan", "inf":
            self.write("bad.toml", f"# areas\naccepted_mm2 = {value}\n")
            for command in (["strategy", "check", "bad.toml"], ["slice", "box.stl", "--strategy", "bad.toml", "-o", "x.cli"]):
                with self.subTest(value=value, command=command):
                    self.fail_with(2, f"bad.toml:2: accepted_mm2 is {value}, but has to be 0 or more", *command)

    def test_material_that_no_vector_reaches_is_measured(self):
        self.write("wall.stl", binary_stl(box_triangles(0.08, 6, 4)))
        self.write("none.toml", '[contours]\nthin_walls = "leave out"\n')
        slicing = ["slice", "part.stl", "wall.stl", "--translate", "20,0,0", "--layer-height", "1"]
        leaving = ["--strategy", "none.toml"]
        thin = r"1\.92 mm2 of material on 4 layers, the lowest at z = 0\.5 mm, are reached by no vector: it is too narrow .*; accepted_mm2 of the strategy says"
        result = self.succeed(*slicing, *leaving, "-o", "job.json", "--stats", "stats.json")
        self.assertRegex(result.err, f"lamella: warning: wall.stl: {thin}")
        self.assertRegex(result.text, r"(?m)^scan .*, 1\.92 mm2 not reached$")
        stats = json.loads(self.bytes_of("stats.json"))
        self.assertAlmostEqual(stats["scan"]["unreached_mm2"], 1.92, places=4)
        self.assertEqual(stats["scan"]["unreached_layers"], 4)
        for layer in stats["layers"]:
            self.assertAlmostEqual(layer["scan"]["unreached_mm2"], 0.48, places=4)
        self.fail_with(4, "wall.stl: " + thin, *slicing, *leaving, "-o", "x.ilt", "--strict")
        self.succeed(*slicing, "-o", "layers.npz")
        result = self.succeed("scan", "layers.npz", "-o", "again.json", "--stats", "stats.json", *leaving)
        of_wall = thin.replace("layers, the", 'layers of the part "wall", the')
        self.assertRegex(result.err, f"layers.npz: {of_wall}")
        self.assertAlmostEqual(json.loads(self.bytes_of("stats.json"))["scan"]["unreached_mm2"], 1.92, places=4)
        self.fail_with(4, "error: layers.npz: " + of_wall, "scan", "layers.npz", "-o", "x.ilt", "--strict", *leaving)
        self.fail_with(4, "error: standard input: " + of_wall, "scan", "-", "-o", "x.ilt", "--strict", *leaving,
                       stdin=self.bytes_of("layers.npz"))
        self.write("more.toml", 'accepted_mm2 = 0.5\n[contours]\nthin_walls = "leave out"\n')
        self.succeed(*slicing, "--strategy", "more.toml", "-o", "y.ilt", "--strict")
        self.path("parts").mkdir()
        self.write("parts/wall.stl", self.bytes_of("wall.stl"))
        record = self.succeed("slice", "--batch", "parts", "-o", "out", "--format", "ilt", "--layer-height", "1", *leaving).json()
        self.assertEqual(len([warning for warning in record["warnings"] if "reached by no vector" in warning]), 1)

    def test_a_thin_wall_has_a_line_in_every_format_of_jobs(self):
        self.write("wall.stl", binary_stl(box_triangles(0.08, 6, 4)))
        self.succeed("slice", "wall.stl", "--layer-height", "1", "--scan", "--stats", "stats.json", "-o", "job.json")
        scan = json.loads(self.bytes_of("stats.json"))["scan"]
        self.assertEqual((scan["contour_vectors"], scan["hatch_vectors"], scan["unreached_layers"]), (4, 0, 0))
        self.assertAlmostEqual(scan["marked_mm"], 4 * 5.92, delta=0.1)
        for name in ("job.cli", "job.ilt", "job.ovf", "job.build.3mf", "job.json", "job.npz"):
            format = ["--format", "3mf-toolpath"] if name.endswith("3mf") else []
            self.succeed("slice", "wall.stl", "--layer-height", "1", "--scan", "-o", name, *format)
            self.assertIn("ok", self.succeed("verify", name, "--mesh", "wall.stl", "--scan").text)
            self.succeed("convert", name, "back.json")
            for layer in json.loads(self.bytes_of("back.json"))["layers"]:
                vectors = [part for part in layer["parts"] if part.get("hatches")]
                self.assertEqual([len(part["hatches"]) for part in vectors], [4], name)

    def test_strict_succeeds_where_formats_lose_nothing_that_somebody_chose(self):
        slicing = ["slice", "part.stl", "--layer-height", "1", "--strict"]
        self.write("own.toml", "[parameters.hatch]\nspot_mm = 0.1\njump_speed_mm_s = 4000\n")
        for name, keeps in (("job.ilt", []), ("job.ovf", []), ("job.build.3mf", ["--format", "3mf-toolpath"])):
            self.assertEqual(self.succeed(*slicing, "--scan", "-o", name, *keeps).err, "")
        self.fail_with(4, "jump speeds, delays and spot sizes were left out for 1 exposure", *slicing, "--strategy", "own.toml", "-o", "x.ilt")
        self.fail_with(4, "spot sizes were left out for 1 exposure", *slicing, "--strategy", "own.toml", "-o", "x.ovf")
        self.succeed(*slicing, "--strategy", "own.toml", "-o", "x.build.3mf", "--format", "3mf-toolpath")
        for name in ("x.cli", "x.json", "x.npz"):
            self.fail_with(4, "power and speed, were left out", *slicing, "--scan", "-o", name)

    def test_rings_that_bound_no_material_are_reported(self):
        self.write("inverted.stl", binary_stl([t[::-1] for t in box_triangles(5, 5, 3)]))
        self.succeed("slice", "inverted.stl", "-o", "layers.npz", "--layer-height", "1")
        lost = r"3 rings bound no material in 3 of 3 layers, first at z = 0\.5 mm \(75 mm3 lost\): .*; converting them with --fill nonzero "
        result = self.succeed("scan", "layers.npz", "-o", "job.json", "--stats", "stats.json")
        self.assertRegex(result.err, rf"layers\.npz: {lost}")
        stats = json.loads(self.bytes_of("stats.json"))
        self.assertEqual([stats["inverted_rings"], stats["inverted_mm3"]], [3, 75])
        self.fail_with(4, lost, "scan", "layers.npz", "-o", "x.json", "--strict")
        self.succeed("convert", "layers.npz", "turned.npz", "--fill", "nonzero")
        self.assertNotIn("turned.npz", self.succeed("scan", "turned.npz", "-o", "job.json").err)

    def test_halves_of_rings_that_cross_themselves_are_reported(self):
        self.write("bow_tie.json", '{"format":"lamella layers","version":1,"units":"mm","parts":[{"label":"part"}],"layers":'
                                   '[{"index":0,"z":0.05,"bottom":0,"top":0.1,"parts":[{"rings":[[0,0,10,10,10,0,0,10]]}]}]}')
        lost = r"bow_tie\.json: 1 ring bounds no material in 1 of 1 layer, first at z = 0\.05 mm \(2\.5 mm3 lost\)"
        for words in [["scan", "bow_tie.json", "-o", "x.json"], ["convert", "bow_tie.json", "x.cli", "--offset=-0.1"]]:
            self.assertRegex(self.succeed(*words).err, rf"^lamella: warning: {lost}")
            self.fail_with(4, lost, *words, "--strict")

    def test_bodies_without_vectors_are_found_by_the_mesh(self):
        inverted = [tuple((x + 9, y, z) for x, y, z in t[::-1]) for t in box_triangles(6, 6, 3)]
        self.write("two.stl", binary_stl(box_triangles(6, 6, 3) + inverted))
        for job in ["job.ovf", "job.cli", "job.ilt"]:
            self.succeed("slice", "two.stl", "-o", job, "--layer-height", "1", "--scan")
            for words in [[], ["--scan"]]:
                result = self.run_program("verify", job, "--mesh", "two.stl", *words, "--json")
                self.assertEqual(result.code, 4)
                vectors = result.json()["vectors"]
                self.assertEqual([vectors["inverted_rings"], round(vectors["inverted_mm3"], 6)], [3, 108])
                self.assertRegex(vectors["findings"][0], r"^3 rings of the mesh bound no material and have no vectors.* the first in layer 0 ")
            self.succeed("slice", "two.stl", "-o", job, "--layer-height", "1", "--scan", "--fill", "nonzero")
            self.succeed("verify", job, "--mesh", "two.stl", "--fill", "nonzero")

    def test_what_a_file_of_vectors_holds_is_reported(self):
        stats = self.stats("--scan", *HATCHED)["scan"]
        for name in ("job.ovf", "job.json"):
            self.succeed("slice", "part.stl", "-o", name, "--layer-height", "1", "--scan", *HATCHED)
            info = self.succeed("info", name, "--json").json()
            self.assertNotIn("volume_mm3", info)
            for key in ("contour_vectors", "hatch_vectors"):
                self.assertEqual(info[key], stats[key])
            for key in ("marked_mm", "jumped_mm"):
                self.assertAlmostEqual(info[key] / stats[key], 1, places=4)
            if name == "job.ovf":
                self.assertAlmostEqual(info["build_seconds"] / stats["build_seconds"], 1, places=4)
            else:  # which has no place for speeds
                self.assertIsNone(info["build_seconds"])
                self.assertIsNone(info["energy_j"])
            text = self.succeed("info", name).text
            self.assertRegex(text, r"(?m)^  in hatches  [\d,]+ vectors$")
            self.assertNotIn("volume", text)

    def test_steps_are_for_contours(self):
        self.succeed("slice", "part.stl", "-o", "job.ovf", "--layer-height", "1", "--scan")
        for step in (["--offset", "0.1"], ["--fill", "nonzero"], ["--simplify", "0.1"], ["--min-area", "1"], ["--largest-only"]):
            self.fail_with(2, "job.ovf: holds scan vectors .part core hatch.; steps such as --fill .* before vectors are made", "convert", "job.ovf", "x.cli", *step)
            self.fail_with(2, "job.ovf: holds scan vectors .part core hatch.; steps such as --fill .* before vectors are made", "view", "job.ovf", "-o", "x.html", *step)
        self.succeed("convert", "job.ovf", "job.ilt")

    def test_jobs_of_machines_keep_what_is_exposed(self):
        for name, other in (("job.ilt", "job.ovf"), ("job.ovf", "job.ilt")):
            options = ["--layer-height", "1", "--scan", *HATCHED, "--skin-layers", "1"]
            self.assertEqual(self.succeed("slice", "part.stl", "-o", name, *options).err, self.parameters_left_out(name, 5))
            self.succeed("convert", name, f"from_{other}", *(["--strict"] if other == "job.ovf" else []))
            self.succeed("convert", f"from_{other}", "again.json")
            self.succeed("convert", name, "once.json")
            again, once = (json.loads(self.bytes_of(f"{kind}.json")) for kind in ("again", "once"))
            self.assertEqual(len(again["parts"]), len(once["parts"]))
            shards = [f"{i}.{name}" for i in (1, 2)]
            for i, shard in enumerate(shards, 1):
                self.succeed("slice", "part.stl", "-o", shard, *options, "--shard", f"{i}/2")
            self.succeed("merge", f"merged.{name}", *shards)
            self.succeed("convert", f"merged.{name}", "merged.json")
            self.assertEqual(json.loads(self.bytes_of("merged.json"))["layers"], once["layers"])
            self.fail_with(3, "holds scan vectors already", "scan", name, "-o", "x.cli")

    def test_scanning_says_what_is_missing(self):
        self.fail_with(2, "needs FILE", "scan", "-o", "x.cli")
        self.succeed("slice", "part.stl", "-o", "layers.cli", "--layer-height", "1")
        self.fail_with(2, "where should the vectors go", "scan", "layers.cli")
        self.fail_with(3, "missing.cli", "scan", "missing.cli", "-o", "x.cli")
        self.fail_with(2, "--hatch-distance is 0, but has to be above 0", "scan", "layers.cli", "-o", "x.cli", "--hatch-distance", "0")
        self.fail_with(2, "overwrite", "scan", "layers.cli", "-o", "layers.cli")


if __name__ == "__main__":
    main()
