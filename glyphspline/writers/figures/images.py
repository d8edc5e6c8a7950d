"""Figures of matplotlib and their bytes as PNG or PDF: the same figure gives the same bytes."""

from __future__ import annotations

import io
from typing import Any, Literal

ImageKind = Literal["png", "pdf"]

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


def saved(figure: Any, kind: ImageKind, dpi: float = DPI) -> bytes:
    """The figure as a PNG of ``dpi`` pixels an inch, or as a one-page PDF."""
    how = {"metadata": UNDATED} if kind == "pdf" else {"dpi": dpi, "metadata": {"Software": None}}
    file = io.BytesIO()
    figure.savefig(file, format=kind, **how)
    return file.getvalue()
