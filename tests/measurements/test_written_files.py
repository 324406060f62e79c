"""Files of moduli with any names, units, order, separators and columns beside are read right."""

import numpy as np
import pytest
import rubbers
import tolerances as tol
from closeness import close
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import viscoroll as vr

f = rubbers.FREQUENCY
w = rubbers.OMEGA
S = rubbers.STORAGE
L = rubbers.LOSS
#: unit -> how many of it are an SI unit, "" where the name needs none
HERTZ = {
    "Hz": 1.0,
    "hertz": 1.0,
    "cps": 1.0,
    "rps": 1.0,
    "kHz": 1e-3,
    "1/s": 1.0,
    "rpm": 60.0,
    "1/min": 60.0,
    "rad/s": 2.0 * np.pi,
    "s⁻¹": 1.0,
}
ANGULAR = {"rad/s": 1.0, "1/s": 1.0, "s^-1": 1.0, "rad·s⁻¹": 1.0, "1/min": 60.0}
PASCAL = {
    "Pa": 1.0,
    "kPa": 1e-3,
    "MPa": 1e-6,
    "GPa": 1e-9,
    "N/mm²": 1e-6,
    "N/mm^2": 1e-6,
    "dyn/cm²": 10.0,
    "bar": 1e-5,
}
PLACES = [
    (f, HERTZ, "f;Frequency;Frequenz;freq.;Test frequency;Prüffrequenz"),
    (w, ANGULAR, "omega;ω;Angular frequency;Kreisfrequenz;ang. freq.;angular_frequency"),
]
STORAGE = (S, PASCAL, "E';E′;Storage modulus;Speichermodul;E_stor;Storage Modulus E';E'-Modul")
LOSS = (L, PASCAL, "E'';E\";Loss modulus;Verlustmodul;E_loss;E″;Loss Modulus (E'')")
TAN = (
    L / S,
    {"": 1.0, "-": 1.0, "1": 1.0, "%": 100.0},
    "tan delta;tan(δ);Loss factor;Verlustfaktor;Tan(delta);tan_delta;Damping",
)
WHOLE = np.hypot(S, L), PASCAL, "|E*|;E*;Complex modulus;Komplexer Modul"
PHASE = (
    np.degrees(np.arctan2(L, S)),
    {"deg": 1.0, "°": 1.0, "rad": np.pi / 180.0},
    "delta;Phase angle;Phasenwinkel;δ",
)
CHOICES = [
    (STORAGE, LOSS),
    (STORAGE, TAN),
    (LOSS, TAN),
    (WHOLE, TAN),
    (WHOLE, PHASE),
    (STORAGE, LOSS, TAN),
    (STORAGE, PHASE),
    (STORAGE, LOSS, WHOLE, TAN),
    (STORAGE, LOSS, PHASE),
]
#: and a column of the temperature, and one that is left aside
OTHERS = [
    (np.full(f.size, 23.5), {"°C": 1.0}, "T;Temperature;Temp.;Temperatur"),
    (np.arange(f.size), {"": 1.0, "s": 1.0}, "Point No.;Index;Status;Static force [N]"),
]
SEPARATORS = [(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ",")]
#: of a name and its unit; the last with a row of units
WAYS = ["{} [{}]", "{} ({})", "{}/{}", "{} in {}", "{}"]


@st.composite
def files(draw):
    """The text of a file."""
    sep, decimal = draw(st.sampled_from(SEPARATORS))
    way = draw(st.sampled_from(WAYS))
    chosen = [draw(st.sampled_from(PLACES)), *draw(st.sampled_from(CHOICES)), *OTHERS]
    lines = []
    for values, units, names in draw(st.permutations(chosen)):
        unit = draw(st.sampled_from([*units]))
        name = draw(st.sampled_from(names.split(";")))
        head = [way.format(name, unit) if unit else name, *[unit] * (way == "{}")]
        numbers = [f"{number:.9g}".replace(".", decimal) for number in values * units[unit]]
        lines.append(head + numbers)
    return "\n".join(map(sep.join, zip(*lines)))


@pytest.mark.filterwarnings("error")
@settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(files())
def test_any_file_is_read_right(tmp_path, text):
    path = tmp_path / "dma.csv"
    path.write_text(text)
    found = vr.read_dma(path)
    assert close([*found], [w, S, L], tol.DMA_DIGITS)
    assert close(found.temperature, 23.5, tol.DMA_DIGITS)
    assert found.mode == "tension"
