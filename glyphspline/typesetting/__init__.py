"""Text: shaped, broken into lines, and laid along a path."""
