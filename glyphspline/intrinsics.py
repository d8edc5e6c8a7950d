"""Instructions of LLVM that Python has no words for; without a compiler, what they compute in Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import types
from numba.extending import intrinsic

from .compiled import JIT


def _fma(context: Any, a: Any, b: Any, c: Any) -> Any:
    """a b + c, rounded once: half the instructions of a product and a sum.

    A compiler that may fuse products by itself does so differently in code just compiled and in code out of the cache.
    Asked for one by one, the fused operations are what IEEE 754 says they are.
    """

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), code


def _select(context: Any, condition: Any, a: Any, b: Any) -> Any:
    """``a if condition else b`` of two numbers of one type, both computed, without a branch.

    Python's conditional expression becomes a branch, and a loop with branches does not become SIMD.
    """

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.select(*arguments)

    if isinstance(condition, types.Boolean) and a == b:
        return a(condition, a, b), code
    return None


def _wide_vectors(context: Any) -> Any:
    """Do nothing, but compile the calling function for the widest vectors of the processor.

    LLVM stays at half of AVX-512 otherwise; the passes of the interpolation gain a tenth.
    """

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        # llvmlite's own list of attributes has none with a value.
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')
        return context.get_dummy_value()

    return types.none(), code


def _borrowed(context: Any, value: Any) -> Any:
    """The same array, or named tuple of such, without a count of references; slices are not counted either.

    Counting is atomic, some 5 ns up and 5 ns down for each argument and each slice: half of the time that setting up a
    polygon of ten vertices took. The owner keeps the array until the last use, by :func:`keep_alive`.
    """

    def uncounted(context: Any, builder: Any, kind: Any, value: Any) -> Any:
        if isinstance(kind, types.BaseTuple):
            parts: Any = kind
            for k, part in enumerate(parts):
                own = uncounted(context, builder, part, builder.extract_value(value, k))
                value = builder.insert_value(value, own, k)
        if not isinstance(kind, types.Array):
            return value
        same = context.make_array(kind)(context, builder, value=value)
        same.meminfo = same.meminfo.type(None)
        same.parent = same.parent.type(None)
        return same._getvalue()

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return uncounted(context, builder, value, arguments[0])

    return (value(value), code) if isinstance(value, types.Array | types.BaseTuple) else None


def _keep_alive(context: Any, owners: Any) -> Any:
    """Do nothing, but use the arrays: they live at least until here."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.get_dummy_value()

    return types.none(owners), code


def _in(compiler: Callable[..., Any], python: Callable[..., Any]) -> Any:
    """What compiled functions call, or Python's equivalent if nothing is compiled."""
    return intrinsic(compiler) if JIT else python


fma = _in(_fma, lambda a, b, c: a * b + c)
select = _in(_select, lambda condition, a, b: a if condition else b)
wide_vectors = _in(_wide_vectors, lambda: None)
borrowed = _in(_borrowed, lambda value: value)
keep_alive = _in(_keep_alive, lambda owners: None)
