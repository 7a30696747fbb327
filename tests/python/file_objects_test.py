"""Files that are objects: bytes, pipes, and files that change while they are read."""

import gzip
import io
import json
import os
import threading
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import box_arrays, nested_boxes

import lamella


@pytest.mark.parametrize("name", ["part.obj", "part.ply", "part.stl", "part.stl.gz", "layers.json", "layers.cli"])
def test_a_file_that_loses_its_content_while_it_is_parsed_is_read_whole(program, tmp_path, name):
    part = tmp_path / name.removesuffix(".gz")
    if name.startswith("layers"):
        lamella.write(part, lamella.slice(box_arrays(), 0.001))
    else:
        program.succeed("make", "torus", "--segments", "60", *(["--ascii"] if part.suffix == ".stl" else []), "-o", part)
    if name.endswith(".gz"):
        (tmp_path / name).write_bytes(gzip.compress(part.read_bytes(), 0))
    path = tmp_path / name
    assert path.stat().st_size > 1 << 16  # a smaller one is read at once
    expected = lamella.read(path)
    calls = []

    def progress(*call):
        calls.append(call)
        os.truncate(path, 0)

    found = lamella.read(path, progress=progress)
    assert calls and path.stat().st_size == 0
    if isinstance(expected, lamella.Stack):
        assert found == expected
    else:
        assert np.array_equal(found.vertices, expected.vertices) and np.array_equal(found.faces, expected.faces)


def test_a_file_that_another_thread_shortens_is_read_or_is_an_error(program, tmp_path):
    part = tmp_path / "part.stl"
    program.succeed("make", "torus", "--segments", "150", "--ascii", "-o", part)
    content = part.read_bytes()
    expected = lamella.read(part)
    ended = threading.Event()

    def shorten():
        while not ended.is_set():
            os.truncate(part, len(content) // 2)
            part.write_bytes(content)

    other = threading.Thread(target=shorten)
    other.start()
    for _ in range(20):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what was read while it was written
            try:
                assert len(lamella.read(part).faces) <= len(expected.faces)
            except lamella.InputError as error:
                assert str(part) in str(error)
    ended.set()
    other.join()


@pytest.mark.parametrize("name", ["part.stl", "layers.cli"])
@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_a_pipe_is_read_from_its_first_byte(tmp_path, name):
    box = lamella.Mesh(*box_arrays(1, 2, 3))
    lamella.write(tmp_path / name, box if name == "part.stl" else lamella.slice(box, 0.5))
    os.mkfifo(tmp_path / "pipe")
    writer = threading.Thread(target=lambda: (tmp_path / "pipe").write_bytes((tmp_path / name).read_bytes()))
    writer.start()
    read = lamella.read(tmp_path / "pipe")
    writer.join()
    assert len(read) == (12 if name == "part.stl" else 6)


def contents_of(path):
    """The content of a file in all forms that are read."""
    content = path.read_bytes()
    after = io.BytesIO(b"before" + content)
    after.seek(len(b"before"))
    yield "<bytes>", content
    yield "<bytearray>", bytearray(content)
    yield "<memoryview>", memoryview(content)
    yield "<memoryview>", memoryview(np.repeat(np.frombuffer(content, dtype=np.uint8), 2))[::2]
    yield "<BytesIO>", after
    yield str(path), open(path, "rb")  # noqa: SIM115
    yield str(path), open(os.fsencode(path), "rb", buffering=0)  # noqa: SIM115
    yield "<GzipFile>", gzip.GzipFile(fileobj=io.BytesIO(gzip.compress(content)))


@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_files_are_read_from_memory(program, tmp_path, rook):
    program.succeed("make", "calibration", "-o", tmp_path / "part.stl")
    part = tmp_path / "part.stl"
    lamella.write(tmp_path / "part.json", lamella.slice(part, 1))
    lamella.write(tmp_path / "part.3mf", lamella.slice(part, 1))
    stack = lamella.read_layers(tmp_path / "part.json")
    vectors = tmp_path / "part.ovf"
    lamella.write(vectors, lamella.scan(stack))
    for number, (name, _) in enumerate(contents_of(part)):

        def content(path=part, number=number):
            return list(contents_of(path))[number][1]

        mesh = lamella.read_mesh(content())
        assert name in (mesh.path, "<GzipFile>") and len(mesh) == len(lamella.read_mesh(part))
        sliced = lamella.slice(content(), 1)
        assert sliced == stack and sliced.label == ("part" if name.startswith("<") else part.stem)
        assert list(lamella.iter_layers(content(), 1)) == list(stack)
        assert isinstance(lamella.read(content()), lamella.Mesh)
        assert lamella.inspect(content()).triangles == len(mesh)
        assert lamella.Slicer(content()).section(1.5).area == stack.at(1.5).area
        for layers in ("part.json", "part.3mf"):
            back = lamella.read_layers(content(tmp_path / layers))
            assert back.path == name.replace("part.stl", layers) and back == lamella.read(content(tmp_path / layers))
            assert lamella.verify(content(tmp_path / layers), content()).ok
            assert lamella.compare(content(tmp_path / layers), stack) and lamella.compare(stack, content(tmp_path / layers))
        lamella.convert(content(tmp_path / "part.json"), tmp_path / "back.json")
        assert (tmp_path / "back.json").read_bytes() == (tmp_path / "part.json").read_bytes()
        found = lamella.verify_vectors(content(vectors), content())
        assert found == lamella.verify_vectors(vectors, part)


def test_errors_name_objects(tmp_path):
    for content in (b"nothing", io.BytesIO(b"nothing")):
        for call in (lamella.read, lamella.read_mesh, lamella.read_layers, lamella.slice, lamella.verify):
            if hasattr(content, "seek"):
                content.seek(0)
            with pytest.raises(lamella.InputError, match=f"^<{type(content).__name__}>: "):
                call(content)
    (tmp_path / "nothing").write_text("nothing")
    with open(tmp_path / "nothing", "rb") as file:
        with pytest.raises(lamella.InputError, match="nothing: line 1: is a text"):
            lamella.read(file)
        with pytest.raises(lamella.InputError, match="nothing: holds nothing at its position; seek"):
            lamella.read(file)
    with pytest.raises(lamella.InputError, match="<bytes>: is empty"):
        lamella.read(b"")
    with pytest.raises(TypeError, match='file: expected a binary file, found one of text; open it with the mode "rb"'):
        lamella.read(open(tmp_path / "nothing"))  # noqa: SIM115


def test_what_is_odd_about_content_in_memory_names_it(rook):
    with pytest.warns(lamella.DefectWarning, match="^<bytes>: .*4 bytes"):
        lamella.read(Path(rook).read_bytes() + b"more")


class Slow(io.RawIOBase):
    """Takes few bytes at a time."""

    def __init__(self):
        self.content = b""

    def writable(self):
        return True

    def write(self, some):
        self.content += bytes(some[:1000])
        return min(len(some), 1000)


FOLDERS = ("png", "svg-layers")
FOR_PRINTERS = ("goo", "ctb", "cbddlp", "anycubic", "chitubox-zip", "nanodlp")


@pytest.mark.parametrize("name", [name for name, _, _ in lamella.layer_formats() if name not in FOLDERS + FOR_PRINTERS])
@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_layers_are_written_to_memory(tmp_path, monkeypatch, name):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    monkeypatch.setenv("TMPDIR", str(tmp_path / "missing"))  # nothing waits in a temporary file
    stack = lamella.slice(nested_boxes(), 0.5)
    lamella.write(tmp_path / "layers", stack, format=name)
    expected = (tmp_path / "layers").read_bytes()
    for threads in (1, 3):
        for layers in (stack, lamella.iter_layers(nested_boxes(), 0.5)):
            target = io.BytesIO(b"")
            lamella.write(target, layers, format=name, threads=threads)
            assert target.getvalue() == expected
    slow = Slow()
    lamella.write(slow, stack, format=name)
    assert slow.content == expected
    with open(tmp_path / "opened", "wb") as file:
        lamella.convert(io.BytesIO(json_of(stack)), file, format=name)
    if name not in ("ilt", "ovf", "3mf-toolpath"):  # these keep the label of the part
        assert (tmp_path / "opened").read_bytes() == expected


def json_of(stack):
    target = io.BytesIO()
    lamella.write(target, stack, format="json")
    return target.getvalue()


def test_the_name_of_a_file_object_selects_its_format(tmp_path):
    stack = lamella.slice(nested_boxes(), 1)
    with open(tmp_path / "out.json", "wb") as file:
        lamella.write(file, stack)
    assert (tmp_path / "out.json").read_bytes() == json_of(stack)
    with gzip.open(tmp_path / "out.json.gz", "wb") as file:
        lamella.write(file, stack)
    assert gzip.decompress((tmp_path / "out.json.gz").read_bytes()) == json_of(stack), "compressed once"
    with pytest.raises(lamella.UsageError, match="'<BytesIO>'.* format.* `format`"):
        lamella.write(io.BytesIO(), stack)


def test_nothing_is_written_to_memory_when_it_fails():
    chain = lamella.Layer([], 1, bottom=0.5, top=1, chains=[[(0, 0), (1, 0), (1, 1)]])
    target = io.BytesIO()
    with pytest.raises(lamella.DefectError, match="^<BytesIO>: "):
        lamella.write(target, chain, format="slc", strict=True)
    with pytest.raises(lamella.OutputError, match="^<BytesIO>: .*write it as .ply or .obj"):
        lamella.write(target, (box_arrays()[0] * 1e40, box_arrays()[1]), format="stl")
    assert target.getvalue() == b""
