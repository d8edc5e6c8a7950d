"use strict";
/* The page of findings: cards with the place of each drawn large, a table of all, and what is chosen of both. */

(() => {
  const setup = JSON.parse(document.getElementById("setup").textContent);
  GS.usePalette(setup.palette);
  const at = (id) => document.getElementById(id);
  const NEAR = 0.07, FAR = 0.6; // half the width of what is shown around a place, in em: at least, at most
  const CLOSE = 6; // times the length of a very short segment, which is shown closer than others
  const ON_SEGMENT = new Set(["inflection", "straight", "slanted", "extremum", "short", "handles", "lump", "retracted"]); // it is drawn over

  const rows = setup.rows.map(([font, glyph, gid, kind, contour, segment, x, y, sentence, location, drawing, score]) => ({
    font: setup.fonts[font], fontNumber: font, glyph, gid, kindNumber: kind, kind: setup.kinds[kind][0], level: setup.kinds[kind][1],
    contour, segment, x, y, sentence, location, drawing, score,
  }));
  const several = setup.fonts.length > 1, located = rows.some((row) => row.location);

  const shapes = new Map(); // contours of an outline, by its number
  const contoursOf = (number) => {
    if (!shapes.has(number)) shapes.set(number, GS.contours(setup.outlines[number]));
    return shapes.get(number);
  };

  /** What a card shows: [centre x, y, half the width]. */
  const view = (row, contours, whole) => {
    const em = row.font.em, piece = ON_SEGMENT.has(row.kind) ? contours[row.contour]?.[row.segment] : null;
    const around = whole ? contours.flat(2) : row.kind === "direction" ? (contours[row.contour] ?? []).flat() : piece ?? [];
    if (!around.length) return [row.x, -row.y, NEAR * em];
    const [left, right, top, bottom] = GS.ends(around), half = 0.6 * Math.max(right - left, bottom - top);
    if (row.kind === "short" && !whole) return [(left + right) / 2, (top + bottom) / 2, Math.min(NEAR * em, CLOSE * Math.max(half, em / 1000))];
    if (whole || row.kind === "direction") return [(left + right) / 2, (top + bottom) / 2, Math.max(half, NEAR * em)];
    const size = Math.min(FAR * em, Math.max(NEAR * em, half)); // a long segment is shown near its place
    return half <= FAR * em ? [(left + right) / 2, (top + bottom) / 2, size] : [row.x, -row.y, size];
  };

  const bezier = (p) => `M${p[0].join(" ")}${p.length === 2 ? "L" : p.length === 3 ? "Q" : "C"}${p.slice(1).flat().join(" ")}`;

  const draw = (card, row) => {
    const contours = contoursOf(row.drawing), whole = card.classList.contains("whole"), em = row.font.em;
    const frame = view(row, contours, whole), [x, y, half] = frame;
    const picture = card.querySelector("svg"), scale = GS.scaleNear(contours, em, frame), pieces = contours.flat();
    const handles = GS.handles(pieces);
    const found = ON_SEGMENT.has(row.kind) ? contours[row.contour]?.[row.segment] : null;
    GS.showNear(picture, x, y, half);
    picture.replaceChildren(
      GS.svg("path", { class: "source", d: setup.outlines[row.drawing] }),
      ...(scale > 0 ? [GS.comb(contours, em, scale, { name: "source-comb", gain: Math.min(6, half / (0.09 * em)) })] : []),
      GS.svg("path", { class: "control", d: handles.map(([a, b]) => GS.join(a, b)).join("") }),
      GS.dots(handles.map(([, b]) => b), "handles"),
      ...(found ? [GS.svg("path", { class: "found", d: bezier(found) })] : []),
      ...(row.kind === "direction" ? [GS.svg("path", { class: "found", d: (contours[row.contour] ?? []).map(bezier).join("") })] : []),
      GS.svg("path", { class: "tangents", d: tangents(row, contours, 0.8 * half) }),
      GS.dots(pieces.map((p) => p[0]), "vertices"),
      GS.dots([[row.x, -row.y]], "mark"),
    );
    card.querySelector(".comb-scale").textContent = scale > 0 ? `comb: a full tooth is ${GS.number(scale * em)}/em` : "no curvature in view";
  };

  /** The two tangents of a joint, each drawn on beyond it: the angle between them is the turn. */
  const tangents = (row, contours, half) => {
    const pieces = contours[row.contour], piece = pieces?.[row.segment];
    if (!["kink", "turn"].includes(row.kind) || !piece) return "";
    const away = (points) => points.map(([x, y]) => [x - points[0][0], y - points[0][1]]).find(([x, y]) => x || y);
    return [piece, [...pieces.at(row.segment - 1)].reverse()].map((points) => [points[0], away(points)]).filter(([, to]) => to)
      .map(([[x, y], [dx, dy]]) => [x, y, dx / Math.hypot(dx, dy) * half, dy / Math.hypot(dx, dy) * half])
      .map(([x, y, dx, dy]) => GS.join([x, y], [x - dx, y - dy])).join("");
  };

  setup.fonts.forEach((font, k) => at("font").append(new Option(font.name, String(k))));
  at("font").closest("label").hidden = !several;
  at("left").textContent = setup.left ? `${setup.left} more are left out here; CSV and JSON have all.` : "";
  const page = GS.places(rows, {
    size: 120, draw, title: (row) => `score ${row.score}`, caption: (row) => [row.sentence, row.location, several ? row.font.name : ""],
    heads: ["glyph", "score", "level", "kind", "contour", "segment", "point", "finding", ...(located ? ["location"] : []), ...(several ? ["font"] : [])],
    numeric: ["score", "contour", "segment", "point"],
    cells: (row) => ({ score: `${row.score}`, level: row.level, finding: row.sentence, location: row.location, font: row.font.name }),
    isChosen: (row) => at("font").value === "" || row.fontNumber === +at("font").value,
    summary: ({ length }) => [length === rows.length ? `${length} findings` : `${length} of ${rows.length} findings`, !length],
  });
  at("font").addEventListener("change", page.choose);
})();
