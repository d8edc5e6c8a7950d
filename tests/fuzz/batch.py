"""Damaged fonts through the batch script: ``python -m tests.fuzz.batch --mutants 300 --seed 1 --step 40``.

Says what became of them, and ends with 1 if a promise was broken: exit status 0 or 1, no traceback, files as the
manifests have them, nothing written elsewhere or left behind, no hang. Runs for hours with ``--rounds``.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from tests.places import ROOT

from .mutants import mutant

PATIENCE = 20.0
"""Seconds that a font may take on average before it counts as a hang."""


def round_of(mutants: int, seed: int, options: list[str]) -> tuple[Counter[str], list[str]]:
    """Make and convert so many damaged fonts: what became of their glyphs, and the promises broken."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        (here / "fonts").mkdir()
        rng = random.Random(seed)
        for k in range(mutants):
            name, data = mutant(rng)
            (here / "fonts" / f"{k:04d}-{name}").write_bytes(data)
        call = [sys.executable, "scripts/batch_convert.py", str(here / "fonts"), "--out", str(here / "out")]
        started = time.monotonic()
        try:
            done = subprocess.run(
                [*call, *options], cwd=ROOT, capture_output=True, text=True, timeout=60 + PATIENCE * mutants
            )
        except subprocess.TimeoutExpired:
            return Counter(), [f"seed {seed}: a hang"]
        return judge(here, done, mutants, time.monotonic() - started)


def judge(
    here: Path, done: subprocess.CompletedProcess[str], mutants: int, seconds: float
) -> tuple[Counter[str], list[str]]:
    """What became of a round, and the promises broken."""
    broken = []
    if done.returncode not in (0, 1):
        broken.append(f"exit status {done.returncode}: {done.stderr[-500:]}")
    if "Traceback" in done.stderr or "Error:" in done.stdout:
        broken.append(done.stderr[-2000:])
    if {path.name for path in here.iterdir()} != {"fonts", "out"}:
        broken.append(f"written elsewhere: {[path.name for path in here.iterdir()]}")
    outcome: Counter[str] = Counter(seconds=round(seconds))
    manifests = list(here.glob("out/**/manifest.jsonl"))
    for manifest in manifests:
        entries = [json.loads(line) for line in manifest.read_text().splitlines()]
        outcome.update(entry["status"] for entry in entries)
        missing = [
            path for entry in entries for path in entry["files"].values() if not (manifest.parent / path).is_file()
        ]
        broken += [f"{manifest}: no {path}" for path in missing]
    outcome["fonts"], outcome["readable"] = mutants, len({path.relative_to(here).parts[1] for path in manifests})
    broken += [f"left behind: {path}" for path in here.glob("out/**/*.part")]
    return outcome, broken


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mutants", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--rounds", type=int, default=1)
    arguments, options = parser.parse_known_args()
    failures = 0
    for seed in range(arguments.seed, arguments.seed + arguments.rounds):
        outcome, broken = round_of(arguments.mutants, seed, options)
        print(f"seed {seed}: {dict(outcome)}", *broken, sep="\n  ", flush=True)  # noqa: T201
        failures += len(broken)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
