"""How a text is laid out, validated."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TypeAlias

from ...errors import is_number
from ...fields import Condition, check, checked, positive
from ...readers.characters import Feature, parsed_features

Direction: TypeAlias = Literal["ltr", "rtl", "ttb", "btt"]
Align: TypeAlias = Literal["start", "center", "end", "justify"]
Orientation: TypeAlias = Literal["mixed", "upright"]

LANGUAGE = re.compile(r"(?:[A-Za-z]{2,3}|[A-Za-z]{5,8}|x)(?:-[A-Za-z0-9]{1,8})*")
"""Language tags (BCP 47), and HarfBuzz's private ones, as in "x-hbot-ABCD"."""


def _is_script(code: Any) -> bool:
    from fontTools.unicodedata import script_name

    return isinstance(code, str) and bool(script_name(code.title(), ""))


SCRIPT = Condition("a code of ISO 15924, such as 'Latn' or 'Arab'", _is_script)
TAG = Condition(
    "a tag of BCP 47, such as 'de' or 'zh-Hant'", lambda tag: bool(isinstance(tag, str) and LANGUAGE.fullmatch(tag))
)
LENGTH = positive("length in font units")


@dataclass(frozen=True)
class Setting:
    """The typographic arguments of :func:`.lay_out.layout`, by the same names."""

    features: str = ""
    script: str | None = checked(None, SCRIPT)
    language: str | None = checked(None, TAG)
    direction: Direction | None = checked(None)
    width: float | None = checked(None, LENGTH)
    align: Align = checked("start")
    line_height: float | None = checked(None, LENGTH)
    orientation: Orientation = checked("mixed")
    letter_spacing: float = checked(0.0, Condition("a finite length in font units", is_number))
    parsed_features: tuple[Feature, ...] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "parsed_features", parsed_features(self.features))
        check(self)
        if self.script is not None:
            object.__setattr__(self, "script", self.script.title())

    @cached_property
    def vertical(self) -> bool:
        """Whether lines are columns."""
        return self.direction in ("ttb", "btt")

    @cached_property
    def stacked(self) -> bool:
        """Whether all characters of a column are upright: in "btt" always."""
        return self.vertical and (self.orientation == "upright" or self.direction == "btt")
