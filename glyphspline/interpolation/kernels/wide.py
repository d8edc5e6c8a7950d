"""Vectors as wide as the processor has them: LLVM stays at half of AVX-512 unless asked. The passes gain a tenth."""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic


def _wide(typing_context: Any) -> Any:
    """Nothing, but that the function that calls this is compiled for the widest vectors."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        # llvmlite's own list of attributes has none with a value.
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')
        return context.get_dummy_value()

    return types.none(), code


wide: Any = intrinsic(_wide)
