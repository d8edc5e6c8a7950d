"""The paths of an SVG drawing with the fewest segments: their ``d`` is written anew, and no other byte of the file.

Each path is fitted in its own units, which its transforms scale, on a grid as fine as the tolerance there. A path stays
the same curve, in the shortest form, if its fit is not within the tolerance, has no fewer segments, or is longer text.
What a fit does not serve keeps its ``d``: paths with open subpaths, markers, dashes or children; what is drawn in an
unknown size: paths of clips, masks and the like.
"""

from __future__ import annotations

import gzip
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil, isfinite, log10
from typing import Any, NamedTuple
from xml.parsers import expat

import numpy as np

from ...errors import GlyphsplineError
from ...fitting.options import Options
from ...outlines.outline import Contours, FontMetrics, Outline
from ...readers.pens import ContourPen
from ...runs.spec import LIMITS
from ...types import FloatArray
from .svg import FLIP, draw_chain, metrics_of, view_of
from .tree.document import GZIP, Document, parse, unpacked
from .tree.lengths import Lengths, view_box
from .tree.painted import Place, placed
from .tree.path_data import parsed_path
from .tree.structure import Structure

AT_NODES = re.compile(r"marker|stroke-dash")
"""What of a style is drawn at the nodes of a path, or from its first one on."""

PASSES = 6
"""Most fits of a path, each of what the one before made. A third seldom finds more."""

TAG = re.compile(rb"<[^\s/>\0]+")
ATTRIBUTE = re.compile(rb"""\s+([^\s=>/]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")


class Path(NamedTuple):
    """A path of a drawing: its element, from its units to those that the em is in, and that em."""

    element: Any
    matrix: FloatArray
    em: float


@dataclass(frozen=True)
class Rewritten:
    """A drawing with other path data.

    Attributes:
        data: the file. paths, changed: numbers of all paths and of those that changed.
        segments: of all that could be read, before and after. unread: why others could not.
    """

    data: bytes
    paths: int
    changed: int
    segments: tuple[int, int]
    unread: tuple[str, ...]


def rewritten(data: bytes, options: Options) -> Rewritten:
    """A drawing whose paths have the fewest segments within the tolerance.

    Args:
        data: the file. options: of continuity "g2"; the tolerance is in user units of the drawing, whose height is the
            em; a precision of 0 decimals stands for as many as each path takes.

    Raises:
        GlyphsplineError: not an SVG drawing, or in an encoding unlike ASCII.
    """
    packed, data = data.startswith(GZIP), unpacked(data)
    document = parse(data)
    places = dict(zip(document.root.iter(), places_of(data), strict=True))
    edits, unread, paths, before, after = list[tuple[int, int, str]](), list[str](), 0, 0, 0
    for path in paths_of(document):
        paths += 1
        try:
            old, outline = outline_of(path)
        except GlyphsplineError as error:
            unread.append(error.message)
            continue
        new = None if outline is None else shortest(outline, old, path, options)
        before, after = before + old, after + (new[0] if new else old)
        if new:
            edits.append((*places[path.element], new[1]))
    ends = [(0, 0, ""), *sorted(edits), (len(data), len(data), "")]
    new_data = b"".join([data[a[1] : b[0]] + b[2].encode() for a, b in pairwise(ends)])
    new_data = gzip.compress(new_data, mtime=0) if packed else new_data
    return Rewritten(new_data, paths, len(edits), (before, after), tuple(unread))


def paths_of(document: Document) -> Iterator[Path]:
    """The paths that are drawn, clones left out, and those of symbols with a view box, which is their em."""
    root = document.root
    structure, em = Structure(document, view_of(root)), metrics_of(root)[0].units_per_em
    lengths = Lengths(*view_of(root)[2:])
    drawn = [(structure.draw(root, Place(np.eye(3), None, lengths, mode="own")), em)]
    for symbol in root.iter("symbol"):
        if box := view_box(symbol.get("viewBox")):
            place = Place(np.eye(3), structure.style_of(symbol), Lengths(box[2], box[3]), mode="own")
            drawn.append(([shape for child in symbol for shape in structure.draw(child, place)], box[3]))
    for shapes, own_em in drawn:
        for shape in shapes:
            if shape.element.tag == "path" and shape.element.get("d"):
                yield Path(shape.element, shape.matrix, own_em)


def outline_of(path: Path) -> tuple[int, Outline | None]:
    """The number of a path's segments, and its outline in its own units, y up; None of one that keeps its ``d``.

    Raises:
        GlyphsplineError: it cannot be read, or is too large.
    """
    scale = float(np.linalg.norm(path.matrix[:2, :2], 2))
    em = path.em / scale if scale > 0 else 0.0
    pen = ContourPen(coincident=1e-7 * em)
    path_data, error_at = parsed_path(path.element.get("d"))
    if error_at is not None:
        raise GlyphsplineError(f"path data with an error at character {error_at + 1}")
    for subpath in path_data:
        draw_chain(placed(subpath.points, FLIP), subpath.degrees, subpath.closed, pen)
    segments, left_open = sum(each.written for each in path_data), not all(each.closed for each in path_data)
    if error := LIMITS.error_of(segments):
        raise error
    styled = " ".join([*path.element.attrib, path.element.get("style", "")])
    stays = left_open or pen.left_out or len(path.element) or AT_NODES.search(styled)
    if stays or not (em > 0 and isfinite(em)):
        return segments, None
    outline = Outline("path", contours=pen.contours, metrics=FontMetrics(em, em, 0.0), snapped=pen.snapped)
    return segments, outline


def shortest(outline: Outline, old: int, path: Path, options: Options) -> tuple[int, str] | None:
    """The number of segments and the path data of a fit, or of the path as it is in fewer characters; else None."""
    fit, same = fitted(outline, old, path, options), unchanged(outline, old)
    before = len(path.element.get("d"))
    least = min(before, len(same[1]) if same else before)
    if fit and len(fit[1]) <= least:
        return fit
    return same if same and least < before else None


def unchanged(outline: Outline, old: int) -> tuple[int, str] | None:
    """The path as it is, in the shortest form; None if it has arcs, or more decimals than 9."""
    from ...writers.svg.path_data import curves_data

    for precision in range(10):
        if np.array_equal(np.round(outline.arrays.points, precision), outline.arrays.points):
            return old, curves_data(outline.arrays, precision)[0].text
    return None


def fitted(outline: Outline, old: int, path: Path, options: Options) -> tuple[int, str] | None:
    """The number of segments of a fit and its path data; None if it has no fewer, or is not within the tolerance.

    What was fitted is fitted again while that takes segments away. Each time it is compared with the path as it was.
    """
    from ...fitting.convert import convert
    from ...outlines.outline_distance import BOUND, chains_of, outline_distance
    from ...writers.svg.path_data import curves_data

    em, arrays = outline.metrics.units_per_em, outline.arrays
    tolerance = options.tolerance_for(path.em) * em / path.em
    precision = options.precision or decimals(tolerance)
    if precision > 9:
        return None
    options, found = replace(options, tolerance=tolerance, precision=precision), None
    for _ in range(PASSES):
        try:
            result = convert(outline, options)
        except GlyphsplineError:
            break
        curves = result.arrays.curves
        curves = curves._replace(points=np.round(curves.points, precision))
        if len(curves.degrees) >= old or curves.num_contours < arrays.num_contours:
            break
        row, _ = outline_distance(chains_of(arrays), chains_of(curves), em / 1000, tolerance - outline.snapped)
        if not row[BOUND] + outline.snapped <= tolerance:
            break
        old, found = len(curves.degrees), (len(curves.degrees), curves_data(curves, precision)[0].text)
        outline = replace(outline, contours=Contours([each.curve.rounded(precision) for each in result.contours]))
    return found


def decimals(tolerance: float) -> int:
    """The fewest decimals whose unit is no larger than a tolerance."""
    return max(0, ceil(-log10(tolerance) - 1e-9))


def places_of(data: bytes) -> Iterator[tuple[int, int]]:
    """Where the ``d`` of each element stands in a file, in document order; two zeros of one that has none.

    Raises:
        GlyphsplineError: it is in an encoding unlike ASCII.
    """
    starts, reader = list[int](), expat.ParserCreate()
    reader.StartElementHandler = lambda name, attributes: starts.append(reader.CurrentByteIndex)
    try:
        reader.Parse(data, True)
    except (expat.ExpatError, LookupError, ValueError) as error:  # an encoding that this parser does not have
        raise GlyphsplineError("text in an encoding unlike ASCII, which is not edited") from error
    for start in starts:
        tag = TAG.match(data, start)
        if tag is None or len(tag[0]) < 2:
            raise GlyphsplineError("text in an encoding unlike ASCII, which is not edited")
        at, place = tag.end(), (0, 0)
        while found := ATTRIBUTE.match(data, at):
            at = found.end()
            if found[1] == b"d":
                place = found.span(2 if found[2] is not None else 3)
        yield place
