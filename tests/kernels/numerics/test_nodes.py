"""Nodes, weights and matrices of polynomials; what is computed with them is claimed in ``test_claims.py``."""

from __future__ import annotations

import decimal

import numpy as np

<<<<<<< HEAD
from viscoroll.kernels.numerics.nodes import Interpolation, gauss, radau, to_chebyshev
=======
from viscoroll.kernels.numerics.nodes import Interpolation, chebyshev, gauss, radau, rounded, to_chebyshev

KINDS = {"left": lambda n: radau(n, -1), "right": lambda n: radau(n, 1), "chebyshev": chebyshev}


@pytest.fixture(autouse=True)
def many_digits():
    with mp.workdps(60):
        yield


def same(found: np.ndarray, exact: list) -> bool:
    """Whether these are the nearest doubles; what is zero need be zero to 30 digits only."""
    wanted = np.array(exact, dtype=object).astype(float).reshape(found.shape)
    return np.array_equal(*(np.where(np.abs(each) < 1e-30, 0.0, each) for each in (found, wanted)))


def zeros(function, n: int) -> list[mp.mpf]:
    """Of a polynomial of degree n with zeros in [-1, 1] only: between the changes of sign on a fine grid."""
    grid = [-mp.cos(mp.pi * mp.mpf(k) / (40 * n + 1)) * (1 + mp.mpf(10) ** -30) for k in range(40 * n + 2)]
    signs = [mp.sign(function(x)) for x in grid]
    ends = [(a, b) for a, b, s, t in zip(grid, grid[1:], signs, signs[1:]) if s != t]
    return [mp.findroot(function, each, solver="anderson", tol=1e-110, maxsteps=200) for each in ends]


def exact_nodes(kind: str, n: int) -> list[mp.mpf]:
    if kind == "chebyshev":
        return [-mp.cos(mp.pi * (2 * k + 1) / (2 * n)) for k in range(n)]
    sign = 1 if kind == "left" else -1
    return zeros(lambda x: mp.legendre(n, x) + sign * mp.legendre(n - 1, x), n)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("n", [1, 2, 5, 8, 9, 12])
def test_nodes(kind, n):
    found = rounded(KINDS[kind](n))
    assert same(found, exact_nodes(kind, n))
    if kind == "chebyshev" and n % 2:
        assert found[n // 2] == 0.0


@pytest.mark.parametrize("n", [1, 5, 28])
def test_gauss_rule(n):
    x, weights = gauss(n)
    exact = zeros(lambda t: mp.legendre(n, t), n) if n > 1 else [mp.mpf(0)]
    slopes = [n * (mp.legendre(n - 1, t) - t * mp.legendre(n, t)) / (1 - t * t) for t in exact]
    assert same(x, [(1 + t) / 2 for t in exact])
    assert same(weights, [1 / ((1 - t * t) * s**2) for t, s in zip(exact, slopes)])


@pytest.mark.parametrize("kind", KINDS)
def test_matrices(kind):
    """Of monomials: powers from the inverse of Vandermonde's matrix, the rest by differentiation and integration."""
    n = 9
    rule = Interpolation(KINDS[kind](n))
    nodes = [mp.mpf(str(x)) for x in rule.exact]
    inverse = mp.matrix([[x**k for k in range(n)] for x in nodes]) ** -1
    assert same(rule.powers(), inverse.tolist())
    points = [decimal.Decimal(-1), decimal.Decimal("0.3"), *rule.exact[1:]]
    x = [mp.mpf(str(point)) for point in points]
    wanted = {
        rule.values: [[t**k for k in range(n)] for t in x],
        rule.slopes: [[k * t ** max(k - 1, 0) for k in range(n)] for t in x],
        rule.integrals: [[(t ** (k + 1) - mp.mpf(-1) ** (k + 1)) / (k + 1) for k in range(n)] for t in x],
    }
    for matrix, monomials in wanted.items():
        assert same(matrix(points), (mp.matrix(monomials) * inverse).tolist())
>>>>>>> 76eadbe9 (The modes' formulas stand once, for values, slopes and N, by jets; fours have operators; readers of rows give value and slope in one; states are one loop, and an engine serves laws with and without N)


def test_digits_do_not_depend_on_the_caller():
    """Whoever imports may have set another precision."""
    with decimal.localcontext(decimal.Context(prec=3, rounding=decimal.ROUND_UP)):
        low = Interpolation(radau(9, 1)).powers(), *gauss(28), to_chebyshev(9)
    high = Interpolation(radau(9, 1)).powers(), *gauss(28), to_chebyshev(9)
    assert all(np.array_equal(a, b) for a, b in zip(low, high, strict=True))
