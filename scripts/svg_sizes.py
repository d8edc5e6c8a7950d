"""Bytes of drawings against fontTools' of the source, made small by SVGO: ``python -m scripts.svg_sizes --svgo svgo``.

60 glyphs, 15 of each of four faces. Ours are those of ``convert --bare``, and of ``refit`` of fontTools' own drawings.
SVGO 4 runs with its defaults and two decimals; ``npm install svgo@4`` brings it, and ``--svgo`` says where it is.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from fontTools.pens.svgPathPen import SVGPathPen
from fontTools.pens.transformPen import TransformPen

import glyphspline as gs

from .survey import faces, parser, table

LATIN, HAN = "HambuRgefonstiQ", "永和九年歲在癸丑暮春之初會于稽"
FACES = {
    "DejaVuSans.ttf": LATIN, "EBGaramond12-Regular.otf": LATIN, "NotoSansCJK-Regular.ttc": HAN,
    "LXGWWenKai-Regular.ttf": HAN,
}  # fmt: skip


def drawings(pattern: str, text: str, bare: Path, plain: Path) -> None:
    """Write the drawings of a face: ours, and those of fontTools."""
    font = gs.open_font(faces(pattern)[0], face_index=0)
    glyphs = font.tables().getGlyphSet()
    for name in font.select(text=text):
        ours = gs.to_svg(gs.convert(font.outline(name)), bare=True)
        pen = SVGPathPen(glyphs)
        glyphs[name].draw(TransformPen(pen, (1, 0, 0, -1, 0, 0)))
        head = ours[: ours.index("<path")]
        (bare / f"{pattern}-{name}.svg").write_text(ours, encoding="utf-8")
        (plain / f"{pattern}-{name}.svg").write_text(f'{head}<path d="{pen.getCommands()}"/></svg>', encoding="utf-8")


def size(folder: Path, pattern: str) -> int:
    """Bytes of the drawings of a face."""
    return sum(file.stat().st_size for file in folder.glob(f"{pattern}-*.svg"))


def main() -> int:
    """Print the bytes of each face, and ratios."""
    asked = parser(__doc__, svgo="svgo").parse_args()
    with TemporaryDirectory() as place:
        bare, plain, small = (Path(place) / name for name in ("bare", "plain", "small"))
        for folder in (bare, plain, small):
            folder.mkdir()
        for pattern, text in FACES.items():
            drawings(pattern, text, bare, plain)
        command = [*shlex.split(asked.svgo), "-q", "--precision", "2", "-f", str(plain), "-o", str(small)]
        subprocess.run(command, check=True)
        refit = [sys.executable, "-m", "glyphspline", "refit", str(plain), "--in-place", "-q"]
        subprocess.run(refit, check=True)
        rows, total = [], [0, 0, 0]
        for pattern in FACES:
            own = [size(folder, pattern) for folder in (small, bare, plain)]
            total = [a + b for a, b in zip(total, own, strict=True)]
            rows.append([pattern, *own, *(f"{each / own[0]:.2f}" for each in own[1:])])
        rows.append(["all", *total, *(f"{each / total[0]:.2f}" for each in total[1:])])
    print(table(["face", "svgo", "convert --bare", "refit", "bare/svgo", "refit/svgo"], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
