"""Options as fields of frozen dataclasses: help, bounds and flags are declared once, beside type and default.

The command line, files of settings, checks of values and printed commands are made from it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import cache
from itertools import chain
from types import NoneType, UnionType
from typing import Any, Literal, NamedTuple, Union, get_args, get_origin, get_type_hints

from .errors import is_number, is_positive, is_whole, require, require_choice

CLOSENESS = "How close to the source"
CORNERS = "Corners"
METHOD = "The method, in the paper's terms"
WRITTEN = "What is written"
LOOK = "How drawings look"
"""Headings of groups of options."""


class Condition(NamedTuple):
    """A condition on a value that is not None, with its phrase: "a positive distance"."""

    phrase: str
    holds: Callable[[Any], bool]


def positive(noun: str) -> Condition:
    """A finite number above 0."""
    return Condition(f"a positive {noun}", is_positive)


def whole(least: int, most: int) -> Condition:
    """An integer of a range."""
    return Condition(f"a whole number from {least} to {most}", lambda value: is_whole(value, least, most))


SHARE = Condition("from 0 to 1", lambda value: is_number(value, 0, 1))


@dataclass(frozen=True)
class About:
    """What is known of an option besides its type and default.

    Attributes:
        help: a sentence. panel: heading of its group. metavar: stands for the value.
        flags: names on the command line; without any, the field's with hyphens. rule: what a value has to be.
        words: values with a name on the command line. more: further arguments of ``typer.Option``.
        shown: whether the command line has it, and not Python alone.
    """

    help: str
    panel: str | None = None
    metavar: str | None = None
    flags: tuple[str, ...] = ()
    rule: Condition | None = None
    words: Mapping[str, Any] = field(default_factory=dict)
    more: Mapping[str, Any] = field(default_factory=dict)
    shown: bool = True


class Described(NamedTuple):
    """An option: a field's name, its type without None, and what is known of it."""

    name: str
    kind: Any
    about: About

    @property
    def flags(self) -> tuple[str, ...]:
        """Its names on the command line."""
        return self.about.flags or (f"--{self.name.replace('_', '-')}",)


def option(
    default: Any, help: str, panel: str | None = None, metavar: str | None = None, flags: str = "", **about: Any
) -> Any:
    """A dataclass field that is an option, with the attributes of :class:`About`; flags are between spaces."""
    return field(default=default, metadata={"about": About(help, panel, metavar, tuple(flags.split()), **about)})


def checked(default: Any, rule: Condition | None = None) -> Any:
    """A dataclass field that is checked as an option is, and set in Python alone: no command has it."""
    return field(default=default, metadata={"about": About("", rule=rule, shown=False)})


@cache
def options_of(kind: Any) -> tuple[Described, ...]:
    """The options of a dataclass, without those of dataclasses in it."""
    return tuple(one for one in _checked_of(kind) if one.about.shown)


@cache
def _checked_of(kind: Any) -> tuple[Described, ...]:
    hints = get_type_hints(kind)
    return tuple(
        described(one.name, hints[one.name], one.metadata["about"]) for one in fields(kind) if "about" in one.metadata
    )


def described(name: str, hint: Any, about: About) -> Described:
    """An option from its annotation."""
    if get_origin(hint) in (Union, UnionType):
        (hint,) = (part for part in get_args(hint) if part is not NoneType)
    return Described(name, hint, about)


def check(value: Any) -> None:
    """Validate options and :func:`checked` fields of a dataclass by their types and rules.

    None stands for a default that depends on a font.

    Raises:
        OptionError: a value out of its range or of the wrong kind.
    """
    for name, kind, about in _checked_of(value.__class__):
        given = getattr(value, name)
        if given is None and getattr(type(value), name, None) is None:
            continue
        if kind is bool:
            require_choice(name, given)
        elif get_origin(kind) is Literal:
            require_choice(name, given, get_args(kind))
        elif about.rule is not None and not (given is None and None in about.words.values()):
            require(about.rule.holds(given), f"{name} is {about.rule.phrase}", given)


def arguments(value: Any, default: Any, unshown: Collection[str] = ()) -> dict[str, list[str]]:
    """The words of a command line that make ``value`` out of ``default``, by the names of its fields.

    Of what is no option of it there is only what one of the dataclass's ``presets`` sets.

    Args:
        unshown: fields that are no options of this command line.
    """
    found = {}
    if preset := _preset(value, default, unshown):
        found["preset"] = ["--preset", preset]
        default = replace(default, **value.presets[preset])
    known = {one.name: one for one in options_of(value.__class__)}
    for name in (one.name for one in fields(value) if one.name not in unshown):
        own, usual = getattr(value, name), getattr(default, name)
        if is_dataclass(own) and usual is not None:
            found[name] = list(chain(*arguments(own, usual, unshown).values()))
        elif name in known and own != usual:
            flag, _, off = known[name].flags[0].partition("/")
            switch = {True: [flag], False: [off]} if isinstance(own, bool) else {}
            found[name] = switch.get(own) or [flag, text_of(own, known[name].about)]
    return found


def _preset(value: Any, default: Any, unshown: Collection[str]) -> str | None:
    """The preset that sets what ``value`` has, ``default`` has not, and no option sets."""
    known = {one.name for one in options_of(value.__class__)}.difference(unshown)
    for preset, values in getattr(value, "presets", {}).items():
        alone = {name: given for name, given in values.items() if name not in known}
        own, other = ({name: getattr(of, name) for name in alone} for of in (value, default))
        if own == alone != other:
            return str(preset)
    return None


def instance_arguments(face_index: int, location: Mapping[str, float]) -> list[str]:
    """The words of a command line that open a font of a collection, at a location of its design space."""
    words = ["--face-index", str(face_index)] if face_index else []
    place = ",".join(f"{tag}={value:g}" for tag, value in location.items())
    return [*words, "--location", place] if place else words


def text_of(value: Any, about: About) -> str:
    """A value as the command line has it."""
    for word, named in about.words.items():
        if value == named:
            return word
    return ",".join(value) if isinstance(value, tuple) else str(value)
