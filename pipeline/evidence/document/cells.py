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


#: two digits, in thousandths, in per cent; three digits, likewise; whole; thousands and millions to
#: go on with; a power of ten; a vertical line that ends no cell
CONVERSIONS = {
    "n": two,
    "m": lambda value: two(1e3 * value),
    "c": lambda value: two(100.0 * value),
    "t": three,
    "u": lambda value: three(1e3 * value),
    "h": lambda value: three(100.0 * value),
    "i": "{:.0f}".format,
    "k": lambda value: 1e-3 * value,
    "M": lambda value: 1e-6 * value,
    "e": lambda value: f"{value:.0e}".replace("e+0", "e"),
    "p": lambda text: text.replace("|", "\\|"),
}


class Cells(string.Formatter):
    """``str.format`` with the CONVERSIONS; nothing of None and of empty text."""

    def convert_field(self, value: Any, conversion: str | None) -> Any:
        if not conversion:
            return value
        return "" if value in (None, "") else CONVERSIONS[conversion](value)

    def __call__(self, template: str, values: Mapping[str, Any]) -> str:
        return self.vformat(template, (), values)


cell = Cells()


def listed(columns: Mapping[str, str], rows: Iterable[Mapping[str, Any]]) -> str:
    """A Markdown table: a line for each of ``rows`` by the templates under their headings."""
    return table(columns, ([cell(template, row) for template in columns.values()] for row in rows))
