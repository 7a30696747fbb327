"""Build plates: several files, copies, and where each of them stands."""

import re

from program import ProgramTest, binary_stl, box_triangles, main, open_box


def amf(objects):
    """A file of objects with these names and triangles."""
    text = '<?xml version="1.0"?><amf unit="millimeter">'
    for number, (name, triangles) in enumerate(objects):
        corners = [corner for triangle in triangles for corner in triangle]
        vertices = "".join("<vertex><coordinates><x>%g</x><y>%g</y><z>%g</z></coordinates></vertex>" % c for c in corners)
        volume = "".join(f"<triangle><v1>{i}</v1><v2>{i + 1}</v2><v3>{i + 2}</v3></triangle>" for i in range(0, len(corners), 3))
        text += (f'<object id="{number}"><metadata type="name">{name}</metadata><mesh><vertices>{vertices}</vertices>'
                 f"<volume>{volume}</volume></mesh></object>")
    return text + "</amf>"


def moved(triangles, x):
    return [tuple((px + x, py, pz) for px, py, pz in t) for t in triangles]


def turned(triangles):
    return [t[::-1] for t in triangles]


class Plate(ProgramTest):
    def setUp(self):
        super().setUp()
        self.succeed("make", "box", "--size", "10,20,5", "-o", "box.stl")
        self.succeed("make", "sphere", "-o", "ball.stl")

    def stats(self, *words):
        return self.succeed("slice", *words, "--stats", "-", "--layer-height", "1").json()

    def test_options_hold_for_the_file_before_them(self):
        stats = self.stats("box.stl", "--translate", "5,0,0", "box.stl", "--rotate-z", "90")
        low = [part["bbox"][0] for part in stats["parts"]]
        alone = self.stats("box.stl")["input"]["bbox"][0]
        self.assertAlmostEqual(low[0][0], alone[0] + 5)
        self.assertAlmostEqual(low[0][1], alone[1])
        turned = self.stats("box.stl", "--rotate-z", "90")["input"]["bbox"]
        self.assertEqual(stats["parts"][1]["bbox"], turned)

    def test_a_negative_file_is_subtracted_from_all_others(self):
        self.succeed("make", "box", "--size", "4,4,20", "--translate", "0,0,-5", "-o", "drill.stl")
        words = ["box.stl", "box.stl", "--translate", "30,0,0", "drill.stl", "--translate", "2,2,0", "--copies", "2",
                 "--spacing", "26", "--negative"]
        stats = self.stats(*words)
        self.assertEqual(len(stats["parts"]), 2)
        for layer in stats["layers"]:
            self.assertAlmostEqual(layer["area_mm2"], 2 * (200 - 16))
        self.succeed("slice", *words, "-o", "whole.cli", "--layer-height", "0.5")
        for i in [1, 2]:
            self.succeed("slice", *words, "-o", f"{i}.cli", "--layer-height", "0.5", "--shard", f"{i}/2")
        self.succeed("merge", "merged.cli", "1.cli", "2.cli")
        self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"))
        self.fail_with(2, "drill.stl: is negative, and there is no other file to subtract it from",
                       "slice", "drill.stl", "--negative", "-o", "x.cli")
        self.fail_with(2, "drill.stl: is given as a support and as negative",
                       "slice", "box.stl", "drill.stl", "--negative", "--support", "-o", "x.cli")

    def test_options_before_the_first_file_hold_for_all(self):
        stats = self.stats("--scale", "2", "box.stl", "ball.stl", "--translate", "100,0,0")
        for part, name in zip(stats["parts"], ["box.stl", "ball.stl"]):
            alone = self.stats(name, "--scale", "2")["input"]["bbox"]
            size = [high - low for low, high in zip(*part["bbox"])]
            self.assertEqual(size, [high - low for low, high in zip(*alone)])

    def test_a_part_has_the_layers_that_it_has_alone(self):
        height = max(self.stats(name)["input"]["bbox"][1][2] for name in ["box.stl", "ball.stl"])
        low = min(self.stats(name)["input"]["bbox"][0][2] for name in ["box.stl", "ball.stl"])
        self.path("z.txt").write_text("\n".join(str(low + (height - low) * (i + 0.5) / 20) for i in range(20)))
        words = ["--z-list", "z.txt", "--stats", "-"]
        plate = self.succeed("slice", "box.stl", "ball.stl", "--translate", "50,1,0", *words).json()
        box = self.succeed("slice", "box.stl", *words).json()
        ball = self.succeed("slice", "ball.stl", "--translate", "50,1,0", *words).json()
        for together, first, second in zip(plate["layers"], box["layers"], ball["layers"]):
            self.assertEqual(together["contours"], first["contours"] + second["contours"])
            self.assertEqual(together["points"], first["points"] + second["points"])
            self.assertAlmostEqual(together["area_mm2"], first["area_mm2"] + second["area_mm2"], places=9)
        self.assertEqual([part["points"] for part in plate["parts"]], [box["points"], ball["points"]])

    def test_copies_stand_side_by_side_and_are_equal(self):
        stats = self.stats("box.stl", "--copies", "3", "--spacing", "2.5")
        boxes = [part["bbox"] for part in stats["parts"]]
        self.assertEqual([part["label"] for part in stats["parts"]], ["box", "box 2", "box 3"])
        (x, y, _), _ = boxes[0]
        self.assertEqual(boxes[1][0][:2], [x + 12.5, y])
        self.assertEqual(boxes[2][0][:2], [x, y + 22.5])
        self.assertEqual(len({part["points"] for part in stats["parts"]}), 1)
        self.assertAlmostEqual(stats["volume_mm3"], 3 * self.stats("box.stl")["volume_mm3"], places=6)

    def test_triangles_and_options_are_reported_as_they_were_given(self):
        self.write("twice.stl", binary_stl(2 * box_triangles(1, 2, 3)))
        result = self.succeed("slice", "twice.stl", "--drop-duplicates", "--copies", "3", "-o", "boxes.cli")
        self.assertIn("twice.stl: 24 triangles", result.text)
        stats = self.stats("box.stl", "--translate", "5,0,0", "ball.stl", "--rotate-z", "90")
        self.assertEqual(stats["input"]["triangles"], sum(one["triangles"] for one in stats["inputs"]))
        self.assertNotIn("translate", stats["options"])
        self.assertNotIn("rotate-z", stats["options"])
        self.assertEqual(self.stats("--translate", "5,0,0", "box.stl", "ball.stl")["options"]["translate"], [5, 0, 0])
        self.assertEqual(self.stats("box.stl", "--translate", "5,0,0")["options"]["translate"], [5, 0, 0])

    def test_the_result_does_not_depend_on_threads(self):
        for name in ["a.cli", "a.svg"]:
            contents = []
            for threads in [1, 2, 5]:
                self.succeed("slice", "box.stl", "--copies", "2", "ball.stl", "-o", name, "--threads", threads)
                contents.append(self.path(name).read_bytes())
            self.assertEqual(len(set(contents)), 1)

    def test_parts_stay_apart_in_files_that_can(self):
        self.succeed("slice", "box.stl", "--label", "crate", "ball.stl", "--copies", "2", "-o", "a.cli")
        labels = re.findall(rb'\$\$LABEL/(\d),"(.*?)"', self.path("a.cli").read_bytes())
        self.assertEqual(labels, [(b"1", b"crate"), (b"2", b"ball"), (b"3", b"ball 2")])

    def test_a_label_that_the_format_has_no_place_for_is_reported(self):
        words = ["slice", "box.stl", "--label", "crate, small", "ball.stl", "--label", "b\u00e4ll"]
        result = self.succeed(*words, "-o", "a.cli")
        self.assertIn('a.cli: 2 labels were changed, the first from "crate, small" to "crate_ small"', result.err)
        self.assertEqual(self.succeed(*words, "-o", "a.svg", "--strict").err, "")
        self.path("a.cli").unlink()
        self.fail_with(4, 'a.cli: 2 labels were changed, the first from "crate, small"', *words, "-o", "a.cli", "--strict")

    def test_a_part_outside_of_the_build_volume_is_named(self):
        words = ["-o", "a.cli", "--build-volume", "100,100,50"]
        self.succeed("slice", "box.stl", "--translate", "50,50,10", *words)
        self.path("a.cli").unlink()
        self.fail_with(2, r"ball\.stl: reaches from .* build volume", "slice", "box.stl", "--translate", "50,50,10", "ball.stl",
                       "--translate", "99,50,20", *words)
        self.fail_with(2, r'box\.stl, part "box 2": reaches from .* build volume', "slice", "box.stl", "--translate", "50,50,10",
                       "--copies", "3", "--spacing", "40", *words)
        self.fail_with(2, r"^lamella: error: ball\.stl: reaches from", "slice", "ball.stl", *words)

    def test_warnings_name_the_file_and_the_part_that_have_the_defect(self):
        self.write("torn.stl", binary_stl(moved(open_box(5, 5, 5), 40)))
        self.write("turned.stl", binary_stl(turned(moved(box_triangles(5, 5, 5), 60))))
        cut = ["--layer-height", "1", "-o", "x.cli"]
        open_chains = "5 open chains in 5 of 5 layers, first at z = 0\\.5 mm: "
        rings = "5 rings bound no material in 5 of 5 layers, first at z = 0\\.5 mm "
        for words in [cut, [*cut, "--threads", "1"], [*cut, "--max-memory", "50M"], [*cut, "--scan"]]:
            warnings = self.succeed("slice", "box.stl", "torn.stl", "turned.stl", *words).err.splitlines()
            warnings = [warning for warning in warnings if "x.cli: " not in warning]  # of the format
            self.assertEqual(len(warnings), 2, warnings)
            self.assertRegex(warnings[0], rf"^lamella: warning: torn\.stl: {open_chains}.*; see lamella info torn\.stl$")
            self.assertRegex(warnings[1], rf"^lamella: warning: turned\.stl: {rings}.*; see lamella info turned\.stl$")
        self.path("x.cli").unlink()
        self.fail_with(4, r"torn\.stl: the mesh has defects", "slice", "box.stl", "torn.stl", *cut, "--strict")
        inspected = self.succeed("slice", "box.stl", "torn.stl", *cut, "--inspect")
        self.assertIn("has defects; see lamella info torn.stl", inspected.text)
        # All copies of a part have what it has.
        warning = self.succeed("slice", "box.stl", "turned.stl", "--copies", "3", *cut).err
        self.assertIn("turned.stl: 15 rings bound no material in 5 of 5 layers, first", warning)

        good = ("good", box_triangles(5, 5, 5))
        self.write("plate.amf", amf([good, ("bad", turned(moved(box_triangles(5, 5, 5), 20)))]))
        warning = self.succeed("slice", "box.stl", "plate.amf", *cut).err
        self.assertIn('plate.amf: 5 rings bound no material in 5 of 5 layers of the part "bad", first at z = 0.5 mm', warning)
        self.assertEqual(warning.count("warning"), 1)
        parts = self.stats("box.stl", "plate.amf")["parts"]
        self.assertEqual({part["label"]: part["inverted_rings"] for part in parts}, {"box": 0, "good": 0, "bad": 5})
        self.path("x.cli").unlink()
        self.fail_with(4, r'plate\.amf, part "bad": the mesh has defects: 1 inverted shell', "slice", "box.stl", "plate.amf", *cut,
                       "--strict")
        self.write("flat.amf", amf([good, ("sheet", [((0, 0, 1), (9, 0, 1), (0, 9, 1))])]))
        self.fail_with(3, r'flat\.amf, part "sheet": the mesh is flat', "slice", "box.stl", "flat.amf", *cut)

    def test_what_cannot_be(self):
        self.fail_with(2, "one at least", "slice", "box.stl", "--copies", "0", "-o", "a.cli")
        self.fail_with(5, "box.stl: 99999999999 copies of 1 part are too many: a plate holds at most 1048576 parts", "slice",
                       "box.stl", "--copies", "99999999999", "-o", "a.cli")
        self.fail_with(5, "ball.stl: 2 copies of 1 part are too many", "slice", "box.stl", "--copies", "1048575", "ball.stl",
                       "--copies", "2", "-o", "a.cli", "--spacing", "0")
        self.fail_with(2, "the mesh is 20 mm wide and lies 1e\\+50 mm away, where numbers are .* apart", "slice", "box.stl",
                       "--translate", "1e50,0,0", "-o", "a.cli")
        self.fail_with(5, "makes 5e\\+07 layers of this part .* GB of memory, above", "slice", "box.stl", "--layer-height", "1e-7",
                       "-o", "a.cli", "--max-memory", "10G")
        self.fail_with(2, "one file only", "slice", "-", "-", "-o", "a.cli")
        self.fail_with(3, "missing.stl", "slice", "box.stl", "missing.stl", "-o", "a.cli")
        self.fail_with(2, "ball.stl", "slice", "box.stl", "ball.stl", "-o", "ball.stl", "--format", "cli")
        self.fail_with(2, "no amount of memory", "slice", "box.stl", "-o", "a.cli", "--max-memory", "much")


if __name__ == "__main__":
    main()
