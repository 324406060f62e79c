"""Put measured numbers into the text: data/results/ -> marked blocks of README.md and docs/.

    python pipeline/document.py [--check] [--results FILE] [FILE ...]

A block is what stands between <!-- measured:NAME --> and <!-- end -->; NAME is a key of BLOCKS.
Nothing else is touched, and a second run changes nothing.  With --check nothing is written: exit code 1
if a block is out of date.  Exit code 2 for results that are missing or incomplete, and for broken marks.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from bench import report

from viscoroll import ViscorollError
from viscoroll.files import write_text

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "data/results/measured.json"
PROOFS = ROOT / "data/results/proofs.json"
DOCUMENTS = (ROOT / "README.md", ROOT / "docs/accuracy.md", ROOT / "docs/benchmark.md")
_BLOCK = re.compile(r"(<!-- measured:(\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
_MARK = re.compile(r"<!-- (?:measured:\w+|end) -->")
_NAMES = {
    "lam": "λ", "epsilon": "ε", "delta_star": "δ*", "beta": "β, times 1 − s", "Q": "Q", "M": "M",
}  # fmt: skip


class DocumentError(ViscorollError):
    """Results that are missing or incomplete, or marks that do not pair."""


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A Markdown table."""
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def number(value: float, digits: int = 2) -> str:
    """Two significant digits, plain where that is short."""
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if 100 <= float(text) < 1e6 else text


def headline(m: dict[str, Any]) -> str:
    contact, motion, time = m["contact_error"], m["motion_error"]["paper"]["1e-08"], m["time"]
    worst = max(field["worst"] for field in contact.values())
    rows = [
        (f"contact state, worst of {m['sizes']['states']} random ones, against 50 digits", number(worst)),
        (
            "pressure and shear: closures with load, Q and M, relative to the load",
            number(max(m["stress_closure"].values())),
        ),
        ("motion IC1-IC3 at rtol 1e-8: V and ω, down to 1e-6", number(motion["speed"])),
        ("motion IC1-IC3 at rtol 1e-8: onset of stick", number(motion["onset"])),
        ("`contact()`, Q and M in arrays, a state", f"{number(time['contact_an_alpha_each_ns'])} ns"),
        ("the same by root solves of the printed equations", f"{number(time['contact_direct_ns'])} ns"),
        ("`roll()`, one motion (rtol 1e-6; 1e-8)", _pair(time, "roll")),
        ("`ensemble()`, a motion, integrated (rtol 1e-6; 1e-8)", _pair(time, "ensemble")),
        ("`ensemble()` of one scene, a motion, from the flow map", f"{number(time['flow_us'])} µs"),
        ("`import viscoroll`, over a bare Python", f"{number(1e3 * time['import_s'])} ms"),
    ]
    return table(("what", "measured"), rows) + "\n" + machine(m)


def _pair(time: dict[str, float], name: str) -> str:
    return f"{number(time[f'{name}_1e-06_us'])} µs; {number(time[f'{name}_1e-08_us'])} µs"


def contact(m: dict[str, Any]) -> str:
    rows = (
        (_NAMES[n], number(m["contact_error"][n]["median"]), number(m["contact_error"][n]["worst"])) for n in _NAMES
    )
    return table(("relative error", "median", "worst"), rows)


def direct(m: dict[str, Any]) -> str:
    units = {
        "lam": "relative", "epsilon": "over max(1, ε)", "delta_star": "relative", "beta": "absolute",
        "Q": "over μ", "M": "times κ",
    }  # fmt: skip
    names = _NAMES | {"beta": "β"}
    rows = ((names[n], units[n], number(m["table_against_direct"][n])) for n in _NAMES)
    return table(("field", "difference", "worst"), rows)


def stress(m: dict[str, Any]) -> str:
    meaning = {"load": "∫ p dx = P", "traction": "∫ τ dx = Q", "moment": "∫ x p dx = M"}
    return table(
        ("closure", "worst, relative to the load"), ((meaning[n], number(m["stress_closure"][n])) for n in meaning)
    )


def motion(m: dict[str, Any]) -> str:
    head = ("rtol", "V, ω", "over condition", "x", "onset", "steps")
    keys = ("speed", "speed_over_condition", "x", "onset")
    parts = []
    for group, title in (
        ("paper", "IC1-IC3, rounded parameters"),
        ("random", f"{m['sizes']['scenes']} random scenes and starts"),
    ):
        rows = (
            (f"{float(rtol):.0e}", *(number(errors[key]) for key in keys), f"{errors['steps']:.0f}")
            for rtol, errors in sorted(m["motion_error"][group].items(), key=lambda item: -float(item[0]))
        )
        parts.append(f"{title}:\n\n{table(head, rows)}")
    return "\n".join(parts)


def times(m: dict[str, Any]) -> str:
    time, sizes = m["time"], m["sizes"]
    rows = [
        (
            f"`contact()`, Q and M, {sizes['timed_states']} states, one alpha",
            f"{number(time['contact_one_alpha_ns'])} ns a state",
        ),
        ("the same, an alpha each", f"{number(time['contact_an_alpha_each_ns'])} ns a state"),
        ('the same by `method="direct"`, one alpha', f"{number(time['contact_direct_ns'])} ns a state"),
        ("`contact()`, one state, all nine fields", f"{number(time['contact_single_us'])} µs"),
        ("`roll()`, IC1 to t = 3e-3, final state (rtol 1e-6; 1e-8)", _pair(time, "roll")),
        (
            f"`ensemble()`, {sizes['timed_motions']} starts in [-2, 2]², final state, integrated (rtol 1e-6; 1e-8)",
            _pair(time, "ensemble") + " a motion",
        ),
        (
            f"the same of {50 * sizes['timed_motions']} starts, from the flow map",
            f"{number(time['flow_us'])} µs a motion",
        ),
        ("`import viscoroll`, over a bare Python", f"{number(1e3 * time['import_s'])} ms"),
        ("`viscoroll roll`, the whole process, kernels cached", f"{number(time['cli_roll_s'])} s"),
    ]
    return table(("what", "median time on one core"), rows) + "\n" + machine(m)


def machine(m: dict[str, Any]) -> str:
    about = m["machine"]
    return (
        f"{about['cpu']}, {about['system']}, Python {about['python']}, numpy {about['numpy']}, numba {about['numba']}; "
        f"viscoroll {about['viscoroll']}, {about['date']}.  Times are medians on one core.\n"
    )


def proofs(m: dict[str, Any]) -> str:
    """One table a proof, from proofs.json."""
    titles = {
        "ratios": "Bessel ratios", "contact": "Contact states", "shape": "Shape", "slopes": "Slopes and stress",
    }  # fmt: skip
    parts = []
    for name, title in titles.items():
        rows = (
            (
                row["claim"].replace("|", "\\|"),
                row["domain"],
                f"{row['points']:,}",
                number(row["bound"]),
                number(row["worst"]),
            )
            for row in m["proofs"][name]
        )
        parts.append(f"{title}:\n\n{table(('claim', 'domain', 'points', 'bound', 'worst'), rows)}")
    return "\n".join(parts)


BLOCKS: dict[str, Callable[[dict[str, Any]], str]] = {
    "headline": headline, "contact": contact, "direct": direct, "stress": stress, "motion": motion, "times": times,
    "proofs": proofs,
}  # fmt: skip


def filled(text: str, measured: dict[str, Any], folder: Path, name: str) -> str:
    """``text`` with every block filled, those of the benchmark from its files in ``folder``.

    Raises
    ------
    DocumentError
        Marks that do not pair, an unknown block, or results that lack a number.
    """

    def fill(match: re.Match[str]) -> str:
        try:
            if match[2] in report.BLOCKS:
                return f"{match[1]}{report.BLOCKS[match[2]](folder)}{match[3]}"
            return f"{match[1]}{BLOCKS[match[2]](measured)}{match[3]}"
        except (KeyError, TypeError) as error:
            if match[2] not in BLOCKS | report.BLOCKS:
                names = ", ".join([*BLOCKS, *report.BLOCKS])
                raise DocumentError(f"{name}: unknown block {match[2]!r}: must be one of {names}") from error
            script = "measure" if match[2] in BLOCKS else "benchmark"
            raise DocumentError(f"results lack {error} for block {match[2]!r}: run pipeline/{script}.py") from error

    result, count = _BLOCK.subn(fill, text)
    if len(_MARK.findall(text)) != 2 * count:
        raise DocumentError(f"{name}: a mark <!-- measured:NAME --> or <!-- end --> has no partner")
    return result


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a block is out of date")
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("files", nargs="*", type=Path, default=DOCUMENTS, metavar="FILE")
    arguments = parser.parse_args()
    stale = []
    try:
        measured = json.loads(arguments.results.read_text(encoding="utf-8"))
        measured |= {"proofs": json.loads(PROOFS.read_text(encoding="utf-8"))["proofs"]}
        for path in arguments.files:
            old = path.read_text(encoding="utf-8")
            new = filled(old, measured, arguments.results.parent, path.name)
            if new != old:
                stale.append(path.name)
                if not arguments.check:
                    write_text(path, new)
    except (ViscorollError, OSError, ValueError) as error:
        print(f"document: {error}", file=sys.stderr)
        return 2
    if stale:
        print(f"{', '.join(stale)}: {'out of date: run pipeline/document.py' if arguments.check else 'filled'}")
    return 1 if stale and arguments.check else 0


if __name__ == "__main__":
    sys.exit(main())
