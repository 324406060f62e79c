"""Headers of C in the hands of a compiler."""

import ctypes
import shutil
import subprocess

import pytest

needs_cc = pytest.mark.skipif(shutil.which("cc") is None, reason="not installed: cc")


def compiled(folder, name, text):
    """The functions of a program of C, compiled in the folder of the headers that it includes."""
    (folder / f"{name}.c").write_text(text)
    command = f"cc -std=c99 -Wall -Wextra -Werror -O2 -shared -fPIC {name}.c -lm -o {name}.so"
    subprocess.run(command.split(), cwd=folder, check=True)
    return ctypes.CDLL(str(folder / f"{name}.so"))
