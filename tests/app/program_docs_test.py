"""docs/program.md tells the same as the program."""

import re

from program import SOURCE, ProgramTest, main

COMMANDS = ["slice", "info", "verify", "compare", "convert", "scan", "strategy", "printers", "resin", "merge", "view", "make", "completion", "help"]


class ProgramDocs(ProgramTest):
    def setUp(self):
        super().setUp()
        path = SOURCE / "docs" / "program.md"
        self.page = path.read_text(encoding="utf-8")

    def section(self, command):
        match = re.search(rf"^## lamella {command}\n(.*?)(?=^## |\Z)", self.page, re.MULTILINE | re.DOTALL)
        self.assertIsNotNone(match, command)
        return match.group(1)

    def test_every_command_has_a_section_with_its_options_and_no_others(self):
        shared = set(re.findall(r"`(--[a-z-]+)", re.search(r"^## Options of several commands\n(.*?)^## ", self.page,
                                                         re.MULTILINE | re.DOTALL).group(1)))
        for command in COMMANDS:
            with self.subTest(command):
                text = self.succeed(command, "--help").text
                real = set(re.findall(r"^  (?:-\w, )?(--[a-z-]+)", text, re.MULTILINE))
                told = set(re.findall(r"^\| `(?:-\w, )?(--[a-z-]+)", self.section(command), re.MULTILINE))
                self.assertEqual(told - real, set())
                self.assertEqual(real - told - shared, set())

    def test_the_exit_codes(self):
        listed = self.succeed("--help").text.partition("Exit codes:\n")[2]
        codes = [(code, " ".join(text.split())) for code, text in
                 re.findall(r"^ +(\d+)  (.*(?:\n {7}.*)*)$", listed, re.MULTILINE)]
        self.assertEqual(len(codes), 9)
        page = self.page.replace("`", "")
        for code, text in codes:
            self.assertIn(f"| {code} | {text} |", page)


if __name__ == "__main__":
    main()
