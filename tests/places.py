"""Where the repository lies and its stages, for tests in any folder."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
PIPELINE, DATA, DOCS = ROOT / "pipeline", ROOT / "data", ROOT / "docs"
RESULTS = DATA / "results"


def script(name: str) -> Path:
    """The one script of the pipeline of that name, in whatever room."""
    (found,) = PIPELINE.rglob(f"{name}.py")
    return found
