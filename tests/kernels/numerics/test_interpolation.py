"""Nodes, weights and matrices of polynomials; what is computed with them is claimed in
``test_claims.py``.
"""

import decimal

import numpy as np

from viscoroll.kernels.numerics.interpolation import Interpolation, gauss, radau, to_chebyshev


def test_digits_do_not_depend_on_the_caller():
    """Whoever imports may have set another precision."""

    def digits():
        return Interpolation(radau(9)).powers(), *gauss(28), to_chebyshev(9)

    with decimal.localcontext(decimal.Context(prec=3, rounding=decimal.ROUND_UP)):
        low = digits()
    np.testing.assert_equal(low, digits())
