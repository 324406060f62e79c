"""The contact of a cylinder from atlas.nc and paper.nc, by xarray and its interp (which wants scipy).

    python read_tables_xarray.py [TABLES [CHECKS]]     default: data/tables docs/loading

Exit code 1 where a value is further from its check value than is stated there.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr


def cubic(table, **at):
    """Cubic splines, one axis after the other: along several at once interp is only good to 1e-5."""
    for axis, value in at.items():
        table = table.interp({axis: value}, method="cubic")
    return table


def from_atlas(atlas, state):
    """beta, Q and M for any kappa and mu: the steps of README.md."""
    mapped = atlas.assign_coords(
        alpha=np.log(atlas.alpha), kappa_V=np.log(atlas.kappa_V), s=1.0 - np.sqrt(1.0 - atlas.s)
    )
    there = cubic(
        mapped[["kappa_delta_star_over_mu", "kappa_M", "beta", "Q_over_mu"]],
        alpha=np.log(state.alpha),
        kappa_V=np.log(state.kappa * abs(state.V)),
    )
    s = min(abs(state.delta) * state.kappa / state.mu / there.kappa_delta_star_over_mu, 1.0)
    there = cubic(there, s=1.0 - np.sqrt(1.0 - s))
    beta, Q = (there.beta, state.mu * there.Q_over_mu) if s < 1.0 else (0.0 * s, state.mu)
    return xr.Dataset(
        {"beta": beta, "Q": np.sign(state.delta * state.V) * Q, "M": np.sign(state.V) * there.kappa_M / state.kappa}
    )


def from_paper(paper, state):
    """beta, Q and M at the kappa and mu of the file and one of its alphas."""
    found = paper[["beta", "Q", "M"]].sel(alpha=state.alpha).interp(V=abs(state.V), delta=state.delta)
    return found.assign(Q=np.sign(state.V) * found.Q, M=np.sign(state.V) * found.M)


def main(tables="data/tables", checks="docs/loading"):
    passed = True
    for name, look_up in (("atlas", from_atlas), ("paper", from_paper)):
        columns = np.genfromtxt(Path(checks) / f"check_{name}.csv", delimiter=",", names=True)
        check = xr.Dataset({column: ("state", columns[column]) for column in columns.dtype.names})
        with xr.open_dataset(Path(tables) / f"{name}.nc", engine="h5netcdf") as table:
            table.load()
        for row in (check.isel(state=n) for n in range(check.sizes["state"])):
            found = look_up(table, row)
            good = all(abs(found[field] - row[field]) <= row[f"allowed_{field}"] for field in ("beta", "Q", "M"))
            state = " ".join(f"{row[field].item():g}" for field in ("alpha", "kappa", "mu", "V", "delta"))
            values = " ".join(f"{field} {found[field].item():.9f}" for field in ("beta", "Q", "M"))
            print(f"{name} {state}: {values} {'ok' if good else 'WRONG'}")
            passed = passed and good
    return passed


if __name__ == "__main__":
    sys.exit(0 if main(*sys.argv[1:]) else 1)
