"""The errors: what each of them is, and that it survives a process boundary."""

from __future__ import annotations

import pickle

import pytest

import glyphspline as gs


@pytest.mark.parametrize(
    ("kind", "base"),
    [(gs.PolygonError, ValueError), (gs.OptionError, ValueError), (gs.OutputError, OSError), (gs.FontError, Exception)],
)
def test_every_error_is_one_of_ours_and_of_its_kind(kind: type[gs.GlyphsplineError], base: type[Exception]) -> None:
    error = kind("no such thing", font="a.ttf", contour=3)
    assert isinstance(error, gs.GlyphsplineError)
    assert isinstance(error, base)
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), str(copy), copy.contour) == (kind, "a.ttf, contour 3: no such thing", 3)


def test_ours_are_no_value_errors_as_such() -> None:
    assert not issubclass(gs.GlyphsplineError, ValueError)
    assert not issubclass(gs.FontError, ValueError)
