"""Drawings rewritten in workers: into themselves or a folder, and what is said of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import GlyphsplineError, OptionError, OutputError
from ...files import make_folder, write_whole
from ...fitting.options import Options
from ...readers.source import opening
from ...runs.engine import Item, Job, reason, run
from ...runs.schedule import workers
from ...runs.spec import kinds_for
from ...types import counted, shortened
from .rewrite import Rewritten, rewritten
from .svg import drawings_in
from .tree.document import LARGEST_FILE

if TYPE_CHECKING:
    from ...cli.arguments import RunOptions

NAMED = 5
"""Drawings named one by one."""


@dataclass(frozen=True)
class DrawingsJob(Job[Path, list[Rewritten | str]]):
    """Drawings rewritten; of one that cannot be read, why."""

    options: Options

    chunk = 8
    budget = 20_000

    def item(self, task: Path) -> Item | Exception:
        """The bytes of a drawing; about twenty of them are a segment."""
        if task.stat().st_size > LARGEST_FILE:
            return GlyphsplineError(f"more than {LARGEST_FILE >> 20} MiB")
        data = task.read_bytes()
        return Item(data, len(data) / 20)

    def together(self, tasks: Sequence[Path], contents: Sequence[Any]) -> list[Rewritten | str]:
        """Rewrite drawings."""
        found: list[Rewritten | str] = []
        for task, data in zip(tasks, contents, strict=True):
            with opening(task, "drawing"):
                found.append(rewritten(data, self.options))
        return found

    def failed(self, task: Path, error: Exception) -> list[Rewritten | str]:
        """Why a drawing could not be read."""
        return [reason(error)]


def refit_drawings(paths: Sequence[Path], options: Options, out: Path | None, how: RunOptions) -> bool:
    """Rewrite drawings with the fewest segments; returns whether something could not be read.

    Args:
        paths: drawings, and folders of them. options: see :func:`.rewrite.rewritten`.
        out: the folder; None writes into the drawings themselves. how: the command runs, and what it prints.

    Raises:
        OptionError: options of other curves, or two drawings of one name. OutputError: a file cannot be written.
        GlyphsplineError: a drawing alone cannot be read.
    """
    from ...cli.messages import print_json, progress, say

    if not options.is_for_fonts or options.remove_overlaps:
        raise OptionError(
            "drawings have the fewest segments with --continuity g2 and --corners sharp; convert draws others"
        )
    targets = targets_of([file for path in paths for file in drawings_in(path)], out)
    files = [*targets]
    found: dict[Path, Rewritten | str] = {}
    jobs = None if how.scheduler else how.processes
    with (
        workers(jobs, kinds=[*kinds_for(options), "distances"], expected=1, scheduler=how.scheduler) as pool,
        progress(how.quiet, json_lines=how.as_json) as observer,
    ):
        for part in run(
            DrawingsJob(options), [file.absolute() for file in files], pool, ordered=True, observer=observer
        ):
            for one in part.result:
                file = files[len(found)]
                found[file] = one
                if isinstance(one, Rewritten) and (out is not None or one.changed):
                    write_whole(str(targets[file]), one.data, durable=True)
    if len(files) == 1 and isinstance(only := found[files[0]], str):
        raise GlyphsplineError(only, font=str(files[0]))
    if how.as_json:
        print_json(facts(found))
    for line in () if how.quiet or how.as_json else lines(found):
        say(line)
    return any(isinstance(one, str) or one.unread for one in found.values())


def targets_of(files: Sequence[Path], out: Path | None) -> dict[Path, Path]:
    """Where drawings are written: by their names into a folder, or None for themselves."""
    if out is None:
        return {file: file for file in files}
    targets = {file: out / file.name for file in files}
    if len({*targets.values()}) < len(files):
        raise OptionError("--out takes no two drawings of one name")
    make_folder(out)
    if any(target.exists() and target.samefile(file) for file, target in targets.items()):
        raise OutputError("holds the drawings themselves: --in-place writes into these", font=str(out))
    return targets


def lines(found: Mapping[Path, Rewritten | str]) -> Iterator[str]:
    """What became of drawings, in words: the first few, then all together; what could not be read comes last."""
    done = {file: one for file, one in found.items() if isinstance(one, Rewritten)}
    each = [f"{file.name}: {words(one)}" for file, one in done.items()]
    yield from shortened(each, NAMED, "{} more drawings")
    if len(done) > 1:
        before, after = (sum(one.segments[k] for one in done.values()) for k in range(2))
        yield f"{len(done)} drawings: {before:,} → {after:,} segments"
    unread = [f"{file.name}: {one}" for file, one in found.items() if isinstance(one, str)]
    unread += [f"{file.name}: a path cannot be read: {why}" for file, one in done.items() for why in one.unread]
    yield from (f"failed: {line}" for line in shortened(unread, NAMED, "{} more, which --json lists"))


def words(one: Rewritten) -> str:
    """What became of a drawing."""
    before, after = one.segments
    return f"{one.changed} of {counted(one.paths, 'path')} rewritten, {before:,} → {after:,} segments"


def facts(found: Mapping[Path, Rewritten | str]) -> dict[str, Any]:
    """The same as JSON data."""
    drawings = []
    for file, one in found.items():
        known: dict[str, Any] = {"drawing": str(file), "error": one if isinstance(one, str) else None}
        if isinstance(one, Rewritten):
            before, after = one.segments
            known |= {"paths": one.paths, "rewritten": one.changed, "segments": after, "source_segments": before}
            known |= {"bytes": len(one.data), "unread": list(one.unread)}
        drawings.append(known)
    return {"drawings": drawings}
