"""Bad input: one line that says what to do, the documented exit code, and no file left behind."""

import os
import resource
import subprocess
import unittest

from program import COMMAND, OTHER_USER, UNPRIVILEGED, ProgramTest, binary_stl, box_triangles, limited, main, needs_posix


class BadInput(ProgramTest):
    def refuse(self, code, pattern, mesh, *arguments, **keywords):
        self.fail_with(code, pattern, "slice", mesh, "-o", "out.cli", *arguments, **keywords)

    def test_a_missing_file(self):
        self.refuse(3, r"nowhere\.stl", "nowhere.stl")

    def test_a_folder(self):
        self.path("folder.stl").mkdir()
        self.refuse(3, r"folder\.stl.*(director|folder)", "folder.stl")

    def test_an_empty_file(self):
        self.write("empty.stl", b"")
        self.refuse(3, r"empty\.stl.*empty", "empty.stl")
        self.refuse(3, "empty", "-", stdin=b"")

    def test_a_file_cut_off_in_its_header(self):
        self.write("cut.stl", binary_stl(box_triangles(1, 1, 1))[:60])
        self.refuse(3, r"cut\.stl", "cut.stl")

    def test_a_file_cut_off_in_a_triangle_is_sliced_with_a_warning_and_refused_when_strict(self):
        self.write("cut.stl", binary_stl(box_triangles(20, 20, 20))[:-30])
        result = self.succeed("slice", "cut.stl", "-o", "out.cli")
        self.assertRegex(result.err, r"lamella: warning: .*cut\.stl")
        self.path("out.cli").unlink()
        result = self.run_program("slice", "cut.stl", "-o", "out.cli", "--strict")
        self.assertIn(result.code, (3, 4))
        self.assertEqual(self.listing(), ["cut.stl"])

    def test_corners_that_are_no_numbers(self):
        nan = float("nan")
        self.write("nan.stl", binary_stl([((nan, 0, 0), (1, 0, 0), (0, 1, 1))]))
        self.refuse(3, r"nan\.stl", "nan.stl")
        self.write("one.stl", binary_stl(box_triangles(20, 20, 20) + [((nan, 0, 0), (1, 0, 0), (0, 1, 1))]))
        self.assertIn("warning", self.succeed("slice", "one.stl", "-o", "out.cli").err)

    def test_no_triangles(self):
        self.write("none.stl", binary_stl([]))
        self.refuse(3, r"none\.stl", "none.stl")
        self.write("none-ascii.stl", "solid nothing\nendsolid nothing\n")
        self.refuse(3, r"none-ascii\.stl", "none-ascii.stl")

    def test_not_a_mesh(self):
        self.write("text.stl", "This is a letter, not a mesh.\n" * 20)
        self.refuse(3, r"text\.stl", "text.stl")

    def test_layers_in_the_place_of_a_mesh(self):
        self.succeed("make", "box", "-o", "box.stl")
        for name in ["box.cli", "box.slc", "box.svg", "box.json", "box.npz"]:
            with self.subTest(name=name):
                self.succeed("slice", "box.stl", "-o", name)
                self.fail_with(3, f"{name}: is .* layers.* no mesh.*; view, convert or verify", "slice", name, "-o", "x.cli")
                self.succeed("info", name)

    def test_a_flat_mesh(self):
        self.write("flat.stl", binary_stl([((0, 0, 5), (1, 0, 5), (0, 1, 5))]))
        self.refuse(3, r"flat\.stl.*flat.*z = 5.*rotate", "flat.stl")

    def test_a_mesh_that_is_flat_because_its_file_was_cut_off(self):
        whole = binary_stl(box_triangles(20, 20, 20))
        self.write("cut.stl", whole[:84 + 50])  # one triangle of the bottom
        self.refuse(3, r"cut\.stl: .*count is 12.*after 1 whole triangle.*; the mesh that was read is flat(?!.*rotate)", "cut.stl")

    def test_planes_that_miss_the_part(self):
        self.box()
        self.write("z.txt", "100\n200\n")
        self.refuse(2, "none of the planes meets the part.*from z = 0 to 10", "box.stl", "--z-list", "z.txt")
        self.refuse(2, "lamella: error: ", "box.stl", "--z-range", "100:200")
        self.refuse(2, "lamella: error: ", "box.stl", "--layers", "500:600")

    def test_impossible_layer_heights(self):
        self.box()
        for height in ["0", "-0.1", "nan", "inf", "1e999", "", "thin", "0,1", "0x10"]:
            with self.subTest(height):
                self.refuse(2, "--layer-height: ", "box.stl", f"--layer-height={height}")
        self.refuse(2, "above the part's height of 10 mm", "box.stl", "--layer-height", "10.5")
        self.refuse(2, "--first-layer-height: ", "box.stl", "--first-layer-height", "0")
        self.refuse(2, "lamella: error: ", "box.stl", "--layer-height", "1e-12")

    def test_unwritable_outputs(self):
        self.box()
        self.path("folder.cli").mkdir()
        for output in ["no/such/folder/out.cli", "folder.cli", "box.stl/out.cli"]:
            with self.subTest(output):
                self.fail_with(6, output.split("/")[0], "slice", "box.stl", "-o", output)

    def test_a_folder_without_permission(self):
        self.box()
        locked = self.path("locked")
        locked.mkdir()
        locked.chmod(0o500)
        self.fail_with(6, "locked", "slice", "box.stl", "-o", "locked/out.cli", **UNPRIVILEGED)

    @needs_posix("pipes and devices with names")
    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full here")
    def test_a_full_disk(self):
        self.box()
        self.fail_with(6, "/dev/full", "slice", "box.stl", "-o", "/dev/full", "--format", "cli")
        self.fail_with(6, "/dev/full", "slice", "box.stl", "--stats", "/dev/full")
        self.fail_with(6, "/dev/full", "make", "box", "-o", "/dev/full")

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full here")
    def test_standard_output_that_is_full(self):
        self.box()
        for arguments in [["info", "box.stl"], ["--help"], ["slice", "box.stl", "--stats", "-"],
                          ["slice", "box.stl", "-o", "-", "--format", "svg"]]:
            with self.subTest(arguments[0]), open("/dev/full", "wb") as full:
                done = subprocess.run([*COMMAND, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE,
                                      timeout=60)
                self.assertEqual(done.returncode, 6, done.stderr)
                self.assertIn(b"lamella: error: ", done.stderr)

    def test_a_disk_that_fills_up_on_the_way_leaves_nothing(self):
        self.box()
        limit = limited(FSIZE=2000)
        self.refuse(6, r"out\.cli", "box.stl", "--layer-height", "0.01", **limit)
        self.fail_with(6, r"box2\.stl", "make", "torus", "-o", "box2.stl", **limit)
        self.fail_with(6, r"s\.json", "slice", "box.stl", "--stats", "s.json", **limit)

    def test_extensions_and_formats_that_nobody_knows(self):
        self.box()
        self.fail_with(2, r"cli.*svg", "slice", "box.stl", "-o", "out.step")
        self.fail_with(2, r"cli.*svg", "slice", "box.stl", "-o", "out")
        self.fail_with(2, r"cli.*svg", "slice", "box.stl", "-o", "-")
        self.refuse(2, '--format: "clii".*did you mean cli', "box.stl", "--format", "clii")
        self.refuse(2, '--engine: "quick".*sweep', "box.stl", "--engine", "quick")

    def test_options_that_contradict_each_other(self):
        self.box()
        self.write("z.txt", "1\n")
        for arguments in [["--z-list", "z.txt", "--layer-height", "1"],
                          ["--z-list", "z.txt", "--first-layer-height", "1"],
                          ["--rotate", "1,2,3", "--rotate-z", "4"],
                          ["--format", "svg", "--short"],
                          ["--format", "svg", "--units-mm", "0.01"],
                          ["--stats", "out.cli"],
                          ["--scale", "0"],
                          ["--scale", "1,2"],
                          ["--scale", "1e300", "--translate", "1e308,0,0"],
                          ["--direction", "0,0,0"],
                          ["--rotate", "1,2"],
                          ["--translate", "1;2;3"],
                          ["--unit", "furlong"],
                          ["--layers", "5:5"],
                          ["--layers", "7"],
                          ["--z-range", "3:1"],
                          ["--z-range", "nan:1"],
                          ["--threads", "-1"],
                          ["--threads", "1000000"]]:
            with self.subTest(arguments):
                self.refuse(2, "lamella: error: ", "box.stl", *arguments)
        self.fail_with(2, "standard output", "slice", "box.stl", "-o", "-", "--format", "cli", "--stats", "-")
        self.fail_with(2, "-o part.cli", "slice", "box.stl")

    def test_lists_of_heights_that_are_none(self):
        self.box()
        for content, code, pattern in [("1\ntwo\n", 2, r"z\.txt:2: \"two\""),
                                       ("2\n1\n", 2, r"z\.txt:2: 1 is not above.*ascend"),
                                       ("1\n1\n", 2, "ascend"),
                                       ("nan\n", 2, r"z\.txt:1"),
                                       ("# nothing\n", 3, r"z\.txt"),
                                       ("[1, \"2\"]", 2, r"z\.txt.*item 2"),
                                       ("[2, 1]", 2, "item 2.*ascend"),
                                       ("[1, 2", 2, r"z\.txt")]:
            with self.subTest(content):
                self.write("z.txt", content)
                self.refuse(code, pattern, "box.stl", "--z-list", "z.txt")
        self.refuse(3, r"missing\.txt", "box.stl", "--z-list", "missing.txt")

    def test_an_output_that_would_overwrite_the_input(self):
        self.box()
        os.link(self.path("box.stl"), self.path("twin.cli"))
        before = self.bytes_of("box.stl")
        self.fail_with(2, "overwrite", "slice", "box.stl", "-o", "box.stl", "--format", "cli")
        self.fail_with(2, "overwrite", "slice", "box.stl", "-o", "./box.stl", "--format", "cli")
        self.fail_with(2, "overwrite", "slice", "box.stl", "-o", "twin.cli")
        self.fail_with(2, "overwrite", "slice", "box.stl", "--stats", "box.stl")
        self.assertEqual(self.bytes_of("box.stl"), before)

    @needs_posix("limits of processes")
    def test_threads_and_files_that_the_system_refuses_are_limits(self):
        if "LAMELLA_SANITIZED" in os.environ:
            self.skipTest("the sanitizer needs threads and files of its own at the end")
        self.box()
        for limit in [(resource.RLIMIT_NOFILE, 4), (resource.RLIMIT_NPROC, 1)]:
            with self.subTest(limit):
                self.fail_with(5, "no further threads or files", "info", "box.stl",
                               preexec_fn=lambda: resource.setrlimit(limit[0], (limit[1], limit[1])), **OTHER_USER)

    @needs_posix("limits of processes")
    def test_names_that_the_system_cannot_follow_are_not_one_file(self):
        inner = self.path("locked/inner")
        inner.mkdir(parents=True)
        self.box("locked/inner/box.stl")
        self.addCleanup(self.path("locked").chmod, 0o700)
        # The folder is locked once the program's process is in it.
        keywords = {"cwd": inner, "preexec_fn": lambda: os.chmod("..", 0), **UNPRIVILEGED}

        def run(*arguments):
            self.path("locked").chmod(0o700)
            return self.run_program(*arguments, **keywords)
        for arguments in [["slice", "box.stl", "-o", "x.cli", "--stats", "x.json"], ["convert", "x.cli", "y.svg"]]:
            self.assertEqual(run(*arguments).err, "")
        result = run("slice", "box.stl", "-o", "../inner/box.stl", "--format", "cli")
        self.assertEqual(result.code, 2)
        self.assertIn("overwrite", result.err)
        self.path("locked").chmod(0o700)
        self.fail_with(3, "too long", "slice", "locked/" + "a" * 256 + ".stl", "-o", "b" * 256 + ".cli")

    def test_a_failed_run_leaves_an_older_result_alone(self):
        self.write("out.cli", "older result")
        self.write("empty.stl", b"")
        self.refuse(3, "empty", "empty.stl")
        self.assertEqual(self.bytes_of("out.cli"), b"older result")

    def test_errors_stay_on_one_line_whatever_a_file_is_called(self):
        self.refuse(3, r"bad\\x0aname\\x1b\[31m\.stl: there is no such file", "bad\nname\x1b[31m.stl")


if __name__ == "__main__":
    main()
