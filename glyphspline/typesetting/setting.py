"""How a text is laid out, validated; OpenType features as HarfBuzz writes them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, NamedTuple, TypeAlias

from ..errors import OptionError, is_number, require
from ..fields import Rule, check, checked, positive

Direction: TypeAlias = Literal["ltr", "rtl", "ttb", "btt"]
Align: TypeAlias = Literal["start", "center", "end", "justify"]
Orientation: TypeAlias = Literal["mixed", "upright"]

LANGUAGE = re.compile(r"(?:[A-Za-z]{2,3}|[A-Za-z]{5,8}|x)(?:-[A-Za-z0-9]{1,8})*")
"""Language tags (BCP 47), and HarfBuzz's private ones, as in "x-hbot-ABCD"."""

FEATURE = re.compile(r"([+-]?)([ -~]{4})(?:\[(\d*)(?:(:)(\d*))?\])?(?:=(\d{1,9}|on|off))?")
END = 2**32 - 1
"""No character has a larger number: HarfBuzz's "to the end"."""


class Feature(NamedTuple):
    """A feature with its value, for the characters from ``start`` up to ``stop`` of the text."""

    tag: str
    value: int
    start: int
    stop: int


def parsed_features(features: str) -> tuple[Feature, ...]:
    """The features of a list with commas.

    Raises:
        OptionError: one is not written as HarfBuzz has it.
    """
    require(isinstance(features, str), "features are a string, such as 'liga,-kern,ss01=2'", features)
    found = []
    for entry in filter(None, map(str.strip, features.split(","))):
        match = FEATURE.fullmatch(entry)
        if not match or (match[1] == "-" and match[6]):
            raise OptionError(
                f"not a feature: {entry!r}; a feature is a tag of four characters with or without a sign, a range of"
                " characters or a value, as in 'liga', '-kern', 'ss01=2', 'smcp[0:5]'"
            )
        value = {"on": 1, "off": 0, None: int(match[1] != "-")}.get(match[6])
        start = int(match[3] or 0)
        stop = int(match[5] or END) if match[4] or match[3] is None else start + 1
        found.append(Feature(match[2], int(match[6]) if value is None else value, min(start, END), min(stop, END)))
    return tuple(found)


def check_features(features: Sequence[Feature], faces: Iterable[Any]) -> None:
    """Raise an OptionError for a feature that no face has.

    Args:
        features: as :func:`parsed_features`. faces: HarfBuzz's.
    """
    known: set[str] = set()
    for face in faces:
        tables = set(face.table_tags)
        if tables & {"morx", "mort", "kerx"}:  # Apple's, in which HarfBuzz finds features without names here
            return
        known |= {"kern"} & tables
        for table in ("GSUB", "GPOS"):
            for script in range(len(face.get_table_script_tags(table))):
                for language in [0xFFFF, *range(len(face.get_script_language_tags(table, script)))]:
                    known |= set(face.get_language_feature_tags(table, script, language))
    for feature in features:
        if feature.tag not in known:
            has = f"it has {', '.join(sorted(known))}" if known else "it has none"
            raise OptionError(f"the font has no feature {feature.tag!r}; {has}")


def _is_script(code: Any) -> bool:
    from fontTools.unicodedata import script_name

    return isinstance(code, str) and bool(script_name(code.title(), ""))


SCRIPT = Rule("a code of ISO 15924, such as 'Latn' or 'Arab'", _is_script)
TAG = Rule(
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
    letter_spacing: float = checked(0.0, Rule("a finite length in font units", is_number))
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


def for_buffer(features: Sequence[Feature], origin: int) -> dict[str, Any]:
    """The features as uharfbuzz takes them; ``origin``: number in the text of the buffer's first character."""
    found: dict[str, Any] = {}
    for tag, value, start, stop in features:
        if start == 0 and stop == END:
            found[tag] = value
        else:
            before = found.get(tag, [])
            found[tag] = [(0, END, before)] if isinstance(before, int) else before
            found[tag].append((max(start - origin, 0), stop if stop == END else max(stop - origin, 0), value))
    return found
