"""A page of what was mended: before and after over each other with combs, along each axis, and what moved."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...outlines.flaws.kinds import KINDS
from ...outlines.flaws.turns import joint_controls, turns_of
from ...outlines.masters import DesignAxis, Masters
from ...report.data import PRECISION, contours_in
from ...report.pages import kind_switches, page_of
from ...types import FloatArray, rounded_up
from ...writers.svg.comb import palette
from ..checks.finding import with_unit
from ..checks.page import FOLDER
from .state import Change

DRAWN, LISTED = 500, 20_000
"""Findings with a drawing: those whose points moved most. Findings in the table."""

STEPS = 48
"""Steps of each axis on the slider."""

SCRIPTS = ("page.js", "shapes.js", "places.js", "mending.js")

UNITS = {kind.name: kind.unit for kind in KINDS}


def mending_page(
    heading: str, facts: Sequence[str], changes: Sequence[Change], glyphs: Mapping[str, tuple[Masters, Masters]]
) -> str:
    """The page as HTML; it loads nothing.

    Args:
        heading: its title. facts: sentences below it. changes: what became of each finding.
        glyphs: those that changed, as they were and as they are, by name.
    """
    ordered = sorted(changes, key=lambda change: (not change.is_mended, -change.moved))[:LISTED]
    axes = next((old.axes for old, _ in glyphs.values()), ())
    places = [positions(axis) for axis in axes]
    names, drawings, rows = dict[str, int](), list[Any](), []
    kinds = [*dict.fromkeys(change.kind for change in ordered)]
    for n, change in enumerate(ordered):
        number, worst = -1, (-1, 0)
        if n < DRAWN and change.is_mended and change.glyph in glyphs:
            old, new = glyphs[change.glyph]
            if change.glyph not in names:
                names[change.glyph] = len(drawings)
                drawings.append(drawing(old, new, places))
            number, worst = names[change.glyph], worst_place(old, change, places)
        rows.append([
            change.glyph, kinds.index(change.kind), change.contour, change.segment,
            *[round(value, 2) for value in change.point],
            before_words(change), after_words(change), moved_words(change),
            "" if change.distance is None else f"{rounded_up(change.distance, 3):g}",
            left_words(change), number, *worst,
        ])  # fmt: skip
    setup = {
        "kinds": kinds, "rows": rows, "drawings": drawings, "palette": palette(),
        "axes": [
            {
                "tag": axis.tag, "name": axis.name, "values": [float(f"{value:.6g}") for value in values],
                "home": int(np.abs(values - axis.default).argmin()),
            }
            for axis, values in zip(axes, places, strict=True)
        ],
    }  # fmt: skip
    switches = kind_switches(
        [(k, kind, "") for k, kind in enumerate(kinds)], Counter(change.kind for change in ordered)
    )
    return page_of(
        "mending.html", ("theme.css", "findings.css", "mending.css"), heading, SCRIPTS, setup, facts=facts,
        own=[Path(__file__).parent, FOLDER], kinds=switches,
    )  # fmt: skip


def positions(axis: DesignAxis) -> FloatArray:
    """User-space values on an axis's slider: even steps, and the default."""
    found: FloatArray = np.union1d(np.linspace(axis.minimum, axis.maximum, STEPS + 1), [axis.default])
    return found


def weights_along(masters: Masters, places: Sequence[FloatArray]) -> list[FloatArray]:
    """(v, K) weights of the masters at the values of each axis, the others at their defaults."""
    along = zip(masters.axes, places, strict=True)
    return [np.array([masters.weights({axis.tag: float(value)}) for value in values]) for axis, values in along]


def drawing(old: Masters, new: Masters, places: Sequence[FloatArray]) -> dict[str, Any]:
    """A glyph before and after, in all masters, and their weights along each axis."""
    sides = (contours_in(np.eye(len(masters)), masters.contours) for masters in (old, new))
    weights = [np.round(each, PRECISION + 3).tolist() for each in weights_along(old, places)]
    return {"em": old.metrics.units_per_em, **dict(zip(("old", "new"), sides, strict=True)), "weights": weights}


def worst_place(old: Masters, change: Change, places: Sequence[FloatArray]) -> tuple[int, int]:
    """The number of the axis and of the value on it where a kink turned most; -1 and 0 at the default."""
    worst, most = (-1, 0), 0.0
    if change.kind == "kink":
        controls = joint_controls(old.contours[change.contour])[:, change.segment]
        for a, weights in enumerate(weights_along(old, places)):
            turns = np.nan_to_num(np.abs(turns_of(np.tensordot(weights, controls, axes=1))))
            if turns.max() > most:
                worst, most = (a, int(turns.argmax())), float(turns.max())
    return worst


def before_words(change: Change) -> str:
    """How much was found, with its unit."""
    return with_unit(change.before, UNITS[change.kind])


def after_words(change: Change) -> str:
    """By how much a joint turns now, where that is known."""
    return "" if change.after is None else f"{change.after:.2f}°"


def moved_words(change: Change) -> str:
    """By how much points moved, and how many went."""
    gone = f"{change.gone} gone" if change.gone else ""
    return ", ".join(filter(None, (f"{change.moved:.3g}" if change.moved or not gone else "", gone)))


def left_words(change: Change) -> str:
    """Why a finding is left, and what it would take."""
    needs = "" if change.needs is None else f": it takes {rounded_up(change.needs, 2):g} units"
    return "" if change.why is None else f"{change.why}{needs}"
