"""One ladder for all that is tried again: proposals are made one after the other, until one is good."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

Proposal = TypeVar("Proposal")


def first_good(proposals: Iterable[Proposal], wrong: Callable[[Proposal], tuple[float, ...]]) -> Proposal:
    """The first proposal with nothing wrong, or else, of those with the least wrong, the first.

    Args:
        proposals: one or more. Each is made when those before it are judged, and need not be made at all.
        wrong: numbers that say what is wrong with a proposal, the gravest first; all 0: nothing.
    """
    best: tuple[tuple[float, ...], Proposal] | None = None
    for proposal in proposals:
        own = wrong(proposal)
        if best is None or own < best[0]:
            best = own, proposal
        if not any(own):
            break
    if best is None:
        raise ValueError("no proposals")
    return best[1]
