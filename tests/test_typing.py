"""What type checkers see of the public interface; what mypy says of a user's script: tests/typing,
`make check`.
"""

import ast

from places import ROOT

import viscoroll as vr


def test_checkers_see_what_python_loads():
    """``__init__.py`` takes its names from the stub: a line each, exported."""
    _, *lines = ast.parse((ROOT / "src/viscoroll/__init__.pyi").read_text()).body
    names = [name for line in lines if isinstance(line, ast.ImportFrom) for name in line.names]
    assert all(name.asname == name.name for name in names)
    assert sorted(vr.__all__) == sorted(["__version__", *(name.name for name in names)])
