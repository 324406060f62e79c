"""Error against time per motion, for every method and tolerance of the configuration."""

from __future__ import annotations

from typing import Any

import numpy as np
from tqdm import tqdm

from ..timing import seconds_of, steady_seconds
from .methods import METHODS
from .problem import (
    Method,
    Outcome,
    Problem,
    copies,
    errors,
    own_problem,
    paper_problems,
    random_problem,
    reference,
    reference_difference,
)


def work_precision(sizes: dict[str, Any]) -> dict[str, Any]:
    """Groups IC1, IC2, IC3 (one motion each) and ``random`` (the same starts for all methods)."""
    problems = paper_problems(sizes["times"], sizes["end"])
    problems["random"] = random_problem(sizes["motions"], sizes["times"], sizes["end"], sizes["seed"])
    return compare(problems, sizes)


def own_parameters(sizes: dict[str, Any]) -> dict[str, Any]:
    """Every motion its own scene."""
    problem = own_problem(sizes["motions"], sizes["times"], sizes["end"], sizes["seed"])
    return compare({"own": problem}, sizes)


def compare(problems: dict[str, Problem], sizes: dict[str, Any]) -> dict[str, Any]:
    """Every method on every problem: rows in ``results``, what could not run in ``skipped``."""
    skipped, calls = {}, []
    best = {name: reference(problem) for name, problem in problems.items()}
    for method in METHODS:
        if method.name not in sizes["methods"]:
            continue
        if reason := method.missing():
            skipped[method.name] = reason
            print(f"benchmark: {method.name} skipped: {reason}")
            continue
        for group, problem in problems.items():
            calls += _calls(method, group, problem, sizes["methods"][method.name])
    _run(calls, sizes["repeats"])
    return {
        "reference": {
            name: reference_difference(problem, best[name], min(sizes["reference_motions"], problem.V0.size))
            for name, problem in problems.items()
        },
        "methods": {m.name: {"label": m.label, "note": m.note} for m in METHODS if m.name in sizes["methods"]},
        "results": [_row(call, best[call["group"]]) for call in calls],
        "skipped": skipped,
    }


def _calls(method: Method, group: str, problem: Problem, settings: dict[str, Any]) -> list[dict[str, Any]]:
    """What is to be timed: one entry for each tolerance of the method."""
    if problem.V0.size == 1:
        problem = copies(problem, settings.get("copies", 1))
    elif settings["motions"] == 0:
        return []
    else:
        problem = problem.take(slice(min(settings["motions"], method.most_motions)))
    entries = []
    for rtol in settings["rtol"]:
        setup, call = seconds_of(lambda rtol=rtol: method.prepare(problem, rtol))
        entries.append(
            {"method": method.name, "group": group, "rtol": rtol, "motions": problem.V0.size, "setup_s": setup}
            | {"call": call, "seconds": [], "repeats": settings.get("repeats")}
        )
    return entries


def _run(calls: list[dict[str, Any]], repeats: int) -> None:
    """Time all entries in turn, round after round; the outcome of the first round is kept."""
    with tqdm(total=sum(entry["repeats"] or repeats for entry in calls), desc="runs", leave=False, disable=None) as bar:
        for turn in range(repeats):
            for entry in calls:
                if turn >= (entry["repeats"] or repeats):
                    continue
                bar.set_postfix_str(f"{entry['method']} {entry['rtol']:.0e} {entry['group']}")
                seconds, outcome = steady_seconds(entry["call"])
                entry.setdefault("outcome", outcome)
                entry["seconds"].append(outcome.seconds if outcome.seconds is not None else seconds)
                bar.update()


def _row(entry: dict[str, Any], best: Outcome) -> dict[str, Any]:
    """What is kept of an entry."""
    outcome, motions = entry["outcome"], entry["motions"]
    if len(best.V) < motions:
        best = Outcome(np.repeat(best.V, motions, axis=0), np.repeat(best.omega, motions, axis=0))
    row = {name: entry[name] for name in ("method", "group", "rtol", "motions", "setup_s")}
    row["us"] = 1e6 * float(np.median(entry["seconds"])) / motions
    row["least_us"] = 1e6 * min(entry["seconds"]) / motions
    if outcome.evaluations is not None:
        row["evaluations"] = outcome.evaluations / motions
    return row | errors(outcome, best)
