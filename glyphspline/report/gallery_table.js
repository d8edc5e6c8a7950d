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

  GS.value = (row, measure) => (measure === "gid" ? row.gid : row.values[row.at[measure]] ?? null);

  const WANTED = {
    all: () => true,
    ok: (row) => row.status === "ok",
    failed: (row) => row.status === "failed",
    empty: (row) => row.status === "empty",
    "not-converged": (row) => GS.value(row, "converged") === false,
    outside: (row) => GS.value(row, "within_tolerance") === false,
  };

  const matches = (row, words) => {
    if (!words) return true;
    const lower = words.toLowerCase();
    return row.name.toLowerCase().includes(lower) || row.unicodes.toLowerCase().split(" ").includes(lower)
      || `gid ${row.gid}` === lower || (row.text && [...words].some((c) => row.text.includes(c)) && [...words].length < 40
        && !/^[\x20-\x7e]{2,}$/.test(words));
  };

  /** The rows to show, in order. `query`: {words, run, show, sort, down, least, most}. */
  GS.choose = (rows, query) => {
    const { sort, least, most } = query;
    const within = (value) => (least === null && most === null)
      || (value !== null && (least === null || value >= least) && (most === null || value <= most));
    const chosen = rows.filter((row) => (query.run === "" || row.run.folder === query.run) && WANTED[query.show](row)
      && matches(row, query.words) && within(GS.value(row, sort)));
    const sign = query.down ? -1 : 1;
    if (sort === "gid" && !query.down) return chosen;
    return chosen.map((row, i) => [GS.value(row, sort), i, row]).sort((a, b) => {
      if (a[0] === b[0]) return a[1] - b[1];
      if (a[0] === null) return 1; // what was not measured comes last either way
      if (b[0] === null) return -1;
      return a[0] < b[0] ? -sign : sign;
    }).map((item) => item[2]);
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

  GS.number = (value) => {
    if (value === null || value === undefined) return "–";
    if (value === true) return "yes";
    if (value === false) return "no";
    if (Number.isInteger(value) && Math.abs(value) < 1e6) return String(value);
    return String(+value.toPrecision(3)).replace("-", "\u2212");
  };
})();
