"""Whole data sets by the command: beside ``convert``, two workers, thousands of fonts, and one row out of a million.

Fonts are those installed. The thousands are made of them: each copy has another name in its name table, and so other
bytes and a family of its own. Commands are timed from start to end with all their files, in turn; the least of the
rounds counts, as in :mod:`.batch`. Memory is as in :mod:`.watched`.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import cycle
from pathlib import Path
from time import perf_counter

from .batch import least
from .check import ANCHORED, LATIN, OTHER_LATIN
from .measure import Row, in_words
from .watched import Watched, run_watched

INSTALLED = Path("/usr/share/fonts")
ROUNDS = 2
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


def rows() -> list[Row]:
    """The table of what whole sets cost."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        found = [*against_convert(here), processors(), *workers(here)]
        if fonts := installed():
            found += [*thousands(fonts, here), *of_a_million(fonts, here)]
    return found


def command(*words: str | Path) -> Watched:
    """Run the program."""
    return run_watched([sys.executable, "-m", "glyphspline", *map(str, words), "--quiet"])


def against_convert(here: Path) -> list[Row]:
    """A set with its fit beside the files of ``convert`` by the same options, one worker each."""
    fit = ("--corners", "sharp", "--jobs", "1")
    table, svg = least(
        ROUNDS,
        lambda k: command("dataset", LATIN, "--out", here / f"fit-{k}", *fit).seconds,
        lambda k: command("convert", LATIN, "--all", "--format", "svg", "--out", here / f"svg-{k}", *fit).seconds,
    )
    note = f"{in_words(table)}, {in_words(svg)}"
    return [Row(f"a set of {LATIN.name} with the fit against `convert --format svg`", svg / table, "x", 0.8, note=note)]


def processors() -> Row:
    """Two processes that share nothing beside one, in loops of the same length: what two workers can be at most."""
    loop = [sys.executable, "-c", "x = 0.0\nfor i in range(30_000_000): x += i * 0.5"]

    def seconds(count: int) -> float:
        start = perf_counter()
        for process in [subprocess.Popen(loop) for _ in range(count)]:
            process.wait()
        return perf_counter() - start

    one, two = least(ROUNDS, lambda _: seconds(1), lambda _: seconds(2))
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
            runs = [partial(made, fonts, here / f"{k}-{jobs}", jobs, words) for jobs in ("1", "2")]
            one, two = least(ROUNDS, *runs)
            note = f"{in_words(one)}, {in_words(two)}"
            yield Row(f"two workers against one, {what}", one / two, "x", 1.8, note=note)


def made(fonts: Sequence[Path], out: Path, jobs: str, words: Sequence[str], k: int) -> float:
    """Seconds of a set."""
    return command("dataset", *fonts, "--out", f"{out}-{k}", "--jobs", jobs, *words).seconds


def installed() -> list[Path]:
    """Font files that are installed, by name."""
    return sorted(path for path in INSTALLED.rglob("*") if path.suffix in (".ttf", ".otf", ".ttc"))


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
    read = least(ROUNDS, *[lambda _, share=share: first_read(taken, share) for share in (0.1, 0.5, 0.9)])
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
