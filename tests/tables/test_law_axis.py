"""The law of every alpha as a file, and a single alpha out of it."""

import numpy as np
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.laws.law_table import law_axis, law_table
from viscoroll.laws.row_layout import AXIS_FUNCTIONS
from viscoroll.tables.law_dataset import check_table

V = np.geomspace(1e-9, 1e9, 50)
DELTA = np.linspace(-0.1, 0.1, 7)[:, None]


def test_stated_errors_are_those_of_other_places():
    law = vr.tables.law(alpha=(3.0, 5.0)).copy(deep=True)
    stated = [law[name].attrs["largest_relative_error"] for name in AXIS_FUNCTIONS]
    assert max(stated) < tol.LAW_STATED
    assert (int(law["first"]), law.sizes["octave_of_alpha"]) == (1, 2)  # alpha in [2, 8]
    assert all(check.passed for check in check_table(law, 3000, 1))
    law["m"].values[1, 0, 8, 0] *= 1.0 + tol.CLI_WRONG
    assert [check.name[-3:] for check in check_table(law, 3000, 1) if not check.passed] == [": m"]


def test_one_alpha_of_a_file(tmp_path):
    saved = tmp_path / "law.nc"
    vr.tables.save(vr.tables.law(alpha=(1, 30.0)), saved)
    told = vr.tables.info(saved)
    assert all(words in told for words in (": axis, ", "alpha = 1 to 32", "m and N come over c"))
    loaded = vr.load_law(saved, alpha=11.0)
    assert np.array_equal(loaded.coefficients, law_axis(1.0, 30.0).at(11.0).coefficients)
    assert not loaded.coefficients.flags.writeable
    scene = vr.Scene(kappa=20.0, mu=0.3, material=loaded)
    own = vr.Scene(11.0, 20.0, 0.3)
    assert scene == own
    exact = own.contact(V, delta=DELTA)
    for name, value in scene.contact(V, delta=DELTA).as_dict().items():
        size = 1.0 if name in ("beta", "Q", "epsilon", "M") else 0.0
        assert close(value, exact[name], tol.AXIS_LAW, scale=size), name
    assert vr.load_law(saved, alpha=32.0).alpha == 32.0
    assert vr.load_law(saved, alpha=1.0) is law_table(1.0)
