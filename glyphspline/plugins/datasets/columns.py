"""The columns of a data set's rows, their types and units, and what they hold in words: schema version 2.

With ``rows="glyph"`` each column of a contour is a list with an item for each contour; with ``rows="contour"`` it is
that item. Contours are stored by the rules of :mod:`.canonical_outlines`, whatever way the font has them.
Lengths are in em or in font units (*normalise*), y up; the metadata of each field says its unit.

A *point* is a list (x, y): of float in ``points`` and ``tangents``, of double elsewhere. Lists of ``points`` points,
and the rows of a raster, have a fixed size in the schema too. A measure is null where it was not computed.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from ...extras import need
from ...fitting.results import QUANTITIES
from .spec import DatasetSpec
from .table import POWERS, fit_columns, measure_types, source_columns, types_of

SCHEMA_VERSION = 2
"""Of the rows. A program reads the rows of its own version and of all before; the first has no ``spline_…``."""

OF_GLYPHS = {
    "schema_version": ("uint16", "of the row"),
    "glyph": ("string", "glyph name"),
    "gid": ("uint32", "glyph index"),
    "codepoints": ("uint32[]", "its characters, ascending"),
    "characters": ("string", "the same as text"),
    "advance": ("double", "advance width"),
    "em": ("double", "the em in the row's unit of length: 1, or units per em"),
    "shape": (
        "string",
        "hash of the outline in em, rounded to 1/10,000 em: equal shapes have equal ones; null without a contour",
    ),
}
"""Types and meanings of the columns that a glyph has."""

OF_CONTOURS = {
    "contour": "with rows of contours: which of the glyph, from 0",
    "points": (
        "(x, y) at equal arc lengths of the exact curve, the fit or else the outline, from its point with the least"
        " x + y on; with `--points polygon` the polygon's vertices, or where segments meet"
    ),
    "tangents": "(x, y) of length 1 at the points; at a corner, of what follows it",
    "curvature": "signed, at the points: positive where the contour turns left; null at a cusp",
    "corner": "whether the point is the nearest, along the contour, of a corner",
    "source_degrees": "of the Bézier segments of the outline",
    "source_points": "their points (x, y), each shared end once",
    "polygon": "points of the outline that the fit passes through; null without a fit, as all down to `source_kept`",
    "closed": "of each spline of the contour: whether it is closed",
    "degree": "of each spline",
    "knots": "of each spline",
    "control_points": "(x, y), of each spline",
    "footpoints": "of each spline: the parameter of each vertex of the polygon",
    "spline_knots": "of the contour as one closed cubic spline, lines included; triple at corners",
    "spline_points": "its control points (x, y)",
    "bezier_degrees": "of the Bézier segments of the fit, as an SVG has them",
    "bezier_points": "their points (x, y), each shared end once",
}

OF_FONTS = {
    "script": ("string", 'of the character asked for, or its usual one, by ISO 15924: "Latn", or "Zyyy" (common)'),
    "category": ("string", 'of that character, by Unicode: "Lu"; null without one, as script'),
    "family": ("string", "of the name table, as the style"),
    "style": ("string", "of the name table, or of the named instance"),
    "weight": ("uint16", "of OS/2 or the location: 400 is regular"),
    "width": ("uint16", "of OS/2 or the location: 5 is normal"),
    "italic": ("bool", "whether the font says so"),
    "location": ("string", 'where a variable font\'s outlines are taken: "wght=400,wdth=100"'),
    "units_per_em": ("double", "of the font"),
    "ascender": ("double", "of the font"),
    "descender": ("double", "of the font"),
    "licence": ("string", 'SPDX identifier, "unknown", or "LicenseRef-…" where SPDX has none'),
    "split": ("string", "the same as the file's"),
    "font": ("string", "sha256 of the file: with face and location the key of `fonts.parquet`"),
    "face": ("uint32", "which of the file's fonts"),
    "duplicate": ("bool", "whether an earlier row, in this split or one before it, has the same shape"),
}
"""Types and meanings of the columns that depend on the font and on other rows."""

ABOUT: dict[str, str] = {
    **{name: about for name, (_, about) in OF_GLYPHS.items()},
    **OF_CONTOURS,
    **{name: measure.about for name, measure in QUANTITIES.items()},
    "max_curvature": "of the sharpest bend: 1/radius",
    "raster": "with `--raster`: grey picture of the outline, first row on top, 255 where ink covers a pixel",
    "raster_side": "side of that square: an em, or more where the ink needs it",
    **{name: about for name, (_, about) in OF_FONTS.items()},
}
"""What each column holds, in the order in which a table has them."""

LENGTHS = (
    "advance", "em", "points", "source_points", "polygon", "knots", "control_points", "footpoints",
    "spline_knots", "spline_points", "bezier_points", "ascender", "descender", "raster_side",
)  # fmt: skip
"""Columns in the unit of length, beside the measures."""


def type_of(name: str) -> Any:
    """The Arrow type of a name such as "string", or "string[]" for lists."""
    pa = need("parquet")
    return pa.list_(type_of(name[:-2])) if name.endswith("[]") else pa.type_for_alias(name)


@cache  # each chunk of rows asks for it
def schema(spec: DatasetSpec, of_fonts: bool = False) -> Any:
    """The columns of rows as an Arrow schema, with those of their fonts if asked for; fields have units as metadata."""
    pa = need("parquet")
    unit = "em" if spec.normalise == "em" else "font unit"
    powers = dict.fromkeys(LENGTHS, 1) | POWERS | {"curvature": -1}
    units = {name: {1: unit, 2: f"{unit}^2", -1: f"1/{unit}"}[power] for name, power in powers.items()}
    units |= {"units_per_em": "font unit", "location": "user space"}
    listed = contour_types(spec)
    if spec.rows == "glyph":
        listed = {name: pa.list_(kind) for name, kind in listed.items()}
    else:
        listed = {"contour": pa.uint32()} | listed
    kinds = {name: type_of(kind) for name, (kind, _) in OF_GLYPHS.items()} | listed
    if spec.raster is not None:
        kinds["raster"] = pa.list_(pa.list_(pa.uint8(), spec.raster), spec.raster)
        kinds["raster_side"] = pa.float32()
    if of_fonts:
        kinds |= {name: type_of(kind) for name, (kind, _) in OF_FONTS.items()}
    facts = {"schema": str(SCHEMA_VERSION), "rows": spec.rows, "unit": unit}
    metadata = {f"glyphspline.datasets.{name}": value for name, value in facts.items()}
    fields = [
        pa.field(name, kind, metadata={"unit": units[name]} if name in units else None) for name, kind in kinds.items()
    ]
    return pa.schema(fields, metadata=metadata)


def contour_types(spec: DatasetSpec) -> dict[str, Any]:
    """Arrow types of the columns that a contour has."""
    pa = need("parquet")
    point, size = pa.list_(pa.float32(), 2), -1 if spec.points is None else spec.points
    kinds = {"points": point, "tangents": point, "curvature": pa.float32(), "corner": pa.bool_()}
    return (
        {name: pa.list_(kind, size) for name, kind in kinds.items()}
        | types_of(source_columns)
        | types_of(fit_columns)
        | measure_types()
    )
