"""Fonts checked, and compared with others, beside fontTools' reading of the same glyphs, in one run.

Times are of this process, without workers unless said, from opening a font to the last finding or difference, which is
looked at. The least of several rounds counts, as in :mod:`.batch`. Fonts that are not installed have no rows.
Memory is as in :mod:`.measure`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

import matplotlib

from .batch import FIRST, FONT, GLYPHS, least
from .measure import Row, in_words, run_watched

LATIN = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
OTHER_LATIN = Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")
"""Debian's release, other than the one that comes with matplotlib."""

BOLD = FONT.with_name(FONT.name.replace("Regular", "Bold"))
ANCHORED = Path("/usr/share/fonts/truetype/lxgw-wenkai/LXGWWenKai-Light.ttf")
"""A face of quadratics with flat contours in nine glyphs of ten."""

ROUNDS = 3


def rows() -> list[Row]:
    """The table of what a check or a comparison costs a glyph, and of a run over a whole face."""
    han = range(FIRST, FIRST + GLYPHS)
    cases = [
        ("check of DejaVu Sans, whole", LATIN, None, None, 1.0),
        (f"check of {GLYPHS} glyphs of {FONT.name}", FONT, None, han, 0.5),
        (f"check of {GLYPHS} glyphs of {ANCHORED.name}", ANCHORED, None, han, 0.5),
        (f"diff of {FONT.name} with itself, whole", FONT, FONT, None, 0.3),
        ("diff of two releases of DejaVu Sans, whole", OTHER_LATIN, LATIN, None, 2.0),
        (f"diff of {FONT.name} with {BOLD.name}, {GLYPHS} glyphs", FONT, BOLD, han, 2.0),
    ]
    found = [row(*case) for case in cases if all(path is None or path.exists() for path in case[1:3])]
    return found + (whole_face() if FONT.exists() else [])


def row(what: str, path: Path, other: Path | None, gids: Sequence[int] | None, must: float) -> Row:
    """Milliseconds a glyph of a check, or of a comparison with the other font; of some glyphs, or all."""
    few = range(200) if gids is None else gids[:200]
    checked(path, few) if other is None else compared(path, other, few)  # nothing is compiled while it is timed
    said: list[str] = []

    def ours(_: int) -> float:
        start = perf_counter()
        count, words = checked(path, gids) if other is None else compared(path, other, gids)
        said[:] = [words]
        return (perf_counter() - start) / count

    def theirs(_: int) -> float:
        start = perf_counter()
        count = sum(read_by_fonttools(each, gids) for each in filter(None, (path, other)))
        return (perf_counter() - start) / (count if other is None else count / 2)

    own, reading = least(ROUNDS, ours, theirs)
    fonts = "the font" if other is None else "both fonts"
    note = f"{said[0]}; fontTools reads {fonts} in {in_words(reading)} a glyph"
    return Row(what, own * 1e3, "ms a glyph", must, more=False, note=note)


def checked(path: Path, gids: Sequence[int] | None) -> tuple[int, str]:
    """Check glyphs; their number, and what was found in words."""
    from glyphspline.plugins.checks.job import check_font
    from glyphspline.readers import open_font

    font = open_font(path)
    names = font.glyph_names if gids is None else [font.glyph_names[gid] for gid in gids]
    glyphs = findings = failed = 0
    for result in check_font(font, names):
        glyphs, findings = glyphs + 1, findings + sum(finding.value is not None for finding in result.findings)
        failed += result.error is not None
    return glyphs, f"{findings} findings" + f", {failed} not read" * bool(failed)


def compared(old: Path, new: Path, gids: Sequence[int] | None) -> tuple[int, str]:
    """Compare glyphs; the number of pairs, and what was found in words."""
    from glyphspline.plugins.comparing.job import compare_fonts, pairs_of
    from glyphspline.readers import open_font

    fonts = open_font(old), open_font(new)
    chosen = None if gids is None else [fonts[0].glyph_names[gid] for gid in gids]
    found = compare_fonts(*fonts, pairs_of(*fonts, chosen, () if chosen else None), jobs=0)
    words = f"{found.identical} identical, {len(found.worst_first())} differ"
    return len(found.glyphs.pairs), words + f", {len(found.unread)} not read" * bool(found.unread)


def read_by_fonttools(path: Path, gids: Sequence[int] | None) -> int:
    """Read outlines as lists of operations, of a large font some of them; their number."""
    from fontTools.pens.recordingPen import DecomposingRecordingPen
    from fontTools.ttLib import TTFont

    font = TTFont(path, fontNumber=0, lazy=True)
    glyphs, order = font.getGlyphSet(), font.getGlyphOrder()
    names = order[:: 1 + len(order) // GLYPHS] if gids is None else [order[gid] for gid in gids]
    for name in names:
        glyphs[name].draw(DecomposingRecordingPen(glyphs))
    return len(names)


def whole_face() -> list[Row]:
    """The command over all glyphs of the CJK face with two workers: seconds and memory."""
    command = [sys.executable, "-m", "glyphspline", "check", str(FONT), "--jobs", "2", "--quiet"]
    run = run_watched(command)
    note = f"largest process {run.largest:.0f} MB"
    return [
        Row(f"check of {FONT.name}, whole, `--jobs 2`", run.seconds, "s", 30, more=False),
        Row("memory of the same, summed over its processes", run.total, "MB", 400, more=False, note=note),
    ]
