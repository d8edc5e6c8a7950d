"""Outer contours run as the format has them: clockwise in every glyph of a TTF, counter-clockwise in every one of a
CFF table. They are read by fontTools, and outer is what no other contour runs around."""

# ruff: noqa: N802

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fontTools.pens.areaPen import AreaPen
from fontTools.pens.basePen import BasePen
from fontTools.subset import Options as Subset
from fontTools.subset import Subsetter
from fontTools.ttLib import TTFont
from matplotlib import get_data_path
from typer.testing import CliRunner

from glyphspline.cli.app import app
from glyphspline.types import FloatArray
from tests.places import FONTS

MONO = Path(get_data_path(), "fonts", "ttf", "DejaVuSansMono.ttf")
CHARACTERS = "+=/-|_#AHBO8i%&é─│┌■○⊕∞"
"""Lines alone, rings in each other, marks apart, components."""


class Polygons(BasePen):  # type: ignore[misc, unused-ignore]
    """A glyph's contours as polygons (n, 2), eight chords a curve, with their areas by AreaPen."""

    def __init__(self, glyphs: Any) -> None:
        super().__init__(glyphs)
        self.found: list[tuple[FloatArray, float]] = []

    def _moveTo(self, pt: Any) -> None:
        self.points, self.area = [pt], AreaPen()
        self.area.moveTo(pt)

    def _lineTo(self, pt: Any) -> None:
        self.points.append(pt)
        self.area.lineTo(pt)

    def _curveToOne(self, pt1: Any, pt2: Any, pt3: Any) -> None:
        a, b, c, d = (np.array(p, dtype=float) for p in (self.points[-1], pt1, pt2, pt3))
        self.points += [
            tuple((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d)
            for t in np.arange(1, 9) / 8
        ]
        self.area.curveTo(pt1, pt2, pt3)

    def _closePath(self) -> None:
        self.area.closePath()
        self.found.append((np.array(self.points, dtype=float), float(self.area.value)))


def runs_around(polygon: FloatArray, point: FloatArray) -> int:
    """How often a polygon runs around a point: the sum of the angles at which it sees the polygon's sides."""
    x, y = (polygon - point).T
    angles = np.arctan2(y, x)
    return round(((np.diff(angles, append=angles[:1]) + np.pi) % (2 * np.pi) - np.pi).sum() / (2 * np.pi))


def wrong_contours(font: TTFont, sign: int, location: dict[str, float] | None = None) -> tuple[list[Any], int]:
    """Outer contours of all glyphs whose area has not this sign, by glyph and number; and how many are right."""
    glyphs, wrong, right = font.getGlyphSet(location=location), [], 0
    for name in font.getGlyphOrder():
        pen = Polygons(glyphs)
        glyphs[name].draw(pen)
        for c, (polygon, area) in enumerate(pen.found):
            others = [other for d, (other, _) in enumerate(pen.found) if d != c]
            some = polygon[:: max(1, len(polygon) // 12)] + np.array([0.0123, 0.0071])
            inside = any(runs_around(other, point) for point in some for other in others)
            if not inside and abs(area) > 1:
                right += area * sign > 0
                wrong += [(name, c)] * (area * sign <= 0)
    return wrong, right


def converted(path: Path, out: Path, *options: str) -> TTFont:
    """The font that the command makes of all glyphs."""
    run = CliRunner().invoke(app, ["refit", str(path), "--all", "--out", str(out), "-j", "0", "-q", *options])
    assert run.exit_code in (0, 1), run.output  # 1: a glyph keeps its outline
    (made,) = out.glob("*.?tf")
    return TTFont(made)


def subset(path: Path, text: str, out: Path) -> Path:
    """A face of some characters alone."""
    font, options = TTFont(path), Subset()
    options.hinting, options.layout_features = False, []
    subsetter = Subsetter(options)
    subsetter.populate(text=text)
    subsetter.subset(font)
    font.save(out)
    return out


def test_every_glyph_of_a_ttf_made_of_cubics_runs_clockwise(tmp_path: Path) -> None:
    source = FONTS / "kouzan-gyosho.otf"
    assert wrong_contours(TTFont(source), 1)[0] == []
    wrong, right = wrong_contours(converted(source, tmp_path, "--format", "ttf"), -1)
    assert (wrong, right > 20) == ([], True)


def test_directions_turn_with_the_format_and_back(tmp_path: Path) -> None:
    source = subset(MONO, CHARACTERS, tmp_path / "mono.ttf")
    assert wrong_contours(TTFont(source), -1)[0] == []
    cff = converted(source, tmp_path / "otf", "--format", "otf")
    wrong, right = wrong_contours(cff, 1)
    assert (wrong, right > 25) == ([], True)
    (path,) = (tmp_path / "otf").glob("*.otf")
    for continuity in ("g2", "c2"):
        out = tmp_path / continuity
        assert wrong_contours(converted(path, out, "--format", "ttf", "--continuity", continuity), -1) == ([], right)


def drawn(turned: bool) -> str:
    """Path data of a box beside a ring, of lines, and of a ring of quadratics; both ways round."""
    paths = []
    for x, y, size, inner in ((0, 0, 90, False), (0, 200, 400, False), (100, 300, 200, True)):
        corners = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]
        paths.append("M" + "L".join(f"{a} {b}" for a, b in corners[:: -1 if inner != turned else 1]) + "Z")
    for size, inner in ((150, False), (90, True)):
        steps = [(size, 0, size, size), (0, size, -size, size), (-size, 0, -size, -size), (0, -size, size, -size)]
        to = steps if inner == turned else [(-x, y, -a, b) for x, y, a, b in steps]
        paths.append(f"M700 {400 - size}" + "".join(f"q{x} {y} {a} {b}" for x, y, a, b in to) + "Z")
    return "".join(paths)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("flavour", "sign"), [("otf", 1), ("ttf", -1)])
def test_a_source_of_either_direction_gets_that_of_the_format(
    flavour: str, sign: int, turned: bool, tmp_path: Path
) -> None:
    (tmp_path / "in").mkdir()
    path = f'<path d="{drawn(turned)}"/>'
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000">{path}</svg>'
    (tmp_path / "in" / "a.svg").write_text(svg, encoding="utf-8")
    font = converted(tmp_path / "in", tmp_path / "out", "--format", flavour)
    assert wrong_contours(font, sign) == ([], 3)


@pytest.mark.parametrize(("file", "flavour", "sign"), [("variable-cff2.otf", "ttf", -1), ("variable.ttf", "otf", 1)])
def test_masters_run_as_the_format_has_them_everywhere(file: str, flavour: str, sign: int, tmp_path: Path) -> None:
    font = converted(FONTS / file, tmp_path, "--masters", "--format", flavour)
    assert "fvar" in font
    for weight in (400, 650, 900):
        wrong, right = wrong_contours(font, sign, {"wght": weight})
        assert (wrong, right > 2) == ([], True)


def test_what_a_font_of_the_same_kind_keeps_runs_as_it_did(tmp_path: Path) -> None:
    """A composite that mirrors what it is made of, and that overlaps it: turned alone, either would cut the other."""
    source = FONTS / "edge-cases.ttf"
    font = converted(source, tmp_path, "--format", "ttf")
    assert wrong_contours(font, -1) == wrong_contours(TTFont(source), -1)
