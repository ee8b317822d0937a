"use strict";
{
  // What cells are sorted by: numbers by value, then words, then what is unknown, whichever way the column is sorted.
  const words = new Intl.Collator("en", { numeric: true });
  const key = (cell, numeric) => {
    const text = cell.dataset.v ?? cell.textContent;
    if (text === "" || cell.textContent === "–") return { rank: 2 };
    const value = Number(text);
    return numeric && !Number.isNaN(value) ? { rank: 0, value } : { rank: 1, text };
  };
  const compare = (a, b, sign) => {
    if (a.rank !== b.rank) return a.rank - b.rank;
    if (a.rank === 0) return sign * (a.value - b.value);
    return a.rank === 1 ? sign * words.compare(a.text, b.text) : 0;
  };

  // Up, down, and back to the order of the file. Rows that are equal keep their order.
  const next = { none: "ascending", ascending: "descending", descending: "none" };
  const sort = (table, heads, rows, i) => {
    const order = next[heads[i].getAttribute("aria-sort") ?? "none"];
    for (const head of heads) head.removeAttribute("aria-sort");
    const sorted = [...rows];
    if (order !== "none") {
      heads[i].setAttribute("aria-sort", order);
      const sign = order === "ascending" ? 1 : -1;
      const numeric = heads[i].classList.contains("n");
      const keys = new Map(rows.map((row) => [row, key(row.cells[i], numeric)]));
      sorted.sort((a, b) => compare(keys.get(a), keys.get(b), sign));
    }
    table.tBodies[0].append(...sorted);
  };
  for (const table of document.querySelectorAll("table")) {
    const heads = [...table.tHead.rows[0].cells];
    const rows = [...table.tBodies[0].rows];
    heads.forEach((head, i) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      button.addEventListener("click", () => sort(table, heads, rows, i));
      head.append(button);
    });
  }

  // Print shows everything.
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:not([open])")];
    for (const details of opened) details.open = true;
  });
  addEventListener("afterprint", () => {
    for (const details of opened) details.open = false;
  });
}
