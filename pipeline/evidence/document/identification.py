"""What measurements tell, in words: the marked blocks of docs/identify.md."""

from __future__ import annotations

from typing import Any

from ..results import Results, table
from .cells import listed

_NEVER, _OPEN = "never", "--"
_HEADS = {"E_1": "E_1 = alpha − 1"}


def _rows(results: Results, part: str) -> list[dict[str, Any]]:
    """Of a part, none of one that was not measured yet."""
    return results["identification"]["parts"].get(part, {"rows": []})["rows"]


def _known(row: dict[str, Any], name: str) -> str:
    """Standard deviation and interval over the truth."""
    if name not in row["unknowns"]:
        return "known"
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
        return "each"
    texts = []
    for one in row["products"]:
        powers = sorted(one["powers"].items(), key=lambda item: -abs(item[1]))
        named = " ".join(name if power == 1.0 else f"{name}^{power:.2g}" for name, power in powers)
        named = f"near these values {named}" if one["near"] else named
        texts.append(f"{named}, {50.0 * (one['high'] - one['low']):.2g} %")
    others = [name for name in row["unknowns"] if name not in (*row["undetermined"], *row["does_not_act"])]
    return "; ".join([*texts, *others]) or "nothing"


def _told(results: Results, part: str, names: tuple[str, ...]) -> str:
    head = ("measured", *(_HEADS.get(name, name) for name in names), "what the data determine")
    return table(
        head,
        ((row["experiment"], *(_known(row, name) for name in names), _together(row)) for row in _rows(results, part)),
    )


def learn(results: Results) -> str:
    """One row an experiment."""
    return _told(results, "learn", ("mu", "E", "E_1", "T_ref"))


def bearing(results: Results) -> str:
    """The same of a roller in a bearing."""
    return _told(results, "bearing", ("E", "E_1", "T_ref", "brake", "drag"))


def said(results: Results) -> str:
    """Six reports."""
    return "\n".join(
        f"{row['problem'].capitalize()}:\n\n```text\n{row['report']}\n```\n" for row in _rows(results, "said")
    )


def times(results: Results) -> str:
    """How long it takes, and how near ends of intervals are."""
    columns = {
        "processor": "{case}", "a fit": "{fit_s!n} s", "its profiles": "{profiles_s!n} s",
        "a fit by 8 starts": "{searches_s!n} s",
    }  # fmt: skip
    off = max(row["off"] for row in _rows(results, "width"))
    text = f"\nEnds of intervals lie within {100.0 * off:.2g} % of their width of a scan of the profile.\n"
    return listed(columns, _rows(results, "time")) + text


def coverage(results: Results) -> str:
    """How often intervals hold the truth."""
    return listed(
        {"intervals of 95 % that hold the truth": "{experiment}, {sets} data sets", "share": "{shares}"},
        (
            row | {"shares": ", ".join(f"{name} {100.0 * share:.3g} %" for name, share in row["held"].items())}
            for row in _rows(results, "coverage") + _rows(results, "product")
        ),
    )


def reach(results: Results) -> str:
    """How often one search arrives."""
    return listed(
        {"one search, up to a factor of ten off": "{experiment}", "arrives": "{share} of {starts}"},
        (row | {"share": f"{100.0 * row['reached']:.3g} %"} for row in _rows(results, "reach")),
    )
