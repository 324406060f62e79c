"""Pressure and shear solved together: references, limits, symmetries, powers computed apart, random
pairs.
"""

import math

import numpy as np
import pandas as pd
import pytest
import tolerances as tol
from calls import STEEL, pair
from closeness import close
from long_cases import long
from places import ROOT
from refusals import each, refusals

import viscoroll as vr
from pipeline.evidence.measure.covers import MATERIALS
from viscoroll.contact_mechanics.coupled_pair import CoupledBody, CoupledRow, pair_of_scene
from viscoroll.contact_mechanics.stress import transforms
from viscoroll.materials import layer_excess

ELASTIC, ONE, THREE = MATERIALS.values()
KAPPA = 4.0
MU = 0.3
BELT = vr.Cover(ONE, nu=0.5, thickness=0.5, on="base")
LINING = vr.Cover(ONE, nu=0.5, thickness=0.5, on="cylinder")
NIP = vr.Cover(
    ONE, nu=0.5, thickness=0.5, on="base", part=0.6, other=THREE, other_nu=0.4, other_thickness=0.3
)
MIXED = vr.Cover(ONE, nu=0.45, thickness=0.5, on="base", part=0.7, other=THREE, other_nu=0.3)
CREEPS = np.array([-0.25, -0.05, 0.03, 0.1, 0.3, 0.8])


def scene_of(material, mu=MU, kappa=KAPPA):
    return vr.Scene(material=material, kappa=kappa, mu=mu)


def coupled(scene, V, **more):
    return scene.contact(V, method="coupled", **more)


def test_boundary_elements_of_another_program():
    rows = pd.read_csv(ROOT / "data/reference/coupled.csv")
    for case, mine in rows.groupby(["material", "nu", "thickness", "u", "mu"]):
        name, nu, thickness, u, mu = case
        cover = vr.Cover(MATERIALS[name], nu=nu, thickness=thickness, on="base")
        found = coupled(scene_of(cover, mu, 1.0), u, delta=0.5 * mine.creep.to_numpy())
        assert close(found.Q, mine.Q, tol.COUPLED_Q, scale=mu)
        assert close(found.M, mine.kappa_M, tol.COUPLED_MOMENT, scale=1.0)
        assert close(found.lam, mine.lam, tol.COUPLED_LENGTH)
        assert close(found.epsilon, mine.epsilon, tol.COUPLED_LENGTH, scale=1.0)


@pytest.mark.parametrize("material", [ELASTIC, ONE, THREE, vr.Bodies(ONE, THREE, 0.3)])
def test_half_spaces_have_the_law_of_the_table(material):
    scene = scene_of(material)
    V = 0.1
    star = scene.contact(V, delta=0.0).delta_star
    delta = star * np.array([-2.0, -0.7, 0.1, 0.5, 0.9])
    found = coupled(scene, V, delta=delta)
    exact = scene.contact(V, delta=delta, fields=("lam", "Q", "M", "M_cylinder", "beta"))
    assert close(found.Q, exact.Q, tol.COUPLED_HALF_SPACE, scale=MU)
    assert close(KAPPA * found.M, KAPPA * exact.M, tol.COUPLED_HALF_SPACE, scale=1.0)
    assert close(found.lam, exact.lam, tol.COUPLED_EDGES)
    assert close(found.M_cylinder, exact.M_cylinder, tol.COUPLED_EDGES, scale=1.0)
    assert close([found.delta_plus[0], -found.delta_minus[0]], star, tol.COUPLED_ONSET)
    assert close(found.beta, exact.beta, tol.COUPLED_STICK, scale=1.0)


def test_sides_and_directions():
    belt = coupled(scene_of(BELT), 0.1, delta=CREEPS)
    lining = coupled(scene_of(LINING), 0.1, delta=-CREEPS)
    back = coupled(scene_of(BELT), -0.1, delta=CREEPS)
    for name in ("Q", "M", "lam", "epsilon", "loss_slip"):
        swapped = -1 if name == "Q" else 1
        turned = -1 if name in ("Q", "M") else 1
        assert (lining[name] == swapped * belt[name]).all(), name
        assert (back[name] == turned * belt[name]).all(), name
    assert (lining.M_cylinder == belt.M_half_space).all()
    assert (lining.delta_plus == -belt.delta_minus).all()


def test_two_like_covers_do_not_couple():
    other = {"other": ONE, "other_nu": 0.3, "other_thickness": 0.5}
    nip = vr.Cover(ONE, nu=0.3, thickness=0.5, on="base", part=0.5, **other)
    fields = "Q", "M_half_space", "M_cylinder", "delta_0"
    found = coupled(scene_of(nip), 0.1, delta=[0.0, 0.02], fields=fields)
    assert close(found.Q[0], 0.0, tol.COUPLED_HALF_SPACE, scale=MU)
    assert close(found.delta_0, 0.0, tol.COUPLED_HALF_SPACE, scale=1.0)
    assert close(found.M_half_space[0], found.M_cylinder[0], tol.COUPLED_HALF_SPACE)


def losses_by_transforms(pair, u, profile):
    """Power lost in all bodies over kappa |V| P, by Parseval's theorem from the loss compliance
    alone.
    """
    half = 0.5 * (profile.nodes[-1] - profile.nodes[0])
    s = np.arange(-40.0, 150.0, 0.2)
    k = np.logaddexp(0.0, s) / half
    p, q = (transforms(profile.nodes, each, k) for each in (profile.p, profile.q))
    total = np.zeros(k.size)
    for body in pair:
        J = sum(j / (1.0 - 1j * k * t * u) for j, t in zip(body.J, body.T)).imag
        local = (1.0 - 2.0 * body.nu) / (2.0 - 2.0 * body.nu)
        L, shear, C = layer_excess(body.nu, np.minimum(k * body.thickness, 300.0))
        L, T, C = 1.0 + L, 1.0 + L + shear, local + C
        t = -q if body.side == "base" else q
        total += (
            body.share * J * (L * abs(p) ** 2 + T * abs(t) ** 2 - 2.0 * C * np.imag(p * np.conj(t)))
        )
    mean = (total / (1.0 + np.exp(-s))).sum() * 0.2 / half
    return mean / np.pi / np.trapezoid(profile.p, profile.nodes)


@pytest.mark.parametrize("cover", [BELT, *long(LINING, NIP, MIXED)])
def test_friction_and_losses_of_the_bodies_take_the_power_of_the_loads(cover):
    scene = scene_of(cover)
    pair = pair_of_scene(scene)
    row = CoupledRow(pair, 0.35, MU, 144)
    found = row.states(CREEPS)
    assert not found.status.any()
    power = found.kM_base + found.kM_cylinder + 0.5 * CREEPS * MU * found.Q_over_mu
    friction = 0.5 * (CREEPS * MU * found.Q_over_mu - found.work_base - found.work_cylinder)
    assert (friction >= -tol.COUPLED_POWER).all()
    apart = [losses_by_transforms(pair, 0.35, row.profile(creep)) for creep in CREEPS]
    assert close(friction + apart, power, tol.COUPLED_POWER, scale=1.0)
    state = coupled(scene, 0.35 / KAPPA, delta=0.5 * CREEPS / KAPPA)
    parts = np.stack([state.loss_slip, state.loss_half_space, state.loss_cylinder])
    assert parts.min() > -tol.COUPLED_POWER
    given = 0.35 / KAPPA * (state.M + state.delta * state.Q)
    assert close(parts.sum(axis=0), given, tol.COUPLED_SUM, scale=1.0)


def random_pair(rng):
    """One or two bodies of any kind, with up to 20 modes over 12 decades, alpha up to 1000; u and
    mu.
    """
    bodies = []
    number = rng.integers(1, 3)
    part = rng.uniform(0.2, 0.8)
    shares = (1.0,) if number == 1 else (part, 1.0 - part)
    for share, side in zip(shares, rng.permuted(["base", "cylinder"])):
        modes = int(rng.choice([0, 1, 2, 3, 10, 20]))
        J = (1.0 - 10.0 ** -rng.uniform(0.1, 3.0)) * rng.dirichlet(np.ones(max(modes, 1)))[:modes]
        T = 10.0 ** rng.uniform(-12.0, 0.0, modes) if modes > 1 else np.ones(modes)
        thickness = rng.choice([0.2, 0.5, 2.0, 20.0, math.inf])
        bodies.append(
            CoupledBody(side, share, rng.uniform(0.0, 0.5), thickness, tuple(J), tuple(T))
        )
    return tuple(bodies), *10.0 ** rng.uniform([-6.0, -1.7], [6.0, 0.0])


@pytest.mark.long
def test_random_pairs_are_solved_and_refined_meshes_agree():
    rng = np.random.default_rng(50)
    for _ in range(8):
        pair, u, mu = random_pair(rng)
        coarse = CoupledRow(pair, u, mu)
        creeps = rng.uniform(*coarse.onsets(), 4)
        one = coarse.states(creeps)
        other = CoupledRow(pair, u, mu, 110).states(creeps)
        assert not (one.status + other.status).any(), (pair, u, mu)
        assert (abs(one.Q_over_mu) <= 1.0).all()
        assert close(one.Q_over_mu, other.Q_over_mu, tol.COUPLED_Q, scale=1.0)
        moments = (each.kM_base + each.kM_cylinder for each in (one, other))
        assert close(*moments, tol.COUPLED_RANDOM_MOMENT, scale=1.0)
        assert close(one.lam, other.lam, tol.COUPLED_RANDOM_LENGTH)


def test_rest_and_the_fastest_speed_are_elastic():
    pair = pair_of_scene(scene_of(BELT))
    for ends in ((1e-9, 0.0), (1e12, math.inf)):
        near, limit = (CoupledRow(pair, u, MU).states(CREEPS) for u in ends)
        assert close(near.Q_over_mu, limit.Q_over_mu, tol.COUPLED_EDGES, scale=1.0)
        assert close(near.lam, limit.lam, tol.COUPLED_EDGES)


def test_tractions_carry_load_and_creep_force():
    scene = scene_of(NIP)
    state = coupled(scene, 0.1, delta=0.01)
    x = np.linspace(-0.6, 0.8, 20001)
    found = scene.stress(x, 0.1, delta=0.01, method="coupled")
    unit = 32.0 * KAPPA**2 / KAPPA
    assert close(unit * np.trapezoid(found.p, x), 1.0, tol.COUPLED_STRESS)
    assert close(unit * np.trapezoid(found.tau, x), state.Q, tol.COUPLED_STRESS, scale=MU)
    assert (abs(found.tau) <= MU * found.p * (1.0 + tol.COUPLED_STRESS)).all()
    back = scene.stress(-x[9000], -0.1, delta=0.01, method="coupled")
    assert (back.p, back.tau) == (found.p[9000], -found.tau[9000])


def test_depth_is_that_of_the_surface_in_the_middle():
    cover = vr.Cover(ELASTIC, nu=0.3, thickness=0.5, on="base")
    row = CoupledRow(pair_of_scene(scene_of(cover)), 0.0, MU)
    profile = row.profile(0.05)
    k = np.linspace(1e-9, 600.0, 20001)
    L, _, C = layer_excess(0.3, np.minimum(0.5 * k, 300.0))
    p, q = (transforms(profile.nodes, each, k) for each in (profile.p, profile.q))
    C += 0.4 / 1.4  # (1 - 2 nu)/(2 - 2 nu), of the half-space
    middle = np.trapezoid(((1.0 + L) * p / k + 1j * C * q / k).real, k) / np.pi
    found = coupled(scene_of(cover), 0.0, delta=0.5 * 0.05 / KAPPA, fields="depth").depth
    assert close(KAPPA * found, middle + 0.5 * profile.shift**2, tol.COUPLED_DEPTH)


def test_a_cylinder_has_the_units_of_its_scene():
    roller = pair(STEEL, vr.Material(2.3e5, 0.49, ELASTIC, thickness=0.02))
    found = coupled(roller, 0.5, delta=0.01)
    plain = coupled(roller.scene(), 0.5 / roller.scale["V"], delta=0.01)
    for name in ("Q", "M", "loss_slip"):
        assert close(found[name], plain[name] * roller.scale[name], tol.COUPLED_SUM)


NOT_THERE = each(
    scene_of(ONE).contact,
    {
        "dQ_dV": {"slopes": True},
        "N": {"fields": "N"},
        "half-space": {"fields": "depth"},
        "coupled": {"fields": "depth", "method": "table"},
    },
    V=0.1,
    delta=0.0,
    method="coupled",
)
test_what_it_does_not_have_is_refused = refusals(NOT_THERE)
