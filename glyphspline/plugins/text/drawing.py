"""A text laid out as an SVG drawing in which each glyph is an element of its own."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from ...fitting.results import GlyphResult, end_to_end
from ...writers.settings import PLAIN, Appearance
from ...writers.svg.document import head, id_prefix, number, painting, shown_as, shown_box, text
from ...writers.svg.path_data import curves_data
from .placed import Layout


def text_document(layout: Layout, results: Sequence[GlyphResult], look: Appearance = PLAIN) -> bytes:
    """The text in UTF-8: each distinct glyph is a path, drawn once for each place by a ``<use>`` of its own.

    Ids are stable: ``font-0-g36-A`` is the path of a glyph of the first font, ``line-0`` a line, ``glyph-7`` the eighth
    glyph in visual order. ``data-cluster`` is the number of the character of the text that a glyph stands for.

    Args:
        layout: n placed glyphs. results: of its distinct glyphs.
        look: of the drawing; its em box is the box of the lines.
    """
    precision = results[0].options.precision if results else 2
    em = layout.fonts[0].metrics.units_per_em
    arrays, offsets = end_to_end(results)
    paths = curves_data(arrays.curves, precision, offsets)
    fonts = np.zeros(len(results), dtype=np.int64)
    fonts[layout.which] = layout.font
    ids = [
        f"font-{font}-{id_prefix(result.outline.name, result.outline.gid)}"
        for font, result in zip(fonts.tolist(), results, strict=True)
    ]
    names = [
        f' data-glyph="{text(result.outline.name)}" href="#{own}' for own, result in zip(ids, results, strict=True)
    ]
    ink = curves_data(layout.placed(results).arrays.curves, precision)[0].box
    box = shown_box(layout.box, ink, look.view_box)
    value, shape = shown_as(box, look, em, precision)
    units = f' data-units-per-em="{number(em, precision)}"'
    parts = [head(value, "text-title", text(layout.text), units, shape), "<defs>\n"]
    for name, path in zip(ids, paths, strict=True):
        if path.text:
            parts.append(f'<path id="{name}" d="{path.text}"/>\n')
    parts.append(f"</defs>\n<g {painting(look, em, float(value.split()[3]))}>\n")
    places = zip(
        range(len(layout)), layout.line.tolist(), layout.which.tolist(), layout.cluster.tolist(),
        layout.origin.tolist(), np.degrees(layout.angle).tolist(), strict=True,
    )  # fmt: skip
    for line, own in groupby(places, key=lambda place: place[1]):
        parts.append(f'<g id="line-{line}">\n')
        parts += [
            f'<use id="glyph-{k}" data-cluster="{cluster}"{names[glyph]}"{_put(x, y, angle, precision)}/>\n'
            for k, _, glyph, cluster, (x, y), angle in own
            if paths[glyph].text
        ]
        parts.append("</g>\n")
    return "".join([*parts, "</g>\n</svg>\n"]).encode()


def _put(x: float, y: float, angle: float, precision: int) -> str:
    """The place of a glyph as attributes; turned ones have a transform."""
    across, down = number(x, precision), number(-y, precision)
    return (
        f' transform="translate({across} {down}) rotate({number(-angle, 6)})"' if angle else f' x="{across}" y="{down}"'
    )
