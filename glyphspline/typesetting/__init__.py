"""Text: shaped, broken into lines, and set along a path."""
