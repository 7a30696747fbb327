"""The page of the Python module: every public name with its signature and its docstring."""

import importlib
import inspect
import sys


def write_page(package_folder, path):
    sys.path.insert(0, str(package_folder))
    module = importlib.import_module("lamella")
    text = ["# Python reference", "", inspect.getdoc(module) or "", ""]
    for name in sorted(module.__all__, key=lambda name: (not inspect.isfunction(getattr(module, name)), name.lower())):
        text += entry(name, getattr(module, name))
    path.write_text("\n".join(text), encoding="utf-8")


def entry(name, thing):
    text = [f"## {name}", ""]
    if inspect.isclass(thing):
        text += [inspect.getdoc(thing) or "", ""]
        for member, value in sorted(vars(thing).items()):
            if member.startswith("_"):
                continue
            text += [f"### {name}.{member}", "", *signature(member, value), *documented(value)]
    else:
        text += [*signature(name, thing), *documented(thing)]
    return text


def signature(name, thing):
    """None for what cannot tell it: functions written in C++ say it in their docstrings, properties have none."""
    try:
        return ["```python", f"{name}{inspect.signature(thing)}", "```", ""] if callable(thing) else []
    except ValueError:
        return []


def documented(thing):
    return [inspect.getdoc(thing) or "", ""] if callable(thing) or inspect.isdatadescriptor(thing) else []
