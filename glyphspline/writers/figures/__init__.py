"""Drawings by matplotlib: PNG and PDF.

In: a result; out: bytes. Read first: :mod:`.drawings`.
"""
