"""Failures are exceptions of the package, with the texts of the program."""

import errno
import gzip
import os
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import box_arrays

import lamella

KINDS = ["InternalError", "UsageError", "InputError", "DefectError", "LimitError", "OutputError", "CancelledError"]


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_is_a_class_of_its_own(name):
    kind = getattr(lamella, name)
    assert issubclass(kind, lamella.Error) and kind is not lamella.Error
    assert kind.__module__ == "lamella" and kind.__doc__
    error = pickle.loads(pickle.dumps(kind("a text")))
    assert type(error) is kind and str(error) == "a text"


@pytest.mark.parametrize("path, also", [("missing.stl", FileNotFoundError), (".", IsADirectoryError)])
def test_errors_of_the_system_are_those_of_python_too(path, also, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for call in (lamella.slice, lamella.read, lambda path: lamella.scan([], path)):
        with pytest.raises(also) as caught:
            call(path)
        for error in (caught.value, pickle.loads(pickle.dumps(caught.value))):
            assert isinstance(error, lamella.InputError) and isinstance(error, also) and type(error).__name__ == "InputError"
            assert str(error) == str(caught.value) and str(error).startswith(f"{path}: ")
            assert os.strerror(error.errno) == error.strerror
    with pytest.raises(lamella.OutputError) as caught:
        lamella.write("missing/out.cli", lamella.slice(box_arrays(), 1))
    assert isinstance(caught.value, FileNotFoundError) and caught.value.errno == errno.ENOENT


def test_a_missing_file_is_described_in_one_sentence(tmp_path):
    for call in (lamella.slice, lamella.compare, lambda path, *_: lamella.scan([], path)):
        with pytest.raises(lamella.InputError) as caught:
            call(tmp_path / "missing", *([tmp_path] if call is lamella.compare else []))
        assert str(caught.value) == f"{tmp_path / 'missing'}: there is no such file"


def test_other_errors_are_none_of_the_system(tmp_path):
    (tmp_path / "part.stl").write_text("nothing")
    with pytest.raises(lamella.InputError) as caught:
        lamella.read(tmp_path / "part.stl")
    assert not isinstance(caught.value, OSError)


FLAT = """solid flat
facet normal 0 0 1
outer loop
vertex 0 0 1
vertex 1 0 1
vertex 0 1 1
endloop
endfacet
endsolid flat
"""


@pytest.mark.parametrize(
    "name, content",
    [
        ("missing.stl", None),
        ("empty.stl", b""),
        ("zeros.stl", bytes(150)),
        ("broken.stl", FLAT.replace("vertex 0 1 1", "vertex 0 one 1").encode()),
        ("cut.stl", b"solid cut\nfacet normal 0 0 1\nouter loop\nvertex 0 0"),
        ("flat.stl", FLAT.encode()),
        ("broken.ply", b"ply\nformat ascii 1.0\nelement vertex three\nend_header\n"),
        ("broken.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 9\n"),
        ("broken.off", b"OFF\n3 1\n"),
        ("text.stl", "nothing of the kind\n".encode()),
        ("odd \udcff name.stl", None),
    ],
    ids=lambda value: value if isinstance(value, str) and value.isascii() else "",
)
@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_bad_meshes_end_in_the_text_of_the_program(program, tmp_path, monkeypatch, name, content):
    monkeypatch.chdir(tmp_path)
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(lamella.InputError) as caught:
        lamella.slice(name)
    text = program(*["slice", name, "-o", "out.cli"]).stderr.decode("utf-8")
    assert str(caught.value) == text.splitlines()[-1].removeprefix("lamella: error: ")
    assert "\udcff" not in name or str(caught.value).startswith("odd \\xff name.stl: ")


def test_a_unit_for_a_file_that_says_its_own_is_reported_with_the_file(program, tmp_path):
    path = tmp_path / "a.amf"
    path.write_text(
        '<amf unit="millimeter"><object id="0"><mesh><vertices>'
        + "".join(f"<vertex><coordinates><x>{x}</x><y>{y}</y><z>{z}</z></coordinates></vertex>" for x, y, z in box_arrays()[0])
        + "</vertices><volume>"
        + "".join(f"<triangle><v1>{a}</v1><v2>{b}</v2><v3>{c}</v3></triangle>" for a, b, c in box_arrays()[1])
        + "</volume></mesh></object></amf>"
    )
    expected = program.error("slice", path, "-o", "-", "--format", "cli", "--unit", "inch")
    for ask in [lamella.read, lamella.slice]:
        with pytest.raises(lamella.UsageError) as caught:
            ask(path, unit_mm=25.4)
        assert str(caught.value) == expected and expected.startswith(str(path))


@pytest.mark.parametrize(
    "keywords, options",
    [
        ({"layer_height": 100}, ["--layer-height", "100"]),
        ({"z_range": (100, 101)}, ["--z-range", "100:101"]),
        ({"layers": (900, 905)}, ["--layers", "900:905"]),
        ({"layer_height": 1e-12}, ["--layer-height", "1e-12"]),
        ({"heights": [(3, 2, 0.1)]}, None),
        ({"z": [2, 1]}, None),
        ({"z": []}, None),
        ({"z": [100, 200]}, None),
        ({"layer_height": -1}, None),
        ({"adaptive": (2, 1)}, None),
        ({"unit_mm": 0}, None),
        ({"unit_mm": np.nan}, None),
    ],
)
def test_impossible_plans_are_errors_of_usage(program, rook, keywords, options):
    with pytest.raises(lamella.UsageError) as caught:
        lamella.slice(rook, **keywords)
    if options:
        assert str(caught.value) == program.error("slice", rook, "-o", "-", "--format", "cli", *options)
    assert isinstance(caught.value, ValueError) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "keywords, text",
    [
        ({"layer_height": 1, "z": [1]}, "z and layer_height contradict each other"),
        ({"offsets": [1], "z": [1]}, "z and offsets contradict each other"),
        ({"adaptive": (0.1, 0.2), "heights": []}, "heights and adaptive contradict each other"),
        ({"z": [1], "first_layer_height": 1}, "z and first_layer_height contradict each other"),
        ({"cusp": 1}, "cusp goes with adaptive layers"),
        ({"at": "side"}, '"side" is none of "bottom", "middle" and "top"'),
        ({"engine": "zigzag"}, '"zigzag" is none of "sweep"'),
        ({"threads": -1}, "threads: -1 is not possible"),
        ({"z": [[1, 2]]}, r"z: expected a list of numbers, found an array of the shape \(1, 2\)"),
        ({"direction": (0, 0, 0)}, "direction"),
        ({"direction": (0, 1)}, "direction: expected three numbers"),
        ({"unit_mm": 25.4}, "unit_mm goes with files"),
        ({"transform": np.eye(3)}, "transform: expected a matrix"),
        ({"transform": np.ones((4, 4))}, "the last row of a transform"),
        ({"transform": np.full((4, 4), np.nan)}, "transform"),
        ({"transform": np.diag([1, 1, 1e308, 1]), "z": [1]}, "transform: .* no finite numbers"),
        ({"transform": np.diag([1, 1, 1e101, 1]), "z": [1]}, "^the mesh: reaches beyond 1e.100 mm"),
        ({"transform": np.eye(4) + [[0, 0, 0, 1e17], *[[0] * 4] * 3]}, "^the mesh: .* away, where numbers are 22 mm apart"),
        ({"transform": np.diag([7e306, 5e306, 1.5e307, 1]), "direction": (1, 1, 1), "z": [1]}, "reaches beyond 1e.100 mm"),
    ],
)
def test_contradictions_are_named(keywords, text):
    with pytest.raises(lamella.UsageError, match=text):
        lamella.slice(box_arrays(), **keywords)


@pytest.mark.parametrize(
    "change, kind, text",
    [
        (lambda v, f: (v[:, :2], f), lamella.UsageError, r"vertices: expected .* \(n, 3\), found \(8, 2\) of float64"),
        (lambda v, f: (v.astype(str), f), lamella.UsageError, "vertices: expected an array of numbers"),
        (lambda v, f: (v, f.astype(float)), lamella.UsageError, "faces: expected an array of whole numbers"),
        (lambda v, f: (v, f.reshape(-1, 4)), lamella.UsageError, "must be cut into triangles first"),
        (lambda v, f: (v, f + 1), lamella.InputError, "faces: row .* names vertex 8, and there are 8, counted from 0"),
        (lambda v, f: (v, f - 1), lamella.InputError, "names vertex -1"),
        (lambda v, f: (v, f.astype(np.uint64) - 1), lamella.InputError, "names vertex 18446744073709551615, and there are 8"),
        (lambda v, f: (v, f[:0]), lamella.InputError, "no triangle"),
        (lambda v, f: v[f][:0], lamella.InputError, "part: holds no triangle"),
        (lambda v, f: np.where(v > 9, np.nan, v)[f], lamella.InputError, "part: triangle 0 has a corner that is not finite"),
        (lambda v, f: (np.ma.array(v, mask=v > 9), f), lamella.UsageError, "vertices: .* masked entries"),
        (lambda v, f: np.ma.array(v[f], mask=v[f] > 9), lamella.UsageError, "part: .* masked entries"),
        (lambda v, f: (np.where(v > 9, np.nan, v), f), lamella.InputError, "vertex"),
        (lambda v, f: (np.where(v > 9, np.inf, v), f), lamella.InputError, "vertex"),
        (lambda v, f: np.zeros((3, 4)), lamella.UsageError, r"triangles: expected an array of the shape \(m, 3, 3\)"),
    ],
)
def test_arrays_that_are_no_mesh_are_refused(change, kind, text):
    with pytest.raises(kind, match=text):
        lamella.slice(change(*box_arrays()))


@pytest.mark.parametrize("thing", [None, 5, [1, 2, 3], object()])
def test_what_is_no_mesh_at_all_is_an_error_of_type(thing):
    with pytest.raises(TypeError, match="a mesh is a path"):
        lamella.slice(thing)


def test_limits_are_their_own_kind(rook):
    with pytest.raises(lamella.LimitError):
        lamella.read(rook, max_triangles=100)


def test_the_limit_of_memory_holds_for_layers(rook, tmp_path):
    path = tmp_path / "layers.npz"
    lamella.write(path, lamella.slice(rook, 1))
    with pytest.raises(lamella.LimitError, match=r"layers\.npz.*`max_memory`") as caught:
        lamella.read(path, max_memory=10_000)
    assert "--" not in str(caught.value), "there are no options here, but keywords"
    assert len(lamella.read(path, max_memory=10_000_000)) > 10


def test_the_limit_of_memory_holds_for_the_list_of_layers():
    part = box_arrays(z=1.0)
    for function in (lamella.slice, lamella.iter_layers):
        with pytest.raises(lamella.LimitError, match="`max_memory`"):
            function(part, 5e-6, max_memory=50_000_000)
    with lamella.iter_layers(part, 5e-6, max_memory=200_000_000) as layers:
        assert next(layers).thickness == pytest.approx(5e-6)


def test_output_errors_are_those_of_the_program(program, rook, tmp_path):
    stack = lamella.slice(rook, 10)
    target = tmp_path / "missing" / "out.cli"
    with pytest.raises(lamella.OutputError) as caught:
        lamella.write(target, stack)
    assert str(caught.value) == program.error("slice", rook, "-o", target, "--layer-height", 10)
    target = tmp_path / "out.strange"
    with pytest.raises(lamella.UsageError) as caught:
        lamella.write(target, stack)
    assert str(caught.value).replace("`format`", "--format") == program.error("slice", rook, "-o", target, "--layer-height", 10)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("answer", [0, -1, 10**9, "all"])
def test_a_file_object_that_writes_nothing_does_not_hang(answer):
    class Full:
        name = "full.cli"

        def write(self, content):
            return answer

    with pytest.raises(lamella.OutputError, match=rf"full.cli: its write\(\) returned {answer}, for \d+ bytes"):
        lamella.write(Full(), lamella.slice(box_arrays(), 1))


def test_a_file_object_of_a_compressed_name_must_compress(tmp_path):
    path = tmp_path / "a.cli.gz"
    with open(path, "wb") as file, pytest.raises(lamella.UsageError, match="a.cli.gz would not be compressed; give its path"):
        lamella.write(file, lamella.slice(box_arrays(), 1))
    with gzip.open(path, "wb") as file:
        lamella.write(file, lamella.slice(box_arrays(), 1), format="cli")
    assert len(lamella.read_layers(path)) == 10


def test_findings_are_true_or_false():
    box = lamella.slice(box_arrays(), 1)
    assert lamella.verify(box, box_arrays()) and not lamella.verify(box, box_arrays(x=25))
    assert not lamella.inspect(box_arrays(), self_intersections=True).self_intersections


def test_errors_of_files_have_their_name(tmp_path):
    missing = tmp_path / "missing.stl"
    nowhere = tmp_path / "no" / "part.cli"
    for call, path in [
        (lambda: lamella.slice(missing), missing),
        (lambda: lamella.read_mesh(str(missing)), str(missing)),
        (lambda: lamella.verify(missing, box_arrays()), missing),
        (lambda: lamella.write(nowhere, lamella.slice(box_arrays(), 1)), nowhere),
        (lambda: lamella.Slicer(missing), missing),
    ]:
        with pytest.raises(OSError) as caught:
            call()
        assert caught.value.filename == os.fspath(path) and caught.value.strerror == os.strerror(errno.ENOENT)
        again = pickle.loads(pickle.dumps(caught.value))
        assert (again.filename, str(again)) == (os.fspath(path), str(caught.value))


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs Linux")
def test_a_folder_that_takes_no_files_is_told_from_a_missing_one():
    with pytest.raises(lamella.OutputError, match="the folder '/proc' takes no new files; choose another place"):
        lamella.write("/proc/part.cli", lamella.slice(box_arrays(), 1))
