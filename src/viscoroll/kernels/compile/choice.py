"""A kernel in several versions, one a kind of record: which of them a call takes is settled when it is compiled."""

from __future__ import annotations

from typing import Any, Callable

import numba
from numba.core import sigutils

from .jit import kernel


def by_record(at: int, *versions: tuple[type, Callable], otherwise: Callable | None = None) -> Callable:
    """The version for the record that argument number ``at`` is: pairs of a record's class and a kernel.

    ``otherwise`` serves the records that are not among them; without it they are refused, with a TypeError.
    """
    known = dict(versions)

    def chosen(kind: type) -> Callable:
        found = known.get(kind, otherwise)
        if found is None:
            raise TypeError(f"{kind.__name__}: must be one of " + ", ".join(one.__name__ for one in known))
        return found

    if numba.config.DISABLE_JIT:
        return lambda *given: chosen(type(given[at]))(*given)
    stand_in = kernel(versions[0][1].py_func)

    def version(given: Any) -> Any:
        return chosen(given[at].instance_class)

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
