"use strict";
/* Points clicked around the contours of a glyph, or of a picture as high as an em: what `experiment --clicked` reads. */

const byId = (id) => document.getElementById(id), SVG = "http://www.w3.org/2000/svg";
const clicked = new Map(); // by glyph, its contours: lists of [x, y] in font units, y up
let metrics = null, glyph = "";

async function asked(path, body) {
  const how = body && { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  const answer = await (await fetch(path, how)).json();
  if (answer.error) throw new Error(answer.error);
  return answer;
}

function contours() {
  if (!clicked.has(glyph)) clicked.set(glyph, [[]]);
  return clicked.get(glyph);
}

function draw() {
  const size = metrics.units_per_em / 180, drawn = contours().map((points, k, every) => {
    const group = document.createElementNS(SVG, "g"), line = document.createElementNS(SVG, "path");
    const done = k < every.length - 1;
    group.setAttribute("class", done ? "done" : "");
    if (points.length) line.setAttribute("d", `M${points.map(([x, y]) => `${x} ${-y}`).join("L")}${done ? "Z" : ""}`);
    group.append(line, ...points.map(([x, y]) => {
      const dot = document.createElementNS(SVG, "circle");
      for (const [name, value] of [["cx", x], ["cy", -y], ["r", size]]) dot.setAttribute(name, value);
      return dot;
    }));
    return group;
  });
  byId("points").replaceChildren(...drawn);
  const counts = contours().map((points) => points.length).filter(Boolean);
  byId("words").textContent = `${glyph || "picture"}: ${counts.join(" + ") || 0} points`;
}

function show(width) {
  const { units_per_em: em, ascender, descender } = metrics, high = Math.max(ascender - descender, em), edge = em / 20;
  byId("sheet").setAttribute("viewBox", [-edge, -ascender - edge, width + 2 * edge, high + 2 * edge].join(" "));
  draw();
}

async function choose(words) {
  const { glyphs } = await asked(`/api/glyphs?words=${encodeURIComponent(words)}`);
  if (!glyphs.length) return void (byId("words").textContent = "no such glyph");
  const found = await asked("/api/glyph", { glyph: glyphs[0].name, sampling: "count", amount: 8, corners: "smooth" });
  glyph = glyphs[0].text || glyphs[0].name;
  byId("outline").setAttribute("d", found.source);
  show(Math.max(found.advance, metrics.units_per_em));
}

function behind(file) {
  const reader = new FileReader();
  reader.onload = () => {
    const image = new Image();
    image.onload = () => {
      const high = metrics.units_per_em, width = (high * image.naturalWidth) / image.naturalHeight;
      const place = { href: reader.result, x: 0, y: -metrics.ascender, width, height: high };
      for (const [name, value] of Object.entries(place)) byId("behind").setAttribute(name, value);
      byId("outline").setAttribute("d", "");
      show(Math.max(width, high));
    };
    image.src = reader.result;
  };
  reader.readAsDataURL(file);
}

function next() {
  if (contours().at(-1).length > 2) contours().push([]);
  draw();
}

function undo() {
  const every = contours();
  if (!every.at(-1).length && every.length > 1) every.pop();
  every.at(-1).pop();
  draw();
}

function save() {
  const quoted = (name) => (/[",]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name), lines = ["glyph,contour,x,y"];
  for (const [name, every] of clicked) {
    every.filter((points) => points.length > 2).forEach((points, k) => {
      for (const [x, y] of points) lines.push([quoted(name), k, x, y].join(","));
    });
  }
  const link = document.createElement("a");
  link.href = `data:text/csv;charset=utf-8,${encodeURIComponent(`${lines.join("\n")}\n`)}`;
  link.download = "points.csv";
  link.click();
}

byId("sheet").addEventListener("click", (event) => {
  const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(byId("sheet").getScreenCTM().inverse());
  const digits = metrics.units_per_em < 100 ? 1000 : 1;
  contours().at(-1).push([Math.round(at.x * digits) / digits, Math.round(-at.y * digits) / digits]);
  draw();
});
document.addEventListener("keydown", (event) => {
  if (event.target.matches("input")) return;
  if (event.key === "Enter") next();
  if (event.key === "Backspace") undo();
});
byId("glyph").addEventListener("change", (event) => choose(event.target.value));
byId("picture").addEventListener("change", (event) => event.target.files.length && behind(event.target.files[0]));
for (const [id, act] of Object.entries({ next, undo, save })) byId(id).addEventListener("click", act);
asked("/api/font").then(async (font) => {
  metrics = font.metrics;
  await choose(font.first);
  document.body.dataset.ready = "";
});
