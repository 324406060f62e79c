"""The contact of a cylinder from atlas.nc and paper.nc, by h5py and numpy alone.

    python read_tables_h5py.py [TABLES [CHECKS]]     default: data/tables docs/loading

Exit code 1 where a value is further from its check value than is stated there.
"""

import itertools
import sys
from pathlib import Path

import h5py
import numpy as np


def read(path):
    with h5py.File(path) as file:
        return {name: item[...] for name, item in file.items()}


def six_points(nodes, x):
    """Weights of the polynomial through the six nodes around x, and the first of them; nodes are evenly spaced."""
    position = (x - nodes[0]) / (nodes[-1] - nodes[0]) * (nodes.size - 1)
    first = np.clip(np.floor(position).astype(int) - 2, 0, nodes.size - 6)
    t = position - first
    return [np.prod([(t - m) / (k - m) for m in range(6) if m != k], axis=0) for k in range(6)], first


def two_points(nodes, x):
    """Weights of linear interpolation, and the first of the two nodes around x."""
    first = np.clip(np.searchsorted(nodes, x) - 1, 0, nodes.size - 2)
    t = (x - nodes[first]) / (nodes[first + 1] - nodes[first])
    return [1.0 - t, t], first


def look_up(values, *axes):
    """Sum of weights times values; an axis is a pair of weights and first index."""
    total = 0.0
    for corner in itertools.product(*(range(len(weights)) for weights, _ in axes)):
        weight = np.prod([weights[k] for k, (weights, _) in zip(corner, axes)], axis=0)
        total += weight * values[tuple(first + k for k, (_, first) in zip(corner, axes))]
    return total


def from_atlas(atlas, alpha, kappa, mu, V, delta):
    """beta, Q and M for any kappa and mu: the steps of README.md."""
    a = six_points(np.log(atlas["alpha"]), np.log(alpha))
    v = six_points(np.log(atlas["kappa_V"]), np.log(kappa * np.abs(V)))
    delta_star = mu / kappa * look_up(atlas["kappa_delta_star_over_mu"], a, v)
    s = np.minimum(np.abs(delta) / delta_star, 1.0)
    u = six_points(1.0 - np.sqrt(1.0 - atlas["s"]), 1.0 - np.sqrt(1.0 - s))
    beta = np.where(s < 1.0, look_up(atlas["beta"], a, v, u), 0.0)
    Q = mu * np.where(s < 1.0, look_up(atlas["Q_over_mu"], a, v, u), 1.0)
    M = look_up(atlas["kappa_M"], a, v) / kappa
    return beta, np.sign(delta * V) * Q, np.sign(V) * M


def from_paper(paper, alpha, V, delta):
    """beta, Q and M at the kappa and mu of the file and one of its alphas."""
    n = np.searchsorted(paper["alpha"], alpha)
    v, d = two_points(paper["V"], np.abs(V)), two_points(paper["delta"], delta)
    at_alpha = [np.ones(n.shape)], n
    beta, Q = (look_up(paper[name], v, d, at_alpha) for name in ("beta", "Q"))
    return beta, np.sign(V) * Q, np.sign(V) * look_up(paper["M"], v, at_alpha)


def report(table, check, values):
    """One line a state; whether all are within what is allowed."""
    passed = True
    for row, *found in zip(check, *values):
        good = all(abs(value - row[name]) <= row[f"allowed_{name}"] for name, value in zip(("beta", "Q", "M"), found))
        state = " ".join(f"{row[name]:g}" for name in ("alpha", "kappa", "mu", "V", "delta"))
        print(f"{table} {state}: beta {found[0]:.9f} Q {found[1]:.9f} M {found[2]:.9f} {'ok' if good else 'WRONG'}")
        passed = passed and good
    return passed


def main(tables="data/tables", checks="docs/loading"):
    check = np.genfromtxt(Path(checks) / "check_atlas.csv", delimiter=",", names=True)
    state = [check[name] for name in ("alpha", "kappa", "mu", "V", "delta")]
    passed = report("atlas", check, from_atlas(read(Path(tables) / "atlas.nc"), *state))
    check = np.genfromtxt(Path(checks) / "check_paper.csv", delimiter=",", names=True)
    state = [check[name] for name in ("alpha", "V", "delta")]
    return report("paper", check, from_paper(read(Path(tables) / "paper.nc"), *state)) and passed


if __name__ == "__main__":
    sys.exit(0 if main(*sys.argv[1:]) else 1)
