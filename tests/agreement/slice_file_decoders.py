"""Decoders of slice files that no program in Debian reads, from the descriptions of the formats alone.

They are strict: what a careful reader could stumble over is an error.
"""

import re
import struct
from typing import NamedTuple


class Contour(NamedTuple):
    part: int
    direction: int  # 0 clockwise, 1 counter-clockwise, 2 an open line; SLC does not say
    points: list  # of (x, y), as the file lists them, in its unit


class Layer(NamedTuple):
    z: float  # in the unit of the file
    contours: list
    hatches: list  # of (part, (x, y), (x, y))


class SliceFile(NamedTuple):
    header: dict
    layers: list


class Bytes:
    """Little-endian numbers, one after the other."""

    def __init__(self, content, at=0):
        self.content = content
        self.at = at

    def take(self, layout):
        values = struct.unpack_from("<" + layout, self.content, self.at)
        self.at += struct.calcsize("<" + layout)
        return values

    def points(self, kind, count):
        flat = self.take(f"{2 * count}{kind}")
        return list(zip(flat[::2], flat[1::2]))

    @property
    def done(self):
        return self.at == len(self.content)


def cli(content):
    """Common Layer Interface 2.0: {'units', 'binary', 'labels', 'layers', 'dimension'} and the layers."""
    text, _, geometry = content.partition(b"$$HEADEREND")
    header = {"labels": {}}
    lines = text.decode("ascii").split("\n")
    assert lines[0] == "$$HEADERSTART" and lines[-1] == "", lines
    for line in lines[1:-1]:
        key, _, value = line.partition("/")
        if key in ("$$BINARY", "$$ASCII"):
            assert "binary" not in header
            header["binary"] = key == "$$BINARY"
        elif key == "$$LABEL":
            number, label = value.split(",", 1)
            header["labels"][int(number)] = label.strip('"')
        elif key == "$$UNITS":
            header["units"] = float(value)
        elif key == "$$LAYERS":
            header["layers"] = int(value)
        elif key == "$$DIMENSION":
            header["dimension"] = [float(v) for v in value.split(",")]
        else:
            assert key in ("$$VERSION", "$$DATE"), line
    return SliceFile(header, cli_binary(geometry) if header["binary"] else cli_ascii(geometry.decode("ascii")))


def cli_ascii(text):
    assert text.startswith("\n$$GEOMETRYSTART\n") and text.endswith("\n$$GEOMETRYEND\n")
    layers = []
    for line in text.split("\n")[2:-2]:
        command, values = re.fullmatch(r"\$\$([A-Z]+)/(.*)", line).groups()
        values = values.split(",")
        counts = {"LAYER": 0, "POLYLINE": 3, "HATCHES": 2}[command]
        for number in values[counts:]:
            assert re.fullmatch(r"-?\d+\.\d+", number), number  # reals have a point, and no exponents
        numbers = [float(v) for v in values[counts:]]
        points = list(zip(numbers[::2], numbers[1::2]))
        if command == "LAYER":
            layers.append(Layer(numbers[0], [], []))
        elif command == "POLYLINE":
            part, direction, count = map(int, values[:3])
            assert count == len(points) and len(numbers) == 2 * count
            layers[-1].contours.append(Contour(part, direction, points))
        else:
            part, count = map(int, values[:2])
            assert len(numbers) == 4 * count
            layers[-1].hatches.extend((part, a, b) for a, b in zip(points[::2], points[1::2]))
    return layers


def cli_binary(geometry):
    layers = []
    source = Bytes(geometry)
    while not source.done:
        command, = source.take("H")
        if command in (127, 128):
            layers.append(Layer(*source.take("f" if command == 127 else "H"), [], []))
        elif command in (129, 130):
            part, direction, count = source.take("HHH" if command == 129 else "iii")
            points = source.points("H" if command == 129 else "f", count)
            layers[-1].contours.append(Contour(part, direction, points))
        elif command in (131, 132):
            part, count = source.take("HH" if command == 131 else "ii")
            points = source.points("H" if command == 131 else "f", 2 * count)
            layers[-1].hatches.extend((part, a, b) for a, b in zip(points[::2], points[1::2]))
        else:
            raise AssertionError(f"command {command} at byte {source.at - 2} of the geometry")
    return layers


def slc(content):
    """SLC 2.0 of 3D Systems: keywords such as '-UNIT', 'table' and 'top', and the layers, whose z are bottoms."""
    header_text, end, _ = content.partition(b"\r\n\x1a")
    assert end and len(header_text) + len(end) <= 2048
    # Keywords and what stands between them, split at blanks as readers do.
    header = {}
    key = None
    for word in header_text.decode("ascii").split(" "):
        if re.match("-[A-Z]", word):
            key = word
            header[key] = []
        elif word:
            header[key].append(word)
    header["-EXTENTS"] = [tuple(float(v) for v in pair.split(",")) for pair in header["-EXTENTS"]]
    source = Bytes(content, len(header_text) + len(end))
    assert source.take("256s") == (bytes(256),)
    entries, = source.take("B")
    assert entries >= 1
    header["table"] = [source.take("4f") for _ in range(entries)]  # lowest z, thickness, width compensation, nothing
    layers = []
    while True:
        z, boundaries = source.take("fI")
        if boundaries == 0xFFFFFFFF:
            header["top"] = z
            assert source.done
            return SliceFile(header, layers)
        layers.append(Layer(z, [], []))
        for _ in range(boundaries):
            count, gaps = source.take("II")
            points = source.points("f", count)
            # A gap is where a vertex stands twice in a row.
            assert gaps == sum(a == b for a, b in zip(points, points[1:]))
            layers[-1].contours.append(Contour(1, None, points))
