"""Numbers by hand of rollers, scenes, materials and series."""

import math
from dataclasses import replace
from math import inf, nan, pi

import numpy as np
import pytest
import tolerances as tol
from calls import HARD, PAPER, RUBBER, SERIES, SI, STEEL, TREAD, pair
from closeness import close

import viscoroll as vr
from viscoroll.kernels.law.bessel_ratios import ratio_i2, ratio_k, ratio_r
from viscoroll.laws.law_netcdf import law_table_of
from viscoroll.laws.law_tables import law_table
from viscoroll.presets import PAPER_CYLINDER, PAPER_SECTION_5

pytestmark = [
    pytest.mark.usefixtures("here"),
    pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning"),
]


#: terms of G that all programs are given, Pa
TERMS = np.array([2e6, 3e6])
TIMES = np.array([0.0, 1e-4, 0.3, 7.0, 1e200])
#: the paper's
SOLID = vr.Material.sls(2.3e5, 0.49, 10.7, 0.97)


def test_cylinder_and_scene():
    """Cylinder and Scene: Sect. 3.1 and Eq. (4) of the paper, of the weight and of a given load."""
    E_prime = pi * 2.3e5 / (1.0 - 0.49**2)
    weight = 35.5 * 9.81
    own, loaded = vr.Cylinder(**SI), vr.Cylinder(**SI, load=1e3)
    for cylinder, load in ((own, weight), (loaded, 1e3)):
        scene = cylinder.scene()
        for found, exact in (
            (cylinder.load, load),
            (cylinder.l0, math.sqrt(32.0 * 0.1 * load / E_prime)),
            (scene.alpha, 10.7 / 0.97),
            (scene.kappa, math.sqrt(E_prime * 0.1 / (32.0 * load))),
            (scene.gamma, load * 10.7**2 / (35.5 * 0.1)),
        ):
            assert close(found, exact, tol.SCENE)
    assert own.scene() == vr.Cylinder(**SI, load=weight).scene() == PAPER_SECTION_5
    # the weight is made anew where another mass is given, a load is not
    assert (replace(own, m=1.0).load, replace(loaded, m=1.0).load) == (9.81, 1e3)
    assert close(vr.Cylinder(**SI | {"nu": 0.5}).E_prime, pi * 2.3e5 / 0.75, tol.SCENE)
    assert close(vr.Cylinder(**SI, plane="stress").E_prime, pi * 2.3e5, tol.SCENE)
    # limits that are allowed
    assert vr.Cylinder(**SI | {"T_epsilon": 0.97}).scene().alpha == 1.0
    assert vr.Scene(1.0, 1e-300, 1e-300).alpha == 1.0


def test_a_material_in_place_of_the_four_parameters():
    """Kappa and gamma to the bit, creep of its own; a base alike."""
    made = pair(SOLID, None)
    scene = made.scene()
    assert scene.replace(material=None, alpha=PAPER_SECTION_5.alpha) == PAPER_SECTION_5
    assert scene.material == SOLID.prony
    assert vr.Cylinder(**SI, base=SOLID).scene() == PAPER_SECTION_5


def test_moduli_and_times_of_pairs():
    """Moduli and times of pairs: 2/E' = 1/E'_1 + 1/E'_2, and the shares of the compliance."""
    rigid = vr.Material.rigid()
    on_steel = pair(RUBBER, STEEL)
    under_steel = pair(STEEL, RUBBER)
    on_hard = pair(RUBBER, HARD)
    soft, hard = 0.75 / 2.3e5, 0.91 / 2e11
    assert close(2.0 / on_steel.E_prime, (soft + hard) / pi, tol.SCENE)
    assert close(on_steel.pair.share, soft / (soft + hard), tol.SCENE)
    assert under_steel.E_prime == on_steel.E_prime
    assert close(under_steel.pair.share + on_steel.pair.share, 1.0, tol.SCENE)
    for found, share in ((pair(RUBBER, rigid), 1.0), (pair(rigid, RUBBER), 0.0)):
        assert (found.E_prime, found.pair.share) == (2.0 * pi * 2.3e5 / 0.75, share)
    # the time is the cylinder's, or the base's where the cylinder does not relax
    assert [c.T_ref for c in (on_hard, under_steel, pair(rigid, HARD))] == [0.3, 0.3, 2.0]
    assert on_hard.scene().material == vr.Bodies(
        SERIES, HARD.prony.slower(2.0 / 0.3), on_hard.pair.share, (0.5, 0.5)
    )
    assert close(on_hard.scene().kappa, 0.1 / on_hard.l0, tol.SCENE)


def test_limits_of_a_material():
    """Of frequency and time; what is elastic."""
    assert close((TREAD.creep(0.0), TREAD.creep(1e200)), (1.0 / 20.0, 1.0), tol.MATERIAL)
    found = [getattr(STEEL, name)(3.0) for name in ("relaxation", "loss", "creep")]
    assert (found, STEEL.instant, STEEL.is_rigid) == ([2e11, 0.0, 1.0], 2e11, False)
    assert close(STEEL.G, 2e11 / 2.6, tol.MATERIAL)
    rigid = vr.Material.rigid()
    found = [getattr(rigid, name)(1.0) for name in ("storage", "loss", "tan_delta")]
    assert (found, rigid.is_rigid) == ([inf, 0.0, 0.0], True)
    # E(t) = E (1 + (T_epsilon/T_sigma - 1) exp(-t/T_sigma)) is the paper's material: 10.7 s over
    # 0.97 s
    exact = 2.3e5 * (1.0 + (10.7 / 0.97 - 1.0) * np.exp(TIMES / -0.97))
    assert close(SOLID.relaxation(TIMES), exact, tol.MATERIAL)
    assert vr.Material.sls(2.3e5, 0.49, 1.0, 1.0).prony == vr.Prony.elastic()


def test_shifts_by_temperature():
    """Shifts by temperature."""
    shift = vr.WLF(T0=20.0)
    warm = TREAD.at(30.0, shift)
    known = replace(TREAD, measured=vr.Measured(0.1, 300.0, 0.01, "dma.csv"))
    # log10 a_T = -17.44 * 10/(51.6 + 10) ten degrees above T0; T_ref becomes a_T T_ref, nothing
    # else
    assert close(math.log10(warm.T_ref / TREAD.T_ref), -174.4 / 61.6, tol.MATERIAL)
    assert replace(warm, T_ref=TREAD.T_ref, temperature=None) == TREAD
    # 100 kJ/mol between 20 and 30 degrees: ln a_T = 12027.24 (1/303.15 - 1/293.15)
    assert close(
        math.log(vr.Arrhenius(energy=1e5, T0=20.0)(30.0)), -1.3533756, tol.MATERIAL_PRINTED
    )
    # a_T = 100: the data hold a hundredth of their frequencies
    assert known.at(0.0, lambda _: 100.0).measured == vr.Measured(1e-3, 3.0, 0.01, "dma.csv")
    assert "0.1 to 300 rad/s, misfit 1 % (dma.csv)" in repr(known._summary())


def test_constants_of_lsdyna_and_bulk_terms():
    """Other programs."""
    dyna = vr.Material.lsdyna(G=[90e6, 20e6], beta=[10.0, 1e4], bulk=66.67e6, G_inf=10e6)
    # LS-DYNA: 66.67 MPa, G_inf = 10 MPa, G_1 = 90 MPa, beta = 0.01/ms: nu = (200.01 - 20)/(400.02
    # + 20), E = 2 (1 + nu) 10 MPa
    assert close(dyna.nu, 0.42857483, tol.MATERIAL_PRINTED)
    assert close(dyna.E, 28.571497e6, tol.MATERIAL_PRINTED)
    # modes of G and of 3 K + G
    assert dyna.prony.E.size == 4
    assert vr.Material.ansys(1e6, 0.5, [0.2], [0.1], k=[0.7]) == vr.Material.ansys(
        1e6, 0.5, [0.2], [0.1]
    )


def test_an_incompressible_material_by_programs():
    """G(t) = 1 + 2 exp(-t/0.1 s) + 3 exp(-t/4 s) MPa, nu = 1/2."""
    exact = 3e6 + 6e6 * np.exp(-TIMES / 0.1) + 9e6 * np.exp(-TIMES / 4.0)
    for given in (
        vr.Material.ansys(18e6, 0.5, TERMS / 6e6, [0.1, 4.0]),
        vr.Material.comsol(3e6, 0.5, TERMS, [0.1, 4.0]),
        vr.Material.lsdyna(TERMS, [10.0, 0.25], nu=0.5, G_inf=1e6),
    ):
        assert close(given.relaxation(TIMES), exact, tol.MATERIAL)


def test_series():
    """One mode is the standard linear solid; nothing that is given is rescaled."""
    known = vr.Prony([3.0, 6.0], [1.0, 1e-5])
    added = vr.Prony(E=[6.0, 0.0, 2.0, 1.0], tau=[1e-5, 3.0, 1.0, 1.0])
    p = vr.Prony([10.0], [1.0 / 11.0])
    assert close(
        [p.alpha, *p.E, *p.tau, *p.J, *p.T],
        [11.0, 10.0, 1.0 / 11.0, 10.0 / 11.0, 1.0],
        tol.SERIES_FORMS,
    )
    # equal times are added up, zeros are dropped
    assert {added: 1}[known] == 1
    assert eval(repr(known), {"Prony": vr.Prony}) == known


def test_arrays_of_materials():
    """Arrays of materials: one of the two may be shared, and an array of materials is a
    material.
    """
    assert vr.Prony([1.0, 2.0], [[1.0, 0.1], [2.0, 0.1]])[1] == vr.Prony([1.0, 2.0], [2.0, 0.1])
    assert vr.Prony.creep(
        [[0.3, 0.6], [0.2, 0.7]], [1.0, 0.1], alpha=[10.0, 10.000000000000002]
    ).alpha.tolist() == [10.0, 10.000000000000002]


def test_a_scene_keeps_its_law():
    """And what follows from a change of a cylinder."""
    table = law_table(SERIES)
    scene = vr.Scene(kappa=20.0, mu=0.3, material=table)
    assert scene.table is scene.replace(mu=0.2).table is law_table_of(table) is table
    assert scene.replace(alpha=3.0).table is not table
    assert vr.Scene(kappa=20.0, mu=0.3, material=law_table(11.0)).alpha == 11.0
    signs = {PAPER_CYLINDER.replace(nu=nu) for nu in (0.0, -0.0)}
    assert len(signs) == 1
    assert PAPER_CYLINDER.replace(material=RUBBER).E is None
    assert pair(RUBBER, STEEL).replace(**SI).material is None


def test_a_scene_and_a_series_are_values():
    """A scene and a series are values."""
    two = vr.Scene(np.array([2.0, 3.0]), 2.0, 0.2)
    assert two == vr.Scene([2.0, 3.0], 2.0, 0.2)
    assert eval(repr(PAPER), {"Scene": vr.Scene}) == PAPER
    assert vr.Prony([[0.0], [1.0]], [1.0]).slow_time.tolist() == [
        1.0,
        3.0,
    ]  # (tau^2 + J T^2)/(J T) of E = 1: J = 1/2, T = 2


def test_bessel_ratios_at_their_ends():
    """NaN must not be taken for the number of a bin, which reads beyond the table."""
    for ratio in (ratio_r, ratio_k):
        assert (ratio(0.0), ratio(inf)) == ((0.0, 1.0), (1.0, 0.0))
        assert np.isnan(ratio(nan)).all()
    assert (ratio_i2(0.0, 0.0), ratio_i2(inf, 1.0)) == (0.0, 1.0)
    assert np.isnan(ratio_i2(nan, nan))
