"""SVG drawings as outlines: round trips, shapes, transforms, and what is refused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fontTools.pens.areaPen import AreaPen

import glyphspline as gs
from glyphspline.errors import FontError, GlyphsplineError
from glyphspline.outlines.outline import Outline
from glyphspline.plugins.drawings.svg import SvgDrawings
from glyphspline.readers import Source, open_source
from tests.drawings import L_SHAPE, circle, polygon_contour, result
from tests.places import FONTS

NAMESPACE = 'xmlns="http://www.w3.org/2000/svg"'


def drawing(tmp_path: Path, content: str, name: str = "A", attributes: str = 'viewBox="0 -800 600 1000"') -> Outline:
    path = tmp_path / f"{name}.svg"
    path.write_text(f"<svg {NAMESPACE} {attributes}>{content}</svg>", encoding="utf-8")
    return SvgDrawings.opened(path).outline(name)


def area(outline: Outline) -> float:
    pen = AreaPen()
    outline.draw(pen)
    return float(pen.value)


def test_what_the_svg_writer_wrote_is_read_back_equal(tmp_path: Path) -> None:
    glyph = result(gs.Contour.from_segments(circle(200, 8, centre=(300, 300))), polygon_contour(L_SHAPE))
    (tmp_path / "x.svg").write_text(gs.to_svg(glyph), encoding="utf-8")
    source = open_source(tmp_path / "x.svg")
    assert source.glyph_names == ("A",)
    outline = source.outline("A")
    assert (outline.name, outline.gid, outline.unicodes, outline.advance) == ("A", 0, (65,), 600)
    assert outline.metrics == glyph.outline.metrics
    assert outline.notes == ()
    for written, read in zip(glyph.contours, outline.contours, strict=True):
        np.testing.assert_array_equal(read.degrees, written.curve.degrees)
        np.testing.assert_allclose(read.points, written.curve.rounded(1).points, atol=1e-9)


def test_a_folder_of_drawings_is_a_source_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    for name, gid, code in (("b", 7, 0x62), ("a", 9, 0x61)):
        glyph = result(polygon_contour(L_SHAPE), name=name, gid=gid, unicodes=(code,))
        (tmp_path / f"{name}.svg").write_text(gs.to_svg(glyph), encoding="utf-8")
    source: Source = open_source(tmp_path)
    assert source.glyph_names == ("b", "a")
    assert source.select(text="ab") == ("a", "b")
    assert source.outline("a").gid == 1
    assert source.sha256 == open_source(tmp_path).sha256


def test_names_and_metrics_come_from_file_name_and_view_box(tmp_path: Path) -> None:
    square = '<path d="M0 0h100v-100h-100z"/>'
    outline = drawing(tmp_path, square, "uni9F8D", 'viewBox="-10 -700 500 1000"')
    assert outline.unicodes == (0x9F8D,)
    assert (outline.metrics.ascender, outline.metrics.descender, outline.metrics.units_per_em) == (700, -300, 1000)
    assert outline.advance == 490
    assert drawing(tmp_path, square, "龍").unicodes == (ord("龍"),)
    assert drawing(tmp_path, square, "nonsense").unicodes == ()
    assert drawing(tmp_path, square, "B", 'width="300px" height="400px"').metrics.units_per_em == 400
    in_inches = drawing(tmp_path, square, "in", 'width="2in" height="2.54cm"')
    assert (in_inches.advance, in_inches.metrics.units_per_em) == pytest.approx((192, 96))
    with pytest.raises(FontError, match="its width is in vw"):
        drawing(tmp_path, square, "vw", 'width="3vw" height="400px"')


def test_y_is_turned_up_and_orientation_with_it(tmp_path: Path) -> None:
    (contour,) = drawing(tmp_path, '<path d="M 0 0 L 100 0 L 100 -50 Z"/>').contours
    assert contour.points.tolist() == [[0, 0], [100, 0], [100, 50]]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ('<rect x="10" y="20" width="30" height="40"/>', 1200),
        ('<circle cx="5" cy="5" r="100"/>', np.pi * 1e4),
        ('<ellipse rx="100" ry="50"/>', np.pi * 5e3),
        ('<polygon points="0,0 10,0 10,10"/>', 50),
        ('<polyline points="0,0 10,0 10,10"/>', 50),
        ('<path d="M0 0 A 100 100 0 0 1 200 0 Z"/>', np.pi * 5e3),
        ('<path d="m0,0 10,0 0,10zm20,0 10,0 0,10z"/>', 100),
        ('<path d="M0 0H10V10ZM0 0H20V20Z"/>', 250),
        ('<path d="M0 0Q50 100 100 0"/>', 100 * 100 / 3),
        ('<g transform="scale(2)"><g transform="translate(5,5) rotate(30)"><path d="M0 0h10v10z"/></g></g>', 200),
        ('<path transform="matrix(2 0 0 3 1 1)" d="M0 0h10v10z"/>', 300),
        ('<path transform="scale(2,1)" d="M0 0 A 100 100 0 0 1 200 0 Z"/>', np.pi * 1e4),
    ],
)
def test_shapes_have_their_areas(tmp_path: Path, content: str, expected: float) -> None:
    outline = drawing(tmp_path, content)
    assert abs(area(outline)) == pytest.approx(expected, rel=5e-6)


@pytest.mark.parametrize(
    ("attributes", "box"),
    [
        ('x="30" y="20"', (30, -120, 130, -20)),
        ('x="30" y="20" width="50" height="50" viewBox="0 0 100 100"', (30, -70, 80, -20)),
        ('width="96" height="1in" viewBox="50 50 200 200" overflow="visible"', (-24, -24, 24, 24)),
        ('width="96" height="1in" viewBox="50 50 200 200"', (0, -24, 24, 0)),
        ('height="200" viewBox="0 0 100 100"', (200, -200, 400, 0)),
        ('width="400" height="200" viewBox="0 0 100 100"', (100, -200, 300, 0)),
        ('width="400" height="200" viewBox="0 0 100 100" preserveAspectRatio="xMinYMax"', (0, -200, 200, 0)),
        ('width="400" height="200" viewBox="0 0 100 100" preserveAspectRatio="none"', (0, -200, 400, 0)),
        ('width="400" height="200" viewBox="0 0 100 100" preserveAspectRatio="xMaxYMin slice"', (0, -200, 400, 0)),
        ('width="200" height="100%" viewBox="0 0 200 200" transform="scale(2)"', (0, -1000, 200, -800)),
    ],
)
def test_a_drawing_in_a_drawing_has_a_view_of_its_own(
    tmp_path: Path, attributes: str, box: tuple[float, float, float, float]
) -> None:
    outline = drawing(tmp_path, f'<svg {attributes}><path d="M0 0h100v100h-100z"/></svg>')
    (contour,) = outline.contours
    np.testing.assert_allclose([*contour.points.min(axis=0), *contour.points.max(axis=0)], box, atol=1e-9)


def test_subpaths_that_begin_at_one_point_are_not_joined(tmp_path: Path) -> None:
    assert len(drawing(tmp_path, '<path d="M0 0H10V10ZM0 0H20V20Z"/>').contours) == 2
    first, second = drawing(tmp_path, '<path d="m5 5h10v10zm0 0h20v20z"/>').contours
    assert first.points[0].tolist() == second.points[0].tolist() == [5, -5]


def test_what_is_not_filled_or_not_drawn_is_left_out_and_noted(tmp_path: Path) -> None:
    outline = drawing(
        tmp_path,
        '<defs><path id="p" d="M0 0h9v9z"/></defs><use href="#p"/><!-- remark --><text>A</text>'
        '<g style="fill:none"><path d="M0 0h5v5z"/><path fill="black" d="M0 0h7v7z"/></g>'
        '<path style="display:none" d="M0 0h3v3z"/><path d="M0 0h50"/>',
    )
    assert area(outline) == pytest.approx(-40.5 - 24.5)
    assert outline.notes == ("contour 2 left out: it encloses nothing",)
    assert outline.unread == ("text (line 1)",)


@pytest.mark.parametrize(
    ("document", "message"),
    [
        (f'<!DOCTYPE svg [<!ENTITY a "9"><!ENTITY b "&a;&a;">]><svg {NAMESPACE}><path d="&b;"/></svg>', "entities"),
        (f'<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg {NAMESPACE}>&a;</svg>', "entities"),
        ("<svg", "not well-formed XML"),
        ("<html/>", "not an SVG"),
        (f'<svg {NAMESPACE} viewBox="0 0 0 0"/>', "no height"),
        (f'<?xml version="1.0" encoding="no-such"?><svg {NAMESPACE}/>', "encoding that is not known: no-such"),
        (f'<?xml version="1.0" encoding="ascii"?><svg {NAMESPACE} id="é"/>', "not in its encoding, ascii"),
        (f"<svg {NAMESPACE}>" + "<g>" * 300 + "</g>" * 300 + "</svg>", "nested"),
    ],
)
def test_bad_drawings_are_refused_by_name(tmp_path: Path, document: str, message: str) -> None:
    (tmp_path / "bad.svg").write_text(document)
    with pytest.raises(FontError, match=message) as caught:
        open_source(tmp_path / "bad.svg")
    assert "bad.svg" in str(caught.value)


def test_a_document_type_without_entities_is_read(tmp_path: Path) -> None:
    head = '<?xml version="1.0"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/svg11.dtd">\n'
    (tmp_path / "t.svg").write_text(head + f'<svg {NAMESPACE} viewBox="0 0 9 9"><path d="M0 0h9v9z"/></svg>')
    assert area(open_source(tmp_path / "t.svg").outline("t")) == pytest.approx(-40.5)


def test_a_drawing_has_no_faces_and_no_axes(tmp_path: Path) -> None:
    drawing(tmp_path, '<path d="M0 0h9v9z"/>')
    assert isinstance(open_source(tmp_path / "A.svg"), SvgDrawings)
    for arguments in ((1, None), (0, {"wght": 700}), (0, "Bold")):
        with pytest.raises(GlyphsplineError, match=r"A\.svg"):
            open_source(tmp_path / "A.svg", *arguments)


@pytest.mark.parametrize("file", ["kouzan-gyosho.woff2", "drawing"])
def test_standard_input_is_a_source(tmp_path: Path, file: str) -> None:
    drawing(tmp_path, '<path d="M0 0h9v9z"/>', "drawing")
    data = (FONTS / file if "." in file else tmp_path / f"{file}.svg").read_bytes()
    code = "from glyphspline.readers import open_source as o; f = o('-'); print(len(f.glyph_names), o(f.path).sha256)"
    run = subprocess.run([sys.executable, "-c", code], input=data, capture_output=True, check=True)
    assert run.stdout.split()[0] == (b"18" if "." in file else b"1")
    empty = subprocess.run([sys.executable, "-c", code], input=b"", capture_output=True, check=False)
    assert b"standard input: nothing" in empty.stderr


def test_a_broken_drawing_of_a_folder_costs_only_itself(tmp_path: Path) -> None:
    for name in ("B", "C"):
        drawing(tmp_path, '<path d="M0 0h9v9z"/>', name)
    (tmp_path / "A.svg").write_text("<svg")
    source = open_source(tmp_path)
    assert source.glyph_names == ("A", "B", "C")
    assert len(source.outline("C").contours) == 1
    with pytest.raises(FontError, match=r"A\.svg.*: not well-formed XML"):
        source.outline("A")
    for name in ("B", "C"):
        (tmp_path / f"{name}.svg").unlink()
    with pytest.raises(FontError, match=r"A\.svg: not well-formed XML"):
        open_source(tmp_path)


def test_drawings_become_glyphs_of_a_font(tmp_path: Path) -> None:
    """Scaled to the em, on the baseline; what names no character gets a code point of private use."""
    for name in ("heart", "ring", "A", "uni9F8D", "no-such"):
        (tmp_path / f"{name}.svg").write_text(
            '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24"><path d="M2 2h20v10h-20z"/></svg>'
        )
    (tmp_path / "a.alt.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24" data-unicodes=""><path d="M2 2h9v9z"/></svg>'
    )
    source = open_source(tmp_path, location={"em": 1200})
    assert source.cmap == {0x41: "A", 0x9F8D: "uni9F8D", 0xE000: "heart", 0xE001: "no-such", 0xE002: "ring"}
    outline = source.outline("heart")
    assert (outline.unicodes, outline.advance) == ((0xE000,), 1200)
    assert outline.contours[0].points.min(axis=0).tolist() == [100, 600]
    assert outline.contours[0].points.max(axis=0).tolist() == [1100, 1100]
    metrics = source.metrics
    assert (metrics.units_per_em, metrics.ascender, metrics.descender) == (1200, 1200, 0)
    assert open_source(tmp_path).cmap[0x2665] == "heart"
