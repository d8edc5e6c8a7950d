"""Linear equations of a fit: symmetric, positive definite, and banded."""

from __future__ import annotations

import numpy as np

from ...compiled import compiled
from ...types import FloatArray, IntArray


@compiled
def solve(A: FloatArray, rhs: FloatArray, first: IntArray, n: int) -> None:
    """Solve n equations by Cholesky's method; ``rhs`` becomes the solution.

    Only the lower half of A counts, and of row r only the columns from ``first[r]`` on: a band, and around a closed
    curve a border.
    """
    for r in range(n):
        for c in range(first[r], r + 1):
            total = A[r, c]
            for m in range(max(first[r], first[c]), c):
                total -= A[r, m] * A[c, m]
            A[r, c] = np.sqrt(max(total, 1e-12)) if c == r else total / A[c, c]
        for m in range(first[r], r):
            rhs[r] -= A[r, m] * rhs[m]
        rhs[r] /= A[r, r]
    for r in range(n - 1, -1, -1):
        rhs[r] /= A[r, r]
        for m in range(first[r], r):
            rhs[m] -= A[r, m] * rhs[r]
