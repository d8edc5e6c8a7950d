"""Compiles the package that is imported, and copies what it needs of the result to a folder of the package.

Arguments: the folder, and the features that a processor must have, as JSON; null: all of this one.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from pathlib import Path

import numba
from numba.core.registry import cpu_target

from glyphspline import compiled
from glyphspline.batch.warm import WORK, prepare, warm


def main() -> None:
    """The command."""
    folder, features = Path(sys.argv[1]), json.loads(sys.argv[2])
    assert folder.parent == compiled.PACKAGE
    kept = compiled.own_folder()
    assert kept
    if "SOURCE_DATE_EPOCH" not in os.environ:  # names in the code count what a process has compiled before
        warm()
    for kind in WORK:
        prepare(kind)
    target = cpu_target.target_context.codegen().magic_tuple()
    if features is None:
        features = [name[1:] for name in target[2].split(",") if name.startswith("+")]
    folder.mkdir()
    for name in sorted(compiled.used):
        if ".inner-" not in name:
            shutil.copyfile(kept / name, folder / name)
    made_for = {
        "numba": numba.__version__,
        "python": sys.implementation.cache_tag,
        "target": target,
        "features": features,
    }
    (folder / "made_for.json").write_text(json.dumps(made_for, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
