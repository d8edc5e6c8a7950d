"""Figures of matplotlib and their bytes as PNG, PDF or SVG: the same figure gives the same bytes."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Literal

ImageKind = Literal["png", "pdf"]
"""Of drawings."""

FigureKind = Literal["png", "pdf", "svg"]
"""Of diagrams."""

DPI = 200.0
"""Pixels an inch of a PNG that says none."""

UNDATED = {"CreationDate": None, "Producer": None, "Creator": None}
"""Metadata of a PDF: without dates and versions the same input gives the same bytes."""


def blank(width: float, height: float, **how: Any) -> Any:
    """A figure of a size in inches, without pyplot and its state; ``how`` as for ``Figure``."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), **how)
    FigureCanvasAgg(figure)
    return figure


def saved(figure: Any, kind: FigureKind, dpi: float = DPI) -> bytes:
    """The figure as a PNG of ``dpi`` pixels an inch, as a one-page PDF, or as an SVG."""
    from matplotlib import rc_context

    how: dict[FigureKind, dict[str, Any]] = {
        "png": {"dpi": dpi, "metadata": {"Software": None}},
        "pdf": {"metadata": UNDATED},
        "svg": {"metadata": {"Date": None, "Creator": None}},
    }
    file = io.BytesIO()
    with rc_context({"svg.hashsalt": "glyphspline"}):  # the names of an SVG's parts
        figure.savefig(file, format=kind, **how[kind])
    return file.getvalue()


def write_pages(path: Path, figures: Iterable[Any]) -> int:
    """Write figures as the pages of a PDF, which is replaced when it is complete; their number.

    One page is held in memory at a time.
    """
    from matplotlib.backends.backend_pdf import PdfPages

    partial = path.with_name(f".{path.name}.part")
    count = 0
    try:
        with PdfPages(partial, metadata=UNDATED) as pages:
            for figure in figures:
                pages.savefig(figure)
                count += 1
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
    return count
