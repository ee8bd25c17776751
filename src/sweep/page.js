const { columns, rows, histories } = data;
const numeric = columns.map((_, k) => rows.some((row) => typeof row[k] === "number")
  && rows.every((row) => typeof row[k] === "number" || row[k] === ""));
const numbers = columns.map((_, k) => k).filter((k) => numeric[k]);
const show = (value) => typeof value === "number" ? digits(value) : value;
const SIZE = [620, 400], MARGIN = [70, 12, 12, 44];

/** Axes of a chart over ranges; says where a point lies. */
function axes(svg, [x0, x1], [y0, y1], [x, y]) {
  svg.replaceChildren();
  const [left, top, right, bottom] = [MARGIN[0], MARGIN[1], SIZE[0] - MARGIN[2], SIZE[1] - MARGIN[3]];
  const wide = (a, b) => a < b ? [a, b] : [a - (Math.abs(a) || 1) / 2, b + (Math.abs(b) || 1) / 2];
  [[x0, x1], [y0, y1]] = [wide(x0, x1), wide(y0, y1)];
  const place = (u, v) => [left + (u - x0) / (x1 - x0) * (right - left), bottom - (v - y0) / (y1 - y0) * (bottom - top)];
  add(svg, "rect", { x: left, y: top, width: right - left, height: bottom - top, fill: "none", stroke: "#767676" });
  for (const [value, label] of ticks(x0, x1, 6)) {
    const [u] = place(value, y0);
    add(svg, "line", { x1: u, x2: u, y1: bottom, y2: bottom + 5, stroke: "#333" });
    add(svg, "text", { x: u, y: bottom + 18, "text-anchor": "middle", "font-size": 12 }, label);
  }
  for (const [value, label] of ticks(y0, y1, 5)) {
    const [, v] = place(x0, value);
    add(svg, "line", { x1: left - 5, x2: left, y1: v, y2: v, stroke: "#333" });
    add(svg, "text", { x: left - 8, y: v + 4, "text-anchor": "end", "font-size": 12 }, label);
  }
  add(svg, "text", { x: (left + right) / 2, y: SIZE[1] - 8, "text-anchor": "middle", "font-size": 13 }, x);
  add(svg, "text", { x: left + 6, y: top + 16, "font-size": 13 }, y);
  return place;
}

const range = (values) => [Math.min(...values), Math.max(...values)];

function choose(id, chosen) {
  for (const k of numbers) add($(id), "option", { value: k, ...(k === chosen ? { selected: "" } : {}) }, columns[k]);
  $(id).addEventListener("change", draw);
}

/** The case under the pointer: its values and its force. */
function look(k) {
  $("case").replaceChildren();
  columns.forEach((column, c) => {
    if (rows[k][c] === "") return;
    const line = add($("case"), "div");
    add(line, "dt", {}, column);
    add(line, "dd", {}, show(rows[k][c]));
  });
  body.querySelectorAll("tr").forEach((row) => row.toggleAttribute("aria-current", Number(row.dataset.row) === k));
  const force = histories[k] ?? [], svg = $("history");
  svg.replaceChildren();
  if (force.length < 2) return;
  const place = axes(svg, range(force.map((p) => 1e3 * p[0])), range(force.map((p) => p[1])), ["time (ms)", "contact force (N)"]);
  const points = force.map(([t, f]) => place(1e3 * t, f).join(",")).join(" ");
  add(svg, "polyline", { points, fill: "none", stroke: "#0072b2", "stroke-width": 2 });
}

/** Shade of a value from the least to the largest. */
function shade(value, [low, high]) {
  const at = high > low ? (value - low) / (high - low) : 0;
  return `hsl(${230 - 200 * at} 75% ${55 - 10 * at}%)`;
}

function draw() {
  const [x, y, c] = ["x", "y", "colour"].map((id) => Number($(id).value));
  const known = rows.map((_, k) => k).filter((k) => [x, y].every((column) => typeof rows[k][column] === "number"));
  if (known.length === 0) return;
  const of = (column) => range(known.map((k) => rows[k][column]).filter((value) => typeof value === "number"));
  const place = axes($("cases"), of(x), of(y), [columns[x], columns[y]]);
  for (const k of known) {
    const [cx, cy] = place(rows[k][x], rows[k][y]);
    const fill = typeof rows[k][c] === "number" ? shade(rows[k][c], of(c)) : "none";
    const dot = add($("cases"), "circle", { cx, cy, r: 5, fill, stroke: "#333" });
    add(dot, "title", {}, `${columns[0]} ${rows[k][0]}`);
    dot.addEventListener("pointerenter", () => look(k));
  }
}

const table = $("table"), head = add(add(table, "thead"), "tr"), body = add(table, "tbody");
rows.forEach((row, k) => {
  const line = add(body, "tr", { "data-row": k });
  row.forEach((value, c) => add(line, "td", numeric[c] ? { class: "number" } : {}, show(value)));
  line.addEventListener("pointerenter", () => look(k));
});
columns.forEach((column, c) => {
  const cell = add(head, "th", { scope: "col", ...(numeric[c] ? { class: "number" } : {}) });
  add(cell, "button", { type: "button" }, column).addEventListener("click", () => {
    const up = cell.getAttribute("aria-sort") !== "ascending";
    for (const other of head.cells) other.removeAttribute("aria-sort");
    cell.setAttribute("aria-sort", up ? "ascending" : "descending");
    const value = (line) => rows[Number(line.dataset.row)][c];
    const order = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true });
    body.append(...[...body.rows].sort((a, b) => (up ? 1 : -1) * order(value(a), value(b))));
  });
});
const last = (name, otherwise) => { const k = numbers.find((k) => columns[k].endsWith(name)); return k ?? otherwise; };
choose("x", numbers[1] ?? 0);
choose("y", data.varied > 1 ? numbers[2] ?? 0 : last("peak_force_N", numbers[2] ?? 0));
choose("colour", last(" index", numbers[numbers.length - 1]));
draw();
if (rows.length > 0) look(0);
