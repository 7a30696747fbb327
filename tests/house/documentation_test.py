"""What the documentation shows is what runs: the sample in C++, the command lines of README.md, every link.

usage: documentation_test.py PROGRAM EXAMPLE [unittest arguments], the built lamella and lamella_example_slice_part
"""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM, EXAMPLE = (os.path.abspath(path) for path in sys.argv[1:3])


def code_blocks(text, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


class Documentation(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.readme = (ROOT / "README.md").read_text(encoding="utf-8")
        self.example = (ROOT / "examples/slice_part.cpp").read_text(encoding="utf-8")

    def run_here(self, *command):
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, f"{shlex.join(command)}\n{result.stdout}{result.stderr}")

    def has_viewer(self):
        """Programs may be built without it; tests/app/view_test.py holds them to saying so."""
        self.run_here(PROGRAM, "make", "box", "-o", "any.stl")
        result = subprocess.run([PROGRAM, "view", "any.stl"], cwd=self.folder, capture_output=True, text=True, check=False)
        return "no viewer" not in result.stderr

    def test_the_readme_shows_the_example(self):
        self.assertEqual(code_blocks(self.readme, "cpp"), [self.example])

    def test_the_door_shows_the_example(self):
        door = (ROOT / "include/lamella/lamella.hpp").read_text(encoding="utf-8")
        shown = [line.strip() for line in re.findall(r"^// {5}(.*)$", door, re.MULTILINE)]
        left_out = {"", "int main() {", "}"}
        self.assertEqual(shown, [line.strip() for line in self.example.splitlines() if line not in left_out])

    def test_the_example_slices_a_part(self):
        self.run_here(PROGRAM, "make", "rook", "-o", "part.stl")
        self.run_here(EXAMPLE)
        self.run_here(PROGRAM, "verify", "part.cli", "--mesh", "part.stl")

    def test_the_command_lines_of_the_readme_work(self):
        lines = [line for block in code_blocks(self.readme, "sh") for line in block.splitlines()]
        commands = [shlex.split(line, comments=True) for line in lines if line.startswith("lamella ")]
        self.assertGreater(len(commands), 2)
        for command in commands:
            if command[1] != "view" or self.has_viewer():
                self.run_here(PROGRAM, *command[1:])

    def test_relative_links_lead_to_files(self):
        pages = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("bench/*.md")]
        self.assertGreater(len(pages), 4)
        for page in pages:
            for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", page.read_text(encoding="utf-8")):
                if "://" not in link:
                    self.assertTrue((page.parent / link).exists(), f"{page.relative_to(ROOT)} links to {link}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
