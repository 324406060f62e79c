"""Bad materials, series, covers, master curves, tables, identifications: a line says what is
allowed.
"""

import dataclasses
from functools import cache, partial
from math import nan

import numpy as np
import pytest
import xarray as xr
from calls import (
    COVERED,
    DMA,
    MANY,
    OMEGA,
    OTHER_GRID,
    PAPER,
    ROLLER,
    RUBBER_COVER,
    SERIES,
    SOFT,
    STEEL,
    TREAD,
    T,
    file,
    grid,
    law_file,
    netcdf,
    run,
)
from experiments import HUMP, TIMES, ranges, resistance, roller
from refusals import each, refused

import viscoroll as vr
from viscoroll import fmu
from viscoroll.core import errors
from viscoroll.runs import read_run
from viscoroll.runs.run_blocks import roll_inputs
from viscoroll.runs.sensitivity import sobol_indices
from viscoroll.runs.uncertain_inputs import read_column


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """Files of a test are its own."""
    monkeypatch.chdir(tmp_path)


@cache
def fitted():
    """A fit of E."""
    return vr.identify(roller(), ranges("E"), resistance(), starts=1)


@cache
def wide():
    """A grid of several alphas."""
    return vr.tables.build(PAPER, [0.1, 2.0], delta=[0.0, 0.01], alpha=[1.0, 16.0])


@cache
def narrow():
    """A law of some alphas."""
    return vr.tables.law(alpha=(1, 2))


REFUSED = [
    *each(
        None,
        {
            "other = <2 series | of one material": lambda: vr.Cover(
                11.0, nu=0.5, thickness=1.0, other=MANY
            ),
            "shapes factor (3,), materials (2,)": lambda: MANY.slower([1.0, 2.0, 3.0]),
            "factor": lambda: MANY.slower(-1.0),
            "alpha = 0.5": lambda: vr.Cover(0.5, nu=0.5, thickness=1.0),
            "E = 0.0": lambda: vr.Material(E=0.0, nu=0.4),
            "prony = [1.0]": lambda: vr.Material(E=1e6, nu=0.4, prony=[1.0]),
            "name = 3": lambda: vr.Material(E=1e6, nu=0.4, name=3),
            "T_ref = [1.0, 2.0]": lambda: vr.Material(E=1e6, nu=0.4, T_ref=[1.0, 2.0]),
            "source = 3": lambda: vr.Measured(1.0, 2.0, 0.1, 3),
            "vertical_shift = array": lambda: vr.Material(1e6, 0.4, vertical_shift=np.ones(2)),
            "starts = 0": lambda: vr.identify(roller(), ranges("E"), resistance(), starts=0),
            "mode = array": lambda: vr.fit_relaxation(T + 1.0, 2.0 - 0.1 * T, mode=np.ones(2)),
            "material = rigid": lambda: vr.Material.rigid().plot(),
            "alpha = -0.2": lambda: vr.Material.ansys(1e6, 0.4, [-0.2], [1.0]),
            "tau | one for each G": lambda: vr.Material.comsol(1e6, 0.4, [], [1.0]),
            "K with beta = 0": lambda: vr.Material.lsdyna(
                [1e6, 1e6], [1.0, 0.0], K=[1e6, 1e6], nu=0.4
            ),
            "at most 64": lambda: vr.Prony(np.ones((2, 65)), np.arange(1.0, 66.0)),
            "nu = 0.6": lambda: vr.fit_prony(*DMA).material(nu=0.6),
            "unknown | at least one name": lambda: vr.identify(roller(), {}, [resistance()]),
        },
    ),
    *each(
        partial(vr.Material.lsdyna, [1e6]),
        {
            "G0 and G_inf": {"beta": [1.0], "nu": 0.4, "G_inf": 1e6, "G0": 3e6},
            "G_inf and beta = 0": {"beta": [0.0], "nu": 0.4, "G_inf": 1e6},
            "give nu or bulk": {"beta": [1.0], "G_inf": 1e6},
            "both": {"beta": [1.0], "nu": 0.4, "G_inf": 1e6, "bulk": 1e9},
        },
    ),
    *each(
        lambda call, *given, **more: call(vr.load_law(netcdf(OTHER_GRID)), *given, **more),
        {
            "V = 5: must be within the table's range [-0.003, 0.003]": (
                lambda law: vr.law(law)(5.0, 50.0)
            ),
            "V = nan": (lambda law: vr.law(law)(nan, 1.0)),
            "delta = 1: must be within the table's range": (
                lambda law: vr.law(law)([1e-3] * 2, [1e-2, 2e-2])
            ),
            "roll reads the rows of a law | vr.law(grid) gives its splines": (
                vr.roll,
                1.0,
                1.0,
                [1.0],
            ),
            "ensemble reads the rows of a law | vr.law(grid) gives its splines": (
                vr.ensemble,
                [1.0],
                [1.0],
                [1.0],
            ),
            "contact reads the rows of a law | vr.law(grid) gives its splines": lambda law: (
                vr.contact(law, 1.0, delta=0.0)
            ),
            "steady reads the rows of a law | vr.law(grid) gives its splines": lambda law: (
                vr.steady(law, force=0.01)
            ),
            "for vr.law alone": lambda law: PAPER.replace(material=law),
        },
    ),
    *each(
        None,
        {
            "dimension of 1": lambda: read_column(
                file("V0 [km/h];mu\n0,36;0,1", "starts.csv"), "V0", "1"
            ),
            "T_ref is in 1/Hz: must be in s": lambda: vr.Material(
                1e6, 0.5, T_ref=xr.DataArray(1.0, attrs={"units": "1/Hz"})
            ),
            "on = array( | 'cylinder' or 'base'": [
                lambda: vr.Cover(SERIES, nu=0.5, thickness=0.5, on=np.array(["base", "base"])),
                lambda: vr.Cover(SERIES, nu=0.5, thickness=0.5, on=np.array(["base"])),
            ],
            "alpha = 1000 | in [1, 1e+12]": lambda: vr.Cover(10**400, nu=0.5, thickness=0.5),
            "shift = <class | a function of the temperature": lambda: TREAD.at(20.0, shift=vr.WLF),
            "version = 2.0 | a whole number in [2, 3]": lambda: fmu.build(
                ROLLER, "b.fmu", version=2.0
            ),
            "model = ['Roller'] (a list) | 'Roller' or 'ContactElement'": lambda: fmu.build(
                ROLLER, "b.fmu", model=["Roller"]
            ),
            "mu = 'a' (a text): must be a number, finite and > 0": lambda: vr.tables.interpolate(
                grid().assign_attrs(mu="a"), "Q", V=0.15, delta=0.01, alpha=1.5
            ),
            "units: 'frequency' is not a quantity of this file; choose from angular frequency, "
            "storage, loss": lambda: vr.read_dma(
                file("1,2,3\n2,3,4"), units={"frequency": "Hz", "storage": "MPa", "loss": "MPa"}
            ),
            "units: 'temperature' is not a quantity of this file; choose from frequency, "
            "storage, loss": lambda: vr.read_dma(
                file("f [Hz],E' [Pa],E'' [Pa]\n1,2,1\n2,3,1\n"), units={"temperature": "K"}
            ),
            "shift by the overlap = | at 0 C and | at 40 C: must be shift factors a_T | which "
            "decrease with temperature": lambda: vr.fit_prony(
                [OMEGA] * 3,
                [TREAD.storage(a * OMEGA) for a in (1.0, 10.0, 100.0)],
                [TREAD.loss(a * OMEGA) for a in (1.0, 10.0, 100.0)],
                temperature=[0.0, 20.0, 40.0],
            ),
            "storage has 10 points in curve 2: must be as many as omega, 20": lambda: vr.fit_prony(
                [OMEGA] * 2, [DMA[1], DMA[1][:10]], [DMA[2]] * 2, temperature=[0.0, 20.0]
            ),
            "loss has 0 points in curve 2: must be as many as omega, 20": lambda: vr.fit_prony(
                [OMEGA] * 2, [DMA[1]] * 2, [DMA[2]], temperature=[0.0, 20.0]
            ),
            "loss has 3 points in curve 1: must be as many as omega, 20": lambda: vr.fit_prony(
                np.array([OMEGA] * 2),
                np.array([DMA[1]] * 2),
                np.ones((2, 3)),
                temperature=[0.0, 20.0],
            ),
            "columns = 'abc': must be quantity -> heading": lambda: vr.read_dma(
                file("1,2,3\n2,3,4"), columns="abc"
            ),
            "columns = 3: must be quantity -> heading": lambda: vr.read_dma(
                file("1,2,3\n2,3,4"), columns=3
            ),
            "encoding = 3: must be an encoding that Python knows": lambda: vr.read_dma(
                file("1,2,3\n2,3,4"), encoding=3
            ),
            "has shape (3,): must be a number or one for each motion, count = 2": lambda: (
                lambda run: roll_inputs(
                    run, {name: [value] * 3 for name, value in run.inputs.medians.items()}, 2
                )
            )(read_run(vr.datasets.path("run.toml"))),
            "temperature = -31.6 | > T0 - C2 = -31.6, where the WLF shift is infinite": lambda: (
                ROLLER.material.at(-31.6, shift=vr.WLF(T0=20.0))
            ),
            "temperature = -40.0 | > T0 - C2 = -31.6, where the WLF shift is infinite": lambda: (
                ROLLER.material.at(-40.0, shift=vr.WLF(T0=20.0))
            ),
            "shift = 3: must be a WLF, an Arrhenius or a function": lambda: ROLLER.material.at(
                20.0, shift=3
            ),
            "an array of shape (2,) | [rubber.at(T, shift) "
            "for T in temperatures] | run file": lambda: ROLLER.material.at(
                [20.0, 30.0], shift=vr.WLF(T0=20.0)
            ),
            "temperature = 30.0 | where the WLF shift is infinite, in degrees Celsius": lambda: (
                dataclasses.replace(ROLLER.material, temperature=20.0).at(
                    30.0, shift=vr.WLF(T0=90.0)
                )
            ),
            "tau | one for each k": lambda: vr.Material.abaqus(
                1e7, 0.49, [0.2], [0.1], k=[0.1, 0.2]
            ),
            "sum of k = 1: must be below 1: otherwise the "
            "long-time modulus is not positive": lambda: vr.Material.abaqus(
                1e7, 0.49, [0.2], [0.1], k=[1.0]
            ),
            "keyword: 'colour' is not a keyword of this function; choose from name, density, "
            "thickness": lambda: vr.Material.abaqus(1e7, 0.49, [0.2], [0.1], colour="red"),
            "tau | one for each K": lambda: vr.Material.comsol(
                1e6, 0.3, G=[1e6], tau=[1.0], K=[1e6, 1e6]
            ),
            "measured | a Measured": lambda: vr.Material.elastic(1e6, 0.5, measured=(1.0, 2.0)),
            "loss | shape": lambda: vr.fit_prony(*DMA[:2], DMA[2][:-1]),
            "shift has several factors for one temperature: must be one factor for each "
            "temperature": lambda: vr.fit_prony(
                [DMA[0]] * 2,
                [DMA[1]] * 2,
                [DMA[2]] * 2,
                temperature=[20.0, 20.2],
                shift=[1.0, 1.1],
            ),
            "mode = 'tension': must be 'shear'": lambda: vr.fit_prony(
                vr.DynamicModuli(*DMA, mode="shear"), mode="tension"
            ),
            "mode = 3 | 'tension' or 'shear'": lambda: vr.fit_relaxation(
                np.logspace(-3, 3, 20), 1.0 + np.exp(-np.logspace(-3, 3, 20)), mode=3
            ),
            "temperature | a single number": lambda: vr.fit_relaxation(
                np.logspace(-3, 3, 20), 1.0 + np.exp(-np.logspace(-3, 3, 20)), temperature=[20.0]
            ),
            "moduli at 0 and 20 °C do not agree after any shift: must be curves that overlap "
            "with their": lambda: vr.fit_prony(
                [np.logspace(-1, 1, 11)] * 2,
                [1.0 + 0.01 * np.logspace(-1, 1, 11), 50.0 + np.logspace(-1, 1, 11)],
                [0.01 * np.logspace(-1, 1, 11), np.logspace(-1, 1, 11)],
                temperature=[20.0, 0.0],
            ),
            "temperature has shape (1,): must be one for each of the 2 curves": lambda: (
                vr.fit_prony(
                    [np.logspace(-1, 1, 11)] * 2,
                    [1.0 + 0.01 * np.logspace(-1, 1, 11), 50.0 + np.logspace(-1, 1, 11)],
                    [0.01 * np.logspace(-1, 1, 11), np.logspace(-1, 1, 11)],
                    temperature=[20.0],
                )
            ),
            "omega has no points for curve 2: must be one frequency or more": lambda: vr.fit_prony(
                [DMA[0], DMA[0][:0]],
                [DMA[1], DMA[1][:0]],
                [DMA[2], DMA[2][:0]],
                temperature=[20.0, 0.0],
            ),
            "units | must be (frequency, moduli)": [
                lambda: vr.read_dma(file("omega [rad/s], E_stor, E_loss\n1,2,3\n"), units=("Hz",)),
                lambda: vr.read_dma(
                    file("omega [rad/s], E_stor, E_loss\n1,2,3\n"), units=("MPa", "Hz")
                ),
                lambda: vr.read_dma(
                    file("omega [rad/s], E_stor, E_loss\n1,2,3\n"), units=("Hz", "Nm")
                ),
                lambda: vr.read_dma(file("omega [rad/s], E_stor, E_loss\n1,2,3\n"), units="Hz"),
                lambda: vr.read_dma(
                    file("omega [rad/s], E_stor, E_loss\n1,2,3\n"), units=("Hz", 1.0)
                ),
            ],
            "'gamma'": lambda: vr.tables.interpolate(
                wide(),
                "gamma",
                V=0.5,
                delta=0.01,
                alpha=2.0,
            ),
            "V, delta, alpha": lambda: vr.tables.interpolate(
                wide(),
                V=2.0,
                alpha=1.0,
            ),
            "V, delta": lambda: vr.tables.interpolate(
                wide(),
                V=0.5,
                delta=0.01,
                alpha=2.0,
                s=1.0,
            ),
            "alpha = nan": [
                lambda: vr.tables.interpolate(
                    wide(),
                    V=0.5,
                    delta=0.01,
                    alpha=nan,
                ),
                lambda: vr.load_law(netcdf(narrow()), nan),
            ],
            "broadcast": lambda: vr.tables.interpolate(
                wide(),
                V=[1.0, 2.0],
                delta=0.01,
                alpha=[2.0] * 3,
            ),
            "a name that ends in .nc, .cdf, .csv, .txt, .mat for a grid": lambda: vr.tables.export(
                wide(), "t.h"
            ),
            "two inputs": lambda: vr.tables.export(wide(), "t.txt"),
            "alpha = 2.0 | 2.5": lambda: vr.Prony.creep([[0.5], [0.6]], [1.0], alpha=2.0),
            "alpha | one for each material": lambda: vr.Prony.creep(
                [[0.5], [0.6]], [1.0], alpha=[1.0, 2.0, 3.0]
            ),
            "alpha | 2.0": lambda: vr.Prony.creep([0.5], [1.0], alpha=3.0),
            "series | a Prony series of one material": lambda: vr.Cover(
                MANY, nu=0.5, thickness=1.0
            ),
            "nu = 0.6: must be in [0, 0.5]": lambda: vr.Cover(SERIES, nu=0.6, thickness=1.0),
            "nu has shape (2,) | a number, or one for each thickness": lambda: vr.Cover(
                SERIES, nu=[0.3, 0.4], thickness=1.0
            ),
            "nu = -0.1: must be in [0, 0.5]": lambda: vr.Cover(SERIES, nu=-0.1, thickness=1.0),
            "thickness = 0.0: must be in (0, 1e+15]": lambda: vr.Cover(
                SERIES, nu=0.5, thickness=0.0
            ),
            "on = 'bed' | 'cylinder' or 'base'": lambda: vr.Cover(
                SERIES, nu=0.5, thickness=1.0, on="bed"
            ),
            "part = 0.0: must be in (0, 1]": lambda: vr.Cover(
                SERIES, nu=0.5, thickness=1.0, part=0.0
            ),
            "path = law.csv | .nc, .cdf, .h, .json": lambda: vr.tables.export(
                vr.tables.law(COVERED.material), "law.csv"
            ),
            "thickness = 1e+16: must be in (0, 1e+15]": lambda: vr.Cover(
                SERIES, nu=0.5, thickness=1e16
            ),
            "thickness has shape (2, 1): must be a number, or one for each cover, (n,)": lambda: (
                vr.Cover(SERIES, nu=0.5, thickness=[[1.0], [2.0]])
            ),
            "a name that ends in .nc, .cdf, .h, .json for a law": lambda: vr.tables.export(
                vr.tables.law(11.0), "rubber.csv"
            ),
            "a file name that is a valid C identifier, for example rubber.h": lambda: (
                vr.tables.export(vr.tables.law(11.0), "my-rubber.h")
            ),
            "model": lambda: fmu.build(11.0, "a.fmu", model="Wheel"),
            "version": lambda: fmu.build(11.0, "a.fmu", version=1),
            "'mue' | mu, j": lambda: vr.identify(roller(), {"mue": (0.1, 1.0)}, [resistance()]),
            "unknown E | (1e+06, 2e+06) | contains the initial guess, 3e+06": lambda: vr.identify(
                roller(), {"E": (1000000.0, 2000000.0)}, [resistance()]
            ),
            "low < high": lambda: vr.identify(
                roller(), {"E": (4000000.0, 2000000.0)}, [resistance()]
            ),
            "unknown E = 0.0 | > 0": lambda: vr.identify(
                roller(), {"E": (0.0, 9000000.0)}, [resistance()]
            ),
            "unknown brake = -0.5 at row 0 | >= 0": lambda: vr.identify(
                roller(), {"brake": (-0.5, 0.5)}, [resistance()]
            ),
            "unknown drag = -0.1 at row 0 | >= 0": lambda: vr.identify(
                roller(), {"E": (1e6, 9e6), "drag": (-0.1, 0.1)}, [resistance()]
            ),
            "prior brake = -0.1 at row 0 | >= 0": lambda: vr.identify(
                roller(), {"brake": (0.0, 0.5)}, [resistance()], prior={"brake": (-0.1, 0.1)}
            ),
            "brake = -0.1 | >= 0": lambda: vr.identify(
                roller(), {"brake": (0.0, 0.5)}, resistance(), starts=1
            ).residuals({"brake": -0.1}),
            "drum: M = nan at row 1": lambda: vr.Resistance([0.1, 0.2], [1.0, nan], name="drum"),
            "number of unknowns = 2: must be at most 0, since the number of points is 1: give "
            "more points, or": lambda: vr.identify(
                roller(), ranges("E", "T_ref"), [vr.Resistance(0.1, 0.1)]
            ),
            "number of unknowns = 1: must be at most 0, since the number of points is 1: give "
            "more points, or": lambda: vr.identify(roller(), ranges("E"), vr.Resistance(0.1, 0.1)),
            "sigma of M = 0.0 | > 0": lambda: vr.Resistance(HUMP, HUMP, sigma=0.0),
            "'V': ..., 'omega': ...": lambda: vr.Coastdown(
                np.linspace(0.0, 20.0, 200),
                np.linspace(0.0, 20.0, 200),
                np.linspace(0.0, 20.0, 200),
                sigma=0.1,
            ),
            "2.0, 1.0 at rows 1, 2": lambda: vr.Coastdown(
                [0.0, 2.0, 1.0], [1.0, 1.0, 1.0], sigma=0.1
            ),
            "(39,) | (40,)": lambda: vr.Resistance(HUMP, HUMP[:-1], sigma=0.1),
            "name = 'a': must be different for each record": lambda: vr.identify(
                roller(), ranges("E"), [resistance(name="a"), resistance(name="a")]
            ),
            "data has records with values and records without: must be one kind: fit the "
            "records with values": lambda: vr.identify(
                roller(), ranges("E"), [resistance(), vr.Resistance(HUMP, sigma=0.1, name="b")]
            ),
            "resistance: sigma": lambda: vr.identify(roller(), ranges("E"), [vr.Resistance(HUMP)]),
            "run: V0 | a number: the data do not determine it": lambda: vr.identify(
                roller(), ranges("E"), [vr.Coastdown(np.linspace(0.0, 20.0, 200), sigma=0.1)]
            ),
            "temperature = 60.0 | given with a shift of the material": lambda: vr.identify(
                roller(), ranges("E"), [resistance(temperature=60.0)]
            ),
            "mu | a single number": lambda: vr.identify(
                roller().replace(mu=[0.1, 0.2]), ranges("E"), [resistance()]
            ),
            "cylinder = 'roller' | a Cylinder": lambda: vr.identify(
                "roller", ranges("E"), [resistance()]
            ),
            "unknown = ['E'] | {name: (low, high)}": lambda: vr.identify(
                roller(), ["E"], [resistance()]
            ),
            "data = 3 | a list of records": lambda: vr.identify(roller(), ranges("E"), 3),
            "shift = 3 | a function": lambda: vr.identify(
                roller(), ranges("E"), [resistance(temperature=60.0)], shift=3
            ),
            "shift | 'rubber' | material, base": lambda: vr.identify(
                roller(), ranges("E"), [resistance()], shift={"rubber": vr.WLF(T0=20.0)}
            ),
            "prior = 3 | {name: (value": lambda: vr.identify(
                roller(), ranges("E"), [resistance()], prior=3
            ),
            "seed = -1 | >= 0": [
                lambda: vr.identify(roller(), ranges("E"), [resistance()], seed=-1),
                lambda: fitted().predict(vr.Resistance(HUMP), draws=3, seed=-1),
            ],
            "draws = -1 | in [0, 100000]": lambda: fitted().predict(vr.Resistance(HUMP), draws=-1),
            "level = 2.0: must be in (0, 0.9999]": lambda: fitted().predict(
                vr.Resistance(HUMP), draws=3, level=2.0
            ),
            "E = -3000000.0 | > 0": lambda: fitted().residuals({"E": -3e6}),
            "data is empty: must be at least one record": lambda: vr.identify(
                roller(), ranges("E"), []
            ),
            "prior | 'mu'": lambda: vr.identify(
                roller(), ranges("E"), [resistance()], prior={"mu": (0.3, 0.1)}
            ),
            "resistance: V | in kg | in m s-1": lambda: vr.Resistance(
                xr.DataArray(HUMP, dims="speed", attrs={"units": "kg"}), sigma=0.1
            ),
            "resistance: V | in % | in m s-1": lambda: vr.Resistance(
                xr.DataArray(HUMP, dims="speed", attrs={"units": "%"}), sigma=0.1
            ),
            "V0 | a prediction needs it": lambda: fitted().predict(vr.Coastdown(TIMES, TIMES)),
            "values | 'nu' | E": lambda: fitted().residuals({"nu": 0.4}),
            "unknown t0:run | low < high": lambda: vr.identify(
                roller(), ranges("E"), [vr.Coastdown(TIMES, TIMES, sigma=0.1, t0=(0.5, 0.1))]
            ),
            "resistance: M has at all points the sign opposite to V: must be of the sign of V, "
            "as it resists: reverse its sign": lambda: vr.Resistance(
                HUMP, -resistance().M, sigma=0.01
            ),
            "drum: F has at all points the sign opposite to V": lambda: vr.Resistance(
                -HUMP, F=resistance().M, name="drum"
            ),
            "left out | given.nc is the law of one material": lambda: vr.load_law(
                netcdf(law_file()), 11.0
            ),
            "alpha = None: must be in [1, 2], the range of | given.nc (`viscoroll tables law "
            "--alpha LOW:HIGH` writes another range)": lambda: vr.load_law(netcdf(narrow())),
            "alpha = 5.0: must be in [1, 2], the range of | given.nc (`viscoroll tables law "
            "--alpha LOW:HIGH` writes another range)": lambda: vr.load_law(netcdf(narrow()), 5.0),
            "alpha | must be": lambda: vr.load_law(netcdf(grid())),
            "alpha = 0.5: must be": lambda: vr.load_law(netcdf(grid()), alpha=0.5),
            "alpha = 4.0: must be": lambda: vr.load_law(netcdf(grid()), alpha=4.0),
            "alpha = nan: must be": lambda: vr.load_law(netcdf(grid()), alpha=nan),
            "alpha = 11.0: must be left out | has no axis alpha": lambda: vr.load_law(
                netcdf(OTHER_GRID), alpha=11.0
            ),
            "n = 0: must be a whole number in [16, 65536]": lambda: sobol_indices(
                run("numbers", "n = 20", "n = 1"), 0
            ),
            "n = 15: must be a whole number in [16, 65536]": lambda: sobol_indices(
                run("numbers", "n = 20", "n = 1"), 15
            ),
            "n = 65537: must be a whole number in [16, 65536]": lambda: sobol_indices(
                run("numbers", "n = 20", "n = 1"), 65537
            ),
            "n = 1024: must be less, or t shorter: | quantities and times": lambda: sobol_indices(
                run(
                    "numbers",
                    "t = [1e-4, 2e-3, 0.03]",
                    "t = { low = 0.0, high = 1e-4, count = 40000 }",
                ),
                1024,
            ),
            "summaries = x at t = 0: it varies by no more than": lambda: sobol_indices(
                run("unsteady", "t = [1.0, 3.0]", 't = 0.0\nsummaries = ["x"]'), 16
            ),
            "[correlation] = | E_2 | omega0 | must be left out": lambda: sobol_indices(
                run("strengths", "n = 20", "n = 1"), 16
            ),
            "the run file has no uncertain input": lambda: sobol_indices(
                read_run(
                    file(
                        'preset = "paper-section-5"\nstart = { V0 = 1.0, omega0 = 0.0 }\nrun = '
                        "{ n = 1, t = 1.0 }"
                    )
                ),
                16,
            ),
            "C2 is in degC: must be in K": lambda: vr.WLF(
                T0=20.0, C2=xr.DataArray(50.0, attrs={"units": "degC"})
            ),
            "temperature is an array of shape (1, 2), but a material has one temperature": lambda: (
                SOFT.at([[20.0, 1.0]], vr.WLF(T0=20.0))
            ),
            "m has shape (2,): must be one number": lambda: ROLLER.replace(m=[30.0, 40.0]).law(),
            "material is of type bool": lambda: fmu.build(True, "b.fmu"),
            "mu has shape (2,): must be one number: an FMU contains one cylinder": lambda: (
                fmu.build(ROLLER.replace(mu=[0.2, 0.3]), "a.fmu")
            ),
            "name = '\\udc80' | a text without NUL and surrogates": lambda: vr.Material(
                E=1000000.0, nu=0.5, name="\udc80"
            ),
            "name = 'a\\x00' | a text without NUL and surrogates": lambda: vr.Material(
                E=1000000.0, nu=0.5, name="a\x00"
            ),
            "prony | a Prony series": lambda: vr.Material(1000000.0, 0.5, MANY),
            "source = 'a\\x00' | a text without NUL and surrogates": lambda: vr.Measured(
                1.0, 2.0, 0.1, "a\x00"
            ),
            "high = 1.0 | >= low = 2": lambda: vr.Measured(2.0, 1.0, 0.0),
            "T_epsilon = 1.0 | >= T_sigma = 2.0": lambda: vr.Material.sls(1000000.0, 0.4, 1.0, 2.0),
            "sum of g = 1: must be below 1: otherwise the "
            "long-time modulus is not positive": lambda: vr.Material.abaqus(
                E0=1000000.0, nu=0.4, g=[1.0], tau=[1.0]
            ),
            "tau has shape (2,): must be one for each g, of shape (1,)": lambda: vr.Material.abaqus(
                E0=1000000.0, nu=0.4, g=[0.2], tau=[1.0, 2.0]
            ),
            "rows (g_i, k_i, tau_i) | (1, 2)": lambda: vr.Material.abaqus(
                10000000.0, 0.49, [[0.2, 0.1]]
            ),
            "tau has shape (2,): must be one for each alpha, of shape (1,)": lambda: (
                vr.Material.ansys(E0=1000000.0, nu=0.4, alpha=[0.6], tau=[1.0, 2.0])
            ),
            "sum of alpha = 1.1: must be below 1: otherwise the long-time modulus is not "
            "positive": lambda: vr.Material.ansys(
                E0=1000000.0, nu=0.4, alpha=[0.6, 0.5], tau=[1.0, 2.0]
            ),
            "the long-time modulus is given by no parameter: must be given by one of G_inf, G0 "
            "and a pair with": lambda: vr.Material.lsdyna(
                G=[1000000.0], beta=[1.0], nu=0.4, G_inf=None
            ),
            "G0 - sum G = 0.0": lambda: vr.Material.lsdyna(
                G=[1000000.0], beta=[1.0], nu=0.4, G_inf=None, G0=1000000.0
            ),
            "temperature = -31.599 | cannot be represented in double precision": lambda: vr.WLF(
                T0=20.0
            )(-31.599),
            "temperature = -270.0 | cannot be represented in double precision": lambda: (
                vr.Arrhenius(energy=100000.0, T0=20.0)(-270.0)
            ),
            "thickness = 0.1 | left out for a rigid body": lambda: vr.Material.rigid(thickness=0.1),
            "resistance: V is empty: must be at least one number": lambda: vr.Resistance([], []),
            "cylinder | has other materials: must be one with the material() of this fit": lambda: (
                vr.fit_prony(*DMA).validity(ROLLER, 1.0)
            ),
        },
    ),
    *each(
        vr.Prony,
        {
            "tau = 1.7e+308 at row 0, and 1 more: must be in [1e-140, 1e+140]": (
                [2.0, 1.0],
                [1.7e308, 1.6e308],
            ),
            "sum of E = 2e+300: must be at most 1e+12": ([1.7e308, 1.7e308], [1.0, 0.1]),
            "E = -2.0 | >= 0": ([[1.0, -2.0]], [1.0, 0.1]),
            "tau = 0.0 | > 0": [([[1.0, 2.0]], [[1.0, 0.0]]), ([1.0], [0.0])],
            "E (1, 2), tau (3,) | broadcast": ([[1.0, 2.0]], [1.0, 0.1, 0.2]),
            "E, tau | (materials, modes)": ([[[1.0]]], [1.0]),
            "from 1e-20 to 1e+20 | within a factor": ([[1.0, 1.0]], [1e-20, 1e20]),
            "sum of E = 2e+12: must be at most 1e+12": ([[1.0], [2000000000000.0]], [1.0]),
            "E = -1.0 | >= 0": ([-1.0], [1.0]),
            "tau | shape": ([1.0, 2.0], [1.0]),
            "E | 1e+12": ([10000000000000.0], [1.0]),
            "tau | 1e+32": ([1.0, 1.0], [1.0, 1e-33]),
            "tau | 64": (np.ones(65), np.geomspace(1e-06, 1.0, 65)),
        },
    ),
    *each(
        vr.Prony.creep,
        {
            "T = 1e-300 | in [1e-140, 1e+140]": ([0.5], [1e-300]),
            "sum of J = 2e+300: must be below 1": ([1.7e308, 1.7e308], [1.0, 0.1]),
            "sum of J = 1.0: must be below 1: otherwise the instantaneous modulus is infinite": (
                [[0.5], [1.0]],
                [1.0],
            ),
            "J | below 1": ([0.6, 0.4], [1.0, 0.1]),
        },
    ),
    *each(
        vr.tables.law,
        {
            "material is of type bool": True,
            "thickness of the cylinder is given | depends on its load and radius": (
                RUBBER_COVER,
                STEEL,
            ),
            "rigid": (vr.Material.rigid(), vr.Material.rigid()),
            "material is of type str: must be a Prony, Bodies, a Material, a Cylinder or an "
            "alpha": "rubber",
            "material = <2 series": vr.Prony([[1.0], [2.0]], [1.0]),
            "base is given: must be left out unless material is a Material": [
                (ROLLER, vr.Material.elastic(200000000000.0, 0.3)),
                (SERIES, vr.Material.elastic(200000000000.0, 0.3)),
            ],
            "alpha = 0.5": [0.5, {"alpha": (0.5, 2)}],
            "alpha = nan": [nan, {"alpha": (2, nan)}],
            "give material or alpha": (),
            "both given": {"material": 2.0, "alpha": (1, 2)},
            "alpha = 11.0": {"alpha": 11.0},
            "alpha = 4 to 2": {"alpha": (4, 2)},
            "alpha = 1": {"alpha": (2, 10000000000000.0)},
        },
    ),
    *each(
        vr.fit_prony,
        {
            "storage = 1.0099009900990099e+295 at row 0, and 19 more: must be in [1e-100, "
            "1e+100]": (
                OMEGA,
                1e295 * DMA[1],
                1e295 * DMA[2],
            ),
            "omega | at least 3 points": ([1.0, 2.0], [1.0, 2.0], [1.0, 2.0]),
            "omega | column": (1.0, 1.0, 1.0),
            "omega | within a factor": ([1e-20, 1.0, 1e20], [1.0, 2.0, 3.0], [1.0, 1.0, 1.0]),
            "storage has no plateau at low frequencies (0.0001 at omega = 0.01): must be that "
            "of a solid, whose": (
                DMA[0],
                DMA[0] ** 2,
                DMA[0],
            ),
            "storage is given: must be left out: the result of read_dma contains it; write "
            "modes=5": (
                vr.DynamicModuli(*DMA),
                5,
            ),
            "storage and loss | given": (DMA[0], DMA[1]),
        },
    ),
    *each(
        vr.fit_relaxation,
        {
            "relaxation = 2e+300 at row 0, and 32 more: must be in [1e-100, 1e+100]": (
                T + 1.0,
                1e300 * (1.0 + np.exp(-T)),
            ),
            "t = 1e+305 at row 0, and 32 more: must be in [1e-100, 1e+100]": (
                1e305 * (T + 1.0),
                1.0 + np.exp(-T),
            ),
            "t = 2 points | at least 3 points": ([1.0, 2.0], [2.0, 1.0]),
            "t = 0.0 at row 0 | in [1e-100, 1e+100]": ([0.0, 1.0, 2.0], [3.0, 2.0, 1.0]),
            "relaxation has shape (2,): must be one column, with the shape of t": (
                [1.0, 2.0, 3.0],
                [3.0, 2.0],
            ),
            "relaxation has no plateau at long times (4.53999e-05 at t = 10): must be that of "
            "a solid, whose": (
                np.linspace(0.1, 10.0, 20),
                np.exp(-np.linspace(0.1, 10.0, 20)),
            ),
            "relaxation rises with time from 1.001 to 2: must be a relaxation modulus, which "
            "falls (a creep": (
                np.logspace(-3, 3, 20),
                2.0 - np.exp(-np.logspace(-3, 3, 20)),
            ),
        },
    ),
    *each(
        vr.Bodies,
        {
            "shapes | cylinder (2,), base (3,)": (MANY, vr.Prony([[1.0]] * 3, [1.0])),
            "share = 1.5 at row 1: must be in [0, 1]": (MANY, MANY, [0.1, 1.5]),
            "the pair has 80 modes: must be a pair of at most 64 modes": (
                vr.Prony(np.ones((2, 40)), np.arange(1.0, 41.0)),
                vr.Prony(np.ones((2, 40)), np.arange(1.0, 41.0)),
                0.1,
            ),
            "base = 11.0 | a Prony series": (MANY, 11.0),
            "share | one for each pair": (MANY, MANY, [[0.1, 0.5]]),
            "base | Prony": (SERIES, 2.0),
            "share = 1.5: must be in [0, 1]": (SERIES, SERIES, 1.5),
        },
    ),
    *each(
        partial(vr.fit_prony, *DMA),
        {
            "modes = np.timedelta64(5) | a whole number": {"modes": np.timedelta64(5)},
            "modes = 2.5 | whole number": {"modes": 2.5},
            "modes = 'many' (a text): must be a whole number in [1, 64]": {"modes": "many"},
            "modes = 65 | in [1, 64]": {"modes": 65},
            "reference is given, but temperature is not": {"reference": 20.0},
            "shift is given, but temperature is not": {"shift": vr.WLF(T0=20.0)},
            "temperature | column": {"temperature": [[20.0]]},
            "temperature rises from 20 to 25 °C in steps of at most 0.5 K: must be equal "
            "within 1 K in each": {"temperature": np.linspace(20.0, 25.0, 20)},
            "omega has shape (20,): must be one for each temperature, of shape (0,)": {
                "temperature": []
            },
            "reference = 30.0: must be within [20.0, 20.0]": {
                "temperature": 20.0,
                "reference": 30.0,
            },
            "shift = 1 at 0 C and 10 at 20 C | shift factors a_T (time divided by time at the "
            "reference), which decrease with temperature, in the order of the curves": {
                "temperature": np.repeat([20.0, 0.0], 10),
                "shift": [10.0, 1.0],
            },
            "shift = 0.01 at 0 C | shift factors a_T (time divided by time at the reference), "
            "which decrease with temperature, in the order of the curves": {
                "temperature": np.repeat([20.0, 0.0], 10),
                "shift": lambda T: 10.0 ** (0.1 * T),
            },
            "reference = 10.0: must be 0.0, 20.0, whose factors shift lists; for another one "
            "give shift as a function": {
                "temperature": np.repeat([20.0, 0.0], 10),
                "shift": [0.1, 1.0],
                "reference": 10.0,
            },
            "on = 'loss' | 'both' or 'storage'": {
                "temperature": np.repeat([0.0, 20.0], 10),
                "on": "loss",
            },
            "mode = 'bulk' | 'tension' or 'shear'": {"mode": "bulk"},
            "shift = 0: must be > 0: factors a_T, not their logarithms": {
                "temperature": np.repeat([0.0, 20.0], 10),
                "shift": [2.0, 0.0],
            },
            "omega | one for each temperature, of shape": {"temperature": np.zeros(19)},
            "omega | at least 2 points": {"temperature": np.arange(20.0)},
            "reference = 2 | within [0.0, 1.0]": {
                "temperature": np.repeat([1.0, 0.0], 10),
                "reference": 2.0,
            },
            "shift | factor for each of 2": {
                "temperature": np.repeat([1.0, 0.0], 10),
                "shift": [1.0],
            },
            "shift | > 0": {"temperature": np.repeat([1.0, 0.0], 10), "shift": [1.0, -1.0]},
        },
    ),
    *each(
        None,
        {
            "alpha = 17: must be within the table's range [1, 16]": lambda: vr.tables.interpolate(
                wide(),
                V=0.5,
                delta=0.01,
                alpha=17.0,
            ),
            "V = 0.0001: must be within the table's range [0.1, 2]": lambda: vr.tables.interpolate(
                wide(),
                V=[0.5, 1e-4],
                delta=0.01,
                alpha=2.0,
            ),
        },
        errors.OutOfTableError,
    ),
]


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize(("call", "words", "error"), REFUSED)
def test_refused(call, words, error):
    refused(call, *words, error=error)
