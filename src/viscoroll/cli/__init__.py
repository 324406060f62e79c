"""The program ``viscoroll``: arguments -> one call of the library -> text, CSV or netCDF.

Read in this order: :mod:`.program` (parser, help, errors, exit codes), :mod:`.arguments` (numbers,
ranges, scenes, formats), then a module per group of commands: each command is a function.
"""

from .program import main

__all__ = ["main"]
