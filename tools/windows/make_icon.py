#!/usr/bin/env python3
"""Makes an icon for Windows from a drawing that consists of polygons.

usage: tools/windows/make_icon.py DRAWING.svg ICON.ico

The drawing is a square. The icon has an image of each usual size, as PNG.
"""

import struct
import sys
import xml.etree.ElementTree as tree
import zlib
from pathlib import Path

SIZES = (16, 24, 32, 48, 64, 256)
ROWS = 8  # per pixel, in which the covered part is measured


def main(drawing, icon):
    root = tree.parse(drawing).getroot()
    side = float(root.get("viewBox").split()[2])
    polygons = [([tuple(map(float, point.split(","))) for point in one.get("points").split()],
                 bytes.fromhex(one.get("fill").removeprefix("#"))) for one in root]
    images = [png(size, pixels(polygons, size / side, size)) for size in SIZES]
    offset = 6 + 16 * len(images)
    directory = struct.pack("<3H", 0, 1, len(images))
    for size, image in zip(SIZES, images):
        directory += struct.pack("<4B2H2I", size % 256, size % 256, 0, 0, 1, 32, len(image), offset)
        offset += len(image)
    Path(icon).write_bytes(directory + b"".join(images))


def pixels(polygons, scale, size):
    """Returns the rows of the image; each pixel is (red, green, blue, covered part from 0 to 1)."""
    image = [[(0, 0, 0, 0.0)] * size for _ in range(size)]
    for points, colour in polygons:
        corners = [(x * scale, y * scale) for x, y in points]
        for y, row in enumerate(image):
            for x, part in enumerate(covered(corners, y, size)):
                if part > 0:
                    row[x] = over(row[x], colour, part)
    return image


def covered(corners, y, size):
    """Returns the part of each pixel of row y that lies in the polygon."""
    parts = [0.0] * size
    for i in range(ROWS):
        height = y + (i + 0.5) / ROWS
        crossings = sorted(ax + (height - ay) / (by - ay) * (bx - ax)
                           for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]) if (ay > height) != (by > height))
        for left, right in zip(crossings[::2], crossings[1::2]):
            for x in range(max(0, int(left)), min(size, int(right) + 1)):
                parts[x] += max(0.0, min(right, x + 1) - max(left, x)) / ROWS
    return parts


def over(below, colour, part):
    rest = below[3] * (1 - part)
    whole = part + rest
    return (*((new * part + old * rest) / whole for new, old in zip(colour, below)), whole)


def png(size, image):
    rows = b"".join(b"\0" + bytes(round(value) for red, green, blue, part in row for value in (red, green, blue, 255 * part))
                    for row in image)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", size, size, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    main(*sys.argv[1:])
