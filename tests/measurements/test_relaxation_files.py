"""Files of relaxation tests: the modulus of a series of one mode is read right, or refused."""

import numpy as np
import pytest
import tolerances as tol
from calls import file, rows
from closeness import close
from refusals import each, refusals

import viscoroll as vr

pytestmark = pytest.mark.usefixtures("here")
T = np.geomspace(0.01, 100.0, 9)
E = 1e6 * (2.0 + np.exp(-T / 0.5))


def relaxation_of(text):
    return vr.read_relaxation(file(text, "step.csv"))


FILES = {
    "Time [s],E(t) [MPa]\n" + rows(T, E / 1e6): "tension",
    "t / min,G(t) / kPa\n" + rows(T / 60.0, E / 1e3): "shear",
    "Zeit\tRelaxationsmodul\tTemperatur\ns\tMPa\t°C\n"
    + rows(T, E / 1e6, 23.0 + 0 * T, sep="\t"): "tension",
    "Temps (s),Contrainte (MPa),Déformation (%)\n"
    + rows(T, 0.05 * E / 1e6, 5.0 + 0 * T): "tension",
    "Tempo [s],Modulo di rilassamento [MPa],Sforzo [MPa]\n" + rows(T, E / 1e6, E / 1e7): "tension",
    "時間[s],緩和弾性率[Pa]\n" + rows(T, E): "tension",
    "Step time,Average modulus,Torque\ns,MPa,N m\n"
    + rows(T, E / 1e6, T)
    + "\nEnd of test\n": "shear",
    "log t (s),log E (Pa)\n" + rows(np.log10(T), np.log10(E)): "tension",
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("text", FILES)
def test_relaxation_is_read(text):
    record = relaxation_of(text)
    assert close(record.t, T, tol.DMA_DIGITS)
    assert close(record.relaxation, E, tol.DMA_DIGITS)
    assert record.mode == FILES[text]
    assert record.temperature == (23.0 if "°C" in text else None)
    fit = vr.fit_relaxation(record)
    assert (fit.mode, fit.measured.source) == (record.mode, "step.csv")
    assert fit.material().temperature == record.temperature
    assert close(fit.E, 2e6, tol.DMA_DIGITS)


REFUSED = each(
    relaxation_of,
    {
        "no column was found for the relaxation modulus | 'Force [N]'": (
            "Time [s];Force [N]\n1;2\n2;1\n"
        ),
        "unit 'Hz' is not a unit of time: give the unit of the column, as units={'time'": (
            "Time [Hz];E(t) [MPa]\n1;2\n2;1\n"
        ),
        "line 2 (0; 2): the time must be > 0 and finite: correct or remove this line": (
            "Time [s];E(t) [MPa]\n0;2\n2;1\n"
        ),
        "'Strain' has no unit | units={'strain': '%'}": (
            "Time [s];Stress [MPa];Strain\n1;2;5\n2;1;5\n"
        ),
        "at 20 to 40 °C: keep only those of one temperature (within 1 K)": (
            "Time [s];E(t) [MPa];T [°C]\n1;2;20\n2;1;40\n"
        ),
        "line 4 (1; 1): an earlier line has the same time | differs, make a file for each": (
            "Time [s];E(t) [MPa]\n1;2\n2;1.8\n1;1\n2;0.9\n"
        ),
        "looks like temperatures | columns={'temperature'": (
            "theta_C;t [s];E(t) [Pa]\n20;1;2\n20;2;1\n60;1;2\n60;2;1\n"
        ),
        "has 2 tables (their rows begin in lines 2, 4): keep one of them in the file": (
            "Time [s];E(t) [MPa]\n1;2\nTime [s];E(t) [MPa]\n1;2\n"
        ),
    },
    vr.FileError,
)
test_relaxation_is_refused = refusals(REFUSED)
