"""Hashes of what the package computes, for a change that must not move a bit.

    python -m pipeline.evidence.same                 the hashes of this tree
    python -m pipeline.evidence.same --base HEAD     beside those of a commit: exit code 1 where they differ

Contact states, stresses, motions, maps, steady rolling and tables through the public interface alone: the script
outlives any move inside.
"""

from __future__ import annotations

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

import viscoroll as vr

ROOT = Path(__file__).parents[2]
_STATES, _MOTIONS = 20_000, 1_000
_ALL = ("V", "omega", "x", "angle", "delta", "regime", "slip_loss", "rolling_loss")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--base", metavar="REV", help="compare with this commit")
    base = parser.parse_args().base
    here = {name: _hash(values) for name, values in parts()}
    there = _hashes_at(base) if base else here
    for name, value in here.items():
        print(f"{name:<20} {value}" + ("" if there[name] == value else f"  was {there[name]}"))
    return int(here != there)


def parts() -> Iterator[tuple[str, list[Any]]]:
    """What is computed, and its name without blanks."""
    draw = np.random.default_rng(12)
    V = 10.0 ** draw.uniform(-12.0, 12.0, _STATES) * draw.choice((-1.0, 1.0), _STATES)
    delta = 10.0 ** draw.uniform(-9.0, 0.5, _STATES) * draw.choice((-1.0, 1.0), _STATES)
    alpha = 1.0 + 10.0 ** draw.uniform(-8.0, 5.0, _STATES)
    V[:2], delta[2:4], alpha[4:8] = 0.0, 0.0, 1.0
    scene, scenes = vr.presets.PAPER_SECTION_5, vr.Scene(alpha=alpha, kappa=2.9, mu=0.2)
    yield "contact", _values(vr.contact(scene, V, delta=delta))
    yield "contact-own-alpha", _values(vr.contact(scenes, V, delta=delta))
    yield "contact-slopes", _values(vr.contact(scenes, V, delta=delta, slopes=True))
    slower = np.abs(V[:1000]) < 1e9
    yield "contact-direct", _values(vr.contact(scene, V[:1000][slower], delta=delta[:1000][slower], method="direct"))
    x = np.linspace(-1.0, 2.0, 301)[:, None]
    yield "stress", _values(vr.stress(vr.Scene(alpha=alpha[:100], kappa=2.9, mu=0.2), x, V[:100], delta=delta[:100]))
    V0, omega0 = draw.uniform(-2.0, 2.0, (2, _MOTIONS))
    own = scene.replace(
        alpha=alpha[:_MOTIONS], kappa=10.0 ** draw.uniform(-0.3, 2.0, _MOTIONS),
        mu=10.0 ** draw.uniform(-2.0, 0.3, _MOTIONS), j=draw.uniform(0.2, 2.0, _MOTIONS),
    )  # fmt: skip
    t = np.linspace(0.0, 3e-3, 13)
    for rtol in (1e-6, 1e-10):
        for name, each in (("motions-own-scene", own), ("motions", scene)):
            e = vr.ensemble(each, V0, omega0, t, rtol=rtol, method="integrate", rest=1e-3, fields=_ALL)
            yield f"{name}-{rtol:g}", [*(getattr(e, field) for field in _ALL), e.onset_time, e.rest_time, e.steps]
    m = vr.roll(scene.replace(mu=0.01), 1.0, 1.0, t)
    yield "roll", [m.V, m.omega, m.x, m.angle, m.delta, m.regime, [each.t for each in m.switches]]
    e = vr.ensemble(scene, V0, omega0, t, method="flow", fields=_ALL)
    yield "flow-map", [getattr(e, field) for field in _ALL]
    yield from _bodies_and_drives(V, delta, V0, omega0, t)
    axes = np.geomspace(0.01, 10.0, 9), np.linspace(-0.1, 0.1, 11), np.array([1.0, 3.0, 11.0])
    grid = vr.tables.build(vr.Scene(2.0, 2.9, 0.2), *axes)
    yield "grid", [each.values for each in grid.data_vars.values()]
    law = vr.tables.law(vr.presets.RUBBER_CYLINDER.material)
    yield "law", [each.values for each in law.data_vars.values()]


def _bodies_and_drives(V: Any, delta: Any, V0: Any, omega0: Any, t: Any) -> Iterator[tuple[str, list[Any]]]:
    """Several relaxation times, two bodies, a material for each motion, drives, steady rolling."""
    strengths, times = np.array([3.0, 5.0, 1.0]), (1e-3, 0.1, 10.0)
    rubber, plastic = vr.Prony(strengths, times), vr.Prony((2.0,), (1.0,))
    each = vr.Prony(np.linspace(1.0, 6.0, 50)[:, None] * strengths, times)
    for name, material, own in (
        ("series", rubber, each),
        ("pair", vr.Bodies(plastic, rubber, 0.3), vr.Bodies(plastic, each, 0.3)),
    ):
        scene = vr.Scene(material=material, kappa=20.0, mu=0.2, gamma=100.0)
        yield f"contact-{name}", _values(vr.contact(scene, V, delta=delta, slopes=True))
        motions = vr.ensemble(scene.replace(material=own), V0[:50], omega0[:50], t, method="integrate", fields=_ALL)
        yield f"motions-{name}-each", [getattr(motions, field) for field in _ALL]
        driven = vr.ensemble(
            scene, V0[:200], omega0[:200], t, force=0.03, torque=np.linspace(-0.1, 0.1, 200), fields=_ALL
        )
        yield f"driven-{name}", [getattr(driven, field) for field in _ALL]
        steady = vr.steady(scene, torque=np.geomspace(1e-4, 0.1, 50))
        yield f"steady-{name}", [steady.V, steady.omega, steady.Q, steady.M_half_space, steady.M_cylinder]


def _values(result: Any) -> list[Any]:
    return list(result.as_dict().values())


def _hash(values: list[Any]) -> str:
    total = hashlib.sha256()
    for each in values:
        total.update(np.ascontiguousarray(each, dtype=np.float64).tobytes())
    return total.hexdigest()[:16]


def _hashes_at(revision: str) -> dict[str, str]:
    """What this script finds in a copy of another commit."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, __file__], env=os.environ | {"PYTHONPATH": str(checked_out(revision, Path(folder)))},
            stdout=subprocess.PIPE, text=True, check=True,
        )  # fmt: skip
    return dict(line.split() for line in done.stdout.splitlines())


def checked_out(revision: str, folder: Path) -> Path:
    """``src`` of a commit, in a folder; raises FileNotFoundError where this clone lacks the commit."""
    archive = subprocess.run(["git", "-C", ROOT, "archive", revision, "src"], capture_output=True, check=False)
    if archive.returncode:
        raise FileNotFoundError(f"no commit {revision} here; a shallow clone has few: git fetch --unshallow")
    subprocess.run(["tar", "-x", "-C", folder], input=archive.stdout, check=True)
    return folder / "src"


if __name__ == "__main__":
    sys.exit(main())
