"""The command ``refit``: fitted outlines go back into fonts, sources and drawings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

from ...cli import arguments as opt
from ...cli.convert import Conversion, convert_fonts, workplace
from ...cli.groups import bare
from ...cli.messages import print_json, say, stop
from ...cli.tables import runs_facts, runs_table
from ...fields import WRITTEN, About
from ...hooks import service
from .spec import RefitSpec

WHERE = "say where the outlines go: --in-place, --layer NAME, or --out DIR with --format otf, ttf or ufo"


@bare
def refit(
    sources: opt.FontFiles,
    spec: RefitSpec,
    subset: opt.Subset,
    instance: opt.Instance,
    run: opt.RunOptions,
    *,
    out: Annotated[Path | None, opt.out("Write to this folder.", "DIR", **opt.PLACE)] = None,
    axis: Annotated[
        str | None,
        About("Make masters of single fonts, on this axis: wght=300:700, a value for each.", WRITTEN, "TAG=A:B"),
    ] = None,
) -> bool:
    """Put fitted outlines back into fonts, sources and drawings: the fewest points, smooth to the curvature.

    They go into the source itself, a layer of it, or a copy in a folder: a font, a UFO or a designspace. All glyphs are
    fitted unless some are asked for; what cannot be fitted within the tolerance stays as it is, and ends the command
    with status 1.
    """
    from ...runs.font_search import find_fonts

    found = find_fonts(sources)
    if not found:
        stop("no fonts found")
    if out is None and not spec.is_back:
        stop(WHERE)
    if not subset.is_given:
        subset = opt.Subset(all_glyphs=True)
    masters = spec.masters or axis is not None
    if not spec.formats and not spec.is_back:
        spec = replace(spec, formats=(own_format(found[0]),))
    spec = replace(spec, masters=masters)
    with kept(out) as folder, workplace(run, spec) as executor:
        call = Conversion(folder, spec, subset, instance, run)
        if masters:
            check_masters(call)
            names, summary = service("refit_masters")([Path(each) for each in sources], call, axis, executor)
            facts = {"font": str(found[0]), "out": str(folder), **summary.facts()}
            if not (run.quiet or run.as_json):
                for line in summary.lines():
                    say(line)
            if run.as_json:
                print_json(facts)
            return bool(names.missing or summary.failed or summary.outside)
        alone = found == [Path(sources[0])] and len(sources) == 1
        runs = convert_fonts(found, call, executor, alone)
    if not (run.quiet or run.as_json or alone):
        say(runs_table(runs))
    if run.as_json:
        print_json(runs_facts(runs))
    return any(one.undone for one in runs)


def own_format(path: Path) -> str:
    """The format of a source itself, which is written where none is asked for."""
    from ...readers import Font, open_source

    source = open_source(path)
    if isinstance(source, Font):
        return "ttf" if source.outer < 0 else "otf"
    return "ufo"


@contextmanager
def kept(out: Path | None) -> Iterator[Path]:
    """The folder of a run; of one that writes into its source, a folder that goes at its end."""
    if out is not None:
        yield out
        return
    with TemporaryDirectory(prefix="glyphspline-") as folder:
        yield Path(folder)


def check_masters(call: Conversion) -> None:
    """Stop if the options of a run over masters clash."""
    for name, given, why in (
        ("location", call.instance.location, "masters are of the whole design space"),
        ("scheduler", call.run.scheduler, "masters are converted on this machine"),
    ):
        if given:
            stop(f"--{name} is not for --masters: {why}")
