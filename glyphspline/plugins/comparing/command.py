"""The command ``diff``: which fonts and glyphs are compared, and the page of their differences."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...cli import arguments as opt
from ...cli.convert import say_face, say_missing
from ...cli.groups import grouped, only
from ...cli.messages import print_json, progress, put, say
from ...errors import GlyphsplineError
from ...fields import About
from .tables import difference_lines, differences_table

if TYPE_CHECKING:
    from ...readers import Source
    from .job import FontDifference, Pairs

DRAWN = 500
"""Glyphs on a page, the worst first; with more of them a browser takes seconds to open it."""


@grouped
def diff(
    old: Annotated[Path, typer.Argument(metavar="OLD", help=opt.FONT_HELP, show_default=False)],
    new: Annotated[
        Path, typer.Argument(metavar="NEW", help="What it is compared with, of any of these kinds.", show_default=False)
    ],
    subset: opt.Subset,
    instance: opt.Instance,
    run: Annotated[opt.RunOptions, only("as_json", "jobs", "quiet")],
    tolerance: Annotated[
        float | None,
        About("Let outlines and advances differ by this, in units of OLD. Without it, 1/1000 em.", metavar="UNITS"),
    ] = None,
    rows: Annotated[
        int, About("Print this number of lines of the table.", "What is reported", "N", more=opt.NATURAL)
    ] = 20,
    html: Annotated[Path | None, About("Draw both over each other, on a page.", None, "FILE", more=opt.PATH)] = None,
) -> bool:
    """Compare two fonts glyph by glyph: a certified distance of the outlines, advances, contours and kinks.

    Fonts differ, with exit status 1, if anything does by more than the tolerance: an outline or an advance, contours or
    glyphs that only one of them has, or glyphs that cannot be read. Kinks do not count. All glyphs are compared unless
    some are asked for.
    """
    from .job import compare_fonts

    sources = open_both(old, new, instance)
    for source in sources:
        say_face(source, instance, run.quiet)
    pairs, lacking = chosen_pairs(*sources, subset)
    with progress(run.quiet) as observer:
        found = compare_fonts(*sources, pairs, tolerance=tolerance, jobs=run.processes, observer=observer)
    if html is not None:
        write_page(html, *sources, found)
    worst = found.worst_first()
    if run.as_json:
        print_json(found.facts())
    elif worst and rows:
        typer.echo(differences_table(worst, rows, found.tolerance))
    if not run.quiet:
        say_missing(lacking)
        for line in difference_lines(found, 0 if run.as_json else rows):
            say(line)
    return found.is_beyond or bool(lacking)


def open_both(old: Path, new: Path, instance: opt.Instance) -> tuple[Source, Source]:
    """Open two sources. Face and location are for those that have several faces, and axes.

    Raises:
        GlyphsplineError: one cannot be read, or neither has such a face or location.
    """
    from ...readers import open_source

    face_index, place = instance.face_index or 0, instance.place
    sources = [open_source(path) for path in (old, new)]
    if face_index and all(source.num_faces == 1 for source in sources):
        raise GlyphsplineError(f"no face {face_index}: both have one, counted from 0")
    if place and not any(source.axes for source in sources):
        raise GlyphsplineError("a location is asked for, and neither is a variable font")
    for k, path in enumerate((old, new)):
        face, where = face_index if sources[k].num_faces > 1 else 0, place if sources[k].axes else {}
        if face or where:
            sources[k] = open_source(path, face, where)
    return sources[0], sources[1]


def chosen_pairs(old: Source, new: Source, subset: opt.Subset) -> tuple[Pairs, list[str]]:
    """Which glyphs are compared: all unless some are asked for, in either font; and what neither of them has.

    Glyph indices are the old one's.

    Raises:
        GlyphsplineError: neither has any of them.
    """
    from ...readers import Selection
    from .job import pairs_of

    if not subset.is_given or subset.all_glyphs:
        return pairs_of(old, new), []
    of_old, of_new = subset.of(old), Selection() if subset.gids is not None else subset.of(new)
    found = pairs_of(old, new, of_old, of_new)
    if not (found.pairs or found.only_old or found.only_new):
        raise GlyphsplineError("none of the glyphs asked for is in either font")
    return found, [one for one in of_old.missing if subset.gids is not None or one in of_new.missing]


def write_page(path: Path, old: Source, new: Source, found: FontDifference) -> None:
    """Draw the worst differences, both outlines over each other.

    Raises:
        OutputError: the file cannot be written.
    """
    from ...outlines.outline import Outline
    from .page import comparison_page

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
    put(path, page)
