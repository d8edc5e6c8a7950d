"""What is said of a written file is true of its bytes: glyphs are within their bounds, whatever writes them wrong."""

from __future__ import annotations

import json
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont
from fontTools.ttLib.tables.TupleVariation import compileTupleVariationStore

import glyphspline as gs
from glyphspline.plugins.fonts import ufo_folder
from glyphspline.plugins.fonts.back import nodes
from glyphspline.plugins.fonts.fit import points as font_points
from glyphspline.plugins.fonts.spec import RefitSpec
from glyphspline.plugins.fonts.tables import font_file, font_glyphs
from glyphspline.plugins.fonts.tables.font_file import FontSummary, to_font
from glyphspline.plugins.fonts.tables.font_glyphs import Flavour
from glyphspline.plugins.masters import variable_font
from glyphspline.plugins.masters.job import convert_font_masters
from glyphspline.readers import Source, open_font
from glyphspline.readers.ufo import Ufo
from glyphspline.runs.convert import convert_font
from glyphspline.runs.folder import MANIFEST, entries_of
from glyphspline.runs.schedule import InProcess
from scripts.bounds import FACES, SINGLE, part_of, written
from scripts.survey import faces
from tests.farthest import cubics, farthest
from tests.places import FONTS
from tests.variable_fonts import quadratic
from tests.variable_fonts import variable_font as built

G2, C2, SMOOTH = gs.Options(continuity="g2"), gs.Options(), gs.Options(corners="smooth")
GLYF = "glyphspline.plugins.fonts.tables.variable_glyf"
FAR = 7.0
"""Units by which what is written is wrong here."""


@pytest.mark.parametrize("kind", ["ttf", "otf"])
@pytest.mark.parametrize("name", ["kouzan-gyosho.ttf", "kouzan-gyosho.otf"])
def test_glyphs_are_within_their_bounds(name: str, kind: str, tmp_path: Path) -> None:
    found, _ = written(FONTS / name, kind, tmp_path, 0)
    assert len(found) >= 15
    assert [glyph for glyph in found if glyph.bound is None or glyph.seen is not None] == []


@pytest.mark.long
@pytest.mark.parametrize("kind", ["ttf", "otf"])
@pytest.mark.parametrize("face", FACES, ids=lambda face: face.name)
def test_glyphs_of_a_face_are_within_their_bounds(face: Any, kind: str, tmp_path: Path) -> None:
    paths = faces(face.file)
    if not paths:
        pytest.skip(f"{face.name} is not installed")
    part = tmp_path / f"part{paths[0].suffix.replace('ttc', 'otf')}"
    part.write_bytes(part_of(paths[0], 200))
    found, _ = written(part, kind, tmp_path / "out", 0)
    assert len(found) >= 200
    assert all(glyph.bound is not None for glyph in found)
    assert [glyph for glyph in found if glyph.seen is not None] == []


@pytest.mark.parametrize("options", [G2, SMOOTH], ids=["g2", "smooth"])
@pytest.mark.parametrize("file", ["variable.ttf", "variable-cff2.otf"])
@pytest.mark.parametrize("kind", ["ttf", "otf"])
def test_variable_glyphs_are_within_their_bounds_at_all_corners(
    kind: str, file: str, options: gs.Options, tmp_path: Path
) -> None:
    font = open_font(FONTS / file)
    made, stored = masters_of(font, kind, options, tmp_path)
    tables = TTFont(FONTS / file), TTFont(made)
    assert options is G2 or any(facts["bound"] > 0 for facts in stored.values())
    for at in locations(font):
        sets = [each.getGlyphSet(location=at, normalized=True) for each in tables]
        for name, facts in stored.items():
            old, new = (segments(glyphs, name) for glyphs in sets)
            assert farthest(old, new, 1000.0, facts["bound"] + SINGLE * 1000) <= facts["bound"] + SINGLE * 1000


def masters_of(font: gs.Font, kind: str, options: gs.Options, out: Path) -> tuple[Path, dict[str, Any]]:
    """A font written in all masters, and what the manifest has of its glyphs."""
    convert_font_masters([font], font.glyph_names, out, RefitSpec(options, (kind,), masters=True), InProcess())
    (made,) = out.glob(f"*.{kind}")
    return made, {entry["glyph"]: entry["stored"] for entry in entries_of(out) if entry["stored"]}


def locations(font: gs.Font) -> list[dict[str, float]]:
    """The ends of all axes together, and places between them."""
    low, high = [-1.0 * (a.minimum < a.default) for a in font.axes], [1.0 * (a.maximum > a.default) for a in font.axes]
    every = np.array(np.meshgrid(*([a, 0.0, b] for a, b in zip(low, high, strict=True)))).reshape(len(low), -1).T
    inside = np.random.default_rng(0).uniform(low, high, (4, len(low)))
    return [dict(zip([a.tag for a in font.axes], at, strict=True)) for at in [*every.tolist(), *inside.tolist()]]


def segments(glyphs: Any, name: str) -> Any:
    """Of a glyph at a location, where its side bearing is the same in both fonts."""
    return cubics(TTFont(), glyphs, name)


def moved(write: Callable[..., Any]) -> Callable[..., Any]:
    """A writer of a glyph of ``glyf`` that puts a point elsewhere."""

    def wrong(points: Any, *rest: Any) -> Any:
        points, middle = points.copy(), len(points) // 2
        points[middle : middle + 1] += int(FAR)  # a glyph may be empty
        return write(points, *rest)

    return wrong


def test_a_ttf_that_is_written_wrong_is_found_beyond(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not summary_of("ttf").beyond
    monkeypatch.setattr(font_glyphs, "simple_glyph", moved(font_glyphs.simple_glyph))
    assert_beyond(summary_of("ttf"))


def test_an_otf_that_is_written_wrong_is_found_beyond(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not summary_of("otf").beyond
    write = font_glyphs.char_string

    def wrong(contours: Any, *rest: Any) -> Any:
        third = [FAR * (np.arange(len(contour.points)) == 3)[:, None] for contour in contours]
        return write([gs.Contour(c.points + move, c.degrees) for c, move in zip(contours, third, strict=True)], *rest)

    monkeypatch.setattr(font_glyphs, "char_string", wrong)
    assert_beyond(summary_of("otf"))


def test_subroutines_that_are_wrong_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(font: TTFont) -> bool:
        strings = font["CFF "].cff.topDictIndex[0].CharStrings
        for name in strings.keys():  # noqa: SIM118 (CharStrings iterates by numbers)
            strings[name].decompile()
            program = strings[name].program
            place = next((k for k, token in enumerate(program) if str(token).endswith("moveto")), 0)
            program[place - 1] = program[place - 1] + int(FAR) if place else program[place - 1]
        return True

    monkeypatch.setattr(font_file, "_grew", lambda *_: True)
    monkeypatch.setattr(font_file, "share_subroutines", wrong)
    assert_beyond(summary_of("otf"))


def test_whole_units_but_for_rounding_errors_are_these(monkeypatch: pytest.MonkeyPatch) -> None:
    points = np.array([[0.0, 0.0], [0.0, 80.0], [100.0, 80.0], [100.0, 0.0]])
    near = np.nextafter(points, np.array([-1.0, 1.0])[np.arange(4) % 2][:, None])
    found = [(near, np.ones(4, dtype=np.bool_))], 0.0
    monkeypatch.setattr(font_points, "quadratic_points", lambda *_: found)
    box = gs.Contour(points, np.ones(4, dtype=np.int64))
    glyph = font_glyphs.in_quadratics([box], G2, 1.0, 1000.0, "box")
    assert list(glyph.coordinates) == list(map(tuple, points.tolist()))


def summary_of(flavour: Flavour) -> FontSummary:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    return to_font(font, [gs.convert(font.outline(name), G2) for name in ("A", "B", "O")], flavour)[1]


def assert_beyond(summary: FontSummary) -> None:
    assert summary.beyond == ("A", "B", "O")
    assert all(bound > 1.0 for bound in summary.bounds.values())
    assert summary.largest_error == max(summary.bounds.values())


def test_glyphs_of_masters_that_are_written_wrong_are_found(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(f"{GLYF}.simple_glyph", moved(font_glyphs.simple_glyph))
        assert_outside(open_font(FONTS / "variable.ttf"), "ttf", tmp_path / "default")
    with monkeypatch.context() as patch:

        def wrong(variations: Any, *rest: Any) -> Any:
            for each in variations:
                each.coordinates = [xy and (xy[0] + int(FAR), xy[1]) for xy in each.coordinates[:-4]] + [None] * 4
            return compileTupleVariationStore(variations, *rest)

        patch.setattr(f"{GLYF}.compileTupleVariationStore", wrong)
        assert_outside(open_font(FONTS / "variable.ttf"), "ttf", tmp_path / "deltas")
    with monkeypatch.context() as patch:
        blend = variable_font.blend
        patch.setattr(variable_font, "blend", lambda column: blend([*column[:-1], column[-1] + FAR]))
        assert_outside(open_font(FONTS / "variable-cff2.otf"), "otf", tmp_path / "blends")


def assert_outside(font: gs.Font, kind: str, out: Path) -> None:
    _, stored = masters_of(font, kind, SMOOTH, out)
    curved = [name for name in stored if any((each.degrees > 1).any() for each in font.masters(name).contours)]
    assert curved
    assert [name for name in curved if stored[name]["within_tolerance"]] == []


def test_a_ufo_that_is_written_wrong_is_found(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    names = font.select(text="AB")
    assert all(facts["within_tolerance"] for facts in stored_ufo(font, names, tmp_path / "right", ("ufo",)))
    source = tmp_path / "right" / "KouzanGyoshoSubset-spline.ufo"

    def wrong(*arguments: Any) -> Any:
        found = write(*arguments)
        return [found[0]._replace(at=(found[0].at[0] + FAR, found[0].at[1])), *found[1:]]

    write = nodes.nodes_of
    monkeypatch.setattr(ufo_folder, "nodes_of", wrong)
    monkeypatch.setattr(nodes, "nodes_of", wrong)
    assert not any(facts["within_tolerance"] for facts in stored_ufo(font, names, tmp_path / "new", ("ufo",)))
    ways: list[dict[str, Any]] = [{"formats": ("ufo",)}, {"layer": "fair"}, {"in_place": True}]
    for number, how in enumerate(ways):
        ufo = Ufo.opened(source)
        assert not any(facts["within_tolerance"] for facts in stored_ufo(ufo, names, tmp_path / f"back{number}", **how))


def stored_ufo(source: Source, names: Any, out: Path, formats: Any = (), **how: Any) -> list[dict[str, Any]]:
    summary = convert_font(source, names, out, RefitSpec(C2, formats, **how), jobs=0)
    found = [next(iter(entry["stored"].values())) for entry in entries_of(out)]
    assert summary.undone == (not all(facts["within_tolerance"] for facts in found))
    assert summary.undone == any("may be beyond the tolerance: A, B" in remark for remark in summary.remarks)
    return found


def test_curves_of_a_ufo_that_are_rounded_twice_are_within_the_tolerance(tmp_path: Path) -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    options = gs.Options(precision=1)
    summary = convert_font(font, font.glyph_names, tmp_path, RefitSpec(options, ("otf", "ufo")), jobs=0)
    assert not summary.undone
    ufo = Ufo.opened(tmp_path / "KouzanGyoshoSubset-spline.ufo")
    tables = TTFont(FONTS / "kouzan-gyosho.otf")
    drawn = tables.getGlyphSet()
    for entry in entries_of(tmp_path):
        bound = entry["stored"]["ufo"]["bound"]
        assert bound <= options.tolerance_for(1024)
        old, new = cubics(tables, drawn, entry["glyph"]), cubics(TTFont(), ufo.default_layer, entry["glyph"])
        assert farthest(old, new, 1024.0, bound + 1e-6) <= bound + 1e-6


def disc(points: int, radius: float) -> Any:
    turn = np.arange(points) * 2 * np.pi / points
    at = np.rint(300 + radius * np.array([np.cos(turn), np.sin(turn)]).T).astype(int)
    return quadratic(list(map(tuple, at.tolist())), [4 * k % points == 0 for k in range(points)])


def test_composites_of_new_glyphs_have_bounds_too(tmp_path: Path) -> None:
    components = {"half": 0.5, "same": 1.0, "larger": 1.5}
    glyphs = {"o": disc(40, 250.0)}
    for name, scale in components.items():
        pen = TTGlyphPen({**glyphs})
        pen.addComponent("o", (scale, 0, 0, scale, 30, -20))
        glyphs[name] = pen.glyph()
    font = open_font(built(tmp_path / "discs.ttf", glyphs, {}))
    tables = TTFont(tmp_path / "discs.ttf")
    for tag in ("fvar", "gvar"):
        del tables[tag]
    tables.save(tmp_path / "static.ttf")
    font = open_font(tmp_path / "static.ttf")
    data, summary = to_font(font, [gs.convert(font.outline("o"), G2)], "ttf")
    new = TTFont(BytesIO(data))
    assert [name for name in components if new["glyf"][name].isComposite()] == ["half", "same"]
    assert summary.bounds.keys() == {"o", "half", "same"}
    assert summary.bounds["o"] > 0.1
    assert summary.bounds["half"] == pytest.approx(summary.bounds["o"] / 2, rel=0.05)
    for name in ("o", *components):
        bound = summary.bounds.get(name, np.sqrt(0.5))  # what was decomposed is rounded
        old, made = (cubics(each, each.getGlyphSet(), name) for each in (tables, new))
        assert farthest(old, made, 1000.0, bound + 1e-9) <= bound + 1e-9


def test_composites_of_masters_have_the_bounds_of_their_components(tmp_path: Path) -> None:
    glyphs = {"o": disc(40, 250.0)}
    for name, scale in (("half", 0.5), ("larger", 1.5)):
        pen = TTGlyphPen({**glyphs})
        pen.addComponent("o", (scale, 0, 0, scale, 30, -20))
        glyphs[name] = pen.glyph()
    wider = [(round(x * 0.2), 0) for x, _ in glyphs["o"].coordinates]
    font = open_font(built(tmp_path / "discs.ttf", glyphs, {"o": [({"wght": (0.0, 1.0, 1.0)}, wider)]}))
    _, stored = masters_of(font, "ttf", G2, tmp_path / "out")
    assert all(facts["within_tolerance"] for facts in stored.values())
    assert stored["half"]["bound"] == pytest.approx(stored["o"]["bound"] / 2, rel=1e-5)
    assert stored["larger"]["bound"] == pytest.approx(stored["o"]["bound"] * 1.5, rel=1e-5)


def test_where_regions_overlap_rounding_counts_at_every_corner(tmp_path: Path) -> None:
    axes = (("wght", 100, 100, 900, "Weight"), ("wdth", 50, 50, 100, "Width"))
    glyph = disc(24, 250.0)
    rng = np.random.default_rng(3)

    def deltas(size: int) -> Any:
        return [(int(x), int(y)) for x, y in rng.integers(-size, size + 1, (24, 2))]

    regions = [
        ({"wght": (0.0, 0.5, 1.0)}, deltas(4)), ({"wght": (0.0, 1.0, 1.0)}, deltas(9)),
        ({"wdth": (0.0, 0.7, 1.0)}, deltas(4)), ({"wdth": (0.0, 1.0, 1.0)}, deltas(9)),
    ]  # fmt: skip
    font = open_font(built(tmp_path / "over.ttf", {"o": glyph}, {"o": regions}, axes))
    for number, options in enumerate((G2, SMOOTH)):
        made, stored = masters_of(font, "ttf", options, tmp_path / str(number))
        if not stored:
            continue
        bound = stored["o"]["bound"]
        tables = TTFont(tmp_path / "over.ttf"), TTFont(made)
        for at in locations(font):
            old, new = (segments(each.getGlyphSet(location=at, normalized=True), "o") for each in tables)
            assert farthest(old, new, 1000.0, bound + 1e-6) <= bound + 1e-6


def test_the_manifest_has_the_bounds_however_often_a_run_goes_on(tmp_path: Path) -> None:
    font, path = open_font(FONTS / "kouzan-gyosho.otf"), tmp_path / MANIFEST
    spec = RefitSpec(G2, ("ttf", "otf"))
    summary = convert_font(font, font.select(text="AB"), tmp_path, spec, jobs=0)
    assert not summary.undone
    convert_font(font, font.select(text="ABO"), tmp_path, spec, jobs=0)
    whole = path.read_bytes()
    assert [list(entry["stored"]) for entry in entries_of(tmp_path)] == [["otf", "ttf"]] * 3
    lines = [{k: v for k, v in json.loads(line).items() if k != "stored"} for line in whole.splitlines()]
    path.write_text("".join(f"{json.dumps(line)}\n" for line in lines))  # as if it had ended before fonts were written
    convert_font(font, font.select(text="A"), tmp_path, spec, jobs=0)
    assert path.read_bytes() == whole


def test_a_ttf_that_cannot_be_within_the_tolerance_is_said_to_be_beyond(tmp_path: Path) -> None:
    font = open_font(FONTS / "kouzan-gyosho.otf")
    summary = convert_font(
        font, font.select(text="O"), tmp_path, RefitSpec(gs.Options(continuity="g2", tolerance=0.01), ("ttf",)), jobs=0
    )
    (entry,) = entries_of(tmp_path)
    assert entry["stored"]["ttf"]["bound"] > 0.01
    assert not entry["stored"]["ttf"]["within_tolerance"]
    assert summary.undone
