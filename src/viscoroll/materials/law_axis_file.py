"""The law of every alpha as a dataset and a file: of a :class:`LawAxis`, and back bit for bit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.checks import number
from ..core.errors import FileError, ParameterError
from .law_axis import FUNCTIONS, LawAxis
from .law_store import AXIS, MEANING_OF_AXIS, OTHERS_OF_AXIS, REMEDY, Content, sealed
from .law_table import LawTable
from .prony_forms import HIGHEST_ALPHA

if TYPE_CHECKING:
    import xarray as xr

_DIMENSIONS = 5
COMMENT = (
    "alpha = m 2^e with m in [1/2, 1) (frexp); i = e - 1 - first; s = 2 log2(2 m) - 1; c = (alpha - 1)/alpha. The table"
    " of that alpha is the sum over j of T_j(s) times [i, j], T_j Chebyshev's polynomials; epsilon, m and N come over "
    "c. It is read as the file of one material (viscoroll tables law MATERIAL.toml): x = m 2^e; row n = e - e0; "
    "n <= 0 or x = 0: row 0 at t = x 2^-e0; 0 < n < rows[i]: row n at t = 4 m - 3; beyond: the fast limit with W = c, "
    "C = c (ln 2 - 0.5772...). T_epsilon is the unit of time; both bodies take half of m."
)


def as_dataset(axis: LawAxis, errors: Mapping[str, float]) -> xr.Dataset:
    """All that a file holds; ``errors``: largest relative error by function."""
    import xarray as xr

    data, low_high = {}, "alpha = {:g} to {:g}".format(*axis.alpha)
    for n, (name, meaning) in enumerate(MEANING_OF_AXIS.items()):
        about = {"long_name": f"coefficients of T_j(s) and of powers of t: {meaning}"}
        dims = ("octave_of_alpha", "degree", "octave", "power")
        data[name] = xr.Variable(dims, axis.coefficients[..., n], about | {"largest_relative_error": errors[name]})
    for name, (others, meaning) in OTHERS_OF_AXIS.items():
        data[name] = xr.Variable(others, np.asarray(getattr(axis, name), np.int32), {"long_name": meaning})
    return sealed(data, AXIS, low_high, COMMENT)


def axis_of(content: Content, path: Any) -> LawAxis:
    """The axis of what was checked."""
    numbers = content.numbers
    try:
        whole = np.stack([numbers[name] for name in FUNCTIONS], axis=-1)
        rows = tuple(map(int, numbers["rows"]))
        found = LawAxis(whole, rows, int(numbers["first"]), int(numbers["e0"]))
    except (TypeError, ValueError) as error:
        raise FileError(path, f"is no whole law file ({' '.join(str(error).split()):.200}): {REMEDY}") from error
    if whole.ndim != _DIMENSIONS or len(rows) != len(whole):
        raise FileError(path, f"is no whole law file (functions of shape {whole.shape[:-1]}): {REMEDY}")
    whole.flags.writeable = False
    return found


def alpha_of(content: Content, alpha: float | None, path: Any) -> LawTable:
    """The law of one alpha; raises ParameterError of none, and of one that is not there."""
    axis = axis_of(content, path)
    low, high = axis.alpha
    if alpha is None or not low <= number("alpha", alpha, low=1.0, high=HIGHEST_ALPHA) <= high:
        wider = "`viscoroll tables law --alpha LOW:HIGH` writes others"
        raise ParameterError("alpha", alpha, f"one of {low:g} to {high:g}, which {path} holds ({wider})")
    return axis.at(alpha)
