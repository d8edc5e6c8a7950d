"""What ``check`` says of a font: a table, or JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from io import StringIO
from pathlib import Path
from typing import Any, get_args

from ..checks.axis_kinks import AxisKinks, Kink, KinkReport
from ..checks.axis_kinks import Source as VariableSource
from ..errors import OptionError
from ..types import counted
from ..writers.figures.images import FigureKind
from .closing import WIDE
from .messages import printable


def kinks_over(report: KinkReport, least: float) -> list[Kink]:
    """Kinks of all axes that turn by so many degrees: those that interpolation makes first, then by their turn."""
    found = [kink for of_axis in report for kink in of_axis[: int((of_axis.turns >= least).sum())]]
    return sorted(found, key=lambda kink: (-round(kink.made, 2), -kink.turn))


def require_figure(path: Path | None) -> None:
    """Raise an error unless a diagram can be written as what the file's suffix says."""
    if path is not None and path.suffix[1:].lower() not in get_args(FigureKind):
        raise OptionError(f"--plot is a file of {', '.join(get_args(FigureKind))}, not {path}")


def write_plot(path: Path, source: VariableSource, report: KinkReport) -> None:
    """Draw the report; see :func:`require_figure`."""
    from ..writers.figures.turns import turns_figure

    kind: Any = path.suffix[1:].lower()
    path.write_bytes(turns_figure(source, report, kind))


def facts(font: str, report: KinkReport, found: Sequence[Kink]) -> dict[str, Any]:
    """The report as JSON data; every finding says its kind."""
    return {
        "font": font,
        "glyphs": report.glyphs,
        "corner_angle": report.corner_angle,
        "axes": [axis_facts(of_axis) for of_axis in report],
        "findings": [{"kind": "kink", **asdict(kink)} for kink in found],
        "failed": [{"glyph": glyph, "error": error} for glyph, error in report.failed],
    }


def axis_facts(found: AxisKinks) -> dict[str, Any]:
    """An axis in numbers. Of no joints, turns are null."""
    some = len(found) > 0
    return {
        "axis": found.axis.tag,
        "joints": len(found),
        "masters": list(found.positions),
        "largest_turn": float(found.turns.max()) if some else None,
        "largest_turn_at_masters": float(found.turns_at_masters.max()) if some else None,
        "largest_made": float(found.made.max()) if some else None,
        "turns_over_1": int((found.turns > 1).sum()),
        "made_over_1": int((found.made > 1).sum()),
        "jumps_over_10_percent": int((found.jumps > 0.1).sum()),
    }


def table(found: Sequence[Kink], shown: int) -> str:
    """The largest kinks, one a line."""
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    lines = Table(box=box.ASCII2, show_edge=False)
    for heading in ("glyph", "contour", "joint", "point", "turn", "in masters", "made", "jump", "location"):
        lines.add_column(heading, justify="left" if heading in ("glyph", "location") else "right")
    for kink in found[:shown]:
        most = max(turn for _, turn in kink.at_masters)
        lines.add_row(
            Text(printable(kink.glyph)), str(kink.contour), str(kink.joint), "{:.0f}, {:.0f}".format(*kink.point),
            f"{kink.turn:.2f}°", f"{most:.2f}°", f"{kink.made:.2f}°", f"{kink.jump:.0%}", place(kink),
        )  # fmt: skip
    text = StringIO()
    Console(file=text, width=WIDE, color_system=None).print(lines)
    return "\n".join([line.rstrip() for line in text.getvalue().splitlines()])


def place(kink: Kink) -> str:
    """Where a kink is on its axis, and between which masters: "wght 632 (400 to 900)"."""
    low, high = kink.between
    between = "in a master" if low == high else f"{low:.4g} to {high:.4g}"
    return f"{kink.axis} {kink.location[kink.axis]:.4g} ({between})"


def sentences(report: KinkReport, found: Sequence[Kink], shown: int, least: float) -> list[str]:
    """What the table does not say: each axis in a line, and how many kinks are left out."""
    lines = []
    for of_axis in report:
        numbers: Mapping[str, Any] = axis_facts(of_axis)
        line = f"{numbers['axis']}: {counted(numbers['joints'], 'smooth joint')}"
        if numbers["joints"]:
            line += (
                f", turn up to {numbers['largest_turn']:.2f}° ({numbers['largest_turn_at_masters']:.2f}° in masters), "
                f"{numbers['turns_over_1']} over 1°; made by interpolation up to {numbers['largest_made']:.2f}°, "
                f"{numbers['made_over_1']} over 1°; curvature jumps over 10 % at "
                f"{numbers['jumps_over_10_percent'] / numbers['joints']:.0%}"
            )
        lines.append(line)
    if len(found) > shown:
        lines.append(f"and {len(found) - shown} more from {least:g}°")
    lines += [f"not measured: {glyph}: {error}" for glyph, error in report.failed[:3]]
    if len(report.failed) > 3:
        lines.append(f"not measured: and {len(report.failed) - 3} more")
    return lines
