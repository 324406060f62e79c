"""An identification as a dataset, and as what JSON holds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import __version__
from .report import noise_said, report, sentences

if TYPE_CHECKING:
    import xarray as xr


def as_dataset(fit: Any) -> xr.Dataset:
    """Values over ``unknown``, each record's places, data, fit and sigma over an axis of its own."""
    import xarray as xr

    names, ends = np.array(list(fit.values), object), np.array(list(fit.intervals().values()), float)
    data: dict[str, Any] = {
        "value": ("unknown", np.array(list(fit.values.values()))),
        "stderr": ("unknown", np.array(list(fit.stderr.values()))),
        "low": ("unknown", ends[:, 0], {"long_name": "lower end of the 95 % interval, NaN where open"}),
        "high": ("unknown", ends[:, 1], {"long_name": "upper end of the 95 % interval, NaN where open"}),
        "correlation": (("unknown", "other"), fit.correlations),
    }
    for called, record in fit.records.items():
        axis = f"{called} point"
        for place in record.PLACES:
            data[f"{called} {place}"] = (axis, np.ravel(getattr(record, place)), {"units": record.unit(place)})
        for one in fit.columns:
            if one.record == called:
                key, about = f"{called} {one.quantity}", {"units": record.unit(one.quantity)}
                band = getattr(fit.predicted[called], one.quantity)
                if not record.planned:
                    data[key] = (axis, np.ravel(getattr(record, one.quantity)), about)
                data[f"{key} fit"] = (axis, np.ravel(band.value), about)
                data[f"{key} sigma"] = (axis, fit.sigma[str(one)], about)
    about = {"title": "Identification", "source": f"viscoroll {__version__}", "report": report(fit)}
    coords = {"unknown": names, "other": names}
    return xr.Dataset(data, coords, about | {"chi2": fit.chi2, "dof": fit.dof})


def as_json(fit: Any) -> dict[str, Any]:
    """What the report says, by name; null where a side is open or nothing acts."""
    intervals = fit.intervals()
    return {
        "source": f"viscoroll {__version__}", "chi2": fit.chi2, "dof": fit.dof, "planned": fit.planned,
        "unknowns": {
            name: {"value": value, "stderr": _finite(fit.stderr[name]), "interval": intervals[name]}
            for name, value in fit.values.items()
        },
        "does_not_act": fit.does_not_act, "undetermined": fit.undetermined,
        "products": [one._asdict() for one in fit.products()], "misfit": fit.misfit,
        "noise": {name: {"rms": one.rms, "lag": one.lag, "allowed": one.allowed} for name, one in fit.noise.items()},
        "correlations": fit.correlations.tolist(), "minima": fit.minima,
        "sigma": {name: float(values[0]) for name, values in fit.sigma.items()},
        "says": [*noise_said(fit), *sentences(fit)],
    }  # fmt: skip


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
