"""Offline: the law of every alpha -> data/tables/law.nc, those of the materials of [tables] -> data/tables/NAME.nc.

python -m pipeline.offline [--config FILE] [--tables FOLDER] [-o FOLDER]

Exit code 1 where an error that is measured while a file is made exceeds the one that the configuration allows.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import msgspec

import viscoroll as vr
from viscoroll.core.errors import FileError
from viscoroll.materials.file import SUFFIX, materials_of, read_materials
from viscoroll.materials.law_store import errors_of

from . import stage


class Tables(msgspec.Struct, forbid_unknown_fields=True):
    """[tables]: the largest errors allowed; lowest and highest alpha of law.nc; the materials by name."""

    allowed: float
    allowed_N: float
    alpha: tuple[float, float]
    laws: dict[str, dict]


class Law(msgspec.Struct, forbid_unknown_fields=True):
    """[tables.laws.NAME]: a material, and that of the base where it is another.

    Each is a file seen from that of the configuration: TOML, netCDF of a material, or the columns of a DMA, which are
    fitted; or the keys of a section [material].  ``nu`` and ``name`` are for a fit.
    """

    material: str | dict
    base: str | dict | None = None
    nu: float = 0.49
    name: str = ""


def build_all(config: Path, folder: Path) -> stage.Outcome:
    """Build, save and report every law of the configuration."""
    outcome, settings = stage.Outcome([]), stage.read_section(config, "tables", Tables)
    build(outcome, folder / "law.nc", settings, lambda: vr.tables.law(alpha=settings.alpha))
    for name, section in settings.laws.items():
        given = read_law(config, name, section)
        base = None if given.base is None else body(config, given.base, given)
        material = body(config, given.material, given)
        build(outcome, folder / f"{name}.nc", settings, partial(vr.tables.law, material, base))
    return outcome


def build(outcome: stage.Outcome, path: Path, settings: Tables, make: Callable[[], Any]) -> None:
    """Build, save and report one."""
    began = time.perf_counter()
    law = make()
    stage.make_folder(path.parent)
    vr.tables.save(law, path)
    errors = errors_of(law)
    off_N, worst = errors.pop("N"), max(errors.values())
    outcome.files.append(path)
    outcome.headline[f"{path.stem}: build, measure and save, s"] = time.perf_counter() - began
    outcome.headline[f"{path.stem}: size, kB"] = path.stat().st_size / 1e3
    outcome.headline[f"{path.stem}: largest relative error (allowed {settings.allowed:g})"] = worst
    outcome.headline[f"{path.stem}: of N, over its largest (allowed {settings.allowed_N:g})"] = off_N
    outcome.failed |= worst > settings.allowed or off_N > settings.allowed_N


def read_law(config: Path, name: str, section: dict[str, Any]) -> Law:
    """One of [tables.laws]; raises FileError."""
    try:
        return msgspec.convert(section, Law)
    except msgspec.ValidationError as error:
        raise FileError(config, f"[tables.laws.{name}] {error}") from error


def body(config: Path, given: str | dict[str, Any], law: Law) -> vr.Material:
    """A material of a file, of the keys of a section, or of a fit."""
    if isinstance(given, dict):
        return materials_of(config, {"material": given})["material"]
    path = config.parent / given
    if path.suffix in (".toml", SUFFIX):
        return read_materials(path)["material"]
    try:
        return vr.fit_prony(*vr.read_dma(path), source=path.name).material(law.nu, name=law.name or path.stem)
    except vr.ViscorollError as error:
        raise FileError(config, str(error)) from error


if __name__ == "__main__":
    sys.exit(stage.run("offline", None, build_all, __doc__, tables=stage.ROOT / "data/tables"))
