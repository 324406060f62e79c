"""The results in words: ratios first.  Read from the files that ``pipeline/evidence/bench/`` wrote."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..results import Results, table
from .cells import cell, listed, stated, two

PAPER_GROUPS = ("IC1", "IC2", "IC3")
#: share of the motions that a peer may give up and still be compared, on those that it finished
MOST_FAILED = 0.05
#: what the ratios are about: motions that are integrated, as by the peers, at the default tolerance; and looked up
INTEGRATED, LOOKED_UP, DEFAULT_RTOL = "table", "flow", 1e-8
_NANOSECONDS = "{ns!t} ns (least {least_ns!t})"


def paper_rows(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows over IC1-IC3 together: mean time, largest error (while moving)."""
    together: dict[tuple[str, float], list[dict[str, Any]]] = {}
    for row in rows:
        if row["group"] in PAPER_GROUPS:
            together.setdefault((row["method"], row["rtol"]), []).append(row)
    return [
        {
            "method": method, "rtol": rtol, "us": float(np.mean([row["us"] for row in three])),
            "max": max((row.get("max_moving") or np.inf for row in three), default=np.inf),
            "failed": sum(row["failed"] for row in three), "motions": sum(row["motions"] for row in three),
        }
        for (method, rtol), three in together.items()
        if len(three) == len(PAPER_GROUPS)
    ]  # fmt: skip


def random_rows(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of the random starts, with the largest error while moving.

    A motion that has all but ended has a large relative error in V with any method but one in log V.
    """
    return [row | {"max": row.get("max_moving") or np.inf} for row in rows if row["group"] == "random"]


def finished(row: dict[str, Any]) -> bool:
    """Whether nearly all motions of a row were rolled to the end."""
    return row["failed"] <= MOST_FAILED * row["motions"]


def ratios(rows: list[dict[str, Any]], own: str, key: str = "max") -> list[dict[str, Any]]:
    """For each row of another method: how many times faster the quickest row of ``own`` with no larger error is."""
    result = []
    mine = [row for row in rows if row["method"] == own and not row["failed"] and row.get(key) is not None]
    for row in rows:
        if row["method"] == own or not finished(row) or row.get(key) is None:
            continue
        fit = [candidate for candidate in mine if candidate[key] <= row[key]]
        if fit:
            best = min(fit, key=lambda candidate: candidate["us"])
            result.append(row | {"ratio": row["us"] / best["us"], "own_us": best["us"], "own_error": best[key]})
    return result


def comparison(results: Results) -> list[tuple[str, ...]]:
    """(ratio, method, its us a motion and error, ours, ratio and ours of the look-up) on IC1-IC3, on the random starts,
    and with own parameters, where nothing is looked up.

    Each peer at the setting with its smallest error.  Slow ones were tried on fewer of the random motions than this
    package, whose error is that over all of them.
    """
    groups = {
        "IC1-IC3": ("work-precision", paper_rows),
        "random starts": ("work-precision", random_rows),
        "own parameters": ("own-parameters", list),
    }
    lines = []
    for where, (part, choose) in groups.items():
        if (result := results.found(f"bench-{part}")) is None:
            continue
        measured = result["measured"]
        rows, methods = choose(measured["results"]), measured["methods"]
        peers = [row for row in rows if row["method"] not in (INTEGRATED, LOOKED_UP)]
        default = [row for row in rows if (row["method"], row["rtol"]) == (INTEGRATED, DEFAULT_RTOL)]
        compared = ratios(peers + default, INTEGRATED)
        looked_up = {(row["method"], row["rtol"]): row for row in ratios(rows, LOOKED_UP)}
        for method in _methods(compared):
            row = min((row for row in compared if row["method"] == method), key=lambda row: row["max"])
            name = f"{methods[row['method']]['label']}, rtol {row['rtol']:.0e}, {where}"
            name += f" ({row['failed']} of {row['motions']} given up)" if row["failed"] else ""
            quick = looked_up.get((row["method"], row["rtol"]))
            ours = "{own_us:.3g} µs at {own_error:.1e}"
            found = (two(quick["ratio"]), cell(ours, quick)) if quick else ("", "")
            lines.append((two(row["ratio"]), name, cell("{us:.3g} µs at {max:.1e}", row), cell(ours, row), *found))
    return lines


def _methods(rows: list[dict[str, Any]]) -> list[str]:
    return list(dict.fromkeys(row["method"] for row in rows))


def peers(results: Results) -> str:
    """The comparison at the setting where each peer errs least, ratios first."""
    columns = ("times faster", "than", "its time and max error", "viscoroll, integrated", "times faster", "looked up")
    return table(columns, comparison(results))


def own_parameters(results: Results) -> str:
    """Every tolerance of the motions with scenes of their own."""
    measured = results["bench-own-parameters"]["measured"]
    columns = {
        "method": "{label}", "rtol": "{rtol:.0e}", "a motion": "{us!t} µs (least {least_us!t})",
        "max error": "{max:.1e}", "99th percentile": "{p99:.1e}", "given up": "{failed}",
    }  # fmt: skip
    return listed(columns, (row | measured["methods"][row["method"]] for row in measured["results"]))


def fixed_scene(results: Results) -> str:
    """Motions of one scene by its flow map."""
    m = results["bench-fixed-scene"]["measured"]
    lines = {name: f"{cell(_NANOSECONDS, row)} a motion" for name, row in m["rows"].items()} | {
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
    return stated(("one scene, flow map, one core", "measured"), lines, m)


def agreement(results: Results) -> str:
    """Random scenes, flow against integration."""
    found = results["bench-agreement"]
    rows = found["measured"]["rows"]
    own = {"scenes": len(rows), "failed": sum(row["failed"] for row in rows), "rtol": found["sizes"]["rtol"]}
    lines = {
        "random scenes; with a map": "{scenes}; {scenes_with_map}",
        "starts in all": "{starts}",
        "scenes within the error stated (and 30 times the integrator's rtol {rtol:.0e})": "{within_stated}",
        "worst difference, as a share of that": "{worst_share:.2g}",
        "motions that failed": "{failed}",
    }
    return stated(("flow map against integrator", "found"), lines, found["measured"] | own)


def law(results: Results) -> str:
    """Time and error of the contact law."""
    columns = {"Q and M of a state": "{name}", "time": _NANOSECONDS, "max error against 50 digits": "{worst:.1e}"}
    rows = (
        row | {
            "name": name.replace("explicit_", "explicit in (zeta, eta), ").replace("_", " "),
            "worst": max(row["error"].values()),
        }
        for name, row in results["bench-law"]["measured"].items()
    )  # fmt: skip
    return listed(columns, rows)


def bound_law(results: Results) -> str:
    """The law of one scene beside contact()."""
    columns = {
        "material": "{material}", "called": "{called}", "a state": _NANOSECONDS, "by `contact`": "{of_contact}",
        "times faster": "{times:.2g}",
    }  # fmt: skip
    rows = (
        row | {
            "called": row["way"] + (", slopes" if row["slopes"] else ""),
            "of_contact": cell(_NANOSECONDS, row["contact"]), "times": row["contact"]["ns"] / row["ns"],
        }
        for row in results["bench-bound-law"]["measured"]["rows"]
    )  # fmt: skip
    return listed(columns, rows)


def scaling(results: Results) -> str:
    """Time and memory by number of motions."""
    columns = {
        "method": "{method}", "threads": "{threads}", "motions": "{motions:.0e}", "a motion": "{us!t} µs",
        "peak memory": "{peak_mb:.0f} MB",
    }  # fmt: skip
    return listed(columns, results["bench-scaling"]["measured"]["rows"])


def skips(results: Results) -> str:
    """What leaving out saves."""
    rows = ({"name": name} | row for name, row in results["bench-skips"]["measured"].items())
    return listed({"left out": "{name}", "times faster": "{ratio:.3g}"}, rows)


def last_release(results: Results) -> str:
    """``contact`` beside that of the last release."""
    found = results["bench-last-release"]
    rows = ({"name": name} | row for name, row in found["measured"].items())
    columns = {
        "Q and M of": "{name}", "a state": "{ns!t} ns", f"in {found['sizes']['release']}": "{ns_before!t} ns",
        "times": "{ratio:.2f}",
    }  # fmt: skip
    return listed(columns, rows)


def series(results: Results) -> str:
    """Contact, motions and tables by the number of modes."""
    rows = [
        {
            "material": row["material"],
            "contact": cell(_NANOSECONDS, row["contact"]) if "contact" in row else "",
            "motion": f"{1e-3 * row['motion']['ns']:.3g} (least {1e-3 * row['motion']['least_ns']:.3g})"
            if "motion" in row else "",
            "table": "" if row["table_ms"] is None else f"{row['table_ms']:.2g} ms",
        }
        for row in results["bench-series"]["measured"]
    ]  # fmt: skip
    columns = {"material": "{material}", "a state": "{contact}", "a motion, µs": "{motion}", "its table": "{table}"}
    return listed(columns, rows)


def driven(results: Results) -> str:
    """Driven motions beside LSODA."""
    rows = [
        row | {name: "" if row[name] is None else f"{row[name]:.1e}" for name in ("median_error", "max_error")}
        for row in results["bench-driven"]["measured"]["rows"]
    ]
    columns = {
        "drive": "{kind}", "method": "{method}, rtol {rtol:.0e}", "motions": "{motions}",
        "median, µs": "{median_us:.3g}", "95th percentile, µs": "{p95_us:.3g}", "mean, µs": "{mean_us:.3g}",
        "error, median": "{median_error}", "max": "{max_error}", "given up": "{failed}",
    }  # fmt: skip
    return listed(columns, rows)


def cold_start(results: Results) -> str:
    """Whole processes."""
    rows = (
        row | {"name": name.replace("_", " ")}
        for name, row in results["bench-cold-start"]["measured"].items() if name != "bare_python"
    )  # fmt: skip
    return listed({"process, kernels cached": "{name}", "over a bare Python": "{over_bare_s!u} ms"}, rows)


def first_calls(results: Results) -> str:
    """One process from an empty cache of kernels, one from a full one."""
    rows = (
        row | {"cache": cache}
        for cache, calls in results["bench-first-calls"]["measured"].items() for row in calls
    )  # fmt: skip
    columns = {
        "cache": "{cache}", "after the first": "{call}", "processor": "{cpu_s:.1f} s", "wall": "{wall_s:.1f} s",
        "peak memory": "{peak_mb:.0f} MB", "cached": "{files} files, {cache_mb:.1f} MB",
    }  # fmt: skip
    return listed(columns, rows)
