"""Shapes that occur again: 64-bit hashes, in far less memory than a set of them."""

from __future__ import annotations

import numpy as np

from ..types import IntArray


class Shapes:
    """The shapes that rows have had so far: 8 bytes each, and twice that while sorted runs are merged."""

    def __init__(self) -> None:
        self._runs: list[IntArray] = []

    def first(self, shapes: IntArray) -> IntArray:
        """(n,) the first row of this call that has the row's shape; -1 if a row of an earlier call has it."""
        unique, first, which = np.unique(shapes, return_index=True, return_inverse=True)
        known = np.zeros(len(unique), dtype=np.bool_)
        for run in self._runs:
            at = np.minimum(np.searchsorted(run, unique), len(run) - 1)
            known |= run[at] == unique
        if not known.all():
            self._runs.append(unique[~known])
        while len(self._runs) > 1 and len(self._runs[-2]) <= 2 * len(self._runs[-1]):
            merged = np.concatenate([self._runs.pop(), self._runs.pop()])
            merged.sort(kind="stable")
            self._runs.append(merged)
        found: IntArray = np.where(known, -1, first)[which]
        return found

    def __len__(self) -> int:
        return sum(map(len, self._runs))
