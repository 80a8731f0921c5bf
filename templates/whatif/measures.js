// What the page says of a loop: responses, metrics, margins; a limited actuator, a wrong model; tuning rules.
"use strict";

const Measures = (() => {
function measure(plant, controller) {
  const unstable = Kernel.unstablePoles(plant, controller);
  if (unstable !== 0) return { stable: false, unstable };
  const maps = Kernel.mapsOf(plant, controller.kd ? controller.filter : 0);
  const p0 = plant.num.at(-1) / plant.den.at(-1), { k, ki, b } = controller, at0 = Number.isFinite(p0);
  const final = ki ? 1 : at0 ? b * p0 * k / (1 + p0 * k) : b, finalLoad = ki ? 0 : at0 ? p0 / (1 + p0 * k) : 1 / k;
  const step = Kernel.respond(maps, controller, { setpoint: 1, load: 0, settle: 1e-11, final });
  const load = Kernel.respond(maps, controller, { setpoint: 0, load: 1, settle: 1e-11, final: finalLoad });
  const rise = Kernel.reaches(step, 0.9 * final) - Kernel.reaches(step, 0.1 * final);
  const run = {
    stable: true, final, finalLoad, step, load, rise,
    ...Kernel.overshoot(step, final), settling: Kernel.settlingTime(step, final, 0.02),
    iae: Kernel.absoluteError(step, final), loadIae: Kernel.absoluteError(load, finalLoad),
    variation: Kernel.totalVariation(step), loadQuiet: quietAfter(load, finalLoad), ...Kernel.margins(plant, controller),
  };
  // What has not come to rest in time has no such numbers.
  if (step.pieces >= Kernel.MOST_PIECES) for (const name of ["settling", "iae", "variation"]) run[name] = NaN;
  if (load.pieces >= Kernel.MOST_PIECES) run.loadIae = NaN;
  return run;
}

// When a load has been worked off, but for a thirtieth of its largest effect.
function quietAfter(response, final) {
  const largest = response.output.reduce((most, y) => Math.max(most, Math.abs(y - final)), 0), step = Kernel.NODES + 1;
  let piece = response.pieces - 1;
  while (piece > 0 && response.output.slice(piece * step, (piece + 1) * step).every((y) => Math.abs(y - final) < largest / 30)) piece--;
  return (piece + 1) * response.h;
}

// Responses of a loop whose control signal is limited: small steps in time, so only as exact as a line is wide. Nothing
// where the plant is too fast for such steps.
function limited(plant, controller, limit, antiWindup, end) {
  const n = plant.order, fast = end * Kernel.fastest(plant.poles), count = Math.max(4000, Math.ceil(fast));
  if (count > 60000) return null;
  const dt = end / count, delay = Math.round(plant.deadTime / dt), every = Math.ceil(count / 1000);
  const x = new Float64Array(n), history = new Float64Array(count + delay + 1), output = [], control = [];
  let integral = 0, lagged = 0;
  const { k, ki, kd, b, filter } = controller, lag = Math.max(filter, 2 * dt), tracking = ki ? Math.max(Math.abs(k / ki), dt) : 1;
  const rate = (z, v) => {
    const d = new Float64Array(n);
    for (let j = 0; j < n - 1; j++) d[j] = z[j + 1];
    d[n - 1] = v;
    for (let j = 0; j < n; j++) d[n - 1] -= plant.den[n - j] * z[j];
    return d;
  };
  for (let i = 0; i <= count; i++) {
    let y = 0;
    for (let j = 0; j < plant.num.length; j++) y += plant.num[plant.num.length - 1 - j] * x[j];
    const slope = kd ? (y - lagged) / lag : 0, wanted = k * (b - y) + integral - kd * slope;
    const u = Math.min(limit, Math.max(-limit, wanted));
    if (i % every === 0) { output.push([i * dt, y]); control.push([i * dt, u]); }
    integral += dt * (ki * (1 - y) + (antiWindup ? (u - wanted) / tracking : 0));
    lagged += dt * slope;
    history[i + delay] = u;
    // the plant in controllable form, a step of the midpoint rule
    const first = rate(x, history[i]), middle = rate(x.map((value, j) => value + dt / 2 * first[j]), history[i]);
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

// PI settings of rules for K e^{-Ls}/(Ts + 1) and K e^{-Ls}/s, as in replicate.loops.tune.
function rules({ num, den, deadTime: L }) {
  if (den.length !== 2 || num.length !== 1 || !(L > 0) || den[1] < 0) return [];
  const lags = den[1] > 0, T = lags ? 1 / den[1] : 1, slope = num[0]; // slope is K/T
  const pi = (name, k, ti) => ({ name, k, ki: k / ti, kd: 0 });
  return [
    pi("SIMC", 1 / (2 * L * slope), lags ? Math.min(T, 8 * L) : 8 * L),
    lags ? pi("AMIGO", (0.15 * L + (0.35 - L * T / (L + T) ** 2) * T) / (slope * T * L), 0.35 * L + 13 * L * T * T / (T * T + 12 * L * T + 7 * L * L))
      : pi("AMIGO", 0.35 / (slope * L), 13.4 * L),
    pi("ZN", 0.9 / (slope * L), L / 0.3),
  ];
}

return { measure, limited, mismatched, rules };
})();
