"""Sums of products with one rounding each: half the instructions, and the same bits wherever the code is compiled.

A compiler that is allowed to fuse products by itself does so differently in code just compiled and in code out of the
cache. Asked for one by one, they are what IEEE 754 says they are.
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import intrinsic

from .footpoint import inlined


def _fma(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """a b + c, rounded once."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), code


fma: Any = intrinsic(_fma)


@inlined
def dot(ax, ay, bx, by):
    """a · b"""
    return fma(ax, bx, ay * by)


@inlined
def cubic(e, v, w, z, y):
    """e + v y + w y² + z y³"""
    return fma(fma(fma(z, y, w), y, v), y, e)
