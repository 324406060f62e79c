"""Files of moduli with any names, units, order, separators and columns beside are read right."""

import numpy as np
import pytest
import rubbers
import tolerances as tol
from closeness import close
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import viscoroll as vr
from viscoroll.measurements.text_cells import readings

f = rubbers.FREQUENCY
w = rubbers.OMEGA
S = rubbers.STORAGE
L = rubbers.LOSS
#: unit -> how many of it are an SI unit, "" where the name needs none
HERTZ = {
    "Hz": 1.0,
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
RATIO = {"": 1.0, "-": 1.0, "1": 1.0, "%": 100.0}
DEGREES = {"deg": 1.0, "°": 1.0, "rad": np.pi / 180.0}
PLACES = [
    (f, HERTZ, "f;Frequency;Frequenz;freq.;Test frequency;Prüffrequenz"),
    (
        w,
        ANGULAR,
        "omega;ω;Angular frequency;Kreisfrequenz;ang. freq.;angular_frequency",
    ),
]
STORAGE = (
    S,
    PASCAL,
    "E';E′;Storage modulus;Speichermodul;E_stor;Storage Modulus E';E'-Modul",
)
LOSS = (
    L,
    PASCAL,
    "E'';E\";Loss modulus;Verlustmodul;E_loss;E″;Loss Modulus (E'')",
)
TAN = (
    L / S,
    RATIO,
    "tan delta;tan(δ);Loss factor;Verlustfaktor;Tan(delta);tan_delta;Damping",
)
WHOLE = np.hypot(S, L), PASCAL, "|E*|;E*;Complex modulus;Komplexer Modul"
PHASE = np.degrees(np.arctan2(L, S)), DEGREES, "delta;Phase angle;Phasenwinkel;δ"
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
BESIDE = {
    "Point No.": "%d",
    "Time [s]": "%.2f",
    "Static force [N]": "%.3e",
    "Strain (%)": "%.4f",
    "Index": "%d",
    "Displacement amplitude [µm]": "%g",
    "Status": "ok",
    "Remark": "n/a",
}
PREAMBLES = [
    "",
    "Sample: A 12\n",
    "# made by hand, 3 times\n",
    "Operator;me\nSample;rubber; 70 ShA\n\n",
    "[step]\nFrequency sweep\n",
]
WAYS = ["{} [{}]", "{} ({})", "{}/{}", "{} in {}", "row"]


@st.composite
def files(draw):
    """The text of a file, its bytes, and whether it has a temperature."""
    sep, decimal = draw(
        st.sampled_from([(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ",")])
    )
    way = draw(st.sampled_from(WAYS))
    written = f"%.{draw(st.integers(7, 12))}{draw(st.sampled_from('eg'))}"
    columns = []
    for values, units, names in [draw(st.sampled_from(PLACES)), *draw(st.sampled_from(CHOICES))]:
        unit = draw(st.sampled_from([*units]))
        name = draw(st.sampled_from(names.split(";")))
        log = (
            units is not RATIO
            and units is not DEGREES
            and way != "{} in {}"
            and draw(st.integers(0, 9)) == 0
        )
        numbers = np.log10(values * units[unit]) if log else values * units[unit]
        # logarithms keep the digits of what they are of with more of their own
        cells = [("%.12g" if log else written) % number for number in numbers]
        columns.append(("log " * log + name, unit, [cell.replace(".", decimal) for cell in cells]))
    warm = draw(st.booleans())
    if warm:
        columns.append(
            (
                draw(st.sampled_from(["T", "Temperature", "Temp.", "Temperatur"])),
                "°C",
                ["23" + decimal + "5"] * f.size,
            )
        )
    for name in draw(st.lists(st.sampled_from([*BESIDE]), max_size=3, unique=True)):
        cells = [
            BESIDE[name] % n if "%" in BESIDE[name] else BESIDE[name] for n in range(1, f.size + 1)
        ]
        columns.append((name, "", [cell.replace(".", decimal) for cell in cells]))
    columns = draw(st.permutations(columns))
    plain = [name for name, _, _ in columns]
    heads = (
        plain
        if way == "row"
        else [way.format(name, unit) if unit else name for name, unit, _ in columns]
    )
    heads = [f'"{head.replace(chr(34), chr(34) * 2)}"' if sep in head else head for head in heads]
    lines = [sep.join(heads)]
    lines += [sep.join(unit for _, unit, _ in columns)] if way == "row" else []
    lines += [sep.join(row) for row in zip(*(cells for _, _, cells in columns), strict=True)]
    end = draw(st.sampled_from(["", sep]))
    newline = draw(st.sampled_from(["\n", "\r\n"]))
    text = draw(st.sampled_from(PREAMBLES)) + "\n".join(line + end for line in lines) + "\n"
    encoding = draw(st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]))
    return text.replace("\n", newline), encoding, warm


@pytest.mark.filterwarnings("error")
@settings(
    max_examples=70, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(files())
def test_any_file_is_read_right(tmp_path, file):
    text, encoding, warm = file
    path = tmp_path / "dma.csv"
    path.write_bytes(text.encode(encoding))
    found = vr.read_dma(path)
    assert close(found.omega, w, tol.DMA_DIGITS)
    assert close(found.storage, S, tol.DMA_DIGITS)
    assert close(found.loss, L, tol.DMA_DIGITS)
    assert (found.temperature is not None) == warm
    assert found.mode == "tension"


@pytest.mark.parametrize("heading", ["log10(f/Hz)", "log10(f) [Hz]", "lg f (Hz)", "log10 f/Hz"])
def test_the_unit_of_a_logarithm_has_no_blank(heading):
    assert ("f", "Hz", 10.0) in [each[:3] for each in readings(heading)]
