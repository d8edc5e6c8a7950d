"use strict";
/* A glyph along the axes of a variable font: source and result are mixed of their masters here, without the server. */

(() => {
  const CORNER = Math.PI / 15; // 12 degrees: a joint that turns less in every master is smooth

  const between = (x, pairs, from, to) => {
    let k = pairs.findIndex((pair) => pair[from] >= x);
    if (k < 0) return pairs[pairs.length - 1][to];
    if (k === 0) return pairs[0][to];
    const [a, b] = [pairs[k - 1], pairs[k]];
    return a[to] + ((x - a[from]) / (b[from] - a[from])) * (b[to] - a[to]);
  };

  /** A value of an axis as regions count: 0 at the default, -1 and 1 at the axis's ends; `mapping` is the font's own. */
  const normalised = ({ minimum, default: middle, maximum, mapping }, value) => {
    const x = Math.min(maximum, Math.max(minimum, value)), side = x < middle ? middle - minimum : maximum - middle;
    const share = side > 0 ? (x - middle) / side : 0;
    return mapping.length ? between(share, mapping, 0, 1) : share;
  };

  /** Weights of the masters at a location, axis tag to value: the regions' scalars by the inverse of those at their peaks. */
  GS.masterWeights = ({ axes, regions, inverse }, location) => {
    const at = axes.map((axis) => normalised(axis, location[axis.tag] ?? axis.default));
    const scalars = [1, ...regions.map((region) => region.reduce((product, [low, peak, high], a) => {
      if (peak === 0 || at[a] === peak) return product;
      const side = at[a] < peak ? (at[a] - low) / (peak - low) : (high - at[a]) / (high - peak);
      return product * Math.min(1, Math.max(0, side));
    }, 1))];
    return inverse[0].map((_, k) => scalars.reduce((sum, scalar, j) => sum + scalar * inverse[j][k], 0));
  };

  /** Contours mixed with weights, each a list of pieces [[x, y], …]; `degrees` has those of the pieces. */
  GS.mixed = (contours, weights) => contours.map(({ degrees, points }) => {
    const flat = new Float64Array(points[0].length);
    weights.forEach((weight, k) => { if (weight) points[k].forEach((value, i) => { flat[i] += weight * value; }); });
    const count = flat.length / 2, point = (i) => [flat[2 * (i % count)], flat[2 * (i % count) + 1]];
    let first = 0;
    return degrees.map((degree) => {
      const piece = Array.from({ length: degree + 1 }, (_, i) => point(first + i));
      first += degree;
      return piece;
    });
  });

  /** x and y in turn as points. */
  GS.pairsOf = (flat) => Array.from({ length: flat.length / 2 }, (_, i) => [flat[2 * i], flat[2 * i + 1]]);

  const COMMANDS = ["", "L", "Q", "C"];
  GS.pathOf = (contours) => contours.filter((pieces) => pieces.length).map((pieces) => `M${pieces[0][0].map((v) => v.toFixed(2)).join(" ")}`
    + pieces.map((p) => COMMANDS[p.length - 1] + p.slice(1).map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join(" ")).join("") + "Z").join("");

  /** Which joints of each contour are smooth in every master. */
  GS.smoothJoints = (contours, count) => {
    const turns = Array.from({ length: count }, (_, k) => GS.mixed(contours, Array.from({ length: count }, (_, j) => +(j === k))).map(GS.turns));
    return contours.map(({ degrees }, c) => degrees.map((_, j) => turns.every((of) => of[c][j] < CORNER)));
  };

  /** The largest turn of smooth joints, in degrees, and where; null without one. */
  GS.largestTurn = (contours, smooth) => {
    let worst = null;
    contours.forEach((pieces, c) => GS.turns(pieces).forEach((turn, j) => {
      if (smooth[c][j] && !(turn * 180 / Math.PI <= worst?.turn)) worst = { turn: turn * 180 / Math.PI, point: pieces[j][0] };
    }));
    return worst;
  };

  /** One side at an instance: its outline and comb, and a ring around the smooth joint that turns most, if that shows. */
  GS.alongDrawing = (font, contours, worst, name, gain) => {
    const em = font.metrics.units_per_em, group = GS.svg("g");
    group.append(GS.svg("path", { class: name, d: GS.pathOf(contours) }),
      GS.comb(contours, em, font.scale, { name: name === "source" ? "source-comb" : "comb", gain }));
    if (worst && worst.turn >= 0.05) group.append(GS.dots([worst.point], "kink"));
    return group;
  };
})();
