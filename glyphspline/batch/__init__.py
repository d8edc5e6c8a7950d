"""Many glyphs of a font into a folder of files, with workers, and so that an interrupted run goes on."""

from .atlas import make_atlas
from .files import OutputError
from .fonts import find_fonts, folders_for
from .gallery import write_gallery
from .manifest import entries_of
from .run import convert_font
from .spec import Limits, RunSpec
from .summary import Summary

__all__ = [
    "Limits",
    "OutputError",
    "RunSpec",
    "Summary",
    "convert_font",
    "entries_of",
    "find_fonts",
    "folders_for",
    "make_atlas",
    "write_gallery",
]
