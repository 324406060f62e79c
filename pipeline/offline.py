"""Offline: the law of every alpha -> data/tables/law.nc, those of the materials of [tables] ->
data/tables/NAME.nc, those of the coupled solution of rollers too, and lam, epsilon, beta, Q and M
on a grid of V, delta and alpha, by root solves -> data/tables/grid.nc.

python -m pipeline.offline [--config FILE] [--tables FOLDER] [-o FOLDER]

Exit code 1 where an error that is measured while a file is made exceeds the one that the
configuration allows.
"""

import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import msgspec
import xarray as xr

import viscoroll as vr
from viscoroll.core.errors import FileError
from viscoroll.materials.checked_netcdf import stated_errors
from viscoroll.materials.material_toml import SECTIONS, parse_materials
from viscoroll.presets import preset, read_roller

from . import stage


class Law(msgspec.Struct, forbid_unknown_fields=True):
    """[tables.laws.NAME]: a material, and that of the base where it is another, as sections of
    these names; or, in place of the first, the columns of a DMA, a file seen from that of the
    configuration, which are fitted; ``nu`` and ``name`` are for the fit.
    """

    material: dict | None = None
    base: dict | None = None
    dma: str = ""
    nu: float = 0.49
    name: str = ""


class Grid(msgspec.Struct, forbid_unknown_fields=True):
    """[tables.grid]: the preset; lowest and highest V and how many; how many delta; every alpha;
    and the largest difference of a node from the rows that is allowed.
    """

    preset: str
    V: tuple[float, float, int]
    delta: int
    alpha: list[float]
    allowed: float


class Coupled(msgspec.Struct, forbid_unknown_fields=True):
    """[tables.coupled.NAME]: the file of a roller, and the largest error of fields of its table."""

    roller: str
    allowed: dict[str, float]


class Tables(msgspec.Struct, forbid_unknown_fields=True):
    """[tables]: the largest errors allowed; lowest and highest alpha of law.nc; the materials by
    name; the grid; tables of the coupled solution by name.
    """

    allowed: float
    allowed_N: float
    alpha: tuple[float, float]
    laws: dict[str, Law]
    grid: Grid
    coupled: dict[str, Coupled] = {}


def build_all(config: Path, folder: Path) -> stage.Outcome:
    """Build, save and report every law of the configuration."""
    outcome = stage.Outcome([])
    settings = stage.read_section(config, "tables", Tables)
    build(outcome, folder / "law.nc", settings, lambda: vr.tables.law(alpha=settings.alpha))
    for name, law in settings.laws.items():
        build(
            outcome, folder / f"{name}.nc", settings, partial(vr.tables.law, *bodies(config, law))
        )
    for name, coupled in settings.coupled.items():
        build_coupled(outcome, folder / f"{name}.nc", coupled)
    build_grid(outcome, folder / "grid.nc", settings.grid)
    return outcome


def build_coupled(outcome: stage.Outcome, path: Path, settings: Coupled) -> None:
    """Build the table of the coupled solution of a roller, save and report it."""
    roller = read_roller(stage.ROOT / settings.roller)
    errors = stated_errors(made(outcome, path, partial(vr.tables.build, roller, method="coupled")))
    for name, allowed in settings.allowed.items():
        outcome.headline[f"{path.stem}: error of {name} (allowed {allowed:g})"] = errors[name]
        outcome.failed |= not errors[name] <= allowed


def build_grid(outcome: stage.Outcome, path: Path, settings: Grid) -> None:
    """Build the grid by root solves, save and report it."""
    scene = preset(settings.preset)
    V = vr.tables.spread(*settings.V, "log")
    delta = vr.tables.creep_nodes(scene, V, settings.delta, alpha=settings.alpha)
    make = partial(vr.tables.build, scene, V, delta=delta, alpha=settings.alpha, method="direct")
    grid = made(outcome, path, make)
    worst = max(float(field.attrs["difference_from_rows"]) for field in grid.values())
    outcome.headline[
        f"grid: nodes, largest difference from rows (allowed {settings.allowed:g})"
    ] = worst
    for way in ("spline", "linear"):
        outcome.headline[f"grid: largest error of Q between nodes, {way}"] = grid.Q.attrs[
            f"{way}_error"
        ]
    outcome.failed |= not worst <= settings.allowed


def made(outcome: stage.Outcome, path: Path, make: Callable[[], xr.Dataset]) -> xr.Dataset:
    """Build and save a table; seconds and size go into the report."""
    began = time.perf_counter()
    table = make()
    stage.make_folder(path.parent)
    vr.tables.save(table, path)
    outcome.files.append(path)
    outcome.headline[f"{path.stem}: build, measure and save, s"] = time.perf_counter() - began
    outcome.headline[f"{path.stem}: size, kB"] = path.stat().st_size / 1e3
    return table


def build(
    outcome: stage.Outcome, path: Path, settings: Tables, make: Callable[[], xr.Dataset]
) -> None:
    """Build, save and report a law."""
    errors = stated_errors(made(outcome, path, make))
    off_N = errors.pop("N")
    worst = max(errors.values())
    outcome.headline[f"{path.stem}: largest relative error (allowed {settings.allowed:g})"] = worst
    outcome.headline[
        f"{path.stem}: error of N divided by its largest value (allowed {settings.allowed_N:g})"
    ] = off_N
    outcome.failed |= worst > settings.allowed or off_N > settings.allowed_N


def bodies(config: Path, law: Law) -> tuple[vr.Material | None, vr.Material | None]:
    """The material and that of the base."""
    found = parse_materials(
        config, {name: each for name in SECTIONS if (each := getattr(law, name)) is not None}
    )
    if law.dma:
        path = config.parent / law.dma
        try:
            fit = vr.fit_prony(*vr.read_dma(path), source=path.name)
        except vr.ViscorollError as error:
            raise FileError(config, str(error)) from error
        found["material"] = fit.material(law.nu, name=law.name or path.stem)
    return found.get("material"), found.get("base")


if __name__ == "__main__":
    sys.exit(stage.run("offline", None, build_all, __doc__, tables=stage.ROOT / "data/tables"))
