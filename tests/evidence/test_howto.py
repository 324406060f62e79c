"""Pages of the documentation that take long or are many."""

import re
import shlex
from pathlib import Path

import pytest
import tolerances as tol
from closeness import close
from experiments import BRAKE, DRAG, TRUTH
from pages import blocks, run_page
from places import ROOT

from viscoroll import cli

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")


@pytest.mark.usefixtures("two_speeds", "here")
@pytest.mark.parametrize("page", sorted(path.stem for path in (ROOT / "docs/howto").glob("*.md")))
def test_howto_runs(page):
    session = run_page(f"howto/{page}")
    assert page != "files" or Path("motion.nc").exists()
    if page == "law":  # the integral part removes the steady-state error
        assert close(session["controlled_V"], session["target"], tol.EXAMPLE_RADAU)


def test_the_page_of_measurements_runs(here, capsys):
    """And finds the truth by which its data were made, in any folder."""
    session = {}
    codes = [
        code
        for page in ("identify", "identify_design")
        for code in blocks(ROOT / f"docs/{page}.md", "python")
    ]
    for code in codes:
        shortened = code.replace("starts=2", "starts=1").replace("print(fit)", "print(repr(fit))")
        exec(compile(shortened, "identify", "exec"), session)
    bearing = {"brake": BRAKE, "drag": DRAG}
    for fit, truth in (
        ("launch", {name: TRUTH[name] for name in ("mu", "E")} | bearing),
        ("fit", TRUTH | bearing),
    ):
        for name, value in truth.items():
            assert abs(session[fit].values[name] - value) < 3.0 * session[fit].stderr[name], (
                fit,
                name,
            )
        assert not session[fit].misfit
    shown = capsys.readouterr().out
    assert "Identification, unknowns: 7, points: 240" in shown
    assert "planned (not measured): the standard deviations are those to expect if the" in shown


def test_run_file_pages_can_be_followed(here, capsys):
    """Every command and snippet in its order; the sample files are made as small as a test."""
    for page in (ROOT / "docs/ensembles.md", ROOT / "docs/sensitivity.md"):
        for language, code in re.findall(
            r"^```(sh|python)\n(.*?)^```$", page.read_text(), re.S | re.M
        ):
            if language == "python":
                exec(compile(code.replace("n=4096", "n=16"), page.name, "exec"), {})
                continue
            for line in code.splitlines():
                command, *words = shlex.split(line, comments=True)
                if words == ["samples"] and Path("samples").exists():  # which are smaller now
                    continue
                if command == "viscoroll" and "--cluster" not in words:
                    assert cli.main(words + ["-n", "16"] * (words[0] == "sensitivity")) == 0, line
                for file in Path("samples").iterdir() if words == ["samples"] else ():
                    file.write_text(file.read_text().replace("n = 20_000", "n = 64"))
    assert "mm" in capsys.readouterr().out
    made = {path.name for path in here.iterdir()}
    names = "samples results.zarr results.png results.nc sensitivity.png sensitivity.nc"
    assert made == set(names.split())
