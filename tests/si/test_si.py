"""A cylinder in SI units: every call is the dimensionless one in other units, of one cylinder and
of many.
"""

from types import SimpleNamespace

import numpy as np
import pytest
import tolerances as tol
from calls import SOFT, STEEL, pair
from closeness import close

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

ROLLER = vr.presets.PAPER_CYLINDER
TIMES = np.linspace(0.0, 2.0, 9)
DOWN = -0.05
WORKS = "work_force work_torque brake_loss slip_loss rolling_loss"


def units_of(roller, P):
    """By hand: R, T_ref, the load on the plane, and what is made of them."""
    R = roller.R
    T = roller.T_ref
    found = {
        "t": T,
        "x": R,
        "l0": roller.l0,
        "V": R / T,
        "omega": 1.0 / T,
        "N": P * T**2,
        "dQ_dV": P * T / R,
        "eigenvalues": P * T / (roller.m * R),
    }
    for names, unit in {
        "force Q dQ_ddelta": P,
        "torque M M_half_space M_cylinder": P * R,
        "zeta rest_time onset_time": T,
        "dQ_domega dM_dV dM_half_space_dV dM_cylinder_dV": P * T,
        "p tau": roller.E_prime,
        WORKS: roller.m * (R / T) ** 2,
    }.items():
        found |= dict.fromkeys(names.split(), unit)
    return found


def everything_acts(body, u):
    """Numbers, schedules, callables, feedback, slope, brake."""
    return body.roll(
        0.02 / u.V,
        0.1 / u.omega,
        TIMES / u.t,
        slope=DOWN,
        force=vr.Feedback(
            lambda t: np.sin(t * u.t) / u.force,
            V=-3.0 * u.V / u.force,
            omega=0.2 * u.omega / u.force,
        ),
        torque=vr.Schedule(np.array([0.5, 1.0, 1.0]) / u.t, np.array([0.0, 4.0, 1.0]) / u.torque),
        brake=vr.Schedule(np.array([1.5, 1.5]) / u.t, np.array([0.0, 6.0]) / u.torque),
    )


def spun(body, u):
    return body.roll(
        0.0,
        None,
        TIMES / u.t,
        omega=vr.Schedule(np.array([0.0, 1.0]) / u.t, np.array([0.0, 0.5]) / u.omega),
    )


SPEEDS = np.array([-0.2, 0.05, 0.3])
SPINS = np.array([-1.99, 0.5, 3.1])
STATE = "lam zeta epsilon delta_star delta beta Q M dQ_dV dQ_domega dQ_ddelta dM_dV"
PARTS = "M_half_space M_cylinder dM_half_space_dV dM_cylinder_dV"
MOTION = "V omega x angle delta regime"
DRIVEN = f"{MOTION} force torque {WORKS}"


def of_states(fields):
    """The call of contact, and these fields."""
    return (
        lambda body, u: body.contact(SPEEDS / u.V, omega=SPINS / u.omega, fields=fields.split()),
        fields,
    )


#: the call of a body in units, the fields of its result, and how near they are
CALLS = {
    "contact": of_states(f"{STATE} N"),
    "two bodies": of_states(f"{STATE} {PARTS}"),
    "stress": (
        lambda body, u: body.stress(np.linspace(-1e-3, 1e-3, 9) / u.l0, 0.05 / u.V, delta=1e-3),
        "p tau",
    ),
    "steady": (
        lambda body, u: body.steady(force=-2.0 / u.force, torque=0.15 / u.torque, slope=DOWN),
        "V omega delta Q M force torque grip eigenvalues",
    ),
    "resistance_extrema": (lambda body, u: body.resistance_extrema(), "V M"),
    "law": (
        lambda body, u: body.law()(0.05 / u.V, 0.5 / u.omega, slopes=True),
        f"Q M {PARTS} dQ_dV dQ_domega",
    ),
    "free": (
        lambda body, u: body.roll(0.02 / u.V, 0.1 / u.omega, 100.0 / u.t, rest=1e-5 / u.V),
        f"{MOTION} rest_time",
    ),
    "driven": (everything_acts, DRIVEN),
    "spun": (spun, DRIVEN),
    "from rest": (
        lambda body, u: body.roll(
            1.0 / u.V, 10.0 / u.omega, TIMES / u.t, unsteady=True, rested=60.0 / u.t
        ),
        MOTION,
    ),
    "ensemble": (
        lambda body, u: body.ensemble(
            np.array([0.01, 0.02]) / u.V, 0.1 / u.omega, TIMES / u.t, rest=1e-6 / u.V
        ),
        "V omega x onset_time rest_time",
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_the_dimensionless_call_in_other_units(name):
    call, fields = CALLS[name]
    roller = {
        "two bodies": pair(SOFT, STEEL, load=2e3),
        "from rest": vr.presets.RUBBER_CYLINDER,
    }.get(name, ROLLER)
    tilted = name in ("steady", "driven")
    unit = units_of(roller, roller.load * (np.cos(DOWN) if tilted else 1.0))
    found = call(roller, SimpleNamespace(**dict.fromkeys(unit, 1.0)))
    bare = call(roller.scene(), SimpleNamespace(**unit))
    rel = {"driven": tol.SI_TILTED, "steady": tol.STEADY, "ensemble": tol.SI_ENSEMBLE}.get(
        name, tol.SI_MOTION
    )
    for field in fields.split():
        exact = np.asarray(getattr(bare, field)) * unit.get(field, 1.0)
        largest = np.abs(exact[np.isfinite(exact)]).max(initial=0.0)
        assert close(getattr(found, field), exact, rel, scale=largest, what=field)
    for events in ("switches", "reversals") if field == "rolling_loss" else ():
        pairs = ([getattr(e, "t", e) for e in getattr(m, events)] for m in (found, bare))
        times, exact = map(np.array, pairs)
        assert not times.size or close(times, exact * unit["t"], rel)


# --- many cylinders ---

MANY = {
    "m, mu and load": (
        ROLLER,
        {"m": [30.0, 40.0, 35.0], "mu": [0.2, 0.3, 0.4], "load": [300.0, 340.0, 380.0]},
    ),
    "load and R": (
        vr.presets.RUBBER_CYLINDER,
        {"load": [50.0, 200.0, 900.0], "R": [0.05, 0.1, 0.2]},
    ),
    "times": (ROLLER, {"T_epsilon": [1e-3, 1e-2, 2e-2], "T_sigma": [1e-3, 1e-3, 5e-3]}),
}


@pytest.mark.parametrize("name", MANY)
def test_each_of_many_is_as_alone(name):
    """Gains over m/s and rad/s too."""
    roller, each = MANY[name]
    many = roller.replace(**each)
    drags = np.array([0.002, 0.0, 0.03])
    fields = ("V", "omega", "x", "torque", "rolling_loss", "onset_time")
    e = many.ensemble(
        0.5, 3.0, TIMES, torque=vr.Feedback(0.01, V=-0.001, omega=-drags), fields=fields[:-1]
    )
    state = many.contact(0.5, delta=0.01)
    unsteady = many.validity(0.5).steady.value
    s = many.steady(slope=1e-3) if name != "times" else None  # of one alpha
    for n in range(3):
        one = roller.replace(**{key: values[n] for key, values in each.items()})
        m = one.roll(0.5, 3.0, TIMES, torque=vr.Feedback(0.01, V=-0.001, omega=-drags[n]))
        for field in fields:
            exact = getattr(m, field)
            scale = np.abs(np.nan_to_num(exact)).max()
            assert close(getattr(e, field)[n], exact, tol.SI_ENSEMBLE, scale=scale, what=field)
        for field in ("M", "Q", "length", "beta"):
            exact = getattr(one.contact(0.5, delta=0.01), field)
            assert close(getattr(state, field)[n], exact, tol.SI_MOTION, what=field)
        alone = one.validity(0.5).steady.value
        assert close(unsteady[n], alone, tol.STEADINESS, scale=1e-9)
        if s is not None:
            rolling = one.steady(slope=1e-3)
            held = slice(s.count[n])
            assert close(s.V[n, held], rolling.V, tol.SI_MOTION)
            assert close(s.eigenvalues[n, held], rolling.eigenvalues, tol.SI_MOTION)
    again = roller.replace(**each)
    assert (many, hash(many)) == (again, hash(again))


def test_no_cylinders_have_no_states():
    none = ROLLER.replace(T_epsilon=[])
    for found in (none.contact(1.0, delta=0.0).M, none.validity(1.0).small_contact.value):
        assert found.shape == (0,)
