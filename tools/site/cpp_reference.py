"""Pages of the public headers, one for each room: every declaration with the comment that is its contract.

Headers are regular enough to be read line by line: an introduction in `//` behind `#pragma once`, then, within the
namespace, declarations with `///` before them. The floors' test sees to what headers may hold.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

TITLES = {
    "core": "Words of all rooms: points, errors, execution",
    "mesh": "Meshes",
    "contour": "Layers and contours",
    "container": "Files under way",
    "read": "Reading",
    "slicing": "Slicing",
    "polygon": "What is made of layers",
    "raster": "Pictures",
    "scan": "Scan vectors",
    "write": "Writing",
    "pipeline": "From file to file",
}


@dataclass
class Declaration:
    comment: list = field(default_factory=list)
    code: list = field(default_factory=list)

    @property
    def name(self):
        """What it declares: a type, a function or a constant."""
        text = " ".join(line.split("//")[0] for line in self.code)
        text = re.sub(r"\[\[.*?\]\]", "", text)
        found = (re.search(r"^\s*(?:template\s*<.*?>\s*)?(?:enum\s+class|class|struct|union)\s+(\w+)", text)
                 or re.search(r"^\s*using\s+(\w+)", text)
                 or re.search(r"(operator\s*\S+?)\s*\(", text)
                 or re.search(r"(\w+)\s*\(", text)
                 or re.search(r"(\w+)\s*(?:=|\{|;)", text))
        if not found:
            raise SystemExit(f"what is declared here?\n{text}")
        return found[1]


@dataclass
class Header:
    path: Path
    introduction: str
    declarations: list


def read_header(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    introduction = []
    rest = iter(lines[lines.index("#pragma once") + 1:])
    for line in rest:
        if line.startswith("//"):
            introduction.append(line[2:].strip())
        elif line or introduction:
            break
    begin = "LAMELLA_API_BEGIN"  # the namespace follows
    found = list(declarations(lines[lines.index(begin) + 2:], path)) if begin in lines else []
    return Header(path, "\n".join(introduction), found)


def declarations(lines, path):
    current = Declaration()
    depth = 0
    for line in lines:
        if line.startswith("} // namespace"):
            return
        stripped = line.strip()
        if not current.code and stripped.startswith("///"):
            current.comment.append(stripped[3:].removeprefix(" "))
        elif not current.code and (not stripped or stripped.startswith(("//", "#"))):
            current = Declaration()
        else:
            current.code.append(line)
            code = line.split("//")[0]
            depth += code.count("{") + code.count("(") - code.count("}") - code.count(")")
            if depth == 0 and code.rstrip().endswith((";", "}")):
                yield current
                current = Declaration()
    raise SystemExit(f"{path}: the namespace does not end")


def room_page(room, headers):
    text = [f"# {TITLES[room]}", ""]
    for header in headers:
        text += [f"## `lamella/{room}/{header.path.name}`", "", header.introduction, ""]
        for one in header.declarations:
            text += [f"### {one.name}", "", *with_tables(one.comment), "", "```cpp", *one.code, "```", ""]
    return "\n".join(text)


def with_tables(comment):
    """Markdown takes indented lines for what is to be kept as it is only behind an empty line."""
    for before, line in zip(["", *comment], comment):
        if line.startswith("    ") and before and not before.startswith("    "):
            yield ""
        yield line


def write_pages(include, folder):
    """Writes index.md and a page for each room; returns their names in the order of the house."""
    folder.mkdir(parents=True, exist_ok=True)
    index = ["# C++ reference", "",
             "The public headers, room by room; `#include <lamella/lamella.hpp>` opens all of them. Everything is in the "
             "namespace `lamella`. Lengths are millimetres.", ""]
    pages = []
    for room, title in TITLES.items():
        headers = [read_header(path) for path in sorted((include / room).glob("*.hpp"))]
        (folder / f"{room}.md").write_text(room_page(room, headers), encoding="utf-8")
        pages.append(f"{room}.md")
        index += [f"## [{title}]({room}.md)", "", "| | |", "|---|---|"]
        for header in headers:
            names = ", ".join(f"`{name}`" for name in dict.fromkeys(one.name for one in header.declarations))
            index.append(f"| `{room}/{header.path.name}` | {names} |")
        index.append("")
    missing = {path.name for path in include.iterdir() if path.is_dir()} - set(TITLES)
    if missing:
        raise SystemExit(f"tools/site/cpp_reference.py knows no title for {', '.join(sorted(missing))}")
    (folder / "index.md").write_text("\n".join(index), encoding="utf-8")
    return ["index.md", *pages]
