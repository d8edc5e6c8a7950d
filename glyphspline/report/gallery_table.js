"use strict";
/* Rows of all runs: what is searched, filtered and sorted by. */

(() => {
  /** One row a glyph: {run, name, gid, unicodes, text, status, file, error, values}. */
  GS.rows = (runs) => {
    const rows = [];
    for (const run of runs) {
      for (const table of run.tables) {
        const at = Object.fromEntries(table.columns.map((name, column) => [name, column]));
        for (const values of table.rows) {
          const codes = values[at.unicodes];
          const text = codes.split(" ").filter(Boolean).map((code) => String.fromCodePoint(parseInt(code.slice(2), 16))).join("");
          rows.push({
            run, name: values[at.glyph], gid: values[at.gid], unicodes: codes, text, advance: values[at.advance],
            status: values[at.status], file: values[at.file] ?? null, error: values[at.error] ?? null, values, at,
          });
        }
      }
    }
    return rows;
  };

  /** A row's measure in the unit that is shown. */
  GS.value = (row, measure) => (measure === "gid" ? row.gid
    : GS.shown(measure, row.values[row.at[measure]] ?? null, row.run.metrics.units_per_em));

  /** What a glyph's contours enclose else than their source, in words; "" if nothing. */
  GS.changed = (row) => [
    GS.value(row, "new_crossings") > 0 && `new crossings: ${GS.value(row, "new_crossings")}`,
    GS.value(row, "collapsed") && "lost its area",
    GS.value(row, "source_kept") && "source kept",
  ].filter(Boolean).join(", ");

  const WANTED = {
    all: () => true,
    ok: (row) => row.status === "ok",
    failed: (row) => row.status === "failed",
    empty: (row) => row.status === "empty",
    "not-converged": (row) => GS.value(row, "converged") === false,
    outside: (row) => GS.value(row, "within_tolerance") === false,
    changed: (row) => GS.changed(row) !== "",
  };

  const matches = (row, words) => {
    if (!words) return true;
    const lower = words.toLowerCase();
    return row.name.toLowerCase().includes(lower) || row.unicodes.toLowerCase().split(" ").includes(lower)
      || `gid ${row.gid}` === lower || (row.text && [...words].some((c) => row.text.includes(c)) && [...words].length < 40
        && !/^[\x20-\x7e]{2,}$/.test(words));
  };

  /** 0 for what was asked for to the letter, 1 but for capitals, 2 for what only contains it. */
  const rank = (row, words) => {
    const lower = words.toLowerCase();
    if (row.name === words || row.text === words || `gid ${row.gid}` === lower || row.unicodes.toLowerCase().split(" ").includes(lower)) return 0;
    return row.name.toLowerCase() === lower ? 1 : 2;
  };

  /** The rows to show, exact matches first, then in the order asked for. `query`: {words, run, show, sort, down, least, most}. */
  GS.choose = (rows, query) => {
    const { sort, least, most } = query;
    const within = (value) => (least === null && most === null)
      || (value !== null && (least === null || value >= least) && (most === null || value <= most));
    const chosen = rows.filter((row) => (query.run === "" || row.run.folder === query.run) && WANTED[query.show](row)
      && matches(row, query.words) && within(GS.value(row, sort)));
    const sign = query.down ? -1 : 1;
    if (sort === "gid" && !query.down && !query.words) return chosen;
    const ranked = (row) => (query.words ? rank(row, query.words) : 0);
    const order = (row, i) => (sort === "gid" ? i : GS.value(row, sort)); // fonts stay together in the order of glyphs
    return chosen.map((row, i) => [order(row, i), i, row, ranked(row)]).sort((a, b) => {
      if (a[3] !== b[3]) return a[3] - b[3];
      if (a[0] === b[0]) return a[1] - b[1];
      if (a[0] === null) return 1; // what was not measured comes last either way
      if (b[0] === null) return -1;
      return a[0] < b[0] ? -sign : sign;
    }).map((item) => item[2]);
  };

  /** Rows as CSV with a header, in the units that are shown. Text that a spreadsheet would compute is kept from it. */
  GS.csv = (rows) => {
    const names = [...GS.measures.keys()].filter((name) => rows.some((row) => GS.value(row, name) !== null));
    const written = (value) => {
      if (typeof value !== "string") return value === null || value === undefined ? "" : String(value);
      const safe = /^[=+\-@\t\r]/.test(value) ? `'${value}` : value;
      return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
    };
    const titled = (name) => { const { label, unit } = GS.measures.get(name); return unit ? `${label} (${unit})` : label; };
    const lines = [["font", "glyph", "gid", "unicodes", "advance (units)", "status", "error", ...names.map(titled)],
      ...rows.map((row) => [`${row.run.family} ${row.run.style}`.trim(), row.name, row.gid, row.unicodes, row.advance, row.status,
        row.error, ...names.map((name) => GS.value(row, name))])];
    return lines.map((line) => `${line.map(written).join(",")}\r\n`).join("");
  };

  /** Counts in `bins` equal steps between the least and largest value; {low, high, counts} or null. */
  GS.histogram = (rows, measure, bins = 40) => {
    let low = Infinity, high = -Infinity;
    const values = [];
    for (const row of rows) {
      const value = GS.value(row, measure);
      if (typeof value !== "number") continue;
      values.push(value);
      if (value < low) low = value;
      if (value > high) high = value;
    }
    if (values.length < 2 || low === high) return null;
    const counts = new Array(bins).fill(0);
    for (const value of values) counts[Math.min(bins - 1, Math.floor(((value - low) / (high - low)) * bins))]++;
    return { low, high, counts };
  };
})();
