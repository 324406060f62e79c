"""How thick a layer has to be: its kernel by elasticity, both ends of thickness, and what the page
says.
"""

import json

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from many import assert_covers_are_each
from places import DATA, DOCS

import viscoroll as vr
from pipeline.evidence.prove import layer
from viscoroll.contact_mechanics.assumptions import THICK_LIMIT

ROWS = json.loads((DATA / "reference/layer.json").read_text())["rows"]


@pytest.mark.parametrize("nu", [row["nu"] for row in ROWS])
def test_a_thick_layer_is_a_half_space(nu):
    """f - 1 = c/(2 h^2), c the integral of (1 - L) u: the layer takes a part of the curvature."""
    u = np.linspace(0.0, 20.0, 20001)
    c = np.trapezoid((1.0 - layer.kernel(u, nu)) * u, u)
    h = 100.0
    assert close(layer.load(h, nu) - 1.0, 0.5 * c / h**2, tol.LAYER_THICK)


def test_the_page_states_what_is_kept():
    """And what is kept is what is computed; validity takes the least of the limits, rounded
    down.
    """
    page = (DOCS / "validity_covers.md").read_text()
    for row in ROWS:
        numbers = *row["shorter"].values(), row["limit"]
        assert f"| {row['nu']} | {' | '.join(f'{v:.2f}' for v in numbers)} |\n" in page
        kept = [(float(length), by) for length, by in row["shorter"].items()]
        kept.append((row["limit"], 0.95))
        for length, by in kept:
            assert close(layer.load(2.0 / (length * by), row["nu"]) * by**2, 1.0, tol.LAYER_KEPT)
    least = min(row["limit"] for row in ROWS)
    assert 0.95 * least <= THICK_LIMIT <= least


def test_covers_that_relax_between_nodes():
    """Laws interpolated over thickness are those of each; of elastic ones: test_covers.py."""
    series = vr.Prony([10.0], [1.0])
    assert_covers_are_each(vr.Cover(series, nu=0.3, thickness=[0.52, 0.6], on="base"))
