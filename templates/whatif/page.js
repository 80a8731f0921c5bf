// The page: what is chosen, and how one changes it.
"use strict";

(() => {
const DATA = JSON.parse(document.getElementById("data").textContent);
const { $, say, PINS } = Views;
const { shown, SVG } = Charts;
const { NotationError, controllerText, parseController, parsePlant } = Notation;
const GAINS = ["k", "ki", "kd", "b", "filter"];
const MOST_GAIN = 1e9, MOST_PARTS = 500;

// `base` is the controller whose gains the slider multiplies, `row` the printed row that was chosen last.
const state = { plantText: "", plant: null, controller: null, base: null, row: -1, plane: "ki", pins: [], view: null, last: null };
const options = { mismatch: 0, limit: 0, antiWindup: true };

// What changes: at most once a frame
let frame = 0, spoken = 0;

function refresh({ plane = false } = {}) {
  state.planeDue ||= plane;
  frame ||= requestAnimationFrame(() => {
    frame = 0;
    state.last = Measures.measure(state.plant, state.controller);
    if (state.planeDue) { state.planeDue = false; Views.drawPlane(state, markers()); } else Views.movePoint(state);
    Views.drawResponses(state, options); Views.drawNyquist(state); Views.drawTable(state); fields(); address();
    say("verdict", state.last.stable ? "" : `Unstable: ${state.last.unstable === Infinity ? "the loop gain does not fall below one" : `${state.last.unstable} closed-loop poles in the right half plane`}. The last stable responses stay.`);
    clearTimeout(spoken);
    spoken = setTimeout(() => say("spoken", summary()), 600);
  });
}

// Tuning rules for the plant, and the rows of the chosen row's table.
function markers() {
  const of = (row) => row.label.replace(/: .*/s, ""), chosen = DATA.rows[state.row];
  const rows = chosen ? DATA.rows.filter((row) => row.plant === state.plantText && of(row) === of(chosen)) : [];
  rows.sort((one, other) => (other === chosen) - (one === chosen));
  return [...rows.map((row) => ({ ...parseController(row.controller), name: row.label.replace(/^.*?: /s, ""), row: true })), ...(DATA.markers[state.plantText] || Measures.rules(state.plant))];
}

function summary() {
  const run = state.last, gains = controllerText(state.controller, 4);
  if (!run.stable) return `${gains}: unstable.`;
  return `${gains}: overshoot ${shown(100 * run.overshoot, 3)} per cent, settling time ${shown(run.settling, 3)}, Ms ${shown(run.ms, 3)}, gain margin ${shown(run.gain, 3)}, phase margin ${shown(run.phase, 3)} degrees.`;
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
  if (options.mismatch) given.mismatch = 100 * options.mismatch;
  if (options.limit) Object.assign(given, { limit: options.limit, windup: options.antiWindup ? "no" : "yes" });
  const hash = Object.entries(given).map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join("&");
  try { history.replaceState(null, "", `#${hash}`); } catch { /* a page in a frame may not */ }
}

// Take what a field says; what makes no sense leaves everything as it was, and the field says why.
const errorOf = (id) => $($(id).getAttribute("aria-describedby"));
function clear(id) {
  if ($(id).hasAttribute("aria-invalid")) { $(id).removeAttribute("aria-invalid"); errorOf(id).textContent = ""; }
}
function take(id, change) {
  try {
    change();
    clear(id);
    return true;
  } catch (error) {
    if (!(error instanceof NotationError)) throw error;
    $(id).setAttribute("aria-invalid", "true");
    errorOf(id).textContent = error.message;
    return false;
  }
}

function checked(controller, plant = state.plant) {
  const refuse = (reason) => { throw new NotationError(reason); };
  for (const name of GAINS) if (!(Math.abs(controller[name]) <= MOST_GAIN)) refuse(`${name} is beyond any limit: at most ${MOST_GAIN.toExponential(0)}`);
  if (controller.filter < 0) refuse("the derivative filter must not be negative");
  const jumps = plant.deadTime && controller.kd && !controller.filter && plant.relativeDegree < 2;
  if (jumps) controller = { ...controller, filter: Math.abs(controller.kd / (controller.k || 1)) / 10 };
  if (Kernel.piecesPerDelay(plant, controller.kd ? controller.filter : 0) > MOST_PARTS) refuse("so fast a plant or filter beside so long a dead time is not drawn here");
  if (Number.isNaN(Kernel.unstablePoles(plant, controller))) refuse("so high a gain is not drawn here");
  say("note", jumps ? "The derivative of this plant's output jumps; a filter of kd/(10 k) is added." : "");
  return controller;
}

function usePlant(text, controller = state.controller) {
  const plant = Kernel.prepare(parsePlant(text));
  const made = checked(controller, plant), pins = state.pins.map((pin) => ({ controller: checked(pin.controller, plant), measured: Measures.measure(plant, pin.controller) }));
  Object.assign(state, { plant, plantText: text.trim(), pins, controller: made, base: made });
  const here = DATA.rows.map((row) => row.plant === state.plantText);
  if (!here[state.row]) state.row = here.indexOf(true);
  ["plant", "controller", ...GAINS].forEach(clear);
  refresh({ plane: true });
}

function useController(controller, { plane = false, base = null } = {}) {
  state.controller = checked(controller);
  state.base = base || state.controller;
  ["controller", ...GAINS].forEach(clear);
  refresh({ plane });
}

function useRow(i) {
  state.row = i;
  usePlant(DATA.rows[i].plant, parseController(DATA.rows[i].controller));
}
function fromAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  if (!state.plant) useRow(0);
  take("controller", () => {
    const controller = given.get("controller") ? parseController(given.get("controller")) : state.controller;
    if (!take("plant", () => usePlant(given.get("plant") || state.plantText, controller))) useController(controller, { plane: true });
    const row = DATA.rows.findIndex((one) => one.plant === state.plantText && controllerText(parseController(one.controller)) === controllerText(controller));
    if (row >= 0) state.row = row;
    const pins = (given.get("pins") || "").split(";").filter(Boolean).slice(0, PINS.length).map((text) => checked(parseController(text)));
    state.pins = pins.map((pin) => ({ controller: pin, measured: Measures.measure(state.plant, pin) }));
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
DATA.rows.forEach((row, i) => { $("rows").append(new Option(row.label, String(i))); });
$("rows").append(new Option("none of these plants", "-1"));
$("rows").addEventListener("change", () => { if ($("rows").value !== "-1") useRow(Number($("rows").value)); });
$("plant").addEventListener("change", () => take("plant", () => usePlant($("plant").value)));
$("controller").addEventListener("change", () => take("controller", () => useController(parseController($("controller").value), { plane: true })));

function number(id) {
  const text = $(id).value.trim().replace("−", "-");
  if (text === "" || !Number.isFinite(Number(text))) throw new NotationError(`${$(id).dataset.name || id}: '${text}' is not a number${text.includes(",") ? "; write a point" : ""}`);
  return Number(text);
}
for (const name of GAINS) {
  $(name).addEventListener("input", () => take(name, () => useController({ ...state.controller, [name]: number(name) }, { plane: !(name === "k" || name === state.plane) })));
}
$("sharpen").addEventListener("input", () => {
  const { base } = state, factor = Number($("sharpen").value);
  take("controller", () => useController({ ...base, k: factor * base.k, ki: factor * base.ki, kd: factor * base.kd }, { base, plane: state.plane === "ki" ? base.kd !== 0 : base.ki !== 0 }));
});
for (const choice of document.getElementsByName("plane")) {
  choice.addEventListener("change", () => { state.plane = choice.value; refresh({ plane: true }); });
}

function readOptions() {
  const ranged = (id, allowed, fits) => {
    const value = number(id);
    if (!fits(value)) throw new NotationError(`${$(id).dataset.name}: ${value} is not possible; allowed: ${allowed}`);
    return value;
  };
  take("mismatch-size", () => { options.mismatch = $("mismatch").checked ? ranged("mismatch-size", "1 to 50 %", (x) => x >= 1 && x <= 50) / 100 : 0; });
  take("limit", () => { options.limit = $("saturation").checked ? ranged("limit", "above 0", (x) => x > 0) : 0; });
  options.antiWindup = $("anti-windup").checked;
  refresh();
}
for (const id of ["mismatch", "mismatch-size", "saturation", "limit", "anti-windup"]) $(id).addEventListener("input", readOptions);

const plane = $("plane");
function drag(event) {
  const { view } = state;
  if (!view) return;
  const rect = plane.getBoundingClientRect(), scale = plane.viewBox.baseVal.width / rect.width;
  const x = (event.clientX - rect.left) * scale, y = (event.clientY - rect.top) * scale;
  const k = view.box.left + (x - view.left) / (view.right - view.left) * (view.box.right - view.box.left);
  const other = view.box.bottom + (view.bottom - y) / (view.bottom - view.top) * (view.box.top - view.box.bottom);
  take("controller", () => useController({ ...state.controller, k, [state.plane]: Math.max(0, other) }));
}
plane.addEventListener("pointerdown", (event) => { plane.setPointerCapture(event.pointerId); drag(event); event.preventDefault(); plane.focus(); });
plane.addEventListener("pointermove", (event) => { if (plane.hasPointerCapture(event.pointerId)) drag(event); });
plane.addEventListener("keydown", (event) => {
  const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
  if (!direction || !state.view) return;
  event.preventDefault();
  const { box } = state.view, step = event.shiftKey ? 0.05 : event.altKey ? 0.0005 : 0.005;
  const next = { ...state.controller, k: state.controller.k + direction[0] * step * (box.right - box.left) };
  next[state.plane] = Math.max(0, next[state.plane] + direction[1] * step * (box.top - box.bottom));
  take("controller", () => useController(next));
});

$("pin").addEventListener("click", () => {
  if (state.pins.length === PINS.length) state.pins.shift();
  state.pins.push({ controller: state.controller, measured: state.last });
  refresh({ plane: true });
});
$("unpin").addEventListener("click", () => { state.pins = []; refresh({ plane: true }); });

async function copy(text, done) {
  try { await navigator.clipboard.writeText(text); say("done", done); } catch { $("copied").hidden = false; $("copied").value = text; $("copied").select(); }
}
const python = () => `from replicate.loops import Loop
from replicate.loops.notation import parse_controller, parse_plant

loop = Loop(parse_plant(${JSON.stringify(state.plantText)}), parse_controller(${JSON.stringify(controllerText(state.controller))}))
y, u, d, m = loop.step(), loop.respond().control, loop.load_step(), loop.margins()
print(f"overshoot {100 * y.overshoot():.4g} %, settling time {y.settling_time():.4g}, rise time {y.rise_time():.4g}")
print(f"IAE {y.iae():.4g} (set point), {d.iae():.4g} (load), total variation of u {u.total_variation():.4g}")
print(f"Ms {loop.sensitivity_peak().value:.4g}, margins: gain {m.gain:.4g}, phase {m.phase:.4g}, delay {m.delay:.4g}")
`;
function download(name, type, text) {
  const link = document.createElement("a");
  link.href = `data:${type};charset=utf-8,${encodeURIComponent(text)}`;
  link.download = name;
  link.click();
}
function table() {
  const runs = [["", state.last], ...state.pins.map((pin, i) => [`${PINS[i]}_`, pin.measured])].filter(([, run]) => run.stable);
  const signals = runs.flatMap(([name, { step, load }]) => [[`${name}y_setpoint`, step, step.output], [`${name}u_setpoint`, step, step.control], [`${name}y_load`, load, load.output], [`${name}u_load`, load, load.control]]);
  const end = Math.min(...signals.map(([, response]) => response.end)) * (1 - 1e-12), lines = [["t", ...signals.map(([name]) => name)]];
  for (let i = 0; i <= 2000; i++) lines.push([end * i / 2000, ...signals.map(([, response, values]) => response.at(values, end * i / 2000))].map((x) => Number(x.toPrecision(12))));
  return lines.map((line) => `${line.join()}\n`).join("");
}
function picture() {
  let y = 0;
  const parts = Object.entries({ plane: 380, nyquist: 400, output: 250, control: 150, load: 150 }).map(([id, tall]) => {
    const copyOf = $(id).cloneNode(true);
    for (const [name, value] of Object.entries({ x: 5, y, width: 460, height: tall, style: `width:460px;height:${tall}px` })) copyOf.setAttribute(name, value);
    y += tall + 10;
    return new XMLSerializer().serializeToString(copyOf);
  });
  const style = document.querySelector("style").textContent.replace(/[<&]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<svg xmlns="${SVG}" viewBox="0 0 470 ${y}" width="470" height="${y}"><style>${style}</style>${parts.join("")}</svg>`;
}
$("copy-python").addEventListener("click", () => copy(python(), "Python lines copied."));
$("copy-link").addEventListener("click", () => { writeAddress(); copy(location.href, "Link copied."); });
$("csv").addEventListener("click", () => (state.last.stable ? download("whatif.csv", "text/csv", table()) : say("done", "There is no response of an unstable loop.")));
$("svg").addEventListener("click", () => download("whatif.svg", "image/svg+xml", picture()));

// A loop that Python has computed, computed here.
function selfTest() {
  const { plant, controller, times, output, metrics } = DATA.reference;
  const prepared = Kernel.prepare(parsePlant(plant)), parsed = parseController(controller);
  const maps = Kernel.mapsOf(prepared, parsed.kd ? parsed.filter : 0), response = Kernel.respond(maps, parsed, { setpoint: 1, until: times[times.length - 1] + 1e-9 });
  let apart = 0;
  times.forEach((t, i) => { apart = Math.max(apart, Math.abs(response.y(Math.min(t, response.end * (1 - 1e-15))) - output[i])); });
  const run = Measures.measure(prepared, parsed);
  for (const [name, value] of Object.entries(metrics)) apart = Math.max(apart, Math.abs(run[name] - value) / Math.max(1, Math.abs(value)));
  return apart;
}
const apart = selfTest();
say("agreement", apart < 1e-7 ? `This page agrees with the report to ${shown(apart, 1).replace("−", "-")}.` : `Warning: this browser's numbers differ by ${shown(apart, 2)} from the report's; do not trust them.`);

window.addEventListener("hashchange", fromAddress);
fromAddress();
window.whatif = { state, measure: Measures.measure, python, table, picture };
})();
