"""Outlines back into the sources they were read from: nothing but contours changes.

In: new contours; out: edited files. Read first: :mod:`.back`.
"""
