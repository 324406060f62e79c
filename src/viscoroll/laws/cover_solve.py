"""Steady rolling on bonded viscoelastic layers of finite thickness, solved by Chebyshev polynomials
at one speed.

Plane strain, constant Poisson's ratios, a Prony series for each body.  Each body is a layer that is
bonded to a rigid core or bed, or a half-space; one of them may be rigid.  The pressure here is that
without shear, from which :mod:`.cover_rows` finds what shear does.

Notation.  All quantities are dimensionless.  T_ref is the unit of time of the materials, in which
their rates are given; kappa = R/l0, with l0 the contact length at rest of the same bodies as
half-spaces.  z is the half length of the contact over V T_ref (zeta of the paper, > 0), w that over
l0, and theta = w l0/h that over the thickness h of a layer, k the wave number and v = k times the
half length, so that k h = v/theta.  Slopes and creep are over V T_ref/R.  The pressure over E'/(4
pi) is sqrt(1 - x^2) sum q_m U_{m-1}(x) for x in [-1, 1], positive x towards the front edge.  With
relaxation rates a_i and creep rates b_j of both bodies together, in 1/T_ref, the exponents on the
contact are alpha_i = a_i z and beta_j = b_j z.

The transforms of the surface displacements of a layer are those of a half-space times L (normal
displacement by pressure), T (tangential displacement by shear) and C (tangential displacement by
pressure).  L - 1 decays like (k h)^2 exp(-2 k h): the layers add a smooth operator S to the Hilbert
transform, and to the memory of each creep mode an excess c.  The unknowns are the coefficients q up
to order N = 14 + 6 theta; the exponentials of the relaxation modes enter by their first N
coefficients, so that alpha may be arbitrarily large.

Sources of the method: the law of the half-space in closed form (:mod:`.material_series`), and
the layer's kernels as in Johnson, Contact Mechanics (1985), Sect. 5.8.

The module also evaluates the pressure along the contact (:func:`pressure`), and the strain of the
surfaces that it makes by the coupling of short waves, which is that of half-spaces
(:func:`local_pressure`).
"""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..core import Floats
from ..materials import Cover, layer_excess, local_coupling
from .law_rows import modes_record

# --- Steady rolling on bonded viscoelastic layers of finite thickness ---

#: terms of the pressure for theta -> 0
_TERMS = 14
#: further terms for each unit of theta; found by doubling all: results change by 3e-14 up to
#: theta = 1
_TERMS_PER_THETA = 6
#: largest half contact length divided by the thickness; there doubling the terms still changes
#: results by less than 1e-10
LARGEST_THETA = 6.0
#: step, factor and ends of the trapezoidal rule in s (:func:`half_line_rule`) for integrals over
#: the wave number u = 0.6 ln(1 + e^s).  Halving the step changes nothing.  Above the last end the
#: integrands are below rounding; the first one, u = 2.5e-18, is far below the poles u = i
#: beta/theta of slow memories at the speeds of the fastest ones: with 3e-12 epsilon was wrong by
#: 1e-8 where rates are eight decades apart
_WAVE_RULE = 0.3, 0.6, (-40.0, 20.0 / 0.6)
#: those of the rule for integrals over t = 2 ln(1 + e^s), the memory of one polynomial
_DECAY_RULE = 0.14, 2.0, (-33.0, 18.0)
#: alpha_i from which on ratios of Bessel functions I_n/I_0 of the orders used here fall as
#: exp(-n^2/(2 alpha_i)) to rounding; scipy has no values beyond 1e9
LARGE_ALPHA = 1e8
#: beta_j from which on the memory of a polynomial vanishes to rounding
_LARGE_BETA = 1e12


class Exponentials(NamedTuple):
    """The relaxation and creep modes on a contact of half length z, as for a half-space;
    dimensionless.

    ratio : I_n/I_0 of alpha_i, [order, mode].
    root : sqrt(I_1/I_0), (modes,).
    k : K_0/K_1 of beta_j, (modes,).
    x : B^-1 sqrt(r) (e, Q^T), r = I_1/I_0, B = 1 + sqrt(r) Q^T k Q sqrt(r): the matching at the
        front edge, of the half-space (column 0) and of a source by each creep mode, (modes, 1 +
        modes).
    sigma : source that an excess memory of 1 is, for each creep mode, (modes,).
    """

    ratio: Floats
    root: Floats
    k: Floats
    x: Floats
    sigma: Floats


class CoverState(NamedTuple):
    """The contact at one half length z, dimensionless; slopes and creep in units of V T_ref/R.

    load : H = z q_1, the integral of the pressure over the contact divided by pi/2, in the unit of
        the pressure and with lengths over V T_ref; z^2 for an elastic half-space.  At the speed
        u' = kappa |V| the contact carries the load where H = 1/(4 u'^2).
    shift : g = epsilon z, the shift of the contact ahead of the axis divided by V T_ref.
    moment : M/V of both bodies, with M divided by P R and V by R/T_ref.
    creep_limit : delta_star/mu in units of V T_ref/R, from which on the whole contact slips.
    q : terms of the pressure q_1 ... q_N, (N,).
    X : amplitudes of the relaxation modes, (modes,); from them follow terms of any higher order.

    What not every result needs:
    v : wave numbers times half the contact length at the nodes of the rule, (n,).
    A : signed Bessel functions there, (N + 1, n).
    compliance : complex compliance of each body there, (2, n); own : that of the body to which a
        node belongs, part : that divided by the compliance of both, (n,).
    transform : of the pressure, divided by pi z, times v, with the factor -i: its odd terms, and
        its even ones as imaginary part, (n,).
    memory : excess memory of exp(i v x), (modes, n).
    exponentials : :class:`Exponentials`.
    matrix : of the system for q, (N, N).
    Xi : amplitudes of the relaxation modes by the excess memory of each creep mode, with the other
        sign, (modes, modes).
    shares : part of the shift g that each creep mode makes at the front edge, times t_j, (modes,).
    """

    load: float
    shift: float
    moment: float
    creep_limit: float
    q: Floats
    X: Floats
    v: Floats
    A: Floats
    compliance: Any
    own: Any
    part: Any
    transform: Any
    memory: Any
    exponentials: Exponentials
    matrix: Floats
    Xi: Floats
    shares: Floats


class BodyModes(NamedTuple):
    """One body of a contact; compliances are parts of the long-time compliance of both bodies as
    half-spaces.

    instant : instantaneous compliance; J, b : strengths and rates of creep, in 1/T_ref, (its
        modes,).  Of a rigid body all are 0 or empty.
    local : coupling C for short waves, (1 - 2 nu)/(2 - 2 nu), with the sign of the body: positive
    on the base.
    """

    instant: float
    J: Floats
    b: Floats
    local: float


class CoverModes:
    """The bodies of a cover in the form that :func:`solve` uses; arrays have the base first, then
    the cylinder.

    Compliances are parts of the long-time compliance of both bodies as half-spaces.

    series : record of the modes of both (:func:`.law_rows.modes_record`), rates in 1/T_ref.
    J : creep strengths of both bodies together, (modes,).
    alpha : instantaneous divided by long-time stiffness of both together, float >= 1.
    cover : the :class:`.bodies.Cover`.
    bodies : :class:`BodyModes` of both.
    shares : part of each in the long-time compliance, (2,).
    weights : part of each in the strength of each creep mode, (2, modes).
    wave : nodes of the integrals over the wave number, as wave numbers times l0, of all layers one
    after another, (n,).
    mine : 1 where a node belongs to a layer of that body, else 0, (2, n).
    L, shear, C : kernels of :func:`layer_nodes`; C has the sign of its body, positive
    on the base.
    """

    def __init__(self, cover: Cover) -> None:
        """Compute the modes of the bodies of a cover.

        cover: :class:`.bodies.Cover` of one thickness and one Poisson's ratio.
        All attributes of the class are set.
        """
        modes = cover.total.modes
        self.series = modes_record(modes)
        self.J = modes.J
        self.alpha = float(cover.total.alpha)
        self.cover = cover
        self.shares = np.array([1.0 - cover.share, cover.share])
        self.weights = np.stack([cover.half_space_weights, 1.0 - cover.half_space_weights])
        bodies = []
        kernels = []
        for name, share, sign in zip(("base", "cylinder"), self.shares.tolist(), (1.0, -1.0)):
            series, nu, thickness = cover.body(name)
            # a rigid body, whose share is 0, has no coupling
            local = sign * local_coupling(nu) if share else 0.0
            bodies.append(
                BodyModes(share / float(series.alpha), share * series.J, 1.0 / series.T, local)
            )
            if thickness is not None:
                u, L, shear, C = layer_nodes(nu)
                mine = np.full(u.size, name == "base", float)
                # u is the wave number times the thickness, and the thickness is over l0
                kernels.append([u / thickness, L, shear, sign * C, mine, 1.0 - mine])
        self.bodies = tuple(bodies)
        self.wave, self.L, self.shear, self.C, *own = np.concatenate(kernels, axis=1)
        self.mine = np.array(own)


def half_line_rule(step: float, scale: float, ends: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return nodes and weights of an integral over [0, inf), by the trapezoidal rule in s with
    scale ln(1 + e^s) as variable.

    Nodes are dense towards 0; for the integrands here the rule converges exponentially.
    step: distance of the nodes in s, > 0.
    scale: factor of ln(1 + e^s), > 0.
    ends: first and last s; the last one is left out.
    Returns (nodes in the variable, > 0, ascending; weights, > 0), (n,) each, in the unit of
    ``scale``; n is the number of steps between the ends, rounded up.
    """
    s = np.arange(*ends, step)
    return scale * np.logaddexp(0.0, s), step * scale / (1.0 + np.exp(-s))


@lru_cache(maxsize=64)
def layer_nodes(nu: float) -> Floats:
    """Return the kernels of a layer at the nodes of the integrals over the wave number, kept.

    Nodes must be dense towards u = 0, where slow memories have poles at u = i beta/theta.
    nu: Poisson's ratio of the layer, in [0, 0.5], not checked.
    Returns four rows of some 245 nodes: u, the wave number times the thickness, > 0, ascending; and
    L - 1, T - L and C less that of a half-space (:func:`layer_excess`), each times du/u of its
    node.
    """
    u, du = half_line_rule(*_WAVE_RULE)
    return np.array([u, *(layer_excess(nu, u) * (du / u))])


def bessel(v: Floats, order: int) -> Floats:
    """Return J_0 ... J_order at v, each with the sign (-1)^(n//2), accurate to 1e-15 absolute.

    They are the Chebyshev coefficients of cos(v x) (even n) and of sin(v x) (odd n), but for the
    factor 2 from n = 1 on, by a discrete sum long enough for aliases to vanish.

    v: arguments, dimensionless, >= 0, (n,), at least one.
    order: highest order, >= 0.
    Returns the values, dimensionless, a new array (order + 1, n): row k is (-1)^(k//2) J_k(v).
    """
    # count points of (0, pi), of which symmetry leaves half: count is even.  The first alias of
    # order n is J of order 2 count - n, which is beyond 2 max(v) + 40 and vanishes
    count = (int(v.max() + 0.5 * order) + 24) & ~1
    phi = (np.arange(count // 2) + 0.5) * (math.pi / count)
    arguments = np.multiply.outer(np.cos(phi), v)
    cosines = np.cos(np.arange(order + 1)[:, None] * phi) * (2.0 / count)
    values = np.empty((order + 1, v.size))
    values[::2] = cosines[::2] @ np.cos(arguments)
    values[1::2] = cosines[1::2] @ np.sin(arguments)
    return values


@lru_cache(maxsize=1)
def _decay_nodes() -> tuple[Floats, Floats]:
    """Return the rule of the integrals D_n of :func:`decays`, kept for all calls.

    Returns (x - 1 = 2 sinh^2(t/2) at the nodes of t, (n,); the weights times sinh(t) exp(-n t),
    [order, node], for orders from 0 to 100).
    """
    # with x = cosh t the power is exp(-n t) and dx = sinh t dt; cosh t - 1 = 2 sinh^2(t/2) keeps
    # its digits
    t, weights = half_line_rule(*_DECAY_RULE)
    orders = np.arange(term_count(LARGEST_THETA) * 2 + 1)[:, None]
    return 2.0 * np.sinh(0.5 * t) ** 2, np.exp(-orders * t) * (weights * np.sinh(t))


def decays(beta: Floats, order: int) -> Floats:
    """Return the memory that each creep mode has of the surface ahead of the front edge, for each
    term of the series.

    It is D_n(beta) = beta int_1^inf exp(-beta (x - 1)) (x - sqrt(x^2 - 1))^n dx.  The power is the
    n-th term of the Chebyshev series continued beyond the front edge, x = 1; D_n goes to 1 for
    large beta.

    beta: b_j z, rates of creep times the half contact length over V, dimensionless, > 0, (modes,);
        above 1e12 the value at 1e12 is taken, as nothing then changes.
    order: highest n, at most 100.
    Returns D_n, dimensionless, in (0, 1], a new array (order + 1, modes), a row for each term.
    """
    beta = np.minimum(beta, _LARGE_BETA)
    x, weights = _decay_nodes()
    return weights[: order + 1] @ np.exp(-x[:, None] * beta) * beta


def term_count(theta: float) -> int:
    """Return the number of terms of the pressure, 14 + 6 theta rounded up; theta: half length over
    thickness, >= 0.
    """
    return math.ceil(_TERMS + _TERMS_PER_THETA * theta)


def evaluate_exponentials(modes: CoverModes, z: float, N: int) -> Exponentials:
    """Evaluate the relaxation and creep modes on a contact, as for a half-space.

    modes: :class:`CoverModes`; without modes all arrays are empty along that axis.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    N: highest order of the Bessel functions, the number of terms of the pressure, >= 1.
    Returns ratios of Bessel functions, (N + 1, modes), and the matching at the front edge, as
    :class:`Exponentials` (ratio, root, k, x, sigma).
    For a_i z above 1e8 the ratios are those at 1e8, corrected to first order, as scipy has no
    values there.
    """
    from scipy.special import ive, k0e, k1e

    a, b, e, _, _, Q = modes.series
    alpha = np.minimum(a * z, LARGE_ALPHA)
    beta = b * z
    n = np.arange(N + 1)[:, None]
    # I_n/I_0 is exp(-n^2/(2 x)) for large x: the factor is 1 unless alpha was limited
    ratio = ive(n, alpha) / ive(0, alpha) * np.exp(0.5 * n * n * (1.0 / alpha - 1.0 / (a * z)))
    root = np.sqrt(ratio[1])
    k = k0e(beta) / k1e(beta)
    B = np.eye(root.size) + root[:, None] * ((Q.T * k) @ Q) * root
    x = np.linalg.solve(B, np.column_stack([root * e, root[:, None] * Q.T]))
    return Exponentials(
        ratio=ratio, root=root, k=k, x=x, sigma=np.sqrt(modes.J * b) / (beta * k1e(beta))
    )


def _excess_memory(v: Floats, A: Floats, beta: Floats) -> Any:
    """Return the memory of exp(i v x) at the front edge, less that of its Chebyshev series.

    v: wave numbers times half contact length, dimensionless, (n,).
    A: signed Bessel functions there, as in :func:`bessel`, (N + 1, n).
    beta: b_j z of the creep modes of both bodies together, dimensionless, (modes,).
    Returns complex numbers (modes, n).
    """
    D = decays(beta, len(A) - 1)
    # the Chebyshev series of exp(i v x) is A_0 + 2 sum A_n T_n over even n + 2 i sum A_n T_n over
    # odd n; D_0 = 1
    memory = np.exp(1j * v) * (beta[:, None] / (beta[:, None] - 1j * v)) - A[0]
    memory -= 2.0 * (D[2::2].T @ A[2::2]) + 2j * (D[1::2].T @ A[1::2])
    return memory


def layer_operator(A: Floats, memory: Any, weights: Any) -> tuple[Floats, Floats]:
    """Return what layers add to the slope and to the memory of half-spaces.

    A: signed Bessel functions at the nodes of the rule, as in :func:`bessel`, (N + 1, n).
    memory: excess memory there (:func:`_excess_memory`), (modes, n).
    weights: the layers' multiplier over u, as (L - 1)/u, times the weights of the rule and times
        the complex compliance of the layer divided by that of both bodies, (n,).
    Returns (S, c).  S (N + 1, N) maps the coefficients q to those of the slope, sum (S q)_n T_n(x),
    n from 0.  c (modes, N): c q is the excess memory of that slope in each creep mode.
    """
    N = len(A) - 1
    n = np.arange(N + 1)[:, None]
    m = np.arange(1, N + 1)
    odd = m % 2
    # the real part of the multiplier couples terms of equal parity, the imaginary part those of
    # unlike parity, with a sign that depends on which of the two is odd
    even_part, odd_part = (2.0 * (A @ (A[1:] * part).T) for part in (weights.real, weights.imag))
    S = np.where((n + m) % 2, odd_part * np.where(odd, m, -m), even_part * m)
    # the term T_0 has half of the factor 2 of the others
    S[0] *= 0.5
    weighted = memory * weights
    return S, np.where(odd, weighted.imag @ A[1:].T, weighted.real @ A[1:].T) * m


def solve(modes: CoverModes, z: float, half: float, orders: int | None = None) -> CoverState:
    """Solve the contact of a given half length, by one linear system of N unknowns, the terms of
    the pressure.

    Boundary elements agree to 2e-6 (``pipeline/evidence/prove/states.py``).  For thick layers the
    contact is that of half-spaces.
    modes: :class:`CoverModes`; with those of :meth:`.bodies.Cover.elastic` the result is that of
        elastic bodies: ``X`` is empty, and the shift is 0 to rounding.
    z: half contact length divided by V T_ref, dimensionless, > 0 and finite.
    half: half contact length divided by l0, dimensionless, > 0; at most six times the thickness of
        each layer; not checked.
    orders: number of terms of the pressure, at most 100; None: as :func:`term_count` has them.
    Returns a :class:`CoverState`; slopes and creep are over V T_ref/R.
    """
    N = orders or term_count(half / modes.cover.thinnest)
    v = half * modes.wave
    A = bessel(v, N)
    # complex compliance of each body for exp(i k Y), k = v/z, Y being the position along the
    # direction of rolling
    k = (v / z)[:, None]
    compliance = np.array(
        [body.instant + (body.J * body.b / (body.b - 1j * k)).sum(axis=1) for body in modes.bodies]
    )
    own = (modes.mine * compliance).sum(axis=0)
    part = own / compliance.sum(axis=0)
    exponentials = evaluate_exponentials(modes, z, N)
    ratio, root, edge, x, sigma = exponentials
    _, b, e, t, _, Q = modes.series
    X0 = e / root * x[:, 0]
    Xi = (e / root)[:, None] * x[:, 1:] * sigma
    memory = _excess_memory(v, A, b * z)
    S, c = layer_operator(A, memory, modes.L * part)
    Phi = 2.0 * ratio[1:]
    right = Phi @ X0
    # q_1 = z alone is the pressure of Hertz
    right[0] += z
    # on half-spaces the pressure q_n makes the slope q_n T_n; the mean slope, row 0 of S, is part
    # of the shift
    matrix = np.eye(N) + S[1:] + Phi @ (Xi @ c)
    q = np.linalg.solve(matrix, right)
    excess = sigma * (c @ q)
    # T_mean - sum X + s_0 without cancellation
    shares = t * (edge * (Q @ (root * (x[:, 0] - x[:, 1:] @ excess))) + excess)
    shift = shares.sum() + S[0] @ q
    # transform of the pressure divided by pi z, times v: its even and odd terms
    mq = np.arange(1, N + 1) * q
    transform = mq[::2] @ A[1::2] + 1j * (mq[1::2] @ A[2::2])
    # that of half-spaces, F = z + g, and what the shear of full slip adds at the front edge x = 1
    # as T and L differ
    limit = z + shift + np.sum((modes.shear * own * transform * np.exp(1j * v)).imag)
    return CoverState(
        load=z * q[0],
        shift=shift,
        # arm of the load about the axis: the shift, and the mean x of the pressure, q_2/(2 q_1)
        # half lengths
        moment=shift + z * q[1] / (2.0 * q[0]),
        creep_limit=limit,
        q=q,
        X=X0 - Xi @ (c @ q),
        v=v,
        A=A,
        compliance=compliance,
        own=own,
        part=part,
        transform=transform,
        memory=memory,
        exponentials=exponentials,
        matrix=matrix,
        Xi=Xi,
        shares=shares,
    )


# --- The pressure of a cover along its contact ---

#: intervals in arccos x for the integral of the local strain; accurate to 1e-5
_INTERVALS = 512
#: exponent of the decay over an interval above which nothing is left in double precision
_DECAYED = 700.0


def pressure(modes: CoverModes, z: float, half: float, x: Floats) -> Floats:
    """Return the pressure along the contact over 2 P/(pi a), the largest pressure of Hertz for the
    load P on the half length a.

    modes: :class:`CoverModes` of the bodies.
    z: a divided by V T_ref, dimensionless, > 0; infinite for V = 0, where the bodies are taken as
        elastic with their long-time moduli.
    half: a divided by l0, dimensionless, at most six times the thickness of each layer.
    x: positions divided by a, from the middle of the contact, positive along V, any shape.
    Returns the pressure, dimensionless, in the shape of x; 0 at the ends of and outside [-1, 1].
    """
    from numpy.polynomial.chebyshev import chebder, chebval

    if z == np.inf:
        modes = CoverModes(modes.cover.elastic(modes.cover.share))
        z = 1.0
    state = solve(modes, z, half)
    # I_n/I_0 is below rounding from n = 9 sqrt(alpha) on
    width = math.sqrt(min(z * modes.series.a.max(initial=0.0), LARGE_ALPHA))
    # 40 more, as for small alpha_i they fall with the order only
    terms = _pressure_terms(modes, z, state, max(state.q.size, math.ceil(9.0 * width)) + 40)
    # U_(m-1) is the derivative of T_m/m
    series = chebder(np.append(0.0, terms / np.arange(1, terms.size + 1)))
    inside = np.clip(x, -1.0, 1.0)
    # the load on the half length a is pi a q_1/2: 2 P/(pi a) is q_1 in the unit of the pressure
    return np.sqrt((1.0 - inside) * (1.0 + inside)) * chebval(inside, series) / state.q[0]


def _pressure_terms(modes: CoverModes, z: float, state: CoverState, count: int) -> Floats:
    """Return the first coefficients of the pressure, more of them than the solve has.

    modes, z, state: as in :func:`local_pressure`; of the state its own coefficients are taken,
        further ones follow from its relaxation modes and are 0 without such modes.
    count: number of coefficients, not below that of ``state``.
    Returns q_m for m = 1, 2, ..., (count,).
    """
    from scipy.special import ive

    alpha = np.minimum(modes.series.a * z, LARGE_ALPHA)
    terms = 2.0 * (ive(np.arange(1, count + 1)[:, None], alpha) / ive(0, alpha)) @ state.X
    terms[: state.q.size] = state.q
    return terms


def local_pressure(modes: CoverModes, z: float, state: CoverState) -> tuple[Floats, Floats]:
    """Return the coupling of the pressure as on half-spaces, that of short waves, by values at 513
    points that are equidistant in arccos x.

    At each point it is C J p: C = (1 - 2 nu)/(2 - 2 nu), J the compliance of the body with its
    memory.  The mean is accurate to 1e-5 of itself, as the pressure is taken as linear between
    points.
    modes: :class:`CoverModes` of the bodies.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    state: :class:`CoverState` of the contact of that length.
    Returns (its Chebyshev coefficients of T_n(x), over the compliance of both bodies, (intervals +
    1, 2); its mean, mirrored about the middle of the contact, with the pressure as weight, (2,)),
    with the base first; 0 of a body of nu = 1/2 and of a rigid one.
    """
    from scipy import fft

    p = np.zeros(_INTERVALS + 1)
    # with x = cos t the pressure is sum q_m sin(m t); the sine transform has a factor 2
    p[1:-1] = 0.5 * fft.dst(_pressure_terms(modes, z, state, _INTERVALS - 1), type=1)
    t = np.arange(_INTERVALS + 1) * (math.pi / _INTERVALS)
    x = np.cos(t)
    # dx = sin t dt; p in reverse order is the pressure mirrored about the middle
    weights = np.sin(t) * (math.pi / _INTERVALS) * p[::-1]
    a, _, e, _, _, _ = modes.series
    values = np.zeros((2, p.size))
    mirrored = np.zeros(2)
    for n, body in enumerate(modes.bodies):
        if not body.local:
            continue
        own = body.instant * p + body.J @ _memory(p, x, body.b * z)
        mirrored[n] = 2.0 / (math.pi * state.q[0]) * body.local * (weights @ own)
        # beside a rigid body its compliance over that of both is 1, without memory
        if modes.shares[n] == 1.0:
            values[n] = body.local * p
            continue
        # its compliance over that of both has poles at the relaxation rates of both
        gap = modes.cover.total.modes.gap
        J = body.instant - modes.weights[n] * modes.J * modes.series.b @ (1.0 / gap)
        strengths = -(e * e * a) * J
        values[n] = body.local * (body.instant * modes.alpha * p + strengths @ _memory(p, x, a * z))
    # Chebyshev coefficients of values at these points; the last one, also twice its value, is not
    # used
    terms = fft.dct(values, type=1, axis=1).T / _INTERVALS
    terms[0] *= 0.5
    return terms, mirrored


def _memory(p: Floats, x: Floats, rates: Floats) -> Floats:
    """Return the memory that modes have of the pressure, f(x) = int_0^inf beta exp(-beta s) p(x +
    s) ds.

    It runs from the front edge x = 1 to the rear; p is linear between points.
    p: pressure at the points, 0 at both ends, in any unit, (n + 1,).
    x: points, descending from 1 to -1.
    rates: beta of each mode, times half the contact length over V, > 0, (modes,).
    Returns f in the unit of p, (modes, n + 1).
    """
    step = np.minimum(rates[:, None] * (x[:-1] - x[1:]), _DECAYED)
    decay = np.exp(-step)
    gone = -np.expm1(-step)
    # for a linear p: its value at the near end, and its increase towards the far end, times the
    # mean distance
    mean = gone / step - decay
    f = np.zeros((rates.size, p.size))
    reach = 1
    f[:, 1:] = gone * p[1:] + (p[:-1] - p[1:]) * mean
    while reach < p.size - 1:  # f_{k+1} = decay_k f_k + gain_k, for all k at once by doubling
        # copies, as each part is read where the other is written
        f[:, 1 + reach :] += decay[:, reach:] * f[:, 1:-reach].copy()
        decay[:, reach:] *= decay[:, :-reach].copy()
        reach *= 2
    return f
