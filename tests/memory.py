"""What a process keeps of earlier calls, in one place for the tests that need it gone."""

from __future__ import annotations

from viscoroll import alpha_slice
from viscoroll.motion import flow


def forget() -> None:
    """Neither a slice nor a flow map is at hand; maps on disk and compiled kernels stay."""
    flow._recent.clear()
    alpha_slice.octave_of.cache_clear()
