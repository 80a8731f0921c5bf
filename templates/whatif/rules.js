// Where the tuning rules of replicate.loops.tune, sent as data, put the controller of a plant.

import { DATA } from "./data.js";

const OPERATIONS = { "+": (a, b) => a + b, "-": (a, b) => a - b, "*": (a, b) => a * b, "/": (a, b) => a / b, "**": (a, b) => a ** b };

// A formula is a number, the name of a symbol, or [operation, formula, formula].
const value = (formula, symbols) => {
  if (typeof formula === "number") return formula;
  if (typeof formula === "string") return symbols[formula];
  return OPERATIONS[formula[0]](value(formula[1], symbols), value(formula[2], symbols));
};

// The plant as gain, real lags, integrators and dead time, zeros to the right as dead time; nothing if it is another one.
// Rounding moves multiple roots of polynomials without factors a little off the real axis.
function lagModel({ num, den, poles, zeros, deadTime }) {
  const lags = poles.filter(([re, im]) => re || im), integrators = poles.length - lags.length, complex = ([re, im]) => Math.abs(im) > 0.01 * Math.abs(re);
  if ([...lags, ...zeros].some(complex) || lags.some(([re]) => re >= 0) || zeros.some(([re]) => re <= 0) || integrators > 1 || !poles.length) return null;
  const L = zeros.reduce((sum, [re]) => sum + 1 / re, deadTime);
  return { K: num.at(-1) / den.at(-1 - integrators), L, integrators, lags: lags.map(([re]) => -1 / re).sort((a, b) => b - a) };
}

// PI settings.
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
    const [quantity, low, high] = rule.holds ? [value(rule.holds[0], symbols), ...rule.holds.slice(1)] : [0, 0, 0];
    return symbols.L > 0 && quantity >= low && quantity <= high ? [{ name: rule.name, k: value(rule.Kp, symbols), ki: value(rule.Ki, symbols), kd: 0 }] : [];
  });
}
