// The page: what is chosen, and how one changes it.

import { DATA } from "./data.js";
import { prepare } from "./loop.js";
import { unstablePoles } from "./poles.js";
import { responder } from "./response.js";
import { measure } from "./metrics.js";
import { limited } from "./limited.js";
import { border, contour, extent, gainMap } from "./region.js";
import { rules } from "./rules.js";
import { controllerText, NotationError, parseController, parsePlant } from "./notation.js";
import { shown } from "./charts.js";
import { $, drawNyquist, drawPlane, drawResponses, drawTable, movePoint, PINS, say, summary } from "./views.js";
import { copy, curves, download, picture, python } from "./takeaway.js";

const GAINS = ["k", "ki", "kd", "b", "filter"];
const MOST_GAIN = 1e9;

// `base` is the controller whose gains the slider multiplies, `row` the printed row that was chosen last.
const state = { plantText: "", plant: null, controller: null, base: null, row: -1, plane: "ki", pins: [], view: null, last: null };
const options = { mismatch: 0, limit: 0, antiWindup: true };

// What changes: at most once a frame
let frame = 0, spoken = 0;

function refresh(plane = false) {
  state.planeDue ||= plane;
  frame ||= requestAnimationFrame(() => {
    frame = 0;
    state.last = measure(state.plant, state.controller);
    if (state.planeDue) { state.planeDue = false; drawPlane(state, markers()); } else movePoint(state);
    drawResponses(state, options); drawNyquist(state); drawTable(state); fields(); address();
    say("verdict", state.last.stable ? "" : `Unstable: ${state.last.unstable === Infinity ? "the loop gain does not fall below one" : `${state.last.unstable} closed-loop poles in the right half plane`}. The last stable responses stay.`);
    clearTimeout(spoken);
    spoken = setTimeout(() => say("spoken", summary(state)), 600);
  });
}

// Tuning rules for the plant, and the rows of the chosen row's table.
function markers() {
  const of = (row) => row.label.replace(/: .*/s, ""), chosen = DATA.rows[state.row];
  const rows = chosen ? DATA.rows.filter((row) => row.plant === state.plantText && of(row) === of(chosen)) : [];
  rows.sort((one, other) => (other === chosen) - (one === chosen));
  return [...rows.map((row) => ({ ...parseController(row.controller), name: row.label.replace(/^.*?: /s, ""), row: true })), ...rules(state.plant), ...(DATA.optimal[state.plantText] || [])];
}

function fields() {
  const show = (id, text) => { if (document.activeElement !== $(id) && !$(id).hasAttribute("aria-invalid")) $(id).value = text; };
  for (const name of GAINS) show(name, String(Number(state.controller[name].toPrecision(6))));
  show("plant", state.plantText);
  show("controller", controllerText(state.controller, 6));
  $("rows").value = String(state.row);
  const factor = state.base.k ? state.controller.k / state.base.k : state.controller.ki / state.base.ki;
  $("sharpen").value = factor;
  say("factor", Number.isFinite(factor) ? factor.toFixed(3) : "1");
}

let waiting = 0;
function address() { clearTimeout(waiting); waiting = setTimeout(writeAddress, 250); }
function writeAddress() {
  const given = { plant: state.plantText, controller: controllerText(state.controller) };
  if (state.plane !== "ki") given.plane = state.plane;
  if (state.pins.length) given.pins = state.pins.map((pin) => controllerText(pin.controller)).join(";");
  if (options.mismatch) given.mismatch = $("mismatch-size").value;
  if (options.limit) Object.assign(given, { limit: options.limit, windup: options.antiWindup ? "no" : "yes" });
  const hash = Object.entries(given).map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join("&");
  try { history.replaceState(null, "", `#${hash}`); } catch { /* a page in a frame may not */ }
}

// Take what a field says; what makes no sense leaves everything as it was, and the field says why.
const tell = (id, text) => say($(id).getAttribute("aria-describedby"), text);
function clear(id) {
  if ($(id).hasAttribute("aria-invalid")) tell(id, "");
  $(id).removeAttribute("aria-invalid");
}
function take(id, change) {
  try {
    change();
    clear(id);
    return true;
  } catch (error) {
    if (!(error instanceof NotationError)) throw error;
    $(id).setAttribute("aria-invalid", "true");
    tell(id, error.message);
    return false;
  }
}

const refuse = (reason) => { throw new NotationError(reason); };

function checked(controller, plant = state.plant) {
  for (const name of [...GAINS, "c", "prefilter"]) if (!(Math.abs(controller[name]) <= MOST_GAIN)) refuse(`${name} is beyond any limit: at most ${MOST_GAIN.toExponential(0)}`);
  if (controller.filter < 0) refuse("the derivative filter must not be negative");
  const jumps = controller.kd && !controller.filter && ((plant.deadTime && plant.relativeDegree < 2) || (controller.c && !controller.prefilter));
  if (jumps) controller = { ...controller, filter: Math.abs(controller.kd / (controller.k || 1)) / 10 };
  if (Number.isNaN(unstablePoles(plant, controller))) refuse("so high a gain is not drawn here");
  say("note", jumps ? "The derivative part would jump without limit: a filter of kd/(10 k) is added." : "");
  return controller;
}

const pinned = (controller, plant = state.plant) => ({ controller, measured: measure(plant, controller) });

function usePlant(text, controller = state.controller) {
  const plant = prepare(parsePlant(text)), made = checked(controller, plant), pins = state.pins.map((pin) => pinned(checked(pin.controller, plant), plant));
  Object.assign(state, { plant, plantText: text.trim(), pins, controller: made, base: made });
  const here = DATA.rows.map((row) => row.plant === state.plantText);
  if (!here[state.row]) state.row = here.indexOf(true);
  ["plant", "controller", ...GAINS].forEach(clear);
  refresh(true);
}

// `plane`: whether the gain plane changes with it.
function useController(controller, plane = false, base = null) {
  state.controller = checked(controller);
  state.base = base || state.controller;
  ["controller", ...GAINS].forEach(clear);
  refresh(plane);
}

function useRow(i) {
  const { plant, controller } = DATA.rows[i];
  state.row = i;
  take("plant", () => usePlant(plant, parseController(controller)));
}

function fromAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  if (!state.plant) useRow(0);
  take("controller", () => {
    const controller = given.get("controller") ? parseController(given.get("controller")) : state.controller;
    if (!take("plant", () => usePlant(given.get("plant") || state.plantText, controller))) useController(controller, true);
    const row = DATA.rows.findIndex((one) => one.plant === state.plantText && controllerText(parseController(one.controller)) === controllerText(controller));
    if (row >= 0) state.row = row;
    state.pins = (given.get("pins") || "").split(";").filter(Boolean).slice(0, PINS.length).map((text) => pinned(checked(parseController(text))));
  });
  state.plane = given.get("plane") === "kd" ? "kd" : "ki";
  document.querySelector(`[name=plane][value=${state.plane}]`).checked = true;
  for (const [name, box, size] of [["mismatch", "mismatch", "mismatch-size"], ["limit", "saturation", "limit"]]) {
    $(box).checked = given.has(name);
    if (given.has(name)) $(size).value = given.get(name);
  }
  $("anti-windup").checked = given.get("windup") !== "yes";
  readOptions();
}

// The controls
$("rows").addEventListener("change", () => { if ($("rows").value !== "-1") useRow(Number($("rows").value)); });
$("plant").addEventListener("change", () => take("plant", () => usePlant($("plant").value)));
$("controller").addEventListener("change", () => take("controller", () => useController(parseController($("controller").value), true)));

function number(id, allowed, fits = () => true) {
  const text = $(id).value.trim().replace("−", "-"), name = $(id).dataset.name || id;
  if (text === "" || !Number.isFinite(Number(text))) refuse(`${name}: '${text}' is not a number${text.includes(",") ? "; write a point" : ""}`);
  if (!fits(Number(text))) refuse(`${name}: ${text} is not possible; allowed: ${allowed}`);
  return Number(text);
}
for (const name of GAINS) {
  $(name).addEventListener("input", () => take(name, () => useController({ ...state.controller, [name]: number(name) }, name !== "k" && name !== state.plane)));
}
$("sharpen").addEventListener("input", () => {
  const { base } = state, factor = Number($("sharpen").value);
  take("controller", () => useController({ ...base, k: factor * base.k, ki: factor * base.ki, kd: factor * base.kd }, Boolean(state.plane === "ki" ? base.kd : base.ki), base));
});
for (const choice of document.getElementsByName("plane")) {
  choice.addEventListener("change", () => { state.plane = choice.value; refresh(true); });
}

function readOptions() {
  take("mismatch-size", () => { options.mismatch = $("mismatch").checked ? number("mismatch-size", "1 to 50 %", (x) => x >= 1 && x <= 50) / 100 : 0; });
  take("limit", () => { options.limit = $("saturation").checked ? number("limit", "above 0", (x) => x > 0) : 0; });
  options.antiWindup = $("anti-windup").checked;
  refresh();
}
for (const id of ["mismatch", "mismatch-size", "saturation", "limit", "anti-windup"]) $(id).addEventListener("input", readOptions);

// The point moves to gains, but not over the axis to where no integral or derivative part belongs.
const plane = $("plane");
function moveTo(k, other) {
  const { box } = state.view, kept = box.bottom < 0 ? Math.min(other, box.top && other) : Math.max(0, other);
  take("controller", () => useController({ ...state.controller, k, [state.plane]: kept }));
}
function drag({ clientX, clientY }) {
  const { view } = state;
  if (!view) return;
  const rect = plane.getBoundingClientRect(), scale = plane.viewBox.baseVal.width / rect.width, { box } = view;
  const across = ((clientX - rect.left) * scale - view.left) / (view.right - view.left), up = (view.bottom - (clientY - rect.top) * scale) / (view.bottom - view.top);
  moveTo(box.left + across * (box.right - box.left), box.bottom + up * (box.top - box.bottom));
}
plane.addEventListener("pointerdown", (event) => { plane.setPointerCapture(event.pointerId); drag(event); event.preventDefault(); plane.focus(); });
plane.addEventListener("pointermove", (event) => { if (plane.hasPointerCapture(event.pointerId)) drag(event); });
plane.addEventListener("keydown", (event) => {
  const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
  if (!direction || !state.view) return;
  event.preventDefault();
  const { box } = state.view, step = event.shiftKey ? 0.05 : event.altKey ? 0.0005 : 0.005;
  moveTo(state.controller.k + direction[0] * step * (box.right - box.left), state.controller[state.plane] + direction[1] * step * (box.top - box.bottom));
});

$("pin").addEventListener("click", () => {
  if (state.pins.length === PINS.length) state.pins.shift();
  state.pins.push({ controller: state.controller, measured: state.last });
  refresh(true);
});
$("unpin").addEventListener("click", () => { state.pins = []; refresh(true); });

$("copy-python").addEventListener("click", () => copy(python(state), "Python lines copied."));
$("copy-link").addEventListener("click", () => { writeAddress(); copy(location.href, "Link copied."); });
$("csv").addEventListener("click", () => (state.last.stable ? download("whatif.csv", "text/csv", curves(state)) : say("done", "There is no response of an unstable loop.")));
$("svg").addEventListener("click", () => download("whatif.svg", "image/svg+xml", picture()));

// A loop that Python has computed, computed here.
function selfTest() {
  const { plant: text, controller, times, output, metrics } = DATA.reference, plant = prepare(parsePlant(text)), given = parseController(controller);
  const response = responder(plant, given)({ until: times.at(-1) }), run = measure(plant, given);
  const errors = Object.entries(metrics).map(([name, value]) => Math.abs(run[name] - value) / Math.max(1, Math.abs(value)));
  return Math.max(...errors, ...times.map((t, i) => Math.abs(response.at(response.output, t) - output[i])));
}
const apart = selfTest();
say("agreement", apart < 1e-7 ? `This page agrees with the report to ${shown(apart, 1).replace("−", "-")}.` : `Warning: this browser's numbers differ by ${shown(apart, 2)} from the report's; do not trust them.`);

window.addEventListener("hashchange", fromAddress);
fromAddress();
window.whatif = { state, measure, responder, prepare, unstablePoles, parsePlant, parseController, rules, limited, border, contour, extent, gainMap, python, curves, picture };
