"""Helpers of the tests on written variable fonts: curves to write, and what HarfBuzz draws of them."""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
import uharfbuzz as hb
from fontTools.pens.recordingPen import RecordingPen
from fontTools.ttLib import TTFont
from scipy.interpolate import BSpline, make_interp_spline, make_lsq_spline

from glyphspline.curves.bezier import evaluate
from glyphspline.curves.cubics import turns
from glyphspline.outlines.masters import MasterContour, Masters
from glyphspline.plugins.masters.redrawn import Redrawn
from glyphspline.types import BoolArray, FloatArray

CORNER = np.radians(12)


def as_it_is(masters: Masters) -> Redrawn:
    """The source's own contours as cubics; its smooth joints of curves count as inner ones."""
    contours = [
        MasterContour(c.cubics()[:, :, :3].reshape(len(masters), -1, 2), 0 * c.degrees + 3) for c in masters.contours
    ]
    kept = [
        MasterContour(c.points, c.degrees) if (c.degrees == 1).any() else r
        for c, r in zip(masters.contours, contours, strict=True)
    ]
    return Redrawn(masters, tuple(kept), tuple(np.zeros(len(c), dtype=bool) for c in kept))


def joined(contour: MasterContour) -> BoolArray:
    """(m,) whether a joint is inside an arc: no corner in any master, and between two curves."""
    turn = np.array([np.abs(turns(master, 1e-6)) for master in contour.cubics()]).max(axis=0)
    curved = contour.degrees > 1
    return np.asarray((turn < CORNER) & curved & np.roll(curved, 1))


def refitted(masters: Masters, density: float = 1.5) -> Redrawn:
    """The glyph's arcs as C2 splines in all masters at once: one least-squares spline in R^2K for each arc."""
    contours, inner = [], []
    for contour in masters.contours:
        new, joints = _refit(contour, density)
        contours.append(new)
        inner.append(joints)
    return Redrawn(masters, tuple(contours), tuple(inner))


def _refit(contour: MasterContour, density: float) -> tuple[MasterContour, BoolArray]:
    cubics, count = contour.cubics(), len(contour)
    smooth = joined(contour)
    if smooth.all():
        points = _samples(cubics, 12)
        knots = _chords(np.concatenate([points, points[:1]]))
        keep = np.unique(np.linspace(0, len(points), int(density * count) + 3).astype(int))
        spline = make_interp_spline(knots[keep], np.concatenate([points, points[:1]])[keep], k=3, bc_type="periodic")
        pieces = _beziers(spline, len(cubics))
        return _contour([pieces], [3]), np.ones(pieces.shape[1], dtype=bool)
    starts = np.flatnonzero(~smooth)
    stops = [*starts[1:], starts[0] + count]
    parts, degrees, joints = [], [], []
    for start, stop in zip(starts, stops, strict=True):
        span = np.arange(start, stop) % count
        if len(span) == 1 and contour.degrees[span[0]] == 1:
            parts.append(cubics[:, span])
            degrees.append(1)
            joints.append([False])
            continue
        points = np.concatenate(
            [_samples(cubics[:, span], 24), cubics[:, span[-1:], 3].transpose(1, 0, 2).reshape(1, -1)]
        )
        places = _chords(points)
        number = int(density * len(span))
        inside = np.interp(np.arange(1, number + 1) / (number + 1), np.linspace(0, 1, len(places)), places)
        knots = np.r_[[0.0] * 4, inside, [places[-1]] * 4]
        weights = np.ones(len(places))
        weights[[0, -1]] = 1e3
        spline = make_lsq_spline(places, points, knots, 3, w=weights)
        c = spline.c.reshape(len(spline.c), len(cubics), 2).copy()
        c[0], c[-1] = cubics[:, span[0], 0], cubics[:, span[-1], 3]
        before, after = cubics[:, span[0] - 1], cubics[:, (span[-1] + 1) % count]
        if contour.degrees[span[0] - 1] == 1:
            c[1] = _along(c[0], c[1], before[:, 3] - before[:, 0])
        if contour.degrees[(span[-1] + 1) % count] == 1:
            c[-2] = _along(c[-1], c[-2], after[:, 0] - after[:, 3])
        pieces = _beziers(BSpline(knots, c.reshape(len(c), -1), 3), len(cubics))
        parts.append(pieces)
        degrees.append(3)
        joints.append([False, *[True] * (pieces.shape[1] - 1)])
    return _contour(parts, degrees), np.concatenate(joints)


def _along(end: FloatArray, handle: FloatArray, line: FloatArray) -> FloatArray:
    """The handle on the line's direction, if it was near it in all masters."""
    arm = handle - end
    cross = arm[:, 0] * line[:, 1] - arm[:, 1] * line[:, 0]
    angle = np.abs(np.arctan2(cross, (arm * line).sum(axis=1)))
    return end + line * (arm * line).sum() / (line**2).sum() if angle.max() < CORNER else handle


def _samples(cubics: FloatArray, per: int) -> FloatArray:
    masters, count = cubics.shape[:2]
    x = np.tile(np.arange(per) / per, count)
    chosen = np.repeat(cubics, per, axis=1).reshape(-1, 4, 2)
    return evaluate(chosen, np.tile(x, masters)).reshape(masters, -1, 2).transpose(1, 0, 2).reshape(len(x), -1)


def _chords(points: FloatArray) -> FloatArray:
    return np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1) + 1e-9)]


def _beziers(spline: Any, masters: int) -> FloatArray:
    """(K, m, 4, 2) the pieces of a cubic spline in R^2K."""
    ends = np.unique(spline.t[3:-3] if len(spline.t) > len(spline.c) else spline.t)
    width = np.diff(ends)[:, None]
    at, slope = spline(ends), spline(ends, 1)
    pieces = np.stack([at[:-1], at[:-1] + width * slope[:-1] / 3, at[1:] - width * slope[1:] / 3, at[1:]], axis=1)
    return np.asarray(pieces.reshape(len(pieces), 4, masters, 2).transpose(2, 0, 1, 3))


def _contour(parts: list[FloatArray], kinds: list[int]) -> MasterContour:
    points = [
        p[:, :, :3].reshape(len(p), -1, 2) if kind == 3 else p[:, :, 0] for p, kind in zip(parts, kinds, strict=True)
    ]
    degrees = np.concatenate([np.full(p.shape[1], kind) for p, kind in zip(parts, kinds, strict=True)])
    return MasterContour(np.concatenate(points, axis=1), degrees)


class Drawing:
    """A font as HarfBuzz draws it, at normalised locations."""

    def __init__(self, data: bytes) -> None:
        self.font = hb.Font(hb.Face(hb.Blob(data)))

    def at(self, location: FloatArray) -> None:
        self.font.set_var_coords_normalized([float(value) for value in location])

    def contours(self, gid: int) -> list[list[FloatArray]]:
        """The segments of each contour, (degree + 1, 2), without closing lines of no length."""
        pen = RecordingPen()
        self.font.draw_glyph_with_pen(gid, pen)
        found: list[list[FloatArray]] = []
        for operator, points in pen.value:
            if operator == "moveTo":
                start = at = np.array(points[0])
                found.append([])
            elif operator == "closePath":
                if np.hypot(*(start - at)) > 2e-3:
                    found[-1].append(np.array([at, start]))
            else:
                segment = np.array([at, *points])
                at = segment[-1]
                if len(segment) > 2 or np.hypot(*(segment[1] - segment[0])) > 2e-3:
                    found[-1].append(segment)
        return found


def turns_of(segments: list[FloatArray]) -> FloatArray:
    """(m,) degrees by which the direction changes where each segment begins."""
    leaving = np.array([_direction(s) for s in segments])
    arriving = np.roll([-_direction(s[::-1]) for s in segments], 1, axis=0)
    cross = arriving[:, 0] * leaving[:, 1] - arriving[:, 1] * leaving[:, 0]
    return np.degrees(np.abs(np.arctan2(cross, (arriving * leaving).sum(axis=1))))


def _direction(points: FloatArray) -> FloatArray:
    arms = points[1:] - points[0]
    return arms[np.argmax(np.hypot(*arms.T) > 1e-3)]


def dense(segments: list[FloatArray], per: int) -> FloatArray:
    x = np.arange(per) / per
    return np.concatenate([evaluate(np.repeat(s[None], per, 0), x) for s in segments])


def apart(one: FloatArray, other: FloatArray) -> float:
    """The largest distance of points (n, 2) from a closed polygon (m, 2)."""
    a, b = other, np.roll(other, -1, axis=0)
    arm = b - a
    worst = 0.0
    for points in np.array_split(one, len(one) // 256 + 1):
        off = points[:, None] - a
        x = np.clip((off * arm).sum(axis=2) / np.maximum((arm**2).sum(axis=1), 1e-12), 0, 1)
        gap = off - x[..., None] * arm
        worst = max(worst, float(np.sqrt((gap**2).sum(axis=2).min(axis=1)).max()))
    return worst


def changed_tables(before: bytes, after: bytes) -> set[str]:
    """The tables that differ; of ``head`` the checksum of the whole file does not count."""
    one, two = TTFont(BytesIO(before)), TTFont(BytesIO(after))
    tags = set(one.reader.keys()) | set(two.reader.keys())
    return {tag for tag in tags if tag not in one or tag not in two or _raw(one, tag) != _raw(two, tag)}


def _raw(font: TTFont, tag: str) -> bytes:
    data = bytes(font.reader[tag])
    return data[:8] + data[12:] if tag == "head" else data


@dataclass
class Shaper:
    """A page of text as HarfBuzz shapes it."""

    data: bytes

    def positions(self, text: str, location: FloatArray) -> list[tuple[int, ...]]:
        font = hb.Font(hb.Face(hb.Blob(self.data)))
        font.set_var_coords_normalized([float(value) for value in location])
        buffer = hb.Buffer()
        buffer.add_str(text)
        buffer.guess_segment_properties()
        hb.shape(font, buffer)
        return [
            (i.codepoint, i.cluster, p.x_advance, p.y_advance, p.x_offset, p.y_offset)
            for i, p in zip(buffer.glyph_infos, buffer.glyph_positions, strict=True)
        ]
