"""From characters to glyphs: what HarfBuzz shows, in every kind of table of characters, and in sources without any."""

from __future__ import annotations

from pathlib import Path
from unicodedata import category

import pytest

import glyphspline as gs
from glyphspline.readers.clusters import clusters, unified
from tests.character_fonts import HEAVY, font_of, ufo_of
from tests.places import DEJAVU


def test_symbols_are_found_by_letters_and_by_their_own_code_points(tmp_path: Path) -> None:
    font = font_of(tmp_path / "s.ttf", {0xF041: "A", 0xF042: "B"}, table=(3, 0))
    assert font.select(text="BA") == ("B", "A") == font.select(text="\uf042\uf041")
    assert font.select(unicodes="41,F042") == font.select(unicodes="*") == ("A", "B")
    assert font.outline("A").unicodes == (0xF041,)
    assert font.counts() == (3, 2)
    assert font.select(text="AC").missing == ("U+0043",)


def test_a_table_of_the_macintosh_has_its_own_bytes(tmp_path: Path) -> None:
    font = font_of(tmp_path / "m.ttf", {0x41: "A", 0x8E: "eacute"}, table=(1, 0))
    assert font.select(text="éA") == ("eacute", "A")
    assert font.cmap == {0x41: "A", 0xE9: "eacute"}
    assert font.counts() == (3, 2)


def test_a_selector_chooses_a_variation_and_what_there_is_none_of_is_said(tmp_path: Path) -> None:
    cmap = {0x845B: "katsu", 0x2764: "heart"}
    selectors = [(0x845B, 0xE0100, "katsu.old"), (0x845B, 0xE0101, None)]
    font = font_of(tmp_path / "v.ttf", cmap, "katsu.old", selectors=selectors)
    assert font.select(text="葛\U000e0100") == ("katsu.old",)
    assert font.select(text="葛葛\U000e0100") == ("katsu", "katsu.old")
    assert font.select(text="葛\U000e0101").missing == ()
    found = font.select(text="葛\U000e0102")
    assert (found, found.missing) == (("katsu",), ("U+845B U+E0102",))
    assert gs.layout(font, "葛葛\U000e0102").unvaried == ("葛\U000e0102",)
    assert gs.layout(font, "葛\U000e0100\u2764\ufe0f").notes == ()
    assert font.select(text="\u2764\ufe0f").missing == ()  # as a heart is copied from anywhere
    assert font.select(text="龍\U000e0100").missing == ("U+9F8D",)


def test_rules_by_location_hold_where_the_font_is_read(tmp_path: Path) -> None:
    cmap = {0x24: "dollar", 0x6F: "o"}
    font_of(tmp_path / "r.ttf", cmap, "dollar.heavy", features=HEAVY, weight=True)
    for weight, name in ((400, "dollar"), (800, "dollar.heavy")):
        font = gs.open_font(tmp_path / "r.ttf", location={"wght": weight})
        assert font.select(text="$o") == (name, "o")
        assert font.select(unicodes=0x24) == font.select(unicodes="20-2F") == (name,)
        assert font.select(text="$").characters == {name: "$"}
        assert [font.glyph_names[gid] for gid in gs.layout(font, "$").gid] == [name]


@pytest.mark.parametrize(
    ("cmap", "text", "names"),
    [
        ({0x65: "e", 0xE9: "eacute"}, "e\u0301", ("eacute",)),
        ({0x65: "e", 0x301: "acute"}, "é", ("e", "acute")),
        ({0x65: "e", 0x301: "acute"}, "e\u0301", ("e", "acute")),
        ({0x65: "e", 0x301: "acute", 0xE9: "eacute"}, "e\u0301", ("eacute",)),
        ({0xEA: "ecircumflex", 0x301: "acute"}, "e\u0302\u0301", ("ecircumflex", "acute")),
        ({0xEA: "ecircumflex", 0x301: "acute"}, "ế", ("ecircumflex", "acute")),
        ({0x1100: "g", 0x1161: "a"}, "가", ("g", "a")),
        ({0xAC01: "gag"}, "\u1100\u1161\u11a8", ("gag",)),
        ({0xAC00: "ga", 0x11A8: "g"}, "각", ("ga", "g")),
        ({0xAC00: "ga", 0x11A8: "g"}, "가\u11a8", ("ga", "g")),
        ({0x1E61: "sdot", 0x323: "below"}, "s\u0307\u0323", ("sdot", "below")),
        ({0x4E00: "one"}, "\U0002f800", ()),
        ({0x4E3D: "li"}, "\U0002f800", ("li",)),
        ({0x20: "space"}, "\u00a0", ("space",)),
        ({0x3A9: "Omega"}, "\u2126", ("Omega",)),
    ],
    ids=str,
)
def test_composed_and_decomposed_text_is_the_same(
    cmap: dict[int, str], text: str, names: tuple[str, ...], tmp_path: Path
) -> None:
    font = font_of(tmp_path / "c.ttf", cmap)
    ufo = ufo_of(tmp_path / "c.ufo", cmap)
    for source in (font, ufo):
        found = source.select(text=text)
        assert found == names
        assert bool(found.missing) == (not names)
        assert dict(found.composed) == ({text: names} if len(names) > 1 else {})
        laid = gs.layout(source, text)
        assert tuple(source.glyph_names[gid] for gid in laid.gid if source.glyph_names[gid] != ".notdef") == names


def test_what_is_missing_of_a_composition_is_said_and_the_rest_is_drawn(tmp_path: Path) -> None:
    font = font_of(tmp_path / "p.ttf", {0x65: "e"})
    found = font.select(text="e\u0301")
    assert (found, found.missing) == (("e",), ("U+0301",))
    assert font.select(text="é").missing == ("U+00E9",)


def test_the_glyph_of_a_character_stays_where_the_font_takes_it_apart(tmp_path: Path) -> None:
    """Unless it is empty: then it only stands for its parts."""
    features = "feature ccmp { sub eacute by e acute; } ccmp;"
    cmap = {0x65: "e", 0xE9: "eacute", 0x301: "acute"}
    assert font_of(tmp_path / "f.ttf", cmap, features=features).select(text="é") == ("eacute",)
    assert font_of(tmp_path / "g.ttf", cmap, features=features, empty="eacute").select(text="é") == ("e", "acute")


def test_letters_stand_alone(tmp_path: Path) -> None:
    """Letters make no ligature; a character of several code points is shown as one, as emoji are."""
    features = """
    languagesystem DFLT dflt;
    feature liga { sub f i by f_i; } liga;
    feature ccmp { sub woman joiner laptop by coder; } ccmp;
    """
    cmap = {0x66: "f", 0x69: "i", 0x200D: "joiner", 0x1F469: "woman", 0x1F4BB: "laptop"}
    font = font_of(tmp_path / "l.ttf", cmap, "f_i", "coder", features=features)
    assert font.select(text="fi") == ("f", "i")
    assert font.select(text="\U0001f469\u200d\U0001f4bb") == ("coder",)
    assert font.select(text="\u200d") == ("joiner",)
    assert font.select(text="\u200b\u200e\ufeff").missing == ()  # nothing is seen of them


def test_text_is_cut_into_what_is_seen_as_one_character() -> None:
    assert clusters("ae\u0301\u0323b\n\u0301 \u0302") == ["a", "e\u0301\u0323", "b", "\u0301", " ", "\u0302"]
    assert clusters("\u0300\u0301\u0302") == ["\u0300", "\u0301", "\u0302"]  # a list of marks
    assert clusters("\u1100\u1161\u11a8가\u11a8\u1161") == ["\u1100\u1161\u11a8", "가\u11a8", "\u1161"]
    assert clusters("\u1112\u119e\u11ab\ua960\u1161\ud7cb") == ["\u1112\u119e\u11ab", "\ua960\u1161\ud7cb"]
    assert clusters("\u1100\u1101\u1161\u1162\u11a8") == ["\u1100", "\u1101\u1161", "\u1162", "\u11a8"]  # a list
    assert clusters("🇫🇷🇩🇪🇫") == ["🇫🇷", "🇩🇪", "🇫"]
    assert clusters("👍🏽1\ufe0f\u20e3葛\U000e0100") == ["👍🏽", "1\ufe0f\u20e3", "葛\U000e0100"]
    assert clusters("\u0915\u094d\u0937\u093f\u0924") == ["\u0915\u094d\u0937\u093f", "\u0924"]
    assert clusters("a\u2028b\r\n") == ["a", "b"]


@pytest.mark.parametrize(
    ("codes", "expected"),
    [
        ([0x2FD3, 0x9F8D], 0x9F8D),  # Kangxi
        ([0x2E81, 0x20086], 0x20086),
        ([0x9F8D, 0xF9C4], 0x9F8D),
        ([0xB5, 0x3BC], 0x3BC),
        ([0x2126, 0x3A9], 0x3A9),
        ([0xC5, 0x212B], 0xC5),
        ([0x1100, 0x3131, 0xFFA1], 0x3131),
        ([0x20, 0xA0], 0x20),
        ([0xD, 0x20], 0x20),
        ([0x628, 0xFE8F], 0x628),
        ([0xE000, 0x1D400], 0x1D400),
        ([0x2FD3], 0x2FD3),
        ([0xF041], 0xF041),
    ],
)
def test_a_glyph_is_called_by_the_character_that_people_write(codes: list[int], expected: int) -> None:
    assert unified(codes) == expected


def test_a_ufo_has_variations_in_its_lib(tmp_path: Path) -> None:
    lib = {"public.unicodeVariationSequences": {"E0100": {"845B": "katsu.old"}}}
    ufo = ufo_of(tmp_path / "v.ufo", {0x845B: "katsu"}, "katsu.old", lib=lib)
    assert ufo.select(text="葛\U000e0100") == ("katsu.old",)
    found = ufo.select(text="葛\U000e0101")
    assert (found, found.missing) == (("katsu",), ("U+845B U+E0101",))


def test_a_designspace_has_rules(tmp_path: Path) -> None:
    from fontTools.designspaceLib import AxisDescriptor, DesignSpaceDocument, RuleDescriptor, SourceDescriptor

    document = DesignSpaceDocument()
    # The rule is in the masters' space: 90 to 120 there is 700 to 900 in the user's.
    document.addAxis(AxisDescriptor(
        tag="wght", name="Weight", minimum=400, default=400, maximum=900, map=[(400, 20), (700, 90), (900, 120)],
    ))  # fmt: skip
    for name, place in (("thin", 20), ("thick", 120)):
        ufo_of(tmp_path / f"{name}.ufo", {0x24: "dollar"}, "dollar.heavy")
        document.addSource(SourceDescriptor(path=str(tmp_path / f"{name}.ufo"), location={"Weight": place}))
    where = [[{"name": "Weight", "minimum": 90, "maximum": 120}]]
    document.addRule(RuleDescriptor(name="heavy", conditionSets=where, subs=[("dollar", "dollar.heavy")]))
    document.write(tmp_path / "d.designspace")
    for location, name in (({}, "dollar"), ({"wght": 650}, "dollar"), ({"wght": 750}, "dollar.heavy")):
        source = gs.open_source(tmp_path / "d.designspace", location=location)
        assert source.select(text="$") == (name,)
        assert [source.glyph_names[gid] for gid in gs.layout(source, "$").gid] == [name]


def test_what_convert_draws_is_what_text_shows() -> None:
    """Of characters of a large font, one by one; below a mark alone, a text puts a dotted circle."""
    font = gs.open_font(DEJAVU)
    texts = [chr(code) for code in sorted(font.cmap)[::37]] + ["e\u0301", "q\u0301", "\u0627\u0655"]
    for text in texts:
        if not text.isprintable() or category(text[0])[0] == "M":
            continue
        names = font.select(text=text)
        assert names == tuple(font.glyph_names[gid] for gid in gs.layout(font, text).gid), ascii(text)
