"""Prints the oldest versions that pyproject.toml allows, as constraints: ``pip install -c FILE``."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

TOOLS = ("bench", "browser", "dev", "docs", "test", "test-all")
"""Extras for the work on the package, which no user installs: any version does."""


def main() -> None:
    """The command."""
    project = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    of_extras = [entry for name in extras if name not in TOOLS for entry in extras[name]]
    for entry in [*project["dependencies"], *of_extras]:
        if found := re.fullmatch(r"([\w-]+)>=([\d.]+)(?:,<[\d.]+)?", entry):
            print(f"{found[1]}=={found[2]}")


if __name__ == "__main__":
    main()
