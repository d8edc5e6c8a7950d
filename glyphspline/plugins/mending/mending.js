"use strict";
/* The page of what was mended: before and after over each other, at a place of an axis, and a table of what moved. */

(() => {
  const setup = JSON.parse(document.getElementById("setup").textContent);
  GS.usePalette(setup.palette);
  const at = (id) => document.getElementById(id);
  const NEAR = 0.05; // half the width of what is shown around a place, in em, at least
  const AT_JOINTS = new Set(["kink", "unlevel", "repeated", "jump"]); // their handles are shown, of others the segment
  const rows = setup.rows.map(([glyph, kind, contour, segment, x, y, before, after, moved, curves, why, drawing, axis, step]) => (
    { glyph, kind: setup.kinds[kind], kindNumber: kind, level: "", contour, segment, x, y, before, after, moved, curves, why, drawing, axis, step }));

  /** Where on the axes a card is: the number of an axis of its drawing and a step of it, or null at the default. */
  const placeOf = (row) => {
    if (!setup.axes.length) return null;
    if (at("worst").checked) return row.axis < 0 ? null : [row.axis, row.step];
    return [+at("axis").value, +at("place").value];
  };

  /** Contours as pieces, y down, of one side, "old" or "new", of a drawing at a place. */
  const contoursOf = (drawing, side, place) => {
    const weights = place ? drawing.weights[place[0]][place[1]] : [1];
    return GS.mixed(drawing[side], weights);
  };

  const draw = (card, row) => {
    const drawing = setup.drawings[row.drawing], place = placeOf(row), em = drawing.em;
    const old = contoursOf(drawing, "old", place), now = contoursOf(drawing, "new", place);
    const whole = card.classList.contains("whole"), own = old[row.contour], m = own.length;
    const joint = AT_JOINTS.has(row.kind) ? [own[(row.segment + m - 1) % m].slice(-2), own[row.segment].slice(0, 2)].flat() : own[row.segment];
    const around = whole ? old.flat(2) : joint;
    const [left, right, top, bottom] = GS.ends(around);
    const half = Math.max(NEAR * em, 0.8 * Math.max(right - left, bottom - top)), x = (left + right) / 2, y = (top + bottom) / 2;
    const picture = card.querySelector("svg"), scale = GS.scaleNear(old, em, [x, y, half]), gain = Math.min(2, half / (0.09 * em));
    const combs = scale > 0 ? [[old, "source-comb"], [now, "comb"]].map(([of, name]) => GS.comb(of, em, scale, { name, gain })) : [];
    const same = old.flat(2).length === now.flat(2).length ? old.flat(2).map((p, k) => [p, now.flat(2)[k]]) : [];
    const moves = same.filter(([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]) > 1e-3);
    GS.showNear(picture, x, y, half);
    picture.replaceChildren(
      GS.svg("path", { class: "source", d: GS.pathData(old) }), GS.svg("path", { class: "result", d: GS.pathData(now) }), ...combs,
      GS.handlePath(old.flat(), "handle-before"), GS.handlePath(now.flat(), "handle-after"), GS.dots([own[row.segment][0]], "mark"),
      GS.svg("path", { class: "moves", d: moves.map(([a, b]) => GS.join(a, b)).join("") }),
      GS.dots(moves.map(([a]) => a), "before"), GS.dots(moves.map(([, b]) => b), "after"),
    );
    const where = place ? `${setup.axes[place[0]].tag} ${GS.number(setup.axes[place[0]].values[place[1]])}` : "";
    const teeth = scale > 0 ? `a full tooth is ${GS.number(scale * em)}/em` : "no curvature in view";
    card.querySelector(".comb-scale").textContent = [where, teeth].filter(Boolean).join("; ");
  };

  const result = (row) => (row.why ? "left" : row.after || "gone");
  const page = GS.places(rows, {
    size: 60, draw, title: (row) => `${row.before} → ${result(row)}`, caption: (row) => [`points moved by ${row.moved}, curves by ${row.curves}`],
    heads: ["glyph", "kind", "contour", "segment", "point", "before", "after", "points moved", "curves moved", "why left"],
    numeric: ["contour", "segment", "point", "before", "after", "points moved", "curves moved"],
    cells: (row) => ({ before: row.before, after: result(row), "points moved": row.moved, "curves moved": row.curves, "why left": row.why }),
    summary: (chosen) => {
      const mended = chosen.filter((row) => !row.why).length;
      return [`${mended} of ${chosen.length} findings mended`, !mended];
    },
  });

  const moved = () => {
    const axis = setup.axes[+at("axis").value];
    if (axis) at("value").textContent = at("worst").checked ? "" : `${axis.tag} ${GS.number(axis.values[+at("place").value])}`;
    page.redraw();
  };
  const chosenAxis = () => {
    const axis = setup.axes[+at("axis").value];
    at("place").max = axis.values.length - 1;
    at("place").value = axis.home;
  };
  at("along").hidden = !setup.axes.length;
  if (setup.axes.length) {
    setup.axes.forEach((axis, k) => at("axis").append(new Option(`${axis.name} (${axis.tag})`, String(k))));
    chosenAxis();
    at("place").addEventListener("input", () => { at("worst").checked = false; moved(); });
    at("axis").addEventListener("change", () => { chosenAxis(); at("worst").checked = false; moved(); });
    at("worst").addEventListener("change", moved);
  }
  moved();
})();
