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
from typing import TYPE_CHECKING, Any, ClassVar

from .. import hooks
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
from .whole_formats import ResultsFormat, TableFormat, WholeFormat, whole_named

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


def available() -> tuple[str, ...]:
    """The formats that a run can have, those of plug-ins too, in the order in which a run lists them."""
    return (*format_names(), GALLERY, *hooks.names("whole"))


def suffix_of(name: str) -> str:
    """The suffix of the files of a format with one file a glyph."""
    return OF_RUNS.get(name) or format_named(name).suffix


def is_folder(name: str) -> bool:
    """Whether a folder of that name belongs to a format with one file a glyph."""
    return name in OF_RUNS or is_format(name)


def needs_fit(formats: Sequence[str], options: Options) -> bool:
    """Whether any of these formats is made of fitted curves: others show outlines as the font has them."""
    for name in formats:
        whole = None if name == GALLERY or is_format(name) else whole_named(name)
        if whole.is_fitted(options) if whole else name == GALLERY or format_named(name).fitted:
            return True
    return False


def kinds_for(options: Options | None, formats: Sequence[str] = ()) -> list[str]:
    """The kinds of work of :mod:`.small_runs` in a run with these options; None: nothing is converted."""
    if options is None:
        return []
    rest = ["rest"] if options.remove_overlaps else []
    if formats and not needs_fit(formats, options):
        return ["unfitted", *rest]
    fit = "g2" if options.is_for_fonts else options.corners
    best = [f"{options.corners}_best"] if options.effort == "best" and not options.is_for_fonts else []
    drawings = ["drawings"] if {"curvature", "gallery", "png", "pdf"} & set(formats) else []
    return [*(["fixed"] if options.is_fixed else [fit, *best]), *drawings, *rest]


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
        verb: the command of such a run. needs_formats: whether it writes nothing without.
        unshown: options that it has in Python alone.

    Raises:
        OptionError: one of these is none of what it can be.
        GlyphsplineError: the plug-in of a format cannot be loaded.
    """

    options: Options = field(default_factory=Options)
    formats: tuple[str, ...] = option(
        ("svg", "curvature", GALLERY),
        f"Write these formats: {', '.join(OURS)}, {GALLERY}, and those of plug-ins, as dxf and parquet.",
        WRITTEN, "NAME,…", flags="--format",
    )  # fmt: skip
    settings: Settings = field(default_factory=Settings)
    names: Names = option(
        "glyph", "Name files after the glyph's name, its code point (uni9F8D), its index, or its character.", WRITTEN
    )
    limits: Limits = LIMITS
    maps: Maps = field(default_factory=Maps)
    verb: ClassVar[str] = "convert"
    unshown: ClassVar[tuple[str, ...]] = (
        "continuity", "corner_angle", "effort", "flatness", "measure", "stroke_width", "thousandths",
    )  # fmt: skip
    needs_formats: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if isinstance(self.formats, str):
            raise GlyphsplineError(f"formats are a tuple of names, not {self.formats!r}")
        if self.needs_formats and not self.formats:
            raise OptionError(f"no format given: there are {', '.join(available())}")
        for name in self.formats:
            if not isinstance(name, str) or not (name == GALLERY or is_format(name) or whole_named(name)):
                raise OptionError(f"no format {name}: there are {', '.join(available())}{hooks.away_words()}")
            if name != GALLERY and is_format(name):
                format_named(name)  # raises where a plug-in is broken
        known = {*OURS, GALLERY}.issuperset(self.formats)
        order = (*OURS, GALLERY) if known else available()
        object.__setattr__(self, "formats", tuple(name for name in order if name in self.formats))
        for whole in self.whole:
            if whole.verb != self.verb:
                line = f"glyphspline {whole.verb} FONT --format {whole.name} --out DIR"
                raise OptionError(f"{self.verb} does not write {whole.name}: {line}")
        if sum(isinstance(whole, TableFormat) for whole in self.whole) > 1:
            raise OptionError("a run writes one table")
        check(self)
        for name, kind in (("options", Options), ("settings", Settings), ("limits", Limits), ("maps", Maps)):
            if not isinstance(getattr(self, name), kind):
                raise GlyphsplineError(f"{name} are {kind.__name__}")
        self.settings.look.line(1.0)  # raises for a width on paper without a size

    @cached_property
    def whole(self) -> tuple[WholeFormat, ...]:
        """The run's formats with one file a font."""
        others = [name for name in self.formats if name != GALLERY and name not in OURS]
        return tuple(found for name in others if not is_format(name) and (found := whole_named(name)))

    @property
    def table(self) -> TableFormat | None:
        """The one of rows among them."""
        return next((whole for whole in self.whole if isinstance(whole, TableFormat)), None)

    @property
    def files(self) -> tuple[ResultsFormat, ...]:
        """Those that are made of results."""
        return tuple(whole for whole in self.whole if isinstance(whole, ResultsFormat))

    @property
    def kinds(self) -> list[str]:
        """The kinds of work of the run, see :func:`.small_runs.work`."""
        return kinds_for(self.options, self.formats)

    @cached_property
    def is_fitted(self) -> bool:
        """Whether the workers fit curves."""
        return needs_fit(self.formats, self.options)

    @cached_property
    def folders(self) -> tuple[str, ...]:
        """The folders written to: one for each format with one file a glyph, and those that other formats need."""
        whole = {each.name for each in self.whole}
        own = tuple(name for name in self.formats if name not in whole)
        return (*own, *([POLYGON] if GALLERY in own else []), *([RESULTS] if self.files else []))

    def fitting(self, units_per_em: float) -> Options:
        """The options of the conversion: what writing a font may take of the tolerance is subtracted from it."""
        options = self.options.for_em(units_per_em)
        tolerance = options.tolerance_for(units_per_em)
        left = [] if options.is_fixed else [each.share(options, tolerance) for each in self.files]
        return replace(options, tolerance=min(left)) if left else options

    def facts(self) -> dict[str, Any]:
        """What ``run.json`` says of the run beside the options that all runs have."""
        return {}


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
    options = spec.options.for_em(em)
    effective = {"tolerance": options.tolerance_for(em), "residual_tolerance": options.solver_tolerance}
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
        "options": options.facts() | effective,
        "formats": list(spec.formats),
        **asdict(spec.settings.look),
        **asdict(spec.maps),
        "flatness": spec.settings.flatness,
        "dxf": spec.settings.dxf,
        "names": spec.names,
        "curvature_scale": curvature_scale,
        **spec.facts(),
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
    yield from ("glyphspline", spec.verb, *(each.path.name for each in (source, *others)))
    if axis is not None:
        yield from ("--axis", axis)
    for name, value in asked.items():
        yield f"--{name}"
        if name != "all":
            yield value if isinstance(value, str) else ",".join(map(str, value))
    yield from instance_arguments(source.face_index, source.location)
    words = arguments(spec, type(spec)(), spec.unshown)
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
