"""Volumes of 3MF and AMF files that are no material: negative ones are subtracted, the others left out."""

import io
import os
import zipfile

from program import ProgramTest, limited, main

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
RELATIONSHIPS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" '
    'Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
CONFIG = "Metadata/Slic3r_PE_model.config"
TRIANGLES = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (1, 3, 7), (1, 7, 5), (3, 2, 6), (3, 6, 7),
             (2, 0, 4), (2, 4, 6)]


def mesh(*boxes, flipped=()):
    """Boxes from a corner to another one, as one mesh; those whose numbers are in `flipped` are inside out."""
    vertices = triangles = ""
    for n, (low, high) in enumerate(boxes):
        for i in range(8):
            x, y, z = ((low, high)[i >> axis & 1][axis] for axis in range(3))
            vertices += f'<vertex x="{x}" y="{y}" z="{z}"/>'
        for a, b, c in TRIANGLES:
            b, c = (c, b) if n in flipped else (b, c)
            triangles += f'<triangle v1="{8 * n + a}" v2="{8 * n + b}" v3="{8 * n + c}"/>'
    return f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"


def config(*types, object_id=1):
    volumes = "".join(f'<volume firstid="{12 * i}" lastid="{12 * i + 11}"><metadata type="volume" key="volume_type" '
                      f'value="{kind}"/></volume>' for i, kind in enumerate(types))
    return f'<config><object id="{object_id}">{volumes}</object></config>'


def package(resources, build, more=None):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("_rels/.rels", RELATIONSHIPS)
        archive.writestr("3D/3dmodel.model", f'<model xmlns="{CORE}"><resources>{resources}</resources>'
                                             f'<build>{build}</build></model>')
        for name, text in (more or {}).items():
            archive.writestr(name, text)
    return content.getvalue()


BODY = ((0, 0, 0), (30, 30, 30))
ABOVE = ((-5, -5, 15), (35, 35, 55))  # takes the upper half away
HOLE = ((10, 10, -5), (20, 20, 35))
ITEM = '<item objectid="1"/>'


class Roles(ProgramTest):
    def file(self, name, kind, *boxes, build=ITEM, resources="", **flipped):
        self.write(name, package(f'<object id="1" name="block">{mesh(*boxes, **flipped)}</object>{resources}', build,
                                 {CONFIG: config("ModelPart", *[kind] * (len(boxes) - 1))}))
        return name

    def areas(self, *arguments, strict=True):
        """Of each layer, and the warnings."""
        result = self.succeed("slice", *arguments, "--layer-height", "1", "--stats", "-", *["--strict"] * strict)
        return [round(layer["area_mm2"], 9) for layer in result.json()["layers"]], result.err

    def test_negative_volumes_are_subtracted_and_others_left_out(self):
        self.file("half.3mf", "NegativeVolume", BODY, ABOVE)
        self.assertEqual(self.areas("half.3mf")[0], 15 * [900] + 15 * [0])
        self.file("hole.3mf", "NegativeVolume", BODY, HOLE, ((5, 5, 5), (15, 15, 10)))
        self.assertEqual(self.areas("hole.3mf")[0], 5 * [800] + 5 * [725] + 20 * [800])
        self.assertEqual(self.areas("half.3mf", "--include", "negative", strict=False)[0][40:45], 5 * [1600])
        for kind, word in ("ParameterModifier", "modifier"), ("SupportBlocker", "support-blocker"), \
                ("SupportEnforcer", "support-enforcer"):
            self.file("part.3mf", kind, BODY, ABOVE)
            areas, warnings = self.areas("part.3mf")
            self.assertEqual(areas, 30 * [900])
            self.assertIn(f"part.3mf: 1 body was left out as no material: 1 {word.replace('-', ' ')} (\"block\"); --include "
                          f"{word} to read it as a solid", warnings)
            areas, warnings = self.areas("part.3mf", "--include", f"support,{word}", strict=False)
            self.assertEqual(len(areas), 55)
            self.assertNotIn("left out", warnings)
        self.fail_with(2, "--include.*expected one of support, negative, modifier", "info", "part.3mf", "--include", "thing")

    def test_a_negative_volume_belongs_to_its_object_wherever_that_stands(self):
        moved = "<item objectid='1' transform='1 0 0 0 1 0 0 0 1 {} 0 0'/>"
        self.file("three.3mf", "NegativeVolume", BODY, ABOVE, build=ITEM + moved.format(100) + "<item objectid='2'/>",
                  resources=f'<object id="2">{mesh(((0, 50, 0), (10, 60, 30)))}</object>')
        result = self.succeed("slice", "three.3mf", "--layer-height", "1", "--stats", "-", "-o", "three.cli").json()
        self.assertEqual([round(layer["area_mm2"]) for layer in result["layers"]], 15 * [1900] + 15 * [100])
        self.assertEqual([part["label"] for part in result["parts"]], ["block", "block 2", "three"])
        self.assertEqual(result["parts"][0]["bbox"][1], [30, 30, 30])

    def test_all_ways_to_slice_give_the_same_bytes(self):
        self.file("part.3mf", "NegativeVolume", BODY, HOLE)
        job = ["part.3mf", "--layer-height", "1", "--copies", "3", "--offset", "0.5"]
        self.succeed("slice", *job, "-o", "whole.cli")
        for threads in 1, 3:
            self.succeed("slice", *job, "-o", "threads.cli", "--threads", threads)
            self.assertEqual(self.bytes_of("threads.cli"), self.bytes_of("whole.cli"))
        for number in 1, 2:
            self.succeed("slice", *job, "-o", f"{number}.cli", "--shard", f"{number}/2")
        self.succeed("merge", "merged.cli", "1.cli", "2.cli")
        self.assertEqual(self.bytes_of("merged.cli"), self.bytes_of("whole.cli"))
        self.succeed("slice", *job, "-o", "limit.cli", "--max-memory", "200M")
        self.assertEqual(self.bytes_of("limit.cli"), self.bytes_of("whole.cli"))
        areas = [layer["area_mm2"] for layer in self.succeed("slice", *job, "--stats", "-").json()["layers"]]
        self.assertAlmostEqual(areas[3], 3 * (31 * 31 - 9 * 9), places=6)

    def test_what_was_sliced_is_verified_against_its_file(self):
        self.file("part.3mf", "NegativeVolume", BODY, HOLE)
        self.succeed("slice", "part.3mf", "--layer-height", "1", "-o", "part.cli")
        self.succeed("verify", "part.cli", "--mesh", "part.3mf")
        solid = self.run_program("verify", "part.cli", "--mesh", "part.3mf", "--include", "negative")
        self.assertEqual(solid.code, 4)
        self.succeed("slice", "part.3mf", "--layer-height", "1", "-o", "lines.ovf", "--scan")
        self.succeed("verify", "lines.ovf", "--mesh", "part.3mf", "--scan")
        self.succeed("view", "part.3mf", "-o", "part.html")

    def test_doubts_about_negative_volumes_are_reported(self):
        self.file("part.3mf", "NegativeVolume", BODY, ABOVE, flipped=(1,))
        areas, warnings = self.areas("part.3mf", strict=False)
        self.assertEqual(areas, 30 * [900])
        self.assertRegex(warnings, "inside out|face inwards|bound no material")
        self.assertEqual(self.areas("part.3mf", "--fill", "nonzero", strict=False)[0], 15 * [900] + 15 * [0])
        self.assertEqual(self.areas("part.3mf", "--orient", strict=False)[0], 15 * [900] + 15 * [0])

    def test_info_lists_every_object_with_its_role(self):
        self.write("part.3mf", package(
            f'<object id="1" name="block">{mesh(BODY, ABOVE, HOLE)}</object><object id="2" name="foot" type="support">'
            f'{mesh(((40, 0, 0), (50, 10, 5)))}</object>', ITEM + '<item objectid="2"/>',
            {CONFIG: config("ModelPart", "NegativeVolume", "SupportBlocker")}))
        objects = {(body["role"], body["use"]): body for body in self.succeed("info", "part.3mf", "--json").json()["objects"]}
        self.assertEqual(set(objects), {("part", "read"), ("negative", "subtracted"), ("support-blocker", "left out"),
                                        ("support", "left out")})
        self.assertEqual(objects["support", "left out"], {"name": "foot", "role": "support", "triangles": 12,
                                                          "use": "left out"})
        result = self.succeed("info", "part.3mf")
        for line in ["block: part, 12 triangles, read", "block: negative volume, 12 triangles, subtracted",
                     "foot: support, 12 triangles, left out"]:
            self.assertIn(line, result.text)
        self.assertIn("2 bodies were left out as no material: 1 support (\"foot\"), 1 support blocker (\"block\"); --include "
                      "support,support-blocker to read them as solids", result.err)

    def test_info_describes_the_parts_and_not_what_negative_volumes_remove(self):
        self.file("part.3mf", "NegativeVolume", BODY, ABOVE)
        result = self.succeed("info", "part.3mf", "--json", "--report", "page.html").json()
        self.assertEqual((result["bbox"], result["volume_mm3"]), ([[0, 0, 0], [30, 30, 30]], 27000))
        self.assertIn(b"subtracted from layers, but not from this mesh", self.bytes_of("page.html"))
        text = self.succeed("info", "part.3mf").text
        for name, figure in ("volume", "27000 mm3"), ("area", "5400 mm2"):
            self.assertRegex(text, f"{name} +{figure} of the parts; negative volumes are not subtracted here, but from layers")
        self.assertNotIn("of the parts", self.succeed("info", "part.3mf", "--include", "negative").text)
        stats = self.succeed("slice", "part.3mf", "--layer-height", "1", "--stats", "-").json()
        self.assertEqual((stats["input"]["volume_mm3"], stats["volume_mm3"]), (27000, 13500))
        self.assertEqual(stats["input"]["bbox"], result["bbox"])

    def test_info_finds_the_defects_of_negative_volumes(self):
        self.file("part.3mf", "NegativeVolume", BODY, HOLE, flipped=(1,))
        found = "part.3mf: a negative volume of 12 triangles has defects: 1 inverted shell"
        self.assertIn(found, self.succeed("info", "part.3mf").err)
        strict = self.run_program("info", "part.3mf", "--strict")
        self.assertEqual(strict.code, 4, strict.err)
        self.assertIn(found, strict.err)
        self.file("whole.3mf", "NegativeVolume", BODY, HOLE)
        self.succeed("info", "whole.3mf", "--strict")

    def test_adaptive_layers_follow_the_slopes_of_negative_volumes(self):
        # A pyramid is a negative volume of the block; outside of it, its slopes do not count.
        self.file("block.3mf", "NegativeVolume", BODY)
        stats = self.succeed("slice", "block.3mf", "--adaptive", "0.1:1", "--stats", "-").json()
        layers = {"none": [layer["thickness"] for layer in stats["layers"]]}
        for name, z in ("inside", 15), ("above", 60):
            tip, rim = (15, 15, z + 8), [(5, 5, z), (25, 5, z), (25, 25, z), (5, 25, z)]
            vertices = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*p) for p in [*rim, tip])
            faces = [(0, 2, 1), (0, 3, 2), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
            block = mesh(BODY).replace("</vertices>", vertices + "</vertices>").replace("</triangles>", "".join(
                '<triangle v1="{}" v2="{}" v3="{}"/>'.format(*(8 + i for i in face)) for face in faces) + "</triangles>")
            marks = config("ModelPart", "NegativeVolume").replace('lastid="23"', 'lastid="17"')
            self.write("part.3mf", package(f'<object id="1" name="block">{block}</object>', ITEM, {CONFIG: marks}))
            stats = self.succeed("slice", "part.3mf", "--adaptive", "0.1:1", "--stats", "-").json()
            layers[name] = [layer["thickness"] for layer in stats["layers"]]
            self.assertAlmostEqual(sum(layers[name]), 30)
        self.assertEqual(layers["above"], layers["none"])
        self.assertGreater(len(layers["inside"]), 2 * len(layers["none"]))

    def test_instances_that_double_stay_within_the_memory_that_is_allowed(self):
        if "LAMELLA_SANITIZED" in os.environ:
            self.skipTest("what a sanitizer takes is not the program's")
        resources = f'<object id="1">{mesh(BODY)}</object>' + "".join(
            f'<object id="{i}"><components>{2 * f"<component objectid=&quot;{i - 1}&quot;/>"}</components></object>'.replace(
                "&quot;", '"') for i in range(2, 18))
        self.write("many.3mf", package(resources, '<item objectid="17"/>'))
        self.succeed("slice", self.box(), "-o", "box.cli")
        limit = 300_000_000
        for memory, found in ("60M", "65536 meshes"), ("90M", "786432 triangles"):
            for arguments in ["info", "many.3mf"], ["view", "many.3mf", "-o", "many.html"]:
                with self.subTest(memory=memory, arguments=arguments):
                    self.fail_with(5, f"many.3mf: .*{found}", *arguments, "--max-memory", memory, "--threads", 1,
                                   **limited(DATA=limit))
        self.fail_with(5, "65536 meshes", "verify", "box.cli", "--mesh", "many.3mf", "--max-memory", "60M", "--threads", 1,
                       **limited(DATA=limit))


    def test_items_of_the_build_are_counted_before_they_take_memory(self):
        if "LAMELLA_SANITIZED" in os.environ:
            self.skipTest("what a sanitizer takes is not the program's")
        self.write("items.3mf", package(f'<object id="1">{mesh(BODY)}</object>',
                                        '<item objectid="1" transform="1 0 0 0 1 0 0 0 1 1 2 0"/>' * 300_000))
        limit = 150_000_000
        for arguments in ["info", "items.3mf"], ["slice", "items.3mf", "-o", "a.cli"], ["view", "items.3mf", "-o", "a.html"]:
            with self.subTest(arguments=arguments):
                self.fail_with(5, "items.3mf: takes more than the 100000000 bytes of --max-memory", *arguments, "--max-memory", "100M",
                               "--threads", 1, **limited(DATA=limit))


if __name__ == "__main__":
    main()
