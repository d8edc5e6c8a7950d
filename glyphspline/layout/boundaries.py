"""Where a text may be cut: between grapheme clusters (UAX #29), and where a line may end (UAX #14)."""

from __future__ import annotations

import numpy as np

from ..types import BoolArray, IntArray


def clusters(text: str) -> IntArray:
    """(k + 1,) where the k extended grapheme clusters of a text begin, and its length."""
    from unicode_segmentation_rs import graphemes

    found = graphemes(text, True)
    ends = np.zeros(len(found) + 1, dtype=np.int64)
    np.cumsum([len(cluster) for cluster in found], out=ends[1:])
    return ends


def line_ends(text: str) -> IntArray:
    """(k,) the places before which a new line may begin, ascending; the last is the length of the text."""
    from unicode_segmentation_rs import line_breaks

    places = np.array([place for place, _ in line_breaks(text)], dtype=np.int64)
    if text.isascii():
        return places
    units = np.frombuffer(text.encode(), dtype=np.uint8)
    begins: BoolArray = (units & 0xC0) != 0x80  # the first unit of each character, in UTF-8
    return np.concatenate([[0], np.cumsum(begins)])[places]
