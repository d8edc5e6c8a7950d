"""What programs that look at many cases share: faces that are installed, processes, tables, and distances of curves."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, TypeVar

import matplotlib
import numpy as np
from fontTools.pens.basePen import BasePen
from scipy.spatial import cKDTree

from glyphspline.curves.bezier import evaluate
from glyphspline.types import FloatArray

Found = TypeVar("Found")

ROOT = Path(__file__).parents[1]
PLACES = [Path(p) for p in os.environ.get("GLYPHSPLINE_FACES", "").split(os.pathsep) if p]
PLACES += [ROOT / "fonts_test", Path("/usr/share/fonts"), Path(matplotlib.get_data_path()) / "fonts"]


def parser(text: str | None, /, **options: Any) -> argparse.ArgumentParser:
    """A parser of options, by their names with their defaults, whose help is a module's docstring."""
    made = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, usual in options.items():
        how: dict[str, Any] = {"action": "store_true"} if usual is False else {"type": type(usual), "default": usual}
        made.add_argument(f"--{name.replace('_', '-')}", help=f"{usual} if not given", **how)
    return made


def surveyed(look: Callable[..., Found], *arguments: Iterable[Any], jobs: int, chunk: int = 1) -> Iterator[Found]:
    """What processes find, in order, as by ``map``."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(look, *arguments, chunksize=chunk)


def table(headings: Sequence[str], rows: Iterable[Sequence[object]] = ()) -> str:
    """A table in Markdown; without rows, its head."""
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join(f"| {' | '.join(map(str, cells))} |" for cells in lines).replace("| --- ", "|---")


def faces(pattern: str) -> list[Path]:
    """Files of a face that is installed, or lies in a folder of GLYPHSPLINE_FACES."""
    return sorted(path for place in PLACES for path in place.rglob(pattern))


class SegmentPen(BasePen):  # type: ignore[misc, unused-ignore]
    """The segments of a glyph, components decomposed, those of no length too: instances then have the same ones."""

    def __init__(self, glyphs: Any = None) -> None:
        super().__init__(glyphs)
        self.contours: list[list[FloatArray]] = []

    def _moveTo(self, point: Any) -> None:  # noqa: N802
        self.contours.append([])
        self.first = point

    def _add(self, *points: Any) -> None:
        self.contours[-1].append(np.array([self._getCurrentPoint(), *points], dtype=np.float64))

    _lineTo = _curveToOne = _qCurveToOne = _add  # noqa: N815

    def _closePath(self) -> None:  # noqa: N802
        self._add(self.first)  # of no length where the outline comes back by itself

    _endPath = _closePath  # noqa: N815


def sampled(segments: Iterable[FloatArray], spacing: float) -> FloatArray:
    """(n, 2) points on all segments, both ends included, at most about ``spacing`` apart."""
    points = [np.empty((0, 2))]
    for segment in segments:
        reach = np.hypot(*np.diff(segment, axis=0).T).sum()
        x = np.linspace(0, 1, int(np.ceil(reach / spacing)) + 1)
        points.append(evaluate(np.broadcast_to(segment, (len(x), *segment.shape)), x))
    return np.concatenate(points)


def distances(points: FloatArray, line: FloatArray, *, closed: bool = True) -> FloatArray:
    """(n,) distances of points from a polyline, sought on the chords beside its three nearest vertices.

    Three, as where two segments join a vertex comes twice.
    """
    nearest = cKDTree(line).query(points, k=min(3, len(line)))[1].reshape(len(points), -1)
    found = np.full(len(points), np.inf)
    for k in nearest.T:
        for step in (-1, 1):
            a, b = line[k], line[(k + step) % len(line) if closed else np.clip(k + step, 0, len(line) - 1)]
            chord = b - a
            along = ((points - a) * chord).sum(axis=1) / np.maximum((chord**2).sum(axis=1), 1e-300)
            found = np.minimum(found, np.hypot(*(points - a - np.clip(along, 0, 1)[:, None] * chord).T))
    return found
