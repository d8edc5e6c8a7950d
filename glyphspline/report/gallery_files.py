"""Where a run has its gallery's files."""

from __future__ import annotations

FOLDER = "gallery"

SUFFIX = ".glyph.js"
"""Suffix of a glyph's file; no other file of the gallery has it."""
