"""What the viewer computes, and as JSON for the page: a glyph, with moved vertices, by other variants, step by step.

The page gets path data and lists of points, y down, with two decimals; paths of results are as they are written.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from functools import cached_property, lru_cache
from itertools import chain
from pathlib import Path
from threading import RLock
from typing import Any

import numpy as np

from ...errors import GlyphsplineError
from ...fields import arguments, instance_arguments
from ...fitting.closed_curves import History, recorded, through_polygons
from ...fitting.convert import convert
from ...fitting.measures import with_geometry
from ...fitting.options import Options
from ...fitting.results import ContourResult, GlyphResult, as_glyph
from ...hooks import service
from ...interpolation.result import Interpolation
from ...outlines.contour_arrays import polylines
from ...outlines.joins import joins
from ...outlines.masters import MasterContour
from ...outlines.outline import Contour, Contours, Outline
from ...readers import Font, open_font
from ...runs.spec import RunSpec
from ...types import BoolArray, FloatArray, rounded_up
from ...writers.json_file import finite
from ...writers.svg.comb import curvature_scale
from ...writers.svg.document import code_points
from ...writers.svg.path_data import path_data, polylines_data
from .requests import Moved, PageState

COMPARED = (1, 2, 3)
"""Variants shown side by side, as in the paper's Figs. 8 and 9."""

STEPS = 60
"""Maximum number of iterations shown: the first half of them are consecutive, then their distance grows."""

DIGITS = 2
"""Decimals of paths, at least: with fewer, the combs that the page draws over short segments are uneven."""


class Work:
    """A font, opened at each location of its design space on request, and a cache of converted glyphs."""

    def __init__(self, path: Path, face_index: int = 0) -> None:
        self.path, self.face_index = path, face_index
        self.lock = RLock()  # a font's tables are read on demand, by one thread at a time
        self.at = lru_cache(maxsize=12)(lambda location: open_font(path, face_index, dict(location)))
        self.converted = lru_cache(maxsize=128)(self._convert)  # a line of text has that many
        self.in_all_masters = lru_cache(maxsize=16)(self._convert_masters)
        self.font: Font = self.at(())
        self.em = self.font.metrics.units_per_em

    def outline(self, glyph: str, location: tuple[tuple[str, float], ...]) -> Outline:
        """The glyph's outline at a location."""
        with self.lock:
            return self.at(location).outline(glyph)

    def has_ink(self, glyph: str) -> bool:
        """Whether a glyph can be read and has contours."""
        try:
            return len(self.outline(glyph, ()).contours) > 0
        except GlyphsplineError:
            return False

    def _convert(self, glyph: str, location: tuple[tuple[str, float], ...], options: Options) -> GlyphResult:
        return convert(self.outline(glyph, location), options)

    def _convert_masters(self, glyph: str, options: Options) -> Any:
        with self.lock:
            masters = self.font.masters(glyph)
        return service("convert_masters")(masters, options)

    def result(self, state: PageState, variant: int | None = None) -> GlyphResult:
        """The glyph of a state, or of the state with another variant.

        On smooth contours another variant interpolates the same polygon, so only the variant differs. Sharp contours
        are converted again.
        """
        result = moved(self.converted(state.glyph, state.location, state.options), state.moved)
        if variant is None or variant == state.options.variant:
            return result
        options = replace(result.options, variant=variant)
        if state.options.corners == "sharp":
            return self.converted(state.glyph, state.location, options)
        contours = tuple(through(contour, contour.polygon, options) for contour in result.contours)
        return replace(result, options=options, contours=contours)

    def text(self, state: PageState) -> tuple[str, list[str]]:
        """The text of a state as an SVG drawing, each distinct glyph converted once, and remarks."""
        with self.lock:
            placed = service("layout")(self.at(state.location), state.text)
            names = [self.font.glyph_names[gid] for _, gid in placed.distinct()]
        notes = [f"no glyph for {' '.join(placed.missing)}"] if placed.missing else []
        results = []
        for name in names:
            try:
                results.append(self.converted(name, state.location, state.options))
            except GlyphsplineError as error:
                results.append(GlyphResult(Outline(name), state.options, (), (str(error),)))
            notes += [] if results[-1].contours else results[-1].notes
        return service("text_document")(placed, results).decode(), notes

    @cached_property
    def scale(self) -> float:
        """The font's curvature scale, from the source outlines of at most 60 glyphs."""
        names = [name for name in self.font.glyph_names if name in set(self.font.cmap.values())]
        chosen = (names or list(self.font.glyph_names))[:: max(1, len(names) // 60)]
        # A broken glyph has its error when it is shown.
        return curvature_scale(as_glyph(self.outline(name, ())) for name in filter(self.has_ink, chosen)) or 4 / self.em

    def command(self, state: PageState, along: str | None = None) -> str:
        """The command that converts the glyph, without moved vertices, or that draws it ``along`` an axis.

        Curves as fonts store them are those of ``refit``.
        """
        gid = str(self.font.glyph_names.index(state.glyph))
        words = [str(self.path), "--gids", gid, *instance_arguments(self.face_index, dict(state.location))]
        options = replace(state.options, measure=False)
        if along is not None:
            words += [*chain(*arguments(options, Options()).values()), "--axis", along, "--out", f"gid-{gid}.pdf"]
            return shlex.join(["glyphspline", "atlas", *words])
        if options.is_for_fonts:
            verb, words = "refit", [*words, "--format", "svg"]
            own = arguments(options, Options(corners="sharp", continuity="g2"), ("variant",))
        else:
            verb, own = "convert", arguments(options, Options(), RunSpec.unshown)
        return shlex.join(["glyphspline", verb, *words, *chain(*own.values()), "--out", f"outputs/gid-{gid}"])


def moved(result: GlyphResult, moves: Moved) -> GlyphResult:
    """The glyph with moved polygon vertices; changed contours are interpolated again. Smooth contours only."""
    contours = list(result.contours)
    for index in sorted({move[0] for move in moves}):
        if not 0 <= index < len(contours) or not is_smooth(contours[index]):
            continue
        polygon = contours[index].polygon.copy()
        for contour, vertex, x, y in moves:
            if contour == index and 0 <= vertex < len(polygon):
                polygon[vertex] = x, y
        contours[index] = through(contours[index], polygon, result.options)
    return replace(result, contours=tuple(contours))


def is_smooth(contour: ContourResult) -> bool:
    """Whether the contour is one closed curve."""
    return len(contour.interpolations) == 1 and contour.interpolations[0].spline.closed


def through(contour: ContourResult, polygon: FloatArray, options: Options) -> ContourResult:
    """The closed curve through a polygon, computed as in a conversion by step or count."""
    source = Contours([contour.source]).arrays
    found = through_polygons(source, polygon, np.array([0, len(polygon)]), options, 0.0)
    return with_geometry(found, options).contour_results()[0]


def steps(result: GlyphResult) -> Iterator[tuple[int, list[Interpolation]]]:
    """Numbers of updates, and after each number the closed curves of the glyph."""
    closed = [contour for contour in result.contours if is_smooth(contour)]
    shown = shown_steps(updates_of(result))
    arcs = [contour.interpolations[0] for contour in closed]
    runs = [
        recorded(contour.polygon, result.options, [m for m in shown if m < arc.iterations])
        for contour, arc in zip(closed, arcs, strict=True)
    ]
    for m in shown:
        yield m, [_after(m, arc, run) for arc, run in zip(arcs, runs, strict=True)]


def updates_of(result: GlyphResult) -> int:
    """The largest number of updates of a closed curve of the glyph."""
    return max((c.interpolations[0].iterations for c in result.contours if is_smooth(c)), default=0)


def _after(updates: int, arc: Interpolation, run: History) -> Interpolation:
    """A closed curve after a number of updates: its own end if it needed no more."""
    if updates not in run:
        return arc
    controls, parameters = run[updates]
    spline = replace(arc.spline, control_points=controls)
    return replace(arc, spline=spline, parameters=parameters, residuals=arc.residuals[: updates + 1])


def shown_steps(most: int) -> list[int]:
    """Which of the iterations 0 to ``most`` are shown."""
    if most < STEPS:
        return list(range(most + 1))
    late = np.geomspace(STEPS // 2, most, STEPS - STEPS // 2).round().astype(int).tolist()
    return sorted({*range(STEPS // 2), *late})


def glyph_payload(outline: Outline) -> dict[str, Any]:
    """The source outline and the facts of the glyph."""
    return {
        "glyph": outline.name,
        "gid": outline.gid,
        "unicodes": code_points(outline),
        "advance": outline.advance,
        "source": path_data(outline.contours, DIGITS),
    }


def result_payload(result: GlyphResult) -> dict[str, Any]:
    """The result: its path, polygons, control polygons, footpoints and measures."""
    arcs = [arc for contour in result.contours for arc in contour.interpolations]
    return {
        "variant": result.options.variant,
        "result": path_data((each.curve for each in result.contours), max(DIGITS, result.options.precision)),
        "polygons": [points(contour.polygon) for contour in result.contours],
        "movable": [is_smooth(contour) for contour in result.contours],
        "notes": list(result.notes),
        "steps": len(shown_steps(updates_of(result))),
        "residuals": [[finite(error) for error in arc.residuals.tolist()] for arc in arcs],
        "intervals": intervals_data(arcs),
        "measures": [{k: finite(v) for k, v in asdict(contour.measures).items()} for contour in result.contours],
        **curves_payload(arcs),
    }


def instance_payload(result: Any, location: Mapping[str, float]) -> dict[str, Any]:
    """A glyph converted in all masters, as it is at a location: source and result."""
    masters, curves = result.masters, [contour.curve for contour in result.contours]
    weights = masters.weights(location)
    every = np.concatenate([np.zeros((0, 2)), *(contour.points.reshape(-1, 2) for contour in masters.contours)])
    return {
        "glyph": masters.name,
        "gid": masters.gid,
        "unicodes": code_points(result.mixed(weights)),
        "masters": len(masters),
        "corners": points(np.array([every.min(axis=0), every.max(axis=0)])) if len(every) else [],
        "source": side_payload(masters.contours, weights),
        "result": side_payload(curves, weights),
        "bound": rounded_up(max((contour.deviation_bound for contour in result.contours), default=0.0), 3),
        "notes": list(result.notes),
    }


def side_payload(contours: Sequence[MasterContour], weights: FloatArray) -> dict[str, Any]:
    """The path of contours with weights of the masters, and where the joint turns most that is smooth in every master.

    The turn is in degrees; None without such a joint.
    """
    drawn = [contour.mixed(weights) for contour in contours]
    found = [joins(contour) for contour in drawn]
    turned = np.degrees(np.abs(np.concatenate([np.zeros(0), *(each.turns for each in found)])))
    turned[~np.concatenate([np.zeros(0, np.bool_), *map(smooth_joints, contours)])] = -1.0
    side: dict[str, Any] = {  # with fewer decimals, combs of short segments are uneven
        "path": path_data(drawn, 4),
        "segments": sum(map(len, contours)),
        "turn": None,
    }
    if turned.max(initial=-1.0) >= 0.0:
        worst = int(turned.argmax())
        place = np.concatenate([each.points for each in found])[worst : worst + 1]
        side |= {"turn": float(turned[worst]), "point": points(place)[0]}
    return side


@lru_cache(maxsize=256)
def smooth_joints(contour: MasterContour) -> BoolArray:
    """(m,) which joints are smooth in every master."""
    masters = [Contour(each, contour.degrees) for each in contour.points]
    corners = np.array([joins(master).of("corner", 0.0) for master in masters])
    return np.asarray(~corners.any(axis=0), dtype=np.bool_)


def curves_payload(arcs: list[Interpolation]) -> dict[str, Any]:
    """Control polygons and footpoints of curves."""
    return {
        "control": lines_data([arc.spline.control_points for arc in arcs], [arc.spline.closed for arc in arcs]),
        "controls": [point for arc in arcs for point in points(arc.spline.control_points)],
        "feet": [point for arc in arcs for point in points(arc.spline(arc.parameters))],
    }


def step_payload(updates: int, curves: list[Interpolation]) -> dict[str, Any]:
    """The curves after a number of updates."""
    shapes = [Contour.from_segments(curve.spline.to_bezier()) for curve in curves]
    error = max((curve.max_error for curve in curves), default=0.0)
    return {"step": updates, "error": error, "result": path_data(shapes, DIGITS), **curves_payload(curves)}


def intervals_data(arcs: list[Interpolation]) -> str:
    """The parts of curves searched for footpoints, as path data, without those of a single point."""
    parts: list[FloatArray] = []
    for arc in arcs:
        wide = arc.intervals[:, 1] > arc.intervals[:, 0]
        a, b = arc.intervals[wide].T
        # Points of the polyline that shows the interval of a footpoint.
        t = a[:, None] + (b - a)[:, None] * np.linspace(0, 1, 7)
        parts += list(arc.spline(t))
    return lines_data(parts, [False] * len(parts))


def lines_data(lines: Sequence[FloatArray], closed: Sequence[bool]) -> str:
    """Path data of polylines, all in one call."""
    return polylines_data(polylines(lines, closed), DIGITS)[0].text if lines else ""


def points(array: FloatArray) -> list[list[float]]:
    """(n, 2) as pairs, y down."""
    return (np.round(array * (1, -1), DIGITS) + 0.0).tolist()
