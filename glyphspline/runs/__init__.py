"""Runs over many glyphs, with workers; interrupted runs are resumed."""
