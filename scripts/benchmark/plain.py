"""What compiling costs and what it saves, by kind of work: written to ``glyphspline/runs/costs.json``.

Seconds of processor time. Compiling is timed function by function in one process that compiles everything; a kind of
work takes those that its small run calls. Work is timed on a few Latin letters and 好, in processes that run as plain
Python and in compiled ones.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from glyphspline import Options, Outline, convert_many, open_font
from glyphspline.code_files import OFF, PLACE
from glyphspline.plugins.masters.work import AXES, REGIONS
from glyphspline.runs.small_runs import work

from .measure import Row

ROOT = Path(__file__).parents[2]
COSTS = ROOT / "glyphspline" / "runs" / "costs.json"

Timed = tuple[float, float]
"""Seconds, and units of work: see :class:`glyphspline.runs.engine.Item`."""


def outlines() -> list[Outline]:
    """Those that are worked on."""
    import matplotlib

    latin = open_font(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf")
    brush = open_font(ROOT / "fonts_test" / "kouzan-kaisho.ttf")
    return [font.outline(name) for font, text in ((latin, "aeg&"), (brush, "好")) for name in font.select(text=text)]


def fitted(**options: Any) -> Callable[[list[Outline]], Any]:
    """A fit with these options, written as SVG."""

    def work(outlines: list[Outline]) -> None:
        from glyphspline import to_svg

        for result in convert_many(outlines, Options(**options)):
            to_svg(result)

    return work


def drawings(outlines: list[Outline]) -> None:
    """Curvature maps of outlines as they are, which is most of the work of fitted ones too."""
    from glyphspline import to_curvature_svg
    from glyphspline.fitting.results import as_glyph

    for outline in outlines:
        to_curvature_svg(as_glyph(outline))


def unfitted(outlines: list[Outline]) -> None:
    """Outlines drawn as they are."""
    from glyphspline import to_svg
    from glyphspline.fitting.results import as_glyph

    for outline in outlines:
        to_svg(as_glyph(outline))


def checks(outlines: list[Outline]) -> None:
    """Outlines checked."""
    from glyphspline import check

    for outline in outlines:
        check(outline)


def mending(outlines: list[Outline]) -> None:
    """Outlines mended."""
    from glyphspline import mend

    for outline in outlines:
        mend(outline)


def comparisons(outlines: list[Outline]) -> None:
    """Outlines compared with themselves, moved a little."""
    from glyphspline import Contour, compare

    for outline in outlines:
        moved = [Contour(contour.points + 0.3, contour.degrees) for contour in outline.contours]
        compare(outline, Outline(outline.name, contours=tuple(moved), metrics=outline.metrics))


def points(outlines: list[Outline]) -> None:
    """Outlines as data sets have them."""
    from glyphspline.fitting.results import as_glyph
    from glyphspline.plugins.datasets.canonical_outlines import canonical_outlines
    from glyphspline.plugins.datasets.resampling import resampled

    canonical_outlines(outlines)
    for outline in outlines:
        resampled(as_glyph(outline).arrays.curves, 64, float(np.radians(30.0)))


def quadratics(outlines: list[Outline]) -> None:
    """What a TTF stores."""
    from glyphspline.plugins.fonts.fit.points import quadratic_points

    for outline in outlines:
        em = outline.metrics.units_per_em
        quadratic_points(outline.arrays, Options(corners="sharp", continuity="g2"), em / 1000, em)


def masters(outlines: list[Outline]) -> None:
    """Two masters: an outline and a wider one."""
    from glyphspline import MasterContour, Masters, convert_masters

    for outline in outlines:
        contours = [
            MasterContour(np.stack([contour.points, contour.points * [1.2, 1.0]]), contour.degrees)
            for contour in outline.contours
        ]
        convert_masters(
            Masters(
                outline.name,
                axes=AXES,
                regions=REGIONS,
                contours=contours,
                advances=np.ones(2),
                metrics=outline.metrics,
            )
        )


STEP = 20.0

KINDS: dict[str, Callable[[list[Outline]], Any]] = {
    "sharp": fitted(),
    "sharp_best": fitted(effort="best"),
    "smooth": fitted(corners="smooth"),
    "smooth_best": fitted(corners="smooth", effort="best"),
    "fixed": fitted(step=STEP),
    "g2": fitted(corners="sharp", continuity="g2"),
    "drawings": drawings,
    "unfitted": unfitted,
    "checks": checks,
    "mending": mending,
    "comparing": comparisons,
    "points": points,
    "quadratics": quadratics,
    "masters": masters,
}
"""What is timed. Other kinds of work are parts of these, or of no run."""


def timed(kind: str) -> Timed:
    """Time a kind of work, in this process."""
    from glyphspline.runs.worker import vertices_of

    given = outlines()
    units = float(sum(len(outline.arrays.degrees) for outline in given))
    if kind == "fixed":
        units += sum(vertices_of(outline, Options(step=STEP)) for outline in given)
    if not os.environ.get(OFF):
        KINDS[kind](given)  # loads code
    begin = time.process_time()
    KINDS[kind](given)
    return time.process_time() - begin, units


def compile_all() -> dict[str, float]:
    """Compile everything, in this process: seconds of each function, without those below it."""
    from numba.core import event

    from glyphspline.runs.warm import compile_kind

    found: dict[str, float] = {}
    open_ones: list[list[float]] = []

    class Listener(event.Listener):  # type: ignore[misc, unused-ignore]
        def on_start(self, event: Any) -> None:
            open_ones.append([time.process_time(), 0.0])

        def on_end(self, event: Any) -> None:
            began, below = open_ones.pop()
            seconds, function = time.process_time() - began, event.data["dispatcher"].py_func
            if not function.__module__.startswith("glyphspline."):
                return  # Numba's own helpers count with what needs them
            if open_ones:
                open_ones[-1][1] += seconds
            name = f"{function.__module__}.{function.__qualname__}"
            found[name] = found.get(name, 0.0) + seconds - below

    event.register("numba:compile", Listener())
    for kind in work():
        compile_kind(kind)
    return found


def functions_of(kind: str) -> list[str]:
    """All functions whose code a kind of work needs; that of each is there."""
    from glyphspline.code_files import below
    from glyphspline.compiled import everything
    from glyphspline.runs.warm import compile_kind

    compile_kind(kind)
    called = [one.py_func for one in everything if "entry" in vars(one) and one.entry.overloads]
    return sorted({f"{one.__module__}.{one.__qualname__}" for each in called for one in below(each)})


CALLS: dict[str, Callable[..., Any]] = {"timed": timed, "compile_all": compile_all, "functions_of": functions_of}


def in_a_process(call: str, *words: str, **environment: str) -> Any:
    """The result of one of ``CALLS`` in a process of its own."""
    command = [sys.executable, "-m", "scripts.benchmark.plain", call, *words]
    run = subprocess.run(command, env=os.environ | environment, check=True, stdout=subprocess.PIPE, cwd=ROOT)
    return json.loads(run.stdout)


def rows() -> list[Row]:
    """Compiling and work of each kind, which are written down."""
    with tempfile.TemporaryDirectory() as folder:
        place = {PLACE: folder, "GLYPHSPLINE_QUIET": "1"}
        seconds = in_a_process("compile_all", **place)
        compiling = {
            kind: sum(seconds.get(name, 0.0) for name in in_a_process("functions_of", kind, **place)) for kind in work()
        }
        costs = {}
        for kind in work():
            plain, compiled = ((0.0, 1.0), (0.0, 1.0))
            if kind in KINDS:
                plain, compiled = (in_a_process("timed", kind, **place, **off) for off in ({OFF: "1"}, {}))
            costs[kind] = {
                "compiling": round(compiling[kind], 1),
                "plain": float(f"{plain[0] / plain[1]:.3g}"),
                "compiled": float(f"{compiled[0] / compiled[1]:.3g}"),
            }
    COSTS.write_text(json.dumps({"kinds": costs}, indent=1) + "\n", encoding="utf-8")
    found = [Row("compiling everything, one process", sum(seconds.values()), "s")]
    for kind, cost in costs.items():
        note = f"{cost['plain'] * 1e3:.3g} ms a segment as plain Python, {cost['compiled'] * 1e6:.3g} µs compiled"
        found.append(Row(f"compiling `{kind}` alone", cost["compiling"], "s", more=False, note=note))
    return found


if __name__ == "__main__":
    print(json.dumps(CALLS[sys.argv[1]](*sys.argv[2:])))
