"""Measured moduli: as a file of a dynamic mechanical analysis has them (:class:`DynamicModuli`),
and checked and sorted, as series are fitted to them.

A series is fitted to a :class:`Curve`, storage and loss modulus, or to a :class:`Relaxation`; both
compute what one mode contributes to their columns, of which :func:`misfits` of a :class:`Spectrum`
are made.  :func:`kramers_kronig` examines whether storage
and loss modulus can be of one material.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np

from ..core import (
    ArrayLike,
    Dataset,
    Figure,
    Floats,
    Result,
    SummaryRow,
    check_array,
    described_error,
    shape_error,
    warn_of_model,
)
from ..materials import Prony

# --- Measured moduli, checked and sorted ---

#: least and largest value of a column, in its unit: doubles hold their squares, of which the least
#: squares are made
RANGE = {"low": 1e-100, "high": 1e100}
#: number of points above which the means of logarithmic bins are fitted in their place: the time of
#: the least squares is proportional to the number of points
MOST_POINTS = 1000
#: number of logarithmic bins: 500 keep every detail that modes of one or two a decade can follow
_BINS = 500
#: half width in ln omega of the window of a slope: a quarter of a decade, within which moduli bend
#: little
_WINDOW = 0.25 * math.log(10.0)
#: least number of points of a slope: five average the noise of usual DMA
_NEIGHBOURS = 5
#: column of a curve -> its unit
UNITS = {
    "omega": "rad s-1",
    "storage": "Pa",
    "loss": "Pa",
    "t": "s",
    "relaxation": "Pa",
    "temperature": "degC",
    "strain": "1",
}
#: range of ln omega below which frequencies count as one: some thousand roundings
_APART = 1e-12


class Curve(NamedTuple):
    """Storage and loss modulus over angular frequency, ascending, all positive.

    omega : angular frequencies, rad/s, ascending, shape (n,); they may repeat.
    storage, loss : moduli at these, shape (n,), both in the unit that the caller used.
    """

    omega: Floats
    storage: Floats
    loss: Floats

    @property
    def band(self) -> tuple[float, float]:
        """Lowest and highest angular frequency of the data, rad/s."""
        return float(self.omega[0]), float(self.omega[-1])

    @property
    def shortest(self) -> float:
        """Shortest time of a mode that the data determine, s: 0, which allows any.

        The loss modulus of a fast mode is proportional to omega far below its peak, so that even
        such a mode shows in data.
        """
        return 0.0

    def responses(self, tau: Floats) -> Floats:
        """Return the responses of modes of strength 1, z^2/(1 + z^2) and z/(1 + z^2) with z = omega
        tau.

        tau : times of the modes, s, > 0, shape (modes,), which may be empty.
        Returns them dimensionless, shape (2, n, modes): row 0 of the storage, row 1 of the loss
        modulus, at the n points.
        """
        z = self.omega[:, None] * tau
        loss = 1.0 / (z + 1.0 / z)
        return np.array([z * loss, loss])

    def slopes(self, tau: Floats, responses: Floats) -> Floats:
        """Return the derivatives of the responses by ln tau, 2 L^2 and L (1 - 2 S).

        tau : times of the modes, s, shape (modes,); not used, as the responses suffice.
        responses : result of :meth:`responses` for these times, S in row 0 and L in row 1, shape
        (2, n, modes).
        Returns the derivatives, dimensionless, shape (2, n, modes), row 0 of the storage, row 1 of
        the loss modulus.
        """
        storage, loss = responses
        return np.array([2.0 * loss * loss, loss * (1.0 - 2.0 * storage)])


class Relaxation(NamedTuple):
    """Relaxation modulus over time, ascending, all positive.

    Properties and methods are those of :class:`Curve`, with one row in place of two.

    t : times since the strain was applied, s, ascending, shape (n,).
    relaxation : relaxation modulus at these, shape (n,), in the unit that the caller used.
    """

    t: Floats
    relaxation: Floats

    @property
    def band(self) -> tuple[float, float]:
        """Reciprocals of the last and of the first time, 1/s, which stand for the lowest and the
        highest angular frequency.
        """
        return float(1.0 / self.t[-1]), float(1.0 / self.t[0])

    @property
    def shortest(self) -> float:
        """Shortest time of a mode that the data determine, s: half of the first time.

        A mode whose time is a tenth of the first time has fallen to exp(-10) there: noise alone
        would set its strength.
        """
        return 0.5 * float(self.t[0])

    def responses(self, tau: Floats) -> Floats:
        """Return the responses of modes of strength 1, exp(-t/tau).

        tau : times of the modes, s, > 0, shape (modes,), which may be empty.
        Returns them dimensionless, shape (1, n, modes), at the n times.
        """
        return np.exp(-self.t[:, None] / tau)[None]

    def slopes(self, tau: Floats, responses: Floats) -> Floats:
        """Return the derivatives of the responses by ln tau, (t/tau) exp(-t/tau).

        tau : times of the modes, s, > 0, shape (modes,).
        responses : result of :meth:`responses` for these times, shape (1, n, modes).
        Returns the derivatives, dimensionless, shape (1, n, modes).
        """
        return (self.t[:, None] / tau) * responses


_Data = TypeVar("_Data", Curve, Relaxation)


class KramersKronig(NamedTuple):
    """Ratio of the measured loss modulus to the one that the slope of the storage modulus gives.

    omega : angular frequency, rad/s, ascending, shape (n,).
    ratio : E''/((pi/2) dE'/d ln omega), dimensionless, shape (n,); infinite where E' does not rise,
        NaN where the neighbours of a point are all of one frequency, so that there is no slope.
    median : median of the ratios that are not NaN, infinite ones included, NaN if all are; near 1
        where the spectrum is broad and the data are sound.
    """

    omega: Floats
    ratio: Floats
    median: float


def data_of(kind: type[_Data], *columns: ArrayLike, fewest: int = 3, where: str = "") -> _Data:
    """Check measured columns and return them as a curve, sorted by frequency or time.

    kind : :class:`Curve` or :class:`Relaxation`.
    columns : the fields of ``kind``, three or two (else ValueError), in any order of points, (n,),
        each without a unit or of the dimension in :data:`UNITS`: omega in rad/s, t in s; moduli
        without a unit may be in any, as long as it is the same.
    fewest : least number of points: three, as many as a series of one mode has constants.
    where : words for the temperature of the curve, "" if it is the only one.
    Returns the curve, of the class ``kind``, in ascending order; points of one frequency or time
    stay in the order in which they were given.

    Raises
    ------
    ParameterError
        Values that are no numbers, outside of :data:`RANGE`, of a unit of another dimension,
        columns of other shapes, or fewer than ``fewest`` points.
    """
    names = kind._fields
    values = [
        check_array(name, given, unit=UNITS[name], **RANGE)
        for name, given in zip(names, columns, strict=True)
    ]
    for name, column in zip(names, values):
        if column.ndim != 1:
            advice = "; curves at several temperatures need temperature=" * (kind is Curve)
            raise shape_error(name, column.shape, f"a list of numbers{advice}")
        if column.shape != values[0].shape:
            raise described_error(
                name,
                f"has {column.size} number{'s' * (column.size != 1)}",
                f"as long as {names[0]}, which has {values[0].size}",
            )
    if values[0].size < fewest:
        raise described_error(
            names[0],
            f"has too few points{where}, {values[0].size}",
            f"a list of at least {fewest} points{' at each temperature' * bool(where)}",
        )
    order = np.argsort(values[0], kind="stable")
    return kind(*(column[order] for column in values))


def thinned(data: _Data) -> _Data:
    """Average a curve of more than :data:`MOST_POINTS` points in logarithmic bins, so that fits of
    long records stay fast.

    In a bin the frequency (time) is the geometric mean, a modulus the arithmetic one: an error of
    measurement that is 0 on average stays so.

    data : a :class:`Curve` or a :class:`Relaxation`, ascending.
    Returns a curve of the same class, ascending, with one point for each of the 500 bins that has
    points, which divide the range of the data in equal ratios; ``data`` itself if it has no more
    than :data:`MOST_POINTS`, 1000, points.
    """
    if data[0].size <= MOST_POINTS:
        return data
    from scipy import stats

    x = np.log(data[0])
    means = stats.binned_statistic(x, [x, *data[1:]], bins=_BINS).statistic
    first, *others = means[:, ~np.isnan(means[0])]
    return type(data)(np.exp(first), *others)


@np.errstate(divide="ignore")  # infinite where the storage modulus does not rise
def kramers_kronig(curve: Curve) -> KramersKronig:
    """Compare the loss modulus with the local form of the Kramers-Kronig relations, E'' = (pi/2)
    dE'/d ln omega.

    It shows whether storage and loss modulus can be of one material.  The form is exact for a power
    law in the limit of small exponents, and good where E' bends little within a decade (H. C. Booij
    and G. P. J. M. Thoone, Rheologica Acta 21, 15-24, 1982, doi:10.1007/BF01520702).  A straight
    line in ln E' over ln omega is fitted to the neighbours of a point, those within a quarter of a
    decade, and at least the five nearest, itself included: the slope is its slope times its modulus
    at the point.

    curve : :class:`Curve`, storage and loss modulus, n points, which may be fewer than five.
    Returns :class:`KramersKronig`: the measured divided by the computed loss modulus at each point,
    infinite where the line does not rise and NaN where all neighbours are of one frequency, and the
    median of those that are not NaN, which is NaN if all are.
    """
    x = np.log(curve.omega)
    y = np.log(curve.storage)
    ratio = np.empty_like(x)
    for n, centre in enumerate(x):
        distance = np.abs(x - centre)
        near = distance <= max(_WINDOW, np.sort(distance)[:_NEIGHBOURS][-1])
        # log is ln E' of the line at the point itself
        slope, log = (
            np.polyfit(x[near] - centre, y[near], 1)
            if np.ptp(x[near]) > _APART
            else (math.nan, 0.0)
        )
        # E'' = pi/2 dE'/d ln(omega), with dE' = E' d ln(E')
        ratio[n] = curve.loss[n] / np.maximum(0.5 * math.pi * slope * math.exp(log), 0.0)
    finite = ratio[~np.isnan(ratio)]
    return KramersKronig(curve.omega, ratio, float(np.median(finite)) if finite.size else math.nan)


# --- A spectrum beside measured moduli ---

#: moduli to which a spectrum is fitted
Data = Curve | Relaxation


class Spectrum(NamedTuple):
    """A discrete spectrum in the units of the data: long-time modulus and modes of a generalised
    Maxwell solid.

    E : long-time modulus, in the unit of the data.
    strength : strength of each mode, in the unit of E, shape (modes,).
    tau : time of each mode, s, descending, shape (modes,); modes may be 0.
    """

    E: float
    strength: Floats
    tau: Floats

    def modulus(self, data: Data) -> Floats:
        """Return the moduli of the spectrum at the frequencies or times of the data, in the unit of
        E.

        data : measured moduli, a :class:`Curve` or a :class:`Relaxation` at n points; only their
            frequencies or times are used.
        Returns shape (2, n), storage and loss, of a :class:`Curve`; (1, n) of relaxation.
        """
        moduli = data.responses(self.tau) @ self.strength
        moduli[0] += self.E  # the storage or the relaxation modulus
        return moduli


def spectrum_of(prony: Prony, E: float, T_ref: float) -> Spectrum:
    """Return the spectrum, in the units of the data, of a dimensionless series.

    prony : :class:`Prony`, strengths divided by the long-time modulus, times over T_ref.
    E : long-time modulus, in the unit of the data.
    T_ref : unit of the times of the series, s.
    Returns the :class:`Spectrum`, strengths in the unit of E and times in s, in the order of the
    series.
    """
    return Spectrum(E, prony.E * E, prony.tau * T_ref)


def relative_columns(data: Data, constant: float, modes: Floats) -> Floats:
    """Return the matrix of the least squares: responses of a constant and of modes, divided by the
    measured moduli.

    data : measured moduli, a :class:`Curve` (rows = 2, storage and loss) or a :class:`Relaxation`
        (rows = 1), at n points.
    constant : long-time modulus whose response is the first column, in the unit of the data; 1.0
    for a unit response.
    modes : responses of the modes, in the unit of the data, shape (rows, n, modes).
    Returns shape (rows n, 1 + modes), dimensionless; the column of the constant is the first.
    """
    found = np.zeros((*modes.shape[:2], 1 + modes.shape[2]))
    found[0, :, 0] = constant  # in the storage or the relaxation modulus, not in the loss
    found[..., 1:] = modes
    found /= np.array(data[1:])[..., None]
    return found.reshape(-1, found.shape[2])


def residuals(data: Data, values: Floats) -> Floats:
    """Return the relative errors of all moduli, one row after the other.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`, ``rows`` of them at n points.
    values : [long-time modulus, strengths, times], the first two in the unit of the data, times in
    s; (1 + 2 modes,).
    Returns fitted divided by measured moduli - 1, dimensionless, shape (rows n,).
    """
    # of 1 + 2 modes numbers the last ones are the times
    strengths, tau = np.split(values, [1 + values.size // 2])
    return relative_columns(data, 1.0, data.responses(tau)) @ strengths - 1.0


def misfits(data: Data, spectrum: Spectrum) -> tuple[float, ...]:
    """Return the misfit of each row of the data: the root mean square of its relative errors.

    data : measured moduli, a :class:`Curve` or a :class:`Relaxation`.
    spectrum : :class:`Spectrum`, the fit.
    Returns dimensionless numbers: (storage, loss) of a :class:`Curve`,
    (relaxation,) of relaxation.
    """
    errors = residuals(data, np.hstack(spectrum)).reshape(len(data) - 1, -1)
    return tuple(np.sqrt(np.mean(errors * errors, axis=1)).tolist())


# --- Storage and loss modulus of a dynamic mechanical analysis ---

#: K; temperatures that differ by no more are those of one sweep, as a chamber holds its temperature
SAME_TEMPERATURE = 1.0


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ModuliRecord(Result):
    """Moduli as a reader of files returns them, with what the file says of them.

    It unpacks into the columns :attr:`COLUMNS`.

    Attributes
    ----------
    TITLE : title of the data, where they have no source.
    COLUMNS : names of the columns, the abscissa first.
    AXES : labels of abscissa and ordinate, each ends with its unit.
    mode : "tension" or "shear".
    source : name of the file.
    columns : meaning -> heading of the column that was taken for it.
    units : meaning -> unit in which that column was written.
    notes : sentences: what was converted, compared, assumed, and which columns were left aside.
    """

    TITLE: ClassVar[str]
    COLUMNS: ClassVar[tuple[str, ...]]
    AXES: ClassVar[tuple[str, str]]

    mode: str = "tension"
    source: str = ""
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def symbols(self) -> tuple[str, ...]:
        """Symbols of several moduli; () of one."""
        return ()

    def __iter__(self) -> Iterator[Floats]:
        """Return an iterator over the columns, (n,) each."""
        return (getattr(self, name) for name in self.COLUMNS)

    def to_xarray(self) -> Dataset:
        """Return the points as a dataset.

        Returns
        -------
        xarray.Dataset
            Variables of the dimension ``point``: omega (rad s-1), storage and loss (Pa), or t (s)
            and relaxation (Pa); and, where they are known, temperature (degC) and strain
            (dimensionless) of each point.  Attributes: title, mode, source and notes, the last as
            one text, separated by "; ", and, where one is known for all points, temperature, a
            number in degrees Celsius.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.read_dma(vr.datasets.path("dma.csv")).to_xarray().sizes["point"]
        25
        """
        import xarray as xr

        known = {name: value for name in UNITS if (value := getattr(self, name, None)) is not None}
        data = {
            name: ("point", values, {"units": UNITS[name]})
            for name, values in known.items()
            if np.ndim(values)
        }
        about = {
            "title": self.TITLE,
            "mode": self.mode,
            "source": self.source,
            "notes": "; ".join(self.notes),
        }
        # one temperature of all points
        return xr.Dataset(data, attrs=about | {name: known[name] for name in known.keys() - data})

    def _figure(self) -> Figure:
        """Return the matplotlib figure of the moduli against the abscissa.

        Both axes are logarithmic; the points of all temperatures are drawn alike.
        """
        from ..core.plots import new_figure

        figure, axes = new_figure(f"{self.source or self.TITLE}, {self.mode}")
        x, *moduli = ModuliRecord.__iter__(self)  # without the warning of DynamicModuli
        for modulus in moduli:
            axes.loglog(x, modulus, "o", markerfacecolor="none", markersize=4)
        if self.symbols:
            axes.legend(self.symbols, frameon=False)
        axes.set(xlabel=self.AXES[0], ylabel=self.AXES[1])
        return figure

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return title and rows of the printed report.

        Returns (the title, one line: the source, or :attr:`TITLE` of the class without one, number
        of points, range of the abscissa, mode and, if the record has them, temperatures; two
        :class:`SummaryRow`: the columns with their headings and units, and the notes, or "no unused
        column" where there are none).
        """
        name = self.COLUMNS[0]
        x = getattr(self, name)
        # the last word of AXES[0], the label of the abscissa, is its unit
        words = [
            f"{np.size(x)} point{'s' * (np.size(x) > 1)}",
            f"{name} {np.min(x):.4g} to {np.max(x):.4g} {self.AXES[0].split()[-1]}",
            f"{self.mode} ({', '.join(self.symbols)})" if self.symbols else self.mode,
        ]
        if (temperature := getattr(self, "temperature", None)) is not None:
            words.append(
                f"{np.min(temperature):g} °C"
                if np.ptp(temperature) == 0.0
                else f"{np.min(temperature):g} to {np.max(temperature):g} °C"
            )
        return f"{self.source or self.TITLE}: {', '.join(words)}", [
            SummaryRow(
                "columns",
                "; ".join(
                    f"{meaning} {heading!r} in {self.units.get(meaning, '1')}"
                    for meaning, heading in self.columns.items()
                ),
            ),
            SummaryRow("notes", "; ".join(self.notes) or "no unused column"),
        ]


@dataclass(frozen=True, eq=False, repr=False)
class DynamicModuli(ModuliRecord):
    """Storage and loss modulus over angular frequency, as :func:`viscoroll.read_dma` reads them
    from a file.

    It unpacks into its first three columns, ``omega, storage, loss = record``;
    ``fit_prony(record)`` takes it whole, with its temperatures and its mode.

    Parameters
    ----------
    omega : angular frequencies, rad/s, shape (n,), in the order of the file.
    storage, loss : storage and loss modulus, Pa, shape (n,).
    temperature : temperature of each point, degrees Celsius, shape (n,); None where the file has
        none.
    mode : "tension" (E', E'') or "shear" (G', G'').
    source : name of the file.
    columns : meaning -> heading of the column that was taken for it.
    units : meaning -> unit in which that column was written.
    notes : sentences: what was converted, compared, assumed, and which columns were left aside.
    strain : amplitude of the strain at each point, dimensionless, (n,); None where the file does
        not state it with its unit.

    Examples
    --------
    >>> import viscoroll as vr
    >>> record = vr.read_dma(vr.datasets.path("dma.csv"))
    >>> record.mode, record.omega.size
    ('tension', 25)
    """

    TITLE = "Dynamic moduli"
    COLUMNS = ("omega", "storage", "loss")
    AXES = ("angular frequency, rad/s", "modulus, Pa")

    omega: Floats
    storage: Floats
    loss: Floats
    temperature: Floats | None = None
    strain: Floats | None = None

    @property
    def symbols(self) -> tuple[str, ...]:
        """Symbols of storage and loss modulus by the mode."""
        return ("G'", "G''") if self.mode == "shear" else ("E'", "E''")

    @property
    def isothermal(self) -> bool:
        """Whether all points are of one temperature, as far as the file says: within 1 K."""
        return self.temperature is None or float(np.ptp(self.temperature)) <= SAME_TEMPERATURE

    @property
    def mean_strain(self) -> float | None:
        """Geometric mean of the strains, dimensionless; None where the strain of a point is not
        known.
        """
        if self.strain is None or not (self.strain > 0.0).all():
            return None
        return float(np.exp(np.log(self.strain).mean()))

    def __iter__(self) -> Iterator[Floats]:
        """Return an iterator over omega, storage and loss, (n,) each, so that ``omega, storage,
        loss = read_dma(path)`` works.

        Warns with ModelWarning where the record has temperatures that span more than 1 K, or moduli
        of shear, which these arrays do not state.
        """
        lost = ["the temperatures"] * (not self.isothermal) + ["that the moduli are of shear"] * (
            self.mode == "shear"
        )
        if lost:
            warn_of_model(
                f"{self.source or 'record'}: the arrays omega, storage and loss do not tell "
                f"{' and '.join(lost)}: give the whole record in their place, as "
                "fit_prony(record), unless you state them by temperature= and mode="
            )
        return super().__iter__()

    def __len__(self) -> int:
        """Three: the columns that it unpacks into."""
        return 3

    def __getitem__(self, name: Any) -> Any:
        """Return a field by its name, or omega, storage, loss by their index.

        name : name of a field; 0, 1 or 2, or -3 to -1 from the end; or a slice, which gives a tuple
        of the arrays.
        Returns the field, or the array, (n,).
        Raises KeyError for another name, IndexError for another number.
        """
        if isinstance(name, (int, slice)):
            return tuple(super().__iter__())[name]
        return super().__getitem__(name)
