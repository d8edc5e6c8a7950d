"""The exit status, one rule for all commands."""

DONE, UNDONE, UNUSABLE, INTERRUPTED = 0, 1, 2, 130

RULE = (
    f"Exit status: {DONE} all was done; {UNDONE} something asked for was not: a glyph failed, a character is missing, "
    f"a result is not within its tolerance, one of several fonts cannot be read, or check -e and diff find what they "
    f"look for; {UNUSABLE} the call or the font is unusable; {INTERRUPTED} Ctrl-C."
)
"""What the help says."""
