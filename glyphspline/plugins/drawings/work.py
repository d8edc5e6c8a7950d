"""A small run that calls all compiled functions of this plug-in, for the types of arguments that it has."""

from __future__ import annotations

from ...runs.small_runs import SHAPES


def distances() -> None:
    """How far a path is from what it was."""
    from ...outlines.outline_distance import chains_of, outline_distance

    chains = chains_of(SHAPES.arrays)
    outline_distance(chains, chains, 1.0, 1.0)
