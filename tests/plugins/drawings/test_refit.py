"""Drawings whose paths are rewritten: fewer segments, the same shapes, and every other byte as it was."""

from __future__ import annotations

import gzip
import json
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial import cKDTree
from svgpathtools import parse_path
from typer.testing import CliRunner, Result

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.plugins.drawings.rewrite import decimals, rewritten
from glyphspline.types import FloatArray
from tests.places import FONTS

G2 = gs.Options(continuity="g2")


def cut(contour: gs.Contour, parts: int) -> list[FloatArray]:
    """The cubics of a contour, each cut into parts of equal parameters."""
    found = []
    for cubic in contour.cubics():
        power = np.array([[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) @ cubic
        for a, b in zip(np.arange(parts) / parts, np.arange(1, parts + 1) / parts, strict=True):
            ends = [power.T @ [1, t, t * t, t**3] for t in (a, b)]
            ways = [power.T @ [0, 1, 2 * t, 3 * t * t] * ((b - a) / 3) for t in (a, b)]
            found.append(np.array([ends[0], ends[0] + ways[0], ends[1] - ways[1], ends[1]]))
    return found


def letter(name: str = "O", scale: float = 1.0, parts: int = 3, digits: int = 3) -> str:
    """A glyph as path data that has too many segments, y down."""
    texts = []
    for contour in gs.open_font(FONTS / "kouzan-gyosho.otf").outline(name).contours:
        cubics = [np.round(each * [scale, -scale], digits) for each in cut(contour, parts)]
        curves = ["C" + " ".join(f"{x:.{digits}f}" for x in each[1:].ravel()) for each in cubics]
        texts.append(f"M{cubics[0][0, 0]:.{digits}f} {cubics[0][0, 1]:.{digits}f}{''.join(curves)}Z")
    return "".join(texts)


def drawing(body: str, em: float = 1024.0, attributes: str = "") -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 {-em:g} {em:g} {em:g}"{attributes}>{body}</svg>'


def data_of(text: str | bytes) -> list[str]:
    """The path data of a drawing, in its order."""
    return [each.get("d", "") for each in ElementTree.fromstring(text).iter() if each.tag.endswith("path")]


def segments_in(data: str) -> int:
    return sum(len(parse_path(part)) for part in re.findall("M[^M]*", data))


def apart(old: str, new: str) -> float:
    """The two-sided distance of path data, by points on both."""
    clouds = []
    for data in (old, new):
        parts = [segment for part in re.findall("M[^M]*", data) for segment in parse_path(part)]
        curves = [np.polyval(each.poly(), np.linspace(0, 1, 2000)) for each in parts if each.start != each.end]
        clouds.append(np.array([[p.real, p.imag] for p in np.concatenate(curves)]))
    a, b = clouds
    return float(max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max()))


@pytest.mark.parametrize("em", [1024.0, 24.0])
def test_a_path_gets_fewer_segments_within_the_tolerance(em: float) -> None:
    old = letter(scale=em / 1024)
    found = rewritten(drawing(f'<path d="{old}"/>', em).encode(), G2)
    (new,) = data_of(found.data)
    assert found.segments == (segments_in(old), segments_in(new))
    assert segments_in(new) < segments_in(old) / 2
    assert 0 < apart(old, new) <= em / 1000 * 1.02  # between the points
    assert max(len(number.partition(".")[2]) for number in re.findall(r"\d*\.?\d+", new)) == decimals(em / 1000)


def test_all_but_path_data_stays_byte_for_byte() -> None:
    old = letter()
    text = (
        '<?xml version="1.0" encoding="UTF-8" standalone="no"?>\r\n<!-- <path d="M0 0"/> -->\n'
        '<svg:svg xmlns:svg="http://www.w3.org/2000/svg" xmlns:own="urn:own" viewBox="0 -1024 1024 1024">\n'
        '<svg:style><![CDATA[ path > a { d: none } ]]></svg:style>\t<svg:title>d="1" 龍 &amp; &#38;</svg:title>'
        f"<svg:path\n  id = 'a>b'   own:d=\"M1 1\" d\t=\n'{old}' fill='#123'  /><svg:circle r=\"5\" cx='9'/>"
        f'<svg:g transform="scale(2)"><svg:path data-d="x" d="{old}"></svg:path></svg:g></svg:svg>\n\n'
    ).encode()
    found = rewritten(text, G2)
    new = data_of(found.data)
    assert (found.paths, found.changed) == (2, 2)
    want = text
    for each in new:
        want = want.replace(old.encode(), each.encode(), 1)
    assert found.data == want
    assert apart(old, new[1]) < 0.6  # what is drawn twice as large is fitted twice as close


@pytest.mark.parametrize(
    "path",
    [
        '<path d="M0 0c0 50 50 100 100 100S200 50 200 0Z"/>',  # nothing to gain
        '<path d="{open}"/>',
        '<path d="{}" marker-mid="url(#m)"/>',
        '<path d="{}" style="fill: red; stroke-dasharray: 1 2"/>',
        '<path d="{}"><animate attributeName="d" values="a;b"/></path>',
        '<path d="{}M0 0Z"/>',  # a contour that encloses nothing
        '<path d="{}" transform="scale(0)"/>',
        '<clipPath><path d="{}"/></clipPath>',
        '<defs><path d="{}"/></defs>',
        '<symbol><path d="{}"/></symbol>',
        '<rect width="10" height="10"/><polygon points="0 0 1 0 1 1"/>',
        "<path/>",
    ],
)
def test_what_is_not_served_by_a_fit_stays(path: str) -> None:
    text = drawing(path.replace("{}", letter()).replace("{open}", letter().replace("Z", ""))).encode()
    found = rewritten(text, G2)
    assert (found.data, found.changed, found.unread) == (text, 0, ())


def test_a_path_that_no_fit_serves_is_the_same_curve_in_fewer_characters() -> None:
    old = "M 0,0 C 0,50 50,100 100,100 C 150,100 200,50 200,0 Z"
    found = rewritten(drawing(f'<path d="{old}"/>').encode(), G2)
    assert data_of(found.data) == ["M0 0c0 50 50 100 100 100S200 50 200 0Z"]
    assert (found.changed, found.segments) == (1, (3, 3))
    assert apart(old, data_of(found.data)[0]) == 0


def test_symbols_have_an_em_of_their_own() -> None:
    old = letter(scale=24 / 1024)
    found = rewritten(drawing(f'<symbol viewBox="0 -24 24 24"><path d="{old}"/></symbol>').encode(), G2)
    assert found.changed == 1
    assert apart(old, data_of(found.data)[0]) <= 0.025


def refit(*words: object) -> Result:
    return CliRunner().invoke(app, ["refit", *map(str, words), "--jobs", "0"])


def test_the_command_rewrites_a_folder_and_names_what_it_cannot_read(tmp_path: Path) -> None:
    (icons := tmp_path / "icons").mkdir()
    good, part = drawing(f'<path d="{letter()}"/>'), drawing(f'<path d="M0 0 L x"/><path d="{letter("g")}"/>')
    texts = {"good.svg": good, "part.svg": part, "bad.svg": "<svg", "plain.svg": drawing('<circle r="1"/>')}
    for name, text in texts.items():
        (icons / name).write_text(text)
    done = refit(icons, "--out", tmp_path / "out", "--json", "--quiet")
    assert done.exit_code == 1, done.output
    facts = {Path(one["drawing"]).name: one for one in json.loads(done.stdout)["drawings"]}
    assert {name: (one["error"] is None, one.get("rewritten")) for name, one in facts.items()} == {
        "bad.svg": (False, None), "good.svg": (True, 1), "part.svg": (True, 1), "plain.svg": (True, 0),
    }  # fmt: skip
    assert len(facts["part.svg"]["unread"]) == 1
    made = {path.name: path.read_text() for path in (tmp_path / "out").iterdir()}
    assert made.keys() == texts.keys() - {"bad.svg"}
    assert made["plain.svg"] == texts["plain.svg"]
    assert {name: (icons / name).read_text() for name in texts} == texts
    assert refit(icons / "good.svg", icons / "plain.svg", "--in-place").exit_code == 0
    assert (icons / "good.svg").read_text() == made["good.svg"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["{bad}", "--in-place"], "not well-formed"),
        (["{good}"], "say where"),
        (["{good}", "--in-place", "--continuity", "c2"], "--continuity g2"),
        (["{good}", "--layer", "new"], "without layers"),
        (["{good}", "--out", "{folder}"], "--in-place"),
        (["{good}", str(FONTS / "kouzan-gyosho.otf"), "--out", "{folder}"], "several kinds"),
    ],
)
def test_calls_that_are_of_no_use_end_with_2(words: list[str], said: str, tmp_path: Path) -> None:
    good, bad = tmp_path / "good.svg", tmp_path / "bad.svg"
    good.write_text(drawing('<circle r="1"/>'))
    bad.write_text("<svg")
    done = refit(*(word.format(good=good, bad=bad, folder=tmp_path) for word in words))
    assert done.exit_code == 2
    assert said in done.output + (done.stderr if done.stderr_bytes else "")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.svg", "good.svg"]


def test_utf_16_is_refused_or_read_as_it_is() -> None:
    with pytest.raises(gs.GlyphsplineError, match="encoding"):
        rewritten(drawing('<path d="M0 0"/>').encode("utf-16"), G2)


def test_a_compressed_drawing_stays_compressed() -> None:
    text = drawing(f'<path d="{letter()}"/>').encode()
    found = rewritten(gzip.compress(text), G2)
    assert gzip.decompress(found.data) == rewritten(text, G2).data
    assert found.changed == 1


@pytest.mark.parametrize("style", ["path{display:none}", "path{d:none}"])
def test_styles_say_what_is_drawn(style: str) -> None:
    text = drawing(f'<style>{style}</style><path d="{letter()}"/>').encode()
    found = rewritten(text, G2)
    assert (found.paths, found.data) == (0, text)


def test_a_folder_of_drawings_becomes_a_font(tmp_path: Path) -> None:
    (icons := tmp_path / "icons").mkdir()
    (icons / "A.svg").write_text(drawing(f'<path d="{letter()}"/>'))
    assert refit(icons, "--format", "ttf", "--out", tmp_path / "out").exit_code == 0
    (made,) = (tmp_path / "out").glob("*.ttf")
    font = gs.open_font(made)
    assert font.select(text="A")
    assert len(font.outline(font.select(text="A")[0]).contours) == 2


@pytest.mark.parametrize("asked", [None, 2048])
def test_icons_become_a_font_of_a_proper_em(asked: int | None, tmp_path: Path) -> None:
    """A disc of radius 10 in a box of 24 stays round within a thousandth of the em, on the baseline."""
    folder = tmp_path / "icons"
    folder.mkdir()
    disc = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24"><circle cx="12" cy="12" r="10"/></svg>'
    (folder / "disc.svg").write_text(disc)
    words = ["refit", str(folder), "--format", "ttf", "--out", str(tmp_path / "o"), "--jobs", "1"]
    found = CliRunner().invoke(app, [*words, *(["--units-per-em", str(asked)] if asked else [])])
    assert found.exit_code == 0, found.output
    assert "U+E000 disc" in found.output
    (path,) = (tmp_path / "o").glob("*.ttf")
    font, em = gs.open_font(path), asked or 1000
    assert font.metrics == gs.FontMetrics(em, em, 0)
    contour = font.outline(font.cmap[0xE000]).contours[0]
    places = np.linspace(0, len(contour), 500, endpoint=False)
    radii = np.hypot(*(contour.at(places) - em / 2).T)
    assert np.abs(radii - em * 10 / 24).max() <= em / 1000


@pytest.mark.parametrize("box", ["-2 -2 28 28", "-12 -12 24 24", "3 -24 24 24"])
def test_an_icon_fills_its_advance_wherever_its_view_box_begins(box: str, tmp_path: Path) -> None:
    """Names that tables of fonts have no letters for, as Chinese ones, are replaced there alone."""
    left, top, size, _ = map(float, box.split())
    rectangle = f'<rect x="{left + 1}" y="{top + 3}" width="{size - 2}" height="{size - 3}"/>'
    (tmp_path / "icons").mkdir()
    (tmp_path / "icons" / "心形—.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}">{rectangle}</svg>'
    )
    for suffix in ("ttf", "otf"):
        found = refit(tmp_path / "icons", "--format", suffix, "--out", tmp_path / suffix, "--units-per-em", 1000)
        assert found.exit_code == 0, found.output
        assert "U+E000 心形—" in found.output
        font = gs.open_font(next((tmp_path / suffix).glob(f"*.{suffix}")))
        assert font.cmap == {0xE000: "uniE000"}
        outline = font.outline(font.cmap[0xE000])
        points = outline.contours[0].points * size / 1000
        assert outline.advance == 1000
        assert np.abs(points.min(axis=0) - [1, 0]).max() < size / 1000
        assert np.abs(points.max(axis=0) - [size - 1, size - 3]).max() < size / 1000


def test_an_em_is_for_drawings_that_become_a_font(tmp_path: Path) -> None:
    font = str(FONTS / "kouzan-gyosho.ttf")
    words = ["refit", font, "--format", "ttf", "--text", "O", "--units-per-em", "500", "--out", str(tmp_path / "o")]
    found = CliRunner().invoke(app, words)
    assert found.exit_code == 2
    assert "--units-per-em is for drawings" in found.output
