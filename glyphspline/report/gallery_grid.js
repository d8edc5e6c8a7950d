"use strict";
/* The virtual grid: only cards in view are in the document, whatever the number of glyphs. */

(() => {
  const MARGIN = 2; // rows drawn beyond what is in view

  /** A square box around the em, alike for all glyphs of a run so that sizes compare. */
  GS.box = (run, advance) => {
    const { units_per_em: em, ascender, descender } = run.metrics;
    const side = 1.08 * Math.max(em, ascender - descender);
    const width = advance ?? em, middle = (ascender + descender) / 2;
    return [width / 2 - side / 2, -middle - side / 2, side, side];
  };

  /** The layers of a glyph, bottom to top; comb and colour only when they are on, since they take work. */
  GS.layers = (run, drawing, on) => {
    const em = run.metrics.units_per_em, group = GS.svg("g");
    if (drawing.source) group.append(GS.svg("path", { class: "source", d: drawing.source }));
    const mapped = on.has("comb") || on.has("colour") || on.has("source-comb"), source = mapped ? GS.contours(drawing.source) : [];
    if (on.has("source-comb")) group.append(GS.comb(source, em, run.scale, { name: "source-comb" }));
    if (drawing.result) {
      group.append(GS.svg("path", { class: drawing.strokes ? "result strokes" : "result", d: drawing.result }));
      if (on.has("comb") || on.has("colour")) {
        const contours = GS.contours(drawing.result);
        // Only a smooth result turns about a corner: elsewhere a corner is a point between two curvatures.
        const corners = on.has("corners") || run.options.corners !== "smooth" ? [] : GS.corners(source);
        if (on.has("comb")) group.append(GS.comb(contours, em, run.scale, { corners }));
        if (on.has("colour")) group.append(GS.coloured(contours, em, run.scale));
      }
    }
    if (on.has("handles")) group.append(...GS.handleLines(GS.contours(drawing.result || drawing.source).flat()));
    if (drawing.control) group.append(GS.svg("path", { class: "control", d: drawing.control }));
    if (drawing.polygon) {
      group.append(GS.svg("path", { class: "polygon", d: drawing.polygon }));
      if (on.has("vertices")) group.append(GS.dotted(drawing.polygon, "vertices"));
    }
    return group;
  };

  /** `box` scrolls, `list` is inside it; `open(position)` is called for a chosen card; `several`: cards say their font. */
  GS.grid = (box, list, layersOn, open, several) => {
    let rows = [], columns = 1, width = 170, height = 200, current = 0, label = () => "";
    const cards = new Map();
    const fontOf = (row) => `${row.run.family} ${row.run.style}`.trim();

    const card = (position) => {
      const row = rows[position];
      const picture = GS.svg("svg", { viewBox: GS.box(row.run, row.advance).join(" "), "aria-hidden": "true" });
      const button = GS.element("button", { class: `card ${row.status}`, type: "button", tabindex: position === current ? "0" : "-1" },
        picture, GS.element("span", { class: "name" }, row.text.trim() && row.text !== row.name ? `${row.text} ` : "", GS.element("b", {}, row.name)),
        ...(several ? [GS.element("span", { class: "font", title: fontOf(row) }, fontOf(row))] : []),
        GS.element("span", { class: "fact" }, label(row)));
      const item = GS.element("div", { role: "listitem", class: "cell", "aria-posinset": String(position + 1),
        "aria-setsize": String(rows.length) }, button);
      button.addEventListener("click", () => { current = position; open(position); });
      button.addEventListener("focus", () => { current = position; });
      GS.drawing(row).then((drawing) => {
        if (cards.get(position) === item) picture.replaceChildren(GS.layers(row.run, drawing, layersOn()));
      }, () => picture.classList.add("missing"));
      return item;
    };

    const show = () => {
      const first = Math.max(0, Math.floor(box.scrollTop / height) - MARGIN) * columns;
      const last = Math.min(rows.length, (Math.ceil((box.scrollTop + box.clientHeight) / height) + MARGIN) * columns);
      for (const [position, item] of cards) {
        if (position < first || position >= last) {
          item.remove();
          cards.delete(position);
        }
      }
      for (let position = first; position < last; position++) {
        if (cards.has(position)) continue;
        const item = card(position);
        item.style.transform = `translate(${(position % columns) * width}px, ${Math.floor(position / columns) * height}px)`;
        item.style.width = `${width}px`;
        item.style.height = `${height}px`;
        cards.set(position, item);
        list.append(item);
      }
      for (const [position, item] of cards) item.firstChild.tabIndex = position === current ? 0 : -1;
      if (!cards.has(current) && cards.size) cards.values().next().value.firstChild.tabIndex = 0;
    };

    /** Takes the list's width in; true if that moves the cards. */
    const measure = () => {
      const room = list.clientWidth, wanted = room < 520 ? 150 : 176, before = width;
      columns = Math.max(1, Math.floor(room / wanted));
      width = room / columns;
      height = width + (several ? 64 : 46);
      list.style.height = `${Math.ceil(rows.length / columns) * height}px`;
      return width !== before;
    };

    const again = () => {
      const held = list.contains(document.activeElement);
      for (const item of cards.values()) item.remove();
      cards.clear();
      measure();
      show();
      if (held) cards.get(current)?.firstChild.focus({ preventScroll: true });
    };

    /** Cards that stay where they are keep what they hold, the focus with it. */
    const resized = () => (measure() ? again() : show());

    const focus = (position) => {
      current = Math.max(0, Math.min(rows.length - 1, position));
      const top = Math.floor(current / columns) * height;
      if (top < box.scrollTop) box.scrollTop = top;
      if (top + height > box.scrollTop + box.clientHeight) box.scrollTop = top + height - box.clientHeight;
      show();
      cards.get(current)?.firstChild.focus({ preventScroll: true });
    };

    list.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const page = Math.max(1, Math.floor(box.clientHeight / height)) * columns;
      const to = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: columns, ArrowUp: -columns, PageDown: page, PageUp: -page,
        Home: -Infinity, End: Infinity }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      focus(current + to);
    });

    let asked = false;
    box.addEventListener("scroll", () => {
      if (asked) return;
      asked = true;
      requestAnimationFrame(() => { asked = false; show(); });
    }, { passive: true });
    new ResizeObserver(resized).observe(box);

    return {
      set(chosen, fact) {
        rows = chosen;
        label = fact;
        current = 0;
        box.scrollTop = 0;
        again();
      },
      again, focus,
    };
  };
})();
