"use strict";
/* Path data to Bézier pieces, and from those what is drawn over them: combs, colours, vertices. SVG coordinates, y down. */

(() => {
  const TURN = Math.PI / 12; // a tooth at least every 15 degrees of turn, as in the curvature maps
  const TOOTH = 0.03, LONGEST = 2.5, SPACING = 1 / 140; // in em and in units of the scale, as in the maps
  const MOST_TEETH = 400; // a piece
  const NEAR = 1 / 40, CORNER = Math.PI / 15; // in em and radians: where a smooth result turns about a corner of 12 degrees
  const FULL = 0.9; // share of the teeth in view that are shorter than a full one
  const CHORDS = 4; // a segment, for which a point counts as inside or outside

  /** The colours of curvature, from the most concave ink to the most convex. */
  GS.usePalette = (palette) => {
    GS.palette = palette;
    const ends = [palette[0], palette[(palette.length - 1) / 2], palette[palette.length - 1]];
    document.documentElement.style.setProperty("--curvature", `linear-gradient(90deg, ${ends.join(", ")})`);
  };

  /** Measures as [name, label, unit, meaning]: curvature is stored in 1/unit and shown in 1/em. */
  GS.useMeasures = (measures) => {
    GS.measures = new Map(measures.map(([name, label, unit, about]) => [name, { label, unit, about }]));
  };
  GS.shown = (name, value, em) => (typeof value === "number" && GS.measures.get(name)?.unit === "1/em" ? value * em : value);

  GS.isBound = (name) => name.endsWith("_bound");

  /** Measures that are listed at once; the others are switched on. */
  const FIRST = ["vertices", "segments", "iterations", "residual", "rate_bound", "deviation", "deviation_bound", "max_curvature",
    "curvature_extrema", "source_curvature_extrema", "curvature_extrema_floor", "bending_energy", "converged", "within_tolerance"];

  /** Rows of a table of contours' measures, each with its unit and meaning. `every`: also those not listed at once;
   *  `always`: names of those that keep their row where no contour has them. */
  GS.measureRows = (contours, em, { every = false, always = new Set() } = {}) => {
    const names = [...FIRST, ...(every ? [...GS.measures.keys()].filter((name) => !FIRST.includes(name)) : [])]
      .filter((name) => always.has(name) || contours.some((contour) => contour[name] !== null && contour[name] !== undefined));
    const head = GS.element("tr", {}, GS.element("th", { scope: "col" }, "contour"),
      ...contours.map((_, i) => GS.element("th", { scope: "col" }, String(i))));
    return [head, ...names.map((name) => {
      const { label, unit, about } = GS.measures.get(name);
      const cell = (contour) => {
        const bad = (name === "converged" || name === "within_tolerance") ? contour[name] === false
          : (name === "new_crossings" || name === "collapsed") && Boolean(contour[name]);
        return GS.element("td", bad ? { class: "bad" } : {}, GS.number(GS.shown(name, contour[name], em), GS.isBound(name)));
      };
      return GS.element("tr", { "data-measure": name, title: about }, GS.element("th", { scope: "row" }, label,
        ...(unit ? [" ", GS.element("small", { class: "unit" }, unit)] : [])), ...contours.map(cell));
    })];
  };

  const NUMBERS = { M: 2, L: 2, H: 1, V: 1, Q: 4, T: 2, C: 6, S: 4 }; // of a command
  const MIRRORED = { T: 3, S: 4 }; // points of a piece whose last handle such a command mirrors

  /** Path data as contours, each a list of pieces [[x, y], …] of 2 to 4 points. */
  GS.contours = (data) => {
    const contours = [];
    let pieces = [], start = [0, 0], at = start;
    for (const [, letter, rest] of data.matchAll(/([MLHVQTCSZ])([^MLHVQTCSZ]*)/gi)) {
      const command = letter.toUpperCase();
      if (command === "Z") {
        if (at[0] !== start[0] || at[1] !== start[1]) pieces.push([at, start]);
        at = start;
      }
      const values = (rest.match(/-?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?/g) || []).map(Number);
      for (let i = 0; i < values.length; i += NUMBERS[command]) {
        const own = values.slice(i, i + NUMBERS[command]), [x, y] = letter === command ? [0, 0] : at;
        const points = command === "H" ? [[own[0] + x, at[1]]] : command === "V" ? [[at[0], own[0] + y]]
          : Array.from({ length: own.length / 2 }, (_, k) => [own[2 * k] + x, own[2 * k + 1] + y]);
        if (command === "M") {
          start = points[0];
          contours.push((pieces = []));
        } else {
          const mirrored = command in MIRRORED, last = pieces[pieces.length - 1];
          const turned = mirrored && last?.length === MIRRORED[command] ? last[last.length - 2] : at;
          pieces.push([at, ...(mirrored ? [[2 * at[0] - turned[0], 2 * at[1] - turned[1]]] : []), ...points]);
        }
        at = points[points.length - 1];
      }
    }
    return contours;
  };

  /** Contours in some masters, [degrees, coordinates of each master], mixed: pieces as of GS.contours, y down. */
  GS.mixed = (contours, weights) => contours.map(([degrees, masters]) => {
    const count = masters[0].length / 2, points = Array.from({ length: count }, (_, n) => [0, 1].map((k) =>
      weights.reduce((sum, weight, m) => sum + weight * masters[m][2 * n + k], 0) * (k ? -1 : 1)));
    let from = 0;
    return degrees.map((degree) => {
      const piece = Array.from({ length: degree + 1 }, (_, i) => points[(from + i) % count]);
      from += degree;
      return piece;
    });
  });

  /** Pieces as absolute path data. */
  GS.pathData = (contours) => contours.map((pieces) => `M${pieces[0][0].join(" ")}` + pieces.map((p) =>
    `${" LQC"[p.length - 1]}${p.slice(1).flat().join(" ")}`).join("") + "Z").join("");

  /** A value of an axis from -1 to 1, as regions have it. */
  const normalised = ({ minimum, default: home, maximum, mapping }, value) => {
    const side = value < home ? home - minimum : maximum - home, x = side > 0 ? (value - home) / side : 0;
    const k = mapping.findIndex(([before]) => before >= x);
    if (k < 1) return k ? mapping[mapping.length - 1]?.[1] ?? x : mapping[0][1];
    const [[a, from], [b, to]] = [mapping[k - 1], mapping[k]];
    return from + (to - from) * (x - a) / (b - a);
  };

  /** A drawing at a location, axis tag to value: source and result are mixed of the default and deltas. */
  GS.instance = (drawing, location) => {
    const { axes, regions, source, result } = drawing.masters;
    const at = axes.map((axis) => normalised(axis, location[axis.tag] ?? axis.default));
    const share = (x, [low, peak, high]) => (!peak || x === peak ? 1
      : Math.min(1, Math.max(0, x < peak ? (x - low) / (peak - low) : (high - x) / (high - peak))));
    const weights = [1, ...regions.map((region) => region.reduce((product, own, a) => product * share(at[a], own), 1))];
    const path = (contours) => GS.pathData(GS.mixed(contours, weights));
    return { ...drawing, source: path(source), result: path(result) };
  };

  /** Dots on the points of polygons. */
  GS.dotted = (data, name) => {
    const points = GS.contours(data).flatMap((pieces) => [pieces[0][0], ...pieces.map((piece) => piece[piece.length - 1])]);
    return GS.svg("path", { class: name, d: points.map(([x, y]) => `M${x} ${y}h0`).join("") });
  };

  const cubic = (p) => {
    if (p.length === 4) return p;
    const mix = (a, b, t) => [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
    return p.length === 3
      ? [p[0], mix(p[0], p[1], 2 / 3), mix(p[2], p[1], 2 / 3), p[2]]
      : [p[0], mix(p[0], p[1], 1 / 3), mix(p[0], p[1], 2 / 3), p[1]];
  };

  /** Point, unit normal to the left (as seen with y up) and curvature with the font's sign, at t of a cubic. */
  GS.frame = (p, t) => {
    const s = 1 - t, point = [0, 0], first = [0, 0], second = [0, 0];
    for (const k of [0, 1]) {
      const [a, b, c, d] = [p[0][k], p[1][k], p[2][k], p[3][k]];
      point[k] = s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
      first[k] = 3 * (s * s * (b - a) + 2 * s * t * (c - b) + t * t * (d - c));
      second[k] = 6 * (s * (c - 2 * b + a) + t * (d - 2 * c + b));
    }
    const speed = Math.hypot(...first);
    if (!(speed > 1e-9)) return { point, normal: [0, 0], curvature: 0, speed };
    return {
      point, speed,
      normal: [first[1] / speed, -first[0] / speed],
      curvature: -(first[0] * second[1] - first[1] * second[0]) / speed ** 3, // y down turns the sign
    };
  };

  const angle = (a, b) => Math.abs(Math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]));

  /** Frames along each contour: even in parameter, closer where the piece turns; `length` is arc length so far. */
  GS.frames = (contours, em) => contours.map((pieces) => {
    const found = [];
    let length = 0;
    for (const piece of pieces) {
      const p = cubic(piece), legs = [1, 2, 3].map((i) => [p[i][0] - p[i - 1][0], p[i][1] - p[i - 1][1]]);
      const extent = legs.reduce((sum, leg) => sum + Math.hypot(...leg), 0);
      const turn = angle(legs[0], legs[1]) + angle(legs[1], legs[2]);
      const n = Math.min(MOST_TEETH, Math.max(2, Math.ceil(extent / (SPACING * em) + turn / TURN)));
      for (let i = 0; i <= n; i++) {
        const frame = GS.frame(p, i / n);
        const last = found[found.length - 1];
        if (last) length += Math.hypot(frame.point[0] - last.point[0], frame.point[1] - last.point[1]);
        found.push(Object.assign(frame, { length }));
      }
    }
    return found;
  });

  /** Sides of contours as in outlines/ink.py: 1 where the ink is to the left (as seen with y up), -1 to the right. */
  GS.sides = (contours) => {
    const rings = contours.map((pieces) => pieces.flatMap((piece) => {
      const p = cubic(piece);
      return Array.from({ length: CHORDS }, (_, k) => { const [x, y] = GS.frame(p, k / CHORDS).point; return [x, -y]; });
    }));
    const area = (ring) => ring.reduce((sum, [x, y], i) => {
      const [px, py] = ring.at(i - 1), [ox, oy] = ring[0];
      return sum + (px - ox) * (y - oy) - (py - oy) * (x - ox);
    }, 0);
    const winding = (ring, [x, y]) => ring.reduce((sum, [bx, by], i) => {
      const [ax, ay] = ring.at(i - 1);
      if ((ay <= y) === (by <= y)) return sum;
      const left = (ax - x) * (by - y) - (ay - y) * (bx - x);
      return sum + (by > ay && left > 0 ? 1 : by < ay && left < 0 ? -1 : 0);
    }, 0);
    return rings.map((ring, c) => {
      const side = area(ring) < 0 ? -1 : 1;
      const around = rings.reduce((sum, other, k) => sum + (k === c || ring.length < 2 ? 0 : winding(other, ring[1])), 0);
      return around * side < 0 ? -side : side;
    });
  };

  /** The turn at the start of each piece of a contour, in radians, without sign. */
  GS.turns = (pieces) => {
    const legs = pieces.map((p) => {
      const away = (from, others) => others.map(([x, y]) => [x - from[0], y - from[1]]).find(([x, y]) => x || y) || [0, 0];
      const [x, y] = away(p[p.length - 1], p.slice(0, -1).reverse());
      return { leaving: away(p[0], p.slice(1)), arriving: [-x, -y] };
    });
    return pieces.map((_, i) => angle(legs.at(i - 1).arriving, legs[i].leaving));
  };

  /** The points where contours have corners, a list for each. */
  GS.corners = (contours) => contours.map((pieces) => {
    const turns = GS.turns(pieces);
    return pieces.filter((_, i) => turns[i] >= CORNER).map((piece) => piece[0]);
  });

  const short = (value) => +value.toFixed(2);
  const move = (a, b) => `M${short(a[0])} ${short(a[1])}L${short(b[0])} ${short(b[1])}`;
  const sides = () => (GS.palette.length - 1) / 2;

  GS.colourClass = (relative) => {
    const n = sides();
    return Math.max(-n, Math.min(n, Math.round(relative * n))) + n;
  };

  /** The comb as a group: teeth by colour class, the line through their tips, a dot where a tooth was cut.
   *  `corners`, as GS.corners gives them: teeth in the turn about one are left out, which is all within a distance of it,
   *  if a tooth there would be cut. `gain` lengthens all teeth. */
  GS.comb = (contours, em, scale, { name = "comb", corners = [], gain = 1 } = {}) => {
    const teeth = GS.palette.map(() => []), ends = [], cut = [], sides = GS.sides(contours);
    const strengthOf = ({ curvature }) => (scale > 0 ? curvature / scale : 0);
    const near = (frame, [x, y]) => Math.hypot(frame.point[0] - x, frame.point[1] - y) <= NEAR * em;
    GS.frames(contours, em).forEach((frames, c) => {
      // A contour that encloses nothing is left out of the result: then they are not told apart.
      const own = corners.length === contours.length ? corners[c] : corners.flat();
      const high = frames.filter((frame) => Math.abs(strengthOf(frame)) > LONGEST);
      const turned = own.filter((corner) => high.some((frame) => near(frame, corner)));
      let down = false, line = "";
      const tips = frames.map((frame) => {
        const { point, normal } = frame, strength = turned.some((corner) => near(frame, corner)) ? 0 : strengthOf(frame);
        const reach = gain * TOOTH * em * Math.max(-LONGEST, Math.min(LONGEST, strength)), flat = Math.abs(reach) <= 1e-4 * em;
        const tip = [point[0] - reach * normal[0], point[1] - reach * normal[1]];
        if (!flat) teeth[GS.colourClass(sides[c] * strength)].push(move(point, tip));
        if (Math.abs(strength) > LONGEST) cut.push(move(tip, tip));
        return { tip, flat };
      });
      // Between two places without a tooth the line would lie on the outline.
      tips.forEach(({ tip, flat }, i) => {
        const before = tips.at(i - 1), drawn = !(flat && before.flat);
        if (drawn && !down) line += `M${short(before.tip[0])} ${short(before.tip[1])}`;
        if (drawn) line += `L${short(tip[0])} ${short(tip[1])}`;
        down = drawn;
      });
      if (line) ends.push(line);
    });
    const group = GS.svg("g", { class: name });
    teeth.forEach((data, i) => data.length && group.append(GS.svg("path", { d: data.join(""), stroke: GS.palette[i] })));
    group.append(GS.svg("path", { class: "tips", d: ends.join("") }));
    if (cut.length) group.append(GS.svg("path", { class: "cut", d: cut.join("") }));
    return group;
  };

  /** The curve itself in the colours of its curvature. */
  GS.coloured = (contours, em, scale) => {
    const parts = GS.palette.map(() => []), sides = GS.sides(contours);
    GS.frames(contours, em).forEach((frames, c) => {
      for (let i = 1; i < frames.length; i++) {
        const mean = (sides[c] * (frames[i].curvature + frames[i - 1].curvature)) / 2;
        parts[GS.colourClass(scale > 0 ? mean / scale : 0)].push(move(frames[i - 1].point, frames[i].point));
      }
    });
    const group = GS.svg("g", { class: "coloured" });
    parts.forEach((data, i) => data.length && group.append(GS.svg("path", { d: data.join(""), stroke: GS.palette[i] })));
    return group;
  };

  GS.join = (a, b) => `M${a[0]} ${a[1]}L${b[0]} ${b[1]}`;

  /** The handles of pieces, each from its point to its end. */
  GS.handles = (pieces) => pieces.flatMap((p) =>
    (p.length === 2 ? [] : p.length === 3 ? [[p[0], p[1]], [p[2], p[1]]] : [[p[0], p[1]], [p[3], p[2]]]));

  /** The same as one path, and with a dot at each end. */
  GS.handlePath = (pieces, name) => GS.svg("path", { class: name, d: GS.handles(pieces).map(([a, b]) => GS.join(a, b)).join("") });
  GS.handleLines = (pieces) => [GS.handlePath(pieces, "handle-lines"), GS.dots(GS.handles(pieces).map(([, end]) => end), "handle-ends")];

  /** The curvature, in 1/unit, of a full tooth: most teeth in view are shorter. */
  GS.scaleNear = (contours, em, [x, y, half]) => {
    const found = GS.frames(contours, em).flat().filter(({ point: [a, b] }) => Math.abs(a - x) < half && Math.abs(b - y) < half)
      .map(({ curvature }) => Math.abs(curvature)).filter((value) => value * em > 0.01).sort((a, b) => a - b);
    return found.length ? found[Math.min(found.length - 1, Math.floor(FULL * found.length))] : 0;
  };

  /** Dots that keep their size whatever the zoom: strokes of no length with round caps. */
  GS.dots = (points, name) => GS.svg("path", { class: name, d: points.map((p) => move(p, p)).join("") });

  /** The legend of combs and colours: a bar of the palette over numbers in 1/em. */
  GS.legend = (em, scale) => {
    const reach = scale * em, width = 14 * GS.palette.length;
    const bar = GS.svg("svg", { viewBox: `0 0 ${width} 10`, class: "bar", "aria-hidden": "true", preserveAspectRatio: "none" });
    GS.palette.forEach((fill, i) => bar.append(GS.svg("rect", { x: 14 * i, width: 14.5, height: 10, fill })));
    const text = (value) => value.toPrecision(3).replace(/\.?0+$/, "").replace("-", "\u2212");
    return GS.element("div", { class: "legend", role: "img", "aria-label":
      `Curvature from ${text(-reach)}, concave, to ${text(reach)}, convex, in 1/em`,
    title: "Curvature: 1/radius, with the em as the unit. Blue to violet: the ink is convex; yellow to red: it is concave. "
      + `A tooth of full length is ${text(reach)}/em.` },
    bar, GS.element("span", {}, `${text(-reach)} concave`), GS.element("span", {}, "κ in 1/em"), GS.element("span", {}, `convex ${text(reach)}`));
  };
})();
