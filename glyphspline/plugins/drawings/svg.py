"""SVG drawings as glyphs: the ink that browsers show, y up. What of it is not read is named.

A drawing is a font of one glyph; a folder of drawings is a font of as many glyphs. Drawings written by this package
contain name, code points and metrics. For others the file's name is the glyph's name (``A.svg``, ``uni9F8D.svg``,
``龍.svg``), and the view box gives em, ascender and advance.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any
from unicodedata import category

import numpy as np

from ...errors import FontError, GlyphsplineError, is_positive
from ...outlines.contour_arrays import ContourArrays
from ...outlines.outline import Contours, FontMetrics, Outline
from ...readers.open import Reader, is_xml
from ...readers.pens import ContourPen
from ...readers.source import Location, Source, first_claims, opening
from ...types import Head
from .tree.document import GZIP, LARGEST_FILE, MARKS, parse
from .tree.ink import ink_of
from .tree.lengths import LENGTH, OF_WINDOW, UNITS, Lengths, view_box
from .tree.structure import Structure

FLIP = np.diag([1.0, -1.0, 1.0])


STROKES = "strokes"
"""The named instance of drawings that has their strokes too: ``--strokes``."""
EM = "em"
"""The place of drawings as glyphs of a font with so many units per em."""

PRIVATE, SIGNS = range(0xE000, 0xF900), ("So", "Sk")
"""Code points of private use; and the categories of pictures and of accents that stand alone."""


class SvgDrawings(Source):
    """One SVG file or a folder of them.

    Attributes:
        path: file or folder, as given. face_index: 0. location: strokes at 1, where these are ink too, and the em of a
            font, for which drawings are scaled, stand on the baseline, and have a code point each.
        family, style: the name of the file or folder without suffix, and "Regular".
        metrics: of the first drawing.
        glyph_names: in the order of ``data-gid`` if every drawing has one, else in the order of the files' names. A
            broken drawing has its file's name.
        cmap: code point to glyph.
    """

    format, kind, each_its_em = "SVG", "drawing", True

    def __init__(self, path: Path, location: Location = None) -> None:
        self.path, self.family, self.style = path, path.stem, "Regular"
        self.location, self.instances = place_of(location), {STROKES: {STROKES: 1.0}}
        self._files = drawings_in(path)
        read = list[tuple[str, Outline | FontError]]()
        for file in self._files:
            try:
                one = read_drawing(file, STROKES in self.location, self.location.get(EM))
                read.append((one.name, one))
            except FontError as error:  # raised when the drawing is asked for
                read.append((file.stem, error))
        outlines = [one for _, one in read if isinstance(one, Outline)]
        if not outlines:
            raise next((one for _, one in read if isinstance(one, FontError)), FontError("no SVG drawings"))
        unknown = math.inf if any(outline.gid for outline in outlines) else 0
        self._outlines: dict[str, Outline | FontError] = {}
        for name, found in sorted(read, key=lambda each: each[1].gid if isinstance(each[1], Outline) else unknown):
            if name in self._outlines:
                raise FontError("two drawings of one name", glyph=name)
            self._outlines[name] = found
        self.glyph_names = tuple(self._outlines)
        self.metrics = min(outlines, key=lambda outline: outline.gid).metrics
        self.cmap = first_claims((outline.name, outline.unicodes) for outline in outlines)
        if EM in self.location:
            # Drawings that say their characters are glyphs of a font, which may have none.
            said = {file for file in self._files if b"data-unicodes" in file.read_bytes()}
            of_file = zip(self._files, (found for _, found in read), strict=True)
            icons = [one for file, one in of_file if isinstance(one, Outline) and file not in said]
            free = (code for code in PRIVATE if code not in self.cmap)
            self.assigned = dict(zip(free, sorted(one.name for one in icons if not one.unicodes), strict=False))
            self.cmap = {**self.cmap, **self.assigned}

    def _bytes(self) -> Iterable[bytes]:
        return (file.read_bytes() for file in self._files)

    def _outline(self, head: Head) -> Outline:
        found = self._outlines[head.name]
        if isinstance(found, FontError):
            raise FontError(found.message, font=found.font)
        return replace(found, gid=head.gid, unicodes=head.unicodes if EM in self.location else found.unicodes)


def of_font(outline: Outline, em: float, left: float) -> Outline:
    """A drawing as a glyph of a font of this em.

    It begins where its view box does, at ``left``. Where no more of it is above y = 0 than below, it stands on the
    baseline, as icons do, whose origin is at the top or in the middle.
    """
    scale, metrics = em / outline.metrics.units_per_em, outline.metrics
    up = -metrics.descender if metrics.ascender <= -metrics.descender else 0.0
    points, degrees, offsets, starts = outline.arrays
    arrays = ContourArrays((points + np.array([-left, up])) * scale, degrees, offsets, starts)
    return replace(
        outline, advance=(outline.advance - left) * scale,
        contours=Contours(arrays, outline.repeats), snapped=outline.snapped * scale,
        metrics=FontMetrics(em, (metrics.ascender + up) * scale, (metrics.descender + up) * scale),
    )  # fmt: skip


def place_of(asked: Location) -> Mapping[str, float]:
    """With strokes, of an em, or empty.

    Raises:
        FontError: something else is asked for.
    """
    place = {asked.strip().casefold(): 1.0} if isinstance(asked, str) else {**(asked or {})}
    place.pop("", None)
    if not {*place} <= {STROKES, EM}:
        raise FontError(f"no place {', '.join(place)!r}: a drawing has {STROKES}, which draws these too, and {EM}")
    if not is_positive(place.get(EM, 1.0)):
        raise FontError(f"an em of {place[EM]} units")
    return MappingProxyType({name: value for name, value in place.items() if value})


def read_drawing(file: Path, strokes: bool = False, em: float | None = None) -> Outline:
    """Read one drawing as an outline, y up; its glyph index is ``data-gid``, or 0.

    Args:
        file: the drawing. strokes: whether its strokes are ink, as outlines. em: of a font, for :func:`of_font`.

    Raises:
        GlyphsplineError: the file is too large, not an SVG drawing, or what cannot be bounded.
    """
    with opening(file, "drawing"):
        if file.stat().st_size > LARGEST_FILE:
            raise GlyphsplineError(f"more than {LARGEST_FILE >> 20} MiB")
        document = parse(file.read_bytes())
        root = document.root
        metrics, advance = metrics_of(root)
        structure = Structure(document, view_of(root), strokes)
        shapes = structure.shapes(FLIP @ np.diag([stretch_of(root), 1.0, 1.0]))
        # Distance in em below which points coincide. Drawings may be in metres as well as in pixels.
        pen = ContourPen(coincident=1e-7 * metrics.units_per_em)
        for chain in ink_of(shapes, structure):
            draw_chain(chain.points, chain.degrees, chain.closed, pen)
    unread = structure.unread
    if (font := next(root.iter("font"), None)) is not None:
        unread.add("an SVG font, whose glyphs are not read", document.lines[font])
    name, gid = root.get("data-glyph") or file.stem, int(root.get("data-gid") or 0)
    unicodes = _unicodes(root.get("data-unicodes"), name, em is not None)
    notes = (*pen.notes, *unread.remarks)
    found = Outline(name, gid, unicodes, advance, pen.contours, metrics, notes, pen.snapped, unread.phrases)
    left = 0.0 if root.get("data-units-per-em") else view_of(root)[0] * stretch_of(root)
    return found if em is None else of_font(found, em, left)


def draw_chain(points: Sequence[tuple[float, float]], degrees: Sequence[int], closed: bool, pen: Any) -> None:
    """Draw a contour by its points and the degrees of its segments; an open one ends with ``endPath``."""
    pen.moveTo(points[0])
    at = 1
    for degree in degrees:
        (pen.lineTo, pen.qCurveTo, pen.curveTo)[degree - 1](*points[at : at + degree])
        at += degree
    (pen.closePath if closed else pen.endPath)()


def _unicodes(written: str | None, name: str, is_icon: bool) -> tuple[int, ...]:
    """The characters that a drawing has, or that its name says; names as heart and ring are those of icons, too."""
    if written is not None:
        return tuple(int(code, 16) for code in re.findall(r"U\+([0-9A-Fa-f]{1,6})", written))
    from fontTools import agl

    text = name if len(name) == 1 else agl.toUnicode(name)
    if len(text) != 1 or (is_icon and len(name) > 1 and name.isalpha() and text > "\xff" and category(text) in SIGNS):
        return ()
    return (ord(text),)


def metrics_of(root: Any) -> tuple[FontMetrics, float]:
    """Metrics and advance from ``data-*`` attributes, else from the view box, else from width and height."""
    if root.get("data-units-per-em"):
        keys = ("units-per-em", "ascender", "descender", "advance")
        try:
            em, ascender, descender, advance = (float(root.get(f"data-{key}", "nan")) for key in keys)
        except ValueError:
            em = ascender = descender = advance = math.nan
    else:
        left, top, width, height = view_of(root)
        em, ascender, descender, advance = height, -top, -top - height, (left + width) * stretch_of(root)
    if not (all(map(math.isfinite, (em, ascender, descender, advance))) and em > 0):
        raise GlyphsplineError("a view box or metrics that are no numbers, or of no height")
    return FontMetrics(em, ascender + 0.0, descender + 0.0), advance


def view_of(root: Any) -> tuple[float, float, float, float]:
    """Left, top, width and height of what a drawing shows, in its units: by its view box, else by its size.

    Raises:
        GlyphsplineError: its size is in another unit.
    """
    box = view_box(root.get("viewBox"))
    return box or (0.0, 0.0, pixels(root, "width") or 1000.0, pixels(root, "height") or 1000.0)


def stretch_of(root: Any) -> float:
    """By how much wider than its units a drawing is shown, where its ``preserveAspectRatio`` is none."""
    box = view_box(root.get("viewBox"))
    if (root.get("preserveAspectRatio") or "").split()[:1] != ["none"] or box is None or not min(box[2:]) > 0:
        return 1.0
    width, height = pixels(root, "width"), pixels(root, "height")
    return (width / box[2]) / (height / box[3]) if width and height else 1.0


def pixels(element: Any, name: str) -> float | None:
    """A length of an element, with or without a unit, in CSS pixels; None if it has none, or a share of the page.

    Raises:
        GlyphsplineError: a length in another unit.
    """
    text = element.get(name) or ""
    found = LENGTH.fullmatch(text)
    if found is None or found[2] == "%":
        return None
    if found[2].lower() in OF_WINDOW:
        raise GlyphsplineError(f"its {name} is in {found[2]}: there are {', '.join(UNITS)}em, ex, rem")
    value = Lengths().of(text)
    return value if value is not None and value > 0 else None


def drawings_in(path: Path) -> list[Path]:
    """The drawings of a folder by name, or one alone."""
    return sorted([*path.glob("*.svg"), *path.glob("*.svgz")]) if path.is_dir() else [path]


def _recognises(path: Path, head: bytes) -> bool:
    """Whether a path is a drawing, or a folder that holds some. What else XML may be says its reader."""
    return bool(drawings_in(path)) if path.is_dir() else is_xml(head) or head.startswith((GZIP, *MARKS))


READER = Reader(_recognises, SvgDrawings.opened, has_axes=True, own="svg")
