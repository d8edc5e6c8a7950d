"""``python -m scripts.benchmark [suite …]``: measure, print each suite's table, write it down."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from pathlib import Path

SUITES = ("core", "startup", "faithful", "batch", "check", "formats", "text", "dataset", "dataset_runs", "viewer")


def main() -> None:
    """Run the suites named, or all of them."""
    # One thread for the libraries' linear algebra: with more, small systems mostly measure the waiting for each other.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from .table import markdown, write

    for suite in sys.argv[1:] or SUITES:
        rows = import_module(f".{suite}", __package__).rows()
        print(markdown(rows), flush=True)
        write(suite, rows, Path(__file__).parents[2])


if __name__ == "__main__":
    main()
