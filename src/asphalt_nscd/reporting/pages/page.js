// Tables that sort and copy; plots whose points say what they are. The page reads without it.
"use strict";
addEventListener("DOMContentLoaded", () => {
  const told = document.createElement("p");
  told.setAttribute("role", "status");
  told.className = "skip";
  document.body.append(told);

  const size = text => {
    const found = /^[−+-]?\d+(\.\d+)?(e[+-]?\d+)?/i.exec(text.trim());
    return found ? Number(found[0].replace("−", "-")) : NaN;
  };
  const compare = (a, b) => {
    if (!a || !b) return !a - !b;  // what is empty comes last
    const [x, y] = [size(a), size(b)];
    return Number.isNaN(x) || Number.isNaN(y) ? a.localeCompare(b, "en", {numeric: true}) : x - y;
  };
  const sort = (table, column, heading) => {
    const down = heading.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", down ? "descending" : "ascending");
    const text = row => row.cells[column].textContent.trim();
    const rows = [...table.tBodies[0].rows];
    rows.sort((a, b) => (down && text(a) && text(b) ? -1 : 1) * compare(text(a), text(b)));
    table.tBodies[0].append(...rows);
    told.textContent = `Sorted by ${heading.textContent.trim() || "first column"}, ${down ? "descending" : "ascending"}.`;
  };
  const copy = async text => {
    try {
      await navigator.clipboard.writeText(text);
    } catch {  // no clipboard for this page, as in some browsers for a file on disk
      const area = document.createElement("textarea");
      area.value = text;
      document.body.append(area);
      area.select();
      const done = document.execCommand("copy");
      area.remove();
      if (!done) throw new Error("not copied");
    }
  };
  for (const table of document.querySelectorAll("table")) {
    const head = table.tHead && table.tHead.rows.length === 1 ? table.tHead.rows[0] : null;
    if (!head || !table.tBodies.length) continue;
    if (table.tBodies[0].rows.length > 1 && !table.hasAttribute("data-ordered"))
      [...head.cells].forEach((heading, column) => {
        const button = document.createElement("button");
        button.type = "button";
        button.append(...heading.childNodes);
        if (!button.textContent.trim()) button.setAttribute("aria-label", "sort by this column");
        button.addEventListener("click", () => sort(table, column, heading));
        heading.append(button);
      });
    const button = document.createElement("button");
    button.type = "button";
    button.className = "copy";
    button.textContent = "Copy table";
    const name = table.caption ? table.caption.textContent : table.getAttribute("aria-label");
    if (name) button.setAttribute("aria-label", `Copy table: ${name.trim()}`);
    button.addEventListener("click", async () => {
      const rows = [...table.rows].map(row => [...row.cells].map(cell => cell.innerText.trim().replace(/\s+/g, " ")).join("\t"));
      const said = await copy(rows.join("\n")).then(() => "Copied", () => "Not copied: select the table instead");
      button.textContent = told.textContent = said;
      setTimeout(() => { button.textContent = "Copy table"; }, 2000);
    });
    (table.closest(".wide") || table).before(button);
  }

  // The same test, or a condition, which has no specimen, and a test at it.
  const same = (a, b) => a === b || a.startsWith("|") && b.endsWith(a) || b.startsWith("|") && a.endsWith(b);
  for (const figure of document.querySelectorAll("figure.chart")) {
    const said = figure.querySelector(".said"), hint = said.textContent;
    let chosen = null;
    const choose = (svg, point) => {
      for (const other of document.querySelectorAll(".on")) other.classList.remove("on");
      chosen = point;
      if (point) point.classList.add("on");
      if (point?.dataset.test) for (const other of document.querySelectorAll("[data-test]"))
        if (same(other.dataset.test, point.dataset.test)) other.classList.add("on");
      said.textContent = point ? point.querySelector("title").textContent : hint;
    };
    for (const svg of figure.querySelectorAll("svg")) {
      const points = [...svg.querySelectorAll("title")].map(title => title.parentNode);
      const under = event => points.find(point => point.contains(event.target));
      for (const kind of ["pointerover", "click"])
        svg.addEventListener(kind, event => { if (under(event)) choose(svg, under(event)); });
      svg.addEventListener("keydown", event => {
        const at = points.indexOf(chosen), last = points.length - 1;
        const to = {ArrowRight: at + 1, ArrowDown: at + 1, ArrowLeft: at - 1, ArrowUp: at - 1, Home: 0, End: last}[event.key];
        if (event.key === "Escape") return choose(svg, null);
        if (to === undefined) return;
        event.preventDefault();
        choose(svg, points[Math.min(Math.max(to, 0), last)]);
      });
    }
  }
});
