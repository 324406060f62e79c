"""One picture: python -m pipeline.figures NAME -o FILE."""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path

import matplotlib as mpl

from viscoroll import ModelWarning
from viscoroll.plots.style import save

from . import FIGURES


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m pipeline.figures")
    parser.add_argument("name", choices=[name for name in FIGURES if name != "ensemble"])
    parser.add_argument("-o", "--output", type=Path, required=True)
    arguments = parser.parse_args()
    mpl.use("agg")
    warnings.simplefilter("ignore", ModelWarning)  # the paper's cylinder, of which its pages say so
    save(FIGURES[arguments.name](), arguments.output)


if __name__ == "__main__":
    main()
