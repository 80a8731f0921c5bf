// Exact responses by a method of steps whose pieces adapt, as in replicate.loops: pieces end where jumps return after each
// dead time, double where the solution is smooth, also beyond the dead time, and are halved where it is not.

import { CONSTANTS } from "./data.js";
import { COUNT, differentiate, dot, floats, identity, integrate, interpolate, lagrange, NODES, product, solve, table, tail, nodes } from "./chebyshev.js";
import { add, roots, sizes } from "./polynomials.js";
import { characteristic, fastest } from "./loop.js";

const MOST_MAPS = 200, ROUNDING = CONSTANTS.rounding;
const LAPS = CONSTANTS.laps; // dead times after which a jump has become too smooth to be seen

class Signals {
  starts = []; lengths = []; output = []; control = []; end = 0;

  get pieces() { return this.starts.length; }

  // The piece that holds a time; of two, the later one.
  piece(t) {
    let low = 0, high = this.pieces;
    while (high - low > 1) { const middle = (low + high) >> 1; if (this.starts[middle] <= t) low = middle; else high = middle; }
    return low;
  }

  at(values, t, piece = this.piece(t)) {
    return interpolate(values, piece * COUNT, 2 * (t - this.starts[piece]) / this.lengths[piece] - 1);
  }
}

// State space in controllable form, time scaled so that the coefficients are near one: x' = A x + B v, y = C x + D v.
function stateSpace({ order: n, num, den, poles }) {
  const all = sizes(poles), scale = all.length ? Math.exp(all.reduce((sum, size) => sum + Math.log(size), 0) / all.length) : 1;
  const scaled = (value, j) => value * Math.pow(scale, j - n + 1), D = num.length > n ? num[0] : 0;
  const A = table(n, n, (i, j) => (i === n - 1 ? scaled(-den[n - j], j) : j === i + 1 ? scale : 0));
  const C = A.map((_, j) => scaled((num.at(-1 - j) || 0) - D * den.at(-1 - j), j));
  return { A, B: A.map((_, i) => Number(i === n - 1)), C, D };
}

export const spaceOf = (plant) => (plant.space ||= stateSpace(plant));

// For a piece of length h: from (states at its start, input at the nodes) to the states at the nodes, row i n + a for
// state a at node i.
export function pieceMap(A, B, h) {
  const n = A.length;
  if (!n) return [];
  const matrix = table(COUNT * n, COUNT * n, (row, column) => Number(row === column) - h / 2 * integrate[Math.floor(row / n)][Math.floor(column / n)] * A[row % n][column % n]);
  return solve(matrix, table(COUNT * n, n + COUNT, (row, column) => (column < n ? Number(row % n === column) : h / 2 * integrate[Math.floor(row / n)][column - n] * B[row % n])));
}

// What does not depend on the gains: maps to the output at the nodes and to the states at the end; where the control
// signal returns inside the piece, what it counts for the input and the output at the nodes; the filter's states.
function mapsOf(plant, length, ticks, unit, lag) {
  plant.maps ||= new Map();
  const h = length * unit, key = [h, lag].join();
  if (plant.maps.has(key)) return plant.maps.get(key);
  const { A, B, C, D } = spaceOf(plant), n = plant.order, map = pieceMap(A, B, h);
  const toOutput = table(COUNT, n + COUNT, (i, column) => (column === n + i ? D : 0));
  toOutput.forEach((row, i) => C.forEach((c, a) => row.forEach((_, column) => { row[column] += c * map[i * n + a][column]; })));
  const made = { toOutput, toState: map.slice(NODES * n), lag: lag ? pieceMap([[-1 / lag]], [1 / lag], h) : null };
  if (length > ticks) {
    made.returned = nodes.map((node) => (returns(node, length, ticks) ? lagrange(node - 2 * ticks / length) : floats(COUNT)));
    made.outputs = product(toOutput, made.returned, n);
  }
  if (plant.maps.size > MOST_MAPS) plant.maps.clear();
  plant.maps.set(key, made);
  return made;
}

// How far a node of a piece lies beyond the return of the piece's start, in ticks.
const ahead = (node, length, ticks) => (node + 1) / 2 * length - ticks;
const returns = (node, length, ticks) => !ticks || ahead(node, length, ticks) > 0;

// A row of a map applied to the states at the start of a piece and the input at its nodes.
const applied = (row, state, input) => dot(row, state) + dot(row, input, COUNT, state.length);

// Of a loop without dead time.
export function closedRate(plant, controller) {
  const { free, delayed } = characteristic(plant, controller);
  return fastest(roots(add(free, delayed)));
}

// A function that gives the response of a loop to steps of set-point and load, from rest.
// options: {setpoint, load, until} or, without until, {settle: how small what is left must be, final}
export function responder(plant, controller) {
  const { k, ki, kd, b, c, prefilter } = controller, lag = kd ? controller.filter : 0, delay = plant.deadTime;
  const slow = Math.max(fastest(plant.poles), lag && 1 / lag, prefilter && 1 / prefilter, 1e-12);
  const rate = delay ? slow : 2 ** Math.ceil(Math.log2(Math.max(2 * closedRate(plant, controller), slow / 2))); // few lengths, known maps
  const ticks = delay ? 2 ** Math.max(0, Math.ceil(Math.log2(delay * rate / CONSTANTS.decayPerPiece))) : 0; // of a dead time
  const unit = delay ? delay / ticks : CONSTANTS.decayPerPiece / rate;
  const growth = Math.max(0, ...plant.poles.map(([re]) => re)) * unit; // of the plant in a tick: its maps must not
  const known = new Map();

  // Maps of a piece of so many ticks in the closed loop.
  function closed(length) {
    if (known.has(length)) return known.get(length);
    const h = length * unit, maps = { ...mapsOf(plant, length, ticks, unit, lag) };
    const slope = (i, j) => (lag ? (Number(i === j) - maps.lag[i][1 + j]) / lag : differentiate[i][j] * 2 / h);
    maps.slope = table(COUNT, COUNT, (i, j) => (kd ? kd * slope(i, j) : 0));
    maps.feedback = table(COUNT, COUNT, (i, j) => (i === j ? k : 0) + ki * h / 2 * integrate[i][j] + maps.slope[i][j]);
    if (maps.returned) {
      const matrix = product(maps.feedback, maps.outputs);
      matrix.forEach((row, i) => { row[i] += 1; });
      maps.inverse = solve(matrix, identity(COUNT));
    }
    known.set(length, maps);
    return maps;
  }

  return function respond({ setpoint = 1, load = 0, until = Infinity, settle = 1e-11, final = setpoint }) {
    const signals = new Signals(), { starts, lengths, output, control } = signals;
    const input = floats(COUNT), y = floats(COUNT), free = floats(COUNT), reference = floats(COUNT);
    let state = floats(plant.order), integral = 0, lagged = 0, tick = 0, length = 1, wait = 0, quietSince = 0, largest = 1e-300, early = ticks > 0;
    // The input of a piece, but for what its own control signal adds.
    function inputOf(from, size) {
      nodes.forEach((node, i) => {
        const then = from + ahead(node, size, ticks); // in ticks
        if (ticks && (then < 0 || (then === 0 && i))) { input[i] = 0; return; }
        input[i] = load;
        if (returns(node, size, ticks)) return;
        let piece = signals.piece(then * unit);
        if (i === NODES && piece && starts[piece] >= then * unit) piece--;
        input[i] += signals.at(control, then * unit, piece);
      });
    }
    while (signals.pieces < CONSTANTS.mostPieces && signals.end < until * (1 - 1e-12)) {
      const maps = closed(length), h = length * unit;
      inputOf(tick, length);
      // u = free - feedback y, where free is known from the start of the piece
      for (let i = 0; i < COUNT; i++) reference[i] = setpoint * (prefilter ? -Math.expm1(-(tick * unit + h / 2 * (nodes[i] + 1)) / prefilter) : 1);
      for (let i = 0; i < COUNT; i++) {
        free[i] = k * b * reference[i] + ki * (integral + h / 2 * dot(integrate[i], reference)) + (lag ? kd / lag * maps.lag[i][0] * lagged : 0);
        if (c) free[i] += c * dot(maps.slope[i], reference);
      }
      for (let i = 0; i < COUNT; i++) y[i] = applied(maps.toOutput[i], state, input);
      if (maps.inverse) {
        const right = maps.feedback.map((row, i) => free[i] - dot(row, y)), own = maps.inverse.map((row) => dot(row, right));
        for (let i = 0; i < COUNT; i++) input[i] += dot(maps.returned[i], own);
        for (let i = 0; i < COUNT; i++) y[i] = applied(maps.toOutput[i], state, input);
      }
      const offset = output.length;
      for (let i = 0; i < COUNT; i++) { output.push(y[i]); control.push(free[i] - dot(maps.feedback[i], y)); }
      let here = 0;
      for (const value of y) here = Math.max(here, Math.abs(value - final));
      largest = Math.max(largest, here);
      const jagged = (values, size) => tail(values, offset) > ROUNDING * size;
      if (length > 1 && (jagged(output, largest) || jagged(control, Math.max(largest, Math.abs(control[offset]))))) { // again, in smaller pieces
        output.length = control.length = offset;
        length /= 2;
        wait = 4;
        continue;
      }
      state = maps.toState.map((row) => applied(row, state, input));
      integral += h / 2 * (dot(integrate[NODES], reference) - dot(integrate[NODES], y));
      if (lag) lagged = applied(maps.lag[NODES], [lagged], y.map((value, i) => value - c * reference[i]));
      starts.push(tick * unit);
      lengths.push(h);
      tick += length;
      signals.end = tick * unit;
      if (!Number.isFinite(here) || here > 1e12 * Math.max(1, Math.abs(setpoint))) break;
      if (here > settle * largest) quietSince = signals.end;
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
