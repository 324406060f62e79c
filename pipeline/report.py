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
from .figures.captions import SECTIONS

STAGES = {
    "offline": "The tables of the law",
    "runtime": "Motions from the file of the law",
    "ensemble": "Random starts",
    "validate": "Against direct solves of the printed equations",
    "benchmark": "Time against error",
    "figures": "Figures",
}
_STYLE = (
    "body{font:16px/1.45 sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#111}"
    "table{border-collapse:collapse;margin:.6em 0}td,th{border:1px solid #bbb;padding:.2em .6em;text-align:left}"
    "td.n{text-align:right;font-variant-numeric:tabular-nums}img{max-width:100%;border:1px solid #ddd}"
    "figure{margin:1.5em 0}pre{overflow-x:auto;background:#f4f4f4;padding:.8em;font-size:12px}.bad{font-weight:bold}"
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
            f"<td{' class=n' if isinstance(value, float) else ''}>{escape(stage.readable(value))}</td>"
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
    numbers = {"Free motion from three initial conditions": "runtime", "Random initial conditions": "ensemble"}
    parts = []
    for title, captions in SECTIONS.items():
        parts.append(f"<h2>{escape(title)}</h2>")
        if title in numbers:
            parts += [grid(found[numbers[title]]["headline"].items()), links(out, found[numbers[title]])]
        parts += [picture(drawn.pop(name), out, caption) for name, caption in captions.items() if name in drawn]
    return parts + [picture(path, out, name) for name, path in drawn.items()]


def introduced(found: dict[str, dict[str, Any]]) -> str:
    """What rolls on this page, and what that is worth."""
    name = str(found["ensemble"]["headline"]["preset"])
    worth = PRESETS[name].validity(max(abs(V0) for V0, _ in vr.presets.PAPER_STARTS.values())).steady.sentence
    return (
        "<p>Five stages made this page.  Offline: tabulates λ, ε, β, Q and M on a grid of V, δ and α by root solves, "
        "and the law as rows.  Runtime: integrates Eq. (22) from the rows.  Monte Carlo: runs random initial "
        "conditions.  Validate: holds tables and motions against direct solves.  Benchmark: run time against error.</p>"
        f"<p>A viscoelastic cylinder rolls and slides on a half-space of its material: first a rubber roller in SI "
        f"units, then the example of the paper's Sect. 5, preset {escape(name)}: {escape(str(PRESETS[name]))}, without "
        f"dimension.</p><p>Motions of the paper: {escape(worth)}.</p>"
    )


def page(out: Path, found: dict[str, dict[str, Any]]) -> str:
    """The whole page: the physics first, then tables and checks, seconds last."""
    failed = found["validate"]["failed"]
    times = stage.read_rows(out / "benchmark.csv")
    verdict = '<span class="bad">a stated tolerance is exceeded</span>' if failed else "every check passed"
    parts = [
        "<!DOCTYPE html>", '<html lang="en"><head><meta charset="utf-8"><title>viscoroll</title>',
        f"<style>{_STYLE}</style></head><body>", "<h1>A viscoelastic cylinder, rolling and sliding</h1>",
        introduced(found), *pictures(out, found), "<h2>Tables</h2>", grid(found["offline"]["headline"].items()),
        links(out, found["offline"]),
        "<h2>Against direct solves of the printed equations</h2>", f"<p>{verdict}.</p>",
        grid(found["validate"]["headline"].items()),
        links(out, found["validate"]), f"<pre>{escape((out / 'validation.txt').read_text(encoding='utf-8'))}</pre>",
        "<h2>Time against error</h2><p>The paper's motions and random ones in one compiled integrator, from splines in "
        "grids of n by n nodes, from rows, and from root solves at every call; beside them roll.  The truth is root "
        "solves of the printed equations.  Errors are the largest of V and ω over the first speed.  Then the size of "
        "each table, and the largest error of Q there.</p>",
        grid([times[0], *(row.values() for row in times)]),
        picture(out / "figures/benchmark.png", out, "Motions: time over error.  Tables: size and error."),
        f"<h2>How long it took</h2><p>viscoroll {escape(vr.__version__)}, seconds:</p>",
        grid((STAGES[name], record["seconds"]) for name, record in found.items()), "</body></html>",
    ]  # fmt: skip
    return "\n".join(part for part in parts if part) + "\n"


def work(config: Path, out: Path) -> stage.Outcome:
    del config  # nothing of it
    write_text(out / "index.html", page(out, records(out)))
    return stage.Outcome([out / "index.html"])


if __name__ == "__main__":
    sys.exit(stage.run("report", None, work, __doc__))
