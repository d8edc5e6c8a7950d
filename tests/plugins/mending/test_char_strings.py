"""Char strings edited and written: what stays is there to the last bit, contours end where they begin, and what glyphs
have in common is stored once. They are read by fontTools, whose numbers are the format's."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.cffLib import SubrsIndex
from fontTools.fontBuilder import FontBuilder
from fontTools.misc.psCharStrings import T2CharString
from fontTools.pens.recordingPen import RecordingPen
from fontTools.ttLib import TTFont

import glyphspline as gs
from glyphspline.outlines.masters import MasterContour, Masters
from glyphspline.plugins.fonts.back.fonts import write_points
from glyphspline.plugins.fonts.tables.font_glyphs import FINE, char_string, on_grid
from glyphspline.plugins.masters.variable_font import to_variable_font
from glyphspline.types import FloatArray, IntArray
from tests.places import FONTS
from tests.plugins.mending.test_back_fonts import mend
from tests.variable_drawings import refitted


def blob(rng: np.random.Generator, kink: float) -> IntArray:
    """(12, 2) four cubics that meet smoothly, but at one joint with a kink in degrees; in 1/65536, from 0 on."""
    turned = np.arange(4) * np.pi / 2 + rng.uniform(-0.3, 0.3, 4)
    radial = np.stack([np.cos(turned), np.sin(turned)], axis=1)
    at, ways = rng.uniform(80, 120, (4, 1)) * radial, radial[:, ::-1] * (-1, 1)
    leaving, arriving = rng.uniform(40, 60, (2, 4, 1)) * ways
    turn = np.radians(kink)
    leaving[2] = leaving[2] @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    points = np.stack([at, at + leaving, np.roll(at - arriving, -1, axis=0)], axis=1).reshape(-1, 2)
    return np.rint((points - points[0]) * FINE).astype(np.int64)


def tokens(steps: IntArray) -> list[float]:
    """Steps in 1/65536 as numbers of a char string."""
    return [value // FINE if value % FINE == 0 else value / FINE for value in steps.ravel().tolist()]


def decimals(path: Path, seed: int) -> Path:
    """A CFF font of decimals: A, B and C draw the same two contours at other places, and so do D, E and F.

    The contours are subroutines. The second one of D has a kink.
    """
    rng, names = np.random.default_rng(seed), [".notdef", *"ABCDEF"]
    builder = FontBuilder(1000, isTTF=False)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({ord(name): name for name in names[1:]})
    builder.setupCFF("Decimals", {}, {name: T2CharString(program=["endchar"]) for name in names}, {})
    builder.setupHorizontalMetrics(dict.fromkeys(names, (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Decimals", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    top = builder.font["CFF "].cff.topDictIndex[0]
    top.Private.Subrs = SubrsIndex()
    for kink in (0.0, 0.0, 0.0, 5.0):
        moves = tokens(np.diff(blob(rng, kink), axis=0, append=0))
        curves = [token for k in range(0, 24, 6) for token in (*moves[k : k + 6], "rrcurveto")]
        top.Private.Subrs.append(T2CharString(program=[*curves, "return"]))
    for k, name in enumerate(names[1:]):
        starts = np.diff(rng.integers(100 * FINE, 300 * FINE, (2, 2)), axis=0, prepend=0)
        program = list[Any]()
        for n, start in enumerate(starts):
            program += [*tokens(start), "rmoveto", k // 3 * 2 + n - 107, "callsubr"]
        top.CharStrings[name].setProgram([*program, "endchar"])
    builder.save(path)
    return path


def cff_of(font: Path | bytes) -> Any:
    """The part of a CFF font with its char strings."""
    tables = TTFont(BytesIO(font) if isinstance(font, bytes) else font)
    return tables["CFF2" if "CFF2" in tables else "CFF "].cff.topDictIndex[0]


def drawn(string: Any, blender: Any = None) -> list[FloatArray]:
    """The points of each contour, with the last one if it is that at which the contour begins."""
    pen, contours = RecordingPen(), list[list[Any]]()
    string.draw(pen, blender)
    for name, points in pen.value:
        if name == "moveTo":
            contours.append([])
        contours[-1] += points
    return [np.array(points) for points in contours]


def size(path: Path) -> int:
    """Bytes of the table of char strings."""
    length: int = TTFont(path).reader.tables["CFF "].length
    return length


def moved(glyph: Masters, contour: int, first: int, ways: FloatArray) -> Masters:
    """The glyph with some points, one behind the other, moved in all masters."""
    contours = list(glyph.contours)
    points = contours[contour].points.copy()
    points[:, first : first + len(ways)] += ways
    contours[contour] = MasterContour(points, contours[contour].degrees)
    return replace(glyph, contours=contours)


@pytest.mark.parametrize("seed", range(4))
def test_points_that_stay_in_a_font_of_decimals_are_there_to_the_last_bit(seed: int, tmp_path: Path) -> None:
    path = decimals(tmp_path / "a.otf", seed)
    font, first, ways = gs.open_font(path), 1 + 2 * seed, np.random.default_rng(seed).uniform(-1, 1, (3, 2))
    pairs = [(font.masters(name), moved(font.masters(name), 1, first, ways)) for name in "DEF"]
    write_points(font, pairs, copy=tmp_path / "new.otf")
    old, new = cff_of(path), cff_of(tmp_path / "new.otf")
    for name in (".notdef", *"ABC"):
        assert new.CharStrings[name].bytecode == old.CharStrings[name].bytecode
    for before, after in zip(old.Private.Subrs, new.Private.Subrs, strict=False):
        assert after.bytecode == before.bytecode
    for name in "DEF":
        for c, (a, b) in enumerate(zip(*(drawn(each.CharStrings[name]) for each in (old, new)), strict=True)):
            assert (b[-1] == b[0]).all()
            wanted = a.copy()
            wanted[first : first + 3] += ways if c else 0.0
            assert ((a != b).any(axis=1) == (a != wanted).any(axis=1)).all()
            assert np.abs(b - wanted).max() <= 0.5001 / FINE


def test_edited_glyphs_call_the_subroutines_of_what_stays_and_share_what_changed(tmp_path: Path) -> None:
    path, new = decimals(tmp_path / "a.otf", 0), tmp_path / "new.otf"
    font = gs.open_font(path)
    write_points(
        font,
        [(font.masters(name), moved(font.masters(name), 1, 4, np.array([[1.0, 0.0]]))) for name in "DEF"],
        copy=new,
    )
    old, now = (cff_of(each).Private.Subrs for each in (path, new))
    assert len(now) == len(old) + 1
    for name in "DEF":
        string = cff_of(new).CharStrings[name]
        string.decompile()
        assert [token for token in string.program if isinstance(token, str)] == ["rmoveto", "callsubr"] * 2 + [
            "endchar"
        ]
        assert string.program[3] == 2 - 107
    assert size(new) - size(path) < len(now[4].bytecode) + 8


def test_a_font_of_decimals_is_mended_without_a_new_finding(tmp_path: Path) -> None:
    path = decimals(tmp_path / "a.otf", 0)
    facts = mend(path, tmp_path / "out")
    assert (facts["changed"], facts["after"]) == ([*"DEF"], 0)
    old, new = gs.open_font(path), gs.open_font(tmp_path / "out" / "a.otf")
    for name in old.glyph_names:
        one, other = ({(each.kind, each.contour) for each in gs.check(f.outline(name), outer=1)} for f in (old, new))
        assert other <= one
        for points in drawn(cff_of(new.path).CharStrings[name]):
            assert (points[-1] == points[0]).all()


@pytest.mark.parametrize("seed", range(4))
def test_a_new_char_string_of_decimals_is_that_of_its_rounded_points(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shapes = [blob(rng, 0.0) / FINE + rng.uniform(-500, 500, 2) for _ in range(20)]
    string = char_string([gs.Contour(shape, np.full(4, 3)) for shape in shapes], 600, FINE, "a")
    string.compile()
    string.private = cff_of(FONTS / "kouzan-gyosho.otf").Private
    for shape, points in zip(shapes, drawn(string), strict=True):
        assert (points == on_grid(shape, FINE)[[*range(12), 0]]).all()


def test_every_master_of_a_variable_font_ends_its_contours_where_they_begin(tmp_path: Path) -> None:
    font = gs.open_font(FONTS / "variable-cff2.otf")
    data, _ = to_variable_font(font, {name: refitted(font.masters(name)) for name in ("o", "n")}, "otf")
    edited = tmp_path / "edited.otf"
    glyph = font.masters("o")
    write_points(font, [(glyph, moved(glyph, 0, 1, np.array([[1 / 3, 0.0]])))], copy=edited)
    for made in (data, edited):
        cff = cff_of(made)
        for name in ("o", "n"):
            default = drawn(cff.CharStrings[name], lambda index, deltas: 0)
            for region in range(2):
                varied = drawn(cff.CharStrings[name], lambda index, deltas, k=region: deltas[k % len(deltas)])
                for a, b in zip(default, varied, strict=True):
                    curved = np.abs(a[-1] - a[0]).max() < 0.01
                    assert not curved or ((a[-1] == a[0]).all() and (b[-1] == b[0]).all())
    old, new = cff_of(FONTS / "variable-cff2.otf"), cff_of(edited)
    assert new.CharStrings["n"].bytecode == old.CharStrings["n"].bytecode
    one, other = (drawn(each.CharStrings["o"], lambda index, deltas: 0) for each in (old, new))
    assert [int((a != b).any(axis=1).sum()) for a, b in zip(one, other, strict=True)] == [1, *[0] * (len(one) - 1)]
