"""The marked blocks of README.md and docs: what blocks.toml says of each, of what stages have
left.
"""

import html
import re
import statistics
import string
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from viscoroll.core.quantities import DIMENSIONS, SYMBOLS, describe_quantity, si_unit

from ...stage import Row
from ..results import Results, rows_of, table
from . import house
from . import house as costs

# --- tables whose cells are templates: str.format with conversions for numbers ---


def two(value: float) -> str:
    """Two significant digits, plain where that is short."""
    text = f"{value:.2g}"
    return f"{float(text):.0f}" if 100 <= float(text) < 1e6 else text


def three_digits(value: float) -> str:
    """Three significant digits."""
    return f"{float(f'{value:.3g}'):g}"


#: two digits, in thousandths, in per cent; three digits, likewise; whole; thousands and millions to
#: go on with; a power of ten; a vertical line that ends no cell
CONVERSIONS = {
    "n": two,
    "m": lambda value: two(1e3 * value),
    "c": lambda value: two(100.0 * value),
    "t": three_digits,
    "u": lambda value: three_digits(1e3 * value),
    "h": lambda value: three_digits(100.0 * value),
    "i": "{:.0f}".format,
    "k": lambda value: 1e-3 * value,
    "M": lambda value: 1e-6 * value,
    "e": lambda value: f"{value:.0e}".replace("e+0", "e"),
    "p": lambda text: text.replace("|", "\\|"),
}


class Cells(string.Formatter):
    """``str.format`` with the CONVERSIONS; nothing of None and of empty text."""

    def convert_field(self, value, conversion: str | None):
        if not conversion:
            return value
        return "" if value in (None, "") else CONVERSIONS[conversion](value)

    def __call__(self, template: str, values: Mapping[str, Any]) -> str:
        return self.vformat(template, (), values)


cell = Cells()


def listed(columns: Mapping[str, str], rows: Iterable[Mapping[str, Any]]) -> str:
    """A Markdown table: a line for each of ``rows`` by the templates under their headings."""
    return table(columns, ([cell(template, row) for template in columns.values()] for row in rows))


# --- what measurements tell ---

_NEVER = "no influence"
_OPEN = "unbounded"


def _known(row, name):
    """Standard deviation and interval over the truth."""
    if name not in row["unknowns"]:
        return "given"
    if name in row["does_not_act"]:
        return _NEVER
    one = row["unknowns"][name]
    ends = [_OPEN if one[end] is None else f"{1.0 + one[end]:.4g}" for end in ("low", "high")]
    if name in row["undetermined"]:
        return _OPEN if ends == [_OPEN, _OPEN] else f"[{', '.join(ends)}]"
    return f"{100.0 * one['sd']:.2g} % [{', '.join(ends)}]"


def _together(row):
    """What is determined of those that are not told apart."""
    if not row["undetermined"]:
        return "all"
    texts = []
    for one in row["products"]:
        powers = sorted(one["powers"].items(), key=lambda item: -abs(item[1]))
        named = " ".join(name if power == 1.0 else f"{name}^{power:.2g}" for name, power in powers)
        near = " (near these values)" if one["near"] else ""
        texts.append(f"{named}{near}, {50.0 * (one['high'] - one['low']):.2g} %")
    others = [
        name for name in row["unknowns"] if name not in (*row["undetermined"], *row["does_not_act"])
    ]
    return "; ".join([*texts, *others]) or "nothing"


def identify_learn(results, part="learn"):
    """One row an experiment."""
    for row in results[f"identification {part}"]["rows"]:
        known = {name: _known(row, name) for name in ("mu", "E", "E_1", "T_ref", "brake", "drag")}
        yield known | {"experiment": row["experiment"], "together": _together(row)}


def identify_said(results):
    """Six reports."""
    rows = results["identification said"]["rows"]
    return "\n".join(
        f"{row['problem'].capitalize()}:\n\n```text\n{row['report']}\n```\n" for row in rows
    )


def identify_times(results):
    """How long it takes, and how near ends of intervals are."""
    off = max(row["off"] for row in results["identification width"]["rows"])
    return (row | {"off": off} for row in results["identification time"]["rows"])


def identify_coverage(results):
    """How often intervals hold the truth."""
    for row in results["identification coverage"]["rows"]:
        yield row | {
            "shares": ", ".join(
                f"{name} {100.0 * share:.3g} %" for name, share in row["held"].items()
            )
        }


IDENTIFY = identify_learn, identify_said, identify_times, identify_coverage


# --- blocks ---

#: what is said of each
BLOCKS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


def block(name: str, results: Results) -> str:
    """The text of a block."""
    given = BLOCKS[name]
    values = results[given["of"]] if "of" in given else {}
    found = (
        MAKERS[maker](results, *given.get("given", ()))
        if (maker := given.get("maker", name)) in MAKERS
        else values.get(given.get("rows"), values)
    )
    if "claims" in given:
        found = [
            row for part, words in given["claims"].items() for row in claims(results, part, words)
        ]
    if "lines" in given:
        head, *lines = given["lines"]
        text = table(head, ([cell(each, values | found) for each in line] for line in lines))
    elif "columns" in given:
        rows = [*(rows_of(found.get("parts", {"": found})) if isinstance(found, dict) else found)]
        text = listed(
            {cell(head, values): template for head, template in given["columns"].items()}, rows
        )
        values = values | rows[-1]
    else:
        text = found
    return text + cell(given.get("end", ""), values)


# --- measure ---


def claims(results: Results, part: str, *words: str) -> list[Row]:
    """Rows of a part of the proofs whose claims hold all these words."""
    return [
        row
        for row in results[f"proofs {part}"]["rows"]
        if all(word in row["claim"] for word in words)
    ]


def three(results):
    """Errors of states."""
    found = [row for name in ("Q, ", "M, ") for row in claims(results, "contact", "relative", name)]
    return {
        "contact": max(row["worst"] for row in found),
        "states": sum(row["points"] for row in found) // 2,
    }


def headline(results):
    """What matters most of all."""

    def worst(part, *words):
        return max(row["worst"] for row in claims(results, part, *words))

    speed, onset = (
        1e-8 * worst("check_motions", name, "1e-08") for name in ("V and omega", "onset")
    )
    return three(results) | {"closure": worst("slopes", "Int"), "speed": speed, "onset": onset}


#: the large run: motions, machines, and motions a block by how they are rolled
MOTIONS = 10**11
MACHINES = 100
BLOCKS_OF = {
    "one scene, from its flow map": 4_000_000,
    "seven uncertain inputs, integrated": 1_000_000,
}


def ensembles(results):
    """Time, memory and disk of each run, and the bare loop."""
    m = results["ensembles"]
    rows = sorted(m["rows"].items(), key=lambda item: (item[1]["motions"], item[0]))
    alone = {
        "name": f"{m['loop']['motions']} motions of a scene, `ensemble()` alone",
        "peak_mb": "",
        "stored_mb": "",
    }
    return [*(row | {"name": name} for name, row in rows), m["loop"] | alone]


def ensembles_plan(results):
    """10^11 motions on 100 machines like the one measured on."""
    m = results["ensembles"]
    sizes = m["sizes"]
    workers = MACHINES * m["threads"]
    measured = (
        f"{sizes['fixed'][-1]} motions of a scene",
        f"{sizes['uncertain']} motions, seven uncertain inputs",
    )
    kept = m["rows"][f"{sizes['designs']} motions of a scene, all kept"]
    for (name, size), run in zip(
        BLOCKS_OF.items(), (m["rows"][key] for key in measured), strict=True
    ):
        count = MOTIONS // size
        seconds = size * run["cpu_s"] / run["motions"]
        yield {
            "name": name,
            "blocks": count,
            "block": size,
            "seconds": seconds,
            "tasks": workers / seconds,
            "hours": count * seconds / workers / 3600.0,
            "records": count * m["record_bytes"] / 1e9,
            "merging": count * m["merge_s_a_block"] / 60.0,
            "whole": MOTIONS * kept["stored_mb"] / kept["motions"] / 1e6,
        }


def grids(results):
    """Motions from the rows beside those from a grid of 161 by 161 nodes, at the least
    tolerance.
    """
    rows = {
        row["law by"]: row for row in sorted(results["grids"]["rows"], key=lambda row: -row["rtol"])
    }
    grid = rows["grid, 161 by 161"]
    exact = rows["law file"]
    return (
        "A law file is more accurate than a grid.  In motions from random starts, computed by one "
        "integrator at rtol 1e-8, the largest error of V and omega, divided by "
        f"the larger initial speed, is {two(exact['error, random'])} with the law file and "
        f"{two(grid['error, random'])} with "
        f"splines on a grid of 161 by 161 nodes.\n"
    )


def mutants(results):
    """Number of defects planted in the kernels, and of those that the tests noticed."""
    outcomes = [row["outcome"] for row in results["mutants"].values()]
    killed = outcomes.count("killed")
    noticed = "all of them" if killed == len(outcomes) else f"{killed}"
    return (
        "Line coverage cannot be measured in compiled kernels.  Instead "
        f"[{len(outcomes)} defects](../pipeline/evidence/mutants.toml) were planted in the "
        "kernels, one at a time. "
        f" The test suite detected {noticed} ([results](../data/results/mutants.json)).\n"
    )


# --- prove ---


def proofs(results):
    """A row a proof, with the claim that comes closest to its bound; data/results/proofs.json has
    all of them.
    """
    for name, part in results["proofs"]["parts"].items():
        found = part["rows"]
        closest = max(
            found, key=lambda row: row["worst"] / row["bound"] if row["bound"] else row["worst"]
        )
        points = sum(row["points"] for row in found)
        yield closest | {"title": name.replace("_", " "), "claims": len(found), "points": points}


def independent_paper(results):
    """Numbers that the paper prints, and the same computed here."""
    for row in results["independent"]["paper"]:
        yield row | {
            "greek": re.sub(
                r"\w+", lambda m: (m[0] in SYMBOLS and greek(m[0])) or m[0], row["quantity"]
            )
        }


#: of the motions without sliding: those of the table over gamma
FEW = 6


def unsteady_gamma(results):
    """Largest errors of V of the first motions, alpha = 11 and kappa V = 4.4 at the start."""
    return (row | {"gamma": 1.5 * row["g"]} for row in results["transient"]["rows"][:FEW])


def unsteady(results):
    """e by level of the unsteadiness: least, largest and median of the motions; of the law, and
    with N.
    """
    found = {}
    for row in results["transient"]["rows"]:
        for start in ("steady", "rest"):
            for level, *e, _ in row[start]["e"]:
                for n, one in enumerate(e):
                    own = found.setdefault(level, {}).setdefault(f"{start}{n}", [])
                    own += [] if one is None else [100.0 * one]
    for level in sorted(found):
        texts = {
            name: f"{two(min(e))} to {two(max(e))} ({two(statistics.median(e))}) %" if e else ""
            for name, e in found[level].items()
        }
        yield dict.fromkeys(("steady0", "steady1", "rest0", "rest1"), "") | {"level": level} | texts


def unsteady_ways(results):
    """How far the motions go, in contact lengths."""
    rows = results["transient"]["rows"][FEW:]
    return (row | {"cost": row["steady"]["shift"] - row["rest"]["shift"]} for row in rows)


# --- bench ---

PAPER_GROUPS = ("IC1", "IC2", "IC3")
#: share of the motions that a peer may give up and still be compared, on those that it finished
MOST_FAILED = 0.05
#: what the ratios are about: motions that are integrated, as by the peers, at the default
#: tolerance; and looked up
INTEGRATED = "table"
LOOKED_UP = "flow"
DEFAULT_RTOL = 1e-8


def paper_rows(found: list[Row]) -> list[Row]:
    """Rows over IC1-IC3 together: mean time, largest error."""
    together = {}
    for row in found:
        if row["group"] in PAPER_GROUPS:
            together.setdefault((row["method"], row["rtol"]), []).append(row)
    return [
        {
            "method": method,
            "rtol": rtol,
            "us": float(np.mean([row["us"] for row in three])),
            "max": max(row.get("max") or np.inf for row in three),
        }
        | {name: sum(row[name] for row in three) for name in ("failed", "motions")}
        for (method, rtol), three in together.items()
        if len(three) == len(PAPER_GROUPS)
    ]


def finished(row: Row) -> bool:
    """Whether nearly all motions of a row were rolled to the end."""
    return bool(row.get("max")) and row["failed"] <= MOST_FAILED * row["motions"]


def ratios(found: list[Row], own: str) -> list[Row]:
    """For each row of another method: how many times faster the quickest row of ``own`` with no
    larger error is.
    """
    result = []
    mine = [row for row in found if row["method"] == own and not row["failed"]]
    for row in found:
        fit = [candidate for candidate in mine if finished(row) and candidate["max"] <= row["max"]]
        if row["method"] != own and fit:
            best = min(fit, key=lambda candidate: candidate["us"])
            result.append(
                row
                | {"ratio": row["us"] / best["us"], "own_us": best["us"], "own_error": best["max"]}
            )
    return result


def bench_peers(results):
    """Each peer at the setting with its smallest error, on IC1-IC3, on random starts, and with own
    parameters, where nothing is looked up.

    Slow ones were tried on fewer of the random motions than this package, whose error is that over
    all of them.
    """
    work = results["bench work-precision"]
    own = results["bench own-parameters"]
    groups = {
        "IC1-IC3": paper_rows(work["rows"]),
        "random starts": [r for r in work["rows"] if r["group"] == "random"],
        "own parameters": own["rows"],
    }
    for where, found in groups.items():
        default = [
            row for row in found if row["method"] != INTEGRATED or row["rtol"] == DEFAULT_RTOL
        ]
        looked_up = {(row["method"], row["rtol"]): row for row in ratios(found, LOOKED_UP)}
        best = {}
        for row in sorted(ratios(default, INTEGRATED), key=lambda row: -row["max"]):
            best[row["method"]] = row
        for row in best.values():
            if row["method"] != LOOKED_UP:
                quick = looked_up.get((row["method"], row["rtol"]))
                yield row | {
                    "label": work["methods"][row["method"]],
                    "where": where,
                    "given_up": cell(" ({failed} of {motions} motions failed)", row)
                    if row["failed"]
                    else "",
                    "quick": cell("{own_us:.3g} µs, {own_error:.1e}; {ratio!n} times faster", quick)
                    if quick
                    else "",
                }


def bench_own(results, part="own-parameters"):
    """Every tolerance of the motions with scenes of their own."""
    found = results[f"bench {part}"]
    return (row | {"label": found["methods"][row["method"]]} for row in found["rows"])


def bench_bound_law(results):
    """The law of one scene beside contact()."""
    for row in results["bench bound-law"]["rows"]:
        yield row | {
            "called": row["way"] + ", slopes" * row["slopes"],
            "times": row["contact"]["ns"] / row["ns"],
        }


def bench_series(results):
    """Contact, motions and tables by the number of modes."""
    for row in results["bench series"]["rows"]:
        yield row | {
            "state": cell("{ns!t} ns (least {least_ns!t})", row["contact"])
            if "contact" in row
            else ""
        }


# --- nothing is measured ---


def greek(name: str) -> str:
    """A sign for a symbol, as its LaTeX has it; empty where that is the name, or no sign alone."""
    sign = html.unescape(re.sub(r"\\(?:var(?=eps))?(\w+)", r"&\1;", SYMBOLS[name].latex)).replace(
        "^", ""
    )
    return sign if re.fullmatch(r"[^\W\d_](\*|/E')?", sign) and sign != name else ""


#: units as "m s-1"
_POWERS = str.maketrans({"-": "⁻", "1": "¹", "2": "²"})


def symbols(_):
    """Every symbol of a result: what it is, in which unit a scene and a cylinder give it, its range
    and equation.
    """
    for name, symbol in SYMBOLS.items():
        unit = si_unit(name).translate(_POWERS) if name in DIMENSIONS else ""
        said = {
            "meaning": describe_quantity(name),
            "range": symbol.range,
            "equation": symbol.equation,
        }
        yield said | {"name": name, "greek": greek(name), "unit": unit}


MAKERS = {
    made.__name__: made
    for made in (
        three,
        headline,
        grids,
        mutants,
        ensembles,
        ensembles_plan,
        proofs,
        independent_paper,
        unsteady_gamma,
        unsteady,
        unsteady_ways,
        bench_peers,
        bench_own,
        bench_bound_law,
        bench_series,
        symbols,
        costs.folder_costs,
        costs.capability_costs,
        house.rooms,
        house.commands,
        house.sections,
        *IDENTIFY,
    )
}
