"""Glyphs drawn anew in all masters as a designspace: a folder with one UFO for each master, and how they are placed.

Glyphs with fewer masters than others are in the UFOs of theirs; glyphs with masters of their own, which not all share,
are at these in layers of the default's UFO. Only redrawn glyphs are in the folder, components decomposed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import astuple, replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from fontTools.designspaceLib import AxisDescriptor, DesignSpaceDocument, InstanceDescriptor, SourceDescriptor
from fontTools.ufoLib import UFOWriter
from fontTools.varLib.models import VariationModel

from ..errors import OutputError
from ..outlines.masters import DesignAxis, Masters
from ..outlines.outline import Contour
from ..readers import Font, Source
from ..types import MadeOnDemand
from .font.master_deltas import Redrawn
from .ufo_folder import as_number, draw, replacing, smooth_ends

DIGITS = 4
"""Decimals of coordinates: a handle of 10 units turns by less than 0.001 degrees."""

Place = tuple[float, ...]
"""A normalised location, rounded as fonts store it."""


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
    if path.is_symlink() or (path.exists() and not (path.is_dir() and list(path.glob("*.designspace")))):
        raise OutputError("is there already, and holds no designspace", font=str(path))
    left = {name: reason for name, new in redrawn.items() if (reason := unlike_regions(new.masters))}
    chosen = MadeOnDemand([name for name in redrawn if name not in left], redrawn.__getitem__)
    if not chosen:
        why = f": {next(iter(left.values()))}" if left else ""
        raise OutputError(f"no glyph to write{why}", font=str(path))
    with replacing(path) as partial:
        partial.mkdir(parents=True)
        _write(source, chosen, partial, family or source.family)
    return left


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
    shared = [at for at in every if all(at in places for places in of_glyph.values())]
    document = DesignSpaceDocument()
    for axis in axes:
        document.addAxis(_axis(axis))
    styles = styles_of(axes, every)
    taken: set[str] = set()
    main = f"{unused_stem(f'{family} {styles[default]}', taken)}.ufo"
    for at in every:
        style = styles[at]
        own = at in shared
        file = main if at == default or not own else f"{unused_stem(f'{family} {style}', taken)}.ufo"
        descriptor = SourceDescriptor(
            filename=file,
            name=f"{family} {style}",
            familyName=family,
            styleName=style,
            location={axis.name: design(axis, x) for axis, x in zip(axes, at, strict=True)},
            layerName=None if own else style,
        )
        document.addSource(descriptor)
    if isinstance(source, Font):
        for number, (name, location) in enumerate(source.instances.items()):
            document.addInstance(_instance(family, name, number, axes, location))
    for at, descriptor in zip(every, document.sources, strict=True):
        if descriptor.layerName is None:
            layers = [other for other in every if other not in shared] if at == default else []
            _write_ufo(source, redrawn, of_glyph, styles, at, layers, folder / str(descriptor.filename), family)
    document.write(folder / f"{unused_stem(family, set())}.designspace")


def _write_ufo(
    source: Source,
    redrawn: Mapping[str, Redrawn],
    of_glyph: Mapping[str, list[Place]],
    styles: Mapping[Place, str],
    at: Place,
    layers: list[Place],
    path: Path,
    family: str,
) -> None:
    writer = UFOWriter(path, fileCreator="org.glyphspline", validate=True)
    em, ascender, descender = map(as_number, astuple(source.metrics))
    metrics = {"unitsPerEm": em, "ascender": ascender, "descender": descender}
    writer.writeInfo(SimpleNamespace(familyName=family, styleName=styles[at], **metrics))
    order = ["public.default", *[styles[other] for other in layers]]
    for place, layer in zip([at, *layers], order, strict=True):
        glyphs = writer.getGlyphSet() if place == at else writer.getGlyphSet(layerName=layer, defaultLayer=False)
        for name, new in redrawn.items():
            if place in of_glyph[name]:
                _write_glyph(name, new, of_glyph[name].index(place), glyphs)
        glyphs.writeContents()
    writer.writeLib({"public.glyphOrder": list(redrawn)})
    writer.writeLayerContents(order)
    writer.close()


def _write_glyph(name: str, new: Redrawn, k: int, glyphs: Any) -> None:
    masters = new.masters
    in_all = [[Contour(points, contour.degrees) for points in contour.points] for contour in new.contours]
    # The flag of a point is one for all masters, as it is in editors: smooth where it is in each.
    smooth = [np.all([smooth_ends(master) for master in each], axis=0).tolist() for each in in_all]
    glyph = SimpleNamespace(width=as_number(float(masters.advances[k])), unicodes=list(masters.unicodes))
    glyphs.writeGlyph(name, glyph, lambda pen: draw([each[k] for each in in_all], DIGITS, pen, smooth))


def _axis(axis: DesignAxis) -> AxisDescriptor:
    pairs = [(user(axis, before), design(axis, after)) for before, after in axis.mapping]
    bent = list(dict.fromkeys(pair for pair in pairs if axis.minimum <= pair[0] <= axis.maximum))
    return AxisDescriptor(
        tag=axis.tag,
        name=axis.name,
        minimum=as_number(axis.minimum),
        default=as_number(axis.default),
        maximum=as_number(axis.maximum),
        map=bent if any(one != other for one, other in bent) else [],
    )


def user(axis: DesignAxis, x: float) -> float | int:
    """A normalised value before the axis's mapping in user space; whole where a font cannot tell it from a whole."""
    side = axis.default - axis.minimum if x < 0 else axis.maximum - axis.default
    value = axis.default + x * side
    near = round(value)
    return near if abs(value - near) <= side / 32768 else round(value, 5)


design = user
"""Design coordinates are normalised values after the mapping, on the scale of user space."""


def _instance(
    family: str, name: str, number: int, axes: tuple[DesignAxis, ...], location: Mapping[str, float]
) -> InstanceDescriptor:
    at = {axis.name: design(axis, axis.normalised(location.get(axis.tag, axis.default))) for axis in axes}
    return InstanceDescriptor(name=f"instance_{number}", familyName=family, styleName=name, designLocation=at)


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
