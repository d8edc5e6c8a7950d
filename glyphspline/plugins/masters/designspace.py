"""Designspaces: variable sources, whose masters are UFOs or layers of them, through fontTools' designspaceLib.

Glyphs files become such: :mod:`.glyphs_file`.

A glyph may be missing in some of the masters; then it has regions of its own, as its components may have. Between the
masters it is interpolated by fontTools' model of variations, from which variable fonts are built.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
from fontTools.designspaceLib import AxisDescriptor, DesignSpaceDocument, processRules
from fontTools.pens.pointPen import PointToSegmentPen
from fontTools.pens.recordingPen import RecordingPen
from fontTools.ufoLib.glifLib import GlyphSet
from fontTools.varLib.errors import VariationModelError
from fontTools.varLib.models import VariationModel, normalizeValue

from ...errors import FontError, GlyphsplineError
from ...outlines.masters import DesignAxis, MasterContour, Masters, Region, distinct_regions, stacked
from ...outlines.outline import Outline
from ...readers.open import Reader
from ...readers.pens import MAX_COMPONENTS, ContourPen, enter_component
from ...readers.source import Location, parsed
from ...readers.ufo import Drawing, EditableSource, Ufo, components_of
from ...types import Head


@dataclass(frozen=True, kw_only=True)
class _Master(Drawing):
    """A source of a designspace: its name, its glyphs, and where it is by axis tag, normalised."""

    name: str
    glyphs: GlyphSet
    muted: frozenset[str]
    at: dict[str, float]


class Designspace(EditableSource):
    """A designspace at one location.

    Attributes:
        path: the file, as given. location: axis tag to user-space value; empty at the default.
        axes: its axes. family, style, metrics, glyph_names, cmap: those of the default master.
    """

    format = kind = "designspace"
    _unread: Mapping[str, tuple[str, ...]] = MappingProxyType({})  # of glyphs drawn themselves

    def __init__(self, path: Path, location: Location = None, file: Path | None = None) -> None:
        """Open the masters that ``file`` names, which is at ``path`` unless it was made of what is there."""
        self.path, file = path, file or path
        parsed(file.read_bytes())
        document = DesignSpaceDocument.fromfile(file)
        if document.axisMappings:
            raise FontError("its axes depend on each other (mappings): locations cannot be told axis by axis")
        for axis in document.axes:
            if not isinstance(axis, AxisDescriptor):
                words = "has separate values, each a designspace of its own: split it (fontTools' splitInterpolable)"
                raise FontError(f"axis {axis.tag!r} {words}")
        self.axes = tuple(_axis(axis) for axis in document.axes)
        instances = {item.name: item.getFullUserLocation(document) for item in document.instances if item.name}
        tags = {axis.name: axis.tag for axis in document.axes}
        self.instances = {n: {tags[axis]: value for axis, value in at.items()} for n, at in instances.items()}
        self.location = self.clamped(location)
        default = document.findDefault()
        if default is None:
            raise FontError("no master at the default of all axes")
        ufos: dict[str, Ufo] = {}
        self._masters_of_all: list[_Master] = []
        for number, source in enumerate(document.sources):
            if source.path is None:
                raise FontError(f"source {number} names no file")
            if source.path not in ufos:
                ufos[source.path] = Ufo.opened(source.path)
            ufo, full = ufos[source.path], source.getFullDesignLocation(document)
            at = {axis.tag: _normalised(axis, full[axis.name]) for axis in document.axes}
            name = source.styleName or source.name or Path(source.path).stem
            glyphs = ufo.default_layer if source.layerName is None else ufo.layer(source.layerName)
            name = name if source.layerName is None else f"{name}, layer {source.layerName}"
            place = tuple(round(x * 16384) / 16384 + 0.0 for x in at.values())
            muted = frozenset(source.mutedGlyphNames)
            master = _Master(ufo.path, source.layerName, place, name=name, glyphs=glyphs, muted=muted, at=at)
            self._masters_of_all.append(master)
        self._ufos, at_default = tuple(ufos.values()), ufos[default.path]
        self.folders = [ufo.path for ufo in self._ufos]
        self.family, self.style, self.metrics = at_default.family, at_default.style, at_default.metrics
        self.cmap, self.glyph_names = at_default.cmap, at_default.glyph_names
        self.variations = at_default.variations
        self._rules = document.rules
        self._place = {a.name: a.map_forward(self.location.get(a.tag, a.default)) for a in document.axes}
        self._components: dict[str, tuple[Masters, list[int | None]]] = {}

    def at_location(self, names: Sequence[str]) -> tuple[str, ...]:
        """See :meth:`.Source.at_location`: by the rules of the designspace."""
        found = processRules(self._rules, self._place, list(names))
        return tuple([new if new in self.gids else old for old, new in zip(names, found, strict=True)])

    def _bytes(self) -> Iterable[bytes]:
        return self.path.read_bytes(), *(ufo.sha256.encode() for ufo in self._ufos)

    def _outline(self, head: Head) -> Outline:
        """The glyph at the location, by the pen of all readers: it drops what has no length there."""
        masters, pen = self._masters(head), ContourPen(opens=True)
        instance = masters.instance(self.location)
        for contour, repeats in zip(instance.contours, masters.repeats_of, strict=False):
            pen.contour(contour.points[None], contour.degrees, repeats)
        notes = (*instance.notes, *pen.notes)
        return replace(instance, contours=pen.contours, notes=notes, snapped=pen.snapped)

    def _masters(self, head: Head) -> Masters:
        return replace(self._mixed(head.name, [])[0], name=head.name, gid=head.gid, unicodes=head.unicodes)

    def _drawn_in(self, name: str) -> list[_Master]:
        return [each for each in self._masters_of_all if name in each.glyphs and name not in each.muted]

    def _mixed(self, name: str, above: list[str | None]) -> tuple[Masters, list[int | None]]:
        """A glyph in its masters and in those of its components; the contours that are its own: :class:`ContourPen`."""
        nesting = enter_component(above, name)
        if name in self._components:
            return self._components[name]
        drawn = [(master, *_drawing(master, name)) for master in self._drawn_in(name)]
        if above and not drawn:
            raise GlyphsplineError(f"component {name!r} does not exist")
        try:
            model = VariationModel([item[0].at for item in drawn], axisOrder=[axis.tag for axis in self.axes])
        except VariationModelError as error:
            where = ", ".join([item[0].name for item in drawn]) or "none"
            raise GlyphsplineError(f"its masters ({where}) are not one default and others elsewhere") from error
        drawn = [drawn[k] for k in model.reverseMapping]  # the default first
        for master, parts, _ in drawn[1:]:
            _compare(parts, drawn[0][1], master.name, drawn[0][0].name)
        own = Masters(name, axes=self.axes, regions=stacked(map(self._region, model.supports[1:]), len(self.axes)))
        names = [part.base for part in drawn[0][1] if part.base is not None]
        if len(names) > MAX_COMPONENTS:
            raise GlyphsplineError(f"more than {MAX_COMPONENTS} components")
        children = {base: self._mixed(base, nesting)[0] for base in dict.fromkeys(names)}
        regions = [tuple(map(tuple, r)) for each in (own, *children.values()) for r in each.regions.tolist()]
        found = replace(own, regions=stacked(distinct_regions(regions), len(self.axes)), metrics=self.metrics)
        weights = own.weights_at(found.peaks)  # (K, S)
        pen = ContourPen(masters=len(found), opens=True)
        notes, unread = list[str](), list(self._unread.get(name, ()))
        for k, part in enumerate(drawn[0][1]):
            points = np.array([parts[k].points for _, parts, _ in drawn], dtype=np.float64)
            points = np.tensordot(weights, points, axes=1)  # (K, N, 2)
            if part.base is None:
                at = 0
                for operation, count in part.operations:
                    getattr(pen, operation)(*[points[:, n].T for n in range(at, at + count)])
                    at += count
                (pen.endPath if part.is_open else pen.closePath)()
                continue
            child = children[part.base]
            of_child, is_mirrored = child.weights_at(found.peaks), np.linalg.det(points[0, :2]) < 0  # in the default
            for contour, repeats in zip(child.contours, child.repeats_of, strict=False):
                placed = np.tensordot(of_child, contour.points, axes=1) @ points[:, :2] + points[:, 2:]
                drawn_so = MasterContour(placed, contour.degrees)
                if is_mirrored:  # as in :meth:`.Ufo._drawn`
                    drawn_so, repeats = drawn_so.reversed(), np.roll(repeats[::-1], 1)
                pen.contour(drawn_so.points, drawn_so.degrees, repeats)
            notes, unread = [*notes, *child.notes], [*unread, *child.unread]
        pen.finish()
        found = replace(
            found, contours=tuple(pen.stacks), advances=weights @ np.array([width for _, _, width in drawn]),
            notes=(*pen.notes, *notes), repeats=pen.repeated, unread=tuple(dict.fromkeys(unread)),
        )  # fmt: skip
        if above:  # components are asked for again
            self._components[name] = found, pen.own
        return found, pen.own

    def drawings(self, name: str) -> Sequence[_Master]:
        """See :meth:`.EditableSource.drawings`."""
        return sorted(self._drawn_in(name), key=lambda each: any(each.place))

    def own_contours(self, name: str) -> list[int | None]:
        """See :meth:`.EditableSource.own_contours`."""
        own: list[int | None] = self.drawings(name)[0].glyphs[name].numbered(self._mixed(name, [])[1])
        return own

    def components(self) -> dict[str, set[str]]:
        """See :meth:`.EditableSource.components`."""
        return components_of([each.glyphs for each in self._masters_of_all])

    def _region(self, support: dict[str, tuple[float, float, float]]) -> Region:
        return tuple(support.get(axis.tag, (0.0, 0.0, 0.0)) for axis in self.axes)


@dataclass(frozen=True)
class _Part:
    """A contour, closed or open, as names of a segment pen's operations and their points, or a component.

    Of a component the points (3, 2) are the rows of its matrix and its offset.
    """

    operations: tuple[tuple[str, int], ...]
    points: list[tuple[float, float]]
    base: str | None = None
    is_open: bool = False


def _drawing(master: _Master, name: str) -> tuple[list[_Part], float]:
    """The parts of a glyph in a master, in order, and its advance."""
    glyph, pen = master.glyphs[name], RecordingPen()
    glyph.replay(PointToSegmentPen(pen, outputImpliedClosingLine=True))
    parts: list[_Part] = []
    operations: list[tuple[str, int]] = []
    points: list[tuple[float, float]] = []
    for operation, given in pen.value:
        if operation == "addComponent":
            base, (a, b, c, d, e, f) = given
            parts.append(_Part((), [(a, b), (c, d), (e, f)], base))
        elif operation in ("closePath", "endPath"):
            parts.append(_Part(tuple(operations), points, is_open=operation == "endPath"))
            operations, points = [], []
        elif given[-1] is None:  # quadratics without a point on the curve begin midway between control points
            (ax, ay), (bx, by) = given[-2], given[0]
            start = ((ax + bx) / 2, (ay + by) / 2)
            operations += [("moveTo", 1), (operation, len(given))]
            points += [start, *given[:-1], start]
        else:
            operations.append((operation, len(given)))
            points += given
    return parts, float(glyph.width)


def _compare(parts: list[_Part], expected: list[_Part], name: str, default: str) -> None:
    """Raise an error that names the first contour that is drawn otherwise than in the default master."""
    if len(parts) != len(expected):
        counts = f"{len(parts)} contours and components, not {len(expected)}"
        raise GlyphsplineError(f"master {name!r} has {counts} as {default!r}")
    for number, (part, other) in enumerate(zip(parts, expected, strict=True)):
        if part.base != other.base:
            kinds = ["a contour" if base is None else f"component {base!r}" for base in (part.base, other.base)]
            raise GlyphsplineError(f"master {name!r} has {kinds[0]}, {default!r} has {kinds[1]}", contour=number)
        words = "its contour is open in one of the two" if part.is_open != other.is_open else ""
        if not words and len(part.operations) != len(other.operations):
            words = f"{len(part.operations) - 1} segments, not {len(other.operations) - 1}"
        for k, ((one, count), (its, its_count)) in enumerate(zip(part.operations, other.operations, strict=False)):
            if not words and one != its:
                words = f"segment {k - 1} is a {KINDS[one]}, not a {KINDS[its]}"
            elif not words and count != its_count:
                words = f"segment {k - 1} has {count} points, not {its_count}"
        if words:
            raise GlyphsplineError(f"master {name!r} is unlike {default!r}: {words}", contour=number)


KINDS = {"moveTo": "start", "lineTo": "line", "qCurveTo": "quadratic", "curveTo": "cubic"}
"""What the operations of a segment pen draw."""


def _axis(axis: AxisDescriptor) -> DesignAxis:
    """An axis; its mapping is from user space to that of the masters, both normalised."""
    limits = (axis.minimum, axis.default, axis.maximum)
    users = sorted({*limits, *(user for user, _ in axis.map if axis.minimum <= user <= axis.maximum)})
    pairs = tuple((normalizeValue(user, limits), _normalised(axis, axis.map_forward(user))) for user in users)
    mapping = () if all(before == after for before, after in pairs) else pairs
    low, default, high = map(float, limits)
    return DesignAxis(axis.tag, axis.name, low, default, high, mapping)


def _normalised(axis: AxisDescriptor, value: float) -> float:
    """A value of the masters' space, normalised."""
    low, default, high = (axis.map_forward(user) for user in (axis.minimum, axis.default, axis.maximum))
    return float(normalizeValue(value, (low, default, high)))


READER = Reader(lambda path, head: b"<designspace" in head, Designspace.opened, has_axes=True)
