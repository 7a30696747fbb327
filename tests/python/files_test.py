"""Files in and out: the bytes of the program, and what it finds."""

import gzip
import io
import json
import os
import pickle
import threading
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import box_arrays, joined, nested_boxes, open_box

import lamella

EXACT = ["layers.json", "layers.npz"]
ROUNDED = ["layers.cli", "layers.svg", "layers.slc", "layers.3mf"]
WRITTEN_ONLY = ["layers.dxf", "layers.geojson"]


@pytest.mark.parametrize("name", EXACT + ROUNDED + WRITTEN_ONLY)
@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_slice_files_have_the_bytes_of_the_program(program, rook, tmp_path, name):
    program.succeed("slice", rook, "-o", tmp_path / ("program_" + name), "--layer-height", 0.5)
    expected = (tmp_path / ("program_" + name)).read_bytes()
    lamella.write(tmp_path / name, lamella.slice(rook, 0.5))
    assert (tmp_path / name).read_bytes() == expected
    for threads in (1, 2, 7):
        with lamella.iter_layers(rook, 0.5) as layers:
            lamella.write(tmp_path / name, layers, threads=threads)
        assert (tmp_path / name).read_bytes() == expected
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([name, "program_" + name])


@pytest.mark.parametrize("name", EXACT + ROUNDED)
def test_slice_files_read_back(rook, tmp_path, name):
    stack = lamella.slice(rook, 0.5)
    lamella.write(tmp_path / name, stack)
    back = lamella.read(tmp_path / name)
    assert isinstance(back, lamella.Stack)
    assert Path(back.path) == tmp_path / name and back.format == name.partition(".")[2]
    comparison = lamella.compare(stack, back, tolerance=0 if name in EXACT else 0.001)
    assert comparison and comparison.layers == len(stack)
    if name in EXACT:
        assert back == stack and back.resolution == 0 and comparison.same == len(stack)
    assert np.allclose(back.area, stack.area, rtol=1e-3)
    assert lamella.compare(stack, back) and lamella.verify(back, rook).ok


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


def test_numpy_arrays_in_single_precision_are_compared_as_such(tmp_path):
    mesh = lamella.Mesh(*box_arrays(1.1, 2.2, 3.3))
    lamella.write(tmp_path / "double.npz", lamella.slice(mesh, layer_height=0.7))
    arrays = dict(np.load(tmp_path / "double.npz"))
    arrays["points"] = arrays["points"].astype(np.float32)
    np.savez(tmp_path / "single.npz", **arrays)
    assert lamella.verify(tmp_path / "single.npz", mesh).ok
    assert lamella.compare(tmp_path / "double.npz", tmp_path / "single.npz")


@pytest.mark.parametrize("name", ["layers.json", "layers.npz", "layers.svg"])
@pytest.mark.parametrize("at", ["bottom", "middle", "top"])
def test_the_rule_of_the_plane_is_kept_with_the_cuts(rook, tmp_path, name, at):
    stack = lamella.slice(rook, 0.5, at=at)
    assert stack.rule == ("section_below" if at == "top" else "section_above")
    assert lamella.verify(stack, rook).ok
    for layers in stack, lamella.iter_layers(rook, 0.5, at=at):
        lamella.write(tmp_path / name, layers)
        back = lamella.read(tmp_path / name)
        assert back.rule == stack.rule
        assert lamella.verify(pickle.loads(pickle.dumps(back)), rook).ok


@pytest.mark.parametrize("extension", ["stl", "ply", "obj"])
def test_meshes_are_written_and_read(tmp_path, extension):
    path = tmp_path / f"mesh.{extension}"
    lamella.write(path, lamella.Mesh(*nested_boxes()))
    back = lamella.read(path)
    assert isinstance(back, lamella.Mesh)
    assert (len(back), back.vertices.shape) == (36, (24, 3))
    assert np.isclose(back.volume, 1000 - 512 + 64)
    assert lamella.slice(path, 1) == lamella.slice(nested_boxes(), 1)


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


@pytest.mark.parametrize("name", [name for name, _, _ in lamella.layer_formats() if name not in FOLDERS])
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


class Trimesh:
    vertices, faces = box_arrays()


class Open3d:
    vertices, triangles = box_arrays()


class Polydata:
    points = box_arrays()[0]
    regular_faces = box_arrays()[1]


class OldPolydata:
    points = box_arrays()[0]
    faces = np.insert(box_arrays()[1], 0, 3, axis=1).ravel()

    @property
    def regular_faces(self):
        raise ValueError("faces are not of one size")


@pytest.mark.parametrize("name", ["stl", "ply", "obj"])
def test_meshes_of_any_kind_are_written(tmp_path, name):
    mesh = lamella.Mesh(*box_arrays())
    lamella.write(tmp_path / f"part.{name}", mesh)
    expected = (tmp_path / f"part.{name}").read_bytes()
    for content in (mesh, box_arrays(), list(box_arrays()), Trimesh(), Open3d(), Polydata(), OldPolydata()):
        target = io.BytesIO()
        lamella.write(target, content, format=name)
        assert target.getvalue() == expected
        lamella.write(tmp_path / "out", content, format=name)
        assert (tmp_path / "out").read_bytes() == expected
        assert lamella.slice(content, 1) == lamella.slice(mesh, 1)
    triangles = io.BytesIO()
    lamella.write(triangles, box_arrays()[0][box_arrays()[1]], format=name)
    assert lamella.slice(triangles.getvalue(), 1) == lamella.slice(mesh, 1)


def test_polygons_of_more_corners_are_refused():
    class Quads(OldPolydata):
        faces = np.array([4, 0, 2, 3, 1, 3, 0, 1, 5])

    with pytest.raises(lamella.UsageError, match="part: faces: expected 3 before .* must be cut into triangles first"):
        lamella.slice(Quads())


def test_parts_stay_apart_in_files(tmp_path):
    z = np.arange(0.5, 10)
    stacks = [lamella.slice(box_arrays(size, 5, 10, at=(20.0 * size, 0, 0)), z=z) for size in (1, 2)]
    named = [lamella.Stack(list(stack), label=label) for stack, label in zip(stacks, ["left", "right"])]
    path = tmp_path / "two.cli"
    lamella.write(path, named)
    back = lamella.read(path)
    assert [part.label for part in back.parts] == ["left", "right"]
    assert [part.area.tolist() for part in back.parts] == [[5.0] * 10, [10.0] * 10]
    assert back.area.tolist() == [15.0] * 10
    again = tmp_path / "again.cli"
    lamella.write(again, back)
    assert [part.label for part in lamella.read(again).parts] == ["left", "right"]
    with pytest.raises(lamella.UsageError, match="the same planes"):
        lamella.write(path, [named[0], named[1][:5]])


@pytest.mark.parametrize("change", [{"bottom": 0.25}, {"top": 0.75}, {"index": 7}])
def test_parts_of_other_layers_are_refused(tmp_path, change):
    square = [(0, 0), (1, 0), (1, 1)]
    heads = {"z": 0.5, "bottom": 0, "top": 1, "index": 0}
    one, other = (lamella.Stack([lamella.Layer([square], **header)]) for header in (heads, {**heads, **change}))
    (name,) = change
    with pytest.raises(lamella.UsageError, match={"bottom": "bottoms", "top": "tops", "index": "indices"}[name]):
        lamella.write(tmp_path / "two.cli", [one, other])
    assert list(tmp_path.iterdir()) == []


def test_stacks_with_parts_keep_them(tmp_path):
    stacks = [lamella.Stack(list(lamella.slice(box_arrays(at=(x, 0, 0)), 1)), label=f"at {x}") for x in (0, 50)]
    lamella.write(tmp_path / "two.json", stacks)
    both = lamella.read(tmp_path / "two.json")
    some = both[2:8:2]
    assert [part.label for part in some.parts] == ["at 0", "at 50"]
    assert [part[0] for part in some.parts] == [stack[2] for stack in stacks]
    assert [len(part) for part in pickle.loads(pickle.dumps(some)).parts] == [3, 3]
    lamella.write(tmp_path / "twice.json", [both, both])
    assert [part.label for part in lamella.read(tmp_path / "twice.json").parts] == ["at 0", "at 50"] * 2


@pytest.fixture
def jobs(program, rook, tmp_path):
    """A folder with layers and scan vectors of the program."""
    program.succeed("slice", rook, "-o", tmp_path / "part.cli", "--layer-height", 2)
    for name in ("program.ilt", "program.ovf"):
        program.succeed("scan", tmp_path / "part.cli", "-o", tmp_path / name)
    return tmp_path


def test_scan_vectors_keep_their_parameters(program, jobs):
    stack = lamella.read(jobs / "program.ilt")
    assert stack.exposure is None and lamella.read(jobs / "part.cli").exposure is None
    for part in [*stack.parts, *stack[1:3].parts, *pickle.loads(pickle.dumps(stack)).parts]:
        exposure = part.exposure
        assert part.label == f"{exposure.part} {exposure.name}" and exposure.parameters.speed_mm_s > 0
    program.succeed("convert", jobs / "program.ilt", jobs / "expected.ovf")
    lamella.convert(jobs / "program.ilt", jobs / "converted.ovf")
    lamella.write(jobs / "written.ovf", stack)
    for name in ("converted.ovf", "written.ovf"):
        assert (jobs / name).read_bytes() == (jobs / "expected.ovf").read_bytes()
    with pytest.raises(lamella.UsageError, match="holds scan vectors"):
        lamella.verify(stack[1:3])
    text = program.error("scan", jobs / "program.ilt", "-o", jobs / "out.ilt").replace("program.ilt", "converted.ovf")
    for vectors in [lamella.read(jobs / "converted.ovf"), lamella.read(jobs / "converted.ovf")[1:3]]:
        with pytest.raises(lamella.InputError) as caught:
            lamella.scan(vectors)
        assert str(caught.value) == text


def test_scan_vectors_are_written_as_by_the_program(program, rook, jobs):
    layers = lamella.read(jobs / "part.cli")
    for name in ("ilt", "ovf"):
        lamella.write(jobs / f"job.{name}", lamella.scan(layers, part=layers.label))
        assert (jobs / f"job.{name}").read_bytes() == (jobs / f"program.{name}").read_bytes()
    program.succeed("slice", rook, "-o", jobs / "sliced.ilt", "--layer-height", 2, "--scan")
    scanned = lamella.scan(lamella.iter_layers(rook, 2), part=layers.label)
    lamella.write(jobs / "streamed.ilt", scanned)
    assert (jobs / "streamed.ilt").read_bytes() == (jobs / "sliced.ilt").read_bytes()
    with pytest.raises(lamella.UsageError, match="no layers to write"):
        lamella.write(jobs / "nothing.ilt", scanned)
    # What could not be written is there still.
    scanned = lamella.scan(lamella.iter_layers(rook, 2), part=layers.label)
    with pytest.raises(lamella.UsageError):
        lamella.write(jobs / "job.unknown", scanned)
    lamella.write(jobs / "again.ilt", scanned)
    assert (jobs / "again.ilt").read_bytes() == (jobs / "sliced.ilt").read_bytes()


def test_the_rule_of_the_plane_goes_with_layers(tmp_path):
    stack = lamella.slice(nested_boxes(), 1, at="top")
    assert lamella.Stack(list(stack)).rule == "section_below"
    by_hand = lamella.Layer(list(stack[0]), 0.5, 0, 0.5)
    for what in [list(stack), (layer.offset(0.1) for layer in stack), [layer.union(by_hand) for layer in stack],
                 [by_hand, *stack[1:]], pickle.loads(pickle.dumps(list(stack))), stack[3], iter(lamella.iter_layers(nested_boxes(), 1, at="top")),
                 list(lamella.scan(stack))]:  # fmt: skip
        lamella.write(tmp_path / "out.json", what)
        assert lamella.read(tmp_path / "out.json").rule == "section_below"
    assert lamella.Stack([by_hand]).rule == "section_above"
    with pytest.raises(lamella.UsageError, match="cut by the same rule"):
        lamella.Stack([lamella.slice(nested_boxes(), 1)[0], stack[1]])


def test_slices_of_stacks_have_the_bounds_of_what_there_is(bodies, tmp_path):
    cone = lamella.slice(bodies("sphere", "--size", 20), 1)
    assert (cone[:5].bounds == cone.bounds).all(), "those of the mesh"
    lamella.write(tmp_path / "cone.json", cone)
    for stack in [lamella.read(tmp_path / "cone.json"), lamella.Stack(list(cone))]:
        for few in [stack[:5], stack[:9][:5], pickle.loads(pickle.dumps(stack[:9]))[:5]]:
            assert (few.bounds == lamella.Stack(list(few)).bounds).all() and (few.bounds[1] < stack.bounds[1]).all()
    lamella.write(tmp_path / "twice.json", [cone, cone])
    few = lamella.read(tmp_path / "twice.json")[:5]
    assert all((part.bounds == few.bounds).all() for part in few.parts)
    assert lamella.Stack([]).bounds.tolist() == [[0, 0, 0], [0, 0, 0]]


def test_layers_without_thickness_are_refused_where_files_need_one(tmp_path):
    square = [(0, 0), (9, 0), (9, 9), (0, 9)]
    flat = lamella.Stack([lamella.Layer([square], z=z) for z in (1, 2)])
    for name in ("a.cli", "a.svg", "a.slc", "a.3mf", "a.sl1"):
        with pytest.raises(lamella.UsageError, match="the layer at z = 1 mm has no thickness.* bottom= and top="):
            lamella.write(tmp_path / name, flat)
    with pytest.raises(lamella.UsageError, match="no thickness.* bottom= and top="):
        lamella.write(tmp_path / "a.ovf", lamella.scan(flat))
    assert list(tmp_path.iterdir()) == []
    for name in ("a.json", "a.npz"):
        lamella.write(tmp_path / name, flat)
        assert lamella.read_layers(tmp_path / name) == flat
    lamella.write(tmp_path / "a.geojson", flat)


def test_the_kind_of_a_file_can_be_asked_for(tmp_path, rook):
    stack = lamella.slice(rook, 5)
    lamella.write(tmp_path / "a.cli", stack)
    assert isinstance(lamella.read_mesh(rook), lamella.Mesh)
    assert len(lamella.read_layers(tmp_path / "a.cli")) == len(stack)
    with pytest.raises(lamella.InputError, match="a.cli: is a slice file .*: it holds layers already"):
        lamella.read_mesh(tmp_path / "a.cli")
    with pytest.raises(lamella.InputError, match="stl: found a mesh"):
        lamella.read_layers(rook)


def test_scan_layers_of_any_kind_are_written(jobs):
    scanned = list(lamella.scan(lamella.read(jobs / "part.cli")))

    def known(exposures):  # of what these files keep
        return [(e.part, e.name, e.parameters.power_w, e.parameters.speed_mm_s) for e in exposures]

    for what in (scanned, iter(scanned), scanned[0]):
        lamella.write(jobs / "out.ilt", what)
        parts = lamella.read(jobs / "out.ilt").parts
        assert known(part.exposure for part in parts) == known(scanned[0].exposures)
        assert len(parts[0]) == (1 if what is scanned[0] else len(scanned))
    (other,) = lamella.scan([lamella.Layer([], 1e3)], part="other")
    with pytest.raises(lamella.UsageError, match="the same exposures"):
        lamella.write(jobs / "mixed.ilt", [*scanned, other])
    assert not (jobs / "mixed.ilt").exists()


def test_a_part_without_contours_leaves_the_box_of_a_file_alone(tmp_path):
    full = lamella.slice(box_arrays(at=(50, 60, 0)), 5)
    empty = lamella.Stack([lamella.Layer([], layer.z, layer.bottom, layer.top, layer.index) for layer in full])
    lamella.write(tmp_path / "out.geojson", [empty, full])
    assert json.loads((tmp_path / "out.geojson").read_text())["bbox"] == [50, 60, 70, 90]
    assert empty.bounds.tolist() == [[0, 0, 0], [0, 0, 10]]
    lamella.write(tmp_path / "out.cli", [empty, empty])
    assert b"$$DIMENSION/0.000000,0.000000,0.000000,0.000000,0.000000,10.000000" in (tmp_path / "out.cli").read_bytes()


def test_conversion_is_that_of_the_program(program, rook, tmp_path):
    lamella.write(tmp_path / "rook.cli", lamella.slice(rook, 0.5))
    program.succeed("convert", tmp_path / "rook.cli", tmp_path / "program.svg")
    lamella.convert(tmp_path / "rook.cli", tmp_path / "rook.svg")
    assert (tmp_path / "rook.svg").read_bytes() == (tmp_path / "program.svg").read_bytes()
    program.succeed("convert", tmp_path / "rook.svg", tmp_path / "program.cli", "--units-mm", 0.01)
    lamella.convert(tmp_path / "rook.svg", tmp_path / "rook.cli", units_mm=0.01)
    assert (tmp_path / "rook.cli").read_bytes() == (tmp_path / "program.cli").read_bytes()
    for format in ("3mf", "3mf-toolpath"):
        for made, folder in [("convert", "a"), ("scan", "b")]:
            (tmp_path / folder).mkdir(exist_ok=True)
            output = ["-o"] if made == "scan" else []
            program.succeed(made, tmp_path / "rook.cli", *output, tmp_path / folder / "rook.3mf", "--format", format)
        lamella.convert(tmp_path / "rook.cli", tmp_path / "rook.3mf", format=format)
        assert (tmp_path / "rook.3mf").read_bytes() == (tmp_path / "a/rook.3mf").read_bytes()
        layers = lamella.read(tmp_path / "rook.cli")
        lamella.write(tmp_path / "rook.3mf", lamella.scan(layers, part=layers.label), format=format)
        assert (tmp_path / "rook.3mf").read_bytes() == (tmp_path / "b/rook.3mf").read_bytes()
    with pytest.raises(lamella.UsageError, match="would overwrite the input"):
        lamella.convert(tmp_path / "rook.cli", tmp_path / "rook.cli")


def test_images_are_those_of_the_program(program, rook, tmp_path):
    program.succeed("slice", rook, "-o", tmp_path / "program.zip", "--format", "png-zip", "--layer-height", 5,
                    "--pixel-size", "0.2")
    lamella.write(tmp_path / "rook.zip", lamella.slice(rook, 5), format="png-zip", pixel_mm=0.2)
    assert (tmp_path / "rook.zip").read_bytes() == (tmp_path / "program.zip").read_bytes()


IMAGES = [
    ("png-zip", {"pixels": (90, 80), "display_mm": (45, 40)}, ["--resolution", "90x80", "--display-size", "45,40"]),
    ("png-zip", {"pixel_mm": (0.2, 0.3), "antialias": 1}, ["--pixel-size", "0.2,0.3", "--antialias", 1]),
    ("png-zip", {"pixel_mm": 0.5, "orientation": "portrait", "mirror": "xy", "gamma": 2.5},
     ["--pixel-size", 0.5, "--orientation", "portrait", "--mirror", "xy", "--gamma", 2.5]),
    ("png-zip", {"pixel_mm": 0.5, "mirror": "y"}, ["--pixel-size", 0.5, "--mirror", "y"]),
    ("sl1", {"mirror": "none", "orientation": "landscape"}, ["--mirror", "none", "--orientation", "landscape"]),
    ("sl1s", {"exposure_s": 3, "first_exposure_s": 20.5, "fade_layers": 4},
     ["--exposure", 3, "--first-exposure", 20.5, "--fade-layers", 4]),
]  # fmt: skip


@pytest.mark.parametrize("name, keywords, options", IMAGES)
def test_options_of_images_are_those_of_the_program(program, rook, tmp_path, name, keywords, options):
    (tmp_path / "program").mkdir()
    target = tmp_path / "program" / "rook.out"
    program.succeed("slice", rook, "-o", target, "--format", name, "--layer-height", 10, *options)
    lamella.write(tmp_path / "rook.out", lamella.slice(rook, 10), format=name, **keywords)
    assert (tmp_path / "rook.out").read_bytes() == target.read_bytes()
    lamella.write(tmp_path / "rook.json", lamella.slice(rook, 10))
    lamella.convert(tmp_path / "rook.json", tmp_path / "converted.out", format=name, **keywords)
    assert (tmp_path / "converted.out").stat().st_size > 0


def test_the_time_that_builds_agree_upon_is_that_of_a_job(program, rook, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    program.succeed("slice", rook, "-o", tmp_path / "rook.sl1", "--layer-height", 10)
    expected = (tmp_path / "rook.sl1").read_bytes()
    lamella.write(tmp_path / "rook.sl1", lamella.slice(rook, 10))
    assert (tmp_path / "rook.sl1").read_bytes() == expected
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "soon")
    with pytest.raises(lamella.UsageError, match='SOURCE_DATE_EPOCH is "soon"'):
        lamella.write(tmp_path / "rook.sl1", lamella.slice(rook, 10))
    lamella.write(tmp_path / "rook.cli", lamella.slice(rook, 10))


def test_layers_are_written_from_whatever_has_them(tmp_path):
    stack = lamella.slice(box_arrays(), 1)

    def written(what):
        lamella.write(tmp_path / "out.json", what)
        return lamella.read(tmp_path / "out.json")

    assert written(stack[3]) == stack[3:4]
    assert written(list(stack)) == written(tuple(stack)) == written(layer for layer in stack) == stack
    assert written(layer for layer in lamella.iter_layers(box_arrays(), 1)) == stack
    shifted = written(layer.offset(1) for layer in stack)
    assert shifted.area.tolist() == [layer.offset(1).area for layer in stack]
    with pytest.raises(lamella.UsageError, match="ascend"):
        lamella.write(tmp_path / "out.json", [stack[1], stack[0]])


def test_what_a_format_has_no_place_for_is_an_error_where_it_is_asked_to_be(tmp_path):
    chain = lamella.Layer([], 1, bottom=0.5, top=1, chains=[[(0, 0), (1, 0), (1, 1)]])
    with pytest.warns(lamella.DefectWarning):
        lamella.write(tmp_path / "out.slc", chain)
    for write in (lambda **options: lamella.write(tmp_path / "strict.slc", chain, **options),
                  lambda **options: lamella.convert(tmp_path / "chain.json", tmp_path / "strict.slc", **options)):
        lamella.write(tmp_path / "chain.json", chain)
        with pytest.raises(lamella.DefectError):
            write(strict=True)
        assert not (tmp_path / "strict.slc").exists()


def test_what_is_odd_about_a_slice_file_is_an_error_where_it_is_asked_to_be(tmp_path):
    layers = '{"z":1,"bottom":0,"top":2,"parts":[{"rings":[[0,0,4,0,0,4],[1,1,2,2]]}]}'
    (tmp_path / "odd.json").write_text('{"format":"lamella layers","version":1,"parts":[{"label":"a"}],"layers":[' + layers + "]}")
    with pytest.warns(lamella.DefectWarning) as caught:
        lamella.convert(tmp_path / "odd.json", tmp_path / "out.cli")
    for ask in [lambda: lamella.read(tmp_path / "odd.json", strict=True),
                lambda: lamella.convert(tmp_path / "odd.json", tmp_path / "strict.cli", strict=True)]:  # fmt: skip
        with pytest.raises(lamella.DefectError) as error:
            ask()
        assert str(error.value) == str(caught[0].message)
    assert not (tmp_path / "strict.cli").exists()


def test_what_is_left_of_a_stream_is_written(tmp_path):
    stack = lamella.slice(box_arrays(), 1)
    layers = lamella.iter_layers(box_arrays(), 1)
    assert [next(layers), next(layers)] == list(stack[:2])
    lamella.write(tmp_path / "rest.json", layers)
    assert lamella.read(tmp_path / "rest.json") == stack[2:]
    with pytest.raises(lamella.UsageError, match="closed or at its end"):
        lamella.write(tmp_path / "nothing.json", layers)


def test_a_stream_that_is_closed_while_it_is_written_leaves_no_file(tmp_path, rook):
    layers = lamella.iter_layers(rook, 0.1)
    with pytest.raises(lamella.CancelledError, match="closed while it was written"):
        lamella.write(tmp_path / "out.cli", layers, progress=lambda *_: layers.close())
    assert list(tmp_path.iterdir()) == []


def test_inspection_is_that_of_the_program(program, rook):
    expected = json.loads(program.succeed("info", rook, "--json"))
    found = lamella.inspect(rook)
    for name in ("path", "format", "triangles", "vertices", "closed", "shells"):
        assert getattr(found, name) == expected[name], name
    assert found.volume == expected["volume_mm3"] and found.area == expected["area_mm2"]
    assert found.bounds.tolist() == expected["bbox"]
    for name, count in expected["defects"].items():
        if hasattr(found, name):
            assert getattr(found, name) == count, name
    assert found.sound and found.defects == ""


def test_defects_are_reported_in_words():
    vertices, faces = open_box()
    found = lamella.inspect((vertices, np.concatenate([faces, faces[:1], [(0, 0, 1)]])))
    assert not found.closed and not found.sound
    assert found.defects == (
        "4 boundary edges, 3 non-manifold edges, 3 orientation conflicts, 1 duplicate triangle, "
        "1 degenerate triangle"
    )
    assert lamella.inspect(box_arrays(inward=True)).inverted_shells == 1


def test_verification_finds_what_is_wrong(program, rook, tmp_path):
    stack = lamella.slice(rook, 0.5)
    found = lamella.verify(stack, rook)
    assert found.ok and found.layers == len(stack) and found.max_area_error < 1e-9
    lamella.write(tmp_path / "rook.cli", stack)
    expected = json.loads(program.succeed("verify", tmp_path / "rook.cli", "--mesh", rook, "--json"))
    found = lamella.verify(tmp_path / "rook.cli", rook)
    assert (found.ok, found.contours, found.crossings) == (True, expected["contours"], 0)
    assert found.max_area_error == expected["max_area_error_mm2"]

    moved = lamella.Stack([lamella.Layer([ring + (i % 2) for ring in layer], layer.z, layer.bottom, layer.top)
                           for i, layer in enumerate(lamella.slice(box_arrays(), 1))])
    found = lamella.verify(moved, box_arrays())
    assert (found.ok, found.areas_agree, found.displaced) == (False, True, len(moved) // 2)
    grown = lamella.Stack([lamella.Layer([ring * 1.01 for ring in layer], layer.z, layer.bottom, layer.top)
                           for layer in moved])
    found = lamella.verify(grown, box_arrays())
    assert not found.ok and not found.areas_agree and found.findings
    back = lamella.read(tmp_path / "rook.cli")
    formerly_rounded = lamella.Stack(list(back))
    assert not lamella.verify(formerly_rounded, rook).ok and lamella.verify(formerly_rounded, rook, tolerance=5e-4).ok
    bow_tie = lamella.Stack([lamella.Layer([[(0, 0), (1, 1), (1, 0), (0, 1)]], z=0)])
    assert lamella.verify(bow_tie).crossings == 1


def test_comparison_reports_where_layers_differ():
    stack = lamella.slice(box_arrays(), 1)
    assert lamella.compare(stack, stack).same == len(stack)
    moved = lamella.Stack([
        layer if i != 4 else lamella.Layer([layer[0] + (0.25, 0)], layer.z, layer.bottom, layer.top, layer.index)
        for i, layer in enumerate(stack)
    ])
    found = lamella.compare(stack, moved)
    assert not found and len(found.differences) == 1 and found.same == len(stack) - 1
    difference = found.differences[0]
    assert (difference.z, difference.distance) == (4.5, 0.25)
    assert difference.first == stack[4] and difference.second == moved[4]
    assert lamella.compare(stack, moved, tolerance=0.3)
    shorter = lamella.compare(stack, stack[:6])
    assert [difference.z for difference in shorter.differences] == [6.5, 7.5, 8.5, 9.5]
    assert all(difference.second is None for difference in shorter.differences)


def test_comparison_warns_of_other_cuts_between_the_same_heights():
    middle, bottom = (lamella.slice(box_arrays(), 1, at=at) for at in ("middle", "bottom"))
    with pytest.warns(lamella.DefectWarning, match=r"z = 0 to 1 mm at 0\.5 mm in the first and at 0 mm in the second"):
        assert not lamella.compare(middle, bottom)


def test_odd_files_are_warned_of(rook, tmp_path):
    path = tmp_path / "long.stl"
    path.write_bytes(Path(rook).read_bytes() + b"more")
    with pytest.warns(lamella.DefectWarning) as caught:
        mesh = lamella.read(path)
    assert len(mesh.warnings) == 1 and "4 bytes" in mesh.warnings[0]
    assert [str(warning.message) for warning in caught] == [f"{path}: {mesh.warnings[0]}"]
    assert caught[0].filename == __file__
    with pytest.raises(lamella.DefectError, match="long.stl"):
        lamella.read(path, strict=True)


def test_odd_slice_files_are_errors_where_they_are_asked_to_be(tmp_path):
    path = tmp_path / "falling.cli"
    layers = "".join(f"$$LAYER/{z}\n$$POLYLINE/1,1,4,0,0,1,0,1,1,0,0\n" for z in (2, 1))
    path.write_text(f"$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n{layers}$$GEOMETRYEND\n")
    with pytest.warns(lamella.DefectWarning, match="falling.cli: layers do not ascend"):
        assert len(lamella.read(path)) == 2
    with pytest.raises(lamella.DefectError, match="falling.cli: layers do not ascend"):
        lamella.read(path, strict=True)


def test_stl_files_report_what_single_precision_takes(tmp_path):
    lamella.write(tmp_path / "exact.stl", lamella.Mesh(*box_arrays()), strict=True)
    vertices, faces = box_arrays(at=(1e6, 0, 0))
    thin = lamella.Mesh(np.where(vertices == 1e6 + 20, 1e6 + 0.01, vertices), faces)
    with pytest.warns(lamella.DefectWarning, match="thin.stl: 8 triangles lose their area"):
        lamella.write(tmp_path / "thin.stl", thin)
    with pytest.raises(lamella.DefectError, match="8 triangles"):
        lamella.write(tmp_path / "strict.stl", thin, strict=True)
    with pytest.raises(lamella.OutputError, match="huge.stl: .* write it as .ply or .obj"):
        lamella.write(tmp_path / "huge.stl", lamella.Mesh(vertices * 1e33, faces))
    lamella.write(tmp_path / "huge.ply", lamella.Mesh(vertices * 1e33, faces))
    assert {path.name for path in tmp_path.iterdir()} == {"exact.stl", "thin.stl", "huge.ply"}


def test_supports_are_read_where_they_are_asked_for(tmp_path):
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    vertices = "".join("<vertex><coordinates><x>%d</x><y>%d</y><z>%d</z></coordinates></vertex>" % p for p in points)
    volume = ">" + "".join(
        "<triangle><v1>%d</v1><v2>%d</v2><v3>%d</v3></triangle>" % t
        for t in [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    path = tmp_path / "part.amf"
    path.write_text(
        f"<amf><object id='0'><mesh><vertices>{vertices}</vertices><volume{volume}</volume>"
        f"<volume type='support'{volume}</volume></mesh></object></amf>"
    )
    with pytest.warns(lamella.DefectWarning, match="1 body was left out as no material: 1 support"):
        assert len(lamella.read(path)) == 4
    assert len(lamella.read(path, include="support")) == 8
    assert len(lamella.read(path, include=["modifier", "support"])) == 8
    with pytest.raises(lamella.UsageError, match="expected one of support, negative"):
        lamella.read(path, include="thing")
    with pytest.raises(TypeError, match="include: expected a word or several"):
        lamella.read(path, include=3)


def test_negative_volumes_are_subtracted_however_a_mesh_is_sliced(tmp_path):
    def tetrahedra(size, at):
        corners = [(0, 0, 0), (size, 0, 0), (0, size, 0), (0, 0, size)]
        return "".join(
            f"<vertex><coordinates><x>{x + at}</x><y>{y + at}</y><z>{z}</z></coordinates></vertex>" for x, y, z in corners
        )

    def volume(first, mark):
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        return f"<volume><metadata type='slic3r.volume_type'>{mark}</metadata>" + "".join(
            f"<triangle><v1>{a + first}</v1><v2>{b + first}</v2><v3>{c + first}</v3></triangle>" for a, b, c in faces
        ) + "</volume>"

    path = tmp_path / "part.amf"
    path.write_text(
        f"<amf><object id='0'><mesh><vertices>{tetrahedra(10, 0)}{tetrahedra(4, 1)}</vertices>"
        f"{volume(0, 'ModelPart')}{volume(4, 'NegativeVolume')}</mesh></object></amf>"
    )
    mesh = lamella.read(path)
    stack = lamella.slice(mesh, 1)
    assert len(mesh) == 4
    area = stack[0].area
    assert area == pytest.approx(9.5**2 / 2 - 3.5**2 / 2)
    assert [layer.area for layer in lamella.iter_layers(mesh, 1)] == [layer.area for layer in stack]
    moved = [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert lamella.slice(mesh, 1, transform=moved)[0].area == pytest.approx(area)
    with pytest.warns(lamella.DefectWarning, match="its negative volumes are not subtracted"):
        lamella.write(tmp_path / "part.obj", mesh)
    assert lamella.verify(stack, mesh).ok
    solid = lamella.read(path, include=["negative"])
    assert not lamella.verify(stack, solid).ok
    with pytest.raises(lamella.UsageError, match="cannot be pickled"):
        pickle.dumps(mesh)


def test_names_that_are_no_text_work(rook, tmp_path):
    name = f"{tmp_path}/odd \udcff name"
    os.link(rook, name + ".stl")
    stack = lamella.slice(Path(name + ".stl"), 5)
    assert lamella.slice(name + ".stl", 5) == stack
    lamella.write(name + ".json", stack)
    assert lamella.read(name + ".json").path == name + ".json"


def test_nothing_is_left_of_a_file_that_fails(tmp_path, rook):
    class Stop(Exception):
        pass

    def progress(stage, done, total):
        raise Stop

    for name, format in (("out.cli", ""), ("pictures", "png")):
        with pytest.raises(Stop) as caught:
            lamella.write(tmp_path / name, lamella.slice(rook, 5), format=format, progress=progress)
        assert list(tmp_path.iterdir()) == [], f"while {caught.value!r} is kept, with all that led to it"


def test_mesh_formats_are_those_that_the_program_takes(program):
    told = program.succeed("slice", "--help").decode()
    assert lamella.mesh_formats() and all(f".{name}" in told for name in lamella.mesh_formats())


def test_formats_are_those_of_the_program(program):
    names = [name for name, _, _ in lamella.layer_formats()]
    assert {"cli", "svg", "3mf", "npz", "png", "html"} <= set(names)
    text = program.succeed("help", "slice").decode()
    assert all(name in text for name in names)


@pytest.mark.parametrize("rule", ["nonzero", "evenodd", "positive"])
def test_conversion_fills_as_the_program_does(program, tmp_path, rule):
    lamella.write(tmp_path / "nested.json", [lamella.slice(nested_boxes(), 1), lamella.slice(box_arrays(), z=np.arange(0.5, 10))])
    options = ["--fill", rule]
    program.succeed("convert", tmp_path / "nested.json", tmp_path / "program.3mf", *options)
    lamella.convert(tmp_path / "nested.json", tmp_path / "python.3mf", fill=rule)
    assert (tmp_path / "python.3mf").read_bytes() == (tmp_path / "program.3mf").read_bytes()
    with pytest.raises(lamella.UsageError, match='^fill: "odd" is none of'):
        lamella.convert(tmp_path / "nested.json", tmp_path / "x.3mf", fill="odd")


def test_filling_says_what_it_leaves_out(tmp_path, jobs):
    lamella.write(tmp_path / "inward.json", lamella.Stack([lamella.Layer([[(0, 0), (0, 4), (4, 4), (4, 0)]], 1, 0, 2)]))
    with pytest.warns(lamella.DefectWarning, match="no contour is left in any of 1 layer: fill removed"):
        lamella.convert(tmp_path / "inward.json", tmp_path / "x.json", fill="positive")
    with pytest.raises(lamella.UsageError, match="holds scan vectors .*, and fill is for contours: fill before scan$"):
        lamella.convert(jobs / "program.ilt", tmp_path / "x.ovf", fill="nonzero")


def test_filled_layers_agree_with_the_filled_sections_of_the_mesh():
    mesh = joined(box_arrays(4, 4, 4), box_arrays(4, 4, 4, at=(2, 2, 0)))
    stack = lamella.slice(mesh, 1, fill="nonzero")
    assert stack.repairs["fill"] == {
        "layers": 4, "groups_united": 4, "rings_united": 8, "rings_reversed": 0, "rings_dropped": 0,
        "area_before_mm2": 128, "area_after_mm2": 112,
    }  # fmt: skip
    assert not lamella.verify(stack, mesh).areas_agree
    assert lamella.verify(stack, mesh, fill="nonzero").ok
    with pytest.raises(lamella.UsageError, match="^fill goes with a mesh, and none is given$"):
        lamella.verify(stack, fill="nonzero")


@pytest.mark.parametrize("name", ["part.svg", "part.cli", "part.json"])
def test_slice_files_may_be_compressed(rook, tmp_path, name):
    stack = lamella.slice(rook, 2)
    lamella.write(tmp_path / name, stack)
    for threads in (1, 7):
        lamella.write(tmp_path / (name + ".gz"), stack, threads=threads)
        assert gzip.decompress((tmp_path / (name + ".gz")).read_bytes()) == (tmp_path / name).read_bytes()
    assert lamella.read(tmp_path / (name + ".gz")) == lamella.read(tmp_path / name)
    with pytest.raises(lamella.UsageError, match="npz is not written compressed with gzip"):
        lamella.write(tmp_path / "part.npz.gz", stack)
