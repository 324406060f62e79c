"""What type checkers see of the public interface; what mypy says of a user's script: tests/typing, `make check`."""

import ast

from places import ROOT

import viscoroll as vr


def test_checkers_and_python_see_the_same_names():
    """``__init__.pyi`` names for the one what ``__init__.py`` loads for the other."""
    stub = ast.parse((ROOT / "src/viscoroll/__init__.pyi").read_text())
    homes = {}
    for node in stub.body:
        if isinstance(node, ast.ImportFrom):
            for name in node.names:
                assert name.asname == name.name  # else it is not exported
                homes[name.name] = node.module
    modules = {name: f"{homes.pop(name) or ''}.{name}".lstrip(".") for name in vr._MODULES}
    assert (homes, modules) == (vr._HOME, vr._MODULES)
    assert set(vr.__all__) == homes.keys() | modules.keys() | {"__version__"}
