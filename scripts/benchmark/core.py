"""The interpolation beside the plain reference, and beside libraries that solve for a curve directly."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

import glyphspline as gs
from glyphspline.interpolation.batch import interpolate_batch
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import Polygons
from glyphspline.interpolation.reference import interpolate_reference, prepare
from glyphspline.interpolation.result import BatchedInterpolation
from glyphspline.interpolation.roots import footpoint
from glyphspline.types import FloatArray

from .measure import Row, in_words, interleaved, ratio

SHARE = 2e-7
"""The residual tolerance in all rows, as a share of the polygon's extent."""


def random_polygon(n: int, seed: int = 0) -> FloatArray:
    """The paper's: uniform in [0, 5]²."""
    return 5 * np.random.default_rng([n, seed]).random((n, 2))


def smooth_polygon(n: int) -> FloatArray:
    """A wavy round."""
    a = 2 * np.pi * np.arange(n) / n
    r = 1 + 0.2 * np.cos(3 * a) + 0.05 * np.sin(7 * a)
    return np.stack([r * np.cos(a), r * np.sin(a)], axis=1)


def glyph_polygons(count: int) -> list[FloatArray]:
    """Contours of DejaVu Sans, which Matplotlib brings along, in chords of 1/25 em and graded."""
    from matplotlib import get_data_path

    font = gs.open_font(f"{get_data_path()}/fonts/ttf/DejaVuSans.ttf")
    found: list[FloatArray] = []
    for name in font.glyph_names:
        found += [gs.sample(contour, step=font.metrics.units_per_em / 25) for contour in font.outline(name).contours]
        if len(found) >= count:
            break
    return [p for p in found if len(p) > 4][:count]


Results = gs.Interpolation | list[gs.Interpolation]
DIMENSIONS = (2, 4, 6, 18, 48, 154)
LIMITS = {
    "`make_interp_spline`": {20: (5, 6), 90: (2.5, 3), 300: (1.5, 2), 1000: (1.0, 1.2)},
    "`splprep`": {20: (0.5, 1), 90: (0.6, 1), 300: (1.2, 1.5)},
}


def rows() -> list[Row]:
    """All rows of this suite."""
    suites = (against_reference, against_kurbo, against_libraries, overhead, many, growth, dimensions)
    return [row for suite in suites for row in suite()]


def laid_out(polygons: list[FloatArray]) -> Polygons:
    """Polygons end to end, beforehand, so that only the interpolation is timed."""
    return Polygons(np.concatenate(polygons), np.cumsum([0, *map(len, polygons)]))


def run(polygons: Polygons, tolerance: float, threads: int = 1, **options: Any) -> BatchedInterpolation:
    """Interpolate all by variant 2."""
    return interpolate_batch(polygons, Method(residual_tolerance=tolerance, **options), threads)


def read(results: Results) -> None:
    """Read of every result what its users read, as the libraries' results hold it too."""
    for result in results if isinstance(results, list) else [results]:
        _ = result.spline.control_points, result.parameters, result.residuals


def _footpoints(result: BatchedInterpolation) -> int:
    return int(((result.arrays.whole[:, 2] + 1) * result.arrays.whole[:, 1]).sum())


def against_reference() -> list[Row]:
    """One footpoint of variant 2 in whole runs, compiled and by numpy.roots."""
    once = random_polygon(20, 0)
    all_ours = partial(run, laid_out([random_polygon(20, seed) for seed in range(100)]), 5 * SHARE)
    ours, plain = all_ours(), interpolate_reference(once, residual_tolerance=5 * SHARE)
    few = partial(interpolate_reference, once, residual_tolerance=5 * SHARE, max_iterations=3)
    times = interleaved({"ours": all_ours, "roots": few}, rounds=9)
    assert plain.iterations == ours.arrays.whole[0, 2]
    a, b = times["ours"] / _footpoints(ours), times["roots"] / (4 * 20)
    return [ratio("variant 2 footpoint against the `numpy.roots` reference", b, a, 2000, 3500)]


def against_kurbo() -> list[Row]:
    """A footpoint on two cubic pieces: kurbo's nearest point at 1e-6, through kurbopy."""
    from kurbopy import CubicBez, Point

    p = random_polygon(90)
    problem = prepare(p, Method())
    spline = problem.spline(p)
    pieces = [CubicBez(*(Point(*map(float, point)) for point in piece)) for piece in spline.to_bezier()]
    targets = [Point(*map(float, point)) for point in p]
    all_ours = partial(run, laid_out([random_polygon(90, seed) for seed in range(20)]), 5 * SHARE)
    ours = all_ours()

    def kurbo() -> None:
        for i, target in enumerate(targets):
            pieces[i - 1].nearest(target, 1e-6)
            pieces[i].nearest(target, 1e-6)

    times = interleaved({"ours": all_ours, "kurbo": kurbo})
    a, b = times["ours"] / _footpoints(ours), times["kurbo"] / len(p)
    assert np.isfinite(footpoint(spline, p[0], problem.intervals.bounds[0], 0.0))
    return [ratio("against kurbo's nearest point at 1e-6, two pieces", b, a, 15, 25)]


def against_libraries() -> list[Row]:
    """A whole interpolation of one smooth contour by the public call, and libraries' closed curves through points."""
    from geomdl.fitting import interpolate_curve
    from scipy.interpolate import CubicSpline, make_interp_spline, make_splprep, splprep
    from splipy import curve_factory

    splipy_curve: Any = curve_factory.cubic_curve
    periodic = curve_factory.Boundary.PERIODIC
    found = []
    for n in (20, 90, 300, 1000):
        p = smooth_polygon(n)
        closed = np.concatenate([p, p[:1]])
        u = gs.interpolate(p).spline.knots
        tolerance = SHARE * float(np.ptp(p, axis=0).max())
        cases: dict[str, Any] = {
            "ours": lambda p=p, t=tolerance: read(gs.interpolate(p, residual_tolerance=t)),
            "`make_interp_spline`": lambda u=u, q=closed: make_interp_spline(u, q, k=3, bc_type="periodic"),
            "`CubicSpline`": lambda u=u, q=closed: CubicSpline(u, q, bc_type="periodic"),
            "`splprep`": lambda q=closed: splprep(q.T, s=0, per=True),
            "`make_splprep`": lambda q=closed: make_splprep(q.T, s=0, bc_type="periodic"),
            "splipy": lambda u=u, q=closed: splipy_curve(q[:-1], periodic, u[:-1]),
        }
        if n <= 90:
            cases["geomdl (open)"] = lambda q=closed: interpolate_curve(q.tolist(), 3)
        times = interleaved(cases, repeat=20)
        for name in list(cases)[1:]:
            limits = LIMITS.get(name, {}).get(n, (None, None))
            what = f"one smooth contour, n = {n}, against {name}"
            found.append(ratio(what, times[name], times["ours"], *limits))
    return found


def overhead() -> list[Row]:
    """What the public call takes beyond the compiled code, n = 20: 200 calls against one call of 200 contours."""
    p = smooth_polygon(20)
    calls = range(200)
    together, tolerance = laid_out([p] * len(calls)), SHARE * float(np.ptp(p, axis=0).max())

    def one_by_one() -> None:
        for _ in calls:
            read(gs.interpolate(p, residual_tolerance=tolerance))

    times = interleaved({"one": one_by_one, "many": lambda: run(together, tolerance)}, rounds=25)
    one, core = times["one"] / len(calls), times["many"] / len(calls)
    note = f"{in_words(one)}, {in_words(core)}"
    return [
        Row("public call beyond the compiled code, n = 20", (one - core) * 1e6, "us", must=12, more=False, note=note)
    ]


def many() -> list[Row]:
    """2000 glyph contours at once."""
    from scipy.interpolate import splprep

    contours = glyph_polygons(2000)
    together, tolerance = laid_out(contours), SHARE * 2048
    rings = [np.concatenate([p, p[:1]]).T for p in contours]

    def library() -> None:
        for ring in rings:
            splprep(ring, s=0, per=True)

    def ours(threads: int) -> list[gs.Interpolation]:
        return gs.interpolate_many(contours, threads=threads, residual_tolerance=tolerance)

    times = interleaved(
        {
            "2": lambda: read(ours(2)),
            "splprep": library,
            "core 1": lambda: run(together, tolerance, 1),
            "core 2": lambda: run(together, tolerance, 2),
        },
        rounds=9,
        repeat=5,
    )
    one, two = ours(1), ours(2)
    assert all((a.spline.control_points == b.spline.control_points).all() for a, b in zip(one, two, strict=True))
    what = "2000 glyph contours, two threads, against a loop over `splprep`"
    return [
        ratio(what, times["splprep"], times["2"], 1.5, 2.5),
        ratio("two threads against one, same bits", times["core 1"], times["core 2"], 1.9),
    ]


def growth() -> list[Row]:
    """Time a footpoint from n = 10 to 100,000."""
    sizes = [5, 10, 100, 1000, 10_000, 100_000]
    cases: dict[str, Any] = {}
    counts = {}
    for n in sizes:
        each = laid_out([random_polygon(n, seed) for seed in range(max(1, 20_000 // n))])
        cases[str(n)] = partial(run, each, 5 * SHARE, max_iterations=20)
        counts[n] = _footpoints(cases[str(n)]())
    times = interleaved(cases, rounds=5)
    footpoint_times = {n: times[str(n)] / counts[n] for n in sizes}
    ratio = max(footpoint_times[n] for n in sizes[1:]) / min(footpoint_times[n] for n in sizes[1:])
    note = ", ".join(f"{n}: {in_words(seconds)}" for n, seconds in footpoint_times.items())
    return [Row("a footpoint, slowest size against fastest, n = 10 to 100,000", ratio, must=1.5, more=False, note=note)]


def dimensions() -> list[Row]:
    """Time a footpoint of `interpolate_many` in R^d against the plane."""
    found = []
    for n, count in ((20, 100), (90, 25)):
        cases: dict[str, Any] = {}
        counts = {}
        for d in DIMENSIONS:
            polygons = list(np.random.default_rng([n, d]).uniform(0, 5, (count, n, d)))
            options: dict[str, Any] = {"residual_tolerance": 5 * SHARE * np.sqrt(d / 2), "threads": 1}
            results = gs.interpolate_many(polygons, **options)
            assert not any(r.uncertified for r in results)
            counts[f"{d}"] = sum((r.iterations + 1) * n for r in results)
            cases[f"{d}"] = lambda p=polygons, o=options: gs.interpolate_many(p, **o)
        times = interleaved(cases, rounds=7)
        each = {name: times[name] / counts[name] for name in cases}
        for d in DIMENSIONS[1:]:
            note = f"{in_words(each[f'{d}'])}, {in_words(each['2'])}"
            what = f"a footpoint in R^{d} against one in the plane, n = {n}"
            found.append(Row(what, each[f"{d}"] / each["2"], more=False, note=note))
    return found
