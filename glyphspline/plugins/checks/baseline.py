"""Findings that are known: a JSON file, against which only new and worse ones count."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Mapping
from itertools import zip_longest
from pathlib import Path
from typing import Any, TypeAlias

from ...errors import GlyphsplineError
from ...files import reading, writing
from .finding import SMALLER_IS_WORSE, Finding, badness

FORMAT = "glyphspline baseline 1"

Key: TypeAlias = tuple[str, str, int, int]
"""Glyph, kind, contour, segment."""


class Baseline:
    """Known findings of fonts.

    A finding is known by its font's family and style, its glyph, kind, contour and segment. Of several with the same
    key the worst is compared with the worst, the next with the next: along two axes a joint may kink twice.
    """

    def __init__(self) -> None:
        self._known: dict[str, dict[Key, list[float]]] = {}

    def add(self, font: str, findings: Iterable[Finding]) -> None:
        """Take in all findings of a glyph of a font. Of two fonts of one name the worse values of both are kept."""
        known = self._known.setdefault(font, {})
        for key, own in _by_key(findings).items():
            pairs = zip_longest(_worst_first(key, map(_value, own)), known.get(key, ()))
            known[key] = [_worst_first(key, [value for value in pair if value is not None])[0] for pair in pairs]

    def new(self, font: str, findings: Iterable[Finding]) -> list[Finding]:
        """Of all findings of a glyph those that are new, or worse than they were, in their order."""
        findings, known = list(findings), self._known.get(font, {})
        old: set[int] = set()
        for key, own in _by_key(findings).items():
            own.sort(key=badness, reverse=True)
            pairs = zip(own, known.get(key, ()), strict=False)
            old |= {id(item) for item, value in pairs if _worst_first(key, [value, _value(item)])[0] == value}
        return [item for item in findings if id(item) not in old]

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
        with writing(path):
            path.write_text(text, encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> Baseline:
        """Read a file that :meth:`write` has written.

        Raises:
            GlyphsplineError: the file cannot be read, or is none.
        """
        with reading(path, GlyphsplineError, "JSON"):
            data: Any = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(data, Mapping) or data.get("format") != FORMAT:
            raise GlyphsplineError(f"is no baseline: its format is not {FORMAT!r}", font=str(path))
        baseline = cls()
        try:
            for font, rows in data["fonts"].items():
                known = {(str(a), str(b), int(c), int(d)): map(float, values) for a, b, c, d, values in rows}
                baseline._known[font] = {key: _worst_first(key, values) for key, values in known.items()}
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise GlyphsplineError("is a broken baseline", font=str(path)) from error
        return baseline


def _by_key(findings: Iterable[Finding]) -> dict[Key, list[Finding]]:
    found: dict[Key, list[Finding]] = defaultdict(list)
    for finding in findings:
        found[finding.glyph, finding.kind, finding.contour, finding.segment].append(finding)
    return found


def _value(finding: Finding) -> float:
    # Significant digits of a value: a finding is worse only if these say so.
    return float(f"{finding.value:.3g}")


def _worst_first(key: Key, values: Iterable[float]) -> list[float]:
    return sorted(values, reverse=key[1] not in SMALLER_IS_WORSE)
