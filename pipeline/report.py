"""Report: one page over all that was made -> out/index.html.

python -m pipeline.report [--config FILE] [-o FOLDER]
"""

from __future__ import annotations

import base64
import json
import os
import sys
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import Any

import viscoroll as vr
from viscoroll.core.errors import FileError
from viscoroll.core.files import write_text
from viscoroll.presets import PRESETS

from . import stage

STAGES = {
    "offline": "Tables of the law",
    "runtime": "Motions from the law file",
    "ensemble": "Random initial speeds",
    "validate": "Validation with the printed equations",
    "benchmark": "Time and error",
    "figures": "Figures",
}
#: Section of figures -> figure -> caption, in order.
SECTIONS: dict[str, dict[str, str]] = stage.read_toml(stage.ROOT / "pipeline/captions.toml")
_STYLE = (
    "body{font:16px/1.45 sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#111}"
    "table{border-collapse:collapse;margin:.6em 0}td,th{border:1px solid #bbb;padding:.2em "
    ".6em;text-align:left}"
    "td.n{text-align:right;font-variant-numeric:tabular-nums}img{max-width:100%;border:1px solid "
    "#ddd}"
    "figure{margin:1.5em "
    "0}pre{overflow-x:auto;background:#f4f4f4;padding:.8em;font-size:12px}.bad{font-weight:bold}"
)


def records(out: Path) -> dict[str, dict[str, Any]]:
    """What the stages left under <out>/stages.

    Raises
    ------
    FileError
        If one of them has not run, or its record is damaged.
    """
    found = {}
    for name in STAGES:
        path = out / "stages" / f"{name}.json"
        try:
            found[name] = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise FileError(path, f"cannot be read ({error}); run pipeline.{name} first") from error
    return found


def grid(lines: Iterable[Iterable[Any]]) -> str:
    """An HTML table."""
    told = (
        "".join(
            f"<td{' class=n' if isinstance(value, float) else ''}>{escape(stage.readable(value))}</td>"  # noqa: E501
            for value in line
        )
        for line in lines
    )
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in told)}</table>"


def link(path: Path, out: Path) -> str:
    """A link as seen from the page."""
    target = Path(os.path.relpath(path, out)).as_posix()
    return f'<a href="{escape(target)}">{escape(path.name)}</a>'


def links(out: Path, record: dict[str, Any]) -> str:
    """What a stage left."""
    return f"<p>{', '.join(link(out / file, out) for file in record['files'])}</p>"


def picture(path: Path, out: Path, caption: str) -> str:
    """A figure with its image in the page itself."""
    data = base64.b64encode(path.read_bytes()).decode()
    image = f'<img src="data:image/png;base64,{data}" alt="{escape(caption)}">'
    return f"<figure>{image}<figcaption>{escape(caption)} {link(path, out)}</figcaption></figure>"


def pictures(out: Path, found: dict[str, dict[str, Any]]) -> list[str]:
    """The sections of figures, each with its numbers."""
    drawn = {Path(file).stem: out / file for file in found["figures"]["files"]}
    numbers = {
        "Free motion from three initial conditions": "runtime",
        "Random initial conditions": "ensemble",
    }
    parts = []
    for title, captions in SECTIONS.items():
        parts.append(f"<h2>{escape(title)}</h2>")
        if title in numbers:
            parts += [
                grid(found[numbers[title]]["headline"].items()),
                links(out, found[numbers[title]]),
            ]
        parts += [
            picture(drawn.pop(name), out, caption)
            for name, caption in captions.items()
            if name in drawn
        ]
    return parts + [picture(path, out, name) for name, path in drawn.items()]


def introduced(found: dict[str, dict[str, Any]]) -> str:
    """Introduce the page: the rollers that it shows, and the stages that made it."""
    name = str(found["ensemble"]["headline"]["preset"])
    return (
        "<p>A viscoelastic cylinder rolls and slides on a half-space of its material: first a "
        "rubber roller in SI "
        f"units, then the example of Sect. 5 of the paper, dimensionless (preset {escape(name)}: "
        f"{escape(str(PRESETS[name]))}).</p>"
        "<p>Five stages made this page.  <b>Offline</b> writes the law of each material to a file, "
        "and Q, M and other "
        "quantities on a grid of V, δ and α.  <b>Runtime</b> integrates Eq. (22) with the law "
        "file.  <b>Ensemble</b> "
        "integrates motions with random initial speeds.  <b>Validate</b> compares tables and "
        "motions with numerical "
        "roots of the printed equations.  <b>Benchmark</b> measures time and error.</p>"
    )


def page(out: Path, found: dict[str, dict[str, Any]]) -> str:
    """The whole page: the physics first, then tables and checks, seconds last."""
    failed = found["validate"]["failed"]
    times = stage.read_rows(out / "benchmark.csv")
    verdict = (
        '<span class="bad">a stated tolerance is exceeded</span>'
        if failed
        else "every check passed"
    )
    parts = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8"><title>viscoroll</title>',
        f"<style>{_STYLE}</style></head><body>",
        "<h1>A viscoelastic cylinder, rolling and sliding</h1>",
        introduced(found),
        *pictures(out, found),
        "<h2>Tables</h2>",
        grid(found["offline"]["headline"].items()),
        links(out, found["offline"]),
        f"<h2>{STAGES['validate']}</h2>",
        f"<p>{verdict}.</p>",
        grid(found["validate"]["headline"].items()),
        links(out, found["validate"]),
        f"<pre>{escape((out / 'validation.txt').read_text(encoding='utf-8'))}</pre>",
        f"<h2>{STAGES['benchmark']}</h2><p>One compiled integrator computes the motions of the "
        "paper and random ones, "
        "with the law from splines on grids of n by n nodes, from the law file, and from numerical "
        "roots at every "
        "call.  The last rows are those of vr.roll.  The reference values are motions with "
        "numerical roots of the "
        "printed equations.  An error is the largest one of V and ω, divided by the initial speed. "
        " The last columns "
        "have the size of each table, and its largest error of Q, divided by the load.</p>",
        grid([times[0], *(row.values() for row in times)]),
        picture(
            out / "figures/benchmark.png",
            out,
            "Left: time, error of motions.  Right: size, error of tables.",
        ),
        f"<h2>Duration of the stages</h2><p>viscoroll {escape(vr.__version__)}, seconds:</p>",
        grid((STAGES[name], record["seconds"]) for name, record in found.items()),
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def work(config: Path, out: Path) -> stage.Outcome:
    del config  # nothing of it
    write_text(out / "index.html", page(out, records(out)))
    return stage.Outcome([out / "index.html"])


if __name__ == "__main__":
    sys.exit(stage.run("report", None, work, __doc__))
