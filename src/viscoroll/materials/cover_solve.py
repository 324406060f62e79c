"""Steady rolling on a bonded viscoelastic layer of finite thickness, solved by Chebyshev polynomials.

Plane strain, a constant Poisson's ratio, one Prony series; the layer is bonded to a rigid core or bed and the other
body is rigid or an elastic half-space.  The pressure is not changed by shear, as everywhere in this package.

Notation.  z is the half length of the contact over V T_ref, theta the half length over the thickness h, u = k h the
wave number times the thickness, v = u theta.  Slopes and creep are over V T_ref/R.  The pressure over E'/(4 pi) is
sqrt(1 - x^2) sum q_m U_{m-1}(x) for x in [-1, 1].  With relaxation rates a_i and creep rates b_j the exponents on the
contact are alpha_i = a_i z and beta_j = b_j z.

The transforms of the surface displacements of the layer are those of a half-space times L (normal displacement by
pressure), T (tangential displacement by shear) and C (tangential displacement by pressure).  L - 1 decays like
exp(-2 u): the layer adds a smooth operator S to the Hilbert transform, and to the memory of each creep mode an excess
c.  The unknowns are the coefficients q up to order N = 14 + 6 theta; the exponentials of the relaxation modes enter by
their first N coefficients, so that alpha may be arbitrarily large.

Sources of the method: the law of the half-space in closed form (:mod:`.law_modes`), and the layer's kernels as in
Johnson, Contact Mechanics (1985), Sect. 5.8.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..core.array_types import Floats
from .law_modes import series_of
from .prony import Prony

#: terms of the pressure: these many, and so many for each unit of theta (found by doubling them: 3e-14 up to theta = 1)
_TERMS, _TERMS_PER_THETA = 14, 6
#: largest half length over thickness; there doubling the terms still changes results by less than 1e-10
MOST_THETA = 6.0
#: trapezoidal rule in s for integrals over u = 0.6 ln(1 + e^s): step, and ends where the integrands are below rounding
_STEP, _SCALE, _FIRST, _LAST = 0.3, 0.6, -26.0, 20.0 / 0.6
#: likewise over t = 2 ln(1 + e^s) for the decay of the memory of one polynomial
_DECAY_STEP, _DECAY_SCALE, _DECAY_FIRST, _DECAY_LAST = 0.14, 2.0, -33.0, 18.0
#: arguments beyond which ratios of Bessel functions of the orders here are 1 to rounding
_LARGE, _LARGEST = 1e8, 1e12
#: points in t = arccos x at which the local strain is added up
_POINTS = 512


class LayerNodes(NamedTuple):
    """What depends on Poisson's ratio alone, at the nodes u of the integrals over the wave number.

    u, du : nodes and weights.  L, T : (L - 1)/u and (T - 1)/u times the weights.  C : C less its limit for short waves.
    local : that limit, (1 - 2 nu)/(2 - 2 nu), the coupling of a half-space.
    """

    u: Floats
    du: Floats
    L: Floats
    T: Floats
    C: Floats
    local: float


class CoverState(NamedTuple):
    """The contact at one half length z and one theta; slopes and creep over V T_ref/R.

    load : H = P/(pi/2) in the units of the pressure, z^2 for an elastic half-space.
    shift : g, the shift of the contact ahead of the axis.
    moment : M/(P V).
    creep_limit : delta_star/(mu V), the creep from which on all of the contact slips.
    strain : what of the strain of the layer's surface by the pressure, weighted with the pressure, comes of the finite
        thickness; positive where the surface is stretched.  :func:`local_strain` is the rest.
    q, X : terms of the pressure, and amplitudes of the relaxation modes.
    """

    load: float
    shift: float
    moment: float
    creep_limit: float
    strain: float
    q: Floats
    X: Floats


class CoverModes:
    """The series of a cover as the solve takes it; made once a cover.

    Parameters
    ----------
    layer : series of the layer.
    total : series of both bodies together, the layer's own where the other body is rigid.
    share : the layer's part of the long-time compliance, in (0, 1].
    nu, other_nu : Poisson's ratios of the layer and of the other body.
    other : series of the other body; default: elastic.
    """

    def __init__(
        self, layer: Prony, total: Prony, share: float, nu: float, other_nu: float, other: Prony | None = None
    ) -> None:
        modes = total.modes
        self.alpha = float(total.alpha)
        self.a, self.b, self.J = modes.a, modes.b, modes.J
        self.e, self.t = np.sqrt(modes.E / modes.a), np.sqrt(modes.J / modes.b)
        self.Q = series_of(modes).Q
        self.share, self.nodes, self.nus = share, layer_nodes(nu), (nu, other_nu)
        self.layer_J, self.layer_b = share * layer.J, 1.0 / layer.T
        self.layer_instant = share / float(layer.alpha)
        self.other, self.other_local = Prony.elastic() if other is None else other, (1.0 - share) * _local(other_nu)

    def elastic(self, share: float) -> CoverModes:
        """The same bodies without relaxation, with this share of the compliance."""
        return CoverModes(Prony.elastic(), Prony.elastic(), share, *self.nus)

    def compliance(self, k: Floats) -> Any:
        """Complex compliance of both bodies at wave numbers k over 1/(V T_ref), for exp(i k Y)."""
        return 1.0 / self.alpha + (self.J * self.b / (self.b - 1j * k[:, None])).sum(axis=1)

    def layer_part(self, k: Floats) -> Any:
        """Return the layer's part of :meth:`compliance` at wave numbers k over 1/(V T_ref): complex, or 1.0 if all."""
        if self.share == 1.0:
            return 1.0
        b = 1.0 / self.other.T
        other = 1.0 / self.other.alpha + (self.other.J * b / (b - 1j * k[:, None])).sum(axis=1)
        return 1.0 - (1.0 - self.share) * other / self.compliance(k)

    def layer_storage(self, k: Floats) -> Any:
        """Real part of the layer's share of that compliance."""
        return self.layer_instant + (self.layer_J * (self.layer_b**2 / (self.layer_b**2 + k[:, None] ** 2))).sum(axis=1)


def _local(nu: float) -> float:
    """Coupling C of a half-space."""
    return (1.0 - 2.0 * nu) / (2.0 - 2.0 * nu)


@lru_cache(maxsize=64)
def layer_nodes(nu: float) -> LayerNodes:
    """The nodes for one Poisson's ratio.

    Dense towards u = 0, where slow memories put poles at u = i beta/theta; in s the rule converges exponentially.
    """
    s = np.arange(_FIRST, _LAST, _STEP)
    u, du = _SCALE * np.logaddexp(0.0, s), _STEP * _SCALE / (1.0 + np.exp(-s))
    kap, e = 3.0 - 4.0 * nu, np.exp(-2.0 * u)
    below = kap * (1.0 + e * e) + (4.0 * u * u + 1.0 + kap * kap) * e
    rest = (2.0 * kap * e + 4.0 * u * u + 1.0 + kap * kap) * e
    local = (kap - 1.0) / (kap + 1.0)
    coupling = (kap * (kap - 1.0) * (1.0 - e) ** 2 - 8.0 * u * u * e) / ((kap + 1.0) * below) - local
    per = du / (u * below)
    return LayerNodes(u, du, -per * (rest + 4.0 * u * e), -per * (rest - 4.0 * u * e), coupling, local)


def bessel(v: Floats, order: int) -> Floats:
    """J_0 ... J_order at v >= 0, each with the sign (-1)^(n//2), [order, place], to 1e-15 absolute.

    They are the Chebyshev coefficients of cos(v x) and sin(v x), by a discrete sum long enough for aliases to vanish.
    """
    count = (int(v.max() + 0.5 * order) + 24) & ~1
    phi = (np.arange(count // 2) + 0.5) * (math.pi / count)
    arguments = np.multiply.outer(np.cos(phi), v)
    cosines = np.cos(np.arange(order + 1)[:, None] * phi) * (2.0 / count)
    found = np.empty((order + 1, v.size))
    found[::2], found[1::2] = cosines[::2] @ np.cos(arguments), cosines[1::2] @ np.sin(arguments)
    return found


@lru_cache(maxsize=1)
def _decay_nodes() -> tuple[Floats, Floats]:
    """(2 sinh^2(t/2) at the nodes of t, weights times exp(-n t), [order, node])."""
    s = np.arange(_DECAY_FIRST, _DECAY_LAST, _DECAY_STEP)
    t = _DECAY_SCALE * np.logaddexp(0.0, s)
    weights = _DECAY_STEP * _DECAY_SCALE / (1.0 + np.exp(-s)) * np.sinh(t)
    orders = np.arange(_orders(MOST_THETA) * 2 + 1)[:, None]
    return 2.0 * np.sinh(0.5 * t) ** 2, np.exp(-orders * t) * weights


def _decays(beta: Floats, order: int) -> Floats:
    """D_n(beta) = beta int_1^inf exp(-beta (x - 1)) (x - sqrt(x^2 - 1))^n dx, [order, mode]."""
    beta = np.minimum(beta, _LARGEST)
    rise, weights = _decay_nodes()
    return weights[: order + 1] @ np.exp(-rise[:, None] * beta) * beta


def _orders(theta: float) -> int:
    return math.ceil(_TERMS + _TERMS_PER_THETA * theta)


class _Exponentials(NamedTuple):
    """The relaxation and creep modes on a contact of half length z, as of the half-space.

    ratio : I_n/I_0 of alpha, [order, mode].  root : sqrt(I_1/I_0).  k : K_0/K_1 of beta.
    x : B^-1 sqrt(r) (e, Q^T), the matching at the front edge, of the half-space and of a source by each creep mode.
    sigma : what an excess memory of 1 is as such a source.
    """

    ratio: Floats
    root: Floats
    k: Floats
    x: Floats
    sigma: Floats


def _exponentials(modes: CoverModes, z: float, N: int) -> _Exponentials:
    """Those of N orders."""
    from scipy.special import ive, k0e, k1e

    alpha, beta = np.minimum(modes.a * z, _LARGE), modes.b * z
    ratio = ive(np.arange(N + 1)[:, None], alpha) / ive(0, alpha)
    root, k = np.sqrt(ratio[1]), k0e(beta) / k1e(beta)
    B = np.eye(root.size) + root[:, None] * ((modes.Q.T * k) @ modes.Q) * root
    x = np.linalg.solve(B, np.column_stack([root * modes.e, root[:, None] * modes.Q.T]))
    return _Exponentials(ratio, root, k, x, np.sqrt(modes.J * modes.b) / (beta * k1e(beta)))


def _layer_operator(v: Floats, A: Floats, beta: Floats, weights: Any) -> tuple[Floats, Floats]:
    """What the layer adds to the slope and to the memory.

    Parameters
    ----------
    v, A : u theta at the nodes, and the signed Bessel functions there.
    beta : b_j z.
    weights : (L - 1)/u times the weights of the rule and the layer's part of the compliance; complex where that is < 1.

    Returns
    -------
    S : (N + 1, N), the slope is sum (S q)_n T_n.
    c : (modes, N), c q is the excess memory of that slope in each creep mode.
    """
    N = len(A) - 1
    n, m = np.arange(N + 1), np.arange(1, N + 1)
    odd, apart = m % 2 == 1, (n[:, None] + m) % 2 == 1
    S = 2.0 * (A @ (A[1:] * np.real(weights)).T) * m
    S[apart] = 0.0
    if np.iscomplexobj(weights):
        S[apart] = (2.0 * (A @ (A[1:] * weights.imag).T) * np.where(odd, m, -m))[apart]
    S[0] *= 0.5
    # excess memory of exp(i v x): its own less that of its Chebyshev series, which decays
    D = _decays(beta, N)
    memory = np.exp(1j * v) * (beta[:, None] / (beta[:, None] - 1j * v)) - A[0]
    memory -= 2.0 * (D[2::2].T @ A[2::2]) + 2j * (D[1::2].T @ A[1::2])
    weighted = memory * weights
    return S, np.where(odd, weighted.imag @ A[1:].T, weighted.real @ A[1:].T) * m


def solve(modes: CoverModes, z: float, theta: float, orders: int | None = None) -> CoverState:
    """The contact of half length ``z`` (over V T_ref) and ``theta`` (over the thickness); one linear system.

    Parameters
    ----------
    modes : of the cover.
    z, theta : both > 0, theta <= 6.
    orders : terms of the pressure; default 14 + 6 theta.

    Returns
    -------
    CoverState
        Against boundary elements: 2e-6 (``pipeline/evidence/prove/cover.py``).  For theta -> 0 the half-space's.
    """
    nodes, N = modes.nodes, orders or _orders(theta)
    v = nodes.u * theta
    A, J = bessel(v, N), modes.compliance(v / z)
    part = modes.layer_part(v / z)
    ratio, root, k, x, sigma = _exponentials(modes, z, N)
    X0, Xi = modes.e / root * x[:, 0], (modes.e / root)[:, None] * x[:, 1:] * sigma
    S, c = _layer_operator(v, A, modes.b * z, nodes.L * part)
    Phi = 2.0 * ratio[1:]
    right = Phi @ X0
    right[0] += z
    q: Any = np.linalg.solve(np.eye(N) + S[1:] + Phi @ (Xi @ c), right)
    excess = sigma * (c @ q)
    # T_mean - sum X + s_0 without cancellation
    shift: Any = modes.t @ (k * (modes.Q @ (root * (x[:, 0] - x[:, 1:] @ excess)))) + modes.t @ excess + S[0] @ q
    moment = shift + z * q[1] / (2.0 * q[0])
    # transform of the pressure over pi z, times v: its even and odd terms
    mq = np.arange(1, N + 1) * q
    odd, even = mq[::2] @ A[1::2], mq[1::2] @ A[2::2]
    source = (nodes.T - nodes.L) * part * (even - 1j * odd)
    limit = z + shift + np.sum((source * np.exp(1j * v) * J).real)
    power = (even**2 + odd**2) / v**2
    strain = -2.0 * theta * np.sum(nodes.du * nodes.C * modes.layer_storage(v / z) * power) / q[0]
    return CoverState(float(z * q[0]), float(shift), float(moment), float(limit), float(strain), q, X0 - Xi @ (c @ q))


def pressure(modes: CoverModes, z: float, theta: float, x: Floats) -> Floats:
    """Return the pressure along the contact, over 2 P/(pi a): its largest value if it were Hertz's on half length a.

    modes: of the cover.  z, theta: a over V T_ref, which may be infinite (V = 0), and over the thickness.
    x: positions in half lengths from the middle of the contact, positive along V, any shape; 0 outside of [-1, 1].
    """
    from numpy.polynomial.chebyshev import chebval

    if z == np.inf:
        modes, z = modes.elastic(modes.share), 1.0
    state = solve(modes, z, theta)
    # I_n/I_0 is below rounding from n = 9 sqrt(alpha) on
    width = math.sqrt(min(z * modes.a.max(initial=0.0), _LARGE))
    terms = _pressure_terms(modes, z, state, max(state.q.size, math.ceil(9.0 * width)) + 40)
    # sum terms_n U_n in Chebyshev polynomials of the first kind: U_n = 2 (T_n + T_(n-2) + ...), with T_0 once
    sums = np.empty(terms.size)
    for parity in (0, 1):
        sums[parity::2] = 2.0 * np.cumsum(terms[parity::2][::-1])[::-1]
    sums[0] *= 0.5
    inside = np.clip(x, -1.0, 1.0)
    return np.sqrt((1.0 - inside) * (1.0 + inside)) * chebval(inside, sums) / state.q[0]


def _pressure_terms(modes: CoverModes, z: float, state: CoverState, count: int) -> Floats:
    """Return the first ``count`` coefficients of the pressure, q_m for m = 1, 2, ..., of the state at z."""
    from scipy.special import ive

    alpha = np.minimum(modes.a * z, _LARGE)
    terms = 2.0 * (ive(np.arange(1, count + 1)[:, None], alpha) / ive(0, alpha)) @ state.X
    terms[: state.q.size] = state.q
    return terms


def local_strain(modes: CoverModes, z: float, state: CoverState) -> float:
    """Mean strain by the coupling of a half-space, -C J p at each place, less that of the other body; 0 for nu = 1/2.

    Good to some 1e-5 of itself: the pressure is linear between points.
    """
    local = modes.nodes.local
    if local == 0.0 and modes.other_local == 0.0:
        return 0.0
    squared, remembered = _products(modes, z, state)
    own = local * (modes.layer_instant * squared + modes.layer_J @ remembered)
    return float(2.0 / (math.pi * state.q[0]) * (modes.other_local * squared - own))


def _products(modes: CoverModes, z: float, state: CoverState) -> tuple[float, Floats]:
    """Int p^2 dx, and Int p f_j dx with f_j = Int_0^inf beta_j exp(-beta_j s) p(x + s) ds of each creep mode.

    p is linear between points that are even in t = arccos x; the memory runs from the front edge x = 1 to the rear.
    """
    from scipy.fft import dst

    coefficients = _pressure_terms(modes, z, state, _POINTS - 1)
    p = np.concatenate([[0.0], 0.5 * dst(coefficients, type=1), [0.0]])
    t = np.arange(_POINTS + 1) * (math.pi / _POINTS)
    x, weights = np.cos(t), np.sin(t) * (math.pi / _POINTS)
    beta = modes.layer_b[:, None] * z
    step = np.minimum(beta * (x[:-1] - x[1:]), 700.0)
    kept, gone = np.exp(-step), -np.expm1(-step)
    # of a linear p: its value at the near end, and its rise towards the far end, times the mean distance
    mean = np.where(step > 1e-3, gone / step - kept, step * (0.5 - step / 3.0))
    gained = gone * p[1:] + (p[:-1] - p[1:]) * mean
    decay, f = kept.copy(), gained
    reach = 1
    while reach < _POINTS:  # f_{k+1} = kept f_k + gained, for all k at once by doubling
        f, decay = f.copy(), decay.copy()
        f[:, reach:] += decay[:, reach:] * f[:, :-reach].copy()
        decay[:, reach:] *= decay[:, :-reach].copy()
        reach *= 2
    return float(weights @ (p * p)), (f * p[1:]) @ weights[1:]
