"""Pages that stand alone: a template, styles and scripts of this package, and data."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from hashlib import sha256
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

from ..writers.svg.document import text
from .data import as_json


def page_of(
    template: str,
    styles: Sequence[str],
    heading: str,
    scripts: Sequence[str] = (),
    setup: Any = None,
    *,
    loads: bool = False,
    pictures: bool = False,
    facts: Sequence[str] = (),
    own: Sequence[Path] = (),
    **parts: str,
) -> str:
    """A page as HTML. Nothing runs in it but its scripts, by their hash.

    Args:
        template: file with the page's body. styles, scripts: files, in the order of their dependencies.
            All are of this package, or in ``own`` folders of plug-ins.
        heading: title of the page, as text. setup: data that the scripts read from the element ``setup``.
        loads: whether it loads scripts and drawings that lie beside it. pictures: whether it has some in itself.
        facts: sentences of the template, as text.
        parts: what else it has, as HTML.
    """
    script = "".join(package_text(name, own) for name in scripts)
    beside = ["'self'", "file:"] * loads
    allowed: dict[str, list[str]] = {
        "script-src": [],
        "style-src": ["'unsafe-inline'"],
        "img-src": [*beside, *["data:"] * pictures],
    }
    run = ""
    if script:
        digest = b64encode(sha256(("\n" + script).encode()).digest()).decode()
        allowed["script-src"] = [*beside, f"'sha256-{digest}'"]
        run = f'<script type="application/json" id="setup">{as_json(setup)}</script>\n<script>\n{script}</script>\n'
    return Template(package_text("page.html")).substitute(
        policy="".join(f" {what} {' '.join(sources)};" for what, sources in allowed.items() if sources),
        heading=text(heading), style="".join(package_text(name, own) for name in styles),
        body=Template(package_text(template, own)).substitute(
            heading=text(heading), facts="".join([f"<p>{text(line)}</p>" for line in facts]), **parts
        ),
        scripts=run,
    )  # fmt: skip


def kind_switches(kinds: Iterable[tuple[int, str, str]], counts: Mapping[str, int]) -> str:
    """A switch for each kind of finding as HTML, from its number in the page's data, its name and its class."""
    return "".join(
        f'<label{of_class}><input type="checkbox" data-kind="{number}" checked><i></i>{text(name)} '
        f"<span>{counts[name]}</span></label>"
        for number, name, of_class in kinds
    )


def package_text(name: str, own: Sequence[Path] = ()) -> str:
    """A text file in one of the folders, or else of this package."""
    found = next((folder / name for folder in own if (folder / name).exists()), files(__package__).joinpath(name))
    return found.read_text(encoding="utf-8")
