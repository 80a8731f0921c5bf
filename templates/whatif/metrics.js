// What is read from a response.

import { CONSTANTS } from "./data.js";
import { apply, COUNT, differentiate, floats, integrate, interpolate, NODES, root, nodes } from "./chebyshev.js";
import { unstablePoles } from "./poles.js";
import { responder } from "./response.js";
import { margins } from "./margins.js";

// Ends of pieces and extrema between them, in order: {t, value, piece, s}; from one to the next a signal rises or falls.
function outline(signals, values) {
  const points = [], slope = floats(COUNT), bend = floats(COUNT), at = (s) => interpolate(slope, s);
  values.forEach((piece, number) => {
    apply(differentiate, piece, slope);
    apply(differentiate, slope, bend);
    const add = (s) => points.push({ t: signals.starts[number] + (s + 1) / 2 * signals.lengths[number], value: interpolate(piece, s), piece: number, s });
    add(-1);
    for (let j = 0; j < NODES; j++) {
      const a = nodes[j], c = nodes[j + 1];
      if (slope[j] * slope[j + 1] < 0) add(root(at, a, c));
      else if (j && slope[j] === 0) add(a);
      else if (bend[j] * bend[j + 1] < 0 && bend[j] * slope[j] < 0) { // two extrema between two nodes
        const between = root((s) => interpolate(bend, s), a, c);
        if (at(between) * slope[j] < 0) { add(root(at, a, between)); add(root(at, between, c)); }
      }
    }
    add(1);
  });
  return points;
}

// Where the output has a level between two points of its outline, one below and one above it.
function passes({ starts, lengths, output }, level, one, other) {
  if (one.piece !== other.piece) return other;
  const s = root((x) => interpolate(output[one.piece], x) - level, one.s, other.s);
  return { s, piece: one.piece, t: starts[one.piece] + (s + 1) / 2 * lengths[one.piece] };
}

function overshoot(points, final) {
  const peak = points.reduce((most, point) => (point.value / final > most.value / final ? point : most));
  return { overshoot: Math.max(0, peak.value / final - 1), peakTime: peak.t };
}

// The last time at which the output enters the band; NaN where it has not come to rest.
function settlingTime(signals, points, final, band) {
  const far = ({ value }) => Math.abs(value - final) > band, last = points.findLastIndex(far);
  if (last < 0 || last === points.length - 1) return last < 0 ? 0 : NaN;
  return passes(signals, points[last].value > final ? final + band : final - band, points[last], points[last + 1]).t;
}

// The first time at which the output reaches a level; NaN if it does not.
function reaches(signals, points, level) {
  const i = points.findIndex((point, j) => j && (points[j - 1].value - level) * (point.value - level) <= 0 && point.value !== points[j - 1].value);
  return i < 0 ? NaN : passes(signals, level, points[i - 1], points[i]).t;
}

// The integral of |final - y|.
function absoluteError(signals, points, final) {
  const crossed = (one, other) => one.piece === other.piece && (one.value - final) * (other.value - final) < 0;
  let total = 0, sum, from;
  for (const { piece, s } of points.flatMap((point, i) => (i && crossed(points[i - 1], point) ? [passes(signals, final, points[i - 1], point), point] : [point]))) {
    if (s === -1) [sum, from] = [apply(integrate, signals.output[piece].map((value) => value - final)), 0];
    const to = interpolate(sum, s);
    total += Math.abs(to - from) * signals.lengths[piece] / 2;
    from = to;
  }
  return total;
}

// Jumps count with their height, the first one from zero.
const totalVariation = (points) => points.reduce((total, { value }, i) => total + Math.abs(value - (i ? points[i - 1].value : 0)), 0);

// All that the page says of a loop; `effort` is {settle, pieces} of a response.
export function measure(plant, controller, effort = CONSTANTS.atRest) {
  const unstable = unstablePoles(plant, controller);
  if (unstable !== 0) return { stable: false, unstable };
  const { k, ki, b } = controller, stiff = k + plant.den.at(-1) / plant.num.at(-1), final = ki ? 1 : b * k / stiff, finalLoad = ki ? 0 : 1 / stiff;
  const respond = responder(plant, controller);
  const step = respond({ effort, final }), load = respond({ effort, setpoint: 0, load: 1, final: finalLoad });
  const y = outline(step, step.output), d = outline(load, load.output);
  const ten = reaches(step, y, 0.1 * final), ninety = reaches(step, y, 0.9 * final);
  const largest = d.reduce((most, { value }) => Math.max(most, Math.abs(value - finalLoad)), 0);
  const run = {
    stable: true, final, step, load, ten, ninety, rise: ninety - ten, ...overshoot(y, final),
    settling: settlingTime(step, y, final, CONSTANTS.band * Math.abs(final || 1)), iae: absoluteError(step, y, final), loadIae: absoluteError(load, d, finalLoad),
    variation: totalVariation(outline(step, step.control)), loadQuiet: d.findLast(({ value }) => Math.abs(value - finalLoad) > largest / 30)?.t ?? 0, ...margins(plant, controller),
  };
  // What has not come to rest in time has no such numbers.
  if (step.pieces >= effort.pieces) for (const name of ["settling", "iae", "variation"]) run[name] = NaN;
  if (load.pieces >= effort.pieces) run.loadIae = NaN;
  return run;
}
