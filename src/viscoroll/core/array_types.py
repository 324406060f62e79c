"""What callers may give, for type checkers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

#: numbers as results hold them
Floats: TypeAlias = NDArray[np.float64]
Integers: TypeAlias = NDArray[np.int64]
Booleans: TypeAlias = NDArray[np.bool_]

if TYPE_CHECKING:
    Reals: TypeAlias = NDArray[np.floating[Any] | np.integer[Any]]

    class SupportsArray(Protocol):
        """Arrays and scalars of numpy, arrays of xarray and pandas."""

        def __array__(self) -> Reals: ...

    #: one number, or an array as numpy, xarray, pandas or lists hold it; no text
    Numbers: TypeAlias = float | SupportsArray | Sequence[float] | Sequence[SupportsArray] | Sequence[Sequence[float]]
else:
    Numbers = Any
