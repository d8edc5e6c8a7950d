"""How a glyph's drawing looks: the region shown, its size on paper, and its colours."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, get_args

from ...errors import OptionError, require, require_choice
from .markup import number

ViewBox = Literal["em", "metrics", "ink"]
VIEW_BOXES: tuple[ViewBox, ...] = get_args(ViewBox)

INCHES = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0, "pt": 1 / 72, "pc": 1 / 6, "px": 1 / 96}
"""Units of lengths in CSS and SVG, in inches."""

LARGEST = 200.0
"""Maximum height of a drawing in inches: five metres, which is what a cutter's roll takes."""

_LENGTH = re.compile(rf"(\d{{1,6}}(?:\.\d{{1,6}})?)({'|'.join(INCHES)})")
_HEX = re.compile(r"#(?:[0-9a-fA-F]{3}|[0-9a-fA-F]{6})")
_NAME = re.compile(r"[a-z]{3,20}")

CURRENT = "currentColor"


@dataclass(frozen=True)
class Appearance:
    """How drawings of glyphs look.

    Attributes:
        view_box: the region shown; see :func:`..svg.document.to_svg`.
        size: height of the drawing with its unit (mm, cm, in, pt, pc, px), its width in proportion; None: none is said.
        fill: colour of the ink: "currentColor", "none", #rgb, #rrggbb or a name of CSS.
        stroke: colour of a line of 1/1000 em along the outline, likewise.

    Raises:
        OptionError: one of these is none of what it can be.
    """

    view_box: ViewBox = "em"
    size: str | None = None
    fill: str = CURRENT
    stroke: str = "none"

    def __post_init__(self) -> None:
        require_choice("view_box", self.view_box, VIEW_BOXES)
        if self.size is not None:
            self.inches(1.0)
        for name in ("fill", "stroke"):
            rule = f"{name} is a colour: a name of CSS, #rgb, #rrggbb, currentColor or none"
            require(is_colour(getattr(self, name)), rule, getattr(self, name))

    def inches(self, default: float) -> float:
        """The height in inches, ``default`` where none is said."""
        if self.length is None:
            return default
        value, unit = self.length
        return value * INCHES[unit]

    def attributes(self, width: float, height: float) -> str:
        """Width and height of a document whose view box is so many units wide and high, as attributes."""
        if self.length is None:
            return ""
        value, unit = self.length
        return f' width="{number(value * width / height, 4)}{unit}" height="{number(value, 6)}{unit}"'

    @property
    def length(self) -> tuple[float, str] | None:
        """The height as a number and its unit; None where none is said."""
        if self.size is None:
            return None
        found = _LENGTH.fullmatch(self.size) if isinstance(self.size, str) else None
        if found is None or not 0 < float(found[1]) * INCHES[found[2]] <= LARGEST:
            units = ", ".join(INCHES)
            raise OptionError(f"size is a height above 0 and up to 5 m with its unit ({units}), not {self.size!r}")
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
