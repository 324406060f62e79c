"""Blocks of pages of the documentation, and sessions that run them."""

import re

from places import ROOT


def blocks(path, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", path.read_text(), re.DOTALL | re.MULTILINE)


def run_page(name):
    """Execute the blocks of Python of a page of docs, in one session, which is returned."""
    session = {}
    for n, code in enumerate(blocks(ROOT / f"docs/{name}.md", "python")):
        exec(compile(code, f"{name}.md, block {n + 1}", "exec"), session)
    return session
