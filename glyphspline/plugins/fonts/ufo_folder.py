"""Outlines as UFO 3 folders, for font editors; they contain converted glyphs only.

A result: cubics are those of the splines, split exactly at extrema (those of continuity "g2" have points where the
source has them), with points marked smooth where the curve is. The
layer ``public.background`` contains the polygon of each contour; each glyph's ``lib`` contains, under
``org.glyphspline.contours``, the splines' knots, footpoint parameters and measures.

Glyphs drawn anew in all masters: a designspace, a folder with one UFO for each master, and how they are placed. Glyphs
with fewer masters than others are only in the UFOs of those masters; glyphs with masters of their own, which not all
share, are at these in layers of the default's UFO. Components are decomposed.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, astuple, replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from fontTools.designspaceLib import DesignSpaceDocument
from fontTools.ufoLib import UFOWriter
from fontTools.varLib.models import VariationModel

from ...errors import OutputError
from ...fitting.results import ContourResult, GlyphResult
from ...outlines.extrema import with_extrema
from ...outlines.masters import DesignAxis, Masters
from ...outlines.outline import Contour
from ...readers import Font, Source
from ...types import MadeOnDemand
from ...writers.json_file import finite
from .back.nodes import as_number, nodes_of, smooth_ends
from .tables.master_deltas import Redrawn

LIB_KEY = "org.glyphspline.contours"
OPTIONS_KEY = "org.glyphspline.options"
BACKGROUND = "public.background"

Place = tuple[float, ...]
"""A normalised location, rounded as fonts store it."""


def write_ufo(source: Source, glyphs: Iterable[GlyphResult], path: str | Path, *, family: str | None = None) -> int:
    """Write the folder, replacing an older one; returns the number of glyphs.

    Args:
        source: what the glyphs were read from. glyphs: results, each glyph once, read one by one.
        path: the folder. family: the name; None is the source's with "Spline".

    Raises:
        OutputError: something at ``path`` is not a UFO. OSError: it cannot be written.
    """
    path = Path(path)
    with replacing(path, "is no UFO", "metainfo.plist") as partial:
        writer = _opened(partial, source, family or f"{source.family} Spline", source.style)
        layers = [writer.getGlyphSet(), writer.getGlyphSet(layerName=BACKGROUND, defaultLayer=False)]
        order = []
        for result in glyphs:
            order.append(result.outline.name)
            write_glyph(result, *layers)
        _close(writer, {"public.default": layers[0], BACKGROUND: layers[1]}, order)
    return len(order)


def write_designspace(
    source: Source, redrawn: Mapping[str, Redrawn], path: str | Path, *, family: str | None = None
) -> dict[str, str]:
    """Write the folder, replacing an older one.

    Args:
        source: what the glyphs were read from. redrawn: glyph name to its new contours, read one by one, some times.
        path: the folder. family: the name; None is the source's.

    Returns:
        Why glyphs were left out. A font made from the folder derives the regions of a glyph from its masters; a glyph
        whose regions are others would have other instances.

    Raises:
        OutputError: nothing is left to write, or something at ``path`` is no folder of a designspace.
        OSError: it cannot be written.
    """
    path = Path(path)
    with replacing(path, "holds no designspace", "*.designspace") as partial:
        left = {name: reason for name, new in redrawn.items() if (reason := unlike_regions(new.masters))}
        chosen = MadeOnDemand([name for name in redrawn if name not in left], redrawn.__getitem__)
        if not chosen:
            why = f": {next(iter(left.values()))}" if left else ""
            raise OutputError(f"no glyph to write{why}", font=str(path))
        partial.mkdir(parents=True)
        _write(source, chosen, partial, family or source.family)
    return left


@contextmanager
def replacing(folder: Path, otherwise: str, *marks: str) -> Iterator[Path]:
    """A folder beside another one, to be filled within; it then takes that one's place.

    Raises:
        OutputError: what is there has none of the files ``marks``, which the error says in the words ``otherwise``.
    """
    if folder.is_symlink() or (folder.exists() and not any(any(folder.glob(mark)) for mark in marks)):
        raise OutputError(f"is there already, and {otherwise}", font=str(folder))
    partial = folder.with_name(f".{folder.name}.part")
    shutil.rmtree(partial, ignore_errors=True)
    yield partial
    if folder.exists():
        shutil.rmtree(folder)
    partial.replace(folder)


def _opened(path: Path, source: Source, family: str, style: str) -> UFOWriter:
    writer = UFOWriter(path, fileCreator="org.glyphspline", validate=True)
    em, ascender, descender = map(as_number, astuple(source.metrics))
    metrics = {"unitsPerEm": em, "ascender": ascender, "descender": descender}
    writer.writeInfo(SimpleNamespace(familyName=family, styleName=style, **metrics))
    return writer


def _close(writer: UFOWriter, layers: Mapping[str, Any], order: Sequence[str]) -> None:
    for glyphs in layers.values():
        glyphs.writeContents()
    writer.writeLib({"public.glyphOrder": list(order)})
    writer.writeLayerContents(list(layers))
    writer.close()


def write_glyph(result: GlyphResult, front: Any, back: Any) -> None:
    """Write one glyph to the default layer and its polygons to the background."""
    outline, digits = result.outline, result.options.precision
    curves = [[curve] for curve in stored_curves(result)]
    lines = [[Contour(c.polygon, np.ones(len(c.polygon), dtype=np.int64))] for c in result.contours if len(c.polygon)]
    lib = {LIB_KEY: [_lib_entry(contour) for contour in result.contours], OPTIONS_KEY: _plain(result.options.facts())}
    width, note = as_number(outline.advance), "\n".join(result.notes) or None
    glyph = SimpleNamespace(width=width, unicodes=list(outline.unicodes), note=note, lib=lib)
    front.writeGlyph(outline.name, glyph, lambda pen: draw(curves, digits, pen))
    back.writeGlyph(outline.name, SimpleNamespace(width=width), lambda pen: draw(lines, digits, pen))


def stored_curves(result: GlyphResult) -> list[Contour]:
    """The contours of a result as a UFO stores them: with points at extrema, which those for fonts have already."""
    curves, em = [contour.curve for contour in result.contours], result.outline.metrics.units_per_em
    return curves if result.options.is_for_fonts else [with_extrema(curve, em) for curve in curves]


def draw(contours: Iterable[Sequence[Contour]], digits: int, pen: Any, master: int = 0) -> None:
    """Draw contours with a point pen in one of their masters, rounded."""
    for masters in contours:
        pen.beginPath()
        for node in nodes_of(masters[master].rounded(digits), smooth_ends(masters)):
            pen.addPoint(node.at, node.kind, node.smooth)
        pen.endPath()


def _lib_entry(contour: ContourResult) -> dict[str, Any]:
    splines = [
        {"closed": s.closed, "degree": s.degree, "knots": s.knots.tolist(), "parameters": one.parameters.tolist()}
        for one in contour.interpolations
        for s in [one.spline]
    ]
    return {"splines": splines, "measures": _plain(asdict(contour.measures))}


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """The values that a property list can store: neither None nor infinite."""
    return {name: value for name, value in values.items() if finite(value) is not None}


def unlike_regions(masters: Masters) -> str | None:
    """Why a font built from the masters would not have their regions; None if it would."""
    tags = [axis.tag for axis in masters.axes]
    peaks = [dict(zip(tags, place, strict=True)) for place in places_of(masters)]
    if len({tuple(peak.items()) for peak in peaks}) < len(peaks):
        return "two of its masters are at one place"
    supports = VariationModel([{tag: x for tag, x in peak.items() if x} for peak in peaks], axisOrder=tags).supports
    regions = [[support.get(tag, (0.0, 0.0, 0.0)) for tag in tags] for support in supports[1:]]
    built = replace(masters, regions=np.array(regions, dtype=np.float64).reshape(masters.regions.shape))
    # Between the corners of a grid for both, weights are products of linear functions: equal there, equal everywhere.
    corners = replace(masters, regions=np.concatenate([masters.regions, built.regions])).grid()
    order = [places_of(masters).index(place) for place in places_of(built)]
    if np.abs(built.weights_at(corners) - masters.weights_at(corners)[:, order]).max() < 1e-6:
        return None
    return "its regions are not those that follow from the places of its masters"


def places_of(masters: Masters) -> list[Place]:
    """Where a glyph's masters are."""
    return [tuple(float(x) for x in peak) for peak in np.round(masters.peaks * 16384) / 16384 + 0.0]


def _write(source: Source, redrawn: Mapping[str, Redrawn], folder: Path, family: str) -> None:
    axes = next(iter(redrawn.values())).masters.axes
    of_glyph = {name: places_of(new.masters) for name, new in redrawn.items()}
    default = (0.0,) * len(axes)
    every = sorted({place for places in of_glyph.values() for place in places}, key=lambda at: (at != default, at))
    layered = [at for at in every if not all(at in places for places in of_glyph.values())]
    document, styles, taken = DesignSpaceDocument(), styles_of(axes, every), set[str]()
    for axis in axes:
        pairs = [(on_axis(axis, before), on_axis(axis, after)) for before, after in axis.mapping]
        bent = list(dict.fromkeys(pair for pair in pairs if axis.minimum <= pair[0] <= axis.maximum))
        limits = {key: as_number(getattr(axis, key)) for key in ("minimum", "default", "maximum")}
        mapping = bent if any(one != other for one, other in bent) else []
        document.addAxisDescriptor(tag=axis.tag, name=axis.name, map=mapping, **limits)
    main = f"{unused_stem(f'{family} {styles[default]}', taken)}.ufo"
    for at in every:
        style, own = f"{family} {styles[at]}", at != default and at not in layered
        descriptor = document.addSourceDescriptor(
            filename=f"{unused_stem(style, taken)}.ufo" if own else main,
            name=style,
            familyName=family,
            styleName=styles[at],
            location={axis.name: on_axis(axis, x) for axis, x in zip(axes, at, strict=True)},
            layerName=styles[at] if at in layered else None,
        )
        if at not in layered:
            writer = _opened(folder / str(descriptor.filename), source, family, styles[at])
            layers = {"public.default": writer.getGlyphSet()}
            layers |= {
                styles[other]: writer.getGlyphSet(layerName=styles[other], defaultLayer=False)
                for other in (layered if at == default else ())
            }
            for place, glyphs in zip([at, *layered], layers.values(), strict=False):
                for name, new in redrawn.items():
                    if place in of_glyph[name]:
                        _write_master(name, new, of_glyph[name].index(place), glyphs)
            _close(writer, layers, list(redrawn))
    for number, (name, location) in enumerate(source.instances.items() if isinstance(source, Font) else ()):
        user = {axis.name: on_axis(axis, axis.normalised(location.get(axis.tag, axis.default))) for axis in axes}
        document.addInstanceDescriptor(
            name=f"instance_{number}", familyName=family, styleName=name, designLocation=user
        )
    document.write(folder / f"{unused_stem(family, set())}.designspace")


def _write_master(name: str, new: Redrawn, k: int, glyphs: Any) -> None:
    masters = new.masters
    in_all = [[Contour(points, contour.degrees) for points in contour.points] for contour in new.contours]
    glyph = SimpleNamespace(width=as_number(float(masters.advances[k])), unicodes=list(masters.unicodes))
    # Decimals of coordinates: a handle of 10 units turns by less than 0.001 degrees.
    glyphs.writeGlyph(name, glyph, lambda pen: draw(in_all, 4, pen, k))


def on_axis(axis: DesignAxis, x: float) -> float | int:
    """A normalised value in user space, or after the axis's mapping in design space, which has the same scale.

    It is whole where a font cannot tell it from a whole number.
    """
    side = axis.default - axis.minimum if x < 0 else axis.maximum - axis.default
    value = axis.default + x * side
    near = round(value)
    return near if abs(value - near) <= side / 32768 else round(value, 5)


def styles_of(axes: tuple[DesignAxis, ...], places: list[Place]) -> dict[Place, str]:
    """The names of masters: their places in user space, without axes at their default, in as few digits as do."""
    for digits in range(4, 18):
        values = [[(axis, axis.user(x)) for axis, x in zip(axes, at, strict=True) if x] for at in places]
        names = [" ".join(f"{axis.tag}{value:.{digits}g}" for axis, value in each) or "Default" for each in values]
        if len(set(names)) == len(names):
            break
    return dict(zip(places, names, strict=True))


def unused_stem(text: str, taken: set[str]) -> str:
    """A file name for a text, other than those taken, without regard to case."""
    base = re.sub(r"[^\w.-]+", "-", text).strip(".-") or "masters"
    stem = next(stem for k in count(1) if (stem := base if k == 1 else f"{base}-{k}").lower() not in taken)
    taken.add(stem.lower())
    return stem
