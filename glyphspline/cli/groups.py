"""Commands that take values: a parameter whose type is a frozen dataclass becomes options, one for each field."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass
from inspect import Parameter, Signature, signature
from math import inf
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeAlias, TypeVar, cast, get_args, get_origin, get_type_hints

import typer
from typer.core import TyperCommand

from ..errors import OptionError
from ..fields import CORNERS, About, Described, described, option, options_of, text_of
from ..fitting.options import PRESETS, Options, Preset
from .messages import UNDONE, errors, listen

Value = TypeVar("Value")


class Command(TyperCommand):
    """A command whose help lists options by group, without the libraries that would draw boxes around them.

    Attributes:
        own: of a command that has a table of its own in files of settings: an option that takes NAME=VALUE,…, and the
            dataclass whose fields these are, which are keys of the table too.
        bare: options that may stand without a value, at the end or before another option, and the value that is meant.
    """

    own: ClassVar[tuple[str, type] | None] = None
    bare: ClassVar[Mapping[str, str]] = {}

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Add the values that are meant by bare options."""
        filled: list[str] = []
        for arg, following in zip(args, [*args[1:], "-"], strict=False):
            filled += [arg, self.bare[arg]] if arg in self.bare and following.startswith("-") else [arg]
        return super().parse_args(ctx, filled)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write a section for each group."""
        groups: dict[str, list[tuple[str, str]]] = {}
        for parameter in self.get_params(ctx):
            if record := parameter.get_help_record(ctx):
                usual = "Arguments" if parameter.param_type_name == "argument" else "Options"
                groups.setdefault(getattr(parameter, "rich_help_panel", None) or usual, []).append(record)
        for name, records in groups.items():
            with formatter.section(name):
                formatter.write_dl(records)


Shown: TypeAlias = Callable[[str], bool]
"""Whether the field of a dataclass with this name is an option of a command."""


def only(*names: str) -> Shown:
    """These fields are options of the command."""
    return lambda name: name in names


def without(*names: str) -> Shown:
    """All fields but these are options of the command."""
    return lambda name: name not in names


@dataclass(frozen=True)
class PresetOption:
    """Options that are set together."""

    preset: Preset | None = option(
        None,
        "Set several options: type keeps corners, in the fewest points; brush is smooth, within 3/1000 em; "
        "paper is smooth and passes through corners, with margin 0. Options given beside it win.",
        CORNERS,
    )  # fmt: skip


def grouped(function: Callable[..., bool | None], cls: type[Command] = Command) -> Callable[..., None]:
    """A command for typer, from a function that takes values and returns whether something asked for was not done.

    A parameter is a dataclass, an option annotated with :class:`.About`, or an argument of typer. Expected errors end
    the command, those of making the values too: see :func:`.messages.errors`. A field whose option is given
    neither on the command line nor in a file, keeps the value of the parameter's default, or that of the preset.
    """
    hints = get_type_hints(function, include_extras=True)
    hints.pop("return")
    groups: dict[str, tuple[Any, Shown]] = {}
    flat = [_parameter("context", typer.Context)]
    for name, hint in hints.items():
        default = signature(function).parameters[name].default
        kind, *extras = get_args(hint) if get_origin(hint) is Annotated else (hint,)
        extra = extras[0] if extras else None
        if isinstance(kind, type) and is_dataclass(kind):
            groups[name] = kind() if default is Parameter.empty else default, extra or without()
            flat += _expanded(*groups[name])
        elif isinstance(extra, About):
            flat.append(_option(described(name, kind, extra), default))
        else:
            flat.append(_parameter(name, hint, default))

    def command(context: typer.Context, **given: Any) -> None:
        quiet, source = bool(given.get("quiet")), context.get_parameter_source
        own = {name: value for name, value in given.items() if getattr(source(name), "name", "") != "DEFAULT"}
        with errors(quiet or bool(given.get("as_json"))):
            listen(quiet)
            values = {name: collected(*groups[name], own) if name in groups else given[name] for name in hints}
            undone = function(**values)
        if undone:
            raise typer.Exit(UNDONE)

    command.__name__, command.__doc__ = function.__name__, function.__doc__
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in flat}
    command.__signature__ = Signature(flat)  # type: ignore[attr-defined]
    command.cls = cls  # type: ignore[attr-defined]
    return command


def collected(base: Value, shown: Shown, given: Mapping[str, Any]) -> Value:
    """A dataclass with the options that are given, by name, and as ``base`` is in the rest.

    Raises:
        OptionError: a value is out of its range; the message names the option.
    """
    kind: Any = type(base)
    known = {one.name: one for one in options_of(kind)}
    usual = kind()
    found = {one.name: value for one in fields(kind) if (value := getattr(base, one.name)) != getattr(usual, one.name)}
    for name in [*found]:  # not what follows from others: it is not given
        rest = {key: value for key, value in found.items() if key != name}
        found = rest if kind(**rest) == base else found
    if kind is Options:
        preset = PRESETS.get(given.get("preset", ""), {})
        found |= preset
    for name in (one.name for one in fields(kind) if shown(one.name)):
        if is_dataclass(value := getattr(base, name)):
            found[name] = collected(value, shown, given)
        elif name in known and name in given:
            found[name] = _read(known[name], given[name])
    try:
        return cast(Value, kind(**found))  # not "replace": what is not given may depend on what is
    except OptionError as error:
        words = error.message.split(" ")
        for k, between in ((0, ("is", "and")), (2, ("and",))):
            if len(words) > 2 and words[k] in known and words[1] in between:
                words[k] = known[words[k]].flags[0]
        raise OptionError(" ".join(words)) from None


def _expanded(base: Any, shown: Shown) -> Iterator[Parameter]:
    """The options of a dataclass and of those in it, as parameters for typer."""
    if isinstance(base, Options):
        yield from _expanded(PresetOption(), without())
    known = {one.name: one for one in options_of(base.__class__)}
    for one in fields(base):
        value = getattr(base, one.name)
        if shown(one.name) and is_dataclass(value):
            yield from _expanded(value, shown)
        elif shown(one.name) and one.name in known:
            yield _option(known[one.name], value)


def _option(one: Described, default: Any) -> Parameter:
    """An option as a parameter for typer. A tuple is written between commas."""
    kind, about = one.kind, one.about
    if about.words or get_origin(kind) is tuple:
        kind, default = str, text_of(default, about) or None
    more = {"parser": PARSERS[kind]} if kind in (int, float) else {}
    made = typer.Option(
        *one.flags, help=about.help, rich_help_panel=about.panel, metavar=about.metavar, **more | dict(about.more)
    )
    return _parameter(one.name, Annotated[kind | None if default is None else kind, made], default)


def _read(one: Described, value: Any) -> Any:
    """A value of the command line, or of a file of settings, as its field has it."""
    if get_origin(one.kind) is tuple:
        return tuple(part.strip() for part in value.split(",") if part.strip())
    if one.about.words:
        return one.about.words[value] if value in one.about.words else whole(value)
    return PARSERS[one.kind](value) if one.kind in PARSERS else value


def _parameter(name: str, annotation: Any, default: Any = Parameter.empty) -> Parameter:
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def _parser(kind: type[int] | type[float], what: str, least: float = -inf) -> Callable[[Any], Any]:
    """A parser of numbers; its error message quotes the value."""

    def parse(text: Any) -> Any:
        with suppress(ValueError):
            found = kind(str(text))  # not of a float or bool of a file
            if not found < least:
                return found
        raise typer.BadParameter(f"{text!r} is not {what}")

    return parse


number, whole = _parser(float, "a number"), _parser(int, "a whole number")
natural = _parser(int, "a whole number from 0 on", 0)


def as_path(text: Any) -> Path:
    """Parse a path. Empty strings are rejected, as ``Path("")`` is the current folder."""
    if not str(text):
        raise typer.BadParameter("it is empty: give a folder, or . for this one")
    return Path(text)


PARSERS: dict[Any, Callable[[Any], Any]] = {int: whole, float: number, Path: as_path}
