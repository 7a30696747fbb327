"""Reads the job files of resin printers (a stack of pictures with exposure and lift settings).

Formats: Elegoo .goo; Chitubox .ctb (versions 2 to 5, not encrypted), .cbddlp and .photon (1, 2); the Anycubic container
(1, 515 to 518); and the zips of PNG pictures: Chitubox zip, NanoDLP, SL1. Only the standard library and NumPy are used.

    job = read("part.goo")
    job.layers[0].pixels()      # height x width, uint8, as the file has it (not un-mirrored)

Names of settings: lengths in mm, times in s, speeds in mm/min, volume in ml, weight in g. `lift` and `retract` are the first
stage, `lift2` and `retract2` the second, numbered as the file numbers them. The reader is strict: whatever breaks a rule of a
format raises FormatError, with layer and offset where they are known.
"""
from __future__ import annotations

import io
import json
import re
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

MAX_PIXELS = 1 << 27        # more than any known panel has (15360 x 8640)
MAX_ENTRY = 1 << 28         # bytes of one unpacked zip entry
MAX_SETS = 16               # 1-bit pictures of one layer

Settings = dict[str, Any]
Runs = tuple[np.ndarray, np.ndarray]        # values and lengths


class FormatError(ValueError):
    """A file that breaks a rule of its format."""

    def __init__(self, message: str, layer: int | None = None, offset: int | None = None):
        self.message, self.layer, self.offset = message, layer, offset
        where = [f"layer {layer}"] if layer is not None else []
        where += [f"offset {offset}"] if offset is not None else []
        super().__init__(": ".join([", ".join(where), message]) if where else message)


class EncryptedError(FormatError):
    """An encrypted file: recognised, never decrypted."""


def expect(condition: bool, message: str, layer: int | None = None, offset: int | None = None) -> None:
    if not condition:
        raise FormatError(message, layer, offset)


@dataclass(frozen=True)
class Source:
    """The bytes of a file; every access is checked."""
    data: bytes = field(repr=False)

    def span(self, offset: int, size: int, what: str, layer: int | None = None) -> bytes:
        expect(0 <= offset and 0 <= size and offset + size <= len(self.data),
               f"{what} ({size} bytes) reaches outside of the file ({len(self.data)} bytes)", layer, offset)
        return self.data[offset:offset + size]

    def u32(self, offset: int, what: str) -> int:
        return struct.unpack("<I", self.span(offset, 4, what))[0]


class Layout:
    """A row of fields, each `name:letter of struct`. Names that begin with `_` are for the reader only."""

    def __init__(self, order: str, text: str):
        pairs = [item.split(":") for item in text.split()]
        self.names = [name for name, _ in pairs]
        self.struct = struct.Struct(order + "".join(kind for _, kind in pairs))
        self.size = self.struct.size

    def read(self, source: Source, offset: int, what: str, layer: int | None = None) -> Settings:
        values = self.struct.unpack(source.span(offset, self.size, what, layer))
        return {name: _plain(value, name, layer, offset) for name, value in zip(self.names, values)}


def _plain(value: Any, name: str, layer: int | None, offset: int) -> Any:
    """Text without padding; single precision as the shortest decimal number that means it."""
    if isinstance(value, bytes):
        return _text(value)
    if isinstance(value, float):
        expect(abs(value) < 1e30, f"{name} is {value}", layer, offset)
        return _single(value)
    return value


def _single(value: float) -> float:
    """The shortest decimal number that means this value in single precision: 0.05, not 0.05000000074505806."""
    return float(str(np.float32(value)))


def _text(raw: bytes) -> str:
    return raw.split(b"\0")[0].decode("utf-8", "replace")


def _public(fields: Settings) -> Settings:
    return {name: value for name, value in fields.items() if not name.startswith("_")}


# ---------------------------------------------------------------------------------------------- runs: decoding

def _starts(sizes: np.ndarray) -> np.ndarray:
    """Where codes begin: the first at 0, each next one `sizes[start]` further; the last one has to end at the end."""
    steps, starts, at = sizes.tolist(), [], 0
    while at < len(steps):
        starts.append(at)
        at += steps[at]
    expect(at == len(steps), "the last run is cut off", offset=starts[-1] if starts else 0)
    return np.array(starts, np.int64)


def _big_endian(data: np.ndarray, at: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Numbers of 0 to 3 bytes, `count` bytes from `at` on."""
    padded = np.concatenate([data, np.zeros(4, np.uint8)])
    value = np.zeros(len(at), np.int64)
    for k in range(3):
        value = np.where(count > k, value << 8 | padded[np.minimum(at + k, len(data))], value)
    return value


GOO_SIZES = np.array([(1, 2, 1, 1)[b >> 6] + ((b >> 4) & (1 if b >> 6 == 2 else 3)) for b in range(256)])


def decode_goo(chunks: np.ndarray) -> Runs:
    """Chunks of a .goo layer, without the leading 0x55 and the checksum."""
    at = _starts(GOO_SIZES[chunks])
    first = chunks[at].astype(np.int64)
    kind, low, step = first >> 6, first & 15, first >> 6 == 2
    second = _big_endian(chunks, at + 1, np.ones_like(at))
    long = _big_endian(chunks, at + 1 + (kind == 1), np.where(step, 0, first >> 4 & 3)) << 4 | low
    lengths = np.where(step, np.where(first & 16, second, 1), long)
    values = np.where(kind == 3, 255, np.where(kind == 1, second, 0))
    values = _follow_steps(values, step, np.where(first & 32, -low, low))
    wrong = np.flatnonzero((values < 0) | (values > 255))
    expect(not len(wrong), "a difference leaves the range 0..255", offset=int(at[wrong[0]]) if len(wrong) else None)
    return values, lengths


def _follow_steps(values: np.ndarray, step: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Replaces differences to the value before by values; 0 stands before the first one."""
    total = np.cumsum(np.where(step, change, 0))
    last = np.maximum.accumulate(np.where(step, -1, np.arange(len(step))))
    return total + np.where(last >= 0, values[last] - total[last], 0)


CTB_EXTRA = np.array([0] * 128 + [1] * 64 + [2] * 32 + [3] * 32)


def decode_ctb(data: np.ndarray) -> Runs:
    """A picture of .ctb after the cipher; values are the 7-bit greys of the file."""
    second = np.append(data[1:], np.uint8(0))[:len(data)]
    at = _starts(np.where(data < 128, 1, 2 + CTB_EXTRA[second]))
    run, head = data[at] >= 128, second[at].astype(np.int64)
    wrong = np.flatnonzero(run & (head >= 0xF0))
    expect(not len(wrong), "a run length begins with 1111", offset=int(at[wrong[0]]) if len(wrong) else None)
    extra = CTB_EXTRA[head]
    tail = _big_endian(data, at + 2, extra)
    lengths = (head & np.array([0x7F, 0x3F, 0x1F, 0x0F])[extra]) << 8 * extra | tail
    return (data[at] & 127).astype(np.int64), np.where(run, lengths, 1)


def decode_pw0(data: np.ndarray) -> Runs:
    """Anycubic's 4-bit greys: black and white have 12 bits of length, the others 4."""
    grey = data >> 4
    at = _starts(np.where((grey == 0) | (grey == 15), 2, 1))
    first = data[at].astype(np.int64)
    values, low = first >> 4, first & 15
    long = low << 8 | _big_endian(data, at + 1, np.ones_like(at))
    return values, np.where((values == 0) | (values == 15), long, low)


def decode_bits(data: np.ndarray) -> Runs:
    """A 1-bit picture of .cbddlp, .photon and .pws."""
    return (data >> 7).astype(np.int64), (data & 127).astype(np.int64)


def ctb_cipher(data: bytes, key: int, layer: int) -> bytes:
    """The layer cipher of .ctb; applied twice it gives the same bytes again. Key 0: none."""
    if key == 0 or not data:
        return bytes(data)
    step = (key * 0x2D83CDAC + 0xD8A83423) & 0xFFFFFFFF
    start = (layer * 0x1E1530CD + 0xEC3D47CD) * step & 0xFFFFFFFF
    words = np.frombuffer(data + bytes(-len(data) % 4), "<u4")
    stream = np.arange(len(words), dtype=np.uint32) * np.uint32(step) + np.uint32(start)
    return (words ^ stream).astype("<u4").tobytes()[:len(data)]


# ---------------------------------------------------------------------------------------------- runs of pictures

def runs_of(pixels: np.ndarray) -> Runs:
    """The longest possible runs of equal values."""
    flat = np.asarray(pixels).reshape(-1)
    starts = np.concatenate([[0], np.flatnonzero(flat[1:] != flat[:-1]) + 1])[:len(flat)]
    return flat[starts].astype(np.int64), np.diff(np.append(starts, len(flat)))


def goo_checksum(chunks: bytes) -> int:
    return 255 - int(np.frombuffer(chunks, np.uint8).sum(dtype=np.uint64)) % 256


# ---------------------------------------------------------------------------------------------- pictures and jobs

GREY_GOO = np.arange(256, dtype=np.uint8)
GREY_CTB = np.array([0] + [2 * g + 1 for g in range(1, 128)], np.uint8)
GREY_PW0 = np.arange(16, dtype=np.uint8) * np.uint8(17)


def grey_of_sets(levels: int) -> np.ndarray:
    """Shown grey for the number of sets in which a pixel is on."""
    return np.array([0] + [count * 256 // levels - 1 for count in range(1, levels + 1)], np.uint8)


@dataclass
class CodedPicture:
    """A picture of runs. Several 1-bit pictures can lie in several spans (sets) or in one (`sets`)."""
    source: Source
    spans: list[tuple[int, int]]                    # offset and size
    size: tuple[int, int]                           # width, height
    layer: int
    decode: Callable[[np.ndarray], Runs]
    shown: np.ndarray
    sets: int = 1
    key: int = 0                                    # of the cipher
    may_lack: int = 0                               # pixels that may be missing at the end

    def data(self, plane: int = 0) -> bytes:
        """The stored bytes of a plane, after the cipher."""
        offset, size = self.spans[plane]
        return ctb_cipher(self.source.span(offset, size, "picture", self.layer), self.key, self.layer)

    def planes(self) -> list[Runs]:
        """The runs of all planes; they cover the picture exactly."""
        return [runs for k in range(len(self.spans)) for runs in self._divide(k)]

    def _divide(self, k: int) -> list[Runs]:
        offset, area = self.spans[k][0], self.size[0] * self.size[1]
        try:
            values, lengths = self.decode(np.frombuffer(self.data(k), np.uint8))
        except FormatError as error:
            raise FormatError(error.message, self.layer, offset + (error.offset or 0)) from None
        expect(bool(np.all(lengths > 0)), "a run of length 0", self.layer, offset)
        ends = np.cumsum(lengths)
        total, wanted = int(ends[-1]) if len(ends) else 0, area * self.sets
        expect(wanted - self.may_lack <= total <= wanted, f"runs cover {total} of {wanted} pixels", self.layer, offset)
        cuts = np.searchsorted(ends, area * np.arange(1, self.sets))
        expect(bool(np.all(ends[cuts] == area * np.arange(1, self.sets))), "a run crosses the end of a 1-bit picture",
               self.layer, offset)
        return list(zip(np.split(values, cuts + 1), np.split(lengths, cuts + 1)))

    def pixels(self) -> np.ndarray:
        planes, area = self.planes(), self.size[0] * self.size[1]
        if len(planes) == 1:
            flat = np.repeat(self.shown[planes[0][0]], planes[0][1])
        else:
            flat = np.zeros(area, np.uint8)
            for values, lengths in planes:
                flat += np.repeat(values.astype(np.uint8), lengths)
            flat = self.shown[flat]
        if len(flat) < area:
            flat = np.append(flat, np.zeros(area - len(flat), np.uint8))
        return flat.reshape(self.size[1], self.size[0])

    def lit(self) -> int:
        """Number of pixels that are not black; all rules of runs are checked on the way."""
        planes = self.planes()
        if len(planes) == 1:
            return int(planes[0][1][self.shown[planes[0][0]] > 0].sum())
        return int(np.count_nonzero(self.pixels()))

    def lacking(self) -> int:
        return self.size[0] * self.size[1] - int(self.planes()[0][1].sum())


@dataclass
class PngPicture:
    """A picture of a zip. An RGB picture of a third of the width holds three grey pixels in one, red first."""
    archive: "Archive"
    name: str
    size: tuple[int, int]
    layer: int

    def _read(self, decode: Callable[[bytes], Any]) -> Any:
        try:
            return decode(self.archive.read(self.name))
        except FormatError as error:
            raise FormatError(f"{self.name}: {error.message}", self.layer, error.offset) from None

    def check(self) -> None:
        head = self._read(png_header)
        wide = head.width == self.size[0] or (head.colour == 2 and head.width * 3 == self.size[0])
        expect(wide and head.height == self.size[1], f"{self.name} has {head.width} x {head.height} pixels", self.layer)

    def planes(self) -> list[Runs]:
        return [runs_of(self.pixels())]

    def pixels(self) -> np.ndarray:
        self.check()
        image = self._read(decode_png)
        if image.shape[1] != self.size[0]:
            return image.reshape(self.size[1], self.size[0])
        colours = image[..., :3] if image.shape[2] > 2 else image[..., :1]
        expect(bool(np.all(colours == colours[..., :1])), f"{self.name} is not grey", self.layer)
        return np.ascontiguousarray(colours[..., 0])


@dataclass
class LayerRecord:
    z_mm: float                                     # top of the layer
    exposure_s: float | None                        # None: the file does not say
    settings: Settings                              # the layer's own
    picture: CodedPicture | PngPicture

    def pixels(self) -> np.ndarray:
        """Height x width, uint8, shown greys."""
        return self.picture.pixels()

    def runs(self, plane: int = 0) -> list[tuple[int, int]]:
        """(value, length) as the file has them: values are codes of the file, not shown greys."""
        values, lengths = self.picture.planes()[plane]
        return list(zip(values.tolist(), lengths.tolist()))


@dataclass
class Job:
    format: str                                     # goo, ctb, cbddlp, anycubic, chitubox-zip, nanodlp, sl1
    version: int | str | None
    printer: str
    pixels: tuple[int, int]
    display_mm: tuple[float, float] | None          # along the picture's x and y
    layer_height_mm: float
    mirrored: tuple[bool, bool] | None
    settings: Settings = field(default_factory=dict)
    previews: list[np.ndarray] = field(default_factory=list)
    layers: list[LayerRecord] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def _check_pictures(job: Job) -> None:
    """Decodes the runs of all layers once; shared pictures are not decoded again."""
    known: dict[tuple, int] = {}
    counted = any(layer.settings.get("lit_pixels") for layer in job.layers)
    for index, layer in enumerate(job.layers):
        picture = layer.picture
        if isinstance(picture, PngPicture):
            picture.check()
            continue
        data = (*picture.spans, picture.may_lack)
        if picture.key or data not in known:
            known[data] = picture.lit()
        stored = layer.settings.get("lit_pixels")
        expect(stored in (None, known[data]) or not counted,
               f"{stored} pixels that are not black are declared, the picture has {known[data]}", index)
        if picture.may_lack and picture.lacking():
            job.warnings.append(f"layer {index}: the runs are {picture.lacking()} pixel short")
    if not counted and any(known.values()) and any("lit_pixels" in layer.settings for layer in job.layers):
        job.warnings.append("the counts of pixels that are not black are all 0")


def _check_size(width: int, height: int) -> tuple[int, int]:
    expect(0 < width and 0 < height and width * height <= MAX_PIXELS, f"pictures of {width} x {height} pixels")
    return width, height


def _check_overlap(regions: Iterable[tuple[int, int, str]], shared: set[tuple[int, int]] = frozenset()) -> None:
    """No two regions (offset, size, name) of a file may overlap, except that `shared` ones can be the same."""
    end, before, last = 0, "", (-1, -1)
    for offset, size, name in sorted(region for region in regions if region[1] > 0):
        if (offset, size) == last and last in shared:
            continue
        expect(offset >= end, f"{name} overlaps {before}", offset=offset)
        end, before, last = offset + size, name, (offset, size)


def _rgb565(raw: bytes, width: int, height: int, order: str) -> np.ndarray:
    words = np.frombuffer(raw, order + "u2").reshape(height, width)
    red, green, blue = words >> 11, words >> 5 & 63, words & 31
    parts = [red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2]
    return np.stack(parts, axis=-1).astype(np.uint8)


# ---------------------------------------------------------------------------------------------- Elegoo .goo

GOO_MAGIC = bytes.fromhex("0700000044 4C5000")
GOO_END = bytes.fromhex("000000070000 00444C5000")
GOO_FIRST = 195477
GOO_TEXTS = Layout(">", "_version:4s _magic:8s software:32s software_version:24s file_time:24s printer:32s "
                   "printer_type:32s resin:32s anti_aliasing:H grey_level:H blur_level:H")
GOO_HEAD = Layout(">", "_layers:I _x:H _y:H _mirror_x:B _mirror_y:B display_x_mm:f display_y_mm:f machine_z_mm:f "
                  "layer_height_mm:f exposure_s:f delay_mode:B light_off_s:f bottom_wait_before_lift_s:f "
                  "bottom_wait_after_lift_s:f bottom_wait_after_retract_s:f wait_before_lift_s:f wait_after_lift_s:f "
                  "wait_after_retract_s:f bottom_exposure_s:f bottom_layers:I bottom_lift_mm:f bottom_lift_mm_min:f "
                  "lift_mm:f lift_mm_min:f bottom_retract_mm:f bottom_retract_mm_min:f retract_mm:f retract_mm_min:f "
                  "bottom_lift2_mm:f bottom_lift2_mm_min:f lift2_mm:f lift2_mm_min:f bottom_retract2_mm:f "
                  "bottom_retract2_mm_min:f retract2_mm:f retract2_mm_min:f bottom_pwm:H pwm:H own_settings:B "
                  "print_time_s:I _volume_mm3:f weight_g:f price:f currency:8s _first:I grey_256:B transition_layers:H")
GOO_LAYER = Layout(">", "pause:H pause_z_mm:f _z:f _exposure:f light_off_s:f wait_before_lift_s:f wait_after_lift_s:f "
                   "wait_after_retract_s:f lift_mm:f lift_mm_min:f lift2_mm:f lift2_mm_min:f retract_mm:f "
                   "retract_mm_min:f retract2_mm:f retract2_mm_min:f pwm:H _crlf:2s _size:I")


def _read_goo(source: Source) -> Job:
    texts, head = GOO_TEXTS.read(source, 0, "header"), GOO_HEAD.read(source, 195310, "header")
    expect(texts["_version"] == "V3.0", f"version {texts['_version']!r} is not known", offset=0)
    for offset in (27106, 195308):
        expect(source.data[offset:offset + 2] == b"\r\n", "the delimiter after a preview is missing", offset=offset)
    expect(head["_first"] == GOO_FIRST, f"the first layer is said to stand at {head['_first']}", offset=195470)
    for name in ("delay_mode", "own_settings", "grey_256", "_mirror_x", "_mirror_y"):
        expect(head[name] <= 1, f"{name} is {head[name]}")
    settings = _public(texts) | _public(head) | {"volume_ml": head["_volume_mm3"] / 1000}
    job = Job("goo", "3.0", texts["printer"], _check_size(head["_x"], head["_y"]),
              (head["display_x_mm"], head["display_y_mm"]), head["layer_height_mm"],
              (bool(head["_mirror_x"]), bool(head["_mirror_y"])), settings)
    if not head["grey_256"]:
        job.warnings.append("greys are said to be 0..15; they are shown as the file has them")
    for offset, side in ((194, 116), (27108, 290)):
        job.previews.append(_rgb565(source.span(offset, 2 * side * side, "preview"), side, side, ">"))
    offset = GOO_FIRST
    for index in range(head["_layers"]):
        offset = _read_goo_layer(source, job, index, offset)
    expect(source.data[offset:] == GOO_END, "the end mark is missing or not the last", offset=offset)
    return job


def _read_goo_layer(source: Source, job: Job, index: int, offset: int) -> int:
    """Adds the layer that begins at `offset`; returns where the next one begins."""
    record = GOO_LAYER.read(source, offset, "layer header", index)
    expect(source.data[offset + 64:offset + 66] == b"\r\n", "the delimiter before the picture is missing", index, offset + 64)
    data, size = offset + GOO_LAYER.size, record["_size"]
    raw = source.span(data, size + 2, "picture", index)
    expect(size >= 2 and raw[0] == 0x55, "the picture does not begin with 0x55", index, data)
    expect(raw[size - 1] == goo_checksum(raw[1:size - 1]), "the checksum is wrong", index, data + size - 1)
    expect(raw[size:] == b"\r\n", "the delimiter after the picture is missing", index, data + size)
    picture = CodedPicture(source, [(data + 1, size - 2)], job.pixels, index, decode_goo, GREY_GOO)
    job.layers.append(LayerRecord(record["_z"], record["_exposure"], _public(record), picture))
    return data + size + 2


# ---------------------------------------------------------------------------------------------- .ctb, .cbddlp, .photon

CTB_VERSIONS = {0x12FD0019: (1, 2), 0x12FD0086: (2, 3), 0x12FD0106: (4, 5), 0xFF220810: (4,)}
CTB_ENCRYPTED = 0x12FD0107
CBDDLP = 0x12FD0019
CTB_HEAD = Layout("<", "_magic:I _version:I display_x_mm:f display_y_mm:f machine_z_mm:f _:I _:I height_mm:f "
                  "layer_height_mm:f exposure_s:f bottom_exposure_s:f light_off_s:f bottom_layers:I _x:I _y:I _large:I "
                  "_table:I _layers:I _small:I print_time_s:I mirror:I _print:I _print_size:I _sets:I pwm:H bottom_pwm:H "
                  "cipher_key:I")
CTB_PRINT = Layout("<", "bottom_lift_total_mm:f bottom_lift_mm_min:f lift_total_mm:f lift_mm_min:f retract_mm_min:f "
                   "volume_ml:f weight_g:f price:f bottom_light_off_s:f light_off_s:f bottom_layers:I _:I _:I _:I _:I")
CTB_SLICER = Layout("<", "bottom_lift2_mm:f bottom_lift2_mm_min:f lift2_mm:f lift2_mm_min:f retract2_mm:f "
                    "retract2_mm_min:f _wait_4:f _name:I _name_size:I anti_aliasing_flag:B _:H own_settings:B "
                    "minutes_since_1970:I anti_aliasing:I _slicer:I wait_after_retract_s:f wait_after_lift_s:f "
                    "transition_layers:I _block4:I _:I _:I")
CTB_BLOCK4 = Layout("<", "bottom_retract_mm_min:f bottom_retract2_mm_min:f _:I _:f _:I _:f wait_after_retract_s:f "
                    "wait_after_lift_s:f wait_before_lift_s:f bottom_retract2_mm:f _:f _:I _:I _last:I _:I _:I _:I _:I "
                    "_rights:I _rights_size:I _resin:I _:380s")
CTB_RESIN = Layout("<", "_:I _blue:B _green:B _red:B _alpha:B _machine:I _type_size:I _type:I _resin_size:I _resin:I "
                   "_machine_size:I resin_density:f _:I")
CTB_ENTRY = Layout("<", "z_stored_mm:f _exposure:f light_off_s:f _data:I _size:I _page:I _record:I _:I _:I")
CTB_RECORD = Layout("<", "_whole:I lift_total_mm:f lift_mm_min:f lift2_mm:f lift2_mm_min:f retract_mm_min:f "
                    "retract2_mm:f retract2_mm_min:f wait_before_lift_s:f wait_after_lift_s:f wait_after_retract_s:f pwm:f")
PREVIEW = Layout("<", "_x:I _y:I _data:I _size:I _:I _:I _:I _:I")


class _CtbReader:
    """Reads .ctb, .cbddlp and .photon; `regions` are all parts of the file, to see that none overlap."""

    def __init__(self, source: Source):
        self.source, self.head = source, CTB_HEAD.read(source, 0, "header")
        self.magic, self.version = self.head["_magic"], self.head["_version"]
        expect(self.version in CTB_VERSIONS[self.magic], f"version {self.version} does not go with this magic", offset=4)
        self.regions: list[tuple[int, int, str]] = [(0, 108 if self.version == 1 else 112, "header")]
        self.sharable: set[tuple[int, int]] = set()
        self.cbddlp = self.magic == CBDDLP

    def read(self) -> Job:
        head = self.head
        self.job = job = Job("cbddlp" if self.cbddlp else "ctb", self.version, "", _check_size(head["_x"], head["_y"]),
                             (head["display_x_mm"], head["display_y_mm"]), head["layer_height_mm"],
                             (head["mirror"] == 1, False), _public(head))
        expect(head["mirror"] <= 1, f"mirror is {head['mirror']}", offset=0x50)
        for name in ("_large", "_small"):
            if head[name]:
                job.previews.append(self._preview(head[name]))
        if self.version >= 2:
            self._print_parameters()
        self._layers()
        _check_overlap(self.regions, self.sharable)
        return job

    def _part(self, layout: Layout, offset: int, name: str, layer: int | None = None) -> Settings:
        self.regions.append((offset, layout.size, name))
        return layout.read(self.source, offset, name, layer)

    def _preview(self, offset: int) -> np.ndarray:
        entry = self._part(PREVIEW, offset, "preview header")
        width, height = _check_size(entry["_x"], entry["_y"])
        self.regions.append((entry["_data"], entry["_size"], "preview"))
        expect(entry["_size"] % 2 == 0, "a preview has an odd number of bytes", offset=offset)
        words = np.frombuffer(self.source.span(entry["_data"], entry["_size"], "preview"), "<u2")
        return decode_rgb15(words, width, height)

    def _print_parameters(self) -> None:
        head, job = self.head, self.job
        expect(head["_print_size"] == CTB_PRINT.size, f"{head['_print_size']} bytes of print parameters", offset=0x58)
        self._merge(self._part(CTB_PRINT, head["_print"], "print parameters"))
        slicer, size = (self.source.u32(at, "header") for at in (0x68, 0x6C))
        if slicer == 0 and self.cbddlp:
            return
        expect(size == CTB_SLICER.size, f"{size} bytes of the slicer block", offset=0x6C)
        block = self._part(CTB_SLICER, slicer, "slicer block")
        self._merge(block)
        job.printer = _text(self.source.span(block["_name"], block["_name_size"], "name of the machine"))
        major, minor, patch, build = block["_slicer"].to_bytes(4, "big")
        job.settings["slicer_version"] = ".".join(map(str, (major, minor, patch, build)))
        if self.version >= 4 and block["_block4"]:
            self._block4(block["_block4"])
        for stage in ("", "bottom_"):
            total, second = (job.settings[stage + name] for name in ("lift_total_mm", "lift2_mm"))
            job.settings[stage + "lift_mm"] = _single(total - second)

    def _block4(self, offset: int) -> None:
        block = self._part(CTB_BLOCK4, offset, "version-4 block")
        self._merge(block)
        expect(block["_last"] == self.head["_layers"] - 1, f"the last layer is said to be {block['_last']}", offset=offset + 52)
        self.source.span(block["_rights"], block["_rights_size"], "text of the version-4 block")
        if self.version < 5 or not block["_resin"]:
            return
        resin = self._part(CTB_RESIN, block["_resin"], "resin block")
        self._merge(resin)
        texts = {"resin_type": "_type", "resin": "_resin", "machine": "_machine"}
        for name, key in texts.items():
            self.job.settings[name] = _text(self.source.span(resin[key], resin[key + "_size"], name))

    def _merge(self, block: Settings) -> None:
        """Adds settings of a block; warns where two blocks disagree."""
        for name, value in _public(block).items():
            old = self.job.settings.get(name, value)
            if old != value:
                self.job.warnings.append(f"{name} is {old} in one block and {value} in another")
            self.job.settings[name] = value

    def _layers(self) -> None:
        head, count = self.head, self.head["_layers"]
        self.sets = head["_sets"] if self.cbddlp and self.version == 2 else 1
        expect(1 <= self.sets <= MAX_SETS, f"{self.sets} level sets", offset=0x5C)
        expect(self.cbddlp or head["_sets"] == 1, f"{head['_sets']} level sets in .ctb", offset=0x5C)
        if self.sets > 1 and 256 % self.sets:
            self.job.warnings.append(f"256 cannot be divided by {self.sets} level sets")
        self.job.settings["level_sets"] = self.sets
        if self.cbddlp and head["cipher_key"]:
            self.job.warnings.append("a cipher key in .cbddlp has no known meaning")
        self.source.span(head["_table"], CTB_ENTRY.size * count * self.sets, "layer table")
        for index in range(count):
            self._layer(index, [head["_table"] + CTB_ENTRY.size * (s * count + index) for s in range(self.sets)])
        if self.cbddlp and self.job.layers and self.job.layers[0].z_mm < self.job.layer_height_mm / 2:
            for layer in self.job.layers:
                layer.z_mm = _single(layer.z_mm + self.job.layer_height_mm)

    def _layer(self, index: int, places: list[int]) -> None:
        entries = [self._part(CTB_ENTRY, place, "layer table", index) for place in places]
        spans = [(entry["_data"] + (entry["_page"] << 32), entry["_size"]) for entry in entries]
        for offset, size in spans:
            self.regions.append((offset, size, f"picture of layer {index}"))
            self.source.span(offset, size, "picture", index)
            if self.cbddlp:
                self.sharable.add((offset, size))
        settings = _public(entries[0]) | self._record(index, entries[0], places[0], spans[0])
        shown = grey_of_sets(self.sets) if self.cbddlp else GREY_CTB
        picture = CodedPicture(self.source, spans, self.job.pixels, index, decode_bits if self.cbddlp else decode_ctb, shown,
                               key=0 if self.cbddlp else self.head["cipher_key"],
                               may_lack=1 if self.cbddlp and self.sets == 1 and index == 0 else 0)
        self.job.layers.append(LayerRecord(entries[0]["z_stored_mm"], entries[0]["_exposure"], settings, picture))

    def _record(self, index: int, entry: Settings, place: int, span: tuple[int, int]) -> Settings:
        """The record before a picture: a copy of the table's entry and, from version 3 on, the layer's own settings."""
        size, offset = entry["_record"], span[0] - entry["_record"]
        allowed = (84,) if self.version >= 3 else (0, 36) if self.version == 2 else (0,)
        expect(size in allowed, f"a record of {size} bytes before the picture", index, place + 24)
        if size == 0:
            return {}
        self.regions.append((offset, size, f"record of layer {index}"))
        copy = self.source.span(offset, size, "record before the picture", index)[:CTB_ENTRY.size]
        expect(copy == self.source.data[place:place + CTB_ENTRY.size], "the record is no copy of the table's entry",
               index, offset)
        if size == 36:
            return {}
        record = CTB_RECORD.read(self.source, offset + 36, "record before the picture", index)
        expect(record["_whole"] == size + span[1], f"record and picture are said to have {record['_whole']} bytes",
               index, offset + 36)
        if self.version == 3:
            del record["wait_after_retract_s"]
        return _public(record) | {"lift_mm": _single(record["lift_total_mm"] - record["lift2_mm"])}


def decode_rgb15(words: np.ndarray, width: int, height: int) -> np.ndarray:
    """A preview of .ctb: 5 bits per colour; bit 5 says that the next word repeats the pixel."""
    run = words & 0x20 != 0
    at = _starts(np.where(run, 2, 1))
    following = np.append(words[1:], np.uint16(0))[:len(words)][at]
    run, pixel = run[at], words[at]
    expect(bool(np.all(following[run] >> 12 == 3)), "a repeat in a preview does not begin with 3")
    lengths = np.where(run, (following & 0xFFF).astype(np.int64) + 1, 1)
    expect(int(lengths.sum()) == width * height, f"runs of a preview cover {int(lengths.sum())} of {width * height} pixels")
    parts = [pixel >> 11, pixel >> 6 & 31, pixel & 31]
    colours = np.stack([part << 3 | part >> 2 for part in parts], axis=-1).astype(np.uint8)
    return np.repeat(colours, lengths, axis=0).reshape(height, width, 3)


# ---------------------------------------------------------------------------------------------- Anycubic container

ANY_TABLES = {1: 4, 515: 5, 516: 8, 517: 9, 518: 11}
ANY_HEADER_SIZE = {1: 80, 515: 80, 516: 84, 517: 92, 518: 96}
ANY_MACHINE_SIZE = {516: 156, 517: 156, 518: 224}
ANY_HEADER = Layout("<", "_pixel_um:f layer_height_mm:f exposure_s:f light_off_s:f bottom_exposure_s:f bottom_layers:f "
                    "lift_mm:f lift_mm_s:f retract_mm_s:f volume_ml:f anti_aliasing:I _x:I _y:I weight_g:f price:f "
                    "currency:4s own_settings:I print_time_s:I transition_layers:I transition_type:I")
ANY_HEADER_516 = Layout("<", "two_stages:I")
ANY_HEADER_517 = Layout("<", "grey:H blur:H resin_type:I")
ANY_HEADER_518 = Layout("<", "intelligent_mode:I")
ANY_GREY = Layout("<", "full_greyscale:I _count:I")
ANY_LAYER = Layout("<", "_data:I _size:I lift_mm:f lift_mm_s:f _exposure:f thickness_mm:f lit_pixels:I _:I")
ANY_EXTRA = Layout("<", "_two:I bottom_lift_mm:f bottom_lift_mm_s:f bottom_retract2_mm_s:f bottom_lift2_mm:f "
                   "bottom_lift2_mm_s:f bottom_retract_mm_s:f _two_again:I lift_mm:f lift_mm_s:f retract2_mm_s:f lift2_mm:f "
                   "lift2_mm_s:f retract_mm_s:f")
ANY_MACHINE = Layout("<", "machine:96s image_format:16s greatest_anti_aliasing:I properties:I machine_x_mm:f machine_y_mm:f "
                     "machine_z_mm:f greatest_version:I _:I")
ANY_SOFTWARE = Layout("<", "software:32s _size:I software_version:32s _system:64s _opengl:32s")
ANY_MODEL = Layout("<", "model_min_x_mm:f model_min_y_mm:f model_min_z_mm:f model_max_x_mm:f model_max_y_mm:f "
                   "model_max_z_mm:f supports:I density:f")


class _AnycubicReader:
    def __init__(self, source: Source, suffix: str):
        self.source, self.suffix = source, suffix
        expect(source.span(0, 12, "header") == b"ANYCUBIC\0\0\0\0", "the mark is not followed by zeros", offset=8)
        self.version, tables = source.u32(12, "header"), source.u32(16, "header")
        expect(self.version in ANY_TABLES, f"version {self.version} is not known", offset=12)
        expect(tables == ANY_TABLES[self.version], f"{tables} tables in version {self.version}", offset=16)
        names = ["header", "software", "preview", "grey", "layers", "extra"]
        names += ["machine"] if self.version >= 516 else []
        names += ["pictures"] + (["model"] if self.version >= 517 else [])
        names += ["sublayers", "preview2"] if self.version >= 518 else []
        self.address = {name: source.u32(20 + 4 * k, name) for k, name in enumerate(names)}
        self.regions: list[tuple[int, int, str]] = [(0, 20 + 4 * len(names), "addresses")]
        self.sharable: set[tuple[int, int]] = set()

    def read(self) -> Job:
        settings = self._header()
        width, height = _check_size(settings.pop("_x"), settings.pop("_y"))
        pixel = settings.pop("_pixel_um") / 1000
        self.job = job = Job("anycubic", self.version, "", (width, height), (_single(width * pixel), _single(height * pixel)),
                             settings["layer_height_mm"], None, _per_minute(settings) | {"pixel_mm": pixel})
        for name, part in (("preview", self._preview), ("grey", self._grey), ("software", self._software),
                           ("machine", self._machine), ("model", self._model), ("extra", self._extra),
                           ("sublayers", self._sublayers)):
            if self.address.get(name):
                part(self.address[name])
        self._layers()
        _check_overlap(self.regions, self.sharable)
        return job

    def _table(self, name: str, offset: int, head: int, size: int) -> int:
        """Checks the name of a table; returns its length field. `size` is the payload."""
        raw = self.source.span(offset, 16, f"table {name}")
        expect(raw[:12] == name.encode().ljust(12, b"\0"), f"no table {name} here", offset=offset)
        self.regions.append((offset, head + size, f"table {name}"))
        return struct.unpack("<I", raw[12:])[0]

    def _header(self) -> Settings:
        offset, size = self.address["header"], ANY_HEADER_SIZE[self.version]
        length = self._table("HEADER", offset, 16, size)
        expect(length == size, f"HEADER has length {length}, not {size}", offset=offset + 12)
        settings, at = ANY_HEADER.read(self.source, offset + 16, "HEADER"), offset + 16 + ANY_HEADER.size
        for since, layout in ((516, ANY_HEADER_516), (517, ANY_HEADER_517), (518, ANY_HEADER_518)):
            if self.version >= since:
                settings |= layout.read(self.source, at, "HEADER")
                at += layout.size
        bottom = settings["bottom_layers"]
        expect(bottom == int(bottom), "the number of bottom layers is not whole", offset=offset)
        return settings | {"bottom_layers": int(bottom)}

    def _preview(self, offset: int) -> None:
        width, mark, height = struct.unpack("<I4sI", self.source.span(offset + 16, 12, "PREVIEW"))
        _check_size(width, height)
        size = 12 + 2 * width * height
        length = self._table("PREVIEW", offset, 16, size)
        expect(length == (size if self.version == 1 else size + 16), f"PREVIEW has length {length}", offset=offset + 12)
        expect(mark == b"x\0\0\0", "no x between the preview's width and height", offset=offset + 20)
        self.job.previews.append(_rgb565(self.source.span(offset + 28, size - 12, "PREVIEW"), width, height, "<"))

    def _grey(self, offset: int) -> None:
        table = ANY_GREY.read(self.source, offset, "grey table")
        expect(table["_count"] == 16, f"{table['_count']} greys in the table", offset=offset + 4)
        self.regions.append((offset, 28, "grey table"))
        greys = self.source.span(offset + 8, 20, "grey table")
        self.job.settings |= _public(table) | {"grey_table": list(greys[:16])}

    def _software(self, offset: int) -> None:
        self.regions.append((offset, ANY_SOFTWARE.size, "software"))
        table = ANY_SOFTWARE.read(self.source, offset, "software")
        expect(table["_size"] == ANY_SOFTWARE.size, f"software has length {table['_size']}", offset=offset + 32)
        self.job.settings |= _public(table)

    def _whole(self, name: str, offset: int, sizes: Iterable[int], layout: Layout) -> Settings:
        """A table whose length counts its 16 bytes of name and length as well."""
        length = self._table(name, offset, 0, max(sizes))
        expect(length in sizes, f"{name} has length {length}", offset=offset + 12)
        self.source.span(offset, length, name)
        return _per_minute(_public(layout.read(self.source, offset + 16, name)))

    def _machine(self, offset: int) -> None:
        self.job.settings |= self._whole("MACHINE", offset, [ANY_MACHINE_SIZE[self.version]], ANY_MACHINE)
        self.job.printer = self.job.settings["machine"]

    def _model(self, offset: int) -> None:
        self.job.settings |= self._whole("MODEL", offset, [16 + ANY_MODEL.size], ANY_MODEL)

    def _extra(self, offset: int) -> None:
        length = self._table("EXTRA", offset, 16, ANY_EXTRA.size)
        expect(length == 24, f"EXTRA has length {length}", offset=offset + 12)
        table = ANY_EXTRA.read(self.source, offset + 16, "EXTRA")
        expect(table["_two"] == 2 and table["_two_again"] == 2, "EXTRA does not say 2 and 2", offset=offset + 16)
        stages = _per_minute(_public(table))
        if self.job.settings["two_stages"]:
            self.job.settings["lift_total_mm"] = self.job.settings["lift_mm"]
            self.job.settings |= stages
        else:
            self.job.settings |= {"extra_" + name: value for name, value in stages.items()}

    def _sublayers(self, offset: int) -> None:
        """Version 518: places of pictures once more; only that they are inside of the file is checked."""
        count = self.source.u32(offset + 16, "SUBIMGS")
        length = self._table("SUBIMGS", offset, 0, 24 + 44 * count)
        expect(length == 24 + 44 * count, f"SUBIMGS has length {length}", offset=offset + 12)
        for index in range(count):
            place, size = struct.unpack("<II", self.source.span(offset + 24 + 44 * index, 44, "SUBIMGS")[:8])
            self.source.span(place, size, "picture in SUBIMGS", index)

    def _layers(self) -> None:
        offset = self.address["layers"]
        count = self.source.u32(offset + 16, "LAYERDEF")
        length = self._table("LAYERDEF", offset, 16, 4 + ANY_LAYER.size * count)
        expect(length == 4 + ANY_LAYER.size * count, f"LAYERDEF has length {length}", offset=offset + 12)
        self.source.span(offset + 20, ANY_LAYER.size * count, "LAYERDEF")
        image = self.job.settings.get("image_format", "pwsImg" if self.suffix == ".pws" else "pw0Img")
        expect(image in ("pw0Img", "pwsImg"), f"pictures of the kind {image!r} are not known")
        z = 0.0
        for index in range(count):
            place = offset + 20 + ANY_LAYER.size * index
            entry = ANY_LAYER.read(self.source, place, "LAYERDEF", index)
            z += entry["thickness_mm"]
            self._layer(index, entry, round(z, 6), image == "pwsImg")

    def _layer(self, index: int, entry: Settings, z: float, pws: bool) -> None:
        span = (entry["_data"], entry["_size"])
        self.source.span(*span, "picture", index)
        self.regions.append((*span, f"picture of layer {index}"))
        self.sharable.add(span)
        expect(span[0] >= self.address["pictures"], "the picture stands before the pictures", index, span[0])
        sets = self.job.settings["anti_aliasing"] if pws else 1
        expect(1 <= sets <= MAX_SETS, f"{sets} pictures in each layer", index)
        picture = CodedPicture(self.source, [span], self.job.pixels, index, decode_bits if pws else decode_pw0,
                               grey_of_sets(sets) if pws else GREY_PW0, sets)
        self.job.layers.append(LayerRecord(z, entry["_exposure"], _per_minute(_public(entry)), picture))


def _per_minute(settings: Settings) -> Settings:
    """Speeds in mm/s (names that end in _mm_s) become mm/min."""
    return {name[:-1] + "min" if name.endswith("_mm_s") else name:
            _single(value * 60) if name.endswith("_mm_s") else value for name, value in settings.items()}


# ---------------------------------------------------------------------------------------------- PNG

@dataclass
class PngHeader:
    width: int
    height: int
    depth: int
    colour: int                                     # 0 grey, 2 RGB, 4 grey and alpha, 6 RGB and alpha
    channels: int


def png_header(data: bytes) -> PngHeader:
    expect(data[:8] == b"\x89PNG\r\n\x1a\n" and data[8:16] == b"\0\0\0\x0dIHDR" and len(data) >= 33, "no PNG picture")
    width, height, depth, colour, packing, filters, interlace = struct.unpack(">IIBBBBB", data[16:29])
    _check_size(width, height)
    channels = {0: 1, 2: 3, 4: 2, 6: 4}.get(colour, 0)
    expect(depth == 8 and channels > 0 or depth in (1, 2, 4) and colour == 0, f"PNG of kind {colour} with {depth} bits")
    expect((packing, filters, interlace) == (0, 0, 0), "PNG with interlacing or an unknown packing")
    return PngHeader(width, height, depth, colour, channels)


def decode_png(data: bytes) -> np.ndarray:
    """A PNG picture as height x width x channels; greys of less than 8 bits are spread to 0..255."""
    head = png_header(data)
    per_row = (head.width * head.channels * head.depth + 7) // 8
    wanted = head.height * (per_row + 1)
    unpacker = zlib.decompressobj()
    try:
        raw = unpacker.decompress(b"".join(_png_chunks(data, b"IDAT")), wanted + 1)
    except zlib.error as error:
        raise FormatError(f"PNG: {error}") from None
    expect(len(raw) == wanted and unpacker.eof and not unpacker.unused_data, "PNG has more or fewer bytes than its rows need")
    rows = np.frombuffer(raw, np.uint8).reshape(head.height, per_row + 1)
    image = _unfilter(rows[:, 0], rows[:, 1:].reshape(head.height, -1, head.channels))
    if head.depth == 8:
        return image
    bits = np.unpackbits(image[..., 0], axis=1).reshape(head.height, -1, head.depth)[:, :head.width]
    levels = bits.astype(np.uint8) @ (1 << np.arange(head.depth)[::-1]).astype(np.uint8)
    return (levels * np.uint8(255 // ((1 << head.depth) - 1)))[..., np.newaxis]


def _png_chunks(data: bytes, kind: bytes) -> list[bytes]:
    """The contents of all chunks of a kind; checks lengths, checksums and the last chunk."""
    found, at, name = [], 8, b""
    while name != b"IEND":
        expect(at + 12 <= len(data), "PNG is cut off", offset=at)
        size, name = struct.unpack(">I4s", data[at:at + 8])
        expect(at + 12 + size <= len(data), "PNG is cut off", offset=at)
        body = data[at + 8:at + 8 + size]
        expect(data[at + 8 + size:at + 12 + size] == struct.pack(">I", zlib.crc32(name + body)), "PNG: wrong CRC", offset=at)
        found += [body] if name == kind else []
        at += 12 + size
    expect(at == len(data), "bytes after the end of the PNG", offset=at)
    return found


def _unfilter(filters: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Undoes the filters of rows x pixels x bytes per pixel."""
    expect(int(filters.max()) <= 4, "PNG with an unknown filter")
    if int(filters.max()) > 2:
        return _unfilter_diagonals(filters, rows)
    image = rows.copy()
    for y, kind in enumerate(filters.tolist()):
        if kind == 1:
            image[y] = np.cumsum(rows[y], axis=0, dtype=np.uint8)
        elif kind == 2 and y > 0:
            image[y] += image[y - 1]
    return image


def _unfilter_diagonals(filters: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """All five filters at once, along diagonals: row y is moved y pixels to the right, so that all neighbours of a
    diagonal stand on the two diagonals before it."""
    height, width, size = rows.shape
    skew = np.zeros((width + height + 1, height + 1, size), np.uint8)      # one row and two diagonals of zeros in front
    ys = np.arange(height)
    for x in range(width):
        skew[ys + x + 2, ys + 1] = rows[:, x]
    masks = [(filters == kind)[:, np.newaxis] for kind in range(5)]
    for d in range(2, width + height + 1):
        left, up, corner = (part.astype(np.int16) for part in (skew[d - 1, 1:], skew[d - 1, :-1], skew[d - 2, :-1]))
        a, b, c = np.abs(up - corner), np.abs(left - corner), np.abs(left + up - 2 * corner)
        paeth = np.where((a <= b) & (a <= c), left, np.where(b <= c, up, corner))
        skew[d, 1:] += np.select(masks[1:], [left, up, (left + up) >> 1, paeth], 0).astype(np.uint8)
    return np.stack([skew[ys + x + 2, ys + 1] for x in range(width)], axis=1)


# ---------------------------------------------------------------------------------------------- zips

class Archive:
    """A zip; every failure of reading is a FormatError."""

    def __init__(self, data: bytes):
        self.zip = self._try(lambda: zipfile.ZipFile(io.BytesIO(data)))
        self.names = self.zip.namelist()
        expect(len(set(self.names)) == len(self.names), "two entries of the zip have the same name")

    @staticmethod
    def _try(action: Callable[[], Any]) -> Any:
        try:
            return action()
        except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError, OSError,
                struct.error, OverflowError, IndexError, KeyError) as error:
            raise FormatError(f"zip: {error}") from None

    def read(self, name: str) -> bytes:
        expect(name in self.names, f"{name} is missing")
        entry = self.zip.getinfo(name)
        expect(entry.compress_type in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED), f"{name} is packed in an unusual way")
        expect(entry.file_size <= MAX_ENTRY, f"{name} is too large")
        return self._try(lambda: self.zip.read(name))

    def text(self, name: str) -> str:
        return self.read(name).decode("utf-8-sig", "replace")

    def json(self, name: str) -> Any:
        """The JSON document `name`; an empty dict when the zip has none."""
        if name not in self.names:
            return {}
        try:
            return json.loads(self.text(name))
        except (ValueError, RecursionError) as error:
            raise FormatError(f"{name}: {error}") from None

    def numbered(self, pattern: str, first: int) -> list[str]:
        """Entries whose number follows without gaps from `first` on, in order of the numbers."""
        found = [(int(match[1]), name) for name in self.names if (match := re.fullmatch(pattern, name))]
        expect([number for number, _ in sorted(found)] == list(range(first, first + len(found))),
               "the numbers of the pictures have gaps or repeat")
        return [name for _, name in sorted(found)]

    def previews(self, names: Iterable[str]) -> list[np.ndarray]:
        images = [decode_png(self.read(name)) for name in names if name in self.names]
        return [image[..., :3] if image.shape[2] > 2 else np.repeat(image[..., :1], 3, axis=2) for image in images]


NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", re.ASCII)


def _number(value: Any) -> Any:
    """Numbers that are written as text become numbers; everything else stays."""
    if not isinstance(value, str) or len(value) > 40 or not NUMBER.fullmatch(value.strip()):
        return value
    number = float(value)
    return int(value) if re.fullmatch(r"\s*[+-]?\d+\s*", value) else number


def _need(settings: Settings, *names: str, whole: bool = False) -> Any:
    """The first of these settings that is there, as a finite number that is not negative."""
    for name in names:
        value = _number(settings.get(name))
        if value is not None:
            expect(isinstance(value, (int, float)) and not isinstance(value, bool) and 0 <= value < 1e12,
                   f"{name} is {value!r}")
            expect(not whole or value == int(value), f"{name} is not a whole number")
            return int(value) if whole else float(value)
    raise FormatError(f"{names[0]} is missing")


def _add_pngs(job: Job, archive: Archive, names: list[str], exposure: Callable[[int], float | None],
              own: list[Settings] | None = None) -> None:
    for index, name in enumerate(names):
        z = round((index + 1) * job.layer_height_mm, 6)
        picture = PngPicture(archive, name, job.pixels, index)
        job.layers.append(LayerRecord(z, exposure(index), own[index] if own else {}, picture))


def _read_zip(data: bytes) -> Job:
    archive = Archive(data)
    for mark, reader in (("run.gcode", _read_chitubox_zip), ("plate.json", _read_nanodlp), ("config.ini", _read_sl1)):
        if mark in archive.names:
            return reader(archive)
    raise FormatError("a zip without run.gcode, plate.json or config.ini")


CHITUBOX_NAMES = {"layerHeight": "layer_height_mm", "machineZ": "machine_z_mm", "normalExposureTime": "exposure_s",
                  "bottomLayerExposureTime": "bottom_exposure_s", "bottomLayerCount": "bottom_layers"}


def _read_chitubox_zip(archive: Archive) -> Job:
    raw: Settings = {}
    for line in archive.text("run.gcode").splitlines():
        match = re.fullmatch(r";\s*(\w+)\s*:(.*)", line.strip())
        if match:
            raw.setdefault(match[1], _number(match[2].strip()))
        elif line.strip() and not line.startswith(";"):
            break
    settings = {CHITUBOX_NAMES.get(name, name): value for name, value in raw.items()}
    size = _check_size(_need(raw, "resolutionX", whole=True), _need(raw, "resolutionY", whole=True))
    mirrored = (_need(raw, "mirror") == 1, False) if "mirror" in raw else None
    job = Job("chitubox-zip", None, str(raw.get("machineType", "")), size, (_need(raw, "machineX"), _need(raw, "machineY")),
              _need(raw, "layerHeight"), mirrored, settings)
    names = archive.numbered(r"([1-9]\d{0,8})\.png", 1)
    expect(len(names) == _need(raw, "totalLayer", whole=True), f"{len(names)} pictures, not {raw['totalLayer']}")
    bottom, normal = _need(raw, "bottomLayerExposureTime"), _need(raw, "normalExposureTime")
    count = _need(raw, "bottomLayerCount", whole=True)
    _add_pngs(job, archive, names, lambda index: bottom if index < count else normal)
    job.previews = archive.previews(["preview.png", "preview_cropping.png"])
    return job


def _read_nanodlp(archive: Archive) -> Job:
    plate, profile, meta = (archive.json(name) for name in ("plate.json", "profile.json", "meta.json"))
    slicer, options = archive.json("slicer.json"), archive.json("options.json")
    for document in (plate, profile, meta, slicer, options):
        expect(isinstance(document, dict), "a JSON document is not an object")
    every = plate | profile | slicer | options
    size = _check_size(_need(every, "PWidth", whole=True), _need(every, "PHeight", whole=True))
    pixel = [_need(every, name) for name in ("XPixelSize", "YPixelSize")]
    height = _need(every, "Thickness", "Depth") / 1000
    bottom, exposure = _need(every, "SupportCureTime"), _need(every, "CureTime")
    settings = {"exposure_s": exposure, "bottom_exposure_s": bottom, "plate": plate, "profile": profile, "slicer": slicer,
                "options": options, "bottom_layers": _need(every, "SupportLayerNumber", whole=True)}
    job = Job("nanodlp", _number(meta.get("FormatVersion")), str(every.get("DisplayController", "")), size,
              (_single(size[0] * pixel[0]), _single(size[1] * pixel[1])), height, None, settings)
    names = archive.numbered(r"([1-9]\d{0,8})\.png", 1)
    expect(len(names) == _need(plate, "LayersCount", whole=True), f"{len(names)} pictures, not {plate.get('LayersCount')}")
    own = _nanodlp_info(archive, len(names))
    _add_pngs(job, archive, names, lambda index: bottom if index < settings["bottom_layers"] else exposure, own)
    job.previews = archive.previews(["3d.png"])
    return job


def _nanodlp_info(archive: Archive, count: int) -> list[Settings] | None:
    info = archive.json("info.json")
    if info == {}:
        return None
    expect(isinstance(info, list) and len(info) == count and all(isinstance(item, dict) for item in info),
           "info.json has not one object for each layer")
    return info


def _ini(text: str) -> Settings:
    pairs = (line.split("=", 1) for line in text.splitlines() if "=" in line and not line.startswith(("#", ";")))
    return {name.strip(): _number(value.strip()) for name, value in pairs}


def _read_sl1(archive: Archive) -> Job:
    config = _ini(archive.text("config.ini"))
    profile = _ini(archive.text("prusaslicer.ini")) if "prusaslicer.ini" in archive.names else {}
    names = archive.numbered(re.escape(str(config.get("jobDir", ""))) + r"(\d{5})\.png", 0)
    expect(len(names) > 0, "no pictures")
    count = _need(config, "numSlow", whole=True) + _need(config, "numFast", whole=True)
    expect(len(names) == count, f"{len(names)} pictures, not {count}")
    head = png_header(archive.read(names[0]))
    display, mirrored = _sl1_display(profile, (head.width, head.height))
    first, normal, fade = _need(config, "expTimeFirst"), _need(config, "expTime"), _need(config, "numFade", whole=True)
    job = Job("sl1", None, str(config.get("printerModel", "")), (head.width, head.height), display,
              _need(config, "layerHeight"), mirrored, config | {"exposure_s": normal, "bottom_exposure_s": first})
    job.settings |= {"profile": profile} if profile else {}
    _add_pngs(job, archive, names, lambda index: first if index == 0 else normal if index > fade else None)
    job.previews = archive.previews(name for name in archive.names if re.fullmatch(r"thumbnail/.*\.png", name))
    return job


def _sl1_display(profile: Settings, size: tuple[int, int]) -> tuple[tuple[float, float] | None, tuple[bool, bool] | None]:
    """Size of the display along the picture's axes, and the profile's two mirror flags as they stand there."""
    if not profile:
        return None, None
    pixels = tuple(_need(profile, f"display_pixels_{axis}", whole=True) for axis in "xy")
    display = tuple(_need(profile, f"display_{name}") for name in ("width", "height"))
    mirrored = tuple(_need(profile, f"display_mirror_{axis}") == 1 for axis in "xy")
    if profile.get("display_orientation") == "portrait":
        pixels, display = pixels[::-1], display[::-1]
    expect(pixels == size, f"the profile has {pixels[0]} x {pixels[1]} pixels, the first picture {size[0]} x {size[1]}")
    return display, mirrored


# ---------------------------------------------------------------------------------------------- reading

def read(path: str | Path, check: bool = True) -> Job:
    """Reads a job file. `check`: go through the runs of all layers now (of PNG pictures only through the headers)."""
    source, suffix = Source(Path(path).read_bytes()), Path(path).suffix.lower()
    magic = int.from_bytes(source.data[:4], "little")
    if magic == CTB_ENCRYPTED:
        raise EncryptedError("an encrypted .ctb file: not supported")
    if source.data[4:12] == GOO_MAGIC:
        job = _read_goo(source)
    elif magic in CTB_VERSIONS:
        job = _CtbReader(source).read()
    elif source.data[:8] == b"ANYCUBIC":
        job = _AnycubicReader(source, suffix).read()
    elif source.data[:2] == b"PK":
        job = _read_zip(source.data)
    else:
        raise FormatError("no known kind of resin job file")
    if check:
        _check_pictures(job)
    return job
