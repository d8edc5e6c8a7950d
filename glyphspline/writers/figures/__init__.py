"""Drawings by matplotlib: PNG, PDF and the atlas."""
