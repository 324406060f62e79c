"""A rubber of five modes with its moduli by formulas of its own, and rows of numbers of it for
files.
"""

import re

import numpy as np

TAU = np.array([10.0, 1.0, 0.1, 1e-2, 1e-3])
STRENGTH = np.array([0.6, 0.8, 1.2, 2.0, 3.5]) * 1e6
LONG = 3e6
FREQUENCY = np.geomspace(0.05, 150.0, 12)
OMEGA = 2.0 * np.pi * FREQUENCY


def moduli(omega, strengths=STRENGTH, tau=TAU, E=LONG):
    """Storage and loss modulus, Pa, at angular frequencies, rad/s; by default of this rubber."""
    z = np.multiply.outer(np.asarray(omega, float), tau)
    return E + (z**2 / (1.0 + z**2)) @ strengths, (z / (1.0 + z**2)) @ strengths


STORAGE, LOSS = moduli(OMEGA)
_COMPLIANCE = 1.0 / (STORAGE + 1j * LOSS)
#: what expressions of files.toml see
NAMES = {
    "f": FREQUENCY,
    "w": OMEGA,
    "S": STORAGE,
    "L": LOSS,
    "tan": LOSS / STORAGE,
    "mod": np.hypot(STORAGE, LOSS),
    "phase": np.degrees(np.arctan2(LOSS, STORAGE)),
    "J1": _COMPLIANCE.real,
    "J2": -_COMPLIANCE.imag,
    "n": np.arange(1, 13),
    "one": np.ones(12),
    "log": np.log10,
    "np": np,
    "half": np.repeat([1.0, 2.0], 6),
}


def filled(text, case):
    """A text with each ``<a; b; c>`` on its line replaced by rows of these columns.

    ``case`` : may have "format" (of a number, %.7g), "sep" (between cells), "decimal", "begin" and
    "end" (of a row).
    """

    def rows(found):
        columns = [column(part.strip()) for part in found[1].split(";")]
        sep = case.get("sep", ",")
        return "\n".join(
            case.get("begin", "") + sep.join(row) + case.get("end", "") for row in zip(*columns)
        )

    def column(part):
        if part.startswith("'"):
            return [part.strip("'")] * FREQUENCY.size
        values = np.broadcast_to(eval(part, NAMES), FREQUENCY.size)
        written = (case.get("format", "%.7g") % value for value in values)
        return [number.replace(".", case.get("decimal", ".")) for number in written]

    return re.sub(r"<([^<>\n]*)>", rows, text).replace("\n", case.get("newline", "\n"))
