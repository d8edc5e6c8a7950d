"""Glyphs asked for by text, code point, name and index."""

from __future__ import annotations

import pickle
from typing import Any

import pytest

from glyphspline.errors import FontError
from glyphspline.readers import open_font
from tests.places import FONTS


def test_a_selection_is_in_the_order_of_the_text_then_of_the_glyphs_without_repeats() -> None:
    font = open_font(FONTS / "kouzan-gyosho.ttf")
    names = font.select(text="龍好\n好A", unicodes="U+0041-0042,597D", glyphs=["g"], gids="0,2-3")
    assert set(names) == {".notdef", *font.glyph_names[2:4], "A", "B", "g", "uni597D", "uni9F8D"}
    assert names[:3] == ("uni9F8D", "uni597D", "A")
    assert list(names[3:]) == sorted(set(names[3:]), key=font.glyph_names.index)
    assert names.missing == ()


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        ({"unicodes": "U+9F8D"}, ["uni9F8D"]),
        ({"unicodes": [0x9F8D, "0x597D"]}, ["uni597D", "uni9F8D"]),
        ({"unicodes": 0x9F8D}, ["uni9F8D"]),
        ({"unicodes": "9F00-9FFF 3042"}, ["uni3042", "uni9F8D"]),
        ({"glyphs": "g, A"}, ["A", "g"]),
        ({"gids": 1}, ["space"]),
        ({"gids": [0, "1"]}, [".notdef", "space"]),
        ({"text": " "}, ["space"]),
        ({"text": ""}, []),
    ],
    ids=str,
)
def test_requests_come_as_numbers_strings_and_ranges(asked: dict[str, Any], found: list[str]) -> None:
    assert list(open_font(FONTS / "kouzan-gyosho.ttf").select(**asked)) == found


def test_a_star_or_all_glyphs_is_everything() -> None:
    font = open_font(FONTS / "kouzan-gyosho.ttf")
    assert font.select(all_glyphs=True) == font.select(glyphs="*") == font.select(gids="*") == font.glyph_names
    assert set(font.select(unicodes="*")) == set(font.cmap.values())


def test_what_is_missing_is_said_once_and_of_ranges_only_if_all_is() -> None:
    font = open_font(FONTS / "kouzan-gyosho.ttf")
    names = font.select(text="龙龙龍", unicodes="1F600-1F64F,9F99", glyphs=["nosuch"], gids="3-9999,9998-9999,70000")
    assert names.missing == ("U+9F99", "U+1F600-1F64F", "glyph nosuch", "gid 9998-9999", "gid 70000")
    assert names[0] == "uni9F8D"
    assert sorted(names, key=font.glyph_names.index) == list(font.glyph_names[3:])
    assert pickle.loads(pickle.dumps(names)).missing == names.missing


@pytest.mark.parametrize(
    "asked",
    [
        {},
        {"unicodes": "U+XYZ"},
        {"unicodes": "110000"},
        {"unicodes": "5-3"},
        {"gids": "A"},
        {"gids": [-1]},
        {"gids": "٣"},
    ],
    ids=str,
)
def test_a_request_that_makes_no_sense_is_an_error(asked: dict[str, Any]) -> None:
    with pytest.raises(FontError, match=r"kouzan-gyosho\.ttf"):
        open_font(FONTS / "kouzan-gyosho.ttf").select(**asked)
