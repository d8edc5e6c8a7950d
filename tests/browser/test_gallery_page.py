from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import expect

import glyphspline as gs
from glyphspline.plugins.fonts.spec import RefitSpec
from glyphspline.plugins.masters.job import convert_font_masters
from glyphspline.report.gallery import write_report
from glyphspline.runs.schedule import InProcess
from glyphspline.writers.svg.path_data import curves_data
from tests.browser.curves import off
from tests.places import FONTS


def opened(page: Any, folder: Path) -> Any:
    page.goto((folder / "index.html").as_uri())
    page.wait_for_selector("body[data-ready]")
    return page


def focused(page: Any, name: str) -> None:
    """Wait until the focus is on the card of this name."""
    page.wait_for_function("name => document.activeElement?.querySelector('b')?.textContent === name", arg=name)


def names(page: Any) -> list[str]:
    """Of the cards in view, in their order."""
    cells = page.locator(".cell").evaluate_all(
        "cells => cells.map(c => [+c.getAttribute('aria-posinset'), c.querySelector('b').textContent])"
    )
    return [name for _, name in sorted(cells)]


def test_shows_every_glyph_of_a_run_with_its_drawing(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    assert page.locator("#count").inner_text() == "18 glyphs"
    assert page.locator("#options").inner_text() == "variant 2, margin 0.02, corners smooth, count 24"
    assert len(names(page)) == 18
    page.wait_for_function("() => document.querySelectorAll('.card .result').length === 17")  # all but the space
    drawn = page.locator(".card:has(b:text-is('O')) .result").get_attribute("d")
    svg = (gallery / "kouzan-gyosho" / "svg" / "O.svg").read_text()
    assert off(drawn, svg) < 0.1


def test_several_fonts_side_by_side(page: Any, gallery: Path) -> None:
    opened(page, gallery)
    assert page.locator("#count").inner_text() == "26 glyphs"
    assert page.locator("#options").inner_text() == ""
    page.select_option("#run", "variable")
    assert page.locator("#options").inner_text().endswith("step 90")
    assert page.locator("#count").inner_text() == "8 of 26 glyphs"
    assert page.locator(".card .font").first.inner_text().strip() != ""
    page.locator(".card:not(.empty)").first.click()
    assert "Regular" in page.locator("[data-part=about]").inner_text()


def test_search_sort_and_limits(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    for words in ("龍", "u+9f8d", "uni9F8D"):
        page.fill("#words", words)
        page.wait_for_function("() => document.getElementById('count').textContent === '1 of 18 glyphs'")
        assert names(page) == ["uni9F8D"]
    page.fill("#words", "")
    page.wait_for_function("() => document.getElementById('count').textContent === '18 glyphs'")
    page.select_option("#sort", "deviation")
    entries = [json.loads(line) for line in (gallery / "kouzan-gyosho" / "manifest.jsonl").read_text().splitlines()]
    worst = {e["glyph"]: max((c["deviation"] for c in e["contours"]), default=-1.0) for e in entries}
    assert names(page) == sorted(worst, key=lambda name: -worst[name])
    limit = sorted(worst.values())[-5]
    page.fill("#least", str(limit * 0.999))
    page.wait_for_function("() => document.getElementById('count').textContent === '5 of 18 glyphs'")
    page.uncheck("#down")
    assert names(page) == sorted(worst, key=lambda name: worst[name])[-5:]
    page.select_option("#show", "empty")
    assert page.locator("#count").inner_text().startswith("0 of")


def test_glyphs_that_enclose_something_else_are_found_and_say_so(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    entries = [json.loads(line) for line in (gallery / "kouzan-gyosho" / "manifest.jsonl").read_text().splitlines()]
    crossing = {e["glyph"]: sum(c["new_crossings"] for c in e["contours"]) for e in entries}
    changed = {e["glyph"] for e in entries if any(c["new_crossings"] or c["collapsed"] for c in e["contours"])}
    page.select_option("#show", "changed")
    page.wait_for_function(
        "count => document.getElementById('count').textContent === count", arg=f"{len(changed)} of 18 glyphs"
    )
    assert set(names(page)) == changed != set()
    for name in sorted(changed):
        fact = page.locator(f".card:has(b:text-is('{name}')) .fact").inner_text()
        assert (f"new crossings: {crossing[name]}" in fact) == (crossing[name] > 0)


@pytest.mark.parametrize(
    "layer", ["source", "result", "polygon", "vertices", "control", "source-comb", "comb", "coloured"]
)
def test_each_layer_is_switched(page: Any, gallery: Path, layer: str) -> None:
    opened(page, gallery / "kouzan-gyosho")
    box = page.locator(f"header [data-layer={layer.replace('coloured', 'colour')}]")
    shape = page.locator(f".card:has(b:text-is('g')) .{layer}")
    before = box.is_checked()
    for wanted in (not before, before):
        box.set_checked(wanted, force=True)
        expect(shape.locator("visible=true")).to_have_count(int(wanted))


def test_a_glyph_large_zoomed_and_faded(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    page.locator(".card:has(b:text-is('uni9F8D'))").click()
    picture = page.locator("[data-part=picture]")
    page.wait_for_selector("[data-part=picture] .result")
    start = [float(v) for v in picture.get_attribute("viewBox").split()]
    box = picture.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.wheel(0, -600)
    width = "document.querySelector('[data-part=picture]').getAttribute('viewBox').split(' ')[2]"
    page.wait_for_function(f"least => {width} < least", arg=start[2] / 2)
    zoomed = [float(v) for v in picture.get_attribute("viewBox").split()]
    assert zoomed[0] + zoomed[2] / 2 == pytest.approx(start[0] + start[2] / 2, abs=start[2] / 200), "about the pointer"
    page.mouse.down()
    page.mouse.move(box["x"] + 100, box["y"] + 100, steps=3)
    page.mouse.up()
    assert picture.get_attribute("viewBox") != " ".join(map(str, zoomed))
    page.keyboard.press("0")
    assert [float(v) for v in picture.get_attribute("viewBox").split()] == pytest.approx(start)
    page.locator("[data-part=fade]").fill("100")
    opacity = "s => getComputedStyle(document.querySelector(`[data-part=picture] ${s}`)).opacity"
    assert (page.evaluate(opacity, ".source"), page.evaluate(opacity, ".result")) == ("0", "1")
    page.locator("[data-part=fade]").fill("0")
    assert (page.evaluate(opacity, ".source"), page.evaluate(opacity, ".result")) == ("1", "0")
    assert page.locator(".side tbody tr").count() > 5


def test_by_keyboard_alone(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    page.keyboard.press("/")
    assert page.evaluate("document.activeElement.id") == "words"
    page.locator("#list [tabindex='0']").focus()
    for key in ("ArrowRight", "ArrowRight", "End", "ArrowLeft"):
        page.keyboard.press(key)
    before_last, last = names(page)[-2:]
    focused(page, before_last)
    page.keyboard.press("Enter")
    assert page.locator("#detail-title").inner_text().endswith(before_last)
    page.keyboard.press("]")
    page.wait_for_function("() => document.querySelector('[data-part=count]').textContent === '18 of 18'")
    page.keyboard.press("c")
    page.wait_for_selector("[data-part=picture] .comb path", state="attached")
    page.keyboard.press("Escape")
    focused(page, last)  # a dialog tells of its closing a moment later


def test_what_a_screen_reader_is_told(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    unnamed = page.evaluate(
        """() => [...document.querySelectorAll('button, input, select, [role=img]')].filter(e => e.checkVisibility() &&
           !e.getAttribute('aria-label') && !e.labels?.length && !e.textContent.trim()).map(e => e.outerHTML)"""
    )
    assert unnamed == []
    assert page.locator("[role=listitem]").first.get_attribute("aria-setsize") == "18"
    assert page.locator("#count").get_attribute("aria-live") == "polite"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_stands_out_in_both_themes(page: Any, gallery: Path, scheme: str) -> None:
    page.emulate_media(color_scheme=scheme)
    opened(page, gallery / "kouzan-gyosho")
    ratio = """selector => {
      const linear = v => v <= .03928 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4;
      const light = c => { const [r, g, b] = c.match(/[\\d.]+/g).map(v => linear(v / 255));
        return .2126 * r + .7152 * g + .0722 * b; };
      const e = document.querySelector(selector);
      let under = e; while (getComputedStyle(under).backgroundColor === 'rgba(0, 0, 0, 0)') under = under.parentElement;
      const colours = [getComputedStyle(e).color, getComputedStyle(under).backgroundColor];
      const [a, b] = colours.map(light).sort((x, y) => y - x);
      return (a + .05) / (b + .05); }"""
    for selector in ("h1", "#count", ".card .name", ".card:not(.empty) .fact", ".layers label", ".controls label"):
        assert page.evaluate(ratio, selector) > 4.5, selector


def test_twenty_thousand_glyphs_are_a_few_cards_at_a_time(page: Any, tmp_path: Path) -> None:
    contour = {"vertices": 10, "iterations": 5, "converged": True, "deviation": 0.5}
    entries: Any = (
        {"glyph": f"g{gid}", "gid": gid, "unicodes": [], "advance": 1000, "status": "ok", "files": {},
         "contours": [contour | {"deviation": gid % 997}], "error": None}
        for gid in range(20_000)
    )  # fmt: skip
    write_report(tmp_path, entries, {})
    opened(page, tmp_path)
    assert page.locator("#count").inner_text() == "20000 glyphs"
    for share in (0.25, 0.5, 1.0):
        page.evaluate(
            "share => { const g = document.getElementById('grid'); g.scrollTop = share * g.scrollHeight; }", share
        )
        expect(page.locator(f".card b:text-is('g{int(share * 19_999)}')")).to_be_attached()
        assert page.locator(".cell").count() < 120
    assert names(page)[-1] == "g19999"
    page.select_option("#sort", "deviation")
    expect(page.locator(".cell[aria-posinset='1'] .fact")).to_have_text("996 units deviation")


def test_prints_cards_in_columns(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    page.emulate_media(media="print")
    assert page.locator(".controls").is_hidden()
    # The page hears of the new medium a moment later, and draws its cards anew: 18 of them, five in a row.
    page.wait_for_function(
        "() => { const tops = [...document.querySelectorAll('.cell')].map((c) => c.getBoundingClientRect().top);"
        " return tops.length === 18 && new Set(tops).size === 4; }"
    )
    assert page.pdf().startswith(b"%PDF")


def test_on_a_phone_nothing_is_wider_than_the_screen(page: Any, gallery: Path) -> None:
    page.set_viewport_size({"width": 375, "height": 740})
    opened(page, gallery / "kouzan-gyosho")
    assert page.evaluate("document.documentElement.scrollWidth") <= 375
    page.locator(".card:has(b:text-is('g'))").click()
    page.wait_for_selector("[data-part=picture] .result")
    assert page.locator(".stage").bounding_box()["height"] > 200
    assert page.locator("#detail").evaluate("d => d.scrollWidth <= d.clientWidth")


def test_every_measure_has_its_unit_and_meaning(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    lines = [json.loads(line) for line in (gallery / "kouzan-gyosho" / "manifest.jsonl").read_text().splitlines()]
    (contours,) = (line["contours"] for line in lines if line["glyph"] == "O")
    page.locator(".card:has(b:text-is('O'))").click()
    row = page.locator("[data-measure=max_curvature]")
    assert row.locator("th").inner_text() == "largest curvature 1/em"
    assert "1/radius" in row.get_attribute("title")
    shown = [float(cell.replace("\N{MINUS SIGN}", "-")) for cell in row.locator("td").all_inner_texts()]
    assert shown == pytest.approx([1024 * contour["max_curvature"] for contour in contours], rel=5e-3)
    assert page.locator("[data-measure=deviation] th").inner_text() == "deviation units"
    overshoot = page.locator("[data-measure=overshoot]")
    expect(overshoot).to_have_count(0)
    page.locator("[data-part=facts] input").check()
    expect(overshoot).to_have_count(1)
    assert page.locator("#sort option[value=bending_energy]").text_content() == "bending energy, 1/em"


def test_nothing_found_is_said_and_exact_matches_come_first(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    assert page.locator("#none").is_hidden()
    page.fill("#words", "no such")
    expect(page.locator("#none")).to_be_visible()
    assert page.locator("#csv").is_disabled()
    page.fill("#words", "a")
    expect(page.locator(".cell[aria-posinset='1'] b")).to_have_text("a")
    assert names(page)[1] == "A"
    assert "ampersand" in names(page)[2:]


def test_a_link_opens_a_glyph(page: Any, gallery: Path) -> None:
    opened(page, gallery)
    page.locator(".card:has(b:text-is('uni9F8D'))").click()
    address = page.url
    assert address.endswith("#kouzan-gyosho/17")
    page.keyboard.press("Escape")
    page.wait_for_function("() => location.hash === ''")
    page.goto("about:blank")
    page.goto(address)
    expect(page.locator("#detail-title")).to_have_text("龍  uni9F8D")
    page.keyboard.press("Escape")
    page.wait_for_function("() => location.hash === ''")
    page.fill("#words", "g")
    page.wait_for_function("() => document.getElementById('count').textContent.includes(' of ')")
    page.evaluate("location.hash = '#kouzan-gyosho/17'")
    expect(page.locator("#detail-title")).to_have_text("龍  uni9F8D")
    assert page.locator("#words").input_value() == ""
    page.keyboard.press("Escape")
    page.evaluate("location.hash = '#nothing/9'")
    assert page.locator("#detail").is_hidden()


def test_the_table_is_saved_as_csv(page: Any, tmp_path: Path) -> None:
    hostile = '=1+"1",\n'
    entries: Any = [
        {"glyph": name, "gid": gid, "unicodes": [], "advance": 500, "status": "ok", "files": {}, "error": None,
         "contours": [{"vertices": 10, "max_curvature": 0.25, "deviation": 1.5}]}
        for gid, name in enumerate(["a", hostile])
    ]  # fmt: skip
    metrics = {"units_per_em": 2000.0, "ascender": 1, "descender": 0}
    write_report(tmp_path, entries, {"font": {"family": "Tests", "style": "Bold", "metrics": metrics}})
    opened(page, tmp_path)
    with page.expect_download() as waiting:
        page.locator("#csv").click()
    waiting.value.save_as(tmp_path / "saved.csv")
    with open(tmp_path / "saved.csv", encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    first = dict(zip(head, rows[0], strict=True))
    assert (first["font"], first["glyph"], first["gid"]) == ("Tests Bold", "a", "0")
    assert (first["deviation (units)"], first["largest curvature (1/em)"]) == ("1.5", "500")
    assert rows[1][1] == f"'{hostile}", "text, not a formula"


def test_convex_and_concave_are_the_inks(page: Any, gallery: Path) -> None:
    opened(page, gallery / "kouzan-gyosho")
    sides = "([a, b]) => [a, b].map((data) => GS.sides(GS.contours(data)))"
    outer, counter = "M0 0l100 0 0 100 -100 0Z", "M20 20l0 60 60 0 0-60Z"  # y down: the outer contour runs clockwise
    reverse = "M0 0l0 100 100 0 0-100Z"
    assert page.evaluate(sides, [outer + counter, reverse]) == [[-1, -1], [1]]
    corners = "(data) => GS.corners(GS.contours(data)).flat()"
    assert sorted(page.evaluate(corners, outer)) == [[0, 0], [0, 100], [100, 0], [100, 100]]
    page.keyboard.press("c")
    cut = page.locator(".card:has(b:text-is('uni9F8D')) .comb .cut")
    dots = "d => d.split('M').length"
    page.wait_for_selector(".card:has(b:text-is('uni9F8D')) .comb", state="attached")
    few = cut.evaluate_all(f"all => all.map((e) => e.getAttribute('d')).map({dots})")
    page.keyboard.press("n")
    page.wait_for_function(
        "few => { const e = [...document.querySelectorAll('.card')].find((c) => c.querySelector('b').textContent ==="
        " 'uni9F8D')?.querySelector('.comb .cut'); return e && e.getAttribute('d').split('M').length > few; }",
        arg=max(few, default=0),
    )


def test_glyphs_in_all_masters_have_a_slider_for_each_axis(page: Any, tmp_path: Path) -> None:
    font = gs.open_font(FONTS / "variable-cff2.otf")
    convert_font_masters([font], ["o"], tmp_path, RefitSpec(gs.Options(), ("gallery",), masters=True), InProcess())
    opened(page, tmp_path)
    page.locator(".card:has(b:text-is('o'))").click()
    axes = page.locator("[data-part=axes] label")
    assert axes.all_inner_texts() == ["Weight (wght)\n400", "Width (wdth)\n100"]
    masters = font.masters("o")
    result = gs.convert_masters(masters)
    for location in ({}, {"wght": 650.0}, {"wght": 650.0, "wdth": 80.0}):
        for k, tag in enumerate(("wght", "wdth")):
            if tag in location:
                axes.nth(k).locator("input").evaluate(
                    "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }",
                    location[tag],
                )
        for name, expected in (("source", masters.instance(location)), ("result", result.instance(location))):
            box = page.locator(f"[data-part=picture] .{name}").evaluate(
                "path => { const b = path.getBBox(); return [b.x, -b.y - b.height, b.x + b.width, -b.y]; }"
            )
            assert box == pytest.approx(curves_data(expected.arrays, 2)[0].box, abs=0.02)
