"""Pages of the documentation that take long, and a command whose example does."""

import shlex

import pytest
import tolerances as tol
from closeness import close
from experiments import BRAKE, DRAG, TRUTH
from pages import LONG, blocks, run_page
from places import ROOT

from viscoroll.cli import main

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")


@pytest.mark.parametrize("page", sorted(LONG))
def test_howto_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = run_page(f"howto/{page}")
    if page == "law":  # the integral part removes the steady-state error
        assert close(session["controlled_V"], session["target"], tol.EXAMPLE_RADAU)


def test_the_page_of_measurements_runs(monkeypatch, capsys, tmp_path):
    """And finds the truth by which its data were made, in any folder."""
    monkeypatch.chdir(tmp_path)
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
    assert "Identification of 7 unknowns from 240 points" in shown
    assert "planned: expected standard deviations, if the cylinder has the true values" in shown


def test_example_of_a_coupled_grid_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["tables", "grid", "--help"]) == 0
    _, *examples = capsys.readouterr().out.split("\n  viscoroll ")
    for example in examples:
        assert main(shlex.split(example)) == 0
    assert (tmp_path / "rubber.nc").exists()
