"""The rows of a chunk of glyphs of one font, made in a worker."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import GlyphsplineError
from ..extras import need
from ..outlines.outline import FontMetrics, Outline
from ..runs.engine import Item, Job, reason
from ..runs.jobs.convert import ConvertJob
from ..runs.schedule import Place, sources
from ..runs.spec import Limits
from .dataset_spec import DatasetSpec
from .plan import Task
from .scan import FontFacts, category_of, script_of, selected

if TYPE_CHECKING:
    from ..readers.source import OutlineOrError


class Made(NamedTuple):
    """The rows of some glyphs.

    Attributes:
        rows: an Arrow table as an IPC stream. glyphs: number of glyphs in it.
        failed: name of each glyph that has no rows, and why.
    """

    rows: bytes
    glyphs: int
    failed: list[tuple[str, str]]


@dataclass(frozen=True)
class RowsJob(Job[Task, Made]):
    """What rows hold, and from which size on a glyph fails. The tasks of a call are of one font."""

    spec: DatasetSpec
    limits: Limits

    budget = ConvertJob.budget

    def read(self, tasks: Sequence[Task]) -> list[Item | Exception]:
        """Outlines; one that is too large is an error."""
        from ..runs.worker import items

        place = tasks[0].font.place
        (source,), gids = sources(place), _selected(place, self.spec)
        found = source.outlines([gids[task.at] for task in tasks], errors="return")
        return items([self._checked(outline) for outline in found], self.spec.options, self.limits)

    def _checked(self, outline: OutlineOrError) -> OutlineOrError:
        """The outline, or an error if it has more contours than any real one has."""
        if isinstance(outline, GlyphsplineError):
            return outline
        contours, points = len(outline.contours), self.spec.points or 0
        if contours <= 100 or contours * points <= self.limits.vertices:
            return outline
        return GlyphsplineError(
            f"{contours} contours of {points} points, more than the {self.limits.vertices} points allowed"
        )

    def together(self, tasks: Sequence[Task], contents: Sequence[Any]) -> Made:
        """The rows of outlines."""
        from .rows import fits_of, table_of

        pa = need("parquet")
        results: list[Any] = [None] * len(contents)
        if self.spec.options is not None:
            results = list(fits_of(contents, self.spec))
        good = [k for k, result in enumerate(results) if not isinstance(result, GlyphsplineError)]
        failed = [
            (outline.name, reason(result))
            for outline, result in zip(contents, results, strict=True)
            if isinstance(result, GlyphsplineError)
        ]
        own = [contents[k] for k in good]
        table = with_font(table_of(own, [results[k] for k in good], self.spec), own, tasks[0].font, self.spec)
        sink = pa.BufferOutputStream()
        with pa.ipc.new_stream(sink, table.schema) as writer:
            writer.write_table(table.combine_chunks())
        return Made(sink.getvalue().to_pybytes(), len(good), failed)

    def failed(self, task: Task, error: Exception) -> Made:
        """No rows. The name of the glyph is that of the font, if it can be opened here."""
        place = task.font.place
        try:
            name = sources(place)[0].glyph_names[_selected(place, self.spec)[task.at]]
        except (GlyphsplineError, IndexError):  # the file has been changed or removed
            name = f"#{task.at}"
        return Made(b"", 0, [(name, reason(error))])

    def failures(self, result: Made) -> int:
        """Number of glyphs that have no rows."""
        return len(result.failed)


@lru_cache(maxsize=1)
def _selected(place: Place, spec: DatasetSpec) -> list[int]:
    return selected(sources(place)[0], spec)


def with_font(table: Any, outlines: Sequence[Outline], font: FontFacts, spec: DatasetSpec) -> Any:
    """The table with the columns of script, category and font, and one for duplicates that is not filled yet.

    Strings are plain ones, as libraries of data sets expect; files keep each distinct one once a row group.
    """
    pa = need("parquet")
    first = {outline.gid: outline.unicodes[0] for outline in outlines if outline.unicodes}
    codes = [first.get(gid) for gid in table["gid"].to_pylist()]
    metrics = outlines[0].metrics if outlines else FontMetrics()  # of all in a batch: drawings have their own
    unit = 1.0 if spec.normalise == "units" else metrics.units_per_em
    length = "font unit" if spec.normalise == "units" else "em"
    string, number = pa.string(), pa.float64()
    constant = [
        ("family", string, font.family, None),
        ("style", string, font.style, None),
        ("weight", pa.uint16(), font.weight_class, None),
        ("width", pa.uint16(), font.width_class, None),
        ("italic", pa.bool_(), font.italic, None),
        ("location", string, font.location, "user space"),
        ("units_per_em", number, metrics.units_per_em, "font unit"),
        ("ascender", number, metrics.ascender / unit, length),
        ("descender", number, metrics.descender / unit, length),
        ("licence", string, font.licence, None),
        ("split", string, font.split, None),
        ("font", string, font.sha256, None),
        ("face", pa.uint32(), font.face, None),
    ]
    columns = [
        ("script", pa.array([None if code is None else script_of(code) for code in codes], string), None),
        ("category", pa.array([None if code is None else category_of(code) for code in codes], string), None),
        *((name, pa.repeat(pa.scalar(value, kind), len(codes)), u) for name, kind, value, u in constant),
        ("duplicate", pa.nulls(len(codes), pa.bool_()), None),
    ]
    for name, values, u in columns:
        field = pa.field(name, values.type, metadata={"unit": u} if u else None)
        table = table.append_column(field, values)
    return table


def empty_table(spec: DatasetSpec) -> Any:
    """A table of no rows, with all columns."""
    from pathlib import Path

    from .schema import schema

    return with_font(schema(spec).empty_table(), [], FontFacts(Path(), ""), spec)
