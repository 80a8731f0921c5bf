// The page's pictures and its table.

import { CONSTANTS } from "./data.js";
import { loopAt } from "./loop.js";
import { isStable } from "./poles.js";
import { responder } from "./response.js";
import { grid } from "./margins.js";
import { limited, mismatched } from "./limited.js";
import { border, contour, extent, gainMap, region } from "./region.js";
import { controllerText } from "./notation.js";
import { diagram, element, shown } from "./charts.js";

const MOST_POINTS = 2000; // of a Nyquist curve; what follows runs around in circles

export const PINS = ["a", "b", "c"];
export const $ = (id) => document.getElementById(id);
export const say = (id, text) => { if ($(id).textContent !== text) $(id).textContent = text; };

// The loop at hand and the pinned ones, as {name, controller, measured}.
export const everyone = ({ pins, controller, last }) => [{ name: "now", controller, measured: last }, ...pins.map((pin, i) => ({ ...pin, name: PINS[i] }))];

// Writes names beside points where they cover no other; one without room has its tooltip.
function labels(view) {
  const taken = [], letter = innerWidth > 736 ? 7 : 9.3;
  return (x, y, text, name) => {
    const wide = letter * text.length;
    const free = [x + 6, x - 6 - wide].flatMap((left) => [[left, y - 5], [left, y + 13]]).find(([left, base]) => left > view.left && left + wide < view.right
      && base < view.bottom && base > view.top + 8 && taken.every(([l, b, w]) => left > l + w || left + wide < l || Math.abs(base - b) > 11));
    if (!free) return;
    taken.push([...free, wide]);
    view.add("text", { class: name, x: free[0], y: free[1] }, text);
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
  svg.dataset.y = plane === "ki" ? "integral gain ki" : "derivative gain kd";
  const view = diagram(svg, box), label = labels(view);
  view.draw("stable", region(map).map((polygon) => `${view.path(polygon)}Z`).join(""));
  for (const level of CONSTANTS.levels) {
    const segments = contour(map, Math.log(level));
    if (!segments.length) continue;
    view.draw("level", segments.map(view.path).join(""));
    const low = ([k, other]) => view.px(k) - 9 * Math.abs(view.py(other) - view.py(0)); // far to the right, near the axis
    const [x, y] = segments.flat().reduce((best, point) => (low(point) > low(best) ? point : best));
    label(view.px(x) - 3, view.py(y) + 2, String(level), "level-name");
  }
  view.draw("border", border(plant, controller, plane));
  for (const { name, row, ...gains } of markers) {
    const x = view.px(gains.k), y = view.py(gains[plane]);
    if (x < view.left || x > view.right || y < view.top || y > view.bottom) continue;
    const mark = row ? view.draw("rule printed", `M${x} ${y - 4}l4 4l-4 4l-4 -4z`) : view.draw("rule", `M${x - 4} ${y}h8M${x} ${y - 4}v8`);
    element("title", {}, mark, name);
    label(x, y, name, "rule-name");
  }
  state.view = { ...view, points: view.add("g", {}) };
  drawPoints(state);
}

// The loops in the gain plane; a point that lies outside stays at the edge.
export function drawPoints(state) {
  const { view, plane } = state;
  if (!view) return;
  view.points.replaceChildren();
  const outside = everyone(state).map(({ name, controller }) => {
    const x = view.px(controller.k), y = view.py(controller[plane]), now = name === "now";
    const cx = Math.min(Math.max(x, view.left), view.right), cy = Math.min(Math.max(y, view.top), view.bottom);
    view.points.prepend(element("circle", { class: now ? "point" : `pin pin-${name}`, r: now ? 8 : 5, cx, cy }));
    return Math.hypot(cx - x, cy - y) > 1;
  });
  say("plane-note", outside[0] ? "The point lies outside the picture." : "");
}

function sampled(signals, values, end) {
  let piece = 0;
  return Array.from({ length: 401 }, (_, i) => {
    const t = end * i / 400;
    while (signals.starts[piece + 1] <= t) piece++;
    return [t, signals.at(values, t, piece)];
  });
}

// `options` are {mismatch in per cent, limit, antiWindup}, off where they are zero; the limited response takes `steps`.
export function drawResponses(state, options, steps) {
  const { plant, controller, last: now } = state, runs = everyone(state).toReversed().filter(({ measured }) => measured.stable);
  const pictures = document.querySelectorAll("[data-signal]");
  for (const svg of pictures) svg.classList.toggle("faded", !now.stable);
  if (!runs.length) return;
  const quiet = (run) => Math.max(Number.isNaN(run.settling) ? run.step.end : run.settling * 1.6, run.loadQuiet * 1.2, 6 * plant.deadTime, 1e-9);
  const end = Math.min(Math.max(...runs.map(({ measured }) => quiet(measured))), Math.max(...runs.map(({ measured }) => measured.step.end)));
  const others = options.mismatch && now.stable ? mismatched(plant, options.mismatch / 100) : [], settled = others.filter((other) => isStable(other, controller));
  const saturated = options.limit && now.stable ? limited(plant, controller, options.limit, options.antiWindup, end, steps) : null;
  const inside = ([t, y]) => [t, Math.max(-1, Math.min(3, y))]; // what is off must not make the rest small
  const cloud = settled.map((other) => { const run = responder(other, controller)({ until: end }); return ["cloud", sampled(run, run.output, end).map(inside)]; });
  for (const svg of pictures) {
    const { from, signal } = svg.dataset, first = svg === pictures[0], lines = first ? [...cloud] : [];
    for (const { name, measured: run } of runs) lines.push([`curve ${name}`, sampled(run[from], run[from][signal], end)]);
    if (saturated && from === "step") lines.push(["curve saturated", first ? saturated.output.map(inside) : saturated.control]);
    const all = lines.flatMap(([, points]) => points.map(([, y]) => y)).filter(Number.isFinite);
    const high = Math.max(first ? 1.05 : 0, ...all), low = Math.min(0, ...all), margin = 0.06 * (high - low || 1);
    const view = diagram(svg, { left: 0, right: end, bottom: low - margin, top: high + margin });
    if (first && now.stable) annotate(view, now, end);
    for (const line of lines) view.draw(...line);
  }
  const lost = others.length - settled.length;
  say("mismatch-note", (lost ? `${lost} of ${others.length} plants of the cloud make the loop unstable. ` : "") + (options.limit && now.stable && !saturated ? "The limited response would need too many steps here." : ""));
}

// Band, overshoot, rise and settling time where they are read.
function annotate({ px, py, right, top, add, draw }, run, end) {
  const { final, ten, ninety } = run, band = CONSTANTS.band * Math.abs(final), dashes = (line) => draw("reading", line);
  const name = (x, y, text) => add("text", { class: "reading-name", x: Math.min(x, right - 6.5 * text.length), y }, text);
  add("rect", { class: "band", x: px(0), width: px(end) - px(0), y: py(final + band), height: py(final - band) - py(final + band) });
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
  const view = diagram($("nyquist"), { left: -2.2, right: 1.2, bottom: -1.9, top: 1.12 }), { px, py } = view;
  const circle = (x, r, name) => view.add("ellipse", { class: name, cx: px(x), cy: py(0), rx: px(r) - px(0), ry: py(0) - py(r) });
  circle(0, 1, "unit");
  if (last.stable) circle(-1, 1 / last.ms, "ms");
  const clipped = (x) => Math.max(-50, Math.min(50, x));
  for (const { name, controller: shaped } of everyone(state).toReversed()) {
    view.draw(`curve ${name}`, Array.from(grid(plant, shaped, 0.02).w.subarray(0, MOST_POINTS), (w) => loopAt(plant, shaped, w).map(clipped)));
  }
  view.draw("critical", `M${px(-1) - 5} ${py(0)}h10M${px(-1)} ${py(0) - 5}v10`);
  if (!last.stable) return;
  const label = labels(view);
  for (const [at, name] of [[last.gainAt, "GM"], [last.phaseAt, "PM"], [last.msAt, "Ms"]]) {
    if (!(at > 0)) continue;
    const [re, im] = loopAt(plant, controller, at);
    view.add("circle", { class: "mark", r: 3.5, cx: px(re), cy: py(im) });
    label(px(re), py(im), name, "reading-name");
  }
}

const spelled = (run, { metric, factor = 1, unit = "" }, missing = "not settled") => (Number.isNaN(run[metric]) ? missing : shown(Math.abs(run[metric]) < 1e-9 ? 0 : factor * run[metric], 4, true) + unit);

// What a screen reader says.
export function summary({ controller, last }) {
  const spoken = ["overshoot", "settling", "ms", "gain", "phase"].map((metric) => document.querySelector(`[data-metric=${metric}]`));
  const parts = last.stable ? spoken.map((row) => `${row.cells[0].textContent} ${spelled(last, row.dataset)}`) : ["unstable"];
  return `${controllerText(controller, 4)}: ${parts.join(", ")}.`;
}

// `missing` stands where a response has not come to rest.
export function drawTable(state, missing) {
  const columns = everyone(state), fill = (row, cells) => { row.innerHTML = row.cells[0].outerHTML + cells.join(""); };
  fill($("metrics-head").rows[0], columns.map(({ name, controller }) => `<th scope="col" class="${name}">${name === "now" ? "" : "pinned "}${name}<br><small>${controllerText(controller, 4)}</small></th>`));
  for (const row of $("metrics-body").rows) fill(row, columns.map(({ measured: run }) => `<td>${run.stable ? spelled(run, row.dataset, missing) : "unstable"}</td>`));
}
