"use strict";
/* The residual history: largest distance of a vertex from its footpoint before each update, one line a curve. */

(() => {
  const W = 260, H = 120, LEFT = 26, LOW = 16, TOP = 6;

  GS.chart = (place, histories, goal, now) => {
    const values = histories.flat().filter((v) => v > 0);
    const most = Math.max(1, ...histories.map((history) => history.length - 1));
    const top = Math.ceil(Math.log10(Math.max(goal * 10, ...values)));
    const bottom = Math.floor(Math.log10(Math.min(goal, ...values)));
    const x = (m) => LEFT + (m / most) * (W - LEFT - 6);
    const y = (v) => TOP + ((top - Math.log10(v)) / Math.max(1, top - bottom)) * (H - TOP - LOW);
    const chart = GS.svg("svg", { viewBox: `0 0 ${W} ${H}`, role: "img",
      "aria-label": `Residual of ${histories.length} curves over ${most} iterations, on a logarithmic scale` });
    for (let power = bottom; power <= top; power++) {
      const at = y(10 ** power);
      chart.append(GS.svg("path", { class: "axis", d: `M${LEFT} ${at}H${W - 6}` }));
      if ((top - power) % Math.ceil((top - bottom) / 5) === 0) {
        chart.append(GS.svg("text", { x: LEFT - 4, y: at + 3, "text-anchor": "end" }, `1e${power}`.replace("-", "\u2212")));
      }
    }
    for (const history of histories) {
      const d = history.map((v, m) => (v > 0 ? `${x(m).toFixed(1)} ${y(v).toFixed(1)}` : null)).filter(Boolean).join("L");
      if (d) chart.append(GS.svg("path", { class: "line", d: "M" + d }));
    }
    chart.append(GS.svg("path", { class: "goal", d: `M${LEFT} ${y(goal)}H${W - 6}` }));
    if (now !== null) chart.append(GS.svg("path", { class: "now", d: `M${x(now)} ${TOP}V${H - LOW}` }));
    chart.append(GS.svg("text", { x: LEFT, y: H - 4 }, "0"), GS.svg("text", { x: W - 6, y: H - 4, "text-anchor": "end" }, `${most} iterations`));
    place.replaceChildren(chart);
  };
})();
