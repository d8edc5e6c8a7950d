"""Drawings through matplotlib: PNG, PDF and the atlas."""
