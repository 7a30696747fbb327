#!/usr/bin/env python3
"""Builds the documentation site from docs/, the public headers and the docstrings of the Python module.

usage: tools/site/build_site.py BUILD_FOLDER SITE_FOLDER PLAYGROUND

BUILD_FOLDER is the build tree of Lamella; the Python reference is made from the module in its folder python/. PLAYGROUND
is the page that `make web` builds. MkDocs builds the pages and reports every broken link.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import cpp_reference
import python_reference

ROOT = Path(__file__).resolve().parents[2]
# Pages outside docs/, and their names in the site.
ADOPTED = {"bench/README.md": "measuring.md", "CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md"}
LINK = re.compile(r"(\]\()([^)#\s]+)((?:#[^)]*)?\))")


def main(build, site, playground):
    with tempfile.TemporaryDirectory() as folder:
        pages = Path(folder, "docs")
        shutil.copytree(ROOT / "docs", pages)
        shutil.copy(playground, pages / "playground.html")
        for source, name in ADOPTED.items():
            (pages / name).write_text(relinked(ROOT / source), encoding="utf-8")
        for page in (ROOT / "docs").glob("**/*.md"):
            (pages / page.relative_to(ROOT / "docs")).write_text(relinked(page), encoding="utf-8")
        cpp_reference.write_pages(ROOT / "include/lamella", pages / "reference/cpp")
        python_reference.write_page(build / "python", pages / "reference/python.md")
        configuration = Path(folder, "mkdocs.yml")
        configuration.write_text(with_all_pages((ROOT / "tools/site/mkdocs.yml").read_text(encoding="utf-8")), encoding="utf-8")
        subprocess.run([sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--config-file", configuration,
                        "--site-dir", site], check=True)
    print(f"The site is in {site}; open {site / 'index.html'}")


def with_all_pages(configuration):
    """Returns the configuration with patterns such as `algorithms/*.md` expanded to pages; MkDocs has no patterns."""

    def lines(match):
        pages = sorted(page.relative_to(ROOT / "docs").as_posix() for page in (ROOT / "docs").glob(match[2]))
        return "".join(f"{match[1]}{page}\n" for page in pages)

    return re.sub(r"^( +- )(\S*\*\S*)\n", lines, configuration, flags=re.MULTILINE)


def relinked(page):
    """Returns the text of a page with links that lead to the targets in the site. Links to files that the site lacks,
    such as sources, become plain words."""
    place = site_place(page)

    def follow(match):
        target = match[2]
        if "://" in target:
            return match[0]
        found = site_place((page.parent / target).resolve())
        return match[1] + relative(found, place.parent) + match[3] if found else match[1] + "#" + ")"

    blocks = re.split(r"(^```.*?^```$)", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    prose = [re.sub(r"\[([^\]]*)\]\(#\)", r"\1", LINK.sub(follow, text)) for text in blocks[::2]]
    blocks[::2] = prose
    return "".join(blocks)


def site_place(path):
    """Returns the path of a file of the tree in the site, or None."""
    inside = path.relative_to(ROOT).as_posix()
    if inside in ADOPTED:
        return Path(ADOPTED[inside])
    if path.is_relative_to(ROOT / "docs"):
        return path.relative_to(ROOT / "docs")
    return None


def relative(path, start):
    ups = [".."] * len(start.parts)
    return "/".join([*ups, *path.parts])


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    main(*(Path(argument).resolve() for argument in sys.argv[1:]))
