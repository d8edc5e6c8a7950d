"""What notebooks show, drawings onto axes, the example notebook, and the atlas."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline.cli.app import app
from glyphspline.outlines.joins import joins
from glyphspline.plugins.viewer import atlas, notebook
from glyphspline.plugins.viewer.atlas import make_atlas
from glyphspline.plugins.viewer.atlas_pages import overview, profile
from glyphspline.writers.settings import Maps
from glyphspline.writers.svg.comb import teeth
from tests.drawings import L_SHAPE, METRICS, circle, polygon_contour
from tests.places import ROOT

SVG = "{http://www.w3.org/2000/svg}"
ROUND = gs.Contour.from_segments(circle(200.0, 8, centre=(300.0, 300.0)))


@pytest.fixture(scope="module")
def glyph() -> gs.GlyphResult:
    return gs.convert(gs.Outline("a<b", 7, (65,), 600.0, (ROUND,), METRICS), gs.Options(count=16))


@pytest.fixture
def axes() -> Any:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure()
    FigureCanvasAgg(figure)
    return figure.add_subplot()


@pytest.fixture(autouse=True)
def in_a_notebook() -> None:
    notebook.install()


def html_of(thing: Any) -> str:
    return str(thing._repr_html_())


def svg_of(thing: Any) -> str:
    return str(thing._repr_svg_())


def test_where_ipython_runs_public_names_bring_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "IPython", raising=False)  # a test before this one may need it
    monkeypatch.delattr(gs.Spline, "_repr_svg_")
    assert gs.__getattr__("Spline") is gs.Spline
    assert not hasattr(gs.Spline, "_repr_svg_")
    monkeypatch.setitem(sys.modules, "IPython", sys)
    assert gs.__getattr__("Spline") is gs.Spline
    assert hasattr(gs.Spline, "_repr_svg_")


def test_outlines_splines_and_results_show_themselves(glyph: gs.GlyphResult) -> None:
    spline = glyph.contours[0].interpolations[0].spline
    open_arc = gs.interpolate(L_SHAPE, closed=False).spline
    quintic = gs.interpolate(L_SHAPE, degree=5).spline
    random = np.random.default_rng(1)
    splines = [gs.Spline(random.normal(size=(d + 4, 2)), np.arange(5.0), d, closed=False) for d in range(2, 7)]
    (lines,) = gs.convert(gs.Outline("L", contours=(polygon_contour(L_SHAPE),)), gs.Options(corners="sharp")).contours
    assert lines.spline is not None
    splines += [lines.spline, spline, open_arc, quintic]
    for thing, paths in ((glyph, 5), (glyph.outline, 1), *((spline, 3) for spline in splines)):
        root = ElementTree.fromstring(svg_of(thing))
        assert len(list(root.iter(f"{SVG}path"))) >= paths
    html = html_of(glyph)
    assert "<td>16</td>" in html
    assert f"<p>{glyph.options.words}</p>" in html
    assert "a<b" not in html


def test_a_spline_shows_its_knots_where_the_curve_passes(glyph: gs.GlyphResult) -> None:
    spline = glyph.contours[0].interpolations[0].spline
    dots = list(ElementTree.fromstring(svg_of(spline)).iter(f"{SVG}path"))[-1].attrib["d"]
    moves = np.array(re.findall(r"[Mm](-?[\d.]+) ?(-?[\d.]+)h0", dots), dtype=float)
    np.testing.assert_allclose(np.cumsum(moves, axis=0) * (1, -1), spline(spline.knots), atol=0.01)


@pytest.mark.parametrize("degree", [3, 5])
def test_an_interpolation_shows_its_vertices_knots_and_footpoints(axes: Any, degree: int) -> None:
    found = gs.interpolate([*L_SHAPE[:1], *L_SHAPE], degree=degree)  # one is merged
    root = ElementTree.fromstring(svg_of(found))
    drawn = {path.get("class"): path.attrib["d"] for path in root.iter(f"{SVG}path")}
    assert list(drawn)[-3:] == ["vertices", "knots", "footpoints"]
    for name, expected in (("vertices", L_SHAPE), ("footpoints", found.spline(found.parameters))):
        moves = np.array(re.findall(r"[Mm](-?[\d.]+) ?(-?[\d.]+)h0", drawn[name]), dtype=float)
        np.testing.assert_allclose(np.cumsum(moves, axis=0) * (1, -1), expected, atol=0.02)
    assert len(list(root.iter(f"{SVG}g"))) == 1  # the comb
    assert "converged" in html_of(found)
    assert "vertices" in html_of(found)
    gs.plot(found, axes, comb=True, polygon=True, control_polygon=True)
    assert [len(np.asarray(line.get_xydata())) for line in axes.lines[-3:]] == [6, 7, 6]
    np.testing.assert_array_equal(np.asarray(axes.lines[0].get_xydata())[:-1], L_SHAPE)
    (many,) = gs.interpolate_many([L_SHAPE])
    np.testing.assert_array_equal(many.points, L_SHAPE)
    assert 'class="vertices"' in svg_of(many)


@pytest.mark.parametrize("dimension", [3, 6])
def test_curves_in_space_show_curvature_and_torsion(dimension: int) -> None:
    t = np.linspace(0, 5, 9)
    points = np.stack([np.cos(k * t) if k % 2 else np.sin(k * t) for k in range(1, dimension + 1)], axis=1)
    for closed in (True, False):
        found = gs.interpolate(points, closed=closed)
        drawing = svg_of(found)
        ElementTree.fromstring(drawing)
        assert "<style" not in drawing  # it would hold for the whole page
        assert ("torsion" in drawing) == (dimension == 3)
        axes: Any = gs.plot(found.spline, comb=True)
        assert axes.name == "3d"
        assert len(axes.lines) == 3
        line = np.stack(axes.lines[1].get_data_3d(), axis=1)
        size = np.hypot.reduce(np.diff(line[[0, -1]], axis=0)[0])
        assert dimension > 3 or np.allclose(line[0], points[0], atol=1e-5) or closed
        assert closed == (size < 1e-9)


def test_plot_draws_onto_the_axes_given(axes: Any, glyph: gs.GlyphResult) -> None:
    assert gs.plot(glyph, axes, comb=True, polygon=True, control_polygon=True, source=True) is axes
    curve = axes.patches[-1].get_path()
    np.testing.assert_array_equal(np.asarray(curve.vertices)[0], glyph.contours[0].curve.points[0])
    assert len(axes.lines) == 2
    np.testing.assert_array_equal(np.asarray(axes.lines[0].get_xydata())[:-1], glyph.contours[0].polygon)
    assert axes.get_aspect() == 1.0


def test_plot_does_not_close_an_open_arc(axes: Any) -> None:
    spline = gs.interpolate(L_SHAPE, closed=False).spline
    gs.plot(spline, axes, comb=True, edgecolor="red")
    curve = axes.patches[-1].get_path()
    np.testing.assert_allclose(np.asarray(curve.vertices)[[0, -1]], L_SHAPE[[0, -1]])
    assert len(curve.vertices) == 1 + 3 * (len(L_SHAPE) - 1)


def test_joins_are_told_apart() -> None:
    corners = joins(polygon_contour(L_SHAPE))
    np.testing.assert_allclose(np.abs(np.degrees(corners.turns)), 90)
    assert corners.of("corner", 0.001).all()
    assert corners.turns.sum() == pytest.approx(2 * np.pi)
    smooth = joins(ROUND)
    assert not any(smooth.of(kind, 0.001).any() for kind in ("corner", "G1", "G2"))
    # A stadium: straight sides of 100 and half circles of radius 50 meet with a jump of 1/50 in curvature.
    half = circle(50.0, 32)[:16]
    sides = [np.array([[-50.0, 0], [-50, -100]]), np.array([[50.0, -100], [50, 0]])]
    stadium = joins(gs.Contour.from_segments([*half, sides[0], *(-half - (0, 100)), sides[1]]))
    jumps = stadium.of("G2", 0.01)
    assert jumps.sum() == 4
    np.testing.assert_allclose(np.abs(stadium.jumps[jumps]), 1 / 50, rtol=1e-4)
    assert stadium.of("G2", 0.03).sum() == 0


def test_the_atlas_has_a_page_for_twelve_glyphs_and_one_for_each_profile(tmp_path: Path) -> None:
    font = str(ROOT / "fonts_test" / "kouzan-gyosho.ttf")
    for name in ("a.pdf", "b.pdf"):
        run = CliRunner().invoke(
            app, ["atlas", font, "--gids", "2-14", "--count", "24", "--profiles", "g", "--out", str(tmp_path / name)]
        )
        assert run.exit_code == 0, run.output
        assert "3 pages" in run.output
    pdf = (tmp_path / "a.pdf").read_bytes()
    assert pdf.count(b"/Type /Page ") == 3
    assert pdf == (tmp_path / "b.pdf").read_bytes()
    assert {path.name for path in tmp_path.iterdir()} == {"a.pdf", "b.pdf"}


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["--preset", "type"], "corners sharp, tolerance 1/1000 em, effort best"),
        (["--corners", "sharp", "--continuity", "g2", "--tolerance", "3"], "corners sharp, continuity g2, tolerance 3"),
    ],
)
def test_the_atlas_is_made_and_captioned_by_the_options(
    given: list[str], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[gs.GlyphResult] = []
    monkeypatch.setattr(atlas, "atlas_pages", lambda glyphs, scale, **_: drawn.__iadd__(glyphs))
    monkeypatch.setattr(atlas, "write_pages", lambda path, pages: len(pages))
    font = str(ROOT / "fonts_test" / "kouzan-gyosho.ttf")
    run = CliRunner().invoke(app, ["atlas", font, "--text", "O", *given, "--out", str(tmp_path / "a.pdf")])
    assert run.exit_code == 0, run.output
    (glyph,) = drawn
    for figure in (overview([("broken", "no outline"), glyph], 0.01, "Font"), profile(glyph, 0.01)):
        assert any(words in text.get_text() for text in figure.texts)


def test_the_profile_draws_curvature_over_arc_length(glyph: gs.GlyphResult) -> None:
    figure = profile(glyph, 1 / 200)
    curves = {line.get_label(): line.get_xydata() for axes in figure.axes for line in axes.lines}
    for name in ("source", "result"):
        np.testing.assert_allclose(curves[name][:, 1], 1000 / 200, rtol=0.05)
        assert curves[name][-1, 0] == pytest.approx(2 * np.pi * 0.2, rel=0.03)


def test_the_atlas_says_whose_comb_it_draws(glyph: gs.GlyphResult) -> None:
    for whose in ("source", "result"):
        figure = overview([glyph], 0.01, "Font", whose)
        words = "curvature of the source in 1/em, convex +" if whose == "source" else "curvature in 1/em, convex +"
        assert words in [axes.get_xlabel() for axes in figure.axes]


def test_an_atlas_shows_the_source_from_its_first_page_on(glyph: gs.GlyphResult) -> None:
    (both, bare) = (overview([glyph], 0.004, "a", combs) for combs in ("both", "result"))
    lines = [[patch for patch in page.axes[0].patches if patch.get_linestyle() != "solid"] for page in (both, bare)]
    assert [len(own) for own in lines] == [1, 0]
    tips = np.concatenate([part.tips for part in teeth(glyph, 0.004, "source")])
    assert len(lines[0][0].get_path().vertices) == len(tips) + len(glyph.contours)
    labels = [page.axes[1].get_xlabel() for page in (both, bare)]
    assert ["dashed: of the source" in label for label in labels] == [True, False]
    sharp = overview([glyph], 0.0005, "a", "result")
    cut = sum(int(part.cut.sum()) for part in teeth(glyph, 0.0005))
    assert cut > 1
    assert f"; dots: {cut} teeth cut at 1.25" in sharp.axes[1].get_xlabel()


def test_an_atlas_is_a_pdf_on_the_scale_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    call = ["atlas", str(ROOT / "fonts_test" / "kouzan-gyosho.ttf"), "--text", "O", "--count", "24"]
    refused = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "a.png")])
    assert refused.exit_code == 2
    assert "an atlas is a PDF" in refused.output
    assert not list(tmp_path.iterdir())
    scales: list[float] = []
    monkeypatch.setattr(atlas, "atlas_pages", lambda glyphs, scale, **_: scales.__iadd__([scale]))
    monkeypatch.setattr(atlas, "write_pages", lambda path, pages: len(pages))
    assert CliRunner().invoke(app, [*call, "--out", str(tmp_path / "a.pdf")]).exit_code == 0
    font = gs.open_font(ROOT / "fonts_test" / "kouzan-gyosho.ttf")
    make_atlas(font, ["O"], tmp_path / "b.pdf", gs.Options(count=24), maps=Maps("both", comb_scale=20.0), jobs=0)
    assert scales[1] == 20 / 1024 != scales[0]


def test_a_glyph_that_failed_is_named_in_the_atlas() -> None:
    figure = overview([("broken", "no outline")], 0.01, "Font")
    assert "broken: no outline" in [text.get_text() for axes in figure.axes for text in axes.texts]


@pytest.mark.needs("nbclient", "nbformat", "ipykernel")
def test_the_example_notebook_runs_and_keeps_no_outputs() -> None:
    import nbclient
    import nbformat

    path = ROOT / "glyphspline" / "examples" / "example.ipynb"
    notebook: Any = nbformat.read(path, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in code)
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
    nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(ROOT)}}).execute()
    shown = [kind for cell in code for output in cell.outputs for kind in output.get("data", {})]
    assert shown.count("image/svg+xml") >= 3
    assert "text/html" in shown
    assert "image/png" in shown


def test_showing_costs_nothing_until_something_is_shown() -> None:
    code = "import sys, glyphspline; print('matplotlib' in sys.modules, 'glyphspline.writers' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False", "False"]
