"""Rows of a data set beside TorchFont's loader with a resampling in NumPy as its users write it, in one run.

``GLYPHSPLINE_BENCH_TORCHFONT`` is the Python of an environment that has TorchFont and PyTorch; without it the same
resampling runs on what fontTools reads alone. Each round starts a process of theirs, whose time counts from after its
imports, and runs ours here, in turn; the least of the rounds counts, as in :mod:`.batch`. Both open the font, read each
glyph that has an outline, and put 64 points with tangents and curvature on each contour; ours makes an Arrow table with
the canonical outline and the rest of a row too.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from time import perf_counter

from .batch import least, per
from .check import ANCHORED, LATIN
from .measure import Row

TORCHFONT = os.environ.get("GLYPHSPLINE_BENCH_TORCHFONT")
ROUNDS = 3
MOST = 2000
"""Glyphs of a font that are read."""

RESAMPLE = """
import numpy as np

def resampled(pieces, count=64, steps=20):  # pieces: (degree + 1, 2) each
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    parts = []
    for p in pieces:
        if len(p) == 2:
            parts.append((1 - t) * p[0] + t * p[1])
        elif len(p) == 3:
            parts.append((1 - t)**2 * p[0] + 2 * t * (1 - t) * p[1] + t**2 * p[2])
        else:
            parts.append((1 - t)**3 * p[0] + 3 * t * (1 - t)**2 * p[1] + 3 * t**2 * (1 - t) * p[2] + t**3 * p[3])
    fine = np.concatenate([*parts, pieces[0][:1]])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(fine, axis=0).T))])
    at = np.linspace(0, along[-1], count, endpoint=False)
    points = np.stack([np.interp(at, along, fine[:, 0]), np.interp(at, along, fine[:, 1])], axis=1)
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    first, second = (after - before) / 2, after - 2 * points + before
    speed = np.hypot(first[:, 0], first[:, 1]) + 1e-12
    curvature = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / speed**3
    return points, first / speed[:, None], curvature
"""

BY_TORCHFONT = (
    RESAMPLE
    + """
import sys, time, torch
from torchfont.datasets import GlyphIdDataset
from torchfont.transforms import LoadGlyph
torch.set_num_threads(1)
start = time.perf_counter()
data = GlyphIdDataset(sys.argv[1], transform=LoadGlyph())
count = min(len(data), int(sys.argv[2]))
for index in range(count):
    outline = data[index].data
    found, pieces = [], []
    for kind, row in zip(outline.types.tolist(), outline.coords.numpy().astype(np.float64)):
        if kind == 1:
            pieces, begin, here = [], row[4:], row[4:]
        elif kind == 2:
            pieces.append(np.stack([here, row[4:]])); here = row[4:]
        elif kind == 3:
            pieces.append(np.stack([here, row[:2], row[4:]])); here = row[4:]
        elif kind == 4:
            pieces.append(np.stack([here, row[:2], row[2:4], row[4:]])); here = row[4:]
        elif kind == 5 and pieces:
            if (here != begin).any():
                pieces.append(np.stack([here, begin]))
            found.append(resampled(pieces))
print((time.perf_counter() - start) / count)
"""
)

BY_FONTTOOLS = (
    RESAMPLE
    + """
import pathlib, sys, time
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.pens.basePen import decomposeQuadraticSegment
from fontTools.ttLib import TTFont
start = time.perf_counter()
font = TTFont(next(pathlib.Path(sys.argv[1]).iterdir()), fontNumber=0)
glyphs, count = font.getGlyphSet(), 0
for name in font.getGlyphOrder():
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    found, pieces = [], []
    for kind, to in pen.value:
        to = [np.array(p, dtype=float) for p in to if p is not None]
        if kind == "moveTo":
            pieces, begin, here = [], to[0], to[0]
        elif kind == "lineTo":
            pieces.append(np.stack([here, to[0]])); here = to[0]
        elif kind == "qCurveTo":
            for control, on in decomposeQuadraticSegment(to):
                pieces.append(np.stack([here, np.array(control), np.array(on)])); here = np.array(on)
        elif kind == "curveTo":
            pieces.append(np.stack([here, *to])); here = to[-1]
        elif kind == "closePath" and pieces:
            if (here != begin).any():
                pieces.append(np.stack([here, begin]))
            found.append(resampled(pieces))
    count += bool(found)
    if count == int(sys.argv[2]):
        break
print((time.perf_counter() - start) / count)
"""
)


def rows() -> list[Row]:
    """The table of what a row of a data set costs a glyph."""
    found: list[Row] = []
    for font in (LATIN, ANCHORED):
        if font.exists():
            found += against_loaders(font)
    return [*found, with_fit()]


def against_loaders(font: Path) -> list[Row]:
    """Rows of a font without a fit, against the others."""
    made(font, 50)  # nothing is compiled while it is timed
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(font, folder)  # TorchFont passes over links
        loaders = [("fontTools", sys.executable, BY_FONTTOOLS)]
        if TORCHFONT:
            loaders.insert(0, ("TorchFont", TORCHFONT, BY_TORCHFONT))
        cases = [partial(theirs, python, code, folder) for _, python, code in loaders]
        mine, *others = least(ROUNDS, lambda _: made(font, MOST), *[lambda _, case=case: case() for case in cases])
    return [
        Row(
            f"rows of {font.name} with points and curvature, no fit, against {name} and a resampling in NumPy",
            other / mine, "x", 3.0, note=f"{per(mine)}, {per(other)}",
        )
        for (name, _, _), other in zip(loaders, others, strict=True)
    ]  # fmt: skip


def theirs(python: str, code: str, folder: str) -> float:
    """Seconds a glyph, as a process of its own says."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    run = subprocess.run([python, "-c", code, folder, str(MOST)], capture_output=True, text=True, env=environment)
    if run.returncode:
        raise RuntimeError(run.stderr)
    return float(run.stdout)


def made(path: Path, most: int) -> float:
    """Seconds a glyph of a table of rows without a fit, the font's opening included."""
    from glyphspline.datasets.dataset_spec import DatasetSpec
    from glyphspline.datasets.rows import table_of
    from glyphspline.readers import open_font

    spec, count, names = DatasetSpec(options=None), 0, 0
    start = perf_counter()
    font = open_font(path)
    while count < most and names < len(font.glyph_names):
        outlines = [o for o in font.outlines(font.glyph_names[names : names + 256]) if len(o.contours)][: most - count]
        table_of(outlines, None, spec)
        names, count = names + 256, count + len(outlines)
    return (perf_counter() - start) / count


def with_fit() -> Row:
    """Rows with the fit of a data set against the conversion to SVG by the same options, in one process."""
    from glyphspline.datasets.dataset_spec import DatasetSpec
    from glyphspline.datasets.rows import fits_of, table_of
    from glyphspline.fitting.convert import convert_many
    from glyphspline.fitting.results import GlyphResult
    from glyphspline.readers import open_font
    from glyphspline.writers.svg.document import to_svg

    spec = DatasetSpec()
    assert spec.options is not None
    options = spec.options

    def fitted(write: bool) -> float:
        start, count = perf_counter(), 0
        font = open_font(LATIN)
        names = font.glyph_names[:MOST]
        for k in range(0, len(names), 64):
            outlines = [outline for outline in font.outlines(names[k : k + 64]) if len(outline.contours)]
            count += len(outlines)
            if write:
                for glyph in convert_many(outlines, options):
                    to_svg(glyph)
            else:
                fits = [fit for fit in fits_of(outlines, spec) if isinstance(fit, GlyphResult)]
                table_of([fit.outline for fit in fits], fits, spec)
        return (perf_counter() - start) / count

    svg, table = least(ROUNDS, lambda _: fitted(True), lambda _: fitted(False))
    what = f"rows of {LATIN.name} with the fit against its conversion to SVG, without files"
    return Row(what, svg / table, "x", 0.8, note=f"{per(table)}, {per(svg)}")
