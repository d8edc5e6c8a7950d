"""Names, metrics, axes and named instances of a font from its tables."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

from fontTools.ttLib import TTFont

from ...errors import FontError
from ...outlines.masters import DesignAxis
from ...outlines.outline import FontMetrics

Location: TypeAlias = Mapping[str, float] | str | None
"""A location as an argument: axis tag to user-space value, the name of an instance, or None for the default."""

log = logging.getLogger(__name__)


def axes_of(tables: TTFont) -> tuple[DesignAxis, ...]:
    """The axes in the font's order, without their mappings; empty if the font is not variable."""
    return tuple(
        DesignAxis(a.axisTag, _name(tables, a.axisNameID) or a.axisTag, a.minValue, a.defaultValue, a.maxValue)
        for a in (tables["fvar"].axes if "fvar" in tables else ())
    )


def instances_of(tables: TTFont) -> Mapping[str, Mapping[str, float]]:
    """The named instances, such as "Bold", with their locations."""
    instances = tables["fvar"].instances if "fvar" in tables else ()
    named = ((_name(tables, instance.subfamilyNameID), instance) for instance in instances)
    return {name: dict(instance.coordinates) for name, instance in named if name}


def _name(tables: TTFont, name_id: int) -> str | None:
    names = tables.get("name")
    return names.getDebugName(name_id) if names else None


def location_within(
    asked: Location, axes: tuple[DesignAxis, ...], instances: Mapping[str, Mapping[str, float]], path: Path
) -> dict[str, float]:
    """Clamp a location to the limits of the axes; the result is in the order of the font's axes.

    Args:
        asked: axis tag to user-space value, or the name of an instance without regard to case.
        axes, instances: of the font. path: for the warning about a clamped value.

    Raises:
        FontError: the font has no such axis or instance, or a value is not finite.
    """
    location = _of_instance(asked, instances) if isinstance(asked, str) else asked or {}
    known = {axis.tag: axis for axis in axes}
    for tag, value in location.items():
        if tag not in known:
            has = f"it has {', '.join(known)}" if known else "it is not a variable font"
            raise FontError(f"no axis {tag!r}: {has}")
        if not math.isfinite(value):
            raise FontError(f"axis {tag!r} cannot be at {value}")
    within = {}
    for axis in axes:
        if axis.tag in location:
            wanted = float(location[axis.tag])
            within[axis.tag] = value = min(max(wanted, axis.minimum), axis.maximum)
            if value != wanted:
                limits = f"{axis.minimum:g} to {axis.maximum:g}"
                log.warning("%s: axis %s goes from %s: %g taken for %g", path, axis.tag, limits, value, wanted)
    return within


def _of_instance(name: str, instances: Mapping[str, Mapping[str, float]]) -> Mapping[str, float]:
    for known, location in instances.items():
        if known.casefold() == name.strip().casefold():
            return location
    has = f"it has {', '.join(instances)}" if instances else "it has none"
    raise FontError(f"no named instance {name!r}: {has}")


def names_of(tables: TTFont, path: Path) -> tuple[str, str]:
    """Family and style; by default the file's name and "Regular"."""
    names = tables.get("name")
    family = names.getBestFamilyName() if names else None
    style = names.getBestSubFamilyName() if names else None
    return family or path.stem, style or "Regular"


def metrics_of(tables: TTFont) -> FontMetrics:
    """Units per em, ascender and descender; the typographic ones if the font says so."""
    units_per_em = tables["head"].unitsPerEm
    if units_per_em < 1:
        raise FontError(f"units per em cannot be {units_per_em}")
    ascender, descender = tables["hhea"].ascent, tables["hhea"].descent
    os2 = tables.get("OS/2")
    if os2 is not None and (os2.fsSelection & (1 << 7) or ascender == descender == 0):
        ascender, descender = os2.sTypoAscender, os2.sTypoDescender
    return FontMetrics(float(units_per_em), float(ascender), float(descender))
