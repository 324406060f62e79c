"""The readers of docs/loading in their own programs, and the headers of C, against the package."""

import shutil
import subprocess
import sys
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from places import ROOT

import viscoroll as vr
from viscoroll import tables
from viscoroll.presets import read_law_source

LOADING = ROOT / "docs/loading"
HEADERS = ROOT / "src/viscoroll/tables/c"
RUBBER = vr.Prony([0.3, 0.6, 1.5], [2e-2, 1e-3, 1e-5])
PAIR = vr.Bodies(vr.Prony([10.0], [1.0]), RUBBER, 0.3)
FIELDS = ("lam", "epsilon", "delta_star", "beta", "Q", "M", "M_half_space", "M_cylinder", "N")
#: A language -> a program that prints the fields of every state, what runs it, and what succeeds
#: where it can run.
PROGRAMS = {
    "python": (
        "for x in np.loadtxt('states.csv', delimiter=','):\n"
        "    print(','.join(repr(float(value)) for value in contact(*x).values()))\n",
        "{ echo 'import numpy as np; from read_law import read_law; contact = "
        'read_law("law.nc")\'; cat program; }'
        f" | '{sys.executable}' -",
        "true",
    ),
    "octave": (
        """\
contact = read_law('law.nc'); x = csvread('states.csv');
for n = 1:rows(x)
  s = contact(x(n, 1), x(n, 2), x(n, 3), x(n, 4));
  printf('%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\\n', struct2cell(s){:});
end
""",
        "octave-cli program",
        "octave-cli --eval 'pkg load netcdf'",
    ),
    "R": (
        """\
source("read_law.R"); contact <- read_law("law.nc"); x <- read.csv("states.csv", header = FALSE)
for (n in seq_len(nrow(x))) {
  s <- contact(x[n, 1], x[n, 2], x[n, 3], x[n, 4])
  cat(sprintf("%.17g", unlist(s)), sep = ","); cat("\\n")
}
""",
        "Rscript program",
        "Rscript -e 'library(ncdf4)'",
    ),
    "node": (
        """\
const fs = require("fs"), law = require("./read_law.js");
const contact = law(JSON.parse(fs.readFileSync("law.json")));
for (const line of fs.readFileSync("states.csv", "utf8").trim().split("\\n"))
  console.log(Object.values(contact(...line.split(",").map(Number))).join(","));
""",
        "mv program program.js && node program.js",
        "command -v node",
    ),
    "fortran": (
        """\
program states
  use read_law_file
  implicit none
  type(law) :: a
  real(8) :: x(4)
  integer :: end
  a = read_law('law.nc')
  open (1, file='states.csv')
  do
    read (1, *, iostat=end) x
    if (end /= 0) exit
    print '(8(es25.17e3, ","), es25.17e3)', contact(a, x(1), x(2), x(3), x(4))
  end do
end program
""",
        "mv program program.f90 && gfortran -O2 -Wall read_law.f90 program.f90 -o program "
        "$(nf-config --fflags --flibs)"
        " && ./program",
        "command -v gfortran && command -v nf-config",
    ),
}
_C = """#include <stdio.h>
{include}
int main(void) {{
  double x[4];
  vr_law law;
  {open}
  while (scanf("%lf,%lf,%lf,%lf", x, x + 1, x + 2, x + 3) == 4) {{
    vr_state s = vr_contact(&law, x[0], x[1], x[2], x[3]), t;
    vr_slopes d;
    vr_contact_slopes(&law, x[0], x[1], x[2], x[3], &t, &d);
    if (s.Q == s.Q && (t.Q != s.Q || t.M != s.M || t.beta != s.beta)) return 3;
    printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", s.lam, s.epsilon, s.delta_star, s.beta, s.Q,
           s.M, s.M_half_space, s.M_cylinder, s.N);
    printf(",%.17g,%.17g,%.17g,%.17g,%.17g\\n", d.dQ_dV, d.dQ_domega, d.dM_dV, d.dM_half_space_dV, d.dM_cylinder_dV);
  }}
  return 0;
}}
"""  # noqa: E501
SLOPES = ("dQ_dV", "dQ_domega", "dM_dV", "dM_half_space_dV", "dM_cylinder_dV")
_STRICT = "-O2 -Wall -Wextra -Werror -pedantic"
_OF_HEADER = _C.format(include='#include "rubber.h"', open="law = rubber;")
PROGRAMS |= {
    "c": (
        _OF_HEADER,
        f"cc -std=c99 {_STRICT} -x c program -o run -lm && ./run < states.csv",
        "command -v cc",
    ),
    "c++": (
        _OF_HEADER,
        f"c++ -std=c++11 {_STRICT} -x c++ program -o run -lm && ./run < states.csv",
        "command -v c++",
    ),
    "c-netcdf": (
        _C.format(
            include='#include "vr_law_netcdf.h"', open='if (vr_law_open("law.nc", &law)) return 2;'
        ),
        f"cc -std=c99 {_STRICT} -x c program -x none -o run $(nc-config --cflags --libs) -lm"
        " && ./run < states.csv",
        "command -v cc && command -v nc-config",
    ),
}
in_each_language = pytest.mark.parametrize("name", PROGRAMS)


shell = partial(subprocess.run, shell=True, capture_output=True, text=True, check=False)


def output(command, folder=None):
    """What a command of the shell prints that must succeed."""
    done = shell(command, cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@cache
def succeeds(command):
    return not shell(command).returncode


def need(command):
    """Skip where a command fails: what it asks for is not installed."""
    if not succeeds(command):
        pytest.skip(f"not installed (make interop): {command}")


NIP = vr.Cover(
    RUBBER,
    nu=0.45,
    thickness=0.5,
    on="base",
    part=0.6,
    other=RUBBER,
    other_nu=0.3,
    other_thickness=0.8,
)
LINING = vr.Cover(1.0, nu=0.5, thickness=1.0)


law_of = cache(tables.law)  # that of a cover takes seconds


def folder_of(material, place):
    """The readers, the headers of C, and a law in every format."""
    law = law_of(material)
    for path in (*LOADING.glob("read_law.*"), *HEADERS.glob("*.h")):
        shutil.copy(path, place)
    for name in ("law.json", "rubber.h"):
        tables.export(law, place / name)
    tables.save(law, place / "law.nc")
    return place


@pytest.fixture(scope="module", params=[RUBBER, PAIR])
def folder(request, tmp_path_factory):
    """A folder of a law of half-spaces, and states of it."""
    return folder_of(request.param, tmp_path_factory.mktemp("law")), states(request.param)


def states(material):
    """kappa, mu, V and slip: any speed from far below the slowest time to far beyond the fastest,
    any creep, rest.
    """
    random = np.random.default_rng(8)
    count = 400
    kappa = 10.0 ** random.uniform(0.0, 2.0, count)
    mu = 10.0 ** random.uniform(-3.0, 0.0, count)
    V = 10.0 ** random.uniform(-8.0, 12.0, count) / kappa * random.choice([-1.0, 1.0], count)
    scene = vr.Scene(kappa=kappa, mu=mu, material=material, coupled=False)
    star = scene.contact(V, delta=0.0).delta_star
    share = np.where(
        random.random(count) < 0.5,
        10.0 ** random.uniform(-12.0, -0.1, count),
        random.uniform(0, 1.3, count),
    )
    # there beta has no digits but those of its condition
    share[abs(share - 1.0) < 1e-3] = 0.5
    slip = share * star * V * random.choice([-1.0, 1.0], count)
    V[:3] = 0.0
    slip[:4] = (0.0, 0.1, -0.1, 0.0)
    return np.column_stack([kappa, mu, V, V + slip - V])  # omega is a double


#: no states, of which every field is NaN: kappa, mu, V, slip
NO_STATES = """\
nan,0.3,0.1,0.01
10,nan,0.1,0.01
10,0.3,nan,0.01
10,0.3,0.1,nan
10,0.3,inf,0.01
10,0.3,0.1,-inf
10,0.3,nan,-0.01
-10,0.3,0.1,0.01
10,0,0.1,0.01
10,0.3,-1e300,0.01
"""


#: A language -> how it reads NaN and infinity, where not as "nan" and "inf".
SPELLED = {"node": ("NaN", "Infinity"), "R": ("NaN", "Inf")}


def told_by(name, folder, states):
    """What the program of a language prints of states, a row each."""
    program, command, needed = PROGRAMS[name]
    need(needed)
    (folder / "program").write_text(program)
    (folder / "states.csv").write_text(states)
    return np.loadtxt(output(command, folder).splitlines(), delimiter=",")


def as_text(states):
    """A file of states, each of four numbers."""
    return "".join("{:.17g},{:.17g},{:.17g},{:.17g}\n".format(*state) for state in states)


def assert_columns(found, exact, rel, **scales):
    """The first columns are these fields, in their order."""
    for n, (field, values) in enumerate(exact.items()):
        assert close(found[:, n], values, rel, scale=scales.get(field, 0.0), what=field)


@in_each_language
@pytest.mark.parametrize("material", [NIP, LINING])
def test_programs_have_the_contact_of_covers(name, material, tmp_path):
    """Where shear acts back, at rest too, also at V = -0."""
    kappa, mu, V, slip = states(material).T
    scene = vr.Scene(kappa=kappa, mu=mu, material=material, coupled=False)
    slip = slip + V * scene.contact(V, delta=0.0).delta_0
    V[1:5] = -0.0
    slip[3:5] = 0.0
    found = told_by(name, folder_of(material, tmp_path), as_text(zip(kappa, mu, V, slip)))
    exact = scene.contact(V, omega=V + slip, fields=FIELDS[:-1])
    scales = {"beta": 1.0, "Q": mu, "epsilon": 1.0} | dict.fromkeys(FIELDS[5:8], mu / kappa)
    assert_columns(found, exact.as_dict(), tol.INTEROP_OF_COVERS, **scales)


@in_each_language
def test_programs_have_the_contact_of_the_package(folder, name):
    """And NaN for what is no state.  Also the sign of a NaN is none: Q was +mu for a NaN speed."""
    place, given = folder
    nan, infinity = SPELLED.get(name, ("nan", "inf"))
    no_states = NO_STATES.replace("nan", nan).replace("inf", infinity)
    found = told_by(name, place, as_text(given) + no_states)
    assert len(found) == len(given) + NO_STATES.count("\n")
    assert np.isnan(found[len(given) :]).all()
    kappa, mu, V, slip = given.T
    scene = vr.Scene(kappa=kappa, mu=mu, material=vr.load_law(place / "law.nc"))
    exact = scene.contact(V, omega=V + slip, fields=(*FIELDS, *SLOPES))
    values = {field: exact[field] for field in FIELDS}
    scales = {"M_half_space": exact.M, "M_cylinder": exact.M, "N": abs(exact.N).max()}
    assert_columns(found[: len(given)], values, tol.INTEROP, **scales)
    if name.startswith("c"):
        slopes = {field: exact[field][3:] for field in SLOPES}  # those that roll
        scales = dict.fromkeys(SLOPES[2:], exact.M[3:] / V[3:]) | {"dQ_dV": slopes["dQ_domega"]}
        rolling = found[3 : len(given), len(FIELDS) :]
        assert_columns(rolling, slopes, tol.INTEROP_SLOPES, **scales)


#: motions: V and slip at the start, force and torque; a throw, and drives that pass through rest or
#: start from it
ROLLED = {
    "thrown": (0.5, -0.3, 0.0, 0.0),
    "pulled back": (0.3, 0.0, -0.05, 0.0),
    "turned back": (-0.4, 1.0, 0.0, -0.03),
    "from rest": (0.0, 0.0, 0.0, 0.05),
}


@pytest.fixture(scope="module")
def roller(tmp_path_factory):
    """A function of gamma, force, torque, rest, V, slip, time, calls and rtol, by a program of
    vr_roll.h, for the law of the paper or of a cover: the worst status of a call, and V, omega, x
    at the end.
    """
    need("command -v cc")
    place = tmp_path_factory.mktemp("roll")
    shutil.copy(HEADERS / "vr_roll.h", place)
    program = """\
#include <stdio.h>
#include <stdlib.h>
#include "paper.h"
#include "vr_roll.h"
int main(int count, char **text) {
  double a[9];
  long n, calls;
  int worst = 0;
  for (n = 1; n < count && n < 10; n++) a[n - 1] = atof(text[n]);
  vr_roller r = {&paper, 10.0, 0.3, a[0], 0.5, a[1], a[2], a[3], a[4], a[5], 0.0, 0.0, 0, 0};
  calls = (long)a[7];
  for (n = 0; n < calls; n++) { int e = vr_roll(&r, a[6] / calls, a[8]); if (e > worst) worst = e; }
  printf("%d %.17g %.17g %.17g\\n", worst, r.V, r.V + r.slip, r.x);
  return 0;
}
"""
    for name, law in (("paper", law_of(11.0)), ("cover", law_of(LINING))):
        tables.export(law, place / f"{name}.h")
        (place / "roll.c").write_text(program.replace("paper", name))
        output(f"cc -std=c99 {_STRICT} roll.c -o {name} -lm", place)

    def rolled(*numbers, law="paper"):
        told = output(f"{place / law} {' '.join(map(repr, numbers))}")
        return [float(word) for word in told.split()]

    return rolled


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # slow rolling is unsteady
@pytest.mark.parametrize("rest", [0.0, 1e-9, 1e-6])
@pytest.mark.parametrize("calls", [1, 40, 40_000])
@pytest.mark.parametrize("name", ROLLED)
def test_a_roller_of_c_in_steps_of_any_length(roller, name, calls, rest):
    """40 units of time in one call or in calls of 1e-3: a drive that turned the roller stopped it
    there for good.
    """
    V, slip, force, torque = ROLLED[name]
    gamma = 0.5
    end = 40.0
    status, *found = roller(gamma, force, torque, rest, V, slip, end, calls, 1e-9)
    loads = {"force": force or None, "torque": torque or None}
    motion = vr.Scene(11.0, 10.0, 0.3, gamma).roll(V, V + slip, [end], rtol=1e-11, **loads)
    exact = np.array([motion.V[0], motion.omega[0], motion.x[0]])
    assert status == 0
    assert close(np.array(found), exact, tol.INTEROP_TURNED, scale=abs(exact).max())


def test_a_roller_of_c_on_a_cover_has_a_mirror_image(roller):
    """Its onsets of full slip differ for traction along V and against it, also for V < 0."""
    there, back = (
        roller(0.5, -0.02 * side, -0.05 * side, 0.0, side, -0.01 * side, 3.0, 1, 1e-9, law="cover")
        for side in (1.0, -1.0)
    )
    assert close(-np.array(back), np.array(there), tol.INTEROP_OF_COVERS)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("place", range(9))
def test_a_roller_of_c_refuses_what_is_no_number(roller, place, bad):
    """Status 2, and a state as it was, whatever is NaN or infinite; a time or tolerance below 0
    too.
    """
    numbers = [0.5, 0.01, 0.0, 1e-6, 0.5, -0.3, 1.0, 1, 1e-8]
    if place != 7:  # number of calls
        numbers[place] = bad
        status, *_, x = roller(*numbers)
        assert (status, x) == (2, 0.0)
    if place in (0, 6, 8):
        numbers[place] = -1.0
        assert roller(*numbers) == [2, 0.5, 0.2, 0.0]


@pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # compared is the integrator, not its validity
def test_the_roller_of_the_page(tmp_path):
    """The program of docs/loading/README.md against roll, for the pair of its file."""
    need("command -v cc")
    roller = read_law_source(vr.datasets.path("rubber.toml"))
    tables.export(tables.law(roller), tmp_path / "rubber.h")
    shutil.copy(HEADERS / "vr_roll.h", tmp_path)
    page = (LOADING / "README.md").read_text().split("## Motions in C")[1]
    (tmp_path / "roll.c").write_text(page.split("```c\n")[1].split("```")[0])
    printed = output(f"cc -std=c99 {_STRICT} roll.c -o roll -lm && ./roll", tmp_path)
    speed, distance = (float(part.split()[0]) for part in printed.split(","))
    m = roller.replace(R=0.1, m=35.5, mu=0.3, load=348.0).roll(2.0, 0.0, 1.0)
    assert close(speed, m.V[-1], tol.RIGID_STEEL)
    assert close(distance, m.x[-1], tol.RIGID_STEEL)


@pytest.mark.parametrize("kind", ["law", "grid"])
def test_cf_checker_finds_nothing(tmp_path, kind):
    checker = Path(sys.executable).with_name("compliance-checker")
    need(f"test -x '{checker}'")
    path = tmp_path / f"{kind}.nc"
    law = tables.law(PAIR)
    tables.save(
        law if kind == "law" else tables.build(law, V=[0.1, 1.0], delta=[0.0, 0.1, 0.2]), path
    )
    command = f"HOME='{tmp_path}' '{checker}' --test cf:1.11 --criteria strict '{path}'"
    assert "All tests passed!" in output(command, tmp_path)
