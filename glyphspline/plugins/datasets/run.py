"""A data set made of fonts: scanned, planned, and written shard after shard from rows that workers make."""

from __future__ import annotations

import json
import re
import shutil
import time
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain, islice
from pathlib import Path
from typing import Any

from ...errors import GlyphsplineError, OptionError, OutputError
from ...extras import need
from ...files import reading
from ...outlines.outline import partly_read
from ...runs.convert import ConvertJob
from ...runs.engine import Item, Job, Observer, reason, run
from ...runs.folder import UNFINISHED, locked, refuse_older
from ...runs.font_search import find_fonts
from ...runs.record import Record, open_record, remove_record
from ...runs.schedule import Place, sources, workers
from ...runs.shapes import Shapes
from ...runs.spec import LIMITS, differences, kinds_for
from . import remote
from .card import DatasetSummary, card, write_fonts
from .columns import schema
from .kept import Chunks, Made, streamed
from .plan import DatasetTask, Plan, Shard, plan_of, record_text
from .scan import ScanJob, selected
from .shards import OfFont, add_shapes, finished, write_shard
from .spec import USUAL, DatasetSpec, Sizes

RECORD, FONTS, CARD = "dataset.json", "fonts.parquet", "README.md"
"""Files beside the folder of shards."""

SHARD_NAME = re.compile(r"(?:train|validation|test)-\d{5,}-of-\d{5,}\.parquet")


@dataclass(frozen=True)
class RowsJob(Job[DatasetTask, Made]):
    """Rows of glyphs; the tasks of a call are of one font."""

    spec: DatasetSpec

    budget = ConvertJob.budget

    def read(self, tasks: Sequence[DatasetTask]) -> list[Item | Exception]:
        """Outlines; one that is too large, or has more contours than any real one, is an error."""
        from ...runs.worker import items

        place = tasks[0].font.place
        (source,), gids = sources(place), list(_selected(place, self.spec))
        found = list(source.outlines([gids[task.at] for task in tasks], errors="return"))
        points, most = self.spec.points or 0, LIMITS.vertices
        for k, outline in enumerate(found):
            if isinstance(outline, GlyphsplineError):
                continue
            if error := partly_read(outline.unread):
                found[k] = error
            elif (count := len(outline.contours)) > 100 and count * points > most:
                words = f"{count} contours of {points} points, more than the {most} points allowed"
                found[k] = GlyphsplineError(words)
        return items(found, self.spec.options, LIMITS)

    def together(self, tasks: Sequence[DatasetTask], contents: Sequence[Any]) -> Made:
        """The rows of outlines."""
        from .rows import fits_of, table_of, with_font

        results: list[Any] = [None] * len(contents)
        if self.spec.options is not None:
            results = list(fits_of(contents, self.spec))
        pairs = list(zip(contents, results, strict=True))
        good = [pair for pair in pairs if not isinstance(pair[1], GlyphsplineError)]
        failed = [(outline.name, reason(one)) for outline, one in pairs if isinstance(one, GlyphsplineError)]
        own = [outline for outline, _ in good]
        font, asked = tasks[0].font, _selected(tasks[0].font.place, self.spec)
        table = with_font(table_of(own, [one for _, one in good], self.spec), own, font, self.spec, asked)
        return Made(streamed(table), len(good), failed)

    def failed(self, task: DatasetTask, error: Exception) -> Made:
        """No rows. The name of the glyph is that of the font, if it can be opened here."""
        place = task.font.place
        try:
            name = sources(place)[0].glyph_names[list(_selected(place, self.spec))[task.at]]
        except (GlyphsplineError, IndexError):  # the file has been changed or removed
            name = f"#{task.at}"
        return Made(b"", 0, [(name, reason(error))])

    def failures(self, result: Made) -> int:
        """Number of glyphs that have no rows."""
        return len(result.failed)


@lru_cache(maxsize=1)
def _selected(place: Place, spec: DatasetSpec) -> dict[int, str | None]:
    return selected(sources(place)[0], spec)


def dataset(
    fonts: str | Path | Iterable[str | Path],
    out: str | Path,
    spec: DatasetSpec | None = None,
    *,
    jobs: int | None = None,
    executor: Executor | None = None,
    scheduler: str | None = None,
    restart: bool = False,
    observer: Observer | None = None,
    sizes: Sizes = USUAL,
) -> DatasetSummary:
    """Make a data set of the glyphs of fonts: a folder of Parquet files that ``datasets.load_dataset`` opens.

    The same fonts and options give the same bytes, whatever ``jobs`` is and however often the run was interrupted:
    called again, it goes on where it was; in an object store, after the last shard that is finished. Memory does not
    grow with the number of glyphs, but for 8 bytes for each distinct shape, by which duplicates are found, twice that
    for moments, and the facts of fonts.

    Fonts and glyphs that are broken cost only themselves: ``fonts.parquet`` says what failed and why.

    Args:
        fonts: files, folders, globs, URLs and lists of fonts as for the command line; see :func:`.find_fonts`.
        out: the folder, which is created if it does not exist, or its URL in an object store: ``s3://bucket/letters``.
        spec: what the data set holds.
        jobs: worker processes; None takes all cores, 0 does everything in this process.
        executor: used instead of worker processes; it is not closed.
        scheduler: address of a dask cluster, whose workers are used instead: ``tcp://10.0.0.1:8786``.
        restart: remove the files of an earlier run first.
        observer: called after each chunk of glyphs.
        sizes: of files, row groups and chunks.

    Raises:
        OutputError: the folder cannot be written, another run writes to it, or it holds a data set of other options,
            fonts or versions and ``restart`` is not given, or files that are of no data set.
        GlyphsplineError: there are no fonts, a list of them cannot be read, or pyarrow is not installed.

    Example:
        >>> import glyphspline as gs
        >>> summary = gs.dataset("fonts_test", "outputs/letters", gs.DatasetSpec(points=32))  # doctest: +SKIP
    """
    started = time.perf_counter()
    need("parquet")
    spec = spec or DatasetSpec()
    folder = remote.place_of(out)
    given = [fonts] if isinstance(fonts, str | Path) else fonts
    found = find_fonts(map(str, given))
    if not found:
        raise OptionError("no fonts found")
    kinds = ["points", *(["unfitted"] if spec.options is None else kinds_for(spec.options))]
    with (
        remote.folder_of_record(folder) as place,
        locked(place),
        workers(jobs, LIMITS.seconds, kinds, len(found), scheduler=scheduler, executor=executor) as pool,
    ):
        scanned = run(ScanJob(spec), [path.absolute() for path in found], pool)
        plan = plan_of(spec, [facts for part in scanned for facts in part.result], sizes)
        _prepare(folder, place, plan, restart)
        with open_record(place) as record:
            summary = _written(folder, plan, record, pool, observer)
    summary.seconds = time.perf_counter() - started
    return summary


def _prepare(out: str, place: Path, plan: Plan, restart: bool) -> None:
    """Make sure that what is in the folder, and in that of the record, is of this run, or nothing."""
    if not restart:
        refuse_older(place)
    shards = [name for name in remote.listing(f"{out}/data") if SHARD_NAME.fullmatch(name)]
    old = _record(out)
    if old is None:
        if shards or any(remote.size(f"{out}/{name}") is not None for name in (CARD, FONTS)):
            raise OutputError("holds files that are of no data set: give another folder", font=out)
    elif restart:
        shutil.rmtree(place / UNFINISHED, ignore_errors=True)
        remove_record(place)
        for name in (*(f"data/{shard}" for shard in shards), FONTS, CARD, RECORD):
            if remote.size(f"{out}/{name}") is not None:
                remote.remove(f"{out}/{name}")
    elif changed := differences(old, json.loads(record_text(plan))):
        raise OutputError("holds another data set; --restart does it anew:\n  " + "\n  ".join(changed), font=out)
    remote.listing(out)  # removes what an interrupted run has left
    remote.put(f"{out}/{RECORD}", lambda file: file.write(record_text(plan)))


def _record(out: str) -> dict[str, Any] | None:
    """The record of the data set in a folder; None if it has none, an OutputError if the file is something else."""
    path = f"{out}/{RECORD}"
    if remote.size(path) is None:
        return None
    with remote.read(path) as file, reading(path):
        record = json.loads(file.read())
    if not (isinstance(record, dict) and {"glyphspline", "spec"} <= record.keys()):
        raise OutputError("is of no data set: give another folder", font=path)
    return record


def _written(out: str, plan: Plan, record: Record, pool: Executor, observer: Observer | None) -> DatasetSummary:
    """Write the shards that are not finished, then the table of fonts and the card."""
    paths = {shard: f"{out}/{shard.name}" for shard in plan.shards}
    held = {shard: finished(path, mark_of(shard, plan)) for shard, path in paths.items()}
    left = [shard for shard, fonts in held.items() if fonts is None]
    totals: dict[int, OfFont] = {}
    numbers = {font.key: k for k, font in enumerate(plan.fonts) if font.taken}
    failed = sum(of_font.failed for fonts in held.values() if fonts is not None for of_font in fonts.values())
    watching = observer and (lambda done, total, new: observer(done, total, failed + new))

    if left and not record.is_open:
        record.begin()
    first = Chunks(record, mark_of(left[0], plan)) if left else None
    known = first.count if first else 0
    made = sum(map(len, islice(plan.chunks(left[0]), known))) if left else 0
    parts = run(
        RowsJob(plan.spec), (), pool, ordered=True, observer=watching, total=plan.glyphs,
        before=plan.glyphs - sum(shard.glyphs for shard in left) + made,
        chunks=islice(chain.from_iterable(map(plan.chunks, left)), known, None),
    )  # fmt: skip

    def of_shard(shard: Shard) -> Iterator[tuple[int, Made]]:
        kept = first if first and shard == left[0] else Chunks(record, mark_of(shard, plan))
        for k, chunk in enumerate(plan.chunks(shard)):
            if k < kept.count:
                own = kept.chunk(k)
            else:
                own, done = [], 0
                while done < len(chunk):
                    part = next(parts)
                    own.append(part.result)
                    done += len(part.tasks)
                kept.add(k, own)
            yield from ((numbers[chunk[0].font.key], one) for one in own)

    shapes, following = Shapes(), len(left)
    layout = schema(plan.spec, of_fonts=True)
    for shard, fonts in held.items():
        if fonts is None:
            fonts = write_shard(paths[shard], of_shard(shard), shapes, mark_of(shard, plan), layout, plan.sizes)
            following -= 1
        elif following:
            add_shapes(paths[shard], shapes)
        for number, of_font in fonts.items():
            totals[number] = totals.get(number, OfFont()).plus(of_font)
    record.remove()
    sizes = {shard: size for shard, path in paths.items() if (size := remote.size(path)) is not None}
    if gone := [path for shard, path in paths.items() if shard not in sizes]:
        raise OutputError("is gone while the data set is written", font=gone[0])
    summary = DatasetSummary.of(plan, totals, sizes)
    remote.put(f"{out}/{FONTS}", lambda file: write_fonts(plan, totals, file))
    remote.put(f"{out}/{CARD}", lambda file: file.write(card(plan, summary, layout).encode()))
    return summary


def mark_of(shard: Shard, plan: Plan) -> str:
    """What a finished shard has in its footer, and no other file."""
    return f"{plan.digest} {shard.name}"
