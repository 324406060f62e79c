"""Materials of many relaxation times and pairs against the matching conditions in balls.

The conditions stand in ``pipeline.evidence.truth`` as they were derived, without the
system that the kernels solve; that they are the contact's, boundary elements say (:mod:`states`),
which know none of them.
"""

import math
from functools import partial

import flint
import numpy as np
from flint import arb
from numpy.random import Generator

import viscoroll as vr
from viscoroll.contact_mechanics.contact_table import OF_BODIES
from viscoroll.kernels.law.material_series import FUNCTIONS, new_workspace
from viscoroll.kernels.law.modes import modes_loop
from viscoroll.laws.law_rows import modes_record

from ..truth import INPUTS, Material, enclosed, material_of, slopes, zone_of
from .cases import Proof, at, powers
from .states import EPSILON, LAM

BITS = 400
DECADES = 14.0
#: fields whose errors are divided by the condition of beta
ILL_CONDITIONED = ("beta", "dQ_dV", "dQ_ddelta", "dQ_domega")
#: states of one alpha that are evaluated by the axis of alpha
STATES_OF_ALPHA = 2000
#: e-folds beyond the shortest and the longest time
BELOW = 30.0
ABOVE = 28.0


def random_series(random: Generator, modes: int) -> vr.Prony:
    """Times even in their logarithm over some of the decades, strengths over two of ten; slow time
    near 1.
    """
    span = random.uniform(0.1, DECADES)
    size = random.uniform(-2.0, 6.0)
    E = 10.0 ** random.uniform(size - 2.0, size, modes)
    return vr.Prony(E, 10.0 ** random.uniform(-span, 0.0, modes)).in_own_time()[0]


def of_z(p: vr.Prony, z: float) -> list[float]:
    """g, h and m, by the modes."""
    series = modes_record(p.modes)
    found = np.empty((2 * FUNCTIONS + 1, 1))
    place = np.array([z])
    place.flags.writeable = False
    modes_loop(series, np.empty(0), new_workspace(p.E.size), place, found)
    shift, rise, half_space, cylinder = found[:FUNCTIONS, 0].tolist()
    return [shift * z, rise * z, half_space + cylinder]


def functions(random, count, modes):
    """g, h and m, which rows are made of, over all z: ten z a material, of many modes fewer."""
    for _ in range(max(count // modes // 10, 1)):
        p = random_series(random, modes)
        with flint.ctx.workprec(BITS):
            material = material_of(p)
            for z in np.exp(
                random.uniform(np.log(p.tau[-1]) - BELOW, np.log(p.T[0]) + ABOVE, 10)
            ).tolist():
                pairs = zip(of_z(p, z), zone_of(material, arb(z)))
                yield (
                    f"{at(z=z)}, {p!r}",
                    {"": [abs(float(value / exact - 1)) for value, exact in pairs]},
                )


def state_errors(given, V: float, delta: float) -> dict[str, float]:
    """Relative errors of a state by its rows at kappa = mu = 1: beta and the slopes of Q over the
    condition of beta.

    dQ_dV over mu/V where it is below, dM_dV and the parts of M in the bodies over M/V or M.
    """
    # balls, but for a series or bodies
    balls = dict(zip(INPUTS, (given, *map(arb, (1, 1, V, delta))))) | (
        {"alpha": arb(given)} if isinstance(given, float) else {}
    )
    truth = enclosed(balls, 100) | slopes(balls)
    with flint.ctx.workprec(BITS):
        truth["dQ_domega"] = truth["dQ_ddelta"] / V
        condition = 1 / (1 - delta / truth["delta_star"])
        scales = {
            "dQ_dV": max(abs(truth["dQ_dV"]), 1 / arb(V)),
            "dM_dV": truth["M"] / V,
            **dict.fromkeys(OF_BODIES, truth["M"]),
        }
        material = {"alpha": given} if isinstance(given, float) else {"material": given}
        fields = sorted(truth.keys() - {"zeta", "full_slip"})
        found = vr.contact(vr.Scene(kappa=1.0, mu=1.0, **material), V, delta=delta, fields=fields)
        errors = {}
        for name in fields:
            off = abs(arb(float(getattr(found, name))) - truth[name])
            ill = condition if name in ILL_CONDITIONED else 1
            errors[name] = float(off / (scales.get(name, abs(truth[name])) * ill))
    return errors


def any_state(random: Generator, material: Material) -> tuple[float, float]:
    """V and delta: zeta from 14 decades below the fastest time to 14 above the slowest or near
    them, 1 - beta any.
    """
    near, far = (math.log10(float(1 / rate)) for rate in (material.a[-1], material.b[0]))
    beyond = 14.0 if random.random() < 0.3 else 2.0
    small, gap = powers(random, (-14.0, 0.0), (-7.0, 0.0))
    zeta = arb(powers(random, (near - beyond, far + beyond))[0])
    eta = zeta * (1 - arb((small, random.random(), 1.0 - gap)[random.integers(3)]))
    whole = zone_of(material, zeta)
    stick = zone_of(material, eta)
    V = 1 / (2 * (zeta * (zeta + 2 * whole.h)).sqrt())
    return float(V), float((zeta + whole.g - eta - stick.g) * V)


def any_material(random: Generator, n: int):
    """An alpha, a series, a pair by turns; now and then an alpha whose rows are least exact, and 30
    modes.
    """
    if n % 10 == 4:
        return float(random.uniform(20.0, 35.0))
    if n % 20 == 19:
        return random_series(random, 30)
    made = (
        lambda: 1.0 + powers(random, (-8.0, 6.0))[0],
        lambda: random_series(random, int(random.integers(1, 11))),
        lambda: vr.Bodies(
            *(random_series(random, int(m)) for m in random.integers(1, 6, 2)),
            random.uniform(0.1, 0.9),
        ),
    )
    return made[n % 3]()


def states(random, count):
    """Every field of states by their rows, five a material."""
    for n in range(count):
        given = any_material(random, n)
        for _ in range(5):
            with flint.ctx.workprec(BITS):
                V, delta = any_state(random, material_of(given))
            yield f"{at(V=V, delta=delta)}, {given!r}", state_errors(given, V, delta)


def axis_states(random, count):
    """Yield differences of states by the axis of alpha, as where there are several, from those by
    the rows of alpha.

    count: how many alphas; each second one is between 20 and 35, where rows are least exact.
    """
    for n in range(count):
        alpha = float(random.uniform(20.0, 35.0)) if n % 2 else 1.0 + powers(random, (-8.0, 6.0))[0]
        scene = vr.Scene(alpha, 1.0, 1.0)
        V = 10.0 ** random.uniform(-6.0, 9.0, STATES_OF_ALPHA)
        V[::2] = 10.0 ** random.uniform(-2.0, 2.0, V[::2].size)
        s = random.choice([10.0 ** random.uniform(-6.0, 0.0, V.size), random.random(V.size)])
        delta = s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        fields = (*AXIS_CLAIMS, "M")
        by_rows = vr.contact(scene, V, delta=delta, fields=fields).as_dict()
        by_axis = vr.contact(
            scene.replace(alpha=np.full(V.size, alpha)), V, delta=delta, fields=fields
        ).as_dict()
        scales = {name: abs(value) for name, value in by_rows.items()}
        scales |= {
            "dQ_dV": np.maximum(scales["dQ_dV"], 1.0 / V),
            "dM_dV": by_rows["M"] / V,
            "epsilon": np.maximum(scales["epsilon"], 1.0),
        }
        for name in ILL_CONDITIONED:
            scales[name] = scales[name] / (1.0 - s)
        errors = {name: abs(by_axis[name] - by_rows[name]) / scales[name] for name in AXIS_CLAIMS}
        yield at(alpha=alpha), errors


def _states(sentence, bound, *names):
    return {name: (f"{name}, {sentence}, by rows", bound) for name in names}


#: field -> divisor of its error, and bound: rounding of the sum over 16 terms in alpha; Q has ten
#: times as much where it is the difference of two numbers, and so have slopes at the ends of rows
AXIS_CLAIMS = {
    "lam": ("relative", 5e-15),
    "epsilon": ("relative, or absolute below 1", 2e-14),
    "delta_star": ("relative", 5e-15),
    "beta": ("divided by its condition", 1e-14),
    "M": ("relative", 1e-14),
    "Q": ("relative", 3e-14),
    "dQ_ddelta": ("relative, divided by the condition of beta", 1e-14),
    "dQ_domega": ("relative, divided by the condition of beta", 1e-14),
    "dQ_dV": ("divided by mu/V and by the condition of beta", 2e-14),
    "dM_dV": ("divided by M/V", 2e-13),
}


PROOFS = [
    *(
        Proof(
            "series",
            "series_states",
            f"times over up to {DECADES:g} decades, z from the least e^-{BELOW:g} to the longest "
            f"e^{ABOVE:g}",
            {"": (f"g, h, m of {modes} mode{'s' * (modes > 1)}", 1e-13)},
            partial(functions, modes=modes),
            f"{modes} modes",
        )
        for modes in (1, 3, 10, 30)
    ),
    Proof(
        "states",
        "state_materials",
        "alpha - 1 from 1e-8 to 1e6, 1 to 10 and 30 "
        "modes, pairs of 1 to 5 modes a body; kappa V from 1e-14 over the slowest time to 1e14 "
        "over the fastest, creep "
        "from 1e-14 delta_star to its end",
        _states("relative", 5e-15, "delta_star", "Q", "M")
        # strengths of 1e4 beside 1: what a slow mode takes of M is then a difference
        | _states("divided by M", 1e-12, *OF_BODIES)
        # for alpha above 15, 24 powers of one octave leave up to 2e-14 of epsilon and 1.1e-14 of
        # lam; of the slope of M, near the ends of that octave, 1e-13
        | _states("relative", LAM, "lam")
        | _states("relative", EPSILON, "epsilon")
        | _states("divided by its condition", 1.5e-14, "beta")
        | _states("relative, divided by the condition of beta", 1e-14, "dQ_ddelta", "dQ_domega")
        | _states("divided by mu/V and by the condition of beta", 1e-14, "dQ_dV")
        | _states("divided by M/V", 1.5e-13, "dM_dV"),
        states,
    ),
    Proof(
        "states",
        "axis_alphas",
        "alpha - 1 from 1e-8 to 1e6, kappa V from 1e-6 to 1e9, creep from 1e-6 "
        "delta_star to its end",
        {
            name: (
                f"{name} by the axis of alpha, as of an alpha each, from that by the rows of "
                f"alpha, {words}",
                bound,
            )
            for name, (words, bound) in AXIS_CLAIMS.items()
        },
        axis_states,
    ),
]
