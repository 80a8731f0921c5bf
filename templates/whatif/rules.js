// Where the tuning rules of replicate.loops.tune, sent along as data, put the controller of a plant.

import { CONSTANTS, DATA } from "./data.js";

const OPERATIONS = { "+": (a, b) => a + b, "-": (a, b) => a - b, "*": (a, b) => a * b, "/": (a, b) => a / b, "**": (a, b) => a ** b };

// A formula is a number, the name of a symbol, or [operation, formula, formula].
const value = (formula, symbols) => {
  if (typeof formula === "number") return formula;
  if (typeof formula === "string") return symbols[formula];
  return OPERATIONS[formula[0]](value(formula[1], symbols), value(formula[2], symbols));
};

// Roots, with each multiple one, which rounding has split into a ring, replaced by its mean.
function clustered(roots, polynomial) {
  const left = [...roots], found = [], at = (p, x) => p.reduce((sum, a) => sum * x + a, 0), slope = (p) => p.slice(0, -1).map((a, i) => a * (p.length - 1 - i));
  while (left.length) {
    const group = [left.pop()];
    for (let i = 0; i < group.length; i++) {
      const [re, im] = group[i], near = ([a, c]) => Math.hypot(a - re, c - im) <= CONSTANTS.linked * Math.hypot(a, c);
      for (let j = left.length - 1; j >= 0; j--) if (near(left[j])) group.push(...left.splice(j, 1));
    }
    const size = group.length;
    let mean = group.reduce((sum, [re]) => sum + re / size, 0), p = polynomial;
    const spread = Math.max(...group.map(([re, im]) => Math.hypot(re - mean, im)));
    const split = size > 1 && spread <= 30 * Number.EPSILON ** (1 / size) * Math.abs(mean);
    if (split) {
      for (let i = 1; i < size; i++) p = slope(p); // of which it is a simple root
      for (let i = 0; i < 4; i++) mean -= at(p, mean) / at(slope(p), mean);
    }
    found.push(...group.map((one) => (split ? [mean, 0] : one)));
  }
  return found;
}

// The plant as gain, real lags, integrators and dead time, zeros to the right as dead time; nothing if it is another one.
function lagModel({ num, den, poles, zeros, deadTime }) {
  const integrators = poles.filter((pole) => Math.hypot(...pole) === 0).length;
  const lags = clustered(poles.filter((pole) => Math.hypot(...pole) > 0), den), inverse = clustered(zeros, num);
  const complex = ([re, im]) => Math.abs(im) > 1e-13 * Math.abs(re);
  if ([...lags, ...inverse].some(complex) || lags.some(([re]) => re >= 0) || inverse.some(([re]) => re <= 0) || integrators > 1) return null;
  const L = inverse.reduce((sum, [re]) => sum + 1 / re, deadTime);
  return { K: num.at(-1) / den.at(-1 - integrators), L, integrators, lags: lags.map(([re]) => -1 / re).sort((a, b) => b - a) };
}

// PI settings by all rules that apply.
export function rules(plant) {
  const model = lagModel(plant);
  if (!model) return [];
  const { K, integrators } = model, [tau, ...small] = integrators ? [undefined, ...model.lags] : model.lags;
  const first = small.length === 0 && plant.num.length === 1;
  // Skogestad's half rule: half of the largest neglected lag for the one kept, all else for the dead time
  const half = integrators ? 0 : (small[0] || 0) / 2;
  const reduced = { tau: tau + half, L: small.reduce((sum, lag) => sum + lag, model.L) - half };
  return DATA.rules.flatMap((rule) => {
    if (!(rule.reduces || first) || rule.process !== (integrators ? "integrator" : "lag")) return [];
    const symbols = { K, ...(rule.reduces ? reduced : { tau, L: model.L }) };
    for (const [name, formula] of rule.where) symbols[name] = value(formula, symbols);
    if (!(symbols.L > 0) || (rule.holds && !(value(rule.holds[0], symbols) >= rule.holds[1] && value(rule.holds[0], symbols) <= rule.holds[2]))) return [];
    const k = value(rule.Kp, symbols);
    return [{ name: rule.name, k, ki: rule.Ki ? value(rule.Ki, symbols) : k / value(rule.Ti, symbols), kd: 0 }];
  });
}
