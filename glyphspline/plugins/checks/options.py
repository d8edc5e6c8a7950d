"""The options of the command ``check``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import typer

from ...cli.arguments import NATURAL, PATH
from ...fields import option
from ...outlines.flaws.kinds import KINDS, Level

FOUND = "What is found"
REPORTED = "What is reported"
"""Headings of groups of options."""


def more_thresholds(context: typer.Context, text: str | None) -> str | None:
    """Thresholds of the command line after those of a file, which they replace one by one."""
    before = (context.default_map or {}).get("thresholds")
    return text if text == before else ",".join(filter(None, [before, text]))


@dataclass(frozen=True)
class CheckOptions:
    """What ``check`` looks for."""

    kinds: str | None = option(None, f"Look only for {', '.join(kind.name for kind in KINDS)}.", FOUND, "KIND,…")
    thresholds: str | None = option(
        None, "Set from which value on each kind counts, as kink=1,short=2: degrees, thousandths of an em, shares.",
        FOUND, "NAME=VALUE,…", more={"callback": more_thresholds},
    )  # fmt: skip
    corner_angle: float | None = option(
        None, "Count a joint as a corner from this turn on. Without it, 12.", FOUND, "DEGREES"
    )
    axis: str | None = option(None, "Look along this axis of a variable font only.", FOUND, "TAG")
    steps: int | None = option(
        None, "Look at this number of steps of each axis besides the masters.", FOUND, "N", more=NATURAL
    )


@dataclass(frozen=True)
class ReportOptions:
    """What ``check`` makes of its findings."""

    loglevel: Level | None = option(
        None, "Show findings from this level on. Without it, WARN in tables, INFO in JSON, CSV and HTML.",
        REPORTED, flags="--loglevel -l", more={"case_sensitive": False},
    )  # fmt: skip
    error_level: Level | None = option(
        None, "Exit with status 1 if there are findings of this level or above.",
        REPORTED, flags="--error-level -e", more={"case_sensitive": False},
    )  # fmt: skip
    baseline: Path | None = option(None, "Leave out the findings of this file that are no worse now.", REPORTED, "FILE")
    write_baseline: Path | None = option(
        None, "Write all findings to this file, as known ones.", REPORTED, "FILE", more=PATH
    )
    rows: int = option(20, "Print this number of lines of the table.", REPORTED, "N", more=NATURAL)
    csv: Path | None = option(None, "Write findings as CSV; - is standard output.", REPORTED, "FILE", more=PATH)
    ghmarkdown: Path | None = option(
        None, "Write findings as Markdown for GitHub; - is standard output.", REPORTED, "FILE", more=PATH
    )
    html: Path | None = option(None, "Write a page with a drawing of each finding.", REPORTED, "FILE", more=PATH)
    plot: Path | None = option(
        None, "Draw the largest turn against the axis: SVG, PNG, PDF.", REPORTED, "FILE", more=PATH
    )
