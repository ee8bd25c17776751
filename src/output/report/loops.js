/** Of each impactor the displacements that its force is drawn over. */
function findLoops({ charts }) {
  const [force, displacement] = ["contact_force", "displacement"].map((id) => charts.find((chart) => chart.id === id));
  if (!force || !displacement) return null;
  const loops = [];
  for (const { name, values: forces } of force.series) {
    if (!name.startsWith("contact force")) continue;
    const of = name.slice("contact force".length);
    const [plate, impactor] = ["plate under the impactor", "impactor"].map((what) =>
      displacement.series.find((series) => series.name === what + of)?.values);
    if (!plate || !impactor) continue;
    // Out of contact there is no force to show; the ends of a contact are.
    const rows = forces.map((_, i) => i).filter((i) => forces[i] || forces[i - 1] || forces[i + 1]);
    const curve = (what, at) => ({ name: what + of, points: rows.map((i) => [at(i), forces[i], i]) });
    loops.push(curve("plate", (i) => plate[i]), curve("impactor", (i) => impactor[i]),
      curve("indentation", (i) => impactor[i] - plate[i]));
  }
  return loops.some((loop) => loop.points.length > 0) ? { force, displacement, loops } : null;
}

/** The force over displacements in the place of the still picture in `figure`. */
function makeLoops(figure, { times, time_unit: unit }, { force, displacement, loops }) {
  const { key, reset, svg, live } = makeFrame(figure,
    `Contact force over displacements: ${loops.map((loop) => loop.name).join(", ")}. Arrow keys read values.`);
  const all = loops.flatMap((loop) => loop.points);
  const rows = [...new Set(all.map((point) => point[2]))].sort((a, b) => a - b);
  const range = (k) => {
    const values = all.map((point) => point[k]);
    const [low, high] = [Math.min(0, ...values), Math.max(...values)];
    const air = 0.05 * (high - low || 1);
    return { low: low < 0 ? low - air : low, high: high + air };
  };
  const whole = [range(0), range(1)];
  let view = whole, reading = null, drag = null, x, y;

  const pointAt = (event) => {
    const box = svg.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width * WIDTH, (event.clientY - box.top) / box.height * HEIGHT];
  };
  const valuesAt = ([a, b]) => [
    view[0].low + (a - LEFT) / (WIDTH - LEFT - RIGHT) * (view[0].high - view[0].low),
    view[1].low + (HEIGHT - BOTTOM - b) / (HEIGHT - TOP - BOTTOM) * (view[1].high - view[1].low),
  ];
  const show = (wanted) => {
    const least = (axis, k) => axis.high - axis.low >= 1e-3 * (whole[k].high - whole[k].low);
    if (!wanted.every(least)) return;
    view = wanted.map((axis, k) => ({ low: Math.max(axis.low, whole[k].low), high: Math.min(axis.high, whole[k].high) }));
    draw();
  };
  const zoom = ([a, b], factor) => show([a, b].map((about, k) =>
    ({ low: about - (about - view[k].low) * factor, high: about + (view[k].high - about) * factor })));

  function draw() {
    const grid = drawGrid(svg, "loops", { ...view[0], name: `Displacement (${displacement.unit})` },
      { ...view[1], name: `Contact force (${force.unit})` });
    ({ x, y } = grid);
    loops.forEach(({ points }, k) => add(grid.plot, "polyline", {
      points: points.map(([a, b]) => `${x(a).toFixed(1)},${y(b).toFixed(1)}`).join(" "),
      fill: "none", stroke: pen(k), "stroke-width": "2.5",
    }));
    add(svg, "g", { class: "cursor" });
    reset.disabled = view.every((axis, k) => axis.low === whole[k].low && axis.high === whole[k].high);
    read(reading, false);
  }

  /** Shows the values at row `i`, or the names alone. */
  function read(i, aloud) {
    reading = i;
    key.replaceChildren();
    const cursor = svg.querySelector(".cursor");
    cursor.replaceChildren();
    const under = (point) => `, ${digits(point[1])} ${force.unit}`;
    // The curves of one impactor have its force in common.
    const one = loops.length === 3 && loops[0].points.find((point) => point[2] === i);
    if (i !== null) add(key, "b", {}, `${digits(times[i])} ${unit}${one ? under(one) : ""}`);
    loops.forEach(({ name, points }, k) => {
      const point = i === null ? undefined : points.find((one) => one[2] === i);
      const text = point ? `${name} ${digits(point[0])} ${displacement.unit}${one ? "" : under(point)}` : name;
      add(key, "span", {}, text).style.setProperty("--swatch", pen(k));
      const inside = point && view.every((axis, n) => point[n] >= axis.low && point[n] <= axis.high);
      if (inside) add(cursor, "circle", { cx: x(point[0]), cy: y(point[1]), r: 4.5, fill: pen(k), stroke: "#fff" });
    });
    if (aloud) live.textContent = key.textContent;
  }

  function nearest([a, b]) {
    const far = (point) => (x(point[0]) - a) ** 2 + (y(point[1]) - b) ** 2;
    return all.reduce((best, point) => (far(point) < far(best) ? point : best))[2];
  }

  svg.addEventListener("pointermove", (event) => {
    const here = pointAt(event);
    read(nearest(here), false);
    if (drag === null) return;
    const [left, top] = here.map((v, k) => Math.min(v, drag[k]));
    add(svg.querySelector(".cursor"), "rect", { x: left, y: top, width: Math.abs(here[0] - drag[0]),
      height: Math.abs(here[1] - drag[1]), fill: "#0072b2", "fill-opacity": "0.15" });
  });
  svg.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || event.pointerType === "touch") return;
    drag = pointAt(event);
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointerup", (event) => {
    const [from, to] = [drag, pointAt(event)];
    drag = null;
    if (from === null || Math.abs(to[0] - from[0]) < 10 || Math.abs(to[1] - from[1]) < 10) return;
    const [one, other] = [valuesAt(from), valuesAt(to)];
    show(one.map((v, k) => ({ low: Math.min(v, other[k]), high: Math.max(v, other[k]) })));
  });
  svg.addEventListener("pointerleave", () => { if (drag === null) read(null, false); });
  svg.addEventListener("dblclick", () => show(whole));
  // The wheel alone moves the page.
  svg.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoom(valuesAt(pointAt(event)), event.deltaY < 0 ? 0.8 : 1.25);
  }, { passive: false });
  svg.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 20 : 1;
    const from = reading === null ? 0 : rows.indexOf(reading);
    const about = () => all.find((point) => point[2] === rows[from]);
    const actions = {
      ArrowRight: () => read(rows[Math.min(rows.length - 1, from + step)], true),
      ArrowLeft: () => read(rows[Math.max(0, from - step)], true),
      "+": () => zoom(about(), 0.7), "-": () => zoom(about(), 1.4), 0: () => show(whole),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  });
  reset.addEventListener("click", () => show(whole));
  draw();
  read(rows[rows.length - 1], false);
  keepRoom(key);
  read(null, false);
}

const loopsFigure = $("picture-force_displacement");
const foundLoops = loopsFigure && data.curves && findLoops(data.curves);
if (foundLoops) makeLoops(loopsFigure, data.curves, foundLoops);
