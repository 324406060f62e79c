"""The law of one material or pair as rows: an octave of kappa |V|, or of 1/F(eta), is one polynomial of 24 powers.

With u = kappa |V|, L(u) = lam (1 + epsilon), D = 2 kappa |delta|/mu and w = L - D, Eq. (10) reads F(eta) = w/(2 u), so
that with v = 2 u/w

    beta = share(v) w/lam       |Q|/mu = 1 - w^2 press(v)       share = eta/F(eta)      press = H(eta)/F(eta)^2

lam, epsilon, M/V and its parts are functions of u alone: seven functions of one variable, and no root (docs/design.md).
Row 0 is the slow end, 0 <= x < 2^e0, a polynomial of t = x 2^-e0; row n > 0 is the octave of x = m 2^(e0+n), m in
[1/2, 1), one of t = 4 m - 3; behind the last row the fast limit holds.  V = 0 and full slip need nothing special.
"""
