"""What a run over fonts makes: fonts in a fixed order, their glyphs packed into shards."""

from __future__ import annotations

import json
import platform
import unicodedata
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from hashlib import sha256
from importlib.metadata import version
from typing import Any, NamedTuple

from ..._version import __version__
from ...runs.engine import slices
from .scan import SPLITS, FontFacts
from .spec import USUAL, DatasetSpec, Sizes

LIBRARIES = ("numpy", "scipy", "numba", "pyarrow", "fonttools", "uharfbuzz")
"""Those whose versions decide the bytes of shards."""


class DatasetTask(NamedTuple):
    """A glyph: its font, and its place among the glyphs of the font that are asked for."""

    font: FontFacts
    at: int


class Piece(NamedTuple):
    """Glyphs of a font in a shard: those asked for from ``first`` up to ``last``; ``font`` is its number."""

    font: int
    first: int
    last: int


class Shard(NamedTuple):
    """A file of the data set: its name, its split and its glyphs."""

    name: str
    split: str
    pieces: tuple[Piece, ...]

    @property
    def glyphs(self) -> int:
        """Number of its glyphs."""
        return sum(piece.last - piece.first for piece in self.pieces)


@dataclass(frozen=True)
class Plan:
    """A data set before it is made.

    Attributes:
        spec: what it holds. fonts: all faces at their locations, in the order of rows first, by split, hash, face and
            location; then the others.
        sizes: where it is cut.
    """

    spec: DatasetSpec
    fonts: tuple[FontFacts, ...]
    sizes: Sizes = USUAL

    @cached_property
    def shards(self) -> tuple[Shard, ...]:
        """The files, in order."""
        found: list[Shard] = []
        for split in SPLITS:
            packs = _packs([(k, font) for k, font in enumerate(self.fonts) if font.split == split], self.sizes.shard)
            found += [
                Shard(f"data/{split}-{k:05d}-of-{len(packs):05d}.parquet", split, pieces)
                for k, pieces in enumerate(packs)
            ]
        return tuple(found)

    @property
    def glyphs(self) -> int:
        """Number of glyphs of all shards."""
        return sum(shard.glyphs for shard in self.shards)

    def chunks(self, shard: Shard) -> Iterator[Sequence[DatasetTask]]:
        """The tasks of a shard in order, in chunks of one font each."""
        # What points, tangents, curvature and pixels of a glyph with eight contours need in memory.
        need = 8 * 20 * (self.spec.points or 64) + (self.spec.raster or 0) ** 2
        size = max(1, min(self.sizes.chunk, self.sizes.chunk_bytes // need))
        for font, first, last in shard.pieces:
            yield from slices([DatasetTask(self.fonts[font], k) for k in range(first, last)], size)

    @cached_property
    def record(self) -> dict[str, Any]:
        """The content of ``dataset.json``, which differs for other options or fonts."""
        options = None if self.spec.options is None else self.spec.options.facts()
        fonts = [[*f.key, f.file, f.status] for f in self.fonts]
        return {
            "glyphspline": __version__,
            "versions": {
                "python": platform.python_version(),
                **{name: version(name) for name in LIBRARIES},
                "unicode": unicodedata.unidata_version,
            },
            "spec": asdict(self.spec) | {"options": options},
            "fonts": {"count": len(fonts), "sha256": _digest(fonts)},
            "shards": len(self.shards),
            **({} if self.sizes == USUAL else {"sizes": asdict(self.sizes)}),
        }

    @cached_property
    def digest(self) -> str:
        """A hash of the record: shards of one run have the same."""
        return _digest(self.record)


def _packs(fonts: Sequence[tuple[int, FontFacts]], size: int) -> list[tuple[Piece, ...]]:
    """The glyphs of a split's fonts in packs of a size."""
    packs: dict[int, list[Piece]] = defaultdict(list)
    before = 0
    for number, font in fonts:
        first = 0
        while first < font.taken:
            pack, used = divmod(before + first, size)
            last = min(font.taken, first + size - used)
            packs[pack].append(Piece(number, first, last))
            first = last
        before += font.taken
    return list(map(tuple, packs.values()))


def plan_of(spec: DatasetSpec, found: Sequence[FontFacts], sizes: Sizes = USUAL) -> Plan:
    """The plan for fonts that were scanned, in any order.

    Fonts of the same bytes are taken once. All faces of a file are in the split of its first one.
    """
    fonts: list[FontFacts] = []
    by_key: dict[Any, FontFacts] = {}
    by_name: dict[tuple[str, str, str], FontFacts] = {}
    by_file: dict[str, str] = {}
    for font in sorted(found, key=lambda f: (*f.key, f.file, str(f.path))):
        if font.sha256 is None or font.status == "failed":
            fonts.append(font)
            continue
        if font.split:
            font = replace(font, split=by_file.setdefault(font.file, font.split))
        first = by_key.setdefault(font.key, font)
        if first is not font:
            reason = "has the same bytes as another file"
            font = replace(font, status="duplicate", reason=reason, same_as=first.sha256, split=None, taken=0)
        elif font.postscript_name and font.version:
            name = (font.postscript_name, font.version, font.style or "")
            same = by_name.setdefault(name, font)
            font = font if same is font else replace(font, same_as=same.sha256)
        fonts.append(font)
    fonts.sort(key=lambda f: (SPLITS.index(f.split) if f.split else len(SPLITS), *f.key, f.file))
    return Plan(spec, tuple(fonts), sizes)


def _digest(value: Any) -> str:
    return sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


def record_text(plan: Plan) -> bytes:
    """``dataset.json``."""
    return (json.dumps(plan.record, indent=1, ensure_ascii=False) + "\n").encode()
