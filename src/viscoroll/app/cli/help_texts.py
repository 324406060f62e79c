"""Help of each command, as ``viscoroll COMMAND --help`` prints it.

The first sentence is the line of the command in ``viscoroll --help``; an example follows the text.
"""

#: Words of a command -> its help.
HELP = {
    "contact": """\
Compute the contact at constant speed: lam, epsilon, delta_star, beta, Q, M.

The result has a row for every pair of V and delta (or omega).  Each option is a number, LOW:HIGH:COUNT,
LOW:HIGH:COUNT:log, or several of these, separated by commas.

example:
  viscoroll contact paper-section-5 --V 0.5,1 --delta -0.04:0.04:5""",
    "stress": """\
Compute pressure and shear stress along the contact.

The stresses are given at 101 points of the contact, for one V and one delta (or omega).

example:
  viscoroll stress paper-section-5 --V 0.5 --delta -0.01""",
    "roll": """\
Integrate one free motion from given initial speeds.

The motion obeys Eq. (22), and may change between full slip and partial slip.
For driven, braked and unsteady motions use vr.roll in Python, or a run file (viscoroll ensemble).

example:
  viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 0:3e-3:7""",
    "steady": """\
Find the steady speeds under force, torque or slope.

Each equilibrium of each load is a row.  If a load has no equilibrium, the reason is printed.
Options are written as the numbers of `viscoroll contact`: single numbers, or lists of equal length.

example:
  viscoroll steady paper-section-5-rounded --slope 0:0.1:6""",
    "heat": """\
Find the temperatures at which a cylinder runs.

Each equilibrium of loss and heat given off is a row; unstable ones lie between two stable ones.
The [material] needs wlf or arrhenius.  Options are written as the numbers of `viscoroll contact`.

example:
  viscoroll samples
  viscoroll heat samples/rubber.toml --V 0.5:4:8 --ambient 20 --conductance 2.5""",
    "validity": """\
Check the assumptions of the model at one speed.

Each line has the name of an assumption, whether it holds (yes, no, or ? if data are missing), and the reason.

example:
  viscoroll validity rubber-roller --V 5 --omega 4.9""",
    "ensemble": """\
Compute the motions of a run file with random initial speeds and parameters.

The command computes the motions that the store does not contain yet, and summarises all motions.
Call it again to complete an interrupted run, or to extend the store after n was raised in the run file.
Without -o it prints the estimated size, memory and time of the run.

example:
  viscoroll samples
  viscoroll ensemble samples/ensemble.toml""",
    "verify": """\
Check every file of a results store against its SHA-256.

The exit code is 1 if a file differs or is missing.""",
    "sensitivity": """\
Compute Sobol indices of the uncertain inputs of a run file.

The table has first-order (S1) and total (ST) indices of the summarised quantities, with the half-width of the
95 % confidence interval (S1_conf, ST_conf), sorted by ST.  `viscoroll plot` draws the .nc file as bars.

example:
  viscoroll sensitivity run.toml -n 4096 -o sensitivity.nc""",
    "material show": """\
Print moduli, relaxation modes and creep modes of the materials of a file.

The values are those at the temperature that the file states.

example:
  viscoroll samples
  viscoroll material show samples/rubber.toml""",
    "material fit": """\
Fit a material to DMA data.

The command fits a Prony series to columns of frequency, storage modulus and loss modulus, with units in their
headings, and prints how well the data determine it.  With -o it writes a [material] of a TOML file, or netCDF.

The exit code is 1 and no file is written if the misfit exceeds --misfit, or if it exceeds 5 % with any --misfit.
With --force the exit code is 0 and the file is written; the source of the data in it states the misfit.

example:
  viscoroll samples
  viscoroll material fit samples/dma.csv --nu 0.49 -o rubber.toml""",
    "identify": """\
Identify friction, modulus, relaxation times and moduli, and bearing friction, from measurements.

The command fits unknown parameters of a cylinder to measured rolling resistance, traction and motions, and states
which of them the data do not determine.  The file has [cylinder], perhaps [material] and [base], and
  [unknown]  NAME = [LOW, HIGH]: bounds; [cylinder] has the initial guess
  [prior]    NAME = [VALUE, SD]
  [[data]]   kind = resistance, traction or coastdown; file = a CSV whose columns are named as V, M, delta,
             Q, t, omega, x, or by columns = { M = NAME }; sigma, load, temperature, name; V0, omega0, t0, m

example:
  viscoroll samples
  viscoroll identify samples/measured.toml --plot fit.png""",
    "tables law": """\
Write the contact law of a material, pair, cover or range of alpha to a file.

.nc is read by vr.load_law, run files and every netCDF reader; .cdf is the same without HDF5; .h is a header of C99
or C++ with table and evaluator; .json is for JavaScript.  --alpha writes the law of one relaxation time for
every alpha of a range.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.h""",
    "tables build": """\
Write a grid of the contact law on axes V, delta (and alpha) for look-up in other programs.

The grid of a scene is dimensionless, the grid of a cylinder is in SI units.  Formats: .nc, .cdf (without HDF5),
.csv, .txt (for Modelica) and .mat (MATLAB).  Axes are written as the numbers of `viscoroll contact`.

example:
  viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc""",
    "tables grid": """\
Write the coupled solution of a roller over speed and creep as a law, for one mu and one thickness over l0.

Pressure and shear are solved together.  The file is loaded by vr.load_law, as the material of the roller, and states
the largest errors beside its nodes.  Formats: .nc and .cdf (without HDF5).

example:
  viscoroll samples
  viscoroll tables grid samples/rubber.toml --method coupled -o rubber.nc""",
    "tables info": """\
Print the contents of a table file: functions or grid, stated errors, material and provenance.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.nc
  viscoroll tables info rubber.nc""",
    "tables validate": """\
Compare a law file with the formulas of its relaxation modes at random speeds, or a grid with the law.

The exit code is 1 if an error is larger than twice the one that the file states, or than half of the largest value
of a field of a grid.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.nc
  viscoroll tables validate rubber.nc""",
    "export": """\
Convert the results of a run, or a table, to another file format.

A results store (STORE.zarr) becomes .nc with summaries and stored motions.  A law becomes .nc, .cdf, .h or .json.
A grid becomes .nc, .cdf, .csv, .txt or .mat.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.nc
  viscoroll export rubber.nc -o rubber.h""",
    "fmu": """\
Build an FMU of a cylinder, for Modelica tools and others.

The FMU contains the law of a material, pair or cover and its C sources, compiled for this machine by cc.
Roller: inputs drive force and torque, outputs v, omega, x; for co-simulation and model exchange.
ContactElement: inputs v, omega, load, outputs force, torque, moments; for model exchange.
Both provide exact directional derivatives.

example:
  viscoroll samples
  viscoroll fmu samples/rubber.toml -o roller.fmu""",
    "plot": """\
Draw a result file, a scene, a material, or the results of a run.

For a netCDF file the command draws its result, for a scene file the contact law over speed, for a file with only
a [material] moduli and relaxation, and for a results store the summaries.""",
    "samples": """\
Copy the sample files of the documentation into a folder.

They are scene files, run files and measurements, which the examples of other commands read.

example:
  viscoroll samples
  viscoroll contact samples/rubber.toml --V 0.5 --delta 0.01""",
    "warmup": """\
Compile all kernels in advance, so that the first calls do not wait.

The compiled kernels go into the cache, once for each machine and version of the package.  If they are there
already, the command takes a second.

example:
  viscoroll warmup""",
    "doctor": """\
Report versions, cache, threads, compiled functions and missing packages.

Send this output with a report of a problem.  The exit code is 1 if a required package is missing.

example:
  viscoroll doctor""",
}
