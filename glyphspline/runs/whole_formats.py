"""Formats with one file a font, which a run writes at its end: fonts and sources of results, tables of rows."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from .. import hooks

if TYPE_CHECKING:
    from ..errors import GlyphsplineError
    from ..fitting.options import Options
    from ..fitting.results import GlyphResult
    from ..outlines.outline import Outline
    from ..readers import Source


class WholeFormat(ABC):
    """A format with one file a font, which a run writes at its end from all glyphs of its folder.

    Attributes:
        name: as in ``--format``; also the file's suffix. extra: the extra of pyproject.toml that it needs.
        verb: the command that writes it. always: whether it is written again where nothing is left to do.
    """

    name: ClassVar[str]
    extra: ClassVar[str | None] = None
    verb: ClassVar[str] = "convert"
    always: ClassVar[bool] = False

    def check(self, source: Source) -> None:  # noqa: B027 -- most sources can
        """Raise a GlyphsplineError before the run if a source cannot become such a file."""

    def refused(self, outline: Outline) -> GlyphsplineError | None:
        """Why a glyph cannot be in such a file; None of most."""
        return None

    def path(self, source: Source, out: Path) -> Path:
        """The file in a run's folder."""
        stem = re.sub(r"[^\w-]+", "", source.family)[:50] or "font"
        return out / f"{stem}-spline.{self.name}"

    def is_fitted(self, options: Options) -> bool:
        """Whether it is made of fitted curves."""
        return True

    def share(self, options: Options, tolerance: float) -> float:
        """What of a tolerance is left for the fit, in font units: writing the file may take the rest."""
        return tolerance


class ResultsFormat(WholeFormat):
    """One that is made of results, which the run stores."""

    @abstractmethod
    def write(
        self, source: Source, glyphs: Iterator[GlyphResult], path: Path, spec: Any
    ) -> tuple[list[str], Mapping[str, Any]]:
        """Write the file; returns remarks, and what it holds of glyphs by name. ``spec`` is the run's.

        Args:
            spec: of the run, as its command has it: a :class:`.runs.spec.RunSpec`.

        Raises:
            OutputError: it cannot be written. GlyphsplineError: the source cannot become such a file.
        """


class TableFormat(WholeFormat):
    """One of rows, which the run keeps batch by batch."""

    @abstractmethod
    def rows(self, font: tuple[str, str], glyphs: Sequence[GlyphResult]) -> bytes:
        """The rows of some glyphs of a font with this family and style."""

    @abstractmethod
    def held(self, path: Path) -> Container[int]:
        """Indices of the glyphs that have rows in a table; a file that is no such table has none."""

    @abstractmethod
    def write(self, path: Path, places: Iterable[tuple[int, int | None]], rows: Callable[[int], bytes]) -> int:
        """Write a table anew; returns the number of its rows.

        Args:
            places: index of each glyph, ascending, and number of the batch that has its rows; None: those that the
                table has. rows: the rows of a batch.
        """


def whole_named(name: str) -> WholeFormat | None:
    """The format with one file a font of that name; None if there is none."""
    found: WholeFormat | None = hooks.find("whole", name)
    return found
