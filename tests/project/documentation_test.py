"""What the documentation shows is what runs: samples, command lines, pictures, every link.

usage: documentation_test.py PROGRAM EXAMPLES [unittest arguments], the built lamella and the folder of the built examples

In README.md and the pages of docs/, blocks marked `sh` are commands that a reader may type, one after the other in one folder;
blocks marked `cpp` are files of examples/. Blocks without a mark show what is printed.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM, EXAMPLES = (Path(path).resolve() for path in sys.argv[1:3])
PAGES = [ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md"))]

IMAGES = {
    "tutorial_layer.svg": "lamella make rook && lamella slice rook.stl -o layers --format svg-layers --layers 485:486",
}


def code_blocks(text, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


class Documentation(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.example = (ROOT / "examples/slice_part.cpp").read_text(encoding="utf-8")

    def run_here(self, *command):
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, f"{command}\n{result.stdout}{result.stderr}")
        return result.stdout

    def has_viewer(self):
        """Programs may be built without it; tests/app/view_test.py holds them to saying so."""
        self.run_here(PROGRAM, "make", "box", "-o", "any.stl")
        result = subprocess.run([PROGRAM, "view", "any.stl"], cwd=self.folder, capture_output=True, text=True, check=False)
        return "no viewer" not in result.stderr

    def run_script(self, script, folder):
        environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}
        result = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=environment, text=True,
                                capture_output=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_samples_are_the_examples(self):
        examples = [path.read_text(encoding="utf-8") for path in ROOT.glob("examples/*.cpp")]
        shown = [block for page in PAGES for block in code_blocks(page.read_text(encoding="utf-8"), "cpp")]
        for block in shown:
            self.assertIn(block, examples)
        for example in examples:
            self.assertIn(example, shown)

    def test_the_rules_of_the_conventions_name_their_tests(self):
        page = (ROOT / "docs/conventions.md").read_text(encoding="utf-8")
        rules = set(re.findall(r"^(?:- )?\*\*(\d+\.\d+)\*\*", page, re.MULTILINE))
        last = page[page.index("## Tests of the rules"):]
        rows = re.findall(r"^\| ([\d., ]+) \| (.*) \|$", last, re.MULTILINE)
        untested = set(re.findall(r"\d+\.\d+", last[:last.index("|")].partition("No test checks")[2]))
        tested = {rule for row, _ in rows for rule in row.split(", ")}
        self.assertEqual(tested | untested, rules)
        self.assertEqual(tested & untested, set())
        cpp = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("tests/**/*.cpp"))
        for name in (name for _, names in rows for name in re.findall(r"`([^`]+)`", names)):
            suite, _, test = name.partition(".")
            if test.startswith("test_"):
                found = any(f"def {test}(" in path.read_text(encoding="utf-8") for path in ROOT.glob(f"tests/*/{suite}.py"))
            else:
                found = re.search(rf"\({suite},\s+{test}\)", cpp)
            self.assertTrue(found, name)

    def test_sources_without_a_test_of_their_own_name_are_listed(self):
        """See "Tests" in CONTRIBUTING.md."""
        tests = [path.name for path in ROOT.glob("tests/**/*_test.cpp")]
        untested = [str(path.relative_to(ROOT)) for path in sorted(ROOT.glob("src/**/*.cpp"))
                    if path.parts[-2] not in ("posix", "windows", "none", "program")
                    and not any(re.fullmatch(rf"{re.sub('_(reader|writer)$', '', path.stem)}[a-z0-9_]*_test\.cpp", name) for name in tests)]
        page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
        listed = re.findall(r"^\| `(src/[^`]+)` \| \S", page, re.MULTILINE)
        self.assertEqual(listed, untested)

    def test_the_types_of_the_npm_package_list_all_engines_and_formats(self):
        types = (ROOT / "web/package/api.d.ts").read_text(encoding="utf-8")
        for union, table, row in [(r"engine\?: ([^;]*);", "slicing/engines.cpp", r'Engine\{"([\w-]+)"'),
                                  (r"type FileFormat =([^;]*);", "slices/engine/slice_formats.cpp", r'\.writer = \{\.name = "([\w-]+)"')]:
            names = re.findall(row, (ROOT / "src" / table).read_text(encoding="utf-8"))
            self.assertGreater(len(names), 3)
            listed = re.findall(r"'([\w-]+)'", re.search(union, types)[1])
            self.assertEqual(listed, [name for name in names if name != "png"])  # png writes a folder, no file

    def test_words_that_were_replaced_do_not_come_back(self):
        """See the glossary in CONTRIBUTING.md."""
        words = self.words_of_the_glossary_that_are_not_used()
        self.assertGreater(len(words), 5)
        gone = re.compile(rf"\b({'|'.join(words)}|torn corners?|so many|so much|abscissa|oddity|"
                          r"(WoundRing|LayerWay|HeldWriter|SinkYield|ScanMemory)|(one_sided|wish_for)\w*)\b", re.IGNORECASE)
        fragment = re.compile(r"^ *(///?|[-*])? *(What|Of|How|Whether|As) [a-z][^?\n]*$", re.MULTILINE)
        texts = [path for folder in ("src", "include", "app", "python", "docs") for path in (ROOT / folder).rglob("*")
                 if path.suffix in (".cpp", ".hpp", ".py", ".pyi", ".md")]
        pages = [path for folder in ("viewer/src", "web") for path in (ROOT / folder).rglob("*")
                 if path.suffix in (".js", ".mjs", ".ts", ".html", ".cpp")]
        self.assertGreater(len(pages), 30)
        for path in [ROOT / "README.md", *texts, *pages]:
            text = path.read_text(encoding="utf-8")
            rules = (gone,) if path in pages else (gone, fragment)
            found = [match[0].strip() for rule in rules for match in rule.finditer(text)]
            self.assertEqual(found, [], path)

    def words_of_the_glossary_that_are_not_used(self):
        """Returns patterns of the words in the right column, also with an ending."""
        glossary = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split("## Glossary")[1].split("\n## ")[0]
        rows = [line.split("|") for line in glossary.splitlines() if line.startswith("| ")]
        self.assertEqual(rows[0][3].strip(), "not")
        return [re.escape(word.strip()) + "(s|es)?" for row in rows[1:] for word in row[3].split(",") if word.strip()]

    def test_the_main_header_shows_the_example(self):
        header = (ROOT / "include/lamella/jobs.hpp").read_text(encoding="utf-8")
        shown = [line.strip() for line in re.findall(r"^// {5}(.*)$", header, re.MULTILINE)]
        left_out = {"", "int main() {", "}"}
        self.assertEqual(shown, [line.strip() for line in self.example.splitlines() if line not in left_out])

    def test_the_main_headers_include_the_modules_of_their_libraries(self):
        self.assertEqual(self.included_by("lamella/jobs.hpp"),
                         {str(path.relative_to(ROOT / "include")) for path in ROOT.glob("include/**/*.hpp")})
        engine = {"core", "mesh", "contour", "slicing", "polygon", "scan"}
        for door, expected in [("lamella/lamella.hpp", engine),
                               ("lamella/formats.hpp", engine | {"findings", "meshes", "slices", "inputs", "raster", "container", "system"})]:
            modules = {header.split("/")[1] for header in self.included_by(door) if header.count("/") > 1}
            self.assertEqual(modules, expected)

    def included_by(self, header):
        included, coming = set(), [header]
        while coming:
            header = coming.pop()
            if header not in included:
                included.add(header)
                text = (ROOT / "include" / header).read_text(encoding="utf-8")
                coming += re.findall(r'^#include "(lamella/[^"]+)"', text, re.MULTILINE)
        return included

    def test_the_example_of_the_engine_prints_its_contours(self):
        printed = self.run_here(EXAMPLES / "lamella_example_slice_arrays")
        self.assertIn(f"```\n{printed}```\n", (ROOT / "docs/howto/embedding.md").read_text(encoding="utf-8"))

    def test_the_example_slices_a_part(self):
        self.run_here(PROGRAM, "make", "rook", "-o", "part.stl")
        self.run_here(EXAMPLES / "lamella_example_slice_part")
        self.run_here(PROGRAM, "verify", "part.cli", "--mesh", "part.stl")

    def test_the_example_subtracts_negative_volumes(self):
        self.write_block_with_a_hole("part.stl")  # the content gives the format
        self.run_here(EXAMPLES / "lamella_example_slice_part")
        self.run_here(PROGRAM, "verify", "part.cli", "--mesh", "part.stl")
        info = json.loads(self.run_here(PROGRAM, "info", "part.cli", "--json"))
        self.assertAlmostEqual(info["volume_mm3"], 10 * (10 * 10 - 4 * 4), places=3)

    def write_block_with_a_hole(self, name):
        """Writes a 3MF file: a box of 10 mm, and a negative volume of 4 x 4 mm through it."""
        vertices, triangles = "", ""
        for box, (low, high, bottom, top) in enumerate([(0, 10, 0, 10), (3, 7, -1, 11)]):
            for corner in range(8):
                x, y, z = (high if corner & 1 else low, high if corner & 2 else low, top if corner & 4 else bottom)
                vertices += f'<vertex x="{x}" y="{y}" z="{z}"/>'
            for face in "021", "123", "456", "576", "014", "154", "263", "367", "042", "246", "135", "375":
                triangles += '<triangle v1="{}" v2="{}" v3="{}"/>'.format(*(8 * box + int(corner) for corner in face))
        volumes = "".join(
            f'<volume firstid="{first}" lastid="{first + 11}"><metadata type="volume" key="volume_type" value="{role}"/></volume>'
            for first, role in ((0, "ModelPart"), (12, "NegativeVolume")))
        with zipfile.ZipFile(Path(self.folder, name), "w") as package:
            package.writestr("[Content_Types].xml", "<Types/>")
            package.writestr("3D/3dmodel.model", '<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
                             f'<resources><object id="1"><mesh><vertices>{vertices}</vertices><triangles>{triangles}'
                             '</triangles></mesh></object></resources><build><item objectid="1"/></build></model>')
            package.writestr("Metadata/Slic3r_PE_model.config", f'<config><object id="1">{volumes}</object></config>')

    def test_the_example_streams_layers(self):
        printed = self.run_here(EXAMPLES / "lamella_example_stream_layers")
        self.assertEqual(len(printed.splitlines()), 20)
        self.assertIn(" 0.25 mm   47.531 mm2\n", printed)

    def test_the_example_cuts_sections(self):
        level, _, *corners = self.run_here(EXAMPLES / "lamella_example_cut_sections").splitlines()
        self.assertEqual(level, "z = 2.5 mm: 28.125 mm2")
        for corner in corners:
            self.assertAlmostEqual(sum(map(float, corner.strip("()").split(","))), 6)

    def test_the_tour_prints_what_its_page_shows(self):
        page = (ROOT / "docs/howto/embedding.md").read_text(encoding="utf-8")
        self.assertIn(f"```\n{self.run_here(EXAMPLES / 'lamella_example_tour')}```\n", page)

    def test_the_commands_of_all_pages_work(self):
        tried = 0
        has_viewer = self.has_viewer()
        for page in PAGES:
            script = "".join(code_blocks(page.read_text(encoding="utf-8"), "sh"))
            if not has_viewer:
                script = "".join(line for line in script.splitlines(keepends=True) if not line.startswith("lamella view"))
            if not script:
                continue
            tried += 1
            with self.subTest(page=page.relative_to(ROOT)), tempfile.TemporaryDirectory() as folder:
                self.run_script(script, folder)
        self.assertGreater(tried, 3)

    def test_images_of_the_tutorial_are_what_its_commands_draw(self):
        for name, script in IMAGES.items():
            with self.subTest(image=name), tempfile.TemporaryDirectory() as folder:
                self.run_script(script, folder)
                drawn = next(Path(folder).glob("**/*.svg")).read_text(encoding="utf-8")
                self.assertEqual((ROOT / "docs/images" / name).read_text(encoding="utf-8"), drawn)

    def test_the_bibliography_has_what_sources_and_pages_cite(self):
        bibliography = (ROOT / "docs/bibliography.md").read_text(encoding="utf-8")
        listed = {(names.split()[0], year) for names, year in re.findall(r"^- (.+?) \((\d{4})\):", bibliography, re.MULTILINE)}
        files = [path for folder in ("include", "src", "parts", "docs") for path in (ROOT / folder).rglob("*")
                 if path.suffix in (".cpp", ".hpp", ".md")]
        # "Hobby 1999", "Zhang and Joshi (2015)", "Xu et al. (2016)", "Guigue and Devillers 2003", "Dowell, Jarratt 1971"
        citation = re.compile(r"((?:[A-Z][a-z]+(?:, | and | et al\. ?| ))+)\(?((?:19|20)\d{2})\b")
        cited = {(match[1].split()[0].rstrip(","), match[2]): path for path in files
                 for match in citation.finditer(re.sub(r"\n(?:///? )?(?!\n)", " ", path.read_text(encoding="utf-8")))}
        self.assertGreater(len(cited), 5)
        self.assertEqual({name: path for name, path in cited.items() if name not in listed}, {})

    def test_relative_links_lead_to_files(self):
        pages = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("bench/*.md")]
        self.assertGreater(len(pages), 4)
        for page in pages:
            prose = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
            for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", prose):
                if "://" not in link:
                    self.assertTrue((page.parent / link).exists(), f"{page.relative_to(ROOT)} links to {link}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
