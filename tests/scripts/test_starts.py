"""Commands end with all that they should have, under load and where processes are killed."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.places import ROOT


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="processes are found in /proc")
def test_starts_end_with_all_files() -> None:
    """A short form of ``make check-starts``."""
    call = [sys.executable, "-m", "scripts.starts", "--starts", "4", "--loaded", "1", "--killed", "3", "--jobs", "2"]
    done = subprocess.run(call, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = [line.strip("| ").split(" | ") for line in done.stdout.splitlines()[2:]]
    assert [(int(number), int(ended), int(whole)) for _, number, _, ended, whole, _ in rows] == [
        (3, 3, 3),
        (0, 0, 0),
        (1, 1, 1),
    ]
