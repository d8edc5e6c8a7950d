"""The pages of docs/: every public name is in them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import glyphspline as gs
from scripts.house import NEEDS
from tests.places import ROOT

DOCS = ROOT / "docs"
PAGES = sorted({*ROOT.glob("*.md"), *DOCS.glob("*.md"), ROOT / "outputs" / "paper" / "README.md"})


def test_every_public_name_has_its_place_in_the_pages() -> None:
    listed = re.findall(r"^\.\. auto\w+:: (\w+)$", (DOCS / "api.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(listed) == sorted(set(gs.__all__) - {"__version__"})


@pytest.mark.parametrize("name", NEEDS)
def test_every_plugin_has_a_line_in_the_table_of_rooms(name: str) -> None:
    page = (DOCS / "inside.md").read_text(encoding="utf-8")
    rows = re.findall(rf"^\| `plugins/{name}/` \| (.+) \|$", page, re.MULTILINE)
    assert len(rows) == 1


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", page.read_text(encoding="utf-8")):
        if not re.match(r"\w+:", target):
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_files_named_in_pages_exist(page: Path) -> None:
    """Paths start at the root of the project or anywhere in the package: ``pool.py``."""
    package = [path.as_posix() for path in (ROOT / "glyphspline").rglob("*")]
    for name in re.findall(r"`((?:\w+/)*\w+\.py)`", page.read_text(encoding="utf-8")):
        assert (ROOT / name).exists() or any(path.endswith(f"/{name}") for path in package), name
