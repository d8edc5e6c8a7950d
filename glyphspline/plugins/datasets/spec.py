"""What a data set holds: its rows, their points, and which fonts and glyphs are taken."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from ...errors import OptionError, require
from ...fields import SHARE, check, option, whole
from ...fitting.options import Options

Rows: TypeAlias = Literal["glyph", "contour"]
Normalise: TypeAlias = Literal["em", "units"]
Instances: TypeAlias = Literal["default", "named"]

ROWS = "What rows hold"
TAKEN = "Which fonts and glyphs"
SPLIT = "Splits, by family"
"""Headings of groups of options."""

MOST_POINTS = 4096
"""Points of a contour, and pixels of a raster's side."""


@dataclass(frozen=True)
class DatasetSpec:
    """What a data set holds.

    Attributes:
        rows: one row a glyph, or one a contour.
        points: points of each contour, at equal arc lengths of its source outline, or of the fitted curve if there is
            one; None: the polygon of the fit, or without a fit the points on the curve.
        normalise: coordinates in em, or in font units.
        options: of the fit; None: nothing is fitted, and the columns of splines and measures are null.
        raster: height and width in pixels of a grey picture of the glyph; None: there is none.
        characters, scripts, licences: only glyphs of these characters, scripts (ISO 15924), and fonts whose licence
            (SPDX identifier, or "unknown") is one of these; empty: all.
        instances: where the outlines of a variable font are taken: at its default, or at each of its named instances.
        coverage: share of ``characters`` that a font needs to be taken, 0 to 1.
        seed: of the split. validation, test: shares of the families in these splits; the rest is for training.
    """

    rows: Rows = option("glyph", "Write a row a glyph, or a row a contour.", ROWS)
    points: int | None = option(
        64, "Place this number of points at equal arc lengths of a contour, or give its polygon.",
        ROWS, "N|polygon", rule=whole(3, MOST_POINTS), words={"polygon": None},
    )  # fmt: skip
    normalise: Normalise = option("em", "Write coordinates in em, or in font units.", ROWS)
    options: Options | None = Options()
    raster: int | None = option(None, "Add a grey picture of N by N pixels.", ROWS, "N", rule=whole(8, MOST_POINTS))
    characters: str = option(
        "", "Take only glyphs of these characters, or of those of a UTF-8 @file.", TAKEN, flags="--text --characters"
    )
    scripts: tuple[str, ...] = option(
        (), "Take only glyphs of these scripts, by ISO 15924: Latn,Grek.", TAKEN, "CODE,…", flags="--script"
    )
    licences: tuple[str, ...] = option(
        (), "Take only fonts of these licences, by SPDX, or unknown.", TAKEN, "ID,…", flags="--licence"
    )
    instances: Instances = option("default", "Take variable fonts at their default, or at each named instance.", TAKEN)
    coverage: float = option(0.0, "Take only fonts that have this share of the characters.", TAKEN, "SHARE", rule=SHARE)
    seed: int = option(0, "Seed the hash that assigns families to splits.", SPLIT, "N")
    validation: float = option(
        0.1, "Put this share of the families into the split validation.", SPLIT, "SHARE", rule=SHARE
    )
    test: float = option(0.1, "Put this share of the families into the split test.", SPLIT, "SHARE", rule=SHARE)

    def __post_init__(self) -> None:
        check(self)
        require(self.options is None or isinstance(self.options, Options), "options are Options, or None", self.options)
        if self.validation + self.test > 1:
            raise OptionError("validation and test are more than all families together")


@dataclass(frozen=True)
class Sizes:
    """Where a data set is cut: other sizes give other bytes.

    Attributes:
        shard: glyphs in a file, at most: of Latin letters some 30 MB, with 64 points a contour and their fit.
        chunk, chunk_bytes: glyphs that a worker makes rows of at a time, and bytes that these need, at most.
        group, group_bytes: rows in a row group, at most: what a reader has to read for one row. With fewer, footers are
            larger. A group of so many bytes ends sooner, with a chunk.
    """

    shard: int = 10_000
    chunk: int = 100
    chunk_bytes: int = 1 << 23
    group: int = 2000
    group_bytes: int = 1 << 26


USUAL = Sizes()
"""Those of every data set that does not ask for others."""
