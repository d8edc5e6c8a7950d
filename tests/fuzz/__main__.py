"""Damaged fonts, UFOs and drawings through info, convert, refit, check, diff and text: ``make fuzz MINUTES=10``.

``python -m tests.fuzz [--minutes 10] [--commands N] [--seed 0] [--out outputs/fuzz]``

``mutants.py`` has the sources and the damage. Each command runs in a process of its own, forked from this
one, with limits of processor time and memory. A mutant with which lines of the package or of fontTools run that ran
with none before is damaged further. A seed gives the same mutants, as long as no limit of time is reached.

Faults are a traceback, or a glyph that failed by an unexpected error; death by a signal; a limit that is reached; a
status other than 0, 1 and 2; numbers that are none in a drawing; files outside the folder, or left among temporary
ones; and another drawing of a glyph than the sound source gives, where only another glyph's data are damaged. At the
end the last fonts go through worker processes together.

The first fault of each kind is printed, reduced to the fewest edits and written to ``faults.json`` in the output
folder. Those that ``found.json`` keeps are tried first. The exit status is 1 if there are any.

Atheris does not serve here: Numba does not compile what it instruments, and it does not see into HarfBuzz.
"""

from __future__ import annotations

import contextlib
import json
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter, deque
from collections.abc import Iterable, Iterator
from functools import cache
from io import BytesIO
from math import inf
from pathlib import Path
from typing import Any

from fontTools.ttLib import TTFont

from scripts.survey import parser

from .enclosed import Lines, Outcome, ran, warm
from .mutants import Edit, Files, Mutant, edits_of, given, made, mutant, reduced, sources

CALLS = {
    "read": "info FONT --deep --json",
    "smooth": "convert FONT --all --step 60 --format svg,json -o out",
    "fitted": "convert FONT --all --format svg,curvature,gallery -o out",
    "sharp": "convert FONT --all --preset type --format svg,dxf -o out",
    "font": "refit FONT --format ttf,otf,ufo -o out",
    "masters": "refit FONT --masters --continuity c2 --format MASTERS -o out",
    "check": "check FONT --json --html page.html --loglevel info",
    "diff": "diff FONT SOUND --json --html page.html",
    "text": "text FONT ABCagZ龍好 --corners sharp --out text.svg",
}
"""Commands; what is in capitals is replaced. Where they start workers, this process does the work."""

MASTERS = {"variable.ttf": "ttf,otf,gallery", "variable-cff2.otf": "otf,ttf,gallery", "space": "ufo"}
"""Sources that have several, and formats for them."""

WRITTEN = {"out", "page.html", "text.svg"}
FOUND = Path(__file__).with_name("found.json")

EXPECTED = re.compile(r"(cannot be drawn|cannot be read|a broken \w+|fontTools): .*")
UNEXPECTED = re.compile(r"(Traceback|\b[A-Z]\w*(Error|Exception|Warning|Interrupt)\b).*", re.DOTALL)

# Judging


def attempt(name: str, found: Mutant, way: str, known: Lines | None = None) -> tuple[list[str], Outcome]:
    """Run a command on a damaged source: the faults, and what came of it."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        here = Path(folder) / "here"
        put(here, found.files)
        put(here / "sound", sources()[name])
        outcome = ran(call_of(name, way, "sound/"), here, known or Lines())
        faults = [f"ended by {signal.Signals(-outcome.status).name}"] if outcome.status < 0 else []
        faults += [f"status {outcome.status}"] if outcome.status > 2 and "Traceback" not in outcome.errors else []
        mine = {path.partition("/")[0] for path in found.files} | WRITTEN | {"sound"}
        faults += [f"written elsewhere: {path.name}" for path in here.iterdir() if path.name not in mine]
        faults += [f"left: {path.suffix}" for path in (*here.rglob("*.part"), *here.with_name("logs").glob("tmp/*"))]
        entries = manifest(here / "out")
        for text in [outcome.errors, *(entry["error"] or "" for entry in entries)]:
            if unexpected := UNEXPECTED.search(EXPECTED.sub("", text)):
                faults.append(
                    unexpected[0].strip()[-1500:] if unexpected[1] == "Traceback" else unexpected[0].partition("\n")[0]
                )
        drawings = {
            entry["glyph"]: here / "out" / entry["files"]["svg"] for entry in entries if "svg" in entry["files"]
        }
        texts = {glyph: path.read_text() for glyph, path in drawings.items()}
        if any(re.search(r"[\s,\"(-](nan|inf)[\s,\")]", text) for text in texts.values()):
            faults.append("a drawing with numbers that are none")
        if found.alone and not faults and way in ("smooth", "fitted", "sharp"):
            others = {
                glyph: text for glyph, text in sound(name, way).items() if glyph not in touched(name, found.alone)
            }
            faults += [f"another glyph is not the same: {g!r}" for g, text in others.items() if texts.get(g) != text][
                :1
            ]
        if name in sources() and found.files is sources()[name]:
            sound_texts[name, way] = texts
    return faults, outcome


sound_texts: dict[tuple[str, str], dict[str, str]] = {}


def sound(name: str, way: str) -> dict[str, str]:
    """The drawings of a source that is not damaged."""
    if (name, way) not in sound_texts:
        attempt(name, Mutant(sources()[name], ""), way)
    return sound_texts[name, way]


def call_of(name: str, way: str, folder: str = "") -> list[str]:
    """The words of a command; the sound source is in a folder."""
    path = given(sources()[name])
    words = {"FONT": path, "SOUND": folder + path, "MASTERS": MASTERS.get(name, "ttf")}
    return [words.get(word, word) for word in CALLS[way].split()]


def put(folder: Path, files: Files) -> None:
    """Write a source into a folder."""
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)


def manifest(out: Path) -> list[dict[str, Any]]:
    """The entries of a run's glyphs."""
    path = out / "manifest.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


@cache
def touched(name: str, glyph: str) -> set[str]:
    """The glyphs that show a glyph's data: itself, and those of which it is a part."""
    found, parts = {glyph}, {"B": {"A"}} if name == "Small.ufo" else {}
    if name.endswith(".ttf"):
        glyf = TTFont(BytesIO(sources()[name][name]))["glyf"]
        parts = {g: set(glyf[g].getComponentNames(glyf)) for g in glyf}
    for _ in parts:
        found |= {g for g, its in parts.items() if its & found}
    return found


def kind_of(fault: str) -> str:
    """A fault without what differs from mutant to mutant."""
    frames = re.findall(r'File "[^"]*?(\w+)\.py", line \d+, in (\w+)', fault)
    last = re.sub(r"'[^']*'|[-\d.]+|0x\w+", "", fault.strip().splitlines()[-1])[:120]
    return f"{'.'.join(frames[-1])}: {last}" if frames else last


def together(fonts: Iterable[Mutant]) -> list[str]:
    """Convert damaged fonts with two worker processes: the faults."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        here = Path(folder)
        for k, found in enumerate(fonts):
            put(here / "fonts", {f"{k:03d}-{path}": data for path, data in found.files.items()})
        call = ["convert", "fonts", "--step", "60", "--format", "svg", "--jobs", "2", "--quiet", "-o", "out"]
        done = subprocess.run([sys.executable, "-m", "glyphspline", *call], cwd=here, capture_output=True, text=True)
        faults = [f"status {done.returncode}: {done.stderr[-1000:]}"] if done.returncode not in (0, 1) else []
        faults += [done.stderr[-2000:]] if "Traceback" in done.stderr else []
        faults += [f"written elsewhere: {path.name}" for path in here.iterdir() if path.name not in ("fonts", "out")]
        faults += [f"left: {path}" for path in here.glob("out/**/*.part")]
        for path in here.glob("out/**/manifest.jsonl"):
            files = [file for entry in manifest(path.parent) for file in entry["files"].values()]
            faults += [f"{path.parent.name} has no {file}" for file in files if not (path.parent / file).is_file()]
        return faults


def recipe(name: str, found: Mutant, way: str, fault: str) -> dict[str, Any]:
    """What makes a fault again: a source, the fewest edits, and the command."""

    def still(edits: list[Edit]) -> bool:
        faults, _ = attempt(name, found._replace(files=made(name, edits)), way)
        return kind_of(fault) in map(kind_of, faults)

    edits = reduced(edits_of(name, found.files), still)
    return {"source": name, "command": way, "edits": edits, "alone": found.alone, "fault": fault}


# The loop


def tried(seed: int, commands: float, end: float) -> Iterator[tuple[str, Mutant, str, list[str]]]:
    """Try the kept recipes; then damage sources, and mutants with which new lines ran, and try them until a time."""
    for kept in json.loads(FOUND.read_text()):
        name, way, found = kept["source"], kept["command"], Mutant(made(kept["source"], kept["edits"]), kept["alone"])
        yield name, found, way, attempt(name, found, way)[0]
    known, corpus, number, done = Lines(), list(sources().items()), 0, 0
    plain = len(corpus)
    while time.monotonic() < end and done < commands:
        rng, number = random.Random(f"{seed} {number}"), number + 1
        name, files = corpus[rng.randrange(plain if rng.random() < 0.5 else len(corpus))]
        found = mutant(rng, files)
        if files is not sources()[name]:
            found = found._replace(alone=None)  # others may differ too
        before = len(known)
        for way in rng.sample([way for way in CALLS if way != "masters" or name in MASTERS], 3):
            faults, outcome = attempt(name, found, way, known)
            known |= outcome.lines
            done += 1
            yield name, found, way, faults
        if len(known) > before:
            corpus.append((name, found.files))


def main() -> int:
    """Try for so long; print and keep what is found."""
    arguments = parser(__doc__, minutes=10.0, commands=inf, seed=0, out=Path("outputs/fuzz")).parse_args()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for name in ("edge-cases.ttf", "variable-cff2.otf", "space", "drawings"):
            put(Path(), sources()[name])
            warm([[f"{way}-{name}" if word == "out" else word for word in call_of(name, way)] for way in CALLS])
    seen, kept, fonts, number = Counter[str](), list[dict[str, Any]](), deque[Mutant](maxlen=60), 0
    end = time.monotonic() + 60 * arguments.minutes
    for name, found, way, faults in tried(arguments.seed, arguments.commands, end):
        number += 1
        fonts += [found] if len(found.files) == 1 and found not in fonts else []
        for fault in faults:
            seen[kind_of(fault)] += 1
            if seen[kind_of(fault)] == 1:
                print(f"{number}: {name} {way}: {fault}", flush=True)
                kept.append(recipe(name, found, way, fault))
                arguments.out.mkdir(parents=True, exist_ok=True)
                (arguments.out / "faults.json").write_text(json.dumps(kept, indent=1))
    broken = together(fonts)
    for line in [*broken, *(f"{count} times: {kind}" for kind, count in seen.most_common())]:
        print(line)
    print(f"{number} commands, {len(seen) + len(broken)} kinds of faults")
    return int(bool(seen or broken))


if __name__ == "__main__":
    sys.exit(main())
