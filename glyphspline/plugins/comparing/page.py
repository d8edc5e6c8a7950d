"""Two fonts over each other: one page, self-contained, a card a glyph."""

from __future__ import annotations

from collections.abc import Sequence
from math import isinf
from pathlib import Path

from ...outlines.outline import Contour, Contours, Outline
from ...outlines.outline_distance import EVEN
from ...report.pages import page_of
from ...types import rounded_up, shortened
from ...writers.svg.document import number, text, view_box_value
from ...writers.svg.path_data import Box, both_ways, curves_data, union
from .difference import Difference, Turn

Drawn = tuple[Difference, Outline | None, Outline | None]
"""A difference with both outlines; None for one that could not be read."""


def comparison_page(heading: str, facts: Sequence[str], drawn: Sequence[Drawn], tolerance: float) -> str:
    """The page.

    Args:
        heading: its title. facts: sentences below it. drawn: glyphs in order. tolerance: in units of the old em.
    """
    return page_of(
        "comparison.html", ("theme.css", "comparison.css"), heading, facts=facts, own=[Path(__file__).parent],
        cards="\n".join([card(*each, tolerance) for each in drawn]),
    )  # fmt: skip


def card(each: Difference, old: Outline | None, new: Outline | None, tolerance: float) -> str:
    """One glyph: both outlines over each other, a close-up of the worst place, and what differs."""
    paths: list[str] = []
    box: Box | None = None
    for kind, outline, scale in (("source", old, 1.0), ("result", new, each.scale)):
        contours = [] if outline is None else [Contour(c.points * scale, c.degrees) for c in outline.contours]
        # Decimals of the drawings.
        arrays = Contours(contours).arrays
        data = curves_data(arrays, 2)[0]
        paths.append(f'<path class="{kind}" fill-rule="nonzero" d="{both_ways(data, arrays, 2)}"/>')
        box = data.box if box is None else union(box, data.box)
    em = 1000.0 if old is None else old.metrics.units_per_em
    left, bottom, right, top = box or (0.0, 0.0, em, em)
    # Free space around a glyph, in its sizes.
    edge = 0.06 * max(right - left, top - bottom)
    whole = drawing("Both outlines", (left - edge, bottom - edge, right + edge, top + edge), paths, marks(each, em))
    close = ""
    if each.worst is not None and not each.identical:
        size = max(right - left, top - bottom)
        # Side of the close-up around the worst place, in distances of the outlines there; half the glyph's at most.
        # Half the side of the smallest close-up, in em.
        half = max(min(12.0 / 2 * each.seen, size / 4), 0.75 * each.seen, 0.004 * em)
        x, y = ((a + b) / 2 for a, b in zip(each.worst.point, each.worst.nearest, strict=True))
        around = (x - half, y - half, x + half, y + half)
        close = drawing("Close-up of the worst place", around, paths, marks(each, em, half), "close")
    beyond = ' class="card beyond"' if each.is_beyond(tolerance) else ' class="card"'
    words = "".join([f"<dt>{name}</dt><dd>{text(value)}</dd>" for name, value in lines(each)])
    name = each.glyph if each.glyph == each.new_glyph else f"{each.glyph} = {each.new_glyph}"
    codes = " ".join([f"U+{code:04X}" for code in each.unicodes])
    return (
        f"<article{beyond}><h2>{text(name)} <small>{codes}</small></h2>"
        f'<div class="pair">{whole}{close}</div><dl>{words}</dl></article>'
    )


def marks(each: Difference, em: float, half: float | None = None) -> str:
    """The worst place: a ring in the drawing of the glyph, a line from point to point in a close-up; a circle in which
    all ink changed; and kinks."""
    found = []
    for kind, turns in (("gone", each.kinks_gone), ("came", each.kinks_new)):
        found += [ring(turn.point, 0.012 * em if half is None else half / 14, f"kink {kind}") for turn in turns]
    if each.ink is not None:
        found.append(ring(each.ink.deepest, each.ink.depth, "ink"))
    if each.worst is not None:
        (ax, ay), (bx, by) = each.worst.point, each.worst.nearest
        found.append(
            ring(each.worst.point, 0.025 * em, "worst")
            if half is None
            else f'<path class="worst" d="M{digits(ax, -ay)}L{digits(bx, -by)}"/>'
        )
    return "".join(found)


def ring(point: tuple[float, float], radius: float, kind: str) -> str:
    """A circle around a place."""
    x, y = point
    return f'<circle class="{kind}" cx="{digits(x)}" cy="{digits(-y)}" r="{digits(radius)}"/>'


def digits(*values: float) -> str:
    """Coordinates of a mark."""
    return " ".join([number(value, 4) for value in values])


def drawing(title: str, box: Box, paths: Sequence[str], more: str, kind: str = "whole") -> str:
    """A drawing of a region."""
    left, bottom, right, top = box
    shown = view_box_value(box, 3) if kind == "whole" else digits(left, -top, right - left, top - bottom)
    return (
        f'<svg class="drawing {kind}" viewBox="{shown}" role="img"><title>{title}</title>{"".join(paths)}{more}</svg>'
    )


def lines(each: Difference) -> list[tuple[str, str]]:
    """What differs, in words."""
    found = [("Distance", distance(each.bound))]
    if each.worst is not None:
        found.append(("Worst", f"{each.worst.outline}, contour {each.worst.contour}, {where(each.worst.point)}"))
    if each.ink is not None:
        deep = f"up to {each.ink.depth:.3g} units from both outlines, at {where(each.ink.deepest)}"
        found.append(("Ink", f"{each.ink.share} changed, {deep}"))
        found += [
            (f"Islands and counters {what}", f"{count}")
            for what, count in (("lost", each.ink.lost), ("gained", each.ink.gained))
            if count
        ]
    if each.advance != each.new_advance:
        found.append(("Advance", f"{each.advance:g} → {each.new_advance:g}"))
    for name, gone, came in (
        ("Contours", ", ".join(map(str, each.contours_gone)), ", ".join(map(str, each.contours_new))),
        ("Kinks", kinks(each.kinks_gone), kinks(each.kinks_new)),
    ):
        found += [(f"{name} gone", gone)] * bool(gone) + [(f"{name} new", came)] * bool(came)
    return found


def distance(bound: float) -> str:
    """A bound for people; infinite if one of the outlines is empty."""
    if isinf(bound):
        return "one is empty"
    return f"≤ {rounded_up(bound / (1 + EVEN), 4):g} units" if bound >= 0.001 else "< 0.001 units"


def kinks(turns: Sequence[Turn]) -> str:
    """Kinks in words, the first three."""
    return "; ".join(shortened([f"{turn.degrees:.3g}° at {where(turn.point)}" for turn in turns], 3))


def where(point: tuple[float, float]) -> str:
    """A place for people."""
    return "({:.5g}, {:.5g})".format(*point)
