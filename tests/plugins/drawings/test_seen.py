"""Drawings of every kind: as much ink as Chromium shows, what is not read said, and points that nothing touched."""

from __future__ import annotations

import gzip
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from glyphspline.cli.app import app
from glyphspline.errors import FontError
from glyphspline.outlines.outline import Outline
from glyphspline.plugins.drawings.svg import SvgDrawings, read_drawing
from glyphspline.readers import open_source

from .seen import HEAD, INK, SEEN, SQUARE

LINES = 400


def read(folder: Path, document: str | bytes, name: str = "a.svg", strokes: bool = False) -> Outline:
    (folder / name).write_bytes(document if isinstance(document, bytes) else document.encode())
    return read_drawing(folder / name, strokes)


def ink(outline: Outline) -> float:
    """The share of a view of 100 units that contours fill by the nonzero rule, by scan lines."""
    starts, stops = [np.empty((0, 2))], [np.empty((0, 2))]
    for contour in outline.contours:
        points = contour.at(np.linspace(0, len(contour), 64 * len(contour), endpoint=False))
        starts.append(points)
        stops.append(np.roll(points, -1, axis=0))
    (ax, ay), (bx, by) = np.concatenate(starts).T, np.concatenate(stops).T
    total = 0.0
    for y in -(np.arange(LINES) + 0.5) / LINES * 100:
        (crossed,) = np.nonzero((ay <= y) != (by <= y))
        x = ax[crossed] + (y - ay[crossed]) / (by - ay)[crossed] * (bx - ax)[crossed]
        order = np.argsort(x)
        winding = np.cumsum(np.sign(by - ay)[crossed][order])
        total += float(np.diff(np.clip(x[order], 0, 100))[winding[:-1] != 0].sum())
    return total / LINES / 100


@pytest.mark.parametrize("name", SEEN)
def test_a_drawing_is_drawn_as_seen_or_says_what_is_not_read(name: str, tmp_path: Path) -> None:
    outline = read(tmp_path, SEEN[name].document)
    if SEEN[name].named:
        assert any(SEEN[name].named in part for part in outline.unread), outline.unread
    else:
        assert outline.unread == ()
    if name in INK and not SEEN[name].named:
        assert ink(outline) == pytest.approx(INK[name], abs=0.006)


@pytest.mark.parametrize(
    "text",
    [
        '<path d="M10.12345678901234 20.1C30.3 .1 50.123456789 7 80 9.87654321Q5 60 7 80Z"/>',
        '<path fill-rule="evenodd" d="M10.123456789 10H90.1V90.3H10.4ZM30.123456789 30H70V70.7H30Z"/>',
        '<path d="M10.123456789 10V60H60V10Z"/><path d="M40.1 40H90.123456789V90H40Z"/>',
        '<clipPath id="c"><rect width="100" height="100"/></clipPath><path clip-path="url(#c)" d="M10.123456789 10V60H60Z"/>',  # noqa: E501
        '<rect width="5" height="5" fill="white"/><path d="M10.123456789 10V60H60Z"/>',
        '<svg width="90" height="90"><path d="M10.123456789 10V60H60Z"/></svg>',
    ],
)
def test_points_that_nothing_cuts_are_those_of_the_file(text: str, tmp_path: Path) -> None:
    outline = read(tmp_path, f'<svg {HEAD} viewBox="0 0 100 100">{text}</svg>')
    points = np.abs(np.concatenate([each.points for each in outline.contours]))
    written = {float(number) for number in re.findall(r"[0-9]+\.[0-9]{9,}", text)}
    assert written <= set(points.ravel().tolist())


@pytest.mark.parametrize(
    "encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-8-sig", "latin-1", "cp1252", "shift_jis"]
)
def test_encodings_and_compression(encoding: str, tmp_path: Path) -> None:
    said = {"utf-16-le": "utf-16", "utf-16-be": "utf-16", "utf-8-sig": "utf-8"}.get(encoding, encoding)
    letter = "カ" if encoding == "shift_jis" else "é"
    text = f'<svg {HEAD} viewBox="0 0 9 9"><g id="{letter}"/><path d="M0 0H9V9Z"/></svg>'
    data = f'<?xml version="1.0" encoding="{said}"?>{text}'.encode(encoding)
    for name, content in (("a.svg", data), ("b.svgz", gzip.compress(data))):
        assert read(tmp_path, content, name).contours[0].points.tolist() == [[0, 0], [9, 0], [9, -9]]
        assert open_source(tmp_path / name).glyph_names == (name[0],)
    assert open_source(tmp_path).glyph_names == ("a", "b")


def clones(deep: int, each: int) -> str:
    """Clones in clones."""
    groups = [f'<g id="a{k}">' + f'<use href="#a{k + 1}"/>' * each + "</g>" for k in range(deep)]
    return f'<svg {HEAD}>{"".join(groups)}<g id="a{deep}"/></svg>'


@pytest.mark.parametrize(
    ("document", "message"),
    [
        (clones(20, 1), "16 deep"),
        (clones(9, 9), "10,000 elements"),
        (f"<!DOCTYPE svg [<!ENTITY a '{'x' * 4000}'>]><svg {HEAD}><path d='{'&a;' * 20000}'/></svg>", "64 MiB"),
        (f'<!DOCTYPE svg [<!ENTITY % p SYSTEM "x">]><svg {HEAD}/>', "entities"),
        (gzip.compress(b" " * (1 << 27)), "64 MiB"),
        (b"\x1f\x8b broken", "compressed data"),
        (f"<svg {HEAD}>\n<g></svg>", "mismatched tag, line 2"),
    ],
)
def test_what_cannot_be_bounded_or_read_is_refused(document: str | bytes, message: str, tmp_path: Path) -> None:
    with pytest.raises(FontError, match=message) as caught:
        read(tmp_path, document)
    assert "Error" not in caught.value.message


def test_what_is_not_read_is_named_by_its_lines(tmp_path: Path) -> None:
    body = "\n".join(['<path stroke="red" d="M0 0H9V9Z"/>'] * 5 + ["<text>A</text>"])
    outline = read(tmp_path, f"<svg {HEAD} viewBox='0 0 9 9'>\n{body}</svg>")
    assert outline.unread == ("strokes, which --strokes draws (lines 2, 3, 4 and 2 more)", "text (line 7)")


@pytest.mark.parametrize(
    ("attributes", "share"),
    [
        ('fill="none" stroke="black" stroke-width="10" d="M20 50H80"', 0.06),
        ('fill="none" stroke="black" stroke-width="10" stroke-linecap="square" d="M20 50H80"', 0.07),
        ('fill="none" stroke="black" stroke-width="10" stroke-linecap="round" d="M20 50H80"', 0.06 + np.pi * 25e-4),
        ('fill="none" stroke="black" stroke-width="10" d="M20 20H80V80H20Z"', 0.49 - 0.25),
        ('fill="none" stroke="black" stroke-width="10" stroke-linejoin="bevel" d="M20 20H80V80H20Z"', 0.24 - 4 * 12.5e-4),  # noqa: E501
        ('stroke="black" stroke-width="10" d="M20 20H80V80H20Z"', 0.49),
        ('fill="none" stroke="black" stroke-width="10" stroke-dasharray="10 5" d="M20 50H80"', 0.04),
        ('fill="none" stroke="black" stroke-width="5" transform="scale(2 1)" d="M10 50H40M25 20V80"', 0.06 * 0.5 + 0.06 - 0.005),  # noqa: E501
    ],
)  # fmt: skip
def test_strokes_are_outlines_where_they_are_asked_for(attributes: str, share: float, tmp_path: Path) -> None:
    outline = read(tmp_path, f'<svg {HEAD} viewBox="0 0 100 100"><path {attributes}/></svg>', strokes=True)
    assert outline.unread == ()
    assert ink(outline) == pytest.approx(share, abs=0.002)
    source = SvgDrawings.opened(tmp_path / "a.svg", "Strokes")
    assert ink(source.outline("a")) == pytest.approx(share, abs=0.002)
    assert dict(source.location) == {"strokes": 1.0}


def test_a_run_names_what_is_not_read_and_ends_with_1(tmp_path: Path) -> None:
    for name in ("even-odd attribute", "text", "stroke", "svg font"):
        (tmp_path / f"{name.replace(' ', '')}.svg").write_text(SEEN[name].document)
    words = ["--all", "--format", "svg", "--jobs", "0", "--out"]
    done = CliRunner().invoke(app, ["convert", str(tmp_path), *words, str(tmp_path / "out")])
    assert done.exit_code == 1
    for part in ("not read of text: text (line 1)", "not read of svgfont: an SVG font", "not read of stroke: strokes"):
        assert part in done.output
    done = CliRunner().invoke(app, ["convert", str(tmp_path / "even-oddattribute.svg"), *words, str(tmp_path / "a")])
    assert done.exit_code == 0
    assert "not read" not in done.output


def test_a_plain_drawing_needs_no_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("cssselect2", "tinycss2", "pathops"):
        monkeypatch.setitem(sys.modules, module, None)
    plain = f'<g style="fill:#123"><path fill-rule="evenodd" d="{SQUARE}M40 40H60V60H40Z"/><circle r="9"/></g>'
    assert len(read(tmp_path, f"<svg {HEAD} viewBox='0 0 100 100'>{plain}</svg>").contours) == 3
    with pytest.raises(
        FontError, match=r"style sheets, clips or strokes needs cssselect2: pip install 'glyphspline\[drawings\]'"
    ):
        read(tmp_path, f"<svg {HEAD} viewBox='0 0 100 100'><style>.a{{fill:none}}</style>{plain}</svg>")
