"""Clip paths, masks and views: what of shapes shows through them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from ....types import FloatArray
from .booleans import CHANGED, Area, CutError, Plane, size_of
from .paint import reference
from .painted import Place, Shape, placed
from .transforms import Box

FLAT = 1 / 128
"""How far the luminance of a mask may be from black or white."""


REGION = (("x", "-10%", "x"), ("y", "-10%", "y"), ("width", "120%", "x"), ("height", "120%", "y"))
"""Where a mask lets anything through: attributes, what they are without, and what 100 % are."""


class Cutting:
    """What cuts shapes.

    Args:
        structure: a :class:`.structure.Structure`, which draws what is in clip paths and masks.

    Attributes:
        plane: where it is done.
    """

    def __init__(self, structure: Any) -> None:
        self._of = structure
        self._active: list[Any] = []

    @cached_property
    def plane(self) -> Plane:
        """Where areas are cut: about the middle of the view."""
        left, top, width, height = self._of.view
        return Plane(left + width / 2, -top - height / 2, height)

    def cut(self, shapes: list[Shape], element: Any, place: Place) -> list[Shape]:
        """What of an element's shapes its clip path and its mask leave; ``place``: within it."""
        style = place.style
        assert style is not None
        for name, of in (("clip-path", self._clip), ("mask", self._mask)):
            text = style[name]
            if not shapes or text.lower() == "none" or (name == "mask" and place.mode == "clip"):
                continue
            target = self._of.resource(reference(text))
            if reference(text) is None or (target is None and not (reference(text) or "").startswith("#")):
                self._of.unread.add(f"{name}: {text[:40]}", self._of.line_of(element))
            elif target is not None and element is self._of.document.root:
                self._of.unread.add(f"the {name} of the whole drawing", self._of.line_of(element))
            elif target is not None and target.tag == ("clipPath" if name == "clip-path" else "mask"):
                if target in self._active:
                    self._of.unread.add(f"a {target.tag} within itself", self._of.line_of(target))
                    continue
                self._active.append(target)
                try:
                    shapes = self._left(shapes, of(target, element, place))
                except CutError:
                    self._of.unread.add(f"a {target.tag} that cannot be cut along", self._of.line_of(element))
                finally:
                    self._active.pop()
        return shapes

    def within(self, shapes: list[Shape], box: Box, matrix: FloatArray) -> list[Shape]:
        """What of shapes lies in a box of the units that a matrix leads from."""
        if not shapes or all(is_inside(shape, box, matrix) for shape in shapes):
            return shapes
        try:
            return self._left(shapes, self._box(box, matrix))
        except CutError:
            self._of.unread.add("a view that cannot be cut along", shapes[0].line)
            return shapes

    def _box(self, box: Box, matrix: FloatArray) -> Area:
        x, y, width, height = box
        return self.plane.box(placed([(x, y), (x + width, y), (x + width, y + height), (x, y + height)], matrix))

    def _left(self, shapes: Sequence[Shape], area: Area) -> list[Shape]:
        """What of shapes lies in an area; those that do whole keep their points."""
        found = (self.changed(shape, self.plane.both(self.plane.area(shape), area)) for shape in shapes)
        return [shape for shape in found if shape is not None]

    def changed(self, shape: Shape, area: Area) -> Shape | None:
        """A shape with what is left of it, itself if nothing is missing; None if nothing is left."""
        before, after = size_of(self.plane.simple(self.plane.area(shape))), size_of(area)
        if after <= CHANGED * before:
            return None
        if abs(before - after) <= CHANGED * before:
            return shape
        return replace(shape, path=self.plane.path(area), matrix=np.eye(3), rule="nonzero")

    def _clip(self, target: Any, element: Any, place: Place) -> Area:
        """The area of a clip path for an element."""
        structure = self._of
        style = structure.style_of(target)
        inside = replace(place, style=style, mode="clip", opacity=1.0, size=None)
        units = self._in_units(target.get("clipPathUnits"), element, place)
        shapes: list[Shape] = []
        if units is not None:
            inside = replace(inside, matrix=place.matrix @ structure.transform(target, inside) @ units)
            if target.get("clipPathUnits") == "objectBoundingBox":
                inside = replace(inside, lengths=inside.lengths.in_box())
            shapes = [shape for child in target for shape in structure.draw(child, inside)]
        area = self.plane.united([self.plane.area(shape) for shape in shapes])
        own = structure.resource(reference(style["clip-path"]))
        if own is not None and own.tag == "clipPath" and own not in self._active:
            self._active.append(own)
            area = self.plane.both(area, self._clip(own, element, place))
            self._active.pop()
        return area

    def _mask(self, target: Any, element: Any, place: Place) -> Area:
        """The area that a mask lets through for an element; what it lets through in part is named."""
        structure, plane = self._of, self.plane
        style = structure.style_of(target)
        units = target.get("maskUnits") or "objectBoundingBox"
        frame = self._in_units(units, element, place)
        matrix = self._in_units(target.get("maskContentUnits"), element, place)
        area = plane.united([])
        if frame is None or matrix is None:
            return area
        inside = replace(place, matrix=place.matrix @ matrix, style=style, mode="ink", opacity=1.0, size=None)
        if target.get("maskContentUnits") == "objectBoundingBox":
            inside = replace(inside, lengths=inside.lengths.in_box())
        for shape in [one for child in target for one in structure.draw(child, inside)]:
            light = shape.colour.alpha * (1.0 if style["mask-type"].lower() == "alpha" else shape.colour.luminance)
            if light < FLAT and style["mask-type"].lower() == "alpha":
                continue
            if not (light <= FLAT or light >= 1 - FLAT) or (light <= FLAT and shape.colour.alpha < 1 - FLAT):
                structure.unread.add("masks that let through a part of the light", shape.line)
            piece = plane.area(shape)
            area = plane.without(area, piece) if light < 0.5 else plane.united([area, piece])
        lengths = place.lengths.in_box() if units == "objectBoundingBox" else place.lengths
        x, y, width, height = (lengths.of(target.get(name) or whole, side) or 0.0 for name, whole, side in REGION)
        area = plane.both(area, self._box((x, y, width, height), place.matrix @ frame))
        return area

    def _in_units(self, units: str | None, element: Any, place: Place) -> FloatArray | None:
        """(3, 3) from the units of a clip path or mask to its element's; None if a bounding box has no size."""
        if units != "objectBoundingBox":
            return np.eye(3)
        box = self._of.box(element, place)
        if box is None or not (box[2] and box[3]):
            return None
        return np.array([[box[2], 0.0, box[0]], [0.0, box[3], box[1]], [0.0, 0.0, 1.0]])


def is_inside(shape: Shape, box: Box, matrix: FloatArray) -> bool:
    """Whether the points of a shape lie in a box of the units that a matrix leads from."""
    if not abs(np.linalg.det(matrix)) > 0:
        return True
    back = np.linalg.inv(matrix) @ shape.matrix
    points = np.array([point for subpath in shape.path for point in placed(subpath.points, back)])
    room = 1e-9 * max(box[2], box[3])
    low, high = np.array(box[:2]) - room, np.array(box[:2]) + np.array(box[2:]) + room
    return bool((points >= low).all() and (points <= high).all())
