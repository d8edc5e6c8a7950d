"""Arrays without a count of references, for functions that are called for each block of each pass.

Counting is atomic, some 5 ns up and 5 ns down for each argument and each slice, which was half of the time that a
polygon of ten vertices took to set up. Whoever lends an array has to hold it until the borrowers are done.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic


def _lend(typing_context: Any, array: Any) -> Any:
    """The same array, whose slices are not counted either."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        lent = context.make_array(array)(context, builder, value=arguments[0])
        lent.meminfo = lent.meminfo.type(None)
        lent.parent = lent.parent.type(None)
        return lent._getvalue()

    return (array(array), code) if isinstance(array, types.Array) else None


def _hold(typing_context: Any, lenders: Any) -> Any:
    """Nothing, but a use of the arrays: until here they are kept."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.get_dummy_value()

    return types.none(lenders), code


lend: Any = intrinsic(_lend)
hold: Any = intrinsic(_hold)
