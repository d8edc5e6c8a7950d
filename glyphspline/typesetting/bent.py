"""Text bent along a path: its outlines deformed so that its baseline becomes the path, within a tolerance."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..curves.bezier import cross, divided, sections
from ..curves.cubics import bernstein
from ..errors import GlyphsplineError, is_positive, require
from ..outlines.outline import Contour, Outline
from ..types import BoolArray, FloatArray, IntArray
from .along_path import MOST_NAMED, Letters, laid
from .path import SMOOTH, Path
from .placed import Layout
from .setting import Align, Side

SHARE = 0.1
"""Share of a tolerance that the bend takes. The rest is for the curves fitted to the bent outline."""

SAMPLES, BETWEEN = 33, 1.02
"""Places of each cubic where the error is measured. Factor on the largest error measured, for what lies between: at 513
places it was larger by 0.8 % at most."""

AT_ONCE = 4096
"""Cubics fitted at once: some 50 MB."""


def bend(
    layout: Layout,
    path: Path,
    tolerance: float,
    *,
    offset: float = 0.0,
    align: Align = "start",
    side: Side = "left",
) -> Outline:
    """Deform the outlines of a line of text so that its baseline becomes the path.

    The point (x, y) of the line goes to P(s) + y N(s), where s is the arc length that x comes to, P the path and N its
    normal to the left: vertical lines stay straight, horizontal ones run parallel to the path.

    Each segment becomes one cubic or more. Their ends and tangents are exact, so smooth joints stay smooth and corners
    stay corners; the handles are fitted by least squares. Small kinks of the path are rounded first, by
    :meth:`.Path.rounded`. Where the path's curvature jumps, a slanted line gets a corner, as the map has it.

    The distance to the deformed outline is measured at 33 places of each cubic, and taken 2 % larger.

    Args:
        layout: of one horizontal line. path: in font units. tolerance: two-sided distance allowed, in font units.
        offset, align, side: as for :func:`.along`.

    Returns:
        The outline of the whole text, in the path's coordinates. ``snapped`` is the largest distance
        seen from the deformed outline, so that :func:`.convert` keeps the rest of its tolerance for the fit.

    Raises:
        GlyphsplineError: as for :func:`.along`; the path has a corner under the text; or its radius is less than the
            height of the text on its inner side, where outlines would fold over.
        OptionError: an argument out of range.

    Example:
        >>> import glyphspline as gs
        >>> font = gs.open_font("fonts_test/kouzan-gyosho.ttf")
        >>> hill = gs.interpolate([[0, 0], [1500, 400], [3000, 0]], closed=False).spline
        >>> bent = gs.bend(gs.layout(font, "龍好"), gs.Path.of(hill), 0.1, align="center")
        >>> bent.snapped < 0.1, len(bent.contours)
        (True, 11)
    """
    require(is_positive(tolerance), "the tolerance of a bend is a positive distance", tolerance)
    layout, path, letters, start = laid(layout, path, offset, align, side)
    flat = layout.outline()
    if not len(flat.contours):
        return flat
    cubics = np.concatenate([contour.cubics() for contour in flat.contours])
    kept = (cubics != cubics[:, :1]).any(axis=(1, 2))
    contours = np.repeat(np.arange(len(flat.contours)), [len(contour) for contour in flat.contours])[kept]
    cubics, degrees = cubics[kept], flat.arrays.degrees[kept]
    height = float(np.abs(cubics[..., 1]).max())
    # Small kinks of the path are rounded by this radius, in heights of the text.
    smooth = path.rounded(4.0 * height) if height else path
    line = _Line(smooth, layout.text, letters, start, smooth.length / path.length, cubics)
    ends, turns, jumps = _joints(smooth, line.rounds)
    corner = np.abs(turns) > SMOOTH
    line.refuse_corners(ends[corner], turns[corner])
    # Radians by which a jump of the path's curvature may turn a line of the text without being kept as a joint.
    kept = corner | (np.abs(jumps) * height > 1e-4)
    cubics, parent = _cut(line.cubics, ends[kept])
    pieces, order, error, stretch = _fitted(line, cubics, tolerance)
    parent = parent[order]
    straight = (degrees[parent] == 1) & _straight(pieces)
    found = []
    for contour in np.unique(contours).tolist():
        own = np.flatnonzero(contours[parent] == contour)
        chosen = zip(pieces[own], straight[own].tolist(), strict=True)
        found.append(Contour.from_segments([piece[[0, 3]] if is_line else piece for piece, is_line in chosen]))
    notes = (*layout.notes, *flat.notes)
    if smooth.moved > path.moved:
        notes += (f"kinks of the path are rounded, which moves it by up to {smooth.moved - path.moved:.2g}",)
    error += flat.snapped * stretch
    return Outline(flat.name, flat.gid, flat.unicodes, flat.advance, found, flat.metrics, notes, error)


class _Line:
    """A line of text on its path: its segments with x as arc length, and which letter is where.

    Attributes:
        path: without small kinks. cubics: (m, 4, 2) of all glyphs.
        rounds: numbers of the periods of a closed path that the text lies on; (0,) for an open one.
    """

    def __init__(self, path: Path, text: str, letters: Letters, start: float, scale: float, cubics: FloatArray) -> None:
        self.path, self._text, self._letters = path, text, letters
        self._start, self._scale = start, scale
        self.cubics = cubics.copy()
        self.cubics[..., 0] = (cubics[..., 0] + start) * scale
        ends = np.array([self.cubics[..., 0].min(), self.cubics[..., 0].max()])
        first, last = np.floor(ends / path.length).tolist()
        self.rounds = np.arange(first, last + 1) if path.closed else np.zeros(1)

    def letter(self, s: float) -> str:
        """The letter at an arc length, for an error."""
        k = int(np.abs(self._letters.middle - (s / self._scale - self._start)).argmin())
        character = int(self._letters.character[k])
        return repr(self._text[character : character + 1])

    def refuse_corners(self, ends: FloatArray, turns: FloatArray) -> None:
        """Raise a GlyphsplineError if an outline passes over one of the corners at these arc lengths."""
        low, high = self.cubics[..., 0].min(axis=1), self.cubics[..., 0].max(axis=1)
        for end, turn in zip(ends.tolist(), turns.tolist(), strict=True):
            if ((low < end) & (high > end)).any():
                raise GlyphsplineError(
                    f"a corner of {np.degrees(abs(turn)):.3g} degrees at length {np.mod(end, self.path.length):.6g}, "
                    f"under {self.letter(end)}; text bends along smooth paths only",
                    font=self.path.name,
                )

    def fold(self, x: FloatArray, y: FloatArray, curvature: FloatArray) -> GlyphsplineError:
        """The error of outlines that fold over at points (x, y) of the line, where the path bends too sharply."""
        letters = list(dict.fromkeys([self.letter(s) for s in np.sort(x).tolist()]))
        letters = letters if len(letters) <= MOST_NAMED else [*letters[:MOST_NAMED], "…"]
        worst = int((curvature * y).argmax())
        where = np.mod(x[worst], self.path.length) if self.path.closed else x[worst]
        return GlyphsplineError(
            f"the path bends with a radius of {1 / abs(curvature[worst]):.4g} at length {where:.6g}, and the text "
            f"reaches {abs(y[worst]):.4g} to that side: {', '.join(letters)} would fold over",
            font=self.path.name,
        )


def _joints(path: Path, rounds: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Joints of a path's segments in all rounds: arc lengths, turns of the tangent, jumps of the curvature.

    The ends of an open path, where it goes on straight, are among them.
    """
    parts, turn, jump = path.joints
    ends = path.table.ends[parts]
    if not path.closed:
        first, last = path.frame([0.0, path.length], [1, -1]).curvature.tolist()
        ends, turn, jump = np.r_[0.0, ends, path.length], np.r_[0.0, turn, 0.0], np.r_[first, jump, -last]
    n = len(rounds)
    return (ends + path.length * rounds[:, None]).ravel(), np.tile(turn, n), np.tile(jump, n)


def _cut(cubics: FloatArray, places: FloatArray) -> tuple[FloatArray, IntArray]:
    """Cut cubics (m, 4, 2) where x is one of (k,) places; the parts in order, and which cubic each is of."""
    low, high = cubics[..., 0].min(axis=1), cubics[..., 0].max(axis=1)
    cuts: dict[int, list[float]] = {}
    for place in places.tolist():
        for k in np.flatnonzero((low < place) & (high > place)).tolist():
            a, b, c, d = (cubics[k, :, 0] - place).tolist()
            roots = np.roots([d - 3 * c + 3 * b - a, 3 * (c - 2 * b + a), 3 * (b - a), a])
            real = roots.real[np.abs(roots.imag) < 1e-9]
            cuts.setdefault(k, []).extend(real[(real > 1e-9) & (real < 1 - 1e-9)].tolist())
    if not cuts:
        return cubics, np.arange(len(cubics))
    parts = [
        (k, a, b) for k in range(len(cubics)) for a, b in pairwise([0.0, *sorted(cuts.get(k, ())), 1.0]) if b - a > 1e-9
    ]
    of, first, last = map(np.array, zip(*parts, strict=True))
    return sections(cubics[of], first, last), of


def _fitted(line: _Line, cubics: FloatArray, tolerance: float) -> tuple[FloatArray, IntArray, float, float]:
    """Cubics (k, 4, 2) within the tolerance of the deformed ones, and which cubic each is of.

    Also the largest error seen, and the largest stretch of lengths. A cubic is divided evenly into as few parts as
    will do.
    """
    count, todo = np.ones(len(cubics), dtype=np.int64), np.arange(len(cubics))
    pieces, parents, worst, stretch = [], [], 0.0, 1.0
    while len(todo):
        parts, of = divided(cubics[todo], count[todo])
        of = todo[of]
        found = [_fit(line, parts[k : k + AT_ONCE], tolerance) for k in range(0, len(of), AT_ONCE)]
        fit, error, stretched = (np.concatenate(column) for column in zip(*found, strict=True))
        stretch = max(stretch, float(stretched.max()))
        most = np.zeros(len(cubics))
        np.maximum.at(most, of, error)
        good = most[of] <= tolerance
        pieces.append(fit[good])
        parents.append(of[good])
        worst = max(worst, float(error[good].max(initial=0.0)))
        todo = todo[most[todo] > tolerance]
        more = np.minimum(0.9 * (most[todo] / tolerance) ** (1 / 6), 2.0) * count[todo]
        count[todo] = np.maximum(np.ceil(more).astype(np.int64), count[todo] + 1)
        # Pieces of one segment. Next to a fold more and more are needed.
        if len(todo) and count[todo].max() > 512:
            k = int(todo[count[todo].argmax()])
            raise GlyphsplineError(
                f"{line.letter(float(cubics[k, :, 0].mean()))} cannot be bent within {tolerance:g}: "
                "the path bends too sharply there, or the tolerance is too small",
                font=line.path.name,
            )
    parent = np.concatenate(parents)
    order = np.argsort(parent, kind="stable")
    return np.concatenate(pieces)[order], parent[order], worst, stretch


def _fit(line: _Line, parts: FloatArray, tolerance: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """A cubic for each deformed one, (k, 4, 2), the largest error seen, and the stretch of lengths along the path.

    It has the arms of the deformed control polygon; where these are not near enough their lengths are fitted.

    Raises:
        GlyphsplineError: one folds over.
    """
    from ..fitting.sharp.cubics import fit_cubic

    basis = bernstein(SAMPLES - 1)
    x, y = np.einsum("jp,kjc->ckp", basis, parts)
    points, T, kappa = line.path.frame(x)
    N = np.stack([-T[..., 1], T[..., 0]], axis=-1)
    shrink = 1 - kappa * y
    if (folded := shrink <= 0).any():
        raise line.fold(x[folded], y[folded], kappa[folded])
    target = points + y[..., None] * N
    first, last = _mapped_arm(line.path, parts, 0), _mapped_arm(line.path, parts, 3)
    pieces = np.stack([target[:, 0], target[:, 0] + first, target[:, -1] - last, target[:, -1]], axis=1)
    error = np.sqrt(((np.einsum("jp,kjc->kpc", basis, pieces) - target) ** 2).sum(axis=2).max(axis=1))
    # Share of the tolerance below which a cubic's handles are not fitted any more.
    enough, handles = 0.5 * tolerance, np.empty((2, 2))
    for k in np.flatnonzero(error > enough).tolist():
        ways = np.stack([first[k] / np.hypot(*first[k]), last[k] / np.hypot(*last[k])])
        # Fits of a cubic's handles to the points of its deformed one.
        off = fit_cubic(target[k], ways, (False, False), enough, 8, handles)
        if off < error[k]:
            arms = handles * (np.hypot(*(target[k, -1] - target[k, 0])) / 3)
            pieces[k, 1:3], error[k] = [target[k, 0] + arms[0], target[k, -1] - arms[1]], off
    return pieces, BETWEEN * error, shrink.max(axis=1)


def _mapped_arm(path: Path, parts: FloatArray, end: int) -> FloatArray:
    """(k, 2) the first arm of each deformed cubic's control polygon, or the last: ``end`` is 0 or 3.

    Where control points coincide with the end, it has the direction that the cubic has there.
    """
    here = parts[:, end]
    arms = (parts - here[:, None])[:, [1, 2, 3] if end == 0 else [2, 1, 0]]
    if end:
        arms = -arms
    long = np.abs(arms).max(axis=2) > 1e-9 * np.abs(arms).max(axis=(1, 2))[:, None]
    arm = arms[np.arange(len(arms)), long.argmax(axis=1)]
    forward = np.sign(arm[:, 0])
    _, T, kappa = path.frame(here[:, 0], -forward if end else forward)
    N = np.stack([-T[:, 1], T[:, 0]], axis=1)
    return ((1 - kappa * here[:, 1]) * arm[:, 0])[:, None] * T + arm[:, 1:] * N


def _straight(pieces: FloatArray) -> BoolArray:
    """(k,) whether all control points lie on the chord, in order."""
    chord = pieces[:, 3] - pieces[:, 0]
    arms = pieces[:, 1:3] - pieces[:, :1]
    square = (chord * chord).sum(axis=1)
    off = np.abs(cross(chord[:, None], arms)).max(axis=1)
    share = (arms * chord[:, None]).sum(axis=2)
    ordered = (share[:, 0] >= 0) & (share[:, 0] <= share[:, 1]) & (share[:, 1] <= square)
    return (off <= 1e-9 * square) & ordered
