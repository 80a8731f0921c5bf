// Loops other than drawn: a control signal with limits, a plant that is off.

import { CONSTANTS } from "./data.js";
import { dot, NODES, nodes } from "./chebyshev.js";
import { prepare } from "./loop.js";
import { closedRate, pieceMap, spaceOf } from "./response.js";

// A loop with limits, in small steps, between which signals are lines. Nothing where it is too fast.
export function limited(plant, controller, limit, antiWindup, end, steps = CONSTANTS.atRest.steps) {
  const { k, ki, kd, b, c, filter, prefilter } = controller, { order: n, deadTime } = plant, { A, B, C, D } = spaceOf(plant), delay = deadTime ? Math.ceil(steps * deadTime / end) : 0;
  const dt = deadTime ? deadTime / delay : end / Math.max(steps, Math.ceil(5 * end * closedRate(plant, controller))), count = Math.ceil(end / dt);
  if (!(count < 30000)) return null;
  // from (state, input before, input after) to the state after a step
  const stepped = (map, size) => map.slice(NODES * size).map((row) => [...row.slice(0, size), ...[-1, 1].map((side) => nodes.reduce((sum, node, j) => sum + row[size + j] * (1 + side * node) / 2, 0))]);
  const plantStep = stepped(pieceMap(A, B, dt), n), lag = filter || dt, [lagStep] = stepped(pieceMap([[-1 / lag]], [1 / lag], dt), 1);
  const time = kd && ki ? Math.sqrt(Math.abs(kd / ki)) : Math.abs(k / ki), pull = antiWindup && ki ? dt / 2 / Math.max(time, dt) : 0; // as in replicate.loops
  const clamped = (v) => Math.min(limit, Math.max(-limit, v)), used = [], output = [], control = [];
  let x = new Float64Array(n), y = 0, integral = 0, before = { error: 0, lagged: 0, acted: 0, off: 0 };
  for (let i = 0; i <= count; i++) {
    const r = prefilter ? -Math.expm1(-i * dt / prefilter) : 1, input = (j) => used[j] ?? 0;
    let now, state = x;
    for (let pass = 0; pass < (delay ? 1 : 3); pass++) { // without dead time the input afterwards is that of the pass before
      const after = delay ? input(i - delay) : now?.u ?? input(i - 1);
      if (i) state = plantStep.map((row) => dot(row, [...x, input(i - 1 - delay), i === delay ? 0 : after])); // u jumps at the start
      y = dot(C, state) + D * after;
      const acted = y - c * r, lagged = i ? dot(lagStep, [before.lagged, before.acted, acted]) : 0, error = r - y;
      const part = k * (b * r - y) - (kd ? kd * (acted - lagged) / lag : 0), base = i ? integral + ki * dt / 2 * (before.error + error) + pull * before.off : 0;
      const free = part + base, v = clamped(free) === free || !i ? free : part + (base + pull * (clamped(free) - part)) / (1 + pull);
      now = { error, acted, lagged, u: clamped(v), off: clamped(v) - v, integral: v - part };
    }
    x = state;
    ({ integral } = now);
    before = now;
    used.push(now.u);
    if (i % Math.ceil(count / 1000) === 0) { output.push([i * dt, y]); control.push([i * dt, now.u]); }
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
