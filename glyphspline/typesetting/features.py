"""OpenType features as HarfBuzz writes them: "liga,-kern,ss01=2,smcp[0:5]"."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from ..errors import OptionError, require

FEATURE = re.compile(r"([+-]?)([ -~]{4})(?:\[(\d*)(?:(:)(\d*))?\])?(?:=(\d{1,9}|on|off))?")
END = 2**32 - 1
"""No character has a larger number: HarfBuzz's "to the end"."""

APPLE = ("morx", "mort", "kerx")
"""Tables of fonts in which HarfBuzz finds features without names in GSUB and GPOS."""


class Feature(NamedTuple):
    """A feature with its value, for the characters from ``start`` up to ``stop`` of the text."""

    tag: str
    value: int
    start: int
    stop: int


def parsed(features: str) -> tuple[Feature, ...]:
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


def check(features: Sequence[Feature], faces: Iterable[Any]) -> None:
    """Raise an OptionError for a feature that no face has.

    Args:
        features: as :func:`parsed`. faces: HarfBuzz's.
    """
    if not features:
        return
    known: set[str] = set()
    for face in faces:
        tables = face.table_tags
        if not known.isdisjoint(APPLE) or not set(tables).isdisjoint(APPLE):
            return
        known |= {"kern"} if "kern" in tables else set()
        known |= _tags(face)
    for feature in features:
        if feature.tag not in known:
            has = f"it has {', '.join(sorted(known))}" if known else "it has none"
            raise OptionError(f"the font has no feature {feature.tag!r}; {has}")


def _tags(face: Any) -> set[str]:
    """All features of GSUB and GPOS, of all scripts and languages."""
    found: set[str] = set()
    for table in ("GSUB", "GPOS"):
        for script in range(len(face.get_table_script_tags(table))):
            languages = len(face.get_script_language_tags(table, script))
            for language in [0xFFFF, *range(languages)]:
                found |= set(face.get_language_feature_tags(table, script, language))
    return found


def for_buffer(features: Sequence[Feature], origin: int) -> dict[str, Any]:
    """The features as uharfbuzz takes them; ``origin``: number in the text of the buffer's first character."""
    found: dict[str, Any] = {}
    for tag, value, start, stop in features:
        everywhere = start == 0 and stop == END
        place = (max(start - origin, 0), stop if stop == END else max(stop - origin, 0), value)
        if everywhere:
            found[tag] = value
        else:
            before = found.get(tag, [])
            found[tag] = [*([(0, END, before)] if isinstance(before, int) else before), place]
    return found
