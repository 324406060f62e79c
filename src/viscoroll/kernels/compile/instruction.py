"""Instructions of LLVM's that kernels call like functions."""

from __future__ import annotations

from inspect import Parameter, Signature
from typing import Any, Callable

from llvmlite import ir
from numba.core import cgutils
from numba.extending import intrinsic


def instruction(lower: Callable, returned: Any, *kinds: Any) -> Any:
    """What kernels call with arguments of these kinds, None for any; ``lower``: as numba calls it."""

    def typed(context: Any, *given: Any) -> Any:
        return returned(*(kind or own for kind, own in zip(kinds, given, strict=True))), lower

    names = ["context", *(f"given_{n}" for n in range(len(kinds)))]
    typed.__signature__ = Signature([Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in names])  # type: ignore[attr-defined]
    return intrinsic(typed)


def called(builder: Any, name: str, given: Any) -> Any:
    """A function of LLVM's own, all of one type."""
    kind = given[0].type
    known = ir.FunctionType(kind, [kind] * len(given))
    return builder.call(cgutils.get_or_insert_function(builder.module, known, name), given)
