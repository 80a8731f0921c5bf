// Control loops with dead time, exactly: the method of steps, margins and stability, as in replicate.loops.
// Nothing here knows of the page. A plant is {num, den, deadTime}, coefficients in descending powers of s; a controller is
// {k, ki, kd, b, filter}: u = k (b r - y) + ki/s (r - y) - kd s/(1 + s filter) y.
"use strict";

const Kernel = (() => {
const NODES = CONSTANTS.nodes; // polynomial degree of a piece
const MOST_PIECES = CONSTANTS.mostPieces;
const MOST_TURNS = CONSTANTS.mostTurns; // of the dead time, in radians, that are looked at
const DECAY_PER_PIECE = CONSTANTS.decayPerPiece; // fastest pole times length of a piece, at most

const floats = (n) => new Float64Array(n);

// row . x, from the given place of the row on, and from that of x.
function dot(row, x, count, from = 0, at = 0) {
  let sum = 0;
  for (let j = 0; j < count; j++) sum += row[from + j] * x[at + j];
  return sum;
}

const sizes = (points) => points.map(([re, im]) => Math.hypot(re, im)).filter((size) => size > 0);

// Chebyshev

// Nodes on [-1, 1], ascending, with the matrices that integrate from -1 and differentiate.
const cheb = (() => {
  const n = NODES, x = [], weights = [];
  for (let j = 0; j <= n; j++) {
    x.push(-Math.cos(Math.PI * j / n));
    weights.push((j % 2 ? -1 : 1) * (j === 0 || j === n ? 0.5 : 1));
  }
  // T_k at the nodes, and the values of the integral of T_k from -1.
  const t = (k, j) => Math.cos(k * Math.PI * (n - j) / n);
  const primitive = (k, j) => {
    if (k === 0) return x[j] + 1;
    if (k === 1) return (x[j] * x[j] - 1) / 2;
    const at = (m) => t(m, j) / m, start = (m) => (m % 2 ? -1 : 1) / m;
    return (at(k + 1) - start(k + 1)) / 2 - (at(k - 1) - start(k - 1)) / 2;
  };
  const integrate = [], coefficients = [];
  for (let k = 0; k <= n; k++) {
    const row = floats(n + 1);
    for (let j = 0; j <= n; j++) {
      row[j] = 2 / n * t(k, j) * (j === 0 || j === n ? 0.5 : 1) * (k === 0 || k === n ? 0.5 : 1);
    }
    coefficients.push(row);
  }
  for (let i = 0; i <= n; i++) {
    const row = floats(n + 1);
    for (let k = 0; k <= n; k++) {
      const value = primitive(k, i);
      for (let j = 0; j <= n; j++) row[j] += value * coefficients[k][j];
    }
    integrate.push(row);
  }
  const differentiate = [];
  for (let i = 0; i <= n; i++) {
    const row = floats(n + 1);
    let sum = 0;
    for (let j = 0; j <= n; j++) {
      if (j !== i) { row[j] = weights[j] / weights[i] / (x[i] - x[j]); sum += row[j]; }
    }
    row[i] = -sum;
    differentiate.push(row);
  }
  return { x, weights, integrate, differentiate };
})();

// The value at s in [-1, 1] of the polynomial through values (offset: where its nodes begin in the array).
function interpolate(values, offset, s) {
  let above = 0, below = 0;
  for (let j = 0; j <= NODES; j++) {
    const gap = s - cheb.x[j];
    if (gap === 0) return values[offset + j];
    const weight = cheb.weights[j] / gap;
    above += weight * values[offset + j];
    below += weight;
  }
  return above / below;
}

// Linear algebra

// Solve M X = R in place for a dense matrix (rows of Float64Array); returns R.
function solve(matrix, right) {
  const n = matrix.length, columns = right[0].length;
  for (let i = 0; i < n; i++) {
    let pivot = i;
    for (let r = i + 1; r < n; r++) if (Math.abs(matrix[r][i]) > Math.abs(matrix[pivot][i])) pivot = r;
    [matrix[i], matrix[pivot]] = [matrix[pivot], matrix[i]];
    [right[i], right[pivot]] = [right[pivot], right[i]];
    for (let r = i + 1; r < n; r++) {
      const factor = matrix[r][i] / matrix[i][i];
      if (factor === 0) continue;
      for (let c = i + 1; c < n; c++) matrix[r][c] -= factor * matrix[i][c];
      for (let c = 0; c < columns; c++) right[r][c] -= factor * right[i][c];
    }
  }
  for (let i = n - 1; i >= 0; i--) {
    for (let c = 0; c < columns; c++) {
      let sum = right[i][c];
      for (let j = i + 1; j < n; j++) sum -= matrix[i][j] * right[j][c];
      right[i][c] = sum / matrix[i][i];
    }
  }
  return right;
}

// Polynomials

const trimmed = (p) => { let i = 0; while (i < p.length - 1 && p[i] === 0) i++; return p.slice(i); };

function multiply(p, q) {
  const product = new Array(p.length + q.length - 1).fill(0);
  p.forEach((a, i) => q.forEach((b, j) => { product[i + j] += a * b; }));
  return product;
}

function add(p, q) {
  const sum = new Array(Math.max(p.length, q.length)).fill(0);
  p.forEach((a, i) => { sum[sum.length - p.length + i] += a; });
  q.forEach((a, i) => { sum[sum.length - q.length + i] += a; });
  return sum;
}

// All roots, as [re, im] (Aberth's iteration, started on a circle of the roots' geometric mean).
function roots(polynomial) {
  const p = trimmed(polynomial);
  let zeros = 0;
  while (p.length > 1 && p[p.length - 1] === 0) { p.pop(); zeros++; }
  const n = p.length - 1, found = Array.from({ length: zeros }, () => [0, 0]);
  if (n < 1) return found;
  const radius = Math.pow(Math.abs(p[n] / p[0]), 1 / n);
  const angle = (i) => 2 * Math.PI * i / n + 0.4, z = Array.from({ length: n }, (_, i) => [radius * Math.cos(angle(i)), radius * Math.sin(angle(i))]);
  for (let round = 0; round < 500; round++) {
    let moved = 0;
    for (let i = 0; i < n; i++) {
      let fr = p[0], fi = 0, gr = 0, gi = 0;
      for (let k = 1; k <= n; k++) {
        [gr, gi] = [gr * z[i][0] - gi * z[i][1] + fr, gr * z[i][1] + gi * z[i][0] + fi];
        [fr, fi] = [fr * z[i][0] - fi * z[i][1] + p[k], fr * z[i][1] + fi * z[i][0]];
      }
      if (fr === 0 && fi === 0) continue;
      const [nr, ni] = divide(gr, gi, fr, fi); // p'/p
      let sr = 0, si = 0;
      for (let j = 0; j < n; j++) {
        if (j === i) continue;
        const [qr, qi] = divide(1, 0, z[i][0] - z[j][0], z[i][1] - z[j][1]);
        sr += qr; si += qi;
      }
      const [dr, di] = divide(1, 0, nr - sr, ni - si);
      if (!Number.isFinite(dr) || !Number.isFinite(di)) continue;
      z[i][0] -= dr; z[i][1] -= di;
      moved = Math.max(moved, Math.hypot(dr, di) / (Math.hypot(z[i][0], z[i][1]) + radius * 1e-300));
    }
    if (moved < 1e-15) break;
  }
  return found.concat(z);
}

const divide = (ar, ai, br, bi) => {
  const scale = br * br + bi * bi;
  return [(ar * br + ai * bi) / scale, (ai * br - ar * bi) / scale];
};

// p(i w) as [re, im].
function onAxis(p, w) {
  let re = 0, im = 0;
  for (const a of p) [re, im] = [-im * w + a, re * w];
  return [re, im];
}

// Plant, controller

// A plant with what every later step asks of it.
function prepare(plant) {
  const den = trimmed(plant.den), num = trimmed(plant.num);
  const scale = den[0];
  const made = { num: num.map((a) => a / scale), den: den.map((a) => a / scale), deadTime: plant.deadTime };
  made.order = den.length - 1;
  made.relativeDegree = den.length - num.length;
  made.poles = roots(made.den);
  made.zeros = roots(made.num);
  return made;
}

// P(i w), without and with the dead time.
function plantAt(plant, w) {
  const [nr, ni] = onAxis(plant.num, w), [dr, di] = onAxis(plant.den, w);
  const [re, im] = divide(nr, ni, dr, di), angle = -w * plant.deadTime;
  const c = Math.cos(angle), s = Math.sin(angle);
  return [re * c - im * s, re * s + im * c];
}

// C(i w) from the measurement to the control signal, sign reversed.
function controllerAt(controller, w) {
  let re = controller.k, im = controller.ki ? -controller.ki / w : 0;
  if (controller.kd) {
    const [dr, di] = divide(0, controller.kd * w, 1, w * controller.filter);
    re += dr; im += di;
  }
  return [re, im];
}

function loopAt(plant, controller, w) {
  const [pr, pi] = plantAt(plant, w), [cr, ci] = controllerAt(controller, w);
  return [pr * cr - pi * ci, pr * ci + pi * cr];
}

// The characteristic quasi-polynomial free(s) + delayed(s) exp(-s L).
function characteristic(plant, controller) {
  const lag = controller.kd ? [controller.filter, 1] : [1];
  const integrator = controller.ki ? [1, 0] : [1];
  let feedback = multiply([controller.k], multiply(integrator, lag));
  if (controller.ki) feedback = add(feedback, multiply([controller.ki], lag));
  if (controller.kd) feedback = add(feedback, multiply([controller.kd, 0], integrator));
  return {
    free: trimmed(multiply(plant.den, multiply(integrator, lag))),
    delayed: trimmed(multiply(plant.num, feedback)),
    corners: [...plant.poles, ...plant.zeros, ...roots(feedback), ...roots(lag)], // roots of both, the slow ones once
  };
}

// The number of closed-loop poles in the right half plane: the argument principle on the imaginary axis.
function unstablePoles(plant, controller) {
  const { free, delayed, corners: all } = characteristic(plant, controller);
  const degree = free.length - 1, delay = plant.deadTime;
  if (delayed.length > free.length || (delayed.length === free.length && delay > 0 && Math.abs(delayed[0]) >= Math.abs(free[0]))) {
    return Infinity; // |L| does not fall below one at high frequencies
  }
  const value = (w) => {
    const [fr, fi] = onAxis(free, w), [dr, di] = onAxis(delayed, w);
    const c = Math.cos(w * delay), s = Math.sin(w * delay);
    return [fr + dr * c + di * s, fi + di * c - dr * s];
  };
  // Beyond `end` the argument can be read off the leading terms.
  const corners = sizes(all);
  const ratio = (w) => Math.hypot(...onAxis(delayed, w)) / Math.hypot(...onAxis(free, w));
  let end = 4 * Math.max(1e-9, ...corners);
  for (let i = 0; i < 200 && ratio(end) > 0.25 * (1 + (delayed.length === free.length ? Math.abs(delayed[0] / free[0]) * 3 : 0)); i++) end *= 1.5;
  end *= 4;
  if (!(end * delay < 10 * MOST_TURNS)) return NaN; // so high a gain is not decided here
  let total = 0, w = 0, [re, im] = value(0);
  let step = Math.min(...corners, delay ? 1 / delay : Infinity, end) / 8;
  while (w < end) {
    const next = Math.min(w + step, end);
    const [nr, ni] = value(next);
    const turn = Math.atan2(re * ni - im * nr, re * nr + im * ni);
    const [mr, mi] = value((w + next) / 2);
    const half = Math.atan2(re * mi - im * mr, re * mr + im * mi) + Math.atan2(mr * ni - mi * nr, mr * nr + mi * ni);
    if ((Math.abs(turn) > 0.8 || Math.abs(turn - half) > 1e-6) && step > 1e-13 * end) { step /= 2; continue; }
    total += turn;
    w = next; [re, im] = [nr, ni];
    step *= Math.abs(turn) < 0.3 ? 1.6 : 1;
  }
  return Math.round(degree / 2 - total / Math.PI);
}

const isStable = (plant, controller) => unstablePoles(plant, controller) === 0;

// Responses

// State space in controllable form, time scaled so that the coefficients are near one: x' = A x + B v, y = C x.
function stateSpace(plant) {
  const n = plant.order, all = sizes(plant.poles);
  const scale = all.length ? Math.exp(all.reduce((sum, size) => sum + Math.log(size), 0) / all.length) : 1;
  const A = [], C = floats(n);
  for (let i = 0; i < n; i++) {
    const row = floats(n);
    if (i < n - 1) row[i + 1] = scale;
    else for (let j = 0; j < n; j++) row[j] = -plant.den[n - j] * Math.pow(scale, j - n + 1);
    A.push(row);
  }
  for (let j = 0; j < plant.num.length && j < n; j++) C[j] = plant.num[plant.num.length - 1 - j] * Math.pow(scale, j - n + 1);
  const B = floats(n);
  if (n) B[n - 1] = 1;
  return { A, B, C, n };
}

// Map of one piece of length h: (state at its start, input at the nodes) -> states at the nodes.
function pieceMap(A, B, h) {
  const n = A.length, m = NODES + 1, half = h / 2;
  const matrix = [], right = [];
  for (let i = 0; i < m; i++) {
    for (let a = 0; a < n; a++) {
      const row = floats(m * n), side = floats(n + m);
      for (let j = 0; j < m; j++) {
        const s = half * cheb.integrate[i][j];
        for (let c = 0; c < n; c++) row[j * n + c] -= s * A[a][c];
        side[n + j] = s * B[a];
      }
      row[i * n + a] += 1;
      side[a] = 1;
      matrix.push(row); right.push(side);
    }
  }
  return solve(matrix, right); // row i*n + a: state a at node i, from (x0, input)
}

const fastest = (poles) => Math.max(0, ...sizes(poles));

class Response {
  constructor(h) { Object.assign(this, { h, output: [], control: [], pieces: 0 }); }

  get end() { return this.pieces * this.h; }

  at(values, t) {
    const piece = Math.min(Math.max(Math.floor(t / this.h), 0), this.pieces - 1);
    return interpolate(values, piece * (NODES + 1), 2 * (t - piece * this.h) / this.h - 1);
  }

  y(t) { return this.at(this.output, t); }

  u(t) { return this.at(this.control, t); }
}

const piecesPerDelay = (plant, filter) => Math.max(1, Math.ceil(plant.deadTime * Math.max(fastest(plant.poles), filter > 0 ? 1 / filter : 0) / DECAY_PER_PIECE));

// What does not depend on the gains.
function mapsOf(plant, filter) {
  const space = stateSpace(plant), delay = plant.deadTime;
  if (delay > 0) {
    const parts = piecesPerDelay(plant, filter), h = delay / parts;
    const map = space.n ? pieceMap(space.A, space.B, h) : [];
    const lag = filter > 0 ? pieceMap([new Float64Array([-1 / filter])], [1 / filter], h) : null;
    return { plant, space, parts, h, ...readOut(space, map), lag, filter };
  }
  return { plant, space, parts: 0, h: 0, filter };
}

// From the maps of the states: those to the output at the nodes, and to the states at the end of the piece.
function readOut({ C, n }, map) {
  const toOutput = [], toState = [];
  for (let i = 0; i <= NODES; i++) {
    const row = floats(n + NODES + 1);
    for (let a = 0; a < n; a++) for (let c = 0; c < row.length; c++) row[c] += C[a] * map[i * n + a][c];
    toOutput.push(row);
  }
  for (let a = 0; a < n; a++) toState.push(map[NODES * n + a]);
  return { toOutput, toState };
}

// The response of a loop to steps of set-point and load, from rest.
// options: {setpoint, load, until} or, without until, {settle: how small what is left must be}
function respond(maps, controller, options) {
  return maps.parts ? respondDelayed(maps, controller, options) : respondUndelayed(maps, controller, options);
}

function respondDelayed({ space, parts, h, toOutput, toState, lag, filter }, controller, options) {
  const { setpoint = 1, load = 0 } = options, m = NODES + 1, n = space.n;
  const response = new Response(h), { output, control } = response;
  const { k, ki, kd, b } = controller;
  let x = floats(n), integral = 0, lagged = 0;
  const input = floats(m), y = floats(m), slope = floats(m), z = floats(m);
  const pieces = piecesOf(options, h);
  const settled = settling(response, setpoint, options, parts);
  for (let piece = 0; piece < pieces; piece++) {
    const before = (piece - parts) * m;
    for (let j = 0; j < m; j++) input[j] = before >= 0 ? control[before + j] + load : 0;
    for (let i = 0; i < m; i++) y[i] = applied(toOutput[i], x, input);
    x = toState.map((row) => applied(row, x, input));
    // integral of the error, and the filtered derivative, are known once y is
    for (let i = 0; i < m; i++) z[i] = integral + h / 2 * (setpoint * (cheb.x[i] + 1) - dot(cheb.integrate[i], y, m));
    integral = z[NODES];
    if (kd) lagged = derivative(slope, y, lagged, lag, filter, h);
    for (let i = 0; i < m; i++) {
      output.push(y[i]);
      control.push(k * (b * setpoint - y[i]) + ki * z[i] - (kd ? kd * slope[i] : 0));
    }
    response.pieces = piece + 1;
    if (settled(piece)) break;
  }
  return response;
}

const piecesOf = ({ until = Infinity }, h) => Math.min(Math.ceil(until / h - 1e-9), MOST_PIECES);

// A row of a map applied to the state at the start of a piece and the input at its nodes.
const applied = (row, state, input) => dot(row, state, state.length) + dot(row, input, input.length, state.length);

// s/(1 + s filter) y at the nodes of a piece; returns the filter's state at its end.
function derivative(slope, y, state, lag, filter, h) {
  const m = NODES + 1;
  for (let i = 0; i < m; i++) slope[i] = lag ? (y[i] - applied(lag[i], [state], y)) / filter : dot(cheb.differentiate[i], y, m) * 2 / h;
  if (lag) state = applied(lag[NODES], [state], y);
  return state;
}

function respondUndelayed({ space, plant, filter }, controller, options) {
  const { setpoint = 1, load = 0 } = options, n = space.n;
  const { k, ki, kd, b } = controller;
  // states: plant, integral, derivative filter; u = k (b r - y) + ki z - kd/filter (y - q), or - kd y' without a filter
  const lag = kd ? filter : 0, gain = k + (lag ? kd / lag : 0), ideal = kd && !lag ? kd : 0;
  const size = n + 2, jump = n ? ideal * space.C[n - 1] : 0, closed = 1 + jump;
  const control = floats(size + 1); // u from the states and the constant 1
  for (let a = 0; a < n; a++) {
    let slope = 0;
    for (let c = 0; c < n; c++) slope += space.C[c] * space.A[c][a];
    control[a] = -(gain * space.C[a] + ideal * slope) / closed;
  }
  control[n] = ki / closed;
  control[n + 1] = (lag ? kd / lag : 0) / closed;
  control[size] = (k * b * setpoint - jump * load) / closed;
  const output = floats(size);
  output.set(space.C);
  const M = [], forcing = floats(size);
  for (let a = 0; a < n; a++) {
    const row = floats(size);
    row.set(space.A[a]);
    for (let c = 0; c < size; c++) row[c] += space.B[a] * control[c];
    forcing[a] = space.B[a] * (control[size] + load);
    M.push(row);
  }
  const integralRow = floats(size), lagRow = floats(size);
  for (let c = 0; c < size; c++) { integralRow[c] = -output[c]; lagRow[c] = lag ? output[c] / lag : 0; }
  forcing[n] = setpoint;
  lagRow[n + 1] -= lag ? 1 / lag : 1;
  M.push(integralRow, lagRow);
  const { free, delayed } = characteristic(plant, controller);
  const rate = Math.max(fastest(roots(add(free, delayed))), fastest(plant.poles) / 4, 1e-12);
  const h = DECAY_PER_PIECE / 2 / rate;
  const map = pieceMap(M, forcing, h), m = NODES + 1, ones = floats(m).fill(1), forced = map.map((row) => dot(row, ones, m, size));
  const response = new Response(h);
  const pieces = piecesOf(options, h);
  const settled = settling(response, setpoint, options, 1);
  let state = floats(size);
  for (let piece = 0; piece < pieces; piece++) {
    const next = floats(size), here = floats(size);
    for (let i = 0; i < m; i++) {
      for (let a = 0; a < size; a++) {
        const row = map[i * size + a];
        here[a] = dot(row, state, size) + forced[i * size + a];
      }
      response.output.push(dot(output, here, size));
      response.control.push(control[size] + dot(control, here, size));
      if (i === NODES) next.set(here);
    }
    state = next;
    response.pieces = piece + 1;
    if (settled(piece)) break;
  }
  return response;
}

// Decides after each piece whether a response has come to rest: small for as long as it took to come there.
function settling(response, setpoint, options, parts) {
  if (options.until !== undefined) return () => false;
  const { settle = 1e-12, final = setpoint } = options, m = NODES + 1;
  let quietSince = 0, largest = 1e-300;
  return (piece) => {
    let here = 0;
    for (let i = piece * m; i < (piece + 1) * m; i++) here = Math.max(here, Math.abs(response.output[i] - final));
    largest = Math.max(largest, here);
    if (!Number.isFinite(here) || here > 1e12 * Math.max(1, Math.abs(setpoint))) return true;
    if (here > settle * largest) quietSince = piece + 1;
    return piece - quietSince >= 2 * parts && piece > 1.05 * quietSince + parts;
  };
}

// Metrics

// Places in (-1, 1) where the polynomial through values[offset...] less a level changes sign.
function crossings(values, offset, level) {
  const found = [];
  for (let j = 0; j < NODES; j++) {
    let low = values[offset + j] - level;
    const high = values[offset + j + 1] - level;
    if (low === 0 || low * high >= 0) { if (low === 0 && j > 0) found.push(cheb.x[j]); continue; }
    let a = cheb.x[j], c = cheb.x[j + 1];
    for (let round = 0; round < 80 && c - a > 1e-16 * 4; round++) {
      // the secant where it helps, bisection where it does not
      let s = a + (c - a) / 2;
      const fa = interpolate(values, offset, a) - level, fc = interpolate(values, offset, c) - level;
      if (round % 3 && fa !== fc) s = Math.min(Math.max(a - fa * (c - a) / (fc - fa), a + 1e-3 * (c - a)), c - 1e-3 * (c - a));
      const here = interpolate(values, offset, s) - level;
      if (here === 0) { a = c = s; break; }
      if (here * low < 0) c = s; else { a = s; low = here; }
    }
    found.push((a + c) / 2);
  }
  return found;
}

function slopes(values, offset) {
  return cheb.differentiate.map((row) => dot(row, values, NODES + 1, 0, offset));
}

// Times and values of all local extrema of a signal, ends of pieces included.
function* turningPoints(response, values) {
  const m = NODES + 1;
  for (let piece = 0; piece < response.pieces; piece++) {
    const offset = piece * m;
    yield [piece * response.h, values[offset]];
    for (const s of crossings(slopes(values, offset), 0, 0)) {
      yield [(piece + (s + 1) / 2) * response.h, interpolate(values, offset, s)];
    }
    yield [(piece + 1) * response.h, values[offset + NODES]];
  }
}

function overshoot(response, final) {
  let peak = -Infinity, time = 0;
  for (const [t, value] of turningPoints(response, response.output)) if (value / final > peak) [peak, time] = [value / final, t];
  return { overshoot: Math.max(0, peak - 1), peakTime: time };
}

// The last time at which the output is further from its final value than the band.
function settlingTime(response, final, band) {
  const m = NODES + 1, width = band * (final ? Math.abs(final) : 1);
  for (let piece = response.pieces - 1; piece >= 0; piece--) {
    const offset = piece * m, points = [-1, ...crossings(slopes(response.output, offset), 0, 0), 1];
    for (let i = points.length - 1; i > 0; i--) {
      const late = Math.abs(interpolate(response.output, offset, points[i]) - final) - width;
      const early = Math.abs(interpolate(response.output, offset, points[i - 1]) - final) - width;
      if (late > 0) return piece === response.pieces - 1 && i === points.length - 1 ? NaN : (piece + (points[i] + 1) / 2) * response.h;
      if (early > 0) {
        const s = bisect((x) => Math.abs(interpolate(response.output, offset, x) - final) - width, points[i - 1], points[i]);
        return (piece + (s + 1) / 2) * response.h;
      }
    }
  }
  return 0;
}

// The first time at which the output reaches a level; NaN if it does not.
function reaches(response, level) {
  const m = NODES + 1;
  for (let piece = 0; piece < response.pieces; piece++) {
    const offset = piece * m;
    if (piece && (response.output[offset] - level) * (response.output[offset - 1] - level) < 0) return piece * response.h;
    const found = crossings(response.output, offset, level);
    if (found.length) return (piece + (found[0] + 1) / 2) * response.h;
  }
  return NaN;
}

// The integral of |final - y|.
function absoluteError(response, final) {
  const m = NODES + 1, last = cheb.integrate[NODES];
  let total = 0;
  for (let piece = 0; piece < response.pieces; piece++) {
    const offset = piece * m, cuts = crossings(response.output, offset, final);
    if (!cuts.length) {
      total += Math.abs(dot(last, response.output, m, 0, offset) - 2 * final) * response.h / 2;
      continue;
    }
    const ends = [-1, ...cuts, 1];
    for (let i = 1; i < ends.length; i++) {
      let sum = 0;
      const middle = (ends[i] + ends[i - 1]) / 2, half = (ends[i] - ends[i - 1]) / 2;
      for (let j = 0; j < m; j++) sum += last[j] * (interpolate(response.output, offset, middle + half * cheb.x[j]) - final);
      total += Math.abs(sum) * half * response.h / 2;
    }
  }
  return total;
}

// The total variation of the control signal: jumps with their height, the first one from zero.
function totalVariation(response) {
  let total = 0, before = 0;
  for (const [, value] of turningPoints(response, response.control)) { total += Math.abs(value - before); before = value; }
  return total;
}

// Frequency domain

// Frequencies dense enough for every resonance and turn of the dead time, up to where |L| stays small.
function grid(plant, controller, floor) {
  const { corners } = characteristic(plant, controller);
  const all = sizes(corners);
  if (controller.k && controller.ki) all.push(Math.abs(controller.ki / controller.k));
  if (plant.deadTime) all.push(1 / plant.deadTime);
  const low = Math.min(...all) / 1e3;
  let high = Math.max(...all) * 4;
  const size = (w) => Math.hypot(...loopAt(plant, controller, w));
  for (let i = 0; i < 400 && size(high) > floor; i++) high *= 1.3;
  if (plant.deadTime) high = Math.min(high + 2.5 * Math.PI / plant.deadTime, MOST_TURNS / plant.deadTime);
  const w = [];
  const most = plant.deadTime ? 0.12 / plant.deadTime : Infinity;
  for (let x = low; x < high;) { w.push(x); x += Math.min(x * 0.03, most); }
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

function bisect(f, a, c) {
  const low = f(a);
  for (let i = 0; i < 200; i++) {
    const s = a + (c - a) / 2, here = f(s);
    if (s === a || s === c || here === 0) return s;
    if (here * low < 0) c = s; else a = s;
  }
  return (a + c) / 2;
}

// Ms, gain, phase and delay margin, with their frequencies; of a stable loop.
function margins(plant, controller) {
  const w = grid(plant, controller, 0.05);
  const re = floats(w.length), im = floats(w.length);
  for (let i = 0; i < w.length; i++) [re[i], im[i]] = loopAt(plant, controller, w[i]);
  const sensitivity = (x) => { const [a, c] = loopAt(plant, controller, x); return 1 / Math.hypot(1 + a, c); };
  const level = (x) => Math.log(Math.hypot(...loopAt(plant, controller, x)));
  const imaginary = (x) => loopAt(plant, controller, x)[1];
  const atOnce = controller.kd && !controller.filter && plant.relativeDegree < 2; // |S| does not tend to one
  let ms = atOnce ? 0 : 1, msAt = NaN, gain = Infinity, gainAt = NaN, phase = Infinity, phaseAt = NaN, delay = Infinity, delayAt = NaN;
  const s = (i) => 1 / Math.hypot(1 + re[i], im[i]);
  const atZero = controller.ki ? 0 : s(0);
  if (atZero > ms) [ms, msAt] = [atZero, 0];
  for (let i = 1; i < w.length - 1; i++) {
    if (s(i) >= s(i - 1) && s(i) >= s(i + 1) && s(i) > 0.9 * ms) {
      const at = golden(sensitivity, w[i - 1], w[i + 1]), value = sensitivity(at);
      if (value > ms) [ms, msAt] = [value, at];
    }
  }
  if (!controller.ki && re[0] < 0) {
    const factor = 1 / Math.hypot(re[0], im[0]);
    if (factor > 1 && Math.abs(im[0]) < 1e-2 * Math.abs(re[0])) [gain, gainAt] = [factor, 0];
  }
  for (let i = 0; i < w.length - 1; i++) {
    if (im[i] * im[i + 1] < 0 && re[i] + re[i + 1] < 0) {
      const at = bisect(imaginary, w[i], w[i + 1]), value = loopAt(plant, controller, at)[0];
      if (value < 0 && -1 / value > 1 && -1 / value < gain) [gain, gainAt] = [-1 / value, at];
    }
    const one = re[i] * re[i] + im[i] * im[i] - 1, other = re[i + 1] * re[i + 1] + im[i + 1] * im[i + 1] - 1;
    if (one * other < 0) {
      const at = bisect(level, w[i], w[i + 1]), [a, c] = loopAt(plant, controller, at);
      let lag = Math.atan2(c, a) + Math.PI;
      lag -= 2 * Math.PI * Math.floor(lag / (2 * Math.PI));
      if (lag * 180 / Math.PI < phase) [phase, phaseAt] = [lag * 180 / Math.PI, at];
      if (lag / at < delay) [delay, delayAt] = [lag / at, at];
    }
  }
  return { ms, msAt, gain, gainAt, phase, phaseAt, delay, delayAt };
}

// The gain plane

// Two of the three gains at which a closed-loop pole lies at i w; `plane` is "ki" (kd fixed) or "kd" (ki fixed).
function boundary(plant, controller, plane, w) {
  const [pr, pi] = plantAt(plant, w), [re, im] = divide(-1, 0, pr, pi); // C(i w) must be this
  const [dr, di] = divide(0, w, 1, w * controller.filter); // the derivative part for kd = 1
  if (plane === "ki") {
    const k = re - controller.kd * dr;
    return [k, -(im - controller.kd * di) * w];
  }
  const kd = (im + controller.ki / w) / di;
  return [re - kd * dr, kd];
}

return {
  NODES, MOST_PIECES, trimmed, multiply, add, sizes, fastest, piecesPerDelay, prepare, mapsOf, respond, overshoot, settlingTime, reaches, absoluteError, totalVariation,
  margins, unstablePoles, isStable, loopAt, plantAt, controllerAt, boundary, grid,
};
})();
