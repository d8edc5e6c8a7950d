"""Texts laid out: what HarfBuzz shapes, in runs, directions, lines and columns, each glyph fitted once."""

from __future__ import annotations

import lzma
import math
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any
from unicodedata import bidirectional

import numpy as np
import pytest
import uharfbuzz as hb
from fontTools.ttLib import TTFont

import glyphspline as gs
from glyphspline import OptionError
from glyphspline.plugins.text.bidi import ISOLATES, REMOVED, embedding_levels, visual_order
from glyphspline.plugins.text.paragraph import clusters
from glyphspline.plugins.text.placed import Layout
from glyphspline.plugins.text.scripts import scripts_of, upright_in_columns
from glyphspline.readers.characters import parsed_features
from tests.places import DEJAVU, ROOT
from tests.text_fonts import advance, text_font

SANS, AMIRI = "truetype/dejavu/DejaVuSans.ttf", "opentype/fonts-hosny-amiri/Amiri-Regular.ttf"
SERIF_CJK = "opentype/noto/NotoSerifCJK-Regular.ttc"

UNICODE = Path(__file__).with_name("unicode")
"""Files of the Unicode Character Database, compressed."""


@pytest.fixture(scope="module")
def font(tmp_path_factory: pytest.TempPathFactory) -> gs.Font:
    return gs.open_font(text_font(tmp_path_factory.mktemp("fonts") / "text.ttf"))


@pytest.fixture(scope="module")
def double(tmp_path_factory: pytest.TempPathFactory) -> gs.Font:
    """The same glyphs with an em of 2000."""
    return gs.open_font(text_font(tmp_path_factory.mktemp("fonts") / "double.ttf", em=2000, family="Double"))


def shaped(
    font: Any, runs: Sequence[tuple[str, str]], text: str, script: str | None = None, **features: Any
) -> tuple[list[int], list[int], Any]:
    """Glyphs, clusters and origins by uharfbuzz, called plainly on the file, of runs in visual order."""
    face = hb.Face(hb.Blob.from_file_path(str(font.path)))
    gids, found, origins, pen = list[int](), list[int](), [], np.zeros(2)
    for run, direction in runs:
        buffer = hb.Buffer()
        buffer.add_codepoints(list(map(ord, text)), text.index(run), len(run))
        buffer.guess_segment_properties()
        buffer.direction, buffer.script = direction, script or buffer.script or "Zyyy"
        buffer.language = features.get("language", buffer.language)
        hb.shape(hb.Font(face), buffer, {name: value for name, value in features.items() if name != "language"})
        for info, position in zip(buffer.glyph_infos, buffer.glyph_positions, strict=True):
            gids.append(info.codepoint)
            found.append(info.cluster)
            origins.append(np.add(pen, [position.x_offset, position.y_offset]))
            pen = np.add(pen, [position.x_advance, position.y_advance])
    return gids, found, np.array(origins)


def names(found: Layout) -> list[str]:
    return [found.fonts[k].glyph_names[gid] for k, gid in zip(found.font.tolist(), found.gid.tolist(), strict=True)]


# --- what HarfBuzz says


@pytest.mark.parametrize(
    ("text", "direction", "script", "expected"),
    [
        ("AVAVA", "ltr", "Latn", ["A", "V", "A", "V", "A"]),
        ("fiAf", "ltr", "Latn", ["f_i", "A", "f"]),
        ("a\u0301Aa", "ltr", "Latn", ["a", "acutecomb", "A", "a"]),
        ("\u0628\u0633\u0628", "rtl", "Arab", ["beh.fina", "seen.medi", "beh.init"]),
        ("\u300c\u3042", "ttb", "Kana", ["quoteleft.vert", "a-hira"]),
    ],
)
def test_a_run_is_what_harfbuzz_makes_of_it(
    font: gs.Font, text: str, direction: Any, script: str, expected: list[str]
) -> None:
    found = gs.layout(font, text, direction=direction)
    gids, clusters, origins = shaped(font, [(text, direction)], text, script)
    assert names(found) == expected
    assert found.gid.tolist() == gids
    assert found.cluster.tolist() == clusters
    np.testing.assert_array_equal(found.origin, origins)
    assert not found.angle.any()


@pytest.mark.parametrize(
    ("file", "text", "runs", "setting"),
    [
        (SANS, "AVATAR To. Type WAVE", "ltr", {}),
        (SANS, "office fluffy affliction", "ltr", {}),
        ("truetype/noto/NotoSerif-Regular.ttf", "Office 1/2 AVATAR", "ltr", {"features": "-kern,-liga,smcp"}),
        (SANS, "q\u0301\u0323 x\u0302 e\u0301", "ltr", {}),
        (AMIRI, "السلام عليكم ورحمة الله", "rtl", {}),
        (AMIRI, "بِسْمِ ٱللَّٰهِ ٱلرَّحْمَٰنِ", "rtl", {}),
        ("truetype/noto/NotoNastaliqUrdu-Regular.ttf", "یہ ایک مثال ہے", "rtl", {"language": "ur"}),
        ("truetype/noto/NotoSansHebrew-Regular.ttf", "שָׁלוֹם עֲלֵיכֶם", "rtl", {}),
        ("truetype/noto/NotoSansDevanagari-Regular.ttf", "क्षत्रिय हिन्दी र्कि श्रृंगार", "ltr", {}),
        (SERIF_CJK, "「縦書き」は、ー（テスト）。", "ttb", {"language": "ja", "direction": "ttb"}),
        (SERIF_CJK, "横書きの「テスト」です。", "ltr", {"language": "ja"}),
        (AMIRI, "abc سلام def", [("abc ", "ltr"), ("سلام", "rtl"), (" def", "ltr")], {}),
        (AMIRI, "سلام 123 عليكم", [(" عليكم", "rtl"), ("123", "ltr"), ("سلام ", "rtl")], {}),
        (SANS, "abc سلام 12", [("abc ", "ltr"), ("12", "ltr"), ("سلام ", "rtl")], {}),
    ],
)
def test_texts_in_installed_fonts_are_what_harfbuzz_makes_of_their_runs(
    file: str, text: str, runs: Any, setting: dict[str, Any]
) -> None:
    """Runs are written in visual order, by hand, with their direction."""
    if not (path := Path("/usr/share/fonts", file)).exists():
        pytest.skip(f"{path.name} is not installed")
    found = gs.layout(gs.open_font(path), text, **setting)
    given: dict[str, Any] = {one.tag: bool(one.value) for one in parsed_features(setting.get("features", ""))}
    given |= {name: value for name, value in setting.items() if name == "language"}
    in_order = [(text, runs)] if isinstance(runs, str) else runs
    gids, clusters, origins = shaped(found.fonts[0], in_order, text, **given)
    assert not found.missing
    assert found.gid.tolist() == gids
    assert found.cluster.tolist() == clusters
    np.testing.assert_allclose(found.origin, origins, atol=1e-9)


def test_kerning_and_features(font: gs.Font) -> None:
    apart = gs.layout(font, "AV", features="-kern").origin[1, 0]
    assert apart == advance("A")
    assert gs.layout(font, "AV").origin[1, 0] == apart - 80
    assert names(gs.layout(font, "fi", features="-liga")) == ["f", "i"]
    assert names(gs.layout(font, "fi", features=" liga=0 ")) == ["f", "i"]
    assert names(gs.layout(font, "aaa", features="smcp[1:2]")) == ["a", "A", "a"]
    assert names(gs.layout(font, "aaa\naaa", features="smcp[5]")) == ["a", "a", "a", "a", "A", "a"]
    assert names(gs.layout(font, "aaa", features="smcp[1:]=on")) == ["a", "A", "A"]


def test_letters_join_over_a_change_of_font(font: gs.Font, tmp_path: Path) -> None:
    """Each run is shaped with the text around it as its context."""
    without = gs.open_font(text_font(tmp_path / "without.ttf", without="\u0633"))
    found = gs.layout(without, "\u0628\u0633\u0628", fallbacks=[font])
    assert names(found) == ["beh.fina", "seen.medi", "beh.init"]
    assert found.font.tolist() == [0, 1, 0]


def test_what_is_missing_is_what_harfbuzz_draws_as_notdef(font: gs.Font) -> None:
    """Hangul fillers and annotation marks are default ignorables to Unicode, and not to HarfBuzz."""
    found = gs.layout(font, "A\u115f\u200b\ufff9\u2003\u0301\u00e1")
    assert found.missing == ("\u115f", "\ufff9")
    assert [found.text[k] for k in found.cluster[found.gid == 0].tolist()] == ["\u115f", "\ufff9"]


def test_the_face_is_opened_once(font: gs.Font, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hb, "Face", None)
    monkeypatch.setattr(hb, "Blob", None)
    assert len(gs.layout(font, "AVfi")) == 3


def test_a_variable_font_is_shaped_at_its_location() -> None:
    path = ROOT / "fonts_test" / "variable.ttf"
    axis = gs.open_font(path).axes[0]
    text = "".join(map(chr, sorted(gs.open_font(path).cmap)))[:3]
    ends = [gs.layout(gs.open_font(path, location={axis.tag: v}), text) for v in (axis.minimum, axis.maximum)]
    for found in ends:
        expected = [outline.advance for outline in found.fonts[0].outlines(found.gid.tolist())]
        assert found.advance.tolist() == pytest.approx(expected, abs=0.51)  # HarfBuzz's are whole units
    assert ends[0].advance.tolist() != ends[1].advance.tolist()


# --- directions


def test_mixed_directions(font: gs.Font) -> None:
    hebrew = "\u05d0\u05d1"
    found = gs.layout(font, f"a {hebrew} 12 (A)")
    assert found.cluster.tolist() == [0, 1, 5, 6, 4, 3, 2, 7, 8, 9, 10]
    assert found.origin[0].tolist() == [0, 0]
    assert bool((np.diff(found.origin[:, 0]) > 0).all())
    found = gs.layout(font, f"a {hebrew} 12 (A)", direction="rtl")
    assert found.cluster.tolist() == [10, 9, 8, 7, 5, 6, 4, 3, 2, 1, 0]
    assert names(found)[0] == "parenleft"  # mirrored


@pytest.mark.parametrize(
    ("text", "base", "levels"),
    [
        ("abc", None, "000"),
        ("\u05d0\u05d1c", None, "112"),
        ("a\u05d0 1", None, "0112"),
        ("a (\u05d0) b", 0, "0001000"),
        ("\u05d0(a)\u05d0", None, "11211"),
        ("\u05d0[1]", None, "1121"),
        ("\u0627 1-2", None, "11212"),
        ("a\u2067b\u2069c", None, "00200"),
        ("\u202eab\u202cc", None, "01110"),
        ("\u0661,\u0662", None, "222"),
    ],
)
def test_embedding_levels(text: str, base: int | None, levels: str) -> None:
    found = embedding_levels(text, base)[1]
    assert "".join(map(str, found)) == levels


def lines_of(name: str) -> list[str]:
    """The lines of a file of Unicode's, without comments."""
    text = lzma.decompress((UNICODE / f"{name}.txt.xz").read_bytes()).decode()
    return [line for line in text.splitlines() if line and line[0] != "#"]


def of_a_line(text: str, levels: list[int], base: int) -> list[int]:
    """Rule L1, which moves nothing that is drawn: separators, and spaces before them and at the end, at ``base``."""
    found, space = list(levels), True
    for i in range(len(text) - 1, -1, -1):
        kind = bidirectional(text[i])
        space = kind in ("S", "B") or (space and kind in ISOLATES | REMOVED | {"WS", "PDI"})
        if space:
            found[i] = base
    return found


@pytest.mark.parametrize("step", [16, pytest.param(1, marks=pytest.mark.long)])
def test_levels_and_order_conform_to_unicode(step: int) -> None:
    cases = lines_of("BidiCharacterTest")
    assert len(cases) == 91_707
    for line in cases[::step]:
        codes, direction, level, levels, order = line.split(";")
        text = "".join(chr(int(code, 16)) for code in codes.split())
        base, found = embedding_levels(text, {"0": 0, "1": 1, "2": None}[direction])
        found, expected = of_a_line(text, found, base), levels.split()
        assert base == int(level), line
        assert all(want in ("x", str(value)) for want, value in zip(expected, found, strict=True)), line
        seen = [i for i in visual_order(found) if expected[i] != "x"]
        assert seen == [int(i) for i in order.split()], line


def test_scripts_of_neighbours() -> None:
    assert scripts_of("a (b)!") == ["Latn"] * 6
    assert scripts_of("1, 2") == ["Zyyy"] * 4
    assert scripts_of("a (\u03b1) b") == ["Latn"] * 3 + ["Grek", "Latn", "Latn", "Latn"]
    assert scripts_of("a «\u0628»\u0628") == ["Latn"] * 3 + ["Arab", "Latn", "Arab"]
    assert scripts_of("\u6f22\u30fc\u30ab") == ["Hani", "Kana", "Kana"]
    assert scripts_of("a\u0301\u03b1") == ["Latn", "Latn", "Grek"]


@pytest.mark.parametrize(("most", "least"), [(100, 10_000), pytest.param(1 << 21, 280_000, marks=pytest.mark.long)])
def test_characters_stand_in_columns_as_unicode_says(most: int, least: int) -> None:
    """So many characters from both ends of each line of the standard's table."""
    from unicodedata import category

    checked = 0
    for line in lines_of("VerticalOrientation"):
        codes, value = (part.strip() for part in line.split("#")[0].split(";"))
        first, _, last = codes.partition("..")
        span = [chr(code) for code in range(int(first, 16), int(last or first, 16) + 1)]
        both = span[:most] + span[max(most, len(span) - most) :]
        text = "".join(character for character in both if category(character) not in ("Cn", "Cs"))
        assert set(upright_in_columns(text, range(len(text) + 1))) <= {value != "R"}, line
        checked += len(text)
    assert checked > least


# --- several fonts


def test_fallbacks_are_scaled_to_the_first_font(font: gs.Font, double: gs.Font, tmp_path: Path) -> None:
    without = gs.open_font(text_font(tmp_path / "without.ttf", without="a\u0301"))
    found = gs.layout(without, "AaA", fallbacks=[double, font])
    assert found.font.tolist() == [0, 1, 0]
    assert found.scale is not None
    assert found.scale.tolist() == [1.0, 0.5, 1.0]
    np.testing.assert_array_equal(found.origin, gs.layout(font, "AaA").origin)
    assert found.missing == ()
    same, other = gs.layout(font, "AaA").outline(), found.outline()
    np.testing.assert_array_equal(same.arrays.points, other.arrays.points)


def test_a_cluster_is_of_one_font(font: gs.Font, tmp_path: Path) -> None:
    without = gs.open_font(text_font(tmp_path / "without.ttf", without="\u0301"))
    found = gs.layout(without, "aa\u0301", fallbacks=[font])
    assert found.font.tolist() == [0, 1, 1]
    alone = gs.layout(without, "aa\u0301")
    assert alone.missing == ("\u0301",)
    assert names(alone)[-1] == ".notdef"


def test_what_no_font_has_is_listed_once(font: gs.Font, double: gs.Font) -> None:
    found = gs.layout(font, "aXYXa\u200d\u00a0", fallbacks=[double])
    assert found.missing == ("X", "Y")
    assert names(found)[1:4] == [".notdef"] * 3
    assert "2 characters without a glyph" in repr(found)


# --- lines


def words(found: Layout) -> list[str]:
    """The characters of each line at which clusters of glyphs begin."""
    lines: list[list[int]] = [[] for _ in range(int(found.line.max()) + 1)]
    for cluster, line in zip(found.cluster.tolist(), found.line.tolist(), strict=True):
        lines[line].append(cluster)
    return ["".join(found.text[i] for i in sorted(set(line))) for line in lines]


def test_new_lines_begin_lines(font: gs.Font) -> None:
    found = gs.layout(font, "A\n\nVV\r\na\u2028i\n")
    assert found.line.tolist() == [0, 2, 2, 3, 4]
    assert found.origin[:, 1].tolist() == [0, -2200, -2200, -3300, -4400]
    assert found.origin[:, 0].tolist() == [0, 0, advance("V"), 0, 0]
    assert found.box == (0.0, -4600.0, 2.0 * advance("V"), 800.0)
    closer = gs.layout(font, "A\nV", line_height=500)
    assert closer.origin[:, 1].tolist() == [0, -500]


def test_lines_are_as_long_as_they_may_be(font: gs.Font) -> None:
    text = "aa aaaaa a  aa-aa aaa"
    width = 5.4 * advance("a")
    found = gs.layout(font, text, width=width)
    assert words(found) == ["aa", "aaaaa", "a  aa-", "aa", "aaa"]
    assert found.box[2] == width
    for k, line in enumerate(words(found)):
        here = found.line == k
        assert float(found.advance[here].sum()) == sum(advance({" ": "space", "-": "hyphen"}.get(c, c)) for c in line)
        assert found.origin[here][0, 0] == 0
    one = gs.layout(font, text, width=100 * advance("a"))
    assert words(one) == [text]


def test_a_long_word_is_broken_between_grapheme_clusters(font: gs.Font) -> None:
    found = gs.layout(font, "a\u0301" * 7, width=3.5 * advance("a"))
    assert words(found) == ["aaa", "aaa", "a"]
    narrow = gs.layout(font, "Va", width=1)
    assert words(narrow) == ["V", "a"]
    assert narrow.box[2] == max(advance("V"), advance("a"))


def test_a_cut_ligature_is_shaped_again(font: gs.Font) -> None:
    found = gs.layout(font, "fifi", width=advance("f_i") + 10)
    assert names(found) == ["f_i", "f_i"]
    found = gs.layout(font, "fifi", width=advance("f") + 10)
    assert names(found) == ["f", "i", "f", "i"]
    assert found.line.tolist() == [0, 1, 2, 3]


def test_kerning_over_a_break_is_undone(font: gs.Font) -> None:
    found = gs.layout(font, "AVAV", width=2 * advance("V"))
    assert words(found) == ["AV", "AV"]
    assert found.origin[:, 0].tolist() == [0, advance("A") - 80] * 2


def test_letters_of_a_broken_word_stay_joined(font: gs.Font) -> None:
    found = gs.layout(font, "\u0628" * 4, width=2.2 * advance("beh.medi"))
    assert [names(found)[i] for i in np.argsort(found.cluster)] == ["beh.init", "beh.medi", "beh.medi", "beh.fina"]
    assert found.line.max() == 1


def test_a_soft_hyphen_shows_where_a_line_ends(font: gs.Font) -> None:
    text = "aaa\u00adaaa"
    whole = gs.layout(font, text)
    assert "hyphen" not in names(whole)
    width = 3 * advance("a") + advance("hyphen")
    found = gs.layout(font, text, width=width)
    assert names(found) == ["a"] * 3 + ["hyphen"] + ["a"] * 3
    assert found.advance[:4].sum() == width
    assert words(gs.layout(font, "a aa\u00adaa", width=2 * advance("a") + advance("space") + advance("a")))[0] == "a"


@pytest.mark.parametrize("text", ["aa aa", "\u05d0\u05d0 \u05d0\u05d0"])
def test_alignment(font: gs.Font, text: str) -> None:
    width = 3000.0
    letter = advance("a" if text[0] == "a" else "alef-hb")
    length = 4 * letter + advance("space")
    room = width - length
    backward = text[0] != "a"
    lefts = {"start": room * backward, "center": room / 2, "end": room * (not backward), "justify": room * backward}
    for align, left in lefts.items():
        found = gs.layout(font, text, width=width, align=align)  # type: ignore[arg-type]
        assert found.origin[0, 0] == left
        assert found.box[0::2] == (0.0, width)


@pytest.mark.parametrize(("text", "direction"), [("aaa", None), ("\u05d0\u05d0\u05d0", None), ("\u300c\u300c", "ttb")])
def test_letters_are_spaced_but_not_the_ends_of_lines(font: gs.Font, text: str, direction: Any) -> None:
    plain, spaced = (gs.layout(font, text, direction=direction, letter_spacing=space) for space in (0.0, 100.0))
    shift = (spaced.origin - plain.origin) @ ([0, -1] if direction else [1, 0])
    assert shift.tolist() == [100.0 * k for k in range(len(text))]
    side = 3 if direction else 2
    size = [found.box[side] - found.box[side - 2] for found in (plain, spaced)]
    assert size[1] - size[0] == 100 * (len(text) - 1)


def test_spaced_letters_keep_their_marks_and_are_no_ligatures(font: gs.Font) -> None:
    plain, spaced = (gs.layout(font, "a\u0301a", letter_spacing=space) for space in (0.0, 100.0))
    assert (spaced.origin - plain.origin)[:, 0].tolist() == [0.0, 0.0, 100.0]
    assert names(gs.layout(font, "fi")) == ["f_i"]
    assert names(gs.layout(font, "fi", letter_spacing=50)) == ["f", "i"]
    assert names(gs.layout(font, "fi", letter_spacing=50, features="liga")) == ["f_i"]
    wide = 2 * advance("a") + 100
    assert words(gs.layout(font, "aaaa", width=wide, letter_spacing=100)) == ["aa", "aa"]
    assert gs.layout(font, "a", letter_spacing=-50).box[2] == advance("a")


def test_justified_lines_fill_the_width_but_the_last(font: gs.Font) -> None:
    width = 5 * advance("a") + 2 * advance("space")
    found = gs.layout(font, "aa aa aa a aa aa", width=width, align="justify")
    lengths = [float(found.advance[found.line == k].sum()) for k in range(int(found.line.max()) + 1)]
    assert lengths[:-1] == pytest.approx([width] * (len(lengths) - 1))
    assert lengths[-1] < width
    for k in range(len(lengths)):
        here = found.line == k
        ends = np.cumsum(found.advance[here])
        np.testing.assert_allclose(found.origin[here][1:, 0], ends[:-1], atol=1e-9)


def test_lines_of_both_directions_break_in_reading_order(font: gs.Font) -> None:
    text = "\u05d0\u05d0 aa \u05d1\u05d1"
    found = gs.layout(font, text, width=2 * advance("alef-hb") + advance("space") + 2 * advance("a"))
    assert words(found) == ["\u05d0\u05d0 aa", "\u05d1\u05d1"]
    assert found.cluster[found.line == 0].tolist() == [3, 4, 2, 1, 0]


@pytest.mark.parametrize("seed", range(4))
def test_odd_texts_are_laid_out_in_order(font: gs.Font, double: gs.Font, seed: int) -> None:
    """Whatever the text and the width, lines follow each other and none is longer than the box."""
    random = Random(seed)
    pool = "aVfi \u0301\u05d0\u0628\u0633(1)\u00ad-\u200d\u2067\u202e\u2069"
    pool += "\u3042\u300c\t\n\u0e20\u2122\U0001f467\U0001f3fd\U0001f1e9"
    for _ in range(150):
        text = "".join(random.choices(pool, k=random.randint(1, 40)))
        direction: Any = random.choice([None, "ltr", "rtl", "ttb", "btt"])
        align: Any = random.choice(["start", "center", "end", "justify"])
        width = random.choice([None, random.uniform(1, 9000)])
        found = gs.layout(font, text, fallbacks=[double], direction=direction, align=align, width=width)
        lines = [found.line == k for k in np.unique(found.line)]
        assert bool((np.diff(found.line) >= 0).all())
        for before, after in pairwise(lines):
            assert found.cluster[before].max() < found.cluster[after].min()
        length = -found.box[1] if direction in ("ttb", "btt") else found.box[2]
        for line in lines:
            wide = np.searchsorted(clusters(text), found.cluster[line & (found.advance > 0)], side="right")
            alone = len(np.unique(wide)) <= 1  # one grapheme cluster, which is never broken
            assert found.advance[line].sum() <= (length if width is None or alone else width) + 1e-3


# --- columns


def test_columns_run_from_right_to_left(font: gs.Font) -> None:
    found = gs.layout(font, "\u3042\u3042\u3042", direction="ttb", width=2000)
    assert found.line.tolist() == [0, 0, 1]
    np.testing.assert_array_equal(found.origin[:, 0], [-500, -500, -1500])
    assert (found.origin[0] - found.origin[1]).tolist() == [0, 1000]
    assert found.box == (-1500.0, -2000.0, 500.0, 0.0)
    assert found.advance.tolist() == [1000.0] * 3


def test_latin_is_turned_in_columns(font: gs.Font) -> None:
    found = gs.layout(font, "\u3042AV\u3042", direction="ttb")
    assert found.angle.tolist() == [0.0, -math.pi / 2, -math.pi / 2, 0.0]
    middle = (800 - 200) / 2
    assert found.origin[1].tolist() == [-middle, -1000.0]
    assert found.origin[2].tolist() == [-middle, -1000.0 - advance("A") + 80]
    upright = gs.layout(font, "\u3042AV\u3042", direction="ttb", orientation="upright")
    assert not upright.angle.any()
    np.testing.assert_array_equal(
        upright.origin, shaped(font, [("\u3042AV\u3042", "ttb")], "\u3042AV\u3042", "Kana")[2]
    )


def test_bottom_to_top(font: gs.Font) -> None:
    found = gs.layout(font, "aVA", direction="btt")
    gids, _, origins = shaped(font, [("aVA", "btt")], "aVA", "Latn")
    assert found.gid.tolist() == gids
    assert names(found) == ["A", "V", "a"]
    np.testing.assert_array_equal(found.origin, origins)


# --- outlines and results


def test_each_glyph_stands_in_its_place(font: gs.Font) -> None:
    found = gs.layout(font, "Aa A\nV")
    assert found.distinct() == sorted({(0, gid) for gid in found.gid.tolist()})
    outline = found.outline()
    contours = [found.fonts[0].outline(name).contours[0].points for name in names(found) if name != "space"]
    origins = [origin for origin, name in zip(found.origin, names(found), strict=True) if name != "space"]
    for contour, points, origin in zip(outline.contours, contours, origins, strict=True):
        np.testing.assert_array_equal(contour.points, points + origin)
    assert (outline.name, outline.advance) == ("text", found.box[2])


def test_a_quarter_turn_is_exact(font: gs.Font) -> None:
    found = gs.layout(font, "A", direction="ttb")
    x, y = font.outline("A").contours[0].points.T
    expected = np.stack([y, -x], axis=1) + found.origin[0]
    np.testing.assert_array_equal(found.outline().contours[0].points, expected)


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
@pytest.mark.parametrize("direction", ["ltr", "ttb"])
def test_results_are_those_of_the_glyphs_moved(corners: Any, direction: Any) -> None:
    source = gs.open_font(ROOT / "fonts_test" / "kouzan-gyosho.ttf")
    options = gs.Options(corners=corners)
    found = gs.layout(source, "gOg", direction=direction)
    whole = found.convert(options)
    alone = {name: gs.convert(source.outline(name), options) for name in ("g", "O")}
    assert [len(alone[name].contours) for name in names(found)] == [4, 2, 4]
    pairs = [(k, contour) for k, name in enumerate(names(found)) for contour in alone[name].contours]
    assert len(whole.contours) == len(pairs) == 10
    for contour, (k, own) in zip(whole.contours, pairs, strict=True):
        turn = np.exp(1j * found.angle[k])

        def moved(points: Any, k: int = k, turn: Any = turn) -> Any:
            turned = (points[..., 0] + 1j * points[..., 1]) * turn
            return np.stack([turned.real, turned.imag], axis=-1) + found.origin[k]

        np.testing.assert_allclose(contour.source.points, moved(own.source.points), rtol=0, atol=1e-8)
        np.testing.assert_allclose(contour.polygon, moved(own.polygon), rtol=0, atol=1e-8)
        np.testing.assert_allclose(contour.curve.points, moved(own.curve.points), rtol=0, atol=1e-8)
        assert contour.measures == own.measures
        assert len(contour.interpolations) == len(own.interpolations)
        for arc, before in zip(contour.interpolations, own.interpolations, strict=True):
            np.testing.assert_allclose(
                arc.spline.control_points, moved(before.spline.control_points), rtol=0, atol=1e-8
            )
            np.testing.assert_array_equal(arc.spline.knots, before.spline.knots)
            np.testing.assert_allclose(arc.spline.to_bezier(), moved(before.spline.to_bezier()), rtol=0, atol=1e-8)
    assert gs.to_svg(whole).count("<path") == gs.to_svg(alone["g"]).count("<path")


def test_each_glyph_is_fitted_once(font: gs.Font, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[str] = []

    def recorded(outlines: list[gs.Outline], *arguments: Any, **named: Any) -> Any:
        given.extend(outline.name for outline in outlines)
        return gs.convert_many(outlines, *arguments, **named)

    monkeypatch.setattr(sys.modules[Layout.__module__], "convert_many", recorded)
    result = gs.layout(font, "AVA VAV").convert(gs.Options(corners="sharp"))
    assert sorted(given) == ["A", "V", "space"]
    assert len(result.contours) == 6


def test_rounding_after_a_motion_is_set_aside(font: gs.Font) -> None:
    """Half a hundredth of a unit is no whole unit of the last digit: the bound grows by what rounding may add."""
    options = gs.Options(corners="sharp")
    plain = gs.layout(font, "A").convert(options)
    shifted = gs.layout(font, "A", width=advance("A") + 0.01, align="center").convert(options)
    assert shifted.outline.contours[0].points[0, 0] == pytest.approx(plain.outline.contours[0].points[0, 0] + 0.005)
    before, after = (result.contours[0].measures.deviation_bound for result in (plain, shifted))
    assert before is not None
    assert after is not None
    assert after >= before + math.sqrt(2) * 0.01 - 1e-9
    assert shifted.contours[0].measures.within_tolerance is True


def test_glyphs_that_touch_are_united(font: gs.Font) -> None:
    """Kerned by hand into each other: the union of two boxes, wherever the pair stands, fitted once."""
    pytest.importorskip("pathops")
    found = gs.layout(font, "AV AV V")
    options = gs.Options(corners="sharp", remove_overlaps=True)
    assert len(found.convert(options).contours) == 5  # 80 units of kerning: the squares have 50 at their sides
    closer = replace(found, origin=found.origin - np.outer(np.isin(found.cluster, [1, 4]), [120.0, 0.0]))
    result = closer.convert(options)
    assert len(result.contours) == 3
    first, second = (contour.curve.points for contour in result.contours[:2])
    np.testing.assert_allclose(second - first, np.broadcast_to(closer.origin[3] - closer.origin[0], first.shape))
    assert len(closer.convert(gs.Options(corners="sharp")).contours) == 5


def test_results_of_distinct_glyphs(font: gs.Font) -> None:
    found = gs.layout(font, "AVA V")
    results = found.results(gs.Options(corners="sharp"))
    assert [result.outline.gid for result in results] == [gid for _, gid in found.distinct()]
    assert [results[k].outline.name for k in found.which.tolist()] == names(found)
    np.testing.assert_array_equal(results[1].contours[0].source.points, font.outline("A").contours[0].points)


def test_options_that_suit_no_glyph_are_an_error(font: gs.Font, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pathops", None)
    with pytest.raises(gs.GlyphsplineError, match="overlaps"):
        gs.layout(font, "AV").convert(gs.Options(remove_overlaps=True))


def test_a_text_of_spaces_has_no_contours(font: gs.Font) -> None:
    result = gs.layout(font, "  \n ").convert()
    assert len(result.contours) == 0
    assert gs.to_svg(result).startswith("<svg")
    assert len(gs.layout(font, "\n\n")) == 0


def test_a_broken_glyph_costs_only_itself(font: gs.Font, tmp_path: Path) -> None:
    tables = TTFont(font.path)
    data = bytearray(tables.getTableData("glyf"))
    start = tables["loca"][tables.getGlyphID("V")]
    tables.close()
    broken = bytearray(font.path.read_bytes())
    at = broken.find(bytes(data[start : start + 12]))
    broken[at : at + 2] = b"\x7f\xff"  # so many contours
    path = tmp_path / "broken.ttf"
    path.write_bytes(broken)
    found = gs.layout(gs.open_font(path), "AVA")
    result = found.convert(gs.Options(corners="sharp"))
    assert len(result.contours) == 2
    assert any("left out" in note and "'V'" in note for note in result.notes), result.notes
    outline = found.outline()
    assert len(outline.contours) == 2
    assert any("left out" in note and "'V'" in note for note in outline.notes), outline.notes
    assert [len(glyph.contours) for glyph in found.results(gs.Options(corners="sharp"))] == [1, 0]


# --- sources without tables for shaping


def test_a_ufo_is_set_character_by_character(tmp_path: Path) -> None:
    from fontTools.ufoLib import UFOWriter

    class Glyph:
        def __init__(self, width: int, code: int) -> None:
            self.width, self.unicodes = width, [code]

    writer = UFOWriter(tmp_path / "drawn.ufo")
    glyphs = writer.getGlyphSet()
    for name, width, code in (("A", 500, 65), ("V", 450, 86), ("space", 200, 32)):
        glyphs.writeGlyph(name, Glyph(width, code), lambda pen: None)
    glyphs.writeContents()
    writer.writeLayerContents(["public.default"])
    source = gs.open_source(tmp_path / "drawn.ufo")
    found = gs.layout(source, "AVX\u00a0A")
    assert names(found) == ["A", "V", "space", "A"]  # no .notdef to stand for the X
    assert found.origin[:, 0].tolist() == [0, 500, 950, 1150]
    assert found.missing == ("X",)
    assert "not shaped" in found.notes[0]
    assert words(gs.layout(source, "AV AV", width=1000)) == ["AV", "AV"]
    for arguments in ({"direction": "ttb"}, {"features": "kern"}):
        with pytest.raises(OptionError, match="needs a font file"):
            gs.layout(source, "A", **arguments)  # type: ignore[arg-type]


# --- what cannot be


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        ("", {}, "at least one character"),
        ("a" * 1_000_001, {}, "1,000,001 characters, more than 1,000,000"),
        ("a\x07", {}, r"control character, U\+0007, as character 1"),
        ("a\ud83d", {}, r"half of a surrogate pair, U\+D83D, as character 1"),
        (b"a", {}, "text is a string"),
        ("a", {"features": "lig"}, "not a feature: 'lig'"),
        ("a", {"features": "liga=x"}, "not a feature: 'liga=x'"),
        ("a", {"features": "-liga=1"}, "not a feature"),
        ("a", {"features": ["liga"]}, "features are a string"),
        ("a", {"features": "ss01"}, "no feature 'ss01'; it has .*kern, liga, .*smcp"),
        ("a", {"features": "liga,-onum"}, "no feature 'onum'"),
        ("a", {"script": "Lation"}, "script is a code of ISO 15924.*'Lation'"),
        ("a", {"script": "Qqqq"}, "'Qqqq'"),
        ("a", {"language": "not a language"}, "language is a tag of BCP 47"),
        ("a", {"language": ""}, "language is a tag"),
        ("a", {"direction": "up"}, "direction is 'ltr' or .*, not 'up'"),
        ("a", {"width": -1}, "width is a positive length in font units, not -1"),
        ("a", {"width": float("nan")}, "not nan"),
        ("a", {"width": float("inf")}, "not inf"),
        ("a", {"width": True}, "not True"),
        ("a", {"line_height": 0}, "line_height is a positive"),
        ("a", {"align": "left"}, "align is 'start'"),
        ("a", {"orientation": "sideways"}, "orientation is 'mixed' or 'upright'"),
        ("a", {"fallbacks": ["x.ttf"]}, "a font is a source"),
    ],
)
def test_errors_say_what_is_wrong(font: gs.Font, text: Any, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        gs.layout(font, text, **arguments)


def test_what_is_allowed(font: gs.Font) -> None:
    assert names(gs.layout(font, "a\ta")) == ["a", "space", "a"]
    assert len(gs.layout(font, "a", script="latn", language="zh-Hant")) == 1
    assert len(gs.layout(font, "a", features=" , liga ,")) == 1


def test_a_feature_of_any_of_the_fonts_is_known(font: gs.Font) -> None:
    plain = gs.open_font(ROOT / "fonts_test" / "edge-cases.ttf")
    with pytest.raises(OptionError, match="no feature 'smcp'"):
        gs.layout(plain, "a", features="smcp")
    assert len(gs.layout(plain, "a", features="smcp", fallbacks=[font])) == 1


def test_many_characters_are_shaped_in_parts(font: gs.Font) -> None:
    text = "AV a " * 9_000
    found = gs.layout(font, text)
    gids, _, origins = shaped(font, [(text, "ltr")], text, "Latn")
    assert found.gid.tolist() == gids
    np.testing.assert_array_equal(found.origin, origins)


def test_layout_is_a_function_whatever_was_imported() -> None:
    code = "import glyphspline.plugins.text.placed as placed, glyphspline as gs; placed.NAME; gs.layout.__kwdefaults__"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_heights_are_those_drawn_or_else_those_of_the_table(tmp_path: Path) -> None:
    file = text_font(tmp_path / "text.ttf")
    tables = TTFont(file)
    assert gs.open_font(file).cap_height is None
    os2 = tables["OS/2"]
    os2.version, os2.sCapHeight, os2.sxHeight = 4, 700, 480
    os2.usDefaultChar = os2.usBreakChar = os2.usMaxContext = 0
    tables.save(file)
    font = gs.open_font(file)
    assert (font.cap_height, font.x_height) == (700.0, 480.0), "the font has neither H nor x"
    drawn = gs.open_font(DEJAVU)
    assert (drawn.cap_height, drawn.x_height) == (1493.0, 1120.0)
