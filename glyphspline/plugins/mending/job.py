"""Sources mended: glyph by glyph in workers, and what moved written back."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from ...errors import GlyphsplineError, OutputError
from ...files import writing
from ...outlines.flaws.kinds import MENDED_UNASKED, THRESHOLDS, Thresholds
from ...outlines.masters import Masters
from ...readers import Font
from ...readers.ufo import EditableSource
from ...runs.engine import Item, Job, Observer, reason, run
from ...runs.schedule import Place, heads_of, place_of, sources, workers
from ...runs.spec import LIMITS
from ...types import Head
from .fewer import EDITED
from .mend import ANYWHERE, check_kinds, mended
from .state import Change, Into, Tally
from .users import MendedGlyph, spoiling, write

OF_COMPONENT = "is of a component"
"""Why contours are left that another glyph draws; there they are mended."""


FONT_KEEPS = "needs points to go or to change their order, and hints and variations of a font count them"
"""Why such findings are left in fonts."""


class Scope(NamedTuple):
    """Which kinds of findings are mended, by how much outlines may move, and what counts as a finding."""

    kinds: Sequence[str] = MENDED_UNASKED
    tolerance: float | None = None
    thresholds: Thresholds = THRESHOLDS


class Mended(NamedTuple):
    """What a worker made of a glyph: as it was, mended (None: nothing moved), what became of its findings, an error."""

    old: Masters | None
    new: Masters | None
    changes: Sequence[Change]
    error: str | None = None


@dataclass(frozen=True)
class MendJob(Job[Head, list[Mended]]):
    """Glyphs mended as their source draws them; ``outer``: see :attr:`.Source.outer`."""

    place: Place
    asked: Scope
    outer: int

    budget = 5_000
    """Points in masters that are looked at together: some ten glyphs of a variable text face."""

    def read(self, tasks: Sequence[Head]) -> Sequence[Item | Exception]:
        """Glyphs in all their masters; those of a source without axes are read together."""
        (source,) = sources(self.place)
        if source.axes:
            return super().read(tasks)
        found = source.read(tasks)
        return [each if isinstance(each, GlyphsplineError) else _item(Masters.of(each)) for each in found]

    def item(self, task: Head) -> Item | Exception:
        """A glyph in all its masters."""
        (source,) = sources(self.place)
        return _item(source.masters(task.name))

    def together(self, tasks: Sequence[Head], contents: Sequence[Any]) -> list[Mended]:
        """Mend glyphs. What the source allows is looked up of those alone that have something to mend."""
        (source,) = sources(self.place)
        (kinds, tolerance, thresholds), found = self.asked, []
        for masters, state in zip(contents, Tally.of_many(contents, thresholds, self.outer), strict=True):
            into = into_of(source, masters) if state.has(kinds) else ANYWHERE
            new, changes = mended(masters, state, kinds, tolerance, thresholds, self.outer, into)
            moved = None if new is masters else new
            found.append(Mended(masters if moved else None, moved, [c for c in changes if c.why != OF_COMPONENT]))
        return found

    def failed(self, task: Head, error: Exception) -> list[Mended]:
        """Why a glyph could not be mended."""
        return [Mended(None, None, (), reason(error))]


def _item(masters: Masters) -> Item | Exception:
    points = sum(contour.points.shape[1] for contour in masters.contours)
    return LIMITS.error_of(sum(map(len, masters.contours))) or Item(masters, len(masters) * points)


def into_of(source: Any, masters: Masters) -> Into:
    """What a source allows of a glyph."""
    count = len(masters.contours)
    if isinstance(source, Font):
        from ..fonts.back.fonts import edit_of

        stored = edit_of(source).stored(masters)
        own = {index for index in stored.owns if index is not None}
        fixed = {number: OF_COMPONENT for number in range(count) if number not in own}
        step = 1.0 if source.outer < 0 else None
        return Into(fixed | dict(stored.why), FONT_KEEPS, stored.masters, step)
    own = {index for index in source.own_contours(masters.name) if index is not None}
    fixed = {number: OF_COMPONENT for number in range(count) if number not in own}
    if {each.place for each in source.drawings(masters.name)} != set(masters.stored_peaks):
        fixed |= dict.fromkeys(own, "has masters in which only its components are drawn")
    return Into(fixed)


@dataclass
class MendedSource:
    """What became of a source.

    Attributes:
        source: its path. glyphs: number of those looked at. changed: names of those that changed.
        changes: what became of each finding. failed: glyphs that could not be read, with the reasons.
        drawn: glyphs that changed, as they were and as they are, by name.
    """

    source: str
    glyphs: int = 0
    changed: list[str] = field(default_factory=list)
    changes: list[Change] = field(default_factory=list)
    failed: list[tuple[str, str]] = field(default_factory=list)
    drawn: dict[str, tuple[Masters, Masters]] = field(default_factory=dict, repr=False)

    @property
    def left(self) -> list[Change]:
        """Findings that are still there."""
        return [change for change in self.changes if not change.is_mended]

    @property
    def mended(self) -> list[Change]:
        """Findings that are there no more, the largest move first."""
        return sorted((change for change in self.changes if change.is_mended), key=lambda change: -change.moved)

    def facts(self) -> dict[str, Any]:
        """As JSON data."""
        moved = [change.moved for change in self.mended]
        return {
            "source": self.source, "glyphs": self.glyphs, "changed": self.changed, "before": len(self.changes),
            "after": len(self.left), "largest_move": max(moved, default=None),
            "changes": [asdict(change) for change in self.changes], "failed": dict(self.failed),
        }  # fmt: skip


def mend_source(
    source: EditableSource | Font,
    names: Sequence[str],
    asked: Scope,
    *,
    copy: Path | None = None,
    layer: str | None = None,
    dry: bool = False,
    executor: Executor | None = None,
    observer: Observer | None = None,
) -> MendedSource:
    """Mend glyphs of a source or font, and write those that changed into it, a layer of it or a copy.

    Args:
        names: of the glyphs. asked: see :func:`glyphspline.mend`.
        copy, layer: see :func:`.back.write_back`. dry: write nothing.
        executor: see :func:`.schedule.workers`; without it, this process does all.

    Raises:
        OptionError: a kind cannot be mended. OutputError: the source takes nothing back, or cannot be written.
    """
    check_kinds(asked.kinds)
    if isinstance(source, Font):
        from ..fonts.back.fonts import editable as editable_font

        if layer is not None:
            raise OutputError("is a font, which has no layers", font=str(source.path))
        editable_font(source)
    else:
        from ..fonts.back.back import editable

        editable(source)
    job = MendJob(place_of(source), asked, source.outer)
    found, new = MendedSource(str(source.path)), list[MendedGlyph]()
    with workers(0, executor=executor) as pool:
        for part in run(job, list(heads_of(source, names).values()), pool, ordered=True, observer=observer):
            for (name, _, _), one in zip(part.tasks, part.result, strict=True):
                found.glyphs += one.error is None
                if one.error is not None:
                    found.failed.append((name, one.error))
                found.changes += one.changes
                if one.old is not None and one.new is not None:
                    redrawn = {each.contour for each in one.changes if each.is_mended and each.kind in EDITED}
                    new.append(MendedGlyph(one.old, one.new, redrawn))
        with writing(copy or source.path):
            stay = spoiling(source, new, asked.tolerance, asked.thresholds, pool)
    new = [each for each in new if each.now.name not in stay]
    with writing(copy or source.path):
        written = write(source, new, copy, layer, dry)
    found.drawn, found.changed = {now.name: (old, now) for old, now, _ in new}, written.names
    kept = written.contours
    found.changes = [
        _left(c, why) if (why := stay.get(c.glyph) or kept.get((c.glyph, c.contour))) and c.is_mended else c
        for c in found.changes
    ]
    return found


def _left(change: Change, why: str) -> Change:
    """A finding that was mended and stays all the same."""
    return replace(change, why=why, after=None, moved=0.0, moves=(), gone=0, distance=None)
