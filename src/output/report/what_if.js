/** Impacts that the page marches itself: a panel of what may be other than in the run, curves, first damage, limits. */
if (data.what_if?.plate) {
  const what = data.what_if, { impact, plate } = what, section = $("what-if"), form = $("what-if-settings");
  const bytes = Uint8Array.from(atob(plate.operator), (c) => c.charCodeAt(0)), view = new DataView(bytes.buffer);
  const operator = Float64Array.from({ length: bytes.length / 8 }, (_, i) => view.getFloat64(8 * i, true));
  // Deflections, in A (w/h)², from which on a linear plate is wrong by more than 5 %; changes of a force faster than those of the run.
  const STRETCHED = 0.05, FASTER = 1.5;

  /** A number that may be set: by a slider over a range about that of the run, or as it is written. */
  const settings = [];
  const setting = (name, unit, perSi, value, range) => {
    const label = add(form, "label", {}, `${name} (${unit})`), own = Number((value * perSi).toPrecision(12));
    const number = add(label, "input", { type: "number", value: own, step: "any", min: 0, "aria-label": `${name} in ${unit}` });
    const slider = add(label, "input", { type: "range", min: -100, max: 100, value: 0, "aria-label": `${name}, slider` });
    const one = { name, number, read: () => Number(number.value) === own ? value : Number(number.value) / perSi, reset() {} };
    one.reset = () => { number.value = own; slider.value = 0; };
    slider.addEventListener("input", () => {
      number.value = Number(slider.value) === 0 ? own : Number((own * range ** (slider.value / 100)).toPrecision(4));
      answer();
    });
    number.addEventListener("input", () => {
      slider.value = Math.round(100 * Math.log(number.value / own) / Math.log(range));
      answer();
    });
    settings.push(one);
    return one;
  };
  const mass = setting("mass", "kg", 1, impact.mass, 5), velocity = setting("velocity", "m/s", 1, impact.velocity, 4);
  const stiffness = setting("contact stiffness k", `N/m^${what.law.n}`, 1, what.law.k, 10);
  const used = new Set(plate.places.map((place) => place.material));
  const strengths = what.strengths.map(([material, of], k) => used.has(k)
    ? Object.entries(of).map(([name, value]) => [name, setting(`${material}: ${name}`, "MPa", 1e-6, value, 2)]) : []);
  add(form, "button", { type: "button" }, "As in the run").addEventListener("click", () => {
    settings.forEach((one) => one.reset());
    answer();
  });

  const charts = ["what-if-force", "what-if-energy"].map((id) => {
    const figure = $(id), key = add(null, "div", { class: "chart-key" });
    const svg = add(null, "svg", { class: "chart", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "font-size": "19",
      "aria-label": figure.textContent });
    figure.prepend(key, svg);
    return { id, key, svg };
  });
  const chart = ({ id, key, svg }, name, curves) => {
    const end = Math.max(...curves.map(({ x }) => x[x.length - 1]));
    const high = 1.05 * Math.max(1e-300, ...curves.map(({ y }) => y.reduce((a, b) => Math.max(a, b), 0)));
    const { x, y, plot } = drawGrid(svg, id, { low: 0, high: end, name: "Time (ms)" }, { low: 0, high, name });
    key.replaceChildren();
    for (const curve of curves) {
      const every = Math.max(1, Math.floor(curve.x.length / 800));
      let points = "";
      for (let i = 0; i < curve.x.length; i += every) points += `${x(curve.x[i]).toFixed(1)},${y(curve.y[i]).toFixed(1)} `;
      add(plot, "polyline", { points, fill: "none", stroke: curve.pen, "stroke-width": "2.5" });
      add(key, "span", {}, curve.name).style.setProperty("--swatch", curve.pen);
    }
  };

  const march = (own) => {
    const found = marchImpact(what, makeLaw({ ...what.law, k: own.k }), own.mass, own.velocity);
    const strong = strengths.map((of) => Object.fromEntries(of.map(([name, one]) => [name, one.read()])));
    let square = 0, rate = 0, peak = 0, deepest = 0;
    for (let i = 1; i <= found.done; i += 1) {
      square += found.forces[i] ** 2;
      rate += ((found.forces[i] - found.forces[i - 1]) / found.h) ** 2;
      peak = Math.max(peak, found.forces[i]);
      deepest = Math.max(deepest, found.deflections[i]);
    }
    return { ...found, peak, deepest, frequency: Math.sqrt(rate / square) / (2 * Math.PI), damage: judge(what, operator, found, strong) };
  };
  const values = () => ({ mass: mass.read(), velocity: velocity.read(), k: stiffness.read() });
  const run = march(values());

  /** What holds and what does not, of the impact `now`: sentences, and whether they are doubts. */
  const limits = (now, own) => {
    const all = [];
    if (what.stretch) {
      const [a, h] = what.stretch, number = a * (now.deepest / h) ** 2;
      all.push([number > STRETCHED, number > STRETCHED
        ? `The plate deflects by ${digits(now.deepest / h)} thicknesses: its stretching, which is left out here, would make the force about ${Math.round(100 * number)} % larger. Use effects.membrane.`
        : `The plate deflects by ${digits(now.deepest / h)} thicknesses, within the linear range (${Number((100 * number).toPrecision(2))} % of stiffening).`]);
    }
    if (plate.places.length) {
      const all_ = plate.places.length === plate.watched;
      all.push([false, all_ ? `All ${plate.watched} places that the run watches are judged.`
        : `${plate.places.length} of ${plate.watched} places are judged. In this run, and in ones of 4 times the mass, or of a quarter at twice the velocity, no other had more than ${Math.ceil(100 * plate.left)} % of the largest index at the same time.`]);
    }
    if (what.unjudged.length) all.push([true, `Not judged here: ${what.unjudged.join(", ")}.`]);
    const faster = now.frequency / run.frequency;
    if (faster > FASTER) all.push([true, `The force changes ${digits(faster)} times as fast as in the run: what the run says of the errors of step and reduction does not speak for it.`]);
    else if (now.peak > 0) all.push([false, "The force changes about as fast as in the run, whose estimates of errors of step, mesh and reduction speak for it."]);
    const stiffer = own.k / what.law.k;
    if (stiffer > 2) all.push([true, "The contact is more than twice as stiff: compare with a shorter step."]);
    return all;
  };

  const body = $("what-if-damage").tBodies[0];
  const tile = (label, value, unit) => {
    const box = add($("what-if-tiles"), "div");
    add(box, "dt", {}, label);
    add(add(box, "dd", {}, `${digits(value)} `), "span", { class: "unit" }, unit);
  };
  function answer() {
    const begun = performance.now(), own = values(), good = settings.every((one) => one.read() > 0);
    if (!good) return;
    const now = march(own), ms = (t) => t * 1e3;
    const steps = ({ forces, h }, pen, name) => ({ x: Array.from(forces, (_, i) => ms(i * h)), y: forces, pen, name });
    chart(charts[0], "Contact force (N)", [steps(run, "#767676", "run"), steps(now, pen(0), "here")]);
    chart(charts[1], "Energy (J)", ["impactor", "motion of the plate", "strain of the plate", "stored in the contact", "lost"].map(
      (name, i) => ({ x: now.times.map(ms), y: now.energies[i], pen: pen(i), name })));
    $("what-if-tiles").replaceChildren();
    tile("impact energy", 0.5 * own.mass * own.velocity ** 2, "J");
    tile("peak force", now.peak, "N");
    tile("peak deflection", now.deepest * 1e3, "mm");
    body.replaceChildren();
    now.damage.forEach((of, i) => {
      const row = add(body, "tr"), cell = (text, number) => add(row, "td", number ? { class: "number" } : {}, text);
      const { time, place } = of, at = time === null ? 0 : time / now.h, low = Math.min(Math.floor(at), now.done - 1);
      cell(of.criterion);
      cell(of.mode);
      cell(time === null ? "\u2013" : digits(ms(time)), true);
      cell(place ? `${place.interface ? "interface" : "ply"} ${place.place}` : "");
      cell(place ? place.at_mm.map(digits).join(", ") : "", true);
      cell(time === null ? "" : digits(now.forces[low] + (at - low) * (now.forces[low + 1] - now.forces[low])), true);
      cell(digits(of.index), true);
      cell(run.damage[i].time === null ? "\u2013" : digits(ms(run.damage[i].time)), true);
    });
    $("what-if-limits").replaceChildren();
    for (const [doubt, text] of limits(now, own)) add($("what-if-limits"), "li", doubt ? { class: "doubt" } : {}, text);
    // For who wants the numbers.
    section.found = { ...now, q: undefined, products: operator.length * now.times.length, milliseconds: performance.now() - begun };
  }
  answer();
}
