"""Mending keeps ink: planted patches, overlaps, nested and touching contours, and composites of them, in pictures."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fontTools.pens.pointPen import SegmentToPointPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ufoLib import UFOWriter

import glyphspline as gs
from glyphspline.outlines.flaws.kinds import MENDED
from glyphspline.outlines.outline import Contour
from glyphspline.plugins.mending.job import MendedSource, Scope, mend_source
from glyphspline.readers import open_source
from glyphspline.readers.ufo import Ufo
from scripts.drawn_fonts import begun, ended
from scripts.mended_ink import Ink, alike, drawings

TOLERANCE, PIXEL = 4.0, 1 / 3

Points = Sequence[tuple[float, float]]
Component = tuple[str, tuple[float, ...]]


def polygon(*points: tuple[float, float]) -> Contour:
    return Contour(np.array(points, dtype=np.float64), np.ones(len(points), dtype=np.int64))


def box(x: float, y: float, width: float, height: float, turn: int = 1) -> Contour:
    """Counter-clockwise, or clockwise for ``turn`` -1."""
    return polygon(*[(x, y), (x + width, y), (x + width, y + height), (x, y + height)][::turn])


def disc(x: float, y: float, radius: float, turn: int = 1) -> Contour:
    k = 0.5523
    quarter = np.array([(1, 0), (1, k), (k, 1)])
    around = np.concatenate([quarter @ np.array([[c, s], [-s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))])
    contour = Contour(np.round(radius * around + (x, y)), np.full(4, 3))
    return contour if turn > 0 else contour.reversed()


ARCHES = {
    "kink": [(0, 0), (0, 166), (134, 300), (300, 300), (466, 306), (600, 166), (600, 0)],
    "unlevel": [(0, 0), (0, 166), (134, 298), (300, 300), (466, 302), (600, 166), (600, 0)],
    "jump": [(0, 0), (0, 166), (134, 300), (300, 300), (430, 300), (600, 166), (600, 0)],
    "handles": [(0, 0), (0, 17), (13, 30), (30, 30), (64, 30), (60, 17), (60, 0)],
    "extremum": [
        (0, 0), (0, 160), (90, 290), (200, 297), (270, 302), (350, 302), (420, 296), (520, 287), (600, 160), (600, 0)
    ],
}  # fmt: skip
"""Curves over a base, with a finding of the kind at their top."""


def arch(kind: str) -> Contour:
    degrees = [3] * (len(ARCHES[kind]) // 3) + [1]
    return Contour(np.array(ARCHES[kind], dtype=np.float64), np.array(degrees)).reversed()


BOX = [(0, 0), (600, 0), (600, 100)]
STEM, BAR = box(280, 0, 40, 400), box(0, 180, 600, 40)
RING = [disc(300, 300, 300), disc(300, 300, 200, -1)]
SLANTED = polygon((0, 0), (600, 0), (600, 101), (0, 100))
"""A bar whose upper edge is off by a unit."""

PLANTED = {
    "patch": [
        box(290, 380, 40, 320), box(290, 60, 40, 320), box(0, 360, 310, 40), box(310, 360, 310, 40),
        box(280, 350, 60, 60),
    ],
    "patch_in_overlap": [STEM, BAR, box(285, 185, 50, 30)],
    "patch_on_seam": [box(0, 0, 300, 60), box(300, 0, 300, 60), box(280, 10, 40, 40)],
    "patch_turned": [STEM, BAR, box(260, 160, 80, 80, -1)],
    "round_patch": [STEM, BAR, disc(300, 200, 30)],
    "overlap": [STEM, BAR],
    "overlap_turned": [STEM, BAR.reversed()],
    "half_overlap": [disc(200, 200, 150), disc(400, 200, 150, -1), disc(300, 450, 100)],
    "nested": [box(0, 0, 300, 300), box(100, 100, 100, 100)],
    "ring_filled": [RING[0], RING[1].reversed(), box(700, 0, 50, 50)],
    "island_turned": [*RING, box(260, 260, 80, 80, -1)],
    "ring_turned": [*(each.reversed() for each in RING), box(700, 0, 50, 50), box(800, 0, 50, 50)],
    "three_deep": [box(0, 0, 500, 500), box(50, 50, 400, 400), box(100, 100, 300, 300, -1)],
    "dot_turned": [box(0, 0, 100, 400), box(0, 500, 100, 100, -1)],
    "touching": [box(0, 0, 200, 200), box(200, 50, 100, 100, -1), box(350, 0, 50, 50)],
    "corner_to_corner": [box(0, 0, 200, 200), box(200, 200, 100, 100, -1)],
    "eight": [polygon((0, 0), (300, 300), (300, 0), (0, 300)), box(400, 0, 90, 90), box(500, 0, 90, 90)],
    "seam_slanted": [SLANTED, polygon((0, 100), (600, 101), (600, 200), (0, 200))],
    "slanted": [SLANTED],
    "slanted_below_bar": [SLANTED, box(0, 101, 600, 100)],
    "slit": [SLANTED, box(0, 102, 600, 100)],
    "slit_closed": [box(0, 0, 600, 300), polygon((100, 101), (100, 103), (500, 103), (500, 102))],
    "tiny_counter": [box(0, 0, 300, 300), box(100, 100, 2, 2, -1), polygon((200, 200), (200, 202), (201, 200))],
    "hairline": [box(0, 0, 300, 2), box(298, 0, 2, 300), disc(500, 100, 80)],
    "bridge": [box(0, 0, 300, 300), box(50, 50, 99, 200, -1), box(151, 50, 99, 200, -1)],
    "short_bridge": [
        polygon((0, 0), (100, 0), (100, 50), (102, 52), (104, 50), (200, 0), (200, 200), (102, 53), (0, 200))
    ],
    "spur": [polygon((0, 0), (300, 0), (300, 200), (150, 200), (150, 260), (150, 200), (0, 200))],
    **{kind: [arch(kind)] for kind in ARCHES},
    "extremum_below_bar": [arch("extremum"), box(0, 302, 600, 60)],
    "unlevel_below_bar": [arch("unlevel"), box(0, 301, 600, 60)],
    "straight": [Contour(np.array([*BOX, (400, 100), (200, 100), (0, 100)]), np.array([1, 1, 3, 1]))],
    "repeated": [polygon((0, 0), (100, 0), (100, 0), (100, 100), (50, 60), (0, 100))],
    "kink_in_overlap": [arch("kink"), box(100, 250, 400, 300)],
    "straight_on_seam": [
        Contour(np.array([*BOX, (400, 100.4), (200, 100.4), (0, 100)]), np.array([1, 1, 3, 1])),
        box(0, 100, 600, 50),
    ],
}  # fmt: skip
"""Drawings by their names, of which most have findings that are not to be mended."""

COMPOSITES: dict[str, list[Component]] = {
    **{
        f"{name}_mirrored": [(name, (-0.75, 0, 0, 0.75, 0, 0)), (name, (-0.75, 0, 0, 0.75, 37, 23))] for name in PLANTED
    },
    "touched_at_an_end": [("slanted", (1, 0, 0, 1, 0, 0)), ("bar", (1, 0, 0, 1, 0, 101))],
    "over_half": [("slanted", (1, 0, 0, 1, 0, 0)), ("bar", (1, 0, 0, 1, 0, 100.5))],
    "over_half_again": [("over_half", (1, 0, 0, 1, 10, 0))],
    "slit_on_bar": [("slit", (1, 0, 0, 1, 0, 0)), ("bar", (1, 0, 0, 1, 0, -60))],
}
"""Composites: of each drawing twice, and of those whose edge meets a bar at one end only, or crosses it."""

ON_BARS = ("touched_at_an_end", "over_half", "over_half_again")
"""Composites that would fall apart if the edge were level."""


def written(path: Path) -> Path:
    """A UFO of the drawings."""
    writer = UFOWriter(path)
    writer.writeInfo(SimpleNamespace(unitsPerEm=1000, ascender=800, descender=-200, familyName="Planted"))
    glyphs = writer.getGlyphSet()
    for name, contours in (PLANTED | {"bar": [box(0, 0, 600, 60)]}).items():

        def draw(pen: Any, contours: Sequence[Contour] = contours) -> None:
            for contour in contours:
                contour.draw(SegmentToPointPen(pen), closing=False)

        glyphs.writeGlyph(name, SimpleNamespace(width=600), draw)
    for name, components in COMPOSITES.items():

        def compose(pen: Any, components: Sequence[Component] = components) -> None:
            for base, matrix in components:
                pen.addComponent(base, matrix)

        glyphs.writeGlyph(name, SimpleNamespace(width=600), compose)
    glyphs.writeContents()
    writer.writeLayerContents()
    writer.close()
    return path


@cache
def before(path: Path) -> Any:
    return drawings(path)


@pytest.fixture(scope="module")
def planted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("planted") / "planted.ufo")


@cache
def mended(path: Path, kinds: tuple[str, ...]) -> tuple[MendedSource, Any]:
    """What became of the source, and what is drawn then."""
    source, copy = open_source(path), path.with_name(f"{'-'.join(kinds)}.ufo")
    assert isinstance(source, Ufo)
    found = mend_source(source, source.glyph_names, Scope(kinds, TOLERANCE), copy=copy)
    assert not found.failed
    return found, drawings(copy)


@pytest.mark.parametrize("kinds", [*((kind,) for kind in MENDED), MENDED], ids="-".join)
def test_no_mending_changes_what_is_filled(kinds: tuple[str, ...], planted: Path) -> None:
    found, new = mended(planted, kinds)
    old = before(planted)
    changed = [name for name in old if not alike(old[name], new[name])]
    assert {*found.changed} <= {*changed}
    assert found.mended
    for name in changed:
        ink = Ink(old[name], new[name], PIXEL, TOLERANCE)
        assert not ink.differs, (name, ink.area, ink.islands, ink.counters)


def test_moves_that_would_change_ink_are_left_and_say_so(planted: Path) -> None:
    found, _ = mended(planted, MENDED)
    left = {(each.glyph, each.kind): each.why for each in found.left}
    for name in ("overlap_turned", "half_overlap"):
        assert left[name, "direction"] == "would change the ink"
    assert left["tiny_counter", "short"] == "would change the ink"
    assert left["slanted", "slanted"] in {f"would change the ink of {name}, a composite" for name in ON_BARS}
    assert "slanted" not in found.changed
    assert {"dot_turned", "island_turned"} <= {*found.changed}
    assert all(each.moved == each.gone == 0 and not each.moves for each in found.left)


def test_in_a_font_composites_keep_their_ink_too(planted: Path, tmp_path: Path) -> None:
    source = open_source(planted)
    builder = begun([".notdef", *source.glyph_names], {}, cubic=False, em=1000)
    drawn: dict[str, Any] = {".notdef": TTGlyphPen(None).glyph()}
    for name in source.glyph_names:
        pen = TTGlyphPen(dict.fromkeys(source.glyph_names))
        for base, matrix in COMPOSITES.get(name, ()):
            pen.addComponent(base, matrix)
        for contour in () if name in COMPOSITES else source.outline(name).contours:
            if (contour.degrees == 1).all():
                contour.draw(pen)
        drawn[name] = pen.glyph()
    builder.setupGlyf(drawn)
    bearings = {name: (600, getattr(builder.font["glyf"][name], "xMin", 0)) for name in drawn}
    ended(builder, bearings, "Planted").save(tmp_path / "planted.ttf")
    font = gs.open_font(tmp_path / "planted.ttf")
    found = mend_source(font, font.glyph_names, Scope(MENDED, TOLERANCE), copy=tmp_path / "mended.ttf")
    old, new = drawings(tmp_path / "planted.ttf"), drawings(tmp_path / "mended.ttf")
    changed = [name for name in old if not alike(old[name], new[name])]
    assert {"slit", "slit_mirrored"} <= {*changed}
    assert not [name for name in changed if Ink(old[name], new[name], PIXEL, TOLERANCE).differs]
    (why,) = [each.why for each in found.left if (each.glyph, each.kind) == ("slanted", "slanted")]
    assert why in {f"would change the ink of {name}, a composite" for name in ON_BARS}
