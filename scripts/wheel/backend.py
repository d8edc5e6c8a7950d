"""The build backend: that of setuptools, and wheels with compiled code where ``GLYPHSPLINE_COMPILED`` asks for it.

``GLYPHSPLINE_COMPILED=1`` makes the wheel of a release: compiled here, for every processor of this kind that the
features below stand for. ``GLYPHSPLINE_COMPILED=host`` makes one for this processor, and takes code that is kept in the
checkout: tests have it in seconds.

With ``SOURCE_DATE_EPOCH`` one process compiles, always in the same order: the same sources and libraries, in the same
folders, give the same bytes. The folders count since errors that numba's functions raise name their files.
"""

from __future__ import annotations

import json
import os
import platform
import re
import subprocess
import sys
import time
import tomllib
import zipfile
from base64 import urlsafe_b64encode
from email.parser import HeaderParser
from hashlib import sha256
from importlib.metadata import distribution
from pathlib import Path
from shutil import copytree, rmtree
from tempfile import TemporaryDirectory
from typing import Any

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403  # the hooks that are not below

ASKED = "GLYPHSPLINE_COMPILED"
"""Environment variable: 1 or host; see above. Not set: the pure wheel."""

ROOT = Path(__file__).parents[2]

X86 = ("x86-64-v3", ["avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"])

PROCESSORS: dict[str, tuple[str, list[str]]] = {
    "x86_64": X86,
    "AMD64": X86,
    "arm64": ("apple-m1", []),  # the least of these computers
    "aarch64": ("generic", []),
    "ARM64": ("generic", []),
}
"""By machine, the processor as LLVM calls it, and those of its features that not every such machine has."""


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    """What building takes: compiling runs the package itself."""
    needed = build_meta.get_requires_for_build_wheel(config_settings)
    if not os.environ.get(ASKED):
        return list(needed)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return [*needed, *project["dependencies"]]


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Any = None) -> str:
    """The metadata of the wheel."""
    name: str = build_meta.prepare_metadata_for_build_wheel(metadata_directory, config_settings)
    if os.environ.get(ASKED):
        pin(Path(metadata_directory) / name)
    return name


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> str:
    """The wheel: the pure one, or one made from it."""
    asked = os.environ.get(ASKED)
    if not asked:
        return str(build_meta.build_wheel(wheel_directory, config_settings, metadata_directory))
    tree = ROOT / "build" / "wheel"  # always the same
    for old in (tree, ROOT / "build" / "lib"):
        rmtree(old, ignore_errors=True)
    with TemporaryDirectory(prefix="glyphspline-wheel-") as folder:
        pure = build_meta.build_wheel(folder, config_settings)
        with zipfile.ZipFile(Path(folder) / pure) as archive:
            archive.extractall(tree)
        compile_all(tree, Path(folder) / "code", for_this=asked == "host")
        (metadata,) = tree.glob("*.dist-info")
        pin(metadata)
        tags = numba_tags()
        describe(metadata / "WHEEL", tags)
        parts = zip(*(tag.split("-") for tag in tags), strict=True)
        name = "-".join([*pure.split("-")[:2], *(".".join(sorted(set(part))) for part in parts)]) + ".whl"
        pack(tree, metadata / "RECORD", Path(wheel_directory) / name)
    return name


def compile_all(tree: Path, code: Path, for_this: bool) -> None:
    """Compile the unpacked package, and put into it what Python and C call; their callees' code is part of theirs."""
    environment = os.environ | {
        "NUMBA_CACHE_DIR": str(code),
        "PYTHONPATH": os.pathsep.join(filter(None, [str(tree), os.environ.get("PYTHONPATH")])),
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONHASHSEED": "0",
        "GLYPHSPLINE_QUIET": "1",
    }
    features: list[str] | None = None
    if for_this:
        kept = Path(os.environ.get("NUMBA_CACHE_DIR") or ROOT / "glyphspline" / "__pycache__" / "compiled")
        if kept.is_dir():
            copytree(kept, code)
    else:
        processor, features = PROCESSORS[platform.machine()]
        # Numba adds the features of this machine to those of the named processor unless it is told which to add.
        environment |= {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""}
    script = Path(__file__).with_name("compile_all.py")
    words = [str(tree / "glyphspline" / "_compiled"), json.dumps(features)]
    subprocess.run([sys.executable, str(script), *words], env=environment, cwd=tree, check=True)


def pin(metadata: Path) -> None:
    """Ask for the minor release of numba whose code the wheel holds; another one would compile everything."""
    release = ".".join(distribution("numba").version.split(".")[:2])
    file = metadata / "METADATA"
    text, found = re.subn(
        r"^Requires-Dist: numba\b.*$", f"Requires-Dist: numba=={release}.*", file.read_text("utf-8"), flags=re.MULTILINE
    )
    assert found == 1
    file.write_text(text, encoding="utf-8", newline="\n")


def numba_tags() -> list[str]:
    """The tags of the numba that is installed: a wheel whose only native code is run by numba runs where that does."""
    return HeaderParser().parsestr(distribution("numba").read_text("WHEEL") or "").get_all("Tag", [])


def describe(file: Path, tags: list[str]) -> None:
    """Write the tags into the description of a wheel."""
    lines = [line for line in file.read_text("utf-8").splitlines() if line and not line.startswith(("Tag:", "Root-"))]
    lines += ["Root-Is-Purelib: false", *(f"Tag: {tag}" for tag in tags)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def pack(tree: Path, record: Path, wheel: Path) -> None:
    """Write a wheel in which nothing depends on when or where it was built."""
    date = time.gmtime(max(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), 315532800))[:6]  # 1980, where ZIP begins
    files = sorted(file for file in tree.rglob("*") if file.is_file() and file != record)
    lines = []
    for file in files:
        content = file.read_bytes()
        digest = urlsafe_b64encode(sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{file.relative_to(tree).as_posix()},sha256={digest},{len(content)}\n")
    own = record.relative_to(tree).as_posix()
    record.write_text("".join([*lines, f"{own},,\n"]), encoding="utf-8", newline="\n")
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for file in [*files, record]:
            entry = zipfile.ZipInfo(file.relative_to(tree).as_posix(), date)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o100644 << 16
            archive.writestr(entry, file.read_bytes())
