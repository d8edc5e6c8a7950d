"""Array types of the annotations, whose shapes the docstrings say, and sequences whose items are views of arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import Context, Decimal
from typing import TYPE_CHECKING, Any, Generic, Literal, NamedTuple, TypeAlias, TypeVar, overload

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FloatArray: TypeAlias = "NDArray[np.float64]"
IntArray: TypeAlias = "NDArray[np.int64]"
ComplexArray: TypeAlias = "NDArray[np.complex128]"
BoolArray: TypeAlias = "NDArray[np.bool_]"
"""Text, so that a command can read its options without NumPy."""

Real: TypeAlias = Any
"""A number, or an array of numbers: of functions that are compiled for one and used in NumPy for many."""

Names: TypeAlias = Literal["glyph", "unicode", "gid", "char"]
"""What the files of glyphs are called after."""

INCHES = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0, "pt": 1 / 72, "pc": 1 / 6, "px": 1 / 96}
"""Units of lengths in CSS and SVG, in inches."""


class Head(NamedTuple):
    """A glyph without its contours: name, glyph index and code points in ascending order."""

    name: str
    gid: int
    unicodes: tuple[int, ...] = ()


T = TypeVar("T", covariant=True)
Value = TypeVar("Value")


def counted(number: int, noun: str) -> str:
    """A number and its noun, in the plural unless there is one."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def listed(names: Sequence[str], count: int) -> str:
    """The names, and how many more there are of ``count``."""
    more = f" and {count - len(names)} more" if count > len(names) else ""
    return ", ".join(names) + more


def shortened(lines: Sequence[str], most: int, more: str = "and {} more") -> list[str]:
    """At most so many lines, and one with the number of the others."""
    return [*lines[:most], *([more.format(len(lines) - most)] if len(lines) > most else [])]


def rounded_up(value: float, digits: int) -> float:
    """Round up to ``digits`` significant digits, as proven bounds are written."""
    text = f"{value:.{digits}g}"
    near = float(text)
    return near if not near < value else float(Decimal(text).next_plus(Context(prec=digits)))


class Views(Sequence[T], Generic[T]):
    """A sequence whose items are made from arrays, all at once, when one is first read.

    A run over a font reads the arrays alone: the objects would take longer to make than the curves.
    Pickled and copied as a tuple.
    """

    __slots__ = ("_count", "_items", "_make")

    def __init__(self, count: int, make: Callable[[], Sequence[T]]) -> None:
        self._count, self._make = count, make
        self._items: tuple[T, ...] | None = None

    @property
    def items(self) -> tuple[T, ...]:
        """All items."""
        if self._items is None:
            self._items = tuple(self._make())
        return self._items

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[T, ...]: ...
    def __getitem__(self, index: int | slice) -> T | tuple[T, ...]:
        return self.items[index]

    def __iter__(self) -> Iterator[T]:
        return iter(self.items)

    def __repr__(self) -> str:
        return repr(self.items)

    def __reduce__(self) -> tuple[Any, ...]:
        return tuple, (self.items,)


class MadeOnDemand(Mapping[str, Value], Generic[Value]):
    """Values by name, each made when it is asked for and not kept: all glyphs of a CJK font would fill the memory."""

    def __init__(self, names: Iterable[str], make: Callable[[str], Value]) -> None:
        self._names, self._make = dict.fromkeys(names), make

    def __getitem__(self, name: str) -> Value:
        if name not in self._names:
            raise KeyError(name)
        return self._make(name)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)
