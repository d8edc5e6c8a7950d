"""A data set made of fonts: scanned, planned, and written shard after shard."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from itertools import chain
from pathlib import Path
from typing import Any

from ..errors import OptionError, OutputError
from ..extras import need
from ..runs.engine import Observer, run
from ..runs.font_search import find_fonts
from ..runs.schedule import kinds_for, workers
from ..runs.spec import Limits, differences
from . import store
from .card import card, fonts_file
from .chunk_rows import Made, RowsJob, empty_table
from .dataset_spec import DatasetSpec
from .dataset_summary import Summary
from .plan import Plan, Shard, plan_of, record_text
from .scan import ScanJob
from .shards import OfFont, Shapes, add_shapes, finished, write_shard

RECORD, FONTS, CARD = "dataset.json", "fonts.parquet", "README.md"
"""Files beside the folder of shards."""

SHARD_NAME = re.compile(r"(?:train|validation|test)-\d{5,}-of-\d{5,}\.parquet")


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
) -> Summary:
    """Make a data set of the glyphs of fonts: a folder of Parquet files that ``datasets.load_dataset`` opens.

    The same fonts and options give the same bytes, whatever ``jobs`` is and however often the run was interrupted:
    called again, it goes on after the last shard that is finished. Memory does not grow with the number of glyphs, but
    for 8 bytes for each distinct shape, by which duplicates are found, twice that for moments, and the facts of fonts.

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
    folder = store.place_of(out)
    given = [fonts] if isinstance(fonts, str | Path) else fonts
    found = find_fonts(map(str, given))
    if not found:
        raise OptionError("no fonts found")
    with store.alone(folder):
        options = spec.options
        kinds = ["points", *(["unfitted"] if options is None else kinds_for(options))]
        limits = Limits()
        with workers(jobs, limits.seconds, kinds, len(found), scheduler=scheduler, executor=executor) as pool:
            scanned = run(ScanJob(spec), [path.absolute() for path in found], pool)
            plan = plan_of(spec, [facts for part in scanned for facts in part.result])
            _prepare(folder, plan, restart)
            summary = _written(folder, plan, pool, limits, observer)
    summary.seconds = time.perf_counter() - started
    return summary


def _prepare(out: str, plan: Plan, restart: bool) -> None:
    """Make sure that what is in the folder is of this run, or nothing."""
    shards = [name for name in store.listing(f"{out}/data") if SHARD_NAME.fullmatch(name)]
    old = _record(out)
    if old is None:
        if shards or store.exists(f"{out}/{CARD}") or store.exists(f"{out}/{FONTS}"):
            raise OutputError("holds files that are of no data set: give another folder", font=out)
    elif restart:
        for name in (*(f"data/{shard}" for shard in shards), FONTS, CARD, RECORD):
            if store.exists(f"{out}/{name}"):
                store.remove(f"{out}/{name}")
    elif changed := differences(old, json.loads(record_text(plan))):
        raise OutputError("holds another data set; --restart does it anew:\n  " + "\n  ".join(changed), font=out)
    store.listing(out)  # removes what an interrupted run has left
    store.put(f"{out}/{RECORD}", record_text(plan))


def _record(out: str) -> dict[str, Any] | None:
    """The record of the data set in a folder; None if it has none.

    Raises:
        OutputError: a file of that name is no such record.
    """
    path = f"{out}/{RECORD}"
    if not store.exists(path):
        return None
    with store.read(path) as file:
        try:
            record = json.loads(file.read())
        except ValueError as error:
            raise OutputError(f"cannot be read: {error}", font=path) from error
    if not (isinstance(record, dict) and {"glyphspline", "spec"} <= record.keys()):
        raise OutputError("is of no data set: give another folder", font=path)
    return record


def _written(out: str, plan: Plan, pool: Executor, limits: Limits, observer: Observer | None) -> Summary:
    """Write the shards that are not finished, then the table of fonts and the card."""
    paths = {shard: f"{out}/{shard.name}" for shard in plan.shards}
    held = {
        shard: found for shard, path in paths.items() if (found := finished(path, mark_of(shard, plan))) is not None
    }
    left = [shard for shard in plan.shards if shard not in held]
    totals: dict[int, OfFont] = {}
    numbers = {font.key: k for k, font in enumerate(plan.fonts) if font.taken}
    done = sum(shard.glyphs for shard in held)
    failed = sum(of_font.failed for fonts in held.values() for of_font in fonts.values())
    chunks = chain.from_iterable(map(plan.chunks, left))
    watching = observer and (lambda done, total, new: observer(done, total, failed + new))
    parts = run(
        RowsJob(plan.spec, limits), (), pool, ordered=True, observer=watching, before=done, chunks=chunks,
        total=plan.glyphs,
    )  # fmt: skip

    def of_shard(shard: Shard) -> Iterator[tuple[int, Made]]:
        following = 0
        while following < shard.glyphs:
            part = next(parts)
            following += len(part.tasks)
            yield numbers[part.tasks[0].font.key], part.result

    shapes = Shapes()
    schema = empty_table(plan.spec).schema
    for shard in plan.shards:
        fonts = held.get(shard)
        if fonts is None:
            fonts = write_shard(paths[shard], of_shard(shard), shapes, mark_of(shard, plan), schema)
        elif left and shard.start < left[-1].start:
            add_shapes(paths[shard], shapes)
        for number, of_font in fonts.items():
            totals[number] = totals.get(number, OfFont()).plus(of_font)
    sizes = {shard: store.size(path) for shard, path in paths.items()}
    summary = Summary.of(plan, totals, sizes)
    store.put(f"{out}/{FONTS}", fonts_file(plan, totals))
    store.put(f"{out}/{CARD}", card(plan, summary, schema).encode())
    return summary


def mark_of(shard: Shard, plan: Plan) -> str:
    """What a finished shard has in its footer, and no other file."""
    return f"{plan.digest} {shard.name}"
