"""Rollers, materials, data and files that many calls share."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import experiments
import numpy as np
import pandas as pd
import xarray as xr
from drives import DMA as DMA_SERIES
from drives import ON_DMA as DMA_ROLLER
from run_files import FILES

import viscoroll as vr
from viscoroll.materials.material_toml import read_materials
from viscoroll.measurements.identify import read_measurements
from viscoroll.presets import read_law_source, read_roller
from viscoroll.runs import read_run

SCENE_FILE = "[scene]\nalpha = 11\nkappa = 2.91\nmu = 0.2\n"
ROLLER_FILE = "[cylinder]\nR = 0.1\nm = 35.5\nmu = 0.2\n"
RUBBER_FILE = (
    "[material]\nE = 2.3e5\nnu = 0.5\nprony = { E = [2.0, 6], tau = [1.0, 1e-4] }\nT_ref = 0.3\n"
)
CYLINDER_FILE = ROLLER_FILE + "E = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97\n"
OMEGA = np.logspace(-2, 4, 20)
DMA = OMEGA, 1.0 + OMEGA / (1.0 + OMEGA), 0.1 + 0.0 * OMEGA
LABELLED = xr.DataArray([0.1, 0.2], dims="run", coords={"run": ["a", "b"], "day": 3}, name="speed")
FRAME = pd.DataFrame(
    {"V": [0.1, 0.2], "delta": [0.0, 0.01]}, index=pd.Index(["x", "y"], name="roller")
)
UNSURE = DMA_ROLLER.replace(
    material=vr.Prony(np.outer(np.linspace(0.9, 1.1, 7), DMA_SERIES.E), DMA_SERIES.tau)
)
MEASURED = vr.Material(
    2e6,
    0.5,
    vr.Prony([2.0, 6.0], [1e-3, 1e-5]),
    measured=vr.Measured(0.06, 1884.0, 0.01, "dma.csv"),
)
BELT = vr.Cylinder(R=0.1, m=30.0, material=vr.Material.rigid(), base=MEASURED, mu=0.5)
SERIES = vr.Prony([2.0, 6.0], [1.0, 1e-4])
MANY = vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1])
SOFT = vr.Material(2.3e5, 0.49, SERIES, density=1100.0)
STEEL = vr.Material.elastic(2e11, 0.3)
RUBBER_COVER = vr.Material(2.3e5, 0.49, SERIES, thickness=0.02)
#: one for all tests of any cover: its law takes a second, once in a process
COVER = vr.Cover(vr.Prony([10.0], [1.0 / 11.0]), nu=0.3, thickness=0.5, on="base")
COVERED = vr.Scene(material=COVER, kappa=10.0, mu=0.5, gamma=1.0, coupled=False)
THIN = vr.Scene(material=vr.Cover(11.0, nu=0.3, thickness=0.02), kappa=10.0, mu=0.5, coupled=False)
ONE = vr.Scene(11.0, 10.0, 0.5, 120.0)
PAPER = vr.presets.PAPER_SECTION_5_ROUNDED
ROLLER = vr.presets.RUBBER_CYLINDER
BOTH = PAPER, ROLLER
T = np.linspace(0.0, 8.0, 33)
#: the paper's cylinder where materials are given, and by its parameters
BARE = {"R": 0.1, "m": 35.5, "mu": 0.2}
SI = BARE | {"E": 2.3e5, "nu": 0.49, "T_epsilon": 10.7, "T_sigma": 0.97}
HEAVY = replace(STEEL, density=7850.0)
RUBBER = vr.Material(2.3e5, 0.5, SERIES, T_ref=0.3)
TREAD = vr.Material(
    2.3e5, 0.49, vr.Prony([2.0, 6.0, 11.0], [1.0, 1e-3, 1e-7]), 0.3, "rubber", 1100.0
)
HARD = vr.Material(1e6, 0.5, vr.Prony([4.0, 1.0], [1.0, 1e-2]), T_ref=2.0)
OTHER_GRID = xr.Dataset(
    {
        "Q": (("V", "delta"), np.tile([0.0, 0.0, 1.0], (3, 1)), {"units": "kN/m"}),
        "M": ("V", np.ones(3), {"units": "N mm/m"}),
    },
    {
        "V": ("V", np.arange(1.0, 4.0), {"units": "mm/s"}),
        "delta": ("delta", [-0.01, 0.0, 0.01], {"units": "1"}),
    },
    {"R": 0.1, "load": 1e3},
)


#: a resistance over speed, in files
DRUM_V = np.geomspace(0.1, 10.0, 5)
DRUM_M = np.array([0.1, 0.3, 0.7, 0.5, 0.2])


def rows(*columns, sep=",", decimal="."):
    """Lines of a file of these columns."""
    return "\n".join(
        sep.join(f"{x:.10g}".replace(".", decimal) for x in row) for row in zip(*columns)
    )


def pair(material, base, **more):
    """A cylinder of a material on a base."""
    return vr.Cylinder(**BARE, material=material, base=base, **more)


@cache
def grid():
    return vr.tables.build(
        vr.presets.PAPER_SECTION_5, [0.1, 0.2], delta=[0.0, 0.1], alpha=[1.0, 2.0]
    )


@cache
def law_file():
    return vr.tables.law(11.0)


def file(content, name="file.toml"):
    """A file in the working directory."""
    Path(name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return Path(name)


def of_roller(content):
    return read_roller(file(content))


def of_materials(content):
    return read_materials(file(content))


def of_law_source(content):
    return read_law_source(file(content))


def run(name, old, new):
    """A run file, with this in place of that."""
    assert old in FILES[name]
    return read_run(file(FILES[name].replace(old, new, 1)))


def measured(old, new):
    """The fit of a file of measurements, with this in place of that."""
    return vr.identify(**read_measurements(experiments.measurements(Path(), old, new)), starts=1)


def data(text, kind="resistance", more=""):
    """The first data of a file of measurements, whose columns have the names of its own kind, or
    those of ``more`` lines.
    """
    file(text, "drum.csv")
    plain = experiments.FILE.replace('columns = { V = "speed", M = "moment" }\n', more)
    return read_measurements(file(plain.replace("resistance", kind)))["data"][0]


def netcdf(data, without=""):
    """A file of a dataset, without an attribute, as another program writes it."""
    data = data.copy()
    data.attrs.pop(without, None)
    data.to_netcdf("given.nc", engine="h5netcdf")
    return Path("given.nc")
