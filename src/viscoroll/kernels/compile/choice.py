"""A kernel in several versions, one a kind of record: which of them a call takes is settled when it is compiled."""

from __future__ import annotations

from typing import Any, Callable

import numba
from numba.core import sigutils

from .jit import kernel


def by_record(at: int, *versions: tuple[type, Callable]) -> Callable:
    """The version for the record that argument number ``at`` is: pairs of a record's class and a kernel.

    The first serves records that are not among them too.
    """
    known, first = dict(versions), versions[0][1]
    if numba.config.DISABLE_JIT:
        return lambda *given: known.get(type(given[at]), first)(*given)
    stand_in = kernel(first.py_func)

    def version(given: Any) -> Any:
        return known.get(given[at].instance_class, first)

    def get_call_template(given: tuple, named: dict[str, Any]) -> Any:
        return version(given).get_call_template(given, named)

    def get_overload(signature: Any) -> Any:
        return version(sigutils.normalize_signature(signature)[0]).get_overload(signature)

    def compile_for_python(signature: Any) -> Any:
        given, _ = sigutils.normalize_signature(signature)
        version(given).compile(signature)
        compiled = version(given).overloads[tuple(given)]
        stand_in.add_overload(compiled)
        return compiled.entry_point

    stand_in.get_call_template, stand_in.get_overload = get_call_template, get_overload
    stand_in.compile = compile_for_python
    return stand_in
