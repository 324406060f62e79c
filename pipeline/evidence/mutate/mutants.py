"""The defects of mutants.toml, and the tests that should notice each."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ...stage import read_toml


class Mutant(NamedTuple):
    """``old`` occurs once in the kernel ``file`` and becomes ``new``; for a table, ``old`` is the coefficient's number.

    ``tests`` : files of tests, or tests of one, with spaces between.
    """

    file: str
    old: str
    new: str
    tests: str


def read_mutants() -> list[Mutant]:
    """Return all mutants of the file, its names of tests replaced by their paths."""
    content = read_toml(Path(__file__).with_suffix(".toml"))
    rows = (row for group in content["mutants"].values() for row in group)
    return [Mutant(file, old, new, content["tests"].get(tests, tests)) for file, old, new, tests in rows]


<<<<<<< HEAD
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
    ("rows/series.py", "multiply(jets, X, load(work.i2, at))", "multiply(jets, ey, load(work.i2, at))", _STATES),
    ("rows/series.py", "p1 * q0 + p0 * q1", "p1 * q0 - p0 * q1", _STATES),
    ("rows/series.py", "for turn in range(3 if jets else 1):", "for turn in range(1):", _STATES),
    ("numerics/interpolation.py", "weights = 1 / ((1 - nodes * nodes)", "weights = (1 + Decimal('1e-9')) / ((1 - nodes * nodes)", _SLOPES),
    ("rows/contact_states.py", "return -creep if V < 0.0 else creep, creep", "return creep, creep", _LAW),
    ("rows/contact_states.py", "else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)", "else np.copysign(np.inf, slip)", _LAW),
    ("rows/modes.py", "di2 = r - (2.0 / x + r) * i2", "di2 = r - (1.0 / x + r) * i2", _STATES),
    ("bessel/ratios.py", "_FAR = 64.0\n", "_FAR = 24.0\n", _RATIOS),
    ("bessel/ratios.py", "return 1.0 - 2.0 * r / x", "return 1.0 - (2.0 + 1e-10) * r / x", _RATIOS),
    ("bessel/ratios.py", "return k if z < 1.0 else", "return k if z <= 1.0 else", _RATIOS),
    ("bessel/ratios.py", "return complement * (1.0 + r) - r / x", "return complement * (1.0 - r) - r / x", claims("ratios")),
    ("bessel/ratios.py", "_EULER_GAMMA = 0.57721566490153286061", "_EULER_GAMMA = 0.57721566547874852", _RATIOS),
    ("bessel/ratios.py", "K_LEAST = 2.0**-30\n", "K_LEAST = 2.0**-20\n", _RATIOS),
    ("rows/modes.py", "pack(value, rate * slope,", "pack(value, 1.001 * rate * slope,", _STATES),
    ("compile/intrinsics.py", "fma(t, c[5], c[4])", "fma(t, c[4], c[5])", _RATIOS),
]  # fmt: skip
STRESS = [
    ("rows/stress.py", "rear = w < 1.0 and a * w < 1.0", "rear = w < 1.0", _SLOPES),
    ("rows/stress.py", "_DEEP = 38.0\n", "_DEEP = 12.0\n", _SLOPES),
    ("rows/stress.py", "offset = w - r_complement", "offset = w + r_complement", _SLOPES),
    ("rows/stress.py", "scale = lam / (8.0 * np.pi *", "scale = lam / (8.0 * np.pi * (1.0 + 1e-9) *", _SLOPES),
    ("rows/stress.py", "u = (1.0 - y) + epsilon", "u = (1.0 - y) - epsilon", _SLOPES),
    ("rows/stress.py", "2.0 - u / beta, beta * zeta", "2.0 - u / beta, zeta", _SLOPES),
    ("printed/law.py", "bracket = 1.0 + epsilon - beta - 2.0", "bracket = 1.0 - beta - 2.0", _DIRECT),
    ("printed/law.py", "0.5 * epsilon * (1.0 - lam * lam) + 0.5", "0.5 * epsilon * (1.0 + lam * lam) + 0.5", _DIRECT),
]  # fmt: skip
SLICE = [
    ("rows/evaluate.py", "return LengthAndMoment(L, dL * dt", "return LengthAndMoment(L * (1.0 + 1e-9), dL * dt", _STATES),
    ("rows/contact.py", "traction = 1.0 - w * w * value", "traction = 1.0 - w * value", _STATES),
    ("rows/contact.py", "return D * ((2.0 * L - D) * value - v * L * secant)", "return D * (2.0 * L - D) * value", claims("contact")),
    ("rows/evaluate.py", "secant = part * secant + (1.0 - part) * near_secant * near_dt", "secant = 1.0 * secant", _STATES),
    ("rows/evaluate.py", "ddL, moment + part, z,", "ddL, moment, z,", _STATES),
    ("rows/simd_polynomial.py", "_constant([k] * LANES)", "_constant([k * 1.0000001] * LANES)", _STATES),
]  # fmt: skip
ROWS = [
    ("rows/alpha_axis.py", "        marks[VERSION] += 1\n", "", _LAW),
    ("rows/alpha_axis.py", "cubic = fma4(high, square, low)", "cubic = fma4(high, power, low)", _LAW),
    ("rows/record.py", "    marks[VERSION] += 1\n", "", _LAW),
    ("rows/z_grid.py", "NODES_PER_OCTAVE = 10\n", "NODES_PER_OCTAVE = 6\n", _LAW),
    ("rows/z_grid.py", "numbers[FIRST_EXPONENT + 1]\n", "numbers[FIRST_EXPONENT + 1] - 12\n", _LAW),
    ("rows/newton_interpolation.py", "    scratch[NODE_VALUES] += limit\n", "    scratch[NODE_VALUES] += 0.999 * limit\n", _LAW),
]  # fmt: skip
MOTION = [
    ("flow/states.py", "edge, V[i] * found.scale * found.m\n", "edge, V[i] * found.scale * found.m * (1.0 + 1e-7)\n", "tests/motion/test_flow.py"),
    ("flow/lookup.py", "(E + layer_value(table, layout.LAYER_ANGLE", "(E - layer_value(table, layout.LAYER_ANGLE", "tests/motion/test_flow.py"),
    ("motion/rhs.py", "stick = max(1.0 - sign * d, 0.0)", "stick = max(1.0 - 0.999 * sign * d, 0.0)", _MOTION),
    ("motion/rhs.py", "dVdelta_star = L + u * dL\n", "dVdelta_star = L\n", _MOTION),
    ("motion/rhs.py", "H_over_F2_secants(index, locate_row(2.0 * u / L, law), v, D / w, law)", "H_over_F2_secants(index, index, v, D / w, law)", _DRIVE),
    ("motion/law.py", "- critical_creepage(V, scene) * abs(V)", "- 0.98 * critical_creepage(V, scene) * abs(V)", _MOTION),
    ("motion/collocation.py", "value = fma(t, value, nodes[row + k])", "value = fma(t, value, nodes[row + k] * (1.0 + 1e-7))", _MOTION),
    ("motion/collocation.py", "_ALL.powers() / np.arange(1.0, ROW_LENGTH + 1.0)", "_ALL.powers() / np.arange(2.0, ROW_LENGTH + 2.0)", _MOTION),
    ("motion/asymptotics.py", "scene.j * omega_over_V * (half_space - force) - cylinder", "omega_over_V * (half_space - force) - scene.j * cylinder", "tests/motion/test_motion.py"),
    ("motion/regimes.py", "on_edge = sigma * current_rates(stick_state, stick_regime, step_state, work).weighted_rate < 0.0", "on_edge = False", "tests/motion/test_nasty_starts.py"),
    ("motion/rhs.py", "drag = mass_ratio * (V_V - 0.5 * inverse_mass * n_V * V_rate), mass_ratio * V_d, 0.5 * n * V_rate", "drag = mass_ratio * (V_V - 0.5 * inverse_mass * n_V * V_rate), mass_ratio * V_d, 0.4 * n * V_rate", "tests/motion/test_unsteady.py"),
    ("rows/added_mass.py", "integral += law.N_rows[start + row]", "integral -= law.N_rows[start + row]", "tests/motion/test_unsteady.py"),
    ("motion/driver.py", "p / (inertia + load.inverse_mass * (1.0 + delta))", "p / (inertia + load.inverse_mass * (1.0 - delta))", "tests/motion/test_sets_out.py"),
    ("motion/events.py", "    for _ in range(_SECANT_STEPS):\n", "    for _ in range(0):\n", "tests/motion/test_motion.py"),
]  # fmt: skip
_UNSTEADY = "tests/kernels/rows/test_unsteady.py"
SERIES = [
    ("rows/series.py", "* (0.0 - inverse)", "* inverse", claims("series", "states")),
    ("rows/series.py", "reciprocal(jets, unit + 2.0 * h_over_z)", "reciprocal(jets, unit + h_over_z)", claims("series", "states")),
    ("rows/series.py", "w * w * (2.0 * w * dz * ds - dzds)", "w * w * (w * dz * ds - dzds)", _UNSTEADY),
    ("rows/series.py", "weight = a * series.a[n] / (a + series.a[n])", "weight = series.a[n]", claims("series", "states")),
    ("rows/series.py", "half_space += series.weights[j] * series.t[j] * moment", "half_space += series.weights[j] * moment", claims("series", "states")),
    ("rows/z_grid.py", "node[_HALF_SPACE] = u * half_space", "node[_HALF_SPACE] = u * cylinder", "tests/materials/test_each.py"),
    ("rows/series.py", "+ p1 * q2 + p2 * q1", "+ p1 * q2", _UNSTEADY),
    ("rows/modes.py", "dy_s + T_mean * dg", "dy_s - T_mean * dg", _UNSTEADY),
    ("rows/modes.py", "return 0.25 * strength * z * z", "return 0.5 * strength * z * z", _UNSTEADY),
    ("rows/evaluate.py", "m, 1.0, m + u * dt * dm)", "m, 1.0, m + dt * dm)", _STATES),
    ("rows/c_function.py", "out[2] = out[3] = 0.5 * out[1]", "out[2] = out[3] = out[1]", _BOUND),
    ("rows/c_function.py", "half_space, cylinder, out[6], out[7] = body_moments", "half_space, cylinder, out[7], out[6] = body_moments", _BOUND),
    ("rows/load_crossings.py", "step = (load - value) / slope", "step = 0.5 * (load - value) / slope", _STEADY),
    ("rows/load_crossings.py", "if (value <= load) == (rise > 0.0):", "if (value <= load) != (rise > 0.0):", _STEADY),
    ("rows/load_crossings.py", "<= EXTREMUM_RTOL * abs(load)", "<= 1e-3 * abs(load)", _STEADY),
]  # fmt: skip
DRIVE = [
    ("motion/rhs.py", "omega_rate = inverse_inertia * (torque - Q - M_cylinder)", "omega_rate = inverse_inertia * (torque - Q + M_cylinder)", _DRIVEN),
    ("motion/rhs.py", "V_rate = load.inverse_mass * (Q - M_half_space + force)", "V_rate = load.inverse_mass * (Q - M_half_space - force)", _DRIVEN),
    ("motion/rhs.py", "inverse_product * (force + torque - M_half_space - M_cylinder)", "inverse_product * (force + torque - M_half_space + M_cylinder)", _DRIVEN),
    ("motion/drive.py", "if omega_given or regime.locked else 1.0 / work.scene.j", "if omega_given else 1.0 / work.scene.j", _DRIVEN),
    ("motion/output.py", "force * V, torque * omega", "force * V, torque * V", _DRIVEN),
    ("motion/output.py", "(omega - V) * rates.Q", "omega * rates.Q", _DRIVEN),
    ("motion/regimes.py", "return abs(torque) <= limit", "return abs(torque) <= 2.0 * limit", _DRIVE),
    ("motion/regimes.py", "Regime(regime.full_slip, -regime.direction, -regime.sigma,", "Regime(regime.full_slip, -regime.direction, regime.sigma,", _EVENTS),
    ("motion/departure_from_rest.py", "* inverse_k - d_total * V_rate, slope, V_rate", "* inverse_k, slope, V_rate", _DRIVEN),
    ("motion/events.py", "if event == NO_EVENT or node < last or v_zero < v:", "if event == NO_EVENT or node < last:", "tests/motion/test_drive_events.py"),
    ("motion/regime_solver.py", "if missed_event != NO_EVENT or (first_event == NO_EVENT and V_negative and not regime.full_slip):", "if first_event == NO_EVENT and V_negative and not regime.full_slip:", _EVENTS),
    ("motion/regime_solver.py", "has_kink = V_negative and (not regime.full_slip or first_event == STICK_EDGE or first_event == BELOW_REST_SPEED)", "has_kink = V_negative and not regime.full_slip", "tests/motion/test_drive_events.py"),
]  # fmt: skip
#: coefficients of ratios.npy, by their number: of every power, in several bins of every segment
COEFFICIENTS = [
    ("bessel/ratios.npy", str(n), "1e-9 of it more", _RATIOS) for n in (0, 1, 302, 1203, 2104, 3005, 4006, 5007)
]
MUTANTS = [
    Mutant(*each) for each in (*LAW, *STRESS, *SLICE, *ROWS, *MOTION, *SERIES, *DRIVE, *COEFFICIENTS)
]  # fmt: skip
=======
MUTANTS = read_mutants()
>>>>>>> h-evidence
