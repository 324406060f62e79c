"""The contact law of one scene, for integrators: :func:`law`."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import partial
from typing import Any, Literal, overload

import numpy as np

from ..core.array_types import Floats, Numbers
from ..core.checks import check_array, check_bool
from ..core.errors import ParameterError
from ..kernels.rows.loads import Loads, LoadsAndSlopes
from ..materials.law.grid import LawGrid
from .contact import contact
from .contact_table import refuse_overflow
from .parameters import Rolls, framed, refuse_arrays

#: what the law takes as it is; all else goes through :func:`contact`
_NUMBERS = frozenset({float, int, np.float64})
_loads, _loads_and_slopes = partial(tuple.__new__, Loads), partial(tuple.__new__, LoadsAndSlopes)


class Law:
    """The law of a scene or a cylinder, bound: what :func:`law` returns.

    Attributes
    ----------
    roller, scene : that it is the law of, and the dimensionless scene of that.
    """

    def __init__(self, roller: Rolls) -> None:
        from ..kernels.rows.c_function import pack_scenes
        from ..kernels.rows.jitted_law import Jitted

        _, scene, scale = framed(roller, "law")
        if scene.each is not None:
            raise ParameterError(
                "material", repr(scene.material), "one material, as material[i]: a law is of one scene"
            )
        refuse_arrays(scene, ("alpha", "kappa", "mu"), "one number: a law is of one scene")
        table = scene.table
        assert table is not None
        self.roller, self.scene, self._fastest = roller, scene, np.asarray(scene.kappa / scale["V"])
        scenes = pack_scenes(table.record, table.unlike, scene.kappa, scene.mu, scale)
        self._take(Jitted(scenes, table))

    def _take(self, jitted: Any) -> None:
        """Keep what is called, and the room for what it finds."""
        from ..kernels.rows.jitted_law import ResultBuffer

        self._jitted, self._room = jitted, ResultBuffer
        self._function, self._plain, self._sloped = jitted.function, jitted.plain, jitted.address

    @overload
    def __call__(  # type: ignore[overload-overlap]
        self, V: float, omega: float, *, slopes: Literal[False] = False
    ) -> Loads[float]: ...
    @overload
    def __call__(  # type: ignore[overload-overlap]
        self, V: float, omega: float, *, slopes: Literal[True]
    ) -> LoadsAndSlopes[float]: ...
    @overload
    def __call__(self, V: Numbers, omega: Numbers, *, slopes: Literal[False] = False) -> Loads[Floats]: ...
    @overload
    def __call__(self, V: Numbers, omega: Numbers, *, slopes: Literal[True]) -> LoadsAndSlopes[Floats]: ...
    def __call__(self, V: Any, omega: Any, *, slopes: bool = False) -> Any:
        """Q and M at speed V of the axis and angular velocity omega, any signs: Eqs. (15)-(18).

        Parameters
        ----------
        V, omega : numbers, or arrays that broadcast.
        slopes : also the derivatives.

        Returns
        -------
        Loads or LoadsAndSlopes
            Q, M, M_half_space, M_cylinder, and with slopes dQ_dV at fixed omega, dQ_domega, dM_half_space_dV,
            dM_cylinder_dV; in the units of what rolls.

        Raises
        ------
        ParameterError
            NaN or infinite input, kappa |V| above 1e300, shapes that do not broadcast.
        """
        if slopes is not False:
            slopes = check_bool("slopes", slopes)
        if type(V) in _NUMBERS and type(omega) in _NUMBERS:
            out = self._room()
            try:
                status = self._function(V, omega, out, self._sloped if slopes else self._plain)
            except ctypes.ArgumentError:  # an integer beyond the doubles
                status = 1
            if status:
                self._refuse(check_array("V", V), check_array("omega", omega))
            return _loads_and_slopes(out) if slopes else _loads(out[:4])
        return self._of_arrays(V, omega, LoadsAndSlopes if slopes else Loads)

    def _of_arrays(self, V: Any, omega: Any, kind: Any) -> Any:
        """The law at arrays, as a ``kind``: :class:`Loads` or :class:`LoadsAndSlopes`."""
        return kind(**contact(self.roller, V, omega=omega, fields=kind._fields).as_dict())

    def _refuse(self, V: Floats, omega: Floats) -> None:
        """Raise ParameterError for finite numbers at which the law is not defined."""
        refuse_overflow(self._fastest, V)

    @property
    def jitted(self) -> Callable[[float, float], LoadsAndSlopes[float]]:
        """(V, omega) -> :class:`LoadsAndSlopes` for numba's jitted functions, which take it as an argument or from
        around them.  NaN, and no error, where the law would raise one.
        """
        return self._jitted

    @property
    def address(self) -> tuple[int, int]:
        """Address of a C function ``int law(double V, double omega, double out[8], void *user_data)``, and of its user
        data.

        It fills ``out`` with the eight numbers of :class:`LoadsAndSlopes` and returns 0; where the law would raise an
        error, with NaN, and returns another number.  Any number of threads may call it, as long as this law is
        there.  All laws of half-spaces share the function, and all laws of covers another one.
        """
        return self._jitted.function_address, self._jitted.address

    @property
    def ctypes(self) -> tuple[Any, Any]:
        """Both for ctypes, as ``scipy.LowLevelCallable(*law.ctypes)`` takes them; either keeps what it needs."""
        return self._jitted.ctypes

    def __reduce__(self) -> tuple[Any, ...]:
        return law, (self.roller,)

    def __repr__(self) -> str:
        return f"law of {self.roller!r}"


class WatchedLaw(Law):
    """The law of a cylinder that has speeds to warn of: each call with numbers looks at its speed."""

    def __call__(self, V: Any, omega: Any, *, slopes: bool = False) -> Any:
        found: Any = super().__call__(V, omega, slopes=slopes)  # type: ignore[call-overload]
        if type(V) in _NUMBERS and type(omega) in _NUMBERS:  # of arrays contact looks
            self.roller.look(V, (V, V))
        return found


class _LawOfGrid(Law):
    """The law of a grid, which is its ``roller``: a :class:`Law` whose numbers are those of splines."""

    def __init__(self, grid: LawGrid) -> None:
        from ..kernels.splines.law import jitted_grid

        self.roller: Any = grid
        (low, high), slowest = grid.delta, grid.V[0]
        self._take(jitted_grid(grid.splines, slips=grid.slips, slowest=slowest, low=low, high=high, R=grid.R))

    def _of_arrays(self, V: Any, omega: Any, kind: Any) -> Any:
        each = np.vectorize(lambda *state: tuple(self(*state, slopes=True)), otypes=[float] * 8)
        return kind(*each(check_array("V", V), check_array("omega", omega))[: len(kind._fields)])

    def _refuse(self, V: Floats, omega: Floats) -> None:
        self.roller.refuse_outside(V, omega)


def law(roller: Rolls | LawGrid) -> Law:
    """The contact law of one scene, checked once, for integrators of one's own: Eqs. (6)-(10), (15)-(18).

    ``law(V, omega)`` is :func:`contact` at a given omega with nothing left to check but V and omega, and
    ``law.jitted`` and ``law.address`` are the same for numba and C.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used, or a :class:`Cylinder`, whose law
        takes and gives SI units: one number each, one material or two bodies; or the grid of
        :func:`viscoroll.load_law`, in its units.

    Returns
    -------
    Law
        A function of V and omega.  Creep is delta = (omega - V)/V, and at V = 0 < abs(omega) the contact slips as a
        whole.  Threads may share it; pickled, it binds its scene anew.

    Raises
    ------
    ParameterError
        What is no scene and no cylinder; arrays for alpha, kappa or mu; a material each.

    Notes
    -----
    For numbers the digits are those of :func:`contact` to the bit, and for arrays it is :func:`contact` that is called
    (``tests/test_bound_law.py``).  At rest, V = omega = 0, the slopes of Q are infinite.  Where full slip begins, Q has
    a corner in V only; the slopes there are those of full slip.  A call without slopes does not pay for them.

    Calls of the law warn as :func:`contact` does; ``law.jitted`` and ``law.address`` cannot.

    Of a grid the numbers are those of its splines in ln \\|V\\| and delta, as good as the file states
    (``tests/tables/test_splines.py``): clipped to \\|Q\\| <= mu P; below the slowest speed Q is that at the slowest,
    and M in proportion to V; beyond both ends of delta \\|Q\\| is mu P where the grid slips fully there.  Other states
    outside of the axes raise OutOfTableError.  Arrays are looked up one state after another.
    """
    if isinstance(roller, LawGrid):
        return _LawOfGrid(roller)
    return WatchedLaw(roller) if isinstance(roller, Rolls) and roller.watched else Law(roller)
