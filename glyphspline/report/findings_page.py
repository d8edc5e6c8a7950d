"""A page of findings: each with a drawing of its place in the outline that was checked, and a table of all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from html import escape
from types import MappingProxyType
from typing import Any, NamedTuple

from ..checks.finding import Finding, place_on_axes, severity
from ..checks.kinds import KINDS
from ..errors import GlyphsplineError
from ..outlines.outline import Outline
from ..readers import Source
from ..writers.svg.comb import palette
from ..writers.svg.path_data import path_data
from .pages import page_of

DRAWN, LISTED = 2000, 20_000
"""Findings with a drawing. Every kind has its share of them, and each share begins with the worst. Findings in the
table: the worst."""

PRECISION = 2
"""Decimals of path data and points."""

SCRIPTS = ("page.js", "shapes.js", "findings.js")

NUMBERS = {kind.name: k for k, kind in enumerate(KINDS)}


class CheckedFont(NamedTuple):
    """A font and what was found in it.

    Attributes:
        name: as the page calls it. source: of the outlines that were checked. findings: of it. scores: of its glyphs.
    """

    name: str
    source: Source
    findings: Sequence[Finding]
    scores: Mapping[str, float] = MappingProxyType({})


def findings_page(fonts: Sequence[CheckedFont]) -> str:
    """The page as HTML; it loads nothing."""
    every = sorted(
        [(k, finding) for k, font in enumerate(fonts) for finding in font.findings],
        key=lambda pair: (severity(pair[1]), pair[0]),
    )
    listed = every[:LISTED]
    drawings = _Drawings(fonts)
    drawn = to_draw([finding for _, finding in listed])
    homes = [home_of(font.source) for font in fonts]
    rows = [
        [
            k, finding.glyph, finding.gid, NUMBERS[finding.kind], finding.contour, finding.segment,
            *[round(value, PRECISION) for value in finding.point], finding.sentence, place_on_axes(finding, homes[k]),
            drawings.number(k, finding) if n in drawn else -1, round(fonts[k].scores.get(finding.glyph, 0.0)),
        ]
        for n, (k, finding) in enumerate(listed)
    ]  # fmt: skip
    counts = Counter(finding.kind for _, finding in every)
    kinds = [kind for kind in KINDS if counts[kind.name]]
    setup = {
        "fonts": [{"name": font.name, "em": font.source.metrics.units_per_em} for font in fonts],
        "kinds": [[kind.name, kind.level] for kind in KINDS],
        "rows": rows,
        "outlines": drawings.paths,
        "left": len(every) - len(listed),
        "palette": palette(),
    }
    switches = "".join(
        f'<label class="{kind.level}"><input type="checkbox" data-kind="{NUMBERS[kind.name]}" checked><i></i>'
        f"{escape(kind.name)} <span>{counts[kind.name]}</span></label>"
        for kind in kinds
    )
    heading = f"{len(fonts)} fonts"
    if len(fonts) == 1:
        heading = f"{fonts[0].source.family} {fonts[0].source.style}"
    return page_of("findings.html", ("theme.css", "findings.css"), heading, SCRIPTS, setup, kinds=switches)


def home_of(source: Source) -> Mapping[str, float]:
    """User-space value of each axis where a font is open."""
    return {axis.tag: axis.default for axis in source.axes} | dict(source.location)


def to_draw(findings: Sequence[Finding], count: int = DRAWN) -> set[int]:
    """Numbers of the findings that are drawn: of each kind the first, and as many as of the others if it has them."""
    seen: Counter[str] = Counter()
    turns = []
    for n, finding in enumerate(findings):
        turns.append((seen[finding.kind], n))
        seen[finding.kind] += 1
    return {n for _, n in sorted(turns)[:count]}


class _Drawings:
    """Path data of outlines where findings are, each once."""

    def __init__(self, fonts: Sequence[CheckedFont]) -> None:
        self._fonts = fonts
        self._numbers: dict[Any, int] = {}
        self.paths: list[str] = []

    def number(self, font: int, finding: Finding) -> int:
        """Number of the outline in which a finding is; -1 if it cannot be read now."""
        key = font, finding.gid, tuple(finding.location.items())
        if key not in self._numbers:
            try:
                outline = outline_of(self._fonts[font].source, finding)
            except GlyphsplineError:
                return -1
            self._numbers[key] = len(self.paths)
            self.paths.append(path_data(outline.contours, PRECISION))
        return self._numbers[key]


def outline_of(source: Source, finding: Finding) -> Outline:
    """The outline in which a finding is, at its location."""
    if finding.location:
        return source.masters(finding.glyph).instance(finding.location)
    return source.outline(finding.glyph)
