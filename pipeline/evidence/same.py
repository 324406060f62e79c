"""Hashes of what the package computes, for a change that must not move a bit.

    python -m pipeline.evidence.same                 the hashes of this tree
    python -m pipeline.evidence.same --base HEAD     beside those of a commit: exit code 1 where they differ

Contact states, stresses, motions, maps, steady rolling and tables through the public interface
alone: the script outlives any move inside.
"""  # noqa: E501

import argparse
import hashlib
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import viscoroll as vr

ROOT = Path(__file__).parents[2]
_STATES = 20_000
_MOTIONS = 1_000
_ALL = ("V", "omega", "x", "angle", "delta", "regime", "slip_loss", "rolling_loss")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--base", metavar="REV", help="compare with this commit")
    base = parser.parse_args().base
    here = {name: _hash(found) for name, found in parts()}
    there = _hashes_at(base) if base else here
    for name, value in here.items():
        print(f"{name:<20} {value}" + ("" if there[name] == value else f"  was {there[name]}"))
    return int(here != there)


def parts() -> Iterator[tuple[str, Any]]:
    """What is computed, and its name without blanks."""
    draw = np.random.default_rng(12)
    V, delta = (
        10.0 ** draw.uniform(*ends, _STATES) * draw.choice((-1.0, 1.0), _STATES)
        for ends in ((-12, 12), (-9, 0.5))
    )
    alpha = 1.0 + 10.0 ** draw.uniform(-8.0, 5.0, _STATES)
    V[:2] = 0.0
    delta[2:4] = 0.0
    alpha[4:8] = 1.0
    scene = vr.presets.PAPER_SECTION_5
    scenes = vr.Scene(alpha=alpha, kappa=2.9, mu=0.2)
    yield "contact", vr.contact(scene, V, delta=delta)
    yield "contact-own-alpha", vr.contact(scenes, V, delta=delta)
    yield "contact-slopes", vr.contact(scenes, V, delta=delta, slopes=True)
    slower = np.flatnonzero(np.abs(V[:1000]) < 1e9)
    yield "contact-direct", vr.contact(scene, V[slower], delta=delta[slower], method="direct")
    x = np.linspace(-1.0, 2.0, 301)[:, None]
    yield (
        "stress",
        vr.stress(vr.Scene(alpha=alpha[:100], kappa=2.9, mu=0.2), x, V[:100], delta=delta[:100]),
    )
    starts = draw.uniform(-2.0, 2.0, (2, _MOTIONS))
    t = np.linspace(0.0, 3e-3, 13)
    kappa, mu = 10.0 ** draw.uniform([[-0.3], [-2.0]], [[2.0], [0.3]], (2, _MOTIONS))
    own = scene.replace(
        alpha=alpha[:_MOTIONS], kappa=kappa, mu=mu, j=draw.uniform(0.2, 2.0, _MOTIONS)
    )

    def motions(each, count=_MOTIONS, **how):
        return vr.ensemble(each, *starts[:, :count], t, fields=_ALL, **how)

    for rtol in (1e-6, 1e-10):
        for name, each in (("motions-own-scene", own), ("motions", scene)):
            yield f"{name}-{rtol:g}", motions(each, rtol=rtol, method="integrate", rest=1e-3)
    motion = vr.roll(scene, *starts[:, 0], t, torque=0.3)
    yield "roll", motion
    yield "switches", xr.Dataset({"t": ("change", [each.t for each in motion.switches])})
    yield "flow-map", motions(scene, method="flow")
    strengths = np.array([3.0, 5.0, 1.0])
    times = (1e-3, 0.1, 10.0)
    rubber = vr.Prony(strengths, times)
    plastic = vr.Prony((2.0,), (1.0,))
    each = vr.Prony(np.linspace(1.0, 6.0, 50)[:, None] * strengths, times)
    pair, pairs = (vr.Bodies(plastic, one, 0.3) for one in (rubber, each))
    for name, material, many in (("series", rubber, each), ("pair", pair, pairs)):
        scene = vr.Scene(material=material, kappa=20.0, mu=0.2, gamma=100.0)
        yield f"contact-{name}", vr.contact(scene, V, delta=delta, slopes=True)
        yield f"motions-{name}-each", motions(scene.replace(material=many), 50, method="integrate")
        yield f"driven-{name}", motions(scene, 200, force=0.03, torque=np.linspace(-0.1, 0.1, 200))
        yield f"steady-{name}", vr.steady(scene, torque=np.geomspace(1e-4, 0.1, 50))
    axes = {"delta": np.linspace(-0.1, 0.1, 11), "alpha": np.array([1.0, 3.0, 11.0])}
    yield "grid", vr.tables.build(vr.Scene(2.0, 2.9, 0.2), np.geomspace(0.01, 10.0, 9), **axes)
    yield "law", vr.tables.law(vr.presets.RUBBER_CYLINDER.material)


def _hash(found):
    """Of all numbers of a result or a table."""
    data = found.to_xarray() if hasattr(found, "to_xarray") else found
    total = hashlib.sha256()
    for each in data.variables.values():
        if each.dtype.kind in "biuf":
            total.update(np.ascontiguousarray(each, dtype=np.float64).tobytes())
    return total.hexdigest()[:16]


def _hashes_at(revision):
    """What this script finds in a copy of another commit."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, __file__],
            env=os.environ | {"PYTHONPATH": str(checked_out(revision, Path(folder)))},
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
    return dict(line.split() for line in done.stdout.splitlines())


def checked_out(revision: str, folder: Path) -> Path:
    """``src`` of a commit, in a folder; raises FileNotFoundError where this clone lacks the
    commit.
    """
    archive = subprocess.run(
        ["git", "-C", ROOT, "archive", revision, "src"], capture_output=True, check=False
    )
    if archive.returncode:
        raise FileNotFoundError(
            f"no commit {revision} here; a shallow clone has few: git fetch --unshallow"
        )
    subprocess.run(["tar", "-x", "-C", folder], input=archive.stdout, check=True)
    return folder / "src"


if __name__ == "__main__":
    sys.exit(main())
