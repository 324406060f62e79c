"""Files of relaxation tests: the modulus of a series of one mode is read right, or refused."""

import numpy as np
import pytest
import rubbers
import tolerances as tol
from closeness import close
from refusals import refused

import viscoroll as vr
from viscoroll.cli import main

T = np.geomspace(0.01, 100.0, 9)
E = 1e6 * (2.0 + np.exp(-T / 0.5))


def table(*columns, sep=";"):
    return "".join(
        sep.join(f"{value:.9g}" for value in row) + "\n" for row in np.transpose(columns)
    )


FILES = {
    "Time [s];E(t) [MPa]\n" + table(T, E / 1e6): "tension",
    "t / min;G(t) / kPa\n" + table(T / 60.0, E / 1e3): "shear",
    "Zeit\tRelaxationsmodul\tTemperatur\ns\tMPa\t°C\n"
    + table(T, E / 1e6, 23.0 + 0 * T, sep="\t"): "tension",
    "Temps (s);Contrainte (MPa);Déformation (%)\n"
    + table(T, 0.05 * E / 1e6, 5.0 + 0 * T): "tension",
    "Tempo [s];Modulo di rilassamento [MPa];Sforzo [MPa]\n" + table(T, E / 1e6, E / 1e7): "tension",
    "時間[s];緩和弾性率[Pa]\n" + table(T, E): "tension",
    "Step time;Modulus;Torque\ns;MPa;N m\n" + table(T, E / 1e6, T) + "End of test\n": "shear",
    "log t (s);log E (Pa)\n" + table(np.log10(T), np.log10(E)): "tension",
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("text", FILES)
def test_relaxation_is_read(text, tmp_path):
    path = tmp_path / "step.csv"
    path.write_text(text, encoding="utf-8")
    record = vr.read_relaxation(path)
    assert close(record.t, T, tol.DMA_DIGITS)
    assert close(record.relaxation, E, tol.DMA_DIGITS)
    assert record.mode == FILES[text]
    assert record.temperature == (23.0 if "°C" in text else None)
    fit = vr.fit_relaxation(record)
    assert (fit.mode, fit.source, fit.temperature) == (record.mode, "step.csv", record.temperature)
    assert close(fit.E, 2e6, tol.DMA_DIGITS)
    assert record.to_xarray().relaxation.values.tolist() == record.relaxation.tolist()
    assert len(str(record).splitlines()) == 3
    assert len(record.plot().axes[0].lines) == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "Time [s];Force [N]\n1;2\n2;1\n",
            ["no column was found for the relaxation modulus", "'Force [N]'"],
        ),
        (
            "Time [Hz];E(t) [MPa]\n1;2\n2;1\n",
            ["unit 'Hz' is not a unit of time: give the unit of its numbers, as units={'time'"],
        ),
        (
            "Time [s];E(t) [MPa]\n0;2\n2;1\n",
            ["line 2 (0; 2): the time must be > 0 and finite: correct or remove the row"],
        ),
        (
            "Time [s];Stress [MPa];Strain\n1;2;5\n2;1;5\n",
            ["'Strain' has no unit", "units={'strain': '%'}"],
        ),
        (
            "Time [s];E(t) [MPa];T [°C]\n1;2;20\n2;1;40\n",
            ["at 20 to 40 °C, and must be at one temperature: keep"],
        ),
        (
            "Time [s];E(t) [MPa]\n1;2\n2;1.8\n1;1\n2;0.9\n",
            ["line 4 (1; 1): an earlier row has the same time and another"],
        ),
        (
            "theta_C;t [s];E(t) [Pa]\n20;1;2\n20;2;1\n60;1;2\n60;2;1\n",
            ["looks like temperatures", "columns={'temperature'"],
        ),
        (
            "Time [s];E(t) [MPa]\n1;2\nTime [s];E(t) [MPa]\n1;2\n",
            ["has 2 tables: keep one of them"],
        ),
    ],
)
def test_relaxation_is_refused(text, words, tmp_path):
    path = tmp_path / "step.csv"
    path.write_text(text, encoding="utf-8")
    refused(lambda: vr.read_relaxation(path), *words, error=vr.FileError)


def test_a_record_is_fitted_alone():
    record = vr.RelaxationModulus(T, E, mode="shear")
    for given in ({"relaxation": E}, {"mode": "tension"}):
        refused(
            lambda given=given: vr.fit_relaxation(record, **given),
            "relaxation or mode is given: must be left out",
        )
    refused(lambda: vr.fit_relaxation(T), "relaxation is not given: must be given beside t")


def test_units_by_name_on_the_command_line(tmp_path, capsys):
    path = tmp_path / "dma.csv"
    text = "f [Schlag/min];E' [MPa];E'' [MPa]\n<60*f; S/1e6; L/1e6>\n"
    path.write_text(rubbers.filled(text, {"sep": ";"}))
    assert main(["material", "fit", str(path)]) == 2
    assert "--units 'frequency=rad/s'" in capsys.readouterr().err
    assert main(["material", "fit", str(path), "--units", "frequency=rpm"]) == 0
    assert "omega 0.3142 to 942.5 rad/s" in capsys.readouterr().out
