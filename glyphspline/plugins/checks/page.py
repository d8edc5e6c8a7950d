"""A page of findings: each with a drawing of its place in the outline that was checked, and a table of all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Protocol

from ...errors import GlyphsplineError
from ...outlines.flaws.kinds import KINDS
from ...report.pages import kind_switches, page_of
from ...writers.svg.comb import palette
from ...writers.svg.path_data import path_data
from .finding import Finding, place_on_axes, severity

DRAWN, LISTED = 2000, 20_000
"""Findings with a drawing. Every kind has its share of them, and each share begins with the worst. Findings in the
table: the worst."""

PRECISION = 2
"""Decimals of path data and points."""

FOLDER = Path(__file__).parent
"""Where the files of the page are."""

SCRIPTS = ("page.js", "shapes.js", "places.js", "findings.js")

NUMBERS = {kind.name: k for k, kind in enumerate(KINDS)}


class CheckedFont(Protocol):
    """A font, as the page calls it, and what was found in it: see :class:`.checks.job.FaceFindings`."""

    font: str
    source: Any
    home: Mapping[str, float]
    findings: list[Finding]
    scores: dict[str, float]


def findings_page(fonts: Sequence[CheckedFont]) -> str:
    """The page as HTML; it loads nothing."""
    every = sorted(
        [(k, finding) for k, font in enumerate(fonts) for finding in font.findings],
        key=lambda pair: (severity(pair[1]), pair[0]),
    )
    listed = every[:LISTED]
    paths: list[str] = []

    @cache
    def drawing(k: int, glyph: str, location: tuple[tuple[str, float], ...]) -> int:
        """Number of an outline's path data; -1 if it cannot be read now."""
        source = fonts[k].source
        try:
            outline = source.masters(glyph).instance(dict(location)) if location else source.outline(glyph)
        except GlyphsplineError:
            return -1
        paths.append(path_data(outline.contours, PRECISION))
        return len(paths) - 1

    drawn = to_draw([finding for _, finding in listed])
    rows = [
        [
            k, finding.glyph, finding.gid, NUMBERS[finding.kind], finding.contour, finding.segment,
            *[round(value, PRECISION) for value in finding.point], finding.sentence,
            place_on_axes(finding, fonts[k].home),
            drawing(k, finding.glyph, tuple(finding.location.items())) if n in drawn else -1,
            round(fonts[k].scores.get(finding.glyph, 0.0)),
        ]
        for n, (k, finding) in enumerate(listed)
    ]  # fmt: skip
    counts = Counter(finding.kind for _, finding in every)
    kinds = [(k, kind.name, f' class="{kind.level}"') for k, kind in enumerate(KINDS) if counts[kind.name]]
    setup = {
        "fonts": [{"name": font.font, "em": font.source.metrics.units_per_em} for font in fonts],
        "kinds": [[kind.name, kind.level] for kind in KINDS],
        "rows": rows,
        "outlines": paths,
        "left": len(every) - len(listed),
        "palette": palette(),
    }
    heading = f"{len(fonts)} fonts"
    if len(fonts) == 1:
        heading = f"{fonts[0].source.family} {fonts[0].source.style}"
    return page_of(
        "findings.html", ("theme.css", "findings.css"), heading, SCRIPTS, setup, own=[FOLDER],
        kinds=kind_switches(kinds, counts),
    )  # fmt: skip


def to_draw(findings: Sequence[Finding], count: int = DRAWN) -> set[int]:
    """Numbers of the findings that are drawn: of each kind the first, and as many as of the others if it has them."""
    seen: Counter[str] = Counter()
    turns = []
    for n, finding in enumerate(findings):
        turns.append((seen[finding.kind], n))
        seen[finding.kind] += 1
    return {n for _, n in sorted(turns)[:count]}
