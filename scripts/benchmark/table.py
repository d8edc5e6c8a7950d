"""Rows of a suite as a Markdown table between two markers of ``docs/benchmarks.md``, and as JSON."""

from __future__ import annotations

import json
from pathlib import Path

from .measure import Row

MARKERS = "<!-- benchmark {suite}: begin -->", "<!-- benchmark {suite}: end -->"


def markdown(rows: list[Row]) -> str:
    """The table; ratios say how many times as fast glyphspline is."""
    lines = ["| what | measured | must | aim | reached | times |", "|---|---|---|---|---|---|"]
    for row in rows:
        unit = "x" if row.unit == "x" else f" {row.unit}"
        limits = ["" if limit is None else f"{limit:g}{unit}" for limit in (row.must, row.aim)]
        value = f"{row.value:.0f}" if row.value >= 1000 else f"{row.value:.3g}"
        lines.append(f"| {row.what} | {value}{unit} | {limits[0]} | {limits[1]} | {row.reached()} | {row.note} |")
    return "\n".join(lines)


def write(suite: str, rows: list[Row], root: Path) -> None:
    """Put the table into docs/benchmarks.md, between the suite's markers, and everything into outputs/benchmark/."""
    begin, end = (marker.format(suite=suite) for marker in MARKERS)
    page = root / "docs" / "benchmarks.md"
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    if begin in text and end in text:
        before, rest = text.split(begin, 1)
        after = rest.split(end, 1)[1]
        page.write_text(f"{before}{begin}\n{markdown(rows)}\n{end}{after}", encoding="utf-8")
    target = root / "outputs" / "benchmark" / f"{suite}.json"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps([row.as_json() for row in rows], indent=1) + "\n", encoding="utf-8")
