"""The pass in NumPy gives the bits of the compiled one: random and degenerate polygons, all variants and dimensions."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

from glyphspline.code_files import kept
from glyphspline.interpolation.batch import interpolate_batch
from glyphspline.interpolation.method import Method
from glyphspline.interpolation.polygon import NO_FLAGS, NO_TANGENTS, Polygons
from glyphspline.types import FloatArray
from tests.polygons import lognormal_chords, near_cusps, polygon, uniform

RUNS: list[tuple[int, dict[str, Any]]] = [
    *((d, {"variant": v, "closed": closed}) for d in (2, 3, 6) for v in (1, 2, 3) for closed in (True, False)),
    *((d, {"variant": 4, "closed": closed, "max_iterations": 3}) for d in (2, 6) for closed in (True, False)),
    (2, {"variant": 0, "max_iterations": 1}),
    (2, {"margin": 0.02, "fallback": "peak"}),
    (3, {"closed": False, "margin": 0.1, "fallback": "peak", "knots": "centripetal"}),
    (2, {"knots": "uniform"}),
]
"""Dimensions and options of methods."""


def polygons(d: int) -> list[FloatArray]:
    """Polygons of every kind, fewer and more vertices than are taken together, and degenerate ones."""
    rng = np.random.default_rng(d)
    found = [polygon(k)[1] for k in range(10)]
    found += [uniform(rng, n) for n in (3, 4, 5, 63, 64, 65)] + [lognormal_chords(rng, 30), near_cusps(rng, 18)]
    lattice, pair, spikes = rng.integers(0, 3, (14, 2)), uniform(rng, 2), uniform(rng, 9)
    spikes[4:7] = spikes[3] + 1e-13 * rng.normal(size=(3, 2))
    line = np.stack([np.arange(9.0), np.zeros(9)], axis=1)
    found += [lattice.astype(np.float64), pair, spikes, line, line[[0, 4, 1, 5, 2]], np.zeros((5, 2)), line[:1]]
    found += [1e150 * uniform(rng, 7), 1e-150 * uniform(rng, 7), 1e307 * uniform(rng, 7), 1e-307 * uniform(rng, 7)]
    found += [np.repeat(uniform(rng, 6), 2, axis=0), np.full((5, 2), np.nan), np.array([[0, 0], [1, np.inf], [2, 0]])]
    return [np.hstack([p, p[:, :1] * rng.normal(size=(len(p), d - 2))]) for p in found]


def results() -> dict[str, FloatArray]:
    """All that interpolations give, by the number of the run and of the polygon."""
    found = {}
    for number, (d, options) in enumerate(RUNS):
        method, rng = Method(**{"max_iterations": 25, **options}), np.random.default_rng(number)
        parts = polygons(d)[: 12 if method.variant in (0, 4) else None]
        offsets, tangents, held = np.cumsum([0, *map(len, parts)]), NO_TANGENTS, NO_FLAGS
        if not method.closed:
            natural = rng.random((len(parts), 2, 1)) < 0.5
            tangents = np.where(natural, np.nan, rng.normal(size=(len(parts), 2, d)))
        elif number % 2:
            held = rng.random(offsets[-1]) < 0.1
        batch = interpolate_batch(
            Polygons(np.concatenate(parts), offsets, tangents=tangents, held=held), method, threads=1
        )
        found[f"{number} whole"] = batch.arrays.whole[:, :2].astype(np.float64)
        for k, r in enumerate(batch.results()):
            if r:
                counts = [r.iterations, r.fallbacks, r.rate_bound, r.uncertified, batch.arrays.tolerances[k]]
                found[f"{number} {k}"] = np.concatenate([
                    r.spline.control_points.ravel(), r.spline.knots, r.parameters, r.intervals.ravel(), r.residuals,
                    r.merged, counts,
                ])  # fmt: skip
    return found


def save(path: str) -> None:
    """Write the results with memory that is not a number before it is written to."""
    plain = np.empty

    def empty(*args: Any, **options: Any) -> Any:
        made: Any = plain(*args, **options)
        made.fill(np.nan if made.dtype.kind == "f" else 77)
        return made

    numpy: Any = np
    numpy.empty = empty
    numpy.savez(path, **results())


def test_plain_and_compiled_give_the_same_bits(tmp_path: Path) -> None:
    path = tmp_path / "plain.npz"
    program = f"from tests.interpolation.test_plain import save; save({str(path)!r})"
    plain = subprocess.Popen([sys.executable, "-c", program], env=os.environ | {"NUMBA_DISABLE_JIT": "1"})
    with kept.compiling():
        compiled = results()
    assert plain.wait() == 0
    found = np.load(path)
    assert set(found) == set(compiled)
    different = [name for name in compiled if found[name].tobytes() != compiled[name].tobytes()]
    assert not different, different
