"""Char strings as operators without subroutines, and whole again: what stays calls the subroutines that it called."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from fontTools.cffLib.specializer import generalizeCommands, programToCommands
from fontTools.misc.psCharStrings import SimpleT2Decompiler, T2CharString, calcSubrBias

DRAWN = (
    "rlineto", "hlineto", "vlineto", "rrcurveto", "hhcurveto", "vvcurveto", "hvcurveto", "vhcurveto", "rcurveline",
    "rlinecurve", "flex", "hflex", "hflex1", "flex1",
)  # fmt: skip
"""Operators of lines and curves."""

DEEPEST = 10
"""Subroutines in each other at most, by the format."""

FULL = 1239, 33899, 65535
"""Most subroutines of a font so that the numbers by which they are called begin at the same one."""

CALL = 4
"""Bytes of a call at most, and about those that a subroutine takes besides what it draws."""

Command = tuple[str, list[Any]]
"""An operator and its arguments; those that vary are lists of a default, deltas and 1."""


class Program(SimpleT2Decompiler):  # type: ignore[misc]
    """The tokens of a char string, with those of its subroutines in the place of calls.

    Attributes:
        tokens: numbers, operators and the bytes of masks. calls: by the first token of subroutines, the outermost
            first, the token behind its last and the two of its call. depth: of subroutines in each other.
    """

    def __init__(self, string: Any) -> None:
        super().__init__(getattr(string.private, "Subrs", []), string.globalSubrs, string.private)
        self.tokens: list[Any] = []
        self.calls: dict[int, list[tuple[int, list[Any]]]] = {}
        self.depth = 0
        self.execute(string)

    def execute(self, string: Any, *, pushToStack: Any = None) -> None:
        """Read a char string or subroutine. It keeps its bytes: fontTools' own would put tokens in their place."""
        self.callingStack.append(string)
        self.depth, index = max(self.depth, len(self.callingStack) - 1), 0
        while self.tokens[-1:] != ["endchar"]:
            token, is_operator, index = string.getToken(index)
            if token is None or token == "return":
                break
            self.tokens.append(token)
            if not is_operator:
                self.push(token)
            elif (handler := getattr(self, f"op_{token}", None)) is None:
                self.popall()
            elif (read := handler(index)) is not None:
                mask, index = read
                self.tokens.append(mask)
        self.callingStack.pop()

    def op_callsubr(self, index: int) -> None:
        """Read a subroutine of the glyph's part of the font."""
        self._call(super().op_callsubr, index)

    def op_callgsubr(self, index: int) -> None:
        """Read a subroutine of the whole font."""
        self._call(super().op_callgsubr, index)

    def _call(self, read: Any, index: int) -> None:
        call = self.tokens[-2:]
        del self.tokens[-2:]
        start = len(self.tokens)
        read(index)
        self.calls.setdefault(start, []).insert(0, (len(self.tokens), call))

    def commands(self, regions: int) -> tuple[list[Command], list[tuple[int, int]]]:
        """Single moves, lines and curves, and whatever else is no drawing; and of each the tokens it was made of.

        Raises:
            ValueError: an operator has a wrong number of arguments.
        """
        commands, spans = list[Command](), []
        start = getattr(self.private, "vsindex", 0) or 0
        for first, behind in operators(self.tokens):
            own = programToCommands(self.tokens[first:behind], lambda _: regions, vsIndex=start)
            made = [each for command in generalizeCommands(own) for each in unflexed(*command)]
            commands += made
            spans += [(first, behind)] * len(made)
        return commands, spans

    def with_others(self, new: Mapping[int, tuple[int, list[Any]]]) -> list[Any]:
        """The tokens to store, with others in the place of some: by the first one the one behind, and the others.

        Subroutines in which nothing is another are called as they were.
        """
        changed = np.zeros(len(self.tokens), dtype=bool)
        for first, (behind, _) in new.items():
            changed[first:behind] = True
        found, at = list[Any](), 0
        while at < len(self.tokens):
            whole = [each for each in self.calls.get(at, ()) if each[0] > at and not changed[at : each[0]].any()]
            at, tokens = new.get(at) or (whole or [(at + 1, self.tokens[at : at + 1])])[0]
            found += tokens
        return found


def operators(tokens: Sequence[Any]) -> list[tuple[int, int]]:
    """The first token of each operator with its arguments, and the one behind its last."""
    found, start = [], 0
    for at, token in enumerate(tokens):
        if isinstance(token, str) and token not in ("blend", "callsubr", "callgsubr"):
            end = at + 1 + (token in ("hintmask", "cntrmask"))
            found.append((start, end))
            start = end
    return found


def share(strings: Sequence[Any]) -> None:
    """Store what several new char strings draw alike once, as subroutines behind those that their font has.

    That are whole contours, or what of one lies between masks of hints. There are no more than leave the numbers of
    other subroutines as they are; none in a font that has none.
    """
    groups: dict[int, list[Any]] = {}
    for string in strings:
        if Program(string).depth < DEEPEST:
            groups.setdefault(id(subroutines_of(string)[0]), []).append(string)
    for own in groups.values():
        subroutines, call = subroutines_of(own[0])
        before, bias = len(subroutines), calcSubrBias(subroutines)
        most = next(count for count in FULL if before <= count) if before else 0
        parts, numbers = [parts_of(string.program) for string in own], dict[tuple[Any, ...], int]()
        for part, count in Counter(part for each in parts for part in each).most_common():
            size = size_of(part) if count > 1 and part[-1] in DRAWN else 0
            if (count - 1) * size > (count + 1) * CALL and len(subroutines) < most:
                numbers[part] = len(subroutines) - bias
                subroutines.append(T2CharString(program=[*part, "return"], private=own[0].private))
        for string, each in zip(own, parts, strict=True):
            calls = [[numbers[part], call] if part in numbers else part for part in each]
            string.setProgram([token for part in calls for token in part])


def subroutines_of(string: Any) -> tuple[Any, str]:
    """Those that a char string shares with others, of its part of the font or else of all, and what calls them."""
    local = getattr(string.private, "Subrs", [])
    return (local, "callsubr") if len(local) else (string.globalSubrs, "callgsubr")


def parts_of(program: Sequence[Any]) -> list[tuple[Any, ...]]:
    """A program in parts: each draws lines and curves alone, or is one other operator."""
    parts, end, draws = list[tuple[Any, ...]](), 0, False
    for first, end in operators(program):
        own, drew = tuple(program[first:end]), draws
        draws = own[-1] in DRAWN
        if draws and drew:
            own = parts.pop() + own
        parts.append(own)
    return [*parts, tuple(program[end:])] if end < len(program) else parts


def size_of(part: Sequence[Any]) -> int:
    """How many bytes tokens have."""
    string = T2CharString(program=[*part])
    string.compile()
    return len(string.bytecode)


def unflexed(name: str, args: list[Any]) -> list[Command]:
    """Two curves in the place of a flex; any other command as it is.

    Raises:
        ValueError: the flex varies.
    """
    if "flex" not in name:
        return [(name, args)]
    if any(isinstance(arg, list) for arg in args):
        raise ValueError(name)
    if name == "flex":
        first, second = args[:6], args[6:12]
    elif name == "hflex":
        a, b, c, d, e, f, g = args
        first, second = [a, 0, b, c, d, 0], [e, 0, f, -c, g, 0]
    elif name == "hflex1":
        a, b, c, d, e, f, g, h, i = args
        first, second = [a, b, c, d, e, 0], [f, 0, g, h, i, -(b + d + h)]
    else:
        x, y = sum(args[0:10:2]), sum(args[1:10:2])
        last = [args[10], -y] if abs(x) > abs(y) else [-x, args[10]]
        first, second = args[:6], [*args[6:10], *last]
    return [("rrcurveto", first), ("rrcurveto", second)]
