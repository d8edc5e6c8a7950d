"""Glyphs drawn anew in all masters as a designspace: a folder with one UFO for each master, and how they are placed.

Glyphs with fewer masters than others are only in the UFOs of those masters; glyphs with masters of their own, which not
all share, are at these in layers of the default's UFO. Components are decomposed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from fontTools.designspaceLib import DesignSpaceDocument
from fontTools.varLib.models import VariationModel

from ...errors import OutputError
from ...outlines.masters import DesignAxis, Masters
from ...outlines.outline import Contour
from ...readers import Font, Source
from ...types import MadeOnDemand
from ..fonts.back.nodes import as_number
from ..fonts.ufo_folder import close, draw, replacing, writer_of
from .redrawn import Redrawn


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


def unlike_regions(masters: Masters) -> str | None:
    """Why a font built from the masters would not have their regions; None if it would."""
    tags = [axis.tag for axis in masters.axes]
    peaks = [dict(zip(tags, place, strict=True)) for place in masters.stored_peaks]
    if len({tuple(peak.items()) for peak in peaks}) < len(peaks):
        return "two of its masters are at one place"
    supports = VariationModel([{tag: x for tag, x in peak.items() if x} for peak in peaks], axisOrder=tags).supports
    regions = [[support.get(tag, (0.0, 0.0, 0.0)) for tag in tags] for support in supports[1:]]
    built = replace(masters, regions=np.array(regions, dtype=np.float64).reshape(masters.regions.shape))
    # Between the corners of a grid for both, weights are products of linear functions: equal there, equal everywhere.
    corners = replace(masters, regions=np.concatenate([masters.regions, built.regions])).grid()
    order = [masters.stored_peaks.index(place) for place in built.stored_peaks]
    if np.abs(built.weights_at(corners) - masters.weights_at(corners)[:, order]).max() < 1e-6:
        return None
    return "its regions are not those that follow from the places of its masters"


def _write(source: Source, redrawn: Mapping[str, Redrawn], folder: Path, family: str) -> None:
    axes = next(iter(redrawn.values())).masters.axes
    of_glyph = {name: new.masters.stored_peaks for name, new in redrawn.items()}
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
            writer = writer_of(folder / str(descriptor.filename), source, family, styles[at])
            layers = {"public.default": writer.getGlyphSet()}
            layers |= {
                styles[other]: writer.getGlyphSet(layerName=styles[other], defaultLayer=False)
                for other in (layered if at == default else ())
            }
            for place, glyphs in zip([at, *layered], layers.values(), strict=False):
                for name, new in redrawn.items():
                    if place in of_glyph[name]:
                        _write_master(name, new, of_glyph[name].index(place), glyphs)
            close(writer, layers, list(redrawn))
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


def styles_of(axes: tuple[DesignAxis, ...], places: list[tuple[float, ...]]) -> dict[tuple[float, ...], str]:
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
