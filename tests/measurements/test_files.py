"""Files of moduli as instruments and spreadsheets write them, in files.toml: each is read right, or
refused.
"""

import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest
import rubbers
import tolerances as tol
from closeness import close
from refusals import refused

import viscoroll as vr

CASES = tomllib.loads(Path(__file__).with_name("files.toml").read_text(encoding="utf-8"))


def written(folder, case):
    """The file of a case: its text with ``{rows: ...}`` replaced by rows of the rubber."""
    path = folder / case.get("name", "dma.csv")
    text = rubbers.filled(case["text"], case)
    path.write_bytes(text.encode(case.get("write", "utf-8")))
    return path


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize("title", CASES)
def test_each_file(title, tmp_path):
    case = CASES[title]
    path = written(tmp_path, case)
    options = case.get("options", {})
    options = options | (
        {"units": tuple(options["units"])} if isinstance(options.get("units"), list) else {}
    )
    if "refused" in case:
        refused(lambda: vr.read_dma(path, **options), *case["refused"], error=vr.ViscorollError)
        return
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = vr.read_dma(path, **options)
    assert [str(each.message) for each in said if "unit" in str(each.message)] == [] or case.get(
        "warns"
    ), said
    storage, loss = rubbers.moduli(found.omega)
    digits = case.get("digits", tol.DMA_DIGITS)
    assert close(
        found.omega, np.tile(rubbers.OMEGA, case.get("repeated", 1))[: found.omega.size], digits
    )
    assert close(found.storage, storage * case.get("times", 1.0), digits)
    assert close(found.loss, loss * case.get("times", 1.0), digits)
    assert found.mode == case.get("mode", "tension")
    if "temperature" in case:
        assert close(
            found.temperature, np.full(found.omega.size, case["temperature"]), 1e-12, scale=1.0
        )
    else:
        assert found.temperature is None
    shown = str(found)
    assert len(shown.splitlines()) == 3
    for word in case.get("says", []):
        assert word in shown, shown


@pytest.mark.parametrize(("factor", "count"), [(0.85, 1), (0.95, 0)])
def test_rows_of_one_frequency_that_differ_are_said(tmp_path, factor, count):
    """Two sweeps that nothing tells apart, 15 % apart, give a warning; repeats within 5 % none."""
    text = "part;w [rad/s];E' [Pa];E'' [Pa]\n<one; w; S; L>\n<one; w; {0}*S; {0}*L>\n"
    path = written(tmp_path, {"text": text.format(factor), "sep": ";"})
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        vr.read_dma(path)
    assert len(said) == count
