"""Text along a path: each letter stands upright on it, turned as a whole."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple, get_args

import numpy as np

from ..errors import GlyphsplineError, is_number, require, require_choice
from ..types import FloatArray, IntArray, counted
from .moved import Motion
from .path import Path
from .placed import Layout
from .setting import Align, Side

ROUNDING = 1e-9
"""Share of the path's length by which a text may be too long."""


MOST_NAMED = 12
"""Letters that an error names."""


class Letters(NamedTuple):
    """The letters of a line, in visual order: glyphs that are turned together.

    Attributes:
        of: (n,) the letter that each glyph belongs to. left, right: (m,) where it begins and ends on the line.
        character: (m,) number of its first character in the text.
    """

    of: IntArray
    left: FloatArray
    right: FloatArray
    character: IntArray

    @property
    def middle(self) -> FloatArray:
        """(m,) the middle of each letter's advance."""
        return (self.left + self.right) / 2


def along(layout: Layout, path: Path, *, offset: float = 0.0, align: Align = "start", side: Side = "left") -> Layout:
    """Put a line of text on a path, as SVG's ``textPath`` does.

    The middle of a letter's advance comes to the path at its arc length, and the letter is turned by the path's tangent
    there. The glyphs of a cluster, and marks on it, are one letter: accents stay where they are above it.

    Args:
        layout: of one horizontal line. path: in font units; see :meth:`.Path.scaled`.
        offset: font units by which the text is moved forward along the path.
        align: where the text stands on an open path, and about which point of a closed one: its start or, half-way
            round or all the way round, its middle or end; "justify" spaces the letters out over the path's length.
        side: "left" of the path, or "right", where the text runs along the reversed path.

    Returns:
        The layout in the path's coordinates.

    Raises:
        GlyphsplineError: several lines, or a text that is too long: letters whose middle is beyond the end of an open
            path, or text that would go round a closed path more than once. The error says how many letters do not fit.
        OptionError: an argument out of range.

    Example:
        >>> import glyphspline as gs
        >>> font = gs.open_font("fonts_test/kouzan-gyosho.ttf")
        >>> upwards = gs.along(gs.layout(font, "龍好"), gs.Path.of([[0, 0], [0, 3000]]))
        >>> upwards.origin.round(6).tolist()
        [[0.0, 0.0], [0.0, 1024.0]]
    """
    layout, path, letters, start = laid(layout, path, offset, align, side)
    if not len(layout):
        return layout
    middle = letters.middle
    points, tangents = path.at(start + middle)
    angle = np.arctan2(tangents[:, 1], tangents[:, 0])
    arms = layout.origin - np.stack([middle[letters.of], np.zeros(len(layout))], axis=1)
    onto = Motion(points, *tangents.T)
    origin = Motion(*(column[letters.of] for column in onto)).of(arms, np.ones(len(arms), dtype=np.int64))
    half = (letters.right - letters.left)[:, None] / 2 * [-1, -1, 1, 1]
    boxes = np.stack(np.broadcast_arrays(half, layout.box[1::2] * 2), axis=2)
    corners = onto.of(boxes.reshape(-1, 2), np.full(len(boxes), 4))
    (left, low), (right, high) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return replace(layout, origin=origin, angle=layout.angle + angle[letters.of], box=(left, low, right, high))


def laid(layout: Layout, path: Path, offset: float, align: Align, side: Side) -> tuple[Layout, Path, Letters, float]:
    """The line, the path in its direction, the letters, and the arc length of the path where x = 0 of the line comes.

    Raises:
        GlyphsplineError, OptionError: as for :func:`along`.
    """
    require(is_number(offset), "offset is a finite distance along the path", offset)
    require_choice("align", align, get_args(Align))
    require_choice("side", side, get_args(Side))
    if (lines := len(np.unique(layout.line))) > 1:
        raise GlyphsplineError(f"a text of {lines} lines; on a path there is one", font=path.name)
    if layout.vertical:
        raise GlyphsplineError("a text set in columns; on a path it is horizontal", font=path.name)
    if side == "right":
        path = path.reversed()
    letters = letters_of(layout)
    if not len(layout):
        return layout, path, letters, offset
    left, right = float(letters.left.min()), float(letters.right.max())
    spare = path.length - (right - left)
    start = offset - left + {"center": spare / 2, "end": spare}.get(align, 0.0)
    count = len(letters.left)
    if align == "justify" and spare > 0 and count > 1 - path.closed:
        gap = spare / (count if path.closed else count - 1)
        shift = np.arange(count) * gap
        letters = letters._replace(left=letters.left + shift, right=letters.right + shift)
        layout = replace(layout, origin=layout.origin + np.stack([shift, 0 * shift], axis=1)[letters.of])
        start += gap / 2 if path.closed else 0.0
    ink = np.array([not layout.text[k : k + 1].isspace() for k in letters.character.tolist()])
    middle = letters.middle
    if path.closed:
        out = ink & (letters.right - letters.left[ink].min(initial=np.inf) > path.length * (1 + ROUNDING))
    else:
        out = ink & (np.abs(start + middle - path.length / 2) > path.length * (0.5 + ROUNDING))
    if out.any():
        number = int(out.sum())
        place = "" if offset == 0 or path.closed else f", and begins at {offset:.6g},"
        named = "".join([layout.text[k] for k in np.sort(letters.character[out]).tolist()])
        named = named if number <= MOST_NAMED else f"{named[:MOST_NAMED]}…"
        raise GlyphsplineError(
            f"the text is {right - left:.6g} units long{place} and the path {path.length:.6g}: "
            f"{number} of {counted(int(ink.sum()), 'letter')} {'does' if number == 1 else 'do'} not fit, {named!r}",
            font=path.name,
        )
    return layout, path, letters, start


def letters_of(layout: Layout) -> Letters:
    """The letters of a line: clusters, each with the marks without advance that stand on it.

    Pens stand where the advances before them end. The line begins where most glyphs say it does: marks, and a few
    others, are moved off their pens.
    """
    wide = layout.advance != 0
    ends = np.cumsum(layout.advance)
    pens = ends - layout.advance
    if not len(layout):
        return Letters(np.zeros(0, dtype=np.int64), pens, pens, np.zeros(0, dtype=np.int64))
    begin = float(np.median((layout.origin[:, 0] - pens)[wide if wide.any() else slice(None)]))
    runs = np.concatenate([[0], np.cumsum(np.diff(layout.cluster) != 0)])
    m = int(runs[-1]) + 1
    character = np.zeros(m, dtype=np.int64)
    character[runs] = layout.cluster
    standing = np.bincount(runs, weights=wide, minlength=m) > 0
    joined = np.arange(m)
    bases = np.flatnonzero(standing)
    for k in np.flatnonzero(~standing).tolist():
        # A mark comes after its base in the text, so its base is the neighbour with the nearest lower cluster.
        at = int(np.searchsorted(bases, k))
        near = [base for base in bases[max(at - 1, 0) : at + 1].tolist() if character[base] <= character[k]]
        joined[k] = max(near, key=character.__getitem__, default=k)
    kept, of = np.unique(joined[runs], return_inverse=True)
    left, right = np.full(len(kept), np.inf), np.full(len(kept), -np.inf)
    counts = wide | ~standing[kept][of]
    np.minimum.at(left, of[counts], np.minimum(pens, ends)[counts])
    np.maximum.at(right, of[counts], np.maximum(pens, ends)[counts])
    return Letters(of, left + begin, right + begin - layout.letter_spacing, character[kept])
