"""The rows of a chunk of glyphs of one font, made in a worker."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from ..batch.job import Place
from ..batch.pool import sign_of_life
from ..batch.spec import Limits
from ..errors import GlyphsplineError
from ..extras import need
from ..outlines.outline import FontMetrics, Outline
from .dataset_spec import DatasetSpec
from .plan import Task
from .scan import FontFacts, category_of, script_of, selected


class RowsJob(NamedTuple):
    """What a worker needs: what rows hold, and from which size on a glyph fails."""

    spec: DatasetSpec
    limits: Limits


class Made(NamedTuple):
    """The rows of some glyphs.

    Attributes:
        rows: an Arrow table as an IPC stream. glyphs: number of glyphs in it.
        failed: name of each glyph that has no rows, and why.
    """

    rows: bytes
    glyphs: int
    failed: list[tuple[str, str]]


def make_rows(job: RowsJob, tasks: Sequence[Task]) -> Made:
    """The rows of glyphs of one font, in order. A glyph that fails costs only itself."""
    from ..batch.worker import Read, batches, cost_of, reason, source_of, vertices_of

    pa = need("parquet")
    font = tasks[0].font
    source = source_of(*font.place)
    gids = _selected(font.place, job.spec)
    tables: list[Any] = []
    failed: dict[int, tuple[str, str]] = {}
    read: list[Read] = []
    for task, outline in zip(tasks, source.outlines([gids[t.at] for t in tasks], errors="return"), strict=True):
        try:
            if isinstance(outline, GlyphsplineError):
                raise outline
            check_points(outline, job)
            vertices = 0.0 if job.spec.options is None else vertices_of([outline], job.spec.options)[0]
            read.append(Read(task, outline, cost_of(outline, vertices, job.limits)))  # type: ignore[arg-type]
        except GlyphsplineError as error:
            failed[task.number] = source.glyph_names[gids[task.at]], reason(error)
    for batch in batches(read):
        tables += _tables(job.spec, font, [(glyph.task, glyph.outline) for glyph in batch], failed)  # type: ignore[misc]
        sign_of_life()
    table = pa.concat_tables(tables) if tables else empty_table(job.spec)
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema) as writer:
        writer.write_table(table.combine_chunks())
    return Made(sink.getvalue().to_pybytes(), len(tasks) - len(failed), [failed[number] for number in sorted(failed)])


def check_points(outline: Outline, job: RowsJob) -> None:
    """Refuse a glyph of more contours than any real one has.

    Raises:
        GlyphsplineError: its points are more than vertices may be, and it has more than a hundred contours.
    """
    contours, points = len(outline.contours), job.spec.points or 0
    if contours > 100 and contours * points > job.limits.vertices:
        raise GlyphsplineError(
            f"{contours} contours of {points} points, more than the {job.limits.vertices} points allowed"
        )


def names_of(tasks: Sequence[Task], spec: DatasetSpec) -> list[str]:
    """The names of glyphs of one font, of which a worker was lost: by opening the font here, if it can be opened."""
    from ..batch.worker import source_of

    place = tasks[0].font.place
    try:
        names, gids = source_of(*place).glyph_names, _selected(place, spec)
        return [names[gids[task.at]] for task in tasks]
    except (GlyphsplineError, IndexError):  # the file has been changed or removed
        return [f"#{task.at}" for task in tasks]


@lru_cache(maxsize=1)
def _selected(place: Place, spec: DatasetSpec) -> list[int]:
    from ..batch.worker import source_of

    return selected(source_of(*place), spec)


def _tables(
    spec: DatasetSpec, font: FontFacts, glyphs: Sequence[tuple[Task, Outline]], failed: dict[int, tuple[str, str]]
) -> list[Any]:
    """Tables of a batch's rows; after an unexpected error, glyph by glyph."""
    from ..batch.worker import reason
    from .rows import fits_of, table_of

    outlines = [outline for _, outline in glyphs]
    try:
        results: list[Any] = [None] * len(outlines)
        if spec.options is not None:
            results = list(fits_of(outlines, spec))
        good = [k for k, result in enumerate(results) if not isinstance(result, GlyphsplineError)]
        own = [outlines[k] for k in good]
        table = with_font(table_of(own, [results[k] for k in good], spec), own, font, spec)
        bad = {k: results[k] for k in {*range(len(glyphs))}.difference(good)}
        failed |= {glyphs[k][0].number: (outlines[k].name, reason(error)) for k, error in bad.items()}
        return [table]
    except Exception as error:
        if len(glyphs) == 1:
            failed[glyphs[0][0].number] = outlines[0].name, reason(error)
            return []
        return [table for glyph in glyphs for table in _tables(spec, font, [glyph], failed)]


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
