"""The marked blocks of README.md and docs, from the results of stages; those of the benchmark: bench/report.py."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..results import rows_of, table
from . import ensembles as ensembles_report

_NAMES = {
    "lam": "λ", "epsilon": "ε", "delta_star": "δ*", "beta": "β, times 1 − s", "Q": "Q", "M": "M",
}  # fmt: skip


def number(value: float, digits: int = 2) -> str:
    """Two significant digits, plain where that is short."""
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if 100 <= float(text) < 1e6 else text


def headline(m: dict[str, Any]) -> str:
    contact, motion, time = m["contact_error"], m["motion_error"]["paper"]["1e-08"], m["time"]
    worst = max(field["worst"] for field in contact.values())
    rows = [
        (f"contact state, worst of {m['sizes']['states']} random ones, against 50 digits", number(worst)),
        (
            "pressure and shear: closures with load, Q and M, relative to the load",
            number(max(m["stress_closure"].values())),
        ),
        ("motion IC1-IC3 at rtol 1e-8: V and ω, down to 1e-6", number(motion["speed"])),
        ("motion IC1-IC3 at rtol 1e-8: onset of stick", number(motion["onset"])),
        ("`contact()`, Q and M in arrays at one alpha, a state", f"{number(time['contact_one_alpha_ns'])} ns"),
        ("the same by root solves of the printed equations", f"{number(time['contact_direct_ns'])} ns"),
        (
            "`contact()`, Q and M in arrays with an alpha each, a state",
            f"{number(time['contact_an_alpha_each_ns'])} ns",
        ),
        ("`roll()`, one motion (rtol 1e-6; 1e-8)", _pair(time, "roll")),
        ("`ensemble()`, a motion, integrated (rtol 1e-6; 1e-8)", _pair(time, "ensemble")),
        ("`ensemble()` of one scene, a motion, from the flow map", f"{number(time['flow_us'])} µs"),
        ("`import viscoroll`, over a bare Python", f"{number(1e3 * time['import_s'])} ms"),
    ]
    return table(("what", "measured"), rows) + "\n" + machine(m)


def _pair(time: dict[str, float], name: str) -> str:
    return f"{number(time[f'{name}_1e-06_us'])} µs; {number(time[f'{name}_1e-08_us'])} µs"


def contact(m: dict[str, Any]) -> str:
    rows = (
        (_NAMES[n], number(m["contact_error"][n]["median"]), number(m["contact_error"][n]["worst"])) for n in _NAMES
    )
    return table(("relative error", "median", "worst"), rows)


def direct(m: dict[str, Any]) -> str:
    units = {
        "lam": "relative", "epsilon": "over max(1, ε)", "delta_star": "relative", "beta": "absolute",
        "Q": "over μ", "M": "times κ",
    }  # fmt: skip
    names = _NAMES | {"beta": "β"}
    rows = ((names[n], units[n], number(m["table_against_direct"][n])) for n in _NAMES)
    return table(("field", "difference", "worst"), rows)


def stress(m: dict[str, Any]) -> str:
    meaning = {"load": "∫ p dx = P", "traction": "∫ τ dx = Q", "moment": "∫ x p dx = M"}
    return table(
        ("closure", "worst, relative to the load"), ((meaning[n], number(m["stress_closure"][n])) for n in meaning)
    )


def motion(m: dict[str, Any]) -> str:
    head = ("rtol", "V, ω", "over condition", "x", "onset", "steps")
    keys = ("speed", "speed_over_condition", "x", "onset")
    parts = []
    for group, title in (
        ("paper", "IC1-IC3, rounded parameters"),
        ("random", f"{m['sizes']['scenes']} random scenes and starts"),
    ):
        rows = (
            (f"{float(rtol):.0e}", *(number(errors[key]) for key in keys), f"{errors['steps']:.0f}")
            for rtol, errors in sorted(m["motion_error"][group].items(), key=lambda item: -float(item[0]))
        )
        parts.append(f"{title}:\n\n{table(head, rows)}")
    return "\n".join(parts)


def times(m: dict[str, Any]) -> str:
    time, sizes = m["time"], m["sizes"]
    rows = [
        (
            f"`contact()`, Q and M, {sizes['timed_states']} states, one alpha",
            f"{number(time['contact_one_alpha_ns'])} ns a state",
        ),
        ("the same, an alpha each", f"{number(time['contact_an_alpha_each_ns'])} ns a state"),
        ('the same by `method="direct"`, one alpha', f"{number(time['contact_direct_ns'])} ns a state"),
        ("`contact()`, one state, all nine fields", f"{number(time['contact_single_us'])} µs"),
        ("`roll()`, IC1 to t = 3e-3, final state (rtol 1e-6; 1e-8)", _pair(time, "roll")),
        (
            f"`ensemble()`, {sizes['timed_motions']} starts in [-2, 2]², final state, integrated (rtol 1e-6; 1e-8)",
            _pair(time, "ensemble") + " a motion",
        ),
        (
            f"the same of {50 * sizes['timed_motions']} starts, from the flow map",
            f"{number(time['flow_us'])} µs a motion",
        ),
        ("`import viscoroll`, over a bare Python", f"{number(1e3 * time['import_s'])} ms"),
        ("`viscoroll roll`, the whole process, kernels cached", f"{number(time['cli_roll_s'])} s"),
    ]
    return table(("what", "median time on one core"), rows) + "\n" + machine(m)


def machine(m: dict[str, Any]) -> str:
    about = m["machine"]
    return (
        f"{about['cpu']}, {about['system']}, Python {about['python']}, numpy {about['numpy']}, numba {about['numba']}; "
        f"viscoroll {about['viscoroll']}, {about['date']}.  Times are medians on one core.\n"
    )


def proofs(m: dict[str, Any]) -> str:
    """One table a proof, from proofs.json."""
    titles = {
        "ratios": "Bessel ratios", "contact": "Contact states", "shape": "Shape", "slopes": "Slopes and stress",
        "motion": "Motion",
    }  # fmt: skip
    parts = []
    for name, title in titles.items():
        rows = (
            (
                row["claim"].replace("|", "\\|"),
                row["domain"],
                f"{row['points']:,}",
                number(row["bound"]),
                number(row["worst"]),
                number(row["mean"]),
            )
            for row in m["proofs"]["parts"][name]["rows"]
        )
        parts.append(f"{title}:\n\n{table(('claim', 'domain', 'points', 'bound', 'worst', 'mean'), rows)}")
    return "\n".join(parts)


def independent(m: dict[str, Any]) -> str:
    """Deviations from other implementations, worst and mean."""
    rows = (
        (row["source"], row["quantity"], f"{row['values']}", number(row["worst"]), number(row["mean"]))
        for row in m["independent"]["deviations"]
    )
    return table(("from", "deviation in", "values", "worst", "mean"), rows)


def paper(m: dict[str, Any]) -> str:
    """Numbers that the paper prints, and the same computed here."""
    names = {"alpha": "α", "kappa": "κ", "gamma": "γ", "delta": "δ", "lam": "λ", "epsilon": "ε", "beta": "β"}
    rows = (
        (
            f"{row['section']:g}",
            f"{row['t']:g}" if row["t"] != "" else "",
            names.get(row["quantity"], row["quantity"]).replace("beta", "β"),
            f"{row['value']:g}",
            row["here"],
            number(row["digits"]),
        )
        for row in m["independent"]["paper"]
    )
    return table(("Sect.", "t", "quantity", "printed", "here", "difference in last digits"), rows)


def loading(m: dict[str, Any]) -> str:
    """Errors of the ways to interpolate in the atlas."""
    ways = {"spline": "tensor cubic spline (not-a-knot)", "six_points": "polynomial through six nodes along each axis"}
    errors = m["loading"]["errors"]
    rows = ((ways[way], *(number(errors[way][name]) for name in ("beta", "Q", "M"))) for way in ways)
    head = ("interpolation", "β", "Q/μ", "κM")
    return (
        table(head, rows)
        + f"\nLargest of {m['loading']['points']:,} random states, by `pipeline/measure/loading.py`.\n"
    )


def loading_steps(m: dict[str, Any]) -> str:
    """The way from a state to Q and M through the atlas, with numbers."""
    formulas = {
        "kappa_V": "kappa abs(V)",
        "kappa_delta_star_over_mu": "look up at (alpha, kappa_V)",
        "delta_star": "(mu/kappa) kappa_delta_star_over_mu",
        "s": "abs(delta)/delta_star; from 1 on: full slip, beta = 0 and Q_over_mu = 1",
        "u": "1 - sqrt(1 - s), the coordinate to interpolate in",
        "beta": "look up at (alpha, kappa_V, u)",
        "Q_over_mu": "look up at (alpha, kappa_V, u)",
        "Q": "mu Q_over_mu with the sign of V delta, that of omega - V",
        "kappa_M": "look up at (alpha, kappa_V)",
        "M": "kappa_M/kappa with the sign of V",
    }
    state = zip(("alpha", "kappa", "mu", "V", "delta"), m["loading"]["state"], strict=True)
    rows = ((f"`{name}`", formula, f"{m['loading']['steps'][name]:.8g}") for name, formula in formulas.items())
    given = ", ".join(f"{name} = {value:g}" for name, value in state)
    return f"For {given}:\n\n{table(('name', 'how', 'value'), rows)}"


def torture(m: dict[str, Any]) -> str:
    """One table of all parts of torture.json."""
    head = ("what was done", "how often", "refused", "unharmed", "wrong", "slowest, s of processor", "most memory, MB")
    rows = (
        (
            row["done"],
            *(f"{row[key]:,}" for key in ("tried", "refused", "unharmed", "wrong")),
            *("" if row[key] is None else number(row[key]) for key in ("slowest_s", "peak_mb")),
        )
        for row in rows_of(m["torture"]["parts"])
    )
    return table(head, rows)


def large(m: dict[str, Any]) -> str:
    """Memory of large calls."""
    rows = (
        (
            f"`{row['call']}`",
            f"{row['elements']:.0e}".replace("e+0", "e"),
            f"{row['result_bytes'] / 1e6:.0f} MB",
            f"{row['extra_bytes'] / 1e6:.1f} MB",
        )
        for row in m["large"]["rows"]
    )
    return table(("call", "elements", "result", "beside input and result"), rows)


BLOCKS: dict[str, Callable[[dict[str, Any]], str]] = {
    "headline": headline, "contact": contact, "direct": direct, "stress": stress, "motion": motion, "times": times,
    "proofs": proofs, "independent": independent, "independent_paper": paper, "large": large, "loading": loading,
    "loading_steps": loading_steps, "torture": torture,
    **ensembles_report.BLOCKS,
}  # fmt: skip
