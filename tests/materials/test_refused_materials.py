"""Bad materials, series, covers, master curves, tables, identifications: a line says what is
allowed.
"""

from functools import partial

import numpy as np
import pytest
import xarray as xr
from calls import (
    DMA,
    MANY,
    OMEGA,
    OTHER_GRID,
    PAPER,
    ROLLER,
    RUBBER_COVER,
    SERIES,
    STEEL,
    TREAD,
    file,
    grid,
    law_file,
    netcdf,
    run,
)
from experiments import HUMP, TIMES, ranges, resistance, roller
from refusals import each, refusals

import viscoroll as vr
from viscoroll.core import errors
from viscoroll.runs import read_run
from viscoroll.runs.run_store import roll_inputs
from viscoroll.runs.sensitivity import sobol_indices
from viscoroll.runs.uncertain_inputs import read_column

pytestmark = pytest.mark.usefixtures("here")


def of_column(content):
    return read_column(file(content, "starts.csv"), "V0", "1")


LAW = partial(vr.tables.law, 11.0)
DECADES = np.logspace(-1, 1, 11)
#: temperatures of two curves
TWO = np.repeat([20.0, 0.0], 10)
STEP = np.logspace(-3, 3, 20)
REFUSED = [
    *each(
        None,
        {
            "shapes factor (3,), materials (2,)": lambda: MANY.slower([1.0, 2.0, 3.0]),
            "source = 3": lambda: vr.Measured(1.0, 2.0, 0.1, 3),
            "material = rigid": vr.Material.rigid().plot,
            "G has shape (0,) and tau has shape (1,): must be lists of the same length": lambda: (
                vr.Material.comsol(1e6, 0.4, [], [1.0])
            ),
            "G has shape (): must be a list": lambda: vr.Material.comsol(1e6, 0.4, 1.0, 1.0),
            "K with beta = 0": lambda: vr.Material.lsdyna(
                [1e6, 1e6], [1.0, 0.0], K=[1e6, 1e6], nu=0.4
            ),
        },
    ),
    *each(
        partial(vr.Material, 1e6, 0.4),
        {
            "name = 3": {"name": 3},
            "T_ref = [1.0, 2.0]": {"T_ref": [1.0, 2.0]},
            "T_ref is in 1/Hz: must be in s": {"T_ref": xr.DataArray(1.0, attrs={"units": "1/Hz"})},
            "prony | one Prony series": MANY,
        },
    ),
    *each(
        partial(vr.Material.lsdyna, [1e6]),
        {
            "G_inf and beta = 0": {"beta": [0.0], "nu": 0.4, "G_inf": 1e6},
            "neither nu nor bulk is given": {"beta": [1.0], "G_inf": 1e6},
        },
    ),
    *each(
        lambda call: call(vr.load_law(netcdf(OTHER_GRID))),
        {
            "V = 5: must be within the table's range [-0.003, 0.003]": (
                lambda law: vr.law(law)(5.0, 50.0)
            ),
            "delta = 1: must be within the table's range": (
                lambda law: vr.law(law)([1e-3] * 2, [1e-2, 2e-2])
            ),
            "material is a grid without | full slip at both ends of delta": lambda law: (
                PAPER.replace(material=law)
            ),
        },
    ),
    *each(
        lambda table, path: vr.tables.export(table(), path),
        {
            "a name that ends in .nc, .cdf, .csv, .txt, .mat for a grid": (grid, "t.h"),
            "two inputs": (grid, "t.txt"),
            "a name in C (letters, digits, _; no digit first": (LAW, "my-rubber.h"),
            "no keyword of C or C++, nor vr_...), as rubber.h": (LAW, "double.h"),
        },
    ),
    *each(
        partial(vr.Prony.creep, T=[1.0, 0.1]),
        {
            "alpha | one for each material": {"J": [[0.5, 0.1]] * 2, "alpha": [1.0, 2.0, 3.0]},
            "alpha | 2.0": {"J": [0.25, 0.25], "alpha": 3.0},
            "sum of J = 2e+300: must be below 1": {"J": [1.7e308, 1.7e308]},
        },
    ),
    *each(
        partial(vr.Coastdown, sigma=0.1),
        {
            "'V': ..., 'omega': ...": (TIMES, TIMES, TIMES),
            "2.0, 1.0 at indices 1, 2": ([0.0, 2.0, 1.0], [1.0, 1.0, 1.0]),
        },
    ),
    *each(
        of_column,
        {
            "line 4 ('x') is not a line of numbers": "V0;mu\n1;0.1\n2;0.2\nx",
            "line 4 ('3') has 1 cell separated": "V0;mu\n1;0.1\n2;0.2\n3",
        },
        vr.FileError,
    ),
    *each(
        None,
        {
            "a unit of a ratio, as %": lambda: of_column("V0 [km/h];mu\n0,36;0,1"),
            "has shape (3,): must be a number, or one for | the argument count, is 2": lambda: (
                lambda run: roll_inputs(run, dict.fromkeys(run.inputs.medians, [1.0] * 3), 2)
            )(read_run(vr.datasets.path("run.toml"))),
            "sum of k = 1: must be below 1, since 1 minus this sum is": lambda: vr.Material.abaqus(
                1e7, 0.49, [0.2], [0.1], k=[1.0]
            ),
            "measured | a vr.Measured": lambda: vr.Material.elastic(1e6, 0.5, measured=(1.0, 2.0)),
            "mode = 'tension': must be 'shear'": lambda: vr.fit_prony(
                vr.DynamicModuli(*DMA, mode="shear"), mode="tension"
            ),
            "V, delta, alpha": lambda: vr.tables.interpolate(grid(), V=0.2, alpha=1.0),
            "broadcast": lambda: vr.tables.interpolate(
                grid(), V=[0.1, 0.2], delta=0.01, alpha=[2.0] * 3
            ),
            "V0 of the record is not given": (
                lambda: vr.identify(roller(), ranges("E"), resistance(), starts=1).predict(
                    vr.Coastdown(TIMES, TIMES)
                )
            ),
            "C2 is in degC: must be in K": lambda: vr.WLF(
                T0=20.0, C2=xr.DataArray(50.0, attrs={"units": "degC"})
            ),
            "high = 1.0 | >= low = 2": lambda: vr.Measured(2.0, 1.0, 0.0),
            "M_error = 1.0: must be pairs": lambda: vr.Measured(1.0, 2.0, 0.0, M_error=1.0),
            "the columns g_i, k_i, tau_i; g has shape | (1, 2)": lambda: vr.Material.abaqus(
                10000000.0, 0.49, [[0.2, 0.1]]
            ),
            "temperature = -31.599 | nearer to T0 = 20.0 °C | is out of range": lambda: vr.WLF(
                T0=20.0
            )(-31.599),
            "thickness = 0.1 | left out for a rigid body": lambda: vr.Material.rigid(thickness=0.1),
            "V0 = None: must be a finite number": lambda: vr.Coastdown(TIMES, sigma=0.1).model(
                roller(), {}
            ),
            "omega = 'x' (a text): must be a finite": lambda: vr.fit_prony(*DMA).modulus("x"),
        },
    ),
    *each(
        TREAD.at,
        {
            "shift = <class | a function of the temperature": (20.0, vr.WLF),
            "temperature = -31.6 | above T0 - C2 = -31.6 °C, where the WLF shift": (
                -31.6,
                vr.WLF(T0=20.0),
            ),
            "temperature has shape (1, 2): must be one number, as a material": (
                [[20.0, 1.0]],
                vr.WLF(T0=20.0),
            ),
        },
    ),
    *each(
        lambda cylinder: vr.fit_prony(*DMA).validity(cylinder, 1.0),
        {"cylinder has no material of this fit: must be a Cylinder with material=": [ROLLER, None]},
    ),
    *each(
        vr.identify,
        {
            "unknown names no parameter | at least one": {"unknown": {}},
            "unknown E | (1e+06, 2e+06) | contains 3e+06, the value of the cylinder with which": {
                "unknown": {"E": (1e6, 2e6)}
            },
            "standard deviation of prior E is in kPa: must be a number without dimension": {
                "prior": {"E": (3e6, xr.DataArray(1.0, attrs={"units": "kPa"}))}
            },
            "number of unknowns = 1 (E): must be at most 0, the number of values in the records "
            "and of priors, less one as sigma is not given: give more points or sigma, or": {
                "data": vr.Resistance(0.1, 0.1)
            },
            "name = 'a': must be different for each record": {
                "data": [vr.Resistance(HUMP, sigma=0.1, name="a")] * 2
            },
            "data has measured values in some records, but none in b: must be records that all": {
                "data": [vr.Resistance(HUMP, HUMP), vr.Resistance(HUMP, sigma=0.1, name="b")]
            },
            "resistance: sigma": {"data": vr.Resistance(HUMP)},
            "run: V0 | given, as the record has no values of V or x": {
                "data": vr.Coastdown(TIMES, sigma=0.1)
            },
            "temperature = 60.0 | unless material has a shift: give one as shift={'material'": {
                "data": vr.Resistance(HUMP, HUMP, temperature=60.0)
            },
            "mu | a single number": {"cylinder": roller().replace(mu=[0.1, 0.2])},
            "data = 3 | a list of records": {"data": 3},
            "data is empty: must be at least one record": {"data": []},
        },
        cylinder=roller(),
        unknown=ranges("E"),
        data=resistance(),
    ),
    *each(
        lambda make, n=16: sobol_indices(make(), n),
        {
            "n = 1024 (n is rounded up to a power of two): | take a smaller n, fewer times": (
                partial(
                    run,
                    "numbers",
                    "t = [1e-4, 2e-3, 0.03]",
                    "t = { low = 0.0, high = 1e-4, count = 40000 }",
                ),
                1024,
            ),
            "has Sobol indices: x at t = 0 (varies by no more than": partial(
                run, "unsteady", "t = [1.0, 3.0]", 't = 0.0\nsummaries = ["x"]'
            ),
            "[correlation] relates the inputs | E_2 | omega0 | must be left out": partial(
                run, "strengths", "n = 20", "n = 1"
            ),
            "the run file has no uncertain input": lambda: read_run(
                file(
                    'preset = "paper-section-5"\nstart = { V0 = 1.0, omega0 = 0.0 }\nrun = '
                    "{ n = 1, t = 1.0 }"
                )
            ),
        },
    ),
    *each(
        lambda **more: vr.read_dma(file("omega [rad/s], E_stor, E_loss\n1,2,3\n"), **more),
        {
            "columns = 'abc' (a text): must be a dict of headings of the file, as": {
                "columns": "abc"
            },
            "encoding = 3: must be an encoding that Python knows": {"encoding": 3},
            "units | must be (unit of frequency, of moduli)": [{"units": "Hz"}],
            "units has | for | must be a unit of the dimension of": [
                {"units": units} for units in (("MPa", "Hz"), ("Hz", 1.0))
            ],
        },
    ),
    *each(
        vr.fit_prony,
        {
            "loss has curves of [20] points: must be as many as omega has, [20, 20]": {
                "omega": [OMEGA] * 2,
                "storage": [DMA[1]] * 2,
                "loss": [DMA[2]],
                "temperature": [0.0, 20.0],
            },
            "curves at 0 and 20 °C do not agree after any shift: must be equal where they overlap, "
            "after a shift; leave": {"temperature": [20.0, 0.0]},
            "shift has different factors for the temperature 20.1 °C: must be one factor for": {
                "temperature": [20.0, 20.2],
                "shift": [1.0, 1.1],
            },
            "temperature has shape (1,): must be one number for each curve; omega has 2": {
                "temperature": [20.0]
            },
            "omega has no points for curve 2: must be a list with points for each curve": {
                "omega": [DECADES, []],
                "storage": [DECADES, []],
                "loss": [DECADES, []],
                "temperature": [20.0, 0.0],
            },
        },
        omega=[DECADES] * 2,
        storage=[1.0 + 0.01 * DECADES, 50.0 + DECADES],
        loss=[0.01 * DECADES, DECADES],
    ),
    *each(
        vr.Prony,
        {
            "E (1, 2), tau (3,) | broadcast": ([[1.0, 2.0]], [1.0, 0.1, 0.2]),
            "E and tau | (materials, terms of the series)": ([[[1.0]]], [1.0]),
            "tau | shape": ([1.0, 2.0], [1.0]),
            "E | 1e+12": ([10000000000000.0], [1.0]),
            "tau | 1e+32": ([1.0, 1.0], [1.0, 1e-33]),
            "tau | 64": (np.ones(65), np.geomspace(1e-06, 1.0, 65)),
        },
    ),
    *each(
        vr.tables.law,
        {
            "material = True (a truth value)": True,
            "thickness of a cover on the cylinder is given | depends on load and radius": (
                RUBBER_COVER,
                STEEL,
            ),
            "material = <2 Prony series": vr.Prony([[1.0], [2.0]], [1.0]),
            "base is given: must be left out unless material is a Material": (
                ROLLER,
                vr.Material.elastic(200000000000.0, 0.3),
            ),
            "neither material nor alpha is given": (),
            "alpha = 11.0": {"alpha": 11.0},
            "alpha = 4 to 2": {"alpha": (4, 2)},
        },
    ),
    *each(
        vr.fit_prony,
        {
            "omega | a list of numbers": (1.0, 1.0, 1.0),
            "omega | within a factor": ([1e-20, 1.0, 1e20], [1.0, 2.0, 3.0], [1.0, 1.0, 1.0]),
            "storage has no plateau at low frequencies (0.0001 at omega = 0.01 rad s-1): must "
            "be the modulus of a solid, which": (DMA[0], DMA[0] ** 2, DMA[0]),
            "storage is given beside the result of read_dma: must be left out, since that result "
            "contains it; give a number of terms": (vr.DynamicModuli(*DMA), 5),
            "loss is not given: must be given, as fit_prony(omega, storage, loss)": (
                DMA[0],
                DMA[1],
            ),
        },
    ),
    *each(
        partial(vr.fit_relaxation, STEP),
        {
            "relaxation is not given: must be the second argument, fit_relaxation(t,": {},
            "temperature | a single number": {
                "relaxation": 1.0 + np.exp(-STEP),
                "temperature": [20.0],
            },
            "relaxation rises from 1.001 at the first time to 2 at the last: must be a relaxation "
            "modulus, which falls with time (a creep": 2.0 - np.exp(-STEP),
        },
    ),
    *each(
        partial(vr.fit_relaxation, vr.RelaxationModulus(STEP, 1.0 / STEP, mode="shear")),
        {
            "relaxation is given beside the result of read_relaxation: must be left out": STEP,
            "mode = 'tension': must be 'shear', as read from the data": {"mode": "tension"},
        },
    ),
    *each(
        vr.Cover,
        {
            "other = <2 Prony series | of one material": {"other": MANY},
            "series | a Prony series of one material": {"series": MANY},
            "nu has shape (2,): must be a number, as thickness": {"nu": [0.3, 0.4]},
            "thickness has shape (2, 1): must be a number, or one number for each cover": {
                "thickness": [[1.0], [2.0]]
            },
        },
        series=SERIES,
        nu=0.5,
        thickness=1.0,
    ),
    *each(
        vr.Resistance,
        {
            "(39,) | (40,)": (HUMP, HUMP[:-1]),
            "resistance: M has at all points the sign opposite to V: must be of the sign of V, "
            "since it resists; reverse its sign": {"V": HUMP, "M": -resistance().M, "sigma": 0.01},
            "F is empty: must be at least one number": {"V": [1.0], "F": []},
            "resistance: F has shape (3,): must be one value for each point, in the shape (1,) of "
            "V": {"V": [1.0], "F": [1.0, 2.0, 3.0]},
        },
        sigma=0.1,
    ),
    *each(
        lambda made, alpha=None: vr.load_law(netcdf(made()), alpha),
        {
            "left out | given.nc has no range of alpha": (law_file, 11.0),
            "alpha = None: must be a number in [1, 2], the range of | --alpha LOW:HIGH": partial(
                vr.tables.law, alpha=(1, 2)
            ),
            "alpha | must be": grid,
            "alpha = nan: must be": (grid, np.nan),
            "alpha = 11.0: must be left out | has no axis alpha": (OTHER_GRID.copy, 11.0),
        },
    ),
    *each(
        vr.Bodies,
        {
            "shapes | cylinder (2,), base (3,)": (MANY, vr.Prony([[1.0]] * 3, [1.0])),
            "cylinder and base have 80 Prony terms together: must be series of at most 64": (
                *[vr.Prony(np.ones((2, 40)), np.arange(1.0, 41.0))] * 2,
                0.1,
            ),
            "base = 11.0 | a Prony series": (MANY, 11.0),
            "share | one number for each pair": (MANY, MANY, [[0.1, 0.5]]),
        },
    ),
    *each(
        partial(vr.fit_prony, *DMA),
        {
            "reference is given, but temperature is not": {"reference": 20.0},
            "temperature | one number for each point": {"temperature": [[20.0]]},
            "temperature rises from 20 to 25 °C in steps of at most 0.5 K: must be equal "
            "within 1 K in each": {"temperature": np.linspace(20.0, 25.0, 20)},
            "omega has shape (20,): must be one number for each point, of shape (0,), as temp": {
                "temperature": []
            },
            "reference = 30.0: must be from 20.0 to 20.0 °C, the range of temperature, or": {
                "temperature": 20.0,
                "reference": 30.0,
            },
            "shift = 1 at 0 °C and 10 at 20 °C | shift factors a_T (relaxation time divided by "
            "that at reference), which fall with temperature; in a list they have the order": {
                "temperature": TWO,
                "shift": [10.0, 1.0],
            },
            "reference = 10.0: must be one of 0.0, 20.0 °C, which have a factor in shift; for "
            "others give shift as a function": {
                "temperature": TWO,
                "shift": [0.1, 1.0],
                "reference": 10.0,
            },
            "shift = 0: must be > 0: give the factors a_T, not their logarithms": {
                "temperature": TWO,
                "shift": [2.0, 0.0],
            },
            "omega | at least 2 points": {"temperature": np.arange(20.0)},
            "shift | factor for each of 2": {"temperature": TWO, "shift": [1.0]},
        },
    ),
    *each(
        None,
        {
            "alpha = 17: must be within the table's range [1, 2]": lambda: vr.tables.interpolate(
                grid(), V=0.15, delta=0.01, alpha=17.0
            )
        },
        errors.OutOfTableError,
    ),
]
test_refused = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")(refusals(REFUSED))
