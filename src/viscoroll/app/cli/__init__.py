"""The program ``viscoroll``: arguments -> one call of the library -> text, CSV or netCDF.

Read in this order: :mod:`program` (parser, errors, exit codes), :mod:`arguments` (commands, numbers, ranges,
scenes), :mod:`output` (formats), then a module per group of commands: each command is a function.  :mod:`help_texts`
has their help.
"""

from .program import main

__all__ = ["main"]
