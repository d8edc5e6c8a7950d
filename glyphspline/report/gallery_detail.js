"use strict";
/* One glyph, large: layers, cross-fade of source and result, zoom and pan, its measures contour by contour. */

(() => {
  /** `dialog` as in gallery.html; `layersOn()` gives the set of layers; `shows(row)` hears of the glyph, null of none. */
  GS.detail = (dialog, layersOn, shows) => {
    const find = (name) => dialog.querySelector(`[data-part="${name}"]`);
    const picture = find("picture"), fade = find("fade");
    const zoom = GS.stage(picture);
    const location = {}; // axis tag to value, of all glyphs
    let rows = [], position = 0, drawing = null, every = false, closed = () => {};

    const draw = () => {
      if (!drawing) return;
      const { run } = rows[position];
      picture.replaceChildren(GS.layers(run, drawing.masters ? GS.instance(drawing, location) : drawing, layersOn()));
      const { units_per_em: em, ascender, descender } = run.metrics, advance = rows[position].advance ?? em;
      const guides = [[-em, 0, 3 * em, 0], [0, -ascender, 0, -descender], [advance, -ascender, advance, -descender]];
      picture.prepend(GS.svg("path", { class: "guides", d: guides.map(([a, b, c, d]) => `M${a} ${b}L${c} ${d}`).join("") }));
      find("legend").replaceChildren(["comb", "source-comb", "colour"].some((name) => layersOn().has(name)) ? GS.legend(em, run.scale) : "");
      fading();
    };

    const fading = () => {
      const value = +fade.value / 100;
      picture.style.setProperty("--source-shown", Math.min(1, 2 - 2 * value).toFixed(3));
      picture.style.setProperty("--result-shown", Math.min(1, 2 * value).toFixed(3));
      fade.setAttribute("aria-valuetext", value === 0.5 ? "both" : value < 0.5 ? "more of the source" : "more of the result");
    };

    /** A slider for each axis of a glyph in all masters. */
    const sliders = () => (drawing.masters?.axes ?? []).map((axis) => {
      const value = () => location[axis.tag] ?? axis.default, out = GS.element("output", {}, GS.number(value()));
      const input = GS.element("input", { type: "range", min: `${axis.minimum}`, max: `${axis.maximum}`, step: "any" });
      input.value = value();
      input.addEventListener("input", () => {
        location[axis.tag] = +input.value;
        out.textContent = GS.number(value());
        draw();
      });
      return GS.element("label", { class: "axis" }, `${axis.name} (${axis.tag})`, input, out);
    });

    const facts = (row) => {
      const [head, ...lines] = GS.measureRows(drawing.contours, row.run.metrics.units_per_em, { every });
      const table = GS.element("table", {}, GS.element("caption", { class: "unseen" }, `Measures of ${row.name}`),
        GS.element("thead", {}, head), GS.element("tbody", {}, ...lines));
      const more = GS.element("input", { type: "checkbox", checked: every });
      more.addEventListener("change", () => { every = more.checked; facts(row); find("facts").querySelector("input")?.focus(); });
      const links = Object.entries(drawing.files).map(([kind, path]) =>
        GS.element("a", { href: GS.fileLink(row.run, path), target: "_blank", rel: "noopener" }, kind));
      find("facts").replaceChildren(
        ...(row.error ? [GS.element("p", { class: "bad" }, row.error)] : []),
        ...(drawing.contours.length ? [GS.element("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Measures" }, table),
          GS.element("label", { class: "check" }, more, " all measures")] : []),
        GS.element("p", { class: "links" }, ...links));
    };

    const show = async (to) => {
      position = Math.max(0, Math.min(rows.length - 1, to));
      const row = rows[position];
      shows(row);
      find("title").textContent = row.text.trim() && row.text !== row.name ? `${row.text}  ${row.name}` : row.name;
      find("about").textContent = [row.run.family, row.run.style, `gid ${row.gid}`, row.unicodes, row.status]
        .filter(Boolean).join(" · ");
      find("count").textContent = `${position + 1} of ${rows.length}`;
      find("before").disabled = position === 0;
      find("after").disabled = position === rows.length - 1;
      drawing = await GS.drawing(row);
      if (rows[position] !== row) return;
      picture.setAttribute("aria-label", `${row.name}: source outline and interpolated curve`);
      zoom.fit(GS.box(row.run, row.advance));
      find("axes").replaceChildren(...sliders());
      draw();
      facts(row);
    };

    find("before").addEventListener("click", () => show(position - 1));
    find("after").addEventListener("click", () => show(position + 1));
    find("close").addEventListener("click", () => dialog.close());
    fade.addEventListener("input", fading);
    dialog.addEventListener("close", () => { shows(null); closed(position); });
    dialog.addEventListener("keydown", (event) => {
      if (event.target.matches("input, select")) return;
      if (event.key === "[" || event.key === "PageUp") show(position - 1);
      else if (event.key === "]" || event.key === "PageDown") show(position + 1);
      else zoom.key(event);
    });

    return {
      draw,
      open(chosen, at, then) {
        rows = chosen;
        closed = then;
        if (!dialog.open) dialog.showModal();
        show(at);
      },
    };
  };
})();
