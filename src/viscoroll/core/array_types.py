"""Types of arrays, and of the numbers that callers may give, for type checkers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

#: Array of doubles, as results hold them.
Floats: TypeAlias = NDArray[np.float64]
#: Array of 64-bit integers, such as indices.
Integers: TypeAlias = NDArray[np.int64]
#: Array of truth values.
Booleans: TypeAlias = NDArray[np.bool_]

if TYPE_CHECKING:
    Reals: TypeAlias = NDArray[np.floating[Any] | np.integer[Any]]

    class SupportsArray(Protocol):
        """Arrays and scalars of numpy, arrays of xarray and pandas."""

        def __array__(self) -> Reals: ...

    #: One number, or an array of numpy, xarray or pandas, or nested lists; no text.
    Numbers: TypeAlias = float | SupportsArray | Sequence[float] | Sequence[SupportsArray] | Sequence[Sequence[float]]
else:
    Numbers = Any
