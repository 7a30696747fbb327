"""PNG pictures of grey, or of numbers in a palette, read with nothing but zlib."""

import struct
import zlib


class Image:
    """Raises ValueError for anything but what printers ask for: no interlacing, and no other chunks.

    rows: for each row the bytes 0 to 255 of grey, or the numbers in the palette.
    palette: the colours (red, green, blue); empty if the image is grey."""

    def __init__(self, data):
        if data[:8] != b"\x89PNG\r\n\x1a\n":
            raise ValueError("no PNG file")
        chunks = []
        at = 8
        while at < len(data):
            size, name = struct.unpack(">I4s", data[at:at + 8])
            content = data[at + 8:at + 8 + size]
            if struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] != zlib.crc32(name + content):
                raise ValueError(f"wrong CRC of {name}")
            chunks.append((name, content))
            at += 12 + size
        self.chunks = [name.decode() for name, _ in chunks]
        self.width, self.height, self.bits, *kind = struct.unpack(">IIBBBBB", chunks[0][1])
        if (self.bits, kind) not in [(8, [0, 0, 0, 0]), (1, [0, 0, 0, 0]), *((bits, [3, 0, 0, 0]) for bits in (1, 2, 4, 8))]:
            raise ValueError(f"neither grey nor a palette: {self.bits} bits, {kind}")
        colours = b"".join(content for name, content in chunks if name == b"PLTE")
        self.palette = [tuple(colours[i:i + 3]) for i in range(0, len(colours), 3)]
        if self.palette and dict(chunks).get(b"tRNS") != b"\0":
            raise ValueError("the first colour is not transparent, or others are")
        size = (self.width * self.bits + 7) // 8
        raw = zlib.decompress(b"".join(content for name, content in chunks if name == b"IDAT"))
        if len(raw) != (size + 1) * self.height:
            raise ValueError(f"{len(raw)} bytes of pixels")
        self.rows = []
        above = bytes(size)
        for r in range(self.height):
            filter_kind = raw[r * (size + 1)]
            row = raw[r * (size + 1) + 1:(r + 1) * (size + 1)]
            if filter_kind == 2:
                row = row if not any(above) else bytes((a + b) & 255 for a, b in zip(row, above))
            elif filter_kind != 0:
                raise ValueError(f"filter {filter_kind}")
            self.rows.append(self._pixels(row))
            above = row

    def _pixels(self, row):
        if self.bits == 8:
            return row
        most = 2**self.bits - 1
        pixels = [byte >> shift & most for byte in row for shift in range(8 - self.bits, -1, -self.bits)]
        return bytes(pixel if self.palette else 255 * pixel for pixel in pixels[:self.width])

    def covered(self):
        """The covered area in pixels."""
        return sum(sum(row) for row in self.rows) / 255
