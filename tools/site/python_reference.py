"""The page of the Python module: every public name with its signature and its docstring."""

import importlib
import inspect
import re
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
    """Returns the lines of a signature. Empty for properties and for C++ functions, whose docstrings contain it."""
    try:
        found = inspect.signature(thing) if callable(thing) else None
    except ValueError:
        found = None
    if found is None:
        return []
    parts = [unquoted(part) for part in str(found)[1:].rsplit(")", 1)]
    text = f"{name}({parts[0]}){parts[1]}"
    if len(text) > 100:
        text = f"{name}(\n" + "".join(f"    {line},\n" for line in parameters(found)) + f"){parts[1]}"
    return ["```python", text, "```", ""]


def parameters(found):
    """Yields the parameters, with a star before those that must be passed by name."""
    starred = False
    for parameter in found.parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not starred:
            starred = True
            yield "*"
        yield unquoted(str(parameter))


def unquoted(text):
    """Returns a parameter without the quotes around its annotation."""
    return re.sub(r"(: |-> )'([^']*)'", r"\1\2", text)


def documented(thing):
    """Returns the docstring. Lines that begin with names and a colon describe arguments: each becomes a list item."""
    if not (callable(thing) or inspect.isdatadescriptor(thing)):
        return []
    lines = []
    for line in (inspect.getdoc(thing) or "").splitlines():
        argument = re.match(r"(\w+(?:, \w+)*): ", line)
        if argument:
            if lines and lines[-1] and not lines[-1].startswith(("- ", "  ")):
                lines.append("")
            line = f"- **{argument[1]}**: {line[argument.end():]}"
        elif line and lines and lines[-1].startswith(("- ", "  ")):
            line = f"  {line}"
        lines.append(line)
    return [*lines, ""]
