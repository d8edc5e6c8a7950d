"""Elements in the order in which a browser paints them: groups, clones, views in views, and what is not drawn."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ....errors import GlyphsplineError
from ....types import FloatArray
from .clips import Cutting
from .document import Document
from .lengths import Lengths, share, view_box
from .paint import BLACK, Painter, colour, reference
from .painted import Place, Shape, bounds_of
from .path_data import Path
from .shapes import SHAPES, length, shape_of
from .strokes import stroke_of
from .styles import Cascade, Style, font_size
from .transforms import Box, attribute_matrix, origin, property_matrix, translation
from .unread import Unread

DEEPEST_USE = 16
"""Limit of clones within clones."""

MOST = {"ink": 10_000, "clip": 10_000, "geometry": 100_000, "own": 100_000}
"""Limits of elements that are drawn, or looked at for clips and boxes: a hundred bytes of clones can ask for 2^64."""

UNSEEN = ("geometry", "own")
"""What is wanted where neither paint nor clips count."""

GROUPS = {"g", "a", "switch", "svg", "symbol", "use"}
NAMED = {"text": "text", "image": "images", "foreignObject": "HTML in foreignObject"}
"""Elements that show something and are not read."""

LANGUAGE = "en"
"""For ``systemLanguage``: the same wherever this runs."""

EXTENSIONS = {"http://www.w3.org/1999/xhtml", "http://www.w3.org/1998/Math/MathML"}
"""For ``requiredExtensions``: what browsers have."""

ANIMATED = ("animate", "animateMotion", "animateTransform", "set", "script")
MARKED = {"path", "line", "polyline", "polygon"}
SOLID = 0.996
"""Opacity from which paint counts as solid."""


@dataclass
class Structure:
    """The shapes of a drawing.

    Attributes:
        document: the drawing. view: left, top, width and height of what it shows, in its units.
        strokes: whether strokes are drawn, as outlines. unread: what is not read.
    """

    document: Document
    view: Box
    strokes: bool = False
    unread: Unread = field(default_factory=Unread)

    def __post_init__(self) -> None:
        self.cascade = Cascade(self.document, self.unread)
        self.painter = Painter(self, self.unread)
        self.cutting = Cutting(self)
        self._met: Counter[str] = Counter()

    def shapes(self, matrix: FloatArray) -> list[Shape]:
        """What is painted, in order; ``matrix``: (3, 3) from the drawing's units to the glyph's.

        Raises:
            GlyphsplineError: there are too many elements, or clones in clones.
        """
        lengths = Lengths(self.view[2], self.view[3], unread=self.unread)
        found = self.draw(self.document.root, Place(matrix, None, lengths))
        style = self.style_of(self.document.root)
        for name in ("background", "background-color"):
            ground = colour(style.get(name, "none"))
            if style.get(name, "none").lower() != "none" and (ground is None or (ground.alpha and min(ground[:3]) < 1)):
                self.unread.add(f"the {name}", self.line_of(self.document.root))
        for element in self.document.root.iter():
            if element.tag in ANIMATED:
                self.unread.add("scripts" if element.tag == "script" else "animation", self.line_of(element))
        return found

    def line_of(self, element: Any) -> int:
        """The line of the file where an element begins."""
        return self.document.lines.get(element, 0)

    def style_of(self, element: Any) -> Style:
        """The style of an element where it stands in the file."""
        around = self.document.parents.get(element)
        return self.cascade.of(element, None if around is None else self.style_of(around))

    def resource(self, reference: str | None) -> Any:
        """A paint server, clip path and the like by its reference; None if there is none, or it is not displayed."""
        target = element = self.document.target(reference)
        while element is not None and element is not self.document.root:
            if self.style_of(element)["display"].lower() == "none" or (
                element.tag == "defs" and not is_for_us(element)
            ):
                return None
            element = self.document.parents.get(element)
        return target

    def draw(self, element: Any, place: Place, transformed: bool = True) -> list[Shape]:
        """The shapes of an element, clipped and masked; ``transformed``: by its own transform too."""
        self._met[place.mode] += 1
        if self._met[place.mode] > MOST[place.mode]:
            raise GlyphsplineError(f"more than {MOST[place.mode]:,} elements, clones counted")
        tag = element.tag
        is_known = tag in SHAPES or tag in GROUPS or tag in NAMED
        is_root = element is self.document.root
        if not is_known or not (is_root or is_for_us(element)) or (tag == "symbol" and place.size is None):
            return []
        style, line = self.cascade.of(element, place.style), self.line_of(element)
        size = font_size(style)
        lengths = replace(place.lengths, size=size, root_size=self.cascade.root_size, line=line)
        opacity = place.opacity * (share(style["opacity"]) or 0.0)
        if (style["display"].lower() == "none" and not is_root) or (place.mode == "ink" and opacity < 1 / 512):
            return []
        if tag in NAMED:
            if place.mode not in UNSEEN:
                self._name(element, style, line)
            return []
        inner = replace(place, style=style, lengths=lengths, opacity=opacity)
        if transformed:
            inner = replace(inner, matrix=place.matrix @ self.transform(element, inner))
            if tag == "use":
                x, y = (length(name, self.get(element, style), lengths) or 0.0 for name in "xy")
                inner = replace(inner, matrix=inner.matrix @ translation(x, y))
        if tag in SHAPES:
            found = self._leaf(element, inner)
        elif place.mode == "clip" and tag != "use":
            return []  # clip paths take no groups
        else:
            found = self._group(element, inner)
        if found and place.mode not in UNSEEN:
            self._name_effects(style, line)
            found = self.cutting.cut(found, element, inner)
        return found

    def _name(self, element: Any, style: Style, line: int) -> None:
        """Name an element that is not read, if it would show something."""
        has = {"text": "".join(element.itertext()).strip(), "image": element.get("href")}.get(element.tag, True)
        if element.tag == "text" and style["fill"] == "none" and style["stroke"] == "none":
            return
        if has and style["visibility"] == "visible":
            self.unread.add(NAMED[element.tag], line)

    def _name_effects(self, style: Style, line: int) -> None:
        """Name effects on what is drawn."""
        for name in ("filter", "mix-blend-mode"):
            target = reference(style[name])
            if style[name] not in ("none", "normal") and (target is None or self.resource(target) is not None):
                self.unread.add("filters" if name == "filter" else f"{name}: {style[name]}", line)

    def get(self, element: Any, style: Style) -> Any:
        """What gets a geometric attribute of an element: of its style, if that has it."""
        return lambda name: style.get(name) or element.get(name)

    # Groups ----------------------------------------------------------------------------------------------------------

    def _group(self, element: Any, place: Place) -> list[Shape]:
        if element.tag == "use":
            return self._clone(element, place)
        inside = replace(place, size=None)
        clip = None
        if element.tag == "symbol" or (element.tag == "svg" and element is not self.document.root):
            entered = self._view(element, place)
            if entered is None:
                return []
            inside, clip = entered
        children: Iterator[Any] = iter(element)
        if element.tag == "switch":
            children = iter([child for child in element if child.tag[0] != "{" and is_for_us(child)][:1])
        found = [shape for child in children for shape in self.draw(child, inside)]
        return found if clip is None or place.mode in UNSEEN else self.cutting.within(found, clip, inside.matrix)

    def _clone(self, element: Any, place: Place) -> list[Shape]:
        """What a ``use`` refers to, in its place."""
        if place.mode == "own":
            return []
        href = element.get("href")
        target, line = self.document.target(href), self.line_of(element)
        if target is None:
            if href and not href.strip().startswith("#"):
                self.unread.add("clones of other files", line)
            return []
        if target in place.clones or self._is_around(target, element):
            self.unread.note("clones in a loop, which are not drawn", line)
            return []
        if len(place.clones) >= DEEPEST_USE:
            raise GlyphsplineError(f"clones (use) nested more than {DEEPEST_USE} deep, line {line}")
        if place.mode == "clip" and target.tag not in SHAPES:
            return []
        assert place.style is not None
        get = self.get(element, place.style)
        size = (get("width"), get("height")) if target.tag in ("symbol", "svg") else None
        return self.draw(target, replace(place, clones=(*place.clones, target), size=size))

    def _is_around(self, element: Any, inner: Any) -> bool:
        while inner is not None and inner is not element:
            inner = self.document.parents.get(inner)
        return inner is element

    def _view(self, element: Any, place: Place) -> tuple[Place, Box | None] | None:
        """The place within a view, and what of it shows, in its units (None: all); None if it has no size."""
        assert place.style is not None
        get, lengths = self.get(element, place.style), place.lengths
        x, y = (length(name, get, lengths) or 0.0 for name in "xy")
        sides, given = [lengths.width, lengths.height], place.size or (None, None)
        for k, name in enumerate(("width", "height")):
            value = lengths.of(given[k], "xy"[k]) if given[k] else length(name, get, lengths)
            sides[k] = sides[k] if value is None or value < 0 else value
        box = view_box(element.get("viewBox"))
        if min(sides) <= 0 or (box is not None and min(box[2:]) <= 0):
            return None
        matrix = translation(x, y)
        shown: Box = (0.0, 0.0, sides[0], sides[1])
        if box is not None:
            fit = fitted(box, (sides[0], sides[1]), element.get("preserveAspectRatio") or "")
            (across, _, left), (_, down, top) = fit[:2].tolist()
            matrix = matrix @ fit
            shown = (-left / across, -top / down, sides[0] / across, sides[1] / down)
        hides = place.style["overflow"].lower() not in ("visible", "auto")
        width, height = (sides[0], sides[1]) if box is None else box[2:]
        inner = replace(
            place, matrix=place.matrix @ matrix, size=None, lengths=replace(lengths, width=width, height=height)
        )
        return inner, shown if hides else None

    # Shapes ----------------------------------------------------------------------------------------------------------

    def _leaf(self, element: Any, place: Place) -> list[Shape]:
        """What is painted of a shape."""
        style, line = place.style, self.line_of(element)
        assert style is not None
        path = shape_of(element.tag, self.get(element, style), place.lengths)
        if not path:
            return []
        if place.mode in UNSEEN:
            return [Shape(path, place.matrix, line=line, element=element)]
        if style["visibility"] != "visible":
            return []
        if place.mode == "clip":
            return [Shape(path, place.matrix, style["clip-rule"].lower(), BLACK, line)]
        found = [self._filled(element, path, place), self._stroked(element, path, place)]
        order = style["paint-order"].lower().split()
        if "stroke" in order and ("fill" not in order or order.index("stroke") < order.index("fill")):
            found.reverse()
        if element.tag in MARKED:
            for name in ("marker-start", "marker-mid", "marker-end"):
                target = self.resource(reference(style[name]))
                if target is not None and target.tag == "marker":
                    self.unread.add("markers", line)
        for shape in found:
            if shape is not None and shape.colour.alpha < SOLID:
                self.unread.add("paint that is partly transparent, drawn as ink", line)
        return [shape for shape in found if shape is not None]

    def _filled(self, element: Any, path: Path, place: Place) -> Shape | None:
        style, line = place.style, self.line_of(element)
        assert style is not None
        if element.tag == "line":
            return None
        colour = self.painter.paint(style["fill"], style, place.opacity * (share(style["fill-opacity"]) or 0.0), line)
        return None if colour is None else Shape(path, place.matrix, style["fill-rule"].lower(), colour, line)

    def _stroked(self, element: Any, path: Path, place: Place) -> Shape | None:
        """The stroke of a shape as an outline; it is named if none are drawn."""
        style, line = place.style, self.line_of(element)
        assert style is not None
        width = place.lengths.of(style["stroke-width"]) or 0.0
        if width <= 0 or style["stroke"] == "none":
            return None
        colour = self.painter.paint(
            style["stroke"], style, place.opacity * (share(style["stroke-opacity"]) or 0.0), line
        )
        if colour is None:
            return None
        if not self.strokes:
            self.unread.add("strokes, which --strokes draws", line)
            return None
        if style["vector-effect"] == "non-scaling-stroke":
            self.unread.add("strokes that do not scale, drawn as if they did", line)
        if element.get("pathLength") and style["stroke-dasharray"] != "none":
            self.unread.add("dashes by pathLength, drawn by the length of the path", line)
        return stroke_of(Shape(path, place.matrix, "nonzero", colour, line), style, width, place.lengths)

    # Transforms and boxes --------------------------------------------------------------------------------------------

    def transform(self, element: Any, place: Place) -> FloatArray:
        """(3, 3) the transform of an element, by its style or its attribute, about its origin."""
        style, lengths = place.style, place.lengths
        assert style is not None
        name = "patternTransform" if element.tag == "pattern" else "transform"
        text = style.get("transform") or element.get(name) or ""
        if text.strip() in ("", "none"):
            return np.eye(3)
        if element is self.document.root:
            self.unread.add("a transform of the whole drawing, by its units", lengths.line)
        box: Box = (0.0, 0.0, lengths.width, lengths.height)
        if style["transform-box"] in ("fill-box", "content-box", "stroke-box", "border-box"):
            box = self.box(element, place) or (0.0, 0.0, 0.0, 0.0)
        matrix = property_matrix(text, box, lengths) if style.get("transform") else attribute_matrix(text)
        if matrix is None:
            self.unread.add(f"a transform that is not read, {' '.join(text.split())[:40]!r}", lengths.line)
            return np.eye(3)
        about = origin(style["transform-origin"], box, lengths) if style["transform-origin"] else None
        return matrix if about is None else translation(*about) @ matrix @ translation(-about[0], -about[1])

    def box(self, element: Any, place: Place) -> Box | None:
        """The bounding box of an element in its units; None if it has no shapes."""
        around = replace(place, matrix=np.eye(3), mode="geometry")
        found = self.draw(element, around, transformed=False)
        ends = [bounds for shape in found for bounds in bounds_of(shape)]
        if not ends:
            return None
        low, high = np.min([each[:2] for each in ends], axis=0), np.max([each[2:] for each in ends], axis=0)
        return float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1])


def is_for_us(element: Any) -> bool:
    """Whether an element's conditions hold in a browser that speaks English."""
    languages = element.get("systemLanguage")
    if languages is not None and LANGUAGE not in {each.strip().lower()[:2] for each in languages.split(",")}:
        return False
    return EXTENSIONS.issuperset((element.get("requiredExtensions") or "").split())


def fitted(box: Box, size: tuple[float, float], aspect: str) -> FloatArray:
    """(3, 3) from a view box to a view of that size, by ``preserveAspectRatio``."""
    words = aspect.split()
    words = words[1:] if words[:1] == ["defer"] else words
    align, fit = (*words, "meet")[:2] if words else ("xMidYMid", "meet")
    across, down = size[0] / box[2], size[1] / box[3]
    shares = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    if align[1:4] not in shares or align[5:8] not in shares:
        align = align if align == "none" else "xMidYMid"
    x, y = -across * box[0], -down * box[1]
    if align != "none":
        across = down = max(across, down) if fit == "slice" else min(across, down)
        x = (size[0] - across * box[2]) * shares[align[1:4]] - across * box[0]
        y = (size[1] - down * box[3]) * shares[align[5:8]] - down * box[1]
    return np.array([[across, 0.0, x], [0.0, down, y], [0.0, 0.0, 1.0]])
