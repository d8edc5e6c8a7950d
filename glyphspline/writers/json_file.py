"""A result as JSON: polygons, splines, Béziers and measures, by the schema beside this file."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Any

from ..curves.bspline import Spline
from ..fitting.results import ContourResult, GlyphResult
from .settings import Settings


def to_json(glyph: GlyphResult) -> str:
    """The result as JSON, in font units, by the schema ``glyphspline/writers/glyph.schema.json``.

    Numbers are written with all digits: control points, knots and degree of a spline read back give the same
    :class:`Spline`. What is not a finite number is null.

    Args:
        glyph: a result of :func:`convert`.

    Example:
        >>> import json
        >>> import glyphspline as gs
        >>> glyph = gs.convert(gs.open_font("fonts_test/kouzan-gyosho.ttf").outline("O"))
        >>> spline = gs.Spline(**json.loads(gs.to_json(glyph))["contours"][0]["spline"])
        >>> bool((spline.knots == glyph.contours[0].spline.knots).all())
        True
    """
    return json_text(glyph, Settings())


def json_text(glyph: GlyphResult, settings: Settings) -> str:
    """The file of a result: coordinates in the unit of the settings, knots and measures as they are."""
    contours = [_contour(contour, settings.scale) for contour in glyph.contours]
    # Of ``glyph.schema.json``: raised where a reader of the version before would misread a file.
    return as_text({"format": "glyphspline", "version": 1, **head(glyph, settings), "contours": contours})


def as_text(data: Any) -> str:
    """Data as JSON in one line, with all digits."""
    return json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":")) + "\n"


def head(glyph: GlyphResult, settings: Settings) -> dict[str, Any]:
    """What files of geometry say of a glyph, and of their coordinates."""
    outline, scale = glyph.outline, settings.scale
    return {
        "glyph": outline.name.encode(errors="replace").decode(),
        "gid": outline.gid,
        "unicodes": [f"U+{code:04X}" for code in outline.unicodes],
        "unit": settings.unit,
        "scale": scale,
        "units_per_em": float(outline.metrics.units_per_em),
        "ascender": outline.metrics.ascender * scale,
        "descender": outline.metrics.descender * scale,
        "advance": outline.advance * scale,
        "notes": list(dict.fromkeys([*outline.notes, *glyph.notes])),
        "unread": list(outline.unread),
    }


def _contour(contour: ContourResult, scale: float) -> dict[str, Any]:
    measures = {name: finite(value) for name, value in asdict(contour.measures).items()}
    return {
        "source": [(segment * scale).tolist() for segment in contour.source.drawn()],
        "points": (contour.polygon * scale).tolist(),
        "spline": None if contour.spline is None else _spline(contour.spline, scale),
        "splines": [_spline(each.spline, scale) for each in contour.interpolations],
        "beziers": [(segment * scale).tolist() for segment in contour.curve.drawn()],
        "measures": measures,
    }


def _spline(spline: Spline, scale: float) -> dict[str, Any]:
    return {
        "degree": int(spline.degree),
        "closed": bool(spline.closed),
        "knots": spline.knots.tolist(),
        "control_points": (spline.control_points * scale).tolist(),
    }


def finite(value: Any) -> Any:
    """A measure as a plain value of Python; None if it is not finite."""
    plain = value.item() if hasattr(value, "item") else value
    return None if isinstance(plain, float) and not math.isfinite(plain) else plain
