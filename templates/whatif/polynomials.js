// Polynomials, coefficients in descending powers, and complex numbers as [re, im].

export const trimmed = (p) => { const first = p.findIndex((a) => a !== 0); return p.slice(first < 0 ? -1 : first); };

export const multiply = (p, q) => Array.from({ length: p.length + q.length - 1 }, (_, i) => p.reduce((sum, a, j) => sum + a * (q[i - j] || 0), 0));

export function add(p, q) {
  const size = Math.max(p.length, q.length);
  return Array.from({ length: size }, (_, i) => (p[i - size + p.length] || 0) + (q[i - size + q.length] || 0));
}

export const times = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
export const divide = ([a, b], [c, d]) => { const scale = c * c + d * d; return [(a * c + b * d) / scale, (b * c - a * d) / scale]; };

// All roots (Aberth's iteration, started on a circle of the roots' geometric mean).
export function roots(polynomial) {
  const p = trimmed(polynomial), found = [];
  while (p.length > 1 && p.at(-1) === 0) { p.pop(); found.push([0, 0]); }
  const n = p.length - 1, radius = Math.pow(Math.abs(p[n] / p[0]), 1 / n);
  const z = Array.from({ length: n }, (_, i) => [radius * Math.cos(2 * Math.PI * i / n + 0.4), radius * Math.sin(2 * Math.PI * i / n + 0.4)]);
  for (let round = 0, moved = 1; round < 500 && moved > 1e-15; round++) {
    moved = 0;
    for (let i = 0; i < n; i++) {
      let value = [p[0], 0], slope = [0, 0];
      for (let k = 1; k <= n; k++) {
        slope = times(slope, z[i]).map((part, j) => part + value[j]);
        value = times(value, z[i]);
        value[0] += p[k];
      }
      if (!value[0] && !value[1]) continue;
      const rate = divide(slope, value);
      z.forEach((other, j) => { if (j !== i) { const [re, im] = divide([1, 0], [z[i][0] - other[0], z[i][1] - other[1]]); rate[0] -= re; rate[1] -= im; } });
      const [re, im] = divide([1, 0], rate);
      if (!Number.isFinite(re) || !Number.isFinite(im)) continue;
      z[i] = [z[i][0] - re, z[i][1] - im];
      moved = Math.max(moved, Math.hypot(re, im) / (Math.hypot(...z[i]) + radius * 1e-300));
    }
  }
  return [...found, ...z];
}

// p(i w).
export function onAxis(p, w) {
  let re = 0, im = 0;
  for (const a of p) [re, im] = [-im * w + a, re * w];
  return [re, im];
}

export const sizes = (points) => points.map((point) => Math.hypot(...point)).filter((size) => size > 0);
