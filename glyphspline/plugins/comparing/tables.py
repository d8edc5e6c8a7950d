"""How two fonts differ, as a table and in lines of text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isinf
from typing import TYPE_CHECKING

from ...cli.tables import named, plain
from ...outlines.outline_distance import EVEN
from ...types import counted, rounded_up

if TYPE_CHECKING:
    from .difference import Difference
    from .job import FontDifference


def differences_table(found: Sequence[Difference], shown: int, tolerance: float) -> str:
    """Differences one a line; those beyond the tolerance have an asterisk, undecided ones a question mark."""
    rows = []
    for each in found[:shown]:
        moved = each.new_advance - each.advance
        rows.append([
            "*" if each.is_beyond(tolerance) else "?" if each.is_undecided(tolerance) else "",
            each.glyph if each.glyph == each.new_glyph else f"{each.glyph} = {each.new_glyph}",
            _distance(each),
            "" if each.worst is None else "{:.0f}, {:.0f}".format(*each.worst.point),
            f"{moved:+.4g}" if moved else "",
            _ink(each),
            _changes(len(each.contours_gone), len(each.contours_new)),
            _changes(len(each.kinks_gone), len(each.kinks_new)),
        ])  # fmt: skip
    headings = ("", "glyph", "distance", "at", "advance", "ink", "contours", "kinks")
    return plain(headings, rows, numbers=("distance", "at", "advance", "ink"))


def _distance(each: Difference) -> str:
    """The bound for people, rounded up."""
    if isinf(each.bound):
        return "one is empty"
    if each.bound < 0.001:
        return "0" if each.identical else "< 0.001"
    return f"{rounded_up(each.bound / (1 + EVEN), 3):g}"


def _ink(each: Difference) -> str:
    """How much of the ink changed, where the tolerance does not explain it."""
    return "" if each.ink is None else each.ink.share


def _changes(gone: int, came: int) -> str:
    """How many came and went: "+1 -2"."""
    return " ".join([f"{sign}{count}" for sign, count in (("+", came), ("-", gone)) if count])


def difference_lines(found: FontDifference, shown: int) -> Iterator[str]:
    """What the table does not say."""
    total, beyond, undecided = len(found.differences), len(found.beyond), found.undecided
    if total > shown > 0:
        yield f"and {total - shown} more"
    yield (
        f"{counted(found.identical + total, 'glyph')} compared: {found.identical} identical, "
        f"{total - beyond - len(undecided)} within the tolerance of {found.tolerance:g}, {beyond} beyond"
        + (f", {len(undecided)} undecided" if undecided else "")
    )
    if found.scale != 1:
        yield f"the new one's units are multiplied by {found.scale:g}: lengths are in the old one's"
    for what, glyphs in (
        ("only in the old one", found.glyphs.only_old),
        ("only in the new one", found.glyphs.only_new),
        ("of another name", [f"{old} = {new}" for old, new in found.glyphs.renamed]),
        ("with other ink", [each.glyph for each in found.beyond if each.ink is not None]),
        ("undecided", [f"{each.glyph} ({each.seen:.4g} to {rounded_up(each.bound, 4):g})" for each in undecided]),
        ("not compared", [f"{each.glyph} ({each.error})" for each in found.unread]),
    ):
        yield from (f"{what}: {line}" for line in named(glyphs, "", 10))
