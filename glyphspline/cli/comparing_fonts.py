"""What ``diff`` says of two fonts: a table, and sentences; and how it opens them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isinf
from pathlib import Path
from typing import TYPE_CHECKING

from ..comparing.difference import Difference
from ..errors import GlyphsplineError
from ..types import counted, rounded_up
from . import arguments as opt
from .text_table import plain

if TYPE_CHECKING:
    from ..readers import Source
    from ..runs import FontDifference
    from ..runs.font_difference import Pairs

DRAWN = 500
"""Glyphs on a page, the worst first."""

NAMED = 10
"""Names of glyphs in a sentence."""


def open_both(old: Path, new: Path, instance: opt.Instance) -> tuple[Source, Source]:
    """Open two sources. Face and location are for those that have several faces, and axes.

    Raises:
        GlyphsplineError: one cannot be read, or neither has such a face or location.
    """
    from ..readers import open_source

    face_index, place = instance.face_index or 0, instance.place
    sources = [open_source(path) for path in (old, new)]
    of_faces = [source.num_faces > 1 or not face_index for source in sources]
    of_axes = [bool(source.axes) or not place for source in sources]
    if not any(of_faces):
        raise GlyphsplineError(f"no face {face_index}: both have one, counted from 0")
    if not any(of_axes):
        raise GlyphsplineError("a location is asked for, and neither is a variable font")
    for k, path in enumerate((old, new)):
        face, where = face_index if of_faces[k] else 0, place if of_axes[k] else {}
        if face or where:
            sources[k] = open_source(path, face, where)
    return sources[0], sources[1]


def chosen_pairs(old: Source, new: Source, subset: opt.Subset) -> Pairs:
    """Which glyphs are compared: all unless some are asked for, in either font; glyph indices are the old one's.

    Raises:
        GlyphsplineError: neither has any of them.
    """
    from ..runs import pairs_of

    if not subset.is_given or subset.all_glyphs:
        return pairs_of(old, new)
    chosen = subset.of(old)
    others = subset.of(new) if subset.gids is None else ()
    found = pairs_of(old, new, chosen, others)
    if not (found.pairs or found.only_old or found.only_new):
        raise GlyphsplineError("none of the glyphs asked for is in either font")
    return found


def table(found: Sequence[Difference], shown: int, tolerance: float) -> str:
    """Differences one a line; those beyond the tolerance have an asterisk."""
    rows = []
    for each in found[:shown]:
        named = each.glyph if each.glyph == each.new_glyph else f"{each.glyph} = {each.new_glyph}"
        contours = changes(len(each.contours_gone), len(each.contours_new))
        kinks = changes(len(each.kinks_gone), len(each.kinks_new))
        at = "" if each.worst is None else "{:.0f}, {:.0f}".format(*each.worst.point)
        beyond = "*" if each.is_beyond(tolerance) else ""
        rows.append([beyond, named, distance(each), at, advance(each), contours, kinks])
    headings = ("", "glyph", "distance", "at", "advance", "contours", "kinks")
    return plain(headings, rows, numbers=("distance", "at", "advance"))


def distance(each: Difference) -> str:
    """The bound for people, rounded up: "none" if one outline is empty."""
    if isinf(each.bound):
        return "one is empty"
    return f"{rounded_up(each.bound, 3):g}" if each.bound >= 0.001 else "0" if each.identical else "< 0.001"


def advance(each: Difference) -> str:
    """The change of the advance with its sign."""
    moved = each.new_advance - each.advance
    return f"{moved:+.4g}" if moved else ""


def changes(gone: int, came: int) -> str:
    """How many came and went: "+1 -2"."""
    return " ".join(([f"+{came}"] if came else []) + ([f"-{gone}"] if gone else []))


def sentences(found: FontDifference, shown: int) -> Iterator[str]:
    """What the table does not say."""
    total, beyond = len(found.differences), len(found.beyond)
    if total > shown > 0:
        yield f"and {total - shown} more"
    yield (
        f"{counted(found.identical + total, 'glyph')} compared: {found.identical} identical, {total - beyond} within "
        f"the tolerance of {found.tolerance:g}, {beyond} beyond"
    )
    if found.scale != 1:
        yield f"the new one's units are multiplied by {found.scale:g}: lengths are in the old one's"
    yield from named("only in the old one", found.glyphs.only_old)
    yield from named("only in the new one", found.glyphs.only_new)
    yield from named("of another name", [f"{old} = {new}" for old, new in found.glyphs.renamed])
    yield from named("not compared", [f"{each.glyph} ({each.error})" for each in found.unread])


def named(what: str, glyphs: Sequence[str]) -> Iterator[str]:
    """A sentence that names the first glyphs; none if there are none."""
    if glyphs:
        more = ", …" if len(glyphs) > NAMED else ""
        yield f"{what}: {counted(len(glyphs), 'glyph')}: {', '.join(glyphs[:NAMED])}{more}"


def write_page(path: Path, old: Source, new: Source, found: FontDifference) -> None:
    """Draw the worst differences, both outlines over each other.

    Raises:
        OutputError: the file cannot be written.
    """
    from ..files import writing
    from ..outlines.outline import Outline
    from ..report.comparison import comparison_page

    worst = found.worst_first()[:DRAWN]
    read = [
        [outline if isinstance(outline, Outline) else None for outline in source.outlines(gids, errors="return")]
        for source, gids in ((old, [each.gid for each in worst]), (new, [each.new_gid for each in worst]))
    ]
    facts = [*sentences(found, 0)]
    if len(found.differences) > DRAWN:
        facts.append(f"the worst {DRAWN} of {len(found.differences)} are drawn")
    heading = f"{old.path.name} and {new.path.name}"
    page = comparison_page(heading, facts, list(zip(worst, *read, strict=True)), found.tolerance)
    with writing(path):
        path.write_text(page, encoding="utf-8")
