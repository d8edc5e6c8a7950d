"""Two fonts compared glyph by glyph: which glyph is which, pairs compared in workers, and what differs."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple, TypeAlias

from ...errors import GlyphsplineError, is_positive, require
from ...outlines.outline import partly_read
from ...readers import Source
from ...readers.source import OutlineOrError
from ...runs.engine import Item, Job, Observer, reason, run
from ...runs.schedule import Place, heads_of, place_of, sources, workers
from ...runs.spec import LIMITS
from ...types import Head
from .difference import PER_EM, Difference


class Pair(NamedTuple):
    """A glyph of both sources."""

    old: Head
    new: Head


class Uncompared(NamedTuple):
    """A glyph that could not be compared: its name in the old font, and why."""

    glyph: str
    gid: int
    error: str


Found: TypeAlias = list[Difference | Uncompared]


@dataclass(frozen=True)
class CompareJob(Job[Pair, Found]):
    """Both sources, and the tolerance in units of the old em."""

    old: Place
    new: Place
    tolerance: float

    budget = 20_000
    """Segments of both fonts compared at once."""

    def read(self, tasks: Sequence[Pair]) -> list[Item | Exception]:
        """The outlines of both glyphs."""
        old, new = sources(self.old, self.new)
        return list(map(_item, old.read([pair.old for pair in tasks]), new.read([pair.new for pair in tasks])))

    def together(self, tasks: Sequence[Pair], contents: Sequence[Any]) -> Found:
        """The differences of a batch."""
        from .compare import compare

        return [compare(old, new, self.tolerance) for old, new in contents]

    def failed(self, task: Pair, error: Exception) -> Found:
        """Why a glyph was not compared."""
        return [Uncompared(*task.old[:2], reason(error))]


def _item(old: OutlineOrError, new: OutlineOrError) -> Item | GlyphsplineError:
    """Both outlines of a glyph, or why one of them cannot be compared."""
    for which, outline in (("old", old), ("new", new)):
        if isinstance(outline, GlyphsplineError):
            error: GlyphsplineError | None = outline
        else:
            error = partly_read(outline.unread) or LIMITS.error_of(len(outline.arrays.degrees))
        if error:
            return GlyphsplineError(f"{which}: {reason(error)}")
    pair: tuple[Any, Any] = old, new
    return Item(pair, sum(len(outline.arrays.degrees) for outline in pair))


@dataclass(frozen=True)
class Pairs:
    """Which glyph is which.

    Attributes:
        pairs: by the old font's glyph indices. only_old, only_new: names of glyphs that the other does not have.
    """

    pairs: tuple[Pair, ...]
    only_old: tuple[str, ...]
    only_new: tuple[str, ...]

    @property
    def renamed(self) -> tuple[tuple[str, str], ...]:
        """Old and new name of each pair whose names differ: these have a code point in common."""
        return tuple((old[0], new[0]) for old, new in self.pairs if old[0] != new[0])


@dataclass
class FontDifference:
    """What differs between two fonts.

    Attributes:
        tolerance: in units of the old em. scale: of the new font's units, to those of the old em.
        glyphs: which are which. identical: number of pairs without any difference.
        differences: of the others, by glyph index. unread: glyphs that could not be compared.
        fonts: the two sources, as JSON data.
    """

    tolerance: float
    scale: float
    glyphs: Pairs
    identical: int = 0
    differences: list[Difference] = field(default_factory=list)
    unread: list[Uncompared] = field(default_factory=list)
    fonts: Mapping[str, Any] = field(default_factory=dict)

    @property
    def beyond(self) -> list[Difference]:
        """The differences beyond the tolerance."""
        return [each for each in self.differences if each.is_beyond(self.tolerance)]

    @property
    def undecided(self) -> list[Difference]:
        """The differences of which neither was shown: that they are within the tolerance, or beyond."""
        return [each for each in self.differences if each.is_undecided(self.tolerance)]

    @property
    def is_beyond(self) -> bool:
        """Whether anything is: a glyph that only one font has, or that could not be compared, always is."""
        return bool(self.glyphs.only_old or self.glyphs.only_new or self.unread or self.beyond)

    def worst_first(self) -> list[Difference]:
        """The differences: those beyond the tolerance first, then those undecided; by distance, change of the advance,
        and index."""

        def badness(own: Difference) -> tuple[float, ...]:
            rank = 0 if own.is_beyond(self.tolerance) else 1 if own.is_undecided(self.tolerance) else 2
            return rank, -own.bound, -abs(own.new_advance - own.advance), own.gid

        return sorted(self.differences, key=badness)

    def facts(self) -> dict[str, Any]:
        """As JSON data: counts first; differences by glyph index. It does not depend on the number of workers."""
        return {
            "format": 1,  # grows when a name changes its meaning
            **self.fonts,
            "tolerance": self.tolerance,
            "scale": self.scale,
            "beyond_tolerance": self.is_beyond,
            "compared": self.identical + len(self.differences),
            "identical": self.identical,
            "beyond": len(self.beyond),
            "undecided": len(self.undecided),
            "only_old": list(self.glyphs.only_old),
            "only_new": list(self.glyphs.only_new),
            "renamed": [list(names) for names in self.glyphs.renamed],
            "glyphs": [
                {
                    "beyond_tolerance": each.is_beyond(self.tolerance),
                    "undecided": each.is_undecided(self.tolerance),
                    **each.facts(),
                }
                for each in self.differences
            ],
            "failed": [unread._asdict() for unread in self.unread],
        }


def pairs_of(
    old: Source, new: Source, chosen_old: Collection[str] | None = None, chosen_new: Collection[str] | None = None
) -> Pairs:
    """Which glyph of one source is which of the other: of the same name, or else of a common code point.

    Glyphs of one name that both have code points, and none in common, are not the same: names like ``glyph00012`` are
    indices.

    Args:
        chosen_old, chosen_new: only pairs with a chosen glyph, and chosen glyphs of one source; None: all.
    """
    mine, its = heads_of(old), heads_of(new)
    partners: dict[str, str] = {}
    for name, (_, _, codes) in mine.items():
        other = its.get(name)
        if other is not None and not (codes and other[2] and not set(codes) & set(other[2])):
            partners[name] = name
    taken = set(partners.values())
    for name, (_, _, codes) in mine.items():
        if name not in partners:
            found = next((new.cmap[c] for c in codes if c in new.cmap and new.cmap[c] not in taken), None)
            if found is not None:
                partners[name] = found
                taken.add(found)
    wanted_old = set(mine if chosen_old is None else chosen_old)
    wanted_new = set(its if chosen_new is None else chosen_new)
    return Pairs(
        tuple(Pair(mine[a], its[b]) for a, b in partners.items() if a in wanted_old or b in wanted_new),
        tuple(name for name in mine if name not in partners and name in wanted_old),
        tuple(name for name in its if name not in taken and name in wanted_new),
    )


def compare_fonts(
    old: Source,
    new: Source,
    glyphs: Pairs | None = None,
    *,
    tolerance: float | None = None,
    jobs: int | None = None,
    executor: Executor | None = None,
    observer: Observer | None = None,
) -> FontDifference:
    """Compare two sources glyph by glyph; see :func:`glyphspline.compare`.

    The result does not depend on the number of workers. A broken glyph does not affect the others.

    Args:
        old, new: the opened sources; workers open them again by their paths.
        glyphs: which are which; without it, all.
        tolerance: in units of the old em; without it, 1/1000 em.
        jobs: worker processes; None takes all cores, 0 does everything in this process.
        executor: used instead; it is not closed.
        observer: called with the number of glyphs done, of all, and of those that could not be compared.

    Raises:
        OptionError: the tolerance is not positive.
    """
    em = old.metrics.units_per_em
    require(tolerance is None or is_positive(tolerance), "--tolerance is a positive number", tolerance)
    glyphs = pairs_of(old, new) if glyphs is None else glyphs
    found = FontDifference(
        em * PER_EM if tolerance is None else tolerance, em / new.metrics.units_per_em, glyphs,
        fonts={"old": about(old), "new": about(new)},
    )  # fmt: skip
    job, total = CompareJob(place_of(old), place_of(new), found.tolerance), len(glyphs.pairs)
    with workers(jobs if total else 0, LIMITS.seconds, ["comparing"], total, executor=executor) as pool:
        for part in run(job, glyphs.pairs, pool, ordered=True, observer=observer):
            for each in part.result:
                if isinstance(each, Uncompared):
                    found.unread.append(each)
                elif each.is_none:
                    found.identical += 1
                else:
                    found.differences.append(each)
    return found


def about(source: Source) -> dict[str, Any]:
    """A source as JSON data."""
    return {
        "file": source.path.name,
        "family": source.family,
        "style": source.style,
        "face_index": source.face_index,
        "location": dict(source.location),
        "metrics": asdict(source.metrics),
        "glyphs": len(source.glyph_names),
    }
