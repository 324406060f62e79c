"""Every symbol once: code name, meaning, unit, range, equation; feeds files and figures."""

from __future__ import annotations

from typing import NamedTuple

from .scale import DIMENSION_UNITS, DIMENSIONS, si_unit

PAPER = (
    "A. A. Zobova and I. G. Goryacheva, Dynamics of a viscoelastic cylinder on a viscoelastic half-space, "
    "Acta Mechanica (2020), doi:10.1007/s00707-020-02643-5"
)

#: attribute of a dataset over V: between which speeds its material was measured
MEASURED = "measured_V"


class Symbol(NamedTuple):
    """A quantity: LaTeX symbol, long name, range, and equation of the paper."""

    latex: str
    long_name: str
    range: str = ""
    equation: str = ""


SYMBOLS = {
    "alpha": Symbol(r"\alpha", "ratio of retardation to relaxation time T_epsilon/T_sigma", ">= 1", "Sect. 3.1"),
    "kappa": Symbol(r"\kappa", "ratio of cylinder radius to contact length at rest R/l0", "> 0", "Sect. 3.1"),
    "mu": Symbol(r"\mu", "coefficient of friction", "> 0", "Sect. 2.1"),
    "gamma": Symbol(r"\gamma", "P T_epsilon^2/(m R)", "> 0", "Eq. (4)"),
    "j": Symbol("j", "dimensionless moment of inertia J/(m R^2)", "> 0", "Eq. (22)"),
    "V": Symbol("V", "velocity of the axis", "finite", "Sect. 3.1"),
    "omega": Symbol(r"\omega", "angular velocity", "finite", "Sect. 3.1"),
    "t": Symbol("t", "time", ">= 0", "Sect. 4"),
    "x": Symbol("x", "distance travelled", "finite", "Eq. (22)"),
    "angle": Symbol(r"\theta", "angle turned", "finite", "Eq. (22)"),
    "delta": Symbol(r"\delta", "creep ratio (omega - V)/V", "finite", "Eq. (5)"),
    "delta_star": Symbol(r"\delta^*", "critical creep ratio", "> 0", "Eq. (9)"),
    "delta_0": Symbol(r"\delta_0", "creep of free rolling by the strain that the pressure makes", "finite"),
    "lam": Symbol(r"\lambda", "contact length over contact length at rest", "[alpha^(-1/2), 1]", "Eq. (6)"),
    "epsilon": Symbol(r"\varepsilon", "relative shift of the contact ahead of the axis", ">= 0", "Eq. (8)"),
    "zeta": Symbol(r"\zeta", "time to travel half the contact", "> 0", "Eq. (7)"),
    "beta": Symbol(r"\beta", "length of the stick zone over the contact length", "[0, 1]", "Eq. (10)"),
    "Q": Symbol("Q", "traction", "[-mu, mu]", "Eqs. (15), (17)"),
    "M": Symbol("M", "rolling resistance moment", "finite", "Eqs. (16), (18)"),
    "C_rr": Symbol(
        r"C_\mathrm{rr}", "coefficient of rolling resistance M/(P R); M of a scene is this", "finite", "Eq. (16)"
    ),
    "force": Symbol("f", "force along V", "finite"),
    "torque": Symbol("q", "torque along omega", "finite"),
    "drag": Symbol("c", "torque of the bearing against omega, for each unit of it", ">= 0"),
    "brake": Symbol("B", "most torque that a brake takes", ">= 0"),
    "slope": Symbol(r"\vartheta", "angle of the slope", "(-pi/2, pi/2)"),
    "grip": Symbol(r"1 - |Q|/\mu", "share of friction to spare", "[0, 1]", "Eq. (15)"),
    "rate_fast": Symbol(r"\lambda_1", "rate of the faster small disturbance", "finite", "Eq. (22)"),
    "rate_slow": Symbol(r"\lambda_2", "rate of the slower small disturbance", "finite", "Eq. (22)"),
    "M_half_space": Symbol("M_h", "part of M in the half-space", "finite"),
    "M_cylinder": Symbol("M_c", "part of M in the cylinder", "finite"),
    "N": Symbol("N", "moment for each unit of V', M = M(V) + N V' in slow changes", "finite"),
    "kappa_V": Symbol(r"\kappa V", "similarity variable kappa V", "> 0", "Eq. (7)"),
    "s": Symbol("s", "creep ratio over its critical value |delta|/delta_star", "[0, 1]", "Eq. (9)"),
    "Q_over_mu": Symbol(r"Q/\mu", "traction over limiting friction", "[0, 1]", "Eq. (15)"),
    "kappa_M": Symbol(r"\kappa M", "kappa times rolling resistance moment over P R", ">= 0", "Eq. (16)"),
    "p": Symbol("p/E'", "contact pressure", ">= 0", "Eq. (11)"),
    "tau": Symbol(r"\tau/E'", "shear stress on the cylinder", "|tau| <= mu p", "Eqs. (12), (13)"),
    "slip_loss": Symbol(r"E_\mathrm{slip}", "energy lost in slip since t = 0", ">= 0", "Eq. (22)"),
    "rolling_loss": Symbol(r"E_\mathrm{roll}", "energy lost in rolling since t = 0", "finite", "Eq. (22)"),
    "work_force": Symbol(r"W_f", "work of the force since t = 0", "finite", "Eq. (22)"),
    "work_torque": Symbol(r"W_q", "work of the torque since t = 0", "finite", "Eq. (22)"),
    "brake_loss": Symbol(r"E_\mathrm{brake}", "energy lost in the brake since t = 0", ">= 0", "Eq. (22)"),
    "onset_time": Symbol("t^*", "time of the first change from full to partial slip", ">= 0", "Eq. (9)"),
}


#: of what has no symbol
_MEANINGS = {
    "full_slip": "1 where the contact slips fully", "stable": "1 where small disturbances die",
    "rest_time": "time at which the rest threshold was crossed", "loss_slip": "power lost: slip",
    "loss_half_space": "power lost: half space", "loss_cylinder": "power lost: cylinder", "length": "contact length",
    "V0": "initial velocity of the axis", "omega0": "initial angular velocity", "count": "number of equilibria",
    "coefficient": "rolling resistance over load", "efficiency": "power out over power in",
}  # fmt: skip


def attributes(name: str, si: bool = False) -> dict[str, str]:
    """long_name, units, symbol and equation of a quantity, without dimension or in SI units."""
    found = {"long_name": describe_quantity(name, si), "units": si_unit(name) if si else "1"}
    if name in SYMBOLS and not (si and name in DIMENSIONS):
        found |= {"symbol": SYMBOLS[name].latex, "equation": SYMBOLS[name].equation}
    return found


def describe_quantity(name: str, si: bool = False) -> str:
    """What a quantity is, in words."""
    if name in SYMBOLS:
        text = SYMBOLS[name].long_name
    elif name.startswith("d") and "_d" in name:
        upper, _, lower = name[1:].partition("_d")
        text = f"partial derivative of {upper} with respect to {lower}"
    else:
        text = _MEANINGS.get(name, "")
    if not text or name not in DIMENSIONS:
        return text
    unit, over = DIMENSION_UNITS[DIMENSIONS[name]]
    return text + (", per length of the cylinder" * unit.endswith(" m-1") if si else over)
