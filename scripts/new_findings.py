"""What ``check`` finds in written and mended fonts and not in their sources: ``python -m scripts.new_findings``.

Of each face so many glyphs, spread evenly, are written as OTF and as TTF with the options that fonts have by default,
and mended: kinks alone, and all kinds. A finding is new if the source's glyph has none of its kind within 5/1000 em of
its point or segment, and, of a jump, no turn that hides one; of kinds that belong to whole contours, none of its kind.
Jumps and lumps are not looked for in quadratics, so that an OTF made of them has what its source is excused. Each
finding is listed below the table of their numbers. The exit status is 1 if there are any.

``--glyphs 0`` takes whole faces, ``--faces DejaVu,Noto`` some of them, ``--ways ttf,mend`` some of the ways. With
``--folder`` the fonts stay there, and those that are there already are only compared: a second run with another
checkout of the program is the check of that one. Other glyphs than those are not in the written fonts.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from fontTools.subset import Options as Subset
from fontTools.subset import Subsetter
from fontTools.ttLib import TTFont

from glyphspline.outlines.flaws.kinds import KINDS, MENDED
from glyphspline.plugins.checks.finding import Finding
from glyphspline.plugins.checks.job import check_font
from glyphspline.plugins.masters.on_axes import OF_CONTOURS
from glyphspline.readers import open_font
from glyphspline.types import FloatArray

from .survey import faces, parser, table

FACES = (
    "DejaVuSans.ttf", "DejaVuSerif.ttf", "DejaVuSansMono.ttf", "EBGaramond12-Regular.otf", "LinLibertine_R.otf",
    "LinBiolinum_R.otf", "NotoSansCJK-Regular.ttc", "NotoSerifCJK-Regular.ttc",
)  # fmt: skip

WAYS = {
    "otf": ("refit", "--format", "otf"),
    "ttf": ("refit", "--format", "ttf"),
    "mend": ("mend",),
    "mend-all": ("mend", "--kinds", ",".join(MENDED)),
}
"""Commands by which fonts are written."""

NEAR = 0.005
"""Of an em, within which a finding is at the same place."""

AT_JOINTS = ("kink", "jump", "unlevel", "turn", "leftover", "repeated", "spike")
"""Kinds that belong to the joints of segments."""

HIDDEN = {"jump": ("jump", "kink", "turn")}
"""Kinds at whose places others are not looked for: curvature jumps where a joint is smooth."""

WHOLE = {KINDS[number].name for number in OF_CONTOURS}
"""Kinds that belong to contours."""


def subset(path: Path, glyphs: int, folder: Path) -> Path:
    """A face of some of its glyphs, spread evenly, with their components."""
    made = folder / f"{path.stem}{'.otf' if path.suffix == '.ttc' else path.suffix}"
    if not made.exists():
        font = TTFont(path, fontNumber=0)
        order = font.getGlyphOrder()
        chosen = np.unique(np.linspace(1, len(order) - 1, glyphs or len(order)).astype(int))
        options = Subset(hinting=False, layout_features=[], glyph_names=True, notdef_outline=True)
        subsetter = Subsetter(options)
        subsetter.populate(glyphs=[order[k] for k in chosen.tolist()])
        subsetter.subset(font)
        folder.mkdir(parents=True, exist_ok=True)
        font.save(made)
    return made


def written(source: Path, way: str, jobs: int) -> Path:
    """The font that a command makes of a face."""
    out = source.parent / f"{source.stem}-{way}"
    if not list(out.glob("*.?tf")):
        command = [*WAYS[way], str(source), "--out", str(out), "-j", str(jobs), "-q"]
        run = subprocess.run([sys.executable, "-m", "glyphspline", *command], check=False)
        assert run.returncode in (0, 1), command
    (made,) = out.glob("*.?tf")
    return made


def found(path: Path) -> list[list[tuple[Finding, FloatArray]]]:
    """The findings of each glyph, in the font's order, and (2, 2) the boxes around them: of segments, or points."""
    font, every = open_font(path), []
    for glyph in check_font(font, font.glyph_names, axes=(), once=False):
        contours, own = font.outline(glyph.glyph).contours if glyph.findings else (), []
        for one in glyph.findings:
            points = np.array([one.point])
            if one.kind not in AT_JOINTS:
                points = contours[one.contour].cubics()[one.segment]
            own.append((one, np.stack([points.min(axis=0), points.max(axis=0)])))
        every.append(own)
    return every


def new(
    before: list[list[tuple[Finding, FloatArray]]], after: list[list[tuple[Finding, FloatArray]]], near: float
) -> Iterator[Finding]:
    """Findings that a glyph has after and not before."""
    for old, now in zip(before, after, strict=True):
        for each, (low, high) in now:
            alike = [box for one, box in old if one.kind in HIDDEN.get(each.kind, (each.kind,))]
            known = any((low - near <= box[1]).all() and (box[0] <= high + near).all() for box in alike)
            if not known and not (alike and each.kind in WHOLE):
                yield each


def main() -> int:
    """Write fonts, compare, print."""
    options = parser(
        __doc__, glyphs=150, faces=",".join(FACES), ways=",".join(WAYS), folder="", jobs=1
    ).parse_args()  # fmt: skip
    every, rows = list[str](), []
    with tempfile.TemporaryDirectory() as temporary:
        for name in FACES:
            if not any(part in name for part in options.faces.split(",")) or not faces(name):
                continue
            source = subset(faces(name)[0], options.glyphs, Path(options.folder or temporary))
            before, em = found(source), open_font(source).metrics.units_per_em
            for way in options.ways.split(","):
                more = list(new(before, found(written(source, way, options.jobs)), NEAR * em))
                counts = Counter(each.kind for each in more)
                rows.append((source.name, way, len(before), " ".join(f"{k} {n}" for k, n in counts.items()) or "–"))
                print(*rows[-1], file=sys.stderr, flush=True)
                every += [f"{source.stem}-{way}: {each}" for each in more]
    print(table(("face", "way", "glyphs", "new findings"), rows), *every, sep="\n")
    return int(bool(every))


if __name__ == "__main__":
    sys.exit(main())
