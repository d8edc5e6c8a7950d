"""What a data set says of itself: counts, the table of fonts, and the data card with the header of ``datasets``."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields
from itertools import chain
from typing import Any, BinaryIO

from ...extras import need
from ...fields import arguments
from ...types import counted
from .columns import ABOUT, type_of
from .plan import Plan, Shard
from .scan import SPLITS, UNKNOWN, FontFacts
from .shards import OfFont
from .spec import DatasetSpec

STATUSES = ("taken", "left out", "duplicate", "failed")
"""Of fonts."""

SHOWN = 5
"""Fonts that failed and are named."""


@dataclass
class OfSplit:
    """Counts of a split; ``bytes`` of its files."""

    families: int = 0
    fonts: int = 0
    glyphs: int = 0
    rows: int = 0
    duplicates: int = 0
    bytes: int = 0


@dataclass
class DatasetSummary:
    """Counts of a data set.

    Attributes:
        splits: by name. fonts: faces, at each of their locations, by status: taken, left out, duplicate, failed.
        licences: fonts and rows by licence. failed: glyphs that have no rows, and some of them: (font, glyph, reason).
        outside_tolerance: glyphs with a contour that is not within it, if it was asked for.
        unread: the first few fonts that failed: (file, reason). seconds: that the run took.
    """

    splits: dict[str, OfSplit] = field(default_factory=dict)
    fonts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(STATUSES, 0))
    licences: dict[str, tuple[int, int]] = field(default_factory=dict)
    failed: int = 0
    outside_tolerance: int = 0
    failures: list[tuple[str, ...]] = field(default_factory=list)
    unread: list[tuple[str, str]] = field(default_factory=list)
    seconds: float = 0.0

    @classmethod
    def of(cls, plan: Plan, totals: Mapping[int, OfFont], sizes: Mapping[Shard, int]) -> DatasetSummary:
        """The counts of a plan that was carried out, from those of each font and the sizes of shards."""
        found = cls()
        families: dict[str, set[str | None]] = {split: set() for split in SPLITS}
        for number, font in enumerate(plan.fonts):
            found.fonts[font.status] += 1
            if font.status == "failed" and len(found.unread) < SHOWN:
                found.unread.append((font.file, font.reason or ""))
            if font.split is None:
                continue
            own = totals.get(number, OfFont())
            split = found.splits.setdefault(font.split, OfSplit())
            families[font.split].add(font.family)
            split.fonts += 1
            split.glyphs += own.glyphs
            split.rows += own.rows
            split.duplicates += own.duplicates
            fonts, rows = found.licences.get(font.licence or UNKNOWN, (0, 0))
            found.licences[font.licence or UNKNOWN] = fonts + 1, rows + own.rows
            found.failed += own.failed
            if plan.spec.options and not plan.spec.options.is_fixed:
                found.outside_tolerance += own.outside
            found.failures += [(font.file, *pair) for pair in own.reasons][: SHOWN - len(found.failures)]
        for name, split in found.splits.items():
            split.families = len(families[name])
            split.bytes = sum(size for shard, size in sizes.items() if shard.split == name)
        return found

    @property
    def rows(self) -> int:
        """Number of rows of all splits."""
        return sum(split.rows for split in self.splits.values())

    @property
    def glyphs(self) -> int:
        """Number of glyphs of all splits."""
        return sum(split.glyphs for split in self.splits.values())

    @property
    def bytes(self) -> int:
        """Size of the shards."""
        return sum(split.bytes for split in self.splits.values())

    def facts(self) -> dict[str, Any]:
        """As plain data."""
        return asdict(self) | {"rows": self.rows, "glyphs": self.glyphs, "bytes": self.bytes}

    def lines(self) -> Iterator[str]:
        """Its summary, in lines."""
        rest = [f"{count} {status}" for status, count in sorted(self.fonts.items()) if count and status != "taken"]
        more = f" ({', '.join(rest)})" if rest else ""
        size = f"{self.bytes / 1e6:.1f} MB"
        yield (
            f"{counted(self.rows, 'row')} of {counted(self.glyphs, 'glyph')} of {counted(self.fonts['taken'], 'font')}"
            f"{more}, {size}, in {self.seconds:.1f} s"
        )
        for file, reason in self.unread:
            yield f"{file}: {reason}"
        if self.failed:
            yield f"{counted(self.failed, 'glyph')} failed"
            for file, glyph, reason in self.failures:
                yield f"{file}, {glyph}: {reason}"
        if self.outside_tolerance:
            yield f"{counted(self.outside_tolerance, 'glyph')} not within the tolerance: see column within_tolerance"


HUB = {
    "OFL-1.1", "Apache-2.0", "MIT", "CC0-1.0", "CC-BY-4.0", "CC-BY-3.0", "CC-BY-SA-4.0", "CC-BY-SA-3.0", UNKNOWN,
}  # fmt: skip
"""Licences that the header has, in lower case; all others are "other" there."""

SIZES = {
    1e3: "n<1K", 1e4: "1K<n<10K", 1e5: "10K<n<100K", 1e6: "100K<n<1M", 1e7: "1M<n<10M", 1e8: "10M<n<100M",
}  # fmt: skip
"""What the header calls a number of rows below these."""


def write_fonts(plan: Plan, totals: Mapping[int, OfFont], file: BinaryIO) -> None:
    """Write ``fonts.parquet``: a row for each face at each location, with what failed and why."""
    pa = need("parquet")
    from pyarrow import parquet

    types = {"str": "string", "int": "uint32", "float": "double", "bool": "bool", "tuple[str, ...]": "string[]"}
    small = dict.fromkeys(("weight_class", "width_class"), "uint16")
    units = {"units_per_em": "font unit", "ascender": "font unit", "descender": "font unit", "axes": "user space"}
    of_fonts = [totals.get(k, OfFont()) for k in range(len(plan.fonts))]
    columns: dict[str, tuple[str, list[Any]]] = {}
    for one in fields(FontFacts):
        if one.name not in ("path", "at"):
            kind = small.get(one.name) or types[str(one.type).removesuffix(" | None")]
            columns[one.name] = kind, [getattr(font, one.name) for font in plan.fonts]
    for name in ("rows", "duplicates", "failed"):
        columns[name] = "uint32", [getattr(of_font, name) for of_font in of_fonts]
    columns["failures"] = "string[]", [[f"{glyph}: {why}" for glyph, why in f.reasons] for f in of_fonts]
    schema = pa.schema([
        pa.field(name, type_of(kind), metadata={"unit": units[name]} if name in units else None)
        for name, (kind, _) in columns.items()
    ])  # fmt: skip
    table = pa.table({name: values for name, (_, values) in columns.items()}, schema=schema)
    parquet.write_table(table, file, compression="zstd", row_group_size=1000)


def command(spec: DatasetSpec) -> str:
    """The call of the command line that makes such a data set: what is not default."""
    found = arguments(spec, DatasetSpec())
    fit = found.pop("options", []) if spec.options else ["--no-fit"]
    # ``dataset.json`` has them all.
    if not (len(spec.characters) <= 100 and spec.characters.isprintable() and "`" not in spec.characters):
        found["characters"] = ["--text", "@CHARACTERS.txt"]
    return f"glyphspline dataset FONTS… --out DIR {shlex.join([*chain(*found.values()), *fit])}".rstrip()


def card(plan: Plan, summary: DatasetSummary, schema: Any) -> str:
    """README.md."""
    spec, record = plan.spec, plan.record
    splits = {name: summary.splits[name] for name in SPLITS if name in summary.splits}
    by_split = [
        f"| {name} | {s.families} | {s.fonts} | {s.glyphs} | {s.rows} | {s.duplicates} | {s.bytes / 1e6:.1f} |"
        for name, s in splits.items()
    ]
    licences = sorted(summary.licences.items(), key=lambda item: (-item[1][0], item[0]))
    by_licence = [f"| {licence} | {fonts} | {rows} |" for licence, (fonts, rows) in licences]
    columns = [
        f"| {column.name} | {_kind(str(column.type))} | {(column.metadata or {}).get(b'unit', b'').decode()} "
        f"| {ABOUT[column.name]} |"
        for column in schema
    ]
    counts = ", ".join([f"{count} {status}" for status, count in summary.fonts.items() if count])
    libraries = ", ".join([f"{name} {number}" for name, number in record["versions"].items()])
    of_contours = "Of what a contour has, a row has a list with an item for each contour.\n\n"
    return f"""\
{_header(summary, splits)}
# Glyphs of fonts as curves

One row a {spec.rows}. Splits are by family: no family is in two of them.

| split | families | fonts | glyphs | rows | rows whose shape is in an earlier row | MB |
{_lines("|---|---:|---:|---:|---:|---:|---:|", *by_split)}
An earlier row may be in an earlier split: rows of `validation` and `test` with `duplicate` have a shape
that was trained on, or that stands twice in the split itself. Leave them out to test on new shapes.

## Licences

The licence is guessed from the name table of each font (licence, its address, else the copyright notice),
and written as an SPDX identifier. `fonts.parquet` has the texts. Read them before you pass the data on.

| licence | fonts | rows |
{_lines("|---|---:|---:|", *by_licence)}
## Fonts

`fonts.parquet` (the configuration `fonts`) has a row for each face at each location: {counts}; \
{counted(summary.failed, "glyph")} failed.
Fonts that share name, style and version with an earlier one name it in `same_as`.

## How it was made

```
{command(spec)}
```

glyphspline {record["glyphspline"]}; {libraries}.
The same fonts, options and versions give the same bytes. `dataset.json` has all options.

## Columns

Schema version {schema.metadata[b"glyphspline.datasets.schema"].decode()}.

{of_contours if spec.rows == "glyph" else ""}| column | type | unit | what it holds |
{_lines("|---|---|---|---|", *columns)}"""


def _lines(*lines: str) -> str:
    return "".join([f"{line}\n" for line in lines])


def _header(summary: DatasetSummary, splits: Iterable[str]) -> str:
    """Facts about the data set for Hugging Face's ``datasets``, as YAML."""
    hub = list(dict.fromkeys(name.lower() if name in HUB else "other" for name in sorted(summary.licences)))
    licence = [f"license: {hub[0]}"] if len(hub) == 1 else ["license:", *(f"- {name}" for name in hub)] if hub else []
    default = ["- config_name: default", "  default: true", "  data_files:"] if splits else []
    for split in splits:
        default += [f"  - split: {split}", f"    path: data/{split}-*.parquet"]
    size = next((name for most, name in SIZES.items() if summary.rows < most), "n>100M")
    return _lines(
        "---", "pretty_name: Glyphs of fonts as curves", *licence,
        "tags:", "- fonts", "- glyphs", "- curves", "- splines", "size_categories:", f"- {size}", "configs:", *default,
        "- config_name: fonts", "  data_files:", "  - split: fonts", "    path: fonts.parquet", "---",
    )  # fmt: skip


def _kind(text: str) -> str:
    """A type of Arrow without the names of list items, which say nothing."""
    return text.replace("element: ", "").replace("item: ", "").replace("|", "\\|")
