"""The defects that pipeline/mutate/ plants, each in one place of the kernels, and the tests that should notice."""

# ruff: noqa: E501
from __future__ import annotations

from typing import NamedTuple


class Mutant(NamedTuple):
    """``old`` occurs once in the kernel ``file`` and becomes ``new``; for a table, ``old`` is the coefficient's number."""

    file: str
    old: str
    new: str
    tests: str


_LAW, _RATIOS, _STRESS = "tests/test_contact.py", "tests/kernels/bessel/test_ratios.py", "tests/test_stress.py"
_DIRECT, _SLICE, _MOTION = (
    "tests/kernels/printed/test_direct.py",
    "tests/materials/test_material_tables.py",
    "tests/motion/test_motion.py",
)
_STEADY, _BOUND, _EACH = "tests/test_steady.py", "tests/test_bound_law.py", "tests/test_contact_each.py"
_LENGTH, _LOSSES = "tests/kernels/law/test_length.py", "tests/motion/test_ensemble.py"
_DRIVE, _EVENTS = "tests/motion/test_drive.py", "tests/motion/test_drive_events.py"

LAW = [
    ("material/standard.py", "return share * p, share * r\n", "return share * p, share * k\n", _LAW),
    ("material/standard.py", "dp = dr * k + r * dk\n    whole = 1.0 / (1.0 + p)\n    share = c * whole\n    return", "dp = dr * k - r * dk\n    whole = 1.0 / (1.0 + p)\n    share = c * whole\n    return", _LAW),
    ("material/standard.py", "share * whole * (dr - r * r * dk)", "share * whole * (dr + r * r * dk)", _LAW),
    ("law/stick.py", "return D, (1.0 + ratio) * D\n", "return D, ratio * D\n", _STEADY),
    ("law/stick.py", "return zeta - d, d, (2.0 - d / zeta) * d, OK", "return zeta - d, 0.5 * d, (2.0 - d / zeta) * d, OK", _MOTION),
    ("material/standard.py", "slope_zh += GAUSS_W[n] * (h + z * dh)", "slope_zh += GAUSS_W[n] * (h + zeta * dh)", _LAW),
    ("numerics/nodes.py", "weights = [1 / ((1 - x * x)", "weights = [(1 + Decimal('1e-9')) / ((1 - x * x)", _LAW),
    ("law/stick.py", "CLOSE = 0.1\n", "CLOSE = 0.9\n", _STEADY),
    ("material/standard.py", "return lam * lam * ratio_i2(alpha * zeta, h / rest) * rest + g", "return lam * ratio_i2(alpha * zeta, h / rest) * rest + g", _MOTION),
    ("law/length.py", "_CUBED = 3e-6\n", "_CUBED = 3e-3\n", _LENGTH),
    ("law/length.py", "_SLOW, _FAST = 1e-17, 1e-9\n", "_SLOW, _FAST = 1e-7, 1e-9\n", _LENGTH),
    ("law/stick.py", "low, high = max(y - 0.5 * material.T_mean, 0.0), y", "low, high = max(y - 0.25 * material.T_mean, 0.0), y", _STEADY),
    ("law/states.py", "return -creep if V < 0.0 else creep, creep", "return creep, creep", _LAW),
    ("law/state.py", "delta_star = 0.5 * mu * lam * (1.0 + epsilon) / kappa", "delta_star = 0.5 * mu * lam / kappa", _LOSSES),
    ("law/states.py", "else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)", "else np.copysign(np.inf, slip)", _LAW),
    ("law/state.py", "bracket = -share * H + H * fall / A + 0.5 * A_eta * d", "bracket = -share * H + H * fall / A - 0.5 * A_eta * d", _STEADY),
    ("material/standard.py", "d_i2 = alpha * 2.0 * (r * r - i2) * per_x", "d_i2 = alpha * 2.0 * (r - i2) * per_x", _LAW),
    ("law/slopes.py", "(ddH * dF - dH * ddg)", "(ddH * dF + dH * ddg)", _STEADY),
    ("bessel/ratios.py", "_NEAR, _FAR = 0.0625, 64.0\n", "_NEAR, _FAR = 0.0625, 24.0\n", _RATIOS),
    ("bessel/ratios.py", "else 1.0 - 2.0 * r / x", "else 1.0 - (2.0 + 1e-10) * r / x", _RATIOS),
    ("bessel/ratios.py", "return k if z < 1.0 else", "return k if z <= 1.0 else", _RATIOS),
    ("bessel/ratios.py", "return complement * (1.0 + r) - r / x", "return complement * (1.0 - r) - r / x", _RATIOS),
    ("bessel/ratios.py", "_EULER_GAMMA = 0.57721566490153286061", "_EULER_GAMMA = 0.57721566547874852", _RATIOS),
    ("bessel/ratios.py", "K_LEAST = 2.0**-30\n", "K_LEAST = 2.0**-20\n", _RATIOS),
    ("bessel/ratios.py", "r_complement * (1.0 + r) - r * per_x", "r_complement * (1.0 - r) - r * per_x", _LAW),
    ("compile/fma.py", "fma(t, c[5], c[4])", "fma(t, c[4], c[5])", _RATIOS),
]  # fmt: skip
STRESS = [
    ("law/stress.py", "rear = w < 1.0 and a * w < 1.0", "rear = w < 1.0", _STRESS),
    ("law/stress.py", "_DEEP = 38.0\n", "_DEEP = 12.0\n", _STRESS),
    ("law/stress.py", "offset = w - r_complement", "offset = w + r_complement", _STRESS),
    ("law/stress.py", "scale = lam / (8.0 * np.pi * kappa)", "scale = lam / (8.0 * np.pi * kappa * (1.0 + 1e-9))", _STRESS),
    ("law/stress.py", "u = (1.0 - y) + epsilon", "u = (1.0 - y) - epsilon", _STRESS),
    ("law/stress.py", "2.0 - u / beta, beta * zeta", "2.0 - u / beta, zeta", _STRESS),
    ("printed/law.py", "bracket = 1.0 + epsilon - beta - 2.0", "bracket = 1.0 - beta - 2.0", _DIRECT),
    ("printed/law.py", "0.5 * epsilon * (1.0 - lam * lam) + 0.5", "0.5 * epsilon * (1.0 + lam * lam) + 0.5", _DIRECT),
]  # fmt: skip
SLICE = [
    ("rows/law.py", "return L, m, 1.0\n", "return L * (1.0 + 1e-9), m, 1.0\n", _SLICE),
    ("rows/contact.py", "part = 1.0 - w * w * press", "part = 1.0 - w * press", _SLICE),
    ("rows/contact.py", "return D * ((2.0 * L - D) * value - v * L * rise)", "return D * (2.0 * L - D) * value", _SLICE),
    ("rows/law.py", "part * here * at.per + (1.0 - part) * there * near.per", "here * at.per", _SLICE),
    ("rows/law.py", "(1.0 + shift), shift + part, z", "(1.0 + shift), shift, z", _LAW),
    ("numerics/quartet.py", "ir.Constant(VECTOR, [float(k)] * 4)", "ir.Constant(VECTOR, [float(k * 1.0000001)] * 4)", _SLICE),
    ("material/tabulated.py", "return g, h, dh * offset_slope(z), m", "return g, h, 2.0 * dh * offset_slope(z), m", _MOTION),
    ("material/standard.py", "per_lam_U * (dm - m *", "per_lam_U * (dm + m *", _SLICE),
]  # fmt: skip
ROWS = [
    ("rows/axis.py", "        marks[STAMP] += 1\n", "", _EACH),
    ("rows/axis.py", "rows[at - j + j % 2]", "rows[at - j]", _EACH),
    ("rows/axis.py", "rows[body], rows[body + 1] = 0.5 * c, 0.5 * c * _FAST", "rows[body], rows[body + 1] = c, c * _FAST", _EACH),
    ("rows/grid.py", "        marks[STAMP] += 1\n", "", _EACH),
    ("rows/grid.py", "PER, POINTS, FAST = 10, 36, 34\n", "PER, POINTS, FAST = 6, 36, 34\n", _EACH),
    ("rows/grid.py", "counts[0], counts[1], counts[2]", "counts[0], counts[1] - 12, counts[2]", _EACH),
    ("rows/grid.py", "numbers[_V], numbers[_V + 1] = 0.0, numbers[_V + 1] + limit", "numbers[_V] = 0.0", _EACH),
]  # fmt: skip
MOTION = [
    ("flow/states.py", "edge, V[i] * scale * m\n", "edge, V[i] * scale * m * (1.0 + 1e-7)\n", "tests/motion/test_flow.py"),
    ("flow/read.py", "(E + layer_value(table, layout.LAYER_ANGLE", "(E - layer_value(table, layout.LAYER_ANGLE", "tests/motion/test_flow.py"),
    ("motion/rates.py", "left = max(1.0 - sign * d, 0.0)", "left = max(1.0 - 0.999 * sign * d, 0.0)", _MOTION),
    ("motion/rates.py", "spread = L + u * dL\n", "spread = L\n", _MOTION),
    ("motion/rates.py", "press_secant(at, place(2.0 * u / L, law), v, D / w, law)", "press_secant(at, at, v, D / w, law)", _MOTION),
    ("motion/rates.py", "edge = frame.sigma * (omega - V) - 0.5", "edge = frame.sigma * (omega - V) - 0.49", _MOTION),
    ("motion/collocation.py", "total = fma(t, total, powers[row + k])", "total = fma(t, total, powers[row + k] * (1.0 + 1e-7))", _MOTION),
    ("motion/collocation.py", "_ALL.powers() / np.arange(1.0, WIDE + 1.0)", "_ALL.powers() / np.arange(2.0, WIDE + 2.0)", _MOTION),
    ("motion/output.py", "(scene.j * half_space - cylinder)", "(half_space - scene.j * cylinder)", _MOTION),
    ("motion/integrate.py", "on_edge = sigma * here(inside, stick, clock, case)[1].rate < 0.0", "on_edge = False", "tests/motion/test_nasty_starts.py"),
    ("motion/rates.py", "drag = light * (V_V - 0.5 * per_V * n_V * V_rate), light * V_d, 0.5 * n * V_rate", "drag = light * (V_V - 0.5 * per_V * n_V * V_rate), light * V_d, 0.4 * n * V_rate", "tests/motion/test_unsteady.py"),
    ("rows/added.py", "whole += law.added[start + row]", "whole -= law.added[start + row]", "tests/motion/test_unsteady.py"),
    ("motion/integrate.py", "p / (inertia + load.per_V * (1.0 + delta))", "p / (inertia + load.per_V * (1.0 - delta))", "tests/motion/test_sets_out.py"),
    ("motion/events.py", "    for _ in range(_STEPS):\n", "    for _ in range(0):\n", "tests/motion/test_sets_out.py"),
]  # fmt: skip
_PRONY, _PAIR, _UNSTEADY = (
    "tests/materials/test_prony.py",
    "tests/kernels/material/test_pair.py",
    "tests/kernels/law/test_unsteady.py",
)
SERIES = [
    ("material/series.py", "store(matrix, at, subtract(load(matrix, at),", "store(matrix, at, add(load(matrix, at),", _PRONY),
    ("material/series.py", "square = 1.0 + 2.0 * h_c / z  # 1/lam^2\n        m =", "square = 1.0 + h_c / z\n        m =", _PRONY),
    ("material/series.py", "dh = add(dh, subtract(rise,", "dh = add(dh, add(rise,", _PRONY),
    ("material/series.py", "u = add(u, multiply(divide(weighted, spread(a + parts.a[n])), apart))", "u = add(u, multiply(divide(weighted, spread(a)), apart))", _PAIR),
    ("material/series.py", "share = multiply(spread(parts.t[j]), multiply(spread(parts.Q[j, i]), pressed))", "share = multiply(spread(parts.Q[j, i]), pressed)", _PAIR),
    ("material/pair.py", "moment_at_an_end(z, other.T_mean, other.ends, material)", "moment_at_an_end(z, one.T_mean, other.ends, material)", _PAIR),
    ("material/pair.py", "return half_space, cylinder, d_half_space * per, d_cylinder * per", "return half_space, cylinder, d_half_space, d_cylinder * per", _PRONY),
    ("material/each.py", "    each.held[0] = row\n    quartet.clear(each.table)\n", "    each.held[0] = row\n", "tests/materials/test_each.py"),
    ("material/each.py", "_body(numbers, HALF_SPACE), _body(numbers, CYLINDER)", "_body(numbers, HALF_SPACE), _body(numbers, HALF_SPACE)", "tests/materials/test_each.py"),
    ("material/fill.py", "_put(row, first, AT_HALF_SPACE, work, table_of_parts)", "_put(row, first, AT_G, work, table_of_parts)", "tests/materials/test_each.py"),
    ("law/unsteady.py", "            _subtract(2, 1, series, work)\n", "", _UNSTEADY),
    ("law/unsteady.py", "dU += T_mean * (", "dU -= T_mean * (", _UNSTEADY),
    ("law/unsteady.py", "return 0.25 * rise * z * z", "return 0.5 * rise * z * z", _UNSTEADY),
    ("rows/law.py", "dL * at.per, m + u * at.per * dm", "dL * at.per, m + at.per * dm", _LAW),
    ("rows/bound.py", "out[2] = out[3] = 0.5 * out[1]", "out[2] = out[3] = out[1]", _BOUND),
    ("rows/bound.py", "out[6], out[7] = body_slopes", "out[7], out[6] = body_slopes", _BOUND),
    ("law/steady_loop.py", "turned = -d_share / fall * m", "turned = d_share / fall * m", _STEADY),
    ("law/steady_loop.py", "share * torque - (1.0 - share) * force", "(1.0 - share) * torque - share * force", _STEADY),
    ("law/steady_loop.py", "D + more, rise_F + more * (1.0 + dg)", "D + more, rise_F + more", _STEADY),
]  # fmt: skip
DRIVE = [
    ("motion/rates.py", "omega_rate = per_omega * (torque - Q - M_cylinder)", "omega_rate = per_omega * (torque - Q + M_cylinder)", _DRIVE),
    ("motion/rates.py", "V_rate = load.per_V * (Q - M_half_space + force)", "V_rate = load.per_V * (Q - M_half_space - force)", _DRIVE),
    ("motion/rates.py", "per_both * (force + torque - M_half_space - M_cylinder)", "per_both * (force + torque - M_half_space + M_cylinder)", _DRIVE),
    ("motion/load.py", "if by_omega or frame.locked else 1.0 / case.scene.j", "if by_omega else 1.0 / case.scene.j", _DRIVE),
    ("motion/nodes.py", "weight * (force * speed), weight * (torque * omega)", "weight * (force * speed), weight * (torque * speed)", _DRIVE),
    ("motion/nodes.py", "weight * ((omega - speed) * Q)", "weight * (omega * Q)", _DRIVE),
    ("motion/switch.py", "return abs(excess) <= most", "return abs(excess) <= 2.0 * most", _DRIVE),
    ("motion/switch.py", "Frame(slips, -direction, -sigma, -spin, locked)", "Frame(slips, -direction, sigma, -spin, locked)", _EVENTS),
    ("motion/origin.py", "* per - d * V_rate, slope, V_rate", "* per, slope, V_rate", _DRIVE),
    ("motion/events.py", "if event == NO_EVENT or node < last or here < v:", "if event == NO_EVENT or node < last:", "tests/kernels/motion/test_events.py"),
    ("motion/phase.py", "if missed != NO_EVENT or (found == NO_EVENT and behind and not frame.slips):", "if found == NO_EVENT and behind and not frame.slips:", _EVENTS),
    ("motion/phase.py", "kinked = behind and (not frame.slips or found == EDGE or found == SLOW)", "kinked = behind and not frame.slips", _EVENTS),
    ("motion/solve.py", "slowest = min(slowest, abs(nodes[SLOPE + i + 1]))", "slowest = abs(nodes[SLOPE])", _EVENTS),
]  # fmt: skip
#: coefficients of ratios.npy, by their number: of every power, in several bins of every segment
COEFFICIENTS = [
    ("bessel/ratios.npy", str(n), "1e-9 of it more", _RATIOS) for n in (0, 1, 302, 1203, 2104, 3005, 4006, 5007)
]
MUTANTS = [
    Mutant(*each) for each in (*LAW, *STRESS, *SLICE, *ROWS, *MOTION, *SERIES, *DRIVE, *COEFFICIENTS)
]  # fmt: skip
