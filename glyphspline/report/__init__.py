"""The gallery of a finished run: written from its manifest and the drawings beside it, and nothing else."""

from .gallery import write_index, write_report

__all__ = ["write_index", "write_report"]
