// Ms, gain, phase and delay margin of a stable loop, with their frequencies.

import { CONSTANTS } from "./data.js";
import { root } from "./chebyshev.js";
import { sizes } from "./polynomials.js";
import { characteristic, loopAt, quietFrom } from "./loop.js";

// Frequencies dense enough for every resonance and turn of the dead time, up to where |L| stays small, and from where on
// |L| only falls.
export function grid(plant, controller, floor) {
  const { corners } = characteristic(plant, controller), turn = 1 / plant.deadTime, w = [];
  const { k, ki } = controller, slow = [ki / k, ki * plant.num.at(-1) / plant.den.at(-1)].map(Math.abs);
  const all = [...sizes(corners), ...slow, turn].filter((x) => x > 0 && x < Infinity), falls = Math.max(...all) * 4;
  const quiet = quietFrom((x) => Math.hypot(...loopAt(plant, controller, x)) > floor, falls);
  const high = plant.deadTime ? Math.min(quiet + 2.5 * Math.PI * turn, CONSTANTS.mostTurns * turn) : Math.max(quiet, falls);
  for (let x = Math.min(...all) / 1e3; x < high; x += Math.min(x * 0.03, 0.12 * turn)) w.push(x);
  w.push(high);
  for (const [re, im] of corners) {
    const width = Math.max(Math.abs(re), 1e-4 * im), gap = (j) => Math.sinh(j / 20) * width;
    if (im > 2 * width) for (let j = 0.5; gap(j) < 0.3 * im; j++) w.push(im - gap(j), im + gap(j));
  }
  return { w: Float64Array.from(w.filter((x) => x > 0)).sort(), falls };
}

const SHIFT = 1e-6; // about a peak

export function margins(plant, controller) {
  const { w, falls } = grid(plant, controller, 0.05), at = (x) => loopAt(plant, controller, x);
  const { k, kd, filter } = controller, direct = plant.relativeDegree ? 0 : Math.abs(plant.num[0] * (kd ? k + kd / filter : k));
  const size = ([re, im]) => 1 / Math.hypot(1 + re, im), least = { gain: [direct ? 1 / direct : Infinity], phase: [Infinity], delay: [Infinity] };
  const found = (name, value, x) => { if (value < least[name][0]) least[name] = [value, x]; };
  const atOnce = kd && !filter && plant.relativeDegree < 2; // |S| does not tend to one
  let ms = atOnce ? 0 : 1 / (1 - direct), msAt = NaN;
  const peak = (value, x) => { if (value > ms) [ms, msAt] = [value, x]; };
  if (!controller.ki) {
    const still = k * plant.num.at(-1) / plant.den.at(-1); // L(0)
    peak(1 / Math.abs(1 + still), 0);
    if (still < 0 && still > -1) found("gain", -1 / still, 0);
  }
  for (let i = 0, before = null, here = at(w[0]), next; i < w.length; i++, before = here, here = next) {
    next = i + 1 < w.length ? at(w[i + 1]) : here;
    const [re, im] = here, [nextRe, nextIm] = next, loud = Math.max(Math.hypot(re, im), direct);
    if (w[i] > falls && loud < 1 && 1 / (1 - loud) <= ms && least.gain[0] <= 1 / loud) break; // what follows is less
    if (before && size(here) >= size(before) && size(here) >= size(next)) {
      const x = root((y) => size(at(y * (1 + SHIFT))) - size(at(y * (1 - SHIFT))), w[i - 1], w[i + 1] || w[i]);
      for (const y of [w[i], x]) peak(size(at(y)), y);
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
  }
  const { gain: [gain, gainAt], phase: [phase, phaseAt], delay: [delay] } = least;
  return { ms, msAt, gain, gainAt, phase, phaseAt, delay };
}
