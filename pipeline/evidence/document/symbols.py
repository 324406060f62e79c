"""Every symbol of a result: what it is, in which unit a scene and a cylinder give it, its range and equation."""

from __future__ import annotations

from viscoroll.scale import DIMENSIONS, si_unit
from viscoroll.symbols import SYMBOLS, meaning

from ..results import Results, table

_GREEK = {
    "alpha": "α", "kappa": "κ", "mu": "μ", "gamma": "γ", "omega": "ω", "angle": "θ", "delta": "δ", "delta_star": "δ*",
    "lam": "λ", "epsilon": "ε", "zeta": "ζ", "beta": "β", "force": "f", "torque": "q", "brake": "B", "slope": "ϑ",
    "tau": "τ", "onset_time": "t*",
}  # fmt: skip
#: units as "m s-1"
_POWERS = str.maketrans({"-": "⁻", "1": "¹", "2": "²"})


def symbols(results: Results) -> str:
    """One row a symbol; nothing is measured."""
    rows = []
    for name, symbol in SYMBOLS.items():
        si = si_unit(name).translate(_POWERS) if name in DIMENSIONS else ""
        texts = (meaning(name), symbol.range, symbol.equation)
        about, allowed, equation = (text.replace("|", "\\|") for text in texts)
        rows.append((f"`{name}`", _GREEK.get(name, ""), about, allowed, si, equation))
    return table(("in code", "symbol", "what it is, of a scene", "range", "of a cylinder", "equation"), rows)
