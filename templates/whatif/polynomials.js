// Polynomials, coefficients in descending powers, and complex numbers as [re, im].

export const trimmed = (p) => { const first = p.findIndex((a) => a !== 0); return p.slice(first < 0 ? -1 : first); };

export const multiply = (p, q) => Array.from({ length: p.length + q.length - 1 }, (_, i) => p.reduce((sum, a, j) => sum + a * (q[i - j] || 0), 0));

export function add(p, q) {
  const size = Math.max(p.length, q.length);
  return Array.from({ length: size }, (_, i) => (p[i - size + p.length] || 0) + (q[i - size + q.length] || 0));
}

export const times = ([a, b], [c, d]) => [a * c - b * d, a * d + b * c];
export const divide = ([a, b], [c, d]) => { const scale = c * c + d * d; return [(a * c + b * d) / scale, (b * c - a * d) / scale]; };

// All roots: Aberth's iteration from a circle on, until rounding hides what is left or none moves by a fraction of itself.
export function roots(polynomial, fraction = 1e-15) {
  const p = trimmed(polynomial), found = [];
  while (p.length > 1 && p.at(-1) === 0) { p.pop(); found.push([0, 0]); }
  if (p.length === 2) return [...found, [-p[1] / p[0], 0]];
  const n = p.length - 1, radius = Math.pow(Math.abs(p[n] / p[0]), 1 / n);
  const z = Array.from({ length: n }, (_, i) => [radius * Math.cos(2 * Math.PI * i / n + 0.4), radius * Math.sin(2 * Math.PI * i / n + 0.4)]);
  for (let round = 0, moved = 1; round < 500 && moved > fraction; round++) {
    moved = 0;
    for (let i = 0; i < n; i++) {
      const [x, y] = z[i], size = Math.hypot(x, y);
      let re = p[0], im = 0, slopeRe = 0, slopeIm = 0, rounding = Math.abs(re);
      for (let k = 1; k <= n; k++) {
        [slopeRe, slopeIm] = [slopeRe * x - slopeIm * y + re, slopeRe * y + slopeIm * x + im];
        [re, im] = [re * x - im * y + p[k], re * y + im * x];
        rounding = rounding * size + Math.abs(p[k]);
      }
      if (Math.hypot(re, im) <= Number.EPSILON * rounding) continue;
      const rate = divide([slopeRe, slopeIm], [re, im]);
      for (let j = 0; j < n; j++) {
        if (j === i) continue;
        const gapRe = x - z[j][0], gapIm = y - z[j][1], gap = gapRe * gapRe + gapIm * gapIm;
        rate[0] -= gapRe / gap;
        rate[1] += gapIm / gap;
      }
      const step = divide([1, 0], rate), moves = Math.hypot(...step);
      if (!Number.isFinite(moves)) continue;
      z[i] = [x - step[0], y - step[1]];
      moved = Math.max(moved, moves / (Math.hypot(...z[i]) + radius * 1e-300));
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
