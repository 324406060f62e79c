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
from calls import file
from closeness import close
from refusals import refused

import viscoroll as vr

CASES = tomllib.loads(Path(__file__).with_name("files.toml").read_text(encoding="utf-8"))


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("title", CASES)
def test_each_file(title):
    case = CASES[title]
    text = rubbers.filled(case["text"], case)
    path = file(text.encode(case.get("write", "utf-8")), "dma.csv")
    options = case.get("options", {})
    if "refused" in case:
        refused(lambda: vr.read_dma(path, **options), *case["refused"], error=vr.ViscorollError)
        return
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = vr.read_dma(path, **options)
    texts = " ".join(str(each.message) for each in said)
    assert case["warns"] in texts if "warns" in case else not texts
    digits = case.get("digits", tol.DMA_DIGITS)
    assert close(found.omega, np.tile(rubbers.OMEGA, case.get("repeated", 1)), digits)
    assert close([found.storage, found.loss], rubbers.moduli(found.omega), digits)
    assert found.mode == case.get("mode", "tension")
    if "temperature" in case:
        assert close(found.temperature, case["temperature"], 1e-12, scale=1.0)
    else:
        assert found.temperature is None
    shown = str(found)
    for word in case.get("says", []):
        assert word in shown, shown
