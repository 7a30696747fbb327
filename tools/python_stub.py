#!/usr/bin/env python3
"""Prints the stub of Python's extension, python/lamella/_lamella.pyi, from the built package: the types of C++ from pybind11's
docstrings, those of methods in Python from their signatures, and those of strategies from their defaults.
usage: tools/python_stub.py [FOLDER]; the folder of the package is build/python by default"""

import importlib
import inspect
import re
import sys
import textwrap
import typing

RULE = 'Literal["section_above", "section_below"]'
# Types that are narrower than those of C++.
NARROWER = {
    "Exposure.kind": 'Literal["contour", "hatch"]',
    "Exposure.region": 'Literal["core", "upskin", "downskin", "support"]',
    "Layer.__iter__": "Iterator[npt.NDArray[np.float64]]",
    "LayerStream.__enter__": "LayerStream",
    "LayerStream.__iter__": "LayerStream",
    "LayerStream.rule": RULE,
    "Stack.__iter__": "Iterator[Layer]",
    "Stack.rule": RULE,
}
NOT_SHOWN = {"__new__", "__repr__", "__str__", "__reduce_ex__", "__getstate__", "__setstate__"}


def returned(text):
    """Returns a type of C++ in words of Python, as pybind11 has it in docstrings."""
    text = re.sub(r"\[\d+\]", "", text.replace("lamella::", "").replace("lamella.", ""))  # lengths of arrays
    text = re.sub(r"numpy\.ndarray\[(?:numpy\.)?(\w+)\]", lambda item: f"npt.NDArray[np.{item[1].replace('bool', 'bool_')}]", text)
    text = re.sub(r"numpy\.ndarray(?!\[)", "npt.NDArray[Any]", text)  # of any numbers
    for plain, full in (("dict", "Dict[str, Any]"), ("list", "List[Any]"), ("tuple", "Tuple[Any, ...]"), ("object", "Any")):
        text = re.sub(rf"\b{plain}\b", full, text)
    return text


def taken(text):
    """The same for an argument: strings may be bytes, lists anything like them, and pointers may be null."""
    text = returned(text).replace("List[", "Iterable[")
    text = re.sub(r"\b(Mesh|Plate|Stack)\b", r"Optional[\1]", text)
    while (shorter := re.sub(r"Iterable\[(float|int|numbers)\]", "numbers", text)) != text:
        text = shorter
    text = re.sub(r"npt\.NDArray\[np\.\w+\]|\bnumbers\b", "npt.ArrayLike", text)
    text = re.sub(r"\bIterable$", "Iterable[Any]", text)
    return re.sub(r"(?<!Dict\[)\bstr\b", "Union[str, bytes]", text)


def split(text):
    """Splits parameters at commas outside of brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter == "[") - (letter == "]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]


def wrapped(name, parameters, result, indent):
    line = f"{indent}def {name}({', '.join(parameters)}) -> {result}: ..."
    if len(line) <= 120:
        return [line]
    whole = [parameter.replace(" ", "\0") for parameter in parameters]  # not broken within
    lines = textwrap.wrap(", ".join(whole), 112, break_long_words=False, break_on_hyphens=False)
    lines = [f"{indent}    {line}".replace("\0", " ") for line in lines]
    return [f"{indent}def {name}(", *lines, f"{indent}) -> {result}: ..."]


def of_cpp(owner, name, function, indent):
    signature = re.match(r"\w+\((.*)\) -> (.*)", (function.__doc__ or "").splitlines()[0])
    parameters = []
    for parameter in split(signature[1]):
        word, _, kind = parameter.partition(": ")
        parameters.append("self" if owner and not parameters else f"{word}: {taken(kind)}" if kind else "*args: object")
    if name == "__eq__":
        parameters = ["self", "other: object"]
    if len(parameters) > bool(owner) and not parameters[-1].startswith("*") and name != "__eq__":
        parameters.append("/")
    return wrapped(name, parameters, NARROWER.get(f"{owner}.{name}", returned(signature[2])), indent)


def of_python(name, function, plain, indent="    "):
    """One declaration, or several of a method with overloads."""
    source = inspect.unwrap(function)
    several = typing.get_overloads(source)
    lines = []
    for one in several or [source]:
        signature = inspect.signature(one)
        names = source.__globals__
        parameters = [
            str(parameter.replace(annotation=inspect.Parameter.empty)) if parameter.annotation is inspect.Parameter.empty
            else str(parameter.replace(annotation=plain(parameter.annotation, names))).replace("'", "")
            for parameter in signature.parameters.values()
        ]  # fmt: skip
        first_named = next((i for i, p in enumerate(signature.parameters.values()) if p.kind is p.KEYWORD_ONLY), None)
        if first_named is not None:
            parameters.insert(first_named, "*")
        parameters = [re.sub(r'=(\s*)(\w[\w-]*)$', lambda found: found[0] if known(found[2]) else f'={found[1]}"{found[2]}"', one)
                      for one in parameters]
        if several:
            lines.append(f"{indent}@overload")
        lines += wrapped(name, parameters, plain(signature.return_annotation, names), indent)
    return lines


def known(word):
    return word in ("None", "True", "False") or word[0].isdigit()


def of_rule(cls):
    """A class of strategies: attributes that are keywords of its constructor."""
    default = cls()
    kinds = {}
    for name, member in vars(cls).items():
        if isinstance(member, property):
            words = re.findall(r'"[^"]+"', member.__doc__ or "")
            kinds[name] = f"Literal[{', '.join(words)}]" if words else type(getattr(default, name)).__name__
    before = [f"other: Optional[{cls.__name__}] = None"] if "other" in inspect.signature(cls).parameters else []
    keywords = [f"{name}: {kind} = ..." for name, kind in kinds.items()]
    lines = wrapped("__init__", ["self", *before, "*", *keywords], "None", "    ")
    return [*lines, *(f"    {name}: {kind}" for name, kind in kinds.items())]


def of_class(cls, plain):
    owner, lines = cls.__name__, []
    is_rule = inspect.isfunction(vars(cls).get("__init__")) and any(
        isinstance(member, property) and member.fset for member in vars(cls).values()
    )
    if is_rule:
        lines += of_rule(cls)
    for name, member in vars(cls).items():
        if name in NOT_SHOWN or (is_rule and (name == "__init__" or isinstance(member, property))):
            continue
        if name == "__hash__" and member is None:
            lines.append("    __hash__: ClassVar[None]  # type: ignore[assignment]")
        elif isinstance(member, property):
            kind = re.search(r"-> (.*)", member.fget.__doc__.splitlines()[0])[1]
            lines += ["    @property", f"    def {name}(self) -> {NARROWER.get(f'{owner}.{name}', returned(kind))}: ..."]
        elif isinstance(member, classmethod):
            lines += ["    @classmethod", *of_python(name, member.__func__, plain)]
        elif isinstance(member, staticmethod):
            lines += ["    @staticmethod", *of_cpp("", name, member.__func__, "    ")]
        elif name == "__eq__" and inspect.isfunction(member):
            lines.append("    def __eq__(self, other: object) -> bool: ...")
        elif inspect.isfunction(member):
            lines += of_python(name, member, plain)
        elif callable(member) and re.match(r"\w+\(", getattr(member, "__doc__", None) or ""):
            lines += of_cpp(owner, name, member, "    ")
    return ["", f"class {owner}:", *lines]


def stub(folder):
    sys.path.insert(0, str(folder))
    module = importlib.import_module("lamella._lamella")
    arguments = importlib.import_module("lamella._arguments")
    lines = ["", "__version__: str"]
    for name, thing in vars(module).items():
        if inspect.isclass(thing):
            lines += of_class(thing, arguments.plain)
        elif inspect.isbuiltin(thing):
            lines += of_cpp("", name, thing, "")
    words = set(re.findall(r"(?<!\.)\b\w+", "\n".join(lines)))
    head = [
        '"""Interface of the extension. The classes are public; functions are wrapped by the package."""', "",
        "# Printed by tools/python_stub.py.", "",
        f"from typing import {', '.join(sorted(words & set(typing.__all__)))}", "",
        "import numpy as np", "import numpy.typing as npt", "",
    ]  # fmt: skip
    local = words - set(typing.__all__) - set(vars(module))
    for source in ("_arguments", "_pixels", "_printing", "_methods"):
        names = vars(importlib.import_module(f"lamella.{source}"))
        found = sorted(word for word in local if word in names and word[0].isupper())
        if found:
            head.append(f"from .{source} import {', '.join(found)}")
            local -= set(found)
    return "\n".join([*head, *lines]) + "\n"


if __name__ == "__main__":
    print(stub(sys.argv[1] if len(sys.argv) > 1 else "build/python"), end="")
