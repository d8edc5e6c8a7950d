"use strict";
/* The drawing: layers of a glyph and its result, and vertices that can be taken hold of. */

(() => {
  const REACH = 12; // pixels within which a vertex is taken hold of

  GS.viewerLayers = {
    source: "Source", result: "Result", vertices: "Vertices", polygon: "Polygon", control: "Control polygon", feet: "Footpoints",
    intervals: "Intervals", "source-comb": "Source's comb", comb: "Result's comb", corners: "Teeth in corners", colour: "Colour",
    handles: "Handles",
  };

  /** The layers of `source` (path data) and `result` (as the server gives it) that are on.
   *  `comb`: {smooth, gain}, whether the result turns about corners, and a factor of the teeth's length. */
  GS.viewerDrawing = (font, source, result, on, { smooth, gain }) => {
    const em = font.metrics.units_per_em, group = GS.svg("g"), contours = GS.contours(result.result);
    const add = (name, make) => on.has(name) && group.append(...make());
    add("source", () => [GS.svg("path", { class: "source", d: source })]);
    add("result", () => [GS.svg("path", { class: "result", d: result.result })]);
    add("intervals", () => [GS.svg("path", { class: "intervals", d: result.intervals || "" })]);
    add("source-comb", () => [GS.comb(GS.contours(source), em, font.scale, { name: "source-comb", gain })]);
    add("comb", () => [GS.comb(contours, em, font.scale, { gain, corners: smooth && !on.has("corners") ? GS.corners(GS.contours(source)) : [] })]);
    add("colour", () => [GS.coloured(contours, em, font.scale)]);
    add("control", () => [GS.svg("path", { class: "control", d: result.control }), GS.dots(result.controls, "controls-dots")]);
    add("handles", () => GS.handleLines(contours.flat()));
    const closed = (points) => "M" + points.map((p) => p.join(" ")).join("L") + "Z";
    add("polygon", () => [GS.svg("path", { class: "polygon", d: result.polygons.filter((p) => p.length).map(closed).join("") })]);
    add("vertices", () => [GS.dots(result.polygons.flat(), "vertices")]);
    add("feet", () => {
      const vertices = result.tied || [];
      const ties = result.feet.map((foot, i) => (vertices[i] ? `M${vertices[i].join(" ")}L${foot.join(" ")}` : "")).join("");
      return [GS.svg("path", { class: "ties", d: ties }), GS.dots(result.feet, "feet")];
    });
    return group;
  };

  /** One side at an instance: its outline and comb, and a ring around the smooth joint that turns most, if that shows. */
  GS.alongDrawing = (font, { path, turn, point }, name, gain) => {
    const group = GS.svg("g", {}, GS.svg("path", { class: name, d: path }),
      GS.comb(GS.contours(path), font.metrics.units_per_em, font.scale, { name: name === "source" ? "source-comb" : "comb", gain }));
    if (turn >= 0.05) group.append(GS.dots([point], "kink"));
    return group;
  };

  /** A box around points with room for combs; the em where there are none. */
  GS.boxAround = (font, points, advance) => {
    const { units_per_em: em, ascender, descender } = font.metrics, room = 0.09 * em;
    if (!points.length) return [0, -ascender, advance || em, ascender - descender];
    const ends = (k) => points.reduce(([low, high], point) => [Math.min(low, point[k]), Math.max(high, point[k])], [Infinity, -Infinity]);
    const [[left, right], [top, bottom]] = [ends(0), ends(1)];
    return [left - room, top - room, right - left + 2 * room, bottom - top + 2 * room];
  };
  GS.viewerBox = (font, glyph) => GS.boxAround(font, GS.contours(glyph.source).flat(2), glyph.advance);

  /** Lets a vertex be dragged: `grasp(contour, vertex, x, y, done)` hears its new place in drawing coordinates. */
  GS.draggable = (svg, place, unit, polygons, grasp) => {
    let held = null;
    const nearest = (event) => {
      const [x, y] = place(event);
      let best = null, least = REACH * unit();
      polygons().forEach(({ points, movable }, contour) => movable && points.forEach(([px, py], vertex) => {
        const distance = Math.hypot(px - x, py - y);
        if (distance < least) [best, least] = [{ contour, vertex }, distance];
      }));
      return best;
    };
    svg.addEventListener("pointerdown", (event) => {
      held = nearest(event);
      if (held) svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointermove", (event) => {
      if (held) grasp(held.contour, held.vertex, ...place(event));
      else if (!event.buttons) svg.classList.toggle("near", Boolean(nearest(event)));
    });
    for (const name of ["pointerup", "pointercancel"]) svg.addEventListener(name, () => { held = null; });
    return (event) => !nearest(event);
  };
})();
