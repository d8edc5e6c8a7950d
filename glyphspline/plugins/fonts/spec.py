"""The options of a run that puts outlines back."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ...errors import OptionError
from ...fields import WRITTEN, option
from ...fitting.options import Options
from ...runs.spec import POLYGON, RESULTS, RunSpec
from ...runs.whole_formats import WholeFormat

if TYPE_CHECKING:
    from ...readers import Source

FOR_FONTS = Options(corners="sharp", continuity="g2")
"""What fonts store."""


@dataclass(frozen=True)
class RefitSpec(RunSpec):
    """How outlines are fitted again, and where they go.

    Attributes:
        formats: of whole fonts, and drawings of the results; none where outlines go into the source alone.
        keep_name: whether written fonts have the source's family name.
        in_place, layer: write new outlines into the source, in place of the old ones or into a layer beside them.
        masters: all masters of a variable font at once.
        unshown: what ``convert`` alone asks for: how results are drawn, and curves that fonts do not store.

    Raises:
        OptionError: as :class:`.RunSpec`; or both ``in_place`` and ``layer``.
    """

    options: Options = field(default_factory=lambda: FOR_FONTS)
    formats: tuple[str, ...] = option(
        (),
        "Write otf, ttf or ufo, and drawings of the new outlines: svg, gallery and other formats of convert. Without "
        "it, what the source is.",
        WRITTEN, "NAME,…", flags="--format",
    )  # fmt: skip
    masters: bool = option(
        False,
        "Fit all masters of a variable font or designspace at once: into a variable font (otf, ttf), a designspace "
        "(ufo), or the source.",
        WRITTEN,
    )  # fmt: skip
    keep_name: bool = option(
        False, "Keep the family name in an otf or ttf. Licences reserve the names of fonts that are not your own.",
        WRITTEN,
    )  # fmt: skip
    in_place: bool = option(
        False, "Write into the source: a UFO, designspace, Glyphs file or drawing. Nothing else in it changes.",
        WRITTEN,
    )  # fmt: skip
    layer: str | None = option(
        None, "Write into this layer of the source, beside the old outlines: glyphspline without a NAME.",
        WRITTEN, "[NAME]",
    )  # fmt: skip

    verb, needs_formats = "refit", False
    unshown = ("settings", "maps", "names", "variant", "step", "count", "measure")

    def __post_init__(self) -> None:
        if self.in_place and self.layer is not None:
            raise OptionError("give --in-place or --layer, not both")
        if self.is_back and self.options.remove_overlaps:
            raise OptionError("--remove-overlaps makes other contours, which cannot go back into the source")
        super().__post_init__()

    @property
    def is_back(self) -> bool:
        """Whether outlines are written into the source."""
        return self.in_place or self.layer is not None

    @cached_property
    def whole(self) -> tuple[WholeFormat, ...]:
        """The run's formats with one file a font, and the source."""
        if not self.is_back:
            return super().whole
        from .formats import BACK  # imports fontTools

        return (*super().whole, BACK)

    @cached_property
    def folders(self) -> tuple[str, ...]:
        """See :attr:`.RunSpec.folders`: fits in all masters are kept whatever is written, and have no polygons."""
        if not self.masters:
            return super().folders
        return (*(name for name in super().folders if name not in (POLYGON, RESULTS)), RESULTS)

    @property
    def kinds(self) -> list[str]:
        """See :attr:`.RunSpec.kinds`."""
        quadratics = ["quadratics"] if "ttf" in self.formats else []
        if self.masters:
            return ["masters", *(["g2"] if self.options.is_for_fonts else []), *quadratics]
        return [*super().kinds, *quadratics]

    @cached_property
    def is_fitted(self) -> bool:
        """Whether the workers fit curves."""
        return self.is_back or self.masters or super().is_fitted

    def family_of(self, source: Source) -> str:
        """The family name of an otf or ttf."""
        return source.family if self.keep_name else f"{source.family} Spline"

    def facts(self) -> dict[str, Any]:
        """What ``run.json`` says besides."""
        return {
            **({"keep_name": True} if self.keep_name else {}),
            **({"in_place": self.in_place, "layer": self.layer} if self.is_back else {}),
            **({"masters": True} if self.masters else {}),
        }
