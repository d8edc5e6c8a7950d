"""The options of the command ``text``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ...fields import LOOK, WRITTEN, option
from .setting import Align, Direction

TEXT = "The text"
"""Heading of a group of options."""


@dataclass(frozen=True)
class TextOptions:
    """How a text is set on lines, and where it comes from."""

    text_file: Path | None = option(None, "Set the text of a UTF-8 file instead.", TEXT, "FILE")
    fallbacks: list[Path] | None = option(
        None, "Use this font for characters that FONT lacks. Repeatable.", TEXT, "FONT", flags="--fallback-font"
    )
    features: str = option("", "Switch OpenType features: liga,-kern,ss01=2.", TEXT, "TAG,…")
    script: str | None = option(None, "Set the script of all text, by ISO 15924: Arab.", TEXT, "CODE")
    language: str | None = option(None, "Set the language, by BCP 47: de, zh-Hant.", TEXT, "TAG")
    direction: Direction | None = option(
        None, "Set the direction; ttb and btt are columns. Without it, that of the first letter.", TEXT
    )
    width: str | None = option(
        None, "Break lines at this width: font units, 12em, or 80mm if --size is given.", TEXT, "LENGTH"
    )
    align: Align = option("start", "Align lines; justify widens spaces.", TEXT)
    line_height: str | None = option(None, "Set the distance of baselines. Without it, the font's.", TEXT, "LENGTH")
    letter_spacing: str | None = option(None, "Add this space between letters.", TEXT, "LENGTH")
    cap_height: str | None = option(
        None, "Set the size by the height of a capital H: 50mm, instead of --size.", LOOK, "LENGTH"
    )
    x_height: str | None = option(None, "Set the size by the height of a small x, likewise.", LOOK, "LENGTH")
    fit_width: str | None = option(None, "Set the size by the width of all ink of the lines: 1200mm.", LOOK, "LENGTH")


@dataclass(frozen=True)
class DrawingOptions:
    """How drawings of a text are written."""

    format_name: str | None = option(
        None, "Write this format (curvature, source, …) instead of that of --out's suffix.",
        WRITTEN, "NAME", flags="--format",
    )  # fmt: skip
    each_glyph: bool = option(False, "Write each glyph in SVG as an element with an id, not all as one path.", WRITTEN)
