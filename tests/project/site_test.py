"""The documentation site: it is built without a broken link, has every public header, and fetches nothing from elsewhere.

usage: site_test.py BUILD_FOLDER [unittest arguments]
"""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv[1]).resolve()


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.site = Path(folder.name, "site")
        cls.playground = Path(folder.name, "made.html")
        cls.playground.write_text("<!doctype html><title>Playground</title>", encoding="utf-8")
        subprocess.run([sys.executable, "-B", ROOT / "tools/site/build_site.py", BUILD, cls.site, cls.playground], check=True)
        cls.pages = {path.relative_to(cls.site).as_posix(): path.read_text(encoding="utf-8")
                     for path in cls.site.glob("**/*.html")}

    def test_every_page_of_docs_is_there(self):
        for page in (ROOT / "docs").glob("**/*.md"):
            self.assertIn(page.relative_to(ROOT / "docs").with_suffix(".html").as_posix(), self.pages)

    def test_the_playground_is_carried_as_it_is(self):
        self.assertEqual(self.pages["playground.html"], self.playground.read_text(encoding="utf-8"))

    def test_every_page_is_in_the_navigation(self):
        home = self.pages["index.html"]
        for page in self.pages:
            if page not in ("404.html", "index.html"):
                self.assertIn(f'href="{page}"', home)

    def test_every_public_header_is_in_the_reference(self):
        headers = list((ROOT / "include/lamella").glob("*/*.h*"))
        self.assertGreater(len(headers), 20)
        for header in headers:
            module = header.parent.name
            self.assertIn(f"lamella/{module}/{header.name}", self.pages[f"reference/cpp/{module}.html"])

    def test_functions_in_c_are_in_the_reference(self):
        page = self.pages["reference/cpp/c.html"]
        header = (ROOT / "include/lamella/c/lamella.h").read_text(encoding="utf-8")
        functions = re.findall(r"^LAMELLA_C_API .*?(\w+)\(", header, re.MULTILINE)
        self.assertGreater(len(functions), 20)
        for function in [*functions, "lamella_settings", "lamella_layer", "lamella_status"]:
            self.assertRegex(page, rf'<h3 id="{function}">{function}<')

    def test_python_names_are_in_the_reference(self):
        page = self.pages["reference/python.html"]
        for name in ("slice", "iter_layers", "inspect", "Error"):
            self.assertRegex(page, rf'<h2 id="{name.lower()}">{name}<')

    def test_nothing_is_fetched_from_elsewhere(self):
        for name, text in self.pages.items():
            fetched = re.findall(r'<(?:script|img|iframe)[^>]*\bsrc="(https?:[^"]*)"|<link[^>]*\bhref="(https?:[^"]*)"', text)
            self.assertEqual(fetched, [], name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
