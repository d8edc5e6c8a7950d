"""A text laid out as an SVG drawing in which each glyph is an element of its own."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256
from itertools import groupby

import numpy as np

from ...errors import OptionError
from ...fitting.results import GlyphResult, joined_results
from ...writers.settings import PLAIN, Appearance
from ...writers.svg.document import head, inked, number, painting, shown_as, shown_box, stroking, text
from ...writers.svg.path_data import curves_data
from .placed import Layout


def text_document(layout: Layout, results: Sequence[GlyphResult], look: Appearance = PLAIN) -> bytes:
    """The text in UTF-8: each distinct glyph is a path, drawn once for each place by a ``<use>`` of its own.

    Lines and glyphs are of the classes "line" and "glyph", in visual order. ``data-cluster`` is the number of the
    character of the text that a glyph stands for. Ids end with a digest of the drawing: texts stand in one page.

    Args:
        layout: n placed glyphs. results: of its distinct glyphs.
        look: of the drawing; its em box is the box of the lines.

    Raises:
        OptionError: a bare drawing is asked for.
    """
    if look.bare:
        raise OptionError("bare: such a drawing is one path, and here each glyph is an element of its own")
    precision = results[0].options.precision if results else 2
    em = layout.fonts[0].metrics.units_per_em
    arrays, offsets = joined_results(results)
    paths = curves_data(arrays.curves, precision, offsets)
    said = [path.text + path.strokes for path in paths]
    digest = sha256(repr((layout.text, layout.origin.tolist(), said)).encode()).hexdigest()[:8]
    ids = [f"g{k}-{digest}" for k in range(len(results))]
    names = [
        f' data-glyph="{text(result.outline.name)}" href="#{own}' for own, result in zip(ids, results, strict=True)
    ]
    ink = curves_data(layout.placed(results).arrays.curves, precision)[0]
    box = shown_box(layout.box, inked(ink, look, em), look.view_box)
    value, shape = shown_as(box, look, em, precision)
    units = f' data-units-per-em="{number(em, precision)}"'
    parts = [head(value, text(layout.text), units, shape), "<defs>\n"]
    for name, path in zip(ids, paths, strict=True):
        if path.strokes:
            line = f'<path{stroking(look, em, float(value.split()[3]))} d="{path.strokes}"/>'
            parts.append(f'<g id="{name}"><path d="{path.text}"/>{line}</g>\n')
        elif path.text:
            parts.append(f'<path id="{name}" d="{path.text}"/>\n')
    parts.append(f"</defs>\n<g{painting(look, em, float(value.split()[3]))}>\n")
    places = zip(
        layout.line.tolist(), layout.which.tolist(), layout.cluster.tolist(),
        layout.origin.tolist(), np.degrees(layout.angle).tolist(), strict=True,
    )  # fmt: skip
    for _, own in groupby(places, key=lambda place: place[0]):
        parts.append('<g class="line">\n')
        parts += [
            f'<use class="glyph" data-cluster="{cluster}"{names[glyph]}"{_put(x, y, angle, precision)}/>\n'
            for _, glyph, cluster, (x, y), angle in own
            if said[glyph]
        ]
        parts.append("</g>\n")
    return "".join([*parts, "</g>\n</svg>\n"]).encode()


def _put(x: float, y: float, angle: float, precision: int) -> str:
    """The place of a glyph as attributes; turned ones have a transform."""
    across, down = number(x, precision), number(-y, precision)
    return (
        f' transform="translate({across} {down}) rotate({number(-angle, 6)})"' if angle else f' x="{across}" y="{down}"'
    )
