"""Fonts and sources as formats of a run: what a fit may take of the tolerance, and how results become files."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, ClassVar, cast

from ...errors import FontError, GlyphsplineError, OutputError
from ...files import write_whole
from ...fitting.options import Options
from ...fitting.results import GlyphResult
from ...outlines.outline import Outline
from ...readers import Source, open_font
from ...runs.whole_formats import ResultsFormat
from ...types import counted, shortened
from .read_back import Held, Promise, held
from .tables.font_glyphs import ROUNDING, Flavour, fitting_tolerance, open_path

NAMED = 5
"""Glyphs named in a remark."""

Written = tuple[list[str], Mapping[str, Any]]
"""Remarks, and what a file holds of glyphs by name."""


def rounding(options: Options) -> float:
    """How far the decimals of results move points. With continuity "g2" results are on the grid."""
    return 0.0 if options.is_for_fonts else ROUNDING * 10.0**-options.precision


class FontFormat(ResultsFormat):
    """A copy of the font with new outlines."""

    verb = "refit"

    def refused(self, outline: Outline) -> GlyphsplineError | None:
        """An outline with open paths."""
        return open_path(outline)

    def is_fitted(self, options: Options) -> bool:
        """Quadratics of continuity "g2" are made of the source."""
        return not (self.name == "ttf" and options.is_for_fonts)

    def share(self, options: Options, tolerance: float) -> float:
        """Curves are certified as they are rounded to the precision; an otf has them so, quadratics are near them."""
        flavour = cast(Flavour, self.name)
        if flavour == "ttf":
            return tolerance if options.is_for_fonts else fitting_tolerance(tolerance, "ttf")
        return max(fitting_tolerance(tolerance, "otf") - rounding(options), tolerance / 2)

    def write(self, source: Source, glyphs: Iterator[GlyphResult], path: Path, spec: Any) -> Written:
        """Write the font."""
        from .tables.font_file import to_font
        from .tables.stored import compared, stored_facts

        gids: list[int] = []

        def each() -> Iterator[GlyphResult]:
            for result in glyphs:
                gids.append(result.outline.gid)
                yield result

        tolerance, flavour = spec.options.tolerance_for(source.metrics.units_per_em), cast(Flavour, self.name)
        data, summary = to_font(source, each(), flavour, tolerance=tolerance, family=spec.family_of(source))
        write_whole(str(path), data, durable=True)
        found = Held(summary.bounds, summary.beyond)
        near, far = found.words
        remark = f"{path.name}: {summary.replaced} glyphs replaced{near}"
        if not spec.options.is_for_fonts:
            points = f"{summary.extrema} points added at extrema" if flavour == "otf" else "as quadratics near these"
            remark += f", as C2 splines (--continuity g2: fewer points), {points}"
        remark += far
        if len((new := open_font(path)).glyph_names) == len(source.glyph_names):
            remark += f"; {compared(stored_facts(source, gids), stored_facts(new, gids))}"
        return [remark, *codes_given(source)], found.facts()


def codes_given(source: Source) -> list[str]:
    """What is said of the code points that drawings were given."""
    codes = [f"U+{code:04X} {name}" for code, name in source.assigned.items()]
    return [f"code points of private use: {', '.join(codes)}"] if codes else []


class Otf(FontFormat):
    """Cubics."""

    name, extra = "otf", "fonts"


class Ttf(FontFormat):
    """Quadratics."""

    name = "ttf"


class UfoFormat(ResultsFormat):
    """A UFO with new outlines: a copy of one, or made of a font."""

    name, verb = "ufo", "refit"
    layer: ClassVar[str | None] = None

    def share(self, options: Options, tolerance: float) -> float:
        """It has points at extrema of rounded curves, which are rounded once more."""
        return max(tolerance - 2 * rounding(options), tolerance / 2)

    def write(self, source: Source, glyphs: Iterator[GlyphResult], path: Path, spec: Any) -> Written:
        """Write the UFO, and read it back."""
        from .ufo_folder import write_ufo

        if source.format == "UFO":
            return self.put_back(source, glyphs, spec, path)
        promises = dict[str, Promise]()
        remarks = [f"{path.name}: {write_ufo(source, promised(glyphs, spec, promises), path)} glyphs"]
        remarks += codes_given(source)
        return as_read(path, promises, None, remarks)

    def put_back(self, source: Source, glyphs: Iterator[GlyphResult], spec: Any, copy: Path | None) -> Written:
        """Write outlines into a UFO, or a copy of it, and read it back."""
        from .back.back import of_results

        promises = dict[str, Promise]()
        layer = None if copy else spec.layer
        ufo: Any = source
        remarks = back_to_source(source, of_results(ufo, promised(glyphs, spec, promises)), spec, copy)
        return as_read(copy or source.path, promises, layer, remarks)


class Back(UfoFormat):
    """The source itself."""

    name, always = "source", True

    def check(self, source: Source) -> None:
        """Refuse what takes no outlines back, or not so."""
        from ...readers.ufo import Ufo
        from .back.back import editable

        if not isinstance(editable(source), Ufo):
            raise OutputError(
                "the outlines of a designspace go back in all masters: add --masters", font=str(source.path)
            )

    def path(self, source: Source, out: Path) -> Path:
        """Where the source is."""
        return source.path

    def write(self, source: Source, glyphs: Iterator[GlyphResult], path: Path, spec: Any) -> Written:
        """Write outlines into the source, and read it back."""
        return self.put_back(source, glyphs, spec, None)


OTF, TTF, UFO, BACK = Otf(), Ttf(), UfoFormat(), Back()


def back_to_source(source: Source, new: Any, spec: Any, copy: Path | None = None) -> list[str]:
    """Write new contours into the source, a UFO or designspace, or into a copy of it; returns remarks for the summary.

    Args:
        new: of glyphs: see :func:`.back.back.write_back`.

    Raises:
        OutputError: a file cannot be written.
    """
    from ...files import writing
    from ...readers.ufo import Ufo
    from .back.back import write_back

    own: Any = source
    layer = None if copy else spec.layer
    with writing(copy or source.path):
        found = write_back(own, new, spec.options.for_em(source.metrics.units_per_em).precision, copy=copy, layer=layer)
    where = copy.name if copy else f"layer {layer} of {source.path.name}" if layer else source.path.name
    curves = "G2, as fonts store them" if spec.options.is_for_fonts else "C2 (--continuity g2: fewer points)"
    curves += "" if isinstance(source, Ufo) else ", in all masters"
    curves += ": points {:,} → {:,}".format(*found.points) * any(found.points)
    remarks = [f"{where}: new outlines of {counted(len(found.names), 'glyph')}, {curves}; nothing else changed"]
    kept = [f"{name}: {why}, and stays as it was" for name, why in found.kept.items()]
    return remarks + shortened(kept, NAMED, "{} more glyphs with contours that stay as they were")


def promised(glyphs: Iterator[GlyphResult], spec: Any, promises: dict[str, Promise]) -> Iterator[GlyphResult]:
    """The results, of each of which is noted what is said of it."""
    for result in glyphs:
        tolerance = spec.options.tolerance_for(result.outline.metrics.units_per_em)
        promises.update({result.outline.name: promise} if (promise := Promise.of(result, tolerance)) else {})
        yield result


def as_read(path: Path, promises: Mapping[str, Promise], layer: str | None, remarks: list[str]) -> Written:
    """What a written UFO holds of what was promised; with a layer, in that one where it has the glyph."""
    from ...readers.ufo import Ufo

    written: Any = Ufo.opened(path)
    if layer:
        with suppress(FontError):  # none is made if nothing changes
            written.default_layer = ChainMap(written.layer(layer), written.default_layer)
    found = held(written, {name: each for name, each in promises.items() if name in written.gids})
    near, far = found.words
    return remarks + [f"{path.name}, as read back{near}{far}"] * bool(near), found.facts()
