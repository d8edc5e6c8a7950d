"""Data sets: rows beside TorchFont's loader with a resampling in NumPy, and whole sets by the command.

``GLYPHSPLINE_BENCH_TORCHFONT`` is the Python of an environment that has TorchFont and PyTorch; without it the same
resampling runs on what fontTools reads alone. Each round starts a process of theirs, whose time counts from after its
imports, and runs ours here, in turn; the least of the rounds counts, as in :mod:`.batch`. Both open the font, read each
glyph that has an outline, and put 64 points with tangents and curvature on each contour; ours makes an Arrow table with
the canonical outline and the rest of a row too.

Of whole sets, the fonts are those installed. Thousands are made of them: each copy has another name in its name table,
and so other bytes and a family of its own. Commands are timed from start to end with all their files, in turn.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import cycle
from pathlib import Path
from time import perf_counter

import glyphspline as gs
from glyphspline.plugins.datasets.rows import fits_of, table_of
from glyphspline.plugins.datasets.spec import DatasetSpec

from .batch import least
from .check import ANCHORED, LATIN, OTHER_LATIN
from .measure import Row, Watched, in_words, ratio, run_watched

TORCHFONT = os.environ.get("GLYPHSPLINE_BENCH_TORCHFONT")
ROUNDS = 3
NO_FIT = DatasetSpec(options=None)
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

CONTOURS = """
def contours(operations):  # moveTo, lineTo, curveTo and closePath, each with its points
    found, pieces = [], []
    for kind, to in operations:
        if kind == "moveTo":
            pieces, begin, here = [], to[0], to[0]
        elif to:
            pieces.append(np.stack([here, *to])); here = to[-1]
        elif pieces:
            if (here != begin).any():
                pieces.append(np.stack([here, begin]))
            found.append(resampled(pieces))
    return found
"""

BY_TORCHFONT = RESAMPLE + CONTOURS + """
import sys, time, torch
from torchfont.datasets import GlyphIdDataset
from torchfont.transforms import LoadGlyph
torch.set_num_threads(1)
start = time.perf_counter()
data = GlyphIdDataset(sys.argv[1], transform=LoadGlyph())
count = min(len(data), int(sys.argv[2]))
POINTS = {1: (4,), 2: (4,), 3: (0, 4), 4: (0, 2, 4), 5: ()}
for index in range(count):
    outline = data[index].data
    rows = zip(outline.types.tolist(), outline.coords.numpy().astype(np.float64))
    contours(("moveTo" if k == 1 else "", [row[p:p + 2] for p in POINTS[k]]) for k, row in rows if k in POINTS)
print((time.perf_counter() - start) / count)
"""  # fmt: skip

BY_FONTTOOLS = RESAMPLE + CONTOURS + """
import pathlib, sys, time
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.pens.basePen import decomposeQuadraticSegment
from fontTools.ttLib import TTFont

def operations(drawn):
    for kind, to in drawn:
        handles_alone = bool(to) and to[-1] is None  # no point on the curve: halfway between two handles is one
        to = [np.array(p, dtype=float) for p in to if p is not None]
        if handles_alone:
            to.append((to[-1] + to[0]) / 2)
            yield "moveTo", to[-1:]
        for part in decomposeQuadraticSegment(to) if kind == "qCurveTo" else [to]:
            yield kind, part

start = time.perf_counter()
font = TTFont(next(pathlib.Path(sys.argv[1]).iterdir()), fontNumber=0)
glyphs, count = font.getGlyphSet(), 0
for name in font.getGlyphOrder():
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    count += bool(contours(operations(pen.value)))
    if count == int(sys.argv[2]):
        break
print((time.perf_counter() - start) / count)
"""  # fmt: skip


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
    what = f"rows of {font.name} with points and curvature, no fit, against {{}} and a resampling in NumPy"
    return [ratio(what.format(name), other, mine, 3.0) for (name, *_), other in zip(loaders, others, strict=True)]


def theirs(python: str, code: str, folder: str) -> float:
    """Seconds a glyph, as a process of its own says."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    run = subprocess.run([python, "-c", code, folder, str(MOST)], capture_output=True, text=True, env=environment)
    if run.returncode:
        raise RuntimeError(run.stderr)
    return float(run.stdout)


def outlines(path: Path, most: int) -> Iterator[list[gs.Outline]]:
    """The first glyphs of a font that have contours, some at a time; the font is opened for this."""
    font = gs.open_font(path)
    for k in range(0, len(font.glyph_names), 256):
        if found := [o for o in font.outlines(font.glyph_names[k : k + 256]) if len(o.contours)][:most]:
            yield found
        most -= len(found)


def made(path: Path, most: int, spec: DatasetSpec = NO_FIT) -> float:
    """Seconds a glyph of a table of rows, the font's opening included."""
    start, count = perf_counter(), 0
    for batch in outlines(path, most):
        made_of = fits_of(batch, spec) if spec.options else []
        fits = [fit for fit in made_of if isinstance(fit, gs.GlyphResult)]
        table_of([fit.outline for fit in fits] or batch, fits or None, spec)
        count += len(batch)
    return (perf_counter() - start) / count


def drawn(path: Path, most: int) -> float:
    """Seconds a glyph of its conversion to SVG by the options of data sets."""
    start, count = perf_counter(), 0
    for batch in outlines(path, most):
        count += len([gs.to_svg(glyph) for glyph in gs.convert_many(batch, DatasetSpec().options or gs.Options())])
    return (perf_counter() - start) / count


def with_fit() -> Row:
    """Rows with the fit of a data set against the conversion to SVG by the same options, in one process."""
    svg, table = least(ROUNDS, lambda _: drawn(LATIN, MOST), lambda _: made(LATIN, MOST, DatasetSpec()))
    return ratio(f"rows of {LATIN.name} with the fit against its conversion to SVG, without files", svg, table, 0.8)


INSTALLED = Path("/usr/share/fonts")
ROUNDS_OF_RUNS = 2
FONTS = 2000
ROWS = 1_000_000

READ = """
import json, sys, time
import glyphspline as gs
import pyarrow.dataset as ds
gs.load
files, font, gid = json.load(sys.stdin)
start = time.perf_counter()
found = ds.dataset(files).to_table(filter=(ds.field("font") == font) & (ds.field("gid") == gid))
loaded = gs.load(found.slice(0, 1).to_pylist()[0])
seconds = time.perf_counter() - start
assert loaded.outline.gid == gid and len(loaded.outline.contours) == 1
print(seconds)
"""


def runs() -> list[Row]:
    """The table of what whole sets cost."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        found = [*against_convert(here), processors(), *workers(here)]
        if fonts := sorted(path for path in INSTALLED.rglob("*") if path.suffix in (".ttf", ".otf", ".ttc")):
            found += [*thousands(fonts, here), *of_a_million(fonts, here)]
    return found


def command(*words: str | Path) -> Watched:
    """Run the program."""
    return run_watched([sys.executable, "-m", "glyphspline", *map(str, words), "--quiet"])


def against_convert(here: Path) -> list[Row]:
    """A set with its fit beside the files of ``convert`` by the same options, one worker each."""
    fit = ("--corners", "sharp", "--jobs", "1")
    table, svg = least(
        ROUNDS_OF_RUNS,
        lambda k: command("dataset", LATIN, "--out", here / f"fit-{k}", *fit).seconds,
        lambda k: command("convert", LATIN, "--all", "--format", "svg", "--out", here / f"svg-{k}", *fit).seconds,
    )
    return [ratio(f"a set of {LATIN.name} with the fit against `convert --format svg`", svg, table, 0.8)]


def processors() -> Row:
    """Two processes that share nothing beside one, in loops of the same length: what two workers can be at most."""
    loop = [sys.executable, "-c", "x = 0.0\nfor i in range(30_000_000): x += i * 0.5"]

    def seconds(count: int) -> float:
        start = perf_counter()
        for process in [subprocess.Popen(loop) for _ in range(count)]:
            process.wait()
        return perf_counter() - start

    one, two = least(ROUNDS_OF_RUNS, lambda _: seconds(1), lambda _: seconds(2))
    what = "two processes that share nothing against one, in loops of Python"
    return Row(what, 2 * one / two, "x", note=f"{in_words(one)}, {in_words(two)} for twice the work")


def workers(here: Path) -> Iterator[Row]:
    """Two workers beside one: the start of a run, which both have, and what only one process does count too."""
    faces = sorted([*LATIN.parent.glob("DejaVu*.ttf"), *OTHER_LATIN.parent.glob("DejaVu*.ttf")])
    cases: list[tuple[str, list[Path], list[str]]] = [
        (f"a set of {LATIN.name} with the fit", [LATIN], []),
        (f"a set of {len(faces)} faces of DejaVu with the fit", faces, []),
        (f"a set of {ANCHORED.name} without a fit", [ANCHORED], ["--no-fit"]),
    ]
    for k, (what, fonts, words) in enumerate(cases):
        if all(font.exists() for font in fonts):
            runs = [partial(set_made, fonts, here / f"{k}-{jobs}", jobs, words) for jobs in ("1", "2")]
            one, two = least(ROUNDS_OF_RUNS, *runs)
            yield ratio(f"two workers against one, {what}", one, two, 1.8)


def set_made(fonts: Sequence[Path], out: Path, jobs: str, words: Sequence[str], k: int) -> float:
    """Seconds of a set."""
    return command("dataset", *fonts, "--out", f"{out}-{k}", "--jobs", jobs, *words).seconds


def thousands(fonts: Sequence[Path], here: Path) -> list[Row]:
    """A set of the Latin glyphs of thousands of fonts, without a fit."""
    copies = many(fonts, here / "fonts")
    run = command("dataset", copies, "--out", here / "many", "--script", "Latn", "--no-fit", "--jobs", "2")
    what = f"a set of the Latin glyphs of {FONTS} fonts, {rows_of(here / 'many')} rows, `--jobs 2`"
    return [
        Row(what, run.seconds, "s", more=False),
        Row("its largest process", run.largest, "MB", 500, more=False, note=f"all together {run.total:.0f} MB"),
    ]


def many(fonts: Sequence[Path], folder: Path) -> Path:
    """Thousands of fonts, each a copy of an installed face under another name."""
    from fontTools.ttLib import TTFont

    folder.mkdir()
    for k, path in zip(range(FONTS), cycle(fonts), strict=False):
        font = TTFont(path, fontNumber=0, lazy=True, recalcTimestamp=False, recalcBBoxes=False)
        for number in (1, 16):
            font["name"].setName(f"Family {k}", number, 3, 1, 0x409)
        font.save(folder / f"{k}{'.otf' if 'CFF ' in font else '.ttf'}", reorderTables=None)
    return folder


def of_a_million(fonts: Sequence[Path], here: Path) -> list[Row]:
    """One row of a set of more than a million, opened and read by a process that has opened nothing before."""
    out = here / "million"
    plain = [path for path in fonts if path.suffix != ".ttc"]
    run = command("dataset", *plain, "--out", out, "--rows", "contour", "--no-fit", "--jobs", "2")
    files = sorted((out / "data").iterdir())
    count, taken = 0, []
    for file in files:
        count += rows_in(file)
        taken.append(str(file))
        if count > ROWS:
            break
    read = least(ROUNDS_OF_RUNS, *[lambda _, share=share: first_read(taken, share) for share in (0.1, 0.5, 0.9)])
    return [
        Row(f"a set of {rows_of(out)} rows, a contour each, of {len(plain)} fonts, `--jobs 2`", run.seconds, "s"),
        Row("its largest process", run.largest, "MB", 500, more=False, note=f"all together {run.total:.0f} MB"),
        Row(
            f"one of {count} rows: opened by pyarrow, found by font and gid, made an outline",
            max(read), "s", 0.2, more=False, note="the slowest of three",
        ),
    ]  # fmt: skip


def first_read(files: Sequence[str], share: float) -> float:
    """Seconds from the names of the files to one row's outline; the row is at this share of the files."""
    import pyarrow.parquet as pq

    file = pq.ParquetFile(files[int(share * len(files))])
    row = file.read_row_group(file.num_row_groups // 2, columns=["font", "gid"]).slice(7, 1).to_pylist()[0]
    given = json.dumps([list(files), row["font"], row["gid"]])
    return float(
        subprocess.run([sys.executable, "-c", READ], input=given, capture_output=True, text=True, check=True).stdout
    )


def rows_of(out: Path) -> int:
    """The number of rows of a set."""
    return sum(map(rows_in, (out / "data").iterdir()))


def rows_in(file: Path) -> int:
    """The number of rows of a shard."""
    import pyarrow.parquet as pq

    return int(pq.read_metadata(file).num_rows)
