"""Char strings as operators without subroutines, and whole again: what stays calls the subroutines that it called."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from fontTools.cffLib.specializer import generalizeCommands, programToCommands
from fontTools.misc.psCharStrings import SimpleT2Decompiler

Command = tuple[str, list[Any]]
"""An operator and its arguments; those that vary are lists of a default, deltas and 1."""


class Program(SimpleT2Decompiler):  # type: ignore[misc]
    """The tokens of a char string, with those of its subroutines in the place of calls.

    Attributes:
        tokens: numbers, operators and the bytes of masks. calls: by the first token of subroutines, the outermost
            first, the token behind its last and the two of its call.
    """

    def __init__(self, string: Any) -> None:
        super().__init__(getattr(string.private, "Subrs", []), string.globalSubrs, string.private)
        self.tokens: list[Any] = []
        self.calls: dict[int, list[tuple[int, list[Any]]]] = {}
        self.execute(string)

    def execute(self, string: Any, *, pushToStack: Any = None) -> None:
        """Read a char string or subroutine. It keeps its bytes: fontTools' own would put tokens in their place."""
        self.callingStack.append(string)
        index = 0
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

    def operators(self) -> list[tuple[int, int]]:
        """The first token of each operator with its arguments, and the one behind its last."""
        found, start = [], 0
        for at, token in enumerate(self.tokens):
            if isinstance(token, str) and token != "blend":
                end = at + 1 + (token in ("hintmask", "cntrmask"))
                found.append((start, end))
                start = end
        return found

    def commands(self, regions: int) -> tuple[list[Command], list[tuple[int, int]]]:
        """Single moves, lines and curves, and whatever else is no drawing; and of each the tokens it was made of.

        Raises:
            ValueError: an operator has a wrong number of arguments.
        """
        commands, spans = list[Command](), []
        start = getattr(self.private, "vsindex", 0) or 0
        for first, behind in self.operators():
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
