// Sensitivity peak, gain, phase and delay margin of a stable loop.

import { CONSTANTS } from "./data.js";
import { root } from "./chebyshev.js";
import { sizes } from "./polynomials.js";
import { characteristic, loopAt } from "./loop.js";

// Frequencies dense enough for every resonance and turn of the dead time, up to where |L| stays small.
export function grid(plant, controller, floor) {
  const { corners } = characteristic(plant, controller);
  const turn = 1 / plant.deadTime, all = [...sizes(corners), Math.abs(controller.ki / controller.k), turn].filter((x) => x > 0 && x < Infinity), w = [];
  let high = Math.max(...all) * 4;
  const loud = (x) => Math.hypot(...loopAt(plant, controller, x)) > floor;
  for (let i = 0; i < 400 && loud(high); i++) high *= 1.3;
  for (let i = 0; plant.deadTime && i < 200 && !loud(high / 1.3); i++) high /= 1.3;
  if (plant.deadTime) high = Math.min(high + 2.5 * Math.PI * turn, CONSTANTS.mostTurns * turn);
  for (let x = Math.min(...all) / 1e3; x < high; x += Math.min(x * 0.03, 0.12 * turn)) w.push(x);
  w.push(high);
  for (const [re, im] of corners) {
    const centre = Math.abs(im), width = Math.max(Math.abs(re), 1e-9 * centre);
    if (centre > 2 * width) for (let j = -24; j <= 24; j++) w.push(centre + Math.sinh(j / 4) * width);
  }
  return Float64Array.from(w.filter((x) => x > 0)).sort();
}

function golden(f, a, c) {
  const ratio = (Math.sqrt(5) - 1) / 2;
  let x1 = c - ratio * (c - a), x2 = a + ratio * (c - a), f1 = f(x1), f2 = f(x2);
  for (let i = 0; i < 70 && c - a > 1e-10 * c; i++) {
    if (f1 > f2) { c = x2; x2 = x1; f2 = f1; x1 = c - ratio * (c - a); f1 = f(x1); }
    else { a = x1; x1 = x2; f1 = f2; x2 = a + ratio * (c - a); f2 = f(x2); }
  }
  return f1 > f2 ? x1 : x2;
}

// Ms, gain, phase and delay margin, with their frequencies; of a stable loop.
export function margins(plant, controller) {
  const w = grid(plant, controller, 0.05), at = (x) => loopAt(plant, controller, x), loop = Array.from(w, at);
  const size = ([re, im]) => 1 / Math.hypot(1 + re, im), least = { gain: [Infinity], phase: [Infinity], delay: [Infinity] };
  const found = (name, value, x) => { if (value < least[name][0]) least[name] = [value, x]; };
  const direct = plant.relativeDegree ? 0 : Math.abs(plant.num[0] * controller.k); // |L| far out
  const atOnce = controller.kd && !controller.filter && plant.relativeDegree < 2; // |S| does not tend to one
  let ms = atOnce ? 0 : 1 / (1 - direct), msAt = NaN;
  const peak = (value, x) => { if (value > ms) [ms, msAt] = [value, x]; };
  if (!controller.ki) {
    const still = controller.k * plant.num.at(-1) / plant.den.at(-1); // L(0)
    peak(1 / Math.abs(1 + still), 0);
    if (still < 0 && still > -1) found("gain", -1 / still, 0);
  }
  loop.forEach((one, i) => {
    const [re, im] = one, [nextRe, nextIm] = loop[i + 1] || one;
    if (i && size(one) >= size(loop[i - 1]) && size(one) >= size([nextRe, nextIm]) && size(one) > 0.9 * ms) {
      const x = golden((y) => size(at(y)), w[i - 1], w[i + 1] || w[i]);
      peak(size(at(x)), x);
    }
    if (im * nextIm < 0 && re + nextRe < 0) {
      const x = root((y) => at(y)[1], w[i], w[i + 1]), value = -1 / at(x)[0];
      if (value > 1) found("gain", value, x);
    }
    if ((Math.hypot(re, im) < 1) !== (Math.hypot(nextRe, nextIm) < 1)) {
      const x = root((y) => Math.log(Math.hypot(...at(y))), w[i], w[i + 1]), [a, c] = at(x), lag = (Math.atan2(-c, -a) + 2 * Math.PI) % (2 * Math.PI);
      found("phase", lag * 180 / Math.PI, x);
      found("delay", lag / x, x);
    }
  });
  const { gain: [gain, gainAt], phase: [phase, phaseAt], delay: [delay] } = least;
  return { ms, msAt, gain, gainAt, phase, phaseAt, delay };
}
