"""The package as a whole: everything public is documented, typed and named once."""

import ast
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import PACKAGE, ROOT, run_python

import lamella

PUBLIC = [name for name in lamella.__all__ if not name.startswith("__")]
FUNCTIONS = [name for name in PUBLIC if inspect.isfunction(getattr(lamella, name))]
CLASSES = [name for name in PUBLIC if inspect.isclass(getattr(lamella, name))]
EXTENSION = [name for name in CLASSES if name in vars(lamella._lamella)]


def members(name):
    """Those that the class itself defines and shows."""
    return [member for member in vars(getattr(lamella, name)) if not member.startswith("_")]


def stub():
    tree = ast.parse((ROOT / "python/lamella/_lamella.pyi").read_text(encoding="utf-8"))
    return {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def test_what_is_public_is_listed():
    shown = {name for name in vars(lamella) if not name.startswith("_") and not inspect.ismodule(getattr(lamella, name))}
    assert shown == set(PUBLIC)
    assert lamella.__all__ == sorted(lamella.__all__)
    assert {"slice", "iter_layers", "read", "write", "inspect", "convert", "compare", "engines"} <= set(FUNCTIONS)


@pytest.mark.parametrize("name", PUBLIC)
def test_everything_has_a_docstring(name):
    thing = getattr(lamella, name)
    assert thing.__doc__ and thing.__doc__.strip()[-1] in ".)", name
    if inspect.isclass(thing) and not issubclass(thing, Exception):
        for member in members(name):
            described = getattr(thing, member)
            if callable(described) or isinstance(described, property):
                assert described.__doc__, f"{name}.{member}"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_docstrings_describe_every_argument(name):
    function = getattr(lamella, name)
    if "Takes what `slice` takes" in function.__doc__ or "For the rest see `write`" in function.__doc__:
        return
    for argument in inspect.signature(function).parameters:
        assert f"{argument}" in function.__doc__, f"{name}: {argument}"


def test_one_signature_is_that_of_the_other():
    slicing, streaming = (inspect.signature(function).parameters for function in (lamella.slice, lamella.iter_layers))
    assert list(slicing.values()) == list(streaming.values())


# What a docstring says of numbers: their unit or their shape.
QUANTITIES = {
    "Mesh": {"vertices": ["millimetres", "(n, 3)", "float64"], "faces": ["(m, 3)", "uint32"], "volume": ["cubic"],
             "bounds": ["millimetres", "(2, 3)"]},
    "Layer": {"z": ["millimetres"], "bottom": ["millimetres"], "top": ["millimetres"], "thickness": ["millimetres"],
              "points": ["millimetres", "(n, 2)", "float64"], "offsets": ["(contours + 1,)", "int64"],
              "closed": ["(contours,)", "bool"], "parent": ["(contours,)", "int64"], "area": ["square millimetres"],
              "perimeter": ["millimetres"], "hatches": ["(n, 2, 2)"]},
    "Stack": {"z": ["millimetres", "(layers,)"], "area": ["square millimetres", "(layers,)"],
              "perimeter": ["millimetres", "(layers,)"], "volume": ["cubic millimetres"], "contours": ["int64"]},
}


@pytest.mark.parametrize("name", QUANTITIES)
def test_docstrings_give_shapes_and_units(name):
    for member, words in QUANTITIES[name].items():
        text = getattr(getattr(lamella, name), member).__doc__
        assert all(word in text for word in words), f"{name}.{member}: {text}"


@pytest.mark.parametrize("name", EXTENSION)
def test_stubs_have_what_the_extension_has(name):
    declared = {node.name for node in stub()[name].body if isinstance(node, ast.FunctionDef)}
    declared |= {node.target.id for node in stub()[name].body if isinstance(node, ast.AnnAssign)}
    assert set(members(name)) <= declared
    assert {member for member in declared if not member.startswith("__")} <= set(vars(getattr(lamella, name)))


@pytest.mark.parametrize("name", EXTENSION)
def test_stubs_report_which_classes_have_no_hash(name):
    unhashable = {node.target.id for node in stub()[name].body if isinstance(node, ast.AnnAssign)} & {"__hash__"}
    assert bool(unhashable) == (getattr(lamella, name).__hash__ is None)


def test_the_stub_is_what_the_script_prints():
    script = ROOT / "tools/python_stub.py"
    printed = subprocess.run([sys.executable, "-B", script, PACKAGE], capture_output=True, text=True, check=True).stdout
    assert printed == (ROOT / "python/lamella/_lamella.pyi").read_text(encoding="utf-8"), f"print it again: {script}"


def imported(path):
    """The modules of the package that one of its modules imports when it runs, wherever the import is."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    checking = {id(node) for one in ast.walk(tree) if isinstance(one, ast.If) and "TYPE_CHECKING" in ast.dump(one.test)
                for statement in one.body for node in ast.walk(statement)}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level and id(node) not in checking:
            yield from [node.module] if node.module else [alias.name for alias in node.names]


def test_modules_import_one_another_in_no_circle():
    sources = (ROOT / "python/src").glob("*.cpp")
    by_extension = {name for source in sources for name in re.findall(r'"(?:lamella\.)?(_[a-z]+)"\)', source.read_text())}
    files = {path.stem: path for path in (ROOT / "python/lamella").glob("_[a-z]*.py")}
    needs = {name: set(imported(path)) for name, path in files.items()}
    needs["_lamella"] = {"_errors", "_arguments"} | (by_extension & set(files))
    assert {"_methods", "_rules"} <= needs["_lamella"]
    while free := {name for name in needs if not needs[name] & set(needs)}:
        needs = {name: others for name, others in needs.items() if name not in free}
    assert needs == {}


def test_classes_are_whole_when_the_extension_is_imported():
    code = "import sys, lamella._lamella as e; print(e.Layer.offset.__module__, e.HatchRule(distance=1).distance)"
    assert run_python(code).split() == ["lamella._methods", "1.0"]


def test_the_extension_is_where_the_stubs_are():
    assert EXTENSION == ["ContourRule", "Exposure", "HatchRule", "Layer", "LayerStream", "Mesh", "ParameterSet",
                         "ScanFigures", "ScanStrategy", "SkinRule", "Stack", "SupportRule"]
    functions = {name for name, node in stub().items() if isinstance(node, ast.FunctionDef)}
    assert functions == {name for name in vars(lamella._lamella) if inspect.isbuiltin(getattr(lamella._lamella, name))}
    assert (Path(lamella.__file__).parent / "py.typed").is_file()


def test_the_built_package_is_the_one_in_the_tree():
    built = {path.name: path.read_bytes() for path in (Path(PACKAGE) / "lamella").glob("*.py*")}
    for path in (ROOT / "python/lamella").iterdir():
        if path.is_file():
            assert built.get(path.name, (Path(PACKAGE) / "lamella" / path.name).read_bytes()) == path.read_bytes()


def test_the_version_is_that_of_the_program(program):
    assert program.succeed("--version").decode().split()[1] == lamella.__version__


def test_importing_it_needs_nothing_but_numpy():
    code = "import sys, lamella; print(*{name.partition('.')[0] for name in sys.modules})"
    result = subprocess.run([sys.executable, "-B", "-c", code], env={"PYTHONPATH": PACKAGE}, capture_output=True,
                            text=True, check=True)
    assert not {"shapely", "matplotlib", "trimesh", "dask"} & set(result.stdout.split())
