"""Words on the command line, help, and configuration files."""

import json
import re

from program import ON_WINDOWS, ProgramTest, main, needs_posix


class CommandLine(ProgramTest):
    def commands(self):
        return re.findall(r"^  ([a-z]+) {2,}", self.succeed("--help").text.split("To begin")[0], re.MULTILINE)

    def test_without_words_it_introduces_itself(self):
        for arguments in [[], ["--help"], ["-h"], ["help"]]:
            text = self.succeed(*arguments).text
            self.assertIn("lamella slice rook.stl -o rook.cli", text)
            self.assertIn("130", text)

    def test_every_command_that_cuts_a_mesh_snaps(self):
        cutting = [name for name in self.commands() if "--slice-at" in self.succeed(name, "--help").text]
        self.assertEqual(sorted(cutting), ["check", "slice", "verify", "view"])
        for name in cutting:
            self.assertIn("--snap MM", self.succeed(name, "--help").text)

    def test_every_command_has_help(self):
        commands = self.commands()
        self.assertEqual(commands, ["slice", "info", "check", "verify", "compare", "convert", "scan", "strategy", "printers", "resin", "merge", "view", "make", "completion", "help"])
        for command in commands:
            with self.subTest(command):
                text = self.succeed(command, "--help").text
                self.assertEqual(text, self.succeed(command, "-h").text)
                self.assertEqual(text, self.succeed("help", command).text)
                self.assertIn("Examples:", text)
                prose = text.split("Examples:")[0]
                self.assertLessEqual(max(map(len, prose.splitlines())), 80)

    def test_the_introduction_works_as_printed(self):
        text = self.succeed("--help").text
        lines = re.findall(r"^  lamella (.*)$", text, re.MULTILINE)
        self.assertEqual(len(lines), 5)
        for line in lines:
            self.succeed(*line.split())

    def test_the_version(self):
        for word in ["--version", "-V", "-v", "version"]:
            self.assertRegex(self.succeed(word).text, r"^lamella \d+\.\d+\.\d+\nMIT licence\n$")

    def test_three_ways_to_the_help_of_a_command(self):
        texts = {self.succeed(*words).text for words in [["slice", "--help"], ["help", "slice"], ["--help", "slice"], ["-h", "slice"]]}
        self.assertEqual(len(texts), 1)
        self.fail_with(2, "did you mean slice", "--help", "slcie")

    def test_quiet_leaves_results_warnings_and_errors(self):
        self.box()
        self.assertIn("written", self.succeed("slice", "box.stl", "-o", "loud.cli").text)
        quiet = self.succeed("slice", "box.stl", "-o", "quiet.cli", "-q")
        self.assertEqual((quiet.out, quiet.err), (b"", ""))
        self.assertEqual(self.path("quiet.cli").read_bytes(), self.path("loud.cli").read_bytes())
        self.assertEqual(self.succeed("info", "box.stl", "--quiet").out, self.succeed("info", "box.stl").out)
        self.fail_with(3, "no such file", "slice", "none.stl", "-o", "none.cli", "--quiet")
        self.assertEqual(self.succeed("slice", "box.stl", "-q", "-o", "-", "--format", "cli").err, "")
        self.fail_with(2, "contradict", "slice", "box.stl", "-q", "--progress", "bar", "-o", "none.cli")

    def test_the_short_form_of_threads(self):
        self.box()
        for words in [["-j", "2"], ["-j2"]]:
            self.assertEqual(self.succeed("slice", "box.stl", "--stats", "-", *words).json()["threads"], 2)

    def test_units_have_all_their_usual_names(self):
        self.box()
        for names in [["inch", "in"], ["ft", "foot"], ["um", "micron"]]:
            self.assertEqual(len({self.succeed("info", "box.stl", "--unit", name).text for name in names}), 1, names)

    def test_an_output_without_its_option(self):
        self.box()
        for words in [[], ["--stats", "-"]]:
            self.fail_with(2, r"did you mean -o out\.cli\?", "slice", "box.stl", "out.cli", *words)

    def test_a_file_whose_name_begins_with_a_hyphen(self):
        self.box("-dash.stl")
        for name in ["-dash.stl", "--dash.stl", "-hash.stl"]:
            self.fail_with(2, rf"write \./{name}, or -- before it", "slice", name, "-o", "out.cli")
        for words in [["./-dash.stl"], ["--", "-dash.stl"]]:
            self.succeed("slice", "-o", "out.cli", *words)

    def test_a_drawing_of_its_own_is_known(self):
        self.box()
        self.succeed("slice", "box.stl", "-o", "box.dxf")
        self.fail_with(3, "is a DXF drawing, which is only written here", "info", "box.dxf")

    def test_a_bar_that_is_asked_for_needs_no_terminal(self):
        self.succeed("make", "lattice")
        words = ["slice", "lattice.stl", "-o", "lattice.cli", "--scan", "--threads", "1"]
        self.assertNotIn("\r", self.succeed(*words).err)
        self.assertRegex(self.succeed(*words, "--progress", "bar").err, r"\r\w+ +\[#*\.*\]")

    def test_slips_of_the_fingers_get_a_suggestion(self):
        self.box()
        self.fail_with(2, "did you mean lamella slice", "slcie", "box.stl")
        self.fail_with(2, "did you mean --layer-height", "slice", "box.stl", "--layer-hieght", "0.1")
        self.fail_with(2, "did you mean --layer-height", "slice", "box.stl", "--layerheight=0.1")
        self.fail_with(2, "did you mean middle", "slice", "box.stl", "-o", "a.cli", "--slice-at", "midle")
        self.fail_with(2, "did you mean sphere", "make", "shpere")
        self.fail_with(2, "did you mean modifier", "slice", "box.stl", "-o", "a.cli", "--include", "modifer")
        self.fail_with(2, "slice --help", "slice", "box.stl", "--zzzzzz")
        self.fail_with(2, "lamella --help", "zzzzzz")
        self.fail_with(2, "say what to do with it", "box.stl")

    @needs_posix("quotes of its shell")
    def test_a_command_with_a_file_can_be_copied(self):
        for name, quoted in [("box.stl", "box.stl"), ("my box.stl", "'my box.stl'"), ("it's.stl", "'it'\\''s.stl'"), ("$HOME.stl", "'$HOME.stl'")]:
            self.box(name)
            result = self.fail_with(2, "is a file; say what to do with it, such as: lamella view", name)
            self.assertTrue(result.err.endswith(f"such as: lamella view {quoted}\n"), result.err)

    def test_text_files_in_utf_16(self):
        """As redirections of Windows PowerShell write them."""
        self.box("Gehäuse.stl")
        self.box("歯車𝄞.stl")
        for encoding in ["utf-16-le", "utf-16-be", "utf-8"]:
            def text(name, content):
                self.write(name, ("\ufeff" + content).encode(encoding))

            with self.subTest(encoding):
                text("list.txt", "Gehäuse.stl\r\n# not this one\r\n歯車𝄞.stl\r\n")
                lines = self.succeed("slice", "--batch", "list.txt", "-o", "out", "--format", "cli", "--layer-height", "5").text.splitlines()
                self.assertEqual([json.loads(line)["path"] for line in lines], ["Gehäuse.stl", "歯車𝄞.stl"])
                text("z.txt", "1.5\r\n2.5\r\n")
                text("job.toml", 'label = "Gehäuse"\r\nz-list = "z.txt"\r\n')
                stats = self.succeed("slice", "Gehäuse.stl", "--config", "job.toml", "--stats", "-").json()
                self.assertEqual([layer["z"] for layer in stats["layers"]], [1.5, 2.5])
                text("strategy.toml", self.succeed("strategy", "show").text)
                self.succeed("strategy", "check", "strategy.toml")
        self.write("z.txt", "\ufeff1\n".encode("utf-16-le") + b"\x00\xd8\x00")  # half a pair, and half a unit
        self.fail_with(2, "z.txt:2: ", "slice", "Gehäuse.stl", "--z-list", "z.txt", "--stats", "-")

    def test_the_format_of_images_and_of_a_batch(self):
        self.box()
        self.fail_with(2, r"'s\.png': images go into a folder, one for each layer; give the path of a folder and the --format png",
                       "slice", "box.stl", "-o", "s.png")
        self.fail_with(2, "'s' has no extension that determines the format; choose another, or a --format", "slice", "box.stl", "-o", "s")
        self.fail_with(2, "the extension of 's.xyz' is that of no format", "slice", "box.stl", "-o", "s.xyz")
        self.fail_with(2, "out becomes a folder with a file for each mesh; choose their format, such as --format cli",
                       "slice", "--batch", ".", "-o", "out")
        self.succeed("slice", "--batch", ".", "-o", "out", "--format", "cli", "--layer-height", "5")

    def test_values_follow_a_blank_or_an_equals_sign(self):
        self.box()
        layers = [self.succeed("slice", "box.stl", "--stats", "-", *words).json()["layers"]
                  for words in [["--layer-height", "1"], ["--layer-height=1"]]]
        self.assertEqual(layers[0], layers[1])
        for output in [["-o", "out.cli"], ["-oout.cli"], ["-o=out.cli"], ["--output", "out.cli"],
                       ["--output=out.cli"]]:
            self.succeed("slice", "box.stl", *output)
            self.path("out.cli").unlink()

    def test_the_last_of_two_values_counts(self):
        stats = self.succeed("slice", self.box(), "--stats", "-", "--layer-height", "1", "--layer-height", "2")
        self.assertEqual(len(stats.json()["layers"]), 5)

    def test_missing_and_surplus_words(self):
        self.box()
        self.fail_with(2, "needs FILE", "slice", "-o", "a.cli")
        self.fail_with(2, "needs OUT", "convert", "a.cli")
        self.fail_with(2, "needs BODY.*rook", "make")
        self.fail_with(2, '"b.stl"', "view", "box.stl", "b.stl")
        self.fail_with(2, "-o needs a value", "slice", "box.stl", "-o")
        self.fail_with(2, "-o needs a value", "slice", "box.stl", "-o", "--strict")
        self.fail_with(2, "neither true nor false", "slice", "box.stl", "--strict=perhaps")
        self.fail_with(2, "no option -x", "slice", "box.stl", "-x")

    def test_a_configuration_survives_its_round_trip(self):
        words = ["--layer-height", ".25", "--rotate", "10,20,-30", "--slice-at", "top", "--inspect", "--threads", "2",
                 "--label", 'a "part"', "--z-range", "1:5", "-o", "out.cli"]
        dump = self.succeed("slice", "--dump-config", *words).text
        self.write("job.toml", dump)
        self.assertEqual(self.succeed("slice", "--config", "job.toml", "--dump-config").text, dump)
        self.box()
        self.succeed("slice", "box.stl", *words)
        written = self.bytes_of("out.cli")
        self.path("out.cli").unlink()
        self.succeed("slice", "box.stl", "--config", "job.toml")
        self.assertEqual(self.bytes_of("out.cli"), written)

    def test_a_configuration_keeps_where_each_file_stands(self):
        self.box("a.stl", size="4,6,2")
        odd = "b '2'.stl" if ON_WINDOWS else 'b "2"\x7f.stl'
        self.box(odd, size="2,2,3")
        words = ["--unit", "cm", "--copies", "1", "--scale", "2", "a.stl", "--copies", "3", "--spacing", "1.5", odd,
                 "--translate", "90,0,0", "--rotate-z", "30", "--rotate-z", "45", "--label", "tower", "a.stl", "--unit", "mm",
                 "--translate=0,99,0", "-o", "out.cli", "--layer-height", "0.5"]
        self.succeed("slice", *words)
        written = self.bytes_of("out.cli")
        dump = self.succeed("slice", *words, "--dump-config").text
        self.assertEqual(dump.count("[[input]]\n"), 3)
        self.write("job.toml", dump)
        self.assertEqual(self.succeed("slice", "--config", "job.toml", "--dump-config").text, dump)
        self.path("out.cli").unlink()
        self.succeed("slice", "--config", "job.toml")
        self.assertEqual(self.bytes_of("out.cli"), written)

    def test_the_command_line_goes_before_the_files_of_a_configuration(self):
        self.box("a.stl")
        self.box("b.stl", size="3,3,3")
        self.write("job.toml", 'unit = "cm"\n[[input]]\npath = "a.stl"\n[[input]]\npath = "b.stl"\ntranslate = [50, 0, 0]\n')
        boxes = lambda *words: [part["bbox"] for part in
                                self.succeed("slice", "--config", "job.toml", "--stats", "-", *words).json()["parts"]]
        self.assertEqual(boxes()[1], self.succeed("slice", "b.stl", "--unit", "cm", "--translate", "50,0,0", "--stats",
                                                  "-").json()["input"]["bbox"])
        self.assertEqual(boxes("--translate", "0,70,0")[1],
                         self.succeed("slice", "b.stl", "--unit", "cm", "--translate", "0,70,0", "--stats",
                                      "-").json()["input"]["bbox"])
        alone = self.succeed("slice", "b.stl", "--config", "job.toml", "--stats", "-").json()
        self.assertEqual(alone["input"]["bbox"], self.succeed("slice", "b.stl", "--unit", "cm", "--stats",
                                                              "-").json()["input"]["bbox"])
        self.assertNotIn("parts", alone)

    @needs_posix("names of files of any bytes")
    def test_a_name_that_no_configuration_can_hold(self):
        self.fail_with(2, "not UTF-8", "slice", b"\xff.stl".decode("utf-8", "surrogateescape"), "--dump-config")

    def test_options_say_what_they_go_with(self):
        self.box()
        for option, other, value in [("cusp", "adaptive", "0.1"), ("spacing", "copies", "3"), ("jobs", "batch", "2"),
                                     ("resume", "shard", None)]:
            words = [f"--{option}"] + ([value] if value else [])
            self.fail_with(2, f"--{option} goes with --{other}", "slice", "box.stl", "-o", "x.cli", *words)
            self.write("job.toml", f"{option} = {value or 'true'}\n")
            self.fail_with(2, f"--{option} goes with --{other}", "slice", "box.stl", "-o", "x.cli", "--config", "job.toml")
        self.fail_with(2, "box.stl: --spacing goes with --copies", "slice", "box.stl", "--copies", "2", "box.stl", "--spacing", "3",
                       "-o", "x.cli")
        # What is only a preset asks for nothing.
        for words in [[], ["--copies", "2"], ["--adaptive", "0.5:1"]]:
            self.write("job.toml", self.succeed("slice", *words, "--dump-config", "-o", "x.cli").text)
            self.succeed("slice", "box.stl", "--config", "job.toml")

    def test_the_name_of_a_file_is_not_empty(self):
        self.box()
        for arguments in [["slice", "", "-o", "x.cli"], ["slice", "box.stl", "-o", ""], ["info", ""], ["convert", "x.cli", ""],
                          ["slice", "box.stl", "-o", "x.cli", "--config="], ["slice", "box.stl", "--z-list=", "-o", "x.cli"]]:
            with self.subTest(arguments):
                self.fail_with(2, "the name of a file is empty", *arguments)

    def test_the_command_line_goes_before_the_file(self):
        self.write("job.toml", "layer-height = 2\n")
        stats = self.succeed("slice", self.box(), "--layer-height", "5", "--config", "job.toml", "--stats", "-")
        self.assertEqual(len(stats.json()["layers"]), 2)
        stats = self.succeed("slice", "box.stl", "--config", "job.toml", "--stats", "-").json()
        self.assertEqual(len(stats["layers"]), 5)
        self.assertEqual(stats["options"]["layer-height"], 2)

    def test_wrong_configurations_are_refused_with_their_line(self):
        for content, pattern in [("layer-hight = 1\n", r'job\.toml:1:.*"layer-hight"; did you mean layer-height'),
                                 ("strict = true\nlayer-height = 'thin'\n", r"job\.toml:2: layer-height: \"thin\""),
                                 ("layer-height = \n", r"job\.toml:1"), ("config = 'a.toml'\n", "goes on the command line only"),
                                 ("[part]\nlayer-height = 1\n", "no option"), ("rotate = [1, 'a', 3]\n", "rotate"),
                                 ("layer-height = { a = 1 }\n", "no value for an option")]:
            with self.subTest(content):
                self.write("job.toml", content)
                self.fail_with(2, pattern, "slice", "--config", "job.toml", "--dump-config")
        for content, pattern in [('{"layer-height": 1}\n', r"job\.toml:1: expected TOML"),
                                 ("input = 3\n", r"job\.toml:1: expected \[\[input\]\]"),
                                 ("\n[[input]]\nunit = 'mm'\n", r"job\.toml:2: .*no path"),
                                 ("[[input]]\npath = 7\n", r"job\.toml:1: .*no path"),
                                 ("[[input]]\npath = 'a.stl'\nstrict = true\n", r"job\.toml:3: strict is no option of one file"),
                                 ("[[input]]\npath = 'a.stl'\ncopies = 0\n", r"job\.toml:3: copies: "),
                                 ("[[input]]\npath = 'a.stl'\nfolder = 'x'\n", r'job\.toml:3: .*no option "folder"')]:
            with self.subTest(content):
                self.write("job.toml", content)
                self.fail_with(2, pattern, "slice", "--config", "job.toml", "--dump-config")
        self.write("job.toml", "[[input]]\npath = 'a.stl'\n")
        self.fail_with(2, 'no option "input"', "info", "--config", "job.toml", "--dump-config")
        self.fail_with(3, r"missing\.toml", "slice", "--config", "missing.toml", "--dump-config")


if __name__ == "__main__":
    main()
