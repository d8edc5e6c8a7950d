"use strict";
/* The data beside the page: script files that call glyphsplineData, because a page opened from disk may not fetch. */

(() => {
  const KEPT = 20; // chunks of outlines held at a time
  const waiting = new Map();

  window.glyphsplineData = (data) => {
    const key = document.currentScript.dataset.key;
    waiting.get(key)?.(data);
  };

  const load = (folder, file) => new Promise((resolve, reject) => {
    const path = [...folder.split("/").filter(Boolean), "gallery", file].map(encodeURIComponent).join("/");
    const script = document.createElement("script");
    const end = (act, value) => {
      waiting.delete(path);
      script.remove();
      act(value);
    };
    script.dataset.key = path;
    script.src = path;
    waiting.set(path, (data) => end(resolve, data));
    script.onerror = () => end(reject, new Error(`${path} cannot be read`));
    document.head.append(script);
  });

  const numbered = (kind, index) => `${kind}-${String(index).padStart(5, "0")}.js`;

  /** All runs of the page with their tables: [{folder, family, …, rows}]; `progress` hears how many rows are in. */
  GS.loadRuns = async (folders, progress) => {
    const runs = [];
    let rows = 0;
    for (const folder of folders) {
      const run = Object.assign(await load(folder, "run.js"), { folder, tables: [] });
      for (let i = 0; i * run.table < run.glyphs; i++) {
        run.tables.push(await load(folder, numbered("table", i)));
        rows += run.tables[i].rows.length;
        progress(rows);
      }
      runs.push(run);
    }
    return runs;
  };

  const chunks = new Map(); // in order of use, the oldest first

  /** The drawings of row `index` of a run: a promise of {source, result, polygon, control, files, contours, error}. */
  GS.drawings = (run, index) => {
    const number = Math.floor(index / run.chunk), key = `${run.folder}/${number}`;
    const chunk = chunks.get(key) || load(run.folder, numbered("glyphs", number));
    chunks.delete(key);
    chunks.set(key, chunk);
    chunk.catch(() => chunks.delete(key));
    if (chunks.size > KEPT) chunks.delete(chunks.keys().next().value);
    return chunk.then((glyphs) => glyphs[index % run.chunk]);
  };

  GS.fileLink = (run, path) => [...run.folder.split("/"), ...path.split("/")]
    .filter((part) => part && part !== "..").map(encodeURIComponent).join("/");
})();
