"""Instructions of LLVM, for the functions of :mod:`.intrinsics` in compiled code."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import types
from numba.core.registry import cpu_target
from numba.extending import intrinsic

from . import intrinsics


def _borrowed(context: Any, value: Any) -> Any:
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
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.get_dummy_value()

    return types.none(owners), code


def _chosen(context: Any, condition: Any, a: Any, b: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.select(*arguments)

    return types.float64(types.boolean, types.float64, types.float64), code


_MADE = {
    intrinsics.borrowed: intrinsic(_borrowed),
    intrinsics.keep_alive: intrinsic(_keep_alive),
    intrinsics.chosen: intrinsic(_chosen),
}


def type_of(function: Callable[..., Any]) -> Any:
    """What Numba takes one of these functions for; None: it is none of them."""
    made = _MADE.get(function)
    return made and cpu_target.typing_context.resolve_value_type(made)
