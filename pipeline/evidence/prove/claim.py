"""A proof: states or motions that are drawn, their errors against a truth, and the claims on
these.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
from tqdm import tqdm

#: (where it was, errors of it or of many, by name), one after the other
Found = Iterable[tuple[str, dict[Any, Any]]]


class Proof(NamedTuple):
    """One row a claim.

    part : of the file, which --only renews.
    size : how many are drawn, a name in [prove] of the sizes.
    domain : what is drawn.
    claims : name of an error -> (sentence, bound); one that begins with "share" is held by the
    mean.
    found : (random numbers, size) -> errors; names of which nothing is claimed are left out.
    name : tells proofs of one part and size apart.
    """

    part: str
    size: str
    domain: str
    claims: dict[Any, tuple[str, float]]
    found: Callable[[np.random.Generator, Any], Found]
    name: str = ""

    def key(self) -> str:
        """Return part, size and name: the name of this proof among all."""
        return f"{self.part} {self.size} {self.name}"

    def random(self, seed: int) -> np.random.Generator:
        """Return the random numbers of this proof.

        They follow from its own key, not from its place among the proofs, so that a new proof
        changes no other's draws.

        seed: of all proofs, [prove].seed of the sizes.
        """
        return np.random.default_rng([seed, *self.key().encode()])

    def rows(self, seed: int, size: Any) -> list[dict[str, Any]]:
        """Return a row for each claim: claim, domain, bound, points, worst, mean, and where the
        worst was.

        A NaN counts as infinite, an error below 0, within what was allowed for, as 0.

        seed: of all proofs.
        size: how many states or motions are drawn.
        """
        kept = {name: [0, 0.0, -1.0, ""] for name in self.claims}  # points, sum, worst, where
        progress = tqdm(self.found(self.random(seed), size), self.part, delay=1.0, leave=False)
        for where, errors in progress:
            for name in self.claims.keys() & errors.keys():
                each = np.atleast_1d(np.asarray(errors[name], float)).ravel()
                each = np.where(np.isnan(each), np.inf, np.maximum(each, 0.0))
                row = kept[name]
                worst = float(each.max(initial=0.0))
                row[0] += each.size
                row[1] += float(each.sum())
                row[2:] = (worst, where) if worst > row[2] else row[2:]
        rows = []
        for name, (points, total, worst, where) in kept.items():
            (claim, bound) = self.claims[name]
            mean = total / max(points, 1)
            found = {
                "points": points,
                "worst": mean if claim.startswith("share") else max(worst, 0.0),
            }
            rows.append(
                {
                    "claim": claim,
                    "domain": self.domain,
                    "bound": bound,
                    "mean": mean,
                    "where": where,
                }
                | found
            )
        return [row for row in rows if row["points"]]


def at(**values: float) -> str:
    """Where an error was found, to the last digit."""
    return ", ".join(f"{name} = {value!r}" for name, value in values.items())
