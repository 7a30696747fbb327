"""Words on the command line, help, and configuration files."""

import json
import re

from program import ProgramTest, main


class CommandLine(ProgramTest):
    def commands(self):
        return re.findall(r"^  ([a-z]+) {2,}", self.succeed("--help").text.split("To begin")[0], re.MULTILINE)

    def test_without_words_it_introduces_itself(self):
        for arguments in [[], ["--help"], ["-h"], ["help"]]:
            text = self.succeed(*arguments).text
            self.assertIn("lamella slice rook.stl -o rook.cli", text)
            self.assertIn("130", text)

    def test_every_command_has_help(self):
        commands = self.commands()
        self.assertEqual(commands, ["slice", "info", "verify", "compare", "convert", "merge", "view", "make", "completion", "help"])
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
        self.assertRegex(self.succeed("--version").text, r"^lamella \d+\.\d+\.\d+\nMIT licence\n$")

    def test_slips_of_the_fingers_get_a_suggestion(self):
        self.box()
        self.fail_with(2, "did you mean lamella slice", "slcie", "box.stl")
        self.fail_with(2, "did you mean --layer-height", "slice", "box.stl", "--layer-hieght", "0.1")
        self.fail_with(2, "did you mean --layer-height", "slice", "box.stl", "--layerheight=0.1")
        self.fail_with(2, "did you mean middle", "slice", "box.stl", "-o", "a.cli", "--slice-at", "midle")
        self.fail_with(2, "did you mean sphere", "make", "shpere")
        self.fail_with(2, "slice --help", "slice", "box.stl", "--zzzzzz")
        self.fail_with(2, "lamella --help", "zzzzzz")
        self.fail_with(2, "say what to do with it", "box.stl")

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
        self.fail_with(2, '"b.stl"', "info", "box.stl", "b.stl")
        self.fail_with(2, "-o needs a value", "slice", "box.stl", "-o")
        self.fail_with(2, "-o needs a value", "slice", "box.stl", "-o", "--strict")
        self.fail_with(2, "neither true nor false", "slice", "box.stl", "--strict=perhaps")
        self.fail_with(2, "no option -x", "slice", "box.stl", "-x")

    def test_a_configuration_survives_its_round_trip(self):
        words = ["--layer-height", ".25", "--rotate", "10,20,-30", "--slice-at", "top", "--strict", "--threads", "2",
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

    def test_toml_and_json_say_the_same(self):
        self.write("job.toml", 'layer-height = 0.5\nrotate = [90, 0, 0]\nstrict = true\nlabel = "x"\nthreads = 2\n')
        self.write("job.json", json.dumps({"layer-height": 0.5, "rotate": [90, 0, 0], "strict": True, "label": "x",
                                           "threads": 2}))
        dumps = {self.succeed("slice", "--config", f"job.{kind}", "--dump-config").text for kind in ["toml", "json"]}
        self.assertEqual(len(dumps), 1)
        self.assertIn("layer-height = 0.5\n", dumps.pop())

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
                                 ("layer-height = \n", r"job\.toml:1"), ("config = 'a.toml'\n", "no option"),
                                 ("[part]\nlayer-height = 1\n", "no option"), ("rotate = [1, 'a', 3]\n", "rotate"),
                                 ("layer-height = { a = 1 }\n", "no value for an option")]:
            with self.subTest(content):
                self.write("job.toml", content)
                self.fail_with(2, pattern, "slice", "--config", "job.toml", "--dump-config")
        for content in ['{"layer-hight": 1}', "[1]", "{", '{"layer-height": null}', '{"layer-height": {}}']:
            with self.subTest(content):
                self.write("job.json", content)
                self.fail_with(2, r"job\.json", "slice", "--config", "job.json", "--dump-config")
        self.fail_with(3, r"missing\.toml", "slice", "--config", "missing.toml", "--dump-config")


if __name__ == "__main__":
    main()
