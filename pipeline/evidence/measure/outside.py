"""The law outside Python: the page that computes, C and Node -> data/results/outside.json (kept in
git).

    python -m pipeline.evidence.measure.outside [--config FILE] [--quick] [-o FILE]

Wants chromium, node and cc (make site-tools interop-tools); sizes are in [outside] of the
configuration.  Every number is of one core.  pipeline/evidence/document/ puts it into docs/live.md
and docs/loading/README.md.
"""

import html
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import viscoroll as vr
from viscoroll import tables
from viscoroll.core.errors import MissingDependencyError
from viscoroll.presets import read_law_source

from ...stage import ROOT, Row, Sizes
from ...validation import FIELDS
from ..results import run

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
#: of which law, on the page and in the programs
RUBBER = ROOT / "src/viscoroll/datasets/rubber.toml"
#: live.md without its theme: sets a slider, and times the redraw with its layout
PAGE = """<!DOCTYPE html><link rel="stylesheet" href="viscoroll.css"><pre id="found"></pre><div id="law"></div>
<script src="read_law.js"></script><script src="rubber.js"></script><script src="live.js"></script>
<script>
const place = document.getElementById("law"), found = [];
for (const state of STATES) {
  let ms = 0;
  for (const [name, value] of Object.entries(state)) {
    const slider = place.querySelector(`[name=${name}]`), begun = performance.now();
    slider.value = value;
    slider.dispatchEvent(new Event("input"));
    place.offsetHeight;
    ms = performance.now() - begun;
  }
  const shown = [...place.querySelectorAll("data")].map(one => [one.id, Number(one.value)]);
  found.push({ ms, ...Object.fromEntries(shown) });
}
document.getElementById("found").textContent = JSON.stringify(found);
</script>
"""  # noqa: E501
NODE = """
const law = require("./read_law.js"), fs = require("fs"), contact = law(JSON.parse(fs.readFileSync("rubber.json")));
const states = JSON.parse(fs.readFileSync("states.json"));
let best = Infinity, sum = 0;
for (let n = 0; n < 20; n++) {
  const begun = process.hrtime.bigint();
  for (const [kappa, mu, V, slip] of states) sum += contact(kappa, mu, V, slip).Q;
  best = Math.min(best, Number(process.hrtime.bigint() - begun) / states.length);
}
console.log(best);
"""  # noqa: E501
C = """
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include "rubber.h"
static const double X[][4] = {STATES};
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return 1e9 * t.tv_sec + t.tv_nsec; }
int main(void) {
  int count = sizeof X / sizeof *X;
  double sum = 0.0;
  for (int slopes = 0; slopes < 2; slopes++) {
    double best = 1e99;
    for (int n = 0; n < 20; n++) {
      double begun = now();
      for (int i = 0; i < count; i++) {
        vr_state s;
        vr_slopes d = {0.0, 0.0, 0.0, 0.0, 0.0};
        if (slopes) vr_contact_slopes(&rubber, X[i][0], X[i][1], X[i][2], X[i][3], &s, &d);
        else s = vr_contact(&rubber, X[i][0], X[i][1], X[i][2], X[i][3]);
        sum += s.Q + d.dQ_dV;
      }
      best = fmin(best, (now() - begun) / count);
    }
    printf("%g\\n", best);
  }
  return sum == 0.1;
}
"""  # noqa: E501


def measure(sizes):
    """All that outside.json holds beside the machine."""
    law = tables.law(read_law_source(RUBBER))
    with TemporaryDirectory() as name:
        folder = Path(name)
        tables.export(law, folder / "rubber.json")
        tables.export(law, folder / "rubber.h")
        return {"sizes": sizes, "page": page(folder, sizes), "states": programs(folder, sizes)}


def program(*names: str) -> str:
    """The first of them that is installed."""
    found = next(filter(None, map(shutil.which, names)), None)
    if found is None:
        raise MissingDependencyError(names[0], None)
    return found


def printed(folder: Path, *command: str) -> str:
    environment = os.environ | {"HOME": str(folder)}
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=True, env=environment
    ).stdout


def page(folder: Path, sizes: Sizes) -> Row:
    """Milliseconds of a redraw, and the largest errors of the numbers that are shown."""
    random = np.random.default_rng(sizes["seed"])
    count = sizes["redraws"]
    columns = {
        "creep": random.uniform(-0.3, 0.3, count),
        "mu": random.uniform(-2, 0, count),
        "u": random.uniform(-3, 9, count),
    }
    states = [
        dict(zip(columns, map(float, row), strict=True))
        for row in zip(*columns.values(), strict=True)
    ]
    for path in ("loading/read_law.js", "_static/live.js", "_static/viscoroll.css"):
        shutil.copy(ROOT / "docs" / path, folder)
    rubber = (folder / "rubber.json").read_text(encoding="utf-8")
    (folder / "rubber.js").write_text(f"const RUBBER = {rubber};\n", encoding="utf-8")
    (folder / "page.html").write_text(PAGE.replace("STATES", json.dumps(states)), encoding="utf-8")
    options = "--headless --no-sandbox --disable-gpu --disable-dev-shm-usage --dump-dom"
    shown = printed(folder, program(*BROWSERS), *options.split(), (folder / "page.html").as_uri())
    found = json.loads(
        html.unescape(re.search(r'<pre id="found">(.*?)</pre>', shown, re.DOTALL)[1])
    )  # type: ignore[index]
    at = {name: np.array([one[name] for one in found]) for name in found[0]}
    exact = vr.contact(
        vr.Scene(kappa=1.0, mu=at["mu"], material=read_law_source(RUBBER).pair.law),
        at["u"],
        delta=at["creep"],
    )
    ms = at["ms"]
    return {
        "median_ms": np.median(ms),
        "slowest_ms": ms.max(),
        "bytes": len(rubber),
        "error": max(
            largest(at[name], getattr(exact, name), 1.0 if name == "beta" else 0.0)
            for name in FIELDS
        ),
    }


def largest(found, exact, scale=0.0) -> float:
    """Largest difference over the larger of ``exact`` and ``scale``."""
    return np.max(np.abs(found - exact) / np.maximum(np.abs(exact), scale))


def programs(folder: Path, sizes: Sizes) -> dict[str, float]:
    """Nanoseconds a state."""
    random = np.random.default_rng(sizes["seed"])
    count = sizes["states"]
    kappa = 10.0 ** random.uniform(0, 2, count)
    mu = 10.0 ** random.uniform(-3, 0, count)
    V = 10.0 ** random.uniform(-4, 9, count) / kappa
    star = vr.contact(
        vr.Scene(kappa=kappa, mu=mu, material=read_law_source(RUBBER).pair.law), V, delta=0.0
    ).delta_star
    states = np.column_stack([kappa, mu, V, star * V * random.uniform(-1, 1, count)]).tolist()
    (folder / "states.json").write_text(json.dumps(states))
    (folder / "node.js").write_text(NODE)
    rows = ",".join("{" + ",".join(map(repr, row)) + "}" for row in states)
    (folder / "time.c").write_text(C.replace("STATES", rows))
    printed(folder, program("cc"), *["-std=c99", "-O2", "time.c", "-lm", "-o", "time"])
    values, slopes = map(float, printed(folder, "./time").split())
    return {
        "c_ns": values,
        "c_slopes_ns": slopes,
        "node_ns": float(printed(folder, program("node"), "node.js")),
    }


if __name__ == "__main__":
    sys.exit(run("outside", measure, __doc__))
