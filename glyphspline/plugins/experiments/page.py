"""The page of experiments, to send to somebody: the paper's claims, sheets, and tables sorted by any column."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from ...files import write_whole
from ...report.data import script
from ...report.pages import page_of
from ...runs.folder import entries_of
from ...runs.spec import read_run
from ...types import counted, shortened
from ...writers.svg.document import text
from .claims import verdicts
from .measures import QUANTITIES
from .report import Tally, rows_in, write_means, write_tables
from .run import times_of
from .spec import ExperimentSpec

MOST_ROWS = 3000
"""Rows of the page's table; ``table.csv`` has all."""

TIMES = "times.js"
"""Beside the page: the times of its rows, which are never the same twice."""

KINDS = {"png": "image/png", "svg": "image/svg+xml"}
"""Of pictures in the page."""


def write_report(out: Path, folders: Sequence[Path], spec: ExperimentSpec) -> tuple[bool, list[str]]:
    """Write the tables and ``index.html`` of finished runs; whether glyphs failed, and what there is to say."""
    tally = write_tables(out, folders)
    means = write_means(out, tally, spec.formats)
    every = [(folder, entry) for folder in folders for entry in entries_of(folder)]
    write_page(out, folders, [(f, e) for f, e in every if e["files"]], tally, means)
    failed = [f"{entry['glyph']}: {entry['error']}" for _, entry in every if entry["status"] == "failed"]
    glyphs = counted(sum(entry["status"] == "ok" for _, entry in every), "glyph")
    lines = [f"{glyphs}, {counted(tally.contours, 'contour')}, {len(tally.methods)} curves of each"]
    lines += [f"{verdict}: {claim} {found}" for _, claim, found, verdict in verdicts(tally)]
    lines += shortened(failed, 5, "and {} more that failed")
    return bool(failed), [*lines, f"open {out / 'index.html'}"]


def write_page(
    out: Path, folders: Sequence[Path], drawn: Sequence[tuple[Path, dict[str, Any]]], tally: Tally, means: Sequence[str]
) -> None:
    """Write ``index.html``, and times beside it.

    Args:
        folders: of the runs. drawn: glyphs with sheets, and their folders. means: files of the figure of means.
    """
    runs = [run for folder in folders if (run := read_run(folder))]
    fonts = [f"{run['font']['family']} {run['font']['style']}".strip() for run in runs]
    rows = list(islice(rows_in(folders), MOST_ROWS + 1))
    facts = ["; ".join(dict.fromkeys(run["command"] for run in runs))]
    if is_long := len(rows) > MOST_ROWS:
        facts.append("table.csv has the rows of all contours.")
    else:
        times = {(k, *key): float(value) for k, folder in enumerate(folders) for key, value in times_of(folder).items()}
        number = {name: k for k, name in reversed(list(enumerate(fonts)))}
        keys = [(number[row["font"]], row["glyph"], str(row["contour"]), row["method"]) for row in rows]
        write_whole(str(out / TIMES), script([times.get(key) for key in keys]))
    pictures = [picture(out / name) for name in means[:1]]
    pictures += [picture(folder / shown(entry["files"])) for folder, entry in drawn]
    if len(fonts) == 1:
        rows = [{name: value for name, value in row.items() if name != "font"} for row in rows]
    heading = "Experiments on " + (fonts[0] if len(fonts) == 1 else f"{len(fonts)} fonts")
    tables = [table("Means and quantiles by number of vertices, from the first to the next", list(tally.groups()))]
    if not is_long:
        tables.insert(0, table("Contours", rows, with_times=True))
    page = page_of(
        "experiment.html", ("theme.css", "experiment.css"), heading, ("experiment.js",), {}, loads=True, pictures=True,
        own=[Path(__file__).parent], facts=facts, claims=claims(tally), pictures_shown="".join(pictures),
        tables="".join(tables),
    )  # fmt: skip
    write_whole(str(out / "index.html"), page)


def shown(files: dict[str, str]) -> str:
    """The file of a glyph that is in the page."""
    return next(files[kind] for kind in (*KINDS, *files) if kind in files)


def picture(path: Path) -> str:
    """A figure in the page itself; a PDF is a link."""
    kind = path.suffix[1:]
    if kind not in KINDS:
        return f'<p><a href="{text(path.name)}">{text(path.name)}</a></p>'
    data = b64encode(path.read_bytes()).decode()
    return f'<figure><img alt="{text(path.stem)}" src="data:{KINDS[kind]};base64,{data}"></figure>'


def claims(tally: Tally) -> str:
    """The rows of the paper's claims."""
    return "".join(
        f'<tr><td>{source}</td><td>{claim}</td><td>{text(found)}</td><td class="{verdict}">{verdict}</td></tr>'
        for source, claim, found, verdict in verdicts(tally)
    )


def table(heading: str, rows: Sequence[dict[str, Any]], with_times: bool = False) -> str:
    """A table whose columns can be sorted."""
    if not rows:
        return ""
    head = [heading_of(name) for name in rows[0]] + ["<th>time, ms</th>"] * with_times
    body = "".join(f"<tr>{''.join(f'<td>{cell(value)}</td>' for value in row.values())}</tr>" for row in rows)
    kind = ' class="numbers timed"' if with_times else ' class="numbers"'
    return (
        f'<h2>{heading}</h2><div class="wide"><table{kind}><thead><tr>{"".join(head)}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def heading_of(name: str) -> str:
    """The heading of a column: its label and unit, and what it is."""
    own, _, more = name.partition(", ")
    if own not in QUANTITIES:
        return f"<th>{text(name)}</th>"
    label, unit, about = QUANTITIES[own]
    words = f"{label}{f', {more}' if more else ''}{f', {unit}' if unit else ''}"
    return f'<th title="{text(about)}">{text(words)}</th>'


def cell(value: Any) -> str:
    """A value for people."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return (
        text(value) if isinstance(value, str) else f"{value:.4g}" if value != int(value) or value >= 1e6 else f"{value}"
    )
