"""A path from an SVG file: one of its shapes, by its id."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path as FilePath

import numpy as np
from fontTools.pens.recordingPen import RecordingPen

from ..curves.bezier import as_cubic
from ..errors import GlyphsplineError
from ..readers.source import opening, reason
from ..readers.svg import FLIP, draw_path, path_data, shapes, svg_root
from ..types import FloatArray
from .path import Path


def open_path(given: str | FilePath) -> Path:
    """Read a path from an SVG file, y up, in CSS pixels (1/96 inch), with view box, units and transforms applied.

    A drawing of 200 mm is 755.9 wide, whatever its view box; in one without a width and height, a user unit is a pixel.

    Shapes are paths, rectangles, circles, ellipses, polygons, polylines and lines, in ``defs`` too; they begin and run
    as SVG has it. A path whose ends meet is closed.

    Args:
        given: ``curve.svg#id``, or ``curve.svg`` if the file has only one shape.

    Raises:
        FontError: the file cannot be read, is no SVG drawing, or declares XML entities.
        GlyphsplineError: there is no such shape, or several without an id to choose from; the shape is of several
            pieces, has no length, or is broken. The error names file and id.
    """
    text = str(given)
    file, mark, name = (text, "", "") if FilePath(text).exists() else text.rpartition("#")
    if not file:
        file, mark, name = text, "", ""
    with opening(FilePath(file), "drawing"):
        root = svg_root(FilePath(file))
        found = [(element, matrix) for element, matrix, _ in shapes(root, FLIP, True, Counter(), everywhere=True)]
    names = [element.get("id") for element, _ in found]
    if mark:
        found = [pair for pair, own in zip(found, names, strict=True) if own == name]
    # Ids that an error lists.
    listed = ", ".join([str(own) for own in names if own][:8]) or "none has an id"
    if mark and len(found) != 1:
        what = f"{len(found)} shapes have this id" if found else f"no shape has this id; there are: {listed}"
        raise GlyphsplineError(what, font=f"{file}#{name}")
    if len(found) != 1:
        what = f"{len(found)} shapes, say which by #id: {listed}" if found else "no shape that text could run along"
        raise GlyphsplineError(what, font=file)
    element, matrix = found[0]
    name = name or element.get("id") or ""
    place = f"{file}#{name}" if name else file
    pen = RecordingPen()
    try:
        # Degrees of an elliptic arc that become one cubic, with an error of 6e-9 of the radius.
        draw_path(path_data(element), matrix, pen, 15.0)
    except GlyphsplineError as error:
        raise error.locate(font=place) from error
    except Exception as error:  # a broken path raises any of a dozen types
        raise GlyphsplineError(f"a broken path: {reason(error)}", font=place) from error
    pieces = [np.array(chain) for chain in _chains(pen.value) if chain]
    if len(pieces) > 1:
        raise GlyphsplineError(f"the path is of {len(pieces)} pieces; text runs along one", font=place)
    cubics = pieces[0] if pieces else np.empty((0, 4, 2))
    return Path.of(cubics, name=place)


def _chains(drawn: Sequence[tuple[str, tuple[tuple[float, float], ...]]]) -> list[list[FloatArray]]:
    """The segments of each subpath of a recorded drawing as cubics, those of a line that closes one too."""
    chains: list[list[FloatArray]] = []
    here = start = (0.0, 0.0)
    for name, points in drawn:
        if name == "moveTo":
            chains.append([])
            here = start = points[0]
            continue
        ends = (start,) if name == "closePath" and here != start else points  # without any: nothing is added
        if ends:
            chains[-1].append(as_cubic(np.array([here, *ends], dtype=np.float64)))
            here = ends[-1]
    return chains
