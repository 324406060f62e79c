"""Stress over arrays of points."""

from __future__ import annotations

from ..compile.jit import kernel
from .material import standard
from .stress import stress_at


@kernel
def stress_loop(x, kappa, mu, lam, epsilon, beta, zeta, alpha, p, tau, start, stop):
    """p/E' and |tau|/E' at points start..stop; x points ahead of the axis."""
    for i in range(start, stop):
        p[i], tau[i] = stress_at(
            x[min(i, x.size - 1)], kappa[min(i, kappa.size - 1)], mu[min(i, mu.size - 1)],
            lam[min(i, lam.size - 1)], epsilon[min(i, epsilon.size - 1)], beta[min(i, beta.size - 1)],
            zeta[min(i, zeta.size - 1)], standard(alpha[min(i, alpha.size - 1)]),
        )  # fmt: skip
