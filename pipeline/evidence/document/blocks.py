"""The marked blocks of README.md and docs: tables of what stages have left."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from viscoroll.core.scale import DIMENSIONS, si_unit
from viscoroll.core.symbols import SYMBOLS, meaning

from ..results import Results, rows_of, table
from .cells import cell, listed, two

Row = Mapping[str, Any]
#: block -> (the stage that measures it, its text)
BLOCKS: dict[str, tuple[str, Callable[[Results], str]]] = {}
_NS, _TIMES_FASTER = "{ns!t} ns (least {least_ns!t})", "times faster"


def rows(stage: str, file: str, columns: Mapping[str, str]) -> Callable[[Any], Any]:
    """A block that is a table: of rows that are made of a file of results, by templates under their headings."""

    def kept(made: Callable[[Any], Iterable[Row]]) -> Any:
        BLOCKS[made.__name__] = stage, lambda results: listed(columns, made(results[file]))
        return made

    return kept


def text(stage: str) -> Callable[[Any], Any]:
    """A block that is what a function of the results says."""

    def kept(made: Callable[[Results], str]) -> Any:
        BLOCKS[made.__name__] = stage, made
        return made

    return kept


def stated(name: str, stage: str, head: tuple[str, str], lines: Mapping[str, str], values: Any, end: str = "") -> None:
    """A block of one set of values: what, and how much, both templates."""

    def made(results: Results) -> str:
        found = values(results)
        return table(head, ((cell(what, found), cell(how_much, found)) for what, how_much in lines.items())) + cell(
            end, found
        )

    BLOCKS[name] = stage, made


# --- measure ---

_ROLL = "{time[roll_1e-06_us]!n} µs; {time[roll_1e-08_us]!n} µs"
_ENSEMBLE = "{time[ensemble_1e-06_us]!n} µs; {time[ensemble_1e-08_us]!n} µs"
_STATE = "Q and M of a contact state against enclosures, worst of {states}, condition below 225"
_HEADLINE = {
    _STATE: "{contact!n}",
    "pressure and shear: closures with load, Q and M, relative to the load": "{closure!n}",
    "motions in extended precision, the paper's among them, at rtol 1e-8: V and ω over their condition": "{speed!n}",
    "the same: onset of stick": "{onset!n}",
}
_THREE = {
    _STATE: "{contact!n}",
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
    "the same of 50 times as many, from the flow map": "{time[flow_us]!n} µs a motion",
    "`import viscoroll`, over a bare Python": "{time[import_s]!m} ms",
    "`viscoroll roll`, the whole process, kernels cached": "{time[cli_roll_s]!n} s",
}
_MACHINE = (
    "\n{machine[cpu]}, {machine[system]}, Python {machine[python]}, numpy {machine[numpy]}, numba {machine[numba]}; "
    "viscoroll {machine[viscoroll]}, {machine[date]}.  Times are medians on one core.\n"
)


def _claims(results: Results, part: str, *words: str) -> list[dict[str, Any]]:
    """Rows of a part of the proofs whose claims hold all these words."""
    return [row for row in results[f"proofs {part}"]["rows"] if all(word in row["claim"] for word in words)]


def _worst(results: Results, part: str, *words: str) -> float:
    return max(row["worst"] for row in _claims(results, part, *words))


def _state(results: Results) -> dict[str, Any]:
    """Errors of states."""
    found = [row for name in ("Q, ", "M, ") for row in _claims(results, "contact", "relative", name)]
    return {"contact": max(row["worst"] for row in found), "states": sum(row["points"] for row in found) // 2}


def _most(results: Results) -> dict[str, Any]:
    """What matters most of all."""
    speed, onset = (1e-8 * _worst(results, "check_motions", name, "1e-08") for name in ("V and omega", "onset"))
    return _state(results) | {"closure": _worst(results, "slopes", "Int"), "speed": speed, "onset": onset}


stated("headline", "prove", ("what", "measured"), _HEADLINE, _most)
stated(
    "three", "measure", ("what", "measured"), _THREE, lambda results: results["measured"] | _state(results), _MACHINE
)
stated("times", "measure", ("what", "median time on one core"), _TIMES, lambda results: results["measured"], _MACHINE)
stated(
    "page", "measure.outside", ("what", "measured"), {
        "a redraw of four curves with their layout, median of {sizes[redraws]}": "{page[median_ms]!n} ms",
        "numbers of the page against `vr.contact`, at most": "{page[error]!n}",
        "the file": "{page[bytes]!k} kB",
    }, lambda results: results["outside"],
)  # fmt: skip
stated(
    "outside", "measure.outside", ("what", "measured"), {
        "C, gcc -O2, a state; with all slopes": "{states[c_ns]!n} ns; {states[c_slopes_ns]!n} ns",
        "JavaScript, Node, a state": "{states[node_ns]!n} ns",
    }, lambda results: results["outside"],
)  # fmt: skip


@rows("measure.large", "large", {
    "call": "`{call}`", "elements": "{elements}", "result": "{result:.0f} MB",
    "beside input and result": "{extra:.1f} MB",
})  # fmt: skip
def large(found: Any) -> Iterator[Row]:
    """Memory of large calls."""
    for row in found["rows"]:
        elements = f"{row['elements']:.0e}".replace("e+0", "e")
        yield row | {"elements": elements, "result": row["result_bytes"] / 1e6, "extra": row["extra_bytes"] / 1e6}


#: the large run: motions, machines, and motions a block by how they are rolled
MOTIONS, MACHINES = 10**11, 100
BLOCKS_OF = {"one scene, from its flow map": 4_000_000, "seven uncertain inputs, integrated": 1_000_000}
_ABOUT = (
    "\nBlocks of {sizes[block]} motions, a 16th of the run where all inputs are uncertain; one output time, "
    "{threads} threads; {machine[cpu]}, {machine[date]}, by `pipeline/evidence/measure/ensembles.py`.  "
    "Other work on the machine lengthens the seconds, hardly those of the processor.\n"
    "A store is verified at {verify_mb_per_s:.0f} MB/s.\n"
)


@text("measure.ensembles")
def ensembles(results: Results) -> str:
    """Time, memory and disk of each run, and the bare loop."""
    m = results["ensembles"]
    columns = {
        "run": "{name}", "s": "{seconds:.3g}", "s of processor": "{cpu_s:.3g}", "most memory, MB": "{memory}",
        "disk, MB": "{disk}",
    }  # fmt: skip
    shown = [
        row | {"name": name, "memory": f"{row['peak_mb']:.0f}", "disk": f"{row['stored_mb']:.3g}"}
        for name, row in sorted(m["rows"].items(), key=lambda item: (item[1]["motions"], item[0]))
    ]
    alone = f"{m['loop']['motions']} motions of a scene, `ensemble()` alone"
    return listed(columns, [*shown, m["loop"] | {"name": alone, "memory": "", "disk": ""}]) + cell(_ABOUT, m)


@text("measure.ensembles")
def ensembles_cluster(results: Results) -> str:
    """What dask costs."""
    m = results["ensembles"]
    found, head = m["cluster"], f"block of {m['sizes']['block']} motions of a scene"
    names = {"seconds a block": "seconds", "of processor": "cpu_s"}
    shown = (
        {"name": name, "overhead": found[f"overhead_{clock}"]}
        | {where: found[f"{where}_{clock}_a_block"] for where in ("threads", "dask")} for name, clock in names.items()
    )  # fmt: skip
    columns = {head: "{name}", "threads": "{threads:.3g}", "dask, local": "{dask:.3g}", "overhead": "{overhead:+.1%}"}
    return listed(columns, shown) + cell("\nOnce running; its start takes {dask_start_s:.2g} s.\n", found)


@text("measure.ensembles")
def ensembles_plan(results: Results) -> str:
    """10^11 motions on 100 machines like the one measured on."""
    m = results["ensembles"]
    sizes, workers, shown = m["sizes"], MACHINES * m["threads"], []
    measured = (f"{sizes['fixed'][-1]} motions of a scene", f"{sizes['uncertain']} motions, seven uncertain inputs")
    columns = {
        "motions": "{name}", "blocks": "{blocks} of {block}", "a block takes": "{seconds:.2g} s",
        "tasks a second": "{tasks:.2g}", "all take": "{hours:.2g} h", "records": "{records:.2g} GB",
        "summing up": "{merging:.2g} min",
    }  # fmt: skip
    for (name, block), run in zip(BLOCKS_OF.items(), (m["rows"][key] for key in measured), strict=True):
        blocks, seconds = MOTIONS // block, block * run["cpu_s"] / run["motions"]
        shown.append({
            "name": name, "blocks": blocks, "block": block, "seconds": seconds, "tasks": workers / seconds,
            "hours": blocks * seconds / workers / 3600.0, "records": blocks * m["record_bytes"] / 1e9,
            "merging": blocks * m["merge_s_a_block"] / 60.0,
        })  # fmt: skip
    kept = m["rows"][f"{sizes['designs']} motions of a scene, all kept"]
    whole = MOTIONS * kept["stored_mb"] / kept["motions"] / 1e6
    return listed(columns, shown) + (
        f"\nEvery motion with V, omega, x at one time, its start, onset, rest and status would be {whole:.2g} TB.\n"
    )


# --- prove ---

#: block -> head, and parts of the proofs with words that their claims hold
_CLAIMS = {
    "contact": ("relative error", {"contact": "relative"}), "direct": ("difference", {"direct": ""}),
    "stress": ("closure", {"slopes": "Int"}),
    "motion": ("error at the default tolerance", dict.fromkeys(("check_motions", "motion"), "rtol 1e-08, over")),
}  # fmt: skip
_FOUND = {"allowed": "{bound!n}", "mean": "{mean!n}", "worst": "{worst!n}"}


def _claimed(results: Results, head: str, parts: dict[str, str]) -> str:
    return listed(
        {head: "{claim}"} | _FOUND, [row for part, words in parts.items() for row in _claims(results, part, words)]
    )


for _name, _which in _CLAIMS.items():
    BLOCKS[_name] = "prove", lambda results, which=_which: _claimed(results, *which)


@rows("prove", "proofs", {
    "proof": "{title}", "claims": "{claims}", "points": "{points:,}", "closest to its bound": "{claim}",
    "bound": "{bound!n}", "worst": "{worst!n}",
})  # fmt: skip
def proofs(found: Any) -> Iterator[Row]:
    """A row a proof, with the claim that comes closest to its bound; data/results/proofs.json has all of them."""
    for name, part in found["parts"].items():
        claims = part["rows"]
        closest = max(claims, key=lambda row: row["worst"] / row["bound"] if row["bound"] else row["worst"])
        points = sum(row["points"] for row in claims)
        claim = closest["claim"].replace("|", "\\|")
        yield closest | {"title": name.replace("_", " "), "claims": len(claims), "points": points, "claim": claim}


@rows("prove.independent", "independent", {
    "from": "{source}", "deviation in": "{quantity}", "values": "{values}", "worst": "{worst!n}", "mean": "{mean!n}",
})  # fmt: skip
def independent(found: Any) -> list[Row]:
    """Deviations from other implementations, worst and mean."""
    return found["deviations"]


@rows("prove.independent", "independent", {
    "Sect.": "{section:g}", "t": "{t}", "quantity": "{quantity}", "printed": "{value:g}", "here": "{here}",
    "difference in last digits": "{digits!n}",
})  # fmt: skip
def independent_paper(found: Any) -> Iterator[Row]:
    """Numbers that the paper prints, and the same computed here."""
    for row in found["paper"]:
        quantity = _GREEK.get(row["quantity"], row["quantity"]).replace("beta", "β")
        yield row | {"t": f"{row['t']:g}" if row["t"] != "" else "", "quantity": quantity}


#: of the motions without sliding: those of the table over gamma; starts; levels of the unsteadiness
FEW, _STARTS = 6, {"steady": "steady contact", "rest": "long rest"}


@rows("prove.unsteady", "transient", {
    "gamma": "{gamma!t}", "unsteadiness at the start": "{unsteadiness!n}", "way by the law, l0": "{way!n}",
    "from steady contact": "{a!n} %", "from a contact at rest": "{b!n} %",
})  # fmt: skip
def unsteady_gamma(found: Any) -> Iterator[Row]:
    """Largest errors of V of the first motions, alpha = 11 and kappa V = 4.4 at the start."""
    for row in found["rows"][:FEW]:
        yield row | {"gamma": 1.5 * row["g"], "a": 100.0 * row["steady"]["error"], "b": 100.0 * row["rest"]["error"]}


@rows("prove.unsteady", "transient", {"unsteadiness": "{level:g}"} | {
    f"{words}{by}": f"{{{start}{n}}}" for start, words in _STARTS.items() for n, by in enumerate(("", ", with N"))
})  # fmt: skip
def unsteady(found: Any) -> Iterator[Row]:
    """e by level of the unsteadiness: least, largest and median of the motions."""
    errors = [(start, *one) for row in found["rows"] for start in _STARTS for one in row[start]["e"]]
    for level in sorted({one[1] for one in errors}):
        row = {"level": level}
        for start in _STARTS:
            for n in range(2):
                e = [100.0 * one[2 + n] for one in errors if one[:2] == (start, level) and one[2 + n] is not None]
                row[f"{start}{n}"] = f"{two(min(e))} to {two(max(e))} ({two(statistics.median(e))}) %" if e else ""
        yield row


@rows("prove.unsteady", "transient", {
    "relaxation times": "{modes}", "kappa V at the start": "{u!t}", "gamma/(1 + j)": "{g!t}",
    "unsteadiness at the start": "{unsteadiness!n}", "way by the law": "{way!t}", "from steady contact": "+{a!t}",
    "from long rest": "{b!t}", "the rest cost": "{c!t}", "as `start` says": "{start!t}",
})  # fmt: skip
def unsteady_ways(found: Any) -> Iterator[Row]:
    """How far the motions go, in contact lengths."""
    for row in found["rows"][FEW:]:
        a, b = row["steady"]["shift"], row["rest"]["shift"]
        yield row | {"a": a, "b": b, "c": a - b}


@rows("torture", "torture", {
    "what was done": "{done}", "how often": "{tried:,}", "refused": "{refused:,}", "unharmed": "{unharmed:,}",
    "wrong": "{wrong:,}", "slowest, s of processor": "{slowest_s!n}", "most memory, MB": "{peak_mb!n}",
})  # fmt: skip
def torture(found: Any) -> list[Row]:
    """One table of all its parts."""
    return rows_of(found["parts"])


# --- bench ---

PAPER_GROUPS = ("IC1", "IC2", "IC3")
#: share of the motions that a peer may give up and still be compared, on those that it finished
MOST_FAILED = 0.05
#: what the ratios are about: motions that are integrated, as by the peers, at the default tolerance; and looked up
INTEGRATED, LOOKED_UP, DEFAULT_RTOL = "table", "flow", 1e-8


def paper_rows(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows over IC1-IC3 together: mean time, largest error (while moving)."""
    together: dict[tuple[str, float], list[dict[str, Any]]] = {}
    for row in found:
        if row["group"] in PAPER_GROUPS:
            together.setdefault((row["method"], row["rtol"]), []).append(row)
    return [
        {
            "method": method, "rtol": rtol, "us": float(np.mean([row["us"] for row in three])),
            "max": max(row.get("max_moving") or np.inf for row in three),
        } | {name: sum(row[name] for row in three) for name in ("failed", "motions")}
        for (method, rtol), three in together.items() if len(three) == len(PAPER_GROUPS)
    ]  # fmt: skip


def moving(found: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows with their errors while moving.

    A motion that has all but ended has a large relative error in V with any method but one in log V.
    """
    return [row | {"max": row.get("max_moving") or np.inf, "p99": row.get("p99_moving")} for row in found]


def finished(row: Row) -> bool:
    """Whether nearly all motions of a row were rolled to the end."""
    return row["failed"] <= MOST_FAILED * row["motions"]


def ratios(found: list[dict[str, Any]], own: str) -> list[dict[str, Any]]:
    """For each row of another method: how many times faster the quickest row of ``own`` with no larger error is."""
    result = []
    mine = [row for row in found if row["method"] == own and not row["failed"] and row.get("max") is not None]
    for row in found:
        if row["method"] == own or not finished(row) or row.get("max") is None:
            continue
        if fit := [candidate for candidate in mine if candidate["max"] <= row["max"]]:
            best = min(fit, key=lambda candidate: candidate["us"])
            result.append(row | {"ratio": row["us"] / best["us"], "own_us": best["us"], "own_error": best["max"]})
    return result


@text("bench")
def bench_peers(results: Results) -> str:
    """Ratio, method, its us a motion and error, ours, ratio and ours of the look-up: on IC1-IC3, on the random starts,
    and with own parameters, where nothing is looked up.

    Each peer at the setting with its smallest error.  Slow ones were tried on fewer of the random motions than this
    package, whose error is that over all of them.
    """
    groups = {
        "IC1-IC3": ("work-precision", paper_rows),
        "random starts": ("work-precision", lambda found: moving(row for row in found if row["group"] == "random")),
        "own parameters": ("own-parameters", moving),
    }
    lines, ours = [], "{own_us:.3g} µs at {own_error:.1e}"
    for where, (part, choose) in groups.items():
        if (result := results.found(f"bench-{part}")) is None:
            continue
        found, methods = choose(result["measured"]["results"]), result["measured"]["methods"]
        default = (INTEGRATED, DEFAULT_RTOL)
        compared = ratios(
            [r for r in found if r["method"] not in (INTEGRATED, LOOKED_UP) or (r["method"], r["rtol"]) == default],
            INTEGRATED,
        )
        looked_up = {(row["method"], row["rtol"]): row for row in ratios(found, LOOKED_UP)}
        for method in dict.fromkeys(row["method"] for row in compared):
            row = min((row for row in compared if row["method"] == method), key=lambda row: row["max"])
            name = f"{methods[method]['label']}, rtol {row['rtol']:.0e}, {where}"
            name += f" ({row['failed']} of {row['motions']} given up)" if row["failed"] else ""
            quick = looked_up.get((method, row["rtol"]))
            last = (two(quick["ratio"]), cell(ours, quick)) if quick else ("", "")
            lines.append((two(row["ratio"]), name, cell("{us:.3g} µs at {max:.1e}", row), cell(ours, row), *last))
    head = (_TIMES_FASTER, "than", "its time and max error", "viscoroll, integrated", _TIMES_FASTER, "looked up")
    return table(head, lines)


_RUNS = {
    "method": "{label}", "rtol": "{rtol:.0e}", "a motion": "{us!t} µs (least {least_us!t})", "max error": "{max:.1e}",
    "99th percentile": "{p99:.1e}", "given up": "{failed}",
}  # fmt: skip


@rows("bench", "bench-own-parameters", _RUNS)
def bench_own(found: Any) -> Iterator[Row]:
    """Every tolerance of the motions with scenes of their own."""
    measured = found["measured"]
    return (row | measured["methods"][row["method"]] for row in moving(measured["results"]))


@rows("bench", "bench-driven", {"from": "{group}"} | _RUNS)
def bench_driven(found: Any) -> Iterator[Row]:
    """Driven motions beside LSODA."""
    return bench_own(found)


@text("bench")
def bench_fixed_scene(results: Results) -> str:
    """Motions of one scene by its flow map."""
    m = results["bench-fixed-scene"]["measured"]
    lines = [(name, f"{cell(_NS, row)} a motion") for name, row in m["rows"].items()]
    more = {
        "largest error of motions from the map, final state; all 30 times": (
            "{error[final]:.1e}; {error[all_times]:.1e}"
        ),
        "motions of {compared} that the map does not hold and that were integrated; largest error of all": (
            "{not_in_map}; {error[with_integrated]:.1e}"
        ),
        "error that the map states": "{stated_error:.1e} (path {stated_path_error:.1e})",
        "build, with its error measured; load": "{build_s!t} s; {load_s!u} ms",
        "size": f"{m['bytes'] / 1e6:.2f} MB",
    }
    lines += [(cell(what, m), cell(how_much, m)) for what, how_much in more.items()]
    return table(("one scene, flow map, one core", "measured"), lines)


def named(found: Any) -> Iterator[dict[str, Any]]:
    """Rows of a mapping."""
    return ({"name": name} | row for name, row in found["measured"].items())


@rows("bench", "bench-bound-law", {
    "material": "{material}", "called": "{called}", "a state": _NS, "by `contact`": "{of_contact}",
    _TIMES_FASTER: "{times:.2g}",
})  # fmt: skip
def bench_bound_law(found: Any) -> Iterator[Row]:
    """The law of one scene beside contact()."""
    for row in found["measured"]["rows"]:
        called, theirs = row["way"] + ", slopes" * row["slopes"], row["contact"]
        yield row | {"called": called, "of_contact": cell(_NS, theirs), "times": theirs["ns"] / row["ns"]}


@rows("bench", "bench-last-release", {
    "Q and M of": "{name}", "a state": "{ns!t} ns", "in the last release": "{ns_before!t} ns", "times": "{ratio:.2f}",
})  # fmt: skip
def bench_last_release(found: Any) -> Iterator[Row]:
    """``contact`` beside that of the last release."""
    return named(found)


@rows("bench", "bench-series", {
    "material": "{material}", "a state": "{state}", "a motion, µs": "{least}", "its table, ms": "{table_ms!n}",
})  # fmt: skip
def bench_series(found: Any) -> Iterator[Row]:
    """Contact, motions and tables by the number of modes."""
    for row in found["measured"]:
        us = {name: 1e-3 * value for name, value in row["motion"].items()}
        state = cell(_NS, row["contact"]) if "contact" in row else ""
        yield row | {"state": state, "least": cell("{ns:.3g} (least {least_ns:.3g})", us)}


@rows("bench", "bench-first-calls", {
    "cache": "{cache}", "after the first": "{call}", "processor": "{cpu_s:.1f} s", "wall": "{wall_s:.1f} s",
    "peak memory": "{peak_mb:.0f} MB", "cached": "{files} files, {cache_mb:.1f} MB",
})  # fmt: skip
def bench_first_calls(found: Any) -> Iterator[Row]:
    """One process from an empty cache of kernels, one from a full one."""
    return ({"cache": cache} | row for cache, calls in found["measured"].items() for row in calls)


# --- nothing is measured ---

_GREEK = {
    "alpha": "α", "kappa": "κ", "mu": "μ", "gamma": "γ", "omega": "ω", "angle": "θ", "delta": "δ", "delta_star": "δ*",
    "lam": "λ", "epsilon": "ε", "zeta": "ζ", "beta": "β", "force": "f", "torque": "q", "brake": "B", "slope": "ϑ",
    "tau": "τ", "onset_time": "t*",
}  # fmt: skip
#: units as "m s-1"
_POWERS = str.maketrans({"-": "⁻", "1": "¹", "2": "²"})


@text("document")
def symbols(results: Results) -> str:
    """Every symbol of a result: what it is, in which unit a scene and a cylinder give it, its range and equation."""
    lines = []
    for name, symbol in SYMBOLS.items():
        si = si_unit(name).translate(_POWERS) if name in DIMENSIONS else ""
        about, allowed, equation = (t.replace("|", "\\|") for t in (meaning(name), symbol.range, symbol.equation))
        lines.append((f"`{name}`", _GREEK.get(name, ""), about, allowed, si, equation))
    return table(("in code", "symbol", "what it is, of a scene", "range", "of a cylinder", "equation"), lines)
