"""A report of headings, paragraphs, tables and charts, as Markdown and as one self-contained HTML page."""

import html
import math
import re
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Heading:
    text: str
    level: int = 2


@dataclass
class Paragraph:
    text: str  # may contain `code` and **bold**


@dataclass
class Table:
    header: list
    rows: list = field(default_factory=list)
    texts: int = 1  # number of columns from the left that contain text; the others contain numbers

    def add(self, *cells):
        if len(cells) != len(self.header):
            raise ValueError(f"{len(cells)} cells in a table of {len(self.header)} columns")
        self.rows.append([str(cell) for cell in cells])


@dataclass
class Chart:
    name: str  # of the file, in the folder of the Markdown
    title: str
    svg: str


def brief(value):
    """Formats three significant digits without an exponent."""
    if value == 0:
        return "0"
    return f"{value:,.{max(0, 2 - math.floor(math.log10(abs(value))))}f}"


class Page:
    def __init__(self, title):
        self.title = title
        self.blocks = []

    def heading(self, text, level=2):
        self.blocks.append(Heading(text, level))

    def say(self, *texts):
        self.blocks.extend(Paragraph(text) for text in texts)

    def show(self, block):
        self.blocks.append(block)

    def markdown(self, charts=""):
        """`charts` is their folder, relative to the Markdown."""
        texts = [f"![{block.title}]({charts}{block.name}.svg)" if isinstance(block, Chart) else MARKDOWN[type(block)](block)
                 for block in self.blocks]
        return f"# {self.title}\n\n" + "\n\n".join(texts) + "\n"

    def html(self):
        body = "\n".join(HTML[type(block)](block) for block in self.blocks)
        return HTML_PAGE.format(title=html.escape(self.title), body=body)

    def write(self, folder, name):
        """Writes NAME.md with its charts in the same folder, and a self-contained NAME.html."""
        folder = Path(folder)
        (folder / f"{name}.md").write_text(self.markdown(), encoding="utf-8")
        (folder / f"{name}.html").write_text(self.html(), encoding="utf-8")
        self.write_charts(folder)

    def write_charts(self, folder):
        for block in self.blocks:
            if isinstance(block, Chart):
                (folder / f"{block.name}.svg").write_text(block.svg + "\n", encoding="utf-8")

    def write_to_documentation(self, docs, name):
        """Writes NAME.md, and its charts to images/NAME/."""
        images = Path(docs) / "images" / name
        images.mkdir(parents=True, exist_ok=True)
        (Path(docs) / f"{name}.md").write_text(self.markdown(f"images/{name}/"), encoding="utf-8")
        self.write_charts(images)


def markdown_table(table):
    cells = [[cell.replace("|", "\\|") for cell in row] for row in [table.header, *table.rows]]
    widths = [max(len(row[c]) for row in cells) for c in range(len(table.header))]
    lines = []
    for r, row in enumerate(cells):
        aligned = [cell.ljust(width) if c < table.texts else cell.rjust(width)
                   for c, (cell, width) in enumerate(zip(row, widths))]
        lines.append("| " + " | ".join(aligned) + " |")
        if r == 0:
            rule = ["-" * (width + 2) if c < table.texts else "-" * (width + 1) + ":" for c, width in enumerate(widths)]
            lines.append("|" + "|".join(rule) + "|")
    return "\n".join(lines)


def html_table(table):
    def line(row, tag):
        return "<tr>" + "".join(f'<{tag} class="{"text" if c < table.texts else "number"}">{inline(cell)}</{tag}>'
                                for c, cell in enumerate(row)) + "</tr>"
    return ('<div class="wide"><table>\n<thead>' + line(table.header, "th") + "</thead>\n<tbody>"
            + "\n".join(line(row, "td") for row in table.rows) + "</tbody>\n</table></div>")


def inline(text):
    text = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False))
    return re.sub(r"\*\*([^*]*)\*\*", r"<b>\1</b>", text)


MARKDOWN = {
    Heading: lambda block: "#" * block.level + " " + block.text,
    Paragraph: lambda block: block.text,
    Table: markdown_table,
}
HTML = {
    Heading: lambda block: f"<h{block.level}>{inline(block.text)}</h{block.level}>",
    Paragraph: lambda block: f"<p>{inline(block.text)}</p>",
    Table: html_table,
    Chart: lambda block: f"<figure>{block.svg}</figure>",
}
HTML_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
body {{ font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 66rem; margin: 2rem auto; padding: 0 1rem }}
@media (prefers-color-scheme: dark) {{ body {{ color: #ddd; background: #1b1f22 }} }}
p {{ max-width: 48rem }}
.wide {{ overflow-x: auto }}
table {{ border-collapse: collapse; font-size: 0.85rem; margin: 1rem 0 }}
th, td {{ padding: 0.25rem 0.7rem; border-bottom: 1px solid #ddd; vertical-align: top }}
thead th {{ border-bottom: 2px solid #888; text-align: right }}
.text, thead .text {{ text-align: left }}
.number {{ text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }}
figure {{ margin: 1rem 0 }}
figure svg {{ max-width: 100%; height: auto }}
</style>
</head>
<body>
<h1>{title}</h1>
{body}
</body>
</html>
"""
