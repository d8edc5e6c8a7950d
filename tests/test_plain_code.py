"""Compiled functions have the same results as plain Python: their sources have none of the arithmetic that differs.

Numba multiplies where Python calls ``pow``; NumPy sums in pairs, by BLAS, sorts ties in any order, divides complex
numbers by a reciprocal, and keeps the size of small integers; the functions of ``math`` raise where NumPy's give NaN.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.places import ROOT

PACKAGE = ROOT / "glyphspline"

DECORATORS = {"compiled", "inlined", "callback"}

SUMS = {"sum", "nansum", "mean", "average", "std", "var", "prod", "dot", "vdot", "inner", "matmul", "einsum", "trace"}
"""Functions and methods of NumPy that add in another order than a loop does, which is as good for whole numbers."""

RAISING = {"hypot", "sqrt", "log", "log2", "log10", "acos", "asin", "exp", "pow", "fsum", "dist"}
"""Functions of ``math`` that raise where compiled code has NaN or an infinity, or have other last bits."""


def functions(tree: ast.Module) -> Iterator[ast.FunctionDef]:
    """The functions of a file that are compiled."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            calls = [one.func if isinstance(one, ast.Call) else one for one in node.decorator_list]
            if DECORATORS & {ast.unparse(one).rpartition(".")[2] for one in calls}:
                yield node


def is_exact(power: ast.BinOp) -> bool:
    """Whether a power has the same value in any way: of 2, a half or 10 to a whole number, or to a broken exponent."""
    base, exponent = power.left, power.right
    if isinstance(base, ast.Constant):
        return base.value in (0.25, 0.5, 2, 4, 10)
    if isinstance(exponent, ast.UnaryOp):
        exponent = exponent.operand
    if isinstance(exponent, ast.Constant):
        return isinstance(exponent.value, float) and exponent.value != int(exponent.value)
    return isinstance(exponent, ast.Name)


def trap(node: ast.AST, complexes: set[str]) -> str:
    """What is wrong with an expression; empty: nothing. ``complexes``: names of complex numbers."""
    if isinstance(node, ast.BinOp | ast.AugAssign):
        if isinstance(node.op, ast.MatMult):
            return "a product of matrices"
        if isinstance(node.op, ast.Pow) and (isinstance(node, ast.AugAssign) or not is_exact(node)):
            return "a power: write a product"
        if isinstance(node.op, ast.LShift) and isinstance(node, ast.BinOp) and isinstance(node.left, ast.Subscript):
            return "a shift of an element: of which type?"
        if isinstance(node.op, ast.Div) and isinstance(node, ast.BinOp) and ast.unparse(node.left) in complexes:
            return "a division of a complex number"
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        name, of = node.func.attr, ast.unparse(node.func.value)
        if of in ("math", "cmath") and name in RAISING:
            return f"{of}.{name}"
        if of == "np" and name.startswith("uint"):
            return f"{name}: NumPy 1.26 adds whole numbers to it as floats"
        if name in SUMS or (of == "np.linalg"):
            return f"{name}: in which order?"
        if name in ("argsort", "lexsort", "argpartition", "partition") and not any(
            one.arg == "kind" and ast.unparse(one.value) in ("'mergesort'", "'stable'") for one in node.keywords
        ):
            return f"{name}: ties in any order"
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("sum", "round", "sorted"):
        return node.func.id
    return ""


def complexes_of(function: ast.FunctionDef) -> set[str]:
    """Names of the arguments that are complex numbers."""
    return {one.arg for one in function.args.args if one.annotation and ast.unparse(one.annotation) == "complex"}


def traps(source: str) -> list[str]:
    """What is wrong in the compiled functions of a file, with the lines."""
    return [
        f"{node.lineno}: {why}"
        for function in functions(ast.parse(source))
        for node in ast.walk(function)
        if isinstance(node, ast.expr | ast.stmt) and (why := trap(node, complexes_of(function)))
    ]


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_compiled_functions_compute_as_plain_python_does(path: Path) -> None:
    assert traps(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "line",
    [
        "x**3", "x**2", "x**-2", "x ** 2.0", "a @ b", "a.sum()", "np.sum(a)", "np.dot(a, b)", "np.argsort(a)",
        "math.sqrt(x)", "math.hypot(x, x)", "a[0] << 8", "c / 2", "np.linalg.solve(a, b)", "sum(a)", "np.uint64(x)",
    ],
)  # fmt: skip
def test_each_trap_is_found(line: str) -> None:
    text = f"@compiled\ndef f(a, b, c: complex, x):\n    return {line}"
    assert len(traps(text)) == 1
    assert traps(text.replace("@compiled\n", "")) == []


@pytest.mark.parametrize(
    "line", ["x**0.25", "0.5**k", "10.0**k", "x * x * x", "np.argsort(a, kind='mergesort')", "x << 8", "c.real / 2"]
)
def test_what_is_the_same_either_way_is_none(line: str) -> None:
    assert traps(f"@compiled\ndef f(a, b, c: complex, x, k):\n    return {line}") == []
