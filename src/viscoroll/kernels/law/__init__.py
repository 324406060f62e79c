"""The contact law, explicit in (zeta, eta): its two inverses, its slopes, the stresses, and arrays of states.

With F, H and m of a material (room ``material``) Eqs. (6), (8)-(10), (15), (16) of the paper read, for V > 0 and
delta >= 0,

    H(zeta) = 1/(2 kappa V)^2               lam = 2 kappa V zeta        epsilon = g(zeta)/zeta
    delta_star = mu V F(zeta)               F(zeta) - F(eta) = delta/(mu V)      beta = eta/zeta
    Q = mu (1 - H(eta)/H(zeta))             M = V m(zeta)
"""
