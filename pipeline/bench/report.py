"""The results in words: ratios first.  Read from the files that ``pipeline/benchmark.py`` wrote."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

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
    """The comparison as a Markdown table, ratios first."""
    head = ("times faster", "than", "its time and max error", "viscoroll")
    lines = [head, ("---",) * 4, *comparison(folder)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
