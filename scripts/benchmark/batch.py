"""Whole fonts: interpolated SVG, and outlines as they are, beside plain export by others, in one run.

Nothing is removed before all is measured: ext4 without a journal looks, for each new file, through the inodes that were
freed within the last minutes, and what came after a removal of ten thousand files would seem several times as slow.
The least of several rounds counts: on a virtual machine a run pays for pages of memory that the host has to provide, or
does not, as it comes.

The font is Noto Sans CJK Regular (Debian's fonts-noto-cjk); ``GLYPHSPLINE_BENCH_FONT`` names another with as many Han
glyphs, ``GLYPHSPLINE_BENCH_GLYPHS`` another number of them. Exports by others write the path and nothing more. Each
export is by one process, from opening the font on; ours has one worker, and writes a manifest. FontForge takes many
seconds to open such a font, so its export is timed alone, too.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from time import perf_counter

from .measure import Row, in_words

FONT = Path(os.environ.get("GLYPHSPLINE_BENCH_FONT", "/usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc"))
GLYPHS = int(os.environ.get("GLYPHSPLINE_BENCH_GLYPHS", "10000"))
FIRST = 10_000
"""The first glyph index taken; Noto Sans CJK has Han glyphs there."""

FONTFORGE = """
import sys, time, fontforge
font = fontforge.open(sys.argv[1])
parts = []
for k in range(max(1, font.cidsubfontcnt)):  # Han glyphs are in the largest part of a font by CID
    if font.cidsubfontcnt:
        font.cidsubfont = k
    parts.append([glyph for glyph in font.glyphs() if len(glyph.foreground)])
largest = max(parts, key=len)
glyphs = largest[len(largest) // 2:][:int(sys.argv[3])]
start = time.perf_counter()
for k, glyph in enumerate(glyphs):
    glyph.export(sys.argv[2] + "/" + str(k) + ".svg")
print((time.perf_counter() - start) / len(glyphs))
"""


def rows() -> list[Row]:
    """The table of what a run over a font costs a glyph."""
    if not FONT.exists():
        return [Row(f"whole fonts: {FONT.name} is not there", 0.0, "s")]
    from glyphspline.fitting.options import Options

    step = Options(step=20.0)
    close = Options(tolerance=1.0, corners="smooth"), Options(tolerance=1.0)
    many = range(FIRST, FIRST + GLYPHS)
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        for k, options in enumerate((step, *close)):  # nothing is compiled while it is timed
            ours(here / f"warm-{k}", many[:50], options, ("svg", "curvature"), 1)
        source, stepped, two, bare = least(
            6,
            lambda k: fonttools_export(here / f"plain-{k}", many),
            lambda k: ours(here / f"one-{k}", many, step, ("svg",), 1),
            lambda k: ours(here / f"two-{k}", many, step, ("svg",), 2),
            lambda k: floor(here / f"floor-{k}", many),
        )
        resumed = ours(here / "one-0", many, step, ("svg",), 1) * len(many)
        mapped, certified, sharp = least(
            3,
            lambda k: ours(here / f"maps-{k}", many, step, ("svg", "curvature"), 1),
            lambda k: ours(here / f"close-{k}", many, close[0], ("svg",), 1),
            lambda k: ours(here / f"sharp-{k}", many, close[1], ("svg",), 1),
        )
        (forge,) = least(3, lambda k: fontforge_export(here / f"forge-{k}", many))
    return [
        row("`--step 20`, one worker, against fontTools' export of the source", stepped, source, 1.5, 1.0),
        row("`--corners smooth --tolerance 1`, certified, against the same", certified, source, 5, 3),
        row("`--tolerance 1`, sharp and certified, against the same", sharp, source, 8, 5),
        row("`--step 20` against FontForge's export", stepped, forge, 4, 2),
        row("`--step 20` against the floor: HarfBuzz reads, empty files", stepped, bare, 9, 6),
        Row("two workers against one", stepped / two, "x", 1.8, note=f"{per(stepped)}, {per(two)}"),
        row("with curvature maps against without", mapped, stepped, 2.5, 2),
        Row(f"resume of a finished folder of {GLYPHS} glyphs", resumed, "s", 3 * GLYPHS / 20_000, more=False),
    ]


def least(rounds: int, *cases: Callable[[int], float]) -> list[float]:
    """The least time of each case, called with the number of the round; in turn, so that what else the machine does
    falls on all."""
    times = [[case(k) for case in cases] for k in range(rounds)]
    return [min(column) for column in zip(*times, strict=True)]


def seconds(call: Callable[[], object], clock: Callable[[], float] = perf_counter) -> Callable[[int], float]:
    """A call as a case for :func:`least`, by a clock."""

    def case(_: int) -> float:
        start = clock()
        call()
        return clock() - start

    return case


def row(what: str, ours: float, theirs: float, must: float, aim: float | None) -> Row:
    """A ratio of times: less is better."""
    return Row(what, ours / theirs, "x", must, aim, more=False, note=f"{per(ours)}, {per(theirs)}")


def per(seconds: float) -> str:
    """A time a glyph in words."""
    return f"{in_words(seconds)} a glyph"


def ours(out: Path, gids: Sequence[int], options: object, formats: tuple[str, ...], jobs: int) -> float:
    """Seconds a glyph of a whole run: opening the font, workers' start, files, manifest, index."""
    from glyphspline.readers import open_font
    from glyphspline.runs.convert import convert_font
    from glyphspline.runs.spec import RunSpec

    start = perf_counter()
    font = open_font(FONT)
    names = [font.glyph_names[gid] for gid in gids]
    convert_font(font, names, out, RunSpec(options, formats), jobs=jobs)  # type: ignore[arg-type]
    return (perf_counter() - start) / len(gids)


def fonttools_export(out: Path, gids: Sequence[int]) -> float:
    """Seconds a glyph of the shortest program that exports a font's outlines as SVG, the font's opening included."""
    from fontTools.pens.svgPathPen import SVGPathPen
    from fontTools.ttLib import TTFont

    start = perf_counter()
    out.mkdir()
    font = TTFont(FONT, fontNumber=0, lazy=True)
    glyphs, order = font.getGlyphSet(), font.getGlyphOrder()
    for gid in gids:
        pen = SVGPathPen(glyphs)
        glyphs[order[gid]].draw(pen)
        path = f'<path transform="scale(1 -1)" d="{pen.getCommands()}"/>'
        document = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 -880 1000 1000">{path}</svg>\n'
        (out / f"{gid}.svg").write_text(document)
    return (perf_counter() - start) / len(gids)


def floor(out: Path, gids: Sequence[int]) -> float:
    """Seconds a glyph of reading outlines through HarfBuzz and writing empty files."""
    import uharfbuzz as hb
    from fontTools.pens.basePen import NullPen

    start = perf_counter()
    out.mkdir()
    font = hb.Font(hb.Face(hb.Blob.from_file_path(str(FONT)), 0))
    pen = NullPen()
    for gid in gids:
        font.draw_glyph_with_pen(gid, pen)
        with open(f"{out}/{gid}.svg", "w"):
            pass
    return (perf_counter() - start) / len(gids)


def fontforge_export(out: Path, gids: Sequence[int]) -> float:
    """Seconds a glyph of FontForge's own export, the font's opening not counted; not a number without FontForge."""
    out.mkdir()
    for python in ("/usr/bin/python3", shutil.which("python3") or "python3"):
        call = [python, "-c", FONTFORGE, str(FONT), str(out), str(len(gids))]
        done = subprocess.run(call, capture_output=True, text=True, timeout=600)
        if done.returncode == 0:
            return float(done.stdout.split()[-1])
    return float("nan")


def formats() -> list[Row]:
    """The table of what it costs to export outlines, a glyph."""
    if not FONT.exists():
        return [Row(f"outlines as they are: {FONT.name} is not there", 0.0, "s")]
    from glyphspline.fitting.options import Options

    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        export = partial(ours, options=Options(), formats=("source",), jobs=1)
        export(here / "warm", range(FIRST, FIRST + 50))  # nothing compiles while it is timed
        return [row for count in (2000, GLYPHS) for row in compared(here, range(FIRST, FIRST + count), export)]


def compared(here: Path, gids: Sequence[int], export: Callable[[Path, Sequence[int]], float]) -> list[Row]:
    """Rows for so many glyphs."""
    count = len(gids)
    opened: list[float] = []

    def forge(k: int) -> float:
        start = perf_counter()
        seconds = fontforge_export(here / f"forge-{count}-{k}", gids)
        opened.append((perf_counter() - start) / count)
        return seconds

    own, fonttools, forged = least(
        3,
        lambda k: export(here / f"ours-{count}-{k}", gids),
        lambda k: fonttools_export(here / f"plain-{count}-{k}", gids),
        forge,
    )
    return [
        row(f"`--format source` of {count} glyphs against fontTools' `SVGPathPen`", own, fonttools, 0.5, None),
        row("the same against FontForge's export, its opening not counted", own, forged, 2.5, None),
        row("the same against FontForge's export, its opening counted", own, min(opened), 2.5, None),
    ]
