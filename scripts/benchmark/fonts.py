"""What fonts store of ``--continuity g2``: curves, kinks and jumps of text faces, written and read back by fontTools.

Kinks and jumps are counted by this program alone: turns of 0.5 to 12 degrees where the source has none such within
3/1000 em, and curvatures that differ by a tenth where a smooth joint has curves on both sides. FontForge has the
benefit of the doubt as in :mod:`.faithful`.
"""

from __future__ import annotations

import os
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np
from fontTools import subset
from fontTools.ttLib import TTFont

import glyphspline as gs
from glyphspline.fitting.convert import unfitted
from glyphspline.plugins.fonts.tables.font_file import write_font
from glyphspline.plugins.fonts.tables.font_glyphs import drawn_result
from glyphspline.readers import Source
from glyphspline.types import FloatArray

from ..survey import SegmentPen, faces
from .faithful import fewest, forge_results, inside, numbers, to_em
from .measure import Row

LATIN = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&"
HAN = "".join(map(chr, range(0x4E00, 0x9F00, 105)))
FACES = {
    "EB Garamond": ("EBGaramond12-Regular.otf", LATIN), "EB Garamond Italic": ("EBGaramond12-Italic.otf", LATIN),
    "STIX": ("STIXGeneral-Regular.otf", LATIN), "Latin Modern": ("lmroman10-regular.otf", LATIN),
    "Latin Modern Italic": ("lmroman10-italic.otf", LATIN), "Libertine": ("LinLibertine_R.otf", LATIN),
    "Libertine Bold Italic": ("LinLibertine_RBI.otf", LATIN), "Inter": ("Inter-Regular.otf", LATIN),
    "DejaVu Serif": ("DejaVuSerif.ttf", LATIN), "Gentium Italic": ("GentiumPlus-Italic.ttf", LATIN),
    "Noto Serif CJK": ("NotoSerifCJK-Regular.ttc", HAN), "Noto Sans CJK": ("NotoSansCJK-Regular.ttc", HAN),
    "LXGW WenKai": ("LXGWWenKai-Regular.ttf", HAN),
}  # fmt: skip
"""Files and characters. Of Han faces a subset is written."""

OPTIONS = gs.Options(continuity="g2")
FORGED = int(os.environ.get("GLYPHSPLINE_BENCH_FORGED", "63"))  # glyphs of a face that FontForge simplifies


def rows() -> list[Row]:
    """All faces that are installed, or lie in a folder of GLYPHSPLINE_FACES."""
    return [
        row for name, (file, text) in FACES.items() for path in faces(file)[:1] for row in face_rows(name, path, text)
    ]


def face_rows(name: str, path: Path, text: str) -> list[Row]:
    """Totals of a face."""
    with TemporaryDirectory() as folder:
        if text == HAN:
            whole, path = path, Path(folder, "subset.font")
            subset.main([str(whole), "--font-number=0", f"--text={text}", "--glyph-names", f"--output-file={path}"])
        return font_rows(name, path, text)


def font_rows(name: str, path: Path, text: str) -> list[Row]:
    """Totals of a font."""
    font = gs.open_font(path)
    glyphs = [outline for outline in font.outlines(font.select(text=text)) if outline.contours]
    quadratic, near = all((outline.arrays.degrees < 3).all() for outline in glyphs), font.metrics.units_per_em / 1000
    fit: Any = unfitted if quadratic else gs.convert_many  # as the command does for the one font that is written
    times = []
    for some in (glyphs[:1], *5 * [glyphs]):
        start, results = process_time(), fit(some, OPTIONS)
        for result in results if quadratic else ():
            drawn_result(result, near, "ttf", None)
        times.append((process_time() - start) / len(some))
    spent = np.median(times[1:])
    found, note = [], f"{len(glyphs)} glyphs"
    for flavour in ("otf", "ttf"):
        with TemporaryDirectory() as folder:
            file = Path(folder, f"new.{flavour}")
            fitted = gs.convert_many(glyphs, OPTIONS) if quadratic and flavour == "otf" else results
            write_font(font, fitted, file, tolerance=near)
            found += written_rows(f"{name}, {flavour}", path, file, [g.name for g in glyphs], font)
    if not quadratic:
        few = [to_em(outline) for outline in glyphs[:: max(1, len(glyphs) // FORGED)]]
        forge = [fewest(g, r) for g, r in zip(few, forge_results(few), strict=True)]
        made = [gs.convert(g, OPTIONS) for g in few]
        share = np.median([sum(numbers(c.curve) for c in r.contours) / f[1] for r, f in zip(made, forge, strict=True)])
        own = [[[*c.curve.segments()] for c in r.contours] for r in made]
        words = "extrema inside curves, kinks and jumps: source {}, {}, {}; FontForge {}, {}, {}; here {}, {}, {}"
        about = "median of the glyphs; " + words.format(
            *faults([[*c.segments()] for g in few for c in g.contours]),
            *faults([contour for *_, each in forge for contour in each]),
            *faults([contour for each in own for contour in each]),
        )
        found.append(Row(f"{name}: numbers / FontForge's", share, "x", 1.0, 0.92, False, about))
    return [*found, Row(f"{name}: fast, a glyph", spent * 1e3, "ms", 10 if text == HAN else 4, None, False, note)]


def written_rows(name: str, source: Path, made: Path, glyphs: list[str], font: Source) -> list[Row]:
    """What is in the written file, against the source's."""
    em, new, jumps, old_jumps = font.metrics.units_per_em, 0, 0, 0
    before, after = (TTFont(file, fontNumber=0) for file in (source, made))
    counts, sets = np.zeros(2), [each.getGlyphSet() for each in (before, after)]
    for glyph in glyphs:
        number = font.glyph_names.index(glyph)
        names = [each.getGlyphOrder()[number] for each in (before, after)]
        drawn = [segments(each, one) for each, one in zip(sets, names, strict=True)]
        old, own = (joints(contours, em) for contours in drawn)
        if "glyf" in before and "glyf" in after:
            tables = [each["glyf"] for each in (before, after)]
            counts += [len(table[each].getCoordinates(table)[0]) for table, each in zip(tables, names, strict=True)]
        else:
            counts += [sum(len(s) > 2 for contour in contours for s in contour) for contours in drawn]
        there = old[is_kink(old)]
        for x, y, turn, *_ in own[is_kink(own)]:
            new += not ((np.hypot(there[:, 0] - x, there[:, 1] - y) < 3e-3 * em) & (there[:, 2] > turn - 0.3)).any()
        jumps, old_jumps = jumps + int(own[:, 3].sum()), old_jumps + int(old[:, 3].sum())
    rows = [Row(f"{name}: kinks that the source has not", new, "", 0, None, False)]
    if ("glyf" in before) == ("glyf" in after):
        what = "points" if "glyf" in before else "curves"
        rows.append(Row(f"{name}: {what} / source's", counts[1] / counts[0], "x", 1.0, 0.85, False))
        table = "glyf" if "glyf" in before else "CFF "
        old_bytes, new_bytes = (each.reader.tables[table].length for each in (before, after))
        rows.append(Row(f"{name}: bytes of outlines / source's", new_bytes / old_bytes, "x", 1.0, 0.85, False))
        if "CFF " in after:
            rows.append(Row(f"{name}: jumps of curvature / source's", jumps / max(old_jumps, 1), "x", 0.1, 0.03, False))
    return rows


def faults(contours: list[list[Any]]) -> tuple[int, int, int]:
    """Extrema inside curves, kinks and jumps of curvature of contours in an em of 1,000."""
    long = [[s for s in map(np.asarray, contour) if np.ptp(s, axis=0).max() > 1e-3] for contour in contours]
    found = joints(long, 1000)
    return inside(contours), int(is_kink(found).sum()), int(found[:, 3].sum())


def is_kink(rows: FloatArray) -> FloatArray:
    """Which joints turn by 0.5 to 12 degrees, two lines apart."""
    return (rows[:, 2] >= 0.5) & (rows[:, 2] <= 12) & (rows[:, 4] == 0)


def segments(glyphs: Any, glyph: str) -> list[list[FloatArray]]:
    """The segments of each contour that have a length: more than a thousandth of a unit, which nobody drew."""
    pen = SegmentPen(glyphs)
    glyphs[glyph].draw(pen)
    return [[s for s in map(np.asarray, contour) if np.ptp(s, axis=0).max() > 1e-3] for contour in pen.contours]


def joints(contours: list[list[FloatArray]], em: float) -> FloatArray:
    """(n, 5) place, turn in degrees, whether the curvature jumps there, and whether both sides are lines."""
    found = [
        joint(before, behind, em)
        for contour in contours
        for before, behind in zip([*contour[-1:], *contour[:-1]], contour, strict=True)
    ]
    return np.array(found, dtype=np.float64).reshape(-1, 5)


def joint(before: FloatArray, behind: FloatArray, em: float) -> tuple[float, ...]:
    """A row of :func:`joints`."""
    (a, one), (b, other) = end_of(before[::-1]), end_of(behind)
    turn = np.degrees(abs(np.arctan2(b[0] * a[1] - b[1] * a[0], -(a @ b))))
    lines, most = (len(before) == 2) + (len(behind) == 2), max(abs(one), abs(other))
    jump = lines == 0 and turn < 3 and 1 / em < most < np.inf and abs(one + other) > 0.1 * most
    return (*behind[0], turn, float(jump), float(lines == 2))


def end_of(points: FloatArray) -> tuple[FloatArray, float]:
    """Where a segment leaves its first point to, and with which curvature."""
    arm, n = next(p - points[0] for p in points[1:] if (p != points[0]).any()), len(points) - 1
    if n == 1:
        return arm, 0.0
    a, b = points[1] - points[0], points[2] - points[1]
    size = np.hypot(*a)
    return arm, float((n - 1) / n * (a[0] * b[1] - a[1] * b[0]) / size**3) if size else np.inf
