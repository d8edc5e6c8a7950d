from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as MatplotlibPath
from svgpathtools import Line, parse_path

import glyphspline as gs
from glyphspline.fitting.results import joined_results
from glyphspline.outlines.outline import Contours
from glyphspline.types import FloatArray
from glyphspline.writers.settings import VIEW_BOXES, ViewBox
from glyphspline.writers.svg.document import number, polygon_document, to_svg
from glyphspline.writers.svg.path_data import curves_data, polyline_data
from tests.drawings import L_SHAPE, circle, polygon_contour, result
from tests.topology import path_contours

SVG = "{http://www.w3.org/2000/svg}"
HOSTILE = "a\"'><script>alert(1)</script>&amp;\x00\x1b\ud800]]>龍"


def path_of(svg: str) -> str:
    paths = ElementTree.fromstring(svg).findall(f".//{SVG}path")
    assert len(paths) == 1
    return paths[0].attrib["d"]


def box_of(svg: str) -> list[float]:
    return [float(word) for word in ElementTree.fromstring(svg).attrib["viewBox"].split()]


def wavy(seed: int = 1) -> gs.Contour:
    """A C2 spline through random points, as its exact Béziers."""
    points = np.random.default_rng(seed).uniform(-300, 900, (12, 2))
    return gs.Contour.from_segments(list(gs.interpolate(points, 2, fallback="peak").spline.to_bezier()))


def test_written_path_reads_back_as_the_same_beziers() -> None:
    curve = wavy()
    read = parse_path(path_of(to_svg(result(curve))))
    assert len(read) == len(curve)
    for segment, expected in zip(read, curve.segments(), strict=True):
        points = np.array([[p.real, -p.imag] for p in segment.bpoints()])
        assert np.abs(points - expected).max() <= 0.05 + 1e-9


def test_path_read_back_passes_through_every_vertex_with_the_splines_curvature() -> None:
    points = np.random.default_rng(4).uniform(0, 1000, (20, 2))
    r = gs.interpolate(points, 2, margin=0.02, fallback="peak", residual_tolerance=0.005)
    curve = gs.Contour.from_segments(list(r.spline.to_bezier()))
    read = parse_path(path_of(to_svg(replace(result(curve), options=gs.Options(precision=2)))))
    rounding = 0.005 * np.sqrt(2)
    for x, y in points:
        distance = min(segment.radialrange(complex(x, -y))[0][0] for segment in read)
        assert distance <= 0.005 + rounding + 1e-9
    middle = (r.spline.knots[:-1] + r.spline.knots[1:]) / 2
    # svgpathtools measures without sign, and rounding to 0.01 moves second differences of 100-unit pieces by 1e-3.
    read_curvature = np.array([segment.curvature(0.5) for segment in read])
    assert read_curvature == pytest.approx(np.abs(r.spline.curvature(middle)), rel=0.02, abs=1e-5)
    before = np.array([segment.curvature(1.0) for segment in read])
    after = np.roll([segment.curvature(0.0) for segment in read], -1)
    assert before == pytest.approx(after, rel=0.02, abs=1e-5)


def test_lines_stay_lines_and_quadratics_quadratics() -> None:
    mixed = gs.Contour.from_segments(
        [np.array([[0, 0], [100, 0]]), np.array([[100, 0], [200, 50], [100, 100]]), np.array([[100, 100], [0, 0]])]
    )
    assert path_of(to_svg(result(mixed))) == "M0 0h100q100-50 0-100Z"
    read = parse_path(path_of(to_svg(result(mixed))))
    assert isinstance(read[-1], Line)
    assert read[-1].end == 0


@pytest.mark.parametrize(
    ("value", "precision", "expected"),
    [
        (-0.001, 2, "0"),
        (0.1 + 0.2, 2, "0.3"),
        (100.0, 2, "100"),
        (-12.3456, 2, "-12.35"),
        (65535.99, 2, "65535.99"),
        (1234.5, 0, "1234"),
    ],
)
def test_numbers_are_minimal(value: float, precision: int, expected: str) -> None:
    assert number(value, precision) == expected
    point = gs.Contour(np.array([[value, 1], [2, 3], [4, 5]]), np.ones(3, dtype=np.int64))
    if precision == 2:
        data = path_of(to_svg(replace(result(point), options=gs.Options(precision=2))))
        assert data.replace("L", "l").startswith(f"M{expected.removeprefix('0') or '0'}-1l")


@pytest.mark.parametrize(
    ("value", "precision", "text"),
    [(0, 2, "0"), (5, 2, ".05"), (-5, 2, "-.05"), (120, 2, "1.2"), (-100, 2, "-1"), (12345, 0, "12345"),
     (999_999_999_999_999, 3, "999999999999.999"), (1_000_000, 2, "10000"), (7, 9, ".000000007"), (-7, 4, "-.0007")],
)  # fmt: skip
def test_numbers_are_written_exactly(value: int, precision: int, text: str) -> None:
    points = np.array([[value, -value]]) / 10.0**precision
    parted = "" if value < 0 or text.startswith(".") else " "
    assert polyline_data(points, precision) == f"M{text}{parted}{text}"


def test_numbers_of_any_size_are_written() -> None:
    huge = gs.Contour(np.array([[0, 0], [1e20, 0], [1e20, 1e20], [0, 1e20], [-1e20, 5]]), np.array([1, 3, 1]))
    small = polygon_contour(L_SHAPE)
    arrays = Contours([small, huge, small]).arrays
    first, second, third = curves_data(arrays, 2, np.array([0, 1, 2, 3]))
    assert first.text == third.text
    assert second.text == "M0 0L1e+20 0C1e+20 -1e+20 0 -1e+20 -1e+20 -5Z"
    assert first.box == (50, 0, 450, 700)


def test_path_data_does_not_depend_on_the_batch() -> None:
    glyphs = [result(wavy(seed), polygon_contour(L_SHAPE)) for seed in range(4)] + [result(), result(wavy(9))]
    arrays, offsets = joined_results(glyphs)
    for glyph, found in zip(glyphs, curves_data(arrays.curves, 2, offsets), strict=True):
        alone = curves_data(glyph.arrays.curves, 2)[0]
        assert found == alone


def test_no_negative_zero_is_written() -> None:
    drawn = polygon_contour(L_SHAPE - np.array([50.001, 79.999]))
    assert not re.search(r"-0(?![.\d])", path_of(to_svg(result(drawn))))


@given(st.lists(st.integers(1, 3), min_size=2, max_size=9), st.integers(0, 2), st.randoms(use_true_random=False))
def test_all_forms_add_up_to_the_rounded_points(degrees: list[int], precision: int, random: Random) -> None:
    """Few places to be at, so that lines are level, and handles mirror each other."""
    points = np.array([[random.randint(-3, 3) / 2 for _ in range(2)] for _ in range(sum(degrees))])
    shape = gs.Contour(points, np.array(degrees))
    drawn = replace(result(shape, shape), options=gs.Options(precision=precision))
    curves = [each.curve.rounded(precision) for each in drawn.contours]
    expected = [[tuple(map(tuple, piece)) for piece in curve.segments()] for curve in curves]
    read = path_contours(path_of(to_svg(drawn)))
    found = [[tuple((x / read.unit, y / read.unit) for x, y in piece) for piece in pieces] for pieces in read.contours]
    if degrees[-1] == 1:  # a last line of no length is not drawn
        expected = [
            [piece for k, piece in enumerate(own) if k < len(degrees) - 1 or piece[0] != piece[1]] for own in expected
        ]
    assert found == expected


def test_a_segment_is_written_in_the_shortest_of_its_forms() -> None:
    cubics = [[(0, 0), (0, 50), (50, 100), (100, 100)], [(100, 100), (150, 100), (200, 50), (200, 0)]]
    quadratics = [[(200, 0), (200, -40), (150, -40)], [(150, -40), (100, -40), (100, -100)]]
    shape = gs.Contour.from_segments(
        [np.array(each, dtype=float) for each in [*cubics, *quadratics, [(100, -100), (0, 0)]]]
    )
    data = path_of(to_svg(replace(result(shape), options=gs.Options(precision=0))))
    assert data == "M0 0c0-50 50-100 100-100S200-50 200 0q0 40-50 40t-50 60Z"


def raster(path: str, box: list[float]) -> FloatArray:
    """Ink (rows from the top, columns) of path data in a view box, by matplotlib's own renderer."""
    points: list[tuple[float, float]] = []
    codes: list[int] = []
    for sub in parse_path(path).continuous_subpaths():
        polygon = [segment.point(t) for segment in sub for t in np.linspace(0, 1, 8, endpoint=False)]
        points += [(p.real, p.imag) for p in [*polygon, polygon[0]]]
        codes += [1, *[2] * (len(polygon) - 1), 79]
    figure = Figure(figsize=(2, 2), dpi=100)
    canvas: Any = FigureCanvasAgg(figure)
    axes: Any = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(box[0], box[0] + box[2]), ylim=(box[1] + box[3], box[1]))  # y down, as a browser shows it
    axes.set_axis_off()
    axes.add_patch(PathPatch(MatplotlibPath(points, codes), facecolor="black", linewidth=0))
    buffer = io.BytesIO()
    canvas.print_rgba(buffer)
    pixels = np.frombuffer(buffer.getvalue(), dtype=np.uint8).reshape(200, 200, 4)
    return (255.0 - pixels[..., 0]) / 255


def test_upright_and_not_mirrored_when_rendered() -> None:
    svg = to_svg(result(polygon_contour(L_SHAPE)), view_box="ink")
    ink = raster(path_of(svg), box_of(svg))
    assert ink[180:].sum() > 3 * ink[:20].sum() > 0  # the foot of an L is below
    assert ink[:, :40].sum() > 3 * ink[:, 160:].sum() > 0  # and its stem on the left


def test_counter_is_open() -> None:
    outer, inner = circle(300, 8, centre=(300, 300)), circle(200, 8, centre=(300, 300), turn=-1)
    svg = to_svg(result(gs.Contour.from_segments(list(outer)), gs.Contour.from_segments(list(inner))), view_box="ink")
    ink = raster(path_of(svg), box_of(svg))
    assert ink[95:105, 95:105].max() == 0
    assert ink[95:105, 5:25].min() == 1


@pytest.mark.parametrize("choice", VIEW_BOXES)
def test_view_boxes(choice: ViewBox) -> None:
    contour = gs.Contour.from_segments(list(circle(300, 8, centre=(250, -100))))
    svg = to_svg(result(contour, advance=500), view_box=choice)
    left, top, width, height = box_of(svg)
    expected = {"em": [-50, -800, 600, 1200], "metrics": [0, -800, 500, 1000], "ink": [-50, -200, 600, 600]}[choice]
    assert [left, top, width, height] == pytest.approx(expected, abs=0.2)
    inside = left <= -50 and top <= -200 and left + width >= 550 and top + height >= 400
    assert inside == (choice != "metrics")
    assert ('overflow="visible"' in svg) == (choice == "metrics")


def test_unknown_view_box_is_refused() -> None:
    with pytest.raises(ValueError, match="bbox"):
        to_svg(result(polygon_contour(L_SHAPE)), view_box="bbox")  # type: ignore[arg-type]


@pytest.mark.parametrize("seed", range(5))
def test_ink_bounds_are_tight(seed: int) -> None:
    curve = wavy(seed)
    t = np.linspace(0, 1, 2001)[:, None]
    samples = np.concatenate(
        [
            (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d
            for a, b, c, d in curve.cubics()
        ]
    )
    dense = (*samples.min(axis=0), *samples.max(axis=0))
    assert curves_data(Contours([curve]).arrays, 3)[0].box == pytest.approx(dense, abs=2e-3)


def test_hostile_names_stay_text() -> None:
    glyph = result(polygon_contour(L_SHAPE), name=HOSTILE, unicodes=(0x41, 0x1F600))
    for svg in (to_svg(glyph), polygon_document(glyph).decode()):
        root = ElementTree.fromstring(svg)
        assert not root.findall(f".//{SVG}script")
        clean = HOSTILE.replace("\x00", "\ufffd").replace("\x1b", "\ufffd").replace("\ud800", "\ufffd")
        assert root.attrib["data-glyph"] == clean
        assert root.attrib["data-unicodes"] == "U+0041 U+1F600"
        svg.encode("utf-8")


def test_identity_and_metrics_can_be_recovered() -> None:
    root = ElementTree.fromstring(to_svg(result(polygon_contour(L_SHAPE))))
    data = {key[5:]: value for key, value in root.attrib.items() if key.startswith("data-")}
    assert data == {
        "glyph": "A",
        "gid": "36",
        "unicodes": "U+0041",
        "advance": "600",
        "units-per-em": "1000",
        "ascender": "800",
        "descender": "-200",
    }


def test_drawings_side_by_side_in_a_page_share_no_id_and_show_no_tooltip() -> None:
    for svg in (to_svg(result(polygon_contour(L_SHAPE))), polygon_document(result(polygon_contour(L_SHAPE))).decode()):
        elements = list(ElementTree.fromstring(svg).iter())
        assert not any("id" in element.attrib or element.tag == f"{SVG}title" for element in elements)
        assert elements[0].attrib["aria-label"].endswith("A U+0041")


def test_a_bare_drawing_is_a_path_in_an_svg() -> None:
    shape = result(polygon_contour(L_SHAPE))
    (path,) = ElementTree.fromstring(svg := to_svg(shape, bare=True))
    assert [*ElementTree.fromstring(svg).attrib] == ["viewBox"]
    assert path.attrib == {"d": path_of(to_svg(shape))}
    painted = ElementTree.fromstring(to_svg(shape, bare=True, fill="red", size="20mm"))
    assert (painted.attrib["height"], painted[0].attrib["fill"]) == ("20mm", "red")


@pytest.mark.parametrize("choice", VIEW_BOXES)
def test_empty_glyph_is_a_valid_drawing(choice: ViewBox) -> None:
    svg = to_svg(result(name="space", advance=0), view_box=choice)
    assert path_of(svg) == ""
    assert box_of(svg)[2] > 0


def test_polygon_drawing_has_outline_and_polygon() -> None:
    root = ElementTree.fromstring(polygon_document(result(polygon_contour(L_SHAPE))))
    groups = {group.attrib["class"]: group for group in root.findall(f"{SVG}g")}
    assert list(groups) == ["source", "polygon", "control"]
    outline = parse_path(groups["source"].findall(f"{SVG}path")[0].attrib["d"])
    assert abs(outline.area()) == pytest.approx(400 * 80 + 80 * 620)
