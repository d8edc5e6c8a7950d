"""The gallery of a finished run."""

from .gallery import write_index, write_report

__all__ = ["write_index", "write_report"]
