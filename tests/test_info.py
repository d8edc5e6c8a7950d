"""What a file holds, as data."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from glyphspline.errors import FontError
from glyphspline.readers.facts import file_facts

FONTS = Path(__file__).parent.parent / "fonts_test"


def test_a_variable_font_has_axes_and_instances() -> None:
    facts = file_facts(FONTS / "variable-cff2.otf", location="bold")
    (font,) = facts["fonts"]
    assert (facts["format"], facts["faces"]) == ("OpenType (CFF)", 1)
    assert [axis["tag"] for axis in font["axes"]] == ["wght", "wdth"]
    assert font["instances"]["Bold Condensed"] == {"wght": 700, "wdth": 75}
    assert font["location"] == {"wght": 700, "wdth": 100}
    assert (font["ascender"], font["units_per_em"]) == (830, 1000)  # MVAR: 800 to 850 over wght 400 to 900
    assert (font["glyphs"], font["characters"], font["contours"]) == (5, 4, 5)
    assert json.loads(json.dumps(facts)) == facts


def test_overlaps_and_degenerate_contours_are_named() -> None:
    (font,) = file_facts(FONTS / "edge-cases.ttf")["fonts"]
    assert font["degenerate"] == ["onepoint", "twopoints", "flat"]
    assert font["overlaps"] == ["overlap", "eight", "loop", "twice"]
    assert font["broken"] == []


def test_all_faces_of_a_collection_or_one() -> None:
    assert [font["family"] for font in file_facts(FONTS / "kouzan.ttc")["fonts"]] == [
        "Kouzan Gyosho Subset",
        "Kouzan Kaisho Subset",
    ]
    facts = file_facts(FONTS / "kouzan.ttc", 1)
    assert facts["format"] == "collection"
    assert [font["face_index"] for font in facts["fonts"]] == [1]


def test_an_instance_that_is_not_there_is_an_error_that_lists_those_that_are() -> None:
    with pytest.raises(FontError, match="no named instance 'Black': it has Regular, Bold, Bold Condensed"):
        file_facts(FONTS / "variable-cff2.otf", location="Black")
    with pytest.raises(FontError, match="it has none"):
        file_facts(FONTS / "kouzan-gyosho.otf", location="Bold")
