// Colours of curves, as in the pictures; darker when they come again.
const PENS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#7a0177",
  "#8c564b", "#005a32", "#b2df8a", "#000075", "#d0a0ff", "#984ea3"];
const pen = (k) => `color-mix(in srgb, ${PENS[k % PENS.length]} ${100 * 0.7 ** Math.floor(k / PENS.length)}%, black)`;
const WIDTH = 800, HEIGHT = 470, LEFT = 92, RIGHT = 30, TOP = 12, BOTTOM = 64;

/** The first index whose time is not before `t`. */
function atTime(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1; else high = middle;
  }
  return low;
}

/** Bar, empty drawing and status line in the place of the still picture in `figure`, which stays where scripts do not run. */
function makeFrame(figure, label) {
  figure.querySelectorAll(".drawing, img").forEach((still) => still.remove());
  const caption = figure.querySelector("figcaption");
  const bar = add(null, "div", { class: "chart-bar" });
  const key = add(bar, "div", { class: "chart-key", "aria-live": "off" });
  const reset = add(bar, "button", { type: "button", disabled: "" }, "Whole");
  const svg = add(null, "svg", {
    class: "chart", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, tabindex: "0", role: "img", "font-size": "19", "aria-label": label,
  });
  figure.insertBefore(bar, caption);
  figure.insertBefore(svg, caption);
  const live = add(figure, "p", { role: "status", class: "chart-live" });
  return { key, reset, svg, live };
}

/** Keeps as much room for `key` as what it shows now takes, so that the drawing under it stays where it is. */
function keepRoom(key) {
  key.style.minHeight = `${key.offsetHeight}px`;
}

/** Clears `svg`, draws its grid and the names of its axes; the group that curves are drawn in. */
function drawGrid(svg, id, across, up) {
  svg.replaceChildren();
  const x = (v) => LEFT + (v - across.low) / (across.high - across.low) * (WIDTH - LEFT - RIGHT);
  const y = (v) => HEIGHT - BOTTOM - (v - up.low) / (up.high - up.low) * (HEIGHT - TOP - BOTTOM);
  const clip = `clip-${id}`;
  add(add(add(svg, "defs"), "clipPath", { id: clip }), "rect",
    { x: LEFT, y: TOP, width: WIDTH - LEFT - RIGHT, height: HEIGHT - TOP - BOTTOM });
  for (const [value, label] of ticks(across.low, across.high, 7)) {
    add(svg, "line", { x1: x(value), x2: x(value), y1: TOP, y2: HEIGHT - BOTTOM, stroke: "#e3e3e3" });
    add(svg, "text", { x: x(value), y: HEIGHT - BOTTOM + 24, "text-anchor": "middle", fill: "#222" }, label);
  }
  for (const [value, label] of ticks(up.low, up.high, 6)) {
    add(svg, "line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), stroke: value === 0 ? "#666" : "#e3e3e3" });
    add(svg, "text", { x: LEFT - 8, y: y(value) + 6, "text-anchor": "end", fill: "#222" }, label);
  }
  add(svg, "text", { x: (LEFT + WIDTH - RIGHT) / 2, y: HEIGHT - 8, "text-anchor": "middle", fill: "#222" }, across.name);
  const middle = (TOP + HEIGHT - BOTTOM) / 2;
  add(svg, "text", { x: 20, y: middle, "text-anchor": "middle", fill: "#222", transform: `rotate(-90 20 ${middle})` }, up.name);
  return { x, y, plot: add(svg, "g", { "clip-path": `url(#${clip})` }) };
}

/** A chart in the place of the still picture in `figure`. */
function makeChart(figure, curves, chart, marks) {
  const { times, time_unit: unit, per_s: perSecond } = curves;
  const whole = [times[0], times[times.length - 1]];
  if (!(whole[1] > whole[0])) return;
  const { key, reset, svg, live } = makeFrame(figure,
    `${chart.quantity} over time: ${chart.series.map((s) => s.name).join(", ")}. Arrow keys read values.`);
  let view = [...whole], reading = null, drag = null, x, y;

  const timeAt = (event) => {
    const box = svg.getBoundingClientRect();
    const share = ((event.clientX - box.left) / box.width * WIDTH - LEFT) / (WIDTH - LEFT - RIGHT);
    return view[0] + Math.min(1, Math.max(0, share)) * (view[1] - view[0]);
  };
  const show = (from, to) => {
    const least = (whole[1] - whole[0]) * 1e-3;
    from = Math.max(whole[0], from);
    to = Math.min(whole[1], to);
    if (to - from < least) return;
    view = [from, to];
    draw();
  };
  const zoom = (about, factor) => show(about - (about - view[0]) * factor, about + (view[1] - about) * factor);

  function draw() {
    const [first, last] = [Math.max(0, atTime(times, view[0]) - 1), Math.min(times.length - 1, atTime(times, view[1]))];
    let low = 0, high = 0;
    for (const { values } of chart.series) {
      for (let i = first; i <= last; i += 1) { low = Math.min(low, values[i]); high = Math.max(high, values[i]); }
    }
    if (low === high) high = low + 1;
    const air = 0.05 * (high - low);
    if (low < 0) low -= air;
    high += air;
    const grid = drawGrid(svg, chart.id, { low: view[0], high: view[1], name: `Time (${unit})` },
      { low, high, name: `${chart.quantity} (${chart.unit})` });
    ({ x, y } = grid);
    const { plot } = grid;
    let row = 0;
    for (const [time, name] of marks) {
      const place = x(time * perSecond);
      const line = add(plot, "line",
        { x1: place, x2: place, y1: TOP, y2: HEIGHT - BOTTOM, stroke: "#b34e00", "stroke-dasharray": "5 4" });
      add(line, "title", {}, name);
      const right = place > (LEFT + WIDTH - RIGHT) / 2;
      add(plot, "text", { x: place + (right ? -6 : 6), y: TOP + 18 + 20 * (row % 8), "text-anchor": right ? "end" : "start",
        "font-size": "16", fill: "#b34e00", stroke: "#fff", "stroke-width": "4", "paint-order": "stroke" }, name);
      row += 1;
    }
    chart.series.forEach(({ values }, k) => {
      let points = "";
      for (let i = first; i <= last; i += 1) if (values[i] !== null) points += `${x(times[i]).toFixed(1)},${y(values[i]).toFixed(1)} `;
      add(plot, "polyline", { points, fill: "none", stroke: pen(k), "stroke-width": "2.5" });
    });
    add(svg, "g", { class: "cursor" });
    reset.disabled = view[0] === whole[0] && view[1] === whole[1];
    read(reading, false);
  }

  /** Shows the values at row `i`, or the names alone. */
  function read(i, aloud) {
    reading = i;
    key.replaceChildren();
    const cursor = svg.querySelector(".cursor");
    cursor.replaceChildren();
    if (i !== null) add(key, "b", {}, `${digits(times[i])} ${unit}`);
    const several = chart.series.length > 1 || i !== null;
    chart.series.forEach(({ name, values }, k) => {
      if (!several) return;
      const entry = add(key, "span", {}, i === null || values[i] === null ? name : `${name} ${digits(values[i])} ${chart.unit}`);
      entry.style.setProperty("--swatch", pen(k));
    });
    if (i === null || times[i] < view[0] || times[i] > view[1]) return;
    add(cursor, "line", { x1: x(times[i]), x2: x(times[i]), y1: TOP, y2: HEIGHT - BOTTOM, stroke: "#666" });
    chart.series.forEach(({ values }, k) => values[i] !== null && add(cursor, "circle",
      { cx: x(times[i]), cy: y(values[i]), r: 4.5, fill: pen(k), stroke: "#fff" }));
    if (aloud) live.textContent = key.textContent;
  }

  svg.addEventListener("pointermove", (event) => {
    const t = timeAt(event);
    read(atTime(times, t), false);
    if (drag === null) return;
    const [a, b] = [x(Math.min(drag, t)), x(Math.max(drag, t))];
    add(svg.querySelector(".cursor"), "rect",
      { x: a, y: TOP, width: b - a, height: HEIGHT - TOP - BOTTOM, fill: "#0072b2", "fill-opacity": "0.15" });
  });
  svg.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || event.pointerType === "touch") return;
    drag = timeAt(event);
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointerup", (event) => {
    const [from, to] = [drag, timeAt(event)];
    drag = null;
    if (from !== null && Math.abs(to - from) > 0.01 * (view[1] - view[0])) show(Math.min(from, to), Math.max(from, to));
  });
  svg.addEventListener("pointerleave", () => { if (drag === null) read(null, false); });
  svg.addEventListener("dblclick", () => show(...whole));
  // The wheel alone moves the page.
  svg.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoom(timeAt(event), event.deltaY < 0 ? 0.8 : 1.25);
  }, { passive: false });
  svg.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 20 : 1;
    const from = reading ?? atTime(times, view[0]);
    const actions = {
      ArrowRight: () => read(Math.min(times.length - 1, from + step), true),
      ArrowLeft: () => read(Math.max(0, from - step), true),
      "+": () => zoom(times[from], 0.7), "-": () => zoom(times[from], 1.4), 0: () => show(...whole),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  });
  reset.addEventListener("click", () => show(...whole));
  draw();
  read(times.length - 1, false);
  keepRoom(key);
  read(null, false);
}

if (data.curves) {
  for (const figure of document.querySelectorAll("figure[data-chart]")) {
    const chart = data.curves.charts.find((c) => c.id === figure.dataset.chart);
    if (chart) makeChart(figure, data.curves, chart, data.marks);
  }
}
