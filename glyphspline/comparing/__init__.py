"""Two outlines of one glyph: how far they are from each other, and what came and went."""
