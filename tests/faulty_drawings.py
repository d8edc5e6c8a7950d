"""Folders of SVG drawings with a fault of known size each, as small fonts."""

from __future__ import annotations

from collections.abc import Mapping
from math import radians, tan
from pathlib import Path

JOINT = "M500 500C{x} {y} 800 700 900 800L200 800C300 600 400 500 500 500Z"
"""Arrives at (500, 500) to the right; all other joints are corners."""


def turning(angle: float, length: float = 100.0) -> str:
    """A drawing whose joint at (500, -500) turns by so many degrees; without a turn its curvature jumps."""
    return JOINT.format(x=500 + length, y=500 + length * tan(radians(angle)))


def drawings(folder: Path, paths: Mapping[str, str]) -> Path:
    """A folder of drawings, by the names of the glyphs."""
    folder.mkdir(exist_ok=True, parents=True)
    for name, path in paths.items():
        (folder / f"{name}.svg").write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000"><path d="{path}"/></svg>'
        )
    return folder
