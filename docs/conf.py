"""Sphinx's settings for the pages of ``docs/``: ``make docs`` builds them."""

import re
from typing import Any

from sphinx.application import Sphinx

from glyphspline import __version__

project = "glyphspline"
author = "The glyphspline authors"
release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
html_theme = "furo"
html_title = f"glyphspline {release}"
exclude_patterns = ["_build"]

myst_heading_anchors = 3
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_type_aliases = {name: name for name in ("ArrayLike", "BoolArray", "FloatArray", "IntArray")}
autodoc_default_options = {"members": True, "undoc-members": False}
napoleon_use_ivar = True

# What is written in other people's pages is theirs to keep; ours are checked by ``-W``.
linkcheck_ignore = [r"https?://"]


def plain_aliases(*event: Any) -> tuple[str | None, str | None]:
    """A signature with the names of aliases as they are: in unions Sphinx writes how it refers to them."""
    signature, result = (part and re.sub(r"TypeAliasForwardRef\('(\w+)'\)", r"\1", part) for part in event[-2:])
    return signature, result


def setup(app: Sphinx) -> None:
    """Sphinx calls this once."""
    app.connect("autodoc-process-signature", plain_aliases)
