"""The pages of docs/: every public name is in them."""

from __future__ import annotations

import re
from pathlib import Path

import glyphspline as gs

DOCS = Path(__file__).parent.parent / "docs"


def test_every_public_name_has_its_place_in_the_pages() -> None:
    listed = re.findall(r"^\.\. auto\w+:: (\w+)$", (DOCS / "api.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(listed) == sorted(set(gs.__all__) - {"__version__"})
