"""Crossings of drawn outlines, counted in exact arithmetic from what is written and from what the font holds.

It shares nothing with the package: outlines come from the text of an SVG file or from a font's tables through
fontTools, with whole numbers for coordinates, and polynomial algebra decides. To find where a piece B crosses a piece
A, the implicit equation of A, which is the determinant of a Bézout matrix, is evaluated along B: a polynomial whose
roots of odd multiplicity are the places where B changes sides of the algebraic curve. The same matrix gives A's
parameter at a root, so whether the root lies on A itself is a question of signs. Roots are isolated by Descartes' rule
in the Bernstein basis. Where a joint of two pieces lies on another strand, the directions in which the four branches
leave the common point decide, and among branches of one direction their power series. A piece's own loop is at the two
roots of a quadratic equation.

Counted are places where two strands change sides. Touching does not count, nor does a stretch where strands coincide.
Not counted either is what a third strand does exactly at the double point of a loop that is a single piece.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import cmp_to_key, reduce
from itertools import pairwise, product
from math import factorial, isqrt, lcm
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from fontTools.pens.recordingPen import DecomposingRecordingPen

Vector: TypeAlias = tuple[Any, Any]
"""A point or vector of whole numbers, or of fractions."""
Piece: TypeAlias = tuple[Vector, ...]
"""Control points of a line, quadratic or cubic."""
Poly: TypeAlias = list[Any]
"""Coefficients of a polynomial, the constant first; or in the Bernstein basis, where so said."""

SMALL = 2**29
"""Coordinates below it have products that 64 bits hold; others are Python's own numbers in NumPy's arrays."""

DEPTH, MOST_DEPTH = 40, 600
"""Halvings after which multiple roots are taken apart, and after which there is something wrong."""


class Drawing(NamedTuple):
    """Closed contours of pieces in whole numbers, y up, ``unit`` of which are one font unit."""

    unit: int
    contours: list[list[Piece]]


# Reading


def path_contours(data: str) -> Drawing:
    """The contours of SVG path data: M, L, H, V, C, S, Q, T and Z, absolute and relative. Y is turned upwards."""
    tokens = re.findall(r"[A-Za-z]|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", data)
    numbers = {token: Decimal(token) for token in tokens if not token.isalpha()}
    places = max([0, *(-int(value.as_tuple().exponent) for value in numbers.values())])
    whole = {token: int(value.scaleb(places)) for token, value in numbers.items()}
    contours: list[list[Piece]] = []
    pieces: list[Piece] = []
    at = start = (0, 0)
    command, k = "", 0

    def close(even_if_empty: bool = False) -> None:
        if pieces and at != start:
            pieces.append((at, start))
        if pieces or even_if_empty:
            contours.append(list(pieces))
        pieces.clear()

    while k < len(tokens):
        if tokens[k].isalpha():
            command, k = tokens[k], k + 1
        kind, relative = command.upper(), command.islower()
        if kind == "Z":
            close(even_if_empty=True)
            at = start
            continue
        count = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2}[kind]
        values, k = [whole[token] for token in tokens[k : k + count]], k + count
        x, y = at if relative else (0, 0)
        if kind in "HV":
            points = [(values[0] + x, at[1]) if kind == "H" else (at[0], values[0] + y)]
        else:
            points = [(values[j] + x, values[j + 1] + y) for j in range(0, count, 2)]
        if kind == "M":
            close()
            start = points[0]
            command = "l" if relative else "L"
        else:
            if kind in "ST":
                before = pieces[-1] if pieces and len(pieces[-1]) == 2 + (kind == "S") + 1 else (at, at)
                points.insert(0, (2 * at[0] - before[-2][0], 2 * at[1] - before[-2][1]))
            pieces.append((at, *points))
        at = points[-1]
    close()
    return Drawing(10**places, [[tuple((x, -y) for x, y in piece) for piece in pieces] for pieces in contours])


def svg_contours(svg: str) -> Drawing:
    """The contours of the result in an SVG document that the package wrote."""
    found = re.findall(r'<path[^>]* d="([^"]*)"', svg)
    if len(found) != 1:
        raise ValueError(f"{len(found)} outlines in the SVG document, not one")
    return path_contours(found[0])


def font_contours(glyph_set: Any, name: str) -> Drawing:
    """The contours of a glyph of a fontTools glyph set, those left out that enclose nothing."""
    pen = DecomposingRecordingPen(glyph_set)
    glyph_set[name].draw(pen)
    contours: list[list[Piece]] = []
    at: Vector = (0, 0)
    start = at
    for operator, arguments in pen.value:
        points: list[Any] = [p and (Fraction(p[0]), Fraction(p[1])) for p in arguments]
        if operator == "moveTo":
            contours.append([])
            start = at = points[0]
        elif operator == "lineTo" or (operator == "curveTo" and len(points) == 3):
            contours[-1].append((at, *points))
            at = points[-1]
        elif operator == "qCurveTo":
            if points[-1] is None:  # no point is on the curve
                contours.append([])
                start = at = points[-1] = _middle(points[-2], points[0])
            for k, off in enumerate(points[:-1]):
                end = points[-1] if k == len(points) - 2 else _middle(off, points[k + 1])
                contours[-1].append((at, off, end))
                at = end
            if len(points) == 1:
                contours[-1].append((at, points[0]))
                at = points[0]
        elif operator in ("closePath", "endPath"):
            if at != start:
                contours[-1].append((at, start))
                at = start
        else:
            raise ValueError(f"{operator} with {len(points)} points")
    contours = [pieces for pieces in contours if not _collinear([p for piece in pieces for p in piece])]
    unit = lcm(*(x.denominator for pieces in contours for piece in pieces for p in piece for x in p))
    return Drawing(unit, [[tuple((int(x * unit), int(y * unit)) for x, y in p) for p in c] for c in contours])


def _middle(p: Vector, q: Vector) -> Vector:
    return (p[0] + q[0]) / 2, (p[1] + q[1]) / 2


# Areas and what went wrong


def area(drawing: Drawing, contour: int) -> Fraction:
    """The signed area of a contour in square units, positive where it is counter-clockwise."""
    total = 0
    for piece in drawing.contours[contour]:
        x, y = power(piece)
        for i, j in product(range(len(x)), repeat=2):
            if i != j:
                total += x[i] * y[j] * (j - i) * (60 // (i + j))
    return Fraction(total, 120 * drawing.unit**2)


def defects(written: Drawing | str, source: Drawing) -> tuple[dict[tuple[int, int], int], list[int]]:
    """What is wrong with the topology of a glyph as written: its new crossings, and its collapsed contours.

    Args:
        written: the SVG document that the package wrote, or its contours.
        source: the glyph's contours as the font holds them, in the same order.

    Returns:
        For each contour i that crosses itself more often than its source, (i, i) and how many times more, and likewise
        (i, j) for each pair i < j; and the contours without area, or with area of the other sign than the source's,
        if that has an area and does not cross itself.

    Raises:
        ValueError: there are not as many contours as in the source.
    """
    result = svg_contours(written) if isinstance(written, str) else written
    if len(result.contours) != len(source.contours):
        raise ValueError(f"{len(result.contours)} contours are written, of {len(source.contours)}")
    given = crossings(source)
    # Two closed curves cross an even number of times. If it is odd, they change sides along a stretch they share.
    whole = {pair: count + (count % 2 if pair[0] != pair[1] else 0) for pair, count in given.items()}
    more = {pair: count - whole.get(pair, 0) for pair, count in crossings(result).items()}
    areas = [(area(result, k), area(source, k)) for k in range(len(source.contours))]
    collapsed = [k for k, (own, its) in enumerate(areas) if its and own * its <= 0 and (k, k) not in given]
    return {pair: count for pair, count in more.items() if count > 0}, collapsed


def unflagged(found: dict[tuple[int, int], int], collapsed: list[int], measures: Sequence[Any]) -> list[str]:
    """The :func:`defects` of a glyph of which the measures of its contours say nothing, each in words.

    A crossing of two contours has to be in ``new_crossings`` of both. None says that crossings were not counted.
    """
    silent = [pair for pair in found if any(measures[k].new_crossings == 0 for k in pair)]
    still = [k for k in collapsed if not getattr(measures[k], "collapsed", False)]
    return [
        *(f"{found[i, j]} crossings of contours {i} and {j}" for i, j in silent if i != j),
        *(f"{found[i, j]} crossings of contour {i} with itself" for i, j in silent if i == j),
        *(f"contour {k} has collapsed" for k in still),
    ]


# Crossings


def crossings(drawing: Drawing) -> dict[tuple[int, int], int]:
    """How often each contour i crosses itself, (i, i), and each two i < j cross; pairs that do not are left out."""
    contours = [_simple(pieces) for pieces in drawing.contours]
    pieces = [piece for contour in contours for piece in contour]
    if not pieces:
        return {}
    owner = [k for k, contour in enumerate(contours) for _ in contour]
    after = [first + (j + 1) % len(c) for first, c in _offsets(contours) for j in range(len(c))]
    before = {b: a for a, b in enumerate(after)}
    found: dict[tuple[int, int], int] = defaultdict(int)
    largest = max(max(abs(x), abs(y)) for piece in pieces for x, y in piece)
    points = np.array(
        [[*piece, *[piece[-1]] * (4 - len(piece))] for piece in pieces], dtype=np.int64 if largest < SMALL else object
    )
    for k, piece in enumerate(pieces):
        found[owner[k], owner[k]] += _loops(piece)
    for a, b in _near(points):
        found[owner[a], owner[b]] += _inside(pieces[a], pieces[b])
    for (a, s), (b, t) in _contacts(pieces, points, before, after):
        branches = [*_branches(pieces, before, a, s, 0), *_branches(pieces, before, b, t, 1)]
        if _alternate(branches):
            found[min(owner[a], owner[b]), max(owner[a], owner[b])] += 1
    return {pair: count for pair, count in found.items() if count}


def _offsets(contours: list[list[Piece]]) -> Iterator[tuple[int, list[Piece]]]:
    first = 0
    for contour in contours:
        yield first, contour
        first += len(contour)


def _simple(pieces: list[Piece]) -> list[Piece]:
    """The same curve at twice the size in pieces of their true degree, without those that go nowhere.

    Twice the size, so that coordinates stay whole numbers. A piece on a straight line is the line between its ends:
    what goes there and back again crosses nothing in sum.
    """
    simple: list[Piece] = []
    for given in pieces:
        piece = tuple((2 * x, 2 * y) for x, y in given)
        if _collinear(piece):
            if piece[0] != piece[-1]:
                simple.append((piece[0], piece[-1]))
            continue
        if len(piece) == 4:
            (ax, ay), (bx, by), (cx, cy), (dx, dy) = piece
            if dx - 3 * cx + 3 * bx == ax and dy - 3 * cy + 3 * by == ay:  # a quadratic in the guise of a cubic
                piece = (piece[0], ((3 * bx - ax) // 2, (3 * by - ay) // 2), piece[3])
        simple.append(piece)
    return simple


def _near(points: Any) -> list[tuple[int, int]]:
    """Pairs a < b of pieces that no line separates of those tried: across, along and aside of their sides and chords.

    Curves in two closed half-planes do not cross on their common line, though they may touch there.
    """
    low, high = points.min(axis=1), points.max(axis=1)
    meet = np.ones((len(points), len(points)), dtype=bool)
    for axis in range(2):
        meet &= (low[:, None, axis] <= high[None, :, axis]) & (low[None, :, axis] <= high[:, None, axis])
    a, b = np.nonzero(np.triu(meet, 1))
    for first, last in ((0, 1), (0, 3), (2, 3), (1, 2)):
        for which in (0, 1):
            for turned in (False, True):
                side = points[(a, b)[which], last] - points[(a, b)[which], first]
                if turned:
                    side = np.stack([-side[:, 1], side[:, 0]], axis=1)
                p, q = ((points[k] * side[:, None]).sum(axis=2) for k in (a, b))
                apart = (p.max(axis=1) <= q.min(axis=1)) | (q.max(axis=1) <= p.min(axis=1))
                keep = ~(apart & (side != 0).any(axis=1)).astype(bool)
                a, b = a[keep], b[keep]
    return list(zip(a.tolist(), b.tolist(), strict=True))


def _loops(piece: Piece) -> int:
    """1 for a piece that crosses itself between its ends, else 0."""
    node = _node(piece, within=True)
    if node is None:
        return 0
    total, times = node  # of the two parameters at the double point
    inside = times > 0 and 1 - total + times > 0 and 0 < total < 2
    return int(inside and total * total > 4 * times)


def _node(piece: Piece, *, within: bool = False) -> tuple[Fraction, Fraction] | None:
    """Sum and product of the parameters at which a cubic is in one place; they may be equal, or complex.

    None if there are none; with ``within``, also if they cannot both be between 0 and 1, by their sum.
    """
    if len(piece) < 4:
        return None
    x, y = power(piece)
    ab, ac, bc = (x[i] * y[j] - y[i] * x[j] for i, j in ((3, 2), (3, 1), (2, 1)))
    if ab == 0 or (within and not 0 < -ac * ab < 2 * ab * ab):
        return None
    total = Fraction(-ac, ab)
    return total, total * total - Fraction(bc, ab)


# Inside two pieces


def _inside(a: Piece, b: Piece) -> int:
    """How often two pieces cross between their ends."""
    if len(a) > len(b):
        a, b = b, a
    matrix = _bezout(power(a), power(b))
    values = _determinant(matrix)
    if not any(values):
        return _same_curve(a, b)
    while values[-1] == 0:
        values.pop()
    while values[0] == 0:
        values.pop(0)
    for t in [1, *(t for end in (a[0], a[-1]) for t in parameters(b, end) if 0 < t < 1)]:
        while len(values) > 1 and _value(values, t) == 0:
            values = _divided(values, t)
    above, below = _inversion(a, b, matrix)
    return _crossing_roots(values, above, below)


def _bezout(a: tuple[Poly, Poly], b: tuple[Poly, Poly]) -> list[list[Poly]]:
    """The Bézout matrix of x_a(s) - x and y_a(s) - y along b: symmetric, of polynomials in b's parameter."""
    (x, y), (u, v) = a, b
    n = len(x) - 1
    aside = [[x[0] - u[0], *(-c for c in u[1:])], *([c] for c in x[1:])]
    up = [[y[0] - v[0], *(-c for c in v[1:])], *([c] for c in y[1:])]
    minors = {(i, j): _minus(_times(aside[i], up[j]), _times(aside[j], up[i])) for j in range(n + 1) for i in range(j)}
    matrix: list[list[Poly]] = [[[0]] * n for _ in range(n)]
    for i in range(n):
        for j in range(i, n):
            # (p(s) q(r) - p(r) q(s)) / (s - r): the coefficient of s^i r^j
            total: Poly = [0]
            for k in range(max(0, i + j + 1 - n), i + 1):
                total = _plus(total, minors[k, i + j + 1 - k])
            matrix[i][j] = matrix[j][i] = total
    return matrix


def _determinant(m: list[list[Poly]]) -> Poly:
    if len(m) == 1:
        return list(m[0][0])
    if len(m) == 2:
        return _minus(_times(m[0][0], m[1][1]), _times(m[0][1], m[0][1]))
    minors = [_minus(_times(m[1][j], m[2][k]), _times(m[1][k], m[2][j])) for j, k in ((1, 2), (0, 2), (0, 1))]
    return _plus(
        _minus(_times(m[0][0], minors[0]), _times(m[0][1], minors[1])),
        _times(m[0][2], minors[2]),
    )


def _inversion(a: Piece, b: Piece, m: list[list[Poly]]) -> tuple[Poly, Poly]:
    """Two polynomials whose ratio is a's parameter where b is on a: the kernel of the matrix is (1, s, s²)."""
    if len(m) == 1:
        (x, y), (u, v) = power(a), power(b)
        along = _plus([x[1] * c for c in _minus(u, [x[0]])], [y[1] * c for c in _minus(v, [y[0]])])
        return along, [x[1] * x[1] + y[1] * y[1]]
    if len(m) == 2:
        return [-c for c in m[0][1]], m[1][1]
    above = _minus(_times(m[1][2], m[0][2]), _times(m[0][1], m[2][2]))
    return above, _minus(_times(m[1][1], m[2][2]), _times(m[1][2], m[1][2]))


def _same_curve(a: Piece, b: Piece) -> int:
    """Crossings of two pieces of one cubic: its double point, if each has one of the two parameters there."""
    node = _node(a)
    if node is None:
        return 0
    total, times = node
    if total * total <= 4 * times:
        return 0
    (x, y), (u, v) = power(a), power(b)
    beta = _cube_root(Fraction(u[3], x[3]) if x[3] else Fraction(v[3], y[3]))  # b(t) = a(alpha + beta t)
    other = _node(b)
    assert other is not None
    alpha = (total - beta * other[0]) / 2

    def holds(low: Fraction, high: Fraction) -> tuple[bool, bool]:
        """Whether the smaller root is between, and whether the larger is."""
        at_low, at_high = (s * s - total * s + times for s in (low, high))
        smaller = (at_low > 0 and 2 * low < total) and (at_high < 0 or 2 * high > total)
        larger = (at_low < 0 or 2 * low < total) and (at_high > 0 and 2 * high > total)
        return smaller, larger

    first, second = holds(Fraction(0), Fraction(1))
    third, fourth = holds(*sorted([alpha, alpha + beta]))
    return int((first and fourth) or (second and third))


def _cube_root(value: Fraction) -> Fraction:
    roots = [round(abs(n) ** (1 / 3)) * (1 if n >= 0 else -1) for n in value.as_integer_ratio()]
    assert Fraction(*roots) ** 3 == value
    return Fraction(*roots)


def _crossing_roots(values: Poly, above: Poly, below: Poly) -> int:
    """Roots between 0 and 1 of odd multiplicity of a polynomial, where above / below is between 0 and 1 as well."""
    n = max(len(above), len(below))
    above, below = (_bernstein([*p, *[0] * (n - len(p))]) for p in (above, below))
    count, stack = 0, [(_bernstein(values), above, below, 0)]
    separate = False
    while stack:
        p, u, v, depth = stack.pop()
        variations = _variations(p)
        signs = _sign(u), _sign(v), _sign([y - x for x, y in zip(u, v, strict=True)])
        if variations == 0 or (signs[1] and (signs[0] * signs[1] < 0 or signs[2] * signs[1] < 0)):
            continue
        if variations == 1 and all(signs):
            count += 1
            continue
        if depth > DEPTH and variations > 1 and not separate:
            separate, count = True, 0
            stack = [(_bernstein(_odd_part(values)), above, below, 0)]
            continue
        if depth > MOST_DEPTH:
            raise ArithmeticError("a crossing at the double point of a piece")
        halves = list(zip(_halves(p), _halves(u), _halves(v), strict=True))
        right, (x, *_), (y, *_) = halves[1]
        if next(k for k, value in enumerate(right) if value) % 2 and 0 < x * y < y * y:  # a root in the middle
            count += 1
        stack += [(*half, depth + 1) for half in halves]
    return count


# Where joints are on other strands

Place: TypeAlias = tuple[int, Fraction]
"""A piece and a parameter from 0 up to 1, not 1 itself, which is 0 on the next piece."""


def _contacts(
    pieces: list[Piece], points: Any, before: dict[int, int], after: list[int]
) -> Iterator[tuple[Place, Place]]:
    """Each two places of the contours where a joint is on another strand, once."""
    starts, low, high = points[:, 0], points.min(axis=1), points.max(axis=1)
    within = ((low[None] <= starts[:, None]) & (starts[:, None] <= high[None])).astype(bool).all(axis=2)
    joints, others = np.nonzero(within)
    found: set[tuple[Place, Place]] = set()
    for j, k in zip(joints.tolist(), others.tolist(), strict=True):
        if k in (j, before[j]) and (len(pieces[k]) < 4 or not _closes(pieces[k])):
            continue  # the joint itself: it is elsewhere on this piece only if that is a loop from its end
        for s in parameters(pieces[k], pieces[j][0]):
            place = (k, s) if s < 1 else (after[k], Fraction(0))
            if place != (j, Fraction(0)):
                found.add((min((j, Fraction(0)), place), max((j, Fraction(0)), place)))
    yield from sorted(found)


def _closes(piece: Piece) -> bool:
    """Whether a cubic's double point is at one of its ends."""
    node = _node(piece, within=True)
    return node is not None and (node[1] == 0 or 1 - node[0] + node[1] == 0)


def parameters(piece: Piece, point: Vector) -> list[Fraction]:
    """Where on it, from 0 to 1, a piece is exactly at a point."""
    if any(min(p[axis] for p in piece) > point[axis] or max(p[axis] for p in piece) < point[axis] for axis in (0, 1)):
        return []
    x, y = power(piece)
    if any(_determinant(_bezout((x, y), ([point[0]], [point[1]])))):
        return []
    common = _gcd([x[0] - point[0], *x[1:]], [y[0] - point[1], *y[1:]])
    if len(common) < 2:
        return []
    if len(common) == 3:
        c, b, a = common
        square = b * b - 4 * a * c
        if square < 0:
            return []
        root = _root(square)
        roots = sorted({(-b - root) / (2 * a), (-b + root) / (2 * a)})
    else:
        roots = [-common[0] / common[1]]
    return [s for s in roots if 0 <= s <= 1]


def _root(square: Fraction) -> Fraction:
    """A square root; one that is not rational, as of a joint at the double point of a piece, to 200 bits.

    That turns the directions in which branches leave the point by as little.
    """
    n, d = square.as_integer_ratio()
    if isqrt(n) ** 2 == n and isqrt(d) ** 2 == d:
        return Fraction(isqrt(n), isqrt(d))
    return Fraction(isqrt((n << 400) // d), 1 << 200)


class Branch(NamedTuple):
    """What leaves a point: x and y as polynomials that are 0 at 0, and to which of two strands it belongs."""

    x: Poly
    y: Poly
    strand: int


def _branches(pieces: list[Piece], before: dict[int, int], k: int, s: Fraction, strand: int) -> list[Branch]:
    """The two branches of a strand at a place."""
    if s == 0:
        return [_branch(pieces[k], s, 1, strand), _branch(pieces[before[k]], Fraction(1), -1, strand)]
    return [_branch(pieces[k], s, 1, strand), _branch(pieces[k], s, -1, strand)]


def _branch(piece: Piece, s: Fraction, way: int, strand: int) -> Branch:
    shifted = [_shifted(c, s, way) for c in power(piece)]
    return Branch([Fraction(0), *shifted[0][1:]], [Fraction(0), *shifted[1][1:]], strand)


def _alternate(branches: list[Branch]) -> bool:
    """Whether the branches of two strands alternate around their common point; not if two of them coincide."""
    order = sorted(branches, key=cmp_to_key(_compare))
    if any(_compare(*pair) == 0 for pair in pairwise(order)):
        return False
    return order[0].strand == order[2].strand


def _leading(branch: Branch) -> tuple[int, Vector]:
    """The order and the coefficients of the first term that is not zero."""
    k = next(k for k in range(1, len(branch.x)) if branch.x[k] or branch.y[k])
    return k, (branch.x[k], branch.y[k])


def _compare(p: Branch, q: Branch) -> int:
    """-1 where branch p comes before q counter-clockwise, starting rightwards; 0 where they coincide."""
    (k, u), (j, v) = _leading(p), _leading(q)
    halves = [not (w[1] > 0 or (w[1] == 0 and w[0] > 0)) for w in (u, v)]
    if halves[0] != halves[1]:
        return -1 if halves[1] else 1
    turn = u[0] * v[1] - u[1] * v[0]
    if turn:
        return -1 if turn > 0 else 1
    along_p, up_p = _turned(p, u)
    along_q, up_q = _turned(q, u)
    if k > 1 and j > 1:  # both are cubics that start with t²: heights are in proportion to (distance)^(3/2)
        a, b = up_p[3] * abs(up_p[3]) * along_q[2] ** 3, up_q[3] * abs(up_q[3]) * along_p[2] ** 3
        return int(a > b) - int(a < b)
    if not any(_determinant(_bezout((p.x, p.y), (q.x, q.y)))):
        return 0  # two stretches of one curve
    if j > 1:
        return -_higher(along_p, up_p, along_q, up_q)
    return _higher(along_q, up_q, along_p, up_p)


def _turned(branch: Branch, u: Vector) -> tuple[Poly, Poly]:
    """How far along a direction a branch is, and how far to the left of it."""
    points = list(zip(branch.x, branch.y, strict=True))
    return [u[0] * x + u[1] * y for x, y in points], [u[0] * y - u[1] * x for x, y in points]


def _higher(along: Poly, up: Poly, other_along: Poly, other_up: Poly) -> int:
    """1, 0 or -1 as the other branch is to the left of a branch that is regular, coincides with it, or is to the right.

    Two cubics that meet more than nine times in a point are one curve.
    """
    t: Poly = [Fraction(0)]
    for order in range(2, 12):  # the parameter at which this one is as far along as the other, as a power series
        further = _minus(other_along, _composed([0, 0, *along[2:]], t, order))
        t = [x / along[1] for x in [*further, *[0] * order][:order]]
        gap = next((x for x in _minus(other_up, _composed(up, t, order))[:order] if x), 0)
        if gap:
            return 1 if gap > 0 else -1
    return 0


def _composed(p: Poly, t: Poly, order: int) -> Poly:
    """The first terms of p(t(x))."""
    result: Poly = [Fraction(0)]
    for c in reversed(p):
        result = _plus(_times(result, t)[:order], [c])
    return result


# Polynomials


def power(piece: Piece) -> tuple[Poly, Poly]:
    """The coefficients of x and of y in powers of the parameter."""
    return _powers([p[0] for p in piece]), _powers([p[1] for p in piece])


def _powers(c: Sequence[Any]) -> Poly:
    if len(c) == 4:
        return [c[0], 3 * (c[1] - c[0]), 3 * (c[2] - 2 * c[1] + c[0]), c[3] - c[0] + 3 * (c[1] - c[2])]
    if len(c) == 3:
        return [c[0], 2 * (c[1] - c[0]), c[2] - 2 * c[1] + c[0]]
    return [c[0], c[1] - c[0]] if len(c) == 2 else [c[0]]


def _plus(p: Poly, q: Poly) -> Poly:
    if len(p) < len(q):
        p, q = q, p
    return [*(x + y for x, y in zip(p, q, strict=False)), *p[len(q) :]]


def _minus(p: Poly, q: Poly) -> Poly:
    return _plus(p, [-c for c in q])


def _times(p: Poly, q: Poly) -> Poly:
    result = [0] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        if x:
            for j, y in enumerate(q):
                result[i + j] += x * y
    return result


def _value(p: Poly, t: Any) -> Any:
    return reduce(lambda total, c: total * t + c, reversed(p))


def _shifted(p: Poly, s: Fraction, way: int) -> Poly:
    """p(s + way t) in powers of t."""
    result: Poly = [Fraction(0)]
    for c in reversed(p):
        result = _plus(_times(result, [s, way]), [c])
    return result[: len(p)]


def _divided(p: Poly, t: Any) -> Poly:
    """p over (x - t), of which it is a multiple."""
    result: Poly = []
    carry: Any = 0
    for c in reversed(p[1:]):
        carry = carry * t + c
        result.append(carry)
    return result[::-1]


def _remainder(p: Poly, q: Poly) -> Poly:
    rest = list(p)
    while len(rest) >= len(q):
        factor = Fraction(rest[-1]) / q[-1]
        for k in range(1, len(q) + 1):
            rest[-k] -= factor * q[-k]
        rest.pop()
    return _trimmed(rest)


def _trimmed(p: Poly) -> Poly:
    p = list(p)
    while p and p[-1] == 0:
        p.pop()
    return p


def _gcd(p: Poly, q: Poly) -> Poly:
    p, q = _trimmed(p), _trimmed(q)
    while q:
        if len(p) >= len(q):
            p = _remainder(p, q)
        p, q = q, p
    return [Fraction(c) / p[-1] for c in p]


def _quotient(p: Poly, q: Poly) -> Poly:
    rest, result = list(p), []
    while len(rest) >= len(q):
        factor = Fraction(rest[-1]) / q[-1]
        result.append(factor)
        for k in range(1, len(q) + 1):
            rest[-k] -= factor * q[-k]
        rest.pop()
    return result[::-1]


def _odd_part(p: Poly) -> Poly:
    """The polynomial with the roots of p that have odd multiplicity, each once, by Yun's algorithm."""
    slope = [k * c for k, c in enumerate(p)][1:]
    common = _gcd(p, slope)
    rest, other = _quotient(p, common), _quotient(slope, common)
    factors, multiplicity = [], 1
    while len(rest) > 1:
        other = _trimmed(_minus(other, [k * c for k, c in enumerate(rest)][1:]))
        factor = _gcd(rest, other)
        if multiplicity % 2:
            factors.append(factor)
        rest, other = _quotient(rest, factor), _quotient(other, factor) if other else []
        multiplicity += 1
    return reduce(_times, factors, [Fraction(1)])


def _bernstein(p: Poly) -> Poly:
    """Coefficients in the Bernstein basis over 0 to 1 of a positive multiple of p, whole numbers."""
    n = len(p) - 1
    scale = lcm(*(Fraction(c).denominator for c in p))
    own = [int(c * scale) * factorial(j) * factorial(n - j) for j, c in enumerate(p)]
    return [
        sum(own[j] * (factorial(i) // (factorial(j) * factorial(i - j))) for j in range(i + 1)) for i in range(n + 1)
    ]


def _halves(b: Poly) -> tuple[Poly, Poly]:
    """A positive multiple of the polynomial, over each half of its interval."""
    n = len(b) - 1
    left, right = [b[0] << n], [b[-1] << n]
    for k in range(1, n + 1):
        b = [x + y for x, y in pairwise(b)]
        left.append(b[0] << (n - k))
        right.append(b[-1] << (n - k))
    return left, right[::-1]


def _variations(b: Poly) -> int:
    signs = [c > 0 for c in b if c]
    return sum(x != y for x, y in pairwise(signs))


def _sign(b: Poly) -> int:
    """1 or -1 where no coefficient has another sign, so neither has the polynomial between its ends; else 0."""
    if all(c >= 0 for c in b):
        return int(any(b))
    return -int(all(c <= 0 for c in b))


def _collinear(points: Iterable[Vector]) -> bool:
    points = list(points)
    away = [(p[0] - points[0][0], p[1] - points[0][1]) for p in points if p != points[0]]
    return all(away[0][0] * q[1] == away[0][1] * q[0] for q in away)
