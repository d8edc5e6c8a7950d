"""What experiments on many contours come to: tables, means and quantiles by the number of vertices, and a figure."""

from __future__ import annotations

import csv
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import Any

import numpy as np

from ...files import replacing, write_whole
from ...report.data import encoded, plain
from ...runs.folder import entries_of
from ...runs.spec import read_run
from ...types import FloatArray
from ...writers.figures.basics import blank, saved
from .api import DPI
from .measures import QUANTITIES
from .style import line_of, small, styled

ENDS = (3, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 512, 1024)
"""Where groups of contours begin, by their numbers of vertices; the last one has no end."""

COLUMNS = ("font", "glyph", "contour", "method", *QUANTITIES)

MEANS = ("iterations", "bulge", "max_curvature", "curvature_variation")
"""Measures of which there are means."""

SHOWN = ("iterations", "bulge", "max_curvature")
"""Those in the figure."""

LOW, HIGH = 0.1, 0.9
"""Quantiles."""

ENOUGH = 30
"""Contours from which on means are drawn."""


@dataclass
class Tally:
    """Numbers of all contours, method by method: column for column, NaN where there is none.

    Attributes:
        columns: (contours,) of each method and measure. contours: number of them.
    """

    columns: dict[str, dict[str, array[float]]] = field(default_factory=dict)

    def add(self, row: dict[str, Any]) -> None:
        """Count the row of a contour and method."""
        own = self.columns.setdefault(row["method"], {name: array("d") for name in QUANTITIES})
        for name, values in own.items():
            values.append(nan if row[name] is None else row[name])

    @property
    def methods(self) -> list[str]:
        """The methods, in the order of the rows."""
        return [*self.columns]

    @property
    def contours(self) -> int:
        """Number of contours."""
        return len(next(iter(self.columns.values()))["vertices"]) if self.columns else 0

    def of(self, method: str, name: str) -> FloatArray:
        """(contours,) a measure of a method."""
        return np.array(self.columns[method][name])

    def groups(self) -> Iterator[dict[str, Any]]:
        """Means and quantiles of each measure, by number of vertices and method."""
        for method in self.methods:
            place = np.searchsorted(ENDS, self.of(method, "vertices"), side="right")
            for group in np.unique(place).tolist():
                chosen = place == group
                row = {"method": method, "from": ENDS[max(group - 1, 0)], "contours": int(chosen.sum())}
                for name in MEANS:
                    values = self.of(method, name)[chosen]
                    known = values[np.isfinite(values)]
                    found = [known.mean(), *np.quantile(known, (LOW, 0.5, HIGH))] if len(known) else [nan] * 4
                    words = ("mean", f"{LOW:.0%}", "median", f"{HIGH:.0%}")
                    row |= {f"{name}, {word}": plain(float(v)) for word, v in zip(words, found, strict=True)}
                yield row


def rows_in(folders: Sequence[Path]) -> Iterator[dict[str, Any]]:
    """The rows of all curves of finished runs, with font and glyph."""
    for folder in folders:
        font = (read_run(folder) or {})["font"]
        name = f"{font['family']} {font['style']}".strip()
        for entry in entries_of(folder):
            for row in entry["contours"]:
                yield {"font": name, "glyph": entry["glyph"], **row}


def write_tables(out: Path, folders: Sequence[Path]) -> Tally:
    """Write ``table.csv``, ``table.json`` and ``means.csv`` of finished runs, and ``means.png`` and so on of many."""
    tally = Tally()
    with replacing(out / "table.csv") as as_csv, replacing(out / "table.json") as as_json:
        as_csv.write(f"{','.join(COLUMNS)}\n".encode())
        before = b"[\n"
        for row in rows_in(folders):
            tally.add(row)
            as_csv.write(line_of_csv([row[name] for name in COLUMNS]))
            as_json.write(before + encoded(row).encode())
            before = b",\n"
        as_json.write(b"[]\n" if before == b"[\n" else b"\n]\n")
    groups = list(tally.groups())
    with replacing(out / "means.csv") as file:
        for values in [list(groups[0]), *(row.values() for row in groups)] if groups else []:
            file.write(line_of_csv([*values]))
    return tally


def line_of_csv(values: Sequence[Any]) -> bytes:
    """A line of CSV."""
    from io import StringIO

    text = StringIO()
    csv.writer(text, lineterminator="\n").writerow(values)
    return text.getvalue().encode()


def write_means(out: Path, tally: Tally, formats: Sequence[Any]) -> list[str]:
    """Draw means against the number of vertices, of enough contours; the names of the files."""
    if tally.contours < ENOUGH:
        return []
    with styled():
        figure = means_figure(tally)
        for kind in formats:
            data = saved(figure, kind, DPI)
            write_whole(str(out / f"means.{kind}"), small(data) if kind == "png" else data)
    return [f"means.{kind}" for kind in formats]


def means_figure(tally: Tally) -> Any:
    """As Figs. 3 and 4: means of each method by number of vertices; bands are from one quantile to the other."""
    groups = list(tally.groups())
    figure = blank(9.6, 3.2, layout="constrained")
    for k, name in enumerate(SHOWN):
        axes, (label, unit, _) = figure.add_subplot(1, len(SHOWN), k + 1), QUANTITIES[name]
        for method in tally.methods:
            own = [row for row in groups if row["method"] == method and row[f"{name}, mean"] is not None]
            x = [row["from"] for row in own]
            how = line_of(method)
            axes.plot(x, [row[f"{name}, mean"] for row in own], label=method, **how)
            if method.startswith("variant"):
                low, high = ([row[f"{name}, {q:.0%}"] for row in own] for q in (LOW, HIGH))
                axes.fill_between(x, low, high, color=how["color"], alpha=0.12, lw=0)
        axes.set(xscale="log", xlabel="vertices", ylabel=f"{label}{f', {unit}' if unit else ''}")
        axes.set_yscale("linear" if name == "iterations" else "log")
        ticks = [end for end in ENDS if end in {row["from"] for row in groups}][::2]
        axes.set_xticks(ticks, [str(tick) for tick in ticks])
        axes.minorticks_off()
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=len(tally.methods), fontsize=7)
    return figure
