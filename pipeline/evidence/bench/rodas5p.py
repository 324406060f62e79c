"""Coefficients and dense output of the Rosenbrock method RODAS5P, for the baseline.

RODAS5P: 8 stages, order 5, embedded order 4, stiffly accurate and L-stable, no order
reduction on the problem of Prothero and Robinson, dense output of order 4.  Coefficients:
G. Steinebach, Construction of Rosenbrock-Wanner method Rodas5P and numerical benchmarks
within the Julia Differential Equations package, BIT Numer. Math. 63:27 (2023),
doi:10.1007/s10543-023-00967-x.
"""

from __future__ import annotations

import numpy as np

from viscoroll.kernels.compile.jit import kernel

STAGES = 8

GAMMA = 0.21193756319429014
_A6 = (-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946)
_A = (
    (),
    (3.0,),
    (2.849394379747939, 0.45842242204463923),
    (-6.954028509809101, 2.489845061869568, -10.358996098473584),
    (2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641),
    _A6,
    (*_A6, 1.0),
    (*_A6, 1.0, 1.0),
)
_C = (
    (),
    (-14.155112264123755,),
    (-17.97296035885952, -2.859693295451294),
    (147.12150275711716, -1.41221402718213, 71.68940251302358),
    (165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306),
    (24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125, -0.6610691825249471),
    (30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783, -19.097331116725623,
     -28.087943162872662),
    (37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047, -40.06618937091002,
     -54.66780262877968, -9.48861652309627),
)  # fmt: skip
_H = np.array((
    (25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204,
     0.524948541321073, 1.1241088310450404, 0.4272876194431874, -0.17202221070155493),
    (-9.91568850695171, -0.9689944594115154, 3.0438037242978453, -24.495224566215796,
     20.176138334709044, 15.98066361424651, -6.789040303419874, -6.710236069923372),
    (11.419903575922262, 2.8879645146136994, 72.92137995996029, 80.12511834622643,
     -52.072871366152654, -59.78993625266729, -0.15582684282751913, 4.883087185713722),
))  # fmt: skip


def _square(rows: tuple) -> np.ndarray:
    return np.array([(*row, *[0.0] * (STAGES - len(row))) for row in rows])


A, C = _square(_A), _square(_C)


@kernel
def dense_terms(K, terms):
    """Coefficients of the dense output of the step whose stages are in K."""
    for m in range(4):
        first = second = third = 0.0
        for n in range(STAGES):
            first += _H[0, n] * K[n, m]
            second += _H[1, n] * K[n, m]
            third += _H[2, n] * K[n, m]
        # first + theta (second + theta third), in theta and 1 - theta
        terms[0, m], terms[1, m], terms[2, m] = first, second + third, -third
        terms[3, m] = terms[4, m] = terms[5, m] = 0.0


@kernel
def dense(theta, old, new, terms, m):
    """Unknown m at the fraction theta of the step."""
    rest = 1.0 - theta
    inner = terms[3, m] + rest * (terms[4, m] + theta * terms[5, m])
    inner = terms[0, m] + theta * (terms[1, m] + rest * (terms[2, m] + theta * inner))
    return old[m] + theta * (new[m] - old[m] + rest * inner)
