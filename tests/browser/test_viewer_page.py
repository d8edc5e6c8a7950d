from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import expect

import glyphspline as gs
from tests.browser.curves import off
from tests.places import GYOSHO as FONT

RESULT = "#picture .result"


@pytest.fixture
def shown(page: Any, viewer: str) -> Any:
    """The viewer's page with the first glyph drawn, and waiting for nothing."""
    page.goto(viewer)
    page.wait_for_selector(RESULT, state="attached")
    rests(page)
    return page


def rests(page: Any) -> None:
    """Wait until no answer is awaited."""
    page.wait_for_selector("main[aria-busy=false]")


def path(page: Any) -> str:
    return str(page.locator(RESULT).get_attribute("d"))


def changes(page: Any, act: Any) -> str:
    """The curve after something that has to change it, once the last answer is in."""
    before = path(page)
    act()
    page.wait_for_function("d => document.querySelector('#picture .result')?.getAttribute('d') !== d", arg=before)
    rests(page)
    return path(page)


@pytest.fixture
def smooth(shown: Any) -> Any:
    """The page with one curve a contour, whose iteration it plays and whose vertices it moves."""
    changes(shown, lambda: shown.locator("[name=preset][value=paper]").check(force=True))
    return shown


def test_opens_on_the_dragon_with_its_measures_and_command(shown: Any) -> None:
    assert "uni9F8D" in shown.locator("#title").inner_text()
    assert shown.locator("#measures tr").count() > 5
    assert 1 < shown.locator("#chart .line").count() < shown.locator("#measures tr:first-child th").count()
    words = shlex.split(shown.locator("#command").inner_text())
    assert words[:2] == ["glyphspline", "convert"]
    assert "--step" in words or "--tolerance" in words


def test_the_curve_follows_the_sliders(smooth: Any) -> None:
    changes(smooth, lambda: smooth.locator("#amount").fill("80"))
    changes(smooth, lambda: smooth.locator("[name=variant][value='3']").check(force=True))
    assert "--variant 3" in smooth.locator("#command").inner_text()
    changes(smooth, lambda: smooth.locator("[name=variant][value='2']").check(force=True))
    changes(smooth, lambda: smooth.locator("[name=sampling][value=count]").check(force=True))
    assert "--count" in smooth.locator("#command").inner_text()


def test_presets_and_continuity(shown: Any) -> None:
    choice = "[name={}][value={}]".format
    assert shown.locator("[name=preset]:checked").count() == 0
    changes(shown, lambda: shown.locator(choice("preset", "type")).check(force=True))
    for name, value in (("corners", "sharp"), ("sampling", "tolerance"), ("continuity", "c2"), ("effort", "best")):
        assert shown.locator(choice(name, value)).is_checked()
    assert "--preset type" in shown.locator("#command").inner_text()
    shown.locator("#compare").check()
    shown.locator("#compared figure").nth(2).wait_for()
    changes(shown, lambda: shown.locator(choice("continuity", "g2")).check(force=True))
    assert "glyphspline refit" in shown.locator("#command").inner_text()
    assert shown.locator("[name=preset]:checked").count() == 0
    assert shown.locator(choice("variant", "'2'")).is_disabled()
    assert shown.locator("#compared").is_hidden()
    for row in ("iterations", "residual", "converged", "rate_bound"):
        cells = shown.locator(f"#measures tr[data-measure={row}] td").all_inner_texts()
        assert cells
        assert set(cells) == {"–"}, "nothing is iterated"
    assert shown.locator("#chart").inner_text() == "–"
    assert "undefined" not in shown.locator("body").inner_text()
    changes(shown, lambda: shown.locator(choice("preset", "paper")).check(force=True))
    assert shown.locator("[name=preset]:checked").get_attribute("value") == "paper"
    assert shown.locator(choice("continuity", "g2")).is_disabled(), "smooth curves are C2"
    assert shown.locator(choice("variant", "'2'")).is_enabled()


def test_another_glyph_by_search_and_by_arrow_keys(shown: Any) -> None:
    changes(shown, lambda: shown.locator("#words").fill("O"))
    assert shown.locator("#title").inner_text() == "O"
    shown.locator("#words").fill("")
    shown.locator("#glyphs [role=option]").nth(15).wait_for()
    shown.locator("#glyphs").focus()
    changes(shown, lambda: shown.keyboard.press("ArrowRight"))
    assert shown.locator("#glyphs [aria-selected=true]").get_attribute("data-name") != "O"


def test_variants_side_by_side(shown: Any) -> None:
    shown.locator("#compare").check()
    shown.locator("#compared figure").nth(2).wait_for()
    captions = shown.locator("#compared figcaption b").all_inner_texts()
    assert captions == ["variant 1", "variant 2", "variant 3"]
    drawn = [shown.locator("#compared .result").nth(i).get_attribute("d") for i in range(3)]
    assert drawn[1] == path(shown)
    assert drawn[2] not in drawn[:2], "variants 1 and 2 are close to each other, 3 is not"


def test_the_iteration_is_played_from_the_polygon_to_the_result(smooth: Any) -> None:
    final = path(smooth)
    changes(smooth, lambda: smooth.locator("#play").click())
    first = path(smooth)
    assert "error" in smooth.locator("#step-out").inner_text()
    assert smooth.locator("#picture .ties").get_attribute("d") != "", "vertices are tied to their footpoints"
    assert changes(smooth, lambda: None) != first
    smooth.wait_for_function("() => document.getElementById('step-out').textContent === 'result'")
    assert path(smooth) == final


def test_a_vertex_is_dragged_and_put_back(smooth: Any) -> None:
    before = path(smooth)
    start = smooth.evaluate(
        """() => { const svg = document.getElementById('picture'), m = svg.getScreenCTM();
             const [x, y] = svg.querySelector('.vertices').getAttribute('d').match(/-?[\\d.]+/g).map(Number);
             return [m.a * x + m.e, m.d * y + m.f]; }"""
    )

    def drag() -> None:
        smooth.mouse.move(*start)
        smooth.mouse.down()
        smooth.mouse.move(start[0] + 30, start[1] - 20, steps=4)
        smooth.mouse.up()

    changes(smooth, drag)
    assert smooth.locator("#moved-note").is_visible()
    changes(smooth, lambda: smooth.locator("#restore").click())
    assert path(smooth) == before


def test_saves_the_drawing(shown: Any, tmp_path: Path) -> None:
    with shown.expect_download() as waiting:
        shown.locator("#save").click()
    waiting.value.save_as(tmp_path / "saved.svg")
    assert off(path(shown), (tmp_path / "saved.svg").read_text()) < 0.1


def test_on_a_phone_nothing_is_wider_than_the_screen(shown: Any) -> None:
    shown.set_viewport_size({"width": 375, "height": 740})
    assert shown.evaluate("document.documentElement.scrollWidth") <= 375
    assert shown.locator(".stage").bounding_box()["y"] < 300


def test_says_that_the_server_compiles_until_the_answer_comes(page: Any, viewer: str) -> None:
    held: list[Any] = []
    page.route("**/api/compiling", lambda route: route.fulfill(json={"words": "compiling once: 1 of 2"}))
    page.route("**/api/glyph", lambda route: held.append(route))
    page.goto(viewer)
    expect(page.locator("#about")).to_have_text("compiling once: 1 of 2")
    page.unroute("**/api/glyph")
    for route in held:
        route.continue_()
    expect(page.locator("#about")).to_contain_text("contours")


def test_opens_on_the_command_lines_defaults(shown: Any) -> None:
    chosen = {name: shown.locator(f"[name={name}]:checked").get_attribute("value") for name in
              ("variant", "sampling", "corners", "effort")}  # fmt: skip
    assert chosen == {"variant": "2", "sampling": "tolerance", "corners": "sharp", "effort": "fast"}
    assert shown.locator("#amount-out").inner_text() == "1.024 units"
    glyph = gs.convert(gs.open_font(FONT).outline("uni9F8D"))
    assert off(path(shown), gs.to_svg(glyph)) < 0.1


def test_a_glyph_that_is_not_there_is_said_to_be_none(shown: Any) -> None:
    note = shown.locator("#no-glyph")
    assert note.is_hidden()
    shown.locator("#words").fill("no such glyph")
    expect(note).to_be_visible()
    assert "uni9F8D" in shown.locator("#title").inner_text(), "what is shown stays"
    shown.locator("#words").fill("")
    expect(note).to_be_hidden()


def test_the_first_key_press_on_the_iteration_counts(smooth: Any) -> None:
    final = int(smooth.locator("#step").get_attribute("max"))
    assert smooth.locator("#step").input_value() == str(final)
    with smooth.expect_response("**/api/steps") as waiting:
        smooth.locator("#step").focus()
        smooth.keyboard.press("ArrowLeft")
    steps = waiting.value.json()["steps"]
    assert len(steps) == final
    expect(smooth.locator("#step-out")).to_contain_text(f"{steps[-1]['step']}, error")
    smooth.keyboard.press("Home")
    expect(smooth.locator("#step-out")).to_contain_text("0, error")
    assert path(smooth) == steps[0]["result"]
    smooth.keyboard.press("End")
    expect(smooth.locator("#step-out")).to_have_text("result")


def test_combs_of_source_and_result_and_their_gain(shown: Any) -> None:
    for layer in ("source-comb", "comb"):
        shown.locator(f"[data-layer={layer}]").check(force=True)
        shown.locator(f"#picture .{layer} .tips").wait_for(state="attached")
    tips = shown.locator("#picture .source-comb .tips")
    plain = tips.get_attribute("d")
    size = "() => document.querySelector('#picture .source-comb').getBBox().height"
    before = shown.evaluate(size)
    shown.locator("#gain").fill("3")
    assert shown.locator("#gain-out").inner_text() == "8×"
    assert tips.get_attribute("d") != plain
    assert shown.evaluate(size) > before
    assert "convex" in shown.locator("#legend").inner_text()


def test_measures_have_units_and_overshoot_is_asked_for(shown: Any) -> None:
    row = shown.locator("#measures tr[data-measure=max_curvature]")
    assert row.locator("th").inner_text() == "largest curvature 1/em"
    assert shown.locator("#measures tr[data-measure=overshoot]").count() == 0
    shown.locator("#every").check()
    shown.locator("#measures tr[data-measure=overshoot]").wait_for()


@pytest.fixture
def along(page: Any, variable_viewer: str) -> Any:
    """The page of a variable font with source and result side by side."""
    page.goto(variable_viewer)
    page.wait_for_selector(RESULT, state="attached")
    page.locator("#along").check()
    page.wait_for_selector("#beside .source-comb .tips", state="attached")
    rests(page)
    return page


TIPS = {"source": "#beside .source-comb .tips", "result": "#picture .comb .tips"}


def test_axis_sliders_move_the_combs_of_source_and_result(along: Any) -> None:
    assert along.locator("#axes > label input").count() == 3, "the others are in a list"
    assert along.locator("#axes details input").count() == 2
    turn = along.locator("#source-turn")
    expect(turn).to_have_text("source: largest turn 0.0°")
    before = {whose: along.locator(tips).get_attribute("d") for whose, tips in TIPS.items()}
    milliseconds = along.evaluate(
        """async () => {
            const slider = document.querySelector("[data-axis=wght]"), start = performance.now();
            const beside = document.querySelector("#beside");
            const changed = new Promise((done) => new MutationObserver(done).observe(beside, { childList: true }));
            slider.value = "650";
            slider.dispatchEvent(new Event("input"));
            await changed;
            return performance.now() - start;
        }"""
    )
    sys.stdout.write(f"a change shows after {milliseconds:.1f} ms\n")
    for whose, tips in TIPS.items():
        assert along.locator(tips).get_attribute("d") != before[whose]
    expect(turn).not_to_have_text("source: largest turn 0.0°")
    expect(along.locator("#result-turn")).to_have_text("result: largest turn 0.0°")
    along.locator("#beside .kink").wait_for(state="attached")
    assert along.locator("#picture .kink").count() == 0


def test_both_drawings_show_the_same_part(along: Any) -> None:
    boxes = [along.locator(place) for place in ("#beside", "#picture")]
    for act in (
        lambda: along.locator("[aria-label='Zoom in']").click(),
        lambda: boxes[0].dblclick(position={"x": 40, "y": 90}),
    ):
        before = boxes[1].get_attribute("viewBox")
        act()
        expect(boxes[1]).not_to_have_attribute("viewBox", before)
        assert boxes[0].get_attribute("viewBox") == boxes[1].get_attribute("viewBox")


def test_the_page_goes_back_to_one_location(along: Any) -> None:
    assert "glyphspline atlas" in along.locator("#command").inner_text()
    along.locator("[data-axis=wght]").fill("650")
    expect(along.locator("#command")).to_contain_text("wght=650")
    along.locator("#along").uncheck()
    expect(along.locator("#command")).to_contain_text("glyphspline convert")
    rests(along)
    assert along.locator("#beside").is_hidden()
    assert along.locator(RESULT).count() == 1
    assert along.locator("#step").is_visible()


def test_the_page_mixes_masters_as_the_font_does(along: Any) -> None:
    """Against the outline that HarfBuzz draws there, along two axes."""
    for tag, value in (("wght", "650"), ("wdth", "30")):
        along.locator(f"[data-axis={tag}]").fill(value)
    rests(along)
    distance = along.evaluate(
        """async (location) => {
            const body = JSON.stringify({ glyph: "k", location, sampling: "tolerance", amount: 5 });
            const headers = { "content-type": "application/json" };
            const answer = await fetch("/api/glyph", { method: "POST", headers, body });
            const points = (data) => GS.contours(data).flat(2);
            const drawn = points(document.querySelector("#beside .source").getAttribute("d"));
            const read = points((await answer.json()).source);
            if (drawn.length !== read.length || !read.length) return Infinity;
            return Math.max(...read.map(([x, y], i) => Math.hypot(x - drawn[i][0], y - drawn[i][1])));
        }""",
        {"wght": 650, "wdth": 30},
    )
    assert distance < 0.1


def test_a_text_is_drawn_and_its_glyphs_are_chosen(shown: Any) -> None:
    shown.fill("#text", "gA龍")
    uses = shown.locator("#text-line use")
    expect(uses).to_have_count(3)
    rests(shown)
    before = shown.locator("#text-line").inner_html()
    changes(shown, uses.nth(1).click)
    assert shown.locator("#title").inner_text().startswith("A")
    expect(shown.locator("#text-line use.chosen")).to_have_count(1)
    changes(shown, lambda: shown.locator("#amount").fill("95"))
    assert shown.locator("#text-line").inner_html() != before
    with shown.expect_download() as saved:
        shown.locator("#save-text").click()
    assert saved.value.suggested_filename == "text.svg"
    shown.fill("#text", "")
    expect(shown.locator("#text-line")).to_be_hidden()
