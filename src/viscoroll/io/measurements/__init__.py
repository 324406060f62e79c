"""Tables of measured numbers as instruments and spreadsheets write them: :func:`read_table`.

:mod:`.lines` cuts a text file into cells, :mod:`.table` finds the table among them, :mod:`.numbers` reads a cell as a
number, and :mod:`.headings` splits a heading into a name and a unit.  Which column is which quantity is for the caller
to say: of moduli :mod:`viscoroll.app.dma.vocabulary`, of drums, tractions and coast-downs the names of their
quantities, of run files the name that the file gives (:mod:`.named_columns`).
"""

from .headings import NO_UNIT, Reading, conversion, readings
from .named_columns import column_in_unit, find_column, missing_column, named_table
from .numbers import Numbers
from .table import Table, read_table

__all__ = [
    "NO_UNIT", "Numbers", "Reading", "Table", "column_in_unit", "conversion", "find_column", "missing_column",
    "named_table", "read_table", "readings",
]  # fmt: skip
