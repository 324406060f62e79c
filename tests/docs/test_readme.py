"""What the documentation says runs, points somewhere, and shows the numbers that were measured."""

import re

import pytest
import tolerances as tol
from calls import of_roller
from pages import blocks, run_page
from places import ROOT
from run_files import run_of

import viscoroll as vr
from viscoroll.fmu import MODELS

PAGES = [
    *ROOT.glob("*.md"),
    *(page for folder in ("docs", "data", "pipeline") for page in (ROOT / folder).rglob("*.md")),
]


def test_readme_block_runs(capsys):
    """Without a warning."""
    (code,) = blocks(ROOT / "README.md", "python")
    exec(compile(code, "README.md", "exec"), {})
    printed = capsys.readouterr().out
    assert "slides for 0.04 s, then rolls to 2.8 m" in printed
    assert (
        "the error of its computed V is below 1 % down to 0.1 m/s, below 10 % down to 0.028 m/s"
        in printed
    )


@pytest.mark.parametrize("model", MODELS)
def test_variables_of_fmus_are_listed(model):
    """Every variable of a model in order, with its start and unit, as in its
    modelDescription.xml.
    """
    rows = [
        f"| `{v.name}` | {v.causality} | {v.unit} | {'' if v.start is None else f'{v.start:g}'} | "
        f"{v.text} |"
        for v in MODELS[model].variables
    ]
    head = f"| `{model}` | causality | unit | start | meaning |\n| --- | --- | --- | --- | --- |\n"
    assert head + "\n".join(rows) + "\n\n" in (ROOT / "docs/loading/fmu_variables.md").read_text()


@pytest.mark.parametrize("page", ["index", "validity"])
def test_first_pages_run(page, capsys):
    run_page(page)
    assert "small_contact  yes " in capsys.readouterr().out


@pytest.mark.usefixtures("here")
@pytest.mark.long
def test_offline_and_runtime(capsys):
    run_page("offline_runtime")
    worst, way = map(float, capsys.readouterr().out.split())
    assert worst < tol.LAW_STATED
    assert way == vr.presets.RUBBER_CYLINDER.roll(2.0, 0.0, 40.0).x[-1]


def test_relative_links_exist():
    for page in PAGES:
        for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
            if target.startswith(
                ("http://", "https://", "#viscoroll.")
            ):  # the last: names, which Sphinx looks up
                continue
            name, _, anchor = target.partition("#")
            # pages of the gallery are made from its examples
            name = re.sub(r"^(\.\./)?(gallery|tutorial)/(.+)\.rst$", r"\1examples/\2/\3.py", name)
            found = (page.parent / name).resolve() if name else page
            assert found.exists(), (page, target)
            if anchor:
                headings = re.findall(r"^#+ (.+)$", found.read_text(), re.MULTILINE)
                assert anchor in [
                    re.sub(r"[^\w -]", "", h).lower().replace(" ", "-") for h in headings
                ], (page, target)


@pytest.mark.usefixtures("here")
def test_howto_scene_files_are_read():
    for page in (ROOT / "docs/howto").glob("*.md"):
        for text in blocks(page, "toml"):
            # [heat] is of a run file
            assert text.startswith("[heat]") or of_roller(text).scene()


def test_forms_of_an_input_are_read(tmp_path):
    page = (ROOT / "docs/ensembles.md").read_text()
    (tmp_path / "measured.csv").write_text("friction\n0.1\n0.2\n")
    for form in re.findall(r"^mu = .*$", page, re.M):
        text = (
            f'preset = "paper-section-5"\n[scene]\n{form}\n[start]\nV0 = 1.0\nomega0 = '
            "0.0\n[run]\nn = 1\nt = 1.0"
        )
        inputs = run_of(text, tmp_path).inputs
        assert inputs.uncertain == (() if form == "mu = 0.2" else ("mu",))
