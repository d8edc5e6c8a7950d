"""Compiled functions: the one decorator, and the instructions of LLVM that Python has no words for.

Numba keeps the machine code beside the source files, or in the user's cache folder where these cannot be written, or
where :mod:`.cache` says. It compares a function's own file, not the files of the functions it calls: after an edit, run
``make clean``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, overload

from llvmlite import ir
from numba import config, njit, types
from numba.extending import intrinsic

from . import cache
from .compiling import watched

Function = TypeVar("Function", bound=Callable[..., Any])

if _place := cache.settle():
    config.CACHE_DIR = _place  # type: ignore[attr-defined, unused-ignore]  # numba may know the environment of before


@overload
def compiled(function: Function, /) -> Function: ...
@overload
def compiled(*, internal: bool) -> Callable[[Function], Function]: ...
def compiled(function: Callable[..., Any] | None = None, /, *, internal: bool = False) -> Any:
    """Compile a function at its first call, cache the machine code, and release the interpreter's lock while it runs.

    Division by zero gives an infinity or NaN, as in NumPy. No ``fastmath``: fused or reassociated operations depend on
    what is inlined, which differs between code just compiled and code out of the cache. The last bits of a result
    would differ too, and at a threshold the result itself.

    Args:
        function: called with scalars, arrays and named tuples of them.
        internal: only compiled code calls the function. There is no entry point for Python then, and a call from Python
            ends the process. Every entry point is optimised again in each caller: without them the first
            ``interpolate`` compiles in four fifths of the time.
    """
    options: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
    if internal:
        options["no_cpython_wrapper"] = True

    def decorate(function: Callable[..., Any]) -> Any:
        return watched(njit(**options)(function))

    return decorate if function is None else decorate(function)


def inlined(function: Function) -> Function:
    """A function whose body takes the place of each call before types are inferred: for helpers of SIMD loops.

    LLVM inlines a call too, but too late for some loops to become SIMD. The body is typed again for every call, so this
    is for a few lines only.
    """
    decorated: Any = njit(inline="always", error_model="numpy")(function)
    return decorated  # type: ignore[no-any-return, unused-ignore]


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


def _store(context: Any, address: Any, word: Any) -> Any:
    """Write an unsigned integer, lowest byte first, to an address of any alignment.

    Eight characters at a time, and no array whose references are counted: a counted one takes four times as long as
    writing a number. The owner keeps the array until the last use.
    """

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address, word = arguments
        builder.store(word, builder.inttoptr(address, ir.PointerType(word.type)), align=1)
        return context.get_dummy_value()

    return types.void(types.uint64, word), code


def _load(context: Any, address: Any) -> Any:
    """The uint64 at an address."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(builder.inttoptr(arguments[0], ir.PointerType(ir.IntType(64))), align=1)

    return types.uint64(types.uint64), code


fma: Any = intrinsic(_fma)
select: Any = intrinsic(_select)
wide_vectors: Any = intrinsic(_wide_vectors)
borrowed: Any = intrinsic(_borrowed)
keep_alive: Any = intrinsic(_keep_alive)
store: Any = intrinsic(_store)
load: Any = intrinsic(_load)
