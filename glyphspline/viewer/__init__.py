"""The live viewer: a page served on this machine only; the Python core computes every picture as sliders move."""

from .app import make_app, serve

__all__ = ["make_app", "serve"]
