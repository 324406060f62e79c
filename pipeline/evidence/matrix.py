"""The package as pip installs it: wheel and sdist, every Python, the newest and the lowest
dependencies.

    python -m pipeline.evidence.matrix            all of them; the whole suite once, on the newest Python
    python -m pipeline.evidence.matrix --quick    newest dependencies on the newest Python, from the wheel; README and
                                                  contact states alone

A case is a fresh environment outside the tree.  The newest dependencies come with the wheel, the
lowest, which the metadata declare for this Python, with the sdist.  There the program answers once,
and tests of the unpacked sdist run: the README, the how-to, a run file, contact states against
enclosures, motions
and a flow map.

Pythons are those of the classifiers: this one, pyenv's and those on the PATH, or those that
$PYTHONS names.  One that is not found is told, and is no failure.  Exit code 1 if a case fails.
"""  # noqa: E501

import os
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import zipfile
from concurrent.futures import ThreadPoolExecutor
from email import message_from_bytes
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

from packaging.requirements import Requirement

from ..stage import ROOT, said

#: what the tests below import beside the package and its extra
TOOLS = ("hypothesis", "mpmath", "pytest", "python-flint")
ASKED = ("roll", "paper-section-5", "--V0", "1.5", "--omega0", "0.5", "--t", "3e-3")
#: what a user does first, and numbers that another NumPy or numba would change
FIRST_STEPS = (
    "tests/docs/test_readme.py::test_readme_block_runs",
    "tests/test_claims.py::test_claims[contact]",
)
SAMPLE = (
    *FIRST_STEPS,
    "tests/docs/test_readme.py::test_howto_runs",
    "tests/docs/test_readme.py::test_run_file_pages_can_be_followed",
    "tests/test_claims.py::test_claims[check_motions]",
    "tests/motion/test_flow.py::test_as_the_integrator_to_its_stated_error",
)
SUITE = ("-n", "2")
_VERSION = "import sys, venv, ensurepip; print('%d.%d' % sys.version_info[:2])"


class Packages(NamedTuple):
    """What is tried: both packages, the tree of the unpacked sdist, and what the metadata
    require.
    """

    wheel: Path
    sdist: Path
    tree: Path
    required: list[Requirement]


class Case(NamedTuple):
    """A Python at ``python``, its ``lowest`` dependencies or the newest, and the ``tests`` to run,
    arguments of pytest.
    """

    version: str
    python: str
    lowest: bool
    tests: tuple[str, ...]

    def __str__(self) -> str:
        return f"Python {self.version}, {'lowest' if self.lowest else 'newest'} dependencies"


def main():
    parser = said(__doc__)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    found = pythons()
    if not found:
        return 1
    *_, (newest, python) = found.items()
    cases = [Case(newest, python, False, FIRST_STEPS if quick else SUITE)]
    if not quick:
        cases += [
            Case(*each, lowest, SAMPLE) for each, lowest in product(found.items(), (True, False))
        ]
        cases.pop()  # the newest Python with the newest dependencies, of which the suite is run
    with tempfile.TemporaryDirectory(prefix="viscoroll-matrix-") as folder:
        packages = built(Path(folder))
        with ThreadPoolExecutor(2) as pool:
            passed = list(pool.map(partial(tried, packages=packages, folder=Path(folder)), cases))
    print(f"matrix: {sum(passed)} of {len(cases)} cases passed", flush=True)
    return int(not all(passed))


def pythons() -> dict[str, str]:
    """Version -> where it lies, oldest first; tells of those that are not found."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    words = [each.rpartition(":: ")[2] for each in project["classifiers"] if "Python :: 3." in each]
    installed = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    places = [
        Path(sys.executable).parent,
        *sorted(installed.glob("*/bin"), reverse=True),
        os.environ["PATH"],
    ]
    found = {}
    for name in os.environ.get("PYTHONS", "").split() or [f"python{version}" for version in words]:
        path = shutil.which(name, path=os.pathsep.join(map(str, places))) or "false"
        done = subprocess.run([path, "-c", _VERSION], capture_output=True, text=True, check=False)
        if done.returncode:
            print(
                f"matrix: no {name} that makes environments was found: it is not tried", flush=True
            )
        else:
            found[done.stdout.strip()] = path
    return dict(sorted(found.items(), key=lambda each: int(each[0].partition(".")[2])))


def packed(folder: Path, *options: str) -> tuple[Path, Path, bytes]:
    """Wheel, made of the sdist, sdist, and the metadata."""
    subprocess.run(
        [sys.executable, "-m", "build", *options, "--outdir", folder, ROOT],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL if options else None,
        check=True,
    )
    (wheel,) = folder.glob("*.whl")
    (sdist,) = folder.glob("*.tar.gz")
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (each for each in archive.namelist() if each.endswith(".dist-info/METADATA"))
        return wheel, sdist, archive.read(name)


def built(folder: Path) -> Packages:
    """Both packages, the second unpacked."""
    wheel, sdist, found = packed(folder)
    shutil.unpack_archive(sdist, folder)
    required = [
        Requirement(line) for line in message_from_bytes(found).get_all("Requires-Dist", [])
    ]
    return Packages(wheel, sdist, folder / sdist.name.removesuffix(".tar.gz"), required)


def floors(required: list[Requirement], version: str) -> list[str]:
    """The lowest version of everything that the package and its extra `runs` declare for this
    Python.
    """
    here = {"python_version": version, "python_full_version": f"{version}.0", "extra": "runs"}
    return [
        f"{each.name}=={next(bound.version for bound in each.specifier if bound.operator == '>=')}"
        for each in required
        if each.marker is None or each.marker.evaluate(here)
    ]


def tried(case: Case, packages: Packages, folder: Path) -> bool:
    """Whether everything runs in an environment of this case; says what ran, and what failed."""
    begun = time.monotonic()
    place = folder / f"{case.version}-{'lowest' if case.lowest else 'newest'}"
    (place / "work").mkdir(parents=True)
    pins = floors(packages.required, case.version) if case.lowest else []
    (place / "constraints.txt").write_text("\n".join(pins) + "\n", encoding="utf-8")
    binaries = place / "env" / ("Scripts" if os.name == "nt" else "bin")
    python = str(binaries / "python")
    program = str(binaries / "viscoroll")
    extra = "dev" if case.tests is SUITE else "runs"
    package = f"{packages.sdist if case.lowest else packages.wheel}[{extra}]"
    pip = [
        python,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--no-compile",
    ]
    warnings = "filterwarnings=ignore::viscoroll.ModelWarning"
    quiet = f"-p no:cacheprovider -o {warnings} --disable-warnings --show-capture=no -rfE"
    test = [python, "-m", "pytest", *quiet.split(), "--rootdir", packages.tree]
    steps = {
        "environment": ([case.python, "-m", "venv", place / "env"], place),
        "installation": ([*pip, "-c", place / "constraints.txt", package, *TOOLS], place),
        "versions": ([python, "-m", "pip", "freeze"], place / "work"),
        "program": ([program, *ASKED], place / "work"),
        "tests": ([*test, *case.tests], packages.tree),
    }
    # without PYTHONDONTWRITEBYTECODE: pip compiles nothing ahead, so what is imported is to be kept
    dropped = ("PYTHONPATH", "VIRTUAL_ENV", "PYTHONDONTWRITEBYTECODE")
    environment = {name: value for name, value in os.environ.items() if name not in dropped}
    environment["VISCOROLL_CACHE_DIR"] = str(place / "cache")
    told = {}
    for name, (command, where) in steps.items():
        done = subprocess.run(
            command,
            cwd=where,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        if done.returncode:
            print(f"matrix: {case}: {name} failed\n{done.stdout[-4000:]}", flush=True)
            return False
        told[name] = done.stdout.splitlines()
    kind = "the whole suite" if case.tests is SUITE else "sample"
    print(
        f"matrix: {case} ({time.monotonic() - begun:.0f} s): {kind}: {told['tests'][-1]}",
        flush=True,
    )
    print(f"        {', '.join(told['versions'])}", flush=True)
    return True


if __name__ == "__main__":
    sys.exit(main())
