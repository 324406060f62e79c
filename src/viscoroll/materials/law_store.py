"""The file of a law: the names of its numbers, their checksum, and a read that trusts nothing it has not checked."""

from __future__ import annotations

import hashlib
import io
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import __version__
from ..errors import TableError
from ..files import sealed_content

if TYPE_CHECKING:
    import xarray as xr

#: Integer attribute of a file: another number where one of this version could not be read any more.
SCHEMA, VERSION = "law_schema", 1
CHECKSUM = "sha256_of_numbers"
#: what to do about a file that is not as it was written
REMEDY = "write it again by `viscoroll tables law`"
_MOST_BYTES = 1 << 24

#: Functions of the law in the order of their coefficients -> meaning.
MEANING = {
    "lam": "contact length over that at rest, over kappa |V|",
    "epsilon": "shift of the contact over half its length, over kappa |V|",
    "m_half_space": "M_half_space/V, over kappa |V|",
    "m_cylinder": "M_cylinder/V, over kappa |V|",
    "N": "N of M = M(V) + N dV/dt, over kappa |V|",
    "share": "eta/F(eta), over v = 1/F(eta)",
    "press": "H(eta)/F(eta)^2, over v = 1/F(eta)",
}
#: Other numbers of a file -> dimensions, meaning.
OTHERS: dict[str, tuple[tuple[str, ...], str]] = {
    "e0": ((), "row 0 holds [0, 2^e0)"),
    "alpha": ((), "instantaneous over long-time modulus"),
    "T_mean": ((), "sum J_j T_j over T_ref"),
    "T_ref": ((), "unit of time; 1 where none was given"),
    "fast_limit": (
        ("body", "term"),
        "W = sum J_j/T_j and C = sum J_j/T_j (ln 2 T_j - 0.5772...) of all, of the half-space and of the cylinder",
    ),
    "relaxation_strength": (("mode",), "E_i over the long-time modulus"),
    "relaxation_time": (("mode",), "tau_i over T_ref"),
    "creep_strength": (("mode",), "J_j over the long-time compliance"),
    "retardation_time": (("mode",), "T_j over T_ref"),
    "half_space_weight": (("mode",), "part of J_j that is the half-space's"),
}  # fmt: skip


def checksum(found: xr.Dataset) -> str:
    """SHA-256 over names and numbers of all variables: little-endian doubles, the last dimension fastest."""
    digest = hashlib.sha256()
    for name in (*MEANING, *OTHERS):
        digest.update(name.encode() + np.ascontiguousarray(found[name].values, "<f8").tobytes())
    return digest.hexdigest()


def is_law(path: str | PathLike[str]) -> bool:
    """Whether a file names itself the law of a material; raises TableError of one that cannot be read or is damaged."""
    import h5py

    content = sealed_content(path, _MOST_BYTES, "material or law of viscoroll", "write it again")
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            return bool(file.attrs.get("viscoroll_table") == "law")
    except OSError:  # the reader of materials says what it is not
        return False


def read_law(path: str | PathLike[str]) -> xr.Dataset:
    """The dataset of a law file, verified; raises TableError."""
    import xarray as xr

    content = sealed_content(path, _MOST_BYTES, "law file of viscoroll", REMEDY)
    try:
        found = xr.load_dataset(io.BytesIO(content), engine="h5netcdf", mask_and_scale=False, decode_times=False)
    except Exception as error:  # libraries raise many kinds
        raise TableError(path, f"is damaged ({' '.join(str(error).split()):.120}): {REMEDY}") from error
    check(found, path)
    return found


def check(found: Any, path: Any) -> None:
    """Refuse what is no law of this schema, or not the numbers that its checksum is of; raises TableError."""
    attributes = getattr(found, "attrs", {})
    if attributes.get("viscoroll_table") != "law":
        raise TableError(path, "is no law file of viscoroll: `viscoroll tables law` writes one")
    schema = attributes.get(SCHEMA)
    if not isinstance(schema, int | np.integer) or schema != VERSION:
        problem = f"is a law file of schema {schema!s:.20}, and this viscoroll ({__version__}) reads {VERSION}"
        raise TableError(path, f"{problem}: {REMEDY}, or install the version that wrote it")
    missing = [name for name in (*MEANING, *OTHERS) if name not in found]
    if missing:
        raise TableError(path, f"is no whole law file: variable {missing[0]!r} is missing; {REMEDY}")
    if checksum(found) != attributes.get(CHECKSUM):
        raise TableError(path, f"is damaged or was edited: its numbers are not those of its {CHECKSUM}; {REMEDY}")
