"""Outlines compared: one moved, one that lacks a contour."""

from dataclasses import replace

from ...comparing.compare import compare
from ...readers.opentype.bulk import load_compiled
from .. import compare_glyphs  # noqa: F401
from . import DISC, LEAF, SHAPES, SQUARE

load_compiled()
compare(SHAPES, replace(SHAPES, contours=(LEAF.reversed(), SQUARE, DISC)))
