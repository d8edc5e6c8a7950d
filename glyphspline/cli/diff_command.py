"""The command ``diff``: which fonts and glyphs are compared, and the page of their differences."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import GlyphsplineError
from . import arguments as opt
from .tables import difference_lines

if TYPE_CHECKING:
    from ..readers import Source
    from ..runs.jobs.diff import FontDifference, Pairs

DRAWN = 500
"""Glyphs on a page, the worst first; with more of them a browser takes seconds to open it."""


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
    from ..runs.jobs.diff import pairs_of

    if not subset.is_given or subset.all_glyphs:
        return pairs_of(old, new)
    found = pairs_of(old, new, subset.of(old), subset.of(new) if subset.gids is None else ())
    if not (found.pairs or found.only_old or found.only_new):
        raise GlyphsplineError("none of the glyphs asked for is in either font")
    return found


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
    facts = [*difference_lines(found, 0)]
    if len(found.differences) > DRAWN:
        facts.append(f"the worst {DRAWN} of {len(found.differences)} are drawn")
    heading = f"{old.path.name} and {new.path.name}"
    page = comparison_page(heading, facts, list(zip(worst, *read, strict=True)), found.tolerance)
    with writing(path):
        path.write_text(page, encoding="utf-8")
