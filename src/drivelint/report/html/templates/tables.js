"use strict";
(() => {
  // a click on a column's head sorts by it: by data-v where a cell has one, else by its number, else by its words
  const value = (row, column) => {
    const cell = row.cells[column];
    if (!cell) return "";
    const text = cell.dataset.v !== undefined ? cell.dataset.v : cell.textContent.trim();
    const number = /^[-\u2212]?\d/.test(text) ? parseFloat(text.replace("\u2212", "-")) : NaN;
    return Number.isNaN(number) ? (text === "-" || text === "\u00b7" ? "" : text.toLowerCase()) : number;
  };
  const before = (a, b) => {
    if (a === b) return 0;
    if (a === "" || b === "") return a === "" ? 1 : -1; // what is not known comes last
    if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
    return a < b ? -1 : 1;
  };
  const sort = (table, column, direction) => {
    const heads = table.tHead.rows[0].cells;
    for (const head of heads) head.removeAttribute("aria-sort");
    heads[column].setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
    const rows = [...table.tBodies[0].rows].map((row) => [value(row, column), row]);
    rows.sort(([a], [b]) => (a === "" || b === "" ? before(a, b) : direction * before(a, b)));
    table.tBodies[0].append(...rows.map(([, row]) => row));
  };
  for (const table of document.querySelectorAll("table.list")) {
    if (!table.tHead || table.matches(".stage-table, .hashes") || table.tBodies[0].rows.length < 2) continue;
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      if (!head.textContent.trim()) return;
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const direction = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
        sort(table, column, direction);
        table.dispatchEvent(new CustomEvent("sorted", { bubbles: true, detail: `${column}${direction < 0 ? "-" : ""}` }));
      });
    });
  }
  document.addEventListener("sort-table", (event) => {
    const [, column, down] = /^(\d+)(-?)$/.exec(event.detail) || [];
    if (column !== undefined && event.target.tHead.rows[0].cells[column]) sort(event.target, Number(column), down ? -1 : 1);
  });
})();
