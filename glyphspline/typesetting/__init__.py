"""Text: shaped, broken into lines, and put in place."""
