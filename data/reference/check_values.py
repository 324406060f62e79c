"""Make check_values.csv: contact states, each the double nearest to a certified enclosure, with
condition numbers.

    python -m data.reference.check_values [--count N] [-o FOLDER]

The file holds its inputs; its values are made from them again, and the file is written anew (the
first N of them with --count).  A condition number is the relative error that one of 1 in each input
makes.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from flint import arb
from tqdm import tqdm

from pipeline import stage
from pipeline.evidence.truth.enclosures import INPUTS, condition_numbers, contact_enclosure
from pipeline.evidence.truth.reference import VALUES

FIELDS = ("lam", "zeta", "epsilon", "delta_star", "beta", "Q", "M")
CONDITIONED = ("epsilon", "delta_star", "beta", "Q", "M")


def value_row(row: dict[str, Any]) -> dict[str, Any]:
    """Inputs, values and condition numbers of one state."""
    state = {name: row[name] for name in INPUTS}
    values = contact_enclosure(**state)
    conditions = condition_numbers({name: arb(abs(value)) for name, value in state.items()})
    found = {"full_slip": int(values["full_slip"])} | {name: float(values[name]) for name in FIELDS}
    return (
        state
        | found
        | {f"condition_{name}": float(f"{conditions[name]:.2e}") for name in CONDITIONED}
    )


def make(folder: Path, count: int | None) -> None:
    """Write the file again.

    folder: where to.
    count: states, the first ones; None for all.
    """
    rows = [value_row(row) for row in tqdm(stage.read_rows(VALUES)[:count], "states", leave=False)]
    stage.write_rows(stage.make_folder(folder) / VALUES.name, rows)


def main() -> int:
    """Make the file."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--count", type=int)
    parser.add_argument("-o", "--output", type=Path, default=VALUES.parent)
    arguments = parser.parse_args()
    return stage.told("check_values", lambda: make(arguments.output, arguments.count))


if __name__ == "__main__":
    sys.exit(main())
