"""A choice without a branch: Python's ``a if c else b`` becomes one, and a loop with branches does not become SIMD."""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic


def _select(typing_context: Any, condition: Any, a: Any, b: Any) -> Any:
    """``a if condition else b`` for two numbers of one type, both computed: LLVM's instruction of that name."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.select(*arguments)

    if isinstance(condition, types.Boolean) and a == b:
        return a(condition, a, b), code
    return None


select: Any = intrinsic(_select)
