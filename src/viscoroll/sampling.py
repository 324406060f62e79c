"""Random starts and parameters, from scipy.stats distributions and a recorded seed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .errors import ParameterError

DESIGNS = ("random", "latin", "sobol")


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
    n : number of draws, >= 1; powers of two suit "sobol".
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
        Bad n, seed or design, or a quantity that is neither.
    """
    from scipy.stats import qmc

    if not (isinstance(n, (int, np.integer)) and n >= 1):
        raise ParameterError("n", n, "a whole number >= 1")
    if not (isinstance(seed, (int, np.integer)) and seed >= 0):
        raise ParameterError("seed", seed, "a whole number >= 0")
    if design not in DESIGNS:
        raise ParameterError("design", repr(design), "out of " + ", ".join(DESIGNS))
    random = [name for name, value in quantities.items() if hasattr(value, "ppf")]
    for name, value in quantities.items():
        if name not in random and not (np.ndim(value) == 0 and np.isreal(value) and np.isfinite(value)):
            raise ParameterError(name, value, "a finite number or a frozen scipy.stats distribution")
    generator = np.random.default_rng(seed)
    if design == "random" or not random:
        points = generator.random((n, len(random)))
    elif design == "latin":
        points = qmc.LatinHypercube(len(random), rng=generator).random(n)
    else:
        points = qmc.Sobol(len(random), rng=generator).random_base2(int(np.ceil(np.log2(n))))[:n]
    columns = {
        name: np.asarray(value.ppf(points[:, random.index(name)]) if name in random else np.full(n, float(value)))
        for name, value in quantities.items()
    }
    return Sample(columns, int(seed), design)
