"""The options of a whole run, and ``run.json``, which records them."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._version import __version__
from ..errors import GlyphsplineError, OptionError, is_positive, require
from ..fields import WRITTEN, arguments, check, instance_arguments, option
from ..files import reading, write_whole
from ..fitting.options import Options
from ..report import FOLDER as GALLERY
from ..report import SUFFIX
from ..types import Names
from ..writers.formats import OURS, format_named, format_names, is_format
from ..writers.settings import Maps, Settings

if TYPE_CHECKING:
    from ..readers import Source

RUN_FILE = "run.json"

RESULTS = "results"

POLYGON = "polygon"

OF_RUNS = {GALLERY: SUFFIX, POLYGON: ".svg", RESULTS: ".json"}
"""Suffixes of the formats with one file a glyph that only a run has, besides those of :mod:`..writers.formats`.
"polygon", the source with the polygon over it, comes with the gallery; fonts and UFOs are made from "results"."""

MAPS = {"curvature", "curvature-png", "curvature-pdf"}
"""Formats of curvature maps, which share a scale."""

PARQUET = "parquet"

WHOLE = ("ufo", "otf", "ttf", PARQUET)
"""Formats with one file a font."""


def available() -> tuple[str, ...]:
    """The formats that a run can have, those of plug-ins too, in the order in which a run lists them."""
    return (*format_names(), GALLERY, *WHOLE)


def suffix_of(name: str) -> str:
    """The suffix of the files of a format with one file a glyph."""
    return OF_RUNS.get(name) or format_named(name).suffix


def is_folder(name: str) -> bool:
    """Whether a folder of that name belongs to a format with one file a glyph."""
    return name in OF_RUNS or is_format(name)


def needs_fit(formats: Sequence[str], options: Options) -> bool:
    """Whether any of these formats is made of fitted curves: others show outlines as the font has them, and with
    continuity "g2" a TTF is made of these too."""
    others = [name for name in formats if not (name == "ttf" and options.is_for_fonts)]
    return not all(is_format(name) and not format_named(name).fitted for name in others)


@dataclass(frozen=True)
class Limits:
    """Limits beyond which a glyph fails.

    Attributes:
        seconds: of wall clock for a batch; its worker is killed and replaced, and each glyph tried on its own.
        segments: of the source outline. vertices: of all its polygons.
    """

    seconds: float = 60.0
    segments: int = 100_000
    vertices: int = 200_000

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            require(is_positive(value), f"the limit of {name} is a positive number", value)

    def error_of(self, segments: int) -> GlyphsplineError | None:
        """The error of a glyph of so many segments, or None."""
        if segments > self.segments:
            return GlyphsplineError(f"{segments} segments, more than the {self.segments} allowed")
        return None


LIMITS = Limits()
"""Those of a run that asks for none."""


@dataclass(frozen=True)
class RunSpec:
    """How the glyphs of a run are converted, and what is written.

    Attributes:
        options: of the conversion. formats: of :func:`available`. names: what the files of glyphs are called after.
        limits: for each glyph. They decide only which glyphs fail and are not in ``run.json``.
        settings: of drawings. maps: what curvature maps show.
        masters: all masters of a variable font at once; see :mod:`.jobs.masters`.
        keep_name: whether written fonts have the source's family name.
        in_place, layer: write new outlines into the source, in place of the old ones or into a layer beside them.

    Raises:
        OptionError: one of these is none of what it can be.
        GlyphsplineError: the plug-in of a format cannot be loaded.
    """

    options: Options = field(default_factory=Options)
    formats: tuple[str, ...] = option(
        ("svg", "curvature", GALLERY),
        f"Write these formats: {', '.join(OURS)}, {GALLERY}, {', '.join(WHOLE)}, and those of plug-ins.",
        WRITTEN, "NAME,…", flags="--format",
    )  # fmt: skip
    settings: Settings = field(default_factory=Settings)
    names: Names = option(
        "glyph", "Name files after the glyph's name, its code point (uni9F8D), its index, or its character.", WRITTEN
    )
    limits: Limits = LIMITS
    maps: Maps = field(default_factory=Maps)
    masters: bool = option(
        False,
        "Convert all masters of a variable font at once, to a variable font (--format otf, ttf), designspace (ufo), "
        "drawings of the default (svg) or a page with a slider for each axis (gallery).",
        WRITTEN,
    )  # fmt: skip
    keep_name: bool = option(
        False, "Keep the family name in an otf or ttf. Licences reserve the names of fonts that are not your own.",
        WRITTEN,
    )  # fmt: skip
    in_place: bool = option(
        False, "Write new outlines into the source, a UFO, designspace or Glyphs file. Nothing else in it changes.",
        WRITTEN,
    )  # fmt: skip
    layer: str | None = option(
        None, "Write new outlines into this layer of the source, beside the old ones: glyphspline without a NAME.",
        WRITTEN, "[NAME]",
    )  # fmt: skip

    def __post_init__(self) -> None:
        if self.in_place and self.layer is not None:
            raise OptionError("give --in-place or --layer, not both")
        if self.is_back and self.options.remove_overlaps:
            raise OptionError("--remove-overlaps makes other contours, which cannot go back into the source")
        if isinstance(self.formats, str):
            raise GlyphsplineError(f"formats are a tuple of names, not {self.formats!r}")
        if not self.formats:
            raise OptionError(f"no format given: there are {', '.join(available())}")
        own = [name for name in self.formats if name not in (GALLERY, *WHOLE)]
        for name in own:
            if not (isinstance(name, str) and is_format(name)):
                raise OptionError(f"no format {name}: there are {', '.join(available())}")
            format_named(name)  # raises where a plug-in is broken
        check(self)
        for name, kind in (("options", Options), ("settings", Settings), ("limits", Limits), ("maps", Maps)):
            if not isinstance(getattr(self, name), kind):
                raise GlyphsplineError(f"{name} are {kind.__name__}")
        self.settings.look.line(1.0)  # raises for a width on paper without a size
        order = OURS if set(own) <= OURS.keys() else format_names()
        given = [name for name in (*order, GALLERY, *WHOLE) if name in self.formats]
        object.__setattr__(self, "formats", tuple(given))

    def family_of(self, source: Source) -> str:
        """The family name of an otf or ttf."""
        return source.family if self.keep_name else f"{source.family} Spline"

    @property
    def is_back(self) -> bool:
        """Whether outlines are written into the source."""
        return self.in_place or self.layer is not None

    @cached_property
    def is_fitted(self) -> bool:
        """Whether the workers fit curves."""
        return self.is_back or self.masters or needs_fit(self.formats, self.options)

    @cached_property
    def folders(self) -> tuple[str, ...]:
        """The folders written to: one for each format with one file a glyph, and those that other formats need."""
        own = tuple(name for name in self.formats if name not in WHOLE)
        polygon = [POLYGON] if GALLERY in own and not self.masters else []
        # Fonts are made of results. The rows of a table are kept elsewhere.
        results = [RESULTS] if self.masters or self.is_back or not {*self.whole} <= {PARQUET} else []
        return (*own, *polygon, *results)

    @property
    def whole(self) -> tuple[str, ...]:
        """The run's formats with one file a font."""
        return tuple(name for name in self.formats if name in WHOLE)

    def fitting(self, units_per_em: float) -> Options:
        """The options of the conversion. If a font is written, its rounding is subtracted from the tolerance.

        With continuity "g2" results are on the font's grid, and quadratics are not made of them. Other curves are
        certified as they are rounded to the precision, and an otf has them as they are; a UFO has points at extrema of
        these, which are rounded once more.
        """
        g2, tolerance, left = self.options.is_for_fonts, self.options.tolerance_for(units_per_em), list[float]()
        if self.options.is_fixed or not (self.is_back or {*self.whole} - {PARQUET}):
            return self.options
        from ..plugins.fonts.tables.font_glyphs import ROUNDING, fitting_tolerance

        rounding = 0.0 if g2 else ROUNDING * 10.0**-self.options.precision
        if self.is_back or "ufo" in self.formats:
            left.append(max(tolerance - 2 * rounding, tolerance / 2))
        if "otf" in self.formats:
            left.append(max(fitting_tolerance(tolerance, "otf") - rounding, tolerance / 2))
        if "ttf" in self.formats and not g2:
            left.append(fitting_tolerance(tolerance, "ttf"))
        return replace(self.options, tolerance=min(left)) if left else self.options


REQUEST = ("command", "selection", "selected", "missing")
"""Keys of ``run.json`` of the last call for the folder; calls for other glyphs go on with the same run."""


def describe(
    source: Source,
    spec: RunSpec,
    glyphs: Sequence[str],
    curvature_scale: float | None,
    others: Sequence[Source] = (),
    axis: str | None = None,
) -> dict[str, Any]:
    """The content of ``run.json``, independent of the machine, the clock and the number of workers.

    Its options are those in effect: tolerances are numbers, in font units. ``others`` are further single fonts whose
    glyphs become masters on the ``axis``.
    """
    em = source.metrics.units_per_em
    effective = {"tolerance": spec.options.tolerance_for(em), "residual_tolerance": spec.options.solver_tolerance}
    asked = dict(getattr(glyphs, "asked", {}))  # the arguments of :meth:`Source.select`
    if not asked:
        asked = {"all": True} if len(glyphs) == len(source.glyph_names) else {"glyphs": list(glyphs)}
    if "text" in asked:  # an argument of the command line may hold bytes that are no text
        asked["text"] = asked["text"].encode(errors="replace").decode()
    missing = getattr(glyphs, "missing", ())
    return {
        "glyphspline": __version__,
        "command": shlex.join(command(source, spec, asked, others, axis)),
        "font": font_facts(source),
        "selection": asked,
        "selected": len(glyphs),
        "missing": {"count": len(missing), "first": list(missing[:20])},
        "options": spec.options.facts() | effective,
        "formats": list(spec.formats),
        **asdict(spec.settings.look),
        **asdict(spec.maps),
        "flatness": spec.settings.flatness,
        "dxf": spec.settings.dxf,
        **({"keep_name": True} if spec.keep_name else {}),
        **({"in_place": spec.in_place, "layer": spec.layer} if spec.is_back else {}),
        "names": spec.names,
        "curvature_scale": curvature_scale,
        **({"masters": True} if spec.masters else {}),
        **({"from": [font_facts(other) for other in others], "axis": axis} if others else {}),
    }


def font_facts(source: Source) -> dict[str, Any]:
    """What ``run.json`` says of a font."""
    return {
        "file": source.path.name,
        "sha256": source.sha256,
        "face_index": source.face_index,
        "location": dict(source.location),
        "family": source.family,
        "style": source.style,
        "metrics": asdict(source.metrics),
    }


def command(
    source: Source, spec: RunSpec, asked: dict[str, Any], others: Sequence[Source] = (), axis: str | None = None
) -> Iterator[str]:
    """The arguments of the command line that make the run's files, without the folder: what is not default."""
    yield from ("glyphspline", "convert", source.path.name)
    for other in others:
        yield from ("--from", other.path.name)
    if axis is not None:
        yield from ("--axis", axis)
    for name, value in asked.items():
        yield f"--{name}"
        if name != "all":
            yield value if isinstance(value, str) else ",".join(map(str, value))
    yield from instance_arguments(source.face_index, source.location)
    words = arguments(spec, RunSpec())
    formats = words.pop("formats", [])
    yield from (*chain(*words.values()), *formats)


def write_run(out: Path, run: dict[str, Any]) -> None:
    """Write ``run.json``, without which a run cannot be resumed."""
    write_whole(f"{out}/{RUN_FILE}", json.dumps(run, indent=1, ensure_ascii=False) + "\n", durable=True)


def read_run(out: Path) -> dict[str, Any] | None:
    """``run.json`` of a folder, or None if it has none.

    Raises:
        OutputError: there is one, and it cannot be read.
    """
    path = out / RUN_FILE
    if not path.exists():
        return None
    with reading(path):
        run = json.loads(path.read_text(encoding="utf-8"))
        scale = run["curvature_scale"]
        if not (scale is None or (isinstance(scale, float | int) and math.isfinite(scale))):
            raise ValueError("a curvature scale that is no number")
    return dict(run)


def differences(old: dict[str, Any], new: dict[str, Any], prefix: str = "") -> list[str]:
    """The differences between two runs, a phrase each; the file's name, the scale and the selection do not count."""
    found = []
    for key in dict.fromkeys([*old, *new]):
        name = f"{prefix}{key}"
        if key == "file" or name in ("curvature_scale", *REQUEST):
            continue
        a, b = old.get(key), new.get(key)
        if key == "from" and a and b:  # fonts by their numbers
            a, b = (dict(enumerate(fonts, 1)) for fonts in (a, b))
        if isinstance(a, dict) and isinstance(b, dict):
            found += differences(a, b, f"{name}.")
        elif a != b:
            found.append(f"{name}: {json.dumps(a)} in the folder, {json.dumps(b)} now")
    return found
