"""The command ``mend``: findings of sources are mended, and what moved goes back into them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...cli import arguments as opt
from ...cli.convert import chosen
from ...cli.groups import grouped, only
from ...cli.messages import print_json, progress, put, say, stop
from ...cli.tables import plain
from ...errors import OptionError
from ...fields import WRITTEN, About, option
from ...files import make_folder
from ...outlines.flaws.kinds import MENDED, MENDED_UNASKED
from ...types import counted, rounded_up, shortened
from ..checks.command import thresholds_of
from ..checks.options import FOUND, ReportOptions
from ..fonts.command import LayerCommand
from ..fonts.spec import RefitSpec

if TYPE_CHECKING:
    from ...readers import Font
    from ...readers.ufo import EditableSource
    from .job import MendedSource
    from .state import Change

SOURCES_HELP = "UFOs, designspaces, Glyphs files, and fonts: TTF and OTF, static or variable, WOFF and WOFF2."
LEFT = 5
"""Findings that are left and named."""


@dataclass(frozen=True)
class MendOptions:
    """What ``mend`` mends."""

    kinds: str = option(
        ",".join(MENDED_UNASKED), f"Mend these kinds of findings, between commas: {', '.join(MENDED)}, or all.",
        FOUND, "KIND,…",
    )  # fmt: skip
    tolerance: float | None = option(
        None, "Let outlines move by this, in font units. Without it, 1/1000 em.", FOUND, "UNITS"
    )
    thresholds: str | None = option(None, "Take these thresholds of check: kink=1.", FOUND, "NAME=VALUE,…")


@partial(grouped, cls=LayerCommand)
def mend(
    sources: Annotated[list[Path], typer.Argument(metavar="SOURCE", help=SOURCES_HELP, show_default=False)],
    subset: opt.Subset,
    spec: Annotated[RefitSpec, only("in_place", "layer")],
    report: Annotated[ReportOptions, only("rows", "html")],
    run: Annotated[opt.RunOptions, only("as_json", "jobs", "quiet")],
    options: MendOptions,
    out: Annotated[Path | None, opt.out("Write copies of the sources to this folder.", "DIR", **opt.PATH)] = None,
    dry_run: Annotated[bool, About("Write nothing; only show what would move.", WRITTEN)] = False,
) -> bool:
    """Mend what check finds in sources: points move as little as it takes, in all masters.

    Kinks are mended unless other kinds are asked for, so that joints meant to be smooth kink nowhere along an axis.
    Points go only where short, straight and repeated are asked for. What would move outlines by more than the
    tolerance, or bring a new finding of any kind, is left and named, and ends the command with status 1.
    """
    from ...readers import Font, open_source
    from ...readers.ufo import EditableSource
    from ...runs.schedule import workers
    from .job import Scope, mend_source

    if (out is not None) + spec.is_back + dry_run != 1:
        stop("give one of --in-place, --layer, --out and --dry-run")
    if out is not None and len({path.name for path in sources}) < len(sources):
        raise OptionError("--out takes no two sources of one name")
    if report.html is not None and len(sources) > 1:
        raise OptionError("--html draws one source")
    kinds = MENDED if options.kinds == "all" else opt.items_of(options.kinds)
    asked = Scope(kinds, options.tolerance, thresholds_of(options.thresholds, None))
    found: list[MendedSource] = []
    undone = False
    with workers(run.processes, kinds=["mending"], expected=1, count=len(sources)) as pool:
        for path in sources:
            source = open_source(path)
            if not isinstance(source, EditableSource | Font):
                stop(f"{path}: only UFOs, designspaces, Glyphs files and fonts are mended")
            names: Sequence[str] = source.glyph_names
            if subset.is_given:
                names = picked = chosen(source, subset, run.quiet, str(path))
                undone |= bool(picked.missing)
            copy = None if out is None else copy_of(source, out)
            with progress(run.quiet) as observer:
                found.append(mend_source(
                    source, names, asked, copy=copy, layer=spec.layer, dry=dry_run, executor=pool, observer=observer,
                ))  # fmt: skip
    if report.html is not None:
        from .page import mending_page

        one, facts = found[0], [next(lines(found[0], dry_run))]
        put(report.html, mending_page(Path(one.source).name, facts, one.changes, one.drawn))
    if run.as_json:
        print_json([one.facts() for one in found])
    for one in found:
        if not run.as_json and not run.quiet and one.mended and report.rows:
            typer.echo(table(one.mended[: report.rows]))
        if not run.quiet:
            for line in lines(one, dry_run):
                say(line)
    return undone or any(one.left or one.failed for one in found)


def copy_of(source: EditableSource | Font, out: Path) -> Path:
    """Where the copy of a source goes: a designspace's is a folder of its files, as its UFOs lie beside it."""
    from ..masters.designspace import Designspace
    from ..masters.glyphs_file import GlyphsFile

    make_folder(out)
    is_folder = isinstance(source, Designspace) and not isinstance(source, GlyphsFile)
    return out / (source.path.stem if is_folder else source.path.name)


def table(changes: Sequence[Change]) -> str:
    """What moved, a finding a line."""
    from .page import after_words, before_words, moved_words

    rows = [
        [
            change.glyph, change.kind, f"{change.contour}", "{:.0f}, {:.0f}".format(*change.point),
            before_words(change), after_words(change), moved_words(change),
            f"{rounded_up(change.distance or 0.0, 3):g}",
        ]
        for change in changes
    ]  # fmt: skip
    headings = ("glyph", "kind", "contour", "at", "before", "after", "points moved", "curves moved")
    return plain(headings, rows, numbers=headings[2:])


def lines(found: MendedSource, dry: bool) -> Iterator[str]:
    """What the table does not say."""
    mended, left = found.mended, found.left
    verb = "would change" if dry else "changed"
    yield (
        f"{found.source}: {counted(len(found.changed), 'glyph')} of {found.glyphs} {verb}, "
        f"{counted(len(found.changes), 'finding')} before, {len(left)} after"
    )
    if mended:
        yield f"the largest move of a point is {mended[0].moved:.3g} units"
    failed = [f"{name}: {why}" for name, why in found.failed]
    yield from (f"left: {line}" for line in shortened([*map(reason, left)], LEFT, "{} more, which --json lists"))
    yield from (f"failed: {line}" for line in shortened(failed, LEFT, "{} more"))


def reason(change: Change) -> str:
    """Where a finding is that is left, and why."""
    from .page import before_words, left_words

    place = "contour {}, {:.0f} {:.0f}".format(change.contour, *change.point)
    return f"{change.glyph}, {place}, {change.kind} of {before_words(change)}: {left_words(change)}"
