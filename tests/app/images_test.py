"""lamella slice and convert to pictures: folders, archives, jobs for resin printers."""

import io
import json
import os
import zipfile

from png_image import Image
from program import UNPRIVILEGED, ProgramTest, binary_stl, main, needs_posix, open_box


class Images(ProgramTest):
    def archive(self, name):
        archive = zipfile.ZipFile(io.BytesIO(self.bytes_of(name)))
        self.assertIsNone(archive.testzip())
        return archive

    def pixels(self, name):
        return b"".join(Image(self.bytes_of(name)).rows)

    def settings(self, archive, name):
        lines = archive.read(name).decode().splitlines()
        self.assertEqual(lines, sorted(lines))
        return dict(line.split(" = ", 1) if " = " in line else (line.rstrip(" ="), "") for line in lines)

    def test_nothing_else_may_lie_in_a_folder_that_is_made(self):
        self.box()
        for option, name in [("--stats", "./out/x.json"), ("--report", "./out/x.html")]:
            self.fail_with(2, f"--output and {option} contradict each other: {name} would lie in the folder", "slice",
                           "box.stl", "-o", "out", "--format", "png", option, name)

    def test_walls_too_thin_for_the_pixels_are_warned_of(self):
        # In columns 240.6 to 241.4 on both sides of the middle, where no pixel has its own middle.
        fin = lambda x: [[(x, 0, 0), (x + 0.04, 0, 0), (x + 0.04, 10, 0), (x, 10, 0)],
                         [(x, 0, 1), (x + 0.04, 0, 1), (x + 0.04, 10, 1), (x, 10, 1)]]
        lines, first = [], 1
        for low, high in [[[(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)], [(0, 0, 1), (10, 0, 1), (10, 10, 1), (0, 10, 1)]],
                          fin(12.03), fin(-12.07)]:
            lines += [f"v {x} {y} {z}" for x, y, z in low + high]
            for face in [(4, 3, 2, 1), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]:
                lines.append("f " + " ".join(str(first + i - 1) for i in face))
            first += 8
        self.write("fins.obj", "\n".join(lines))
        job = ["slice", "fins.obj", "--layer-height", "0.5", "--strict", "--pixel-size", "0.05", "--resolution", "500x500"]
        for name, options in [("x.zip", ["--format", "png-zip"]), ("x.sl1", []), ("folder", ["--format", "png"])]:
            with self.subTest(name):
                self.fail_with(4, r"[0-9.]+ mm2 of material on 2 layers, the lowest at z = 0.25 mm, are too thin for the pixels",
                               *job, *options, "--antialias", "1", "-o", name)
                self.assertEqual(self.succeed(*job, *options, "--antialias", "8", "-o", name).err, "")

    def test_a_job_needs_no_options(self):
        self.succeed("slice", self.box(), "-o", "part.sl1")
        archive = self.archive("part.sl1")
        images = [f"part{i:05}.png" for i in range(100)]
        thumbnails = ["thumbnail/thumbnail400x400.png", "thumbnail/thumbnail800x480.png"]
        self.assertEqual(archive.namelist(), images + ["config.ini", "prusaslicer.ini"] + thumbnails)
        config = self.settings(archive, "config.ini")
        self.assertEqual(int(config["numSlow"]) + int(config["numFast"]), 100)
        self.assertEqual([config[key] for key in ("action", "jobDir", "printerModel")], ["print", "part", "SL1"])
        self.assertEqual([config[key] for key in ("layerHeight", "expTime", "expTimeFirst")],
                         ["0.1", "7.5", "35"])
        self.assertEqual(config["fileCreationTimestamp"], "1970-01-01 at 00:00:00 UTC")
        self.assertAlmostEqual(float(config["usedMaterial"]), 6, delta=0.01)
        # Three first layers, ten that fade, the rest; five seconds between two.
        exposures = 3 * 35 + sum(35 - i / 11 * 27.5 for i in range(1, 11)) + 87 * 7.5
        self.assertAlmostEqual(float(config["printTime"]), exposures + 100 * 5, places=3)
        profile = self.settings(archive, "prusaslicer.ini")
        self.assertEqual([profile["display_" + key] for key in
                          ("width", "height", "pixels_x", "pixels_y", "orientation", "mirror_x", "mirror_y")],
                         ["120.96", "68.04", "2560", "1440", "portrait", "1", "0"])
        image = Image(archive.read("part00050.png"))
        self.assertEqual((image.width, image.height), (1440, 2560))
        self.assertEqual(image.chunks, ["IHDR", "IDAT", "IEND"])
        self.assertAlmostEqual(image.covered() * 0.04725 ** 2, 600, delta=0.5)

    def test_images_given_for_a_mesh_are_reported(self):
        for name in ("part.sl1", "part.zip"):
            self.succeed("slice", self.box(), "-o", name, *(["--format", "png-zip"] if name == "part.zip" else []))
            with self.subTest(name):
                self.fail_with(3, name + ": holds images of layers", "slice", name, "-o", "x.cli")

    def test_images_are_read_as_layers(self):
        for name in ("part.sl1", "part.zip"):
            self.succeed("slice", self.box(), "-o", name, *(["--format", "png-zip"] if name == "part.zip" else []))
            with self.subTest(name):
                self.succeed("convert", name, "x.cli")
                found = self.succeed("info", name, "--json").json()
                self.assertEqual(found["format"], "sl1" if name == "part.sl1" else "png-zip")
                self.assertEqual(found["pixels"], [1440, 2560] if name == "part.sl1" else found["pixels"])
                self.assertAlmostEqual(found["volume_mm3"] / 6000, 1, delta=0.02)
                self.succeed("view", name, "-o", "x.html")
                self.succeed("verify", name, "--mesh", "box.stl")
                self.succeed("compare", name, name)

    def test_the_sl1s_has_a_display_of_its_own(self):
        self.succeed("slice", self.box(), "-o", "part.sl1s", "--layer-height", "1")
        archive = self.archive("part.sl1s")
        self.assertEqual(self.settings(archive, "config.ini")["printerModel"], "SL1S")
        image = Image(archive.read("part00003.png"))
        self.assertEqual((image.width, image.height), (1620, 2560))
        self.assertAlmostEqual(image.covered() * 0.05 ** 2, 600, delta=0.01)

    def test_a_job_gives_the_answer_of_its_program(self):
        self.succeed("slice", self.box(), "-o", "my part.sl1", "--layer-height", "0.5",
                     "--first-layer-height", "1", "--exposure", "3", "--first-exposure", "20", "--fade-layers", "2", "--gamma", "1.5",
                     "--display-size", "40,40", "--resolution", "200x100", "--orientation", "landscape",
                     "--mirror", "y", env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"})
        archive = self.archive("my part.sl1")
        self.assertEqual(archive.namelist()[0], "my_part00000.png")
        config = self.settings(archive, "config.ini")
        self.assertEqual((config["expTime"], config["expTimeFirst"], config["numFade"]), ("3", "20", "2"))
        self.assertEqual(config["fileCreationTimestamp"], "2023-11-14 at 22:13:20 UTC")
        profile = self.settings(archive, "prusaslicer.ini")
        self.assertEqual((profile["initial_layer_height"], profile["layer_height"]), ("1", "0.5"))
        self.assertEqual([profile["display_" + key] for key in ("orientation", "mirror_x", "mirror_y")],
                         ["landscape", "0", "1"])
        self.assertEqual(profile["gamma_correction"], "1.5")
        image = Image(archive.read("my_part00000.png"))
        self.assertEqual((image.width, image.height), (200, 100))

    def test_cuts_through_a_layer_become_its_image(self):
        self.succeed("make", "sphere", "--size", "40", "-o", "ball.stl")
        display = ["--resolution", "120x120", "--display-size", "60,60", "--format", "png"]
        for count in 2, 3:
            with self.subTest(count):
                self.succeed("slice", "ball.stl", "-o", f"mean{count}", "--layer-height", "3", "--layers", "0:6",
                             "--z-antialias", str(count), "--grey-curve", "0:40,0.5:100", *display)
                self.succeed("slice", "ball.stl", "-o", f"cuts{count}", "--layer-height", str(3 / count), *display)
                grey = 0
                for layer in range(6):
                    mean = self.pixels(f"mean{count}/{layer:05}.png")
                    cuts = [self.pixels(f"cuts{count}/{layer * count + i:05}.png") for i in range(count)]
                    for found, *values in zip(mean, *cuts):
                        covered = (sum(values) + count // 2) // count / 255
                        value = 40 + 120 * covered if covered < 0.5 else 100 + 310 * (covered - 0.5)
                        self.assertAlmostEqual(found, value if covered > 0 else 0, delta=0.51)
                        grey += 0 < found < 255
                self.assertGreater(grey, 600)

    def test_converted_jobs_keep_transition_display_and_printer(self):
        self.box(size="2,2,12")
        self.succeed("slice", "box.stl", "-o", "a.goo", "--printer", "Mars 4 DLP", "--layer-height", "1")
        first = self.succeed("info", "a.goo", "--json").json()["exposures_s"]
        self.assertGreater(len(set(first)), 4)
        self.succeed("convert", "a.goo", "b.goo", "--exposure", "2.1")
        second = self.succeed("info", "b.goo", "--json").json()["exposures_s"]
        self.assertEqual([len(set(second)), second[0], round(second[-1], 4)], [len(set(first)), first[0], 2.1])
        for before, after in zip(first, second):
            share = (first[0] - before) / (first[0] - first[-1])
            self.assertAlmostEqual(after, first[0] - share * (first[0] - 2.1), delta=0.002)
        warning = "the job is for the Elegoo Mars 4 DLP, which reads files of the format goo (.goo), not ctb; name another printer with --printer"
        self.assertIn(warning, self.succeed("convert", "a.goo", "a.ctb").err)
        self.fail_with(4, "a.goo: the job is for the Elegoo Mars 4 DLP", "convert", "a.goo", "b.ctb", "--strict")
        self.assertFalse(self.path("b.ctb").exists())
        self.assertNotIn("the job is for", self.succeed("convert", "a.goo", "c.goo").err)
        self.succeed("slice", "box.stl", "-o", "a.sl1", "--layer-height", "1")
        of_sl1 = self.succeed("info", "a.sl1", "--json").json()
        self.succeed("convert", "a.sl1", "d.goo")
        of_goo = self.succeed("info", "d.goo", "--json").json()
        self.assertEqual(of_goo["pixels"], [1440, 2560])
        for mm, pixels in zip(of_goo["display_mm"], of_goo["pixels"]):
            self.assertAlmostEqual(mm / pixels, 0.04725, places=6)
        self.assertEqual(of_sl1["pixels"], of_goo["pixels"])

    def test_black_and_white_takes_one_bit(self):
        for name, bits in [("grey", 8), ("white", 1)]:
            self.succeed("slice", self.box(), "-o", name, "--format", "png", "--layer-height", "5", "--antialias", str(bits))
            image = Image(self.bytes_of(f"{name}/00000.png"))
            self.assertEqual((image.bits, image.width, image.covered()), (bits, 400, 240000))
            self.assertEqual(json.loads(self.bytes_of(f"{name}/manifest.json"))["bits"], bits)
        self.succeed("slice", "box.stl", "-o", "white.zip", "--format", "png-zip", "--antialias", "1", "--layer-height", "5")
        self.assertAlmostEqual(self.succeed("info", "white.zip", "--json").json()["volume_mm3"], 6000, delta=1)
        self.succeed("slice", "box.stl", "-o", "job.sl1", "--antialias", "1", "--layer-height", "5")
        self.assertEqual(Image(self.archive("job.sl1").read("job00000.png")).bits, 8)

    def test_parts_have_their_colours(self):
        for i in range(4):
            self.succeed("make", "box", "--size", "4", "-o", f"{i}.stl")
        plate = [word for i in range(4) for word in (f"{i}.stl", "--translate", f"{3 * i},0,0", "--label", f"part {i}")]
        colours = ["#ff0000", "#00ff00", "#0000ff", "#ff0000"]
        job = ["slice", *plate, "--layer-height", "2", "--pixel-size", "0.5"]
        self.succeed(*job, "--format", "png", "-o", "out", "--part-colours", ",".join(colours))
        image = Image(self.bytes_of("out/00001.png"))
        self.assertEqual((image.bits, image.palette), (4, [(0, 0, 0), (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 0, 0)]))
        self.assertEqual(image.rows, [bytes([1] * 8 + [2] * 6 + [3] * 6 + [4] * 6)] * 8)
        manifest = json.loads(self.bytes_of("out/manifest.json"))
        self.assertEqual(manifest["parts"], [{"label": f"part {i}", "colour": colours[i]} for i in range(4)])
        self.assertEqual(manifest["layers"][0]["area_mm2"], 4 * 13)
        self.succeed(*job, "-o", "out.zip", "--part-colours", "auto")
        palette = Image(self.archive("out.zip").read("00000.png")).palette
        self.assertEqual(len(set(palette)), 5)
        self.assertAlmostEqual(self.succeed("info", "out.zip", "--json").json()["volume_mm3"], 4 * 4 * 13, delta=1e-6)
        self.fail_with(2, "1 colours for 4 parts", *job, "-o", "x.zip", "--part-colours", "#123456")
        self.fail_with(2, "black .* is the colour of pixels without material", *job, "-o", "x.zip", "--part-colours",
                       "#123456,#000000,#654321,#123456")
        self.fail_with(2, '"red" is not a colour, such as #e6194b', *job, "-o", "x.zip", "--part-colours", "red")
        self.fail_with(2, "excludes --antialias", *job, "-o", "x.zip", "--part-colours", "auto", "--antialias", "4")
        self.fail_with(2, "--part-colours goes with the formats png, png-zip, not with sl1", *job, "-o", "x.sl1", "--part-colours", "auto")
        self.fail_with(2, "do not tell which part", "convert", "out.zip", "y.zip", "--format", "png-zip", "--part-colours", "auto")

    def test_a_layer_that_covers_more_than_half_the_display_is_a_slow_one(self):
        for size, slow in (("20,9.9,1", "0"), ("20,10.1,1", "10")):
            self.succeed("slice", self.box(size=size), "-o", "part.sl1", "--display-size", "20,20",
                         "--resolution", "200x200")
            config = self.settings(self.archive("part.sl1"), "config.ini")
            self.assertEqual(config["numSlow"], slow)

    def test_folder_and_archive_hold_the_same(self):
        self.succeed("slice", self.box(), "-o", "out", "--format", "png", "--layer-height", "1")
        self.succeed("slice", "box.stl", "-o", "out.zip", "--layer-height", "1")
        archive = self.archive("out.zip")
        self.assertEqual(sorted(archive.namelist()), sorted(p.name for p in self.path("out").iterdir()))
        for name in archive.namelist():
            self.assertEqual(archive.read(name), self.bytes_of(f"out/{name}"))
        manifest = json.loads(archive.read("manifest.json"))
        self.assertEqual([layer["file"] for layer in manifest["layers"]], [f"{i:05}.png" for i in range(10)])
        self.assertEqual((manifest["width"], manifest["height"]), (400, 600))
        for layer in manifest["layers"]:
            self.assertAlmostEqual(layer["area_mm2"], 600, places=6)
        image = Image(archive.read("00000.png"))
        self.assertEqual(set(b"".join(image.rows)), {255})

    def test_images_are_the_same_for_any_threads(self):
        self.succeed("make", "rook", "-o", "rook.stl")
        for name in ("sl1", "zip"):
            for threads in (1, 2, 5):
                self.succeed("slice", "rook.stl", "-o", f"a{threads}.{name}",
                             "--layer-height", "0.7", "--threads", threads)
            archives = [self.archive(f"a{threads}.{name}") for threads in (1, 2, 5)]
            contents = [[archive.read(entry) for entry in archive.namelist() if entry.endswith(".png")]
                        for archive in archives]
            self.assertEqual(contents[0], contents[1])
            self.assertEqual(contents[0], contents[2])

    def test_images_can_be_made_of_a_slice_file(self):
        self.succeed("slice", self.box(), "-o", "part.cli", "--layer-height", "1")
        self.succeed("convert", "part.cli", "part.zip", "--pixel-size", "0.1,0.2", "--antialias", "1")
        manifest = json.loads(self.archive("part.zip").read("manifest.json"))
        self.assertEqual((manifest["width"], manifest["height"], manifest["antialias"]), (200, 150, 1))

    def test_grey_values_that_a_format_does_not_have_are_counted(self):
        self.succeed("make", "sphere", "--size", "5", "-o", "ball.stl")
        self.succeed("slice", "ball.stl", "-o", "a.goo", "--layer-height", "0.5", "--display-size", "6,6", "--resolution", "60x60",
                     "--antialias", "16")
        self.assertEqual(self.succeed("convert", "a.goo", "same.goo").err, "")
        self.succeed("convert", "a.goo", "a.zip", "--format", "png-zip")
        before = self.archive("a.zip")
        for name, options, levels in [("b.ctb", [], 128), ("b.cbddlp", ["--antialias", "8"], 5), ("b.pwmo", [], 16),
                                      ("c.goo", ["--antialias", "1"], 2)]:
            with self.subTest(name):
                result = self.succeed("convert", "a.goo", name, *options)
                self.succeed("convert", name, "b.zip", "--format", "png-zip")
                after = self.archive("b.zip")
                pixels, layers, largest, values = 0, 0, 0, set()
                for i in range(10):
                    rows = [b"".join(Image(archive.read(f"{i:05}.png")).rows) for archive in (before, after)]
                    changes = [abs(a - b) for a, b in zip(*rows) if a != b]
                    pixels, layers, largest = pixels + len(changes), layers + bool(changes), max([largest, *changes])
                    values |= set(rows[1])
                self.assertTrue(0 < len(values) <= levels)
                self.assertGreater(pixels, 0)
                text = " ".join(result.err.split())
                self.assertRegex(text, f"{pixels} pixels on {layers} layers, [^:]*get other grey values, by up to {largest} of 255: "
                                       "the format or the display has fewer levels of grey")
                self.fail_with(4, "other grey values", "convert", "a.goo", "no" + name, *options, "--strict")
                # What a format has holds its own values.
                self.assertNotIn("grey values", self.succeed("convert", name, "again-" + name, *options).err)

    def test_mirroring_that_a_format_cannot_say_is_reported(self):
        for mirror, lost in ("x", {"b.ctb": [], "b.pwmo": []}), ("xy", {"b.ctb": ["y"], "b.pwmo": ["y"]}), ("none", {"b.ctb": [], "b.pwmo": ["x"]}):
            self.succeed("slice", self.box(size="2,3,1"), "-o", "a.goo", "--layer-height", "0.5", "--display-size", "6,6",
                         "--resolution", "60x60", "--mirror", mirror, "--antialias", "1")
            for name, axes in lost.items():
                text = self.succeed("convert", "a.goo", name).err
                for axis in "xy":
                    self.assertEqual(f"mirroring along {axis}" in text, axis in axes, (mirror, name, text))

    def test_standard_output_takes_a_job(self):
        result = self.succeed("slice", self.box(), "-o", "-", "--format", "sl1", "--layer-height", "5")
        self.assertEqual(zipfile.ZipFile(io.BytesIO(result.out)).namelist()[0], "layers00000.png")

    def test_what_does_not_fit_is_refused(self):
        self.box(size="130,30,2")
        self.fail_with(2, r"part measures 130 x 30 mm and the display of the Original Prusa SL1 only 120\.96 x 68\.04 mm",
                       "slice", "box.stl", "-o", "part.sl1")
        self.fail_with(2, "need 1.3e\\+06 pixels of 0.0001 mm, and 65535 are the most",
                       "slice", "box.stl", "-o", "part.zip", "--pixel-size", "0.0001")

    def test_options_that_make_no_sense_are_refused(self):
        self.box()
        for options, pattern in [
                (["--pixel-size", "0"], "not a length or two"),
                (["--pixel-size", "nan"], "--pixel-size"),
                (["--pixel-size", "1,2,3"], "not a length or two"),
                (["--resolution", "100"], "such as 2560x1440"),
                (["--resolution", "0x5"], "columns and of rows"),
                (["--resolution", "70000x5"], "up to 65535"),
                (["--display-size", "-1,1"], "not a length or two"),
                (["--antialias", "0"], '"0" is not a whole number from 1 to 64'),
                (["--antialias", "65"], '"65" is not a whole number from 1 to 64'),
                (["--antialias", "5000000000"], '--antialias: "5000000000" is not a whole number from 1 to 64'),
                (["--antialias", "99999999999999999999999"], '"99999999999999999999999" is not a whole number from 1'),
                (["--fade-layers", "5000000000"], '"5000000000" is not a whole number from 0 to 4294967295'),
                (["--gamma", "0"], "above 0"),
                (["--grey-curve", "0.5"], '"0.5" is not a covered part and a grey value, such as 0.5:180'),
                (["--grey-curve", "0.5:300"], "grey curve with the point 0.5:300"),
                (["--grey-curve", "0:60", "--gamma", "2"], "exclude each other"),
                (["--z-antialias", "65"], '"65" is not a whole number from 1 to 64'),
                (["--z-antialias", "2", "--shard", "1/2"], "shard"),
                (["--mirror", "z"], "--mirror"),
                (["--orientation", "upside"], "--orientation"),
                (["--exposure", "3"], "sl1, sl1s, goo, ctb, cbddlp, anycubic, chitubox-zip, nanodlp, not with png-zip"),
                (["--pixel-size", "1", "--display-size", "10.5,40"], "no whole number"),
                (["--pixel-size", "1", "--display-size", "40,40", "--resolution", "40x50"],
                 "are 50 mm, not the 40 mm")]:
            self.fail_with(2, pattern, "slice", "box.stl", "-o", "part.zip", *options)
        self.fail_with(2, "--antialias goes with the formats png, png-zip, sl1, sl1s, goo, ctb, cbddlp, anycubic, chitubox-zip, nanodlp, not with cli",
                       "slice", "box.stl", "-o", "part.cli", "--antialias", "4")
        self.fail_with(2, "SOURCE_DATE_EPOCH is \"soon\"", "slice", "box.stl", "-o", "part.sl1",
                       env={**os.environ, "SOURCE_DATE_EPOCH": "soon"})

    def test_heights_that_differ_make_no_job(self):
        self.write("z.txt", "1\n2\n2.5\n")
        self.box()
        self.fail_with(2, "one layer height", "slice", "box.stl", "-o", "part.sl1", "--z-list", "z.txt")

    def test_open_contours_are_reported_and_cover_nothing(self):
        self.write("open.stl", binary_stl(open_box(10, 10, 10)))
        result = self.succeed("slice", "open.stl", "-o", "part.zip", "--layer-height", "5")
        self.assertIn("open chain", result.err)
        self.assertEqual(Image(self.archive("part.zip").read("00000.png")).covered(), 0)

    @needs_posix("permissions to list a folder but not to search it")
    def test_what_cannot_be_looked_at_is_not_removed(self):
        self.box()
        for name in ["png", "svg-layers"]:
            with self.subTest(name):
                out = self.path(name)
                out.mkdir()
                (out / "thesis.txt").write_text("years")
                out.chmod(0o444)
                result = self.run_program("slice", "box.stl", "-o", name, "--format", name, **UNPRIVILEGED)
                out.chmod(0o700)
                self.assertEqual(result.code, 6, result.err)
                self.assertIn("holds something else", result.err)
                self.assertEqual((out / "thesis.txt").read_text(), "years")

    def test_a_folder_that_may_not_be_searched(self):
        self.box()
        locked = self.path("locked")
        locked.mkdir()
        locked.chmod(0)
        self.addCleanup(locked.chmod, 0o700)
        result = self.run_program("slice", "box.stl", "-o", "locked/x", "--format", "png", **UNPRIVILEGED)
        self.assertEqual(result.code, 6)
        self.assertRegex(result.err, r"no permission in the folder '([^']*\\)?locked'")


if __name__ == "__main__":
    main()
