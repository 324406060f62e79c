"""Coverage-guided fuzzing of the loaders: TOML scenes and materials (io/config.py), and tables (io/tables/store.py).

    python -m pipeline.evidence.torture.fuzz_loaders toml|table [--seconds N] [--corpus FOLDER]

Whatever the bytes, a loader returns or raises one of the package's own errors, in one line.  Anything
else is a finding: exit code 77 of libFuzzer, and the input in ./crash-*.  Wants atheris (pip install
-e '.[fuzz]'); without it says so and ends well.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

SCENES = (
    b'preset = "paper-section-5"\n',
    b"[scene]\nalpha = 11\nkappa = 2.91\nmu = 0.2\ngamma = 1.1e4\nj = 0.5\n",
    b"[cylinder]\nR = 0.1\nm = 35.5\nE = 2e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 1\nmu = 0.2\nplane = 'stress'\n",
    b"[material]\nE = 3e6\nnu = 0.5\nprony = { E = [0.3, 0.6], tau = [2e-2, 1e-3] }\n[base]\nE = 2e11\nnu = 0.3\n",
)
#: bytes of the largest input: a small table
LONGEST = 1 << 17


def readers(what: str) -> tuple[Callable[[Path], Any], ...]:
    if what == "toml":
        from viscoroll.io.config import read_bodies, read_body

        return read_body, read_bodies
    from viscoroll import load_law
    from viscoroll.io.tables import load

    return load, load_law


def seeds(what: str, folder: Path) -> None:
    """Files that the fuzzer starts from."""
    if what == "toml":
        for n, content in enumerate(SCENES):
            (folder / f"{n}.toml").write_bytes(content)
    else:
        from viscoroll.io.tables import build, law, save
        from viscoroll.presets import RUBBER_CYLINDER

        save(build(RUBBER_CYLINDER, [0.1, 0.2], [0.0, 0.01]), folder / "grid")
        save(law(11.0), folder / "law")


def fuzz(what: str, seconds: int, corpus: Path) -> None:
    """Never returns: libFuzzer ends the process."""
    import atheris

    with atheris.instrument_imports(include=["viscoroll", "tomllib", "h5netcdf"]):
        from viscoroll import ViscorollError

        found = readers(what)
    seeds(what, corpus)
    path = Path(tempfile.mkdtemp()) / "input"

    def one(data: bytes) -> None:
        path.write_bytes(data)
        for read in found:
            try:
                read(path)
            except ViscorollError as error:
                if not str(error) or "\n" in str(error):
                    raise AssertionError(f"not one line: {error!r}") from error

    options = [f"-max_total_time={seconds}", f"-max_len={LONGEST}", "-timeout=20", "-rss_limit_mb=4096"]
    atheris.Setup([sys.argv[0], *options, str(corpus)], one)
    atheris.Fuzz()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("what", choices=("toml", "table"))
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument(
        "--corpus", type=Path, help="folder that keeps what was found worth keeping; default: none kept"
    )
    arguments = parser.parse_args()
    try:
        import atheris  # noqa: F401
    except ImportError:
        print("fuzz_loaders: skipped, atheris is not installed (pip install -e '.[fuzz]')")
        return 0
    corpus = arguments.corpus or Path(tempfile.mkdtemp())
    corpus.mkdir(parents=True, exist_ok=True)
    fuzz(arguments.what, arguments.seconds, corpus)
    return 0


if __name__ == "__main__":
    sys.exit(main())
