"""Blocks made from the code: its size, layers and their imports, commands, keys of files; nothing
is measured.
"""

import argparse
import ast
import inspect
import re
import tokenize
import tomllib
from functools import cache, partial
from pathlib import Path

import msgspec
from msgspec import inspect as schema

import viscoroll as vr
from viscoroll.cli import parser
from viscoroll.materials.material_toml import MaterialSection
from viscoroll.presets import CylinderSection, SceneSection
from viscoroll.runs.run_rollers import RUN_SECTIONS
from viscoroll.runs.runfile import RunSection

from ...stage import ROOT
from ..results import table

# --- size in tokens: names, numbers, operators and strings, without docstrings ---

COUNTED = (tokenize.NAME, tokenize.NUMBER, tokenize.OP, tokenize.STRING)
#: Tokens before the first one of a statement: a string that follows them, alone, is a docstring.
STARTS = (tokenize.ENCODING, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
#: Columns of the second table, and the folders that each of them counts.
KINDS = {"source": ("src",), "tests": ("tests",), "evidence": ("pipeline",)}


def count_tokens(path: Path) -> int:
    """Return the number of tokens of code in a Python file, without those of docstrings.

    path: of the file.
    """
    with path.open("rb") as file:
        kinds = [
            t.type
            for t in tokenize.tokenize(file.readline)
            if t.type not in (tokenize.COMMENT, tokenize.NL)
        ]
    pairs = zip([tokenize.NEWLINE, *kinds], kinds)
    return sum(
        kind in COUNTED and not (kind == tokenize.STRING and before in STARTS)
        for before, kind in pairs
    )


@cache
def sizes() -> dict[str, int]:
    """Return the tokens of every Python file of the tree by its path below the root."""
    folders = [ROOT / folder for kind in KINDS.values() for folder in kind]
    paths = (path for folder in folders for path in sorted(folder.rglob("*.py")))
    return {path.relative_to(ROOT).as_posix(): count_tokens(path) for path in paths}


def folder_costs(_, folders):
    """Yield a row for each folder: its files, its tokens, and these over those of the first, which
    is what users call.

    folders: path below the root -> what it contains.
    """
    counts = {
        folder: [size for path, size in sizes().items() if path.startswith(folder)]
        for folder in folders
    }
    called = sum(counts[next(iter(folders))])
    for folder, own in counts.items():
        row = {"folder": folder, "content": folders[folder], "files": len(own), "tokens": sum(own)}
        yield row | {"share": sum(own) / called}


def capability_costs(_, capabilities):
    """Yield a row for each capability: tokens of what users call, of tests and of evidence.

    A file belongs to the first capability that has a word of its path; the last one has the empty
    word.

    capabilities: name -> words.
    """
    rows = {name: dict.fromkeys(KINDS, 0) for name in capabilities}
    for path, size in sizes().items():
        owner = next(
            name for name, words in capabilities.items() if any(word in path for word in words)
        )
        rows[owner][next(kind for kind, folders in KINDS.items() if path.startswith(folders))] += (
            size
        )
    for name, row in rows.items():
        yield row | {"name": name, "ratio": (row["tests"] + row["evidence"]) / row["source"]}


# --- layers, commands, keys ---

_PACKAGE = ROOT / "src/viscoroll"
#: sections of a TOML file: what reads them, and whose parameters they hold
_SECTIONS = {
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


def rooms(results):
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


def _imported(file):
    """The rooms that a file imports from, by their names below the package."""
    package = file.relative_to(_PACKAGE).parts[:-1]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            path = [*package[: len(package) - node.level + 1], *(node.module or "").split(".")]
            yield from (path[0],) if path[0] else (name.name for name in node.names)


def commands(results, *names):
    """A heading for every command of these names, and the text of its --help below the usage."""
    texts = (text for name, text in _commands(parser()) if name.split()[1] in names)
    return "\n".join(texts)


def _commands(program):
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


def sections(results, *wanted):
    """A heading and a table of keys for each of these sections of a TOML file."""
    lines = []
    for names in wanted:
        section, meant = _SECTIONS[names]
        meanings = {}
        for each in (*meant, section):  # the section knows its keys best
            meanings |= _parameters(each)
        rows = [
            (f"`{field.name}`", _kind(field.type), _default(field), meanings.get(field.name, ""))
            for field in schema.type_info(section).fields
            if not isinstance(field.type, schema.NoneType)
        ]
        lines += [f"## {names}\n", table(("key", "type", "default", "meaning"), rows)]
    return "\n".join(lines)


def _parameters(thing):
    """What a docstring says of each of its parameters, without the paragraphs that follow."""
    text = inspect.getdoc(thing) or ""
    # a meaning goes on to the next parameter or an empty line, however its lines are indented
    found = re.findall(r"(?m)^(\w+(?:, \w+)*) : (.*(?:\n(?!\w+(?:, \w+)* : )[^\n]+)*)", text)
    return {
        name: _ROLE.sub(r"`\1`", " ".join(words.split("\n\n")[0].split())).replace("|", "\\|")
        for names, words in found
        for name in names.split(", ")
    }


def _kind(kind):
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


def _default(field):
    """The default of a key as a file would say it; empty where there is none."""
    if field.required:
        return ""
    return "-" if field.default is None else f"`{msgspec.json.encode(field.default).decode()}`"
