"""Charts as SVG text: bars on a logarithmic axis, and points with fitted lines on two logarithmic axes."""

import html
import math
from dataclasses import dataclass
from typing import Optional

COLOURS = ["#0b6e4f", "#6fb98f", "#d1495b", "#edae49", "#30638e", "#8d6a9f", "#7a7a7a"]
FONT = 'font-family="sans-serif" font-size="13"'
# Light or dark like the page around it.
STYLE = ("<style>.paper{fill:#fff}text{fill:#222}.grid{stroke:#ddd}.mark{stroke:#fff}"
         "@media(prefers-color-scheme:dark){.paper{fill:#1b1f22}text{fill:#ddd}.grid{stroke:#444a4f}.mark{stroke:#1b1f22}}</style>")


@dataclass
class Bar:
    group: str
    series: str
    value: Optional[float]  # None: no bar; the note gives the reason
    inner: Optional[float] = None  # a part of the value, marked inside the bar
    note: str = ""
    hollow: bool = False  # outline only: the value is the limit at which it stopped


def bars(items, title, axis, inner_label=""):
    """Draws horizontal bars in groups, one below the other."""
    groups, series = unique(item.group for item in items), unique(item.series for item in items)
    values = [value for item in items for value in (item.value, item.inner) if value]
    low, high = decades(values)
    left, right, top, row, gap = 150, 190, 46 + 20 * math.ceil(len(series) / 4), 19, 16
    width = 960
    height = top + sum(row * sum(item.group == group for item in items) + gap for group in groups) + 46

    def x(value):
        return left + (width - left - right) * (math.log10(value) - low) / (high - low)

    parts = [text(0, 20, title, weight="bold")]
    for i, name in enumerate(series):
        cx, cy = 230 * (i % 4), 34 + 20 * (i // 4)
        parts.append(f'<rect x="{cx}" y="{cy}" width="12" height="12" fill="{colour(i)}"/>')
        parts.append(text(cx + 18, cy + 11, name))
    bottom = height - 46
    for decade in range(low, high + 1):
        parts.append(line(x(10**decade), top - 4, x(10**decade), bottom))
        parts.append(text(x(10**decade), bottom + 18, power_of_ten(decade), anchor="middle"))
    parts.append(text(left, height - 6, axis + (f"; line in a bar: {inner_label}" if inner_label else "")))
    y = top
    for group in groups:
        members = [item for item in items if item.group == group]
        parts.append(text(left - 10, y + row * len(members) / 2 + 4, group, anchor="end"))
        for item in members:
            end = left
            if item.value:
                end = x(item.value)
                paint = colour(series.index(item.series))
                fill = f'fill="none" stroke="{paint}" stroke-dasharray="4 3"' if item.hollow else f'fill="{paint}"'
                parts.append(f'<rect x="{left}" y="{y + 2}" width="{max(end - left, 1):.1f}" height="{row - 4}" '
                             f'{fill}/>')
                if item.inner and x(item.inner) < end - 2:
                    parts.append(line(x(item.inner), y + 2, x(item.inner), y + row - 2, width=2, kind="mark"))
            else:
                parts.append(line(left, y + 2, left, y + row - 2, colour(series.index(item.series)), 3))
            parts.append(text(end + 6, y + row - 5, item.note, size=12))
            y += row
        y += gap
    return svg(width, height, title, parts)


@dataclass
class Series:
    name: str
    points: list  # (x, y)
    fit: Optional[tuple] = None  # y = factor * x ** exponent
    limit: tuple = ()  # points of a line that no value is below


def scatter(series, title, x_axis, y_axis):
    """Draws points on two logarithmic axes, each series with its fitted power law or its limit."""
    low_x, high_x = decades([x for one in series for x, _ in one.points])
    low_y, high_y = decades([y for one in series for _, y in [*one.points, *one.limit]])
    left, right, top, bottom, width, height = 84, 290, 56, 396, 900, 446

    def place(px, py):
        return (left + (width - left - right) * (math.log10(px) - low_x) / (high_x - low_x),
                bottom - (bottom - top) * (math.log10(py) - low_y) / (high_y - low_y))

    parts = [text(0, 20, title, weight="bold")]
    for decade in range(low_x, high_x + 1):
        x, _ = place(10**decade, 10**low_y)
        parts += [line(x, top, x, bottom), text(x, bottom + 18, power_of_ten(decade), anchor="middle")]
    for decade in range(low_y, high_y + 1):
        _, y = place(10**low_x, 10**decade)
        parts += [line(left, y, width - right, y), text(left - 8, y + 4, power_of_ten(decade), anchor="end")]
    parts += [text(left, height - 8, x_axis), text(0, top - 16, y_axis)]
    for i, one in enumerate(series):
        radius = max(7 - 1.5 * i, 2)  # keeps coincident points visible
        for point in one.points:
            cx, cy = place(*point)
            parts.append(f'<circle cx="{cx:.1f}" cy="{cy:.1f}" r="{radius}" fill="{colour(i)}"/>')
        label = one.name
        if one.fit:
            factor, exponent = one.fit
            ends = [min(x for x, _ in one.points), max(x for x, _ in one.points)]
            parts.append(line(*place(ends[0], factor * ends[0]**exponent), *place(ends[1], factor * ends[1]**exponent),
                              colour(i), 1.5))
            label += f": power {exponent:.2f}".replace("-0.00", "0.00")
        for start, end in zip(one.limit, one.limit[1:]):
            parts.append(line(*place(*start), *place(*end), colour(i), 1.5))
        parts += [f'<circle cx="{width - right + 20}" cy="{top + 10 + 22 * i}" r="{radius}" fill="{colour(i)}"/>',
                  text(width - right + 32, top + 14 + 22 * i, label)]
    return svg(width, height, title, parts)


def unique(values):
    return list(dict.fromkeys(values))


def decades(values):
    """Returns the powers of ten below and above all positive values."""
    values = [value for value in values if value > 0] or [1.0]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return low, max(high, low + 1)


def power_of_ten(exponent):
    return f"{10**exponent:,}" if 0 <= exponent < 7 else (f"{10.0**exponent:g}" if -4 < exponent < 0 else f"1e{exponent}")


def colour(i):
    return COLOURS[i % len(COLOURS)]


def line(x1, y1, x2, y2, stroke=None, width=1.0, kind="grid"):
    """Draws a line in a colour; without one, a line of the grid or a mark on a bar."""
    paint = f'stroke="{stroke}"' if stroke else f'class="{kind}"'
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" {paint} stroke-width="{width}"/>'


def text(x, y, words, anchor="start", weight="normal", size=13):
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-weight="{weight}" font-size="{size}">'
            f"{html.escape(words)}</text>")


def svg(width, height, title, parts):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" role="img" aria-label="{html.escape(title)}" {FONT}>\n{STYLE}\n'
            f'<rect class="paper" width="{width}" height="{height}"/>\n' + "\n".join(parts) + "\n</svg>")
