"""Settings of writers of drawings besides the result: looks, scale, flatness, and what curvature maps show."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, get_args

from ..errors import OptionError, is_positive, require
from ..fields import LOOK, WRITTEN, check, checked, option, positive
from ..types import INCHES

if TYPE_CHECKING:
    from ..outlines.outline import FontMetrics

DxfKind = Literal["spline", "arcs", "polyline"]

ImageKind = Literal["png", "pdf"]
"""Of drawings."""

FigureKind = Literal["png", "pdf", "svg"]
"""Of diagrams."""

SMOOTH = 1e-3
"""Radians of turn up to which a join is smooth: rounding to 1/100 unit turns handles of 10 units by as much."""

NO_HANDLE = 1e-9
"""Handles up to this length in font units may be rounding errors and have no direction."""

RELATIVE_FLATNESS = 1 / 2000
"""Flatness of polylines where none is given, in em."""

ViewBox = Literal["em", "metrics", "ink"]
VIEW_BOXES: tuple[ViewBox, ...] = get_args(ViewBox)

_LENGTH = re.compile(r"(\d{1,6}(?:\.\d{1,9})?)([a-z]*)")
_HEX = re.compile(r"#(?:[0-9a-fA-F]{3}|[0-9a-fA-F]{6})")
_NAME = re.compile(r"[a-z]{3,20}")

Whose = Literal["result", "source"]
WHOSE: tuple[Whose, ...] = get_args(Whose)
"""Whose curvature a comb shows: the curve's, or that of the outline it was made of, which is exact."""

Combs = Literal[Whose, "both"]
"""The combs of a map; in one of both, the source's is a line through its tips."""

CURRENT = "currentColor"


@dataclass(frozen=True)
class Appearance:
    """How drawings of glyphs look.

    Attributes:
        view_box: the region shown; see :func:`.svg.document.to_svg`.
        size: height of the drawing with its unit (mm, cm, in, pt, pc, px), its width in proportion; None: no size.
        fill: colour of the ink: "currentColor", "none", #rgb, #rrggbb or a name of CSS.
        stroke: colour of a line along the outline, likewise.
        em: instead of ``size``, the length of an em with its unit, which is the size that type has.
        stroke_width: of that line: font units, "0.01em", or "0.1mm" of a drawing with a size; None: 1/1000 em.
        bare: write a path in an SVG and nothing else, black unless a colour is asked for.

    Raises:
        OptionError: one of these is none of what it can be, both sizes are given, or a width without a line.
    """

    view_box: ViewBox = option("em", "Show this region.", LOOK)
    size: str | None = checked(None)
    fill: str = option(CURRENT, "Colour the ink: a CSS name, #rrggbb, none or currentColor.", LOOK)
    stroke: str = option("none", "Draw a thin line along the outline, in such a colour.", LOOK)
    em: str | None = option(None, "Set how large an em is: 12pt, 20mm.", LOOK, "LENGTH", flags="--size")
    stroke_width: str | None = option(
        None, "Set the width of that line: font units, 0.01em, or 0.1mm of a drawing with a size.", LOOK, "LENGTH"
    )  # fmt: skip
    bare: bool = option(False, "Write a path in an svg, for the web, and nothing else.", LOOK)

    def __post_init__(self) -> None:
        check(self)
        if self.size is not None and self.em is not None:
            raise OptionError(f"size and em exclude each other: {self.size}, {self.em}")
        for name in ("size", "em"):
            paper_length(name, getattr(self, name))
        if self.stroke_width is not None:
            require(self.stroke != "none", "stroke_width is of a line: colour it by stroke", self.stroke_width)
            found = _LENGTH.fullmatch(str(self.stroke_width))
            known = found is not None and float(found[1]) > 0 and found[2] in ("", "em", *INCHES)
            require(known, "stroke_width is font units, 0.01em or 0.1mm", self.stroke_width)
        for name in ("fill", "stroke"):
            rule = f"{name} is a colour: a name of CSS, #rgb, #rrggbb, currentColor or none"
            require(is_colour(getattr(self, name)), rule, getattr(self, name))

    def scale(self, height: float, units_per_em: float) -> tuple[float, str] | None:
        """Length of a font unit in a drawing, by its height in font units, and its unit; None without ``size``."""
        size, em = paper_length("size", self.size), paper_length("em", self.em)
        if size:
            return size[0] / height, size[1]
        return em and (em[0] / units_per_em, em[1])

    def line(self, units_per_em: float, height: float = 1.0) -> float:
        """Width of the line along the outline in font units, by the drawing's height in font units.

        Raises:
            OptionError: it is a length on paper, and the drawing has no size.
        """
        if self.stroke_width is None:
            # Width in em of a line along the outline that says none: cutters follow its middle.
            return (1 / 1000) * units_per_em
        number, unit = _LENGTH.findall(self.stroke_width)[0]
        width = float(number)
        if unit in INCHES:
            scale = self.scale(height, units_per_em)
            if scale is None:
                raise OptionError(f"stroke_width is {self.stroke_width} of a drawing with a size, and there is none")
            return width * INCHES[unit] / (scale[0] * INCHES[scale[1]])
        return width * units_per_em if unit else width

    def open_line(self, units_per_em: float, height: float = 1.0) -> tuple[str, float]:
        """Colour and width of open paths, likewise: of the line along the outline, or else the ink's and 1/40 em."""
        if self.stroke != "none":
            return self.stroke, self.line(units_per_em, height)
        return CURRENT if self.fill == "none" else self.fill, units_per_em / 40

    def inches(self, height: float, units_per_em: float, default: float) -> float:
        """Height in inches of a drawing, by its height in font units; ``default`` without ``size``."""
        found = self.scale(height, units_per_em)
        return default if found is None else height * found[0] * INCHES[found[1]]


def paper_length(name: str, value: str | None) -> tuple[float, str] | None:
    """A length on paper and its unit.

    Raises:
        OptionError: it is none, or too long.
    """
    if value is None:
        return None
    found = _LENGTH.fullmatch(value) if isinstance(value, str) else None
    # Maximum height of a drawing, and of its em, in inches: five metres, which is what a cutter's roll takes.
    if found is None or found[2] not in INCHES or not 0 < float(found[1]) * INCHES[found[2]] <= 200.0:
        units = ", ".join(INCHES)
        raise OptionError(f"{name} is a length above 0 and up to 5 m with its unit ({units}), not {value!r}")
    return float(found[1]), found[2]


def is_colour(value: object) -> bool:
    """Whether a value is a colour that SVG, PNG and PDF know."""
    if not isinstance(value, str):
        return False
    if value in (CURRENT, "none") or _HEX.fullmatch(value):
        return True
    if not _NAME.fullmatch(value):
        return False
    from matplotlib.colors import CSS4_COLORS  # here and not above: few runs name a colour

    return value in CSS4_COLORS


PLAIN = Appearance()
"""The em box, in the colour of the text around the drawing."""


@dataclass(frozen=True)
class Settings:
    """Settings of a writer of drawings.

    Attributes:
        look: of drawings. scale: length of a font unit in the drawing, in ``unit``.
        unit: "mm", "cm", "in", "pt", "pc" or "px"; None: a font unit.
        flatness: largest distance of a polyline from its curve, in font units; None: 1/2000 em.
        dxf: contours as one spline each, as arcs and lines, or flattened. title: what SVG drawings are labelled; None:
            the glyph's name and code points.

    Raises:
        OptionError: a scale or flatness that is not positive, or an unknown kind of DXF.
    """

    look: Appearance = PLAIN
    scale: float = 1.0
    unit: str | None = None
    flatness: float | None = option(
        None, "Keep polylines within this distance of their curves, in font units. Without it, 1/2000 em.",
        WRITTEN, "UNITS", rule=positive("distance in font units"),
    )  # fmt: skip
    dxf: DxfKind = checked("spline")
    title: str | None = None

    def __post_init__(self) -> None:
        require(is_positive(self.scale), "scale is a positive number", self.scale)
        check(self)

    def flatness_for(self, units_per_em: float) -> float:
        """The flatness in font units."""
        return units_per_em * RELATIVE_FLATNESS if self.flatness is None else self.flatness

    def scaled(self, metrics: FontMetrics) -> Settings:
        """The settings with the scale of ``look``: its size is from ascender to descender. Without a size: 1, no unit.

        A font whose ascender is not above its descender is scaled by its em.
        """
        height = metrics.ascender - metrics.descender
        found = self.look.scale(height if height > 0 else metrics.units_per_em, metrics.units_per_em)
        scale, unit = found or (1.0, None)
        return replace(self, scale=scale, unit=unit)


@dataclass(frozen=True)
class Maps:
    """What curvature maps show.

    Attributes:
        comb: the curvature of the result, or of the source outline, which is exact, or both.
        corner_teeth: also draw the teeth of a smooth result in the turn of a corner.
        comb_scale: the curvature, in 1/em, of a full tooth; None: by :func:`..curves.curvature.shared_scale`.

    Raises:
        OptionError: one of these is none of what it can be.
    """

    comb: Combs = option(
        "result", "Show the curvature of the result, or of the source outline, which is exact, or both.", LOOK
    )
    comb_scale: float | None = checked(None, positive("curvature in 1/em"))
    corner_teeth: bool = checked(False)

    def __post_init__(self) -> None:
        check(self)

    def scale_for(self, units_per_em: float) -> float | None:
        """The curvature in 1/unit of a full tooth that is asked for."""
        return None if self.comb_scale is None else self.comb_scale / units_per_em


PLAIN_MAPS, BOTH = Maps(), Maps("both")
"""Maps of which nothing is asked for; those of an atlas, which shows the source beside the result."""
