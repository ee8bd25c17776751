document.documentElement.classList.add("scripted");
const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);

/** A new element with attributes, inside `parent` where there is one. */
function add(parent, name, attributes = {}, text) {
  const svg = name === "svg" || (parent && parent.namespaceURI === "http://www.w3.org/2000/svg");
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

/** A number with four digits. */
function digits(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e-3 && size < 1e6 ? String(Number(value.toPrecision(4))) : value.toExponential(3);
  return text.replace("-", "\u2212");
}

/** Round values from `low` to `high`, about `count` of them, with their labels. */
function ticks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.999);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
    found.push([k * step, (k * step).toFixed(Math.min(decimals, 12)).replace(/^-(?=0\.?0*$)/, "").replace("-", "\u2212")]);
  }
  return found;
}
