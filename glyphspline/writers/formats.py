"""Formats: a glyph or a text as a file, and a font as one, by name. Plug-ins add theirs.

Formats are found by name in one table, ``OURS``; only for a name that is not in it plug-ins are asked.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from .. import hooks
from ..errors import GlyphsplineError, OptionError, require
from ..extras import EXTRAS
from .settings import Settings

if TYPE_CHECKING:
    from pathlib import Path

    from ..fitting.options import Options
    from ..fitting.results import GlyphResult
    from ..readers import Source

_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_SUFFIX = re.compile(r"(\.[A-Za-z0-9]+)+")


@dataclass(frozen=True)
class Format:
    """A format with one file a glyph, or a text.

    Attributes:
        name: as in ``--format``; also the folder's: lower-case letters, digits, hyphens.
        suffix: of its files, with the dot.
        write: the file of a result, as bytes or text in UTF-8; the same bytes at every call.
        extra: the extra of pyproject.toml that it needs.
        fitted: False if it shows the outline as the font has it. In a run of such formats alone nothing is fitted:
            curves of results are the source's contours, without polygons, interpolations and measures.

    Raises:
        OptionError: a name or suffix of other characters, or an unknown extra.
    """

    name: str
    suffix: str
    write: Callable[[GlyphResult, Settings], str | bytes]
    extra: str | None = None
    fitted: bool = True

    def __post_init__(self) -> None:
        name, suffix = self.name, self.suffix
        good = isinstance(name, str) and _NAME.fullmatch(name) is not None
        require(good, "the name of a format has lower-case letters, digits and hyphens", name)
        good = isinstance(suffix, str) and _SUFFIX.fullmatch(suffix) is not None
        require(good, "the suffix of a format is like '.svg'", suffix)
        require(callable(self.write), "a format writes with a function", self.write)
        require(self.extra is None or self.extra in EXTRAS, f"extra is one of {', '.join(EXTRAS)}", self.extra)


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
    def kept(self, path: Path, mark: str) -> KeptRows:
        """The rows that there are already for a table, of a run with that mark."""

    @abstractmethod
    def forget(self, folder: Path) -> None:
        """Remove what is kept in a run's folder for a table that is not whole."""


class KeptRows(Protocol):
    """The rows of a table in the making.

    Attributes:
        added: whether there are some that the table does not have.
    """

    added: bool

    def __contains__(self, gid: object) -> bool:
        """Whether the rows of a glyph are there."""

    def add(self, rows: bytes) -> None:
        """Keep the rows of some glyphs."""

    def write(self, gids: Iterable[int]) -> int:
        """Write the table anew with the rows of these glyphs; returns their number."""


def whole_named(name: str) -> WholeFormat | None:
    """The format with one file a font of that name; None if there is none."""
    found: WholeFormat | None = hooks.find("whole", name)
    return found


def format_named(name: str) -> Format:
    """The format of that name: the pipeline's, or a plug-in's.

    Raises:
        OptionError: there is none; the message lists all there are.
        GlyphsplineError: the plug-in cannot be loaded, or has no format of that name there.
    """
    if name in OURS:
        return OURS[name]
    found = hooks.find("formats", name)
    if found is None:
        raise OptionError(f"no format {name}: there are {', '.join(format_names())}{hooks.away_words()}")
    if not isinstance(found, Format) or found.name != name:
        raise GlyphsplineError(f"the plug-in for format {name!r} has {found!r} in its place")
    return found


def formats() -> tuple[Format, ...]:
    """All formats with one file a glyph: the pipeline's, then those of plug-ins by name.

    Raises:
        GlyphsplineError: a plug-in cannot be loaded.
    """
    return tuple(format_named(name) for name in format_names())


def format_names() -> tuple[str, ...]:
    """The names of all formats; none is imported."""
    return (*OURS, *(name for name in hooks.names("formats") if name not in OURS))


def is_format(name: str) -> bool:
    """Whether there is a format of that name; none is imported."""
    return name in OURS or name in hooks.names("formats")


def _lazy(place: str, *more: Any) -> Callable[[GlyphResult, Settings], str | bytes]:
    """A function that is imported when it is first called: a run imports only what it writes with."""
    module, name = place.split(":")

    def write(result: GlyphResult, settings: Settings, **how: Any) -> str | bytes:
        written: str | bytes = getattr(import_module(f".{module}", __package__), name)(result, settings, *more, **how)
        return written

    return write


OURS = {each.name: each for each in (
    Format("source", ".svg", _lazy("svg.document:write_source"), fitted=False),
    Format("svg", ".svg", _lazy("svg.document:write_svg")),
    Format("curvature", ".svg", _lazy("svg.curvature_map:write_map")),
    Format("png", ".png", _lazy("figures.drawings:write_drawing", "png")),
    Format("pdf", ".pdf", _lazy("figures.drawings:write_drawing", "pdf")),
    Format("curvature-png", ".png", _lazy("figures.drawings:write_map", "png")),
    Format("curvature-pdf", ".pdf", _lazy("figures.drawings:write_map", "pdf")),
    Format("json", ".json", _lazy("json_file:json_text")),
)}  # fmt: skip
"""The pipeline's formats by name, in the order in which a run writes and lists them."""
