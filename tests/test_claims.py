"""The table of claims, each held against truth of another making: that of ``make prove``, at the
sizes of a test.

Claim, domain, bound and truth stand in pipeline/evidence/prove/, the sizes in [prove.quick] of
sizes.toml beside it.
"""

import pytest
from places import kept

from pipeline.evidence.prove.__main__ import PROOFS, beyond
from pipeline.evidence.results import SIZES, read_sizes

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # scenes of all kinds, beyond the model too


@pytest.mark.parametrize("proof", PROOFS)
def test_claims(proof):
    """And the worst that was found at full size, which is committed, is of the same claims and
    bounds.
    """
    rows = PROOFS[proof](read_sizes(SIZES, "prove", quick=True))
    assert [text for row in rows if (text := beyond(row))] == []
    committed = kept("proofs.json")["parts"][proof]["rows"]
    held = {(row["claim"], row["bound"]) for row in committed}
    assert held >= {(row["claim"], row["bound"]) for row in rows if row["points"]}
    assert [text for row in committed if (text := beyond(row))] == []
