"""Whether plain Python writes the same bytes as compiled code: drawings, curvature maps and the manifest.

``python -m scripts.same_bytes [--glyphs 10] [--seed 0] [--faces sans,garamond] [--ways sharp,smooth,step,count]``

Glyphs are drawn from installed faces, those of Debian packages or in a folder of GLYPHSPLINE_FACES; those that are not
installed are skipped. Glyphs that no designer draws are among them: coincident points, flat contours, huge ones, and
coordinates that are no numbers. Each way to convert them is one run of the command as plain Python, whose
``np.empty`` is filled with what no program means, and one with compiled code, which is made first. Every file that
differs is named, and every glyph whose line of the manifest does. The exit status is 1 if there are any.
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from glyphspline import open_font
from glyphspline.code_files import OFF
from glyphspline.runs.warm import warm

from .survey import faces, parser, table

FACES = {
    "sans": "DejaVuSans.ttf",
    "serif": "DejaVuSerif.ttf",
    "garamond": "EBGaramond12-Regular.otf",
    "noto": "NotoSansCJK-Regular.ttc",
    "wenkai": "LXGWWenKai-Regular.ttf",
    "inter": "Inter-Regular.otf",
}

WAYS = {
    "sharp": ["--corners", "sharp"],
    "smooth": ["--corners", "smooth"],
    "step": ["--step", "40"],
    "count": ["--count", "24"],
}

KINDS = ("sharp", "smooth", "fixed", "drawings")
"""Kinds of work of all ways."""

RUN = """
import sys
import numpy as np

def filled(make):
    def made(*args, **options):
        found = make(*args, **options)
        if found.dtype.kind in "fc":
            found[...] = np.nan
        elif found.dtype.kind in "iu":
            found[...] = np.iinfo(found.dtype).max
        elif found.dtype.kind == "b":
            found[...] = True
        return found
    return made

if sys.argv.pop(1) == "plain":
    np.empty, np.empty_like = filled(np.empty), filled(np.empty_like)
from glyphspline.cli import main
main()
"""
"""The command, in one process. Compiled code reads what is in memory that nothing was written to; plain code is given
the worst."""

CONTOURS: dict[str, list[tuple[float, float]]] = {
    "coincident": [(100, 100)] * 8,
    "twice": [(0, 0), (0, 0), (500, 0), (500, 0), (500, 700), (500, 700), (0, 700), (0, 700)],
    "flat": [(0, 0), (250, 0), (500, 0), (800, 0)],
    "thin": [(0, 0), (500, 0.25), (900, 0), (500, 0.5)],
    "tiny": [(0, 0), (1e-7, 0), (1e-7, 1e-7), (0, 1e-7)],
    "huge": [(0, 0), (1e5, 0), (1e5, 1e5), (0, 1e5)],
    "vast": [(0, 0), (1e200, 0), (1e200, 1e200), (0, 1e200)],
    "back": [(0, 0), (500, 0), (500, 700), (500, 0), (0, 0), (0, 300)],
    "crossed": [(0, 0), (500, 700), (500, 0), (0, 700)],
    "nothing": [(0, 0), (float("nan"), 0), (500, 700)],
}
"""Contours that no designer draws, of lines."""


def odd_glyphs(folder: Path) -> Path:
    """A UFO of these contours, each as lines and as one loop of curves."""
    glyphs = folder / "glyphs"
    glyphs.mkdir(parents=True)
    entries = []
    for name, points in CONTOURS.items():
        for curved in (False, True):
            own = f"{name}{'.round' * curved}"
            file, lines = f"{own}.glif", list(_points(points, curved))
            entries.append(f"<key>{own}</key><string>{file}</string>")
            text = f'<glyph name="{own}" format="2"><advance width="600"/><outline><contour>{"".join(lines)}'
            (glyphs / file).write_text(f'<?xml version="1.0"?>\n{text}</contour></outline></glyph>\n')
    about = "<key>creator</key><string>script</string><key>formatVersion</key><integer>3</integer>"
    _plist(folder / "metainfo.plist", about)
    _plist(folder / "fontinfo.plist", "<key>unitsPerEm</key><integer>1000</integer>")
    _plist(glyphs / "contents.plist", "".join(entries))
    layers = "<array><array><string>public.default</string><string>glyphs</string></array></array>"
    (folder / "layercontents.plist").write_text(f'<?xml version="1.0"?>\n<plist version="1.0">{layers}</plist>\n')
    return folder


def _points(points: Sequence[tuple[float, float]], curved: bool) -> Iterator[str]:
    for k, (x, y) in enumerate(points):
        kind = "" if curved and k % 3 else f' type="{"curve" if curved else "line"}"'
        yield f'<point x="{x}" y="{y}"{kind}/>'


def _plist(path: Path, content: str) -> None:
    path.write_text(f'<?xml version="1.0"?>\n<plist version="1.0"><dict>{content}</dict></plist>\n')


def convert(font: Path, out: Path, words: Sequence[str], is_plain: bool) -> None:
    """Run the command in a process of its own."""
    formats = ["--format", "svg,source,curvature"]
    call = ["convert", str(font), "--quiet", "--jobs", "0", *formats, "--out", str(out), *words]
    environment = {name: value for name, value in os.environ.items() if name != OFF}
    run = subprocess.run(
        [sys.executable, "-c", RUN, "plain" if is_plain else "compiled", *call],
        env=environment | ({OFF: "1"} if is_plain else {}),
        capture_output=True,
        text=True,
    )
    if run.returncode not in (0, 1):
        raise RuntimeError(run.stderr)


def differences(one: Path, other: Path) -> list[str]:
    """Files of two runs that differ or are not in both; of the manifest the lines that do."""
    found = []
    names = {path.relative_to(folder) for folder in (one, other) for path in folder.rglob("*") if path.is_file()}
    for name in sorted(names - {Path("run.json")}):
        texts = [(folder / name).read_text(encoding="utf-8").splitlines() if (folder / name).exists() else []
                 for folder in (one, other)]  # fmt: skip
        if name.name == "manifest.jsonl":
            found += [line[:60] for line in sorted({*texts[0]} ^ {*texts[1]})]
        elif texts[0] != texts[1]:
            found.append(name.as_posix())
    return found


def compared(font: Path, words: Sequence[str]) -> list[str]:
    """Convert glyphs of a font both ways, and name what differs."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("plain", "compiled"):
            convert(font, Path(folder) / name, words, name == "plain")
        return differences(Path(folder) / "plain", Path(folder) / "compiled")


def words_for(font: Path, glyphs: int, seed: int) -> list[str]:
    """Options that take glyphs of a font at random."""
    names = [*open_font(font).glyph_names]
    return ["--glyphs", ",".join(random.Random(seed).sample(names, min(glyphs, len(names))))]


def main() -> int:
    """The command."""
    options = parser(__doc__, glyphs=10, seed=0, faces=",".join([*FACES, "odd"]), ways=",".join(WAYS)).parse_args()
    warm(None, KINDS)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for face in options.faces.split(","):
            found = [odd_glyphs(Path(folder) / "odd.ufo")] if face == "odd" else faces(FACES[face])
            for font in found[:1]:
                words = ["--all"] if face == "odd" else words_for(font, options.glyphs, options.seed)
                for way in options.ways.split(","):
                    unlike = compared(font, [*words, *WAYS[way]])
                    rows.append((face, way, len(unlike), " ".join(unlike[:6])))
                    print(*rows[-1], flush=True)
    print(table(("face", "way", "differences", "first"), rows))
    return int(any(row[2] for row in rows))


if __name__ == "__main__":
    sys.exit(main())
