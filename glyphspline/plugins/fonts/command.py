"""The command ``refit``: fitted outlines go back into fonts, sources and drawings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ...cli import arguments as opt
from ...cli.convert import Conversion, convert_fonts, workplace
from ...cli.groups import Command, grouped, without
from ...cli.messages import print_json, say, stop
from ...cli.tables import runs_facts, runs_table
from ...fields import WRITTEN, About
from ...hooks import service
from .spec import RefitSpec

if TYPE_CHECKING:
    from concurrent.futures import Executor


class LayerCommand(Command):
    """A command that may write into a layer, whose name need not be said."""

    bare = {"--layer": "glyphspline"}  # noqa: RUF012


@partial(grouped, cls=LayerCommand)
def refit(
    sources: opt.FontFiles,
    spec: Annotated[RefitSpec, without(*RefitSpec.unshown)],
    subset: opt.Subset,
    instance: opt.Instance,
    run: opt.RunOptions,
    *,
    out: Annotated[Path | None, opt.out("Write to this folder.", "DIR", **opt.PATH)] = None,
    axis: Annotated[
        str | None,
        About("Make masters of single fonts, on this axis: wght=300:700, a value for each.", WRITTEN, "TAG=A:B"),
    ] = None,
    units_per_em: Annotated[
        int | None,
        About("Scale drawings to this em of a font; without it, to 1000 those smaller than 500.", WRITTEN, "N"),
    ] = None,
) -> bool:
    """Put fitted outlines back into fonts, sources and drawings: the fewest points, smooth to the curvature.

    They go into the source itself, a layer of it, or what is written to a folder: a font, a UFO, a designspace, an SVG
    drawing with its other content as it is. All glyphs are fitted unless some are asked for. What cannot be fitted
    within the tolerance stays as it is; what was not done ends the command with status 1.
    """
    from ...runs.font_search import find_fonts
    from .refit import em_of, kept, own_format

    found = find_fonts(sources)
    if not found:
        stop("no fonts found")
    if out is None and not spec.is_back:
        stop("say where the outlines go: --out DIR, --in-place or --layer NAME")
    masters = spec.masters or axis is not None
    if not spec.formats:
        own, in_masters = own_format(found, axis is not None)
        if own == "svg":
            if subset.is_given or masters or spec.layer is not None:
                stop("drawings are refitted whole, without layers and masters")
            undone: bool = service("refit_drawings")(found, spec.options, out, run)
            return undone
        masters = masters or (in_masters and not instance.location)
        spec = spec if spec.is_back else replace(spec, formats=(own,))
    if not subset.is_given:
        subset = opt.Subset(all_glyphs=True)
    spec = replace(spec, masters=masters)
    if (em := em_of(found, spec, units_per_em)) is not None:
        place = [instance.location, "strokes=1" if instance.strokes else None, f"em={em:g}"]
        instance = replace(instance, strokes=False, location=",".join(filter(None, place)))
    for name, given, why in (
        ("location", instance.location, "masters are of the whole design space"),
        ("jobs", run.scheduler, "masters are converted on this machine"),
    ):
        if masters and given:
            stop(f"--{name} {given} is not for --masters: {why}")
    with kept(out) as folder, workplace(run, spec) as executor:
        call = Conversion(folder, spec, subset, instance, run, out is not None)
        if masters:
            return in_all_masters([Path(each) for each in sources], call, axis, executor)
        alone = found == [Path(sources[0])] and len(sources) == 1
        runs = convert_fonts(found, call, executor, alone)
    if not (run.quiet or run.as_json or alone):
        say(runs_table(runs))
    if run.as_json:
        print_json(runs_facts(runs))
    return any(one.undone for one in runs)


def in_all_masters(sources: Sequence[Path], call: Conversion, axis: str | None, executor: Executor) -> bool:
    """Fit a family in all masters at once; whether something was not done."""
    names, summary = service("refit_masters")(sources, call, axis, executor)
    facts = {"font": str(sources[0]), "out": str(call.out), **summary.facts()}
    if call.run.as_json:
        print_json(facts)
    elif not call.run.quiet:
        for line in summary.lines():
            say(line)
    return bool(names.missing or summary.failed or summary.outside)
