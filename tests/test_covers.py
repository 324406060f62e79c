"""Covers of finite thickness: limits, closed forms, more terms, balances; against boundary elements: make prove."""

import ctypes
import json
import shutil
import subprocess

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refused

import viscoroll as vr
from data.reference import layer as elastic_layer
from pipeline.evidence.prove import layer
from viscoroll.materials.law.cover_rows import solve_at_speed
from viscoroll.materials.law.cover_solve import CoverModes, solve

ONE, THREE = vr.Prony([10.0], [1.0 / 11.0]), vr.Prony([2.0, 6.0, 3.0], [1.0, 0.1, 0.003])
KAPPA, MU = 10.0, 0.3
THIN, RIGID = vr.Material(2e6, 0.49, THREE, 0.1, thickness=0.01), vr.Material.rigid()
#: a cover of nu = 1/2 on the roller, one of a compressible belt, one beside an elastic body
COVERS = (
    vr.Cover(THREE, nu=0.5, thickness=0.5),
    vr.Cover(ONE, nu=0.3, thickness=1.0, on="base"),
    vr.Cover(THREE, nu=0.45, thickness=2.0, part=0.8, other_nu=0.3),
)
#: what is known beside a body that relaxes too
BESIDE = "lam", "zeta", "epsilon", "delta_star", "delta", "M"


def roller_of(material: vr.Material, base: vr.Material, load: object = 2e3) -> vr.Cylinder:
    return vr.Cylinder(R=0.1, m=30.0, material=material, base=base, mu=0.5, load=load)


def scene_on(cover: object, **more: float) -> vr.Scene:
    return vr.Scene(material=cover, kappa=KAPPA, mu=MU, gamma=0.5, **more)


@pytest.mark.parametrize(("p", "other", "part"), [(ONE, None, 1.0), (THREE, None, 1.0), (THREE, ONE, 0.6)])
def test_a_thick_cover_is_a_half_space(p, other, part):
    """At speeds where the memory, V T over l0, does not reach the core; beside a body that relaxes without slip."""
    half = scene_on(vr.Bodies(p, other or vr.Prony.elastic(), part))
    cover = scene_on(vr.Cover(p, nu=0.5, thickness=1e10, part=part, other=other))
    V, creep = np.meshgrid(10.0 ** np.linspace(-13.0, 1.0, 29), [1e-3, 0.5, 0.99])
    delta = creep * vr.contact(half, V, delta=0.0, fields="delta_star").delta_star
    free = 0.0 if other else vr.contact(cover, V, delta=0.0, fields="delta_0").delta_0
    known, found = vr.contact(half, V, delta=delta), vr.contact(cover, V, delta=delta + free)
    assert np.abs(free).max() < tol.COVER_THICK
    assert (tuple(found.keys()) == BESIDE) == (other is not None)
    for name in BESIDE if other else ("lam", "epsilon", "delta_star", "M", "M_cylinder", "Q"):
        assert close(found[name], known[name], rel=tol.COVER_THICK, scale=MU * (name == "Q"), what=name)
    x, V = np.meshgrid(np.linspace(-1.5, 2.5, 101), [0.0, 1e-6, 1e-3, 0.1, 10.0, -1.0])
    known, found = vr.stress(half, x, V, delta=0.0), vr.stress(cover, x, V, delta=0.0)
    assert close(found.p, known.p, rel=tol.COVER_PRESSURE, scale=known.p.max())
    assert list(found.keys()) == ["p"]


@pytest.mark.parametrize("cover", COVERS)
def test_rows_are_the_solve(cover):
    """With twice as many terms of the pressure; slow and fast these lose digits of epsilon."""
    u = 10.0 ** np.linspace(-12.0, 12.0, 33)
    truth = np.array([solve_at_speed(cover, each, orders=60) for each in u]).T
    found = vr.contact(scene_on(cover), u / KAPPA, delta=0.0)
    assert close(found.lam, truth[0], rel=tol.COVER_ROWS)
    assert close(2.0 * KAPPA / MU * found.delta_star, truth[1], rel=tol.COVER_ROWS)
    assert close(found.epsilon, truth[3], rel=tol.COVER_ROWS, scale=1.0)
    assert close(KAPPA * found.M, u * truth[4], rel=tol.COVER_ROWS)
    side, rel = (1.0 if cover.on == "base" else -1.0), tol.COVER_ROWS if cover.nu == 0.5 else tol.COVER_FREE
    assert close(2.0 * KAPPA * found.delta_0, side * truth[2], rel=rel, scale=1.0)


def test_rows_join():
    """Where rates are twelve decades apart, nothing jumps at the ends of octaves."""
    wide = vr.Prony(np.logspace(-1.0, 0.5, 20), np.logspace(3.0, -9.0, 20))
    V = np.array([[1.0 - 1e-15], [1.0 + 1e-15]]) * 2.0 ** np.arange(-20, 90) / KAPPA
    c = vr.contact(scene_on(vr.Cover(wide, nu=0.5, thickness=0.2)), V, delta=0.0)
    for name in ("lam", "epsilon", "delta_star", "M"):
        assert close(*c[name], rel=tol.COVER_JOIN, what=name)


@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_an_elastic_cover(nu):
    """Its load at half width 1 is that of another solution (make prove); delta_0 of a thick one is in closed form."""
    found = vr.contact(scene_on(vr.Cover(1.0, nu=nu, thickness=1.0)), 1.0, delta=0.0)
    assert found.M == 0.0
    assert close(found.lam**2 * elastic_layer.load(2.0 / found.lam, nu), 1.0, rel=tol.COVER_ELASTIC)
    thick = vr.contact(scene_on(vr.Cover(1.0, nu=nu, thickness=1e12, on="base")), 1.0, delta=0.0)
    assert close(thick.delta_0, -(0.5 - nu) / (1.0 - nu) * 4.0 / (3.0 * np.pi * KAPPA), rel=tol.COVER_LOCAL, scale=1e-3)
    alike = vr.Cover(1.0, nu=nu, thickness=1e12, part=0.5, other_nu=nu)
    assert abs(vr.contact(scene_on(alike), 1.0, delta=0.0).delta_0) < tol.COVER_THICK


def test_a_thin_compressible_cover_is_a_foundation():
    """To a first order in the thickness, whose extrapolation is ten times as near."""
    modes = CoverModes(vr.Cover(ONE, nu=0.0, thickness=1.0))
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


#: on either side of an octave; elastic, with a Poisson's ratio each
MANY = vr.Cover(ONE, nu=0.3, thickness=[0.45, 0.55, 0.45], on="base")
MANY_NU = vr.Cover(1.0, nu=[0.0, 0.5, 0.33], thickness=[0.3, 0.55, 0.45])


@pytest.mark.parametrize("cover", [MANY, MANY_NU])
def test_a_thickness_each(cover):
    """States and motions of many covers are those of each."""
    scene, V = scene_on(cover), np.array([0.01, -0.5, 3.0])
    found, motions = vr.contact(scene, V, delta=-2e-3, slopes=True), vr.ensemble(scene, V, 0.1, [1.0, 9.0], rtol=1e-10)
    for n, each in enumerate(cover):
        one = scene.replace(material=each)
        for name, value in vr.contact(one, V[n], delta=-2e-3, slopes=True).as_dict().items():
            assert close(found[name][n], value, rel=tol.COVER_EACH, what=name)
        assert close(motions.V[n], vr.roll(one, V[n], 0.1, [1.0, 9.0], rtol=1e-10).V, rel=tol.COVER_EACH_MOTION)


def test_a_load_each():
    """Cylinders whose loads, and with them thicknesses over l0, differ."""
    load = np.array([1.2e3, 1.7e3])
    rollers = roller_of(THIN, RIGID, load)
    M = [rollers.replace(load=each).contact(1.0, delta=0.0).M for each in load]
    assert close(rollers.contact(1.0, delta=0.0).M, M, rel=tol.COVER_EACH)
    assert rollers.validity(1.0).thick.value.shape == (2,)


def test_a_law_on_disk(tmp_path):
    """Bit for bit, with its bodies, in JSON too; it is refused where load or radius make another thickness over l0."""
    roller = roller_of(THIN, vr.Material.elastic(3e9, 0.3))
    for known, bodies, more in ((scene_on(COVERS[2]), COVERS[2], {}), (roller, roller, {"base": None})):
        dataset = vr.tables.law(bodies)
        vr.tables.save(dataset, tmp_path / "law.nc")
        vr.tables.export(dataset, tmp_path / "law.json")
        content = json.loads((tmp_path / "law.json").read_text())
        assert all(np.array_equal(content[name], dataset[name].values) for name in ("lam", "limit", "free"))
        law = vr.load_law(tmp_path / "law.nc")
        found = known.replace(material=law, **more)
        V = np.logspace(-6, 6, 13)
        for name, values in vr.contact(found, V, delta=1e-3).as_dict().items():
            assert np.array_equal(values, vr.contact(known, V, delta=1e-3)[name])
    assert law.pair == roller.pair
    refused(lambda: found.replace(load=2.1e3).contact(1.0, delta=0.0), "material", "thickness/l0 = 0.5", "0.49")


#: a layer beside a body that relaxes too, and one that is elastic itself there
TWO_RELAXING = vr.Cover(THREE, nu=0.3, thickness=0.4, part=0.6, other=ONE)
ELASTIC_LAYER = vr.Cover(1.0, nu=0.5, thickness=0.8, part=0.3, other=THREE, on="base")


@pytest.mark.parametrize("cover", [*COVERS, TWO_RELAXING, ELASTIC_LAYER])
@pytest.mark.parametrize("V", [0.0, 2e-3, 0.04, 0.2])
def test_pressure_of_a_cover_makes_the_parabola(cover, V):
    """Its integral is the load, its moment M, and the slope that both bodies take on, by Fourier's transform with the
    kernel of the layer, is x/R in the contact.

    Much faster the memory would reach round the period of the transform."""
    scene = scene_on(cover)
    c = vr.contact(scene, V, delta=0.0, fields=("lam", "epsilon", "M", "zeta"))
    nodes = np.pi * np.arange(1, 400) / 400.0
    y, weights = np.cos(nodes), np.sin(nodes) * np.pi / 400.0

    def p(y):
        return vr.stress(scene, 0.5 * c.lam * (c.epsilon + y), V, delta=0.0).p

    load = 1.0 / (32.0 * KAPPA)
    assert close(0.5 * c.lam * weights @ p(y), load, rel=tol.COVER_PRESSURE)
    moment = 0.25 * c.lam**2 * weights @ (p(y) * (y + c.epsilon)) / (load * KAPPA)
    assert close(moment, c.M, rel=tol.COVER_MOMENT, scale=max(abs(c.M), c.lam))
    count, cells = 1 << 17, 256
    grid = (np.arange(count) - count // 2 + 0.5) / cells
    v = 2.0 * np.pi * np.fft.rfftfreq(count, 1.0 / cells)
    layer_of = elastic_layer.kernel(2.0 * v * cover.thickness / c.lam, cover.nu)

    def compliance(series):
        b = 1.0 / series.T
        return 1.0 / series.alpha + (series.J * b / (b - 1j * (v / c.zeta)[:, None])).sum(axis=1)

    def slope(pressure, kernel):
        return np.fft.irfft(-1j * kernel * np.fft.rfft(pressure), count)

    kernel = cover.part * compliance(cover.layer) * layer_of + (1.0 - cover.part) * compliance(cover.other)
    near = np.abs(grid) < 0.8
    hertz = slope(np.sqrt(np.maximum(1.0 - grid**2, 0.0)) / (8.0 * np.pi * KAPPA), np.ones(v.size))
    unit = np.mean(hertz[near] / grid[near])
    found = slope(p(grid), kernel)[near]
    assert close(found, unit * c.lam * (grid + c.epsilon)[near], rel=tol.COVER_SLOPE, scale=abs(unit) * c.lam)


def test_a_layer_beside_a_body_that_relaxes():
    """In SI units it is that of its scene; what needs the split of M is left out."""
    roller = roller_of(vr.Material(1e7, 0.3, ONE, 0.02), THIN)
    assert roller.scene().material.other == ONE
    assert roller.scene().material.layer == THREE.slower(0.1 / 0.02)
    assert set(roller.contact(1.0, delta=0.0).keys()) == {*BESIDE, "length", "C_rr"}


#: evaluates the header for arrays of states, as the fields and slopes below
C_STATES = """#include "cover.h"
void states(int n, double kappa, double mu, const double *V, const double *slip, double *out) {
  for (int i = 0; i < n; i++) {
    vr_state s, t = vr_contact(&cover, kappa, mu, V[i], slip[i]);
    vr_slopes d;
    vr_contact_slopes(&cover, kappa, mu, V[i], slip[i], &s, &d);
    double all[] = {s.lam, s.epsilon, s.delta_star, s.delta_0, t.beta, t.Q, s.M, s.M_half_space, s.M_cylinder, d.dQ_dV,
                    d.dQ_domega, d.dM_dV};
    for (int k = 0; k < 12; k++) out[12 * i + k] = all[k];
  }
}
"""
C_FIELDS = ("lam", "epsilon", "delta_star", "delta_0", "beta", "Q", "M", "M_half_space", "M_cylinder")
C_FIELDS += ("dQ_dV", "dQ_domega", "dM_dV")


@pytest.mark.skipif(shutil.which("cc") is None, reason="not installed: cc")
@pytest.mark.parametrize("cover", COVERS)
def test_the_header_of_C_is_the_contact(tmp_path, cover):
    """In rows and behind them, forwards and backwards, below and above full slip, with slopes; N is NaN."""
    vr.tables.export(vr.tables.law(cover), tmp_path / "cover.h")
    (tmp_path / "states.c").write_text(C_STATES)
    flags = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC", "states.c", "-lm", "-o", "states.so")
    subprocess.run([shutil.which("cc"), *flags], cwd=tmp_path, check=True)
    scene, speeds = scene_on(cover), 10.0 ** np.linspace(-6.0, 14.0, 61)
    V, part = (each.ravel() for each in np.meshgrid([*speeds, *-speeds], [-1.4, -0.6, -0.05, 1e-2, 0.3, 0.97, 1.2]))
    limit = vr.contact(scene, V, delta=0.0, fields=("delta_star", "delta_0"))
    omega = V * (1.0 + limit.delta_0 + part * limit.delta_star)
    slip, out = omega - V, np.empty((V.size, len(C_FIELDS)))
    pointers = (ctypes.c_void_p(array.ctypes.data) for array in (V, slip, out))
    ctypes.CDLL(str(tmp_path / "states.so")).states(V.size, ctypes.c_double(KAPPA), ctypes.c_double(MU), *pointers)
    known = vr.contact(scene, V, omega=omega, slopes=True, fields=C_FIELDS)
    for name, values in zip(C_FIELDS, out.T, strict=True):
        scale = np.abs(known[name]).max() if name in ("Q", "beta", "delta_0") else np.abs(known[name])
        assert close(values, known[name], rel=tol.COVER_IN_C, scale=scale, what=name)


def test_a_bound_law_is_the_contact():
    """To the bit, at any speed."""
    scene = scene_on(COVERS[1])
    law = vr.law(scene)
    for V in (0.0, 1e-9, -0.03, 7.0, 1e13):
        for omega in (V * 1.001, -V, 0.2):
            if V or omega:
                state = vr.contact(scene, V, omega=omega, fields=law(V, omega, slopes=True)._fields)
                assert tuple(state.as_dict().values()) == law(V, omega, slopes=True)


#: (force, torque): constant, with a feedback on omega, and with one whose gains cancel in the sum
LOADS = [
    (0.0, 0.004), (0.004, 0.0), (-0.197, 0.2), (vr.Feedback(0.004), vr.Feedback(0.02, omega=-0.4)),
    (vr.Feedback(-0.01, omega=0.4), vr.Feedback(0.02, omega=-0.4)),
]  # fmt: skip


@pytest.mark.parametrize("cover", COVERS)
def test_equilibria(cover):
    """Forces balance at what is found; at rest they are the limit of slow rolling."""
    scene = scene_on(cover)
    for loads in LOADS:
        s = vr.steady(scene, force=loads[0], torque=loads[1])
        c = vr.contact(scene, s.V, omega=s.omega)
        force, torque = (getattr(each, "value", each) + (getattr(each, "omega", 0) or 0) * s.omega for each in loads)
        assert s.V.size
        assert close(c.Q - c.M_half_space + force, 0.0 * s.V, rel=tol.COVER_STEADY, scale=1.0)
        assert close(torque - c.Q - c.M_cylinder, 0.0 * s.V, rel=tol.COVER_STEADY, scale=1.0)
        assert close(s.beta, c.beta, rel=tol.COVER_STEADY)
    rest, slow = vr.steady(scene, force=0.1, torque=-0.1), vr.steady(scene, V=1e-12, torque=-0.1)
    assert close(rest.delta, slow.delta, rel=tol.COVER_REST)


def test_a_thickness_in_SI_units():
    """A Material's thickness over l0 is that of the Cover; steel under it is nearly rigid; validity tells of it."""
    steel = vr.Material.elastic(2e11, 0.3)
    for material, base, on in ((THIN, RIGID, "cylinder"), (RIGID, THIN, "base"), (THIN, steel, "cylinder")):
        roller = roller_of(material, base)
        found, scene = roller.contact(1.0, delta=0.0), roller.scene()
        assert scene.material.on == on
        plain = scene.replace(material=vr.Cover(THREE, nu=0.49, thickness=0.01 / roller.l0, on=on))
        known = vr.contact(plain, 1.0 / roller.scale["V"], delta=0.0)
        for name in ("lam", "epsilon", "delta_star", "delta_0"):
            assert close(found[name], known[name], rel=tol.COVER_ON_STEEL if base is steel else tol.SCENE)
        thick = roller.validity(1.0).thick
        assert close(thick.value, 0.5 * found.length / 0.01, rel=tol.CONTACT)
        assert thick.holds
        assert roller.roll(1.0, 10.0, 0.1).validity().steady.word == "?"
        # on a slope the load, and with it l0, is less: of a scene too
        tilted = roller.roll(0.0, 0.0, 0.3, slope=0.5).V, scene.roll(0.0, 0.0, 0.3 / roller.T_ref, slope=0.5).V
        assert close(tilted[0][-1], tilted[1][-1] * roller.scale["V"], rel=1e-9)
