"""Exact serialisation of a result as JSON; arrays are stored as their bytes."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..curves.bspline import Spline
from ..files import reading
from ..fitting.options import Options
from ..fitting.results import ContourResult, GlyphResult, Measures
from ..interpolation.result import Interpolation
from ..outlines.outline import Contour, FontMetrics, Outline
from ..types import Views

KINDS: tuple[type, ...] = (
    Contour, ContourResult, FontMetrics, GlyphResult, Interpolation, Measures, Options, Outline, Spline,
)  # fmt: skip
"""The classes in a result. Reading a file creates objects of these classes, and of those that are asked for, only."""

TYPES = {"float64": "<f8", "int64": "<i8", "bool": "|b1"}

Result = TypeVar("Result")


def to_text(result: Any) -> str:
    """The result as one line of JSON."""
    return json.dumps(_plain(result), separators=(",", ":")) + "\n"


def from_text(text: str, kind: type[Result], more: Sequence[type] = ()) -> Result:
    """The result that was written, of that kind.

    Args:
        more: classes that may be in it besides ``KINDS``.

    Raises:
        ValueError: the text is not one.
    """
    try:
        result = _made(json.loads(text), {one.__name__: one for one in (*KINDS, *more)})
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"not a stored result: {error}") from error
    if not isinstance(result, kind):
        raise ValueError("not a stored result")
    return result


def read_result(path: Path, kind: type[Result], more: Sequence[type] = ()) -> Result:
    """Read the result in a file that :func:`to_text` made.

    Raises:
        OutputError: the file cannot be read, or holds no such result.
    """
    with reading(path):
        return from_text(path.read_text(encoding="utf-8"), kind, more)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        kind = value.dtype.name
        data = base64.b64encode(value.astype(TYPES[kind]).tobytes()).decode()
        return {"array": kind, "shape": list(value.shape), "data": data}
    if is_dataclass(value):
        return {"kind": type(value).__name__} | {f.name: _plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, tuple | Views):
        return [_plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def _made(value: Any, kinds: Mapping[str, type]) -> Any:
    if isinstance(value, list):
        return tuple(_made(item, kinds) for item in value)
    if not isinstance(value, dict):
        return value
    if "array" in value:
        flat = np.frombuffer(base64.b64decode(value["data"]), TYPES[value["array"]])
        return flat.astype(value["array"]).reshape(value["shape"])
    kind = kinds[value.pop("kind")]
    return kind(**{name: _made(item, kinds) for name, item in value.items()})
