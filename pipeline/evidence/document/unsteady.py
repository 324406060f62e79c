"""The marked blocks of docs/may_i.md on rolling that is not steady, from the results of prove.unsteady."""

from __future__ import annotations

import statistics
from typing import Any

from ..prove.unsteady import FEW, LEVELS
from ..results import Results
from .cells import listed, three, two

_STARTS = {"steady": "steady contact", "rest": "long rest"}


def over_gamma(results: Results) -> str:
    """Largest errors of V of the first motions, alpha = 11 and kappa V = 4.4 at the start."""
    columns = {
        "gamma": "{gamma!t}", "unsteadiness at the start": "{unsteadiness!n}", "way by the law, l0": "{way!n}",
        "from steady contact": "{a} %", "from a contact at rest": "{b} %",
    }  # fmt: skip
    return listed(columns, (row | _percent(row) for row in results["transient"]["rows"][:FEW]))


def _percent(row: dict[str, Any]) -> dict[str, Any]:
    errors = {name: two(100.0 * row[start]["error"]) for name, start in zip("ab", _STARTS, strict=True)}
    return errors | {"gamma": 1.5 * row["g"]}


def errors(results: Results) -> str:
    """e by level of the unsteadiness: least, largest and median of the motions."""
    columns = {"unsteadiness": "{level:g}"} | {
        f"{words}{by}": f"{{{start}{n}}}" for start, words in _STARTS.items() for n, by in enumerate(("", ", with N"))
    }
    rows = []
    for level in LEVELS:
        row: dict[str, Any] = {"level": level}
        for start in _STARTS:
            found = [one for each in results["transient"]["rows"] for one in each[start]["e"] if one[0] == level]
            for n in range(2):
                e = [100.0 * one[n + 1] for one in found if one[n + 1] is not None]
                row[f"{start}{n}"] = f"{two(min(e))} to {two(max(e))} ({two(statistics.median(e))}) %" if e else ""
        rows.append(row)
    return listed(columns, rows)


def ways(results: Results) -> str:
    """How far the motions go, in contact lengths."""
    columns = {
        "relaxation times": "{modes}", "kappa V at the start": "{u!t}", "gamma/(1 + j)": "{g!t}",
        "unsteadiness at the start": "{unsteadiness!n}", "way by the law": "{way!t}", "from steady contact": "{a}",
        "from long rest": "{b}", "the rest cost": "{c}", "as `start` says": "{start!t}",
    }  # fmt: skip

    def shown(row: dict[str, Any]) -> dict[str, Any]:
        a, b = row["steady"]["shift"], row["rest"]["shift"]
        return row | {"a": f"+{three(a)}", "b": three(b), "c": three(a - b)}

    return listed(columns, map(shown, results["transient"]["rows"][FEW:]))
