"""Tables whose cells are templates: ``str.format`` with conversions for measured numbers."""

from __future__ import annotations

import string
from collections.abc import Iterable, Mapping
from typing import Any

from ..results import table


def two(value: float) -> str:
    """Two significant digits, plain where that is short."""
    text = f"{value:.2g}"
    return f"{float(text):.0f}" if 100 <= float(text) < 1e6 else text


def three(value: float) -> str:
    """Three significant digits."""
    return f"{float(f'{value:.3g}'):g}"


#: two digits, two in thousandths, three, three in thousandths, thousands; nothing of None
CONVERSIONS = {
    "n": lambda value: "" if value is None else two(value), "m": lambda value: two(1e3 * value), "t": three,
    "u": lambda value: three(1e3 * value), "k": lambda value: f"{1e-3 * value:.0f}",
}  # fmt: skip


class Cells(string.Formatter):
    """``str.format`` with the CONVERSIONS."""

    def convert_field(self, value: Any, conversion: str | None) -> Any:
        return CONVERSIONS[conversion](value) if conversion else value

    def __call__(self, template: str, values: Mapping[str, Any]) -> str:
        return self.vformat(template, (), values)


cell = Cells()


def listed(columns: Mapping[str, str], rows: Iterable[Mapping[str, Any]]) -> str:
    """A Markdown table: a line for each of ``rows`` by the templates under their headings."""
    return table(columns, ([cell(template, row) for template in columns.values()] for row in rows))
