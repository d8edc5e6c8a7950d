"use strict";
/* The data beside the page: script files that call glyphsplineData, because a page opened from disk may not fetch. */

(() => {
  const KEPT = 800; // glyphs held at a time
  const waiting = new Map();

  window.glyphsplineData = (data) => {
    const key = document.currentScript.dataset.key;
    waiting.get(key)?.(data);
  };

  const load = (folder, file) => new Promise((resolve, reject) => {
    const path = GS.fileLink({ folder }, file);
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

  const numbered = (kind, index) => `gallery/${kind}-${String(index).padStart(5, "0")}.js`;

  /** All runs of the page with their tables: [{folder, family, …, rows}]; `progress` hears how many rows are in. */
  GS.loadRuns = async (folders, progress) => {
    const runs = [];
    let rows = 0;
    for (const folder of folders) {
      const run = Object.assign(await load(folder, "gallery/run.js"), { folder, tables: [] });
      for (let i = 0; i * run.table < run.glyphs; i++) {
        run.tables.push(await load(folder, numbered("table", i)));
        rows += run.tables[i].rows.length;
        progress(rows);
      }
      runs.push(run);
    }
    return runs;
  };

  const kept = new Map(); // in order of use, the oldest first
  const NOTHING = { source: "", result: "", polygon: "", control: "", files: {}, contours: [] };

  /** The drawing of a row: a promise of {source, result, polygon, control, files, contours}. */
  GS.drawing = (row) => {
    if (!row.file) return Promise.resolve(NOTHING);
    const key = `${row.run.folder}/${row.file}`, drawing = kept.get(key) || load(row.run.folder, row.file);
    kept.delete(key);
    kept.set(key, drawing);
    drawing.catch(() => kept.delete(key));
    if (kept.size > KEPT) kept.delete(kept.keys().next().value);
    return drawing;
  };

  GS.fileLink = (run, path) => [...run.folder.split("/"), ...path.split("/")]
    .filter((part) => part && part !== "..").map(encodeURIComponent).join("/");
})();
