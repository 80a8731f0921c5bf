// Loops that are not as drawn: a control signal with limits, a plant that is off.
// Responses of a loop whose control signal is limited: small steps in time, so only as exact as a line is wide. Nothing
// where the plant is too fast for such steps.

import { fastest, prepare } from "./loop.js";

export function limited(plant, controller, limit, antiWindup, end) {
  const n = plant.order, direct = plant.num.length > n ? plant.num[0] : 0, fast = end * fastest(plant.poles), count = Math.max(4000, Math.ceil(fast));
  if (count > 60000) return null;
  const dt = end / count, delay = Math.round(plant.deadTime / dt), every = Math.ceil(count / 1000);
  const x = new Float64Array(n), history = new Float64Array(count + delay + 1), output = [], control = [];
  let integral = 0, lagged = 0;
  const { k, ki, kd, b, c, filter, prefilter } = controller, lag = Math.max(filter, 2 * dt), tracking = ki ? Math.max(Math.abs(k / ki), dt) : 1;
  const rate = (z, v) => {
    const d = new Float64Array(n);
    for (let j = 0; j < n - 1; j++) d[j] = z[j + 1];
    d[n - 1] = v;
    for (let j = 0; j < n; j++) d[n - 1] -= plant.den[n - j] * z[j];
    return d;
  };
  for (let i = 0; i <= count; i++) {
    const r = prefilter ? -Math.expm1(-i * dt / prefilter) : 1;
    let y = direct * history[i];
    for (let j = 0; j < n; j++) y += ((plant.num.at(-1 - j) || 0) - direct * plant.den.at(-1 - j)) * x[j];
    const slope = kd ? (y - c * r - lagged) / lag : 0, wanted = k * (b * r - y) + integral - kd * slope;
    const u = Math.min(limit, Math.max(-limit, wanted));
    if (i % every === 0) { output.push([i * dt, y]); control.push([i * dt, u]); }
    integral += dt * (ki * (r - y) + (antiWindup ? (u - wanted) / tracking : 0));
    lagged += dt * slope;
    history[i + delay] = u;
    // the plant in controllable form, a step of the midpoint rule
    const first = rate(x, history[i]), middle = rate(x.map((value, j) => value + dt / 2 * first[j]), history[i]);
    for (let j = 0; j < n; j++) x[j] += dt * middle[j];
  }
  return { output, control };
}

// Plants whose gain, time constants and dead time are off by a fraction.
export function mismatched(plant, fraction) {
  if (plant.cloud?.fraction !== fraction) {
    const sides = [1 - fraction, 1 + fraction], slowed = (p, time, gain = 1) => p.map((a, i) => gain * a * Math.pow(time, p.length - 1 - i));
    const plants = sides.flatMap((gain) => sides.flatMap((time) => sides.map((delay) => prepare({ den: slowed(plant.den, time), num: slowed(plant.num, time, gain), deadTime: plant.deadTime * delay }))));
    plant.cloud = { fraction, plants };
  }
  return plant.cloud.plants;
}
