"""Random starts and parameters, from scipy.stats distributions and a recorded seed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .checks import checked, number
from .errors import ParameterError, unknown

DESIGNS = ("random", "latin", "sobol")
#: bits of scipy's Sobol sequence, which has no more points
_SOBOL_BITS = 30


@dataclass(frozen=True)
class Sample(Mapping[str, NDArray]):
    """Named columns of n draws, with what is needed to draw them again."""

    columns: dict[str, NDArray[np.float64]]
    seed: int
    design: str

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]

    def __iter__(self) -> Any:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)


def sample(n: int, seed: int, design: Literal["random", "latin", "sobol"] = "random", **quantities: Any) -> Sample:
    """Draw n values of each named quantity, independent of each other.

    Parameters
    ----------
    n : number of draws, >= 1; powers of two suit "sobol", which has at most 2^30.
    seed : whole number >= 0, kept in the result.
    design : "random", "latin" (hypercube) or "sobol" (scrambled), of scipy.stats.qmc.
    **quantities : a number, or a frozen scipy.stats distribution, e.g.
        ``V0=scipy.stats.uniform(-1, 2)``; drawn through its inverse CDF.

    Returns
    -------
    Sample
        A mapping from name to array (n,).

    Raises
    ------
    ParameterError
        Bad n, seed or design, a quantity that is neither, a distribution without a median, a draw that overflows.

    Notes
    -----
    The same n, seed and design give the same bits; "latin" and "sobol" have one draw in each of n
    strata of every quantity, for "sobol" where n is a power of two (``tests/test_sampling.py``).
    """
    from scipy.stats import qmc

    for name, value, least in (("n", n, 1), ("seed", seed, 0)):
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            raise ParameterError(name, value, f"a whole number >= {least}")
    if design not in DESIGNS:
        raise unknown("design", design, DESIGNS, "a design")
    if design == "sobol" and n > 1 << _SOBOL_BITS:
        raise ParameterError("n", n, f"at most 2^{_SOBOL_BITS} for design 'sobol'")
    random = [name for name, value in quantities.items() if _is_distribution(name, value)]
    generator = np.random.default_rng(seed)
    if design == "random" or not random:
        points = generator.random((n, len(random)))
    elif design == "latin":
        points = qmc.LatinHypercube(len(random), rng=generator).random(n)
    else:
        points = qmc.Sobol(len(random), bits=_SOBOL_BITS, rng=generator).random_base2(int(np.ceil(np.log2(n))))[:n]
    # infinite draws come from the edge of the cube alone: of a Sobol sequence to the middle of the cell there
    points = np.clip(points, 2.0 ** -(_SOBOL_BITS + 1) if design == "sobol" else 2.0**-54, 1.0 - 2.0**-53)
    with np.errstate(all="ignore"):  # what overflows is infinite, and refused
        drawn = {
            name: checked(name, quantities[name].ppf(column)) for name, column in zip(random, points.T, strict=True)
        }
    columns = {name: drawn[name] if name in drawn else np.full(n, float(value)) for name, value in quantities.items()}
    return Sample(columns, int(seed), design)


@np.errstate(all="ignore")  # scipy may overflow on what is refused here
def _is_distribution(name: str, value: Any) -> bool:
    """Whether it is a distribution, else a number; raises ParameterError where it is neither."""
    random = hasattr(value, "ppf")
    try:
        number(name, value.ppf(0.5) if random else value)
    except (TypeError, ValueError):
        allowed = "a finite number or a frozen scipy.stats distribution"
        raise ParameterError(name, f"{value!s:.60}", allowed) from None
    return random
