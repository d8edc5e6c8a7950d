"use strict";
/* The viewer's page: what is asked of the server as controls change, and what is drawn of its answers. */

(async () => {
  const at = (id) => document.getElementById(id);
  const WORDS = {
    0: "(u_{i−2}, u_{i+2}): the whole support; often does not converge", 1: "(u_{i−1}, u_{i+1})",
    2: "the interval of Lemma 2: converges, and certified to with c > 0", 3: "only the knot u_i: no search, overshoots",
    4: "as 2, each control point renewed at once (Algorithm 3)",
  };
  /** Measures of the iteration, which keep their rows where nothing is iterated. */
  const ITERATED = new Set(["iterations", "residual", "converged", "rate_bound"]);
  const CHOICES = ["variant", "sampling", "corners", "continuity", "effort"];
  const choiceOf = (name, value) => document.querySelector(`[name=${name}][value="${value}"]`);
  const AXES = 3; // whose sliders are in sight; those of others are in a list
  const number = GS.number;

  /** What is drawn may still change while an answer is awaited, and says so; the server may be compiling meanwhile. */
  let shown = null, awaited = 0, asking = null, said = "";
  const askCompiling = async () => {
    const { words } = await (await fetch("/api/compiling")).json();
    if (awaited && words) at("about").textContent = said = words;
  };
  const awaiting = (more) => {
    awaited += more;
    document.querySelector("main").setAttribute("aria-busy", String(awaited > 0));
    if (awaited) asking ??= setInterval(() => askCompiling().catch(() => {}), 1000);
    else {
      clearInterval(asking);
      asking = null;
      if (shown && said && at("about").textContent === said) tell();
    }
  };

  awaiting(1);
  const font = await (await fetch("/api/font")).json();
  GS.usePalette(font.palette);
  GS.useMeasures(font.measures);
  const em = font.metrics.units_per_em;
  const state = { glyph: font.first, location: {}, ...font.defaults, moved: [], measure: false };
  /* The page opens on the command line's defaults. */
  for (const name of CHOICES) choiceOf(name, state[name]).checked = true;
  const layers = new Set(["source", "result", "vertices"]);
  let along = null; // the instance at the sliders' location, while the glyph is shown along the axes
  let compared = null, steps = null, playing = null;
  let asked = 0; // how often the curve has been asked for: what was sent before the last time is out of date

  const post = async (path, body) =>
    (await fetch(path, { method: "POST", headers: { "content-type": "application/json" }, body })).json();
  /** One request of a kind at a time; of those that came in between only the last is sent. */
  const line = (path, then) => {
    let busy = false, next = null;
    const send = async (body) => {
      if (busy) { next = body; return; }
      busy = true;
      const sent = asked;
      awaiting(1);
      try {
        const found = await post(path, body);
        if (!next || found.error) then(found, sent);
      } catch (error) {
        then({ error: `the viewer does not answer: ${error.message}` }, sent);
      }
      busy = false;
      if (next) { const body = next; next = null; send(body); }
      awaiting(-1);
    };
    return () => send(JSON.stringify(state));
  };

  const zoom = GS.stage(at("picture"), () => {
    for (const svg of document.querySelectorAll("#compared svg")) svg.setAttribute("viewBox", at("picture").getAttribute("viewBox"));
    beside.follow(zoom.box());
  }, (event) => mayPan(event));
  const beside = GS.zoomable(at("beside"), () => { zoom.follow(beside.box()); zoom.pan(0, 0); });

  const polygons = () => (shown && !along && layers.has("vertices") && state.corners === "smooth"
    ? shown.polygons.map((points, i) => ({ points, movable: shown.movable[i] })) : []);
  const mayPan = GS.draggable(at("picture"), zoom.place, zoom.unit, polygons, (contour, vertex, x, y) => {
    state.moved = state.moved.filter(([c, v]) => c !== contour || v !== vertex);
    state.moved.push([contour, vertex, +x.toFixed(2), +(-y).toFixed(2)]);
    ask();
  });

  const mapped = () => ["comb", "source-comb", "colour"].some((name) => layers.has(name));
  const combs = () => ({ smooth: state.corners === "smooth", gain: 2 ** +at("gain").value });

  /** Source and result at the sliders' location. */
  const drawAlong = () => {
    for (const [whose, place] of [["source", "beside"], ["result", "picture"]]) {
      const { turn } = along[whose];
      at(place).replaceChildren(GS.alongDrawing(font, along[whose], whose, combs().gain));
      at(`${whose}-turn`).textContent = `${whose}: ${turn === null ? "no smooth joints" : `largest turn ${turn.toFixed(1)}°`}`;
    }
    at("gain").disabled = false;
    at("legend").replaceChildren(GS.legend(em, font.scale));
  };

  const draw = () => {
    if (along) return drawAlong();
    if (!shown) return;
    const index = +at("step").value, step = steps && index < steps.length ? steps[index] : null;
    const closed = shown.polygons.filter((_, i) => shown.movable[i]);
    const result = step ? { ...step, polygons: shown.polygons, intervals: "", tied: closed.flat() } : shown;
    at("picture").replaceChildren(GS.viewerDrawing(font, shown.source, result, layers, combs()));
    at("legend").replaceChildren(...(mapped() ? [GS.legend(em, font.scale)] : []));
    at("gain").disabled = !(layers.has("comb") || layers.has("source-comb"));
    at("step-out").textContent = step ? `${step.step}, error ${number(step.error)}` : "result";
    if (shown.measures.some((m) => m.iterations !== null)) GS.chart(at("chart"), shown.residuals, 0.005, step ? step.step : null);
    else at("chart").textContent = "–";
  };

  const drawCompared = () => {
    at("compared").hidden = !compared;
    if (!compared) return;
    const small = new Set([...layers].filter((name) => name !== "feet" && name !== "vertices"));
    at("compared").replaceChildren(...compared.map((result) => {
      const picture = GS.svg("svg", { class: "drawing", viewBox: at("picture").getAttribute("viewBox"), role: "img", "aria-label": `variant ${result.variant}` },
        GS.viewerDrawing(font, shown.source, result, small, combs()));
      const known = (key) => result.measures.map((m) => GS.shown(key, m[key], em)).filter((v) => v !== null);
      const sum = (key) => (known(key).length ? known(key).reduce((total, v) => total + v, 0) : null);
      const most = (key) => (known(key).length ? Math.max(...known(key)) : null);
      return GS.element("figure", { class: result.variant === state.variant ? "chosen" : "" }, picture, GS.element("figcaption", {},
        GS.element("b", {}, `variant ${result.variant}`), ` · ${number(most("iterations"))} iterations · energy ${number(sum("bending_energy"))}/em · largest κ ${number(most("max_curvature"))}/em`));
    }));
  };

  const title = ({ unicodes, glyph }) => {
    const text = unicodes.split(" ").filter(Boolean).map((u) => String.fromCodePoint(parseInt(u.slice(2), 16))).join("");
    at("title").textContent = text === glyph ? glyph : `${text} ${glyph}`;
  };
  const tell = () => {
    title(shown);
    const total = shown.measures.reduce((sum, m) => sum + m.vertices, 0), bad = shown.measures.filter((m) => m.converged === false).length;
    at("about").textContent = [`gid ${shown.gid}`, shown.unicodes, `${shown.measures.length} contours`, `${total} vertices`,
      ...(bad ? [`${bad} not converged`] : []), ...(state.sampling === "tolerance" ? shown.notes : [])].filter(Boolean).join(" · ");
    at("about").classList.toggle("bad", bad > 0);
    at("measures").replaceChildren(...GS.measureRows(shown.measures, em, { every: at("every").checked, always: ITERATED }));
    const whole = shown.movable.every(Boolean); // arcs between corners take a few updates each and are not stepped through
    at("play").disabled = at("step").disabled = !whole;
    at("step-out").title = whole ? "" : "the iteration of smooth curves only";
    at("command").textContent = shown.command;
    at("moved-note").hidden = !state.moved.length;
  };

  /* The slider knows the number of steps from the curve's own answer; their drawings are asked for when it is used. */
  let wanted = null;
  const askSteps = line("/api/steps", (found, sent) => {
    const act = wanted;
    wanted = null;
    if (found.error || sent !== asked) return;
    steps = found.steps;
    act?.();
    draw();
  });
  const withSteps = (act) => {
    if (steps) return act();
    const already = wanted;
    wanted = act;
    if (!already) askSteps();
  };
  const askCompared = line("/api/compare", (found) => {
    compared = found.error || !at("compare").checked ? null : found.results;
    drawCompared();
  });
  const failed = ({ error }) => {
    at("about").classList.toggle("bad", Boolean(error));
    if (error) at("about").textContent = error;
    return error;
  };
  const askGlyph = line("/api/glyph", (found) => {
    if (at("along").checked) return;
    if (failed(found)) return;
    at("step").max = String(found.steps);
    if (!steps && !wanted) at("step").value = at("step").max;
    const other = !shown || shown.glyph !== found.glyph, onlyMeasured = state.measure && shown?.result === found.result;
    shown = found;
    if (onlyMeasured) return tell();
    if (other) zoom.fit(GS.viewerBox(font, found));
    tell();
    draw();
    if (at("compare").checked) askCompared();
  });
  const askMasters = line("/api/masters", (found) => {
    if (!at("along").checked || failed(found)) return;
    const other = along?.glyph !== found.glyph;
    along = found;
    at("stage").classList.add("along");
    if (other) for (const each of [beside, zoom]) each.fit(GS.boxAround(font, found.corners));
    title(found);
    at("about").textContent = [`gid ${found.gid}`, found.unicodes, `${found.masters} masters`, `${found.source.segments} segments in the source, ${found.result.segments} in the result`,
      `within ${found.bound} units at every location`, ...found.notes].filter(Boolean).join(" · ");
    at("chart").textContent = "–";
    at("measures").replaceChildren();
    at("command").textContent = found.command;
    draw();
  });
  /* The text is drawn by the server; a click on one of its glyphs shows that glyph. */
  let lineSaid = null;
  const markText = () => {
    for (const use of at("text-line").querySelectorAll("use")) use.classList.toggle("chosen", use.dataset.glyph === state.glyph);
  };
  const askText = line("/api/text", (found) => {
    at("text-about").textContent = found.error ?? found.notes.join(" · ");
    at("text-about").classList.toggle("bad", Boolean(found.error));
    lineSaid = found.error ? null : found.svg;
    at("save-text").disabled = at("text-line").hidden = !lineSaid;
    if (!lineSaid) return;
    at("text-line").replaceChildren(document.importNode(new DOMParser().parseFromString(lineSaid, "image/svg+xml").documentElement, true));
    markText();
  });
  const ask = () => {
    if (state.text) askText();
    if (at("along").checked) return askMasters();
    steps = wanted = null;
    asked++;
    at("step").value = at("step").max;
    clearInterval(playing);
    playing = null;
    state.measure = false;
    askGlyph();
    clearTimeout(rest);
    rest = setTimeout(measured, 350);
  };
  /** Deviations take as long to measure as the curve itself, so they are asked for once the sliders rest. */
  let rest = null;
  const measured = () => {
    if (state.sampling === "tolerance" || state.moved.length) return;
    state.measure = true;
    askGlyph();
  };

  /* Controls. The amount's slider is logarithmic: each kind of sampling has its own ends. */
  const ENDS = { step: [em / 100, em / 4], count: [4, 400], tolerance: [em / 5000, em / 50] };
  const shareOf = (sampling, value) => (100 * Math.log(value / ENDS[sampling][0])) / Math.log(ENDS[sampling][1] / ENDS[sampling][0]);
  const START = { step: 45, count: 50, tolerance: shareOf("tolerance", font.defaults.amount) };
  at("amount").value = String(START[state.sampling]);
  const UNITS = { step: ["chord", " units"], count: ["vertices a contour", ""], tolerance: ["distance allowed", " units"] };
  const amount = () => {
    const [low, high] = ENDS[state.sampling], share = +at("amount").value / 100;
    const value = low * (high / low) ** share;
    state.amount = state.sampling === "count" ? Math.round(value) : +value.toPrecision(4);
    at("amount-word").textContent = UNITS[state.sampling][0];
    at("amount-out").textContent = `${state.amount}${UNITS[state.sampling][1]}`;
  };
  const read = () => {
    for (const name of CHOICES) state[name] = document.querySelector(`[name=${name}]:checked`).value;
    state.variant = +state.variant;
    const sharp = state.corners === "sharp", fitted = sharp && state.continuity === "g2"; // G2 cubics: nothing is iterated
    at("continuities").disabled = !sharp;
    at("efforts").disabled = state.sampling !== "tolerance";
    if (fitted && at("compare").checked) at("compare").click(); // before it is disabled
    for (const id of ["variants", "compare"]) at(id).disabled = fitted;
    at("compare").disabled ||= at("along").checked;
    at("variant-words").textContent = fitted ? "no variant runs: G2 cubics are fitted, nothing is iterated" : WORDS[state.variant];
    amount();
    for (const input of document.querySelectorAll("[name=preset]")) {
      const { amount: exact, ...rest } = font.presets[input.value];
      input.checked = Object.entries({ ...rest, amount: +exact.toPrecision(4) }).every(([key, value]) => state[key] === value);
    }
  };
  /* Step and count sample whole contours, which sharp corners cut. */
  const together = (sampling, corners) => {
    choiceOf("sampling", sampling).checked = choiceOf("corners", corners).checked = true;
    at("amount").value = START[sampling];
  };
  for (const input of document.querySelectorAll("[name=corners], [name=sampling]")) {
    input.addEventListener("change", () => {
      if (input.value === "sharp" && state.sampling !== "tolerance") together("tolerance", "sharp");
      else if (input.name === "sampling" && input.value !== "tolerance") together(input.value, "smooth");
    });
  }
  for (const input of document.querySelectorAll("[name=preset]")) {
    input.addEventListener("change", () => {
      const { amount: exact, ...choices } = font.presets[input.value];
      for (const [key, value] of Object.entries(choices)) choiceOf(key, value).checked = true;
      at("amount").value = String(shareOf("tolerance", exact));
      state.moved = [];
      read();
      ask();
    });
  }
  for (const input of document.querySelectorAll(`${CHOICES.map((name) => `[name=${name}]`)}, #amount`)) {
    input.addEventListener(input.type === "radio" ? "change" : "input", () => {
      if (input.name === "sampling") at("amount").value = START[input.value];
      if (input.name !== "variant") state.moved = []; // these sample anew
      read();
      ask();
    });
  }
  const more = GS.element("details", {}, GS.element("summary", {}, font.axes.length - AXES === 1 ? "1 more axis" : `${font.axes.length - AXES} more axes`));
  font.axes.forEach((axis, index) => {
    state.location[axis.tag] = axis.default;
    const input = GS.element("input", { type: "range", min: String(axis.minimum), max: String(axis.maximum), step: "any", value: String(axis.default), "data-axis": axis.tag });
    const out = GS.element("output", {}, number(axis.default));
    input.addEventListener("input", () => {
      state.location[axis.tag] = +(+input.value).toPrecision(4);
      out.textContent = number(state.location[axis.tag]);
      state.moved = [];
      ask();
    });
    (index < AXES ? at("axes") : more).append(GS.element("label", { class: "slider" }, `${axis.name} (${axis.tag})`, out, input));
  });
  if (font.axes.length > AXES) at("axes").append(more);
  at("along-choice").hidden = !font.axes.length;
  at("along").addEventListener("change", () => {
    along = null;
    clearTimeout(rest);
    at("stage").classList.remove("along");
    at("save").disabled = at("along").checked;
    if (at("along").checked) { // masters are converted so
      if (at("compare").checked) at("compare").click();
      together("tolerance", "sharp");
      choiceOf("continuity", "c2").checked = true;
      state.moved = [];
    } else if (shown) zoom.fit(GS.viewerBox(font, shown));
    read();
    ask();
  });
  for (const [name, label] of Object.entries(GS.viewerLayers)) {
    const box = GS.element("input", { type: "checkbox", "data-layer": name, checked: layers.has(name) });
    box.addEventListener("change", () => { layers[box.checked ? "add" : "delete"](name); draw(); drawCompared(); });
    at("layers").append(GS.element("label", {}, box, GS.element("i"), label));
  }

  const choose = (name) => {
    state.glyph = name;
    state.moved = [];
    for (const option of at("glyphs").children) option.setAttribute("aria-selected", String(option.dataset.name === name));
    markText();
    ask();
  };
  const find = async () => {
    const words = at("words").value;
    const found = await (await fetch(`/api/glyphs?words=${encodeURIComponent(words)}`)).json();
    if (words !== at("words").value) return;
    at("no-glyph").hidden = found.glyphs.length > 0;
    at("glyphs").hidden = !found.glyphs.length;
    at("glyphs").replaceChildren(...found.glyphs.map(({ name, text }) => {
      const option = GS.element("div", { role: "option", class: text.trim() ? "" : "named", title: name, "aria-label": name, "aria-selected": String(name === state.glyph), "data-name": name }, text.trim() || name);
      option.addEventListener("click", () => choose(name));
      return option;
    }));
    if (words && found.glyphs.length && state.glyph !== found.glyphs[0].name) choose(found.glyphs[0].name);
  };
  at("words").addEventListener("input", find);
  at("glyphs").addEventListener("keydown", (event) => {
    const options = [...at("glyphs").children], now = options.findIndex((option) => option.dataset.name === state.glyph);
    const to = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!to || !options.length) return;
    event.preventDefault();
    const option = options[Math.max(0, Math.min(options.length - 1, now + to))];
    option.scrollIntoView({ block: "nearest" });
    choose(option.dataset.name);
  });

  at("text").addEventListener("input", () => {
    state.text = at("text").value;
    if (state.text.trim()) return askText();
    state.text = lineSaid = null;
    at("text-about").textContent = "";
    at("save-text").disabled = at("text-line").hidden = true;
  });
  at("text-line").addEventListener("click", (event) => {
    const use = event.target.closest("use");
    if (use) choose(use.dataset.glyph);
  });
  at("save-text").addEventListener("click", () => lineSaid && download(lineSaid, "text.svg"));

  at("step").addEventListener("pointerdown", () => withSteps(() => {}));
  at("step").addEventListener("focus", () => withSteps(() => {}));
  at("step").addEventListener("input", () => withSteps(draw));
  at("gain").addEventListener("input", () => { at("gain-out").textContent = `${number(combs().gain)}×`; draw(); drawCompared(); });
  at("play").addEventListener("click", () => withSteps(() => {
    clearInterval(playing);
    for (const name of ["control", "feet"]) if (!layers.has(name)) document.querySelector(`[data-layer=${name}]`).click();
    at("step").value = "0";
    draw();
    playing = setInterval(() => {
      at("step").value = String(+at("step").value + 1);
      draw();
      if (+at("step").value >= steps.length) { clearInterval(playing); playing = null; }
    }, 280);
  }));
  at("compare").addEventListener("change", () => (at("compare").checked ? askCompared() : ((compared = null), drawCompared())));
  at("every").addEventListener("change", () => shown && !along && tell());
  at("restore").addEventListener("click", () => { state.moved = []; ask(); });
  at("copy").addEventListener("click", async () => {
    await navigator.clipboard.writeText(at("command").textContent);
    at("copy").textContent = "Copied";
    setTimeout(() => { at("copy").textContent = "Copy command"; }, 1200);
  });
  const download = (svg, name) => GS.download(svg, name, "image/svg+xml");
  at("save").addEventListener("click", async () => {
    const found = await post("/api/svg", JSON.stringify(state));
    if (!found.error) download(found.svg, `gid-${shown.gid}.svg`);
  });
  for (const id of ["picture", "beside"]) at(id).addEventListener("keydown", zoom.key);

  at("family").textContent = `${font.family} ${font.style}`;
  document.title = `${font.family} – glyphspline`;
  read();
  find();
  ask();
  awaiting(-1);
})();
