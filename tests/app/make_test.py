"""lamella make: closed bodies, exact counts, the same bytes every time."""

from program import ProgramTest, main


class Make(ProgramTest):
    def info(self, name):
        return self.succeed("info", name, "--json").json()

    def test_every_body_is_sound(self):
        for body in ["sheet", "rook", "box", "sphere", "torus", "cylinder"]:
            with self.subTest(body):
                text = self.succeed("make", body).text
                self.assertIn(f"{body}.stl", text)
                found = self.info(f"{body}.stl")
                self.assertTrue(found["closed"])
                self.assertEqual(set(found["defects"].values()), {0})
                self.assertGreater(found["volume_mm3"], 0)

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

    def test_options_that_a_body_does_not_have(self):
        self.fail_with(2, "--holes.*box.*size", "make", "box", "--holes", "9")
        self.fail_with(2, "--size.*rook.*--scale", "make", "rook", "--size", "9")
        self.fail_with(2, "holes", "make", "sheet", "--holes", "10")
        self.fail_with(2, "segments", "make", "sheet", "--segments", "2")
        self.fail_with(2, "too many", "make", "sheet", "--holes", "99999999999")
        self.fail_with(2, "one length", "make", "sphere", "--size", "1,2,3")
        self.fail_with(2, "lamella: error: ", "make", "box", "--size", "0")
        self.fail_with(2, "lamella: error: ", "make", "box", "--size", "-1,1,1")
        self.fail_with(2, "lamella: error: ", "make", "torus", "--thickness", "100")


if __name__ == "__main__":
    main()
