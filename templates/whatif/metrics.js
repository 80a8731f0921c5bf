// What is read from a response: overshoot, settling and rise time, integrals of the error, total variation.

import { CONSTANTS } from "./data.js";
import { COUNT, differentiate, dot, integrate, interpolate, NODES, root, nodes } from "./chebyshev.js";
import { unstablePoles } from "./poles.js";
import { responder } from "./response.js";
import { margins } from "./margins.js";

// Ends of pieces and extrema of a signal between them, in order: {t, value, piece, s}; between two of a piece it rises or falls.
function outline(signals, values) {
  const points = [], derivative = (from, offset) => differentiate.map((row) => dot(row, from, COUNT, 0, offset));
  for (let piece = 0; piece < signals.pieces; piece++) {
    const offset = piece * COUNT, slope = derivative(values, offset), bend = derivative(slope, 0), at = (s) => interpolate(slope, 0, s);
    const add = (s) => points.push({ t: signals.starts[piece] + (s + 1) / 2 * signals.lengths[piece], value: interpolate(values, offset, s), piece, s });
    add(-1);
    for (let j = 0; j < NODES; j++) {
      const a = nodes[j], c = nodes[j + 1];
      if (slope[j] * slope[j + 1] < 0) add(root(at, a, c));
      else if (j && slope[j] === 0) add(a);
      else if (bend[j] * bend[j + 1] < 0 && bend[j] * slope[j] < 0) { // two extrema between two nodes
        const between = root((s) => interpolate(bend, 0, s), a, c);
        if (at(between) * slope[j] < 0) { add(root(at, a, between)); add(root(at, between, c)); }
      }
    }
    add(1);
  }
  return points;
}

// Where a signal has a level between two points of its outline, one below and one above it.
function passes({ starts, lengths }, values, level, one, other) {
  if (one.piece !== other.piece) return other;
  const s = root((x) => interpolate(values, one.piece * COUNT, x) - level, one.s, other.s);
  return { s, piece: one.piece, t: starts[one.piece] + (s + 1) / 2 * lengths[one.piece] };
}

function overshoot(points, final) {
  const peak = points.reduce((most, point) => (point.value / final > most.value / final ? point : most));
  return { overshoot: Math.max(0, peak.value / final - 1), peakTime: peak.t };
}

// The last time at which the output is further from its final value than the band; NaN where it has not come to rest.
function settlingTime(signals, points, final, band) {
  const far = ({ value }) => Math.abs(value - final) > band, last = points.findLastIndex(far);
  if (last < 0 || last === points.length - 1) return last < 0 ? 0 : NaN;
  return passes(signals, signals.output, points[last].value > final ? final + band : final - band, points[last], points[last + 1]).t;
}

// The first time at which the output reaches a level; NaN if it does not.
function reaches(signals, points, level) {
  const i = points.findIndex((point, j) => j && (points[j - 1].value - level) * (point.value - level) <= 0 && point.value !== points[j - 1].value);
  return i < 0 ? NaN : passes(signals, signals.output, level, points[i - 1], points[i]).t;
}

// The integral of |final - y|.
function absoluteError(signals, points, final) {
  let total = 0;
  for (let i = 1, from = points[0].s; i < points.length; i++) {
    const [one, other] = [points[i - 1], points[i]], { piece } = one;
    if (one.piece !== other.piece) { from = other.s; continue; }
    const crossed = (one.value - final) * (other.value - final) < 0, ends = other.s === 1 ? [1] : [];
    if (crossed) ends.unshift(passes(signals, signals.output, final, one, other).s);
    for (const to of ends) {
      const middle = (to + from) / 2, half = (to - from) / 2;
      const sum = nodes.reduce((all, node, j) => all + integrate[NODES][j] * (interpolate(signals.output, piece * COUNT, middle + half * node) - final), 0);
      total += Math.abs(sum) * half * signals.lengths[piece] / 2;
      from = to;
    }
  }
  return total;
}

// Jumps count with their height, the first one from zero.
const totalVariation = (points) => points.reduce((total, { value }, i) => total + Math.abs(value - (i ? points[i - 1].value : 0)), 0);

// All that the page says of a loop.
export function measure(plant, controller) {
  const unstable = unstablePoles(plant, controller);
  if (unstable !== 0) return { stable: false, unstable };
  const p0 = plant.num.at(-1) / plant.den.at(-1), { k, ki, b } = controller, at0 = Number.isFinite(p0);
  const final = ki ? 1 : at0 ? b * p0 * k / (1 + p0 * k) : b, finalLoad = ki ? 0 : at0 ? p0 / (1 + p0 * k) : 1 / k;
  const respond = responder(plant, controller);
  const step = respond({ final }), load = respond({ setpoint: 0, load: 1, final: finalLoad });
  const y = outline(step, step.output), d = outline(load, load.output);
  const ten = reaches(step, y, 0.1 * final), ninety = reaches(step, y, 0.9 * final);
  const largest = d.reduce((most, { value }) => Math.max(most, Math.abs(value - finalLoad)), 0);
  const run = {
    stable: true, final, step, load, ten, ninety, rise: ninety - ten, ...overshoot(y, final),
    settling: settlingTime(step, y, final, 0.02 * Math.abs(final || 1)), iae: absoluteError(step, y, final), loadIae: absoluteError(load, d, finalLoad),
    variation: totalVariation(outline(step, step.control)), loadQuiet: d.findLast(({ value }) => Math.abs(value - finalLoad) > largest / 30)?.t ?? 0, ...margins(plant, controller),
  };
  // What has not come to rest in time has no such numbers.
  if (step.pieces >= CONSTANTS.mostPieces) for (const name of ["settling", "iae", "variation"]) run[name] = NaN;
  if (load.pieces >= CONSTANTS.mostPieces) run.loadIae = NaN;
  return run;
}
