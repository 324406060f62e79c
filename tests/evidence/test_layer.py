"""How thick a layer has to be: its kernel by elasticity, both ends of thickness, and what the page
says.
"""

import json
import re

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from places import DOCS

from data.reference import layer
from viscoroll.contact_mechanics.assumptions import THICK_LIMIT


@pytest.mark.parametrize("nu", layer.RATIOS)
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
    rows = json.loads(layer.TARGET.read_text())["rows"]
    assert [row["nu"] for row in rows] == list(layer.RATIOS)
    page = (DOCS / "validity_covers.md").read_text()
    cells = [
        re.findall(r"[\d.]+", line)
        for line in re.findall(r"^\| \d\.\d+ \|(?: \d\.\d\d \|)+$", page, re.M)
    ]
    stated = [list(map(float, line)) for line in cells if len(line) == 2 + len(layer.LENGTHS)]
    assert stated == [
        [row["nu"], *(round(v, 2) for v in (*row["shorter"].values(), row["limit"]))]
        for row in rows
    ]
    assert close(layer.longest(0.5), rows[-1]["limit"], tol.LAYER_KEPT)
    assert close(layer.shorter(0.3, 2.0), rows[0]["shorter"]["2"], tol.LAYER_KEPT)
    least = min(row["limit"] for row in rows)
    assert 0.95 * least <= THICK_LIMIT <= least
