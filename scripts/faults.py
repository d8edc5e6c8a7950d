"""Faults planted in the package, and which of them its tests find: ``python -m scripts.faults``.

``[--count 40] [--seed 0] [--jobs 2] [--selection "not long"] [--seconds 1200]``

A fault is an operator, a sign, a comparison, a bound or a constant that is another one, in the body of a function; the
seed draws them, room after room. Each is planted in a copy of the repository. What depends on it is compiled there, and
the tests of its room run: first those of the selection, as pytest's ``-m`` takes it, until one fails; where none does,
those that the selection leaves out. So one run compares the selection with all tests. The compiler finds a fault too if
it refuses it, and so does a time limit. Tests that fail without a fault end the program. Nothing but the copy changes.

The exit status is 1 if the selection finds more than one fault less than all tests do.
"""

from __future__ import annotations

import ast
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from glyphspline.code_files import PLACE, places

from .survey import ROOT, parser, table

TESTS = """
arrays         tests/fitting/test_options.py tests/outlines
cli            tests/cli
code_files     tests/test_compiled_code.py
compiled       tests/test_compiled_code.py
compiling      tests/test_compiled_code.py
curves         tests/curves
errors         tests/test_errors.py
extras         tests/test_extras.py
fields         tests/fitting/test_options.py
files          tests/runs/test_batch.py
fitting        tests/fitting
hooks          tests/test_plugins.py
interpolation  tests/interpolation tests/test_compiled.py
outlines       tests/outlines
readers        tests/readers
report         tests/report
runs           tests/runs
writers        tests/writers
"""
"""The tests of each room of the pipeline; those of a plug-in stand in a folder of its name."""

OTHERS: dict[type[ast.AST], tuple[str, str]] = {
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "*"),
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
    ast.USub: ("-", ""),
    ast.Not: ("not", ""),
}
"""What stands for an operator, and what is put in its place."""

LEFT_OUT = (ast.Raise, ast.Assert, ast.JoinedStr, ast.FormattedValue)
"""What is said in errors, and places in texts, which Python 3.11 does not know."""


class Fault(NamedTuple):
    """Some bytes of a file of the package that others take the place of."""

    file: str
    line: int
    start: int
    stop: int
    before: str
    after: str

    def planted(self, text: bytes) -> bytes:
        """The file with the fault."""
        assert text[self.start : self.stop] == self.before.encode()
        return text[: self.start] + self.after.encode() + text[self.stop :]


class Text:
    """A file of Python, with the places of its nodes."""

    def __init__(self, file: str, text: bytes) -> None:
        self.file, self.text, self.tree = file, text, ast.parse(text)
        self.lines = [0]
        for line in text.splitlines(keepends=True):
            self.lines.append(self.lines[-1] + len(line))

    def span(self, node: ast.expr) -> tuple[int, int]:
        """Where a node begins and ends."""
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return self.lines[node.lineno - 1] + node.col_offset, self.lines[node.end_lineno - 1] + node.end_col_offset

    def fault(self, start: int, before: str, after: str) -> Fault:
        """A fault at a place."""
        line = self.text.count(b"\n", 0, start) + 1
        return Fault(self.file, line, start, start + len(before), before, after)

    def operator(self, kind: ast.AST, start: int, stop: int) -> Iterator[Fault]:
        """Another operator in the place of the one between two operands."""
        if pair := OTHERS.get(type(kind)):
            yield self.fault(self.text.index(pair[0].encode(), start, stop), *pair)

    def faults(self) -> Iterator[Fault]:
        """All faults that can be planted in bodies of functions."""
        for node in ast.walk(self.tree):
            if isinstance(node, ast.FunctionDef) and not is_called_by_others_only(node):
                for statement in node.body:
                    yield from self.within(statement)

    def within(self, node: ast.AST) -> Iterator[Fault]:
        """Faults in a node, but not in functions inside it, which are found by themselves, nor in types."""
        if isinstance(node, (*LEFT_OUT, ast.FunctionDef, ast.ClassDef)):
            return
        yield from self.at(node)
        for name, part in ast.iter_fields(node):
            if name not in ("annotation", "returns"):
                for child in part if isinstance(part, list) else [part]:
                    if isinstance(child, ast.AST):
                        yield from self.within(child)

    def at(self, node: ast.AST) -> Iterator[Fault]:
        """Faults of a node itself."""
        match node:
            case ast.Compare():
                operands = [node.left, *node.comparators]
                for kind, one, other in zip(node.ops, operands, operands[1:], strict=False):
                    yield from self.operator(kind, self.span(one)[1], self.span(other)[0])
            case ast.BinOp():
                yield from self.operator(node.op, self.span(node.left)[1], self.span(node.right)[0])
            case ast.BoolOp():
                yield from self.operator(node.op, self.span(node.values[0])[1], self.span(node.values[1])[0])
            case ast.UnaryOp():
                yield from self.operator(node.op, self.span(node)[0], self.span(node.operand)[0])
            case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                start, stop = self.span(node)
                changed = value + 1 if isinstance(value, int) else 2 * value or 1.0
                yield self.fault(start, self.text[start:stop].decode(), repr(changed))


def is_called_by_others_only(function: ast.FunctionDef) -> bool:
    """Whether it is for those who look at an object, or at its type."""
    decorators = " ".join(map(ast.unparse, function.decorator_list))
    return function.name in ("__repr__", "__str__") or "overload" in decorators


def rooms() -> dict[str, list[str]]:
    """The tests of each room; that of a plug-in is "plugins.NAME"."""
    found = {words[0]: words[1:] for words in map(str.split, TESTS.strip().splitlines())}
    for place in sorted((ROOT / "tests" / "plugins").glob("*/__init__.py")):
        found[f"plugins.{place.parent.name}"] = [place.parent.relative_to(ROOT).as_posix()]
    return found


@cache
def faults_of(room: str) -> list[Fault]:
    """All faults that can be planted in a room."""
    place = ROOT / "glyphspline" / room.replace(".", "/")
    files = sorted(place.rglob("*.py")) if place.is_dir() else [place.with_suffix(".py")]
    texts = (Text(file.relative_to(ROOT).as_posix(), file.read_bytes()) for file in files)
    return [fault for text in texts for fault in text.faults()]


def drawn(count: int, seed: int) -> list[tuple[str, Fault]]:
    """So many faults with their rooms, which take turns."""
    rng = random.Random(seed)
    order = [*rooms()]
    rng.shuffle(order)
    return [(room, rng.choice(faults_of(room))) for room in (order[k % len(order)] for k in range(count))]


class Copy:
    """A copy of the repository, with compiled code of its own, and its tests.

    Attributes:
        tree: its folder. jobs: tests and compilations at a time. seconds: of a run of tests, at most.
    """

    def __init__(self, place: Path, jobs: int, seconds: float) -> None:
        self.tree, self.code, self.jobs, self.seconds = place / "tree", place / "code", jobs, seconds
        self.edits = 0
        named = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        for name in filter(None, named.split("\0")):
            if (ROOT / name).is_file():
                (self.tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, self.tree / name)
        self.code.mkdir()
        for folder in places():
            for file in folder.glob("*.nbc"):
                shutil.copy(file, self.code)

    def run(self, *words: str) -> tuple[int | None, str]:
        """A module's exit status, None after too many seconds, and what it says."""
        environment = os.environ | {"PYTHONPATH": str(self.tree), PLACE: str(self.code)}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)  # pytest takes longer to rewrite its files than to run them
        process = subprocess.Popen(
            [sys.executable, "-m", *words], cwd=self.tree, env=environment, start_new_session=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
        )  # fmt: skip
        try:
            said, _ = process.communicate(timeout=self.seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return None, ""
        return process.returncode, said

    def tests(self, names: tuple[str, ...], selection: str) -> str:
        """What finds a fault among tests, or nothing."""
        parallel = ["-n", str(self.jobs)] if self.jobs > 1 else ["-p", "no:xdist"]
        status, said = self.run("pytest", "-x", "-p", "no:cacheprovider", *parallel, "-m", selection, *names)
        if status in (0, 5):  # 5: no test is selected
            return ""
        failed = re.findall(r"^(?:FAILED|ERROR) (.+?)(?: - |$)", said, re.MULTILINE)
        return "the time limit" if status is None else failed[0] if failed else said.strip()[-200:]

    def write(self, file: Path, text: bytes) -> None:
        """Write a file, dated otherwise than any before: Python knows by dates, in whole seconds, what it has read."""
        file.write_bytes(text)
        self.edits += 1
        os.utime(file, (self.edits, self.edits))

    @cache  # noqa: B019
    def sound(self, names: tuple[str, ...], selection: str) -> None:
        """End the program if tests fail without a fault."""
        if failed := self.tests(names, selection):
            sys.exit(f"without a fault: {failed}")

    def finds(self, room: str, fault: Fault, selection: str) -> tuple[str, str]:
        """What of the selection finds a fault, and what beyond it."""
        names, file = tuple(rooms()[room]), self.tree / fault.file
        both = selection, f"not ({selection})"
        whole = file.read_bytes()
        self.sound(names, both[0])
        try:
            self.write(file, fault.planted(whole))
            status, _ = self.run("glyphspline", "warm", "--jobs", str(self.jobs))
            if status:
                return "the compiler", ""
            if found := self.tests(names, both[0]):
                return found, ""
            found = self.tests(names, both[1])
        finally:
            self.write(file, whole)
        if found:
            self.sound(names, both[1])
        return "", found


def main() -> int:
    """Plant faults, and print what finds them."""
    asked = parser(__doc__, count=40, seed=0, jobs=2, selection="not long", seconds=1200.0).parse_args()
    print(table(["place", "instead of", "stands", "found by the selection", "or else by"]), flush=True)
    mine = more = 0
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        copy = Copy(Path(folder), asked.jobs, asked.seconds)
        for room, fault in drawn(asked.count, asked.seed):
            found, otherwise = copy.finds(room, fault, asked.selection)
            mine, more = mine + bool(found), more + bool(otherwise)
            cells = f"{fault.file}:{fault.line}", f"`{fault.before}`", f"`{fault.after}`", found, otherwise
            print(f"| {' | '.join(cells)} |", flush=True)
    print(f"\nof {asked.count} faults the selection finds {mine}, all tests {mine + more}")
    return int(more > 1)


if __name__ == "__main__":
    sys.exit(main())
