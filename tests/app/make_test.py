"""lamella make: closed bodies, exact counts, the same bytes every time."""

from program import ProgramTest, main


class Make(ProgramTest):
    def info(self, name):
        return self.succeed("info", name, "--json").json()

    def test_a_configuration_is_not_overwritten(self):
        self.write("box.stl", "size = 3\n")
        for output in [[], ["-o", "./box.stl"]]:
            self.fail_with(2, "box.stl: the output would overwrite the input", "make", "box", "--config", "box.stl", *output)

    def test_every_body_is_sound(self):
        for body in ["sheet", "rook", "dodecahedra", "calibration", "head", "sole", "box", "sphere", "torus", "cylinder"]:
            with self.subTest(body):
                text = self.succeed("make", body).text
                self.assertIn(f"{body}.stl", text)
                found = self.info(f"{body}.stl")
                self.assertTrue(found["closed"])
                self.assertEqual(set(found["defects"].values()), {0})
                self.assertGreater(found["volume_mm3"], 0)

    def test_any_format_holds_the_same_solid(self):
        self.succeed("make", "rook")
        self.succeed("slice", "rook.stl", "-o", "stl.cli")
        for name in ["rook.ply", "rook.obj"]:
            with self.subTest(name):
                self.succeed("make", "rook", "-o", name)
                stl, other = self.info("rook.stl"), self.info(name)
                self.assertEqual({key: value for key, value in other.items() if key not in ("path", "format")},
                                 {key: value for key, value in stl.items() if key not in ("path", "format")})
                self.succeed("slice", name, "-o", "other.cli")
                self.assertEqual((self.folder / "other.cli").read_bytes(), (self.folder / "stl.cli").read_bytes())
        self.fail_with(2, "--ascii: PLY files are written as binary", "make", "rook", "--ascii", "-o", "other.ply")
        for name in ["rook.off", "rook.3mf", "rook.step", "rook.cli", "rook.html"]:
            self.fail_with(2, f'-o: "{name}" has the extension of another format; what is written is .stl or .ply or .obj',
                           "make", "rook", "-o", name)
        self.succeed("make", "rook", "-o", "rook")
        self.assertEqual(self.bytes_of("rook"), self.bytes_of("rook.stl"))

    def test_a_lattice_is_one_closed_surface(self):
        self.succeed("make", "lattice", "--cells", "2", "--detail", "2")
        found = self.info("lattice.stl")
        self.assertEqual((found["closed"], found["shells"]), (True, 1))

    def test_a_sheet_has_exactly_the_triangles_of_its_formula(self):
        for holes, segments in [(4, 8), (9, 16), (100, 32)]:
            self.succeed("make", "sheet", "--holes", holes, "--segments", segments)
            self.assertEqual(self.info("sheet.stl")["triangles"], 4 * holes * (segments + 1) + 12)
        self.succeed("make", "sheet", "--holes", "100")
        self.assertEqual(self.info("sheet.stl")["triangles"], 102812)

    def test_the_parts_of_the_paper_have_its_counts_and_sizes(self):
        for body, triangles, size, shells in [("dodecahedra", 2074, [157.81, 133.62, 165.15], 13),
                                              ("calibration", 316, [165.1, 165.1, 25.4], 1),
                                              ("rook", 93930, [31.75, 31.75, 53.15], 1),
                                              ("head", 467882, [141.61, 111.27, 81.29], 1),
                                              ("sole", 862014, [324, 125, 54], 1)]:
            with self.subTest(body):
                self.succeed("make", body)
                found = self.info(f"{body}.stl")
                self.assertAlmostEqual(found["triangles"], triangles, delta=0.01 * triangles)
                self.assertEqual(found["shells"], shells)
                low, high = found["bbox"]
                for l, h, expected in zip(low, high, size):
                    self.assertAlmostEqual(h - l, expected, delta=0.01)

    def test_they_can_be_sliced_and_are_right(self):
        for body, height in [("dodecahedra", 0.1), ("calibration", 0.1), ("head", 0.1), ("sole", 2)]:
            with self.subTest(body):
                self.succeed("make", body)
                self.succeed("slice", f"{body}.stl", "-o", f"{body}.cli", "--layer-height", height)
                self.succeed("verify", f"{body}.cli", "--mesh", f"{body}.stl")

    def test_the_order_of_a_sheets_triangles(self):
        def sheet(*options):
            self.succeed("make", "sheet", "--holes", "9", "-o", "sheet.stl", *options)
            return self.bytes_of("sheet.stl")

        wall, hole, split, shuffled = [sheet("--order", order) for order in ["wall", "hole", "split", "shuffle"]]
        self.assertEqual(wall, sheet())
        self.assertEqual(len({wall, hole, split, shuffled}), 4)
        self.assertEqual(shuffled, sheet("--shuffle", "1"))
        self.assertEqual(sheet("--order", "shuffle", "--shuffle", "7"), sheet("--shuffle", "7"))
        self.fail_with(2, "--order.*wall.*hole.*split.*shuffle", "make", "sheet", "--order", "random")

    def test_sizes(self):
        for arguments, size in [(["box", "--size", "1,2,3"], [1, 2, 3]), (["box", "--size", "5"], [5, 5, 5]),
                                (["cylinder", "--size", "8", "--thickness", "3"], [8, 8, 3]),
                                (["torus", "--size", "40", "--thickness", "10"], [40, 40, 10]),
                                (["sphere", "--size", "6"], [6, 6, 6]),
                                (["box", "--size", "1,2,3", "--rotate-x", "90"], [1, 3, 2]),
                                (["box", "--size", "1,2,3", "--scale", "2"], [2, 4, 6])]:
            with self.subTest(arguments):
                self.succeed("make", *arguments, "-o", "body.stl")
                low, high = self.info("body.stl")["bbox"]
                for l, h, expected in zip(low, high, size):
                    self.assertAlmostEqual(h - l, expected, delta=0.01 * expected)

    def test_the_same_options_give_the_same_bytes(self):
        for name in ["a.stl", "b.stl"]:
            self.succeed("make", "sheet", "--holes", "9", "--shuffle", "3", "-o", name)
        self.assertEqual(self.bytes_of("a.stl"), self.bytes_of("b.stl"))
        self.succeed("make", "sheet", "--holes", "9", "--shuffle", "4", "-o", "b.stl")
        self.assertNotEqual(self.bytes_of("a.stl"), self.bytes_of("b.stl"))
        self.succeed("make", "sheet", "--holes", "9", "--order", "split", "-o", "b.stl")
        self.assertEqual(self.info("a.stl")["volume_mm3"], self.info("b.stl")["volume_mm3"])

    def test_ascii_and_standard_output(self):
        self.succeed("make", "box", "--ascii")
        self.assertTrue(self.bytes_of("box.stl").startswith(b"solid"))
        result = self.succeed("make", "box", "-o", "-", "--ascii")
        self.assertEqual(result.out, self.bytes_of("box.stl"))
        self.assertIn("12 triangles", result.err)

    def test_the_extension_says_the_format_in_capitals_as_well(self):
        self.succeed("make", "box", "-o", "box.PLY")
        self.assertTrue(self.bytes_of("box.PLY").startswith(b"ply"))
        self.succeed("make", "lattice", "--cells", "1", "-o", "lattice.OBJ")
        self.assertIn(b"\nf ", self.bytes_of("lattice.OBJ"))
        for name in ["box.stl.gz", "box.GZ", "box.3MF"]:
            self.fail_with(2, "extension of another format", "make", "box", "-o", name)

    def test_options_that_a_body_does_not_have(self):
        self.fail_with(2, "--holes.*box.*size", "make", "box", "--holes", "9")
        self.fail_with(2, "--size.*rook.*--scale", "make", "rook", "--size", "9")
        self.fail_with(2, "--detail.*head.*--scale", "make", "head", "--detail", "9")
        self.fail_with(2, "--order.*sole", "make", "sole", "--order", "shuffle")
        self.fail_with(2, "holes", "make", "sheet", "--holes", "10")
        self.fail_with(2, "segments", "make", "sheet", "--segments", "2")
        self.fail_with(2, "too many", "make", "sheet", "--holes", "99999999999")
        self.fail_with(2, "one length$", "make", "sphere", "--size", "1,2,3")
        self.fail_with(2, "one length, or three", "make", "box", "--size", "1,2")
        self.fail_with(2, "lamella: error: ", "make", "box", "--size", "0")
        self.fail_with(2, "lamella: error: ", "make", "box", "--size", "-1,1,1")
        self.fail_with(2, "lamella: error: ", "make", "torus", "--thickness", "100")


if __name__ == "__main__":
    main()
