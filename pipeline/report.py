"""Report: one page over all that was made -> out/index.html.

python -m pipeline.report [--config FILE] [-o FOLDER]
"""

import base64
import json
import os
import sys
from collections.abc import Iterable
from html import escape
from pathlib import Path
from string import Template
from typing import Any

import viscoroll as vr
from viscoroll.core.errors import FileError
from viscoroll.core.files import write_text
from viscoroll.presets import PRESETS

from . import stage
from .stage import Row

STAGES = {
    "offline": "Tables of the law",
    "runtime": "Motions from the law file",
    "ensemble": "Random initial speeds",
    "validate": "Validation with the printed equations",
    "benchmark": "Time and error",
    "figures": "Figures",
}
#: Section of figures -> figure -> caption, in order.
SECTIONS = stage.read_toml(stage.ROOT / "pipeline/report_captions.toml")
#: The page, with what the stages left at $names.
PAGE = stage.ROOT / "pipeline/report.html"


def records(out: Path) -> dict[str, Row]:
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


def links(out: Path, record: Row) -> str:
    """What a stage left."""
    return f"<p>{', '.join(link(out / file, out) for file in record['files'])}</p>"


def picture(path: Path, out: Path, caption: str) -> str:
    """A figure with its image in the page itself."""
    data = base64.b64encode(path.read_bytes()).decode()
    image = f'<img src="data:image/png;base64,{data}" alt="{escape(caption)}">'
    return f"<figure>{image}<figcaption>{escape(caption)} {link(path, out)}</figcaption></figure>"


def pictures(out: Path, found: dict[str, Row]) -> list[str]:
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


def page(out: Path, found: dict[str, Row]) -> str:
    """The whole page: the physics first, then tables and checks, seconds last."""
    times = stage.read_rows(out / "benchmark.csv")
    name = str(found["ensemble"]["headline"]["preset"])
    failed = '<span class="bad">a stated tolerance is exceeded</span>'
    about_benchmark = "Left: time, error of motions.  Right: size, error of tables."
    return Template(PAGE.read_text(encoding="utf-8")).substitute(
        preset=f"{escape(name)}: {escape(str(PRESETS[name]))}",
        pictures="\n".join(pictures(out, found)),
        tables=grid(found["offline"]["headline"].items()) + "\n" + links(out, found["offline"]),
        validate=STAGES["validate"],
        verdict=failed if found["validate"]["failed"] else "every check passed",
        checks=grid(found["validate"]["headline"].items()) + "\n" + links(out, found["validate"]),
        report=escape((out / "validation.txt").read_text(encoding="utf-8")),
        benchmark=STAGES["benchmark"],
        times=grid([times[0], *(row.values() for row in times)]),
        drawn=picture(out / "figures/benchmark.png", out, about_benchmark),
        version=escape(vr.__version__),
        seconds=grid((STAGES[name], record["seconds"]) for name, record in found.items()),
    )


def work(config, out):
    del config  # nothing of it
    write_text(out / "index.html", page(out, records(out)))
    return stage.Outcome([out / "index.html"])


if __name__ == "__main__":
    sys.exit(stage.run("report", None, work, __doc__))
