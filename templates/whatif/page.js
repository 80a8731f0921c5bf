// The page: what is chosen, and how it changes.

import { CONSTANTS, DATA } from "./data.js";
import { prepare } from "./loop.js";
import { unstablePoles } from "./poles.js";
import { responder } from "./response.js";
import { measure } from "./metrics.js";
import { limited } from "./limited.js";
import { border, contour, extent, gainMap } from "./region.js";
import { rules } from "./rules.js";
import { controllerText, NotationError, parseController, parsePlant } from "./notation.js";
import { shown } from "./charts.js";
import { $, drawNyquist, drawPlane, drawResponses, drawTable, drawPoints, PINS, say, summary } from "./views.js";
import { copy, curves, download, picture, python } from "./takeaway.js";

const GAINS = ["k", "ki", "kd", "b", "filter"];

// Also `base`, the controller whose gains the slider multiplied by `factor`; `row` is the printed row chosen last.
const state = { row: -1, plane: "ki", pins: [] };
const options = { mismatch: 0, limit: 0, antiWindup: true };
const OPTIONS = [["mismatch", "mismatch", "mismatch-size"], ["limit", "saturation", "limit"]]; // which switch, which number

// What changes is drawn once a frame: while it moves as far as a frame has time for, at rest with the gain plane and all
// digits; then come the address and what a screen reader says.
const REST = 250, SPEECH = 600; // ms after a frame
let frame = 0, rest = 0, speech = 0;

function refresh({ plane = false, moving = false } = {}) {
  Object.assign(state, { planeDue: state.planeDue || plane, moving });
  frame ||= requestAnimationFrame(draw);
  clearTimeout(rest);
  clearTimeout(speech);
}

function draw() {
  const { moving } = state, effort = moving ? CONSTANTS.moving : CONSTANTS.atRest;
  frame = 0;
  state.last = measure(state.plant, state.controller, effort);
  if (state.planeDue && !moving) { state.planeDue = false; drawPlane(state, markers()); } else drawPoints(state);
  $("plane").classList.toggle("faded", state.planeDue);
  drawResponses(state, options, effort.steps); drawNyquist(state); drawTable(state, moving ? "…" : undefined); fields();
  say("verdict", state.last.stable ? "" : `Unstable: ${state.last.unstable === Infinity ? "the loop gain does not fall below one" : `${state.last.unstable} closed-loop poles in the right half plane`}. The last stable responses stay.`);
  rest = setTimeout(() => (moving ? refresh() : writeAddress()), REST);
  speech = setTimeout(() => say("spoken", summary(state)), SPEECH);
}

// Tuning rules, and the rows of the chosen row's table.
function markers() {
  const chosen = DATA.rows[state.row], rows = DATA.rows.filter((row) => row.plant === state.plantText && row.table === chosen?.table);
  rows.sort((one, other) => (other === chosen) - (one === chosen));
  return [...rows.map(({ name, controller }) => ({ ...parseController(controller), name, row: true })), ...rules(state.plant), ...(DATA.optimal[state.plantText] || [])];
}

function fields() {
  const show = (id, text) => { if (document.activeElement !== $(id) && !$(id).ariaInvalid) $(id).value = text; };
  for (const name of GAINS) show(name, String(Number(state.controller[name].toPrecision(6))));
  show("plant", state.plantText);
  show("controller", controllerText(state.controller, 6));
  $("rows").value = String(state.row);
  $("sharpen").value = state.factor;
  say("factor", state.factor.toFixed(3));
}

function writeAddress() {
  const given = { plant: state.plantText, controller: controllerText(state.controller) };
  if (state.plane !== "ki") given.plane = state.plane;
  if (state.pins.length) given.pins = state.pins.map((pin) => controllerText(pin.controller)).join(";");
  for (const [name] of OPTIONS) if (options[name]) given[name] = options[name];
  if (options.limit) given.windup = options.antiWindup ? "no" : "yes";
  try { history.replaceState(null, "", `#${new URLSearchParams(given)}`); } catch { /* a page in a frame may not */ }
}

// Take what a field says; nonsense leaves everything as it was, and the field says why.
function tell(id, reason) {
  if (reason || $(id).ariaInvalid) say($(id).getAttribute("aria-describedby"), reason.replace(/('[^']{40})[^']*/g, "$1…"));
  $(id).ariaInvalid = reason ? "true" : null;
}
const clear = (id) => tell(id, "");
function take(id, change) {
  try {
    change();
    clear(id);
    return true;
  } catch (error) {
    if (!(error instanceof NotationError)) throw error;
    tell(id, error.message);
    return false;
  }
}

const on = (id, type, react) => $(id).addEventListener(type, react);
const refuse = (reason) => { throw new NotationError(reason); };

function checked(controller, plant = state.plant) {
  for (const [name, value] of Object.entries(controller)) if (!(Math.abs(value) <= CONSTANTS.mostGain)) refuse(`${name} is beyond any limit: at most ${CONSTANTS.mostGain}`);
  if (controller.filter < 0) refuse("the derivative filter must not be negative");
  const jumps = controller.kd && !controller.filter && ((plant.deadTime && plant.relativeDegree < 2) || (controller.c && !controller.prefilter));
  if (jumps) controller = { ...controller, filter: Math.abs(controller.kd / (controller.k || 1)) / 10 };
  if (Number.isNaN(unstablePoles(plant, controller))) refuse("so high a gain is not drawn here, nor numbers so far apart");
  say("note", jumps ? "The derivative part would jump without limit: a filter of kd/(10 k) is added." : "");
  return controller;
}

const pinned = (controller, plant = state.plant) => ({ controller, measured: measure(plant, controller) });

// `change` says whether the gain plane changes, too, and whether more is about to follow.
function use(plant, plantText, controller, change = { plane: true }, slid = {}) {
  const made = checked(controller, plant), pins = plant === state.plant ? state.pins : state.pins.map((pin) => pinned(checked(pin.controller, plant), plant));
  Object.assign(state, { plant, plantText, pins, controller: made, base: made, factor: 1, ...slid });
  const here = DATA.rows.map((row) => row.plant === plantText);
  if (!here[state.row]) state.row = here.indexOf(true);
  ["plant", "controller", ...GAINS].forEach(clear);
  refresh(change);
}
const usePlant = (text, controller = state.controller) => use(prepare(parsePlant(text)), text.trim(), controller);
const useController = (controller, change, slid) => use(state.plant, state.plantText, controller, change, slid);

function useRow(row) {
  state.row = row;
  take("plant", () => usePlant(DATA.rows[row].plant, parseController(DATA.rows[row].controller)));
}

function fromAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  if (!state.plant) useRow(0);
  take("controller", () => {
    const controller = given.get("controller") ? parseController(given.get("controller")) : state.controller;
    if (!take("plant", () => usePlant(given.get("plant") || state.plantText, controller))) useController(controller);
    const row = DATA.rows.findIndex((one) => one.plant === state.plantText && controllerText(parseController(one.controller)) === controllerText(controller));
    if (row >= 0) state.row = row;
    state.pins = (given.get("pins") || "").split(";").filter(Boolean).slice(0, PINS.length).map((text) => pinned(checked(parseController(text))));
  });
  state.plane = given.get("plane") === "kd" ? "kd" : "ki";
  document.querySelector(`[name=plane][value=${state.plane}]`).checked = true;
  for (const [name, box, size] of OPTIONS) {
    $(box).checked = given.has(name);
    if (given.has(name)) $(size).value = given.get(name);
  }
  $("anti-windup").checked = given.get("windup") !== "yes";
  readOptions();
}

on("rows", "change", ({ target: { value } }) => { if (value !== "-1") useRow(Number(value)); });
on("plant", "change", () => take("plant", () => usePlant($("plant").value)));
on("controller", "change", () => take("controller", () => useController(parseController($("controller").value))));

function number(id) {
  const { value, min, max, dataset: { name = id } } = $(id), text = value.trim().replace("−", "-"), found = Number(text);
  if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(text)) refuse(`${name}: '${text}' is not a number${text.includes(",") ? "; write a point" : ""}`);
  if (min && (found < min || found > max)) refuse(`${name}: ${text} is not possible; allowed: ${min} to ${max}`);
  return found;
}
on("gains", "input", ({ target: { id } }) => take(id, () => useController({ ...state.controller, [id]: number(id) }, { plane: !["k", "b", state.plane].includes(id) })));
on("sharpen", "input", () => {
  const { base } = state, factor = Number($("sharpen").value);
  take("controller", () => useController({ ...base, k: factor * base.k, ki: factor * base.ki, kd: factor * base.kd }, { plane: Boolean(state.plane === "ki" ? base.kd : base.ki), moving: true }, { base, factor }));
});
on("planes", "change", ({ target }) => { state.plane = target.value; refresh({ plane: true }); });

function readOptions() {
  for (const [name, box, size] of OPTIONS) take(size, () => { options[name] = $(box).checked ? number(size) : 0; });
  options.antiWindup = $("anti-windup").checked;
  refresh();
}
on("options", "input", readOptions);

// The point moves, but not over the axis to where no integral or derivative part belongs.
const plane = $("plane");
function moveTo(k, other) {
  const { box } = state.view, kept = box.bottom < 0 ? Math.min(other, box.top && other) : Math.max(0, other);
  take("controller", () => useController({ ...state.controller, k, [state.plane]: kept }, { moving: true }));
}
function drag({ clientX, clientY }) {
  if (!state.view) return;
  const { box, left, right, top, bottom } = state.view, { x, y } = new DOMPoint(clientX, clientY).matrixTransform(plane.getScreenCTM().inverse());
  moveTo(box.left + (x - left) / (right - left) * (box.right - box.left), box.bottom + (bottom - y) / (bottom - top) * (box.top - box.bottom));
}
on("plane", "pointerdown", (event) => { plane.setPointerCapture(event.pointerId); drag(event); event.preventDefault(); plane.focus(); });
on("plane", "pointermove", (event) => { if (plane.hasPointerCapture(event.pointerId)) drag(event); });
on("plane", "keydown", (event) => {
  const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
  if (!direction || !state.view) return;
  event.preventDefault();
  const { box } = state.view, [right, up] = direction.map((way) => way * (event.shiftKey ? 0.05 : event.altKey ? 0.0005 : 0.005));
  moveTo(state.controller.k + right * (box.right - box.left), state.controller[state.plane] + up * (box.top - box.bottom));
});

on("pin", "click", () => { state.pins = [...state.pins, pinned(state.controller)].slice(-PINS.length); refresh(); });
on("unpin", "click", () => { state.pins = []; refresh(); });

on("copy-python", "click", () => copy(python(state), "Python lines copied."));
on("copy-link", "click", () => { writeAddress(); copy(location.href, "Link copied."); });
on("csv", "click", () => (state.last.stable ? download("whatif.csv", "text/csv", curves(state)) : say("done", "There is no response of an unstable loop.")));
on("svg", "click", () => download("whatif.svg", "image/svg+xml", picture()));

// A loop that Python has computed, computed here.
function selfTest({ plant, controller, times, output, metrics }) {
  const run = measure(prepare(parsePlant(plant)), parseController(controller)), { step } = run;
  const errors = Object.entries(metrics).map(([name, value]) => Math.abs(run[name] - value) / Math.max(1, Math.abs(value)));
  return Math.max(...errors, ...times.map((t, i) => Math.abs(step.at(step.output, t) - output[i])));
}
const apart = selfTest(DATA.reference);
say("agreement", apart < 1e-7 ? `This page agrees with the report to ${shown(apart, 1).replace("−", "-")}.` : `Warning: this browser's numbers differ by ${shown(apart, 2)} from the report's; do not trust them.`);

window.addEventListener("hashchange", fromAddress);
fromAddress();
window.whatif = { state, measure, responder, prepare, unstablePoles, parsePlant, parseController, rules, limited, border, contour, extent, gainMap, python, curves, picture };
