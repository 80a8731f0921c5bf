// Diagrams as elements of SVG: numbers as text, axes, curves.

export const SVG = "http://www.w3.org/2000/svg";

// A number in so many digits; `all` keeps zeros at the end.
export function shown(x, digits = 4, all = false) {
  if (x === Infinity) return "∞";
  if (x === undefined || Number.isNaN(x)) return "–";
  const text = Math.abs(x) >= 1e5 || (x && Math.abs(x) < 1e-4) ? x.toExponential(digits - 1) : x.toPrecision(digits);
  return (all || text.includes("e") ? text : String(Number(text))).replace("-", "−");
}

export const set = (made, attributes) => { for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value); };

export function element(name, attributes, parent, text) {
  const made = document.createElementNS(SVG, name);
  set(made, attributes);
  if (text !== undefined) made.textContent = text;
  if (parent) parent.append(made);
  return made;
}

// Round numbers for an axis.
function ticks(low, high, count = 5) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough)), step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * (1 - 1e-9));
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) => (first + i) * step);
}

// An empty diagram in an <svg>: axes, functions from values to places, and what draws inside: `path` gives the line through
// values, `draw` draws one, also in SVG's words, `add` any element.
export function diagram(svg, box) {
  const { width, height } = svg.viewBox.baseVal, { x = "", y } = svg.dataset;
  svg.replaceChildren();
  const left = 52, right = width - 10, top = 10, bottom = height - (x ? 36 : 20);
  const px = (value) => left + (value - box.left) / (box.right - box.left) * (right - left);
  const py = (value) => bottom - (value - box.bottom) / (box.top - box.bottom) * (bottom - top);
  const grid = element("g", { class: "grid" }, svg);
  const tick = (d, at, value) => { element("path", { d }, grid); element("text", at, svg, shown(value)); };
  for (const value of ticks(box.left, box.right)) tick(`M${px(value)} ${top}V${bottom}`, { x: px(value), y: bottom + 15, "text-anchor": "middle" }, value);
  for (const value of ticks(box.bottom, box.top, 4)) tick(`M${left} ${py(value)}H${right}`, { x: left - 6, y: py(value) + 4, "text-anchor": "end" }, value);
  element("text", { x: (left + right) / 2, y: height - 5, "text-anchor": "middle", class: "axis" }, svg, x);
  element("text", { x: 12, y: (top + bottom) / 2, "text-anchor": "middle", class: "axis", transform: `rotate(-90 12 ${(top + bottom) / 2})` }, svg, y);
  const clip = `${svg.id}-clip`, inside = element("g", { "clip-path": `url(#${clip})` }, svg);
  const frame = { x: left, y: top, width: right - left, height: bottom - top };
  element("rect", frame, element("clipPath", { id: clip }, svg));
  element("rect", { ...frame, class: "frame" }, svg);
  const add = (kind, attributes, text) => element(kind, attributes, inside, text);
  const path = (points) => points.map(([across, up], i) => `${i && Number.isFinite(up) ? "L" : "M"}${px(across).toFixed(1)} ${py(up).toFixed(1)}`).join("");
  const draw = (kind, line) => add("path", { class: kind, d: typeof line === "string" ? line : path(line) });
  return { px, py, box, left, right, top, bottom, add, path, draw };
}
