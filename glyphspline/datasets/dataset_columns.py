"""What the columns of a data set hold, in words: for the data card and the documents."""

from __future__ import annotations

from ..fitting.quantities import QUANTITIES

OF_GLYPHS = {
    "schema_version": "of the row",
    "glyph": "glyph name",
    "gid": "glyph index",
    "codepoints": "its characters, ascending",
    "characters": "the same as text",
    "advance": "advance width",
    "em": "the em in the row's unit of length: 1, or units per em",
    "shape": "hash of the outline in em, rounded to 1/10,000 em: equal shapes have equal ones; null without a contour",
}

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
    "bezier_degrees": "of the Bézier segments of the fit, as an SVG has them",
    "bezier_points": "their points (x, y), each shared end once",
}

OF_OUTLINES = {
    "raster": "with `--raster`: grey picture of the outline, first row on top, 255 where ink covers a pixel",
    "script": 'of the first character, by ISO 15924: "Latn", or "Zyyy" (common); null without one',
    "category": 'of the first character, by Unicode: "Lu"; null without one',
}

OF_FONTS = {
    "family": "of the name table, as the style",
    "style": "of the name table, or of the named instance",
    "weight": "of OS/2 or the location: 400 is regular",
    "width": "of OS/2 or the location: 5 is normal",
    "italic": "whether the font says so",
    "location": 'where a variable font\'s outlines are taken: "wght=400,wdth=100"',
    "units_per_em": "of the font",
    "ascender": "of the font",
    "descender": "of the font",
    "licence": 'SPDX identifier, "unknown", or "LicenseRef-…" where SPDX has none',
    "split": "the same as the file's",
    "font": "sha256 of the file: with face and location the key of `fonts.parquet`",
    "face": "which of the file's fonts",
}

OF_SETS = {
    "duplicate": "whether an earlier row, in this split or one before it, has the same shape",
}

MEASURED = {name: measure.about for name, measure in QUANTITIES.items()}
MEASURED["max_curvature"] = "of the sharpest bend: 1/radius"

ABOUT = OF_GLYPHS | OF_CONTOURS | MEASURED | OF_OUTLINES | OF_FONTS | OF_SETS
"""By name, in the order in which a table has them."""
