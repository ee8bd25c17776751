if (data.damage) {
  const { cells, tags, places, modes, plies, impacts, end_s: end } = data.damage;
  const [map, place, time, play, grey] = ["map", "place", "time", "play", "grey"].map($);
  const colour = (mode) => data.colors[mode % data.colors.length];
  const criteria = new Set(modes.map((m) => m.criterion));
  const modeName = (m) => criteria.size > 1 ? `${modes[m].mode} (${modes[m].criterion})` : modes[m].mode;
  const angle = (ply, region) =>
    `${plies.filter((band) => band.region === region)[ply - 1].angle_deg}\u00b0`.replace("-", "\u2212");
  const called = ({ ply, region }) => {
    const of = region === undefined ? "" : ` of ${region}`;
    return ply.includes("|") ? `interface ${ply}${of}` : `ply ${ply}${of} (${angle(ply, region)})`;
  };
  const ms = (t) => `${digits(t * 1e3)} ms`;
  // Greys of ColorBrewer for indices below 1, as in the pictures.
  const GREYS = [255, 240, 217, 189, 150, 115];
  const shade = (index) => {
    const at = Math.min(1, Math.max(0, index)) * (GREYS.length - 1), low = Math.min(GREYS.length - 2, Math.floor(at));
    const value = Math.round(GREYS[low] + (GREYS[low + 1] - GREYS[low]) * (at - low));
    return `rgb(${value},${value},${value})`;
  };

  // The selector's first entry looks at all places at once.
  add(place, "option", { value: "" }, "all plies and interfaces");
  places.forEach((p, k) => add(place, "option", { value: k }, `${called(p)}${p.failed.length ? "" : ", intact"}`));
  const used = [...new Set(places.flatMap((p) => p.failed.map((f) => f[1])))].sort((a, b) => a - b);
  for (const mode of used) add($("legend"), "span", {}, modeName(mode)).style.setProperty("--swatch", colour(mode));
  if (!used.length) add($("legend"), "p", {}, "No mode reached index 1.");

  const corners = cells.flat();
  const [xs, ys] = [0, 1].map((d) => corners.map((p) => p[d]));
  const least = (values) => values.reduce((m, v) => Math.min(m, v), Infinity);
  const most = (values) => values.reduce((m, v) => Math.max(m, v), -Infinity);
  const [left, right, low, high] = [least(xs), most(xs), least(ys), most(ys)];
  const size = Math.max(right - left, high - low);
  const pad = 0.07 * size;
  map.setAttribute("viewBox", `${left - pad} ${-high - pad} ${right - left + 2 * pad} ${high - low + 2 * pad}`);
  const polygons = cells.map((cell) => add(map, "polygon", {
    points: cell.map(([x, y]) => `${x},${-y}`).join(" "), fill: "#fff", stroke: "#c4c4c4", "stroke-width": size * 8e-4,
  }));
  for (const [x, y] of impacts) {
    const arm = 0.018 * size;
    for (const [width, pen] of [[0.008, "#fff"], [0.003, "#222"]]) {
      add(map, "path", { d: `M${x - arm},${-y}h${2 * arm}M${x},${-y - arm}v${2 * arm}`, stroke: pen, "stroke-width": width * size });
    }
  }
  const scale = ticks(0, right - left, 5)[1];
  if (scale) {
    const [x, y] = [left, -low + 0.5 * pad];
    add(map, "path", { d: `M${x},${y}h${scale[0]}`, stroke: "#222", "stroke-width": 0.005 * size });
    add(map, "text", { x: x + scale[0] + 0.01 * size, y: y + 0.011 * size, "font-size": 0.032 * size, fill: "#222" }, `${scale[1]} mm`);
  }

  /** Of each cell the first failure in the places that are looked at. */
  let firsts = [], seen = places;
  function look() {
    seen = place.value === "" ? places : [places[place.value]];
    firsts = cells.map(() => null);
    for (const p of seen) {
      for (const [cell, mode, t] of p.failed) {
        if (firsts[cell] === null || t < firsts[cell].t) firsts[cell] = { mode, t, p };
      }
    }
    draw();
  }

  const now = () => time.value / time.max * end;
  function draw() {
    let count = 0;
    firsts.forEach((first, i) => {
      const failed = first !== null && first.t <= now();
      count += failed;
      const rest = grey.checked ? shade(seen.reduce((m, p) => Math.max(m, p.index[i]), 0)) : "#fff";
      polygons[i].setAttribute("fill", failed ? colour(first.mode) : rest);
      polygons[i].toggleAttribute("data-failed", failed);
    });
    $("time-out").textContent = ms(now());
    time.setAttribute("aria-valuetext", ms(now()));
    const where = place.options[place.selectedIndex].text.replace(", intact", "");
    $("count").textContent = `${count} of ${cells.length} cells have failed in ${where}.`;
    rows.forEach(({ row, cells: shown, k }) => {
      shown.textContent = new Set(places[k].failed.filter((f) => f[2] <= now()).map((f) => f[0])).size;
      row.setAttribute("aria-current", String(place.value === String(k)));
    });
  }

  // From the top ply down, as the plate lies.
  const rows = places.map((p, k) => ({ p, k })).filter(({ p }) => p.failed.length).reverse().map(({ p, k }) => {
    const row = add($("places").tBodies[0], "tr");
    const choose = add(add(row, "td"), "a", { href: "#damage" }, called(p));
    choose.addEventListener("click", (event) => event.preventDefault());
    row.addEventListener("click", () => { place.value = String(k); look(); });
    const shown = add(row, "td", { class: "number" });
    add(row, "td", { class: "number" }, digits(p.failed[0][2] * 1e3));
    return { row, cells: shown, k };
  });
  $("places").hidden = !rows.length;

  map.addEventListener("pointerover", (event) => {
    const i = polygons.indexOf(event.target);
    if (i < 0) return;
    const said = (p, f) => [f[2], `${ms(f[2])}: ${modeName(f[1])}, ${called(p)}`];
    const found = seen.flatMap((p) => p.failed.filter((f) => f[0] === i).map((f) => said(p, f)));
    const largest = seen.reduce((m, p) => p.index[i] > m.index[i] ? p : m, seen[0]);
    const lines = found.sort((a, b) => a[0] - b[0]).slice(0, 6).map((f) => f[1]);
    $("cell").textContent = [`cell ${tags[i]}, largest index ${digits(largest.index[i])} in ${called(largest)}`, ...lines].join("\n");
  });

  let timer = null;
  function stop() {
    clearInterval(timer);
    timer = null;
    play.textContent = "Play";
    play.setAttribute("aria-pressed", "false");
  }
  play.addEventListener("click", () => {
    if (timer !== null) return stop();
    if (Number(time.value) >= Number(time.max)) time.value = 0;
    play.textContent = "Stop";
    play.setAttribute("aria-pressed", "true");
    timer = setInterval(() => {
      time.value = Number(time.value) + 10;
      draw();
      if (Number(time.value) >= Number(time.max)) stop();
    }, 50);
  });
  time.addEventListener("input", draw);
  place.addEventListener("change", look);
  grey.addEventListener("change", draw);
  look();
}
