"""Blocks made from the code: layers and their imports, commands, keys of files; nothing is
measured.
"""

from __future__ import annotations

import argparse
import ast
import inspect
import re
import tomllib
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
from msgspec import inspect as schema

import viscoroll as vr
from viscoroll.cli.program import parser
from viscoroll.materials.material_toml import MaterialSection
from viscoroll.roller_toml import CylinderSection, SceneSection
from viscoroll.runs.run_rollers import RUN_SECTIONS
from viscoroll.runs.runfile import RunSection

from ...stage import ROOT
from ..results import Results, table

_PACKAGE = ROOT / "src/viscoroll"
#: sections of a TOML file: what reads them, and whose parameters they hold
_SECTIONS: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "[scene]": (SceneSection, (vr.Scene,)),
    "[cylinder]": (CylinderSection, (vr.Cylinder,)),
    "[material], [base]": (MaterialSection, (vr.Material,)),
    "[run]": (RunSection, ()),
} | {f"[{name}]": (keys, (vr.roll,)) for name, keys in RUN_SECTIONS.items()}
#: a role of reStructuredText, or a literal, which Markdown writes between single backticks
_ROLE = re.compile(r"(?::\w+:`|``)\.?([^`]+)``?")
_KINDS = {
    schema.FloatType: "number",
    schema.IntType: "whole number",
    schema.BoolType: "true or false",
    schema.StrType: "text",
}


def rooms(results: Results) -> str:
    """The picture: a box a room, by the layers of the import contract, with the rooms that its
    files import.
    """
    contract = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"][
        "importlinter"
    ]
    layers = [name.removeprefix("viscoroll.") for name in contract["contracts"][0]["layers"]]
    lines = []
    for name in layers:
        place = _PACKAGE / name
        files = sorted(place.rglob("*.py")) if place.is_dir() else [place.with_suffix(".py")]
        about = ast.get_docstring(
            ast.parse((place / "__init__.py" if place.is_dir() else files[0]).read_text("utf-8"))
        )
        stands_on = {room for file in files for room in _imported(file)} - {name}
        size = f"{len(files)} files" if place.is_dir() else ""
        below = ", ".join(room for room in layers if room in stands_on)
        lines += [
            f"{name + ('/' if place.is_dir() else ''):<14}{size:>10}   {about.splitlines()[0]}"
        ]
        lines += [f"{'':27}-> {below}"] if below else []
    return "```text\n" + "\n".join(lines) + "\n```\n"


def _imported(file: Path) -> Iterator[str]:
    """The rooms that a file imports from, by their names below the package."""
    package = file.relative_to(_PACKAGE).parts[:-1]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            path = [*package[: len(package) - node.level + 1], *(node.module or "").split(".")]
            yield from (path[0],) if path[0] else (name.name for name in node.names)


def commands(results: Results, *names: str) -> str:
    """A heading for every command of these names, and the text of its --help below the usage."""
    texts = (text for name, text in _commands(parser()) if name.split()[1] in names)
    return "\n".join(texts)


def _commands(program: Any) -> Iterator[tuple[str, str]]:
    """Yield (name, text) of every command below a parser."""
    below = [
        action for action in program._actions if isinstance(action, argparse._SubParsersAction)
    ]
    if not below:
        program.formatter_class = partial(program.formatter_class, width=76)
        program.color = False
        _, _, said = program.format_help().partition("\n\n")
        yield program.prog, f"## {program.prog}\n\n```text\n{said}```\n"
    for action in below:
        for command in action.choices.values():
            yield from _commands(command)


def sections(results: Results, *wanted: str) -> str:
    """A heading and a table of keys for each of these sections of a TOML file."""
    lines = []
    for names in wanted:
        section, meant = _SECTIONS[names]
        meanings: dict[str, str] = {}
        for each in (*meant, section):  # the section knows its keys best
            meanings |= _parameters(each)
        rows = [
            (f"`{field.name}`", _kind(field.type), _default(field), meanings.get(field.name, ""))
            for field in schema.type_info(section).fields
            if not isinstance(field.type, schema.NoneType)
        ]
        lines += [f"## {names}\n", table(("key", "type", "default", "meaning"), rows)]
    return "\n".join(lines)


def _parameters(thing: Any) -> dict[str, str]:
    """What a docstring says of each of its parameters, without the paragraphs that follow."""
    text = inspect.getdoc(thing) or ""
    found = re.findall(r"(?m)^(\w+(?:, \w+)*) : (.*(?:\n    .*)*)", text)
    return {
        name: _ROLE.sub(r"`\1`", " ".join(words.split("\n\n")[0].split())).replace("|", "\\|")
        for names, words in found
        for name in names.split(", ")
    }


def _kind(kind: Any) -> str:
    """A type in words."""
    if isinstance(kind, schema.UnionType):
        return " or ".join(
            _kind(each) for each in kind.types if not isinstance(each, schema.NoneType)
        )
    if isinstance(kind, schema.LiteralType):
        return ", ".join(f'"{each}"' for each in kind.values)
    if isinstance(kind, schema.ListType | schema.VarTupleType):
        return "list of names" if isinstance(kind.item_type, schema.StrType) else "list of numbers"
    if fields := getattr(kind, "fields", None):
        return "{ " + ", ".join(each.name for each in fields) + " }"
    return _KINDS[type(kind)]


def _default(field: schema.Field) -> str:
    """The default of a key as a file would say it; empty where there is none."""
    if field.required:
        return ""
    return "-" if field.default is None else f"`{msgspec.json.encode(field.default).decode()}`"
