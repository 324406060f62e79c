"""Motions in extended precision: the integrator, the check motions made by it, and the package against them."""

from __future__ import annotations

import csv
import math
import sys

import flint
import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from places import ROOT
from processes import made

import viscoroll as vr
from pipeline.truth import roll_precise
from pipeline.truth.collocation import radau
from pipeline.truth.load import pieces_of
from pipeline.truth.phase import Law
from pipeline.truth.precise import printed_state
from pipeline.truth.rest import begun
from pipeline.truth.solid import solid_of

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

CHECK_MOTIONS = ROOT / "data/reference/check_motions.csv"
PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
OUTPUTS = ("V", "omega", "x", "angle")


def check_motions() -> list[list[dict[str, float]]]:
    """Rows of every motion."""
    with CHECK_MOTIONS.open(encoding="utf-8", newline="") as file:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]
    return [[row for row in rows if row["motion"] == number] for number in sorted({row["motion"] for row in rows})]


def inputs(rows: list[dict[str, float]]) -> tuple:
    first = rows[0]
    return vr.Scene(*(first[name] for name in PARAMETERS)), first["V0"], first["omega0"], [row["t"] for row in rows]


class Decay:
    """u' = -u."""

    def rates(self, u):
        return [-u[0]], np.array([[-1.0]])

    def sizes(self, values, taus):
        return [1.0]


# --- the integrator ---


def test_order_of_the_collocation():
    """n nodes: the error of a step at its end falls like its length to the power 2 n, and the first is small."""
    method, errors = radau(4, 160), []
    with flint.ctx.workprec(160):
        for length in (flint.arb(0.0625), flint.arb(0.03125)):
            values = method.step(Decay(), [flint.arb(1)], [[flint.arb(1)] for _ in method.nodes], length)
            errors.append(float(abs(values[-1][0] - (-length).exp())))
    assert close(np.log2(errors[0] / errors[1]), 8.0, rel=0.025)


def test_rates_are_those_of_the_printed_law():
    """Speeds along the rates of the unknowns: V' = Q - M/2, j omega' = -(Q + M/2), Q and M as printed."""
    scene = vr.Scene(11.0, 2.91, 0.2, gamma=1.0, j=0.5)
    for V, omega in ((0.7, 0.69), (-0.7, -0.71), (1e-5, 1e-5), (0.5, 0.8), (-0.9, 0.4)):
        with flint.ctx.workprec(200):
            kappa, mu, j, zero = map(flint.arb, (scene.kappa, scene.mu, scene.j, 0))
            (free,) = pieces_of({}, zero + 1, zero, zero + 1)
            phase = begun(Law(solid_of(scene), kappa, mu, j), free, flint.arb(V), flint.arb(omega))
            u, (rates, weights), h = phase.unknowns(), phase.rates(phase.unknowns(), zero), flint.arb(10) ** -20
            change = [rate / weight for rate, weight in zip(rates, weights, strict=True)]
            ends = [phase.contact([a + d * h * b for a, b in zip(u, change, strict=True)]) for d in (1, -1)]
            found = [(up - down) / (2 * h) for up, down in zip(ends[0][:2], ends[1][:2], strict=True)]
        with mp.workdps(60):
            creep = abs((mp.mpf(omega) - V) / mp.mpf(V))
            alpha, kappa, mu = map(mp.mpf, (scene.alpha, scene.kappa, scene.mu))
            state = printed_state(mp, alpha, kappa, mu, abs(mp.mpf(V)), creep)
            Q, M = state["Q"] * mp.sign(omega - V), state["M"] * mp.sign(V)
            for ours, printed in zip(found, (Q - M / 2, -(Q + M / 2) / mp.mpf(scene.j)), strict=True):
                assert abs(mp.mpf(ours.mid().str(50, radius=False)) / printed - 1) < tol.PRECISE_RATE, (V, omega)


def test_precise_motion_refuses(monkeypatch):
    monkeypatch.setitem(sys.modules, "flint", None)
    with pytest.raises(vr.MissingDependencyError, match="python-flint"):
        roll_precise(vr.PAPER_SECTION_5, 1.0, 0.0, [1.0])


# --- the check motions ---


def test_check_motions_hold_together():
    """Fifty motions, each shown to 1e-17 by a second one, netCDF as CSV."""
    motions = check_motions()
    assert len(motions) == 50
    assert max(row["difference"] for rows in motions for row in rows) < tol.PRECISE_MOTION
    assert {rows[0]["switches"] for rows in motions} >= {0.0, 1.0, 2.0}
    with xr.open_dataset(CHECK_MOTIONS.with_suffix(".nc"), engine="h5netcdf") as data:
        for name in motions[0][0]:
            expected = np.array([[row[name] for row in rows] for rows in motions])
            expected = expected if data[name].ndim == 2 else expected[:, 0]
            assert np.array_equal(data[name], expected, equal_nan=True), name


@pytest.mark.parametrize("number", [0, 9, 10, 37])
def test_check_motions_are_found_again(number):
    """The same doubles as by an integrator in other unknowns, which made them: IC1, two of large alpha, one of 1."""
    rows = check_motions()[number]
    motion = roll_precise(*inputs(rows), nodes=18, tolerance=1e-19)
    for name in OUTPUTS:
        assert [float(value) for value in getattr(motion, name)] == [row[name] for row in rows]
    assert np.array_equal(float(motion.onset_time or math.nan), rows[0]["onset_time"], equal_nan=True)
    assert len(motion.switches) == rows[0]["switches"]


def test_check_motions_have_the_digits_of_the_theory_brief():
    """V(3e-3) and onset of IC1; where the stick zone forms again in the motion in which it vanishes."""
    paper, _, _, returning = check_motions()[:4]
    late = next(row for row in paper if row["t"] == 3e-3)
    assert close(late["V"], 0.0066003062980, rel=tol.THEORY_V)
    assert close(late["onset_time"], 1.53067404651e-4, rel=tol.THEORY_ONSET)
    assert close(returning[0]["onset_time"], 2.43862380e-3, rel=tol.RETURN_TIME)


@pytest.mark.parametrize("rtol", [1e-6, 1e-11, 1e-12])
def test_roll_has_the_check_motions(rtol):
    """V and omega over the larger of the two, x and angle over the longer way so far, onset: within 30 rtol."""
    for rows in check_motions():
        scene, V0, omega0, t = inputs(rows)
        motion = vr.roll(scene, V0, omega0, t, rtol=rtol)
        best = {name: np.array([row[name] for row in rows]) for name in OUTPUTS}
        size = np.maximum(abs(best["V"]), abs(best["omega"]))
        path = np.maximum.accumulate(np.maximum(abs(best["x"]), abs(best["angle"])))
        for name, scale in (("V", size), ("omega", size), ("x", path), ("angle", path)):
            assert np.all(abs(getattr(motion, name) - best[name]) <= tol.MOTION_RTOL * rtol * scale), (name, rows[0])
        onset = rows[0]["onset_time"]
        assert np.array_equal(motion.onset_time, onset, equal_nan=True) or (
            abs(motion.onset_time / onset - 1.0) <= tol.MOTION_RTOL * rtol
        )
        assert len(motion.switches) == rows[0]["switches"]


def test_flow_map_has_the_check_motions():
    """The paper's IC1-IC3, of one scene: speeds over the larger of the two, to the error that a map may have."""
    for rows in check_motions()[:3]:
        scene, V0, omega0, t = inputs(rows)
        found = vr.ensemble(scene, [V0], [omega0], t, method="flow")
        best = {name: np.array([row[name] for row in rows]) for name in ("V", "omega")}
        size = np.maximum(abs(best["V"]), abs(best["omega"]))
        assert found.flow.all()
        for name in best:
            assert np.all(abs(getattr(found, name)[0] - best[name]) <= tol.FLOW_SPEED * size), (name, rows[0])
        assert abs(found.onset_time[0] / rows[0]["onset_time"] - 1.0) <= tol.FLOW_ONSET


def test_picture_of_tolerance_and_error(tmp_path):
    """From the stored proofs."""
    picture = tmp_path / "errors.png"
    made("prove.figures", "-o", picture)
    assert picture.read_bytes()[1:4] == b"PNG"


# --- motions that were hard ---

#: full slip returns, for the stick zone has nearly but not quite room: condition 89 of the last speed
GRAZING = (
    vr.Scene(510.45568653962954, 0.5247852814242023, 2.557735474381976, 2.8000965315322106, 0.7782976106082509),
    -1.2809180933345572, 1.4667094740472884, 0.25837168600422666,
)  # fmt: skip
#: slip returns; the stick zone shrank from 20/alpha to 2/alpha in a step whose error estimate was 0 by chance
BENDING = (
    vr.Scene(936.5925299237001, 0.6144945288743532, 0.022619873900494563, 1.0, 0.18263280814885985),
    0.4938428317294208, 1.7474727257674805, 9.978466226360105,
)  # fmt: skip
#: the stick zone is halved at a falling rate: steps that are cut to half of it must not creep toward that
HALVING = (
    vr.Scene(172.1000522201097, 0.7911613660857378, 0.03771641938561012, 1.0, 1.5535530713756633),
    1.6278781526483272, 1.1102379559631137, 9.313033983515185,
)  # fmt: skip
#: delta passes through 0 in a boundary layer that is hardly stiff
CROSSING = (
    vr.Scene(2.6582482816051427, 0.703710794728877, 1.404317490066254, 7083834.831610067, 1.8204264337721243),
    1.4929857172733687, 0.0, 3.1332148766490937e-06,
)  # fmt: skip
#: the slow manifold begins where half of the contact slips
LOADED = (
    vr.Scene(1618.4781012859387, 0.8432381068506855, 0.014504634382489416, 61.33319650094108, 0.12235383260228083),
    -1.301111868560695, 10.63400991115697, 1.5016933731025053,
)  # fmt: skip
#: a start inside the stick zone with omega = 0
INSIDE = (
    vr.Scene(8.805956049844358, 0.54549940082077, 2.04978711424485, 0.008791919479357162, 0.7989734039318818),
    1.8040919247831977, 0.0, 136.42696692393858,
)  # fmt: skip
#: pure rolling, on the slow manifold from the start
ROLLING = (
    vr.Scene(4411.155165510711, 189.80142791395932, 0.02033499264745895, 0.004045450481881663, 0.16349020421702037),
    -1.8692720154256754, -1.8692720154256754, 136.36735558784045,
)  # fmt: skip


def test_slip_that_returns_in_passing():
    """One rtol in every input, the condition number times rtol, is the bound; measured 18.

    A step over the end of the stick zone, where the law bends, is no better than the one that ends on it.
    """
    scene, V0, omega0, end = GRAZING
    best = vr.roll(scene, V0, omega0, [end], rtol=1e-12)
    for rtol in np.geomspace(1e-7, 1e-11, 60):
        motion = vr.roll(scene, V0, omega0, [end], rtol=rtol)
        assert abs(motion.V[0] / best.V[0] - 1.0) <= tol.GRAZING_CONDITION * rtol


def test_slip_that_returns_at_great_alpha():
    """Measured 1.3."""
    scene, V0, omega0, end = BENDING
    t = [0.5 * end, end]
    best = roll_precise(scene, V0, omega0, t, nodes=12, tolerance=1e-15)
    for rtol in np.geomspace(1e-6, 1e-11, 51):
        motion = vr.roll(scene, V0, omega0, t, rtol=rtol)
        assert np.all(abs(motion.V / [float(V) for V in best.V] - 1.0) <= tol.MOTION_RTOL * rtol)


def test_stick_zone_that_shrinks_and_stays():
    scene, V0, omega0, end = HALVING
    for rtol in (1e-4, 1e-6, 1e-8):
        motion = vr.roll(scene, V0, omega0, [0.5 * end, end], rtol=rtol, max_steps=300)
        assert motion.status == vr.MotionStatus.DONE


def test_delta_through_zero_within_a_step():
    """The slope of the rates jumps there: no step may reach beyond by more than its tolerance allows.  Measured 3.4."""
    scene, V0, omega0, end = CROSSING
    best = roll_precise(scene, V0, omega0, [0.1 * end, end])
    for rtol in np.geomspace(1e-9, 1e-12, 13):
        motion = vr.roll(scene, V0, omega0, [0.1 * end, end], rtol=rtol)
        for name in ("V", "omega"):
            exact = np.array([float(value) for value in getattr(best, name)])
            assert np.all(abs(getattr(motion, name) / exact - 1.0) <= tol.MOTION_RTOL * rtol)


def test_slow_manifold_is_entered_where_much_of_the_contact_slips():
    """An interval too long for its manifold is shortened: no more steps for want of a layer that is over."""
    scene, V0, omega0, end = LOADED
    motion = vr.roll(scene, V0, omega0, [end], rtol=1e-11, max_steps=300)
    assert motion.status == vr.MotionStatus.DONE


@pytest.mark.filterwarnings("ignore:roll")
def test_start_without_rotation_inside_the_stick_zone_at_the_tightest_tolerance():
    scene, V0, omega0, end = INSIDE
    assert vr.roll(scene, V0, omega0, [end], rtol=1e-12, max_steps=2000).status == vr.MotionStatus.DONE


def test_distance_early_in_an_interval_of_the_slow_manifold():
    scene, V0, omega0, end = ROLLING
    t = [1e-3 * end]
    best = float(roll_precise(scene, V0, omega0, t).x[0])
    for rtol in np.geomspace(1e-10, 1e-12, 20):
        x = vr.roll(scene, V0, omega0, [*t, end], rtol=rtol).x[0]
        assert abs(x / best - 1.0) <= tol.MOTION_RTOL * rtol
