"""The errors a caller can expect: bad input is an exception that names the file, glyph and contour."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection
from numbers import Integral, Real
from typing import Any


class GlyphsplineError(Exception):
    """What the package raises by design. ``font``, ``glyph`` and ``contour`` say where, as far as it is known.

    The parts are filled in from the inside out: the interpolation knows only its polygon, the glyph
    pipeline adds contour and glyph, the run adds the font. ``str()`` gives the complete sentence.
    """

    def __init__(
        self, message: str, *, font: str | None = None, glyph: str | None = None, contour: int | None = None
    ) -> None:
        super().__init__(message)
        self.message = message
        self.font = font
        self.glyph = glyph
        self.contour = contour

    def locate(
        self, *, font: str | None = None, glyph: str | None = None, contour: int | None = None
    ) -> GlyphsplineError:
        """Add what an outer layer knows, keeping what an inner layer has set."""
        self.font = font if self.font is None else self.font
        self.glyph = glyph if self.glyph is None else self.glyph
        self.contour = contour if self.contour is None else self.contour
        return self

    def __str__(self) -> str:
        glyph = None if self.glyph is None else f"glyph {self.glyph!r}"
        contour = None if self.contour is None else f"contour {self.contour}"
        place = ", ".join(filter(None, (self.font, glyph, contour)))
        return f"{place}: {self.message}" if place else self.message


class PolygonError(GlyphsplineError, ValueError):
    """A polygon that no curve can be put through: wrong shape, not finite, or too few distinct vertices."""


class OptionError(GlyphsplineError, ValueError):
    """An option out of its range or of the wrong kind, or options that contradict each other."""


class FontError(GlyphsplineError):
    """A font that cannot be opened, or a face, axis or glyph that it does not have."""


class OutputError(GlyphsplineError, OSError):
    """A file or folder that cannot be written, or one of a run that cannot be read."""


def words_of(error: Exception) -> str:
    """The message of an exception, without the number that the system gives its errors."""
    return (isinstance(error, OSError) and error.strerror) or str(error)


def require(good: bool, rule: str, value: object) -> None:
    """Raise an OptionError, such as "step is a positive distance, not 0", unless ``good``."""
    if not good:
        raise OptionError(f"{rule}, not {value!r}")


def require_choice(name: str, value: object, choices: Collection[object] = (True, False)) -> None:
    """Raise an OptionError unless ``value`` is one of ``choices``: strings, or bools."""
    if not isinstance(value, str | bool) or value not in choices:
        raise OptionError(f"{name} is {' or '.join(map(repr, choices))}, not {value!r}")


def is_whole(value: Any, least: int, largest: int) -> bool:
    """Whether a value is an integer from ``least`` to ``largest``. A bool is not."""
    return isinstance(value, Integral) and is_number(value, least, largest)


def is_number(value: Any, least: float = -sys.float_info.max, largest: float = sys.float_info.max) -> bool:
    """Whether a value is a finite number from ``least`` to ``largest``. A bool is not."""
    real = isinstance(value, Real) and not isinstance(value, bool)
    return real and bool(least <= value <= largest)


def is_positive(value: Any, largest: float = sys.float_info.max) -> bool:
    """Whether a value is a finite number above 0 and up to ``largest``."""
    return is_number(value, math.ulp(0.0), largest)
