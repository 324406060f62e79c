"""Symbols of all quantities: name in code, LaTeX symbol, meaning, range, equation of the paper.

Files, figures and ``docs/symbols.md`` take their words from here, and the units from :mod:`.scale`.
"""

from __future__ import annotations

from typing import NamedTuple

from .scale import DIMENSIONS, si_unit

PAPER = (
    "A. A. Zobova and I. G. Goryacheva, Dynamics of a viscoelastic cylinder on a viscoelastic half-space, "
    "Acta Mechanica (2020), doi:10.1007/s00707-020-02643-5"
)

#: Attribute of a dataset over V: the lowest and the highest speed at which the material was measured.
MEASURED = "measured_V"


class Symbol(NamedTuple):
    """A quantity.

    latex : symbol.
    long_name : meaning.
    range : allowed values.
    equation : its place in the paper.
    """

    latex: str
    long_name: str
    range: str = ""
    equation: str = ""


#: Name in code -> symbol.
SYMBOLS = {
    "alpha": Symbol(r"\alpha", "ratio of retardation time to relaxation time, T_epsilon/T_sigma", ">= 1", "Sect. 3.1"),
    "kappa": Symbol(r"\kappa", "slenderness: radius divided by contact length at rest, R/l0", "> 0", "Sect. 3.1"),
    "mu": Symbol(r"\mu", "coefficient of friction", "> 0", "Sect. 2.1"),
    "gamma": Symbol(r"\gamma", "ratio of the load to inertia, P T_epsilon^2/(m R)", "> 0", "Eq. (4)"),
    "j": Symbol("j", "moment of inertia divided by m R^2", "> 0", "Eq. (22)"),
    "V": Symbol("V", "velocity of the axis", "finite", "Sect. 3.1"),
    "omega": Symbol(r"\omega", "angular velocity", "finite", "Sect. 3.1"),
    "t": Symbol("t", "time", ">= 0", "Sect. 4"),
    "x": Symbol("x", "distance travelled", "finite", "Eq. (22)"),
    "angle": Symbol(r"\theta", "angle turned", "finite", "Eq. (22)"),
    "delta": Symbol(r"\delta", "creepage (omega - V)/V", "finite", "Eq. (5)"),
    "delta_star": Symbol(r"\delta^*", "critical creepage, at which full slip begins", "> 0", "Eq. (9)"),
    "delta_0": Symbol(r"\delta_0", "creepage of free rolling, by the strain that the pressure causes", "finite"),
    "lam": Symbol(r"\lambda", "contact length divided by contact length at rest", "[alpha^(-1/2), 1]", "Eq. (6)"),
    "epsilon": Symbol(
        r"\varepsilon",
        "shift of the contact towards the leading edge, in half contact lengths",
        ">= 0",
        "Eq. (8)",
    ),
    "zeta": Symbol(r"\zeta", "time in which a point passes through half the contact", "> 0", "Eq. (7)"),
    "beta": Symbol(r"\beta", "length of the stick zone divided by contact length", "[0, 1]", "Eq. (10)"),
    "Q": Symbol("Q", "creep force", "[-mu, mu]", "Eqs. (15), (17)"),
    "M": Symbol("M", "rolling resistance moment", "finite", "Eqs. (16), (18)"),
    "C_rr": Symbol(r"C_\mathrm{rr}", "coefficient of rolling resistance, M/(P R)", "finite", "Eq. (16)"),
    "force": Symbol("f", "force along V", "finite"),
    "torque": Symbol("q", "torque along omega", "finite"),
    "drag": Symbol("c", "torque of the bearing against omega, per unit of omega", ">= 0"),
    "brake": Symbol("B", "largest torque of the brake", ">= 0"),
    "slope": Symbol(r"\vartheta", "angle of the slope", "(-pi/2, pi/2)"),
    "grip": Symbol(r"1 - |Q|/\mu", "friction reserve, 1 - |Q|/(mu P)", "[0, 1]", "Eq. (15)"),
    "rate_fast": Symbol(r"\lambda_1", "growth rate of the faster small disturbance", "finite", "Eq. (22)"),
    "rate_slow": Symbol(r"\lambda_2", "growth rate of the slower small disturbance", "finite", "Eq. (22)"),
    "M_half_space": Symbol("M_h", "part of M by losses in the half-space", "finite"),
    "M_cylinder": Symbol("M_c", "part of M by losses in the cylinder", "finite"),
    "N": Symbol("N", "added mass of slow speed changes, N in M(V) + N V'", "finite"),
    "kappa_V": Symbol(r"\kappa V", "similarity variable: kappa times V", "> 0", "Eq. (7)"),
    "s": Symbol("s", "creepage divided by critical creepage, |delta|/delta_star", "[0, 1]", "Eq. (9)"),
    "Q_over_mu": Symbol(r"Q/\mu", "creep force divided by limiting friction", "[0, 1]", "Eq. (15)"),
    "kappa_M": Symbol(r"\kappa M", "kappa times rolling resistance moment, divided by P R", ">= 0", "Eq. (16)"),
    "p": Symbol("p/E'", "contact pressure", ">= 0", "Eq. (11)"),
    "tau": Symbol(r"\tau/E'", "shear stress on the cylinder", "|tau| <= mu p", "Eqs. (12), (13)"),
    "slip_loss": Symbol(r"E_\mathrm{slip}", "energy lost in slip since t = 0", ">= 0", "Eq. (22)"),
    "rolling_loss": Symbol(r"E_\mathrm{roll}", "energy lost in rolling since t = 0", "finite", "Eq. (22)"),
    "work_force": Symbol(r"W_f", "work of the force since t = 0", "finite", "Eq. (22)"),
    "work_torque": Symbol(r"W_q", "work of the torque since t = 0", "finite", "Eq. (22)"),
    "brake_loss": Symbol(r"E_\mathrm{brake}", "energy lost in the brake since t = 0", ">= 0", "Eq. (22)"),
    "onset_time": Symbol("t^*", "time of the first change from full to partial slip", ">= 0", "Eq. (9)"),
}


#: Name in code -> meaning, of quantities without a symbol.
_MEANINGS = {
    "full_slip": "1 in full slip, else 0",
    "stable": "1 if small disturbances decay, else 0",
    "rest_time": "time at which the rest threshold was crossed",
    "loss_slip": "power lost: slip",
    "loss_half_space": "power lost: half-space",
    "loss_cylinder": "power lost: cylinder",
    "length": "contact length",
    "V0": "initial velocity of the axis",
    "omega0": "initial angular velocity",
    "count": "number of equilibria",
    "coefficient": "all losses divided by load and distance",
    "efficiency": "output power divided by input power",
}


def attributes(name: str, si: bool = False) -> dict[str, str]:
    """Return the attributes of a quantity in a dataset: long_name, units, and of most symbol and equation.

    name: quantity.
    si: whether it is in SI units, else dimensionless.
    """
    found = {"long_name": describe_quantity(name, si), "units": si_unit(name) if si else "1"}
    if name in SYMBOLS and not (si and name in DIMENSIONS):
        found |= {"symbol": SYMBOLS[name].latex, "equation": SYMBOLS[name].equation}
    return found


def describe_quantity(name: str, si: bool = False) -> str:
    """Return the meaning of a quantity in words, as for long_name of a dataset; "" where it is not known.

    name: quantity, or a slope as "dQ_dV".
    si: whether it is in SI units; forces and moments are then "per length of the cylinder".  Else the words end with
        the unit by which the quantity is divided.
    """
    if name in SYMBOLS:
        text = SYMBOLS[name].long_name
        if si and name == "delta":
            text = text.replace("omega", "omega R")
    elif name.startswith("d") and "_d" in name:
        dependent, _, variable = name[1:].partition("_d")
        text = f"partial derivative of {dependent} with respect to {variable}"
    else:
        text = _MEANINGS.get(name, "")
    if not text or name not in DIMENSIONS:
        return text
    dimension = DIMENSIONS[name]
    return text + (", per length of the cylinder" * dimension.si_unit.endswith(" m-1") if si else dimension.divisor)
