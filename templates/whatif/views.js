// The page's pictures and its table: the gain plane, the responses, the Nyquist curve, the metrics.
"use strict";

const Views = (() => {
const { shown, element, diagram, path } = Charts;
const LEVELS = [1.2, 1.4, 1.6, 2.0];
const PINS = ["a", "b", "c"];
const $ = (id) => document.getElementById(id);
const say = (id, text) => { if ($(id).textContent !== text) $(id).textContent = text; };

// Writes names beside points where they cover no other; one without room is left to the tooltip.
function labels(view) {
  const taken = [], letter = innerWidth > 736 ? 7 : 9.3;
  return (x, y, text, name) => {
    const wide = letter * text.length;
    const places = [[6, -5], [6, 13], [-6 - wide, -5], [-6 - wide, 13]].map(([dx, dy]) => [x + dx, y + dy]);
    const free = places.find(([left, base]) => left > view.left && left + wide < view.right && base < view.bottom && base > view.top + 8
      && taken.every(([l, b, w]) => left > l + w || left + wide < l || Math.abs(base - b) > 11));
    if (!free) return;
    taken.push([...free, wide]);
    element("text", { class: name, x: free[0], y: free[1] }, view.inside, text);
  };
}

function drawPlane(state, markers) {
  const { plant, controller, plane } = state, svg = $("plane"), box = Plane.extent(plant, controller, plane);
  state.view = null;
  if (!box) {
    svg.replaceChildren();
    say("plane-note", `No ${plane === "ki" ? "PI" : "PD"} part stabilises this plant with the other gain as it is.`);
    return;
  }
  const map = Plane.map(plant, controller, plane, box);
  const view = diagram(svg, box, { width: 460, height: 380, x: "proportional gain k (curves: Ms)", y: plane === "ki" ? "integral gain ki" : "derivative gain kd" });
  const label = labels(view);
  element("path", { class: "stable", d: Plane.region(map, plant, controller, plane).map((polygon) => path(polygon, view) + "Z").join("") }, view.inside);
  for (const level of LEVELS) {
    const segments = Plane.contour(map, Math.log(level));
    if (!segments.length) continue;
    element("path", { class: "level", d: segments.map((segment) => path(segment, view)).join("") }, view.inside);
    const foot = segments.flat().filter(([, y]) => y < box.bottom + 0.04 * (box.top - box.bottom));
    const [x, y] = (foot.length ? foot : segments.flat()).reduce((best, point) => (point[0] > best[0] ? point : best));
    label(view.px(x) - 3, view.py(y) + 2, String(level), "level-name");
  }
  element("path", { class: "border", d: path(Plane.border(plant, controller, plane), view) }, view.inside);
  for (const { name, k, ki, kd, row } of markers) {
    const x = view.px(k), y = view.py(plane === "ki" ? ki : kd);
    if (x < view.left || x > view.right || y < view.top || y > view.bottom) continue;
    const mark = element("path", { class: row ? "rule printed" : "rule", d: row ? `M${x} ${y - 4}l4 4l-4 4l-4 -4z` : `M${x - 4} ${y}h8M${x} ${y - 4}v8` }, view.inside);
    element("title", {}, mark, name);
    label(x, y, name, "rule-name");
  }
  state.pins.forEach((pin, i) => element("circle", { class: `pin pin-${PINS[i]}`, r: 5, cx: view.px(pin.controller.k), cy: view.py(pin.controller[plane]) }, view.inside));
  state.point = element("circle", { class: "point", r: 8 }, view.inside);
  state.view = view;
  movePoint(state);
}

// The point; one that lies outside stays at the edge.
function movePoint({ view, point, controller, plane }) {
  if (!view) return;
  const x = view.px(controller.k), y = view.py(controller[plane]);
  const cx = Math.min(Math.max(x, view.left), view.right), cy = Math.min(Math.max(y, view.top), view.bottom);
  point.setAttribute("cx", cx);
  point.setAttribute("cy", cy);
  say("plane-note", Math.hypot(cx - x, cy - y) > 1 ? "The point lies outside the picture." : "");
}

const sampled = (response, values, end) => {
  const points = [];
  for (let i = 0; i <= 400; i++) points.push([end * i / 400, response.at(values, Math.min(end * i / 400, response.end * (1 - 1e-12)))]);
  return points;
};

// `options` are {mismatch, limit, antiWindup}, each off where it is zero.
function drawResponses({ plant, controller, pins, last: now }, options) {
  const runs = [...pins.map((pin, i) => [PINS[i], pin.measured]), ["now", now]].filter(([, run]) => run.stable);
  for (const id of ["output", "control", "load"]) $(id).classList.toggle("faded", !now.stable);
  if (!runs.length) return;
  const quiet = (run) => Math.max(Number.isNaN(run.settling) ? run.step.end : run.settling * 1.6, run.loadQuiet * 1.2, 6 * plant.deadTime, 1e-9);
  const end = Math.min(Math.max(...runs.map(([, run]) => quiet(run))), Math.max(...runs.map(([, run]) => run.step.end)));
  const others = options.mismatch && now.stable ? Measures.mismatched(plant, options.mismatch) : [];
  const cloud = others.filter((other) => Kernel.isStable(other, controller)).map((other) => {
    const run = Kernel.respond(Kernel.mapsOf(other, controller.kd ? controller.filter : 0), controller, { setpoint: 1, until: end });
    return sampled(run, run.output, end);
  });
  const saturated = options.limit && now.stable ? Measures.limited(plant, controller, options.limit, options.antiWindup, end) : null;
  const values = { output: (run) => [run.step, run.step.output], control: (run) => [run.step, run.step.control], load: (run) => [run.load, run.load.output] };
  for (const [id, name] of [["output", "output y, set-point step"], ["control", "control u"], ["load", "y, load step"]]) {
    const curves = runs.map(([who, run]) => [who, sampled(...values[id](run), end)]), output = id === "output";
    const all = [...curves.map(([, points]) => points), saturated && id !== "load" ? saturated[id].map(([t, y]) => [t, output ? Math.max(-1, Math.min(3, y)) : y]) : []].flatMap((points) => points.map(([, y]) => y)).filter(Number.isFinite);
    const high = Math.max(output ? 1.05 : 0, ...all, output ? Math.min(3, Math.max(0, ...cloud.flat().map(([, y]) => y))) : 0), low = Math.min(0, ...all);
    const margin = 0.06 * (high - low || 1);
    const view = diagram($(id), { left: 0, right: end, bottom: low - margin, top: high + margin }, { width: 460, height: output ? 250 : 150, x: id === "load" ? "time" : "", y: name });
    if (output && now.stable) annotate(view, now, end);
    if (output) for (const points of cloud) element("path", { class: "cloud", d: path(points, view) }, view.inside);
    for (const [who, points] of curves) element("path", { class: `curve ${who}`, d: path(points, view) }, view.inside);
    if (saturated && id !== "load") element("path", { class: "curve saturated", d: path(saturated[id], view) }, view.inside);
  }
  const lost = others.length - cloud.length;
  say("mismatch-note", (lost ? `${lost} of ${others.length} plants of the cloud make the loop unstable. ` : "") + (options.limit && now.stable && !saturated ? "This plant is too fast for the small steps of the limited response." : ""));
}

// Band, overshoot, rise and settling time where they are read.
function annotate({ px, py, inside, right, top }, run, end) {
  const { final } = run, band = 0.02 * Math.abs(final), dashes = (d) => element("path", { class: "reading", d }, inside);
  const name = (x, y, text) => element("text", { class: "reading-name", x: Math.min(x, right - 6.5 * text.length), y }, inside, text);
  element("rect", { class: "band", x: px(0), width: px(end) - px(0), y: py(final + band), height: py(final - band) - py(final + band) }, inside);
  if (run.overshoot > 0.001) {
    const y = py(final * (1 + run.overshoot));
    dashes(`M${px(run.peakTime)} ${py(final)}V${y}`);
    name(px(run.peakTime) + 5, Math.max(y - 5, top + 12), `overshoot ${shown(100 * run.overshoot, 3)} %`);
  }
  if (run.settling <= end) {
    dashes(`M${px(run.settling)} ${py(0)}V${py(final)}`);
    name(px(run.settling) + 4, py(0) - 6, `settles ${shown(run.settling, 3)}`);
  }
  const ten = Kernel.reaches(run.step, 0.1 * final), ninety = Kernel.reaches(run.step, 0.9 * final);
  if (ninety > end || !(run.rise > 0)) return;
  dashes(`M${px(ten)} ${py(0.1 * final)}V${py(0.05 * final)}H${px(ninety)}V${py(0.9 * final)}`);
  name(px(ninety) + 4, py(0.5 * final), `rises in ${shown(run.rise, 3)}`);
}

function drawNyquist({ plant, controller, pins, last }) {
  const view = diagram($("nyquist"), { left: -2.2, right: 1.2, bottom: -1.9, top: 1.12 }, { width: 460, height: 400, x: "Re L", y: "Im L" });
  const circle = (x, r, name) => element("ellipse", { class: name, cx: view.px(x), cy: view.py(0), rx: view.px(r) - view.px(0), ry: view.py(0) - view.py(r) }, view.inside);
  circle(0, 1, "unit");
  if (last.stable) circle(-1, 1 / last.ms, "ms");
  const clipped = (x) => Math.max(-50, Math.min(50, x));
  for (const [name, shaped] of [...pins.map((pin, i) => [PINS[i], pin.controller]), ["now", controller]]) {
    const points = Array.from(Kernel.grid(plant, shaped, 0.02), (w) => Kernel.loopAt(plant, shaped, w).map(clipped));
    element("path", { class: `curve ${name}`, d: path(points, view) }, view.inside);
  }
  element("path", { class: "critical", d: `M${view.px(-1) - 5} ${view.py(0)}h10M${view.px(-1)} ${view.py(0) - 5}v10` }, view.inside);
  if (!last.stable) return;
  const label = labels(view);
  for (const [at, name] of [[last.gainAt, "GM"], [last.phaseAt, "PM"], [last.msAt, "Ms"]]) {
    if (!(at > 0)) continue;
    const [x, y] = Kernel.loopAt(plant, controller, at);
    element("circle", { class: "mark", r: 3.5, cx: view.px(x), cy: view.py(y) }, view.inside);
    label(view.px(x), view.py(y), name, "reading-name");
  }
}

const digits = (x) => (Number.isNaN(x) ? "not settled" : shown(Math.abs(x) < 1e-9 ? 0 : x, 4, true));
const METRICS = [
  ["overshoot", (run) => `${digits(100 * run.overshoot)} %`], ["settling time (2 %)", (run) => digits(run.settling)],
  ["rise time (10–90 %)", (run) => digits(run.rise)], ["IAE, set point", (run) => digits(run.iae)], ["IAE, load", (run) => digits(run.loadIae)],
  ["total variation of u", (run) => digits(run.variation)], ["Ms", (run) => digits(run.ms)], ["gain margin", (run) => digits(run.gain)],
  ["phase margin", (run) => `${digits(run.phase)}°`], ["delay margin", (run) => digits(run.delay)],
];

function cell(name, text, attributes = {}) {
  const made = document.createElement(name);
  made.textContent = text;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

function row(...cells) {
  const made = document.createElement("tr");
  made.append(...cells);
  return made;
}

function drawTable({ controller, last, pins }) {
  const columns = [["now", controller, last], ...pins.map((pin, i) => [PINS[i], pin.controller, pin.measured])];
  $("metrics-head").replaceChildren(row(cell("th", "metric", { scope: "col" }), ...columns.map(([name, gains]) => {
    const made = cell("th", name === "now" ? "now" : `pinned ${name}`, { scope: "col", class: name });
    made.append(document.createElement("br"), cell("small", Notation.controllerText(gains, 4)));
    return made;
  })));
  $("metrics-body").replaceChildren(...METRICS.map(([name, text]) => row(cell("th", name, { scope: "row" }), ...columns.map(([, , run]) => cell("td", run.stable ? text(run) : "unstable")))));
}

return { PINS, $, say, drawPlane, movePoint, drawResponses, drawNyquist, drawTable };
})();
