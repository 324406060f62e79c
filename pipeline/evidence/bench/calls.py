"""Calls that are timed in turn on one core: states of the law, motions of materials, a map."""

import ctypes
from functools import partial

import numba
import numpy as np
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.kernels.law.law_callables import RESULTS
from viscoroll.laws.law_tables import make_table
from viscoroll.motion import flow

from ..timing import seconds_of, timed
from .motions import speed_error

PAPER = vr.presets.PAPER_SECTION_5_ROUNDED


def speeds_and_creep(random: np.random.Generator, count: int) -> tuple[NDArray, NDArray]:
    """V of a motion's end to its start, and creep over that of full slip."""
    return np.exp(random.uniform(np.log(1e-3), np.log(2.0), count)), random.uniform(size=count)


def creep(scene: vr.Scene, V: NDArray, s: NDArray) -> NDArray:
    return s * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star


def starts(random: np.random.Generator, count: int) -> NDArray:
    """V0 and omega0."""
    return random.uniform(-2.0, 2.0, (2, count))


def ensemble(scene: vr.Scene, start: NDArray, t, fields=("V", "omega"), **how):
    """A call on one thread, by the integrator unless told."""
    given = {"method": "integrate", "threads": 1} | how
    return partial(vr.ensemble, scene, *start, t, fields=fields, **given)


@numba.njit
def jitted_states(law, V, omega):
    """Sum over states, so that none is left out."""
    total = 0.0
    for i in range(V.size):
        state = law(V[i], omega[i])
        total += state.Q + state.M + state.dQ_dV + state.dQ_domega + state.dM_cylinder_dV
    return total


def bound_law(sizes):
    """A row for each material and way to call the law of a scene, with that of contact() called
    alike.

    The states are those of one motion: creep from 0 to delta_star, speeds within a factor of 2.
    """
    random = np.random.default_rng(sizes["seed"])
    n = sizes["states"]
    few = sizes["numbers"]
    V = random.uniform(0.2, 0.4, n)
    share = random.uniform(size=n)
    three = PAPER.replace(material=rubber(3))
    base = PAPER.replace(material=vr.Bodies(rubber(3), vr.Prony.elastic(), 0.8))
    calls = {}
    for name, scene in {
        "one alpha": PAPER,
        "3 modes": three,
        "3 modes on an elastic base": base,
    }.items():
        # compiled
        omega = V * (1.0 + creep(scene, V, share))
        law = vr.law(scene)
        numbers = list(zip(V[:few].tolist(), omega[:few].tolist()))
        function, data = law.ctypes
        out = (ctypes.c_double * RESULTS)()

        def contact(v, w, slopes, scene=scene):
            return vr.contact(
                scene, v, omega=w, fields=("Q", "M", "M_half_space", "M_cylinder"), slopes=slopes
            )

        def each(call, numbers=numbers):
            return few, lambda: [call(v, w) for v, w in numbers]

        for slopes in (False, True):
            for who, call in {"": law, ", contact": contact}.items():
                one = partial(call, slopes=slopes)
                calls[name, f"numbers{who}", slopes] = each(one)
                calls[name, f"array{who}", slopes] = n, partial(one, V, omega)
        calls[name, "jitted", True] = n, partial(jitted_states, law.jitted, V, omega)
        called = partial(lambda call, out, data, v, w: call(v, w, out, data), function, out, data)
        calls[name, "C by ctypes", True] = each(called)
    found = timed(calls, sizes["repeats"])
    return [
        {"material": name, "way": way, "slopes": slopes}
        | ns
        | {"contact": found[name, ("array" if way == "array" else "numbers") + ", contact", slopes]}
        for (name, way, slopes), ns in found.items()
        if not way.endswith(", contact")
    ]


def rubber(modes: int, strength: float = 10.0) -> vr.Prony:
    """Equal strengths that sum up to ``strength``, times a third of a decade apart, as a fit has
    them.
    """
    return vr.Prony(np.full(modes, strength / modes), 3.0 ** -np.arange(float(modes)))


def series(sizes):
    """A row a material: nanoseconds a state and a motion, and milliseconds of its table."""
    random = np.random.default_rng(sizes["seed"])
    n = sizes["states"]
    m = sizes["motions"]
    V, s = speeds_and_creep(random, n)
    start = starts(random, m)
    t = np.linspace(0.0, sizes["end"], sizes["times"])

    def spread(modes):
        """Materials whose strengths and times are off by some 10 and 30 %."""
        mean = rubber(modes)
        off = random.standard_normal((2, m, modes))
        return vr.Prony(mean.E * np.exp(0.1 * off[0]), mean.tau * np.exp(0.3 * off[1]))

    materials = {f"{modes} mode{'s' * (modes > 1)}": rubber(modes) for modes in (1, 3, 10, 30)}
    materials["pair of 10 and 3 modes"] = vr.Bodies(rubber(10), rubber(3, 2.0), 0.4)
    each = ", a different material for each motion"
    many = {f"{modes} mode{'s' * (modes > 1)}{each}": spread(modes) for modes in (1, 3, 10)}
    many["3 and 3 modes, a different pair for each motion"] = vr.Bodies(spread(3), spread(3), 0.4)
    scenes = {
        name: PAPER.replace(material=material) for name, material in (materials | many).items()
    }
    calls = {}
    for name, scene in ({"alpha = 11": PAPER} | scenes).items():
        if name not in many:
            fields = ("Q", "M") if scene.like_bodies else ("Q", "M", "M_half_space")
            calls[name, "contact"] = (
                n,
                partial(vr.contact, scene, V, delta=creep(scene, V, s), fields=fields),
            )
        calls[name, "motion"] = (
            m,
            ensemble(scene, start, t, ("V", "omega", "x"), rtol=sizes["rtol"]),
        )
    rows = {}
    for (name, kind), ns in timed(calls, sizes["repeats"]).items():
        rows.setdefault(name, {"material": name, "table_ms": None})[kind] = ns
    for name, material in materials.items():
        rows[name]["table_ms"] = 1e3 * seconds_of(partial(make_table, material))[0]
    return [*rows.values()]


def fixed_scene(sizes):
    """Many motions of one scene by its flow map: ns a motion by fields and output times; the map's
    own figures.
    """
    start = starts(np.random.default_rng(sizes["seed"]), sizes["motions"])
    t = np.linspace(0.0, sizes["end"], sizes["times"] + 1)[1:]

    def load():
        flow._map.cache_clear()
        return flow.flow_map(PAPER, 2.0)

    table = load()
    calls = {}
    for times in (t[-1:], t):
        for fields in (("V", "omega"), ("V", "omega", "x")):
            named = ", ".join(fields)
            name = f"final {named}" if times.size == 1 else f"{named} at {t.size} times"
            calls[name] = start[0].size, ensemble(PAPER, start, times, fields, method="flow")
    rows = timed(calls, sizes["repeats"])
    once = timed(
        {
            "build": (1e9, partial(flow.build_map, *flow.map_key(PAPER, 2.0), 1)),
            "load": (1e9, load),
        },
        sizes["repeats"],
    )
    few = start[:, : sizes["exact"]]
    mine = ensemble(PAPER, few, t, method="flow")()
    by_map = mine.flow
    off = speed_error(mine, ensemble(PAPER, few, t, rtol=1e-11)())
    return {
        "rows": [{"call": name} | row for name, row in rows.items()],
        "error": {
            "final": off[by_map, -1].max(),
            "all_times": off[by_map].max(),
            "with_integrated": off.max(),
        },
        "compared": by_map.size,
        "not_in_map": int((~by_map).sum()),
        "stated_error": table.errors[0],
        "stated_path_error": table.errors[1],
        "build_s": once["build"]["ns"],
        "load_s": once["load"]["ns"],
        "bytes": int(table.table.nbytes),
    }
