"""What a run needs that fits nothing: reading outlines, and drawing them as they are."""

from ...fitting.results import as_glyph
from ...readers.opentype.bulk import load_compiled
from ...writers.svg.document import to_svg
from .. import worker  # noqa: F401
from . import SHAPES

load_compiled()
to_svg(as_glyph(SHAPES))
