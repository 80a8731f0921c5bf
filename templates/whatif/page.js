// The page: what is chosen, what is drawn, and how one changes it.
"use strict";

(() => {
  const DATA = JSON.parse(document.getElementById("data").textContent);
  const LEVELS = [1.2, 1.4, 1.6, 2.0];
  const PINS = ["a", "b", "c"];
  const $ = (id) => document.getElementById(id);
  const SVG = "http://www.w3.org/2000/svg";

  const state = { plantText: "", plant: null, controller: null, plane: "ki", pins: [], view: null, last: null };

  // ------------------------------------------------------------------------------------------------- numbers, shapes

  function shown(x, digits = 4) {
    if (x === Infinity) return "∞";
    if (x === undefined || Number.isNaN(x)) return "–";
    const text = Math.abs(x) >= 1e5 || (x && Math.abs(x) < 1e-4) ? x.toExponential(digits - 1) : String(Number(x.toPrecision(digits)));
    return text.replace("-", "−");
  }

  function element(name, attributes, parent, text) {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  }

  // Round numbers for an axis.
  function ticks(low, high, count = 5) {
    const rough = (high - low) / count, power = Math.pow(10, Math.floor(Math.log10(rough)));
    const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough) || power * 10;
    const found = [];
    for (let x = Math.ceil(low / step - 1e-9) * step; x <= high + 1e-9 * step; x += step) found.push(Math.abs(x) < step * 1e-9 ? 0 : x);
    return found;
  }

  // An empty diagram in an <svg>: axes, and functions from values to places.
  function diagram(svg, box, { width = 460, height = 260, x = "", y = "" }) {
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.replaceChildren(...[...svg.children].filter((child) => ["title", "desc"].includes(child.tagName)));
    const left = 52, right = width - 10, top = 10, bottom = height - 36;
    const px = (value) => left + (value - box.left) / (box.right - box.left) * (right - left);
    const py = (value) => bottom - (value - box.bottom) / (box.top - box.bottom) * (bottom - top);
    const grid = element("g", { class: "grid" }, svg);
    for (const value of ticks(box.left, box.right)) {
      element("path", { d: `M${px(value)} ${top}V${bottom}` }, grid);
      element("text", { x: px(value), y: bottom + 15, "text-anchor": "middle" }, svg, shown(value));
    }
    for (const value of ticks(box.bottom, box.top, 4)) {
      element("path", { d: `M${left} ${py(value)}H${right}` }, grid);
      element("text", { x: left - 6, y: py(value) + 4, "text-anchor": "end" }, svg, shown(value));
    }
    element("text", { x: (left + right) / 2, y: height - 5, "text-anchor": "middle", class: "axis" }, svg, x);
    element("text", { x: 12, y: (top + bottom) / 2, "text-anchor": "middle", class: "axis", transform: `rotate(-90 12 ${(top + bottom) / 2})` }, svg, y);
    const clip = `${svg.id}-clip`, inside = element("g", { "clip-path": `url(#${clip})` }, svg);
    element("rect", { x: left, y: top, width: right - left, height: bottom - top }, element("clipPath", { id: clip }, svg));
    element("rect", { x: left, y: top, width: right - left, height: bottom - top, class: "frame" }, svg);
    return { inside, px, py, box, left, right, top, bottom };
  }

  const path = (points, { px, py }) => points.map(([x, y], i) => `${i && Number.isFinite(y) ? "L" : "M"}${px(x).toFixed(1)} ${py(y).toFixed(1)}`).join("");

  // ------------------------------------------------------------------------------------------------- what is computed

  function measure(plant, controller) {
    const unstable = Kernel.unstablePoles(plant, controller);
    if (unstable !== 0) return { stable: false, unstable };
    const maps = Kernel.mapsOf(plant, controller.kd ? controller.filter : 0);
    const p0 = plant.den[plant.den.length - 1] ? plant.num[plant.num.length - 1] / plant.den[plant.den.length - 1] : Infinity;
    const final = controller.ki || p0 === Infinity ? (controller.ki ? 1 : controller.b) : p0 * controller.k * controller.b / (1 + p0 * controller.k);
    const finalLoad = controller.ki ? 0 : p0 === Infinity ? 1 / controller.k : p0 / (1 + p0 * controller.k);
    const step = Kernel.respond(maps, controller, { setpoint: 1, load: 0, settle: 1e-9, final });
    const load = Kernel.respond(maps, controller, { setpoint: 0, load: 1, settle: 1e-9, final: finalLoad });
    const rise = Kernel.reaches(step, 0.9 * final) - Kernel.reaches(step, 0.1 * final);
    return {
      stable: true, final, step, load, rise,
      ...Kernel.overshoot(step, final), settling: Kernel.settlingTime(step, final, 0.02),
      iae: Kernel.absoluteError(step, final), loadIae: Kernel.absoluteError(load, finalLoad),
      variation: Kernel.totalVariation(step), loadQuiet: quietAfter(load, finalLoad), ...Kernel.margins(plant, controller),
    };
  }

  // When a load has been worked off, but for a thirtieth of its largest effect.
  function quietAfter(response, final) {
    const largest = response.output.reduce((most, y) => Math.max(most, Math.abs(y - final)), 0), step = Kernel.NODES + 1;
    let piece = response.pieces - 1;
    while (piece > 0 && response.output.slice(piece * step, (piece + 1) * step).every((y) => Math.abs(y - final) < largest / 30)) piece--;
    return (piece + 1) * response.h;
  }

  // Responses of a loop whose control signal is limited: small steps in time, so only as exact as a line is wide.
  function limited(plant, controller, limit, antiWindup, end) {
    const n = plant.order, count = 4000, dt = end / count, delay = Math.round(plant.deadTime / dt);
    const x = new Float64Array(n), history = new Float64Array(count + delay + 1), output = [], control = [];
    let integral = 0, lagged = 0;
    const { k, ki, kd, b, filter } = controller, lag = Math.max(filter, 2 * dt), tracking = ki ? Math.sqrt(k / ki * Math.max(kd / k, dt)) || k / ki : 1;
    for (let i = 0; i <= count; i++) {
      let y = 0;
      for (let j = 0; j < plant.num.length; j++) y += plant.num[plant.num.length - 1 - j] * x[j];
      const slope = kd ? (y - lagged) / lag : 0, wanted = k * (b - y) + integral - kd * slope;
      const u = Math.min(limit, Math.max(-limit, wanted));
      output.push([i * dt, y]); control.push([i * dt, u]);
      integral += dt * (ki * (1 - y) + (antiWindup ? (u - wanted) / (controller.ki ? Math.max(k / ki, dt) : tracking) : 0));
      lagged += dt * slope;
      history[i + delay] = u;
      // the plant in controllable form, a step of the midpoint rule
      const v = history[i], rate = (z) => {
        const d = new Float64Array(n);
        for (let j = 0; j < n - 1; j++) d[j] = z[j + 1];
        d[n - 1] = v;
        for (let j = 0; j < n; j++) d[n - 1] -= plant.den[n - j] * z[j];
        return d;
      };
      const first = rate(x), middle = rate(x.map((value, j) => value + dt / 2 * first[j]));
      for (let j = 0; j < n; j++) x[j] += dt * middle[j];
    }
    return { output, control };
  }

  // Plants whose gain, time constants and dead time are off by a fraction.
  function mismatched(plant, fraction) {
    const found = [];
    for (const gain of [1 - fraction, 1 + fraction]) for (const time of [1 - fraction, 1 + fraction]) for (const delay of [1 - fraction, 1 + fraction]) {
      const n = plant.den.length, m = plant.num.length;
      found.push(Kernel.prepare({
        den: plant.den.map((a, i) => a * Math.pow(time, n - 1 - i)), num: plant.num.map((a, i) => gain * a * Math.pow(time, m - 1 - i)),
        deadTime: plant.deadTime * delay,
      }));
    }
    return found;
  }

  // ------------------------------------------------------------------------------------------------------ drawing

  function drawPlane() {
    const { plant, controller, plane } = state, svg = $("plane");
    const box = Plane.extent(plant, controller, plane);
    state.view = null;
    if (!box) {
      svg.replaceChildren(...[...svg.children].filter((child) => ["title", "desc"].includes(child.tagName)));
      say("plane-note", `No ${plane === "ki" ? "PI" : "PD"} part stabilises this plant with the other gain as it is; try another plant or another gain.`);
      return;
    }
    say("plane-note", "");
    const map = Plane.map(plant, controller, plane, box);
    const view = diagram(svg, box, { width: 460, height: 380, x: "proportional gain k (curves: Ms)", y: plane === "ki" ? "integral gain ki" : "derivative gain kd" });
    element("path", { class: "stable", d: Plane.region(map, plant, controller, plane).map((polygon) => path(polygon, view) + "Z").join("") }, view.inside);
    let named = -Infinity;
    for (const level of LEVELS) {
      const segments = Plane.contour(map, Math.log(level));
      if (!segments.length) continue;
      element("path", { class: "level", d: segments.map((segment) => path(segment, view)).join("") }, view.inside);
      const foot = segments.flat().filter(([, y]) => y < box.bottom + 0.04 * (box.top - box.bottom));
      const [x, y] = (foot.length ? foot : segments.flat()).reduce((best, point) => (point[0] > best[0] ? point : best));
      if (view.px(x) > named + 22) { named = view.px(x); element("text", { class: "level-name", x: named + 3, y: view.py(y) - 3 }, view.inside, String(level)); }
    }
    const border = [], corners = [...plant.poles, ...plant.zeros].map(([re, im]) => Math.hypot(re, im)).filter((size) => size > 0).concat(plant.deadTime ? [1 / plant.deadTime] : []);
    for (let w = Math.min(...corners, 1) / 1e3; w < Math.max(...corners, 1) * 40; w *= 1.01) border.push(Kernel.boundary(plant, controller, plane, w));
    element("path", { class: "border", d: path(border.filter(([x, y]) => Math.abs(x) < 1e6 && Math.abs(y) < 1e6), view) }, view.inside);
    const rules = DATA.markers[state.plantText] || [];
    rules.forEach((rule, i) => {
      const x = view.px(rule.k), y = view.py(rule[plane] || 0);
      element("path", { class: "rule", d: `M${x - 4} ${y}h8M${x} ${y - 4}v8` }, view.inside);
      element("text", { class: "rule-name", x: x + 6, y: y - 5 + 11 * (i % 2) }, view.inside, rule.name);
    });
    state.pins.forEach((pin, i) => element("circle", { class: `pin pin-${PINS[i]}`, r: 5, cx: view.px(pin.controller.k), cy: view.py(pin.controller[plane]) }, view.inside));
    state.point = element("circle", { class: "point", r: 8 }, view.inside);
    state.view = view;
    movePoint();
  }

  function movePoint() {
    if (!state.view) return;
    state.point.setAttribute("cx", state.view.px(state.controller.k));
    state.point.setAttribute("cy", state.view.py(state.controller[state.plane]));
  }

  const sampled = (response, values, end) => {
    const points = [];
    for (let i = 0; i <= 400; i++) points.push([end * i / 400, response.at(values, Math.min(end * i / 400, response.end * (1 - 1e-12)))]);
    return points;
  };

  function drawResponses() {
    const now = state.last, runs = [...state.pins.map((pin, i) => [PINS[i], pin.measured]), ["now", now]].filter(([, run]) => run.stable);
    for (const id of ["output", "control", "load"]) $(id).classList.toggle("faded", !now.stable);
    if (!runs.length) return;
    const quiet = (run) => Math.max(Number.isNaN(run.settling) ? run.step.end : run.settling * 1.6, run.loadQuiet * 1.2, 6 * state.plant.deadTime, 1e-9);
    const end = Math.min(Math.max(...runs.map(([, run]) => quiet(run))), Math.max(...runs.map(([, run]) => run.step.end)));
    const mismatch = $("mismatch").checked && now.stable ? mismatched(state.plant, Number($("mismatch-size").value) / 100) : [];
    const cloud = mismatch.map((plant) => (Kernel.isStable(plant, state.controller) ? Kernel.respond(Kernel.mapsOf(plant, state.controller.kd ? state.controller.filter : 0), state.controller, { setpoint: 1, until: end }) : null));
    const saturated = $("saturation").checked && now.stable ? limited(state.plant, state.controller, Math.abs(Number($("limit").value)) || 1, $("anti-windup").checked, end) : null;
    const draw = (id, values, label) => {
      const curves = runs.map(([name, run]) => [name, sampled(...values(run), end)]);
      const all = curves.flatMap(([, points]) => points.map(([, y]) => y)).filter(Number.isFinite);
      let low = Math.min(0, ...all), high = Math.max(id === "output" ? 1.05 : 0, ...all);
      if (id === "output" && cloud.length) high = Math.max(high, Math.min(3, ...[Math.max(...cloud.filter(Boolean).flatMap((run) => sampled(run, run.output, end).map(([, y]) => y)), 0)]));
      if (high === low) high = low + 1;
      const margin = 0.06 * (high - low);
      const view = diagram($(id), { left: 0, right: end, bottom: low - margin, top: high + margin }, { width: 460, height: id === "output" ? 250 : 150, x: id === "load" ? "time" : "", y: label });
      if (id === "output" && now.stable) annotate(view, now, end);
      if (id === "output") for (const run of cloud) if (run) element("path", { class: "cloud", d: path(sampled(run, run.output, end), view) }, view.inside);
      for (const [name, points] of curves) element("path", { class: `curve ${name}`, d: path(points, view) }, view.inside);
      if (saturated && id !== "load") element("path", { class: "curve saturated", d: path(saturated[id === "output" ? "output" : "control"], view) }, view.inside);
    };
    draw("output", (run) => [run.step, run.step.output], "output y, set-point step");
    draw("control", (run) => [run.step, run.step.control], "control u");
    draw("load", (run) => [run.load, run.load.output], "y, load step");
    const lost = cloud.filter((run) => !run).length;
    say("mismatch-note", lost ? `${lost} of ${cloud.length} plants of the cloud make the loop unstable.` : "");
  }

  // Band, overshoot, rise and settling time where they are read.
  function annotate(view, run, end) {
    const { px, py, inside } = view, { final } = run, band = 0.02 * Math.abs(final);
    element("rect", { class: "band", x: px(0), width: px(end) - px(0), y: py(final + band), height: py(final - band) - py(final + band) }, inside);
    if (run.overshoot > 0.001) {
      const y = py(final * (1 + run.overshoot));
      element("path", { class: "reading", d: `M${px(run.peakTime)} ${py(final)}V${y}` }, inside);
      element("text", { class: "reading-name", x: px(run.peakTime) + 5, y: y + 11 }, inside, `${shown(100 * run.overshoot, 3)} %`);
    }
    if (run.settling <= end) {
      element("path", { class: "reading", d: `M${px(run.settling)} ${py(0)}V${py(final)}` }, inside);
      element("text", { class: "reading-name", x: px(run.settling) + 4, y: py(0) - 6 }, inside, `settles ${shown(run.settling, 3)}`);
    }
    const ten = Kernel.reaches(run.step, 0.1 * final), ninety = Kernel.reaches(run.step, 0.9 * final);
    if (ninety <= end) element("path", { class: "reading", d: `M${px(ten)} ${py(0.1 * final)}V${py(0.05 * final)}H${px(ninety)}V${py(0.9 * final)}` }, inside);
  }

  function drawNyquist() {
    const { plant, controller, last } = state, w = Kernel.grid(plant, controller, 0.02), points = [];
    for (const x of w) points.push(Kernel.loopAt(plant, controller, x));
    const view = diagram($("nyquist"), { left: -2.2, right: 1.2, bottom: -1.9, top: 1.12 }, { width: 460, height: 400, x: "Re L", y: "Im L" });
    const circle = (x, y, r, name) => element("ellipse", { class: name, cx: view.px(x), cy: view.py(y), rx: view.px(r) - view.px(0), ry: view.py(0) - view.py(r) }, view.inside);
    circle(0, 0, 1, "unit");
    if (last.stable) circle(-1, 0, 1 / last.ms, "ms");
    const near = points.map(([x, y]) => [Math.max(-50, Math.min(50, x)), Math.max(-50, Math.min(50, y))]);
    state.pins.forEach((pin, i) => {
      const others = [...Kernel.grid(state.plant, pin.controller, 0.02)].map((x) => Kernel.loopAt(state.plant, pin.controller, x)).filter(([x, y]) => Math.abs(x) < 50 && Math.abs(y) < 50);
      element("path", { class: `curve ${PINS[i]}`, d: path(others, view) }, view.inside);
    });
    element("path", { class: "curve now", d: path(near, view) }, view.inside);
    element("path", { class: "critical", d: `M${view.px(-1) - 5} ${view.py(0)}h10M${view.px(-1)} ${view.py(0) - 5}v10` }, view.inside);
    if (!last.stable) return;
    for (const [at, name] of [[last.gainAt, "GM"], [last.phaseAt, "PM"], [last.msAt, "Ms"]]) {
      if (!(at > 0)) continue;
      const [x, y] = Kernel.loopAt(plant, controller, at);
      element("circle", { class: "mark", r: 3.5, cx: view.px(x), cy: view.py(y) }, view.inside);
      element("text", { class: "reading-name", x: view.px(x) + 6, y: view.py(y) - 5 }, view.inside, name);
    }
  }

  const METRICS = [
    ["overshoot", (run) => `${shown(100 * run.overshoot)} %`], ["settling time (2 %)", (run) => shown(run.settling)],
    ["rise time (10–90 %)", (run) => shown(run.rise)], ["IAE, set point", (run) => shown(run.iae)], ["IAE, load", (run) => shown(run.loadIae)],
    ["total variation of u", (run) => shown(run.variation)], ["Ms", (run) => shown(run.ms)], ["gain margin", (run) => shown(run.gain)],
    ["phase margin", (run) => `${shown(run.phase)}°`], ["delay margin", (run) => shown(run.delay)],
  ];

  function drawTable() {
    const columns = [["now", state.controller, state.last], ...state.pins.map((pin, i) => [PINS[i], pin.controller, pin.measured])];
    const head = document.createElement("tr");
    head.append(cell("th", "metric", { scope: "col" }));
    for (const [name, controller] of columns) {
      const made = cell("th", "", { scope: "col", class: name });
      made.append(name === "now" ? "now" : `pinned ${name}`, document.createElement("br"));
      const small = document.createElement("small");
      small.textContent = Notation.controllerText(controller, 4);
      made.append(small);
      head.append(made);
    }
    $("metrics-head").replaceChildren(head);
    $("metrics-body").replaceChildren(...METRICS.map(([name, text]) => {
      const row = document.createElement("tr");
      row.append(cell("th", name, { scope: "row" }));
      for (const [, , run] of columns) row.append(cell("td", run.stable ? text(run) : "unstable"));
      return row;
    }));
  }

  function cell(name, text, attributes = {}) {
    const made = document.createElement(name);
    made.textContent = text;
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  }

  const say = (id, text) => { if ($(id).textContent !== text) $(id).textContent = text; };

  // -------------------------------------------------------------------------------------------------- what changes

  let frame = 0, spoken = 0;

  function refresh({ plane = false } = {}) {
    state.planeDue ||= plane;
    if (frame) return;
    frame = requestAnimationFrame(() => {
      frame = 0;
      state.last = measure(state.plant, state.controller);
      if (state.planeDue) { state.planeDue = false; drawPlane(); } else movePoint();
      drawResponses(); drawNyquist(); drawTable(); fields(); address();
      say("verdict", state.last.stable ? "" : `Unstable: ${state.last.unstable === Infinity ? "the loop gain does not fall below one" : `${state.last.unstable} closed-loop poles in the right half plane`}. The last stable responses stay.`);
      clearTimeout(spoken);
      spoken = setTimeout(() => say("spoken", summary()), 600);
    });
  }

  function summary() {
    const run = state.last, gains = Notation.controllerText(state.controller, 4);
    if (!run.stable) return `${gains}: unstable.`;
    return `${gains}: overshoot ${shown(100 * run.overshoot, 3)} per cent, settling time ${shown(run.settling, 3)}, Ms ${shown(run.ms, 3)}, gain margin ${shown(run.gain, 3)}, phase margin ${shown(run.phase, 3)} degrees.`;
  }

  function fields() {
    for (const name of ["k", "ki", "kd", "b", "filter"]) {
      const input = $(name);
      if (document.activeElement !== input) input.value = String(Number(state.controller[name].toPrecision(6)));
    }
    if (document.activeElement !== $("plant")) $("plant").value = state.plantText;
    if (document.activeElement !== $("controller")) $("controller").value = Notation.controllerText(state.controller, 6);
  }

  let waiting = 0;
  function address() {
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      const hash = `#plant=${encodeURIComponent(state.plantText)}&controller=${encodeURIComponent(Notation.controllerText(state.controller))}`;
      try { history.replaceState(null, "", hash); } catch { /* a page in a frame may not */ }
    }, 250);
  }

  // Take a new plant or controller; a text that makes no sense leaves everything as it was and says why.
  function take(field, change) {
    try {
      change();
      say(`${field}-error`, "");
      $(field).removeAttribute("aria-invalid");
      return true;
    } catch (error) {
      if (!(error instanceof Notation.NotationError)) throw error;
      say(`${field}-error`, error.message);
      $(field).setAttribute("aria-invalid", "true");
      return false;
    }
  }

  const LIMIT = 1e9;
  function checked(controller) {
    for (const [name, value] of Object.entries(controller)) {
      if (!Number.isFinite(value) || Math.abs(value) > LIMIT) throw new Notation.NotationError(`${name} is beyond any limit: at most ${LIMIT.toExponential(0)}`);
    }
    if (controller.kd && !controller.filter && state.plant.relativeDegree < 2) controller = { ...controller, filter: Math.abs(controller.kd / (controller.k || 1)) / 10 };
    if (controller.kd && !controller.filter && !state.plant.deadTime) controller = { ...controller, filter: Math.abs(controller.kd / (controller.k || 1)) / 10 };
    return controller;
  }

  function usePlant(text) {
    const plant = Kernel.prepare(Notation.parsePlant(text));
    state.plant = plant;
    state.plantText = text.trim();
    state.pins = state.pins.map((pin) => ({ ...pin, measured: measure(plant, pin.controller) }));
  }

  function useController(controller, options) {
    state.controller = checked(controller);
    refresh(options);
  }

  function fromAddress() {
    const given = new URLSearchParams(location.hash.slice(1));
    const row = DATA.rows[0];
    const ok = take("plant", () => usePlant(given.get("plant") || row.plant));
    if (!ok && !state.plant) usePlant(row.plant);
    const good = take("controller", () => { state.controller = checked(Notation.parseController(given.get("controller") || row.controller)); });
    if (!good && !state.controller) state.controller = Notation.parseController(row.controller);
    $("rows").value = String(Math.max(0, DATA.rows.findIndex((other) => other.plant === state.plantText && Notation.controllerText(Notation.parseController(other.controller)) === Notation.controllerText(state.controller))));
    refresh({ plane: true });
  }

  // ---------------------------------------------------------------------------------------------------- the controls

  DATA.rows.forEach((row, i) => { const option = new Option(row.label, String(i)); $("rows").append(option); });
  $("rows").addEventListener("change", () => {
    const row = DATA.rows[Number($("rows").value)];
    usePlant(row.plant);
    useController(Notation.parseController(row.controller), { plane: true });
  });
  $("plant").addEventListener("change", () => take("plant", () => { usePlant($("plant").value); useController(state.controller, { plane: true }); }));
  $("controller").addEventListener("change", () => take("controller", () => useController(Notation.parseController($("controller").value), { plane: true })));
  for (const name of ["k", "ki", "kd", "b", "filter"]) {
    $(name).addEventListener("input", () => take("controller", () => {
      const value = Number($(name).value);
      if ($(name).value.trim() === "" || !Number.isFinite(value)) throw new Notation.NotationError(`${name}: '${$(name).value}' is not a number`);
      if (name === "filter" && value < 0) throw new Notation.NotationError("the derivative filter must not be negative");
      useController({ ...state.controller, [name]: value }, { plane: !(name === "k" || name === state.plane) });
    }));
  }
  for (const choice of document.getElementsByName("plane")) {
    choice.addEventListener("change", () => { state.plane = choice.value; refresh({ plane: true }); });
  }
  for (const id of ["mismatch", "mismatch-size", "saturation", "limit", "anti-windup"]) $(id).addEventListener("input", () => refresh());

  const plane = $("plane");
  function drag(event) {
    const { view } = state;
    if (!view) return;
    const rect = plane.getBoundingClientRect(), scale = plane.viewBox.baseVal.width / rect.width;
    const x = (event.clientX - rect.left) * scale, y = (event.clientY - rect.top) * scale;
    const k = view.box.left + (x - view.left) / (view.right - view.left) * (view.box.right - view.box.left);
    const other = view.box.bottom + (view.bottom - y) / (view.bottom - view.top) * (view.box.top - view.box.bottom);
    useController({ ...state.controller, k, [state.plane]: Math.max(0, other) });
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
    useController(next);
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
  const python = () => [
    "from replicate.loops import Loop", "from replicate.loops.notation import parse_controller, parse_plant", "",
    `loop = Loop(parse_plant(${JSON.stringify(state.plantText)}), parse_controller(${JSON.stringify(Notation.controllerText(state.controller))}))`,
    "y = loop.step()", "y.overshoot(), y.settling_time(), y.iae(), loop.sensitivity_peak(), loop.margins()", "",
  ].join("\n");
  function download(name, type, text) {
    const link = document.createElement("a");
    link.href = `data:${type};charset=utf-8,${encodeURIComponent(text)}`;
    link.download = name;
    link.click();
  }
  $("copy-python").addEventListener("click", () => copy(python(), "Python lines copied."));
  $("copy-link").addEventListener("click", () => copy(location.href, "Link copied."));
  $("csv").addEventListener("click", () => {
    if (!state.last.stable) return say("done", "There is no response of an unstable loop.");
    const { step, load } = state.last, end = Math.min(step.end, load.end) * (1 - 1e-12), lines = ["t,y_setpoint,u_setpoint,y_load,u_load"];
    for (let i = 0; i <= 2000; i++) { const t = end * i / 2000; lines.push([t, step.y(t), step.u(t), load.y(t), load.u(t)].map((x) => Number(x.toPrecision(12))).join()); }
    return download("whatif.csv", "text/csv", lines.join("\n") + "\n");
  });
  $("svg").addEventListener("click", () => {
    const height = { plane: 380, output: 250, control: 150, load: 150 }, style = document.querySelector("style").textContent;
    let y = 0;
    const parts = Object.entries(height).map(([id, tall]) => {
      const copyOf = $(id).cloneNode(true);
      copyOf.setAttribute("y", y); copyOf.setAttribute("width", 460); copyOf.setAttribute("height", tall);
      y += tall + 10;
      return new XMLSerializer().serializeToString(copyOf);
    });
    download("whatif.svg", "image/svg+xml", `<svg xmlns="${SVG}" viewBox="0 0 460 ${y}" class="picture"><style>${style.replace(/[<&]/g, (c) => `&#${c.charCodeAt(0)};`)}</style>${parts.join("")}</svg>`);
  });

  // --------------------------------------------------------------------------------------------------- the self-test

  // The loop that Python has computed, computed here, too; the footer says how well the two agree.
  function selfTest() {
    const { plant, controller, times, output, metrics } = DATA.reference;
    const prepared = Kernel.prepare(Notation.parsePlant(plant)), parsed = Notation.parseController(controller);
    const maps = Kernel.mapsOf(prepared, parsed.kd ? parsed.filter : 0), response = Kernel.respond(maps, parsed, { setpoint: 1, until: times[times.length - 1] + 1e-9 });
    let apart = 0;
    times.forEach((t, i) => { apart = Math.max(apart, Math.abs(response.y(Math.min(t, response.end * (1 - 1e-15))) - output[i])); });
    const run = measure(prepared, parsed);
    for (const [name, value] of Object.entries(metrics)) apart = Math.max(apart, Math.abs(run[name] - value) / Math.max(1, Math.abs(value)));
    return apart;
  }
  const apart = selfTest();
  say("agreement", apart < 1e-7 ? `This page agrees with the report to ${shown(apart, 1).replace("−", "-")}.` : `Warning: this browser's numbers differ from the report's by ${shown(apart, 2)}; do not trust them.`);

  window.addEventListener("hashchange", fromAddress);
  fromAddress();
  window.whatif = { state, measure, python };
})();
