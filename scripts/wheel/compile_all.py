"""Compiles the package that is imported, and copies what it needs of the result to a folder of the package.

Arguments: the folder, and the features that a processor must have, as JSON; null: all of this one.
"""

from __future__ import annotations

import json
import os
import re
import sys
from hashlib import blake2b
from pathlib import Path

import numba
from numba.core.registry import cpu_target

from glyphspline.code_files import PACKAGE, names_in, own_folder
from glyphspline.compiling import used
from glyphspline.runs.small_runs import work
from glyphspline.runs.warm import MARK, compile_kind, warm


def main() -> None:
    """The command."""
    folder, features = Path(sys.argv[1]), json.loads(sys.argv[2])
    assert folder.parent == PACKAGE
    kept = own_folder()
    assert kept
    if "SOURCE_DATE_EPOCH" not in os.environ:  # names in the code count what a process has compiled before
        warm()
    for kind in work():
        compile_kind(kind)
    target = cpu_target.target_context.codegen().magic_tuple()
    if features is None:
        features = [name[1:] for name in target[2].split(",") if name.startswith("+")]
    folder.mkdir()
    for name in sorted(used):
        if ".inner-" not in name:
            (folder / name).write_bytes(without_addresses((kept / name).read_bytes(), name))
    for name in names_in(kept, MARK):
        (folder / name).write_bytes((kept / name).read_bytes())
    made_for = {
        "numba": numba.__version__,
        "python": sys.implementation.cache_tag,
        "target": target,
        "features": features,
    }
    (folder / "made_for.json").write_text(json.dumps(made_for, indent=1), encoding="utf-8")


def without_addresses(content: bytes, name: str) -> bytes:
    """Code in which functions that numba has called after an address in memory are called after their file.

    These, of expressions over arrays, are all that differs between two compilations.
    """
    found = dict.fromkeys(re.findall(rb"(?<=__numba_array_expr_0x)[0-9a-f]+", content))
    for k, address in enumerate(found):
        new = blake2b(f"{name} {k}".encode()).hexdigest()[: len(address)].encode()
        content = content.replace(b"__numba_array_expr_0x" + address, b"__numba_array_expr_0x" + new)
    return content


if __name__ == "__main__":
    main()
