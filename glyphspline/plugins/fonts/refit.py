"""Outlines of a source fitted and put back, from Python as by the command ``refit``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from ...errors import OptionError, require
from ...hooks import service
from ...readers import Source, open_source
from ...readers.open import reader_of
from ...runs.convert import convert_font
from ...runs.schedule import workers
from .spec import RefitSpec

if TYPE_CHECKING:
    from ...runs.summary import Summary

SMALL, STANDARD = 500.0, 1000.0
"""An em smaller than this has too coarse a grid for curves, and becomes the usual one."""


def refit(
    source: Source | str | Path, out: str | Path | None = None, *, glyphs: Sequence[str] | None = None,
    jobs: int | None = 0, **how: Any,
) -> Summary | Any:  # fmt: skip
    """Fit the outlines of a font, UFO, designspace or Glyphs file, and put them back.

    Args:
        source: open, or its path. out: a folder for what is written; None where outlines go into the source.
        glyphs: names; None: all. jobs: worker processes; None: one a core, 0: none, in this process.
        how: fields of :class:`.RefitSpec`: ``formats`` (of the source itself where none are given and it stays),
            ``in_place``, ``layer``, ``masters``, ``options`` and others.

    Returns:
        A summary of the run: :class:`.Summary`, or of masters :class:`..masters.summary.MastersSummary`.

    Raises:
        OptionError: neither a folder is given nor the source to be changed, or other options are unusable.
        OutputError: the folder or the source cannot be written. FontError: the source cannot be read.

    Example:
        >>> import glyphspline as gs
        >>> gs.refit("fonts_test/kouzan-gyosho.otf", "outputs/new", glyphs=["O"]).statuses["ok"]
        1
    """
    face = source if isinstance(source, Source) else open_source(source)
    spec = RefitSpec(**how)
    if out is None and not spec.is_back:
        raise OptionError("say where outlines go: out, in_place or layer")
    if not (spec.formats or spec.is_back):
        own, in_masters = own_format([face.path], False)
        spec = replace(spec, formats=(own,), masters=spec.masters or (in_masters and not face.location))
    if not face.location and (em := em_of([face.path], spec)) is not None:
        face = open_source(face.path, location={"em": em})
    names = face.glyph_names if glyphs is None else tuple(glyphs)
    with kept(None if out is None else Path(out)) as folder, workers(jobs, kinds=spec.kinds) as pool:
        if spec.masters:
            return service("fit_masters")([face], names, folder, spec, pool)
        return convert_font(face, names, folder, spec, executor=pool)


def own_format(paths: Sequence[Path], become_one: bool) -> tuple[str, bool]:
    """The format of sources themselves, and whether they are of masters; of single fonts that ``become_one``, ttf."""
    readers = {path: reader_of(path) for path in paths}
    found = {
        reader.own if reader else "ttf" if become_one or open_source(path).outer < 0 else "otf"
        for path, reader in readers.items()
    }
    if len(found) > 1:
        raise OptionError(
            f"sources of several kinds, {', '.join(sorted(found))}: refit those of one kind, or say a format"
        )
    return found.pop(), all(reader is not None and reader.has_axes for reader in readers.values())


def em_of(paths: Sequence[Path], spec: RefitSpec, asked: int | None = None) -> float | None:
    """The em to which drawings are scaled that become a font; None: these are none.

    Raises:
        OptionError: one is asked for, and they are none, or it is none of a font.
    """
    readers = [reader_of(path) for path in paths]
    if not {"otf", "ttf", "ufo"}.intersection(spec.formats) or any(r is None or r.own != "svg" for r in readers):
        require(asked is None, "--units-per-em is for drawings that become a font", asked)
        return None
    if asked is not None:
        require(16 <= asked <= 16384, "a font has 16 to 16384 units per em", asked)
        return float(asked)
    em = open_source(paths[0]).metrics.units_per_em
    return em if em >= SMALL else STANDARD


@contextmanager
def kept(out: Path | None) -> Iterator[Path]:
    """The folder of a run; of one that writes into its source, a folder that goes at its end."""
    if out is not None:
        yield out
        return
    with TemporaryDirectory(prefix="glyphspline-") as folder:
        yield Path(folder)
