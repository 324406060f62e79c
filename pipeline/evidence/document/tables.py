"""The marked blocks of README.md and docs, from the results of measure, prove and torture."""

from __future__ import annotations

from collections.abc import Mapping

from ..results import Results, rows_of, table
from .cells import cell, listed, stated, two

_NAMES = {
    "lam": "λ", "epsilon": "ε", "delta_star": "δ*", "beta": "β, times 1 − s", "Q": "Q", "M": "M",
}  # fmt: skip
_IMPORT = {"`import viscoroll`, over a bare Python": "{time[import_s]!m} ms"}
_ROLL = "{time[roll_1e-06_us]!n} µs; {time[roll_1e-08_us]!n} µs"
_ENSEMBLE = "{time[ensemble_1e-06_us]!n} µs; {time[ensemble_1e-08_us]!n} µs"
_HEADLINE = {
    "contact state, worst of {sizes[states]} random ones, against 50 digits": "{worst_contact!n}",
    "pressure and shear: closures with load, Q and M, relative to the load": "{worst_closure!n}",
    "motion IC1-IC3 at rtol 1e-8: V and ω, down to 1e-6": "{motion[speed]!n}",
    "motion IC1-IC3 at rtol 1e-8: onset of stick": "{motion[onset]!n}",
    "`contact()`, Q and M in arrays at one alpha, a state": "{time[contact_one_alpha_ns]!n} ns",
    "the same by root solves of the printed equations": "{time[contact_direct_ns]!n} ns",
    "`contact()`, Q and M in arrays with an alpha each, a state": "{time[contact_an_alpha_each_ns]!n} ns",
    "`roll()`, one motion (rtol 1e-6; 1e-8)": _ROLL,
    "`ensemble()`, a motion, integrated (rtol 1e-6; 1e-8)": _ENSEMBLE,
    "`ensemble()` of one scene, a motion, from the flow map": "{time[flow_us]!n} µs",
    **_IMPORT,
}
_THREE = {
    "contact state against 50 digits, worst of {sizes[states]}": "{worst_contact!n}",
    "friction and rolling resistance, one of many states": "{time[contact_one_alpha_ns]!n} ns",
    "one motion (rtol 1e-8); one of many, looked up": "{time[roll_1e-08_us]!n} µs; {time[flow_us]!n} µs",
}
_TIMES = {
    "`contact()`, Q and M, {sizes[timed_states]} states, one alpha": "{time[contact_one_alpha_ns]!n} ns a state",
    "the same, an alpha each": "{time[contact_an_alpha_each_ns]!n} ns a state",
    'the same by `method="direct"`, one alpha': "{time[contact_direct_ns]!n} ns a state",
    "`contact()`, one state, all nine fields": "{time[contact_single_us]!n} µs",
    "`roll()`, IC1 to t = 3e-3, final state (rtol 1e-6; 1e-8)": _ROLL,
    "`ensemble()`, {sizes[timed_motions]} starts in [-2, 2]², final state, integrated (rtol 1e-6; 1e-8)": (
        f"{_ENSEMBLE} a motion"
    ),
    "the same of {mapped} starts, from the flow map": "{time[flow_us]!n} µs a motion",
    **_IMPORT,
    "`viscoroll roll`, the whole process, kernels cached": "{time[cli_roll_s]!n} s",
}
_PAGE = {
    "a redraw of four curves with their layout, median of {sizes[redraws]}": "{page[median_ms]!n} ms",
    "numbers of the page against `vr.contact`, at most": "{page[error]!n}",
    "the file": "{kilobytes:.0f} kB",
}
_OUTSIDE = {
    "C, gcc -O2, a state; with all slopes": "{states[c_ns]!n} ns; {states[c_slopes_ns]!n} ns",
    "JavaScript, Node, a state": "{states[node_ns]!n} ns",
    "FMU: complaints of `validate_fmu`, both models, FMI 2.0 and 3.0": "{fmu[complaints]}",
    "FMU: a thrown roller as co-simulation against `roll`": "{fmu[roller_error]!n}",
    "FMU: the contact element in SciPy's Radau at rtol 1e-9, likewise": "{fmu[element_error]!n}",
    "FMU: largest file, sources inside": "{kilobytes:.0f} kB",
}
_MACHINE = (
    "\n{cpu}, {system}, Python {python}, numpy {numpy}, numba {numba}; "
    "viscoroll {viscoroll}, {date}.  Times are medians on one core.\n"
)


def headline(results: Results, lines: Mapping[str, str] = _HEADLINE) -> str:
    """What matters most of all that was measured."""
    m = results["measured"]
    own = {
        "worst_contact": max(field["worst"] for field in m["contact_error"].values()),
        "worst_closure": max(m["stress_closure"].values()), "motion": m["motion_error"]["paper"]["1e-08"],
    }  # fmt: skip
    return stated(("what", "measured"), lines, m | own) + cell(_MACHINE, m["machine"])


def three(results: Results) -> str:
    """Of that, three numbers for the README."""
    return headline(results, _THREE)


def times(results: Results) -> str:
    m = results["measured"]
    shown = m | {"mapped": 50 * m["sizes"]["timed_motions"]}
    return stated(("what", "median time on one core"), _TIMES, shown) + cell(_MACHINE, m["machine"])


def contact(results: Results) -> str:
    rows = ({"name": text} | results["measured"]["contact_error"][name] for name, text in _NAMES.items())
    return listed({"relative error": "{name}", "median": "{median!n}", "worst": "{worst!n}"}, rows)


def direct(results: Results) -> str:
    units = {
        "lam": "relative", "epsilon": "over max(1, ε)", "delta_star": "relative", "beta": "absolute",
        "Q": "over μ", "M": "times κ",
    }  # fmt: skip
    worst, names = results["measured"]["table_against_direct"], _NAMES | {"beta": "β"}
    return table(("field", "difference", "worst"), ((names[n], units[n], two(worst[n])) for n in units))


def stress(results: Results) -> str:
    meaning = {
        "∫ p dx = P": "{load!n}", "∫ τ dx = Q": "{traction!n}", "∫ x p dx = M": "{moment!n}",
    }  # fmt: skip
    return stated(("closure", "worst, relative to the load"), meaning, results["measured"]["stress_closure"])


def motion(results: Results) -> str:
    m = results["measured"]
    columns = {
        "rtol": "{rtol:.0e}", "V, ω": "{speed!n}", "over condition": "{speed_over_condition!n}", "x": "{x!n}",
        "onset": "{onset!n}", "steps": "{steps:.0f}",
    }  # fmt: skip
    titles = {
        "paper": "IC1-IC3, rounded parameters", "random": f"{m['sizes']['scenes']} random scenes and starts",
    }  # fmt: skip
    parts = []
    for group, title in titles.items():
        rows = ({"rtol": float(rtol)} | errors for rtol, errors in m["motion_error"][group].items())
        parts.append(f"{title}:\n\n{listed(columns, sorted(rows, key=lambda row: -row['rtol']))}")
    return "\n".join(parts)


def proofs(results: Results) -> str:
    """A row a proof, with the claim that comes closest to its bound; data/results/proofs.json has all of them."""
    titles = {
        "ratios": "Bessel ratios", "contact": "contact states", "states": "states of rows, 60 digits", "shape": "shape",
        "slopes": "slopes and stress", "motion": "motion", "series": "series and pairs",
        "boundary": "boundary elements", "driven": "driven motion", "check_driven": "driven motion, extended precision",
    }  # fmt: skip
    columns = {
        "proof": "{title}", "claims": "{claims}", "points": "{points:,}", "closest to its bound": "{claim}",
        "bound": "{bound!n}", "worst": "{worst!n}",
    }  # fmt: skip
    lines = []
    for name, title in titles.items():
        rows = results["proofs"]["parts"][name]["rows"]
        closest = max(rows, key=lambda row: row["worst"] / row["bound"] if row["bound"] else row["worst"])
        found = {"title": title, "claims": len(rows), "points": sum(row["points"] for row in rows)}
        lines.append(closest | found | {"claim": closest["claim"].replace("|", "\\|")})
    return listed(columns, lines)


def independent(results: Results) -> str:
    """Deviations from other implementations, worst and mean."""
    columns = {
        "from": "{source}", "deviation in": "{quantity}", "values": "{values}", "worst": "{worst!n}",
        "mean": "{mean!n}",
    }  # fmt: skip
    return listed(columns, results["independent"]["deviations"])


def paper(results: Results) -> str:
    """Numbers that the paper prints, and the same computed here."""
    names = {"alpha": "α", "kappa": "κ", "gamma": "γ", "delta": "δ", "lam": "λ", "epsilon": "ε", "beta": "β"}
    columns = {
        "Sect.": "{section:g}", "t": "{t}", "quantity": "{quantity}", "printed": "{value:g}", "here": "{here}",
        "difference in last digits": "{digits!n}",
    }  # fmt: skip
    rows = (
        row | {
            "t": f"{row['t']:g}" if row["t"] != "" else "",
            "quantity": names.get(row["quantity"], row["quantity"]).replace("beta", "β"),
        }
        for row in results["independent"]["paper"]
    )  # fmt: skip
    return listed(columns, rows)


def torture(results: Results) -> str:
    """One table of all its parts."""
    columns = {
        "what was done": "{done}", "how often": "{tried:,}", "refused": "{refused:,}", "unharmed": "{unharmed:,}",
        "wrong": "{wrong:,}", "slowest, s of processor": "{slowest_s}", "most memory, MB": "{peak_mb}",
    }  # fmt: skip
    rows = (
        row | {name: "" if row[name] is None else two(row[name]) for name in ("slowest_s", "peak_mb")}
        for row in rows_of(results["torture"]["parts"])
    )
    return listed(columns, rows)


def page(results: Results) -> str:
    """The page that computes."""
    found = results["outside"]
    return stated(("what", "measured"), _PAGE, found | {"kilobytes": found["page"]["bytes"] / 1e3})


def outside(results: Results) -> str:
    """The law in C, in Node and in FMUs."""
    found = results["outside"]
    return stated(("what", "measured"), _OUTSIDE, found | {"kilobytes": found["fmu"]["bytes"] / 1e3})


def large(results: Results) -> str:
    """Memory of large calls."""
    columns = {
        "call": "`{call}`", "elements": "{elements}", "result": "{result:.0f} MB",
        "beside input and result": "{extra:.1f} MB",
    }  # fmt: skip
    rows = (
        {
            "call": row["call"], "elements": f"{row['elements']:.0e}".replace("e+0", "e"),
            "result": row["result_bytes"] / 1e6, "extra": row["extra_bytes"] / 1e6,
        }
        for row in results["large"]["rows"]
    )  # fmt: skip
    return listed(columns, rows)
