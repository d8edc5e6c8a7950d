"""The options of a run of experiments over the glyphs of fonts."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..._version import __version__
from ...errors import GlyphsplineError, OptionError
from ...fields import METHOD, WRITTEN, Condition, option, positive, whole
from ...files import reading
from ...outlines.sampling import MOST_VERTICES
from ...runs.spec import RunSpec, command, font_facts
from ...writers.settings import FigureKind

if TYPE_CHECKING:
    from ...readers import Source

SHEETS: tuple[FigureKind, ...] = ("png", "svg", "pdf")
"""Formats of a sheet."""

LISTED = re.compile(r"[0-4](?:-[0-4])?(?:,[0-4](?:-[0-4])?)*")


def variants_of(text: str) -> tuple[int, ...]:
    """The variants of a list: "1,2,3" or "0-4", each once, ascending."""
    ends = [part.split("-") for part in text.split(",")]
    return tuple(sorted({v for part in ends for v in range(int(part[0]), int(part[-1]) + 1)}))


@dataclass(frozen=True)
class ExperimentSpec(RunSpec):
    """Which polygons are made of outlines, what is put through them, and what is drawn.

    Attributes:
        formats: of sheets. variants: see :func:`variants_of`. count, step, clicked: how polygons are made; none of them
            has vertices set as somebody would click them. sheets: number of glyphs that get one. radii: see
            :func:`.api.experiment`.
    """

    formats: tuple[str, ...] = option(SHEETS, "Draw sheets in these formats.", WRITTEN, "NAME,…", flags="--format")
    variants: str = option(
        "1,2,3", "Put these variants of the paper through the polygons: 1,2,3 or 0-4.", METHOD, "LIST",
        rule=Condition(
            "a list of 0 to 4, as 1,2,3 or 0-4", lambda text: bool(LISTED.fullmatch(text) and variants_of(text))
        ),
    )  # fmt: skip
    count: int | None = option(
        None,
        "Sample so many vertices a contour. Without this, --step and --clicked, they are set as somebody would click.",
        METHOD, "N", rule=whole(3, MOST_VERTICES),
    )  # fmt: skip
    step: float | None = option(
        None, "Or sample about every so many units.", METHOD, "UNITS", rule=positive("distance")
    )
    clicked: Path | None = option(
        None, "Or take clicked points of a CSV file with the columns glyph,contour,x,y.", METHOD, "FILE"
    )
    sheets: int = option(12, "Draw a sheet of the first N glyphs.", WRITTEN, "N", rule=whole(0, 10_000))
    radii: bool = option(
        False, "Follow the spectral radii of the composite matrices (Fig. 5), too; takes seconds a glyph.", METHOD
    )

    verb, needs_formats = "experiment", False
    unshown = ("options", "settings", "limits", "maps")

    def __post_init__(self) -> None:
        if wrong := [name for name in self.formats if name not in SHEETS]:
            raise OptionError(f"a sheet is {', '.join(SHEETS)}, not {wrong[0]!r}")
        if sum(way is not None for way in (self.count, self.step, self.clicked)) > 1:
            raise OptionError("give --count, --step or --clicked, one of them")
        super().__post_init__()

    @property
    def kinds(self) -> list[str]:
        """See :attr:`.RunSpec.kinds`."""
        return ["interpolation", "fixed", "drawings"]

    @property
    def named(self) -> ExperimentSpec:
        """Itself, with the name of the file of clicked points, wherever that is."""
        return self if self.clicked is None else replace(self, clicked=Path(self.clicked.name))

    def run_facts(self, source: Source, glyphs: Any) -> dict[str, Any]:
        """The content of ``run.json``; see :func:`...runs.spec.describe`."""
        asked, missing = dict(getattr(glyphs, "asked", {})) or {"glyphs": [*glyphs]}, getattr(glyphs, "missing", ())
        points = None
        if self.clicked is not None:
            with reading(self.clicked, GlyphsplineError):
                points = sha256(self.clicked.read_bytes()).hexdigest()
        return {
            "glyphspline": __version__, "command": shlex.join(command(source, self.named, asked)),
            "font": font_facts(source), "selection": asked, "selected": len(glyphs),
            "missing": {"count": len(missing), "first": list(missing[:20])},
            "formats": list(self.formats), "variants": list(variants_of(self.variants)), "count": self.count,
            "step": self.step, "clicked": points, "sheets": self.sheets, "radii": self.radii, "names": self.names,
            "curvature_scale": None,
        }  # fmt: skip
