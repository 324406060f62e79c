"""Relaxation modulus over time from a text file: :func:`read_relaxation`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...core.array_types import Floats
from ...core.errors import FileError
from ...core.results import Result, SummaryRow
from .column_quantities import Column
from .dynamic_moduli import SAME_TEMPERATURE, rows_of
from .table_reader import agreeing_numbers, missing, refuse_repeats, understand, warn_of_assumed_units

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class RelaxationModulus(Result):
    """Relaxation modulus over time, as :func:`viscoroll.read_relaxation` reads it from a file.

    It unpacks into its columns, ``t, relaxation = record``; ``fit_relaxation(record)`` takes it whole, with its
    temperature and its mode.

    Parameters
    ----------
    t : times since the strain was applied, s, shape (n,), in the order of the file.
    relaxation : relaxation modulus, Pa, shape (n,).
    temperature : temperature of the test, degrees Celsius; None where the file has none.
    mode : "tension" (E) or "shear" (G).
    source : name of the file.
    columns : meaning -> heading of the column that was taken for it.
    units : meaning -> unit in which that column was written.
    notes : sentences: what was computed, assumed, and which columns were left aside.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.RelaxationModulus([0.1, 1.0, 10.0], [3e6, 2e6, 1.5e6], temperature=23.0).mode
    'tension'
    """

    t: Floats
    relaxation: Floats
    temperature: float | None = None
    mode: str = "tension"
    source: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __iter__(self) -> Iterator[Floats]:
        """Return an iterator over t and relaxation, (n,) each."""
        return iter((self.t, self.relaxation))

    def to_xarray(self) -> xr.Dataset:
        """Return the points as a dataset.

        Returns
        -------
        xarray.Dataset
            Variables t (s) and relaxation (Pa) over the dimension ``point``; attributes title, mode, source and notes,
            one text, parted by "; ", and temperature (degrees Celsius) where it is known.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.RelaxationModulus([0.1, 1.0, 10.0], [3e6, 2e6, 1.5e6]).to_xarray().sizes["point"]
        3
        """
        import xarray as xr

        data = {"t": ("point", self.t, {"units": "s"}), "relaxation": ("point", self.relaxation, {"units": "Pa"})}
        about = {"title": "Relaxation modulus", "mode": self.mode, "source": self.source}
        about |= {"notes": "; ".join(self.notes)}
        warmth = {} if self.temperature is None else {"temperature": self.temperature}
        return xr.Dataset(data, attrs=about | warmth)

    def _figure(self) -> Figure:
        """Return the matplotlib figure of the relaxation modulus, Pa, over time, s; both axes are logarithmic."""
        from ...core.plots.style import new_figure

        figure, axes = new_figure(f"{self.source or 'Relaxation modulus'}, {self.mode}")
        axes.loglog(self.t, self.relaxation, "o", markerfacecolor="none", markersize=4)
        axes.set(xlabel="time, s", ylabel="relaxation modulus, Pa")
        return figure

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return title and rows of the printed report, as :meth:`.DynamicModuli._summary`."""
        words = f"{np.size(self.t)} points, t {np.min(self.t):.4g} to {np.max(self.t):.4g} s, {self.mode}"
        words += "" if self.temperature is None else f", {self.temperature:g} °C"
        return f"{self.source or 'Relaxation modulus'}: {words}", rows_of(self)


def read_relaxation(
    path: str | PathLike[str], *, columns: Mapping[str, str] | None = None,
    units: tuple[str, str] | Mapping[str, str] | None = None, decimal: str | None = None, encoding: str | None = None,
) -> RelaxationModulus:  # fmt: skip
    """Read a relaxation modulus over time, as instruments and spreadsheets write it.

    The headings say which column is which, in any order: time, and the relaxation modulus, or stress and strain, of
    which it is the ratio.  Lines, separators and other columns are treated as of :func:`viscoroll.read_dma`.

    Parameters
    ----------
    path : a text file, in an encoding as of :func:`viscoroll.read_dma`.
    columns : meaning -> heading, of columns whose names are not understood; meanings are time, relaxation modulus,
        stress, strain and temperature.  Two columns without headings are taken as time and relaxation modulus.
    units : units of time and of moduli and stresses, as ("s", "MPa"), of columns that the file gives none for; or
        meaning -> unit, in place of what the file says.  Columns for which neither gives a unit are taken in s, Pa and
        degrees Celsius, the first two with a warning; a strain must have one.
    decimal : "." or ","; default: the one that the numbers have.
    encoding : encoding of the file; default: by its first bytes.

    Returns
    -------
    RelaxationModulus
        ``t`` in s and ``relaxation`` in Pa, (n,) each, in the order of the file; ``mode`` is "shear" where the headings
        say so, else "tension"; ``temperature`` is the median of its column.  Times are read as they are: leave out
        those before the strain was applied and those of the ramp.

    Raises
    ------
    FileError
        As of :func:`viscoroll.read_dma`: what is no table, columns that are missing or contradict each other, units;
        a time, modulus, stress or strain that is not > 0 and finite; several tests: tables, temperatures, or moduli at
        one time that differ by more than a factor of 1.25.
    ParameterError
        Names or headings in ``columns``, units, a decimal mark or an encoding that are not allowed or not in the file.

    Warns
    -----
    ModelWarning
        Where neither the file nor ``units`` says what times or moduli are in.

    Examples
    --------
    >>> from pathlib import Path
    >>> import viscoroll as vr
    >>> size = Path("relaxation.csv").write_text("t [s];E(t) [MPa]\\n0,1;3,2\\n1;2,7\\n10;2,4\\n")
    >>> record = vr.read_relaxation("relaxation.csv")
    >>> record.relaxation.tolist(), record.mode
    ([3200000.0, 2700000.0, 2400000.0], 'tension')
    """
    table, found, others = source = understand(path, "relaxation", columns, units, decimal, encoding)
    alike: dict[str, list[Column]] = {}
    for column in found:
        alike.setdefault(column.quantity, []).append(column)
    pair = ("relaxation modulus",) if "relaxation modulus" in alike else ("stress", "strain")
    if "time" not in alike or not {*pair} <= alike.keys():
        raise missing(table, "no column was found for time, or none for the modulus, or for stress and strain", others)
    if len(table.starts) > 1:
        raise FileError(table.path, f"has {len(table.starts)} tables: keep one of them")
    used = [name for name in ("time", *pair, "temperature") if name in alike]
    others |= {each.heading: "not needed" for name in alike.keys() - {*used} for each in alike[name]}
    numbers = {name: agreeing_numbers(table, name, alike[name], others).values for name in used}
    for name in used[: 1 + len(pair)]:
        holds = (numbers[name] > 0.0) & (numbers[name] < np.inf)
        table.require(holds, f"the {name} is not > 0 and finite: remove the row")
    relaxation = numbers[pair[0]] / numbers.get("strain", 1.0)
    refuse_repeats(table, "time", numbers["time"], relaxation)
    temperature = numbers.get("temperature")
    if temperature is not None and np.ptp(temperature) > SAME_TEMPERATURE:
        raise FileError(
            table.path, f"has temperatures from {temperature.min():g} to {temperature.max():g} °C: keep one"
        )
    taken = [alike[name][0] for name in used]
    warn_of_assumed_units(table, taken, relaxation)
    mode, notes = source.mode(next((each.mode for each in alike[pair[0]] if each.mode), ""))
    notes += ["the modulus is stress over strain"] * (len(pair) > 1) + source.notes(taken)
    return RelaxationModulus(
        numbers["time"], relaxation, None if temperature is None else float(np.median(temperature)),
        mode, Path(path).name.encode(errors="replace").decode(),
        {column.name: column.heading for column in taken}, {column.name: column.unit for column in taken},
        tuple(notes),
    )  # fmt: skip
