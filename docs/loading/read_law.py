"""contact = read_law("rubber.nc");  contact(kappa, mu, V, slip), arrays too.  slip = omega - V.

Without viscoroll: numpy, and xarray, h5py or netCDF4 to open the file.
"""

import numpy as np
import xarray as xr

FUNCTIONS = "lam", "epsilon", "m_half_space", "m_cylinder", "N", "share", "press"
# of a layer, where shear acts back on the pressure
SHEAR = (
    "limit",
    "free_half_space",
    "free_cylinder",
    "excess_half_space",
    "excess_cylinder",
    "lam_Q",
    "epsilon_Q",
)


def read_law(path):
    with xr.open_dataset(path, engine="h5netcdf") as file:
        names = FUNCTIONS + SHEAR if "limits" in file else FUNCTIONS
        unknown = np.full(file.lam.shape, np.nan)
        c = np.stack(
            [file[name].values if name in file else unknown for name in names]
        )  # [function, octave, power]
        if "limits" in file:  # a layer
            ends = file.limits.values
            fast = (
                ends[0] ** -2.0,
                np.array([[0.0, 4.0 * ends[8]], [0.0, 8.0 * ends[17]], [0.0, 8.0 * ends[18]]]),
            )
        else:
            ends, fast = None, (float(file.alpha), file.fast_limit.values)
        numbers = int(file.e0), *fast, ends
    return lambda kappa, mu, V, slip: state(c, *numbers, *np.broadcast_arrays(kappa, mu, V, slip))


def place(x, e0):
    """Row, argument and its slope; row 0 is that of the slow end."""
    m, e = np.frexp(x)
    row = np.where(x == 0.0, 0, np.maximum(e - e0, 0))
    t = np.where(row == 0, np.ldexp(x, -e0), 4.0 * m - 3.0)
    return row, t, np.where(row == 0, 2.0**-e0, np.ldexp(4.0, -e))


def value(c, row, t):
    return np.polynomial.polynomial.polyval(t, c[np.minimum(row, len(c) - 1)].T, tensor=False)


def chord(c, row, t, s):
    """(p(t) - p(s))/(t - s)."""
    c = c[np.minimum(row, len(c) - 1)]
    last = total = c[..., -1]
    for k in range(c.shape[-1] - 2, 0, -1):
        last = last * t + c[..., k]
        total = total * s + last
    return total


# NaN where one of these is NaN or infinite, kappa or mu is not above 0, or kappa |V| is above 1e300
@np.errstate(all="ignore")
def state(c, e0, alpha, limit, ends, kappa, mu, V, slip):
    (W, C), rows = limit[0], c.shape[1]
    u = kappa * np.abs(V)
    good = (kappa > 0.0) & (mu > 0.0) & (mu < np.inf) & (u <= 1e300) & (np.abs(slip) < np.inf)
    row, t, _ = place(u, e0)
    z = 0.5 / (u * np.sqrt(alpha))
    half, log = 0.5 * alpha * z, np.log(z)
    fast = [
        alpha**-0.5,
        half * (C - W * log),
        *(half * z * (C - W * (log - 0.25)) for W, C in limit[1:]),
    ]
    fast.append(0.25 * (alpha - 1.0) * z * z)
    if ends is not None:
        fast[0], fast[1] = ends[1] + ends[9] / u, ends[16] / u
    lam, epsilon, half_space, cylinder, N = (
        np.where(row < rows, value(one, row, t), end) for one, end in zip(c, fast)
    )
    L, *shear = lam * (1.0 + epsilon), *np.zeros(6)
    if ends is not None:
        beyond = (ends[n] + ends[n + 8] / u for n in (0, *range(2, 8)))
        L, *shear = (
            np.where(row < rows, value(one, row, t), end) for one, end in zip(c[7:], beyond)
        )
    f_h, f_c, g_h, g_c, lam_Q, epsilon_Q = shear
    f = f_h + f_c
    delta = (
        np.where(slip == 0.0, 0.0, np.where(V == 0.0, np.copysign(np.inf, slip), slip / V))
        - 0.5 * f / kappa
    )
    side, sign, delta = np.where(V < 0.0, -1.0, 1.0), np.sign(delta), np.abs(delta)
    # the onsets of full slip of a cover lie at different distances from delta_0
    star, excess = 0.5 * mu * L / kappa, 2.0 * (g_h + g_c) / (mu * L)
    lean = -sign * excess / (1.0 + (2.0 * excess) ** 6)
    D = 4.0 * kappa * delta / mu / (1.0 + np.sqrt(1.0 + 4.0 * lean * delta / star))
    slips = ~((delta < star * (1.0 + lean)) & (D < L))
    w = np.where(slips, L, L - D)
    v1, v2 = 2.0 * u / L, 2.0 * u / w
    (r1, t1, p1), (r2, t2, p2) = place(v1, e0), place(v2, e0)
    bracket = [(C + W * np.log(v)) / v for v in (v1, v2)]
    end = 1.0 - 0.5 * alpha * bracket[1]
    press = np.where(r2 < rows, value(c[6], r2, t2), alpha * end**2)
    if ends is not None:
        end = ends[1] / ends[0] + 2.0 * (ends[9] * ends[0] - ends[1] * ends[8]) / ends[0] ** 3 / v2
    share = np.where(r2 < rows, value(c[5], r2, t2), end)
    part = np.clip((np.ldexp(1.0, e0 + r2 - 1) - v1) / (v2 - v1), 0.0, 1.0)
    two = part * chord(c[6], r1, t1, 1.0) * p1 + (1.0 - part) * chord(c[6], r2, t2, -1.0) * p2
    x = (v2 - v1) / v1
    beyond = C - W * (np.where(x > 0.0, np.log1p(x) / x, 1.0) - np.log(v1))
    beyond *= 0.5 * alpha**2 * (2.0 - 0.5 * alpha * sum(bracket)) / v1 / v2
    S = np.where(r2 >= rows, beyond, np.where(r1 == r2, chord(c[6], r1, t1, t2) * p1, two))
    q = np.where(
        D < L / 8.0, D * ((2.0 * L - D) * press - 2.0 * u * L / w * S), 1.0 - w * w * press
    )
    used = np.where(slips, 1.0, np.minimum(q, 1.0))
    Q, along = side * sign * mu * used, sign * mu * used
    more = used * (1.0 + excess**4) ** -0.25
    change_h, change_c = (
        Q * (f_h + more * g_h) / (2.0 * kappa),
        Q * (f_c + more * g_c) / (2.0 * kappa + f),
    )
    found = {
        "lam": lam + lam_Q * along,
        "epsilon": epsilon + epsilon_Q * along,
        "delta_star": star,
        "beta": np.where(slips, 0.0, np.minimum(share * w / lam, 1.0)),
        "Q": Q,
        "M": V * (half_space + cylinder) - (change_h + change_c),
        "M_half_space": V * half_space - change_h,
        "M_cylinder": V * cylinder - change_c,
        "N": N,
    }
    return {name: np.where(good, each, np.nan) for name, each in found.items()}
