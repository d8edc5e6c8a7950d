"""The common interface of fonts, UFOs and SVG drawings."""

from __future__ import annotations

import hashlib
import logging
import math
from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, TypeAlias, TypeVar, overload

from ..errors import FontError, GlyphsplineError, words_of
from ..outlines.masters import DesignAxis, Masters
from ..outlines.outline import FontMetrics, Outline
from ..types import Head, counted
from .clusters import mapper_of
from .selection import Request, Selection, select

OutlineOrError: TypeAlias = Outline | GlyphsplineError

Location: TypeAlias = Mapping[str, float] | str | None
"""A location as an argument: axis tag to user-space value, the name of an instance, or None for the default."""

Read = TypeVar("Read")
Own = TypeVar("Own", bound="Source")

log = logging.getLogger(__name__)


class Source(ABC):
    """An opened file of glyphs: a font, a UFO, or a folder of SVG drawings.

    Pickling keeps ``path``, ``face_index`` and ``location`` and opens the source again.

    Attributes:
        path: the file, as given. format: the kind of file.
        kind: what a file that cannot be read is called in its error.
        face_index: which font of a collection; 0 otherwise. num_faces: number of fonts.
        location: place in the design space, axis tag to user-space value; empty at the default.
        axes: of the design space; empty if there is none. Their mappings are known to :meth:`masters`.
        instances: named instances, name to location.
        family, style: never empty.
        metrics: units per em, ascender and descender.
        glyph_names: every glyph, unique, in glyph index order.
        cmap: code point to glyph name. variations: base and selector, two characters, to glyph name; of a font file
            the shaper knows them.
        shaper: HarfBuzz's font at the location, to shape text with; None for a source without tables for shaping.
        each_its_em: whether each glyph has an em of its own.
        assigned: code points of private use that the reader gave to glyphs, to their names.
        outer: the direction in which outer contours run by the rules of the format: 1 counter-clockwise (PostScript),
            -1 clockwise (TrueType), 0 if it has none.
    """

    path: Path
    format: str
    kind = "font"
    face_index: int = 0
    num_faces: int = 1
    location: Mapping[str, float] = MappingProxyType({})
    axes: tuple[DesignAxis, ...] = ()
    instances: Mapping[str, Mapping[str, float]] = MappingProxyType({})
    variations: Mapping[str, str] = MappingProxyType({})
    shaper: Any = None
    outer: int = 0
    each_its_em: bool = False
    assigned: Mapping[int, str] = MappingProxyType({})
    family: str
    style: str
    metrics: FontMetrics
    glyph_names: tuple[str, ...]
    cmap: Mapping[int, str]

    def __repr__(self) -> str:
        name, face = f"{self.family} {self.style}", f", face {self.face_index}" if self.face_index else ""
        place = "".join([f", {tag}={value:g}" for tag, value in self.location.items()])
        counts = f"{counted(len(self.glyph_names), 'glyph')}, {counted(len(self.cmap), 'character')}"
        em = f"{self.metrics.units_per_em:g} units per em"
        return f"<{type(self).__name__} {name!r} from {self.path.name!r}{face}{place}: {counts}, {em}>"

    @classmethod
    def opened(cls: type[Own], path: str | Path, *location: Location) -> Own:
        """Open a file or folder of this kind, at a location if it has axes.

        Raises:
            FontError: it cannot be read, is broken, or has no such axis or instance.
        """
        path = Path(path)
        with opening(path, cls.kind):
            return cls(path, *location)  # type: ignore[call-arg]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).opened, (self.path, dict(self.location)) if self.location else (self.path,)

    @cached_property
    def sha256(self) -> str:
        """Hash of the bytes read, in hexadecimal."""
        digest = hashlib.sha256()
        for part in self._bytes():
            digest.update(part)
        return digest.hexdigest()

    @abstractmethod
    def _bytes(self) -> Iterable[bytes]:
        """What is hashed."""

    @cached_property
    def cap_height(self) -> float | None:
        """Height of H as it is drawn, in font units at the location; without one, as the font says; None: neither."""
        return self._height_of("H", "CAP_HEIGHT")

    @cached_property
    def x_height(self) -> float | None:
        """Height of x, likewise."""
        return self._height_of("x", "X_HEIGHT")

    def _height_of(self, letter: str, tag: str) -> float | None:
        if ord(letter) in self.cmap:
            from fontTools.pens.boundsPen import BoundsPen

            pen = BoundsPen(None)
            self.outline(self.cmap[ord(letter)]).draw(pen)
            if pen.bounds and pen.bounds[3] > 0:
                return float(pen.bounds[3])
        if self.shaper is not None:
            from uharfbuzz import OTMetricsTag

            return float(self.shaper.get_metric_position(OTMetricsTag[tag]) or 0.0) or None
        return None

    def counts(self) -> tuple[int, int]:
        """The numbers of glyphs and of characters."""
        return len(self.glyph_names), len(self.cmap)

    def clamped(self, asked: Location) -> Mapping[str, float]:
        """A location within the limits of the axes, in their order.

        Args:
            asked: axis tag to user-space value, or the name of an instance without regard to case.

        Raises:
            FontError: there is no such axis or instance, or a value is not finite.
        """
        location, known = asked or {}, [axis.tag for axis in self.axes]
        if isinstance(location, str):
            named = [place for name, place in self.instances.items() if name.casefold() == location.strip().casefold()]
            if not named:
                has = f"it has {', '.join(self.instances)}" if self.instances else "it has none"
                raise FontError(f"no named instance {asked!r}: {has}")
            location = named[0]
        for tag, value in location.items():
            if tag not in known:
                has = f"it has {', '.join(known)}" if known else "it is not a variable font"
                raise FontError(f"no axis {tag!r}: {has}")
            if not math.isfinite(value):
                raise FontError(f"axis {tag!r} cannot be at {value}")
        within = {}
        for axis in self.axes:
            if axis.tag in location:
                wanted = float(location[axis.tag])
                within[axis.tag] = value = min(max(wanted, axis.minimum), axis.maximum)
                if value != wanted:
                    limits = f"{axis.minimum:g} to {axis.maximum:g}"
                    log.warning("%s: axis %s goes from %s: %g taken for %g", self.path, axis.tag, limits, value, wanted)
        return MappingProxyType(within)

    def at_location(self, names: Sequence[str]) -> tuple[str, ...]:
        """The glyphs that stand for glyphs at the location by the rules of a source without tables for shaping."""
        return tuple(names)

    def read(self, heads: Sequence[Head]) -> list[OutlineOrError]:
        """Read glyphs of this source; the result has an error in place of each broken glyph."""
        return [attempt(self.path, head.name, partial(self._outline, head)) for head in heads]

    def _outline(self, head: Head) -> Outline:
        """Read one glyph, where :meth:`read` is not overridden."""
        raise NotImplementedError

    def outline(self, name: str) -> Outline:
        """Read the outline of a glyph, components decomposed, at the font's location.

        Raises:
            FontError: the source has no glyph of that name.
            GlyphsplineError: the glyph is broken; the error names file and glyph.
        """
        return self.outlines([name])[0]

    @overload
    def outlines(self, glyphs: Iterable[str | int], *, errors: Literal["raise"] = "raise") -> list[Outline]: ...
    @overload
    def outlines(self, glyphs: Iterable[str | int], *, errors: Literal["return"]) -> list[OutlineOrError]: ...
    def outlines(
        self, glyphs: Iterable[str | int], *, errors: Literal["raise", "return"] = "raise"
    ) -> list[Outline] | list[OutlineOrError]:
        """Read the outlines of many glyphs; the result of a glyph does not depend on the others.

        Args:
            glyphs: names or glyph indices.
            errors: "return" returns errors in place of broken glyphs.

        Raises:
            FontError: the source has no such glyph.
            GlyphsplineError: a glyph is broken; the error names file and glyph.
        """
        heads = [self._head(glyph) for glyph in glyphs]
        read = iter(self.read([head for head in heads if isinstance(head, Head)]))
        found = [next(read) if isinstance(head, Head) else head for head in heads]
        if errors == "return":
            return found
        return [_good(outline) for outline in found]

    def masters(self, name: str) -> Masters:
        """Read a glyph in all masters of a variable font, components decomposed; ``location`` does not matter.

        All masters have the same segments: only those that have no length in all of them are dropped. Without axes
        there is one master.

        Raises:
            FontError: the source has no glyph of that name.
            GlyphsplineError: the glyph is broken, or its masters are unlike; the error names file and glyph.
        """
        head = _good(self._head(name))
        return _good(attempt(self.path, head.name, partial(self._masters, head)))

    def _masters(self, head: Head) -> Masters:
        return Masters.of(self.outline(head.name))

    def _head(self, glyph: str | int) -> Head | FontError:
        if isinstance(glyph, str):
            gid = self.gids.get(glyph, -1)
        else:
            gid = glyph if 0 <= glyph < len(self.glyph_names) else -1
        if gid < 0:
            return FontError("the font has no such glyph", font=str(self.path), glyph=str(glyph))
        name = self.glyph_names[gid]
        return Head(name, gid, self.unicodes.get(name, ()))

    @cached_property
    def gids(self) -> dict[str, int]:
        """Glyph name to glyph index."""
        return {name: gid for gid, name in enumerate(self.glyph_names)}

    @cached_property
    def mapper(self) -> Any:
        """HarfBuzz's font of the characters of a source without ``shaper``: see :func:`.clusters.mapper_of`."""
        return mapper_of(self.cmap, self.variations, self.gids)

    @cached_property
    def unicodes(self) -> dict[str, tuple[int, ...]]:
        """Glyph name to its code points, ascending, of glyphs that have some."""
        codes = defaultdict(list)
        for code, name in sorted(self.cmap.items()):
            codes[name].append(code)  # of one glyph there may be a million
        return {name: tuple(of_name) for name, of_name in codes.items()}

    def select(
        self,
        *,
        text: str | None = None,
        unicodes: Request | None = None,
        glyphs: str | Iterable[str] | None = None,
        gids: Request | None = None,
        all_glyphs: bool = False,
    ) -> Selection:
        """Select glyph names, unique: those of ``text`` in its order, then the others in glyph index order.

        See :func:`.selection.select`, and :meth:`outlines`, which reads them.

        Returns:
            A tuple of names. Its ``missing`` lists what the source does not have.

        Raises:
            FontError: no argument is given, or a string is not a list of numbers.
        """
        try:
            return select(self, text, unicodes, glyphs, gids, all_glyphs)
        except GlyphsplineError as error:
            raise FontError(error.message, font=str(self.path)) from error


def _good(found: Read | GlyphsplineError) -> Read:
    if isinstance(found, GlyphsplineError):
        raise found
    return found


@contextmanager
def opening(path: Path, kind: str = "font") -> Iterator[None]:
    """Turn every exception within into a FontError that names the file."""
    try:
        yield
    except FontError as error:
        error.locate(font=str(path))
        raise
    except GlyphsplineError as error:
        raise FontError(error.message, font=error.font or str(path), glyph=error.glyph) from error
    except OSError as error:
        raise FontError(f"cannot be read: {words_of(error)}", font=str(path)) from error
    except Exception as error:  # broken data raises any of a dozen types, AssertionError among them
        raise FontError(f"a broken {kind}: {library_words(error)}", font=str(path)) from error


@contextmanager
def reusing(path: Path, kind: str = "font") -> Iterator[None]:
    """Turn an unexpected exception within into a FontError: tables that were opened may be broken further inside."""
    try:
        yield
    except (GlyphsplineError, OSError, MemoryError):
        raise
    except Exception as error:  # as in opening
        raise FontError(f"a broken {kind}: {library_words(error)}", font=str(path)) from error


def attempt(path: Path, name: str, read: Callable[[], Read]) -> Read | GlyphsplineError:
    """What ``read`` returns of a glyph; if it raises, an error that names file and glyph."""
    try:
        return read()
    except GlyphsplineError as error:
        return error.locate(font=str(path), glyph=name)
    except Exception as error:  # as in opening
        found = GlyphsplineError(f"cannot be drawn: {library_words(error)}", font=str(path), glyph=name)
        found.__cause__ = error
        return found


def parsed(document: bytes) -> Any:
    """Parse an XML document and return its root. Entities are refused: they can expand without bound or read files.

    Raises:
        GlyphsplineError: the document declares entities, or is not XML.
    """
    from defusedxml.common import DefusedXmlException
    from defusedxml.ElementTree import fromstring

    try:
        return fromstring(document)
    except DefusedXmlException as error:
        raise GlyphsplineError("its XML declares entities, which are refused") from error
    except SyntaxError as error:
        raise GlyphsplineError(f"not well-formed XML: {error}") from error


def first_claims(unicodes: Iterable[tuple[str, Iterable[int]]]) -> Mapping[int, str]:
    """Code point to the first glyph that has it, from the code points of each glyph."""
    found: dict[int, str] = {}
    for name, codes in unicodes:
        for code in codes:
            found.setdefault(code, name)
    return MappingProxyType(found)


def library_words(error: Exception) -> str:
    """The message of a library's exception, or its type if it has none."""
    if isinstance(error, RecursionError):
        return "components or subroutines nested without end"
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


def tags_of(source: Any, axis: str | None = None) -> list[str]:
    """The tags of a source's axes.

    Raises:
        GlyphsplineError: the source is not variable, or has no such axis.
    """
    tags = [of_font.tag for of_font in source.axes]
    if not tags:
        raise GlyphsplineError("not a variable font: it has no axes", font=str(source.path))
    if axis is not None and axis not in tags:
        raise GlyphsplineError(f"no axis {axis!r}: it has {', '.join(tags)}", font=str(source.path))
    return tags
