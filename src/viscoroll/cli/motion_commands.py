"""Commands of contact, motion, runs and figures.

- Contact and motion of a scene: ``viscoroll contact``, ``stress``, ``roll``, ``steady``, ``heat``
  and ``validity``.
- Run files: ``viscoroll ensemble``, ``verify`` and ``sensitivity``.
- ``viscoroll plot``: a figure of the content of a file.
"""

import os
import sys
import warnings
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

import viscoroll as vr

from .arguments import (
    FIGURES,
    SCENE,
    Option,
    add_table,
    as_text,
    command,
    deliver,
    numbers,
    option,
    output,
    roller_of_argument,
    show,
)

# --- Contact and motion of a scene ---


#: Largest number of loads without an equilibrium that ``steady`` lists.
_MOST_LINES = 3
#: Help of a speed.
_V_HELP = (
    "velocity of the axis, any sign; in m/s for [cylinder], divided by R/T_ref for [scene] "
    "and presets"
)
#: Help of an angular velocity.
_OMEGA_HELP = "angular velocity, rad/s for [cylinder], else times T_ref"


def _speeds(kind: Callable[[str], Any]) -> tuple[Option, ...]:
    """Return the options that commands on a contact have in common.

    kind: function that converts the text of a speed or creepage: ``float``, for one number, or
        :func:`.arguments.numbers`, for one or several.
    Returns four options for :func:`.arguments.command`: (scene, --V, --delta, --omega).  Scene
    and --V are required; delta and omega are None where they are not given.
    """
    return (
        SCENE,
        option("--V", type=kind, required=True, help=_V_HELP),
        option("--delta", type=kind, help="creepage (omega R - V)/V"),
        option("--omega", type=kind, help=f"{_OMEGA_HELP}; in place of --delta"),
    )


@command("contact", *_speeds(numbers), add_table)
def contact(arguments: Namespace) -> None:
    """Compute the contact at constant speed: length, shift, stick zone, creep force Q and rolling moment M.

    The result has a row for every pair of V and delta (or omega).  Each option is a number, LOW:HIGH:COUNT (COUNT numbers
    at equal distances), LOW:HIGH:COUNT:log (with equal ratios), or several of these, separated by commas.

    example:
      viscoroll contact paper-section-5 --V 0.5,1 --delta -0.04:0.04:5

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        V, speeds, a number or (n,), in m/s of a cylinder, dimensionless of a scene;
        delta, creepages, a number or (m,), dimensionless, or None;
        omega, angular velocities, a number or (m,), in rad/s or dimensionless, or None;
        output, path of a .txt, .csv or .nc file that is written, or None: standard
        output;
        format of standard output, "text", "csv" or "json".
    Exactly one of delta and omega must be given.  A vector of speeds and one of creepages (or
    angular velocities) give n x m states, those of the first speed first; a vector and a number one
    state for each element; two numbers one.
    Returns None; a state has V, delta or omega, and the default fields of
    :func:`viscoroll.contact`; a .nc file has them as the dataset of the result's ``to_xarray``.  A
    contact that the model does not describe gives a ModelWarning.
    Raises ParameterError for both or none of delta and omega, and for values that are not allowed;
    FileError for a file that cannot be read or written.
    """  # noqa: E501
    import numpy as np

    speeds = {name: getattr(arguments, name) for name in ("V", "delta", "omega")}
    # all pairs, speeds along the first axis, so that the states of the first speed come first
    if np.ndim(arguments.V) and (np.ndim(arguments.delta) or np.ndim(arguments.omega)):
        speeds["V"] = arguments.V[:, None]
    show(arguments, roller_of_argument(arguments.scene).contact(**speeds))


@command("stress", *_speeds(float), add_table)
def stress(arguments: Namespace) -> None:
    """Compute pressure and shear stress along the contact.

    The stresses are given at 101 points, for one V and one delta (or omega).  The output has the pressure p only for a
    cover, and for half-spaces with Dundurs' constant above 0.05 unless the file has coupled = false.

    example:
      viscoroll stress paper-section-5 --V 0.5 --delta -0.01

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        V, delta, omega, one number each, delta or omega None, as in ``contact``;
        output and format as in ``contact``.
    Exactly one of delta and omega must be given.
    Returns None; each position has x, V, delta or omega, the pressure p and the shear stress tau
    (of a cover p alone), in SI units of a cylinder, as in :func:`viscoroll.stress`; a .nc file has
    them as the dataset of the result's ``to_xarray``.  A contact that the model does not describe
    gives a ModelWarning.
    Raises ParameterError for both or none of delta and omega, and for values that are not allowed;
    FileError for a file that cannot be read or written.

    The positions are equidistant and ascend in x: from the trailing to the leading end for V >= 0.
    """  # noqa: E501
    import numpy as np

    roller = roller_of_argument(arguments.scene)
    speeds = {name: getattr(arguments, name) for name in ("V", "delta", "omega")}
    state = roller.contact(**speeds, fields=("length", "epsilon"))
    # Eq. (8): the contact reaches from (epsilon - 1) lam/2 behind to (epsilon + 1) lam/2 ahead
    ahead = np.linspace(state.epsilon - 1.0, state.epsilon + 1.0, 101)
    # ahead is towards -x for V < 0: mirrored, and reversed so that x ascends
    x = 0.5 * state.length * (ahead if arguments.V >= 0.0 else -ahead[::-1])
    show(arguments, roller.stress(x, **speeds))


@command(
    "roll",
    SCENE,
    option("--V0", type=float, required=True, help=f"initial {_V_HELP}"),
    option(
        "--omega0",
        type=float,
        required=True,
        help=f"initial {_OMEGA_HELP}",
    ),
    option(
        "--t",
        type=numbers,
        required=True,
        help="output times as LOW:HIGH:COUNT[:log] or 0.1,0.2,0.4; in s for [cylinder], divided "
        "by T_ref for [scene] and presets",
    ),
    add_table,
)
def roll(arguments: Namespace) -> None:
    """Integrate one free motion from given initial speeds.

    The motion may change between full slip and partial slip.  For half-spaces of one material Eq. (22) of the paper holds.
    For driven, braked and unsteady motions use vr.roll in Python, or a run file (viscoroll ensemble).

    example:
      viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 0:3e-3:7

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        V0, omega0, speeds at the start, numbers, in m/s and rad/s of a cylinder; t, output times,
        a number or (n,), in s of a cylinder; all are dimensionless of a scene;
        output and format as in ``contact``.
    The output has a row for each time with t, V, omega, x, angle, delta and the
    regime in words; times that the motion did not reach have NaN, and the regime "not_reached".  A
    .nc file has the dataset of :meth:`viscoroll.Motion.to_xarray`, with the regime as a code.  A
    motion that the model does not describe gives a ModelWarning.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read
    or written.

    The summary of the motion is the heading of a text; where a file is written it is printed too.
    """  # noqa: E501
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # the text states how the motion ended
        motion = roller_of_argument(arguments.scene).roll(
            arguments.V0, arguments.omega0, arguments.t
        )
    show(arguments, motion, str(motion))
    if arguments.output is not None:
        print(motion)


def _given(arguments: Namespace, *names: str) -> dict[str, Any]:
    """Return the numbers of the options that are given, as vectors, which have a list of reasons.

    arguments: parsed command line.
    names: names of options; their values are numbers, (n,), or None.
    Returns a dict name -> (n,); a slope is as it is given, since a cover takes one number.
    """
    import numpy as np

    return {
        name: value if name == "slope" else np.atleast_1d(value)
        for name in names
        if (value := getattr(arguments, name)) is not None
    }


@command(
    "steady",
    SCENE,
    option("--force", type=numbers, help="force along V, N/m for [cylinder] (default: 0)"),
    option("--torque", type=numbers, help="torque along omega, N m/m for [cylinder] (default: 0)"),
    option(
        "--slope",
        type=numbers,
        help="slope angle in rad, positive if +V points downhill; the normal load is P cos(slope)",
    ),
    option(
        "--V",
        type=numbers,
        help="given speed, m/s for [cylinder], in place of --force or --torque, which is computed",
    ),
    add_table,
)
def steady(arguments: Namespace) -> None:
    """Find the steady speeds under force, torque or slope.

    Each row is a steady speed under one of the loads.  If a load has no steady speed, the reason is printed.
    Options are numbers as in `viscoroll contact`, or lists of equal length (the slope of a cover: one number).

    example:
      viscoroll steady paper-section-5-rounded --slope 0:0.1:6

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        force, torque, slope, V, a number or (n,) each, or None where it is not given: a force,
        torque or slope of 0, and a speed that is not prescribed;
        output and format as in ``contact``.
    Returns None.  The table has a row for each equilibrium of each load, with the quantities of
    :func:`viscoroll.steady`, and none for a load without an equilibrium; a .nc file has the dataset
    of :meth:`viscoroll.Steady.to_xarray`, with NaN in its place.  A contact that the model does not
    describe gives a ModelWarning.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read
    or written.

    The reasons stand above the table, of at most three loads, and then the number of the others;
    where the output is a file, csv or json they are warnings (ModelWarning), one for each.
    """  # noqa: E501
    loads = _given(arguments, "force", "torque", "slope", "V")
    if loads.keys() <= {"slope"}:
        loads["force"] = [0.0]
    equilibria = roller_of_argument(arguments.scene).steady(**loads)
    lines = [f"load {n}: {reason}" for n, reason in enumerate(equilibria.reason) if reason]
    if (further := len(lines) - _MOST_LINES) > 0:
        lines[_MOST_LINES:] = [
            f"no steady speed for {further} more of the loads, which are counted from 0"
        ]
    # a table for programs has no heading
    if arguments.output is not None or arguments.format != "text":
        for line in lines:
            warnings.warn(line, vr.ModelWarning, stacklevel=2)
    show(arguments, equilibria, "\n".join(lines))


@command(
    "heat",
    SCENE,
    option("--V", type=numbers, help="speed in m/s (default: that of steady rolling by the loads)"),
    option(
        "--ambient",
        type=numbers,
        required=True,
        help="temperature of the surroundings in degrees Celsius",
    ),
    option(
        "--conductance",
        type=numbers,
        required=True,
        help="heat that a metre of roller gives off per kelvin above --ambient, W/(m K)",
    ),
    option("--force", type=numbers, help="force on the axis along V, N/m"),
    option("--torque", type=numbers, help="torque on the cylinder along omega, N m/m"),
    option("--slope", type=numbers, help="slope angle in rad, positive if +V points downhill"),
    add_table,
)
def heat(arguments: Namespace) -> None:
    """Find the temperatures at which a cylinder runs.

    Each row is a temperature at which rolling loss and heat given off are equal; unstable ones lie between stable ones.
    The file needs [cylinder].  A body that relaxes needs the key wlf or arrhenius; if both relax, they must be of one
    material.  Options are numbers as in `viscoroll contact` (the slope of a cover: one number).

    example:
      viscoroll samples
      viscoroll heat samples/rubber.toml --V 0.5:4:8 --ambient 20 --conductance 2.5

    arguments: parsed command line with scene, path of a TOML file with [cylinder] and a [material]
        that has a shift; V, ambient, conductance, force, torque, slope, numbers or (n,), or None;
        output and format as in ``steady``.
    The table has a row for each equilibrium, with the fields of :func:`viscoroll.temperature`.
    Raises ParameterError for values that are not allowed, FileError for a file that fails.
    """  # noqa: E501
    given = _given(arguments, "V", "ambient", "conductance", "force", "torque", "slope")
    found = roller_of_argument(arguments.scene).temperature(**given)
    reasons = [f"state {n}: {reason}" for n, reason in enumerate(found.reason) if reason]
    for text in reasons[:_MOST_LINES]:
        warnings.warn(text, vr.ModelWarning, stacklevel=2)
    show(arguments, found)


@command(
    "validity",
    SCENE,
    option("--V", type=float, required=True, help=_V_HELP),
    option(
        "--omega",
        type=float,
        help="angular velocity, rad/s for [cylinder]; without it the creepage is not checked",
    ),
)
def validity(arguments: Namespace) -> None:
    """Check the assumptions of the model at one speed.

    Each line has the name of an assumption, whether it holds (yes, no, or ? if data are missing), and the reason.

    example:
      viscoroll validity rubber-roller --V 5 --omega 4.9

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        V, omega, numbers, in m/s and rad/s of a cylinder, dimensionless of a scene; omega perhaps
        None: the assumption on creepage is then not checked.
    Returns None also where an assumption does not hold.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read.
    """  # noqa: E501
    print(roller_of_argument(arguments.scene).validity(arguments.V, omega=arguments.omega))


# --- Run files ---

#: The run file of a command.
_RUN = option("run_file", metavar="RUN.toml", help="a run file")


@command(
    "ensemble",
    _RUN,
    output(
        ".zarr",
        required=False,
        more=": the results store; without -o a trial estimates the time and memory of the run",
    ),
    option(
        "--cluster",
        metavar="WHERE",
        help="local (processes of this machine), or the address "
        "tcp://host:port of a dask scheduler",
    ),
    option(
        "--threads",
        type=int,
        help="threads, or local processes (default: $VISCOROLL_THREADS, else the number of cores)",
    ),
)
def ensemble(arguments: Namespace) -> None:
    """Compute the motions of a run file with random initial speeds and parameters.

    The command computes the motions that the store does not contain yet, and summarises all motions.
    Call it again to complete an interrupted run, or to extend the store after n was raised in the run file.
    Without -o it prints the estimated size, memory and time of the run.

    example:
      viscoroll samples
      viscoroll ensemble samples/ensemble.toml

    arguments: parsed command line with
        run_file, path of a TOML file;
        output, folder of the results (.zarr), which is made or completed, or None: a few motions
        are rolled as a trial, the estimate is printed, and nothing is written;
        cluster, None for threads of this process, and threads, as the options above say.
    Motions beyond the model or the measured bands of the materials give a ModelWarning.
    With output standard error has a progress bar if it is a terminal, else lines of progress unless
    $VISCOROLL_QUIET is "1".
    Raises ParameterError for values that are not allowed, as cluster without output; FileError for
    a file that cannot be read or written, a store in use or a lost cluster; MissingDependencyError
    without zarr, dask for a cluster, or pyarrow for a sample in .parquet; Interrupted at Ctrl-C,
    finished blocks being kept.

    Blocks of motions that the store already has are not computed again; where there are any, their
    number is printed.
    """  # noqa: E501
    run = vr.runs.read_run(arguments.run_file)
    if arguments.output is None:
        if arguments.cluster is not None:
            raise vr.ParameterError(
                "--cluster",
                arguments.cluster,
                "left out without -o: the trial runs on this machine",
            )
        print(vr.runs.estimate(run, arguments.threads))
        return
    evaluated = vr.runs.run_ensemble(
        run,
        arguments.output,
        cluster=arguments.cluster,
        threads=arguments.threads,
        # a bar on a terminal, else lines of text or nothing
        progress=sys.stderr.isatty()
        or (False if os.environ.get("VISCOROLL_QUIET") == "1" else "lines"),
    )
    if evaluated < run.blocks:
        print(f"blocks that were complete already: {run.blocks - evaluated} of {run.blocks}")
    results = vr.runs.open_run(arguments.output)
    print(as_text(results.to_pandas().reset_index(), str(results)), end="")


@command("verify", option("store", metavar="STORE.zarr", help="results of viscoroll ensemble"))
def verify(arguments: Namespace) -> int:
    """Check every file of a results store against its checksum (SHA-256).

    The exit code is 1 if a file differs or is missing, or the run is unfinished.
    It is 2 if the file records/start is missing or damaged.

    arguments: parsed command line with store, path of the folder of the results.
    Returns that code, True for 1, also for a run that is not finished.
    Raises FileError for a folder that is no store, or where the record of its start is damaged.
    """
    verdict = vr.runs.verify(arguments.store)
    print(f"{arguments.store}: {verdict}")
    return not verdict.ok  # True is exit code 1


@command(
    "sensitivity",
    _RUN,
    option(
        "-n",
        type=int,
        default=4096,
        help="number of base points, rounded up to a power of two (default: 4096); a base point "
        "takes a motion for every uncertain input and two more",
    ),
    add_table,
)
def sensitivity(arguments: Namespace) -> None:
    """Compute Sobol indices of the uncertain inputs of a run file.

    The table has first-order (S1) and total (ST) indices of the summarised quantities, with the half-width of the
    95 % confidence interval (S1_conf, ST_conf), sorted by ST.
    `viscoroll plot` draws the .nc file as bars, for the last time.

    example:
      viscoroll sensitivity run.toml -n 4096 -o sensitivity.nc

    arguments: parsed command line with
        run_file, path of a TOML file;
        n, number of base points in [16, 65536]; output, path of a .txt or .csv file to which the table, or of a .nc file to which
        the dataset of :func:`.sensitivity.sobol_indices` is written; or None: standard output;
        beside a file the table is printed as text too;
        format of standard output without a file, "text", "csv" or "json".
    Standard error has a progress bar if it is a terminal.  Motions beyond the model or the measured
    bands of the materials give a ModelWarning.
    Returns None.  The table has a row for each quantity, time and input that has indices, with the
    columns quantity, t with its unit as "t [s]" (missing if every quantity is one number for each
    motion), input, and the indices, dimensionless.  Quantities are in the order of the run file, times ascending, and at each
    time the largest ST is first.
    Raises ParameterError for values that are not allowed, as correlated inputs, and where no
    quantity has indices; FileError for a file that cannot be read or written;
    MissingDependencyError for a sample in .parquet without pyarrow.

    A heading, of text alone, has the numbers of base points and motions, the seed, the number of
    motions for each way in which they ended, and the reasons why a quantity has no indices.
    """  # noqa: E501
    from ..runs.sensitivity import sobol_indices, table

    run = vr.runs.read_run(arguments.run_file)
    indices = sobol_indices(run, arguments.n, progress=sys.stderr.isatty())
    frame = table(indices)
    about = indices.attrs
    base = about["base_points"]
    rounded = f" ({arguments.n}, rounded up to a power of two)" * (base != arguments.n)
    lines = [
        f"Sobol indices from {base} base points{rounded}, {about['motions']} motions, "
        f"seed {about['seed']}"
    ]
    lines += [
        f"{count} of {about['motions']} motions: {key.removeprefix('ended: ')}"
        for key, count in about.items()
        if key.startswith("ended: ")
    ]
    lines += [f"no indices for {reason}" for reason in about["refused"].splitlines()]
    heading = "\n".join(lines)
    deliver(arguments, indices, frame, heading)
    if arguments.output is not None:
        print(as_text(frame, heading), end="")


# --- Figures of the content of a file ---

#: The figure of a scene reaches from the speed of the first extremum of M divided by this number to
#: that of the last times it.
_MARGIN = 30.0


@command(
    "plot",
    option("what", metavar="WHAT", help="FILE.nc, SCENE.toml, MATERIAL.toml or STORE.zarr"),
    output(*FIGURES),
)
def plot(arguments: Namespace) -> None:
    """Draw a result file, a scene, a material, or the results of a run.

    For a netCDF file the command draws its result, for a scene file the contact law over speed, for a file with only
    a [material] moduli and relaxation, and for a results store the summaries.

    arguments: parsed command line with
        what, path of a .nc (result, table, material), a .toml (scene, cylinder, material) or a
        .zarr (results of a run);
        output, path of the figure that is written; its suffix is the format.
    Raises ParameterError for another suffix of what, and for content without a figure, as a single
    state; FileError for a file that cannot be read or written; MissingDependencyError for a .zarr
    without zarr.
    """  # noqa: E501
    from ..core.plots import save

    kinds = {
        ".zarr": lambda path: vr.runs.open_run(path).plot(),
        ".nc": _figure_of_netcdf,
        ".toml": _figure_of_toml,
    }
    path = arguments.what
    if (draw := kinds.get(Path(path).suffix.lower())) is None:
        allowed = "FILE.nc, SCENE.toml, MATERIAL.toml or STORE.zarr"
        sentence = f"{path!r} is not a file that can be plotted: give {allowed}"
        raise vr.ParameterError("plot", path, allowed, sentence)
    save(draw(path), arguments.output)


def _figure_of_netcdf(path: str) -> Any:
    """Return the matplotlib figure of the content of a netCDF file.

    Of a material, with an attribute ``schema``, it shows the moduli; of many motions, with a
    dimension ``motion``, a summary; else the result itself.

    path: path of a netCDF-4 file; one of netCDF-3 counts as no netCDF file.
    Raises FileError for a file that does not exist, cannot be read, or is no netCDF-4, also for a
    material that is damaged, as one whose SHA-256 does not fit, and for what looks like a result
    but lacks a variable or an attribute; ParameterError for a dataset that is no result, or has a
    single state.
    """
    import xarray as xr

    from ..core.plots import draw
    from ..motion import drawn_summary

    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
            if "schema" in data.attrs:
                return vr.Material.from_netcdf(path).plot()
            return draw(drawn_summary(data.load()) if "motion" in data.dims else data)
    except OSError as error:
        if not Path(path).is_file():
            raise vr.FileError(path, "the file does not exist") from error
        problem = (
            "is damaged or is not a netCDF-4 file"
            if os.access(path, os.R_OK)
            else "cannot be read (Permission denied)"
        )
        raise vr.FileError(path, problem) from error
    except vr.ParameterError:  # a ValueError too, but no sign of an incomplete result
        raise
    except (AttributeError, KeyError, ValueError) as error:
        reason = f"is not a complete result of viscoroll ({' '.join(str(error).split()):.100})"
        raise vr.FileError(
            path, f"{reason}: give another file, or write this one again with viscoroll"
        ) from error


def _figure_of_toml(path: str) -> Any:
    """Return the matplotlib figure of what a TOML file describes.

    Of a scene or cylinder it is the contact in free rolling at 301 speeds, from a thirtieth of the
    speed of the first extremum of M to thirty times that of the last; where M has no extremum, as
    of elastic bodies, from a thirtieth of the unit of speed (R/T_ref, 1 of a scene) to thirty times
    it.  Of a file without them it is the material, else the base.

    path: path of a TOML file with [scene], [cylinder], preset, [material] or [base].
    Raises FileError for a file that cannot be read or has none of these, or a value that is not
    allowed; ParameterError for a layer too thin for its law.
    """
    import numpy as np

    from ..core import read_toml
    from ..materials import read_materials
    from ..presets import SCENES, read_roller

    if not read_toml(path).keys() & set(SCENES):
        return next(iter(read_materials(path).values())).plot()
    roller = read_roller(path)
    extrema = roller.resistance_extrema().V
    # extrema ascend in speed; without any both ends are the unit of speed
    low, high = (extrema[0], extrema[-1]) if extrema.size else (roller.scale["V"],) * 2
    return roller.contact(np.geomspace(low / _MARGIN, high * _MARGIN, 301), delta=0.0).plot()
