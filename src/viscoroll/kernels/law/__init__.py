"""States of the contact by name, and what is computed of a material by its modes, without rows: stresses, and N.

With F = z + g, H = z^2 + 2 z h and m of a material (:mod:`..rows.series`) Eqs. (6), (8)-(10), (15), (16) of the paper
read, for V > 0 and delta >= 0,

    H(zeta) = 1/(2 kappa V)^2               lam = 2 kappa V zeta        epsilon = g(zeta)/zeta
    delta_star = mu V F(zeta)               F(zeta) - F(eta) = delta/(mu V)      beta = eta/zeta
    Q = mu (1 - H(eta)/H(zeta))             M = V m(zeta)
"""
