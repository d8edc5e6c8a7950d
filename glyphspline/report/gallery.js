"use strict";
/* The page: loads the runs, then answers to its controls. */

(async () => {
  const setup = JSON.parse(document.getElementById("setup").textContent);
  GS.usePalette(setup.palette);
  GS.useMeasures(setup.measures);
  const at = (id) => document.getElementById(id);
  const layers = new Set(["source", "result"]);
  const layersOn = () => layers;

  const boxes = [...document.querySelectorAll("[data-layer]")];
  const showLayers = () => {
    for (const box of boxes) {
      box.checked = layers.has(box.dataset.layer);
      document.body.classList.toggle(`show-${box.dataset.layer}`, box.checked);
    }
  };

  document.querySelector(".controls").addEventListener("submit", (event) => event.preventDefault());

  let runs;
  try {
    runs = await GS.loadRuns(setup.runs, (rows) => { at("count").textContent = `${rows} glyphs read…`; });
  } catch (error) {
    at("count").textContent = `The data beside this page is missing: ${error.message}.`;
    return;
  }
  const rows = GS.rows(runs);
  const present = new Set(setup.measures.map(([key]) => key)
    .filter((key) => rows.some((row) => typeof GS.value(row, key) === "number")));
  for (const [key, label, unit, about] of setup.measures) {
    if (present.has(key)) at("sort").append(Object.assign(new Option(unit ? `${label}, ${unit}` : label, key), { title: about }));
  }
  for (const run of runs) at("run").append(new Option(`${run.family} ${run.style}`, run.folder));
  at("run").closest("label").hidden = runs.length < 2;
  document.title = runs.length === 1 ? `${runs[0].family} ${runs[0].style}` : `${runs.length} fonts`;
  at("heading").textContent = document.title;

  /* The address has the glyph that is shown large, so that it can be sent to somebody. */
  const address = (row) => `#${[row.run.folder, row.gid].filter((part) => part !== "").map(encodeURIComponent).join("/")}`;
  const plain = () => location.href.split("#")[0];
  const detail = GS.detail(at("detail"), layersOn, (row) => history.replaceState(null, "", row ? address(row) : plain()));
  const open = (position) => detail.open(chosen, position, (last) => grid.focus(last));
  const follow = () => {
    const row = location.hash.length > 1 ? rows.find((one) => address(one) === location.hash) : null;
    if (!row) return;
    if (!chosen.includes(row)) {
      at("words").value = at("run").value = at("least").value = at("most").value = "";
      at("show").value = "all";
      update();
    }
    open(chosen.indexOf(row));
  };
  const grid = GS.grid(at("grid"), at("list"), layersOn, open, runs.length > 1);
  let chosen = [];

  const limit = (id) => (at(id).value.trim() === "" || Number.isNaN(+at(id).value) ? null : +at(id).value);

  const histogram = (sort) => {
    const found = sort === "gid" ? null : GS.histogram(rows, sort);
    at("spread").hidden = !found;
    if (!found) return;
    const most = Math.max(...found.counts), [least, top] = [limit("least"), limit("most")];
    const step = (found.high - found.low) / found.counts.length;
    at("bars").replaceChildren(...found.counts.map((count, i) => {
      const low = found.low + i * step, inside = (least === null || low + step >= least) && (top === null || low <= top);
      const height = count ? 2 + 26 * Math.sqrt(count / most) : 0;
      return GS.svg("rect", { x: 5 * i, y: 28 - height, width: 4, height, class: inside ? "in" : "out" });
    }));
    at("least").placeholder = GS.number(found.low);
    at("most").placeholder = GS.number(found.high);
  };

  const update = () => {
    const sort = at("sort").value;
    chosen = GS.choose(rows, { words: at("words").value.trim(), run: at("run").value, show: at("show").value, sort,
      down: at("down").checked, least: sort === "gid" ? null : limit("least"), most: sort === "gid" ? null : limit("most") });
    const fact = sort === "gid" ? ["deviation", "deviation_bound"].find((name) => present.has(name)) ?? "deviation" : sort;
    grid.set(chosen, (row) => (row.status !== "ok" ? row.status
      : [GS.changed(row), GS.value(row, fact) === null ? `${GS.number(GS.value(row, "vertices"))} vertices`
        : [GS.number(GS.value(row, fact), GS.isBound(fact)), GS.measures.get(fact).unit, GS.measures.get(fact).label].filter(Boolean).join(" "),
      ].filter(Boolean).join(" · ")));
    at("none").hidden = chosen.length > 0;
    at("csv").disabled = chosen.length === 0;
    at("count").textContent = chosen.length === rows.length ? `${rows.length} glyphs` : `${chosen.length} of ${rows.length} glyphs`;
    at("options").textContent = (runs.length === 1 ? runs[0] : runs.find((run) => run.folder === at("run").value))?.words ?? "";
    histogram(sort);
    at("sort").title = GS.measures.get(sort)?.about ?? "";
  };
  at("csv").addEventListener("click", () => GS.download(GS.csv(chosen), "glyphs.csv", "text/csv"));

  const redraw = () => {
    showLayers();
    grid.again();
    detail.draw();
    const mapped = ["comb", "source-comb", "colour"].some((name) => layers.has(name));
    at("legend").replaceChildren(...(mapped && runs.length === 1 ? [GS.legend(runs[0].metrics.units_per_em, runs[0].scale)] : []));
  };
  for (const box of boxes) {
    box.addEventListener("change", () => {
      layers[box.checked ? "add" : "delete"](box.dataset.layer);
      redraw();
    });
  }
  document.addEventListener("keydown", (event) => {
    if (event.target.matches("input:not([type=checkbox]):not([type=range]), select") || event.ctrlKey || event.metaKey || event.altKey) return;
    const box = boxes.find((item) => item.dataset.key === event.key);
    if (box) {
      layers[layers.has(box.dataset.layer) ? "delete" : "add"](box.dataset.layer);
      redraw();
    } else if (event.key === "/" && !at("detail").open) {
      event.preventDefault();
      at("words").focus();
    }
  });
  let pause;
  for (const id of ["words", "least", "most"]) at(id).addEventListener("input", () => { clearTimeout(pause); pause = setTimeout(update, 120); });
  for (const id of ["run", "show", "down"]) at(id).addEventListener("change", update);
  at("sort").addEventListener("change", () => {
    at("least").value = at("most").value = "";
    at("down").checked = at("sort").value !== "gid";
    update();
  });
  showLayers();
  update();
  follow();
  addEventListener("hashchange", follow);
  document.body.dataset.ready = "yes";
})();
