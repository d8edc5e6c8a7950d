"""Fonts made to do harm: each costs one glyph, within bounded time, and nothing outside the output folder."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fontTools.cffLib import SubrsIndex
from fontTools.fontBuilder import FontBuilder
from fontTools.misc.psCharStrings import T2CharString
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont

from glyphspline.errors import GlyphsplineError
from glyphspline.fitting.options import Options
from glyphspline.plugins.checks.job import Asked, check_fonts
from glyphspline.plugins.text.job import TextJob, draw, drawings
from glyphspline.plugins.text.lay_out import layout
from glyphspline.plugins.viewer.atlas import make_atlas
from glyphspline.readers import open_font
from glyphspline.runs.convert import convert_font
from glyphspline.runs.folder import entries_of
from glyphspline.runs.schedule import workers
from glyphspline.runs.spec import Limits, RunSpec, kinds_for
from glyphspline.writers.settings import Settings
from tests.places import ROOT

NASTY = ["../../etc/passwd", "CON", "<&\"'>]]>", "x" * 250, "a\nb\x1b[31m", "-rf", "A", "a", "..", "%s%n", "\udc80"]


def built(glyphs: dict[str, object], *, cff: bool = False) -> FontBuilder:
    builder = FontBuilder(1000, isTTF=not cff)
    builder.setupGlyphOrder(list(glyphs))
    builder.setupCharacterMap({ord("a") + k: name for k, name in enumerate(glyphs) if len(glyphs) < 26})
    if cff:
        builder.setupCFF("Hostile", {}, glyphs, {})
    else:
        builder.setupGlyf(glyphs)
    builder.setupHorizontalMetrics(dict.fromkeys(glyphs, (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Hostile <&>", "styleName": "Regular"})
    builder.setupPost(keepGlyphNames=not cff)
    return builder


def square(size: float = 500.0) -> object:
    pen = TTGlyphPen(None)
    pen.moveTo((0, 0))
    for point in ((0, size), (size, size), (size, 0)):
        pen.lineTo(point)
    pen.closePath()
    return pen.glyph()


@pytest.mark.parametrize("formats", [("svg",), ("svg", "curvature")])
def test_nasty_names_stay_in_the_folder_and_in_their_attributes(formats: tuple[str, ...], tmp_path: Path) -> None:
    names = [".notdef", *(name.encode(errors="replace").decode("latin-1") for name in NASTY)]
    builder = built({name: square() for name in names})
    builder.save(tmp_path / "names.ttf")
    font = open_font(tmp_path / "names.ttf")
    out = tmp_path / "deep" / "down" / "out"
    summary = convert_font(font, font.glyph_names, out, RunSpec(Options(step=100.0), formats), jobs=0)
    assert summary.statuses == {"ok": len(names)}
    assert {path.name for path in tmp_path.iterdir()} == {"names.ttf", "deep"}
    entries = list(entries_of(out))
    drawings = [out / path for entry in entries for path in entry["files"].values()]
    assert len({str(path).lower() for path in drawings}) == len(drawings)
    for drawing in drawings:
        assert drawing.resolve().is_relative_to(out.resolve())
        ElementTree.parse(drawing)


def test_a_contour_of_a_million_points_and_other_giants_fail_alone(tmp_path: Path) -> None:
    pen = T2CharStringPen(600, None)
    pen.moveTo((0, 0))
    for k in range(250_000):
        pen.lineTo((k % 700, (k * k) % 900))
    pen.closePath()
    plain = T2CharStringPen(600, None)
    plain.moveTo((0, 0))
    plain.curveTo((0, 300), (300, 300), (300, 0))
    plain.closePath()
    glyphs = {".notdef": plain.getCharString(), "giant": pen.getCharString(), "plain": plain.getCharString()}
    built(glyphs, cff=True).save(tmp_path / "giant.otf")
    font = open_font(tmp_path / "giant.otf")
    started = time.monotonic()
    for options in (Options(step=20.0), Options(tolerance=5.0)):
        summary = convert_font(font, font.glyph_names, tmp_path / f"{options.step}", RunSpec(options, ("svg",)), jobs=0)
        assert summary.statuses == {"ok": 2, "failed": 1}
        assert "segments" in summary.failures[0][1]
    assert time.monotonic() - started < 60


def test_a_step_far_too_small_fails_before_memory_is_asked_for(tmp_path: Path) -> None:
    font = open_font(ROOT / "fonts_test" / "kouzan-gyosho.otf")
    summary = convert_font(font, ["O"], tmp_path / "out", RunSpec(Options(step=1e-9), ("svg",)), jobs=0)
    assert summary.failures[0][1].endswith("vertices, more than the 200000 allowed")


def bomb(depth: int) -> tuple[list[T2CharString], T2CharString]:
    """Subroutines each calling the next a hundred times, and a glyph calling the first: nothing is ever drawn."""
    bias = 107
    subroutines = [T2CharString(program=[k + 1 - bias, "callsubr"] * 100 + ["return"]) for k in range(depth)]
    subroutines.append(T2CharString(program=["return"]))
    return subroutines, T2CharString(program=[600, -bias, "callsubr", "endchar"])


def endless_font(path: Path) -> None:
    """A font of three glyphs, one of which is never read to its end."""
    plain = T2CharStringPen(600, None)
    plain.moveTo((0, 0))
    plain.curveTo((0, 300), (300, 300), (300, 0))
    plain.closePath()
    subroutines, endless = bomb(8)
    glyphs = {".notdef": plain.getCharString(), "endless": endless, "plain": plain.getCharString()}
    builder = built(glyphs, cff=True)
    private = builder.font["CFF "].cff.topDictIndex[0].Private
    private.Subrs = SubrsIndex()
    for subroutine in subroutines:
        private.Subrs.append(subroutine)
    builder.font.recalcBBoxes = False  # it would draw the glyph
    builder.save(path)


def test_a_glyph_that_never_ends_is_killed_and_the_others_are_there(tmp_path: Path) -> None:
    endless_font(tmp_path / "endless.otf")
    font = open_font(tmp_path / "endless.otf")
    spec = RunSpec(Options(step=50.0), limits=Limits(seconds=10.0))
    summary = convert_font(font, font.glyph_names, tmp_path / "out", spec, jobs=2)
    assert summary.statuses == {"ok": 2, "failed": 1}
    assert summary.failures == [("endless", "took longer than 10 s")]


def test_a_text_is_drawn_without_the_glyph_that_never_ends(tmp_path: Path) -> None:
    endless_font(tmp_path / "endless.otf")
    text = layout(open_font(tmp_path / "endless.otf"), "bcc")
    with workers(1, 5.0, expected=1) as pool:
        drawn = draw(TextJob(text, Options(step=50.0), ("svg",), Settings()), pool)
    (note,) = drawn.notes
    assert "left out: " in note
    assert note.endswith("glyph 'endless': took longer than 5 s")
    assert drawn.contents[0].count(b"M") == 2


def test_check_and_atlas_go_on_without_the_glyph_that_never_ends(tmp_path: Path) -> None:
    endless_font(tmp_path / "endless.otf")
    with workers(1, 5.0, ["checks", *kinds_for(Options())], expected=1) as pool:
        (face,) = check_fonts([tmp_path / "endless.otf"], Asked(), executor=pool, alone=True)
        assert (face.glyphs, face.failed) == (2, [("endless", "took longer than 5 s")])
        font = open_font(tmp_path / "endless.otf")
        found = make_atlas(font, font.glyph_names, tmp_path / "atlas.pdf", Options(), executor=pool)
    assert found == (3, ["endless: took longer than 5 s"], [])


def test_a_text_that_needs_too_many_vertices_is_refused(tmp_path: Path) -> None:
    text = layout(open_font(ROOT / "fonts_test" / "kouzan-gyosho.ttf"), "O")
    with pytest.raises(GlyphsplineError, match="vertices, more than the 200000 allowed"):
        drawings(TextJob(text, Options(step=1e-6), ("svg",), Settings()))


ENDS = ("", "-wal", "-shm", "-journal")


def test_links_in_the_output_folder_lead_nowhere(tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    victim.write_text("precious")
    out = tmp_path / "out"
    (out / "svg").mkdir(parents=True)
    for name in ("run.json", "index.html", "svg/O.svg", "manifest.jsonl", *(f".record.sqlite{end}" for end in ENDS)):
        (out / name).symlink_to(victim)
    call = [
        sys.executable,
        "-m",
        "glyphspline",
        "convert",
        "fonts_test/kouzan-gyosho.otf",
        "--text",
        "O",
        "--step",
        "90",
    ]
    done = subprocess.run(
        [*call, "--out", str(out), "--jobs", "0", "--format", "svg", "--restart"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert victim.read_text() == "precious"
    assert "Traceback" not in done.stderr
    assert not os.path.islink(out / "svg" / "O.svg")


def test_tables_that_ask_for_too_much_are_opened_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A count of subroutines that the CFF2 table does not hold: fontTools makes a list of so many offsets."""
    data = bytearray((ROOT / "fonts_test" / "variable-cff2.otf").read_bytes())
    cff2 = TTFont(BytesIO(data)).reader.tables["CFF2"].offset
    subroutines = cff2 + data[cff2 + 2] + int.from_bytes(data[cff2 + 3 : cff2 + 5], "big")
    data[subroutines : subroutines + 5] = (100_000).to_bytes(4, "big") + b"\4"
    (tmp_path / "many.otf").write_bytes(data)
    opened: list[TTFont] = []
    glyph_set = TTFont.getGlyphSet

    def counted(self: TTFont, **given: object) -> object:
        opened.append(self)
        return glyph_set(self, **given)

    monkeypatch.setattr(TTFont, "getGlyphSet", counted)
    font = open_font(tmp_path / "many.otf")
    errors = font.outlines(font.glyph_names, errors="return")
    assert len(errors) == 5
    assert all("cannot be drawn" in str(error) for error in errors)
    assert len(opened) == 1
