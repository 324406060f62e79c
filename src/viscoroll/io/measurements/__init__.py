"""Tables of measured numbers as instruments and spreadsheets write them: :func:`read_table`.

:mod:`.cells` finds the table in a text file and cuts it into cells; :mod:`.headings` parts a heading into a name and a
unit.  Which column means which is the caller's to say: of moduli :mod:`viscoroll.app.dma.names`, of drums, tractions
and coast-downs the names of their quantities, of run files the name that the file gives.
"""

from .cells import Numbers, Table, read_table
from .headings import NO_UNIT, Reading, conversion, readings
from .named import find, is_heading, missing, quantity

__all__ = [
    "NO_UNIT", "Numbers", "Reading", "Table", "conversion", "find", "is_heading", "missing", "quantity", "read_table",
    "readings",
]  # fmt: skip
