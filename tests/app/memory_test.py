"""lamella slice --max-memory: files that do not fit give the same bytes range by range, and leave nothing behind."""

import json
import math
import os
import signal
import struct
import subprocess
import sys
import threading
import zipfile

from program import COMMAND, ON_WINDOWS, ProgramTest, binary_stl, limited, main, needs_posix, open_box

# The program and its threads take some of each limit; what is left makes many ranges of these small meshes.
TIGHT = {1: "39M", 2: "52M", 7: "116M"}
WINE = 20_000_000 if ON_WINDOWS else 0  # what it takes in each process
MEASURED = """
import resource, subprocess, sys
code = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL).returncode
print(code, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""
PATTERNS = ("lines", "meander", "stripes", "chessboard", "hexagons")


class Memory(ProgramTest):
    def setUp(self):
        super().setUp()
        self.spill = self.path("spill")
        self.spill.mkdir()
        self.environment = dict(os.environ, TMPDIR=str(self.spill))

    def lattice(self, name="lattice.stl", *options):
        """112,000 triangles."""
        self.succeed("make", "lattice", "--cells", 6, "-o", name, *options)
        return name

    def slice(self, *arguments, **keywords):
        self.succeed("slice", *arguments, "--stats", "stats.json", env=self.environment, **keywords)
        self.assertEqual(list(self.spill.iterdir()), [])
        return json.loads(self.bytes_of("stats.json"))

    def check(self, *arguments, name="cli", least_ranges=2, stdin=b"", threads=(1, 2, 7)):
        """The bytes and hashes of a run in memory, for all numbers of threads."""
        whole = self.slice(*arguments, "-o", f"whole.{name}", stdin=stdin)
        self.assertNotIn("ranges", whole)
        for n in threads:
            stats = self.slice(*arguments, "-o", f"ranges.{name}", "--threads", n, "--max-memory", TIGHT[n],
                               stdin=stdin)
            self.assertGreaterEqual(stats["ranges"], least_ranges)
            self.assertEqual(self.bytes_of(f"ranges.{name}"), self.bytes_of(f"whole.{name}"))
            self.assertEqual(stats["layers"], whole["layers"])
            for key in ["points", "contours", "open_chains", "volume_mm3"]:
                self.assertEqual(stats[key], whole[key])
            self.assertAlmostEqual(stats["input"]["volume_mm3"], whole["input"]["volume_mm3"], places=6)
            self.assertLess(stats["peak_rss_bytes"] - WINE, 1.1 * 1e6 * int(TIGHT[n][:-1]))
        return whole

    def damaged(self, name):
        """The lattice with holes, and with triangles that are turned over, doubled and not finite."""
        bytes_ = bytearray(self.bytes_of(self.lattice()))
        records = (len(bytes_) - 84) // 50
        for i in range(0, records, 97):
            at = 84 + 50 * i
            kind = i // 97 % 4
            if kind == 0:
                bytes_[at + 12:at + 24] = bytes_[at + 24:at + 36]
            elif kind == 1:
                bytes_[at + 12:at + 36] = bytes_[at + 24:at + 36] + bytes_[at + 12:at + 24]
            elif kind == 2:
                bytes_[at:at + 50] = bytes_[at + 50:at + 100]
            else:
                bytes_[at + 12:at + 16] = struct.pack("<f", float("nan"))
        self.write(name, bytes(bytes_))
        return name

    def peak(self, *arguments, codes=(0,)):
        """The most memory, in bytes, that the program had. It is started by a small process, since what the one that starts
        it has had counts, too."""
        finished = subprocess.run([sys.executable, "-c", MEASURED, *COMMAND, *map(str, arguments)], cwd=self.folder,
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
        code, kilobytes = map(int, finished.stdout.split())
        self.assertIn(code, codes, arguments)
        return 1024 * kilobytes - WINE

    def plate(self, side=250):
        """Ten layers of a square as layers.json, and as box.stl."""
        self.box(size=f"{side},{side},1")
        self.succeed("slice", "box.stl", "-o", "layers.json")
        return {"scan": "layers.json", "slice": "box.stl"}

    def test_of_scan_vectors_is_counted_before_it_is_taken(self):
        for command, name in self.plate().items():
            scan = ["--scan"] if command == "slice" else []
            for pattern in PATTERNS:
                with self.subTest(command=command, pattern=pattern):
                    self.fail_with(5, fr"{name}: layer [0-3] at z = 0\.[0-3]5 mm: .* above the .* that --max-memory leaves .*"
                                   "--threads.*--hatch-distance", command, name, *scan, "-o", "job.json", "--pattern", pattern,
                                   "--hatch-distance", 0.001 if pattern in ("lines", "meander") else 0.01, "--max-memory", "100M", "--threads", 2)

    def test_scan_vectors_keep_within_what_is_allowed(self):
        slack = 25e6
        for command, name in self.plate().items():
            scan = ["--scan"] if command == "slice" else []
            for pattern in ("meander", "chessboard", "hexagons"):
                for distance in (0.1, 0.04):
                    with self.subTest(command=command, pattern=pattern, distance=distance):
                        self.assertLess(self.peak(command, name, *scan, "-o", "job.json", "--pattern", pattern, "--hatch-distance",
                                                  distance, "--max-memory", "100M", "--threads", 2, codes=(0, 5)), 100e6 + slack)

    def test_small_files_of_large_shapes_take_a_bounded_amount_without_an_option(self):
        corners = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (0, 0, 10), (10, 0, 10), (10, 10, 10), (0, 10, 10)]
        faces = [(1, 3, 2), (1, 4, 3), (5, 6, 7), (5, 7, 8), (1, 2, 6), (1, 6, 5), (3, 4, 8), (3, 8, 7), (2, 3, 7), (2, 7, 6),
                 (4, 1, 5), (4, 5, 8)]
        for far in ((2e7, 10, 10), (3e6, 3e6, 10)):
            corners[6] = far
            self.write("far.obj", "".join("v %r %r %r\n" % c for c in corners) + "".join("f %d %d %d\n" % f for f in faces))
            with self.subTest(far=far):
                self.assertLess(self.peak("slice", "far.obj", "-o", "job.json", "--scan", "--hatch-distance", 0.7, "--include",
                                          "support", "--timeout", 2, "--threads", 2, codes=(0, 5)), 1e9)
        for ring in ("0,0,10000,0,10000,10000,0,10000,0,0", "0,0,30000000,10,1000,1000,0,0", "0,0,2000000,0,2000000,0.06,0,0.06,0,0"):
            layers = "".join(f"$$LAYER/{i}\n$$POLYLINE/1,1,{ring.count(',') // 2 + 1},{ring}\n" for i in (1, 2))
            self.write("far.cli", f"$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n{layers}$$GEOMETRYEND\n")
            for pattern in ("stripes", "hexagons"):
                with self.subTest(ring=ring, pattern=pattern):
                    self.assertLess(self.peak("scan", "far.cli", "-o", "job.cli", "--hatch-distance", 1, "--pattern", pattern,
                                              "--threads", 2, codes=(0, 5)), 1e9)

    def test_a_layer_height_that_is_far_too_small_is_refused_before_it_takes_memory(self):
        self.box()
        for words, found in ((["--layer-height", "0.000001"], r"a layer height of 1e-06 mm makes 1e\+07 layers"),
                             (["--heights", "0:5=0.0000005"], r"100000\d\d layers take 5\.0 GB")):
            with self.subTest(words=words):
                self.fail_with(5, fr"box\.stl: {found} .*--max-memory", "slice", "box.stl", "-o", "a.cli", *words, "--threads", 1,
                               **limited(DATA=100_000_000))

    def test_copies_are_counted_before_they_take_memory(self):
        self.fail_with(5, r"box\.stl: 200000 parts on the plate take .*--max-memory", "slice", self.box(), "-o", "a.cli", "--copies",
                       200_000, "--max-memory", "100M")

    def test_of_crossings_is_counted_before_it_is_taken(self):
        numbers = iter(pow(7919, k, 1_000_003) / 10_000 for k in range(10 ** 9))
        rings = [[next(numbers) for _ in range(6)] for _ in range(1500)]
        self.write("chords.json", json.dumps({
            "format": "lamella layers", "version": 1, "units": "mm", "parts": [{"label": "part"}],
            "layers": [{"index": 3, "z": 0.5, "bottom": 0, "top": 1, "parts": [{"rings": rings}]}]}).encode())
        for step in (["--fill", "nonzero"], ["--offset=0.01"]):
            self.fail_with(5, "chords.json: layer 3 at z = 0.5 mm: .*crossings of contours.* above .*--max-memory", "convert", "chords.json",
                           "x.json", *step, "--max-memory", "100M", "--threads", 2)

    def test_of_random_chords_is_refused_before_they_are_sorted(self):
        numbers = iter(f"{pow(7919, k, 1_000_003) / 10_000:.3f}" for k in range(1, 10 ** 9))

        def layer_file(name, lines):
            self.write(name, "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n"
                       "$$LAYER/1\n" + "".join(lines) + "$$GEOMETRYEND\n")

        def ring(n):
            points = [f"{next(numbers)},{next(numbers)}" for _ in range(n)]
            return f"$$POLYLINE/1,1,{n + 1}," + ",".join([*points, points[0]]) + "\n"

        layer_file("rings.cli", [ring(3) for _ in range(6000)])
        layer_file("ring.cli", [ring(18000)])
        for name in ["rings.cli", "ring.cli"]:
            for step in ["--fill=nonzero", "--offset=0.01"]:
                self.fail_with(5, f"{name}: layer 0 at z = .*cross", "convert", name, "x.json", step, "--max-memory", "100M")
            self.fail_with(5, f"{name}: layer 0 at z = .*cross", "scan", name, "-o", "x.ilt", "--max-memory", "100M")
            result = self.run_program("verify", name, "--max-memory", "100M")
            self.assertEqual(result.code, 4, result.err)
            self.assertRegex(result.out.decode(), r"crossings of contours, or more \(rings")
            self.succeed("info", name, "--max-memory", "100M")

    def test_points_of_a_slice_file_are_held_once(self):
        points = self.slice(self.lattice(), "--layer-height", "0.02", "-o", "layers.cli")["points"]
        self.slice("lattice.stl", "--layer-height", "10", "-o", "few.cli")
        file = self.path("layers.cli").stat().st_size  # of which there is a copy
        self.assertLess(self.peak("info", "layers.cli") - self.peak("info", "few.cli"), file + 1.7 * 16 * points)

    def large_layers(self):
        """Four layers of a ring of 400,000 points each, as JSON."""
        points = [round(50 * f(2 * math.pi * k / 400_000), 6) for k in range(400_000) for f in (math.cos, math.sin)]
        layers = [{"index": i, "z": 0.1 * i + 0.05, "bottom": 0.1 * i, "top": 0.1 * i + 0.1, "parts": [{"rings": [points]}]}
                  for i in range(4)]
        self.write("large.json", json.dumps({"format": "lamella layers", "version": 1, "units": "mm", "parts": [{"label": "part"}],
                                             "layers": layers}).encode())
        return "large.json"

    def test_reading_layers_keeps_within_what_is_allowed(self):
        names = [self.large_layers()]
        for name, *options in [("a.cli",), ("text.cli", "--format", "cli-ascii"), ("a.svg",), ("a.slc",), ("a.ovf",), ("a.ilt",), ("a.3mf",)]:
            self.succeed("convert", "large.json", name, *options)
            names.append(name)
        for name in names:
            for limit in (20, 34, 50):
                with self.subTest(name=name, limit=limit):
                    # Each of the threads reads the text of a layer from the copy on disk: 9 MB of JSON, 4 MB of SVG.
                    beside = {"large.json": 43, "a.svg": 33}.get(name, 25)
                    self.assertLess(self.peak("info", name, "--max-memory", f"{limit}M", "--threads", 2, codes=(0, 5)),
                                    1e6 * (limit + beside))

    def test_placements_of_a_3mf_file_are_counted_as_they_are_held(self):
        mesh = ("<mesh><vertices>" + "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
                + "</vertices><triangles>" + "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in
                                                     [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]) + "</triangles></mesh>")
        components = '<components>' + '<component objectid="1"/>' * 300_000 + '</components>'
        for name, objects, items in [("items", "", '<item objectid="1"/>' * 300_000),
                                     ("components", f'<object id="2">{components}</object>', '<item objectid="1"/>')]:
            with zipfile.ZipFile(self.path(f"{name}.3mf"), "w", zipfile.ZIP_DEFLATED) as archive:
                archive.writestr("3D/3dmodel.model", '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
                                 f'<resources><object id="1">{mesh}</object>{objects}</resources><build>{items}</build></model>')
            for command in (["info"], ["slice", "-o", "a.cli"]):
                with self.subTest(name=name, command=command):
                    self.assertLess(self.peak(*command, f"{name}.3mf", "--max-memory", "100M", "--threads", 2, codes=(5,)), 110e6)

    def test_files_that_are_held_together_share_the_limit(self):
        self.succeed("convert", self.large_layers(), "a.cli")
        self.succeed("convert", "large.json", "b.cli")
        for name in "a.cli", "b.cli":
            self.succeed("info", name, "--max-memory", "64M")
        self.assertLess(self.peak("compare", "a.cli", "b.cli", "--max-memory", "64M"), 89e6)
        self.succeed("make", "box", "--size", 10, "-o", "box.stl")
        for name in "many.cli", "more.cli":  # planes stay in memory, their contours do not
            self.succeed("slice", "box.stl", "-o", name, "--layer-height", 0.0002)
        self.assertLess(self.peak("compare", "many.cli", "more.cli", "--max-memory", "64M", codes=(5,)), 89e6)
        self.fail_with(5, r"more\.cli: takes more than the 64000000 bytes of --max-memory together with the files read before, which "
                       r"take 45\d{6} ", "compare", "many.cli", "more.cli", "--max-memory", "64M")
        self.succeed("compare", "many.cli", "more.cli", "--max-memory", "150M")
        self.lattice("mesh.ply", "--cells", 20)
        self.fail_with(5, r"mesh\.ply: takes more than the 60000000 bytes .* files read before", "verify", "many.cli", "--mesh",
                       "mesh.ply", "--max-memory", "60M")

    def test_layers_that_are_parsed_twice_share_no_limit_with_a_mesh(self):
        self.succeed("convert", self.large_layers(), "a.cli")
        self.lattice("mesh.ply", "--cells", 12)
        verified = self.run_program("verify", "a.cli", "--mesh", "mesh.ply", "--max-memory", "30M")
        self.assertEqual(verified.code, 4, verified.err)

    def test_converting_takes_no_memory_for_layers(self):
        self.succeed("convert", self.large_layers(), "a.cli")
        for name in "b.cli", "b.slc", "b.ovf":
            self.succeed("convert", "a.cli", name, "--max-memory", "24M", "--threads", 1)

    def test_layers_of_toolpaths_in_3mf_take_little_memory(self):
        self.succeed("convert", self.large_layers(), "a.ilt")
        self.succeed("convert", "a.ilt", "a.3mf", "--format", "3mf-toolpath")
        self.succeed("convert", "a.3mf", "b.cli")
        self.assertLess(self.peak("convert", "a.3mf", "c.cli", "--max-memory", "44M", "--threads", 1), 60e6)
        self.assertEqual(self.bytes_of("c.cli"), self.bytes_of("b.cli"))

    def test_layer_steps_take_little_memory(self):
        self.succeed("convert", self.large_layers(), "a.cli")
        steps = ["--min-area", "1", "--simplify", "0.001"]
        kept = self.succeed("convert", "a.cli", "b.cli", *steps).text
        self.assertLess(self.peak("convert", "a.cli", "c.cli", *steps, "--max-memory", "40M", "--threads", 1), 45e6)
        self.assertEqual(self.bytes_of("c.cli"), self.bytes_of("b.cli"))
        self.assertEqual(self.succeed("convert", "a.cli", "c.cli", *steps, "--max-memory", "40M").text,
                         kept.replace("b.cli", "c.cli"))
        pages = [self.path(name) for name in ("b.html", "c.html")]
        for page, options in zip(pages, ([], ["--max-memory", "40M"])):
            self.succeed("view", "a.cli", "-o", page.name, *steps, *options)
        self.assertEqual(*(page.read_bytes() for page in pages))

    def test_ranges_give_the_same_bytes(self):
        self.check(self.lattice(), least_ranges=3)

    def test_in_any_order_of_triangles(self):
        ordered = self.check(self.lattice(), threads=[2])
        shuffled = self.check(self.lattice("shuffled.stl", "--shuffle", 5), threads=[2])
        self.assertEqual(ordered["layers"], shuffled["layers"])

    def test_of_ascii_files(self):
        binary = self.check(self.lattice(), threads=[2])
        ascii_ = self.check(self.lattice("ascii.stl", "--ascii"), threads=[1, 2])
        self.assertEqual(binary["layers"], ascii_["layers"])

    def test_of_standard_input(self):
        for options in [[], ["--ascii"]]:
            self.lattice("piped.stl", *options)
            self.check("-", stdin=self.bytes_of("piped.stl"), threads=[2])

    def test_of_broken_meshes(self):
        whole = self.check(self.damaged("damaged.stl"))
        self.assertGreater(whole["open_chains"], 100)
        self.check("damaged.stl", "--close-gaps", "0.5", "--fill", "nonzero", threads=[2])

    def test_in_all_formats(self):
        self.lattice()
        for name in ["cli", "svg", "slc", "json", "npz", "3mf"]:
            self.check("lattice.stl", "--layer-height", "0.5", name=name, threads=[2])

    def test_of_placed_parts(self):
        for options in [[], ["--shuffle", 5]]:
            self.check(self.lattice("lattice.stl", *options), "--rotate", "10,20,30", "--unit", "cm", "--layer-height", "5",
                       threads=[1, 2])
        self.check("lattice.stl", "--slice-at", "top", "--layers", "20:60", threads=[2])

    def test_of_plates(self):
        self.succeed("make", "sphere", "--detail", 6, "-o", "sphere.stl")
        for options in [[], ["--shuffle", 5]]:
            self.check(self.lattice("lattice.stl", *options), "--copies", 2, "sphere.stl", "--translate", "0,0,3",
                       "--layer-height", "0.5", threads=[1, 2])

    def test_a_mesh_that_fits_with_layers_that_do_not(self):
        self.succeed("make", "sheet", "--holes", 25, "-o", "sheet.stl")
        plate = ["sheet.stl", "--copies", 3, "--layer-height", 0.005]
        whole = self.slice(*plate)
        windows = self.slice(*plate, "--max-memory", "140M", "--threads", 2)
        self.assertNotIn("ranges", list(windows))
        self.assertEqual(windows["layers"], whole["layers"])
        self.assertEqual(windows["parts"], whole["parts"])
        self.assertGreater(16 * whole["parts"][0]["points"], 1.5 * 140e6)
        self.assertLess(windows["peak_rss_bytes"], 1.1 * 140e6)

    def test_what_a_file_has_at_its_end_does_not_wait_in_memory(self):
        self.succeed("make", "box", "--size", "60,60,10", "-o", "box.stl")
        hatched = self.slice("box.stl", "--scan", "--layer-height", 0.025, "--threads", 2, "-o", "box.npz")
        self.assertGreater(self.path("box.npz").stat().st_size, 110e6)
        self.assertLess(hatched["peak_rss_bytes"], 90e6)
        self.succeed("make", "sheet", "--holes", 25, "-o", "sheet.stl")
        plate = self.slice("sheet.stl", "--copies", 8, "--layer-height", 0.03, "--max-memory", "120M", "--threads", 2, "-o", "plate.3mf")
        self.assertGreater(self.path("plate.3mf").stat().st_size, 200e6)
        self.assertLess(plate["peak_rss_bytes"], 170e6)

    def test_layers_where_nothing_is(self):
        self.succeed("make", "sphere", "--detail", 7, "-o", "low.stl")
        self.succeed("make", "sphere", "--detail", 7, "--translate", "0,0,40", "-o", "high.stl")
        both = self.bytes_of("low.stl")[84:] + self.bytes_of("high.stl")[84:]
        self.write("apart.stl", b"".ljust(80) + struct.pack("<I", len(both) // 50) + both)
        whole = self.check("apart.stl")
        self.assertTrue(any(layer["contours"] == 0 for layer in whole["layers"]))

    def test_progress_counts_bytes_and_planes(self):
        self.lattice()
        result = self.succeed("slice", "lattice.stl", "-o", "a.cli", "--max-memory", "52M", "--threads", 2,
                              "--progress", "json", env=self.environment)
        events = [json.loads(line) for line in result.err.splitlines()]
        stages = [event["stage"] for event in events]
        self.assertEqual(stages, sorted(stages, key=["read", "slice"].index))
        for stage, total in [("read", 3 * len(self.bytes_of("lattice.stl"))), ("slice", 287)]:
            done = [event["done"] for event in events if event["stage"] == stage]
            self.assertEqual(done, sorted(done))
            self.assertEqual(done[-1], total)
            self.assertEqual({event["total"] for event in events if event["stage"] == stage}, {total})

    def test_limits_that_are_too_small(self):
        self.lattice()
        self.fail_with(5, r"above the 1\.0 kB of --max-memory", "slice", "lattice.stl", "-o", "a.cli", "--max-memory", "1K")
        self.fail_with(5, r"the layer at z = .* alone is cut from .* triangles.*--max-memory", "slice", "lattice.stl",
                       "-o", "a.cli", "--threads", "2", "--max-memory", "46700K")
        self.fail_with(5, r"287 layers on 2 threads take .* above the 1\.0 MB of --max-memory", "slice", "lattice.stl",
                       "-o", "a.cli", "--threads", "2", "--max-memory", "1M")

    def test_wishes_that_need_the_whole_mesh(self):
        self.lattice()
        for option in [["--strict"], ["--inspect"], ["--weld-tolerance", "0.01"], ["--drop-duplicates"], ["--orient"],
                       ["--engine", "eecc"]]:
            self.fail_with(5, f"lattice.stl: .*MB.*--max-memory.* {option[-1] if 'eecc' in option else option[0]}",
                           "slice", "lattice.stl", "-o", "a.cli", "--max-memory", "52M", "--threads", 2, *option)
        self.succeed("make", "box", "-o", "box.obj")
        self.fail_with(5, "box.obj.* read whole", "slice", "lattice.stl", "box.obj", "-o", "a.cli", "--max-memory",
                       "52M", "--threads", 2)

    def test_other_formats_that_do_not_fit(self):
        for name in ["part.obj", "part.ply"]:
            self.lattice(name)
            self.fail_with(5, f"{name}: .*134064 triangles.*only STL files", "slice", name, "-o", "a.cli",
                           "--max-memory", "60M", "--threads", 2)
            self.succeed("slice", name, "-o", "a.cli", "--max-memory", "200M", "--threads", 2)
            self.path("a.cli").unlink()

    def test_files_of_other_formats_are_held_together(self):
        names = [f"{i}.ply" for i in range(4)]
        for name in names:
            self.lattice(name)
        self.succeed("slice", names[0], "-o", "one.cli", "--max-memory", "96M", "--threads", 2)
        self.fail_with(5, "2.ply: to slice .* triangles, those of the files before it among them, takes up to",
                       "slice", *names, "-o", "all.cli", "--max-memory", "96M", "--threads", 2)

    def test_planes_of_many_copies_wait_by_their_points(self):
        self.succeed("make", "torus", "--segments", 200, "-o", "ring.stl")
        stats = self.slice("ring.stl", "--copies", 1000, "--layer-height", "0.5", "-o", "rings.cli", "--threads", 2,
                           "--max-memory", "120M")
        self.assertLess(stats["peak_rss_bytes"], 120e6)

    def test_a_disk_that_is_full(self):
        self.lattice("shuffled.stl", "--shuffle", 5)
        result = self.fail_with(6, r"spill: cannot hold [0-9.]+ MB of temporary data: .*TMP", "slice",
                                "shuffled.stl", "--stats", "-", "--max-memory", "52M", "--threads", 2, env=self.environment,
                                **limited(FSIZE=1 << 16))
        self.assertIn("--max-memory", result.err)

    def test_no_folder_for_temporary_data(self):
        self.lattice("shuffled.stl", "--shuffle", 5)
        self.fail_with(6, r"nowhere: cannot hold", "slice", "shuffled.stl", "-o", "a.cli", "--max-memory", "52M",
                       "--threads", 2, env=dict(os.environ, TMPDIR="/nowhere"))

    def test_no_temporary_data_where_triangles_lie_together_that_the_same_planes_cut(self):
        self.lattice("large.stl", "--cells", 10)
        bytes_ = bytearray(self.bytes_of("large.stl"))
        for at in range(84 + 12, len(bytes_), 50 * 9973):
            bytes_[at:at + 4] = struct.pack("<f", float("nan"))
        self.write("damaged.stl", bytes(bytes_))
        for name, *options in [("large.stl",), ("large.stl", "--copies", 2), ("large.stl", "--rotate-z", 30, "--layers", "50:400"),
                               ("large.stl", "--scan", "--layer-height", 0.5), ("damaged.stl",)]:
            self.environment["TMPDIR"] = str(self.spill)
            whole = self.slice(name, *options, "-o", "whole.cli")
            self.environment["TMPDIR"] = "/nowhere"
            ranges = self.slice(name, *options, "-o", "ranges.cli", "--max-memory", "105M", "--threads", 2)
            self.assertGreater(ranges["ranges"], 1)
            self.assertEqual(self.bytes_of("ranges.cli"), self.bytes_of("whole.cli"))
            self.assertEqual(ranges["volume_mm3"], whole["volume_mm3"])

    @needs_posix("signals")
    def test_a_run_that_is_stopped_leaves_nothing(self):
        self.lattice("shuffled.stl", "--shuffle", 5)
        for number, code in [(signal.SIGTERM, 130), (signal.SIGKILL, -signal.SIGKILL)]:
            for stage in ["read", "slice"]:
                process = subprocess.Popen([*COMMAND, "slice", "shuffled.stl", "-o", "a.svg", "--layer-height", "0.001",
                                            "--max-memory", "80M", "--threads", "2", "--progress", "json"],
                                           cwd=self.folder, env=self.environment, stdout=subprocess.DEVNULL,
                                           stderr=subprocess.PIPE)
                self.addCleanup(process.kill)
                for line in process.stderr:
                    if json.loads(line).get("stage") == stage:
                        break
                process.send_signal(number)
                drain = threading.Thread(target=process.stderr.read)
                drain.start()
                self.assertEqual(process.wait(timeout=60), code)
                drain.join()
                process.stderr.close()
                self.assertEqual(list(self.spill.iterdir()), [])
                self.assertFalse(self.path("a.svg").exists())

    def test_open_contours_are_counted_as_ever(self):
        self.write("open.stl", binary_stl(open_box(20, 30, 10) * 30000))
        whole = self.slice("open.stl", "--layer-height", "2")
        ranges = self.slice("open.stl", "--layer-height", "2", "--max-memory", "110M", "--threads", 2)
        self.assertIn("ranges", ranges)
        self.assertEqual(whole["layers"], ranges["layers"])


if __name__ == "__main__":
    main()
