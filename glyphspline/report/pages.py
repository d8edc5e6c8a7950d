"""Pages that stand alone: a template, styles and scripts of this package, and data."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from hashlib import sha256
from importlib.resources import files
from string import Template
from typing import Any

from ..writers.svg.colours import SIDES, class_colour
from ..writers.svg.markup import text
from .data import as_json


def page_of(
    template: str, styles: Sequence[str], scripts: Sequence[str], setup: Any, heading: str, **parts: str
) -> str:
    """A page as HTML. Nothing runs in it but its scripts, by their hash.

    Args:
        template, styles, scripts: files of this package, in the order of their dependencies.
        setup: data that the scripts read from the element ``setup``.
        heading: title of the page, as text. parts: what else the template has, as HTML.
    """
    script = "".join(package_text(name) for name in scripts)
    return Template(package_text(template)).substitute(
        heading=text(heading), style="".join(package_text(name) for name in styles), setup=as_json(setup),
        script=script, digest=b64encode(sha256(("\n" + script).encode()).digest()).decode(), **parts,
    )  # fmt: skip


def palette() -> list[str]:
    """The colours of curvature, from the most concave ink to the most convex."""
    return [class_colour(index) for index in range(-SIDES, SIDES + 1)]


def package_text(name: str) -> str:
    """A text file of this package."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")
