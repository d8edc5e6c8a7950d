"""Experiments on one outline: the same curves as everywhere, measures by other means, sheets of the same bytes."""

from __future__ import annotations

import os
import subprocess
import sys
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import glyphspline as gs
from glyphspline.plugins.experiments import PEERS, VARIANTS
from glyphspline.plugins.experiments.measures import bulge, farthest_apart
from glyphspline.plugins.experiments.methods import composite_radii, curve_through
from glyphspline.plugins.experiments.polygons import clicks, read_clicked
from tests.places import FONTS, ROOT

BRUSH = FONTS / "kouzan-gyosho.ttf"


@pytest.fixture(scope="module")
def letter() -> gs.Outline:
    return gs.open_font(BRUSH).outline("O")


@pytest.fixture(scope="module")
def made(letter: gs.Outline) -> gs.Experiment:
    return gs.experiment(letter, (2, 3), count=16)


def row_of(made: gs.Experiment, method: str, contour: int = 0) -> dict[str, Any]:
    (row,) = (row for row in made.rows if (row["method"], row["contour"]) == (method, contour))
    return row


def test_a_row_says_what_the_interpolation_says(made: gs.Experiment, letter: gs.Outline) -> None:
    polygon = gs.sample(letter.contours[0], count=16)
    np.testing.assert_array_equal(made.polygons[0], polygon)
    found, row = gs.interpolate(polygon, 2, residual_tolerance=made.tolerance), row_of(made, "variant 2")
    assert (row["vertices"], row["iterations"], row["converged"]) == (16, found.iterations, True)
    assert row["residual"] == pytest.approx(1000 * found.max_error / made.em)
    t = np.linspace(0, found.spline.period, 20_001)[:-1]
    speed = np.hypot(*found.spline(t, 1).T)
    assert row["bending_energy"] == pytest.approx(
        made.em * float((found.spline.curvature(t) ** 2 * speed).mean()) * found.spline.period, rel=1e-4
    )
    assert row["max_curvature"] == pytest.approx(made.em * np.abs(found.spline.curvature(t)).max(), rel=1e-2)
    assert row["length"] == pytest.approx(float(speed.mean()) * found.spline.period / made.em, rel=1e-6)


def test_what_converges_to_one_curve_measures_alike(made: gs.Experiment) -> None:
    """PIA's limit, FITPACK's and SciPy's periodic cubics by chord lengths are variant 3's."""
    for contour in range(len(made.polygons)):
        three = row_of(made, "variant 3", contour)
        for peer in PEERS[:3]:
            own = row_of(made, peer, contour)
            assert own["bulge"] == pytest.approx(three["bulge"], abs=1e-3)
            assert own["bending_energy"] == pytest.approx(three["bending_energy"], rel=1e-3)
        assert row_of(made, "PIA", contour)["iterations"] == three["iterations"]
    centripetal = row_of(made, "centripetal")
    assert centripetal["length"] != pytest.approx(row_of(made, "variant 3")["length"], rel=1e-9)


@pytest.mark.parametrize("method", [*VARIANTS, *PEERS])
@pytest.mark.parametrize("n", [3, 4, 7])
def test_every_curve_passes_through_its_vertices(method: str, n: int) -> None:
    polygon = np.random.default_rng(n).uniform(0, 5, (n, 2))
    curve = curve_through(polygon, method, 1e-9)
    if not curve.converged and method == "variant 0":
        return
    ends = curve.pieces[np.floor(curve.places).astype(int) % n]
    x = (curve.places % 1)[:, None]
    points = ((1 - x) ** 3 * ends[:, 0] + 3 * x * (1 - x) ** 2 * ends[:, 1]
              + 3 * x**2 * (1 - x) * ends[:, 2] + x**3 * ends[:, 3])  # fmt: skip
    np.testing.assert_allclose(points, polygon, atol=1e-8)


def test_an_overshoot_is_measured_and_found() -> None:
    """A curve that is a straight line but for one span, which leaves its chord by 3/4 of its handles' height."""
    square = np.array([[0.0, 0], [10, 0], [10, 10], [0, 10]])
    after = np.roll(square, -1, axis=0)
    pieces = np.stack([square, square + (after - square) / 3, after - (after - square) / 3, after], axis=1)
    flat, places = pieces.copy(), np.arange(4.0)
    pieces[2, 1:3, 1] += 4
    assert bulge(flat, places, square) == pytest.approx(0, abs=1e-12)
    assert bulge(pieces, places, square) == pytest.approx(3)
    base = curve_through(square, "variant 2", 1e-6)
    curves = {
        name: type(base)(own, places, 0.0, converged=True) for name, own in (("variant 1", flat), ("variant 2", pieces))
    }
    gap, where = farthest_apart([curves], ["variant 1", "variant 2"])
    assert gap == pytest.approx(3)
    assert where[0] == pytest.approx(5)
    assert 10 <= where[1] <= 13


def test_clicks_lie_near_the_outline_with_few_on_straight_parts(letter: gs.Outline) -> None:
    contour, em = letter.contours[0], 1024.0
    found = clicks(contour, em)
    outline = contour.at(np.arange(64 * len(contour)) / 64)
    far = np.hypot(*(found[:, None] - outline).transpose(2, 0, 1)).min(axis=1)
    assert far.max() < 0.006 * em
    assert (found == np.rint(found)).all()
    square = gs.Contour(np.array([[0.0, 0], [1000, 0], [1000, 1000], [0, 1000]]), np.ones(4, dtype=np.int64))
    assert 12 <= len(clicks(square, 1000.0)) <= 40
    speck = gs.Contour(square.points / 500, square.degrees)
    assert len(np.unique(clicks(speck, 1000.0), axis=0)) >= 3


def test_the_composite_radius_of_variant_3_is_a_power() -> None:
    polygon = np.random.default_rng(1).uniform(0, 5, (9, 2))
    radii = composite_radii(polygon, 3, 1e-6)
    spline = gs.interpolate(polygon, 3).spline
    factor = np.abs(np.linalg.eigvals(np.eye(9) - spline.basis(spline.knots[:-1]))).max()
    np.testing.assert_allclose(radii, factor ** np.arange(1, len(radii) + 1), rtol=1e-9)
    two = composite_radii(polygon, 2, 1e-6)
    assert two[-1] < 0.1 < 1
    assert len(gs.experiment(gs.open_font(BRUSH).outline("O"), (3,), count=8, radii=True).curves[0]) == 1 + len(PEERS)


def test_a_sheet_has_the_same_bytes_plain_and_compiled(made: gs.Experiment, tmp_path: Path) -> None:
    made.save(tmp_path / "here.svg", "A face")
    made.save(tmp_path / "here.png")
    code = (
        "import glyphspline as gs, sys\n"
        "made = gs.experiment(gs.open_font(sys.argv[1]).outline('O'), (2, 3), count=16)\n"
        "made.save('plain.svg', 'A face')\n"
        "print(made.rows)"
    )
    plain = subprocess.run(
        [sys.executable, "-c", code, str(BRUSH)], cwd=tmp_path, capture_output=True, text=True, check=True,
        env=os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert plain.stdout == f"{made.rows}\n"
    assert (tmp_path / "plain.svg").read_bytes() == (tmp_path / "here.svg").read_bytes()
    assert made._repr_png_() == (tmp_path / "here.png").read_bytes()


def test_variants_stay_apart_in_grey_and_all_is_drawn(made: gs.Experiment) -> None:
    from glyphspline.plugins.experiments.style import SHADES

    grey = sorted(np.array([int(s[k : k + 2], 16) for k in (1, 3, 5)]) @ (0.299, 0.587, 0.114) for s in SHADES)
    assert min(np.diff(grey)) > 20
    with Image.open(BytesIO(made._repr_png_())) as drawn:
        ink = np.asarray(drawn.convert("L")) < 250
    rows = np.flatnonzero(ink.any(axis=1))
    assert rows[0] > 0
    assert rows[-1] < len(ink) - 1
    assert not ink[:, [0, -1]].any()
    for part in np.array_split(ink, 6):
        assert part.any()


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"variants": (5,)}, "variants are some of 0 to 4"),
        ({"variants": ()}, "variants are some of 0 to 4"),
        ({"count": 8, "step": 3.0}, "one of them"),
        ({"count": 2}, "count is a whole number"),
        ({"residual_tolerance": 0}, "residual_tolerance is a positive distance"),
    ],
)
def test_bad_options_are_refused(letter: gs.Outline, how: dict[str, Any], words: str) -> None:
    with pytest.raises(gs.OptionError, match=words):
        gs.experiment(letter, **how)


def test_a_bad_polygon_names_glyph_and_contour(letter: gs.Outline) -> None:
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    with pytest.raises(gs.PolygonError, match="glyph 'O', contour 1: 2 distinct vertices"):
        gs.experiment(letter, polygons=[square, [[0, 0], [1, 1], [0, 0]]])


def test_a_glyph_without_contours_has_no_rows() -> None:
    assert gs.experiment(gs.open_font(BRUSH).outline("space")).rows == []


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "first line is not"),
        ("a,b\n", "first line is not"),
        ("glyph,contour,x,y\nO,0,1\n", "no point: 'O,0,1'"),
        ("glyph,contour,x,y\nO,0,1,here\n", "no point: 'O,0,1,here'"),
    ],
)
def test_a_bad_file_of_points_is_named(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(gs.GlyphsplineError, match=f"points.csv: .*{words}"):
        read_clicked(path)


def test_points_are_read_by_glyph_and_contour(tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    path.write_text("# clicked\nglyph,contour,x,y\n好,a,1,2\n好,a,3,4.5\n\n好,b,0,0\nO,0,7,8\n", encoding="utf-8")
    found = read_clicked(path)
    assert {glyph: [points.tolist() for points in each] for glyph, each in found.items()} == {
        "好": [[[1, 2], [3, 4.5]], [[0, 0]]], "O": [[[7, 8]]]
    }  # fmt: skip
