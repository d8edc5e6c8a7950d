"""Measures as people are told them."""

from __future__ import annotations

import json

import glyphspline as gs
from glyphspline.fitting.results import MEASURES, PER_EM, QUANTITIES, shown
from glyphspline.report.data import COMBINED
from scripts.house import PACKAGE
from tests.drawings import circle
from tests.places import ROOT


def test_every_measure_has_a_label_and_a_meaning() -> None:
    assert tuple(QUANTITIES) == MEASURES
    assert set(COMBINED) == set(MEASURES)
    assert all(quantity.label and quantity.about for quantity in QUANTITIES.values())
    assert len({quantity.label for quantity in QUANTITIES.values()}) == len(QUANTITIES)


def test_every_measure_is_in_the_schema_and_in_the_pages() -> None:
    schema = json.loads((PACKAGE / "writers" / "glyph.schema.json").read_text(encoding="utf-8"))["$defs"]["measures"]
    assert tuple(schema["properties"]) == MEASURES
    assert tuple(schema["required"]) == MEASURES
    for page in ("manifest.md", "datasets.md"):
        text = (ROOT / "docs" / page).read_text(encoding="utf-8")
        assert not [name for name in MEASURES if f"`{name}`" not in text]


def test_curvature_is_told_in_units_of_the_em_whatever_the_em() -> None:
    told = []
    for em in (1000.0, 2048.0):
        contour = gs.Contour.from_segments(list(circle(0.25 * em)))
        outline = gs.Outline("o", contours=(contour,), metrics=gs.FontMetrics(em, 0.8 * em, -0.2 * em))
        (found,) = gs.convert(outline, gs.Options(count=40, measure=True, precision=6)).contours
        curved = {name: getattr(found.measures, name) for name in QUANTITIES if QUANTITIES[name].unit == PER_EM}
        told.append({name: round(shown(name, value, em), 2) for name, value in curved.items()})
    assert told[0] == told[1]
    assert abs(told[0]["max_curvature"] - 4) < 0.05
    assert shown("max_curvature", None, 1000.0) is None
    assert shown("deviation", 1.5, 1000.0) == 1.5
