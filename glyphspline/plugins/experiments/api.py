"""An experiment on one outline: variants and peers through its polygons, their measures, and its figure."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike

from ...errors import OptionError, PolygonError, is_positive, require
from ...files import write_whole
from ...outlines.outline import Outline
from ...types import counted
from ...writers.figures.basics import saved
from ...writers.settings import FigureKind
from . import PEERS, VARIANTS
from .measures import rows_of
from .methods import Interpolated, curve_through
from .polygons import polygons_of
from .spec import SHEETS

TOLERANCE = 1e-7
"""Of the residual, in em."""


DPI = 160.0
"""Of sheets as PNG."""


class Experiment(Interpolated):
    """Curves of several methods through the polygons of one outline, with what there is to see and to measure of them.

    Attributes:
        outline: what the polygons are of. polygons: (n, 2) of each contour, in font units.
        curves: of each contour by method, "variant 2" or a peer. tolerance: of the residual, in font units.
    """

    def __repr__(self) -> str:
        methods = ", ".join(self.curves[0]) if self.curves else "nothing"
        contours = counted(len(self.polygons), "contour")
        return f"<Experiment {self.outline.name!r}: {contours}, {sum(map(len, self.polygons))} vertices; {methods}>"

    @cached_property
    def rows(self) -> list[dict[str, Any]]:
        """A row of measures for each contour and method; lengths are in 1/1000 em, curvature is in 1/em."""
        return rows_of(self.polygons, self.curves, self.em)

    def figure(self, face: str = "") -> Any:
        """The sheet, a figure of matplotlib: original, polygon, curves, zooms, curvature maps and residuals.

        Args:
            face: the font's name, for the caption.
        """
        from .sheet import sheet

        return sheet(self, face)

    def save(self, path: str | Path, face: str = "") -> None:
        """Write the sheet as PNG, SVG or PDF, by the suffix; the same bytes each time.

        Args:
            path: the file. face: the font's name, for the caption.

        Raises:
            OptionError: another suffix.
            OutputError: it cannot be written.
        """
        kind: Any = Path(path).suffix[1:].lower()
        require(kind in SHEETS, f"a sheet is a {' or '.join(SHEETS)}", kind)
        write_whole(str(path), self.drawn([kind], face)[kind])

    def drawn(self, kinds: Sequence[FigureKind], face: str = "") -> dict[FigureKind, bytes]:
        """The sheet in formats of ``SHEETS``."""
        from .style import small, styled

        with styled():
            figure = self.figure(face)
            files = {kind: saved(figure, kind, DPI) for kind in kinds}
        return {kind: small(data) if kind == "png" else data for kind, data in files.items()}

    def _repr_png_(self) -> bytes:
        return self.drawn(["png"])["png"]


def experiment(
    outline: Outline,
    variants: Sequence[int] = (1, 2, 3),
    *,
    count: int | None = None,
    step: float | None = None,
    polygons: Sequence[ArrayLike] | None = None,
    peers: bool = True,
    residual_tolerance: float | None = None,
    radii: bool = False,
) -> Experiment:
    """Put the curves of several variants, and of peers, through the polygons of an outline, as in Figs. 6 to 9.

    Args:
        outline: of a glyph. variants: of Table 1, 0 to 4. Of variant 0, which need not converge, 100 steps are made.
        count, step: sample each contour, as :func:`glyphspline.sample` does. polygons: or clicked ones, (n, 2) each, in
            font units. Without all three, vertices are set as somebody would click them.
        peers: PIA and SciPy's periodic cubics too, through the same polygons.
        residual_tolerance: in font units; None for 1e-7 em.
        radii: follow the spectral radii of the composite matrices (Fig. 5), which takes seconds.

    Raises:
        OptionError: an option out of its range, or two ways to make polygons.
        PolygonError: a polygon that no curve can be put through; it names the glyph and the contour.

    Example:
        >>> from glyphspline import experiment, open_font
        >>> made = experiment(open_font("fonts_test/kouzan-gyosho.ttf").outline("O"), (2, 3), count=20)
        >>> made
        <Experiment 'O': 2 contours, 40 vertices; variant 2, variant 3, PIA, splprep, make_interp_spline, centripetal>
        >>> made.rows[0]["method"], made.rows[0]["converged"]
        ('variant 2', True)
    """
    if sum(way is not None for way in (count, step, polygons)) > 1:
        raise OptionError("give count, step or polygons, one of them")
    require(
        len(variants) > 0 and all(v in range(5) for v in variants) and len({*variants}) == len(variants),
        "variants are some of 0 to 4, each once", variants,
    )  # fmt: skip
    good = residual_tolerance is None or is_positive(residual_tolerance)
    require(good, "residual_tolerance is a positive distance or None", residual_tolerance)
    found = polygons_of(outline, count, step, polygons)
    tolerance = TOLERANCE * outline.metrics.units_per_em if residual_tolerance is None else residual_tolerance
    methods = [*(VARIANTS[v] for v in variants), *(PEERS if peers else ())]
    curves = []
    for k, polygon in enumerate(found):
        try:
            curves.append({method: curve_through(polygon, method, tolerance, radii) for method in methods})
        except PolygonError as error:
            raise error.locate(glyph=outline.name, contour=k) from None
    return Experiment(outline, tuple(found), tuple(curves), tolerance)
