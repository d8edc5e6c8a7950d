"""Rows of a data set, made in a worker: glyphs or contours as an Arrow table, from flat arrays, and grey pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from hashlib import blake2b
from typing import Any
from unicodedata import category, normalize

import numpy as np

from ...errors import GlyphsplineError, OptionError
from ...extras import need
from ...fitting.convert import convert_many, unfitted
from ...fitting.measures import check_coordinates
from ...fitting.results import ConvertedContours, GlyphResult, as_glyphs, joined_results
from ...outlines.contour_arrays import ContourArrays
from ...outlines.outline import FontMetrics, Outline
from ...outlines.sampling import CORNER_ANGLE
from ...readers.clusters import unified
from ...types import FloatArray, IntArray
from .canonical_outlines import canonical_outlines
from .columns import OF_FONTS, OF_GLYPHS, SCHEMA_VERSION, schema, type_of
from .resampling import at_vertices, resampled
from .scan import FontFacts, script_of
from .spec import DatasetSpec
from .table import fit_columns, measure_columns, nested, pairs, source_columns


def fits_of(outlines: Sequence[Outline], spec: DatasetSpec) -> list[GlyphResult | GlyphsplineError]:
    """The fit of outlines by the options of ``spec``, whatever way their font stores them; errors in their places.

    Overlaps are removed first, if the options say so; what is fitted then is as :func:`.canonical_outlines` has it.

    Raises:
        OptionError: the spec has no options.
    """
    if spec.options is None:
        raise OptionError("a fit needs options")
    united = unfitted(outlines, spec.options)
    whole = [result.outline for result in united if isinstance(result, GlyphResult)]
    found = iter(convert_many(canonical_outlines(whole), replace(spec.options, remove_overlaps=False), errors="return"))
    return [next(found) if isinstance(result, GlyphResult) else result for result in united]


def table_of(outlines: Sequence[Outline], results: Sequence[GlyphResult | None] | None, spec: DatasetSpec) -> Any:
    """Rows of the glyphs of one font, or of some of them, with the columns of :mod:`.columns`.

    Args:
        outlines: as their font has them.
        results: of :func:`fits_of`, for each one that is no error; None, or None for each, where nothing is fitted.
        spec: what the rows hold; its filters and split are not looked at.

    Returns:
        A ``pyarrow.Table``: a row for each outline, or for each of their contours, in order.

    Raises:
        GlyphsplineError: a coordinate is not finite or far too large; or pyarrow, of the extra ``parquet``, is not
            installed.

    Example:
        >>> from glyphspline import open_font
        >>> from glyphspline.datasets.spec import DatasetSpec
        >>> outlines = [open_font("fonts_test/kouzan-gyosho.ttf").outline("O")]
        >>> table_of(outlines, None, DatasetSpec(rows="contour", options=None)).num_rows
        2
    """
    pa, layout = need("parquet"), schema(spec)
    fitted = [result for result in results or () if result is not None]
    glyphs = fitted or as_glyphs(canonical_outlines(outlines))
    if len(glyphs) != len(outlines):
        raise ValueError(f"{len(fitted)} results for {len(outlines)} outlines")
    found, offsets = joined_results(glyphs)
    check_coordinates(found.source)
    ems = np.array([glyph.outline.metrics.units_per_em for glyph in glyphs], dtype=np.float64)
    scales = ems if spec.normalise == "em" else np.ones(len(glyphs))
    owner = np.repeat(np.arange(len(glyphs)), np.diff(offsets))
    factors = 1.0 / scales[owner]
    columns = _point_columns(found, factors, bool(fitted), spec) | source_columns(found, factors)
    if fitted:
        columns |= fit_columns(found, factors) | measure_columns(found, factors)
    of_glyph = _glyph_columns([glyph.outline for glyph in glyphs], scales)
    hashed = offsets if spec.rows == "glyph" else np.arange(len(found) + 1)
    if spec.raster is not None:
        outlined = [glyph.outline for glyph in glyphs]
        of_glyph["raster"], sides = rasters(outlined, found.source, offsets, spec.raster)
        of_glyph["raster_side"] = pa.array(sides / scales, pa.float32())
    if spec.rows == "glyph":
        columns = {name: nested(column, offsets) for name, column in columns.items()}
    else:
        of_glyph = {name: column.take(pa.array(owner)) for name, column in of_glyph.items()}
        columns["contour"] = pa.array(np.arange(len(found)) - offsets[owner], pa.uint32())
    columns |= of_glyph
    columns["shape"] = pa.array(shapes(found, ems[owner], hashed), pa.string())
    rows = len(hashed) - 1
    columns |= {field.name: pa.nulls(rows, field.type) for field in layout if field.name not in columns}  # no fit
    return pa.Table.from_arrays([columns[name] for name in layout.names], schema=layout)


def shapes(found: ConvertedContours, ems: FloatArray, offsets: IntArray) -> list[str | None]:
    """For each group of source contours a hash of its coordinates in em, rounded; None for no contours.

    Args:
        ems: (C,) units per em. offsets: (R + 1,) where the contours of each group begin.
    """
    source = found.source
    # Steps an em to which coordinates are rounded before outlines are compared.
    points = np.rint(source.points * (10_000 / np.repeat(ems, np.diff(source.starts)))[:, None]).astype("<i4")
    degrees = source.degrees.astype(np.uint8)
    degrees[source.offsets[:-1]] += 8  # where a contour begins
    hashes: list[str | None] = []
    starts, firsts = source.starts[offsets].tolist(), source.offsets[offsets].tolist()
    for k in range(len(offsets) - 1):
        if firsts[k] == firsts[k + 1]:
            hashes.append(None)
            continue
        hashed = blake2b(degrees[firsts[k] : firsts[k + 1]].tobytes(), digest_size=16)
        hashed.update(points[starts[k] : starts[k + 1]].tobytes())
        hashes.append(hashed.hexdigest())
    return hashes


def _point_columns(found: ConvertedContours, factors: FloatArray, fitted: bool, spec: DatasetSpec) -> dict[str, Any]:
    """Points of each contour with tangents, curvature and corners."""
    pa = need("parquet")
    angle = np.radians(spec.options.corner_angle if fitted and spec.options is not None else CORNER_ANGLE)
    if spec.points is None:
        at = at_vertices(found.curves, found.polygons, angle)
    else:
        at = resampled(found.curves, spec.points, angle)
    each = np.repeat(factors, np.diff(at.offsets))
    curvature = (at.curvature / each).astype(np.float32)
    columns = {
        "points": pairs((at.points * each[:, None]).astype(np.float32)),
        "tangents": pairs(at.tangents.astype(np.float32)),
        "curvature": pa.array(curvature, mask=~np.isfinite(curvature)),
        "corner": pa.array(at.corners),
    }
    if spec.points is None:
        return {name: nested(column, at.offsets) for name, column in columns.items()}
    return {name: pa.FixedSizeListArray.from_arrays(column, spec.points) for name, column in columns.items()}


def _glyph_columns(outlines: Sequence[Outline], scales: FloatArray) -> dict[str, Any]:
    """What a glyph is called, and its metrics."""
    values: dict[str, Any] = {
        "schema_version": [SCHEMA_VERSION] * len(outlines),
        "glyph": [outline.name for outline in outlines],
        "gid": [outline.gid for outline in outlines],
        "codepoints": [outline.unicodes for outline in outlines],
        "characters": ["".join(map(chr, outline.unicodes)) for outline in outlines],
        "advance": np.array([outline.advance for outline in outlines], dtype=np.float64) / scales,
        "em": np.array([outline.metrics.units_per_em for outline in outlines], dtype=np.float64) / scales,
    }
    return {name: need("parquet").array(value, type_of(OF_GLYPHS[name][0])) for name, value in values.items()}


def with_font(
    table: Any, outlines: Sequence[Outline], font: FontFacts, spec: DatasetSpec, asked: Mapping[int, str | None]
) -> Any:
    """The table with the columns of script, category and font, and one for duplicates that is not filled yet.

    Script and category are of the character that was ``asked`` for, by glyph index, or else the unified one.
    Strings are plain ones, as libraries of data sets expect; files keep each distinct one once a row group.
    """
    pa, layout = need("parquet"), schema(spec, of_fonts=True)
    called = {outline.gid: chr(unified(outline.unicodes)) for outline in outlines if outline.unicodes}
    called |= {gid: normalize("NFC", character)[0] for gid, character in asked.items() if character}
    characters = [called.get(gid) for gid in table["gid"].to_pylist()]
    metrics = outlines[0].metrics if outlines else FontMetrics()  # of all in a batch: drawings have their own
    unit = 1.0 if spec.normalise == "units" else metrics.units_per_em
    values = {
        "family": font.family, "style": font.style, "weight": font.weight_class, "width": font.width_class,
        "italic": font.italic, "location": font.location, "units_per_em": metrics.units_per_em,
        "ascender": metrics.ascender / unit, "descender": metrics.descender / unit, "licence": font.licence,
        "split": font.split, "font": font.sha256, "face": font.face, "duplicate": None,
    }  # fmt: skip
    rows = len(characters)
    columns = {name: pa.repeat(pa.scalar(value, layout.field(name).type), rows) for name, value in values.items()}
    for name, of_character in (("script", script_of), ("category", category)):
        columns[name] = pa.array([character and of_character(character) for character in characters], pa.string())
    return pa.Table.from_arrays([*table.columns, *(columns[name] for name in OF_FONTS)], schema=layout)


def rasters(
    outlines: Sequence[Outline], contours: ContourArrays, offsets: IntArray, size: int
) -> tuple[Any, FloatArray]:
    """Pictures of ``size`` by ``size`` pixels of glyphs, as an Arrow array of lists of rows, the first on top.

    Agg, which matplotlib brings along, weighs each pixel by the share of it that the outline covers, in 256 steps,
    under the non-zero rule. The picture is a square of one em: from left to right its middle is that of the advance,
    from bottom to top that between descender and ascender. Where ink is beyond, it is the square about both.

    Args:
        contours: of all outlines; offsets: (G + 1,) where those of each begin.

    Returns:
        The pictures; (G,) their sides in font units.
    """
    from matplotlib.backends.backend_agg import RendererAgg
    from matplotlib.path import Path
    from matplotlib.transforms import Affine2D

    renderer = RendererAgg(size, size, 72)
    context = renderer.new_gc()
    context.set_linewidth(0.0)
    context.set_snap(False)
    pictures = np.zeros((len(outlines), size, size), dtype=np.uint8)
    sides = np.array([outline.metrics.units_per_em for outline in outlines], dtype=np.float64)
    for g, outline in enumerate(outlines):
        own = contours.part(int(offsets[g]), int(offsets[g + 1]))
        if not own.num_contours:
            continue
        em, metrics = outline.metrics.units_per_em, outline.metrics
        path = Path(*_path(own))
        low = np.array([outline.advance - em, metrics.ascender + metrics.descender - em]) / 2
        ink = path.get_extents()
        least, most = np.minimum(low, ink.min), np.maximum(low + em, ink.max)
        if (least < low).any() or (most > low + em).any():
            sides[g] = (most - least).max()
            low = (least + most - sides[g]) / 2
        renderer.clear()
        placed = Affine2D().translate(*-low).scale(size / sides[g])
        renderer.draw_path(context, path, placed, (0.0, 0.0, 0.0))
        pictures[g] = np.asarray(renderer.buffer_rgba())[..., 3]
    pa = need("parquet")
    lines = pa.FixedSizeListArray.from_arrays(pa.array(pictures.ravel()), size)
    return pa.FixedSizeListArray.from_arrays(lines, size), sides


def _path(contours: ContourArrays) -> tuple[Any, Any]:
    """Vertices and codes of matplotlib's path."""
    move, close = 1, 79
    vertices, codes = list[FloatArray](), list[Any]()
    for c in range(contours.num_contours):
        part = contours.part(c, c + 1)
        vertices += [part.points, part.points[:1], part.points[:1]]
        drawn = np.repeat(part.degrees + 1, part.degrees)  # LINETO 2, CURVE3 3, CURVE4 4
        codes += [[move], drawn, [close]]
    return np.concatenate(vertices), np.concatenate(codes).astype(np.uint8)
