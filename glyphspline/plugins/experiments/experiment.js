"use strict";

/* Times of the rows in their order, from the file beside the page. */
function glyphsplineData(seconds) {
  document.querySelectorAll("table.timed tbody tr").forEach((row, k) => {
    row.append(Object.assign(document.createElement("td"), {
      textContent: seconds[k] == null ? "–" : (1000 * seconds[k]).toPrecision(3),
    }));
  });
}

function valueOf(row, column) {
  const words = row.cells[column]?.textContent ?? "–", number = Number(words);
  return words === "–" ? null : Number.isNaN(number) ? words : number;
}

function compared(a, b) {
  if (a === null || b === null) return (a === null) - (b === null);
  return typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
}

function sort(head) {
  const body = head.closest("table").tBodies[0], column = head.cellIndex;
  const falls = head.getAttribute("aria-sort") === "ascending";
  for (const other of head.parentElement.cells) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", falls ? "descending" : "ascending");
  const rows = [...body.rows].map((row) => [valueOf(row, column), row]);
  rows.sort(([a], [b]) => (a === null || b === null || !falls ? compared(a, b) : compared(b, a)));
  body.append(...rows.map(([, row]) => row));
}

for (const head of document.querySelectorAll("th")) {
  const button = Object.assign(document.createElement("button"), { type: "button", textContent: head.textContent });
  head.replaceChildren(button);
  button.addEventListener("click", () => sort(head));
}
const times = document.createElement("script");
times.src = "times.js";
document.body.append(times);
document.body.dataset.ready = "";
