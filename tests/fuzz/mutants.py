"""Damage done to fonts: bytes, table directories, lengths and offsets, and parts of other fonts."""

from __future__ import annotations

import random
import struct

from tests.places import FONTS

SEEDS = [path for path in sorted(FONTS.iterdir()) if path.suffix in (".ttf", ".otf", ".ttc", ".woff2")]

EXTREMES = [0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF]


def mutant(rng: random.Random) -> tuple[str, bytes]:
    """A damaged font, and the name of the one that it was made of."""
    seed = rng.choice(SEEDS)
    data = bytearray(seed.read_bytes())
    for _ in range(rng.choice([1, 1, 2, 4])):
        data = rng.choice([flip, extreme, directory, within_table, cut, splice, swap])(data, rng)
    return seed.name, bytes(data)


def flip(data: bytearray, rng: random.Random) -> bytearray:
    """Change some bytes anywhere."""
    for _ in range(rng.choice([1, 8, 64])):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return data


def extreme(data: bytearray, rng: random.Random) -> bytearray:
    """Write a number at the edge of its range, where a length or an offset may be."""
    size, code = rng.choice([(1, "B"), (2, "H"), (4, "I")])
    at = rng.randrange(max(1, len(data) - size))
    data[at : at + size] = struct.pack(f">{code}", rng.choice(EXTREMES) & (2 ** (8 * size) - 1))
    return data


def directory(data: bytearray, rng: random.Random) -> bytearray:
    """Change an entry of the table directory: tag, checksum, offset or length."""
    at = 12 + 16 * rng.randrange(12) + 4 * rng.randrange(4)
    if at + 4 <= len(data):
        data[at : at + 4] = struct.pack(">I", rng.choice([*EXTREMES, rng.randrange(2 * len(data))]))
    return data


def within_table(data: bytearray, rng: random.Random) -> bytearray:
    """Write extremes near the beginning of a table, where its counts are."""
    tables = [struct.unpack_from(">4sIII", data, 12 + 16 * k) for k in range(min(20, max(0, (len(data) - 12) // 16)))]
    inside = [offset for _, _, offset, length in tables if length > 0 and offset + 64 < len(data)]
    if inside:
        at = rng.choice(inside) + 2 * rng.randrange(24)
        data[at : at + 2] = struct.pack(">H", rng.choice(EXTREMES) & 0xFFFF)
    return data


def cut(data: bytearray, rng: random.Random) -> bytearray:
    """Keep only the beginning."""
    return data[: rng.randrange(4, len(data) + 1)] if len(data) > 4 else data


def splice(data: bytearray, rng: random.Random) -> bytearray:
    """Put a piece of another font, or of this one, somewhere."""
    other = rng.choice(SEEDS).read_bytes()
    size = rng.choice([4, 32, 512, 4096])
    start, at = rng.randrange(len(other)), rng.randrange(len(data))
    data[at : at + size] = other[start : start + size]
    return data


def swap(data: bytearray, rng: random.Random) -> bytearray:
    """Let two entries of the table directory change places in all but their tags."""
    a, b = (16 + 16 * rng.randrange(10) for _ in range(2))
    if max(a, b) + 12 <= len(data):
        data[a : a + 12], data[b : b + 12] = data[b : b + 12], data[a : a + 12]
    return data
