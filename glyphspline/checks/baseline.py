"""Findings that are known: a JSON file, against which only new and worse ones count."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

from ..errors import GlyphsplineError, OutputError
from .finding import Finding

FORMAT = "glyphspline baseline 1"

DIGITS = 3
"""Significant digits of a value: a finding is worse if it is larger in these."""

Key: TypeAlias = tuple[str, str, int, int]
"""Glyph, kind, contour, segment."""


class Baseline:
    """Known findings of fonts.

    A finding is known by its font's family and style, its glyph, kind, contour and segment. Of several with the same
    key the largest is compared with the largest, the next with the next: along two axes a joint may kink twice.
    """

    def __init__(self) -> None:
        self._known: dict[str, dict[Key, list[float]]] = {}

    def add(self, font: str, findings: Iterable[Finding]) -> None:
        """Take in all findings of a glyph of a font. Two fonts of one name keep the larger values of both."""
        known = self._known.setdefault(font, {})
        for key, values in _by_key(findings).items():
            rounded = sorted((_rounded(finding.value) for finding in values), reverse=True)
            before = known.get(key, [])
            longer, shorter = (rounded, before) if len(rounded) > len(before) else (before, rounded)
            known[key] = [max(pair) for pair in zip(shorter, longer, strict=False)] + longer[len(shorter) :]

    def new(self, font: str, findings: Iterable[Finding]) -> list[Finding]:
        """Of all findings of a glyph those that are new, or worse than they were, in their order."""
        findings, known = list(findings), self._known.get(font, {})
        old: set[int] = set()
        for key, values in _by_key(findings).items():
            values.sort(key=lambda finding: -finding.value)
            pairs = zip(values, known.get(key, ()), strict=False)
            old |= {id(finding) for finding, value in pairs if _rounded(finding.value) <= value}
        return [finding for finding in findings if id(finding) not in old]

    def write(self, path: Path) -> None:
        """Write a file; the order of fonts and findings is theirs, not that of the run.

        Raises:
            OutputError: the file cannot be written.
        """
        fonts = []
        for font, known in sorted(self._known.items()):
            lines = [json.dumps([*key, values], ensure_ascii=False) for key, values in sorted(known.items())]
            fonts.append(f"{json.dumps(font, ensure_ascii=False)}: [\n" + ",\n".join(lines) + "\n]")
        text = f'{{"format": "{FORMAT}", "fonts": {{\n' + ",\n".join(fonts) + "\n}}\n"
        try:
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            raise OutputError(f"cannot be written: {error.strerror or error}", font=str(path)) from error

    @classmethod
    def read(cls, path: Path) -> Baseline:
        """Read a file that :meth:`write` has written.

        Raises:
            GlyphsplineError: the file cannot be read, or is none.
        """
        try:
            data: Any = json.loads(path.read_text(encoding="utf-8"))
        except OSError as error:
            raise GlyphsplineError(f"cannot be read: {error.strerror or error}", font=str(path)) from error
        except ValueError as error:
            raise GlyphsplineError(f"is not JSON: {error}", font=str(path)) from error
        if not isinstance(data, Mapping) or data.get("format") != FORMAT:
            raise GlyphsplineError(f"is no baseline: its format is not {FORMAT!r}", font=str(path))
        baseline = cls()
        try:
            for font, rows in data["fonts"].items():
                known = {(str(a), str(b), int(c), int(d)): [float(v) for v in values] for a, b, c, d, values in rows}
                baseline._known[font] = {key: sorted(values, reverse=True) for key, values in known.items()}
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise GlyphsplineError("is a broken baseline", font=str(path)) from error
        return baseline


def _by_key(findings: Iterable[Finding]) -> dict[Key, list[Finding]]:
    found: dict[Key, list[Finding]] = defaultdict(list)
    for finding in findings:
        found[finding.glyph, finding.kind, finding.contour, finding.segment].append(finding)
    return found


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
