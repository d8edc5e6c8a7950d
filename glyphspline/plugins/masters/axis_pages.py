"""Diagrams against an axis: pages of a variable font's atlas, and the turns of its smooth joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...fitting.results import as_glyph
from ...outlines.masters import Masters
from ...types import FloatArray, rounded_up, shortened
from ...writers.figures.basics import (
    OUTLINE,
    ascii_text,
    blank,
    colour_legend,
    comb_patches,
    glyph_label,
    headed,
    outline_patch,
    saved,
)
from ...writers.settings import FigureKind
from ...writers.svg.comb import LONGEST, SOURCE, TOOTH, Teeth, teeth
from .convert_masters import MastersResult
from .kinks import AlongAxis, AxisKinks, Kink, KinkReport, VariableSource, along_axis, joint_turns, places_along

PAGE = (11.69, 8.27)
"""A4 in inches, broad side down."""

LEAST_SHOWN = 0.05
"""Degrees from which a turn is more than 0.0."""


def axis_pages(
    glyphs: Iterable[MastersResult | tuple[str, str]],
    tag: str,
    location: Mapping[str, float],
    scale: float,
    heading: str,
) -> Iterator[Any]:
    """The pages of glyphs along an axis as matplotlib figures.

    Args:
        glyphs: results in the order of the pages, or the name of a glyph without one and the reason, for the last page.
        tag, location, scale, heading: as for :func:`axis_page`.
    """
    failed: list[tuple[str, str]] = []
    for glyph in glyphs:
        if isinstance(glyph, MastersResult):
            yield axis_page(glyph, tag, location, scale, heading)
        else:
            failed.append(glyph)
    if failed:
        yield failures_page(failed, heading)


def axis_page(result: MastersResult, tag: str, location: Mapping[str, float], scale: float, heading: str) -> Any:
    """A glyph along an axis as a matplotlib figure.

    Above are the combs of source and result at places of the axis: at its masters, where the source's worst joint turns
    most (a ring is around it), and between. Below, against the axis, are the largest turn of smooth joints, the bending
    energy of arcs, and the ratio of the energies.

    Args:
        result: the glyph. tag: of the axis. location: user-space values of the other axes.
        scale: curvature in 1/unit of a full tooth. heading: the font's name.
    """
    source = along_axis(result.masters, tag, location, corner_angle=result.options.corner_angle)
    curve = along_axis(curves_of(result), tag, location, corner_angle=result.options.corner_angle)
    figure = headed(f"{heading}  {glyph_label(result.masters)}", _caption(result, source), PAGE)
    _draw_places(figure.add_axes((0.04, 0.415, 0.93, 0.495)), source, curve, scale)
    grid = figure.add_gridspec(1, 3, left=0.055, right=0.975, top=0.345, bottom=0.12, wspace=0.18)
    turns, energies, ratios = (figure.add_subplot(grid[0, k]) for k in range(3))
    _draw_lines(turns, source, curve, (source.turns, curve.turns))
    words = [f"source: {turn_words(source.worst)}", f"result: {turn_words(curve.worst)}"]
    inside = worst_inside(result, curve)
    if inside is not None and inside != curve.worst:
        words.append(f"inside its arcs: {turn_words(inside)}")
    turns.set_title("\n".join(words), **WORDS)
    turns.set_ylabel("largest turn of smooth joints, degrees", fontsize=6)
    turns.set_ylim(0, max(1.0, 1.1 * float(max(source.turns.max(), curve.turns.max()))))
    if source.worst is not None and source.worst.turn >= LEAST_SHOWN:
        turns.plot(source.worst.location[tag], source.worst.turn, "o", color=SOURCE, markersize=5, markerfacecolor="w")
    _draw_lines(energies, source, curve, (source.energies, curve.energies))
    energies.set_title("bending energy of arcs", **WORDS)
    energies.set_ylabel("in 1/em", fontsize=6)
    energies.legend(fontsize=6, frameon=False, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.99))
    scale_of(energies, np.concatenate([source.energies, curve.energies]), 0.0)
    at, ratio = energy_ratio(source, curve)
    ratios.axhline(1.0, color="0.6", linewidth=0.6)
    ratios.plot(at, ratio, color="black", linewidth=1)
    _mark_masters(ratios, source)
    scale_of(ratios, np.append(ratio, [0.9, 1.1]), 0.9)
    known = np.flatnonzero(np.isfinite(ratio))
    k = known[ratio[known].argmax()] if len(known) else 0
    most = f"at most {ratio[k]:.3g} at {tag} {at[k]:.4g}" if len(known) else "no arcs"
    ratios.set_title(f"energy, result / source: {most}", **WORDS)
    em = result.masters.metrics.units_per_em
    colour_legend(
        figure, (0.35, 0.045, 0.3, 0.012), scale * em, " in 1/em, convex positive, combs of source and result"
    )
    return figure


def failures_page(failed: Sequence[tuple[str, str]], heading: str) -> Any:
    """The names of glyphs without a result, with the reasons, as a matplotlib figure."""
    figure = headed(f"{heading}: without a result", "", PAGE)
    # Maximum number of glyphs that are named on the page of those without a result.
    lines = shortened([f"{name}: {reason}"[:180] for name, reason in failed], 60)
    figure.text(0.05, 0.93, ascii_text("\n".join(lines)), fontsize=7, va="top", parse_math=False)
    return figure


WORDS: dict[str, Any] = {"fontsize": 7, "loc": "left"}


def curves_of(result: MastersResult) -> Masters:
    """The result's curves in all masters."""
    return replace(result.masters, contours=tuple(contour.curve for contour in result.contours))


def energy_ratio(source: AlongAxis, result: AlongAxis) -> tuple[FloatArray, FloatArray]:
    """(v,) user-space values of the axis, and the result's bending energy over the source's there; NaN without arcs."""
    values = np.union1d(source.values, result.values)
    own = [np.interp(values, along.values, along.energies) for along in (result, source)]
    with np.errstate(divide="ignore", invalid="ignore"):
        return values, np.where(own[1] > 0, own[0] / own[1], np.nan)


def worst_inside(result: MastersResult, curve: AlongAxis) -> Kink | None:
    """The joint inside an arc of the result that turns most: none of those with lines. None without one."""
    inner = [contour.inner for contour in result.contours]
    return next((kink for kink in curve.found if inner[kink.contour][kink.joint]), None)


def turn_words(kink: Kink | None) -> str:
    """The worst joint in a line: "9.1° at wght 632, masters 0.4° and 0.3°"."""
    if kink is None:
        return "no smooth joints"
    if kink.turn < LEAST_SHOWN:
        return degrees(kink.turn)
    at, place = dict(kink.at_masters), f"{degrees(kink.turn)} at {kink.axis} {kink.location[kink.axis]:.4g}"
    before, behind = kink.between
    if before == behind:
        return f"{place}, a master" if before in at else place
    return f"{place}, masters {at[before]:.1f}° and {at[behind]:.1f}°"


def degrees(turn: float) -> str:
    """A turn with a decimal; a smaller one rounded up to a digit: "9.1°", "below 1e-12°"."""
    return f"{turn:.1f}°" if turn >= LEAST_SHOWN or turn == 0 else f"below {rounded_up(turn * (1 + 1e-9), 1):g}°"


def _caption(result: MastersResult, source: AlongAxis) -> str:
    others = [f"{tag} {value:.4g}" for tag, value in source.location.items() if tag != source.axis.tag]
    bound = max((contour.deviation_bound for contour in result.contours), default=0.0)
    counts = [sum(len(contour) for contour in m.contours) for m in (source.masters, curves_of(result))]
    parts = [
        f"along {source.axis.name} ({source.axis.tag})", *(["at " + ", ".join(others)] if others else []),
        f"{len(source.masters)} masters", f"{counts[0]} segments in the source, {counts[1]} in the result",
        f"within {rounded_up(bound, 3):g} units at every location", result.options.words,
    ]  # fmt: skip
    return ascii_text("; ".join(parts))


def _draw_places(axes: Any, source: AlongAxis, curve: AlongAxis, scale: float) -> None:
    """Combs of source, above, and result at places along the axis, on one pair of axes."""
    em = source.masters.metrics.units_per_em
    values = places_along(source, 7)
    rows = [[along.instance(value) for value in values] for along in (source, curve)]
    points = np.concatenate([contour.points for row in rows for outline in row for contour in outline.contours]) / em
    room = TOOTH * LONGEST + 0.02  # between instances, in em, beyond their longest teeth
    low, high = points.min(axis=0) - room, points.max(axis=0) + room
    height = float(high[1] - low[1])
    width = max(float(high[0] - low[0]), 0.76 * height)  # cells fill the page's width
    middle = (low + high) / 2
    outlines: list[FloatArray] = []
    drawn: list[Teeth] = []
    kink = source.worst
    for r, row in enumerate(rows):
        for c, outline in enumerate(row):
            shift = np.array([(c + 0.5) * width, -(r + 0.5) * height]) - middle
            outlines += [contour.cubics() / em + shift for contour in outline.contours]
            found = teeth(as_glyph(outline), scale, "source")
            drawn += [t.placed(lambda points, shift=shift: points / em + shift) for t in found]  # type: ignore[misc]
            if r == 0 and kink is not None and kink.turn >= LEAST_SHOWN:
                ring = outline.contours[kink.contour].cubics()[kink.joint, 0] / em + shift
                axes.plot(*ring, "o", color=SOURCE, markersize=8, markerfacecolor="none", markeredgewidth=0.7)
    # Limits are set below: add_patch would look for each tooth's extent, which takes longer than all the rest.
    for patch in [*outline_patch(outlines, **OUTLINE), *comb_patches(drawn)]:
        axes.add_artist(patch)
    near = 1e-6 * (source.axis.maximum - source.axis.minimum)
    for c, value in enumerate(values):
        is_master = any(abs(value - position) <= near for position in source.found.positions)
        is_worst = kink is not None and kink.turn >= LEAST_SHOWN and abs(value - kink.location[kink.axis]) <= near
        words = f"{source.axis.tag} {value:.4g}" + (", master" if is_master else "") + (", worst" if is_worst else "")
        style = {"weight": "bold"} if is_master else {}
        colour = SOURCE if is_worst else "0.2"
        axes.text((c + 0.5) * width, 0.01 * height, words, fontsize=7, ha="center", va="bottom", color=colour, **style)
    for r, words in enumerate(("source", "result")):
        axes.text(0, -(r + 0.5) * height, words, fontsize=8, rotation=90, ha="right", va="center", color="0.35")
    axes.set(xlim=(0, len(values) * width), ylim=(-2 * height, 0), aspect="equal")
    axes.set_axis_off()


def _draw_lines(axes: Any, source: AlongAxis, curve: AlongAxis, columns: tuple[FloatArray, FloatArray]) -> None:
    lines = ((source, SOURCE, 1.1, "source"), (curve, "black", 0.9, "result"))
    for (along, colour, width, words), column in zip(lines, columns, strict=True):
        shown = np.where(np.isfinite(column), column, np.nan)
        axes.plot(along.values, shown, color=colour, linewidth=width, label=words)
    _mark_masters(axes, source)


def scale_of(axes: Any, values: FloatArray, least: float) -> None:
    """Scale a diagram's values, from ``least`` or the smallest; logarithmically where some are far above the others."""
    shown = values[np.isfinite(values) & (values > 0)]
    if len(shown) and shown.max() > 20.0 * shown.min():
        axes.set_yscale("log")
    elif len(shown):
        axes.set_ylim(min(least, 0.98 * float(shown.min())), 1.05 * float(shown.max()))


def _mark_masters(axes: Any, source: AlongAxis) -> None:
    axis = source.axis
    _against_axis(axes, axis, source.found.positions, (axis.minimum, axis.maximum), 6, 2.0)
    axes.tick_params(labelsize=6)


def _against_axis(
    axes: Any, axis: Any, masters: Iterable[float], limits: tuple[float, float], size: int, gap: float
) -> None:
    """What all diagrams against an axis have in common: dashed lines at the masters, limits, and a label."""
    for position in masters:
        axes.axvline(position, color="0.6", linewidth=0.7, linestyle=(0, (4, 3)), zorder=0.5)
    margin = 0.01 * (limits[1] - limits[0]) or 1.0  # of an axis without range
    axes.set_xlim(limits[0] - margin, limits[1] + margin)
    axes.set_xlabel(f"{ascii_text(axis.name)} ({axis.tag}), masters dashed", fontsize=size, labelpad=gap)
    axes.spines[["top", "right"]].set_visible(False)


def turns_figure(source: VariableSource, report: KinkReport, kind: FigureKind) -> bytes:
    """A diagram for each axis: the largest turn of all smooth joints, and of those that interpolation kinks most.

    Args:
        source: which the report is of. report: of :func:`glyphspline.kinks`. kind: of the file.
    """
    figure = blank(7.5, 2.9 * len(report), layout="constrained")
    for axes, found in zip(figure.subplots(len(report), squeeze=False)[:, 0], report, strict=True):
        _draw_kinks(axes, source, found)
    return saved(figure, kind)


def _draw_kinks(axes: Any, source: VariableSource, found: AxisKinks) -> None:
    values, largest = found.profile.T
    axes.fill_between(values, largest, color="0.93", zorder=0)
    axes.plot(values, largest, color="0.3", linewidth=1.2, label="largest turn of all smooth joints")
    for colour, kink in zip(("#e8590c", "#1098ad", "#9c36b5"), worst(found), strict=False):
        at = np.union1d(np.linspace(values[0], values[-1], 241), [value for value, _ in kink.at_masters])
        axes.plot(at, joint_turns(source.masters(kink.glyph), kink, at), color=colour, linewidth=1.2, label=words(kink))
        axes.plot(*zip(*kink.at_masters, strict=True), "o", color=colour, markersize=3.5)
        axes.plot(kink.location[kink.axis], kink.turn, "o", color=colour, markersize=6, markerfacecolor="white")
    _against_axis(axes, found.axis, found.positions, (values[0], values[-1]), 8, 4.0)
    axes.set_ylim(0, max(1.0, 1.12 * float(largest.max())))
    axes.set_ylabel("turn in degrees", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(0.0, 1.16), ncols=2)


def worst(found: AxisKinks) -> list[Kink]:
    """The joints whose turn interpolation makes most, one a glyph: up to three of half a degree or more."""
    kinks: dict[str, Kink] = {}
    for k in np.argsort(-found.made, kind="stable"):
        if found.made[k] < 0.5 or len(kinks) == 3:
            break
        kink = found[int(k)]
        kinks.setdefault(kink.glyph, kink)
    return [*kinks.values()]


def words(kink: Kink) -> str:
    """A kink in a line: "f, contour 1: 9.1° at 632, 0.4° in masters"."""
    most = max(turn for _, turn in kink.at_masters)
    return (
        f"{ascii_text(kink.glyph)}, contour {kink.contour}: {kink.turn:.1f}° at {kink.location[kink.axis]:.4g}, "
        f"{most:.1f}° in masters"
    )
