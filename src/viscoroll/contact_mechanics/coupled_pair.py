"""Steady rolling with pressure and shear solved together: :class:`CoupledBody`, and its states at
one speed by boundary elements (:class:`CoupledRow`).

**Units.**  Everything is dimensionless.  Lengths are divided by l0, the contact length at rest of
half-spaces, kappa = R/l0, u = kappa |V|, forces are divided by the load P and moments by P R, and
compliances by the long-time one of both bodies together.  A relaxation time T is the length u T.  A
reduced creepage ("creep" in names) is 2 kappa delta, of the sign of omega R - V.

**Kernels** of the elements are second antiderivatives of the slopes of a surface under a point
load.  With J* the complex compliance at the wave number k and L, T and C the transforms of
:mod:`.cover_solve`, a pressure makes the slope -i sgn(k) L J*, a shear the strain -i sgn(k) T J*,
and either makes C J* of the other.

**Powers** per unit of V, with M_b the part of M by the slope of body b and W_b = int q u'_b dx by its
strain along x:

    body b loses M_b + W_b      friction loses delta Q - W_base - W_cylinder      their sum is M + delta Q
"""  # noqa: E501

import functools
import math
from typing import Any, NamedTuple

import numpy as np
from scipy import optimize, special

from ..core import ConvergenceError, Floats, ParameterError, described_error
from ..kernels.law import coupled_states
from ..kernels.law.contact_elements import BINS, DEGREE, LOWEST, WIDTH
from ..laws import layer_nodes
from ..materials import Bodies, local_coupling, series_of_alpha

# --- Kernels of the boundary elements at one speed ---

#: smallest argument of the asymptotic series of the exponential integral, to rounding with its
#: number of terms
_FAR = 50.0
_FAR_TERMS = 30
#: terms of the power series of the entire exponential integral up to 1
_NEAR_TERMS = 22
#: k |x| below which the transforms of second antiderivatives are taken from two terms of their
#: series
_SMALL_PHASE = 0.02
#: distances from the front edge, divided by l0, at which the growth of the compliance is evaluated;
#: at most the square root of a distance is the part of the load that lies within it
_SCALES = np.geomspace(1e-7, 1.0, 200)
#: growth d ln J/d ln x of the compliance over distance x from the front edge from which on pressure
#: gathers there; the pressure of half-spaces grows like the distance to the power of 1/2 less it
_GROWTH = 0.4


@functools.cache
def _fit() -> tuple[Floats, Floats]:
    """Return the nodes of the polynomials of kernels, and the matrix that fits them.

    Returns (|x| of the nodes of all bins of ln|x|, ascending in each, (BINS (DEGREE + 1),); matrix
    that makes of the values at the nodes of a bin the coefficients of powers of t, where t in [-1,
    1] is the position of ln|x| in the bin).
    """
    nodes = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    logs = LOWEST + WIDTH * (np.arange(BINS)[:, None] + 0.5 * (1.0 + nodes))
    return np.exp(logs).ravel(), np.linalg.inv(np.vander(nodes, DEGREE + 1, increasing=True))


def _memory(X: Floats) -> Floats:
    """Return f(X) + ln|X| + gamma, with f the principal value of int_0^inf exp(-s)/(X + s) ds.

    f(X) is exp(X) E_1(X) for X > 0 and -exp(X) Ei(-X) for X < 0, with the exponential integrals
    E_1 and Ei; gamma is Euler's constant.  Up to |X| = 1 it is a power series, beyond 50 an
    asymptotic one.

    X: numbers of any sign, not 0, any shape.
    Returns an array of its shape, whose absolute error is some units of rounding of 1.
    """
    size = np.abs(X)
    found = np.log(size) + np.euler_gamma
    near = size < 1.0
    far = size > _FAR
    x = X[near]
    entire = np.zeros_like(x)
    term = np.ones_like(x)
    for k in range(1, _NEAR_TERMS):
        term = -term * x / k
        entire -= term / k
    # E_1(x) = entire - gamma - ln x, and of found, which is gamma + ln|x|, exp(x) - 1 parts are
    # left
    found[near] = np.exp(x) * entire - np.expm1(x) * found[near]
    middle = ~(near | far)
    x = X[middle]
    integral = np.where(x > 0.0, special.exp1(np.abs(x)), -special.expi(np.abs(x)))
    found[middle] += np.exp(x) * integral
    inverse = 1.0 / X[far]
    # f ~ sum (-1)^k k!/X^(k+1)
    term = inverse
    tail = term.copy()
    for k in range(1, _FAR_TERMS):
        term = -term * k * inverse
        tail += term
    found[far] += tail
    return found


def _half_space(body: Any, u: float, x: Floats) -> Floats:
    """Return the kernels of a half-space (module) at distances x ahead of a point load.

    Elastic, of compliance 1, the slope by a pressure is 1/(pi x), so that the kernel is (x ln|x| -
    x)/pi; the coupling is local, and its kernel is max(x, 0).  Each creep mode adds the memory of
    these (:func:`_memory`).

    body, u: as of :func:`body_kernels`.
    x: distances divided by l0, all > 0 or all < 0, (n,).
    Returns the kernels of pressure, shear and coupling, (3, n).  Those of pressure and shear are
    equal, and lack the term instant x ln|x|/pi, which is singular at 0, with the instantaneous
    compliance.
    """
    instant, modes = body.at_speed(u)
    normal = -instant * x / np.pi
    ramp = np.maximum(x, 0.0)
    coupling = instant * ramp
    for strength, length in modes:
        X = x / length
        normal += strength * length / np.pi * (_memory(X) + X * np.log(np.abs(X)) - X)
        # the local coupling remembers the load behind it alone, X < 0
        coupling += strength * (length * np.expm1(np.minimum(X, 0.0)) + ramp)
    # T = L = 1: shear strains a half-space as pressure tilts it
    return np.array([normal, normal, body.local * coupling])


@functools.lru_cache(maxsize=4)
def _phases(nu: float, thickness: float) -> tuple[Floats, Floats, Floats]:
    """Return what kernels of a bonded layer have in common at all speeds.

    nu, thickness: Poisson's ratio of the layer, and its thickness divided by l0.
    Returns (wave numbers k times l0, (m,); (1 - cos y)/y^2 and (y - sin y)/y^2 at y = |x| k, for
    all |x| of :func:`_fit`, (2, BINS, DEGREE + 1, m); weights of the integrals over k for the
    three kernels, L - 1, T - 1 and C, (3, m)).  The two functions of y are the even and the odd
    part of the second antiderivative of a wave, without terms linear in x.  Each bin is a matrix
    of its own, so that BLAS takes no threads beside those of the rows.
    """
    u, L, shear, C = layer_nodes(nu)
    k = u / thickness
    phase = _fit()[0][:, None] * k
    small = phase < _SMALL_PHASE
    safe = np.where(small, 1.0, phase)
    # 1 - cos y = 2 sin^2(y/2) keeps its digits
    even = np.where(small, 0.5 - phase**2 / 24.0, 2.0 * (np.sin(0.5 * safe) / safe) ** 2)
    odd = np.where(small, phase / 6.0 - phase**3 / 120.0, (safe - np.sin(safe)) / safe**2)
    # the nodes have (L - 1)/u and (T - L)/u; here L - 1, T - 1 and C, and dk = du/thickness
    excess = np.array([L, L + shear, C]) * u
    phases = np.array([even, odd]).reshape(2, BINS, DEGREE + 1, k.size)
    return k, phases, excess / (np.pi * thickness)


def wave_compliance(body: Any, u: float, k: Floats) -> Any:
    """Return the compliance of a body under waves, divided by that at rest.

    body, u: as of :func:`body_kernels`.
    k: wave numbers times l0, (n,).
    Returns complex numbers, (n,).
    """
    instant, modes = body.at_speed(u)
    compliance = np.full(k.size, complex(instant))
    for strength, length in modes:
        compliance += strength / (1.0 - 1j * k * length)
    return compliance


def _layer(body: Any, u: float) -> Floats:
    """Return what a bonded layer adds to the kernels of a half-space (module), by integrals over
    the wave number with the complex compliance.

    body, u: as of :func:`body_kernels`; a layer.
    Returns (2 signs of x, first +; 3 kernels: pressure, shear, coupling; n) at all |x| of
    :func:`_fit`, without terms linear in x.
    """
    k, phases, excess = _phases(body.nu, body.thickness)
    compliance = wave_compliance(body, u, k)
    # columns 0 to 2 are those of L - 1, T - 1 and C with the real part of the compliance, 3 to 5
    # with the imaginary part; the coupling, without -i sgn(k), takes them the other way round
    weights = np.concatenate([excess * compliance.real, excess * compliance.imag]).T
    even, odd = (phases @ weights).reshape(2, -1, 6).transpose(0, 2, 1)
    sign = np.array([1.0, -1.0])[:, None, None]
    found = np.concatenate([even[3:5] + sign * odd[:2], even[2:3] - sign * odd[5:]], axis=1)
    # phases are divided by y^2 = (k x)^2, the second antiderivative of a wave by k^2
    return found * _fit()[0] ** 2


class BodyKernels(NamedTuple):
    """Kernels of one body at one speed.

    All are multiplied by the body's share of the compliance of both; the coupling has the sign of
    the body, positive on the base.

    table : kernels (module) as polynomials of ln|x| in bins (:func:`_fit`), (BINS, 2 signs of x, 3
        kernels: pressure, shear, coupling, DEGREE + 1 coefficients).
    instant : instantaneous compliance.
    local : (modes + 1, 2): strength of each part of the local coupling, and length u T over which
        it decays behind the load; the first part, of length 0, is instantaneous.
    """

    table: Floats
    instant: float
    local: Floats


def body_kernels(body: Any, u: float) -> BodyKernels:
    """Return the kernels of one body at one speed.

    body: :class:`CoupledBody`.
    u: kappa |V|, dimensionless, >= 0 or infinite.  At 0 the body is elastic with its long-time
        compliance, at infinity with its instantaneous one.
    Returns the :class:`BodyKernels`.
    """
    size, fit = _fit()
    instant, modes = body.at_speed(u)
    values = np.array([_half_space(body, u, x) for x in (size, -size)])
    if math.isfinite(body.thickness):
        values += _layer(body, u)
    values[:, 2] *= body.sign
    table = values.reshape(2, 3, BINS, DEGREE + 1) @ fit.T
    local = body.sign * body.share * body.local
    parts = [(local * strength, length) for strength, length in [(instant, 0.0), *modes]]
    table = np.ascontiguousarray(body.share * table.transpose(2, 0, 1, 3))
    return BodyKernels(table, body.share * instant, np.array(parts))


def growth(bodies: Any, times: Floats) -> Floats:
    """Return d ln J/d ln t of the creep compliance J(t) of both bodies together, (n,).

    bodies: a :class:`CoupledBody` for each body that deforms.
    times: durations of a load, in units of T_ref, > 0, (n,).
    """
    compliance = np.zeros_like(times)
    rate = np.zeros_like(times)
    for body in bodies:
        compliance += body.share * body.instant
        for strength, time in zip(body.J, body.T, strict=True):
            x = times / time
            compliance -= body.share * strength * np.expm1(-x)
            rate += body.share * strength * x * np.exp(-x)
    return rate / compliance


def edge_layer(bodies: Any, u: float) -> float:
    """Return the length of the zone behind the front edge in which the material is still stiff.

    A point of a surface reaches the distance x l0 behind the edge at the time x/u.  The zone ends
    at the smallest x in [1e-7, 1] at which the compliance J at that time has a logarithmic slope
    d ln J/d ln t above 0.4 (:data:`_GROWTH`), so that the pressure is concentrated there.

    bodies: a :class:`CoupledBody` for each body that deforms.
    u: kappa |V|, dimensionless, >= 0 or infinite.
    Returns that x, a float, divided by l0; infinity if no x in this range has such a slope, and for
    u = 0 or infinite, where the bodies are elastic.
    """
    if u == 0.0 or math.isinf(u):
        return math.inf
    steep = _SCALES[growth(bodies, _SCALES / u) > _GROWTH]
    return float(steep[0]) if steep.size else math.inf


# --- Steady rolling with pressure and shear solved together ---

#: Elements of a state.
ELEMENTS = 72
#: Elements of states of which only the zones of stick and slip are needed.
_ROUGH_ELEMENTS = 40
#: Absolute error of the reduced creepage without creep force.
_FREE_CREEP_ERROR = 1e-9
#: Length of an edge layer, divided by l0, below which the mesh has additional elements there.
_UNLAYERED = 1e-3
#: Coupling that counts as rounding, divided by the largest kernel.
_ROUNDING = 1e-14
#: What each status of the kernels says.
_REASONS = {
    1: "no zones of stick and slip satisfy Coulomb's law",
    2: "the pressure is negative in a part of the contact",
    3: "no contact length bears the load",
    4: "a matrix is singular",
}


class CoupledBody(NamedTuple):
    """One deformable body of a pair.

    side : "base" or "cylinder".
    share : its part of the summed long-time compliance of both as half-spaces, in (0, 1].
    nu : Poisson's ratio in plane strain.
    thickness : of a layer, divided by l0; infinite of a half-space.
    J, T : strengths of its creep modes, divided by its long-time compliance, and their retardation
    times in units of T_ref.
    """

    side: str
    share: float
    nu: float
    thickness: float
    J: tuple[float, ...]
    T: tuple[float, ...]

    @property
    def sign(self) -> float:
        """Sign of the strain of its surface by shear in creep: 1 of the base, else -1."""
        return 1.0 if self.side == "base" else -1.0

    @property
    def instant(self) -> float:
        """Instantaneous compliance divided by the long-time one, >= 0."""
        return max(1.0 - math.fsum(self.J), 0.0)

    def at_speed(self, u: float) -> tuple[float, list[tuple[float, float]]]:
        """Return the instantaneous compliance at kappa |V| = ``u``, and strength and length of each
        mode, in l0; the bodies are elastic for u = 0 and u infinite.
        """
        if u == 0.0:
            return 1.0, []
        elastic = math.isinf(u)
        return self.instant, [] if elastic else [(J, T * u) for J, T in zip(self.J, self.T)]

    @property
    def local(self) -> float:
        """Coupling of its surface as a half-space, (1 - 2 nu)/(2 - 2 nu)."""
        return local_coupling(self.nu)


#: Both bodies of a roller, a record for each that deforms; equal pairs have one hash.
CoupledPair = tuple[CoupledBody, ...]


def pair_of_scene(scene: Any) -> CoupledPair:
    """Return the pair of bodies of a roller.

    scene: dimensionless parameters, a :class:`.parameters.Parameters`; its alpha or material is
        read.
    Returns a :class:`CoupledBody` for each that deforms; without a material both are half-spaces of
    alpha, without coupling.
    Raises ParameterError for several materials, and for a grid, whose bodies are not known.
    """
    material = scene.material
    if scene.gridded:
        allowed = "a Prony, Bodies or Cover with method='coupled', not a grid"
        raise described_error("material", "is a grid of Q and M", allowed)
    if np.size(scene.alpha) != 1 or scene.material_array is not None:
        shape = np.shape(scene.alpha)
        allowed = "one number each with method='coupled': make a call for each"
        given = "alpha, T_epsilon, T_sigma or material, or (of a layer) R or load,"
        sentence = f"{given} has shape {shape}: must be {allowed} element of the array"
        name = "alpha" if material is None else "material"
        raise ParameterError(name, shape, allowed, sentence)
    if material is None:
        material = series_of_alpha(np.asarray(scene.alpha).item())
    if not isinstance(material, Bodies):
        material = Bodies(material, material)
    shares = {"base": 1.0 - material.share, "cylinder": material.share}
    parts = [(side, share, *material.body(side)) for side, share in shares.items()]
    return tuple(
        CoupledBody(
            side=side,
            share=float(share),
            nu=float(nu),
            thickness=float(thickness or math.inf),
            J=tuple(series.J.tolist()),
            T=tuple(series.T.tolist()),
        )
        for side, share, series, nu, thickness in parts
        if share > 0.0  # a rigid body has no part of the compliance
    )


class CoupledStates(NamedTuple):
    """Fields of states of one row in the order of :data:`.law_rows.FIELDS`, and their status,
    (n,) each, dimensionless.

    Q_over_mu : traction divided by mu P.
    kM_base, kM_cylinder : kappa times the parts of M by the slope of each body.
    lam, epsilon : contact length divided by l0, shift divided by half the contact length.
    beta : length of the stick zone divided by the contact length.
    work_base, work_cylinder : 2 kappa int q u'_b dx/P: strain of each body (module).
    status : 0 where solved (:mod:`.coupled_states`).
    """

    Q_over_mu: Floats
    kM_base: Floats
    kM_cylinder: Floats
    lam: Floats
    epsilon: Floats
    beta: Floats
    work_base: Floats
    work_cylinder: Floats
    status: Floats


class CoupledProfile(NamedTuple):
    """Tractions of one state, linear between the nodes of the elements.

    nodes : x from the middle of the contact, divided by l0, ascending, (n,), of a motion along +x.
    shift : distance of the middle ahead of the axis, divided by l0.
    p, q : pressure and shear stress on the cylinder along +x, divided by E'/(4 pi kappa), (n,).
    """

    nodes: Floats
    shift: float
    p: Floats
    q: Floats


class CoupledRow:
    """States of a pair at one speed u = kappa |V|, as functions of the reduced creepage 2 kappa
    delta.  Its compiled kernels release the GIL.

    pair, u, mu : the bodies, kappa |V|, and the coefficient of friction.
    n : number of elements of the contact.
    """

    def __init__(self, pair: CoupledPair, u: float, mu: float, n: int = ELEMENTS) -> None:
        """Compute the kernels of the row, and full slip of both signs.

        pair: the bodies.
        u: kappa |V|, >= 0, or infinite.
        mu: coefficient of friction, > 0.
        n: number of elements, to which those of an edge layer are added.
        Raises ConvergenceError where full slip has no solution.
        """
        self.pair = pair
        self.u = u
        self.mu = mu
        layer = edge_layer(pair, u)
        # elements of the edge layer: its weight for each factor of e by which it is shorter
        self.n = n + round(
            0.5 * coupled_states.WEIGHT_OF_LAYER * math.log(max(_UNLAYERED / layer, 1.0))
        )
        kernels = {body.side: body_kernels(body, u) for body in pair}
        table: Any = sum(each.table for each in kernels.values())
        instant = math.fsum(each.instant for each in kernels.values())
        local = np.concatenate([each.local for each in kernels.values()])
        self._row = coupled_states.Row(
            both=BodyKernels(table, instant, local),
            # by these M and work are divided: those of the cylinder, or of the single body
            own=kernels.get("cylinder", next(iter(kernels.values()))),
            coupled=bool(np.abs(table[:, :, 2]).max() > _ROUNDING * np.abs(table).max()),
            split=len(kernels) == 2,
            cylinder="cylinder" in kernels,
            layer=layer,
        )
        # states of full slip of the negative and of the positive sign
        self._full = np.zeros((2, coupled_states.COLUMNS))
        # a guess of the half length: that of elastic half-spaces of the instantaneous compliance
        length = 0.5 * math.sqrt(max(instant, 1e-3))
        # kappa delta at the onset of full slip of negative and of positive sign, and
        # d ln(load)/d ln(half length) there
        self._ends, slopes = zip(
            *(
                coupled_states.full_slip(
                    self._row, mu, sign, coupled_states.new_contact(self.n), length, out
                )
                for sign, out in zip((-1.0, 1.0), self._full, strict=True)
            )
        )
        self.refuse_unsolved(self._full[:, 8], (-math.inf, math.inf))
        # guesses that are the same for bodies that are swapped; the half length is column 9
        self._guesses = 0.5 * float(self._full[:, 9].sum()), 0.5 * sum(slopes)

    def onsets(self) -> tuple[float, float]:
        """Return the reduced creepages 2 kappa delta at which full slip begins, (the negative, the
        positive one).
        """
        return 2.0 * self._ends[0], 2.0 * self._ends[1]

    def touch(self) -> float:
        """Return the reduced creepage 2 kappa delta, between the onsets, at which a zone of slip of
        the other sign appears in the rear half of the contact.
        """
        return 2.0 * coupled_states.touch_creep(
            self._row,
            self.mu,
            *self._ends,
            coupled_states.new_contact(_ROUGH_ELEMENTS),
            *self._guesses,
        )

    def states(self, creeps: Any, at: Any = None, apart: bool = False) -> CoupledStates:
        """Return the states at given creepages.

        creeps: reduced creepages 2 kappa delta, (n,), in any order, also beyond the onsets of full
            slip.
        at: values of a coordinate in which the states are smooth, ascending with the creepage,
            (n,), by which first guesses are extrapolated; None: the creepages themselves.
        apart: whether each state is solved independently of the others; else each starts from its
            neighbour, which halves the time and changes results by about 1e-5.
        Returns the :class:`CoupledStates`; ``status`` is not 0 where no solution was found.
        """
        given = np.asarray(creeps, dtype=float)
        found = np.empty((given.size, coupled_states.COLUMNS))
        # kernels take kappa delta, half of the reduced creepage, ascending
        order = np.argsort(given)
        low, high = self.onsets()
        inside = order[(given[order] > low) & (given[order] < high)]
        found[given <= low] = self._full[0]
        found[given >= high] = self._full[1]
        out = np.zeros((inside.size, coupled_states.COLUMNS))
        coupled_states.states_loop(
            self._row,
            self.mu,
            0.5 * given[inside],
            (given if at is None else at)[inside],
            coupled_states.new_contact(self.n),
            *self._guesses,
            apart,
            out,
        )
        found[inside] = out
        lam, epsilon, Q, moment, work, own_moment, own_work, beta, status = found.T[:9].copy()
        return CoupledStates(
            lam=lam,
            epsilon=epsilon,
            Q_over_mu=np.clip(Q, -1.0, 1.0),  # beyond by rounding
            kM_base=moment - own_moment,
            kM_cylinder=own_moment,
            work_base=work - own_work,
            work_cylinder=own_work,
            beta=beta,
            status=status,
        )

    def free_creep(self) -> float:
        """Return the reduced creepage 2 kappa delta of free rolling, at which Q = 0.

        It is found between the onsets by Brent's method, to an error of :data:`_FREE_CREEP_ERROR`.
        """
        return optimize.brentq(
            lambda creep: self.states([creep]).Q_over_mu[0], *self.onsets(), xtol=_FREE_CREEP_ERROR
        )

    def profile(self, creep: float) -> CoupledProfile:
        """Return pressure and shear stress along the contact, at one creepage.

        creep: reduced creepage 2 kappa delta; at or beyond the :meth:`onsets` the contact slips
            fully.
        Returns the :class:`CoupledProfile`: between the nodes, which the kernel places, both
        stresses are linear, at both ends of the contact 0, and they are scaled so that the pressure
        bears the load.
        Raises ConvergenceError where no solution was found.
        """
        low, high = self.onsets()
        found = coupled_states.new_contact(self.n)
        if low < creep < high:
            out = np.zeros((1, coupled_states.COLUMNS))
            d = np.array([0.5 * creep])  # kappa delta
            coupled_states.states_loop(self._row, self.mu, d, d, found, *self._guesses, True, out)
        else:  # full slip, whose state is known but for its contact
            side = int(creep >= high)
            out = self._full[[side]]
            coupled_states.full_slip(
                self._row, self.mu, 2.0 * side - 1.0, found, 0.5 * out[0, 0], out[0]
            )
        self.refuse_unsolved(out[:, 8], [creep])
        p, q = (np.concatenate([[0.0], each, [0.0]]) for each in (found.p, found.q))
        unit = coupled_states.LOAD / np.trapezoid(p, found.nodes)
        shift = 0.5 * out[0, 0] * out[0, 1]  # half of lam times epsilon
        return CoupledProfile(found.nodes, shift, p=p * unit, q=q * unit)

    def refuse_unsolved(self, status: Any, creeps: Any) -> None:
        """Raise ConvergenceError for the first state whose status is not 0; else do nothing.

        status: status of the kernels for each state, (n,).
        creeps: reduced creepages 2 kappa delta, (n,), for the message.
        """
        for code, creep in zip(np.asarray(status, int), creeps, strict=True):
            if code:
                raise ConvergenceError(
                    "contact with pressure and shear solved together (method 'coupled'): "
                    f"{_REASONS[code]} at |V| T_ref/l0 = {self.u:g}, mu = {self.mu:g}, "
                    f"2 delta R/l0 = {creep:g} (infinite: full slip; delta: creepage, l0: contact "
                    "length at rest); please report this defect of viscoroll"
                )
