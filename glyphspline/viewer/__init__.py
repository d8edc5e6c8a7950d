"""The live viewer: a page on this machine alone, whose every picture the Python core computes as sliders move."""

from .app import make_app
from .serve import serve

__all__ = ["make_app", "serve"]
