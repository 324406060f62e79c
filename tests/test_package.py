"""The public interface, and light imports (layers: `make check`)."""

import re
from pathlib import Path

import pytest
from processes import printed

import viscoroll as vr

PACKAGE = Path(vr.__file__).parent
HEAVY = "numba xarray matplotlib scipy dask h5py pandas pint msgspec tqdm"


# --- the public interface ---


def test_public_names():
    """That each loads: test_keywords.py."""
    assert dir(vr) == sorted(vr.__all__)
    with pytest.raises(AttributeError, match="no attribute 'contacts'"):
        _ = vr.contacts
    assert all(status.message for status in vr.MotionStatus)


def test_the_table_of_coefficients_ships_small():
    assert (PACKAGE / "kernels/law/ratios.npy").stat().st_size < 300_000
    assert (PACKAGE / "py.typed").exists()


# --- imports ---


def test_imports_are_light():
    """A contact imports no motions and no heat."""
    code = "vr.presets.PAPER_SECTION_5; vr.Scene(2, 2, 0.2); dir(vr); vr.law; vr.ParameterError"
    names = "print(*{name.split('.')[0] for name in sys.modules})"
    call = "vr.Scene(2, 2, 0.2).contact(1, delta=0); print(*sys.modules)"
    loaded = printed(f"import sys, viscoroll as vr; {code}; {names}; {call}")
    light, _, of_contact = loaded.partition("\n")
    assert not set(HEAVY.split()) & set(light.split())
    assert not re.search(r"viscoroll\.(motion|heat|tables|runs)", of_contact)
