// Polynomials of one degree through Chebyshev-Lobatto nodes: interpolate, integrate, differentiate; dense linear systems.

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

// row . x, from the given place of the row on, and from that of x.
export function dot(row, x, count = x.length, from = 0, at = 0) {
  let sum = 0;
  for (let j = 0; j < count; j++) sum += row[from + j] * x[at + j];
  return sum;
}

export const identity = (size) => table(size, size, (i, j) => Number(i === j));

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

// What each value at a node counts for the value at s.
export function lagrange(s) {
  const at = nodes.indexOf(s), parts = nodes.map((node, j) => (at < 0 ? weights[j] / (s - node) : Number(j === at)));
  const sum = parts.reduce((total, part) => total + part, 0);
  return Float64Array.from(parts, (part) => part / sum);
}

// The value at s of the polynomial through values (offset: where its nodes begin in the array).
export function interpolate(values, offset, s) {
  let above = 0, below = 0;
  for (let j = 0; j < COUNT; j++) {
    const gap = s - nodes[j];
    if (gap === 0) return values[offset + j];
    const weight = weights[j] / gap;
    above += weight * values[offset + j];
    below += weight;
  }
  return above / below;
}

// The size of the last coefficients: how well the degree suffices.
export const tail = (values, offset) => Math.max(...coefficients.slice(-3).map((row) => Math.abs(dot(row, values, COUNT, 0, offset))));

// Solve M X = R in place for a dense matrix (rows of Float64Array); returns R.
export function solve(matrix, right) {
  const size = matrix.length, columns = right[0].length;
  for (let i = 0; i < size; i++) {
    let pivot = i;
    for (let r = i + 1; r < size; r++) if (Math.abs(matrix[r][i]) > Math.abs(matrix[pivot][i])) pivot = r;
    [matrix[i], matrix[pivot]] = [matrix[pivot], matrix[i]];
    [right[i], right[pivot]] = [right[pivot], right[i]];
    for (let r = i + 1; r < size; r++) {
      const factor = matrix[r][i] / matrix[i][i];
      if (factor === 0) continue;
      for (let c = i + 1; c < size; c++) matrix[r][c] -= factor * matrix[i][c];
      for (let c = 0; c < columns; c++) right[r][c] -= factor * right[i][c];
    }
  }
  for (let i = size - 1; i >= 0; i--) {
    for (let c = 0; c < columns; c++) {
      let sum = right[i][c];
      for (let j = i + 1; j < size; j++) sum -= matrix[i][j] * right[j][c];
      right[i][c] = sum / matrix[i][i];
    }
  }
  return right;
}

// A place between a and c, where f has different signs, at which it is zero: regula falsi, with a bisection each third time.
export function root(f, a, c) {
  let low = f(a), high = f(c);
  for (let round = 0; round < 100 && c - a > 2e-16 * Math.max(Math.abs(a), Math.abs(c)); round++) {
    let s = round % 3 === 2 ? a + (c - a) / 2 : a - low * (c - a) / (high - low);
    if (!(s > a && s < c)) s = a + (c - a) / 2;
    const here = f(s);
    if (s === a || s === c || here === 0) return s;
    if (here * high < 0) { a = s; low = here; high /= 2; } else { c = s; high = here; low /= 2; }
  }
  return a + (c - a) / 2;
}
