"""``python -m scripts.benchmark [suite …]``: measure, print each suite's table, write it down."""

from __future__ import annotations

import argparse
import os
from importlib import import_module
from pathlib import Path

OWN = ("core", "startup", "plain", "faithful", "fonts", "rings", "batch", "check", "text", "dataset", "viewer")
SUITES = {name: f"{name}.rows" for name in OWN}
SUITES |= {"formats": "batch.formats", "dataset_runs": "dataset.runs"}


def main() -> None:
    """Run the suites named, or all of them."""
    # One thread for the libraries' linear algebra: with more, small systems mostly measure the waiting for each other.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from .measure import markdown, write

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("suite", nargs="*", help=f"one of {', '.join(SUITES)}; all of them if none is named")
    for suite in parser.parse_args().suite or SUITES:
        module, function = SUITES[suite].split(".")
        rows = getattr(import_module(f".{module}", __package__), function)()
        print(markdown(rows), flush=True)
        write(suite, rows, Path(__file__).parents[2])


if __name__ == "__main__":
    main()
