"""SVG drawings as glyphs: filled paths and shapes, their path data parsed by svgpathtools, transforms applied, y up.

A drawing is a font of one glyph; a folder of drawings is a font of as many glyphs. Drawings written by this package
contain name, code points and metrics. For others the file's name is the glyph's name (``A.svg``, ``uni9F8D.svg``,
``龍.svg``), and the view box gives em, ascender and advance.
"""

from __future__ import annotations

import math
import re
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import FontError, GlyphsplineError
from ...outlines.outline import FontMetrics, Outline
from ...readers.open import Reader, is_xml
from ...readers.pens import ContourPen
from ...readers.source import Source, first_claims, opening, parsed
from ...types import INCHES, FloatArray, Head

LARGEST_FILE = 1 << 26
"""Limit of bytes of one drawing."""

DEEPEST = 200
"""Limit of nested groups, far above any real drawing."""

ARC = 45.0
"""Degrees of an elliptic arc that become one cubic, with an error of 4e-6 of the radius."""

NOT_DRAWN = {"defs", "clipPath", "mask", "symbol", "pattern", "marker", "metadata", "title", "desc", "style", "text"}
LEFT_OUT = {"use": "clones (use)", "image": "images", "text": "text"}

FLIP = np.diag([1.0, -1.0, 1.0])


class SvgDrawings(Source):
    """One SVG file or a folder of them.

    Attributes:
        path: file or folder, as given. face_index, location: 0 and empty.
        family, style: the name of the file or folder without suffix, and "Regular".
        metrics: of the first drawing.
        glyph_names: in the order of ``data-gid`` if every drawing has one, else in the order of the files' names. A
            broken drawing has its file's name.
        cmap: code point to glyph.
    """

    format, kind, each_its_em = "SVG", "drawing", True

    def __init__(self, path: Path) -> None:
        self.path, self.family, self.style = path, path.stem, "Regular"
        self._files = sorted(path.glob("*.svg")) if path.is_dir() else [path]
        read = list[tuple[str, Outline | FontError]]()
        for file in self._files:
            try:
                one = read_drawing(file)
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

    def _bytes(self) -> Iterable[bytes]:
        return (file.read_bytes() for file in self._files)

    def _outline(self, head: Head) -> Outline:
        found = self._outlines[head.name]
        if isinstance(found, FontError):
            raise FontError(found.message, font=found.font)
        return replace(found, gid=head.gid)


def read_drawing(file: Path) -> Outline:
    """Read one drawing as an outline, y up; its glyph index is ``data-gid``, or 0.

    Raises:
        GlyphsplineError: the file is too large, not an SVG drawing, or declares entities.
    """
    with opening(file, "drawing"):
        root = svg_root(file)
        metrics, advance = metrics_of(root)
        # Distance in em below which points coincide. Drawings may be in metres as well as in pixels.
        pen = ContourPen(coincident=1e-7 * metrics.units_per_em)
        left_out: Counter[str] = Counter()
        for element, matrix, filled in shapes(root, FLIP, True, left_out):
            if filled:
                draw_path(path_data(element), matrix, pen)
            else:
                left_out["shapes without fill (strokes are not read)"] += 1
    name, gid = root.get("data-glyph") or file.stem, int(root.get("data-gid") or 0)
    unicodes = _unicodes(root.get("data-unicodes"), name)
    notes = (*pen.notes, *(f"{count} {kind} left out" for kind, count in left_out.items()))
    return Outline(name, gid, unicodes, advance, pen.contours, metrics, notes, pen.snapped)


def svg_root(file: Path) -> Any:
    """The root element of an SVG document.

    Raises:
        GlyphsplineError: the file is too large, not an SVG drawing, or declares entities.
    """
    if file.stat().st_size > LARGEST_FILE:
        raise GlyphsplineError(f"more than {LARGEST_FILE >> 20} MiB")
    root = parsed(file.read_bytes())
    if root.tag.rpartition("}")[2] != "svg":
        raise GlyphsplineError("not an SVG drawing")
    return root


def _unicodes(written: str | None, name: str) -> tuple[int, ...]:
    if written is not None:
        return tuple(int(code, 16) for code in re.findall(r"U\+([0-9A-Fa-f]{1,6})", written))
    from fontTools import agl

    text = name if len(name) == 1 else agl.toUnicode(name)
    return (ord(text),) if len(text) == 1 else ()


def metrics_of(root: Any) -> tuple[FontMetrics, float]:
    """Metrics and advance from ``data-*`` attributes, else from the view box, else from width and height."""
    if root.get("data-units-per-em"):
        keys = ("units-per-em", "ascender", "descender", "advance")
        em, ascender, descender, advance = (float(root.get(f"data-{key}", "nan")) for key in keys)
    else:
        box = view_box(root) or (0.0, 0.0, pixels(root, "width") or 1000.0, pixels(root, "height") or 1000.0)
        left, top, width, height = box
        em, ascender, descender, advance = height, -top, -top - height, left + width
    if not (all(map(math.isfinite, (em, ascender, descender, advance))) and em > 0):
        raise GlyphsplineError("a view box or metrics that are no numbers, or of no height")
    return FontMetrics(em, ascender + 0.0, descender + 0.0), advance


def view_box(element: Any) -> tuple[float, float, float, float] | None:
    """Left, top, width and height of an element's ``viewBox`` in user units; None without one."""
    box = [float(part) for part in element.get("viewBox", "").replace(",", " ").split()]
    return (box[0], box[1], box[2], box[3]) if len(box) == 4 else None


def pixels(element: Any, name: str) -> float | None:
    """A length of an element, with or without a unit, in CSS pixels; None if it has none, or a share of the page.

    Raises:
        GlyphsplineError: a length in another unit.
    """
    found = re.match(r"\s*([0-9.]+(?:[eE][+-]?[0-9]+)?)\s*([A-Za-z%]*)", element.get(name, ""))
    if found is None or found[2] == "%":
        return None
    if found[2] and found[2].lower() not in INCHES:
        raise GlyphsplineError(f"its {name} is in {found[2]}: there are {', '.join(INCHES)}")
    return float(found[1]) * (INCHES[found[2].lower() or "px"] / INCHES["px"])


def viewport(element: Any) -> FloatArray:
    """(3, 3) from the user units within an ``svg`` element to those around it, CSS pixels at the root.

    Without a width or height, or without a view box, they are the same.
    """
    x, y = (pixels(element, name) or 0.0 for name in ("x", "y"))
    box, width, height = view_box(element), pixels(element, "width"), pixels(element, "height")
    if box is None or not (width or height) or min(box[2:]) <= 0:
        return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])
    width, height = width or height / box[3] * box[2], height or width / box[2] * box[3]  # type: ignore[operator]
    across, down = width / box[2], height / box[3]
    align, _, fit = (element.get("preserveAspectRatio") or "xMidYMid").strip().partition(" ")
    if align != "none":
        across = down = max(across, down) if fit.strip() == "slice" else min(across, down)
    shares = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    x += (width - across * box[2]) * shares.get(align[1:4], 0.0) - across * box[0]
    y += (height - down * box[3]) * shares.get(align[5:8], 0.0) - down * box[1]
    return np.array([[across, 0.0, x], [0.0, down, y], [0.0, 0.0, 1.0]])


def shapes(
    element: Any, matrix: FloatArray, filled: bool, left_out: Counter[str], depth: int = 0
) -> Iterator[tuple[Any, FloatArray, bool]]:
    """Each shape with the (3, 3) matrix to font space, and whether it is filled."""
    if depth > DEEPEST:
        raise GlyphsplineError(f"groups nested more than {DEEPEST} deep")
    if not isinstance(element.tag, str):
        return  # a comment
    tag, style = element.tag.rpartition("}")[2], styles(element)
    if tag in LEFT_OUT:
        left_out[LEFT_OUT[tag]] += 1
    if tag in NOT_DRAWN or style.get("display") == "none":
        return
    if element.get("transform"):
        matrix = matrix @ _transform(element.get("transform"))
    if tag == "svg" and depth:
        matrix = matrix @ viewport(element)
    filled = style["fill"] not in ("none", "transparent") if "fill" in style else filled
    if tag in ("path", "rect", "circle", "ellipse", "polygon", "polyline"):
        yield element, matrix, filled
    for child in element:
        yield from shapes(child, matrix, filled, left_out, depth + 1)


def _transform(text: str) -> FloatArray:
    """The (3, 3) matrix of a transform attribute."""
    from svgpathtools.parser import parse_transform  # imports SciPy, which fonts do not need

    with warnings.catch_warnings():
        warnings.simplefilter("error")  # what is skipped otherwise
        try:
            return np.asarray(parse_transform(text), dtype=np.float64)
        except Warning as warning:
            raise GlyphsplineError(f"a transform that cannot be read: {text[:40]}") from warning


def styles(element: Any) -> dict[str, str]:
    """``fill`` and ``display`` from the style attribute, else from the attributes of these names."""
    found = {name: element.get(name).strip() for name in ("fill", "display") if element.get(name)}
    for item in (element.get("style") or "").split(";"):
        name, colon, value = item.partition(":")
        if colon and name.strip() in ("fill", "display"):
            found[name.strip()] = value.strip()
    return found


def path_data(element: Any) -> str:
    """A shape as path data, which begins and runs as SVG 2 has it for the shape."""
    tag = element.tag.rpartition("}")[2]
    if tag == "path":
        return str(element.get("d") or "")
    if tag == "rect":
        from svgpathtools.svg_to_paths import rect2pathd  # as above

        return str(rect2pathd(dict(element.attrib)))
    if tag in ("circle", "ellipse"):
        cx, cy = float(element.get("cx", 0)), float(element.get("cy", 0))
        rx, ry = (float(element.get(key)) for key in (("r", "r") if tag == "circle" else ("rx", "ry")))
        ends = ((cx, cy + ry), (cx - rx, cy), (cx, cy - ry), (cx + rx, cy))
        return f"M{cx + rx!r},{cy!r}" + "".join([f"A{rx!r},{ry!r} 0 0 1 {x!r},{y!r}" for x, y in ends]) + "Z"
    points = element.get("points") or ""
    return f"M{points}{'Z' if tag == 'polygon' else ''}" if points.strip() else ""


def draw_path(data: str, matrix: FloatArray, pen: Any) -> tuple[int, int]:
    """Draw path data subpath by subpath: svgpathtools would join two that meet in a point.

    An open subpath ends with ``endPath``. Returns the number of segments, with lines that close, and of open subpaths.
    """
    from svgpathtools import Arc, parse_path  # as above

    (a, b, x), (c, d, y) = matrix[:2].tolist()

    def placed(points: Sequence[complex]) -> list[tuple[float, float]]:
        return [(a * p.real + b * p.imag + x, c * p.real + d * p.imag + y) for p in map(complex, points)]

    here, segments, left_open = 0j, 0, 0
    for subpath in re.findall(r"[Mm][^Mm]*", data):
        numbers = re.findall(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?", subpath)
        if len(numbers) < 2:
            raise GlyphsplineError("path data that begins nowhere")
        start = complex(float(numbers[0]), float(numbers[1])) + (here if subpath[0] == "m" else 0)
        pen.moveTo(placed([start])[0])
        end = start
        for segment in parse_path(subpath, current_pos=here):
            for to in arc_cubics(segment) if isinstance(segment, Arc) else [segment.bpoints()[1:]]:
                (pen.lineTo, pen.qCurveTo, pen.curveTo)[len(to) - 1](*placed(to))
            end, segments = segment.end, segments + 1
        closed = subpath.rstrip(" \t\r\n\f,").endswith(("Z", "z"))
        (pen.closePath if closed else pen.endPath)()
        left_open += not closed
        here = start if closed else end
    return segments, left_open


def arc_cubics(arc: Any) -> Iterator[list[complex]]:
    """The three points that each cubic of an elliptic arc adds."""
    pieces = max(1, int(np.ceil(abs(arc.delta) / ARC)))
    handle = 4 / 3 * np.tan(np.radians(arc.delta) / pieces / 4) / np.radians(arc.delta)
    for k in range(pieces):
        t0, t1 = k / pieces, (k + 1) / pieces
        start, end = arc.point(t0), arc.point(t1)
        yield [start + handle * arc.derivative(t0), end - handle * arc.derivative(t1), end]


def _recognises(path: Path, head: bytes) -> bool:
    """Whether a path is a drawing, or a folder that holds some. What else XML may be says its reader."""
    return next(path.glob("*.svg"), None) is not None if path.is_dir() else is_xml(head)


READER = Reader(_recognises, lambda path, location: SvgDrawings.opened(path), own="svg")
