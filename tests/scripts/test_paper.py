"""The reproduction of the paper, in its small version: what it claims, and that it is the same twice.

``make test`` makes the steps that prove what the paper says, ``make test-all`` all of them.
"""

from __future__ import annotations

import json
import math
import os
import re
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glyphspline as gs
from glyphspline.interpolation.intervals import basis_function
from scripts.paper import local
from scripts.paper.certified import certify, enclose, family, peak_values, threshold, windows_of, worst_corner
from scripts.paper.common import Run, is_verdict, random_polygons
from scripts.paper.faces import CHARACTERS, FONTS, Character
from scripts.paper.fairness import curves_of, quality, self_crossings
from scripts.paper.report import numbers_missing, show
from scripts.paper.steps import STEPS, reproduce
from tests.places import ROOT

OUTPUTS = ROOT / "outputs" / "paper"
PROOFS = ["theorems", "lemmas", "fig1", "fig2", "fig3", "fig5", "convergence"]


@pytest.fixture(scope="module", params=[PROOFS, pytest.param([*STEPS], marks=pytest.mark.long)], ids=["proofs", "all"])
def quick(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the small version, which one process makes for all that run tests beside each other."""
    place = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        place = place.parent  # of this run of pytest
    out, made = (place / f"quick-paper-{len(request.param)}{end}" for end in ("", "-made"))
    try:
        out.mkdir()
    except FileExistsError:
        until = time.monotonic() + 600
        while not made.exists():
            assert time.monotonic() < until, "the process that makes the paper has failed"
            time.sleep(0.2)
    else:
        reproduce(Run(out, quick=True), request.param)
        made.touch()
    return out


def claims_of(folder: Path) -> dict[str, Any]:
    content = json.loads((folder / "claims.json").read_text(encoding="utf-8"))
    return {c["id"]: c for c in content["claims"]}


def test_a_page_of_one_figure_has_that_one_alone(tmp_path: Path) -> None:
    reproduce(Run(tmp_path, quick=True), ["fig4"])
    page = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"!\[.*?\]\((.+?)\)", page) == ["fig-4.png"]
    assert re.findall(r"(?m)^#.*", page) == ["# The paper, claim by claim", "## Fig. 4: time", "# Times"]
    assert "was not run" not in page
    for claim in claims_of(tmp_path).values():
        assert f'| {claim["source"]} | <a href="#{claim["id"]}">{claim["claim"]}</a> |' in page


def test_a_line_that_would_flatten_the_others_has_a_scale_of_its_own() -> None:
    times = {f"variant {v}": {"5": value, "90": 2 * value} for v, value in enumerate((0.1, 0.2, 2.5))}
    assert [
        len(axes.get_shared_x_axes().get_siblings(axes)) for axes in local.picture(times, times, Run(Path())).axes
    ] == [2] * 4
    alike = {name: {"5": 1.0, "90": 2.0} for name in times}
    assert len(local.picture(alike, alike, Run(Path())).axes) == 2


def test_every_claim_has_the_schema(quick: Path) -> None:
    claims = claims_of(quick)
    assert {"corollary-1", "fig-1-failures", "fig-2-variant-0-share", "fig-3-mean-iterations"} <= set(claims)
    for c in claims.values():
        assert set(c) == {"id", "source", "claim", "paper", "measured", "verdict", "note", "command"}
        assert is_verdict(c["verdict"])
        assert c["command"].rsplit(" ", 1)[1] in STEPS
        for number in _numbers(c["measured"]):
            assert math.isfinite(number), c["id"]


def _numbers(value: Any) -> list[float]:
    if isinstance(value, dict | list):
        return [x for v in (value.values() if isinstance(value, dict) else value) for x in _numbers(v)]
    return [value] if isinstance(value, int | float) else []


def test_what_the_paper_proves_holds(quick: Path) -> None:
    claims = claims_of(quick)
    # x³/2 - x² + 1/6 = 0 by bisection, not by the program's own intervals.
    low, high = 0.4, 0.5
    for _ in range(60):
        x = (low + high) / 2
        low, high = (x, high) if x**3 / 2 - x**2 + 1 / 6 > 0 else (low, x)
    assert claims["corollary-1"]["measured"] == pytest.approx(low, abs=1e-8)
    assert claims["remark-1"]["measured"]["bound"] == pytest.approx(5 / 6, abs=1e-5)
    assert claims["remark-1"]["measured"]["largest factor, uniform knots"] <= 5 / 6
    assert claims["theorem-1"]["measured"]["not converged"] == 0
    assert claims["remark-2"]["measured"]["not converged"] > 0
    assert claims["theorem-2"]["measured"]["steps above the bound"] == 0
    assert claims["beyond-margin-zero"]["measured"]["largest factor of two steps"] < 1
    assert claims["beyond-algorithm-3"]["measured"]["c = 0.05"]["steps above the bound"] == 0


def test_iterations_and_shares_are_in_the_range_of_the_paper(quick: Path) -> None:
    claims = claims_of(quick)
    shares = claims["fig-2-variant-0-share"]["measured"]
    assert shares["variant 0"]["20"] < 100
    assert all(shares[f"variant {v}"][n] == 100 for v in (1, 2, 3, 4) for n in ("5", "20"))
    means = claims["fig-3-mean-iterations"]["measured"]
    for n in ("5", "20"):
        assert means["variant 4"][n] < means["variant 2"][n] < means["variant 3"][n]
        assert 15 < means["variant 2"][n] < 50
    radius = claims["fig-5-composite-radius"]["measured"]
    assert all(radius[f"variant {v}"]["largest of all"] < 1 for v in (1, 2, 3))


def test_the_readme_has_no_number_that_the_claims_lack(quick: Path) -> None:
    for folder in [quick, *([OUTPUTS] if (OUTPUTS / "README.md").exists() else [])]:
        readme = (folder / "README.md").read_text(encoding="utf-8")
        assert numbers_missing(readme, (folder / "claims.json").read_text(encoding="utf-8")) == []
        assert "{{" not in readme
        for picture in re.findall(r"\]\(([^)#]+\.png)\)", readme):
            assert (folder / picture).exists(), picture
    assert numbers_missing("about 47.11 of them", '{"a": 4, "b": 0.11}') == ["47.11"]


def test_a_second_run_says_the_same(quick: Path, tmp_path: Path) -> None:
    """Steps that are run again keep the claims of the others, and come to the same claims and pictures."""
    claims = json.loads((quick / "claims.json").read_text(encoding="utf-8"))
    steps = {claim["command"].rsplit(" ", 1)[1] for claim in claims["claims"]}
    again = ["theorems", "fig1"] if steps <= {*PROOFS} else [*steps - {"fig4", "quality", "fig8", "fig9", "degrees"}]
    of_others = [claim for claim in claims["claims"] if claim["command"].rsplit(" ", 1)[1] not in again]
    (tmp_path / "claims.json").write_text(json.dumps(claims | {"claims": of_others}), encoding="utf-8")
    reproduce(Run(tmp_path, quick=True), again)
    assert list(claims_of(tmp_path).items()) == list(claims_of(quick).items())
    for picture in {path.name for path in tmp_path.iterdir()} & {"fig-1.png", "fig-3.svg", "fig-5.png", "fig-6.png"}:
        assert (tmp_path / picture).read_bytes() == (quick / picture).read_bytes(), picture
    assert (tmp_path / "fig-1.png").exists()


@pytest.mark.parametrize("degree", [3, 4, pytest.param(5, marks=pytest.mark.long)])
def test_no_random_knot_vector_beats_the_certified_least_peak(degree: int) -> None:
    rng = np.random.default_rng(degree)
    h = np.exp(rng.uniform(0, np.log(3), (20_000, degree + 1)))
    least, _ = worst_corner(degree, 3, "box")
    assert certify(degree, 3, "box", least - 1e-6) is not None
    assert peak_values(h).min() > least - 1e-6


def test_enclosures_hold_values_and_slopes() -> None:
    rng = np.random.default_rng(1)
    middle = rng.uniform(1, 4, (200, 4))
    x = rng.uniform(0, 1, 200)
    box = enclose(middle * 0.9, middle * 1.1, 1, x)
    h = middle * rng.uniform(0.9, 1.1, middle.shape)

    def value(h: np.ndarray) -> np.ndarray:
        return basis_function(windows_of(h), h[:, 0] + x * h[:, 1])

    assert ((box.low <= value(h)) & (value(h) <= box.high)).all()
    for k in range(4):
        up, down = h.copy(), h.copy()
        up[:, k] *= 1 + 1e-6
        down[:, k] *= 1 - 1e-6
        slope = (value(up) - value(down)) / 2e-6
        assert (box.slope_low[:, k] - 1e-8 <= slope).all()
        assert (slope <= box.slope_high[:, k] + 1e-8).all()


def test_quadratic_peaks_have_the_closed_form_and_no_threshold() -> None:
    b = np.array([1.0, 10.0, 1e4])
    h = np.stack([np.ones(3), b, np.ones(3)], axis=1)
    assert peak_values(h) == pytest.approx(1 - b / (2 * (1 + b)), rel=1e-12)
    assert threshold(2, "box") is None
    assert len(family(2, 4, "adjacent").low) == 0


def test_scipy_with_chord_lengths_is_variant_3() -> None:
    polygon = random_polygons(12, 1)[0]
    curves = curves_of(polygon, 1e-12)
    np.testing.assert_allclose(curves["variant 3"][0], curves["SciPy chord"][0], atol=1e-9)


def test_measures_of_a_circle() -> None:
    angle = 2 * np.pi * np.arange(40) / 40
    polygon = 2 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    r = gs.interpolate(polygon, 2, residual_tolerance=1e-12)
    q = quality(r.spline.to_bezier(), np.arange(40.0), polygon)
    assert q["∫κ² ds"] == pytest.approx(np.pi, rel=1e-4)
    # The second derivative of a cubic spline is off by h²/12 at the knots, h being the angle of a span, and is
    # linear between them, so that the slope of the curvature runs from h/8 to -h/8 along each span.
    h = np.pi / 20
    assert q["max |κ|"] == pytest.approx(0.5 * (1 + h**2 / 12), rel=1e-4)
    assert q["∫(dκ/ds)² ds"] == pytest.approx(4 * np.pi * (h / 8) ** 2 / 3, rel=0.02)
    assert q["bulge"] == pytest.approx(2 * (1 - np.cos(np.pi / 40)), rel=1e-3)
    assert q["self-crossings"] == 0


def test_crossings_are_counted() -> None:
    t = np.linspace(0, 2 * np.pi, 60, endpoint=False) + 0.01
    assert self_crossings(np.stack([np.sin(2 * t), np.sin(t)], axis=1)) == 1
    assert self_crossings(np.stack([np.cos(t), np.sin(t)], axis=1)) == 0


@pytest.mark.parametrize("each", CHARACTERS, ids=lambda each: each.name)
def test_the_clicked_polygons_come_from_the_bundled_faces(each: Character) -> None:
    """And the experiment on the character, as anybody makes it, has the numbers of the paper's page."""
    font = gs.open_font(FONTS / f"{each.stem}.ttf")
    made = gs.experiment(font.outline(font.select(text=each.character)[0]), peers=False)
    for own, stored in zip(made.polygons, each.polygons(), strict=True):
        np.testing.assert_array_equal(own, stored)
    measured = claims_of(OUTPUTS)[f"{each.name}-overshoot"]["measured"]
    for v in (1, 2, 3):
        beyond = [row["bulge"] for row in made.rows if row["method"] == f"variant {v}"]
        assert max(beyond) == pytest.approx(measured[f"variant {v}"]["largest"], rel=1e-5)
        assert np.mean(beyond) == pytest.approx(measured[f"variant {v}"]["mean of contours"], rel=1e-5)


def test_tables_of_nested_claims() -> None:
    text = show({"all": 3, "a": {"x": 1, "y": 2.5}, "b": {"x": 3, "y": 4}})
    assert text.splitlines()[0] == "| all |"
    assert "| a | 1 | 2.5 |" in text
    assert "| b | 3 | 4 |" in text
