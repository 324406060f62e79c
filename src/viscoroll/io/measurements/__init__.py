"""Tables of measured numbers as instruments and spreadsheets write them: :func:`read_table`.

:mod:`.table` finds the table in a text file and cuts it into cells; :mod:`.headings` parts a heading into a
name and a unit.  Which column means which is the caller's to say: of moduli :mod:`viscoroll.app.dma.vocabulary`, of drums, tractions
and coast-downs the names of their quantities, of run files the name that the file gives.
"""

from .headings import NO_UNIT, Reading, conversion, readings
from .named_columns import column_in_unit, find_column, missing_column, named_table
from .table import Numbers, Table, read_table

__all__ = [
    "NO_UNIT", "Numbers", "Reading", "Table", "column_in_unit", "conversion", "find_column", "missing_column",
    "named_table", "read_table", "readings",
]  # fmt: skip
