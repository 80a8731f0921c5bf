// Polynomials of one degree through Chebyshev-Lobatto nodes, dense linear systems, roots.

import { CONSTANTS } from "./data.js";

export const NODES = CONSTANTS.nodes; // the degree
export const COUNT = NODES + 1;

export const floats = (n) => new Float64Array(n);
export function table(rows, columns, entry) {
  const made = [];
  for (let i = 0; i < rows; i++) {
    const row = floats(columns);
    for (let j = 0; j < columns; j++) row[j] = entry(i, j);
    made.push(row);
  }
  return made;
}

// row . x, from the given place of the row on.
export function dot(row, x, from = 0) {
  let sum = 0;
  for (let j = 0; j < x.length; j++) sum += row[from + j] * x[j];
  return sum;
}

// M x, with the columns of M from the given one on, written or added to y.
export function apply(M, x, y = floats(M.length), from = 0, added = false) {
  for (let i = 0; i < M.length; i++) y[i] = dot(M[i], x, from) + (added ? y[i] : 0);
  return y;
}

export const identity = () => table(COUNT, COUNT, (i, j) => Number(i === j));

// A B, with the columns of A from the given one on.
export function product(A, B, from = 0) {
  return A.map((row) => {
    const sum = floats(B[0].length);
    for (let m = 0; m < B.length; m++) {
      const factor = row[from + m], other = B[m];
      if (factor) for (let j = 0; j < sum.length; j++) sum[j] += factor * other[j];
    }
    return sum;
  });
}

// Nodes on [-1, 1], ascending, with the matrices that give the coefficients, integrate from -1, and differentiate.
const halved = (j) => (j === 0 || j === NODES ? 0.5 : 1), sign = (j) => (j % 2 ? -1 : 1);
const cosine = (k, j) => Math.cos(k * Math.PI * (NODES - j) / NODES); // T_k at a node
export const nodes = Array.from({ length: COUNT }, (_, j) => -Math.cos(Math.PI * j / NODES));
const weights = nodes.map((_, j) => sign(j) * halved(j));
const coefficients = table(COUNT, COUNT, (k, j) => 2 / NODES * cosine(k, j) * halved(j) * halved(k));
const primitive = (k, j) => { // of T_k, from -1
  if (k < 2) return k ? (nodes[j] ** 2 - 1) / 2 : nodes[j] + 1;
  const part = (m) => (cosine(m, j) - sign(m)) / m;
  return (part(k + 1) - part(k - 1)) / 2;
};
export const integrate = table(COUNT, COUNT, (i, j) => coefficients.reduce((sum, row, k) => sum + primitive(k, i) * row[j], 0));
export const differentiate = table(COUNT, COUNT, (i, j) => (i === j ? 0 : weights[j] / weights[i] / (nodes[i] - nodes[j])));
differentiate.forEach((row, i) => { row[i] = -row.reduce((sum, value) => sum + value, 0); });

// The value at s of the polynomial through values.
export function interpolate(values, s) {
  let above = 0, below = 0;
  for (let j = 0; j < COUNT; j++) {
    const gap = s - nodes[j];
    if (gap === 0) return values[j];
    const weight = weights[j] / gap;
    above += weight * values[j];
    below += weight;
  }
  return above / below;
}

// The size of the last coefficients: how well the degree suffices.
const last = coefficients.slice(-3);
export const tail = (values) => Math.max(...last.map((row) => Math.abs(dot(row, values))));

// row - factor other, in place, from the given column on.
function subtract(row, factor, other, from = 0) {
  if (factor) for (let j = from; j < row.length; j++) row[j] -= factor * other[j];
}

// Solve M X = R in place for a dense matrix (rows of Float64Array); returns R.
export function solve(M, R) {
  const size = M.length;
  for (let i = 0; i < size; i++) {
    let pivot = i;
    for (let r = i + 1; r < size; r++) if (Math.abs(M[r][i]) > Math.abs(M[pivot][i])) pivot = r;
    for (const rows of [M, R]) [rows[i], rows[pivot]] = [rows[pivot], rows[i]];
    for (let r = i + 1; r < size; r++) {
      const factor = M[r][i] / M[i][i];
      subtract(M[r], factor, M[i], i);
      subtract(R[r], factor, R[i]);
    }
  }
  for (let i = size - 1; i >= 0; i--) {
    for (let j = i + 1; j < size; j++) subtract(R[i], M[i][j], R[j]);
    for (let c = 0; c < R[i].length; c++) R[i][c] /= M[i][i];
  }
  return R;
}

// A zero of f between a and c, where its signs differ (Chandrupatla: inverse quadratic interpolation where safe, else bisection).
export function root(f, a, c) {
  let x1 = c, x2 = a, f1 = f(c), f2 = f(a), part = 0.5; // newest place, and the other end
  const least = Number.EPSILON * Math.abs(c - a) / 4;
  for (let round = 0; round < 100; round++) {
    const x = x1 + part * (x2 - x1), here = f(x), same = here * f1 > 0;
    const x3 = same ? x1 : x2, f3 = same ? f1 : f2; // the place given up
    if (!same) [x2, f2] = [x1, f1];
    [x1, f1] = [x, here];
    const best = Math.abs(f1) < Math.abs(f2) ? x1 : x2, near = (2 * Number.EPSILON * Math.abs(best) + least) / Math.abs(x2 - x1);
    if (f1 === 0 || !(near < 0.5)) return best;
    const along = (x1 - x2) / (x3 - x2), up = (f1 - f2) / (f3 - f2), safe = up * up < along && (1 - up) ** 2 < 1 - along;
    part = safe ? f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2) : 0.5;
    part = Math.min(1 - near, Math.max(near, part));
  }
  return x1;
}
