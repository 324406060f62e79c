"""The program ``viscoroll``: arguments -> one call of the library -> text, CSV or netCDF.

Read in this order: :mod:`program` (parser, errors, exit codes), :mod:`arguments` (commands,
numbers, ranges, scenes), :mod:`arguments` (formats), then a module per group of commands: each
command is a function.  :mod:`program` has their help.
"""

from .program import main

__all__ = ["main"]
