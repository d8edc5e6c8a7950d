"""Power cuts: ``python -m tests.fuzz.power_cut FONT --gids 10000-19999 --step 20 --format svg`` (Linux, as root).

A run writes to an ext4 of its own, in a file, which at some moment forgets all that it has not stored: the kernel's
request for just that purpose. Then the same command is given again. Ends with 1 if the folder is not the same, to the
byte, as that of a run that nobody disturbed.
"""

from __future__ import annotations

import argparse
import fcntl
import filecmp
import os
import random
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

EXT4_IOC_SHUTDOWN = 0x8004587D
WITHOUT_LOG = struct.pack("I", 2)

CONVERT = [sys.executable, "-m", "glyphspline", "convert", "--quiet"]


@contextmanager
def mounted(disk: Path, at: Path) -> Iterator[None]:
    """The file system in a file, mounted."""
    subprocess.run(["mount", "-o", "loop,commit=1", disk, at], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", at], check=True)


def cut_off(folder: Path) -> None:
    """Have the file system of a folder forget what it has not stored; every later call on it fails."""
    handle = os.open(folder, os.O_RDONLY)
    fcntl.ioctl(handle, EXT4_IOC_SHUTDOWN, WITHOUT_LOG)
    os.close(handle)


def same(a: Path, b: Path) -> bool:
    """Whether two folders have the same files with the same bytes."""
    names = [{path.relative_to(folder) for path in folder.rglob("*") if path.is_file()} for folder in (a, b)]
    return names[0] == names[1] and all(filecmp.cmp(a / name, b / name, shallow=False) for name in names[0])


def one_cut(options: list[str], whole: Path, here: Path, after: float, storing_for: float) -> bool:
    """A run cut off after so many seconds, in the midst of storing, and gone on with: whether it ends as it should."""
    disk, at = here / "disk", here / "mounted"
    at.mkdir(exist_ok=True)
    disk.unlink(missing_ok=True)
    with open(disk, "wb") as file:
        file.truncate(4 << 30)
    subprocess.run(["mkfs.ext4", "-q", "-F", disk], check=True)
    with mounted(disk, at):
        run = subprocess.Popen([*CONVERT, *options, "--out", at / "run"], stderr=subprocess.DEVNULL)
        time.sleep(after)
        storing = subprocess.Popen(["sync", "-f", at], stderr=subprocess.DEVNULL)
        time.sleep(storing_for)
        cut_off(at)
        storing.wait()
        status = run.wait()
    with mounted(disk, at):
        left = [path.stat().st_size for path in (at / "run").rglob("*") if path.is_file()]
        again = subprocess.run([*CONVERT, *options, "--out", at / "run"], stderr=subprocess.DEVNULL).returncode
        good = again == 0 and same(whole, at / "run")
    what = f"after {after:.1f} s, {storing_for:.1f} of them storing: status {status}"
    sys.stdout.write(f"{what}, {len(left)} files left, {left.count(0)} empty; same: {good}\n")
    return good


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cuts", type=int, default=5)
    parser.add_argument("--last", type=float, default=1.6, help="the latest moment, in times of a whole run")
    parser.add_argument("--storing", type=float, default=0.6, help="seconds for which half of the cuts wait in storing")
    parser.add_argument("--seed", type=int, default=0)
    arguments, options = parser.parse_known_args()
    rng = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        started = time.monotonic()
        subprocess.run([*CONVERT, *options, "--out", here / "whole"], check=True)
        seconds = time.monotonic() - started
        moments = [
            (rng.uniform(0.2, arguments.last) * seconds, rng.choice([0.0, rng.uniform(0, arguments.storing)]))
            for _ in range(arguments.cuts)
        ]
        outcome = [one_cut(options, here / "whole", here, *moment) for moment in moments]
    return 0 if all(outcome) else 1


if __name__ == "__main__":
    sys.exit(main())
