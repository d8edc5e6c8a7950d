"""Outlines back into the sources they were read from: nothing but contours changes."""
