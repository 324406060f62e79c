"""Storage and loss modulus of a dynamic mechanical analysis: :class:`DynamicModuli`."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.array_types import Floats
from ...core.errors import ModelWarning, caller_level
from ...core.results import Result, SummaryRow

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: K; temperatures that differ by no more are those of one sweep, as a chamber holds its temperature
SAME_TEMPERATURE = 1.0


@dataclass(frozen=True, eq=False, repr=False)
class DynamicModuli(Result):
    """Storage and loss modulus over angular frequency, as :func:`viscoroll.read_dma` reads them from a file.

    It unpacks into its first three columns, ``omega, storage, loss = record``; ``fit_prony(record)`` takes it whole,
    with its temperatures and its mode.

    Parameters
    ----------
    omega : angular frequencies, rad/s, shape (n,), in the order of the file.
    storage, loss : storage and loss modulus, Pa, shape (n,).
    temperature : temperature of each point, degrees Celsius, shape (n,); None where the file has none.
    mode : "tension" (E', E'') or "shear" (G', G'').
    source : name of the file.
    columns : meaning -> heading of the column that was taken for it.
    units : meaning -> unit in which that column was written.
    notes : sentences: what was converted, compared, assumed, and which columns were left aside.
    strain : amplitude of the strain at each point, dimensionless, (n,); None where the file does not state it with its
        unit.

    Examples
    --------
    >>> import viscoroll as vr
    >>> record = vr.read_dma(vr.datasets.path("dma.csv"))
    >>> record.mode, record.omega.size
    ('tension', 25)
    """

    omega: Floats
    storage: Floats
    loss: Floats
    temperature: Floats | None = None
    mode: str = "tension"
    source: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    strain: Floats | None = None

    @property
    def isothermal(self) -> bool:
        """Whether all points are of one temperature, as far as the file says: within 1 K."""
        return self.temperature is None or float(np.ptp(self.temperature)) <= SAME_TEMPERATURE

    def __iter__(self) -> Iterator[Floats]:
        """Return an iterator over omega, storage and loss, (n,) each, so that ``omega, storage, loss = read_dma(path)``
        works.

        Warns with ModelWarning where the record has temperatures that span more than 1 K, or moduli of shear, which
        these arrays do not state.
        """
        lost = ["its temperatures"] * (not self.isothermal) + ["that it is of shear"] * (self.mode == "shear")
        if lost:
            text = (
                f"{self.source}: three columns do not state {' and '.join(lost)}: give the record itself, "
                f"fit_prony(record)"
            )
            warnings.warn(text, ModelWarning, stacklevel=caller_level())
        return iter((self.omega, self.storage, self.loss))

    def __len__(self) -> int:
        """Three: the columns that it unpacks into."""
        return 3

    def __getitem__(self, name: Any) -> Any:
        """Return a field by its name, or omega, storage, loss by their place.

        name : name of a field; 0, 1 or 2, or -3 to -1 from the end; or a slice, which gives a tuple of the arrays.
        Returns the field, or the array, (n,).
        Raises KeyError for another name, IndexError for another number.
        """
        if isinstance(name, (int, slice)):
            return (self.omega, self.storage, self.loss)[name]
        return super().__getitem__(name)

    def to_xarray(self) -> xr.Dataset:
        """Return the points as a dataset.

        Returns
        -------
        xarray.Dataset
            Variables omega (rad s-1), storage and loss (Pa) and, where they are not None, temperature (degC) and
            strain (dimensionless), each over the dimension ``point``; attributes title, mode, source and notes, one
            text, parted by "; ".

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.read_dma(vr.datasets.path("dma.csv")).to_xarray().sizes["point"]
        25
        """
        import xarray as xr

        units = {"omega": "rad s-1", "storage": "Pa", "loss": "Pa", "temperature": "degC", "strain": "1"}
        columns = {name: values for name in units if (values := getattr(self, name)) is not None}
        data = {name: ("point", values, {"units": units[name]}) for name, values in columns.items()}
        about = {"title": "Dynamic moduli", "mode": self.mode, "source": self.source, "notes": "; ".join(self.notes)}
        return xr.Dataset(data, attrs=about)

    def _figure(self) -> Figure:
        """Return the matplotlib figure of storage and loss modulus, Pa, over angular frequency, rad/s.

        Both axes are logarithmic; the points of all temperatures are drawn alike.
        """
        from ...core.plots.style import new_figure

        figure, axes = new_figure(f"{self.source or 'Dynamic moduli'}, {self.mode}")
        axes.loglog(self.omega, self.storage, "o", self.omega, self.loss, "o", markerfacecolor="none", markersize=4)
        axes.legend(["G'", "G''"] if self.mode == "shear" else ["E'", "E''"], frameon=False)
        axes.set(xlabel="angular frequency, rad/s", ylabel="modulus, Pa")
        return figure

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return title and rows of the printed report.

        Returns (title: source, number of points, range of omega in rad/s, mode and, if the record has them,
        temperatures, in one line; two :class:`SummaryRow`: the columns with their headings and units, and the notes, or
        "no unused column" where there are none).
        """
        words = [f"{self.omega.size} points", f"omega {self.omega.min():.4g} to {self.omega.max():.4g} rad/s"]
        words.append("shear (G', G'')" if self.mode == "shear" else "tension (E', E'')")
        if self.temperature is not None:
            low, high = self.temperature.min(), self.temperature.max()
            words.append(f"{low:g} °C" if low == high else f"{low:g} to {high:g} °C")
        return f"{self.source or 'Dynamic moduli'}: {', '.join(words)}", rows_of(self)


def rows_of(record: Any) -> list[SummaryRow]:
    """Return the rows of the report of a record with ``columns``, ``units`` and ``notes``: columns, and notes."""
    given = (f"{name} {record.columns[name]!r} in {record.units.get(name, '1')}" for name in record.columns)
    return [
        SummaryRow("columns", "; ".join(given)),
        SummaryRow("notes", "; ".join(record.notes) or "no unused column"),
    ]
