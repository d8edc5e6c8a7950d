"""How a text is laid out, validated."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias
from unicodedata import category

from ..errors import OptionError, is_positive, require, require_choice
from .features import Feature, parsed

Direction: TypeAlias = Literal["ltr", "rtl", "ttb", "btt"]
PathAlign: TypeAlias = Literal["start", "center", "end"]
Align: TypeAlias = Literal[PathAlign, "justify"]
Orientation: TypeAlias = Literal["mixed", "upright"]
Side: TypeAlias = Literal["left", "right"]
"""Of a path, on which letters stand."""

LONGEST = 1_000_000
"""Characters of the longest text."""

LANGUAGE = re.compile(r"(?:[A-Za-z]{2,3}|[A-Za-z]{5,8}|x)(?:-[A-Za-z0-9]{1,8})*")
"""Language tags (BCP 47), and HarfBuzz's private ones, as in "x-hbot-ABCD"."""

PARAGRAPH = re.compile("\r\n|[\n\r\x85\u2028\u2029]")
"""What ends a line of the text."""


@dataclass(frozen=True)
class Setting:
    """What :func:`.lay_out.layout` is told of the text's setting, by the same names."""

    features: str = ""
    script: str | None = None
    language: str | None = None
    direction: Direction | None = None
    width: float | None = None
    align: Align = "start"
    line_height: float | None = None
    orientation: Orientation = "mixed"
    parsed_features: tuple[Feature, ...] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "parsed_features", parsed(self.features))
        if self.script is not None:
            from fontTools.unicodedata import script_name

            known = isinstance(self.script, str) and script_name(self.script.title(), "")
            require(bool(known), "script is a code of ISO 15924, such as 'Latn' or 'Arab'", self.script)
            object.__setattr__(self, "script", self.script.title())
        if self.language is not None:
            named = isinstance(self.language, str) and LANGUAGE.fullmatch(self.language)
            require(bool(named), "language is a tag of BCP 47, such as 'de' or 'zh-Hant'", self.language)
        if self.direction is not None:
            require_choice("direction", self.direction, ("ltr", "rtl", "ttb", "btt"))
        for name in ("width", "line_height"):
            value = getattr(self, name)
            require(value is None or is_positive(value), f"{name} is a positive length in font units", value)
        require_choice("align", self.align, ("start", "center", "end", "justify"))
        require_choice("orientation", self.orientation, ("mixed", "upright"))

    @cached_property
    def vertical(self) -> bool:
        """Whether lines are columns."""
        return self.direction in ("ttb", "btt")

    @cached_property
    def stacked(self) -> bool:
        """Whether all characters of a column are upright: in "btt" always."""
        return self.vertical and (self.orientation == "upright" or self.direction == "btt")


def check_text(text: str) -> None:
    """Raise an OptionError for a text that cannot be laid out."""
    require(isinstance(text, str), "text is a string", text)
    require(bool(text), "text has at least one character", text)
    if len(text) > LONGEST:
        raise OptionError(f"text has {len(text):,} characters, more than {LONGEST:,}")
    for character in sorted(set(text)):
        kind = category(character)
        if kind == "Cs" or (kind == "Cc" and character != "\t" and not PARAGRAPH.fullmatch(character)):
            what = "half of a surrogate pair" if kind == "Cs" else "a control character"
            raise OptionError(f"text has {what}, U+{ord(character):04X}, as character {text.index(character)}")


def paragraphs(text: str) -> Sequence[tuple[int, int]]:
    """First and last (exclusive) character of each paragraph; what ends a paragraph is in none of them."""
    ends = [match.span() for match in PARAGRAPH.finditer(text)]
    if ends and ends[-1][1] == len(text):  # a file's last line ends too
        ends[-1] = (ends[-1][0], ends[-1][0])
        text = text[: ends[-1][0]]
        ends.pop()
    starts = [0, *(stop for _, stop in ends)]
    stops = [*(start for start, _ in ends), len(text)]
    return list(zip(starts, stops, strict=True))
