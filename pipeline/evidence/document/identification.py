"""What measurements tell, in words: the marked blocks of docs/identify.md."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..results import Results

_NEVER = "no influence"
_OPEN = "unbounded"


def _known(row: dict[str, Any], name: str) -> str:
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


def _together(row: dict[str, Any]) -> str:
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


def identify_learn(results: Results, part: str = "learn") -> Iterator[dict[str, str]]:
    """One row an experiment."""
    for row in results[f"identification {part}"]["rows"]:
        known = {name: _known(row, name) for name in ("mu", "E", "E_1", "T_ref", "brake", "drag")}
        yield known | {"experiment": row["experiment"], "together": _together(row)}


def identify_bearing(results: Results) -> Iterator[dict[str, str]]:
    """The same of a roller in a bearing."""
    return identify_learn(results, "bearing")


def identify_said(results: Results) -> str:
    """Six reports."""
    rows = results["identification said"]["rows"]
    return "\n".join(
        f"{row['problem'].capitalize()}:\n\n```text\n{row['report']}\n```\n" for row in rows
    )


def identify_times(results: Results) -> Iterator[dict[str, Any]]:
    """How long it takes, and how near ends of intervals are."""
    off = max(row["off"] for row in results["identification width"]["rows"])
    return (row | {"off": off} for row in results["identification time"]["rows"])


def identify_coverage(results: Results) -> Iterator[dict[str, Any]]:
    """How often intervals hold the truth."""
    for row in results["identification coverage"]["rows"]:
        yield row | {
            "shares": ", ".join(
                f"{name} {100.0 * share:.3g} %" for name, share in row["held"].items()
            )
        }


MAKERS = identify_learn, identify_bearing, identify_said, identify_times, identify_coverage
