"""Decompression of WOFF and WOFF2 within limits."""

from __future__ import annotations

import struct
import zlib
from io import BytesIO

import brotli
from fontTools.ttLib import TTFont
from fontTools.ttLib.woff2 import WOFF2DirectoryEntry, woff2DirectorySize

from ...errors import FontError

FORMATS = {
    b"\0\1\0\0": "TrueType",
    b"true": "TrueType",
    b"OTTO": "OpenType (CFF)",
    b"ttcf": "collection",
    b"wOFF": "WOFF",
    b"wOF2": "WOFF2",
}
"""Format of a font file by its first four bytes."""

MAX_UNPACKED = 1 << 28
"""Limit of bytes of a decompressed font. The largest real ones, CJK faces of 65,535 glyphs, have a tenth of it; a
hostile file of a few hundred kilobytes can ask for gigabytes."""

TOO_LARGE = f"a font that grows beyond {MAX_UNPACKED >> 20} MiB when it is unpacked"


def unpacked(data: bytes) -> bytes:
    """Decompress a font; other data is returned as it is.

    Raises:
        FontError: the font is larger than ``MAX_UNPACKED``, or a WOFF2 file of several faces.
    """
    if data[:4] == b"wOFF":
        check_woff(data)
    elif data[:4] == b"wOF2":
        if data[4:8] == b"ttcf":
            raise FontError("a WOFF2 file of several faces, which is not supported: unpack it to a TTC first")
        check_woff2(data)
    else:
        return data
    font = TTFont(BytesIO(data), recalcBBoxes=False, recalcTimestamp=False)
    font.flavor, font.flavorData = None, None
    plain = BytesIO()
    font.save(plain, reorderTables=False)
    return plain.getvalue()


def check_woff(data: bytes) -> None:
    """Refuse a WOFF file with tables above the limit, or longer than its directory says."""
    num_tables = struct.unpack_from(">H", data, 12)[0]
    total = 0
    for k in range(num_tables):
        offset, packed, length = struct.unpack_from(">3L", data, 44 + 20 * k + 4)
        total += length
        if total > MAX_UNPACKED:
            raise FontError(TOO_LARGE)
        if packed < length:
            inflater = zlib.decompressobj()
            inflater.decompress(data[offset : offset + packed], length + 1)
            if inflater.unconsumed_tail:
                raise FontError("a broken font: a table is longer than its entry says")


def check_woff2(data: bytes) -> None:
    """Refuse a WOFF2 file above the limit; never more than that is in memory."""
    file = BytesIO(data)
    num_tables = struct.unpack_from(">H", data, 12)[0]
    file.seek(woff2DirectorySize)
    total = 0
    for _ in range(num_tables):
        entry = WOFF2DirectoryEntry()
        entry.fromFile(file)
        total += max(entry.length, entry.origLength)
    if total > MAX_UNPACKED:
        raise FontError(TOO_LARGE)
    inflater, found, packed = brotli.Decompressor(), 0, file.read(struct.unpack_from(">L", data, 20)[0])
    while not inflater.is_finished():
        piece = inflater.process(packed, output_buffer_limit=1 << 20)
        found += len(piece)
        if found > total:
            raise FontError("a broken font: its compressed data is longer than its directory says")
        if not piece and inflater.can_accept_more_data():
            raise FontError("a broken font: its compressed data is cut short")
        packed = b""
