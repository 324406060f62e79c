"""Where the repository lies, for tests in any folder."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
PIPELINE, DATA, DOCS = ROOT / "pipeline", ROOT / "data", ROOT / "docs"
RESULTS = DATA / "results"
