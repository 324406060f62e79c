"""The defects that pipeline/evidence/mutate/ plants, each in one place of the kernels, and the tests that should notice."""

# ruff: noqa: E501
from __future__ import annotations

from typing import NamedTuple


class Mutant(NamedTuple):
    """``old`` occurs once in the kernel ``file`` and becomes ``new``; for a table, ``old`` is the coefficient's number.

    ``tests`` : files of tests, or tests of one, with spaces between.
    """

    file: str
    old: str
    new: str
    tests: str


def claims(*proofs: str) -> str:
    """Claims of these proofs."""
    return " ".join(f"tests/test_claims.py::test_claims[{proof}]" for proof in proofs)


_LAW, _RATIOS = "tests/test_contact.py", "tests/kernels/bessel/test_ratios.py"
_STATES, _SLOPES, _MOTION, _DRIVEN = (
    claims("contact", "states"),
    claims("slopes"),
    claims("motion"),
    claims("check_driven"),
)
_DIRECT, _STEADY, _BOUND = "tests/kernels/printed/test_direct.py", "tests/test_steady.py", "tests/test_bound_law.py"
_DRIVE, _EVENTS = "tests/motion/test_drive.py", "tests/motion/test_hard_motions.py"

LAW = [
    ("rows/series.py", "times(jets, X, load(work.i2, at))", "times(jets, ey, load(work.i2, at))", _STATES),
    ("rows/series.py", "p1 * q0 + p0 * q1", "p1 * q0 - p0 * q1", _STATES),
    ("rows/series.py", "for turn in range(3 if jets else 1):", "for turn in range(1):", _STATES),
    ("numerics/interpolation.py", "weights = [1 / ((1 - x * x)", "weights = [(1 + Decimal('1e-9')) / ((1 - x * x)", _SLOPES),
    ("rows/contact_states.py", "return -creep if V < 0.0 else creep, creep", "return creep, creep", _LAW),
    ("rows/contact_states.py", "else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)", "else np.copysign(np.inf, slip)", _LAW),
    ("rows/modes.py", "di2 = r - (2.0 / x + r) * i2", "di2 = r - (1.0 / x + r) * i2", _STATES),
    ("bessel/ratios.py", "_NEAR, _FAR = 0.0625, 64.0\n", "_NEAR, _FAR = 0.0625, 24.0\n", _RATIOS),
    ("bessel/ratios.py", "return 1.0 - 2.0 * r / x", "return 1.0 - (2.0 + 1e-10) * r / x", _RATIOS),
    ("bessel/ratios.py", "return k if z < 1.0 else", "return k if z <= 1.0 else", _RATIOS),
    ("bessel/ratios.py", "return complement * (1.0 + r) - r / x", "return complement * (1.0 - r) - r / x", claims("ratios")),
    ("bessel/ratios.py", "_EULER_GAMMA = 0.57721566490153286061", "_EULER_GAMMA = 0.57721566547874852", _RATIOS),
    ("bessel/ratios.py", "K_LEAST = 2.0**-30\n", "K_LEAST = 2.0**-20\n", _RATIOS),
    ("rows/modes.py", "four(value, rate * slope,", "four(value, 1.001 * rate * slope,", _STATES),
    ("compile/intrinsics.py", "fma(t, c[5], c[4])", "fma(t, c[4], c[5])", _RATIOS),
]  # fmt: skip
STRESS = [
    ("rows/stress.py", "rear = w < 1.0 and a * w < 1.0", "rear = w < 1.0", _SLOPES),
    ("rows/stress.py", "_DEEP = 38.0\n", "_DEEP = 12.0\n", _SLOPES),
    ("rows/stress.py", "offset = w - r_complement", "offset = w + r_complement", _SLOPES),
    ("rows/stress.py", "scale = lam / (8.0 * np.pi * kappa)", "scale = lam / (8.0 * np.pi * kappa * (1.0 + 1e-9))", _SLOPES),
    ("rows/stress.py", "u = (1.0 - y) + epsilon", "u = (1.0 - y) - epsilon", _SLOPES),
    ("rows/stress.py", "2.0 - u / beta, beta * zeta", "2.0 - u / beta, zeta", _SLOPES),
    ("printed/law.py", "bracket = 1.0 + epsilon - beta - 2.0", "bracket = 1.0 - beta - 2.0", _DIRECT),
    ("printed/law.py", "0.5 * epsilon * (1.0 - lam * lam) + 0.5", "0.5 * epsilon * (1.0 + lam * lam) + 0.5", _DIRECT),
]  # fmt: skip
SLICE = [
    ("rows/evaluate.py", "return Speed(L, dL * at.per", "return Speed(L * (1.0 + 1e-9), dL * at.per", _STATES),
    ("rows/contact.py", "part = 1.0 - w * w * value", "part = 1.0 - w * value", _STATES),
    ("rows/contact.py", "return D * ((2.0 * L - D) * value - v * L * rise)", "return D * (2.0 * L - D) * value", claims("contact")),
    ("rows/evaluate.py", "rise = part * rise + (1.0 - part) * there * other", "rise = 1.0 * rise", _STATES),
    ("rows/evaluate.py", "bend, own + part, z,", "bend, own, z,", _STATES),
    ("rows/simd_polynomial.py", "_constant([k] * LANES)", "_constant([k * 1.0000001] * LANES)", _STATES),
]  # fmt: skip
ROWS = [
    ("rows/alpha_axis.py", "        marks[STAMP] += 1\n", "", _LAW),
    ("rows/alpha_axis.py", "rows[at - j + j % 2]", "rows[at - j]", _LAW),
    ("rows/z_grid.py", "        marks[STAMP] += 1\n", "", _LAW),
    ("rows/z_grid.py", "PER, FAST = 10, 34\n", "PER, FAST = 6, 34\n", _LAW),
    ("rows/z_grid.py", "numbers[LIMITS], numbers[LIMITS + 1], numbers", "numbers[LIMITS], numbers[LIMITS + 1] - 12, numbers", _LAW),
    ("rows/newton_interpolation.py", "    numbers[Y] += limit\n", "    numbers[Y] += 0.999 * limit\n", _LAW),
]  # fmt: skip
MOTION = [
    ("flow/states.py", "edge, V[i] * found.scale * found.m\n", "edge, V[i] * found.scale * found.m * (1.0 + 1e-7)\n", "tests/motion/test_flow.py"),
    ("flow/lookup.py", "(E + layer_value(table, layout.LAYER_ANGLE", "(E - layer_value(table, layout.LAYER_ANGLE", "tests/motion/test_flow.py"),
    ("motion/rates.py", "left = max(1.0 - sign * d, 0.0)", "left = max(1.0 - 0.999 * sign * d, 0.0)", _MOTION),
    ("motion/rates.py", "spread = L + u * dL\n", "spread = L\n", _MOTION),
    ("motion/rates.py", "press_secants(at, place(2.0 * u / L, law), v, D / w, law)", "press_secants(at, at, v, D / w, law)", _DRIVE),
    ("motion/rates.py", "- creep_limit(V, scene) * abs(V)", "- 0.98 * creep_limit(V, scene) * abs(V)", _MOTION),
    ("motion/collocation.py", "total = fma(t, total, nodes[row + k])", "total = fma(t, total, nodes[row + k] * (1.0 + 1e-7))", _MOTION),
    ("motion/collocation.py", "_ALL.powers() / np.arange(1.0, WIDE + 1.0)", "_ALL.powers() / np.arange(2.0, WIDE + 2.0)", _MOTION),
    ("motion/output.py", "scene.j * spin * (half_space - force) - cylinder", "spin * (half_space - force) - scene.j * cylinder", "tests/motion/test_motion.py"),
    ("motion/integrate.py", "on_edge = sigma * here(inside, stick, clock, case)[1].rate < 0.0", "on_edge = False", "tests/motion/test_nasty_starts.py"),
    ("motion/rates.py", "drag = light * (V_V - 0.5 * per_V * n_V * V_rate), light * V_d, 0.5 * n * V_rate", "drag = light * (V_V - 0.5 * per_V * n_V * V_rate), light * V_d, 0.4 * n * V_rate", "tests/motion/test_unsteady.py"),
    ("rows/added_mass.py", "whole += law.added[start + row]", "whole -= law.added[start + row]", "tests/motion/test_unsteady.py"),
    ("motion/integrate.py", "p / (inertia + load.per_V * (1.0 + delta))", "p / (inertia + load.per_V * (1.0 - delta))", "tests/motion/test_sets_out.py"),
    ("motion/events.py", "    for _ in range(_STEPS):\n", "    for _ in range(0):\n", "tests/motion/test_motion.py"),
]  # fmt: skip
_UNSTEADY = "tests/kernels/rows/test_unsteady.py"
SERIES = [
    ("rows/series.py", "* (0.0 - per)", "* per", claims("series", "states")),
    ("rows/series.py", "inverse(jets, one + 2.0 * rise)", "inverse(jets, one + rise)", claims("series", "states")),
    ("rows/series.py", "w * w * (2.0 * w * dz * ds - dzds)", "w * w * (w * dz * ds - dzds)", _UNSTEADY),
    ("rows/series.py", "weight = a * series.a[n] / (a + series.a[n])", "weight = series.a[n]", claims("series", "states")),
    ("rows/series.py", "half_space += series.weights[j] * series.t[j] * share", "half_space += series.weights[j] * share", claims("series", "states")),
    ("rows/z_grid.py", "work.found[LANES * HALF_SPACE + c], work.found[LANES * CYLINDER + c]", "work.found[LANES * CYLINDER + c], work.found[LANES * HALF_SPACE + c]", "tests/materials/test_each.py"),
    ("rows/series.py", "+ p1 * q2 + p2 * q1", "+ p1 * q2", _UNSTEADY),
    ("rows/modes.py", "dy_s + T_mean * dg", "dy_s - T_mean * dg", _UNSTEADY),
    ("rows/modes.py", "return 0.25 * strength * z * z", "return 0.5 * strength * z * z", _UNSTEADY),
    ("rows/evaluate.py", "m, 1.0, m + u * at.per * dm)", "m, 1.0, m + at.per * dm)", _STATES),
    ("rows/c_function.py", "out[2] = out[3] = 0.5 * out[1]", "out[2] = out[3] = out[1]", _BOUND),
    ("rows/c_function.py", "half_space, cylinder, out[6], out[7] = bodies", "half_space, cylinder, out[7], out[6] = bodies", _BOUND),
    ("rows/load_crossings.py", "step = (load - value) / slope", "step = 0.5 * (load - value) / slope", _STEADY),
    ("rows/load_crossings.py", "if (value <= load) == rising:", "if (value <= load) != rising:", _STEADY),
    ("rows/load_crossings.py", "<= SNAP * abs(load)", "<= 1e-3 * abs(load)", _STEADY),
]  # fmt: skip
DRIVE = [
    ("motion/rates.py", "omega_rate = per_omega * (torque - Q - M_cylinder)", "omega_rate = per_omega * (torque - Q + M_cylinder)", _DRIVEN),
    ("motion/rates.py", "V_rate = load.per_V * (Q - M_half_space + force)", "V_rate = load.per_V * (Q - M_half_space - force)", _DRIVEN),
    ("motion/rates.py", "per_both * (force + torque - M_half_space - M_cylinder)", "per_both * (force + torque - M_half_space + M_cylinder)", _DRIVEN),
    ("motion/load.py", "if by_omega or frame.locked else 1.0 / case.scene.j", "if by_omega else 1.0 / case.scene.j", _DRIVEN),
    ("motion/nodes.py", "= force * speed, torque * omega", "= force * speed, torque * speed", _DRIVEN),
    ("motion/nodes.py", "= (omega - speed) * rates.Q", "= omega * rates.Q", _DRIVEN),
    ("motion/switch.py", "return abs(excess) <= most", "return abs(excess) <= 2.0 * most", _DRIVE),
    ("motion/switch.py", "return State(0.0, -state.second), Frame(slips, -direction, -sigma,", "return State(0.0, -state.second), Frame(slips, -direction, sigma,", _EVENTS),
    ("motion/origin.py", "* per - tilt * V_rate, slope, V_rate", "* per, slope, V_rate", _DRIVEN),
    ("motion/events.py", "if event == NO_EVENT or node < last or here < v:", "if event == NO_EVENT or node < last:", "tests/motion/test_drive_events.py"),
    ("motion/phase.py", "if missed != NO_EVENT or (found == NO_EVENT and behind and not frame.slips):", "if found == NO_EVENT and behind and not frame.slips:", _EVENTS),
    ("motion/phase.py", "kinked = behind and (not frame.slips or found == EDGE or found == SLOW)", "kinked = behind and not frame.slips", "tests/motion/test_drive_events.py"),
]  # fmt: skip
#: coefficients of ratios.npy, by their number: of every power, in several bins of every segment
COEFFICIENTS = [
    ("bessel/ratios.npy", str(n), "1e-9 of it more", _RATIOS) for n in (0, 1, 302, 1203, 2104, 3005, 4006, 5007)
]
MUTANTS = [
    Mutant(*each) for each in (*LAW, *STRESS, *SLICE, *ROWS, *MOTION, *SERIES, *DRIVE, *COEFFICIENTS)
]  # fmt: skip
