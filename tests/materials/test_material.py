"""Material: SI moduli, conventions of other programs; shifts and more numbers by hand:
test_values_of_materials.py; shifts from any temperature: test_heat.py.
"""

import dataclasses
import warnings

import numpy as np
import pytest
import tolerances as tol
from calls import TREAD as RUBBER
from calls import file, of_materials
from closeness import close

import viscoroll as vr
from viscoroll.materials import Pair, Solid
from viscoroll.materials.material_toml import material_as_toml, read_materials

pytestmark = pytest.mark.usefixtures("here")
OMEGA = np.array([0.0, 1e-9, 0.02, 3.0, 3.3, 1e5, 1e9])
T = np.array([0.0, 1e-12, 1e-8, 1e-4, 0.3, 7.0, 1e200])


def modulus(material, omega):
    """E' + i E'' as the sum over the modes."""
    product = 1j * omega[:, None] * material.T_ref * material.prony.tau
    return material.E * (1.0 + (material.prony.E * product / (1.0 + product)).sum(axis=1))


# --- moduli ---


def test_moduli_are_the_sums_over_modes():
    exact = modulus(RUBBER, OMEGA)
    assert close(RUBBER.storage(OMEGA), exact.real, tol.MATERIAL)
    assert close(RUBBER.loss(OMEGA), exact.imag, tol.MATERIAL)
    assert close(RUBBER.tan_delta(OMEGA), exact.imag / exact.real, tol.MATERIAL)
    far = [1e200, 1e308]
    assert close(RUBBER.storage(far), RUBBER.instant, tol.MATERIAL)
    decays = np.exp(-T[:, None] / (RUBBER.T_ref * RUBBER.prony.tau))
    assert close(RUBBER.relaxation(T), RUBBER.E * (1.0 + decays @ RUBBER.prony.E), tol.MATERIAL)


# --- other programs ---


@pytest.mark.parametrize(
    "nu, g, k",
    [
        (0.49, [0.3, 0.3], [0.0, 0.0]),
        (0.35, [0.5, 0.3], [0.2, 0.1]),
        (0.3, [0.1, 0.0], [0.2, 0.1]),
        (0.2, [0.4, 0.3], [0.4, 0.3]),
    ],
)
def test_what_the_contact_feels_under_a_bulk_modulus_that_relaxes(nu, g, k):
    """E/(1 - nu^2) = 4 G (3 K + G)/(3 K + 4 G) at every frequency, by every program's way to say
    it.
    """
    tau = np.array([0.01, 1.0])
    omega = np.logspace(-3.0, 5.0, 50)
    product = 1j * omega[:, None] * tau
    instant = 1e6 / np.array([2.0 * (1.0 + nu), 3.0 * (1.0 - 2.0 * nu)])
    shear, bulk = terms = instant[:, None] * [g, k]
    G_inf, K_inf = long = instant - terms.sum(axis=1)
    G, K = (long + product / (1.0 + product) @ terms.T).T
    late = (3.0 * K_inf - 2.0 * G_inf) / (6.0 * K_inf + 2.0 * G_inf)
    E_inf = 2.0 * (1.0 + late) * G_inf
    for found in (
        vr.Material.abaqus(1e6, nu, g, tau, k=k),
        vr.Material.abaqus(1e6, nu, np.transpose([g, k, tau])),
        vr.Material.abaqus(E_inf, late, g, tau, k=k, long_term=True),
        vr.Material.ansys(1e6, nu, g, tau, k=k),
        vr.Material.comsol(E_inf, late, shear, tau, K=bulk),
        vr.Material.lsdyna(shear, 1.0 / tau, nu=late, G_inf=G_inf, K=bulk),
        vr.Material.lsdyna([*shear, G_inf], [*1.0 / tau, 0.0], K=[*bulk, K_inf]),
    ):
        assert close(found.nu, late, tol.MATERIAL_FORMS)
        plane = 4.0 * G * (3.0 * K + G) / (3.0 * K + 4.0 * G)
        assert close(modulus(found, omega) / (1.0 - found.nu**2), plane, tol.MATERIAL_FORMS)
        assert close(found.instant, 1e6, tol.MATERIAL_FORMS)


def test_a_poissons_ratio_that_changes_with_time():
    """Dundurs' constant at once is that of nu at t = 0, beside a rigid body (1 - 2 nu)/(2 - 2 nu).
    The series is that of a half-space in plane strain alone.
    """
    rubber = vr.Material.abaqus(1e7, 0.45, [0.4], [1.0], k=[0.0])
    ends = [(1.0 - 2.0 * nu) / (2.0 - 2.0 * nu) for nu in (rubber.nu, 0.45)]
    assert close(Pair(vr.Material.rigid(), rubber).dundurs, ends, tol.MATERIAL_FORMS)
    for body, plane in (
        (rubber, "stress"),
        (dataclasses.replace(rubber, thickness=0.01), "strain"),
        (Solid(1e7, 0.45, rubber.prony, 1.0, np.array([0.01, 0.02]), rubber.nu_instant), "strain"),
    ):
        with pytest.raises(vr.ParameterError, match="nu_instant of material is given"):
            Pair(body, vr.Material.rigid(), plane)


def test_bulk_terms_in_another_unit_than_shear_warn():
    for make in (
        lambda: vr.Material.lsdyna(G=[1e6, 1e6], beta=[10.0, 0.0], K=[0.0, 2000.0]),
        lambda: vr.Material.comsol(1e6, 0.3, G=[9e6], tau=[1.0], K=[20.0]),
        # only between the two relaxation times
        lambda: vr.Material.abaqus(1e7, 0.49, [0.001, 0.9], [1e-3, 1.0], k=[0.99, 0.0]),
    ):
        with pytest.warns(vr.ModelWarning, match=r"Poisson's ratio -?0.* at least 0\.2"):
            make()


# --- as netCDF ---

STORED = (
    vr.Material(
        1.0 / 3.0,
        0.1,
        vr.Prony([2.0 / 3.0, 1e-9], [0.1, 1e-17]),
        1e9 / 7.0,
        'the "soft" one',
        1100.0 / 3.0,
    ),
    vr.Material(3e6, 0.5, vr.Prony.creep([0.3, 0.69], [3.0, 1e-5], alpha=100.00000000000001)),
    vr.Material.rigid(name="ideal"),
    vr.Material.elastic(1e6, 0.3, name="tread \U0001f6de, Gummi für µ\tand\x7f\n"),
    vr.Material(
        2e6,
        0.5,
        vr.Prony([2.0], [1e-3]),
        thickness=0.02 / 3.0,
        measured=vr.Measured(0.1, 1e3 / 3.0, 0.2, "ä\x7f", ((0.1, 0.3), (1.0, 0.1))),
        temperature=-1.0 / 3.0,
    ),
)


@pytest.mark.parametrize("material", STORED)
def test_a_material_stored_is_read_to_the_bit(material):
    material.to_netcdf("rubber.nc")
    for found in (
        read_materials("rubber.nc"),
        of_materials('[material]\nfile = "rubber.nc"\n'),
        of_materials(material_as_toml(material)),
    ):
        assert found == {"material": material}


def test_a_shift_is_not_stored_without_its_vertical_one(tmp_path):
    """A file cannot hold a function; ``at`` of the shift alone would give other moduli."""
    for vertical, shift in (("entropic", vr.WLF(T0=20.0)), (lambda T: 1.0 + 0.01 * T, None)):
        material = dataclasses.replace(STORED[0], shift=vr.WLF(T0=20.0), vertical_shift=vertical)
        with warnings.catch_warnings(record=True, action="always") as said:
            material.to_netcdf(tmp_path / "m.nc")
        assert [
            "lacks shift and vertical_shift of the material" in str(one.message) for one in said
        ] == [True] * (shift is None)
        (tmp_path / "m.toml").write_text(material_as_toml(material))
        for name in ("m.nc", "m.toml"):
            assert read_materials(tmp_path / name)["material"].shift == shift


def test_a_material_of_another_toml_file():
    """As ``material fit -o dma.toml`` leaves it, for either body; the layer may be given beside
    it.
    """
    rubber, belt, *_ = STORED
    file(material_as_toml(rubber), "dma.toml")
    file(material_as_toml(rubber) + material_as_toml(belt, "base"), "two.toml")
    thin = dataclasses.replace(rubber, thickness=0.006)
    for text, exact in {
        '[material]\nfile = "dma.toml"\n[base]\nfile = "dma.toml"\nthickness = 0.006\n': (
            {"material": rubber, "base": thin}
        ),
        '[material]\nfile = "two.toml"\n[base]\nfile = "two.toml"\n': (
            {"material": rubber, "base": belt}
        ),
        '[base]\nfile = "dma.toml"\nwlf = { T0 = 20.0 }\ntemperature = 30.0\n': (
            {"base": rubber.at(30.0, vr.WLF(T0=20.0))}
        ),
    }.items():
        assert of_materials(text) == exact
