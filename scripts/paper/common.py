"""What every figure shares: the random polygons, the record of claims, the style of the pictures."""

from __future__ import annotations

import sys
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from glyphspline.plugins.experiments.style import COLOURS, MARKERS, small, style
from glyphspline.types import FloatArray
from glyphspline.writers.figures.basics import saved

PAPER = (
    "Y. Xiong, G. Li, A. Mao, “Convergence analysis for B-spline geometric interpolation”, "
    "Computers & Graphics 36 (2012) 884–891"
)

WORDS: dict[str, dict[str, str]] = tomllib.loads(Path(__file__).with_name("claims.toml").read_text(encoding="utf-8"))
"""By claim, or kind of claims: where the paper says it, what, what the paper reports, and a note."""

SEED = 2012
GROUPS = (5, 10, 15, 20, 30, 40, 50, 60, 70, 80, 90)
"""Vertices of the polygons of the paper's Section 4; each group has 200 polygons."""

SIDE = 5.0
"""Vertices are uniform in [0, SIDE]²."""

plt.rcParams.update(style())


def random_polygons(n: int, count: int, seed: int = SEED) -> list[FloatArray]:
    """``count`` polygons of n vertices, uniform in [0, 5]²; the first ones are the same whatever the count."""
    rng = np.random.default_rng([seed, n])
    return list(rng.uniform(0, SIDE, (count, n, 2)))


@dataclass(frozen=True)
class Claim:
    """One claim of the paper, or of ours, beside what was measured.

    Attributes:
        id, source: a stable name, and where the paper says it.
        claim, paper: in our words, and what the paper reports.
        measured: a number, or a mapping that ends in numbers.
        verdict: one of ``VERDICTS``; or "proven for …" with the hypothesis of the proof.
        note: why it differs, or how it was measured.
        command: what makes it again.
    """

    id: str
    source: str
    claim: str
    paper: str
    measured: Any
    verdict: str
    note: str
    command: str


VERDICTS = ("reproduced", "differs", "not decidable", "proven", "measured")
"""The last two are for what goes beyond the paper; "proven for …" names what a proof supposes."""


def is_verdict(text: str) -> bool:
    """Whether a claim may end with these words."""
    return text in VERDICTS or text.startswith("proven for ")


@dataclass
class Run:
    """A run of the whole reproduction: its size, where it writes, and what it found.

    Attributes:
        out: folder for pictures and claims.json.
        quick: a small version of everything, for the tests. step: what is being made, as ``--only`` names it.
        fonts: files given for the faces of Figs. 8 and 9, by figure.
        claims, times: as claims.json has them; times are kept apart, since they are never the same twice.
    """

    out: Path
    quick: bool = False
    fonts: dict[str, Path] = field(default_factory=dict)
    claims: list[Claim] = field(default_factory=list)
    times: dict[str, Any] = field(default_factory=dict)
    cache: dict[str, Any] = field(default_factory=dict)
    step: str = ""

    def size(self, full: int, quick: int) -> int:
        """How many of something."""
        return quick if self.quick else full

    @property
    def groups(self) -> tuple[int, ...]:
        """Numbers of vertices of the polygons of Section 4."""
        return (5, 20) if self.quick else GROUPS

    def polygons(self) -> dict[int, list[FloatArray]]:
        """The 2200 polygons of Section 4, by number of vertices."""
        return {n: random_polygons(n, self.size(200, 3)) for n in self.groups}

    def claim(self, id: str, measured: Any, verdict: str, words: str = "", digits: int = 6, **values: object) -> None:
        """Record a claim, whose words are in claims.toml, with ``values`` put in; numbers are rounded to ``digits``.

        The last bits of a machine then do not show.
        """
        if not is_verdict(verdict):
            raise ValueError(f"verdict {verdict!r} of {id}")
        said = {name: text.format(**values) for name, text in WORDS[words or id].items()}
        command = f"python -m scripts.paper --only {self.step}"
        self.claims.append(Claim(id, measured=rounded(measured, digits), verdict=verdict, command=command, **said))

    def save(self, figure: Figure, name: str, svg: bool = False) -> None:
        """Write a picture without date or random ids."""
        (self.out / f"{name}.png").write_bytes(small(saved(figure, "png", plt.rcParams["savefig.dpi"])))
        if svg:
            (self.out / f"{name}.svg").write_bytes(saved(figure, "svg"))
        plt.close(figure)


def rounded(value: Any, digits: int = 6) -> Any:
    """Plain Python values, floats to so many significant digits, keys as strings."""
    if isinstance(value, dict):
        return {str(k): rounded(v, digits) for k, v in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [rounded(v, digits) for v in value]
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        number = float(f"{float(value):.{digits}g}")
        return int(number) if number.is_integer() and abs(number) < 1e9 else number
    return value


def verdict(agrees: bool) -> str:
    """The word for a claim that can be decided by a number."""
    return "reproduced" if agrees else "differs"


@contextmanager
def progress(run: Run, label: str) -> Iterator[None]:
    """Say on stderr what is being made, and how long it took."""
    print(f"{label} …", file=sys.stderr, flush=True)
    start = time.perf_counter()
    yield
    run.times[f"{label}, s"] = time.perf_counter() - start
    print(f"{label}: {run.times[f'{label}, s']:.1f} s", file=sys.stderr, flush=True)


def draw_series(axes: Axes, series: dict[str, dict[str, float]], **style: Any) -> None:
    """A line for each variant, over numbers that are the keys of its values."""
    for name, values in series.items():
        x = [int(n) for n in values]
        axes.plot(x, list(values.values()), color=COLOURS[name], marker=MARKERS[name], label=name, **style)


def curve_points(spline: Any, per_span: int = 24) -> FloatArray:
    """Points of a closed spline, evenly in every span."""
    u = np.asarray(spline.knots)
    x = np.arange(per_span) / per_span
    return np.asarray(spline((u[:-1, None] + x * np.diff(u)[:, None]).ravel()))
