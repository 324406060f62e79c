"""The uncertain inputs of a run file: its sections read into one record, which draws and blocks are made from.

:mod:`record`, what they are; :mod:`ranges`, what is allowed; :mod:`reader`, a value; :mod:`solids` and :mod:`drives`,
sections of materials and of what drives; :mod:`sources`, all of them; :mod:`units`, what a result is counted in.
"""
