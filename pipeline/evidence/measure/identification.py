"""What measurements tell, and whether `identify` says it -> data/results/identification.json (kept
in git).

    python -m pipeline.evidence.measure.identification [--config FILE] [--quick] [--only PART ...]
    [-o FILE]

Of a roller of known truth: what each experiment determines (learn, bearing), planned; what is said
of six that determine little (said); of synthetic data sets how often intervals hold the truth
(coverage), how often a search from far off arrives (reach), how far ends of intervals are from a
scan (width), and what it all takes (time).  Sizes and seeds are in [identification] of the
configuration.  Exit code 1 if a bound asked is exceeded.
"""

import os
import sys
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import viscoroll as vr
from viscoroll.measurements.identification_result import Identification
from viscoroll.measurements.measurement_records import Record
from viscoroll.measurements.profile import ProfileWalk

from ...stage import Row, Sizes
from ..results import run_parts
from ..timing import timed

TRUTH = {"mu": 0.3, "E": 3e6, "E_1": 9.0, "T_ref": 1e-3}
SHAPE = ("E", "E_1", "T_ref")
RANGES = {"mu": (3e-3, 30.0), "E": (3e4, 3e8), "E_1": (0.09, 900.0), "T_ref": (1e-5, 1e-1)}
BEARING = {"brake": 0.05, "drag": 0.003}
BEARINGS = {"brake": (0.0, 5.0), "drag": (0.0, 0.3)}
#: standard deviations: N m/m, N/m, and of motions m/s, rad/s, m
NOISE = {"M": 0.01, "Q": 1.0, "V": 5e-3, "omega": 5e-2, "x": 2e-3}
#: what is asked: coverage of nominal 95 % intervals, ends over a width, and of times, as ratios in
#: one run: a fit over one prediction of its data by a new law (some 30 steps with three new laws
#: each, of the step and to both sides of E_1), its profiles over the fit; shares of starts a factor
#: of ten off that must arrive
ASKED = {"held": (0.90, 0.98), "off": (0.0, 0.02), "fit": (0.0, 100.0), "profiles": (0.0, 6.0)}
#: data sets whose share tells anything
FEWEST = 100
REACHED = {
    "M across its maximum": 1.0,
    "coast-down to 0": 0.95,
    "launched without rotation, V": 0.95,
}
#: of chi2 at the ends of an interval of 95 %
RISE = 3.8414588
#: chi2 above the best within which a search has arrived
_ARRIVED = 0.01

HUMP, SLOW, FAST = (np.geomspace(*ends, 40) for ends in ((0.02, 20.0), (0.02, 0.2), (4.0, 20.0)))
LOAD = 35.5 * 9.81


def roller(values: dict[str, float] = TRUTH) -> vr.Cylinder:
    """A standard linear solid; at the truth M has its hump, 0.79 N m/m, at 0.64 m/s."""
    rubber = vr.Material(values["E"], 0.5, vr.Prony([values["E_1"]], [1.0]), values["T_ref"])
    return vr.Cylinder(R=0.1, m=35.5, mu=values["mu"], material=rubber)


def drum(V: NDArray, **more) -> vr.Resistance:
    """Planned: M over V."""
    return vr.Resistance(V, sigma=NOISE["M"], **more)


def traction(*speeds: float) -> vr.Traction:
    """Planned: Q over 21 creeps at each speed."""
    delta = np.tile(np.linspace(-0.06, 0.06, 21), len(speeds))
    return vr.Traction(np.repeat(speeds, 21), delta, sigma=NOISE["Q"])


def motion(V0: float, end: float, what: str = "V", **more) -> vr.Coastdown:
    """Planned: 200 points of a motion, let go rolling unless told."""
    sigma = {name: NOISE[name] for name in what.split()}
    return vr.Coastdown(np.linspace(0.0, end, 200), sigma=sigma, V0=V0, **{"name": "run"} | more)


def thrown(what: str = "V") -> vr.Coastdown:
    """Planned: at 4 m/s without spin."""
    return motion(4.0, 20.0, what, omega0=0.0)


HUMPED = [drum(HUMP)]
ROLLED = [motion(3.0, 40.0)]
THROWN = [thrown()]
#: unknown -> what is measured -> its records; the second with a series that is known
EXPERIMENTS = [
    (
        tuple(TRUTH),
        {
            "M, 0.02-20 m/s, across its maximum": HUMPED,
            "M, 0.3-3 m/s, around its maximum": [drum(np.geomspace(0.3, 3.0, 40))],
            "M, 0.02-0.2 m/s, below its maximum": [drum(SLOW)],
            "M, 4-20 m/s, above its maximum": [drum(FAST)],
            "Q at 0.1 m/s": [traction(0.1)],
            "Q at 0.1 and 1 m/s": [traction(0.1, 1.0)],
            "Q at 0.1, 1 and 10 m/s": [traction(0.1, 1.0, 10.0)],
            "coast-down V, 0.3 m/s to 0": [motion(0.3, 20.0)],
            "coast-down V, 3 to 1.1 m/s (cut at 20 s)": [motion(3.0, 20.0)],
            "coast-down V, 3 m/s to 0 (40 s)": ROLLED,
            "coast-down V, 10 m/s, 150 s": [motion(10.0, 150.0)],
            "coast-down x, 3 m/s to 0": [motion(3.0, 40.0, "x")],
            "launched without rotation, V": THROWN,
            "launched without rotation, V and omega": [thrown("V omega")],
            "M across its maximum + Q at 0.1 m/s": [*HUMPED, traction(0.1)],
            "coast-down to 0 + Q at 0.1 m/s": [*ROLLED, traction(0.1)],
            "M, Q at 3 speeds, launch without rotation (V and omega)": [
                *HUMPED,
                traction(0.1, 1.0, 10.0),
                thrown("V omega"),
            ],
        },
    ),
    (
        ("mu", "E", "T_ref"),
        {
            "series from DMA data, launched without rotation, V": THROWN,
            "series from DMA data, M below its maximum": [drum(SLOW)],
            "series from DMA data, M above its maximum": [drum(FAST)],
        },
    ),
]
LOADS = [{"load": share * LOAD, "name": f"at {share:g} P"} for share in (0.3, 2.0)]
TWO_LOADS = [motion(3.0, 30.0, **at) for at in LOADS]
IN_A_BEARING = [
    (
        SHAPE,
        {
            "coast-down 3 m/s, one load": [motion(3.0, 30.0)],
            "the same at 0.3 P and 2 P": TWO_LOADS,
            "M across its maximum, one load": HUMPED,
            "M across its maximum at 0.3 P and 2 P": [drum(HUMP, **at) for at in LOADS],
        },
    ),
    (
        ("E", "T_ref"),
        {
            "series from DMA data, coast-down 3 m/s, one load": [motion(3.0, 30.0)],
            "series from DMA data, the same at 0.3 P and 2 P": TWO_LOADS,
        },
    ),
]
#: experiments whose intervals are counted, and their unknowns
COUNTED = {
    "M across its maximum": (HUMPED, SHAPE),
    "M across its maximum and Q at 0.1 m/s": ([*HUMPED, traction(0.1)], tuple(TRUTH)),
    "launched without rotation, V and omega": ([thrown("V omega")], tuple(TRUTH)),
}
#: one of which a product is
PRODUCT = {"M below its maximum": ([drum(SLOW)], SHAPE, "E_1 T_ref")}
SEARCHED = {
    "M across its maximum": (HUMPED, SHAPE),
    "coast-down to 0": (ROLLED, SHAPE),
    "launched without rotation, V": (THROWN, tuple(TRUTH)),
}


def ranges(names: Iterable[str], records: Iterable[Record]) -> dict[str, tuple[float, float]]:
    """Of the unknowns, and of the first speeds of motions: none is known for sure."""
    motions = (one for one in records if isinstance(one, vr.Coastdown))
    starts = {
        f"V0:{one.name}": (0.2 * one.V0, 5.0 * one.V0) for one in motions if one.V0 is not None
    }
    return {each: RANGES[each] for each in names} | starts


def told(name: str, fit: Identification) -> Row:
    """A row: of each unknown s.d. and ends of the interval, both over the truth, less 1 (results
    keep three digits).
    """
    unknowns = {}
    for each, value in (TRUTH | BEARING).items():
        if each in fit.values:
            low, high = (
                None if end is None else end / value - 1.0 for end in fit.intervals()[each]
            )
            unknowns[each] = {"sd": fit.stderr[each] / value, "low": low, "high": high}
    products = [
        {"powers": one.powers, "low": one.low - 1.0, "high": one.high - 1.0, "near": one.near}
        for one in fit.products()
    ]
    return {
        "experiment": name,
        "unknowns": unknowns,
        "does_not_act": fit.does_not_act,
        "undetermined": fit.undetermined,
        "products": products,
    }


def learn(sizes, of=EXPERIMENTS, bearing=None):
    """What experiments would tell of the truth: of a roller in a bearing, of exact data, as no plan
    has a bearing.
    """

    def fit(names, records):
        if bearing:
            return fitted(records, None, names, bearing=bearing)
        return vr.identify(roller(), ranges(names, records), records)

    return [
        told(name, fit(names, records))
        for names, group in of
        for name, records in first(group, sizes)
    ]


def first(group: Row, sizes: Sizes) -> Iterable[tuple[str, Any]]:
    """As many experiments as are asked for."""
    return tqdm([*group.items()][: sizes["experiments"]])


def _measured(record, rng, bearing=None):
    """A planned record with values, at the truth, with noise."""
    exact = record.model(roller().replace(**record.overrides), bearing or {})
    values = {
        name: exact[name] + (0.0 if rng is None else sigma * rng.standard_normal(exact[name].shape))
        for name, sigma in record.sigma.items()
    }
    return replace(record, **values)


def fitted(
    records: list[Record],
    seed: int | None,
    names: Iterable[str] = TRUTH,
    start: dict[str, float] = TRUTH,
    *,
    starts: int = 1,
    bearing: dict[str, float] | None = None,
) -> Identification:
    """A fit to a synthetic data set, without a seed to exact data; with a bearing, which is unknown
    then.
    """
    noise = (
        None if seed is None else np.random.default_rng([seed, n]) for n in range(len(records))
    )
    data = [_measured(one, rng, bearing) for one, rng in zip(records, noise)]
    given = ranges(names, data) | (BEARINGS if bearing else {})
    return vr.identify(roller(TRUTH | start), given, data, starts=starts, seed=0)


def said(sizes):
    """Reports of six problems that cannot be solved as they are put."""
    two = roller().replace(material=vr.Material(3e6, 0.5, vr.Prony([4.0, 5.0], [1.0, 0.05]), 1e-3))
    exact = two.contact(HUMP, delta=0.0, fields="M").M
    bad = [
        vr.Resistance(
            HUMP, exact + 0.01 * np.random.default_rng(10).standard_normal(HUMP.size), sigma=0.01
        )
    ]
    held = [_measured(ROLLED[0], np.random.default_rng(11), BEARING)]
    fits = {
        "M below its maximum": lambda: fitted([drum(SLOW)], 2),
        "M above its maximum": lambda: fitted([drum(FAST)], 2),
        "Q at one low speed": lambda: fitted([traction(0.1)], 2),
        "Q at two speeds": lambda: fitted([traction(0.1, 1.0)], 0, starts=sizes["searches"]),
        "M of two relaxation times, fitted by one": lambda: vr.identify(
            roller(), ranges(SHAPE, bad), bad, starts=1
        ),
        "a coast-down whose bearing is left out": lambda: vr.identify(
            roller(), ranges(SHAPE, held), held, starts=1
        ),
    }
    return [{"problem": name, "report": str(fit())} for name, fit in first(fits, sizes)]


def coverage(sizes):
    """Share of data sets whose intervals hold the truth: those in which chi2 rises by no more than
    3.84 up to there.
    """
    rows = []
    for name, (records, names, *counted) in first(COUNTED | PRODUCT, sizes):
        fits = [fitted(records, sizes["seed"] + n, names) for n in tqdm(range(sizes["sets"]), name)]
        held = {
            each: np.mean([rise_at_truth(fit, each) <= RISE for fit in fits])
            for each in counted or names
        }
        rows.append({"experiment": name, "sets": sizes["sets"], "held": held})
    return rows


def rise_at_truth(fit: Identification, product: str) -> float:
    """By what chi2 rises with an unknown, or a product of some, held at its true value, all others
    following.
    """
    walk = ProfileWalk(
        fit._likelihood, np.array([float(name in product.split()) for name in fit.values]), RISE
    )
    true = np.log([TRUTH.get(name, 1.0) for name in fit.values])
    return walk.minimum_at(walk.distance(true), fit._likelihood.best.u).chi2 - fit.chi2


def reach(sizes):
    """Share of single searches from starts a factor of ten off that arrive."""
    rows = []
    for name, (records, names) in first(SEARCHED, sizes):
        rng = np.random.default_rng(sizes["seed"])
        at = partial(fitted, records, sizes["seed"], names)
        off = 10.0 ** rng.uniform(-1.0, 1.0, (sizes["starts"], len(names)))
        starts = (
            {each: TRUTH[each] * one for each, one in zip(names, row)} for row in off.tolist()
        )
        chi2 = np.array([at(start).chi2 for start in tqdm(starts, name, sizes["starts"])])
        share = np.mean(chi2 < min(*chi2, at().chi2) + _ARRIVED)
        rows.append({"experiment": name, "starts": sizes["starts"], "reached": share})
    return rows


def width(sizes):
    """Largest difference of an end from a scan of the profile, over the width of the interval."""
    rows = []
    for name, (records, names) in first(COUNTED, sizes):
        fit = fitted(records, sizes["seed"], names)
        off = 0.0
        for each in names[: sizes["scanned"]]:
            ends = np.array(fit.intervals()[each], dtype=float)
            others = [other for other in names if other != each]
            for end, side in zip(ends, (-1.0, 1.0)):
                near = end + side * np.ptp(ends) * np.linspace(-0.05, 0.05, sizes["scan"])
                held = (
                    fitted(records, sizes["seed"], others, fit.values | {each: value})
                    for value in near.tolist()
                )
                rise = [one.chi2 - fit.chi2 for one in held]
                off = max(off, abs(np.interp(RISE, rise, near) - end) / np.ptp(ends))
        rows.append({"experiment": name, "off": off})
    return rows


def times(sizes):
    """Seconds of a fit of five unknowns to 200 points, from 30 % off, of its five profiles, of a
    fit from several starts, and of one prediction of the data by a new law.
    """
    cases = {
        "launched without rotation, V: 5 unknowns, 200 points": THROWN,
        "M across its maximum and Q: 4 unknowns, 61 points": [*HUMPED, traction(0.1)],
    }
    return [
        {"case": name, "searches": sizes["searches"]} | _times_of(records, sizes)
        for name, records in cases.items()
    ]


def _times_of(records, sizes):
    """What a fit to records takes, as :func:`times`."""
    random = np.random.default_rng(sizes["seed"])
    search = partial(
        fitted, records, sizes["seed"], start={name: 1.3 * value for name, value in TRUTH.items()}
    )

    def predict():
        at = roller(TRUTH | {"E_1": random.uniform(8.0, 10.0)})
        return [each.model(at.replace(**each.overrides), {}) for each in records]

    calls = {
        "fit_s": search,
        "profiles_s": lambda: search().intervals(),
        "searches_s": partial(search, starts=sizes["searches"]),
        "prediction_s": predict,
    }
    found = timed({name: (1e9, call) for name, call in calls.items()}, sizes["repeats"])
    taken = {name: each["ns"] for name, each in found.items()}
    taken["profiles_s"] -= taken["fit_s"]
    taken["fit"] = taken["fit_s"] / taken["prediction_s"]
    taken["profiles"] = taken["profiles_s"] / taken["fit_s"]
    return taken


PARTS = {
    "learn": learn,
    "bearing": partial(learn, of=IN_A_BEARING, bearing=BEARING),
    "said": said,
    "time": times,
    "width": width,
    "reach": reach,
    "coverage": coverage,
}


def complaint(row: Row) -> str | None:
    """What a row exceeds of what is asked."""
    counted = row["held"] if row.get("sets", 0) >= FEWEST else {}
    found = {f"{name} held by its interval": ("held", share) for name, share in counted.items()}
    found |= {name: (name, row[name]) for name in ("off", "fit", "profiles") if name in row}
    faults = [
        f"{name}: {value:.3g}"
        for name, (kind, value) in found.items()
        if not ASKED[kind][0] <= value <= ASKED[kind][1]
    ]
    if row.get("reached", 1.0) < REACHED.get(row.get("experiment", ""), 0.0):
        faults.append(f"{row['reached']:.0%} of starts arrive")
    return f"{row.get('experiment', row.get('case'))}: {', '.join(faults)}" if faults else None


if __name__ == "__main__":
    os.environ["VISCOROLL_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"
    sys.exit(run_parts("identification", PARTS, __doc__, "identification.json", complaint))
