// How many closed-loop poles lie in the right half plane, by the argument principle; NaN where numbers lie too far apart.

import { CONSTANTS } from "./data.js";
import { divide, onAxis, sizes, times } from "./polynomials.js";
import { characteristic, quietFrom } from "./loop.js";

export function unstablePoles(plant, controller) {
  const { free, delayed, corners } = characteristic(plant, controller);
  const degree = free.length - 1, delay = plant.deadTime;
  // |L| does not fall below one at high frequencies
  if (delayed.length > free.length || (delayed.length === free.length && delay > 0 && Math.abs(delayed[0]) >= Math.abs(free[0]))) return Infinity;
  const value = (w) => {
    const [fr, fi] = onAxis(free, w), [dr, di] = times(onAxis(delayed, w), [Math.cos(w * delay), -Math.sin(w * delay)]);
    return [fr + dr, fi + di];
  };
  // Beyond `end` the argument can be read off the leading terms.
  const scales = [...sizes(corners), 1 / delay].filter(Number.isFinite), far = delayed.length === free.length ? Math.abs(delayed[0] / free[0]) : 0;
  const loud = (w) => Math.hypot(...divide(onAxis(delayed, w), onAxis(free, w))) > 0.25 * (1 + 3 * far);
  const guess = 4 * Math.max(1e-9, ...scales), quiet = quietFrom(loud, guess), end = 4 * Math.max(guess, quiet);
  if (!(quiet * delay < 10 * CONSTANTS.mostTurns && Math.max(quiet, ...scales) < CONSTANTS.farApart * Math.min(...scales))) return NaN;
  const turned = (from, to) => { const [re, im] = divide(to, from); return Math.atan2(im, re); };
  let total = 0, w = 0, here = value(0), step = Math.min(...scales, end) / 8;
  while (w < end) {
    const next = Math.min(w + step, end), there = value(next), middle = value((w + next) / 2), turn = turned(here, there);
    if ((Math.abs(turn) > 0.8 || Math.abs(turn - turned(here, middle) - turned(middle, there)) > 1e-6) && step > 1e-13 * end) { step /= 2; continue; }
    total += turn;
    w = next;
    here = there;
    if (Math.abs(turn) < 0.3) step *= 1.6;
  }
  return Math.round(degree / 2 - total / Math.PI);
}

export const isStable = (plant, controller) => unstablePoles(plant, controller) === 0;
