// The page's pictures and its table: the gain plane, the responses, the Nyquist curve, the metrics.

import { CONSTANTS } from "./data.js";
import { loopAt } from "./loop.js";
import { isStable } from "./poles.js";
import { responder } from "./response.js";
import { grid } from "./margins.js";
import { limited, mismatched } from "./limited.js";
import { border, contour, extent, gainMap, region } from "./region.js";
import { controllerText } from "./notation.js";
import { diagram, element, path, shown } from "./charts.js";

export const PINS = ["a", "b", "c"];
export const $ = (id) => document.getElementById(id);
export const say = (id, text) => { if ($(id).textContent !== text) $(id).textContent = text; };

// The loop at hand and the pinned ones, as {name, controller, measured}.
export const everyone = ({ pins, controller, last }) => [{ name: "now", controller, measured: last }, ...pins.map((pin, i) => ({ ...pin, name: PINS[i] }))];

// Writes names beside points where they cover no other; one without room is left to the tooltip.
function labels(view) {
  const taken = [], letter = innerWidth > 736 ? 7 : 9.3;
  return (x, y, text, name) => {
    const wide = letter * text.length;
    const free = [[x + 6, y - 5], [x + 6, y + 13], [x - 6 - wide, y - 5], [x - 6 - wide, y + 13]].find(([left, base]) => left > view.left && left + wide < view.right
      && base < view.bottom && base > view.top + 8 && taken.every(([l, b, w]) => left > l + w || left + wide < l || Math.abs(base - b) > 11));
    if (!free) return;
    taken.push([...free, wide]);
    element("text", { class: name, x: free[0], y: free[1] }, view.inside, text);
  };
}

export function drawPlane(state, markers) {
  const { plant, controller, plane } = state, svg = $("plane"), box = extent(plant, controller, plane);
  state.view = null;
  if (!box) {
    svg.replaceChildren();
    say("plane-note", `No ${plane === "ki" ? "PI" : "PD"} part stabilises this plant with the other gain as it is.`);
    return;
  }
  const map = gainMap(plant, controller, plane, box);
  const view = diagram(svg, box, { height: 380, x: "proportional gain k (curves: Ms)", y: plane === "ki" ? "integral gain ki" : "derivative gain kd" });
  const label = labels(view);
  element("path", { class: "stable", d: region(map, plant, controller, plane).map((polygon) => path(polygon, view) + "Z").join("") }, view.inside);
  for (const level of CONSTANTS.levels) {
    const segments = contour(map, Math.log(level));
    if (!segments.length) continue;
    element("path", { class: "level", d: segments.map((segment) => path(segment, view)).join("") }, view.inside);
    const foot = segments.flat().filter(([, y]) => Math.abs(y) < 0.04 * (box.top - box.bottom));
    const [x, y] = (foot.length ? foot : segments.flat()).reduce((best, point) => (point[0] > best[0] ? point : best));
    label(view.px(x) - 3, view.py(y) + 2, String(level), "level-name");
  }
  element("path", { class: "border", d: path(border(plant, controller, plane), view) }, view.inside);
  for (const { name, row, ...gains } of markers) {
    const x = view.px(gains.k), y = view.py(gains[plane]);
    if (x < view.left || x > view.right || y < view.top || y > view.bottom) continue;
    const mark = element("path", { class: row ? "rule printed" : "rule", d: row ? `M${x} ${y - 4}l4 4l-4 4l-4 -4z` : `M${x - 4} ${y}h8M${x} ${y - 4}v8` }, view.inside);
    element("title", {}, mark, name);
    label(x, y, name, "rule-name");
  }
  for (const { name, controller: gains } of everyone(state).slice(1)) element("circle", { class: `pin pin-${name}`, r: 5, cx: view.px(gains.k), cy: view.py(gains[plane]) }, view.inside);
  state.point = element("circle", { class: "point", r: 8 }, view.inside);
  state.view = view;
  movePoint(state);
}

// The point; one that lies outside stays at the edge.
export function movePoint({ view, point, controller, plane }) {
  if (!view) return;
  const x = view.px(controller.k), y = view.py(controller[plane]);
  const cx = Math.min(Math.max(x, view.left), view.right), cy = Math.min(Math.max(y, view.top), view.bottom);
  point.setAttribute("cx", cx);
  point.setAttribute("cy", cy);
  say("plane-note", Math.hypot(cx - x, cy - y) > 1 ? "The point lies outside the picture." : "");
}

const sampled = (signals, values, end) => Array.from({ length: 401 }, (_, i) => [end * i / 400, signals.at(values, Math.min(end * i / 400, signals.end))]);

// `options` are {mismatch, limit, antiWindup}, each off where it is zero.
export function drawResponses(state, options) {
  const { plant, controller, last: now } = state, runs = everyone(state).toReversed().filter(({ measured }) => measured.stable);
  for (const id of ["output", "control", "load"]) $(id).classList.toggle("faded", !now.stable);
  if (!runs.length) return;
  const quiet = (run) => Math.max(Number.isNaN(run.settling) ? run.step.end : run.settling * 1.6, run.loadQuiet * 1.2, 6 * plant.deadTime, 1e-9);
  const end = Math.min(Math.max(...runs.map(({ measured }) => quiet(measured))), Math.max(...runs.map(({ measured }) => measured.step.end)));
  const others = options.mismatch && now.stable ? mismatched(plant, options.mismatch) : [], settled = others.filter((other) => isStable(other, controller));
  const cloud = settled.map((other) => { const run = responder(other, controller)({ until: end }); return sampled(run, run.output, end); });
  const saturated = options.limit && now.stable ? limited(plant, controller, options.limit, options.antiWindup, end) : null;
  const inside = ([t, y]) => [t, Math.max(-1, Math.min(3, y))]; // what is off must not make the rest small
  for (const [id, name, from, signal] of [["output", "output y, set-point step", "step", "output"], ["control", "control u", "step", "control"], ["load", "y, load step", "load", "output"]]) {
    const curves = runs.map(({ name: who, measured: run }) => [who, sampled(run[from], run[from][signal], end)]), first = id === "output";
    const off = [...(first ? cloud : []), saturated && from === "step" ? saturated[signal] : []].map((points) => (first ? points.map(inside) : points));
    const all = [...curves.map(([, points]) => points), ...off].flat().map(([, y]) => y).filter(Number.isFinite);
    const high = Math.max(first ? 1.05 : 0, ...all), low = Math.min(0, ...all), margin = 0.06 * (high - low || 1);
    const view = diagram($(id), { left: 0, right: end, bottom: low - margin, top: high + margin }, { height: first ? 250 : 150, x: id === "load" ? "time" : "", y: name });
    const draw = (points, kind) => element("path", { class: kind, d: path(points, view) }, view.inside);
    if (first && now.stable) annotate(view, now, end);
    if (first) for (const points of cloud) draw(points, "cloud");
    for (const [who, points] of curves) draw(points, `curve ${who}`);
    if (saturated && from === "step") draw(saturated[signal], "curve saturated");
  }
  const lost = others.length - cloud.length;
  say("mismatch-note", (lost ? `${lost} of ${others.length} plants of the cloud make the loop unstable. ` : "") + (options.limit && now.stable && !saturated ? "The limited response would need too many steps here." : ""));
}

// Band, overshoot, rise and settling time where they are read.
function annotate({ px, py, inside, right, top }, run, end) {
  const { final, ten, ninety } = run, band = CONSTANTS.band * Math.abs(final), dashes = (d) => element("path", { class: "reading", d }, inside);
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
  if (ninety > end || !(run.rise > 0)) return;
  dashes(`M${px(ten)} ${py(0.1 * final)}V${py(0.05 * final)}H${px(ninety)}V${py(0.9 * final)}`);
  name(px(ninety) + 4, py(0.5 * final), `rises in ${shown(run.rise, 3)}`);
}

export function drawNyquist(state) {
  const { plant, controller, last } = state;
  const view = diagram($("nyquist"), { left: -2.2, right: 1.2, bottom: -1.9, top: 1.12 }, { height: 400, x: "Re L", y: "Im L" });
  const circle = (x, r, name) => element("ellipse", { class: name, cx: view.px(x), cy: view.py(0), rx: view.px(r) - view.px(0), ry: view.py(0) - view.py(r) }, view.inside);
  circle(0, 1, "unit");
  if (last.stable) circle(-1, 1 / last.ms, "ms");
  const clipped = (x) => Math.max(-50, Math.min(50, x));
  for (const { name, controller: shaped } of everyone(state).toReversed()) {
    const points = Array.from(grid(plant, shaped, 0.02), (w) => loopAt(plant, shaped, w).map(clipped));
    element("path", { class: `curve ${name}`, d: path(points, view) }, view.inside);
  }
  element("path", { class: "critical", d: `M${view.px(-1) - 5} ${view.py(0)}h10M${view.px(-1)} ${view.py(0) - 5}v10` }, view.inside);
  if (!last.stable) return;
  const label = labels(view);
  for (const [at, name] of [[last.gainAt, "GM"], [last.phaseAt, "PM"], [last.msAt, "Ms"]]) {
    if (!(at > 0)) continue;
    const [re, im] = loopAt(plant, controller, at), x = view.px(re), y = view.py(im);
    element("circle", { class: "mark", r: 3.5, cx: x, cy: y }, view.inside);
    label(x, y, name, "reading-name");
  }
}

const digits = (x) => (Number.isNaN(x) ? "not settled" : shown(Math.abs(x) < 1e-9 ? 0 : x, 4, true));
const METRICS = [
  ["overshoot", (run) => `${digits(100 * run.overshoot)} %`], ["settling time (2 %)", (run) => digits(run.settling)],
  ["rise time (10–90 %)", (run) => digits(run.rise)], ["IAE, set point", (run) => digits(run.iae)], ["IAE, load", (run) => digits(run.loadIae)],
  ["total variation of u", (run) => digits(run.variation)], ["Ms", (run) => digits(run.ms)], ["gain margin", (run) => digits(run.gain)],
  ["phase margin", (run) => `${digits(run.phase)}°`], ["delay margin", (run) => digits(run.delay)],
];

// What a screen reader is told of a change.
export function summary({ controller, last }) {
  const parts = last.stable ? METRICS.filter(([name]) => /^(over|settling|Ms|gain|phase)/.test(name)).map(([name, text]) => `${name} ${text(last)}`) : ["unstable"];
  return `${controllerText(controller, 4)}: ${parts.join(", ")}.`;
}

export function drawTable(state) {
  const columns = everyone(state);
  const heads = columns.map(({ name, controller }) => `<th scope="col" class="${name}">${name === "now" ? "now" : `pinned ${name}`}<br><small>${controllerText(controller, 4)}</small></th>`);
  $("metrics-head").innerHTML = `<tr><th scope="col">metric</th>${heads.join("")}</tr>`;
  $("metrics-body").innerHTML = METRICS.map(([name, text]) => `<tr><th scope="row">${name}</th>${columns.map(({ measured: run }) => `<td>${run.stable ? text(run) : "unstable"}</td>`).join("")}</tr>`).join("");
}
