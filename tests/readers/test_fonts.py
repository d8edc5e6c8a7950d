"""Outlines as read, against fontTools' own pens on the same glyphs, and across formats."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.pens.areaPen import AreaPen
from fontTools.pens.boundsPen import BoundsPen
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.pens.transformPen import TransformPen
from fontTools.ttLib import TTFont
from scipy.spatial import KDTree

from glyphspline.outlines.outline import Contour, Outline
from glyphspline.readers import Font, Source, open_font
from glyphspline.types import FloatArray
from tests.places import DEJAVU, FONTS

FACES: list[tuple[Path, int, dict[str, float]]] = [
    (FONTS / "kouzan-gyosho.ttf", 0, {}),
    (FONTS / "kouzan-kaisho.ttf", 0, {}),
    (FONTS / "kouzan-gyosho.otf", 0, {}),
    (FONTS / "kouzan-gyosho.woff2", 0, {}),
    (FONTS / "kouzan.ttc", 0, {}),
    (FONTS / "kouzan.ttc", 1, {}),
    (FONTS / "edge-cases.ttf", 0, {}),
    (FONTS / "variable.ttf", 0, {}),
    (FONTS / "variable.ttf", 0, {"wght": 650}),
    (FONTS / "variable.ttf", 0, {"wght": 900}),
]


def area(draw: Callable[[Any], None]) -> float:
    pen = AreaPen()
    draw(pen)
    return float(pen.value)


def drawn_area(font: Font, name: str) -> float:
    return area(font.outline(name).draw)


def bounds(outline: Outline) -> tuple[float, ...] | None:
    pen = BoundsPen(None)
    outline.draw(pen)
    return None if pen.bounds is None else tuple(pen.bounds)


def side_bearing_shift(tables: TTFont, name: str) -> float:
    """fontTools leaves composites where they are; rasterisers move every glyph to its left side bearing."""
    glyph = tables["glyf"][name] if "glyf" in tables and "fvar" not in tables else None
    return tables["hmtx"][name][1] - glyph.xMin if glyph is not None and glyph.isComposite() else 0


def assert_agrees_with_fonttools(font: Font, tables: TTFont, name: str) -> None:
    glyph_set = tables.getGlyphSet(location=dict(font.location))
    recording = DecomposingRecordingPen(glyph_set)
    glyph_set[name].draw(TransformPen(recording, (1, 0, 0, 1, side_bearing_shift(tables, name), 0)))
    outline = font.outline(name)
    assert area(outline.draw) == pytest.approx(area(recording.replay), rel=1e-9, abs=1e-6)
    if not outline.notes:  # else the bounds may include what encloses nothing
        pen = BoundsPen(None)
        recording.replay(pen)
        assert (bounds(outline) is None) == (pen.bounds is None)
        assert bounds(outline) == (pytest.approx(pen.bounds, abs=1e-6) if pen.bounds else None)


@pytest.mark.parametrize(
    ("path", "face_index", "location"), FACES, ids=lambda value: str(getattr(value, "name", value))
)
def test_every_glyph_has_the_area_and_bounds_fonttools_gives(
    path: Path, face_index: int, location: dict[str, float]
) -> None:
    font = open_font(path, face_index, location)
    tables = TTFont(path, fontNumber=face_index)
    assert list(font.glyph_names) == tables.getGlyphOrder()
    assert font.num_glyphs == len(font.glyph_names) > 5
    for name in font.glyph_names:
        assert_agrees_with_fonttools(font, tables, name)


def test_a_large_latin_font_agrees_with_fonttools() -> None:
    font, tables = open_font(DEJAVU), TTFont(DEJAVU)
    assert font.family == "DejaVu Sans"
    assert font.metrics.units_per_em == 2048
    for name in font.glyph_names[::25]:
        assert_agrees_with_fonttools(font, tables, name)


def test_contours_are_chains_without_segments_of_no_length() -> None:
    for path, face_index, location in FACES:
        font = open_font(path, face_index, location)
        for name in font.glyph_names:
            for contour in font.outline(name).contours:
                segments = list(contour.segments())
                for segment, following in zip(segments, segments[1:] + segments[:1], strict=True):
                    np.testing.assert_array_equal(segment[-1], following[0])
                    assert np.ptp(segment, axis=0).max() > 0


@pytest.mark.parametrize("file", ["kouzan-gyosho.woff2", "kouzan.ttc", "gyosho.woff"])
def test_containers_hold_the_very_same_outlines(file: str, tmp_path: Path) -> None:
    as_woff = TTFont(FONTS / "kouzan-gyosho.ttf", recalcTimestamp=False)
    as_woff.flavor = "woff"
    as_woff.save(tmp_path / "gyosho.woff")
    path = FONTS / file if (FONTS / file).exists() else tmp_path / file
    plain, packed = open_font(FONTS / "kouzan-gyosho.ttf"), open_font(path)
    assert plain.glyph_names == packed.glyph_names
    for name in plain.glyph_names:
        one, other = plain.outline(name), packed.outline(name)
        assert (one.advance, one.unicodes, one.gid) == (other.advance, other.unicodes, other.gid)
        assert len(one.contours) == len(other.contours)
        for a, b in zip(one.contours, other.contours, strict=True):
            np.testing.assert_array_equal(a.points, b.points)
            np.testing.assert_array_equal(a.degrees, b.degrees)


def test_glyphs_of_one_name_are_told_apart(tmp_path: Path) -> None:
    data = (FONTS / "kouzan-gyosho.otf").read_bytes()
    (tmp_path / "same.otf").write_bytes(data.replace(b"uni3042", b"uni3044"))
    plain, same = open_font(FONTS / "kouzan-gyosho.otf"), open_font(tmp_path / "same.otf")
    assert same.glyph_names.count("uni3044") == 1
    assert len(set(same.glyph_names)) == same.num_glyphs == plain.num_glyphs
    for name, original in zip(same.glyph_names, plain.glyph_names, strict=True):
        assert drawn_area(same, name) == drawn_area(plain, original)


def test_a_collection_has_two_faces() -> None:
    gyosho, kaisho = (open_font(FONTS / "kouzan.ttc", k) for k in range(2))
    assert (gyosho.family, kaisho.family) == ("Kouzan Gyosho Subset", "Kouzan Kaisho Subset")
    assert gyosho.num_faces == 2
    assert drawn_area(gyosho, "uni9F8D") != drawn_area(kaisho, "uni9F8D")


def test_cff_outlines_are_the_truetype_ones_within_rounding_run_the_other_way() -> None:
    quadratic, cubic = open_font(FONTS / "kouzan-gyosho.ttf"), open_font(FONTS / "kouzan-gyosho.otf")
    degrees = set()
    for name in quadratic.glyph_names:
        assert cubic.outline(name).advance == quadratic.outline(name).advance
        for a, b in zip(quadratic.outline(name).contours, cubic.outline(name).contours, strict=True):
            degrees.update(b.degrees.tolist())
            # Each control point moves by at most half a unit each way, and so does the curve between them.
            assert two_sided_distance(a, b) < np.hypot(0.5, 0.5) + 0.02
            assert area(a.draw) == pytest.approx(-area(b.draw), rel=0.02)
    assert degrees == {1, 3}


def two_sided_distance(a: Contour, b: Contour) -> float:
    """Largest distance of a point of either contour from the other, by points a quarter of a unit apart."""
    one, other = densely(a), densely(b)
    return float(max(KDTree(one).query(other)[0].max(), KDTree(other).query(one)[0].max()))


def densely(contour: Contour) -> FloatArray:
    points = []
    for cubic in contour.cubics():
        length = np.hypot(*np.diff(cubic, axis=0).T).sum()
        t = np.linspace(0, 1, 2 + int(8 * length))[:, None]
        points.append(np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3]) @ cubic)
    return np.concatenate(points)


def test_a_contour_with_no_point_on_the_curve_is_made_of_implied_points() -> None:
    font = open_font(FONTS / "variable.ttf")
    (contour,) = font.outline("dot").contours
    coordinates, ends, flags = TTFont(FONTS / "variable.ttf")["glyf"]["dot"].getCoordinates(None)
    assert not any(flags)
    assert ends == [7]
    assert contour.degrees.tolist() == [2] * 8
    controls = np.array(coordinates, dtype=float)
    midpoints = (controls + np.roll(controls, -1, axis=0)) / 2
    assert {tuple(p) for p in contour.points.tolist()} == {tuple(p) for p in [*controls.tolist(), *midpoints.tolist()]}
    assert np.hypot(*(midpoints - (130, 600)).T) == pytest.approx(50, abs=1)


def test_components_are_placed_by_their_transforms() -> None:
    font = open_font(FONTS / "variable.ttf")
    i, stem, dot = (drawn_area(font, name) for name in ("i", "stem", "dot"))
    assert i == pytest.approx(stem + dot)
    assert drawn_area(font, "ii") == pytest.approx(1.5 * i)  # the second copy at half the height
    assert drawn_area(font, "mirror") == pytest.approx(-0.75 * drawn_area(font, "o"))
    (dot_alone,), (_, dot_placed) = font.outline("dot").contours, font.outline("i").contours
    np.testing.assert_array_equal(dot_placed.points, dot_alone.points + np.array([0, 15]))
    assert len(font.outline("ii").contours) == 4


@pytest.mark.parametrize(("weight", "share"), [(400, 0.0), (525, 0.25), (650, 0.5), (900, 1.0)])
def test_outlines_and_advances_vary_with_the_weight(weight: float, share: float) -> None:
    light, bold = (open_font(FONTS / "variable.ttf", location={"wght": end}) for end in (400, 900))
    between = open_font(FONTS / "variable.ttf", location={"wght": weight})
    assert light.outline("stem").advance == 260
    assert bold.outline("stem").advance == 400
    for name in between.glyph_names:
        a, b, found = (font.outline(name) for font in (light, bold, between))
        assert found.advance == pytest.approx((1 - share) * a.advance + share * b.advance, abs=0.5)
        for p, q, r in zip(a.contours, b.contours, found.contours, strict=True):
            np.testing.assert_allclose(r.points, (1 - share) * p.points + share * q.points, atol=1.0)


def test_the_default_location_is_the_font_as_stored() -> None:
    plain, at_default = open_font(FONTS / "variable.ttf"), open_font(FONTS / "variable.ttf", location={"wght": 400})
    assert [(axis.tag, axis.minimum, axis.default, axis.maximum) for axis in plain.axes] == [("wght", 400, 400, 900)]
    assert plain.location == {}
    for name in plain.glyph_names:
        assert bounds(plain.outline(name)) == bounds(at_default.outline(name))


def test_a_location_out_of_range_is_brought_back_with_a_warning(caplog: pytest.LogCaptureFixture) -> None:
    font = open_font(FONTS / "variable.ttf", location={"wght": 1000})
    assert font.location == {"wght": 900}
    assert font.outline("stem").advance == 400
    assert "wght" in caplog.text
    assert "1000" in caplog.text


def test_what_encloses_nothing_is_left_out_and_noted() -> None:
    font = open_font(FONTS / "edge-cases.ttf")
    kept = {"onepoint": (1, "contour 1"), "twopoints": (1, "contour 0"), "flat": (0, "contour 0")}
    for name, (contours, place) in kept.items():
        outline = font.outline(name)
        assert len(outline.contours) == contours
        assert len(outline.notes) == 1
        assert place in outline.notes[0]
    for name in set(font.glyph_names) - set(kept):
        assert font.outline(name).notes == ()


def test_repeated_points_leave_no_trace() -> None:
    square, hole = open_font(FONTS / "edge-cases.ttf").outline("repeated").contours
    assert square.degrees.tolist() == [1] * 4
    assert hole.degrees.tolist() == [2] * 8


def test_an_empty_glyph_has_an_advance_and_no_contours() -> None:
    font = open_font(FONTS / "edge-cases.ttf")
    assert font.outline("space").advance == 250
    assert [len(font.outline(name).contours) for name in ("space", "hollow")] == [0, 0]


def test_an_outline_knows_its_place_in_the_font() -> None:
    font = open_font(FONTS / "edge-cases.ttf")
    outline = font.outline("a")
    assert (outline.name, outline.gid, outline.unicodes) == ("a", 2, (ord("a"), 0x3B1))
    assert (outline.metrics.units_per_em, outline.metrics.ascender, outline.metrics.descender) == (1000, 800, -200)
    assert [font.outline(name).gid for name in font.glyph_names] == list(range(font.num_glyphs))


def test_a_font_is_a_source_and_travels_by_how_it_was_opened() -> None:
    font: Source = open_font(str(FONTS / "variable.ttf"), location={"wght": 650})
    assert font.sha256 == hashlib.sha256((FONTS / "variable.ttf").read_bytes()).hexdigest()
    copy = pickle.loads(pickle.dumps(font))
    assert copy.location == font.location == {"wght": 650}
    assert bounds(copy.outline("o")) == bounds(font.outline("o"))
