"""The gallery of a finished run, and what other pages share.

In: lines of a manifest; out: ``index.html`` and its data. Read first: :mod:`.gallery`.
"""

from __future__ import annotations

FOLDER = "gallery"
"""Where a run has its gallery's files."""

SUFFIX = ".glyph.js"
"""Suffix of a glyph's file; no other file of the gallery has it."""
