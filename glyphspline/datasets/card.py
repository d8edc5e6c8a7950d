"""The data card, README.md with the header of Hugging Face's ``datasets``, and the table of fonts."""

from __future__ import annotations

import io
import shlex
from collections.abc import Iterator, Mapping
from dataclasses import fields
from itertools import chain
from typing import Any

from ..extras import need
from ..fields import arguments
from ..types import counted
from .dataset_columns import ABOUT
from .dataset_spec import DatasetSpec
from .dataset_summary import Summary
from .licences import UNKNOWN
from .plan import Plan
from .scan import SPLITS
from .shards import OfFont

HUB = {
    "OFL-1.1": "ofl-1.1", "Apache-2.0": "apache-2.0", "MIT": "mit", "CC0-1.0": "cc0-1.0", "CC-BY-4.0": "cc-by-4.0",
    "CC-BY-3.0": "cc-by-3.0", "CC-BY-SA-4.0": "cc-by-sa-4.0", "CC-BY-SA-3.0": "cc-by-sa-3.0", UNKNOWN: "unknown",
}  # fmt: skip
"""What the header calls a licence; all others are "other" there."""

SIZES = {
    1e3: "n<1K", 1e4: "1K<n<10K", 1e5: "10K<n<100K", 1e6: "100K<n<1M", 1e7: "1M<n<10M", 1e8: "10M<n<100M",
}  # fmt: skip
"""What the header calls a number of rows below these."""

TEXT_COLUMNS = (
    "file", "sha256", "family", "style", "postscript_name", "version", "location", "embedding", "licence",
    "licence_text", "licence_url", "split", "status", "reason", "same_as",
)  # fmt: skip


LISTED = 100
"""Characters that a command in the card has as they are; ``dataset.json`` has them all."""


def fonts_file(plan: Plan, totals: Mapping[int, OfFont]) -> bytes:
    """``fonts.parquet``: a row for each face at each location, with what failed and why."""
    pa = need("parquet")
    from pyarrow import parquet

    names = pa.list_(pa.string())
    kinds = {name: pa.string() for name in TEXT_COLUMNS} | {"face": pa.uint32(), "axes": names, "scripts": names}
    kinds |= {"weight_class": pa.uint16(), "width_class": pa.uint16(), "italic": pa.bool_()}
    kinds |= {name: pa.float64() for name in ("units_per_em", "ascender", "descender", "coverage")}
    kinds |= {name: pa.uint32() for name in ("glyphs", "characters", "taken")}
    of_fonts = [totals.get(k, OfFont()) for k in range(len(plan.fonts))]
    columns: dict[str, Any] = {}
    units = {"units_per_em": "font unit", "ascender": "font unit", "descender": "font unit", "axes": "user space"}
    schema = []
    for field in fields(plan.fonts[0]):
        if field.name not in ("path", "at"):
            values = [getattr(font, field.name) for font in plan.fonts]
            columns[field.name] = pa.array(values, kinds[field.name])
            unit = units.get(field.name)
            schema.append(pa.field(field.name, kinds[field.name], metadata={"unit": unit} if unit else None))
    for name in ("rows", "duplicates", "failed"):
        columns[name] = pa.array([getattr(of_font, name) for of_font in of_fonts], pa.uint32())
        schema.append(pa.field(name, pa.uint32()))
    columns["failures"] = pa.array([[f"{glyph}: {why}" for glyph, why in f.reasons] for f in of_fonts], names)
    schema.append(pa.field("failures", names))
    file = io.BytesIO()
    table = pa.Table.from_arrays(list(columns.values()), schema=pa.schema(schema))
    parquet.write_table(table, file, compression="zstd", row_group_size=1000)
    return file.getvalue()


def command(spec: DatasetSpec) -> str:
    """The call of the command line that makes such a data set: what is not default."""
    found = arguments(spec, DatasetSpec())
    fit = found.pop("options", []) if spec.options else ["--no-fit"]
    if not (len(spec.characters) <= LISTED and spec.characters.isprintable() and "`" not in spec.characters):
        found["characters"] = ["--text-file", "CHARACTERS.txt"]
    return f"glyphspline dataset FONTS… --out DIR {shlex.join([*chain(*found.values()), *fit])}".rstrip()


def card(plan: Plan, summary: Summary, schema: Any) -> str:
    """README.md."""
    return "\n".join([*_header(plan, summary), "", *_body(plan, summary, schema)]) + "\n"


def _header(plan: Plan, summary: Summary) -> Iterator[str]:
    yield "---"
    yield "pretty_name: Glyphs of fonts as curves"
    hub = list(dict.fromkeys(HUB.get(name, "other") for name in sorted(summary.licences)))
    if len(hub) == 1:
        yield f"license: {hub[0]}"
    elif hub:
        yield "license:"
        yield from (f"- {name}" for name in hub)
    yield "tags:"
    yield from (f"- {tag}" for tag in ("fonts", "glyphs", "curves", "splines"))
    yield "size_categories:"
    yield f"- {next((name for most, name in SIZES.items() if summary.rows < most), 'n>100M')}"
    yield "configs:"
    if summary.splits:
        yield "- config_name: default"
        yield "  default: true"
        yield "  data_files:"
        for split in SPLITS:
            if split in summary.splits:
                yield f"  - split: {split}"
                yield f"    path: data/{split}-*.parquet"
    yield "- config_name: fonts"
    yield "  data_files:"
    yield "  - split: fonts"
    yield "    path: fonts.parquet"
    yield "---"


def _body(plan: Plan, summary: Summary, schema: Any) -> Iterator[str]:
    spec = plan.spec
    yield "# Glyphs of fonts as curves"
    yield ""
    what = "contour" if spec.rows == "contour" else "glyph"
    yield f"One row a {what}. Splits are by family: no family is in two of them."
    yield ""
    yield "| split | families | fonts | glyphs | rows | rows whose shape is in an earlier row | MB |"
    yield "|---|---:|---:|---:|---:|---:|---:|"
    for name in SPLITS:
        if (s := summary.splits.get(name)) is not None:
            yield (
                f"| {name} | {s.families} | {s.fonts} | {s.glyphs} | {s.rows} | {s.duplicates} | {s.bytes / 1e6:.1f} |"
            )
    yield ""
    yield "An earlier row may be in an earlier split: rows of `validation` and `test` with `duplicate` have a shape"
    yield "that was trained on, or that stands twice in the split itself. Leave them out to test on new shapes."
    yield ""
    yield "## Licences"
    yield ""
    yield "The licence is guessed from the name table of each font (licence, its address, else the copyright notice),"
    yield "and written as an SPDX identifier. `fonts.parquet` has the texts. Read them before you pass the data on."
    yield ""
    yield "| licence | fonts | rows |"
    yield "|---|---:|---:|"
    for licence, (fonts, rows) in sorted(summary.licences.items(), key=lambda item: (-item[1][0], item[0])):
        yield f"| {licence} | {fonts} | {rows} |"
    yield ""
    yield "## Fonts"
    yield ""
    counts = ", ".join([f"{count} {status}" for status, count in summary.fonts.items() if count])
    failed = f"{counted(summary.failed, 'glyph')} failed"
    yield f"`fonts.parquet` (the configuration `fonts`) has a row for each face at each location: {counts}; {failed}."
    yield "Fonts that share name, style and version with an earlier one name it in `same_as`."
    yield ""
    yield "## How it was made"
    yield ""
    yield "```"
    yield command(spec)
    yield "```"
    yield ""
    libraries = ", ".join([f"{name} {number}" for name, number in plan.record["versions"].items()])
    yield f"glyphspline {plan.record['glyphspline']}; {libraries}."
    yield "The same fonts, options and versions give the same bytes. `dataset.json` has all options."
    yield ""
    yield "## Columns"
    yield ""
    metadata = schema.metadata or {}
    if (version := metadata.get(b"glyphspline.datasets.schema")) is not None:
        yield f"Schema version {version.decode()}."
        yield ""
    if spec.rows == "glyph":
        yield "Of what a contour has, a row has a list with an item for each contour."
        yield ""
    yield "| column | type | unit | what it holds |"
    yield "|---|---|---|---|"
    for field in schema:
        unit = (field.metadata or {}).get(b"unit", b"").decode()
        yield f"| {field.name} | {_kind(str(field.type))} | {unit} | {ABOUT[field.name]} |"


def _kind(text: str) -> str:
    """A type of Arrow without the names of list items, which say nothing."""
    return text.replace("element: ", "").replace("item: ", "").replace("|", "\\|")
