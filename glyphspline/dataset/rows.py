"""Glyphs as rows of a table."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import blake2b
from typing import Any

from ..fitting.results import GlyphResult
from ..outlines.outline import Outline
from .spec import DatasetSpec


def table_of(outlines: Sequence[Outline], results: Sequence[GlyphResult | None], spec: DatasetSpec) -> Any:
    """A table with a row for each glyph."""
    import pyarrow as pa

    schema = pa.schema(
        [
            ("glyph", pa.string()),
            ("gid", pa.uint32()),
            ("codepoints", pa.list_(pa.uint32())),
            ("advance", pa.float64()),
            ("contours", pa.uint32()),
            ("points", pa.list_(pa.list_(pa.float32(), 2))),
            ("vertices", pa.int64()),
            ("shape", pa.string()),
        ]
    )
    rows = [
        {
            "glyph": o.name, "gid": o.gid, "codepoints": list(o.unicodes), "advance": o.advance,
            "contours": len(o.contours), "points": o.arrays.points.tolist(),
            "vertices": None if r is None else sum(len(c.polygon) for c in r.contours),
            "shape": blake2b(o.arrays.points.tobytes(), digest_size=8).hexdigest() if len(o.contours) else None,
        }
        for o, r in zip(outlines, results, strict=True)
    ]  # fmt: skip
    return pa.Table.from_pylist(rows, schema=schema)
