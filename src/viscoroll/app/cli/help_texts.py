"""Help of each command, as ``viscoroll COMMAND --help`` prints it.

The first sentence is the line of the command in ``viscoroll --help``; an example follows the text.
"""

#: Words of a command -> its help.
HELP = {
    "contact": """\
State of the contact: lam, epsilon, delta_star, beta, Q, M.

For every pair of V and delta (or omega), each a number, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or several of
these with commas between.

example:
  viscoroll contact paper-section-5 --V 0.5,1 --delta -0.04:0.04:5""",
    "stress": """\
Pressure and shear stress along the contact.

At 101 positions along the contact, at one V and delta (or omega).

example:
  viscoroll stress paper-section-5 --V 0.5 --delta -0.01""",
    "roll": """\
One motion from given start speeds.

Free motion of the cylinder from (V0, omega0), Eq. (22), through all regimes of slip.
For driven, braked and unsteady motions take vr.roll in Python, or a run file (viscoroll ensemble).

example:
  viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 0:3e-3:7""",
    "steady": """\
Steady rolling under force, torque or slope.

Prints a row for every equilibrium of rolling under each load; if there is none, the reason.
Options are numbers, as of `viscoroll contact`, all of one length or single.

example:
  viscoroll steady paper-section-5-rounded --slope 0:0.1:6""",
    "validity": """\
Validity of the model's assumptions at a speed.

A line for each assumption of the model: whether it holds (yes, no, ?: not known) and why.

example:
  viscoroll validity rubber-roller --V 5 --omega 4.9""",
    "ensemble": """\
Many motions with random starts and parameters, by a run file.

Rolls the motions that the store lacks, and summarises all of them.  The same command completes an interrupted run,
and extends the store of a run whose file now has a larger n.
Without -o it prints size, memory and time of the run.

example:
  viscoroll ensemble docs/examples/ensemble.toml""",
    "verify": """\
Check of every file of a store against its SHA-256.

Exit code 1 if a file differs or is missing.""",
    "sensitivity": """\
Sobol indices of the uncertain inputs of a run file.

First-order (S1) and total (ST) indices of the summarised quantities, each with the half-width of its 95 %
confidence interval (S1_conf, ST_conf), the largest total first.  `viscoroll plot` draws the .nc as bars.

example:
  viscoroll sensitivity run.toml -n 4096 -o sensitivity.nc""",
    "material show": """\
Moduli, relaxation modes and creep modes.

Of each material of the file, at the temperature that the file states.

example:
  viscoroll material show docs/examples/rubber.toml""",
    "material fit": """\
Fit of a material to the master curve of a DMA.

Fits a Prony series to columns of frequency, storage modulus and loss modulus, with units in their heading; prints
how well the data determine it; with -o writes it as a section [material] of a TOML file, or as netCDF.

A fit that misses --misfit, or has an error above 5 %, ends with exit code 1 and writes no file.  With --force the
file is written, and the source of the data in it states the misfit.

example:
  viscoroll material fit src/viscoroll/datasets/dma.csv --nu 0.49 -o rubber.toml""",
    "identify": """\
Friction, modulus, times, strengths and bearing from measurements.

Fits unknown parameters of a cylinder to measured rolling resistance, traction and motions, and states which of
them the data do not determine.  The file has [cylinder], perhaps [material] and [base], and
  [unknown]  NAME = [LOW, HIGH], with the start of the cylinder between
  [prior]    NAME = [VALUE, SD]
  [[data]]   kind = resistance, traction or coastdown; file = a CSV whose columns are named as V, M, delta,
             Q, t, omega, x, or by columns = { M = NAME }; sigma, load, temperature, name; V0, omega0, t0, m

example:
  viscoroll identify docs/examples/measured.toml --plot fit.png""",
    "tables law": """\
File of the law of a material, pair or cover, or of every alpha.

For vr.load_law, run files and every program that reads netCDF (.nc; .cdf without HDF5); as table and evaluator in
one header of C99 or C++ (.h); or as .json.  --alpha writes the law of every alpha of one relaxation time.

example:
  viscoroll tables law docs/examples/rubber.toml -o rubber.h""",
    "tables build": """\
Grid over V, delta and perhaps alpha, for programs that look up tables.

The contact of a scene, or of a cylinder in SI units, as .nc, .cdf (without HDF5), .csv, .txt (for Modelica) or
.mat (MATLAB).  Axes are numbers, as of `viscoroll contact`.

example:
  viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc""",
    "tables info": """\
Content of a table file: functions or grid, stated errors, material and provenance.

example:
  viscoroll tables info data/tables/rubber.nc""",
    "tables validate": """\
Check of a law file against the formulas of its relaxation modes at random speeds, or of a grid against the law.

Exit code 1 if an error is larger than the file states.

example:
  viscoroll tables validate data/tables/rubber.nc""",
    "export": """\
Results of a run, or a table, as a file for other programs.

The summaries of STORE.zarr, and all motions that it keeps, as .nc; a law as .nc, .cdf, .h or .json; a grid as .nc,
.cdf, .csv, .txt or .mat.

example:
  viscoroll export data/tables/rubber.nc -o rubber.h""",
    "fmu": """\
Cylinder as an FMU, for Modelica tools and others.

With the law of a material, pair or cover, and its sources, compiled for this machine by cc.
Roller: drive force and torque -> v, omega, x; co-simulation and model exchange.
ContactElement: v, omega, load -> force, torque, moments; model exchange.  Both have exact slopes.

example:
  viscoroll fmu docs/examples/rubber.toml -o roller.fmu""",
    "plot": """\
Figure of a result, a scene, a material, or the results of a run.

The result in a netCDF file of this program; the contact law over speed of a scene file; moduli and relaxation of
the [material] of a file without a scene; or the summaries of a store.""",
    "warmup": """\
Compilation of all functions that first calls would otherwise compile.

Compiles the kernels of every public function into the cache, once for a machine and a version of the package; quick
if they are there.

example:
  viscoroll warmup""",
    "doctor": """\
Versions, cache, threads, compiled functions and missing packages.

Send its output with the report of a problem.  Exit code 1 if a required package is missing.

example:
  viscoroll doctor""",
}
