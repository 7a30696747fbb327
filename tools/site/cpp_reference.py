"""Pages of the public headers, one for each module: every declaration with the comment that is its contract.

Headers are regular enough to be read line by line: an introduction in `//` behind `#pragma once`, then, within the
namespace, declarations with `///` before them. The header in C has comments in `/* */` in the same places. The test of
levels checks the content of headers.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import dedent

TITLES = {
    "core": "Points, errors and execution",
    "mesh": "Meshes",
    "contour": "Layers and contours",
    "slicing": "Slicing",
    "polygon": "Operations on layers",
    "scan": "Scan vectors",
    "system": "Whole files",
    "container": "Hashes of files",
    "read": "Reading",
    "raster": "Images",
    "write": "Writing",
    "pipeline": "Whole jobs",
    "c": "From C and other languages",
}


@dataclass
class Declaration:
    comment: list = field(default_factory=list)
    code: list = field(default_factory=list)

    @property
    def name(self):
        """Name of the declared type, function or constant."""
        text = " ".join(line.split("//")[0] for line in self.code)
        text = re.sub(r"\[\[.*?\]\]", "", text)
        found = (re.search(r"^\s*(?:template\s*<.*?>\s*)?(?:typedef\s+)?(?:enum|enum\s+class|class|struct|union)\s+(\w+)", text)
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


def read_c_header(path):
    introduction, interface = path.read_text(encoding="utf-8").split('extern "C" {', 1)
    introduction = re.match(r"/\*(.*?)\*/", introduction, re.DOTALL)[1]
    interface = re.sub(r"^/\*(.*?)\*/$", lambda block: re.sub(r"^[ *]*", "/// ", block[1].rstrip(), flags=re.MULTILINE),
                       interface, flags=re.DOTALL | re.MULTILINE).replace("LAMELLA_C_API ", "")
    found = declarations(interface.replace("\n}\n#endif", "\n} // namespace").splitlines(), path)
    return Header(path, dedent("  " + introduction).rstrip(), list(found))


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


def module_page(module, headers):
    text = [f"# {TITLES[module]}", ""]
    for header in headers:
        text += [f"## `lamella/{module}/{header.path.name}`", "", header.introduction, ""]
        for one in header.declarations:
            text += [f"### {one.name}", "", *with_tables(one.comment), "", "```cpp", *one.code, "```", ""]
    return "\n".join(text)


def with_tables(comment):
    """Adds empty lines before indented lines, as Markdown needs for preformatted text."""
    for before, line in zip(["", *comment], comment):
        if line.startswith("    ") and before and not before.startswith("    "):
            yield ""
        yield line


def write_pages(include, folder):
    """Writes index.md and a page for each module; returns their names in the order of TITLES."""
    folder.mkdir(parents=True, exist_ok=True)
    index = ["# C++ reference", "",
             "The public headers, by module. `lamella/lamella.hpp` includes those of the engine, `lamella/formats.hpp` also those of the formats, `lamella/jobs.hpp` all. Everything is in the "
             "namespace `lamella`, except for the interface in C. Lengths are millimetres.", ""]
    pages = []
    for module, title in TITLES.items():
        headers = [read_c_header(path) if path.suffix == ".h" else read_header(path)
                   for path in sorted((include / module).iterdir())]
        (folder / f"{module}.md").write_text(module_page(module, headers), encoding="utf-8")
        pages.append(f"{module}.md")
        index += [f"## [{title}]({module}.md)", "", "| | |", "|---|---|"]
        for header in headers:
            names = ", ".join(f"`{name}`" for name in dict.fromkeys(one.name for one in header.declarations))
            index.append(f"| `{module}/{header.path.name}` | {names} |")
        index.append("")
    missing = {path.name for path in include.iterdir() if path.is_dir()} - set(TITLES)
    if missing:
        raise SystemExit(f"tools/site/cpp_reference.py knows no title for {', '.join(sorted(missing))}")
    (folder / "index.md").write_text("\n".join(index), encoding="utf-8")
    return ["index.md", *pages]
