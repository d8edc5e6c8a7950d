"""Runs over many glyphs, with workers; interrupted runs are resumed.

In: a source, glyphs, a :class:`.RunSpec`; out: a folder of files with a manifest. Read first: :mod:`.convert`, then
:mod:`.engine`.
"""
