"""Wrong arguments: the texts are of the package, in words of Python, and name the keyword."""

import inspect
import io
import os
import pickle
import subprocess
import sys
import warnings
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from conftest import PACKAGE, box_arrays

import lamella

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


def stack():
    return lamella.slice(box_arrays(), 5)


def closed_stream():
    layers = lamella.iter_layers(box_arrays(), 5)
    layers.close()
    return layers


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The working directory, with a mesh, layers, and a folder in it."""
    monkeypatch.chdir(tmp_path)
    lamella.write("box.stl", lamella.Mesh(*box_arrays()))
    lamella.write("box.json", stack())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", lamella.DefectWarning)  # the format has no place for powers and speeds
        lamella.write("job.cli", list(lamella.scan(stack(), part="box")))
    (tmp_path / "folder").mkdir()
    return tmp_path


class Broken:
    """Has no number, no length, and nothing to iterate over."""


# What somebody may give by mistake.
MISTAKES = [
    None, True, -1, 0, 2**70, 10**5000, -1.5, 1e300, np.nan, np.inf, 1j, "", "text", "folder", "missing.stl", "no\0name",
    "\ud800", b"", b"\xff", b"no\0name", (), [1], [None], ["a", "b"], [SQUARE, [1]], [1, [2, 3]], {}, {"a": 1}, {1},
    Broken(), Broken, ..., np.zeros(3), np.zeros((3, 3)), np.zeros((2, 2, 2)), np.zeros((0, 3)), np.array("x"),
    np.array([(1, 2, 3)], dtype=object), np.array([1j, 2]), np.array([True, False]), np.full((4, 2), np.nan),
    np.datetime64("2026-01-01"), memoryview(b"bytes"), range(3), (n for n in "ab"), closed_stream,
]  # fmt: skip

class Square:
    """A polygon as shapely has them."""

    geom_type, is_empty, interiors = "Polygon", False, ()

    class exterior:  # noqa: N801, as shapely calls it
        coords, is_ccw = SQUARE, True


# Every function and every class that takes something, with arguments that are right.
CALLS = {
    "slice": (lamella.slice, {"part": box_arrays()}),
    "iter_layers": (lamella.iter_layers, {"part": box_arrays()}),
    "read": (lamella.read, {"file": "box.stl"}),
    "read_mesh": (lamella.read_mesh, {"file": "box.stl"}),
    "read_layers": (lamella.read_layers, {"file": "box.json"}),
    "write": (lamella.write, {"file": "out.zip", "content": stack(), "format": "png-zip"}),
    "convert": (lamella.convert, {"source": "box.json", "target": "out.cli"}),
    "inspect": (lamella.inspect, {"part": box_arrays()}),
    "mend": (lamella.mend, {"part": box_arrays(), "orient": True}),
    "verify": (lamella.verify, {"layers": stack(), "mesh": box_arrays()}),
    "verify_vectors": (lamella.verify_vectors, {"file": "job.cli", "mesh": box_arrays()}),
    "compare": (lamella.compare, {"first": stack(), "second": stack()}),
    "scan": (lamella.scan, {"layers": list(stack())}),
    "to_pyslm": (lamella.to_pyslm, {"layer": next(lamella.scan(stack()))}),
    "Part": (lamella.Part, {"mesh": box_arrays()}),
    "Mesh": (lamella.Mesh, dict(zip(("vertices", "faces"), box_arrays()))),
    "Layer": (lamella.Layer, {"rings": [SQUARE], "z": 1}),
    "Stack": (lamella.Stack, {"layers": list(stack())}),
    "ContourRule": (lamella.ContourRule, {}),
    "HatchRule": (lamella.HatchRule, {}),
    "ParameterSet": (lamella.ParameterSet, {}),
    "ScanStrategy": (lamella.ScanStrategy, {}),
    "SkinRule": (lamella.SkinRule, {}),
    "SupportRule": (lamella.SupportRule, {}),
    "Slicer": (lamella.Slicer, {"part": box_arrays()}),
    "Slicer.section": (lamella.Slicer(box_arrays()).section, {"z": 1}),
    "Slicer.section of any plane": (lamella.Slicer(box_arrays()).section, {"origin": (1, 1, 1), "normal": (1, 1, 0)}),
    "Layer.diagnose": (stack()[0].diagnose, {}),
    "Layer.image": (stack()[0].image, {"pixel_mm": 1}),
    "voxels": (lamella.voxels, {"meshes": box_arrays(), "spacing": 5}),
    "Stack.pixels": (stack().pixels, {"pixel_size": 5}),
    "Stack.at": (stack().at, {"z": 1}),
    "Stack.check": (stack().check, {}),
    "Layer.from_shapely": (lamella.Layer.from_shapely, {"geometry": Square(), "z": 1}),
    "Layer.filled": (stack()[0].filled, {}),
    "Layer.offset": (stack()[0].offset, {"distance": 1}),
    "Layer.simplified": (stack()[0].simplified, {"tolerance": 1}),
    "Layer.union": (stack()[0].union, {"other": stack()[0]}),
    "Layer.intersection": (stack()[0].intersection, {"other": stack()[0]}),
    "Layer.difference": (stack()[0].difference, {"other": stack()[0]}),
    "Layer.symmetric_difference": (stack()[0].symmetric_difference, {"other": stack()[0]}),
}


def parameters():
    for name, (function, _) in CALLS.items():
        made = function.__init__ if inspect.isclass(function) else function
        for parameter in inspect.signature(made).parameters:
            if parameter != "self":
                yield name, parameter


def test_every_function_is_looked_at():
    functions = {name for name in lamella.__all__ if inspect.isfunction(getattr(lamella, name))}
    assert functions - set(CALLS) == {"engines", "layer_formats", "mesh_formats"}, "these take nothing"
    methods = {
        f"{cls.__name__}.{name}"
        for cls in (lamella.Layer, lamella.Stack, lamella.Mesh, lamella.LayerStream, lamella.Slicer)
        for name, method in vars(cls).items()
        if not name.startswith("_") and callable(method)
    }
    assert methods - set(CALLS) == {"Layer.plot", "Layer.polygons", "Layer.to_shapely", "LayerStream.close", "Stack.show"}, "likewise, or axes"


def in_words_of_python(text):
    """No type, no name and no signature of C++, nor of the extension."""
    return "\n" not in text and not any(
        word in text for word in ("incompatible", "std::", "_lamella", "SharedLayer", "numpy.ndarray", "Invoked with")
    )


@pytest.mark.parametrize("name, parameter", parameters())
@pytest.mark.filterwarnings("ignore::lamella.DefectWarning")
def test_mistakes_are_errors_of_the_documented_kinds(folder, name, parameter):
    function, arguments = CALLS[name]
    for mistake in MISTAKES:
        given = mistake() if mistake is closed_stream else mistake
        try:
            function(**{**arguments, parameter: given})
        except TypeError as error:
            if not (parameter == "progress" and callable(given)):  # which raises what it likes
                names = [parameter, "vertices", "faces"] if parameter in ("part", "mesh", "content") else [parameter]
                named = any(f"{name}: " in str(error) for name in names)
                assert in_words_of_python(str(error)) and named, f"{mistake!r}: {error}"
        except lamella.Error as error:
            assert not isinstance(error, lamella.InternalError) and in_words_of_python(str(error)), f"{mistake!r}: {error}"


@pytest.mark.parametrize("name", CALLS)
def test_calls_that_do_not_fit_are_reported_as_by_python(name):
    function, arguments = CALLS[name]
    for wrong in ([1] * 99, []), ([], {**arguments, "colour": 1}), ([], {"colour": 1}):
        with pytest.raises(TypeError) as caught:
            function(*wrong[0], **dict(wrong[1]))
        assert in_words_of_python(str(caught.value)), caught.value


@pytest.mark.parametrize(
    "call",
    [
        lambda: stack()[0].polygons(1),
        lambda: stack()[0].to_shapely(1),
        lambda: closed_stream().close(1),
        lambda: lamella.LayerStream(),
        lambda: stack()["a"],
        lambda: stack()[1.5],
        lambda: stack()[None],
        lambda: stack()[0]["a"],
        lambda: stack()[0][0:1],
    ],
)
def test_methods_refuse_in_words_of_python(call):
    with pytest.raises(TypeError) as caught:
        call()
    assert in_words_of_python(str(caught.value))


TEXTS = [
    (lambda: lamella.slice(box_arrays(), "thin"), TypeError, "layer_height: expected a number above 0, found 'thin'"),
    (lambda: lamella.slice(box_arrays(), True), TypeError, "layer_height: expected a number above 0, found True"),
    (lambda: lamella.slice(box_arrays(), np.nan), ValueError, "layer_height: nan is not possible; expected a number above 0"),
    (lambda: lamella.slice(box_arrays(), z_range=5), TypeError, "z_range: expected two numbers (from, to), found 5"),
    (lambda: lamella.slice(box_arrays(), z_range=(1, 2, 3)), ValueError,
     "z_range: expected two numbers (from, to), found 3 values"),
    (lambda: lamella.slice(box_arrays(), layers=(0, 1.5)), TypeError, "layers: expected a whole number, 0 or more, found 1.5"),
    (lambda: lamella.slice(box_arrays(), heights=[(0, 1)]), ValueError,
     "heights: expected ranges, each of three numbers (from, to, layer_height), found 2 values"),
    (lambda: lamella.slice(box_arrays(), z=["1"]), ValueError, "z: expected a list of numbers, found (1,) of <U1"),
    (lambda: lamella.slice(box_arrays(), at="side"), ValueError, 'at: "side" is none of "bottom", "middle" and "top"'),
    (lambda: lamella.slice(box_arrays(), strict="no"), TypeError, "strict: expected True or False, found 'no'"),
    (lambda: lamella.slice(box_arrays(), threads=5000), ValueError,
     "threads: 5000 is not possible; expected a whole number from 0 to 4096"),
    (lambda: lamella.slice(box_arrays(), progress=5), TypeError,
     "progress: expected a function of (stage, done, total), found 5"),
    (lambda: lamella.slice(box_arrays(), transform=np.full((4, 4), np.nan)), ValueError,
     "transform: expected finite numbers, found nan or inf"),
    (lambda: lamella.slice(box_arrays(), transform=np.diag([1, 1, 1, 2])), ValueError,
     "transform: the last row of a transform must be 0, 0, 0, 1, and this one is 0, 0, 0, 2: meshes are moved, rotated and "
     "scaled, but not projected"),
    (lambda: lamella.slice(box_arrays(), offsets=[1, 3, 2]), ValueError,
     "offsets: 2 is not above the one before it, 3; the list must ascend"),
    (lambda: lamella.slice(box_arrays(), offsets=[]), ValueError, "offsets: expected a list of numbers, found an empty one"),
    (lambda: lamella.slice(box_arrays(), z=[1, np.nan]), ValueError, "z: expected finite numbers, found nan or inf"),
    (lambda: lamella.slice(box_arrays(), z=np.ma.array([1, 2], mask=[0, 1])), ValueError,
     "z: expected a list of numbers, found one with masked entries"),
    (lambda: lamella.slice(box_arrays(), np.ma.masked), TypeError,
     "layer_height: expected a number above 0, found () of float64"),
    (lambda: lamella.slice(box_arrays(), heights=[]), ValueError,
     "heights: expected ranges, each of three numbers (from, to, layer_height), found none"),
    (lambda: lamella.slice(np.zeros((2, 3, 3), dtype="U1")), ValueError,
     "part: expected an array of numbers of the shape (m, 3, 3), found (2, 3, 3) of <U1"),
    (lambda: lamella.read("box.json", unit_mm=2), ValueError,
     "unit_mm goes with meshes, and box.json holds layers, which say their unit"),
    (lambda: lamella.read(5), TypeError, "file: expected a path (str or os.PathLike), bytes or a binary file, found 5"),
    (lambda: lamella.read(io.StringIO("solid")), TypeError,
     'file: expected a binary file, found one of text; open it with the mode "rb"'),
    (lambda: lamella.write(io.StringIO(), stack(), format="cli"), TypeError,
     'file: expected a binary file, found one of text; open it with the mode "wb"'),
    (lambda: lamella.write(b"out.cli", stack()), TypeError,
     "file: expected a path (str or os.PathLike) or a binary file, found b'out.cli'"),
    (lambda: lamella.write(io.BytesIO(), stack(), format="png"), ValueError,
     "png writes a folder, so <BytesIO> is not possible; give the path of a folder"),
    (lambda: lamella.write(io.BytesIO(), lamella.Mesh(*box_arrays())), ValueError,
     "<BytesIO>: meshes are written as stl, ply, obj, by the extension or `format`; slice the mesh to get layers"),
    (lambda: lamella.read(""), ValueError, "file: expected the path of a file, found an empty one"),
    (lambda: lamella.read("a\0b"), ValueError, "file: 'a\\x00b' is not possible; the path of a file holds no null character"),
    (lambda: lamella.read("x", max_memory=-1), ValueError,
     "max_memory: -1 is not possible; expected a whole number, 0 or more"),
    (lambda: lamella.write("x.cli", 5), TypeError,
     "content: expected a mesh, a lamella.Layer or Stack, or an iterable of layers, stacks or scan layers, found 5"),
    (lambda: lamella.write("x.cli", [stack(), stack()[0]]), TypeError,
     "content: expected a mesh, a lamella.Layer or Stack, or an iterable of layers, stacks or scan layers, found an object of "
     "type Layer"),
    (lambda: lamella.write("x.cli", []), ValueError, "content: there are no layers to write"),
    (lambda: lamella.write("x.cli", closed_stream()), ValueError,
     "content: there are no layers to write: the stream is closed or at its end"),
    (lambda: lamella.write("x.cli", stack(), gamma=2), ValueError,
     "gamma goes with the formats png, png-zip, sl1, sl1s, goo, ctb, cbddlp, anycubic, chitubox-zip, nanodlp, not with cli"),
    (lambda: lamella.write("x.zip", stack(), grey_curve=[(0, 60, 1)]), ValueError,
     "grey_curve: expected pairs of two numbers (covered part, grey value), found 3 values"),
    (lambda: lamella.write("x.zip", stack(), part_colours=[(0, 60)]), ValueError,
     "part_colours: expected True, or three whole numbers from 0 to 255 (red, green, blue) for each part, found 2 values"),
    (lambda: lamella.write("x.svg", stack(), units_mm=2), ValueError, "units_mm goes with the formats cli, cli-ascii, ilt, 3mf-toolpath, not with svg"),
    (lambda: lamella.write("x.zip", stack(), exposure_s=2, format="png-zip"), ValueError,
     "exposure_s goes with the formats sl1, sl1s, goo, ctb, cbddlp, anycubic, chitubox-zip, nanodlp, not with png-zip"),
    (lambda: lamella.write("x.stl", lamella.Mesh(*box_arrays()), gamma=2), ValueError,
     "gamma goes with layers, and the content is a mesh"),
    (lambda: lamella.write("x.out", stack(), format="3fm"), ValueError,
     'format: "3fm" is none of ' + ", ".join(f'"{name}"' for name, _, _ in lamella.layer_formats()[:-1]) +
     ' and "nanodlp"; did you mean "3mf"?'),
    (lambda: lamella.write("x.sl1", stack(), antialias=65), ValueError,
     "antialias: 65 is not possible; expected a whole number from 1 to 64"),
    (lambda: lamella.write("x.sl1", stack(), mirror="z"), ValueError, 'mirror: "z" is none of "none", "x", "y" and "xy"'),
    (lambda: lamella.verify(stack(), unit_mm=2), ValueError, "unit_mm goes with a mesh, and none is given"),
    (lambda: lamella.verify(5), TypeError, "layers: expected a path, bytes, a binary file or a lamella.Stack, found 5"),
    (lambda: lamella.compare(stack(), stack(), -1), ValueError,
     "tolerance: -1 is not possible; expected a distance, which is not negative"),
    (lambda: lamella.inspect(None), TypeError,
     "part: a mesh is a path, bytes, a binary file, a lamella.Mesh, a pair of arrays (vertices, faces), or something with "
     ".vertices and .faces; this is None"),
    (lambda: lamella.scan("part.stl"), TypeError, "layers: a path is not taken; slice it first"),
    (lambda: lamella.scan(b"solid"), TypeError, "layers: a file is not taken; slice it first"),
    (lambda: lamella.scan(lamella.Mesh(*box_arrays())), TypeError, "layers: a mesh is not taken; slice it first"),
    (lambda: lamella.slice(box_arrays(), layer_hight=1), TypeError,
     "slice() got an unexpected keyword argument 'layer_hight'; did you mean 'layer_height'?"),
    (lambda: stack()[0].offset(1, corner="round"), TypeError,
     "Layer.offset() got an unexpected keyword argument 'corner'; did you mean 'corners'?"),
    (lambda: stack()[0].offset(1, corners="miter"), ValueError,
     'corners: "miter" is none of "mitre", "bevel" and "round"; did you mean "mitre"?'),
    (lambda: lamella.slice(box_arrays(), at="center"), ValueError, 'at: "center" is none of "bottom", "middle" and "top"'),
    (lambda: lamella.slice(box_arrays(), engine="swep"), ValueError, 'engine: "swep" is none of ' +
     " and ".join([", ".join(f'"{engine.name}"' for engine in lamella.engines()[:-1]), f'"{lamella.engines()[-1].name}"']) +
     '; did you mean "sweep"?'),
    (lambda: stack().at(99), ValueError, "z: there is no layer at 99 mm; they reach from 0 to 10 mm"),
    (lambda: stack()[[1, 0]], ValueError,
     "index: expected whole numbers that ascend, or True or False for each layer; layers of a stack ascend"),
    (lambda: lamella.Layer.from_shapely(5, 1), TypeError, "geometry: expected a geometry of shapely, found 5"),
    (lambda: lamella.Layer([[(0, 0, 0)]], 1), ValueError,
     "rings: expected contours, each an array of numbers of the shape (n, 2), found (1, 3) of int64"),
    (lambda: lamella.Layer([[(0, 0), (1, 0), (1, np.nan)]], 1), ValueError,
     "rings: expected finite numbers, found nan or inf"),
    (lambda: lamella.Layer([np.ma.array(SQUARE, mask=np.eye(4, 2))], 1), ValueError,
     "rings: expected contours, each an array of numbers of the shape (n, 2), found one with masked entries"),
    (lambda: setattr(lamella.ScanStrategy(), "hatch", "x"), TypeError, "hatch: expected a lamella.HatchRule, found 'x'"),
    (lambda: lamella.ScanStrategy(3), TypeError, "ScanStrategy() takes its attributes as keywords only"),
    (lambda: lamella.ParameterSet(3), TypeError, "other: expected a lamella.ParameterSet, found 3"),
    (lambda: lamella.Layer([], 1, bottom=2), ValueError,
     "z: 1 is not possible; a layer is cut between its bottom, 2.0, and its top, 1.0"),
    (lambda: lamella.Stack([1]), TypeError, "layers: expected layers, found 1"),
    (lambda: stack()[0].offset("far"), TypeError, "distance: expected a number or several, found 'far'"),
    (lambda: stack()[0].union(5), TypeError, "other: expected a layer, found 5"),
    (lambda: stack()[0]["a"], TypeError, "the number of a contour: expected a whole number, found str"),
]  # fmt: skip


@pytest.mark.parametrize("call, kind, text", TEXTS, ids=[text.partition(" ")[0] for _, _, text in TEXTS])
def test_texts_name_the_keyword_what_was_given_and_what_is_expected(folder, call, kind, text):
    with pytest.raises(kind) as caught:
        call()
    assert str(caught.value) == text
    assert isinstance(caught.value, lamella.Error) == (kind is ValueError), "wrong values are a UsageError"


LONG = "long" * 10**5
QUOTED = {
    "at": lambda: lamella.slice("part.stl", at=LONG),
    "engine": lambda: lamella.slice("part.stl", engine=LONG),
    "layer_height": lambda: lamella.slice("part.stl", Decimal("-" + "1" * 10**5)),
    "layers": lambda: lamella.slice("part.stl", layers=(0, -(10**4000))),
    "path": lambda: lamella.read(LONG + "\0"),
    "format": lambda: lamella.write("part.cli", stack(), format=LONG),
    "label": lambda: lamella.Stack([], label=LONG + "\ud800"),
    "rings": lambda: lamella.Layer([type(LONG, (), {})()], 1),
    "rule": lambda: stack()[0].filled(LONG),
    "corners": lambda: stack()[0].offset(1, LONG),
    "z": lambda: lamella.Layer([], Decimal("-" + "1" * 300), bottom=2),
    "table": lambda: lamella.scan(stack(), {LONG: {}}),
    "pattern": lambda: lamella.scan(stack(), {"hatch": {"pattern": LONG}}),
    "parameters": lambda: lamella.scan(stack(), {"hatch": {"parameters": LONG}}),
    "parameters that are not used": lambda: lamella.scan(stack(), {"parameters": {LONG: {}}}),
    "key of parameters": lambda: lamella.scan(stack(), {"parameters": {LONG: {LONG: 1}}}),
}


@pytest.mark.parametrize("call", QUOTED.values(), ids=QUOTED)
def test_errors_quote_the_begin_of_long_values(folder, call):
    with pytest.raises((TypeError, ValueError)) as caught:
        call()
    assert len(str(caught.value)) < 900 and "\n" not in str(caught.value)


READERS = {
    "read": lamella.read,
    "slice": lamella.slice,
    "iter_layers": lamella.iter_layers,
    "inspect": lamella.inspect,
    "verify": lamella.verify,
    "verify with a mesh": lambda path: lamella.verify(stack(), path),
    "compare": lambda path: lamella.compare(path, stack()),
    "convert": lambda path: lamella.convert(path, "out.cli"),
    "convert to itself": lambda path: lamella.convert(path, path),
    "convert to what is there": lambda path: lamella.convert(path, "box.json"),
}


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("path", ["missing.stl", "missing.cli", "missing/part.stl", "box.json/part.cli", "missing\udcff.cli"])
def test_files_that_are_not_there_are_errors_of_input(folder, name, path):
    with pytest.raises(lamella.InputError) as caught:
        READERS[name](path)
    assert str(caught.value).startswith(f"{path}: " if path.isascii() else "missing\\xff.cli: ")
    assert isinstance(caught.value, NotADirectoryError if path.startswith("box") else FileNotFoundError)
    assert not (folder / "out.cli").exists()


@pytest.mark.parametrize("name", set(READERS) - {"convert to itself"})
def test_folders_are_errors_of_input(folder, name):
    with pytest.raises(lamella.InputError, match="folder") as caught:
        READERS[name]("folder")
    assert isinstance(caught.value, IsADirectoryError)


@pytest.mark.parametrize("target", ["missing/out.cli", "box.json/out.cli"])
def test_places_that_cannot_be_written_to_are_errors_of_output(folder, target):
    for write in (
        lambda: lamella.write(target, stack()),
        lambda: lamella.convert("box.json", target),
        lambda: lamella.write(target.replace("cli", "stl"), lamella.Mesh(*box_arrays())),
    ):
        with pytest.raises(lamella.OutputError, match="out") as caught:
            write()
        assert isinstance(caught.value, NotADirectoryError if target.startswith("box") else FileNotFoundError)


def test_numbers_of_any_kind_are_numbers():
    expected = lamella.slice(box_arrays(), 0.5, layers=(1, 3))
    for half in (Fraction(1, 2), np.float32(0.5), np.array(0.5)):
        assert lamella.slice(box_arrays(), half, layers=np.array([1, 3])) == expected
    assert lamella.slice(box_arrays(), z=range(1, 4)).z.tolist() == [1, 2, 3]


def test_a_length_of_any_kind_stands_for_both(tmp_path):
    written = set()
    for length in ((0.5, 0.5), 0.5, Decimal("0.5"), np.array(0.5)):
        lamella.write(tmp_path / "out.zip", stack(), format="png-zip", pixel_mm=length)
        written.add((tmp_path / "out.zip").read_bytes())
    assert len(written) == 1


def test_labels_need_not_be_utf_8(folder):
    named = lamella.Stack(list(stack()), label="caf\udce9")
    assert named.label == pickle.loads(pickle.dumps(named)).label == "caf\udce9"
    lamella.write("out.json", named)
    assert lamella.read("out.json") == named


def test_memory_that_runs_out_is_a_limit():
    # Of a program of its own, which may take so much more than it has.
    code = """
import resource
import numpy as np
import lamella

vertices, faces = np.zeros((6_000_000, 3)), np.arange(6_000_000).reshape(-1, 3)
taken = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (taken + (64 << 20), resource.RLIM_INFINITY))
try:
    lamella.Mesh(vertices, faces)
except lamella.LimitError as error:
    assert isinstance(error, MemoryError)
    print(error)
"""
    result = subprocess.run([sys.executable, "-B", "-c", code], env={"PYTHONPATH": PACKAGE}, capture_output=True,
                            text=True, check=True)
    assert result.stdout.startswith("memory ran out")


@pytest.mark.parametrize(
    "call",
    [
        lambda text: lamella.slice(box_arrays(), 5, at=text),
        lambda text: lamella.Part(box_arrays(), role=text),
        lambda text: lamella.read(text),
        lambda text: lamella.read_layers(f"{text}.cli"),
        lambda text: lamella.scan(stack(), text),
        lambda text: lamella.scan(stack(), {text: 1}),
        lambda text: lamella.write(f"no folder/{text}.cli", stack()),
    ],
)
def test_errors_are_one_short_line_that_a_terminal_shows_as_it_is(folder, call):
    for text in "a\x1b[31mb", "a\u202egpj", "a\u2028b", "a\x9bb", "a\r" + "x" * 100_000, ("x" * 250 + "/") * 400:
        with pytest.raises((lamella.Error, TypeError, OSError)) as error:
            call(text)
        shown = str(error.value)
        assert shown.isprintable(), repr(shown)
        assert len(shown) < 2000


def test_a_text_of_a_strategy_is_no_path(folder):
    with pytest.raises(lamella.UsageError, match="found a text of several lines; ScanStrategy.from_toml takes it"):
        lamella.scan(stack(), lamella.ScanStrategy().to_toml())


def test_warnings_are_lines_that_a_terminal_shows_as_it_is(tmp_path):
    path = tmp_path / "a\x1b\u202e.stl"
    lamella.write(path, lamella.Mesh(*box_arrays()))
    with open(path, "ab") as file:
        file.write(b"more")
    with pytest.warns(lamella.DefectWarning) as found:
        lamella.read_mesh(path)
    assert all(str(one.message).isprintable() for one in found)
