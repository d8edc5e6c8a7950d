"""The largest turn of a variable font's smooth joints against its axes, masters marked."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...checks.kinks import AxisKinks, Kink, KinkReport, joint_turns
from ...checks.kinks import Source as VariableSource
from .images import FigureKind, blank, saved
from .patches import ascii_text

WIDTH, HEIGHT = 7.5, 2.9
"""Of the diagram of one axis, in inches."""

NAMED = 3
"""Joints of each axis that have a line of their own: those whose turn interpolation makes most."""

MADE = 0.5
"""Degrees made by interpolation from which they have one."""

STEPS = 240
"""Of the lines of single joints."""

COLOURS = ("#e8590c", "#1098ad", "#9c36b5")


def turns_figure(source: VariableSource, report: KinkReport, kind: FigureKind) -> bytes:
    """A diagram for each axis: the largest turn of all smooth joints, and of those that interpolation kinks most.

    Args:
        source: which the report is of. report: of :func:`glyphspline.kinks`. kind: of the file.
    """
    figure = blank(WIDTH, HEIGHT * len(report), layout="constrained")
    for axes, found in zip(figure.subplots(len(report), squeeze=False)[:, 0], report, strict=True):
        _draw(axes, source, found)
    return saved(figure, kind)


def _draw(axes: Any, source: VariableSource, found: AxisKinks) -> None:
    values, largest = found.profile.T
    axes.fill_between(values, largest, color="0.93", zorder=0)
    axes.plot(values, largest, color="0.3", linewidth=1.2, label="largest turn of all smooth joints")
    for position in found.positions:
        axes.axvline(position, color="0.6", linewidth=0.7, linestyle=(0, (4, 3)), zorder=0.5)
    for colour, kink in zip(COLOURS, worst(found), strict=False):
        at = np.union1d(np.linspace(values[0], values[-1], STEPS + 1), [value for value, _ in kink.at_masters])
        axes.plot(at, joint_turns(source.masters(kink.glyph), kink, at), color=colour, linewidth=1.2, label=words(kink))
        axes.plot(*zip(*kink.at_masters, strict=True), "o", color=colour, markersize=3.5)
        axes.plot(kink.location[kink.axis], kink.turn, "o", color=colour, markersize=6, markerfacecolor="white")
    margin = 0.01 * (values[-1] - values[0])
    axes.set(xlim=(values[0] - margin, values[-1] + margin), ylim=(0, max(1.0, 1.12 * float(largest.max()))))
    axes.set_xlabel(f"{ascii_text(found.axis.name)} ({found.axis.tag}), masters dashed", fontsize=8)
    axes.set_ylabel("turn in degrees", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(0.0, 1.16), ncols=2)


def worst(found: AxisKinks) -> list[Kink]:
    """The joints whose turn interpolation makes most, one a glyph."""
    kinks: dict[str, Kink] = {}
    for k in np.argsort(-found.made, kind="stable"):
        if found.made[k] < MADE or len(kinks) == NAMED:
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
