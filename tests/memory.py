"""What a process keeps of earlier calls, in one place for the tests that need it gone."""

from __future__ import annotations

from viscoroll.materials import tables as material_tables
from viscoroll.motion import flow


def forget() -> None:
    """Neither a table nor a flow map is at hand; those on disk and compiled kernels stay."""
    flow._recent.clear()
    material_tables._kept.materials.clear()
    material_tables._kept.inverses.clear()
    material_tables._series_table.cache_clear()
    material_tables._pair_tables.cache_clear()
