"""Help: it fits the width of the terminal, has sections, and uses the words of the glossary."""

import os
import re

from program import ProgramTest, main

COMMANDS = ["slice", "info", "verify", "compare", "convert", "scan", "strategy", "printers", "resin", "merge", "view", "make", "completion", "help"]


class Help(ProgramTest):
    def help_in(self, columns, *words):
        environment = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
        return self.succeed(*words, env={**environment, **({} if columns is None else {"COLUMNS": str(columns)})}).text

    def longest(self, text):
        return max(map(len, text.splitlines()))

    def test_every_text_fits_the_terminal_and_breaks_no_word(self):
        for words in [["--help"], *([command, "--help"] for command in COMMANDS), ["help", "slice", "scan"]]:
            usual = self.help_in(None, *words)
            for columns, longest in [(40, 40), (57, 57), (80, 80), (100, 100), (300, 100), (10, 40), (0, 80), ("no number", 80)]:
                with self.subTest(words, columns=columns):
                    text = self.help_in(columns, *words)
                    self.assertEqual(text.split(), usual.split())
                    self.assertLessEqual(self.longest(text), longest)
        self.assertGreater(self.longest(self.help_in(100, "slice", "--help")), 90)

    def test_a_section_is_printed_by_itself(self):
        whole = self.help_in(None, "slice", "--help")
        names = re.search(r"one section of the options: (.*?)\.", " ".join(whole.split()))[1].split(", ")
        self.assertLessEqual({"input", "layers", "repair", "scan", "images", "output", "limits"}, set(names))
        sections = [self.help_in(None, "help", "slice", name) for name in names]
        for section in sections:
            self.assertIn("\n" + section, whole)
        options = re.compile(r"^  (?:-\w, )?(--[a-z-]+)", re.MULTILINE)
        self.assertEqual([option for section in sections for option in options.findall(section)], options.findall(whole))
        self.assertEqual(self.help_in(None, "--help", "slice", "scan"), self.help_in(None, "help", "slice", "scan"))
        self.fail_with(2, "lamella convert has no section scan; its sections are output, images,", "help", "convert", "scan")
        self.fail_with(2, "did you mean scan", "help", "slice", "scna")

    def test_words_of_the_glossary(self):
        """See the glossary in CONTRIBUTING.md."""
        gone = re.compile(r"\b(mend\w*|voids?|shares?|by lot|pictures?|tells?|told|pieces?|slabs?|oddity|crowded|"
                          r"so (many|much)|what is made of|unless given|asked for|there is by default|stood up|goes before|"
                          r"turn|turned|level but|straight from)\b", re.IGNORECASE)
        texts = [self.help_in(None, "--help"), *(self.help_in(None, command, "--help") for command in COMMANDS),
                 self.help_in(None, "help", "--man").replace("\\-", "-"), self.help_in(None, "strategy", "show")]
        for text in texts:
            text = " ".join(re.sub(r"--hatch-turn\b|\bturn_degrees\b", "", text).split())
            self.assertEqual([match[0] for match in gone.finditer(text)], [])

    def test_sentences_of_whole_descriptions(self):
        verify = " ".join(self.help_in(None, "verify", "--help").split())
        self.assertIn("Scan vectors are checked, too: they must lie inside the mesh or, without --mesh, inside the outermost "
                      "contour of their part.", verify)
        merge = " ".join(self.help_in(None, "merge", "--help").split())
        self.assertIn("Files that overlap, leave gaps or belong to different jobs are refused.", merge)


if __name__ == "__main__":
    main()
