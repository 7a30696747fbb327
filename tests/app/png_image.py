"""PNG pictures of 8 bits of grey, read with nothing but zlib."""

import struct
import zlib


class Image:
    """Raises ValueError for anything but what printers ask for: grey, 8 bits, three kinds of chunks."""

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
        self.width, self.height, *kind = struct.unpack(">IIBBBBB", chunks[0][1])
        if kind != [8, 0, 0, 0, 0]:
            raise ValueError(f"not grey with 8 bits: {kind}")
        raw = zlib.decompress(b"".join(content for name, content in chunks if name == b"IDAT"))
        if len(raw) != (self.width + 1) * self.height:
            raise ValueError(f"{len(raw)} bytes of pixels")
        self.rows = []
        above = bytes(self.width)
        for r in range(self.height):
            kind = raw[r * (self.width + 1)]
            row = raw[r * (self.width + 1) + 1:(r + 1) * (self.width + 1)]
            if kind == 2:
                row = row if not any(above) else bytes((a + b) & 255 for a, b in zip(row, above))
            elif kind != 0:
                raise ValueError(f"filter {kind}")
            self.rows.append(row)
            above = row

    def covered(self):
        """The covered area in pixels."""
        return sum(sum(row) for row in self.rows) / 255
