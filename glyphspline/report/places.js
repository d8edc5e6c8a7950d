"use strict";
/* Places of outlines: cards with the place of each drawn large, a table of all, and what is chosen of both. */

(() => {
  const ROWS = 300; // lines of the table at a time
  const at = (id) => document.getElementById(id);

  GS.point = (row) => `${Math.round(row.x)}, ${Math.round(row.y)}`.replaceAll("-", "\u2212");

  /** [left, right, top, bottom] of points. */
  GS.ends = (points) => [0, 1].flatMap((k) => [Math.min(...points.map((p) => p[k])), Math.max(...points.map((p) => p[k]))]);

  /** Show what is within `half` of a point, or less of it: `data-zoom`. */
  GS.showNear = (picture, x, y, half) => {
    const own = half / (picture.dataset.zoom || 1);
    picture.setAttribute("viewBox", [x - own, y - own, 2 * own, 2 * own].map((value) => +value.toFixed(2)).join(" "));
  };

  /** Cards of the rows that have a drawing, and a table of all. `draw(card, row)` when it comes into view; its caption has a
   *  `title(row)`, a sentence and lines: `caption(row)`. `heads` of the table, those that are `numeric`, and `cells(row)` by head.
   *  `isChosen(row)` besides kind and name; `summary(chosen)`: words, and whether to say that none is as asked for.
   *  Returns {choose, redraw}: after a change of what is chosen, and of what cards show. */
  GS.places = (rows, { size, draw, title, caption, heads, numeric, cells, isChosen = () => true, summary }) => {
    const visible = new Set();
    const watcher = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        visible[isIntersecting ? "add" : "delete"](target);
        if (isIntersecting) draw(target, target.row);
      }
    }, { rootMargin: "400px" });

    const kindOf = (row) => GS.element("span", { class: `kind ${row.level}` }, row.kind);
    const cardOf = (row) => {
      const picture = GS.svg("svg", { "aria-hidden": "true" });
      const button = GS.element("button", { type: "button", "aria-label": `${row.glyph}: show the whole glyph, or the place` }, picture);
      const zoom = (factor) => { picture.dataset.zoom = factor * (picture.dataset.zoom || 1); draw(card, row); };
      const zooms = [["+", "Zoom in", 1.6], ["\u2212", "Zoom out", 1 / 1.6]].map(([text, label, factor]) => {
        const one = GS.element("button", { type: "button", "aria-label": `${row.glyph}: ${label}` }, text);
        one.addEventListener("click", () => zoom(factor));
        return one;
      });
      const [sentence, ...lines] = caption(row);
      const place = `contour ${row.contour}, segment ${row.segment}, at ${GS.point(row)}`;
      const card = GS.element("figure", { class: "card", role: "listitem" }, button, GS.element("figcaption", {},
        GS.element("div", { class: "zooms" }, ...zooms), GS.element("div", {}, GS.element("b", {}, row.glyph), " ", kindOf(row), ` ${title(row)}`), GS.element("div", {}, sentence),
        ...[place, ...lines].filter(Boolean).map((line) => GS.element("p", {}, line)), GS.element("p", { class: "comb-scale" })));
      card.row = row;
      button.addEventListener("click", () => { card.classList.toggle("whole"); delete picture.dataset.zoom; draw(card, row); });
      watcher.observe(card);
      return card;
    };

    at("head").append(...heads.map((name) => GS.element("th", { scope: "col" }, name)));
    const lineOf = (row) => {
      const every = { glyph: row.glyph, kind: kindOf(row), contour: `${row.contour}`, segment: `${row.segment}`, point: GS.point(row), ...cells(row) };
      return GS.element("tr", {}, ...heads.map((name) => GS.element("td", numeric.includes(name) ? { class: "number" } : {}, every[name])));
    };

    const fillCards = GS.filled(at("cards"), at("more-cards"), size, cardOf, "drawings");
    const fillRows = GS.filled(at("rows"), at("more-rows"), ROWS, lineOf, "lines");
    const boxes = [...document.querySelectorAll("[data-kind]")];
    const update = () => {
      const kinds = new Set(boxes.filter((box) => box.checked).map((box) => +box.dataset.kind)), name = at("words").value.trim().toLowerCase();
      const chosen = rows.filter((row) => kinds.has(row.kindNumber) && isChosen(row) && (!name || row.glyph.toLowerCase().includes(name)));
      visible.clear();
      fillCards(chosen.filter((row) => row.drawing >= 0));
      fillRows(chosen);
      const [words, none] = summary(chosen);
      at("none").hidden = !none;
      at("count").textContent = words;
    };
    const choose = () => { update(); scrollTo(0, 0); };
    document.querySelector(".controls").addEventListener("submit", (event) => event.preventDefault());
    boxes.forEach((box) => box.addEventListener("change", choose));
    let pause;
    at("words").addEventListener("input", () => { clearTimeout(pause); pause = setTimeout(choose, 120); });
    update();
    document.body.dataset.ready = "yes";
    return { choose, redraw: () => visible.forEach((card) => draw(card, card.row)) };
  };
})();
