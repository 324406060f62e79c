"""Covers of finite thickness: limits, closed forms, more terms, balances; against boundary elements: make prove."""

import dataclasses

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refused

import viscoroll as vr
from pipeline.evidence.prove import layer
from viscoroll.materials.cover_rows import at_speed
from viscoroll.materials.cover_solve import CoverModes, solve

ONE, THREE = vr.Prony([10.0], [1.0 / 11.0]), vr.Prony([2.0, 6.0, 3.0], [1.0, 0.1, 0.003])
KAPPA, MU = 10.0, 0.3
RUBBER = vr.Material(2e6, 0.49, THREE, 0.1)
#: a cover of nu = 1/2 on the roller, one of a compressible belt, one beside an elastic body
COVERS = (
    vr.Cover(THREE, nu=0.5, thickness=0.5),
    vr.Cover(ONE, nu=0.3, thickness=1.0, on="base"),
    vr.Cover(THREE, nu=0.45, thickness=2.0, part=0.8, other_nu=0.3),
)


def scene_on(cover: object, **more: float) -> vr.Scene:
    return vr.Scene(material=cover, kappa=KAPPA, mu=MU, gamma=0.5, **more)


@pytest.mark.parametrize("p", [ONE, THREE])
def test_a_thick_cover_is_a_half_space(p):
    """At speeds where the memory, V T over l0, does not reach the core."""
    half = scene_on(vr.Bodies(p, vr.Prony.elastic(), 1.0))
    cover = scene_on(vr.Cover(p, nu=0.5, thickness=1e10))
    V, part = np.meshgrid(10.0 ** np.linspace(-13.0, 1.0, 29), [1e-3, 0.5, 0.99])
    limit = vr.contact(half, V, delta=0.0, fields="delta_star").delta_star
    free = vr.contact(cover, V, delta=0.0, fields="delta_0").delta_0
    known, found = vr.contact(half, V, delta=part * limit), vr.contact(cover, V, delta=part * limit + free)
    for name in ("lam", "epsilon", "delta_star", "M", "M_cylinder"):
        assert close(found[name], known[name], rel=tol.COVER_THICK, what=name)
    assert close(found.Q, known.Q, rel=tol.COVER_THICK, scale=MU)
    assert np.abs(found.delta_0).max() < tol.COVER_THICK


@pytest.mark.parametrize("cover", COVERS)
def test_rows_are_the_solve(cover):
    """With twice as many terms of the pressure."""
    modes = CoverModes(cover.layer, cover.total, cover.part, cover.nu, cover.other_nu)
    u = 10.0 ** np.linspace(-2.5, 3.0, 12)
    truth = np.array([at_speed(modes, cover.thickness, each, orders=60) for each in u]).T
    found = vr.contact(scene_on(cover), u / KAPPA, delta=0.0)
    assert close(found.lam, truth[0], rel=tol.COVER_ROWS)
    assert close(2.0 * KAPPA / MU * found.delta_star, truth[1], rel=tol.COVER_ROWS)
    assert close(found.epsilon, truth[3], rel=tol.COVER_ROWS)
    assert close(KAPPA * found.M, u * truth[4], rel=tol.COVER_ROWS)
    side, rel = (1.0 if cover.on == "base" else -1.0), tol.COVER_ROWS if cover.nu == 0.5 else tol.COVER_FREE
    assert close(2.0 * KAPPA * found.delta_0, side * truth[2], rel=rel, scale=1.0)


@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_an_elastic_cover(nu):
    """Its load at half width 1 is that of another solution (make prove); delta_0 of a thick one is in closed form."""
    found = vr.contact(scene_on(vr.Cover(1.0, nu=nu, thickness=1.0)), 1.0, delta=0.0)
    assert found.M == 0.0
    assert close(found.lam**2 * layer.load(2.0 / found.lam, nu), 1.0, rel=tol.COVER_ELASTIC)
    thick = vr.contact(scene_on(vr.Cover(1.0, nu=nu, thickness=1e12, on="base")), 1.0, delta=0.0)
    assert close(thick.delta_0, -(0.5 - nu) / (1.0 - nu) * 4.0 / (3.0 * np.pi * KAPPA), rel=tol.COVER_LOCAL, scale=1e-3)
    alike = vr.Cover(1.0, nu=nu, thickness=1e12, part=0.5, other_nu=nu)
    assert abs(vr.contact(scene_on(alike), 1.0, delta=0.0).delta_0) < tol.COVER_THICK


def test_a_thin_compressible_cover_is_a_foundation():
    """To a first order in the thickness, whose extrapolation is ten times as near."""
    modes = CoverModes(ONE, ONE, 1.0, 0.0, 0.5)
    ratios = []
    for theta in (3.0, 6.0):
        state = solve(modes, 1.0, theta)
        ratios.append(np.array([state.load, state.shift, state.moment]) / layer.springs(ONE, 1.0, 1.0 / theta, 0.0))
    assert close(ratios[1], 1.0, rel=tol.COVER_THIN)
    assert close(2.0 * ratios[1] - ratios[0], 1.0, rel=0.1 * tol.COVER_THIN)


@settings(max_examples=12, deadline=None)
@given(
    st.floats(0.0, 0.5), st.floats(-0.8, 2.0), st.floats(-1.0, 2.0), st.floats(-4.0, 0.0), st.floats(0.05, 1.0),
    st.sampled_from(["cylinder", "base"]),
)  # fmt: skip
def test_any_cover(nu, thickness, strength, time, part, on):
    """Shorter than the half-space's contact, which resists; traction within friction, and rising with creep."""
    p = vr.Prony([10.0**strength, 1.0], [10.0**time, 1.0])
    scene = scene_on(vr.Cover(p, nu=nu, thickness=10.0**thickness, on=on, part=part))
    V = np.logspace(-9.0, 9.0, 37)[:, None]
    limit, free = (vr.contact(scene, V, delta=0.0)[name] for name in ("delta_star", "delta_0"))
    c = vr.contact(scene, V, delta=free + limit * np.linspace(-1.25, 1.25, 24))
    assert np.all((c.lam > 0.0) & (c.lam < 1.0) & (c.M > 0.0) & (c.epsilon > 0.0))
    assert np.all((np.abs(c.Q) <= MU) & (c.beta >= 0.0) & (c.beta <= 1.0))
    assert np.all(np.diff(c.Q, axis=1) >= 0.0)
    assert np.array_equal(c.full_slip, np.abs(c.Q) == MU)
    assert np.all(np.diff(limit, axis=0) <= tol.COVER_THICK)


@pytest.mark.parametrize("cover", COVERS)
def test_slow_and_fast(cover):
    """M = V T_mean, and M falls as 1/V, without the logarithm of a half-space; nothing jumps at nu = 1/2."""
    slow, fast = (vr.contact(scene_on(cover), V, delta=0.0, fields="M").M for V in (1e-15, [1e8, 2e8]))
    rate = slow / (1e-15 * cover.total.T_mean)
    assert close(rate, 1.0, rel=tol.COVER_ROWS) if cover.part == 1.0 else 0.8 < rate < 1.0
    assert close(2.0 * fast[1], fast[0], rel=tol.COVER_FAST)
    near, at = (vr.Cover(THREE, nu=nu, thickness=0.5) for nu in (0.5 - 1e-9, 0.5))
    near, at = (vr.contact(scene_on(each), 0.03, delta=1e-3) for each in (near, at))
    assert close(list(near.as_dict().values()), list(at.as_dict().values()), rel=tol.COVER_NU)


@pytest.mark.parametrize("cover", COVERS)
def test_slopes_and_mirror(cover):
    scene, V, delta, h = scene_on(cover), 0.03, 2e-3, 1e-6
    for creep in ("delta", "omega"):
        at = delta if creep == "delta" else V * (1.0 + delta)
        found = vr.contact(scene, V, **{creep: at}, slopes=True)
        sides = vr.contact(scene, [V * (1.0 + h), V * (1.0 - h)], **{creep: at})
        over = 1.0 / (2.0 * h * V)
        assert close(found.dQ_dV, (sides.Q[0] - sides.Q[1]) * over, rel=tol.COVER_SLOPES, scale=MU / V)
        assert close(found.dM_dV, (sides.M[0] - sides.M[1]) * over, rel=tol.COVER_SLOPES, scale=found.M / V)
    back = vr.contact(scene, -V, delta=delta)
    front = vr.contact(scene, V, delta=delta)
    assert (back.Q, back.M, back.delta_0, back.beta) == (-front.Q, -front.M, front.delta_0, front.beta)
    free = vr.contact(scene, V, delta=front.delta_0)
    assert close(free.Q, 0.0, rel=tol.COVER_THICK, scale=MU)
    assert free.beta == 1.0


MOTIONS = {
    "free": ((1.0, 1.0), {}), "thrown": ((1.0, -0.5), {}), "back": ((-1.0, -0.7), {}),
    "driven": ((0.1, 0.1), {"torque": 0.02}),
    "from rest": ((0.0, 0.0), {"torque": vr.Schedule([0.0, 9.0], [0.0, 0.02])}),
    "braked": ((1.0, 1.0), {"brake": 0.05}), "to rest": ((0.02, 0.02), {}),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("cover", COVERS[:2])
def test_energy_of_motions(cover, name):
    """What is put in is what moves and what is lost; and where nothing slips, the traction is that of the state."""
    (V, omega), drive = MOTIONS[name]
    scene, t = scene_on(cover), np.linspace(0.0, 400.0 if name == "to rest" else 30.0, 31)
    m = vr.roll(scene, V, omega, t, rtol=tol.COVER_RTOL, **drive)
    assert m.status in (vr.MotionStatus.DONE, vr.MotionStatus.RESTED)
    energy = 0.5 * m.V**2 + 0.5 * scene.j * m.omega**2
    put_in = sum(0.0 if work is None else work for work in (m.work_force, m.work_torque))
    lost = m.slip_loss + m.rolling_loss + (0.0 if m.brake_loss is None else m.brake_loss)
    assert close(energy + lost - put_in, energy[0], rel=tol.MOTION_RTOL * tol.COVER_RTOL, scale=energy.max())


def test_motions_follow_the_contact():
    """V' and omega' by differences of a motion against the contact's forces; an ensemble is its motions."""
    scene, h = scene_on(COVERS[0]), 1e-3
    t = np.array([3.0 - h, 3.0, 3.0 + h])
    m = vr.roll(scene, 1.0, 0.2, t, rtol=1e-11, torque=0.01)
    c = vr.contact(scene, m.V[1], omega=m.omega[1], fields=("Q", "M_half_space", "M_cylinder"))
    rates = [scene.gamma * (c.Q - c.M_half_space), scene.gamma / scene.j * (0.01 - c.Q - c.M_cylinder)]
    assert close([(m.V[2] - m.V[0]) / (2 * h), (m.omega[2] - m.omega[0]) / (2 * h)], rates, rel=tol.COVER_RATES)
    both = vr.ensemble(scene, [1.0, 0.5], [0.2, 0.5], t, rtol=1e-11, torque=0.01)
    assert np.array_equal(both.V[0], m.V)


def test_a_thickness_each():
    """States and motions of many thicknesses are those of each: of a scene, and of cylinders by their load."""
    cover = vr.Cover(ONE, nu=0.5, thickness=[0.45, 0.55, 0.45])  # on either side of an octave
    scene, V = scene_on(cover), np.array([0.01, -0.5, 3.0])
    found, motions = vr.contact(scene, V, delta=-2e-3, slopes=True), vr.ensemble(scene, V, 0.1, [1.0, 9.0], rtol=1e-10)
    for n, each in enumerate(cover):
        one = scene.replace(material=each)
        for name, value in vr.contact(one, V[n], delta=-2e-3, slopes=True).as_dict().items():
            assert close(found[name][n], value, rel=tol.COVER_EACH, what=name)
        assert close(motions.V[n], vr.roll(one, V[n], 0.1, [1.0, 9.0], rtol=1e-10).V, rel=tol.COVER_EACH_MOTION)
    thin, load = vr.Material(2e6, 0.5, ONE, 0.1, thickness=0.01), np.array([1.2e3, 1.7e3])
    rollers = vr.Cylinder(R=0.1, m=30.0, material=thin, base=vr.Material.rigid(), mu=0.5, load=load)
    M = [rollers.replace(load=each).contact(1.0, delta=0.0).M for each in load]
    assert close(rollers.contact(1.0, delta=0.0).M, M, rel=tol.COVER_EACH)
    assert rollers.validity(1.0).thick.value.shape == (2,)


def test_a_law_on_disk(tmp_path):
    """Bit for bit, with its bodies; it is refused where load or radius make another thickness over l0."""
    thin = dataclasses.replace(RUBBER, thickness=0.01)
    roller = vr.Cylinder(R=0.1, m=30.0, material=thin, base=vr.Material.elastic(3e9, 0.3), mu=0.5, load=2e3)
    for known in (scene_on(COVERS[2]), roller):
        vr.tables.save(vr.tables.law(known.material if known is not roller else roller), tmp_path / "law.nc")
        law = vr.load_law(tmp_path / "law.nc")
        found = known.replace(material=law, **({"base": None} if known is roller else {}))
        V = np.logspace(-6, 6, 13)
        for name, values in vr.contact(found, V, delta=1e-3).as_dict().items():
            assert np.array_equal(values, vr.contact(known, V, delta=1e-3)[name])
    assert law.pair == roller.pair
    refused(lambda: found.replace(load=2.1e3).contact(1.0, delta=0.0), "material", "layer of 0.5", "0.49")


def test_a_bound_law_is_the_contact():
    """To the bit, at any speed."""
    scene = scene_on(COVERS[1])
    law = vr.law(scene)
    for V in (0.0, 1e-9, -0.03, 7.0, 1e13):
        for omega in (V * 1.001, -V, 0.2):
            if V or omega:
                state = vr.contact(scene, V, omega=omega, fields=law(V, omega, slopes=True)._fields)
                assert tuple(state.as_dict().values()) == law(V, omega, slopes=True)


@pytest.mark.parametrize("cover", COVERS)
def test_equilibria(cover):
    """Forces balance at what is found; at rest they are the limit of slow rolling."""
    scene = scene_on(cover)
    for load in ({"torque": 0.004}, {"force": 0.004}, {"torque": 0.2, "force": -0.197}):
        s = vr.steady(scene, **load)
        c = vr.contact(scene, s.V, omega=s.omega)
        assert s.V.size == 2
        assert close(c.Q - c.M_half_space + load.get("force", 0.0), 0.0 * s.V, rel=tol.COVER_STEADY, scale=1.0)
        assert close(load.get("torque", 0.0) - c.Q - c.M_cylinder, 0.0 * s.V, rel=tol.COVER_STEADY, scale=1.0)
        assert close(s.beta, c.beta, rel=tol.COVER_STEADY)
    rest, slow = vr.steady(scene, force=0.1, torque=-0.1), vr.steady(scene, V=1e-12, torque=-0.1)
    assert close(rest.delta, slow.delta, rel=tol.COVER_REST)


def test_a_thickness_in_SI_units():
    """A Material's thickness over l0 is that of the Cover; steel under it is nearly rigid; validity tells of it."""
    thin, rigid, steel = (
        dataclasses.replace(RUBBER, thickness=0.01),
        vr.Material.rigid(),
        vr.Material.elastic(2e11, 0.3),
    )
    for material, base, on in ((thin, rigid, "cylinder"), (rigid, thin, "base"), (thin, steel, "cylinder")):
        roller = vr.Cylinder(R=0.1, m=30.0, material=material, base=base, mu=0.5, load=2e3)
        found, scene = roller.contact(1.0, delta=0.0), roller.scene()
        assert scene.material.on == on
        plain = scene.replace(material=vr.Cover(THREE, nu=0.49, thickness=0.01 / roller.l0, on=on))
        known = vr.contact(plain, 1.0 / roller.scale["V"], delta=0.0)
        rel = tol.SCENE if base is not steel and material is not steel else tol.COVER_ON_STEEL
        for name in ("lam", "epsilon", "delta_star", "delta_0"):
            assert close(found[name], known[name], rel=rel)
        thick = roller.validity(1.0).thick
        assert close(thick.value, 0.5 * found.length / 0.01, rel=tol.CONTACT)
        assert thick.holds
        assert roller.roll(1.0, 10.0, 0.1).validity().steady.word == "?"
        # on a slope the load, and with it l0, is less: of a scene too
        tilted = (
            each.roll(V, V, t, slope=0.5) for each, V, t in ((roller, 0.0, 0.3), (scene, 0.0, 0.3 / roller.T_ref))
        )
        assert close(
            *(each.V[-1] * unit for each, unit in zip(tilted, (1.0, roller.scale["V"]), strict=True)), rel=1e-9
        )
