"""Where the repository lies, for tests in any folder."""

import json
from pathlib import Path

ROOT = Path(__file__).parents[1]
DATA = ROOT / "data"
DOCS = ROOT / "docs"
RESULTS = DATA / "results"


def kept(name):
    """Results that are committed."""
    return json.loads((RESULTS / name).read_text())


def content(folder):
    """Every file under a folder: its path there, and its bytes."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }
