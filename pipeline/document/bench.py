"""The results in words: ratios first.  Read from the files that ``pipeline/bench/`` wrote."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..results import table

PAPER_GROUPS = ("IC1", "IC2", "IC3")
#: share of the motions that a peer may give up and still be compared, on those that it finished
MOST_FAILED = 0.05
#: what the ratios are about, best first: the first that a result holds stands for this package
OWN = ("flow", "table")


def read(folder: Path, part: str) -> dict[str, Any] | None:
    """The results of a part, or None if it was not run."""
    path = folder / f"bench-{part}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None


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


def comparison(folder: Path) -> list[tuple[str, str, str, str]]:
    """(ratio, method, its us a motion and error, ours) on IC1-IC3, on the random starts, and with own parameters.

    A dear peer was tried on fewer of the random motions than this package, whose error is that over all of them.
    """
    groups = {
        "IC1-IC3": ("work-precision", paper_rows),
        "random starts": ("work-precision", lambda rows: [row for row in rows if row["group"] == "random"]),
        "own parameters": ("own-parameters", list),
    }
    lines = []
    for where, (part, choose) in groups.items():
        result = read(folder, part)
        if result is None:
            continue
        rows, methods = choose(result["measured"]["results"]), result["measured"]["methods"]
        own = next((name for name in OWN if name in {row["method"] for row in rows}), None)
        for row in ratios(rows, own) if own else []:
            name = f"{methods[row['method']]['label']}, rtol {row['rtol']:.0e}, {where}"
            name += f" ({row['failed']} of {row['motions']} given up)" if row["failed"] else ""
            theirs, ours = (
                f"{row['us']:.3g} µs at {row['max']:.1e}",
                f"{row['own_us']:.3g} µs at {row['own_error']:.1e}",
            )
            lines.append((f"{row['ratio']:.2g}", name, theirs, ours))
    return lines


def headline(folder: Path) -> str:
    """The comparison with every row of every peer, ratios first."""
    return table(("times faster", "than", "its time and max error", "viscoroll"), comparison(folder))


def peers(folder: Path) -> str:
    """The comparison at the peers' rtol 1e-6."""
    rows = [row for row in comparison(folder) if "rtol 1e-06" in row[1]]
    return table(("times faster", "than", "its time and max error", "viscoroll"), rows)


def own_parameters(folder: Path) -> str:
    """Every tolerance of the motions with scenes of their own."""
    measured = _measured(folder, "own-parameters")
    rows = [
        (
            measured["methods"][row["method"]]["label"], f"{row['rtol']:.0e}",
            f"{_three(row['us'])} µs (least {_three(row['least_us'])})", f"{row['max']:.1e}", f"{row['p99']:.1e}",
            str(row["failed"]),
        )
        for row in measured["results"]
    ]  # fmt: skip
    return table(("method", "rtol", "a motion", "max error", "99th percentile", "given up"), rows)


def fixed_scene(folder: Path) -> str:
    """Motions of one scene by its flow map."""
    m = _measured(folder, "fixed-scene")
    rows = [(name, f"{_nanoseconds(row)} a motion") for name, row in m["rows"].items()]
    rows += [
        (
            "largest error of motions from the map, final state; all 30 times",
            f"{m['error']['final']:.1e}; {m['error']['all_times']:.1e}",
        ),
        (
            f"motions of {m['compared']} that the map does not hold and that were integrated; largest error of all",
            f"{m['not_in_map']}; {m['error']['with_integrated']:.1e}",
        ),
        ("error that the map states", f"{m['stated_error']:.1e} (path {m['stated_path_error']:.1e})"),
        ("build, with its error measured; load", f"{_three(m['build_s'])} s; {_three(1e3 * m['load_s'])} ms"),
        ("size", f"{m['bytes'] / 1e6:.2f} MB"),
    ]
    return table(("one scene, flow map, one core", "measured"), rows)


def agreement(folder: Path) -> str:
    """Random scenes, flow against integration."""
    m, sizes = _measured(folder, "agreement"), read(folder, "agreement")["sizes"]
    rows = [
        ("random scenes; with a map", f"{len(m['rows'])}; {m['scenes_with_map']}"),
        ("starts in all", f"{m['starts']}"),
        (
            f"scenes within the error stated (and 30 times the integrator's rtol {sizes['rtol']:.0e})",
            f"{m['within_stated']}",
        ),
        ("worst difference, as a share of that", f"{m['worst_share']:.2g}"),
        ("motions that failed", f"{sum(row['failed'] for row in m['rows'])}"),
    ]
    return table(("flow map against integrator", "found"), rows)


def law(folder: Path) -> str:
    """Time and error of the contact law."""
    rows = [
        (_law_name(name), _nanoseconds(row), f"{max(row['error'].values()):.1e}")
        for name, row in _measured(folder, "law").items()
    ]
    return table(("Q and M of a state", "time", "max error against 50 digits"), rows)


def _law_name(name: str) -> str:
    return name.replace("explicit_", "explicit in (zeta, eta), ").replace("_", " ")


def scaling(folder: Path) -> str:
    """Time and memory by number of motions."""
    rows = [
        (
            row["method"],
            f"{row['threads']}",
            f"{row['motions']:.0e}",
            f"{_three(row['us'])} µs",
            f"{row['peak_mb']:.0f} MB",
        )
        for row in _measured(folder, "scaling")["rows"]
    ]
    return table(("method", "threads", "motions", "a motion", "peak memory"), rows)


def skips(folder: Path) -> str:
    """What leaving out saves."""
    rows = [(name, f"{row['ratio']:.3g}") for name, row in _measured(folder, "skips").items()]
    return table(("left out", "times faster"), rows)


def cold_start(folder: Path) -> str:
    """Whole processes."""
    rows = [
        (name.replace("_", " "), f"{_three(1e3 * row['over_bare_s'])} ms")
        for name, row in _measured(folder, "cold-start").items() if name != "bare_python"
    ]  # fmt: skip
    return table(("process, kernels cached", "over a bare Python"), rows)


def _measured(folder: Path, part: str) -> dict[str, Any]:
    """Results of a part; a KeyError that names it where it was not run."""
    result = read(folder, part)
    if result is None:
        raise KeyError(f"bench-{part}.json")
    return result["measured"]


def _three(value: float) -> str:
    return f"{float(f'{value:.3g}'):g}"


def _nanoseconds(row: dict[str, Any]) -> str:
    return f"{_three(row['ns'])} ns (least {_three(row['least_ns'])})"


#: tables of this module by the name of their block in the documents
BLOCKS = {
    "bench_peers": peers, "bench_all": headline, "bench_fixed_scene": fixed_scene, "bench_own": own_parameters,
    "bench_agreement": agreement,
    "bench_law": law, "bench_scaling": scaling, "bench_skips": skips, "bench_cold_start": cold_start,
}  # fmt: skip
