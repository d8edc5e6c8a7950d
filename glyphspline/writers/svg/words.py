"""Memory by its address, in compiled code: eight characters at a time, and no references counted.

An array handed from function to function has its references counted, which takes four times as long as writing a
number. Whoever hands on an array's address has to keep the array until the last use.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


def _store(typing_context: Any, address: Any, word: Any) -> Any:
    """Write an unsigned integer, lowest byte first, to an address of any alignment."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address, word = arguments
        builder.store(word, builder.inttoptr(address, ir.PointerType(word.type)), align=1)
        return context.get_dummy_value()

    return types.void(types.uint64, word), code


def _load(typing_context: Any, address: Any) -> Any:
    """The uint64 at an address."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(builder.inttoptr(arguments[0], ir.PointerType(ir.IntType(64))), align=1)

    return types.uint64(types.uint64), code


store: Any = intrinsic(_store)
load: Any = intrinsic(_load)
