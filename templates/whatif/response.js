// Exact responses by the method of steps of replicate.loops: pieces end where jumps return after each dead time, double
// where the solution is smooth, also beyond the dead time, and are halved where it is not.

import { CONSTANTS } from "./data.js";
import { apply, COUNT, differentiate, dot, floats, identity, integrate, interpolate, NODES, product, solve, table, tail, nodes } from "./chebyshev.js";
import { add, roots, sizes } from "./polynomials.js";
import { characteristic, fastest } from "./loop.js";

const { rounding: ROUNDING, laps: LAPS } = CONSTANTS;

// Output and control signal, as values at the nodes of each piece.
class Signals {
  starts = []; lengths = []; output = []; control = []; end = 0;

  get pieces() { return this.starts.length; }

  // The piece that holds a time; of two, the later one.
  piece(t) { return Math.max(0, this.starts.findLastIndex((start) => start <= t)); }

  // A signal at a time, in the piece that holds it; after the end its last value.
  at(signal, t, piece = this.piece(t)) { return interpolate(signal[piece], Math.min(1, 2 * (t - this.starts[piece]) / this.lengths[piece] - 1)); }
}

// x' = A x + B v, y = C x + D v in controllable form, time scaled so that coefficients are near one.
function stateSpace({ order: n, num, den, poles }) {
  const all = sizes(poles), scale = all.length ? Math.exp(all.reduce((sum, size) => sum + Math.log(size), 0) / all.length) : 1;
  const scaled = (value, j) => value * Math.pow(scale, j - n + 1), D = num.length > n ? num[0] : 0;
  const A = table(n, n, (i, j) => (i === n - 1 ? scaled(-den[n - j], j) : j === i + 1 ? scale : 0));
  const C = A.map((_, j) => scaled((num.at(-1 - j) || 0) - D * den.at(-1 - j), j));
  return { A, B: A.map((_, i) => Number(i === n - 1)), C, D };
}

export const spaceOf = (plant) => (plant.space ||= stateSpace(plant));

// For a piece of length h: from (states at its start, input at the nodes) to state a at node i in row i n + a.
export function pieceMap(A, B, h) {
  const n = A.length;
  if (!n) return [];
  const matrix = table(COUNT * n, COUNT * n, (row, column) => Number(row === column) - h / 2 * integrate[Math.floor(row / n)][Math.floor(column / n)] * A[row % n][column % n]);
  return solve(matrix, table(COUNT * n, n + COUNT, (row, column) => (column < n ? Number(row % n === column) : h / 2 * integrate[Math.floor(row / n)][column - n] * B[row % n])));
}

// What does not depend on the controller: maps to the output at the nodes and the states at the end; where the control
// signal returns inside the piece, also from it to input and output.
function mapsOf(plant, length, ticks, unit) {
  plant.maps ||= new Map();
  const h = length * unit;
  if (plant.maps.has(h)) return plant.maps.get(h);
  const { A, B, C, D } = spaceOf(plant), n = plant.order, map = pieceMap(A, B, h);
  const toOutput = table(COUNT, n + COUNT, (i, column) => C.reduce((sum, c, a) => sum + c * map[i * n + a][column], column === n + i ? D : 0));
  const made = { toOutput, toState: map.slice(NODES * n) };
  if (length > ticks) {
    const units = identity();
    made.returned = table(COUNT, COUNT, (i, j) => (returns(nodes[i], length, ticks) ? interpolate(units[j], nodes[i] - 2 * ticks / length) : 0));
    made.outputs = product(toOutput, made.returned, n);
  }
  plant.maps.set(h, made);
  return made;
}

// How far a node of a piece lies beyond the return of the piece's start, in ticks.
const ahead = (node, length, ticks) => (node + 1) / 2 * length - ticks;
const returns = (node, length, ticks) => !ticks || ahead(node, length, ticks) > 0;

// The fastest pole of a loop without dead time, to a few per cent.
export function closedRate(plant, controller) {
  const { free, delayed } = characteristic(plant, controller);
  return fastest(roots(add(free, delayed), 0.01));
}

// A function that gives the response of a loop to steps of set-point and load, from rest.
// `effort` is {pieces: at most, settle: without `until`, how small what is left of the way to `final` must be}.
export function responder(plant, controller) {
  const { k, ki, kd, b, c, prefilter } = controller, lag = kd ? controller.filter : 0, { deadTime: delay, order: n } = plant;
  const slow = Math.max(fastest(plant.poles), lag && 1 / lag, prefilter && 1 / prefilter, 1e-12);
  const rate = delay ? slow : 2 ** Math.ceil(Math.log2(Math.max(2 * closedRate(plant, controller), slow / 2))); // few lengths, known maps
  const ticks = delay ? 2 ** Math.max(0, Math.ceil(Math.log2(delay * rate / CONSTANTS.decayPerPiece))) : 0; // of a dead time
  const unit = delay ? delay / ticks : CONSTANTS.decayPerPiece / rate;
  const growth = Math.max(0, ...plant.poles.map(([re]) => re)) * unit; // of the plant in a tick: its maps must not
  const known = new Map();

  // Maps of a piece of so many ticks in the closed loop; the filter's is from (its state, output) to its states.
  function closed(length) {
    if (known.has(length)) return known.get(length);
    const h = length * unit, maps = { ...mapsOf(plant, length, ticks, unit), lag: lag && pieceMap([[-1 / lag]], [1 / lag], h) };
    maps.slope = table(COUNT, COUNT, (i, j) => kd * (lag ? (Number(i === j) - maps.lag[i][1 + j]) / lag : differentiate[i][j] * 2 / h));
    maps.feedback = table(COUNT, COUNT, (i, j) => (i === j ? k : 0) + ki * h / 2 * integrate[i][j] + maps.slope[i][j]);
    if (maps.returned) {
      const matrix = product(maps.feedback, maps.outputs);
      matrix.forEach((row, i) => { row[i] += 1; });
      maps.inverse = solve(matrix, identity());
    }
    known.set(length, maps);
    return maps;
  }

  return function respond({ setpoint = 1, load = 0, until = Infinity, final = setpoint, effort = CONSTANTS.atRest }) {
    const signals = new Signals(), { starts, lengths, output, control } = signals;
    const [reference, summed, jumps, free, input, back] = Array.from({ length: 6 }, () => floats(COUNT));
    let state = floats(n), integral = 0, lagged = 0, tick = 0, length = 1, wait = 0, quietSince = 0, largest = 1e-300, early = ticks > 0;
    // The input of a piece at a node, but for what its own control signal adds.
    function inputAt(node, size, i) {
      const then = tick + ahead(node, size, ticks);
      if (ticks && (then < 0 || (then === 0 && i))) return 0;
      if (returns(node, size, ticks)) return load;
      let piece = signals.piece(then * unit);
      if (i === NODES && piece && starts[piece] >= then * unit) piece--;
      return load + signals.at(control, then * unit, piece);
    }
    while (signals.pieces < effort.pieces && signals.end < until * (1 - 1e-12)) {
      const maps = closed(length), h = length * unit, y = floats(COUNT), u = floats(COUNT);
      const respondTo = () => { apply(maps.toOutput, state, y); apply(maps.toOutput, input, y, n, true); apply(maps.feedback, y, back); };
      // u = free - feedback y, where free is known from the start of the piece
      for (let i = 0; i < COUNT; i++) reference[i] = setpoint * (prefilter ? -Math.expm1(-(tick * unit + h / 2 * (nodes[i] + 1)) / prefilter) : 1);
      apply(integrate, reference, summed);
      if (c) apply(maps.slope, reference, jumps);
      for (let i = 0; i < COUNT; i++) free[i] = k * b * reference[i] + ki * (integral + h / 2 * summed[i]) + c * jumps[i] + (lag ? kd / lag * maps.lag[i][0] * lagged : 0);
      for (let i = 0; i < COUNT; i++) input[i] = inputAt(nodes[i], length, i);
      respondTo();
      if (maps.inverse) {
        for (let i = 0; i < COUNT; i++) back[i] = free[i] - back[i];
        apply(maps.inverse, back, u);
        apply(maps.returned, u, input, 0, true);
        respondTo();
      }
      for (let i = 0; i < COUNT; i++) u[i] = free[i] - back[i];
      let here = 0;
      for (const value of y) here = Math.max(here, Math.abs(value - final));
      largest = Math.max(largest, here);
      if (length > 1 && (tail(y) > ROUNDING * largest || tail(u) > ROUNDING * Math.max(largest, Math.abs(u[0])))) { // again, in smaller pieces
        length /= 2;
        wait = 4;
        continue;
      }
      output.push(y);
      control.push(u);
      state = apply(maps.toState, input, apply(maps.toState, state), n, true);
      integral += h / 2 * (summed[NODES] - dot(integrate[NODES], y));
      if (lag) lagged = maps.lag[NODES][0] * lagged + dot(maps.lag[NODES], y, 1) - c * dot(maps.lag[NODES], reference, 1);
      starts.push(tick * unit);
      lengths.push(h);
      tick += length;
      signals.end = tick * unit;
      if (!Number.isFinite(here) || here > 1e12 * Math.max(1, Math.abs(setpoint))) break;
      if (here > effort.settle * largest) quietSince = signals.end;
      if (until === Infinity && signals.end > 1.05 * quietSince + 3 * Math.max(delay, unit)) break;
      // While jumps can be seen, pieces end where they return, at whole dead times, and small ones follow; later one piece
      // tries to hold all until the next return.
      if (tick > LAPS * ticks && length >= ticks) early = false;
      if (early && tick % ticks === 0) length = tick < LAPS * ticks ? 1 : ticks;
      else if (--wait < 0 && (!early || tick % (2 * length) === 0) && growth * length < 2) length *= 2;
    }
    return signals;
  };
}
