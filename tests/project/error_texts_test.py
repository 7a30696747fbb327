"""Texts of the library speak of fields, as in `max_memory`, and the program knows its option, or the key in files, for each of them."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STRING = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
OPTION = re.compile(r"(?<![<!\w-])--[a-z]{3,}")
FIELD = re.compile(r"`\w+`")


def texts_of(folder):
    """Pairs of a place and a text in the sources of the folder, comments left out."""
    for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            for text in STRING.findall(re.sub(r"^\s*//.*", "", line)):
                yield f"{path.relative_to(ROOT)}:{number}", text


class ErrorTexts(unittest.TestCase):
    def test_the_library_names_no_options_of_the_program(self):
        self.assertEqual([place for place, text in texts_of("src") if OPTION.search(text)], [])

    def test_the_program_has_an_option_for_every_field(self):
        table = (ROOT / "app/failure.cpp").read_text(encoding="utf-8")
        known = set(re.findall(r'FieldOption\{"(`\w+`)", "(?:--[a-z-]+|\w+)"\}', table))
        fields = {field for _, text in texts_of("src") for field in FIELD.findall(text)}
        self.assertIn("`max_memory`", fields)
        self.assertEqual(fields, known)


if __name__ == "__main__":
    unittest.main()
