"use strict";
// A click on the head of a column sorts by it, a second one the other way round, a third restores the order.
(() => {
  const next = { none: "ascending", ascending: "descending", descending: "none" };
  const order = { pass: 0, inconclusive: 1, fail: 2 };
  const text = (row, column) => row.cells[column].textContent.trim();

  // By verdict, by number where every cell begins with one, else as text; a dash is no number and comes last.
  const sorting = (rows, column) => {
    const texts = rows.map(row => text(row, column)).filter(cell => cell !== "-" && cell !== "");
    if (texts.every(cell => cell in order)) return cell => order[cell];
    if (texts.every(cell => Number.isFinite(parseFloat(cell)) || /^-?(NaN|inf)$/.test(cell))) {
      return cell => parseFloat(cell.replace(/inf$/, "Infinity"));
    }
    return null;
  };

  const sort = (table, column, direction) => {
    const body = table.tBodies[0];
    const all = [...body.rows];
    for (const [place, row] of all.entries()) row.dataset.place ??= place;
    // Sorted, the rows belong to no group any more.
    table.classList.toggle("sorted", direction !== "none");
    const rows = direction === "none" ? all : all.filter(row => row.className !== "group");
    const key = sorting(rows, column);
    const sign = direction === "descending" ? -1 : 1;
    rows.sort((a, b) => {
      if (direction === "none") return a.dataset.place - b.dataset.place;
      if (!key) return sign * text(a, column).localeCompare(text(b, column), "en", { numeric: true });
      const [x, y] = [key(text(a, column)), key(text(b, column))];
      const [left, right] = [x, y].map(value => value === undefined || Number.isNaN(value));
      if (left || right) return left - right;
      return x === y ? a.dataset.place - b.dataset.place : sign * (x < y ? -1 : 1);
    });
    body.append(...rows);
  };

  for (const table of document.querySelectorAll("table")) {
    // Columns of sentences deserve room, columns of numbers need none.
    for (const cell of table.querySelectorAll("td")) cell.classList.toggle("long", cell.textContent.length > 60);
    const heads = [...table.tHead.rows[0].cells];
    for (const [column, head] of heads.entries()) {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      head.setAttribute("aria-sort", "none");
      button.addEventListener("click", () => {
        const direction = next[head.getAttribute("aria-sort")];
        for (const other of heads) other.setAttribute("aria-sort", "none");
        head.setAttribute("aria-sort", direction);
        sort(table, column, direction);
      });
    }
  }
})();
