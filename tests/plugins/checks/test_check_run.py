"""Fonts checked whole, and glyphs of variable fonts along their axes."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.ttLib.tables._g_l_y_f import Glyph, GlyphCoordinates

import glyphspline as gs
from glyphspline.errors import FontError
from glyphspline.outlines.flaws.kinds import Thresholds
from glyphspline.outlines.masters import MasterContour, Masters
from glyphspline.plugins.checks import job as check_run
from glyphspline.plugins.checks.finding import Finding
from glyphspline.plugins.checks.job import Asked, AxesJob, CheckJob, GlyphFindings, check_font, check_fonts
from glyphspline.plugins.masters.kinks import kinks
from glyphspline.runs.schedule import workers
from tests.places import FONTS
from tests.readers.test_bulk import build, simple
from tests.variable_fonts import quadratic, variable_font

KOUZAN = FONTS / "kouzan-gyosho.ttf"

BEFORE = [(0, 0), (150, 0), (500, 300), (-300, 300), (-60, 0)]
BOLD = [(0, 0), (60, 30), (560, 340), (-330, 290), (-200, -100)]
"""A joint at the origin that is smooth in both masters, and kinks between them."""


@pytest.fixture(scope="module")
def variable(tmp_path_factory: pytest.TempPathFactory) -> Path:
    glyph = quadratic(BEFORE, [True, False, True, True, False])
    deltas = [(x - a, y - b) for (x, y), (a, b) in zip(BOLD, BEFORE, strict=True)]
    path = tmp_path_factory.mktemp("fonts") / "v.ttf"
    square = quadratic([(0, 0), (0, 100), (100, 100), (100, 0)], [True] * 4)
    bow = [(0, 0), (200, 0), (-100, 0), (0, 0)]  # its upper corners change places: it crosses itself from 2/3 on
    return variable_font(
        path, {"k": glyph, "s": square}, {"k": [({"wght": (0, 1, 1)}, deltas)], "s": [({"wght": (0, 1, 1)}, bow)]}
    )


@pytest.fixture(scope="module")
def pool() -> Iterator[Executor]:
    with workers(2, 60.0, kinds=["checks"], expected=2) as made:
        yield made


def found(path: Path, **options: Any) -> list[GlyphFindings]:
    font = gs.open_source(path)
    asked = Asked(**{name: options.pop(name) for name in ("thresholds", "steps") if name in options})
    return list(check_font(font, font.glyph_names, asked, **options))


def of(glyphs: Sequence[GlyphFindings], kind: str) -> list[Finding]:
    return [item for glyph in glyphs for item in glyph.findings if item.kind == kind]


def test_glyphs_come_in_order_with_what_check_says_of_each() -> None:
    font = gs.open_source(KOUZAN)
    names = [*font.glyph_names[::-1], font.glyph_names[0]]
    glyphs = list(check_font(font, names, once=False))
    assert [(glyph.glyph, glyph.gid) for glyph in glyphs] == [(name, k) for k, name in enumerate(font.glyph_names)]
    assert [glyph.findings for glyph in glyphs] == [
        gs.check(font.outline(name), outer=font.outer) for name in font.glyph_names
    ]
    assert sum(len(glyph.findings) for glyph in glyphs) > 100
    assert [glyph.error for glyph in glyphs] == [None] * len(glyphs)


def test_a_font_that_was_edited_is_read_again(tmp_path: Path) -> None:
    path = tmp_path / "font.ttf"
    path.write_bytes(KOUZAN.read_bytes())
    assert of(found(path), "kink")
    path.write_bytes((FONTS / "variable.ttf").read_bytes())
    glyphs = found(path, axes=())
    assert [glyph.glyph for glyph in glyphs] == list(gs.open_font(FONTS / "variable.ttf").glyph_names)
    assert not any(glyph.error for glyph in glyphs)


@pytest.mark.parametrize("name", ["kouzan-gyosho.ttf", "kouzan-gyosho.otf", "v.ttf"])
def test_workers_find_what_one_process_finds(name: str, variable: Path, pool: Executor) -> None:
    path = variable if name == "v.ttf" else FONTS / name
    alone = found(path)
    assert sum(len(glyph.findings) for glyph in alone) > 1
    assert found(path, executor=pool) == alone


def test_chunks_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    alone = found(KOUZAN)
    for size in (1, 5):
        monkeypatch.setattr(CheckJob, "chunk", size)
        assert found(KOUZAN) == alone


def test_a_broken_glyph_costs_only_itself(tmp_path: Path) -> None:
    from fontTools.ttLib import TTFont

    tables = TTFont(KOUZAN)
    start, end = tables["loca"].locations[5:7]
    data = bytearray(tables.reader["glyf"])
    data[start + 10 : end] = b"\xff" * (end - start - 10)
    del tables
    path = tmp_path / "broken.ttf"
    path.write_bytes(KOUZAN.read_bytes().replace(TTFont(KOUZAN).reader["glyf"], bytes(data)))
    seen: list[tuple[int, int, int]] = []
    whole, glyphs = found(KOUZAN, once=False), found(path, once=False, observer=lambda *counts: seen.append(counts))
    assert [glyph.gid for glyph in glyphs if glyph.error] == [5]
    assert [glyph for glyph in glyphs if glyph.gid != 5] == [glyph for glyph in whole if glyph.gid != 5]
    assert seen[-1] == (len(glyphs), len(glyphs), 1)


def test_an_unexpected_error_is_of_one_glyph(monkeypatch: pytest.MonkeyPatch) -> None:
    from glyphspline.plugins.checks import check

    font, real = gs.open_source(KOUZAN), check.measured
    most = max(font.outlines(font.glyph_names), key=lambda outline: len(outline.arrays.degrees))

    def fails(glyphs: Any, *others: Any) -> Any:
        if any(len(each.repeats) == len(most.repeats) for each in glyphs):
            raise ZeroDivisionError("of all things")
        return real(glyphs, *others)

    whole = found(KOUZAN, once=False)
    monkeypatch.setattr(check, "measured", fails)
    glyphs = found(KOUZAN, once=False)
    assert [glyph.gid for glyph in glyphs if glyph.error] == [most.gid]
    assert glyphs[most.gid].error == "ZeroDivisionError: of all things"
    assert [glyph for glyph in glyphs if not glyph.error] == [glyph for glyph in whole if glyph.gid != most.gid]


class Slow(CheckJob):
    def together(self, tasks: Any, contents: Any) -> Any:
        if any(gid == 3 for _, gid, _ in tasks):
            time.sleep(60)
        return super().together(tasks, contents)


def test_a_glyph_that_takes_too_long_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = found(KOUZAN)
    monkeypatch.setattr(check_run, "CheckJob", Slow)
    with workers(2, 8.0, kinds=["checks"], expected=2) as pool:
        glyphs = found(KOUZAN, executor=pool)
    assert [glyph.gid for glyph in glyphs if glyph.error] == [3]
    assert glyphs[3].error == "took longer than 8 s"
    assert [glyph for glyph in glyphs if glyph.gid != 3] == [glyph for glyph in whole if glyph.gid != 3]


def test_what_components_have_is_told_of_the_first_glyph_only(tmp_path: Path) -> None:
    spur = [(0, 0), (200, 0), (200, 100), (100, 100), (100, 150), (100, 100), (0, 100)]
    again = [(x + 300, y) for x, y in spur]
    path = variable_font(
        tmp_path / "v.ttf",
        {"a": quadratic(spur, [True] * 7), "b": quadratic(again, [True] * 7)},
        {name: [({"wght": (0, 1, 1)}, [(0, 0)] * 7)] for name in "ab"},
    )
    for axes in ((), None):
        assert [item.glyph for item in of(found(path, axes=axes), "doubled")] == ["a"]
        assert [item.glyph for item in of(found(path, axes=axes, once=False), "doubled")] == ["a", "b"]
    font = gs.open_source(path)
    assert [item.glyph for item in of(list(check_font(font, ["b"])), "doubled")] == ["b"]


def test_a_doubled_point_is_told_where_the_shape_is_known(tmp_path: Path) -> None:
    square = [(0, 0, 1), (120, 0, 1), (300, 0, 1), (300, 300, 1), (0, 300, 1)]
    build(tmp_path / "again.ttf", {"plain": simple(square), "doubled": simple([*square[:4], *square[3:]])})
    source = gs.open_font(tmp_path / "again.ttf")
    rows = check_font(source, source.glyph_names)
    found = {row.glyph: [each.kind for each in row.findings if each.kind in ("leftover", "repeated")] for row in rows}
    assert found == {".notdef": [], "plain": ["leftover"], "doubled": ["repeated", "leftover"]}


def test_parts_that_cross_are_told_again_where_they_stand_otherwise(tmp_path: Path) -> None:
    def parts(dx: int, apart: int) -> Glyph:
        glyph = quadratic([(dx, 0), (dx, 100), (dx + 100, 100), (dx + 100, 0)], [True] * 4)
        shift = GlyphCoordinates([(x + apart, y + 50) for x, y in glyph.coordinates])
        glyph.coordinates.extend(shift)
        glyph.flags.extend(glyph.flags)
        glyph.numberOfContours, glyph.endPtsOfContours = 2, [3, 7]
        return glyph

    path = variable_font(tmp_path / "v.ttf", {"a": parts(0, 50), "b": parts(70, 50), "c": parts(0, 60)}, {})
    assert [item.glyph for item in of(found(path), "overlap")] == ["a", "c"]
    assert [item.glyph for item in of(found(path, once=False), "overlap")] == ["a", "b", "c"]
    assert sum(row.repeated.get("overlap", 0) for row in found(path)) == 1, "that of b"


def test_a_kink_between_masters_is_told_once_where_it_is_worst(variable: Path) -> None:
    (item,) = of(found(variable, steps=7), "kink")
    (along,) = kinks(gs.open_font(variable))
    worst = along[0]
    assert (item.glyph, item.contour, item.segment) == ("k", 0, 0)
    assert item.value == worst.turn > 1
    assert item.detail == worst.made == pytest.approx(worst.turn, abs=0.1)
    assert (item.location, item.between) == (worst.location, (400, 900))
    assert (item.unit, item.level, item.other) == ("°", "WARN", None)
    assert item.point == pytest.approx(worst.point)
    assert of(found(variable, axes=()), "kink") == []
    assert of(found(variable, thresholds=Thresholds(kink=worst.turn + 0.01)), "kink") == []


def test_numbers_of_glyphs_add_up_to_those_of_the_font(variable: Path) -> None:
    """The same as of all joints at once; the square has no smooth joint."""
    font = gs.open_font(variable)
    (along,) = kinks(font)
    of_k, of_s = (item.axes[0] for item in found(variable) if item.glyph in "ks")
    total = of_s + of_k
    assert (of_s.joints, of_s.largest_turn, of_s.masters) == (0, None, (400.0,))
    assert (total.axis, total.joints, total.masters) == ("wght", len(along), along.positions)
    assert total.largest_turn == along.turns.max()
    assert total.largest_turn_at_masters == along.turns_at_masters.max()
    assert total.largest_made == along.made.max()
    assert total.turns_over_1 == (along.turns > 1).sum() == of_k.turns_over_1
    assert (of_k + of_k).jumps_over_10_percent == 2 * (along.jumps > 0.1).sum()
    assert all(item.axes == () for item in found(variable, axes=()))


def test_other_findings_are_told_once_at_a_step(variable: Path) -> None:
    (item,) = of(found(variable, steps=8), "crossing")
    assert (item.glyph, item.contour, item.between) == ("s", 0, None)
    assert item.location["wght"] > 400 + 500 / 3
    instance = gs.open_font(variable, location=item.location).outline("s")
    assert [other.kind for other in gs.check(instance) if other.kind == "crossing"] == ["crossing"]
    assert of(found(variable, axes=()), "crossing") == []


def test_a_joint_that_is_a_corner_in_a_master_does_not_kink() -> None:
    from glyphspline.plugins.masters.on_axes import on_axes

    font = gs.open_font(FONTS / "variable.ttf")
    masters = font.masters(font.glyph_names[-1])
    points = np.array([BEFORE, BOLD], dtype=np.float64)
    for turn, number in ((0.02, 1), (0.5, 0)):
        turned = points.copy()
        c, s = np.cos(turn), np.sin(turn)
        turned[1, 1] = turned[1, 1] @ np.array([[c, s], [-s, c]])  # the handle behind the joint, in the second master
        contour = MasterContour(turned, np.array([2, 1, 2]))
        glyph = Masters(
            "k", 0, axes=masters.axes, regions=np.array([[[0.0, 1.0, 1.0]]]), contours=[contour], advances=np.ones(2)
        )
        rows, _ = on_axes([glyph], {}, [masters.axes[0].tag], 4, Thresholds())
        assert ((rows.kinds == 0) & (rows.segments == 0)).sum() == number


def test_glyphs_and_axes_that_are_not_there_are_refused(variable: Path) -> None:
    font = gs.open_source(variable)
    with pytest.raises(FontError, match="no axis 'wdth': it has wght"):
        check_font(font, ["k"], axes=["wdth"])
    with pytest.raises(FontError, match="no such glyph"):
        check_font(font, ["z"])


def test_joints_of_chunks_are_those_of_the_whole_font(variable: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(AxesJob, "chunk", 1)
    for path in (variable, FONTS / "variable.ttf"):
        (face,) = check_fonts([path], Asked(joints=True), jobs=0, alone=True)
        assert face.kinks is not None
        for own, whole in zip(face.kinks, kinks(gs.open_source(path)), strict=True):
            assert list(own) == list(whole)
            assert (own.profile == whole.profile).all()
            assert own.positions == whole.positions
