"""What type checkers see of the public interface."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys

from places import ROOT

import viscoroll as vr

SCRIPTS = ROOT / "tests/typing"


def test_mypy_finds_each_mistake_of_a_user_and_no_other(tmp_path):
    """Strict, with the settings of somebody who has none; what mypy finds in numpy is kept for the next time.

    Only of what the user wrote, as where a package is installed: newer mypy and numpy find more in the package itself.
    """
    command = [sys.executable, "-m", "mypy", "--strict", "--no-pretty", "--config-file=", "--follow-imports=silent"]
    command += ["--cache-dir", ROOT / ".mypy_cache/tests"]
    done = subprocess.run(
        [*command, SCRIPTS / "mistakes.py", SCRIPTS / "right.py"], cwd=tmp_path, capture_output=True, text=True,
        env=os.environ | {"MYPYPATH": str(ROOT / "src")}, check=False,
    )  # fmt: skip
    found = [(name, int(line)) for name, line in re.findall(r"(\w+\.py):(\d+): error", done.stdout)]
    lines = (SCRIPTS / "mistakes.py").read_text(encoding="utf-8").splitlines()
    planted = [("mistakes.py", n) for n, line in enumerate(lines, 1) if "# wrong" in line]
    assert len(planted) == 10
    assert found == planted, done.stdout


def test_checkers_and_python_see_the_same_names():
    """``__init__.pyi`` names for the one what ``__init__.py`` loads for the other."""
    stub = ast.parse((ROOT / "src/viscoroll/__init__.pyi").read_text(encoding="utf-8"))
    homes = {}
    for node in stub.body:
        if isinstance(node, ast.ImportFrom):
            for name in node.names:
                assert name.asname == name.name  # else it is not exported
                homes[name.name] = node.module
    modules = {name: f"{homes.pop(name) or ''}.{name}".lstrip(".") for name in vr._MODULES}
    assert (homes, modules) == (vr._HOME, vr._MODULES)
    assert set(vr.__all__) == homes.keys() | modules.keys() | {"__version__"}
