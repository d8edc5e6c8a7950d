"""The hooks: what plug-ins add to the pipeline, what each hook gets, and how it is found.

A plug-in is an entry point of the group ``glyphspline.plugins`` whose value is a :class:`Plugin`. Those of this package
are such entry points too, one for each folder of ``plugins/``. One that is not there, because its folder has been taken
away, adds nothing, and the rest works on. Entry points are read, and plug-ins imported, when something is asked for
that the pipeline does not have; and what they add, when it is used.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from .errors import GlyphsplineError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "glyphspline.plugins"

Place: TypeAlias = str
"""Where something is, "module:name". A module that begins with a dot is in the plug-in's package."""


class Listed(NamedTuple):
    """A command as the help lists it: the place of the function, see :func:`.cli.groups.grouped`, and a sentence."""

    place: Place
    help: str


@dataclass(frozen=True)
class Plugin:
    """What a plug-in adds, by hook and name.

    Attributes:
        commands: of the command line.
        formats: one file a glyph: a :class:`.writers.formats.Format` of that name.
        whole: one file a font: a :class:`.runs.whole_formats.WholeFormat` of that name.
        readers: sources: a :class:`.readers.open.Reader`.
        services: functions that the pipeline, or other plug-ins, call if they are there: see ``SERVICES``.
        work: kinds of work: functions without arguments that call all compiled functions of the kind.
        names: public names, ``gs.NAME``; those of this package stand in ``__init__.pyi``.
    """

    commands: Mapping[str, Listed] = field(default_factory=dict)
    formats: Mapping[str, Place] = field(default_factory=dict)
    whole: Mapping[str, Place] = field(default_factory=dict)
    readers: Mapping[str, Place] = field(default_factory=dict)
    services: Mapping[str, Place] = field(default_factory=dict)
    work: Mapping[str, Place] = field(default_factory=dict)
    names: Mapping[str, Place] = field(default_factory=dict)


SERVICES: dict[str, tuple[str, str]] = {
    "axis_pages": ("pages along an axis", "see :func:`.masters.axis_pages.axis_pages`"),
    "check_axis": ("pages along an axis", "whether masters can be converted so: source, tag, options"),
    "cluster": ("a cluster", "an executor on it: its address, the time limit of a batch, kinds of work"),
    "convert_masters": ("all masters", "see :func:`glyphspline.convert_masters`"),
    "experiment": ("the paper's figures", "see :func:`.experiments.command.demonstrate`"),
    "fetch_fonts": ("a URL", "fonts behind it, in the user's cache: the URL, suffixes of fonts"),
    "fit_masters": ("fits of all masters", "see :func:`.masters.job.convert_font_masters`"),
    "g2_fits": ("continuity g2", "fits: options, tolerance and em in font units, to :class:`.fitting.faithful.Fits`"),
    "kink_report": ("kinks along axes", "parts of checks as one report: see :func:`.masters.kinks.kink_report`"),
    "layout": ("text on lines", "see :func:`glyphspline.layout`"),
    "no_joints": ("kinks along axes", "numbers of no joints along an axis: a :class:`.DesignAxis`"),
    "notebook": ("display in notebooks", "no arguments"),
    "on_axes": ("checks along axes", "see :func:`.masters.on_axes.on_axes`"),
    "refit_drawings": ("refit of drawings", "paths, options, a folder or None for themselves, options of the run"),
    "refit_masters": ("refit of masters", "paths, the call of ``refit``, an axis or None, an executor"),
    "text_document": ("text on lines", "as SVG: a layout and the results of its distinct glyphs"),
    "turns_figure": ("a diagram of turns along axes", "a source, a report, a format"),
    "variations": ("the masters of a variable font", "see :class:`.masters.variations.Variations`"),
}
"""What services there are: for what, and what each gets and returns."""


@cache
def plugins() -> Mapping[str, Plugin]:
    """The plug-ins that are there, by name. One that is broken is named in a warning, and left out."""
    return {name: plugin for name, entry in entries().items() if (plugin := _loaded(entry)) is not None}


@cache
def entries() -> Mapping[str, EntryPoint]:
    """The entry points of plug-ins by name, of several with one name the first."""
    from importlib.metadata import entry_points  # here and not above: most runs ask for nothing that plug-ins have

    return {entry.name: entry for entry in sorted(entry_points(group=GROUP), key=lambda one: one.name)[::-1]}


def away() -> list[str]:
    """The names of plug-ins whose code is not there, or broken."""
    return sorted(entries().keys() - plugins().keys())


def away_words() -> str:
    """The same in words, to end a message with."""
    return f"; plug-ins that are not there: {', '.join(away())}" if away() else ""


def names(hook: str) -> list[str]:
    """The names of all that plug-ins add to a hook; nothing of it is imported."""
    return sorted({name for plugin in plugins().values() for name in getattr(plugin, hook)})


def find(hook: str, name: str) -> Any:
    """What a plug-in adds to a hook by that name; None if none does.

    Raises:
        GlyphsplineError: it cannot be loaded.
    """
    for plugin_name, plugin in plugins().items():
        if name in (added := getattr(plugin, hook)):
            place = added[name]
            return _at(plugin_name, place.place if isinstance(place, Listed) else place)
    return None


def every(hook: str) -> Iterator[Any]:
    """All that plug-ins add to a hook, by name."""
    return (find(hook, name) for name in names(hook))


def service(name: str) -> Any:
    """The function of a service.

    Raises:
        GlyphsplineError: no plug-in has it.
    """
    found = find("services", name)
    if found is None:
        raise GlyphsplineError(f"{SERVICES[name][0]}: the plug-in for it is not there")
    return found


def _at(plugin: str, place: Place) -> Any:
    """What stands at a place of a plug-in."""
    module, _, name = place.partition(":")
    try:
        return getattr(import_module(module, entries()[plugin].module), name)
    except ModuleNotFoundError as error:
        if not is_away(error):
            raise
        raise GlyphsplineError(f"the plug-in {plugin} needs another one, which is not there: {error.name}") from error
    except AttributeError as error:
        raise GlyphsplineError(f"the plug-in {plugin} cannot be loaded: {error}") from error


def _loaded(entry: EntryPoint) -> Plugin | None:
    """A plug-in; None if its code is not there, or is broken."""
    try:
        found = entry.load()
    except ModuleNotFoundError as error:
        if error.name and f"{entry.module}.".startswith(f"{error.name}."):
            return None
        found, why = None, str(error)
    except Exception as error:  # a plug-in may raise anything
        found, why = None, f"{type(error).__name__}: {error}"
    else:
        why = f"{entry.value} is {found!r}, no Plugin"
    if isinstance(found, Plugin):
        return found
    who = f"the plug-in {entry.name!r}{f' of {entry.dist.name}' if entry.dist else ''}"
    logging.getLogger(__package__).warning("%s cannot be loaded: %s", who, why)
    return None


def is_away(error: ModuleNotFoundError) -> bool:
    """Whether an import failed because one of this package's plug-ins has been taken away."""
    return (error.name or "").startswith(f"{__package__}.plugins.")
