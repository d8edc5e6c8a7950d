"""Mended glyphs written, and composites of them compared as they are then read: they keep their ink, too."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from ...outlines.flaws.kinds import Thresholds
from ...outlines.masters import Masters
from ...readers import Font
from ...readers.ufo import EditableSource
from ...runs.engine import Item, Job, run
from ...runs.schedule import Place, heads_of, place_of, sources
from ...types import Head
from ..fonts.back.back import Written, moved_points, write_back
from ..fonts.back.fonts import edit_of, write_points
from .ink import INK, keeps_ink
from .state import DIGITS, PER_EM, Design


class MendedGlyph(NamedTuple):
    """A glyph as it was and mended; ``redrawn``: contours of which points went or changed their order."""

    old: Masters
    now: Masters
    redrawn: Collection[int]


def write(
    source: EditableSource | Font, glyphs: Sequence[MendedGlyph], copy: Path | None, layer: str | None = None,
    dry: bool = False,
) -> Written:  # fmt: skip
    """Write mended glyphs into a source, a layer of it or a copy; see :func:`.back.write_back`."""
    if isinstance(source, Font):
        return Written(write_points(source, [(each.old, each.now) for each in glyphs], copy=copy, dry=dry))
    moved = [moved_points(source, *each) for each in glyphs]
    return write_back(source, moved, DIGITS, copy=copy, layer=layer, dry=dry)


def spoiling(
    source: EditableSource | Font, glyphs: Iterable[MendedGlyph], tolerance: float | None, thresholds: Thresholds,
    pool: Executor,
) -> dict[str, str]:  # fmt: skip
    """The mended glyphs that would change a composite's ink, or their own, as not all is written; and why they stay.

    They are written to a copy of the source, until no composite there has other ink than it had.
    """
    left = {each.now.name: each for each in glyphs}
    stay = dict.fromkeys(_in_part(source, [*left.values()], tolerance, thresholds), INK)
    left = {name: each for name, each in left.items() if name not in stay}
    parts = (edit_of(source) if isinstance(source, Font) else source).components() if left else {}
    while users := users_of(parts, left):
        with TemporaryDirectory(prefix="glyphspline-") as folder:
            write(source, [*left.values()], Path(folder, source.path.name))
            path, face_index, location = place_of(source)
            # The copy of a designspace is a folder.
            written = next(each for each in Path(folder).rglob(path.name) if each.is_dir() or path.is_file())
            job = UsersJob((path, face_index, location), (written, face_index, location), tolerance, thresholds)
            heads = [*heads_of(source, users).values()]
            spoiled = [name for part in run(job, heads, pool, ordered=True) for name in part.result]
            sources.cache_clear()
        new = {part: f"{INK} of {user}, a composite" for user in reversed(spoiled) for part in users[user]}
        if not new:
            break
        stay |= new
        left = {name: each for name, each in left.items() if name not in new}
    return stay


def _in_part(
    source: EditableSource | Font, glyphs: Sequence[MendedGlyph], tolerance: float | None, thresholds: Thresholds
) -> list[str]:
    """Glyphs of which only some contours can be written, so that the ink changes."""
    kept, found = write(source, glyphs, None, dry=True).contours, []
    for old, now, _ in glyphs:
        same = {c for name, c in kept if name == now.name}
        contours = [old.contours[c] if c in same else each for c, each in enumerate(now.contours)]
        if same and not _keeps_ink(old, replace(now, contours=contours), tolerance, thresholds):
            found.append(now.name)
    return found


def _keeps_ink(old: Masters, new: Masters, tolerance: float | None, thresholds: Thresholds) -> bool:
    tolerance = tolerance or PER_EM * old.metrics.units_per_em
    return keeps_ink(old, new, Design.of(old, tolerance, thresholds, None))


def users_of(parts: Mapping[str, Collection[str]], names: Collection[str]) -> dict[str, set[str]]:
    """Composites with any of these glyphs among their components, at any depth, and which of them.

    Args:
        parts: the components that each composite has itself.
    """
    found: dict[str, set[str]] = {}
    for user in parts:
        below, left = set[str](), [user]
        while left:
            new = set(parts.get(left.pop(), ())) - below
            below |= new
            left += new
        if own := below.intersection(names) - {user}:
            found[user] = own
    return found


@dataclass(frozen=True)
class UsersJob(Job[Head, list[str]]):
    """Composites of a source and of its copy, compared: the names of those whose ink differs."""

    place: Place
    copy: Place
    tolerance: float | None
    thresholds: Thresholds

    def item(self, task: Head) -> Item | Exception:
        """A composite in all its masters, before and after."""
        old, new = (each.masters(task[0]) for each in sources(self.place, self.copy))
        return Item((old, new))

    def together(self, tasks: Sequence[Head], contents: Sequence[Any]) -> list[str]:
        """Compare composites."""
        return [old.name for old, new in contents if not _keeps_ink(old, new, self.tolerance, self.thresholds)]

    def failed(self, task: Head, error: Exception) -> list[str]:
        """Nothing is known of a composite that cannot be read."""
        return []
