"""How soon the viewer answers a moved slider: the server's part, from request to answer, drawing apart.

Each request has an amount of its own, so that no answer comes out of a cache.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import matplotlib
from starlette.testclient import TestClient

from glyphspline.plugins.viewer.app import make_app

from .measure import Row, in_words

HOST = "127.0.0.1:8642"
FONTS = Path(__file__).parents[2] / "fonts_test"
LETTERS = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
CHANGES = 15

WAYS: dict[str, tuple[dict[str, Any], float]] = {
    "smooth by step": ({"corners": "smooth", "sampling": "step"}, 1 / 20),
    "sharp by tolerance": ({"corners": "sharp", "sampling": "tolerance"}, 1 / 1000),
    "smooth by tolerance": ({"corners": "smooth", "sampling": "tolerance"}, 1 / 1000),
}
"""What is asked for, and the amount about which the slider moves, in em."""


def rows() -> list[Row]:
    """An ordinary letter and 'Dragon'; milliseconds, a median over changes of the amount."""
    cases = [("g of DejaVu Sans", LETTERS, "g"), ("龍 of the running hand", FONTS / "kouzan-gyosho.ttf", "uni9F8D")]
    return [answer_row(what, path, glyph, way) for what, path, glyph in cases for way in WAYS]


def answer_row(what: str, path: Path, glyph: str, way: str) -> Row:
    """The time of one glyph's answers, after one that is not counted."""
    client = TestClient(make_app(path, hosts=(HOST,)), base_url=f"http://{HOST}")
    em = client.get("/api/font").json()["metrics"]["units_per_em"]
    state, share = WAYS[way]
    times = []
    for k in range(CHANGES + 1):
        body = {"glyph": glyph, "variant": 2, "amount": em * share * (1 + k / CHANGES)} | state
        start = perf_counter()
        client.post("/api/glyph", json=body).raise_for_status()
        times.append(perf_counter() - start)
    seconds = median(times[1:])
    must = 100.0 if glyph == "g" else None  # an ordinary letter
    return Row(f"{what}, {way}", seconds * 1e3, "ms", must=must, more=False, note=f"slowest {in_words(max(times[1:]))}")
