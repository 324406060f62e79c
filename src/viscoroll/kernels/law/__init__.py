"""The law of one material or pair as rows of polynomials: one octave of kappa |V|, or of 1/F(eta),
is one row.

A row holds the coefficients of 24 powers of t for each function (:mod:`.law_record` names every
column).  Times are divided by T_epsilon, or T_ref of a series (docs/symbols.md).  zeta is half the
transit time of the contact, eta that of its stick zone, and g, h and m are functions of a half
transit time z, those of the material (:mod:`.material_series`).  With F = z + g and H = z^2 + 2 z h
Eqs. (6), (8)-(10), (15), (16) of the paper read, for V > 0 and delta >= 0,

    H(zeta) = 1/(2 kappa V)^2               lam = 2 kappa V zeta        epsilon = g(zeta)/zeta
    delta_star = mu V F(zeta)               F(zeta) - F(eta) = delta/(mu V)      beta = eta/zeta
    Q = mu (1 - H(eta)/H(zeta))             M = V m(zeta)

With u = kappa |V|, L(u) = lam (1 + epsilon), D = 2 kappa |delta|/mu and w = L - D, Eq. (10) is
F(eta) = w/(2 u), so that with v = 2 u/w

    beta = (eta/F)(v) w/lam       |Q|/mu = 1 - w^2 (H/F^2)(v)

lam, epsilon, M/V and its parts are functions of u alone: seven functions of one variable, and no
root (docs/design.md).  Row 0 is the slow end, 0 <= x < 2^e0, a polynomial of t = x 2^-e0; row n > 0
is the octave of x = m 2^(e0+n), m in [1/2, 1), one of t = 4 m - 3; beyond the last row the fast
limit holds.  V = 0 and full slip need nothing special.

A cover of finite thickness (:mod:`.cover_law`) has rows of its own of these functions, with L = 2
kappa delta_star/mu and with (H/F^2)(2 u/L) = 1/L^2 and (eta/F)(2 u/L) = lam/L; and D counts from
the creep at Q = 0, delta_0(u).
"""
