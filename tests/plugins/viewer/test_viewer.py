"""The viewer's answers, and whom it answers."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient
from svgpathtools import parse_path
from typer.testing import CliRunner

import glyphspline as gs
from glyphspline import compiled
from glyphspline.cli.app import app as shell
from glyphspline.fitting.closed_curves import History, recorded
from glyphspline.fitting.options import PRESETS, Continuity, Effort
from glyphspline.plugins.viewer import conversion
from glyphspline.plugins.viewer.app import first_glyph, make_app
from glyphspline.plugins.viewer.conversion import shown_steps
from glyphspline.types import FloatArray
from glyphspline.writers.svg.path_data import path_data
from tests.places import FONTS

HOST = "127.0.0.1:8642"
STATE = {"glyph": "O", "sampling": "count", "amount": 24, "variant": 2, "corners": "smooth"}


@pytest.fixture(scope="module")
def client() -> TestClient:
    app = make_app(FONTS / "kouzan-gyosho.ttf", hosts=(HOST,))
    return TestClient(app, base_url=f"http://{HOST}")


@pytest.fixture(scope="module")
def variable() -> TestClient:
    return TestClient(make_app(FONTS / "variable.ttf", hosts=(HOST,)), base_url=f"http://{HOST}")


def ask(client: TestClient, path: str = "glyph", **changes: Any) -> Any:
    answer = client.post(f"/api/{path}", json=STATE | changes)
    assert answer.status_code == 200, answer.text
    return answer.json()


def path_of(result: gs.GlyphResult) -> str:
    return path_data([contour.curve for contour in result.contours], 2)


def test_a_glyph_is_what_convert_gives(client: TestClient) -> None:
    found = ask(client)
    outline = gs.open_font(FONTS / "kouzan-gyosho.ttf").outline("O")
    result = gs.convert(outline, gs.Options(count=24))
    polygon = np.array(found["polygons"][0]) * (1, -1)
    np.testing.assert_allclose(polygon, result.contours[0].polygon, atol=0.006)
    assert found["result"] == path_of(result)
    assert found["measures"][0]["iterations"] == result.contours[0].measures.iterations
    assert ask(client, "svg")["svg"] == gs.to_svg(result)


@pytest.mark.parametrize(
    "changes",
    [
        {"variant": 3},
        {"sampling": "tolerance", "amount": 3},
        {"sampling": "tolerance", "amount": 3, "corners": "sharp", "continuity": "g2"},
        {"sampling": "tolerance", "amount": 3, "corners": "sharp", "effort": "best"},
    ],
)
def test_the_command_gives_the_drawing_that_was_seen(
    client: TestClient, changes: dict[str, Any], tmp_path: Path
) -> None:
    words = shlex.split(ask(client, **changes)["command"])
    assert words[:2] == ["glyphspline", "refit" if changes.get("continuity") == "g2" else "convert"]
    words[words.index("--out") + 1] = str(tmp_path)
    run = CliRunner().invoke(shell, [*words[1:], "--jobs", "0", "--quiet", "--format", "svg,curvature"])
    assert run.exit_code == 0, run.output
    (drawing,) = (tmp_path / "svg").iterdir()
    assert drawing.read_text() == ask(client, "svg", **changes)["svg"]


@pytest.mark.parametrize("corners", ["smooth", "sharp"])
def test_by_tolerance_the_result_is_within_it(client: TestClient, corners: str) -> None:
    found = ask(client, glyph="O", sampling="tolerance", amount=4, corners=corners)
    assert all(measures["within_tolerance"] for measures in found["measures"])
    assert len(found["residuals"]) >= len(found["polygons"])
    assert found["movable"] == [corners == "smooth"] * 2


def test_continuity_and_effort_reach_the_fit_and_the_command(client: TestClient) -> None:
    outline = gs.open_font(FONTS / "kouzan-gyosho.ttf").outline("O")
    chosen: list[tuple[Continuity, Effort]] = [("c2", "best"), ("g2", "fast")]
    for continuity, effort in chosen:
        found = ask(client, sampling="tolerance", amount=4, corners="sharp", continuity=continuity, effort=effort)
        options = gs.Options(tolerance=4, corners="sharp", continuity=continuity, effort=effort)
        assert found["result"] == path_of(gs.convert(outline, options))
        assert found["command"].startswith("glyphspline refit" if continuity == "g2" else "glyphspline convert")
        assert ("--preset type" in found["command"]) == (effort == "best")
        for measures in found["measures"] if continuity == "g2" else ():
            assert [measures[name] for name in ("iterations", "residual", "converged", "rate_bound")] == [None] * 4


def test_presets_are_those_of_the_shell(client: TestClient) -> None:
    font = client.get("/api/font").json()
    assert font["presets"].keys() == PRESETS.keys()
    for name, values in PRESETS.items():
        amount = values.get("thousandths", 1.0) * font["metrics"]["units_per_em"] / 1000
        usual = {key: value for key, value in font["defaults"].items() if key != "variant"} | {"amount": amount}
        chosen = {key: value for key, value in values.items() if key in usual}
        assert font["presets"][name] == usual | chosen


def test_sliding_and_resting_draw_the_same(client: TestClient) -> None:
    for sampling, amount in (("step", 60), ("count", 30)):
        sliding = ask(client, glyph="uni597D", sampling=sampling, amount=amount)
        resting = ask(client, glyph="uni597D", sampling=sampling, amount=amount, measure=True)
        assert sliding["result"] == resting["result"]
        assert sliding["polygons"] == resting["polygons"]
        assert sliding["measures"][0]["deviation"] is None
        assert resting["measures"][0]["deviation"] > 0


def test_other_variants_interpolate_the_same_polygon(client: TestClient) -> None:
    results = ask(client, "compare", sampling="tolerance", amount=4, corners="smooth")["results"]
    assert [result["variant"] for result in results] == [1, 2, 3]
    assert results[0]["polygons"] == results[1]["polygons"] == results[2]["polygons"]
    assert results[1]["result"] != results[2]["result"]
    assert results[1]["intervals"]
    assert not results[2]["intervals"], "variant 3 searches nothing"


def test_compared_variants_are_all_measured(client: TestClient) -> None:
    for result in ask(client, "compare", sampling="step", amount=40)["results"]:
        assert all(measures["bending_energy"] > 0 for measures in result["measures"])


def test_steps_go_from_the_polygon_to_the_result(client: TestClient) -> None:
    found, steps = ask(client), ask(client, "steps")["steps"]
    assert [step["step"] for step in steps] == list(range(len(steps)))
    vertices = [point for polygon in found["polygons"] for point in polygon]
    assert steps[0]["controls"] == vertices, "the polygon is the first control polygon"
    assert steps[-1]["result"] == found["result"]
    np.testing.assert_allclose(steps[-1]["feet"], vertices, atol=0.02)
    assert steps[-1]["error"] < 0.005 < steps[-2]["error"]
    assert [step["error"] for step in steps] == pytest.approx(
        [max(r[min(m, len(r) - 1)] for r in found["residuals"]) for m in range(len(steps))]
    )


@pytest.mark.parametrize("variant", [1, 2, 3, 4])
def test_a_run_is_made_once_for_all_of_its_steps(variant: int, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[gs.Options] = []

    def counted(polygon: FloatArray, options: gs.Options, updates: Iterable[int]) -> History:
        made.append(options)
        return recorded(polygon, options, updates)

    monkeypatch.setattr(conversion, "recorded", counted)
    glyph = gs.convert(gs.open_font(FONTS / "kouzan-gyosho.ttf").outline("O"), gs.Options(variant=variant, count=24))
    found = list(conversion.steps(glyph))
    assert len(made) == len(glyph.contours) == 2
    assert [m for m, _ in found] == shown_steps(conversion.updates_of(glyph))
    for m, curves in found:
        stopped = gs.convert(glyph.outline, gs.Options(variant=variant, count=24, max_iterations=m))
        for curve, contour in zip(curves, stopped.contours, strict=True):
            own = contour.interpolations[0]
            np.testing.assert_allclose(curve.spline.control_points, own.spline.control_points, atol=1e-6)
            np.testing.assert_allclose(curve.parameters, own.parameters, atol=1e-4)
            assert curve.max_error == pytest.approx(own.max_error, abs=1e-6)


def test_opens_on_defaults_and_never_on_notdef(client: TestClient, tmp_path: Path) -> None:
    font = client.get("/api/font").json()
    assert font["defaults"] == {
        "variant": 2, "corners": "sharp", "continuity": "c2", "effort": "fast",
        "sampling": "tolerance", "amount": 1.024,
    }  # fmt: skip
    units = {name: unit for name, _, unit, about in font["measures"] if about}
    assert list(units) == [name for name, *_ in font["measures"]]
    assert (units["max_curvature"], units["bending_energy"], units["deviation"]) == ("1/em", "1/em", "units")
    for path in sorted(FONTS.glob("*.[to]t[fc]")):
        work = conversion.Work(path)
        first = first_glyph(work)
        assert first != ".notdef"
        assert work.has_ink(first)


def test_long_iterations_are_thinned_out() -> None:
    assert shown_steps(10) == list(range(11))
    assert len(shown_steps(1000)) <= 61
    assert {0, 1000} < set(shown_steps(1000))


def test_the_curve_follows_a_moved_vertex(client: TestClient) -> None:
    before = ask(client)
    x, y = before["polygons"][0][5]
    after = ask(client, moved=[[0, 5, x + 30, -y + 10]])
    assert after["polygons"][0][5] == pytest.approx([x + 30, y - 10])
    assert after["polygons"][1] == before["polygons"][1]
    np.testing.assert_allclose(after["feet"][5], [x + 30, y - 10], atol=0.02)
    assert ask(client, moved=[[99, 0, 0, 0], [0, 9999, 0, 0]])["polygons"] == before["polygons"]


def test_axes_of_a_variable_font_change_the_source(variable: TestClient) -> None:
    axis = variable.get("/api/font").json()["axes"][0]
    ends = [ask(variable, glyph="o", location={axis["tag"]: axis[end]})["source"] for end in ("minimum", "maximum")]
    assert ends[0] != ends[1]
    found = ask(variable, glyph="o", location={axis["tag"]: axis["maximum"]})
    assert f"{axis['tag']}={axis['maximum']:g}" in found["command"]


def test_a_variable_glyph_is_sent_at_a_location(variable: TestClient) -> None:
    found = ask(variable, "masters", glyph="o", location={"wght": 650}, sampling="tolerance", amount=1, corners="sharp")
    masters = gs.open_font(FONTS / "variable.ttf").masters("o")
    result = gs.convert_masters(masters, gs.Options(corners="sharp", tolerance=1.0))
    assert found["masters"] == len(masters) > 1
    for side, outline in (("source", masters), ("result", result)):
        drawn = outline.instance({"wght": 650})
        assert found[side]["path"] == path_data(drawn.contours, 4)
        assert found[side]["segments"] == sum(map(len, drawn.contours))
    assert found["result"]["turn"] == pytest.approx(result.turn({"wght": 650}), abs=1e-6)
    assert 0 < found["bound"] <= 1
    words = shlex.split(found["command"])
    assert words[:2] == ["glyphspline", "atlas"]
    assert words[words.index("--axis") + 1] == "wght"


def test_a_line_of_text_is_drawn_with_the_options_of_the_glyph(client: TestClient) -> None:
    found = client.post("/api/text", json=STATE | {"text": "gA龍x"}).json()
    assert found["svg"].count("<use ") == 4
    assert found["notes"] == ["no glyph for x"]
    path = re.search(r'<path id="g1-[0-9a-f]+" d="([^"]*)"', found["svg"])
    name = gs.open_font(FONTS / "kouzan-gyosho.ttf").cmap[ord("A")]
    assert path
    line, glyph = (
        np.array([piece.bpoints() for piece in parse_path(data)])
        for data in (path[1], client.post("/api/glyph", json=STATE | {"glyph": name}).json()["result"])
    )
    np.testing.assert_allclose(line, glyph, atol=0.08)  # rounded to 0.1 and to 0.01
    assert "error" in client.post("/api/text", json=STATE | {"text": "a" * 501}).json()
    assert "at least one" in client.post("/api/text", json=STATE | {"text": ""}).json()["error"]


def test_masters_are_of_variable_fonts(client: TestClient) -> None:
    answer = client.post("/api/masters", json=STATE | {"sampling": "tolerance", "amount": 1, "corners": "sharp"})
    assert answer.status_code == 400
    assert "not a variable font" in answer.json()["error"]


def test_glyphs_are_found_by_character_code_index_and_name(client: TestClient) -> None:
    for words in ("龍", "U+9F8D", "uni9F8D", "17"):
        names = [glyph["name"] for glyph in client.get("/api/glyphs", params={"words": words}).json()["glyphs"]]
        assert names[0] == "uni9F8D", words
    assert client.get("/api/glyphs", params={"words": "no such glyph"}).json() == {"glyphs": [], "more": False}


@pytest.mark.parametrize(
    "change",
    [
        {"glyph": "nothing"}, {"glyph": 3}, {"variant": 7}, {"variant": True},
        {"sampling": "eval"}, {"amount": None}, {"corners": []}, {"location": [1]}, {"location": {"wght": 3}},
        {"continuity": "g3"}, {"effort": 1},
        {"corners": "sharp"}, {"moved": [[1, 2, 3]]}, {"moved": [[0, 0, 1e999, 0]]}, {"moved": [[0, 0, 0, 0]] * 1001},
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_and_not_computed(client: TestClient, change: dict[str, Any]) -> None:
    body = json.dumps(STATE | change).encode()
    answer = client.post("/api/glyph", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 400
    assert answer.json()["error"]


def test_amounts_without_end_are_bounded(client: TestClient) -> None:
    assert ask(client, amount=1e12)["measures"][0]["vertices"] <= 1000
    assert ask(client, sampling="step", amount=1e-12)["command"].count("--step 1.024")


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, 200),
        ({"host": "evil.example"}, 403),
        ({"host": "127.0.0.1:1"}, 403),
        ({"origin": f"http://{HOST}"}, 200),
        ({"origin": "http://evil.example"}, 403),
        ({"origin": "null"}, 403),
        ({"sec-fetch-site": "cross-site"}, 403),
        ({"sec-fetch-site": "same-origin"}, 200),
    ],
)
def test_only_its_own_pages_are_answered(client: TestClient, headers: dict[str, str], status: int) -> None:
    for path in ("/", "/api/font", "/static/viewer.js"):
        assert client.get(path, headers=headers).status_code == status
    assert client.post("/api/glyph", json=STATE, headers=headers).status_code == status


def test_every_answer_carries_the_policy(client: TestClient) -> None:
    for path in ("/", "/static/viewer.css", "/static/none", "/api/font", "/nowhere"):
        policy = client.get(path).headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "unsafe" not in policy
    page = client.get("/").text
    assert not re.search(r"\son\w+=|style=|<script>", page), "nothing inline, which the policy would refuse"


def test_nothing_outside_the_page_is_served(client: TestClient) -> None:
    for name in ("work.py", "..%2Fapp.py", "%2Fetc%2Fpasswd", "../state.py"):
        assert client.get(f"/static/{name}").status_code == 404
    plain = client.post("/api/glyph", content=b"{}", headers={"content-type": "text/plain"})
    assert plain.status_code == 403, "what a form of another page could send"
    long = client.post("/api/glyph", content=b" " * 300_000, headers={"content-type": "application/json"})
    assert long.status_code == 413


def test_says_what_is_compiled_while_it_is(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "_spent", 0.0)  # other tests of this process may have run as plain Python
    assert client.get("/api/compiling").json() == {"words": ""}
    monkeypatch.setattr(compiled, "hint", lambda: "running as plain Python")
    assert client.get("/api/compiling").json() == {"words": "running as plain Python"}
