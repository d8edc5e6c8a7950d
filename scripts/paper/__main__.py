"""Reproduce the paper: ``python -m scripts.paper [--quick] [--only fig3,theorems] [--out outputs/paper]``."""

from __future__ import annotations

import argparse
from pathlib import Path

from .common import Run
from .steps import STEPS, reproduce


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m scripts.paper", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a small version of everything, in less than a minute")
    parser.add_argument("--only", type=lambda s: s.split(","), help=f"some of: {', '.join(STEPS)}")
    parser.add_argument("--out", type=Path, help="outputs/paper; of some steps, a folder of their own beside it")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--xingkai", type=Path, help="a font file for 'Dragon', Fig. 8")
    parser.add_argument("--lishu", type=Path, help="a font file for 'Good', Fig. 9")
    options = parser.parse_args()
    unknown = set(options.only or ()) - set(STEPS)
    if unknown:
        parser.error(f"unknown: {', '.join(sorted(unknown))}")
    given = {"fig-8": options.xingkai, "fig-9": options.lishu}
    out = options.out or Path("-".join(["outputs/paper", *(options.only or ())]))
    reproduce(Run(out, options.quick, {k: f for k, f in given.items() if f}), options.only, options.jobs)


if __name__ == "__main__":
    main()
