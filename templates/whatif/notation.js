// Plants and controllers as text, as in replicate.loops.notation: e^{-1.5s}/(s+1)^3 and k=0.6,ki=0.5,b=1.

import { add, multiply, roots, trimmed } from "./polynomials.js";

export class NotationError extends Error {}

const fail = (column, reason) => { throw new NotationError(`column ${column}: ${reason}`); };
const CLOSING = { "(": ")", "{": "}", "[": "]" };

function tokens(text) {
  const found = [], pattern = /\s+|\\left|\\right|\\[,;!:]|((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(\*\*|\\cdot|\\frac|exp|[-+*/^(){}[\]−–·⋅×se])|([⁰¹²³⁴-⁹]+)/y;
  const same = { "**": "^", "\\cdot": "*", "−": "-", "–": "-", "·": "*", "⋅": "*", "×": "*" };
  while (pattern.lastIndex < text.length) {
    const column = pattern.lastIndex + 1, match = pattern.exec(text), rest = text.slice(column - 1);
    if (!match) {
      const [letters] = /^\p{L}*/u.exec(rest);
      fail(column, letters ? `'${letters}' is not known here; allowed are s, numbers, e^{...} and exp(...)` : rest[0] === "," ? "a decimal point is written '.', not ','" : `'${rest[0]}' is not understood`);
    }
    const [, number, symbol, superscript] = match;
    if (symbol) found.push({ kind: same[symbol] || symbol, column });
    if (superscript) found.push({ kind: "^", column });
    const digits = number || superscript?.replace(/./g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c)), value = Number(digits);
    if (value === Infinity || (value === 0 && /^[^e]*[1-9]/i.test(digits))) fail(column, `${digits} is not a floating-point number`);
    if (digits) found.push({ kind: "number", value, column });
  }
  return [...found, { kind: "end", column: text.length + 1 }];
}

// Values are quotients of products of polynomials with a dead time: {num, den, delay}, the factors as they were written.
const poly = (...num) => ({ num: [num], den: [], delay: 0 });
const expanded = (factors) => trimmed(factors.reduce(multiply, [1]));
const negative = (a) => ({ ...a, num: [[-1], ...a.num] });
const isZero = (a) => a.num.some((p) => p.every((x) => x === 0));

function plus(a, b, column) {
  if (isZero(b)) return a;
  if (isZero(a)) return b;
  if (a.delay !== b.delay) fail(column, "a sum of different dead times is not drawn here; replicate.loops computes it");
  const same = JSON.stringify(a.den) === JSON.stringify(b.den), crossed = (one, other) => expanded(same ? one.num : [...one.num, ...other.den]);
  return { num: [add(crossed(a, b), crossed(b, a))], den: same ? a.den : [...a.den, ...b.den], delay: a.delay };
}
const joined = (a, b) => ({ num: [...a.num, ...b.num], den: [...a.den, ...b.den], delay: a.delay + b.delay });
function over(a, b, column) {
  if (isZero(b)) fail(column, "division by zero");
  return joined(a, { num: b.den, den: b.num, delay: -b.delay });
}
function constant(a) {
  const [num, den] = [expanded(a.num), expanded(a.den)];
  return num.length === 1 && den.length === 1 && !a.delay ? num[0] / den[0] : null;
}

function power(base, exponent, column) {
  const n = constant(exponent);
  if (n === null || !Number.isInteger(n) || Math.abs(n) > 40) fail(column, "an exponent is a whole number here");
  const result = Array.from({ length: Math.abs(n) }, () => base).reduce(joined, poly(1));
  return n < 0 ? over(poly(1), result, column) : result;
}

function evaluate(text) {
  const list = tokens(text);
  let at = 0, depth = 0;
  const next = () => list[at], take = () => (next().kind === "end" ? next() : list[at++]);
  const unexpected = ({ kind, column, value }) => fail(column, kind === "end" ? "the text ends too early" : `'${value ?? kind}' is not expected here`);

  function sum() {
    if (++depth > 40) fail(next().column, "too many parentheses inside each other");
    const opening = next().kind === "+" || next().kind === "-" ? take().kind : "+";
    let value = opening === "-" ? negative(product()) : product();
    while (next().kind === "+" || next().kind === "-") {
      const { kind, column } = take(), term = product();
      value = plus(value, kind === "-" ? negative(term) : term, column);
    }
    depth--;
    return value;
  }
  function product() {
    let value = factor(), divided = false;
    for (;;) {
      const token = next();
      if (token.kind === "*") { take(); value = joined(value, factor()); divided = false; }
      else if (token.kind === "/") { take(); value = over(value, factor(), token.column); divided = true; }
      else if (token.kind === "number") fail(token.column, "a number stands before what it multiplies, and a power is written ^");
      else if (token.kind in CLOSING || ["s", "e", "exp", "\\frac"].includes(token.kind)) {
        if (divided && token.kind !== "e" && token.kind !== "exp") fail(token.column, "is this above or below the division? Write a/(b c) or a/b*c");
        value = joined(value, raised());
      } else return value;
    }
  }
  const factor = () => (next().kind === "-" ? (take(), negative(raised())) : raised());
  function raised() {
    const base = primary();
    if (next().kind !== "^") return base;
    const column = take().column;
    if (next().kind in CLOSING) return power(base, group(), column);
    const sign = next().kind === "-" ? (take(), -1) : 1, token = take();
    if (token.kind !== "number") fail(token.column, "an exponent is a number, or stands in braces");
    return power(base, poly(sign * token.value), column);
  }
  function primary() {
    const token = next();
    if (token.kind in CLOSING) return group();
    take();
    if (token.kind === "number") return poly(token.value);
    if (token.kind === "s") return poly(1, 0);
    if (token.kind === "\\frac") { const above = group(); return over(above, group(), token.column); }
    if (token.kind === "e" && !(next().kind === "^" && list[at + 1].kind in CLOSING)) fail(token.column, "e needs an exponent in braces, as in e^{-2s}");
    if (token.kind === "e") take();
    if (token.kind === "e" || token.kind === "exp") return exponential(token.column);
    return unexpected(token);
  }
  function exponential(column) {
    const value = group(), p = expanded(value.num), [scale, ...more] = expanded(value.den);
    if (value.delay || more.length || p.length > 2 || (p.length === 2 && p[1] !== 0)) fail(column, "the exponent of e is a number times s");
    return p.length === 1 ? poly(Math.exp(p[0] / scale)) : { ...poly(1), delay: -p[0] / scale };
  }
  function group() {
    const opening = take();
    if (!(opening.kind in CLOSING)) fail(opening.column, "'{' is missing");
    const value = sum(), closing = take();
    if (closing.kind !== CLOSING[opening.kind]) fail(closing.column, `'${CLOSING[opening.kind]}' is needed for column ${opening.column}`);
    return value;
  }

  if (next().kind === "end") fail(1, "the text is empty");
  const value = sum();
  return next().kind === "end" ? value : unexpected(next());
}

export function parsePlant(text) {
  const value = evaluate(text), num = expanded(value.num), den = expanded(value.den);
  const wrong = [
    [isZero(value), "the plant is zero"], [value.delay < 0, "the plant predicts; the dead time must not be negative"],
    [num.length > den.length, "the plant is improper: its numerator has the higher degree"],
    [num.length === den.length && !value.delay, "a plant that answers at once is not drawn here"], [den.length > 16, "at most order 15 is drawn here"],
    [![...num, ...den, value.delay].every(Number.isFinite), "a coefficient is beyond any limit"],
  ].find(([holds]) => holds);
  return wrong ? fail(1, wrong[1]) : { num, den, deadTime: value.delay, poles: value.den.flatMap((p) => roots(p)), zeros: value.num.flatMap((p) => roots(p)) };
}

const ALIASES = { kp: "k", gain: "k", integral_time: "ti", derivative_time: "td" };
const FIELDS = { b: 1, c: 0, derivative_filter: 0, setpoint_filter: 0 }; // and what they are where they are not given
const NAMES = ["k", "ki", "kd", "ti", "td", "alpha", ...Object.keys(FIELDS)];

export function parseController(text) {
  const given = {};
  let start = 1;
  for (const part of text.split(",")) {
    const [left, ...right] = part.split("="), key = left.trim().toLowerCase(), name = ALIASES[key] || key;
    if (name.startsWith("measurement_filter")) fail(start, `${name} is not drawn here; replicate.loops computes it`);
    if (!NAMES.includes(name)) fail(start, `'${left.trim()}' is not known; allowed are ${NAMES.join(", ")}`);
    if (!right.length) fail(start, `a value is missing: ${name}=...`);
    if (name in given) fail(start, `${name} is given twice`);
    const plain = right.join("=").trim();
    const value = plain === "inf" && name === "ti" ? Infinity : constant(evaluate(plain));
    if (value === null || Number.isNaN(value) || (!Number.isFinite(value) && name !== "ti")) fail(start, `${name} must be a number`);
    if (value < 0 && (name.endsWith("filter") || name === "alpha")) fail(start, `${name} must not be negative`);
    if (value === 0 && name === "ti") fail(start, "ti must not be zero");
    given[name] = value;
    start += part.length + 1;
  }
  if (!("k" in given)) fail(1, "the gain is missing: k=...");
  for (const [one, other] of [["ki", "ti"], ["kd", "td"], ["ki", "alpha"], ["kd", "alpha"]]) if (one in given && other in given) fail(1, `${one} and ${other} cannot both be given`);
  const series = "alpha" in given, { k: gain, ti = Infinity, td = 0 } = given, lag = series ? given.alpha * td : 0;
  const { b, c, derivative_filter: filter, setpoint_filter: prefilter } = { ...FIELDS, ...(series && { c: 1, derivative_filter: lag }), ...given };
  const k = series ? gain * (1 + (td - lag) / ti) : gain;
  return { k, ki: given.ki ?? gain / ti, kd: given.kd ?? gain * td - (series ? k * lag : 0), b, c, filter, prefilter };
}

// The controller as text; `digits` significant ones, all if not given.
export function controllerText({ k, ki, kd, b, c, filter, prefilter }, digits) {
  const parts = Object.entries({ k, ki, kd, b, c, derivative_filter: filter, setpoint_filter: prefilter });
  const kept = parts.filter(([name, x]) => ["k", "ki"].includes(name) || (name === "kd" && filter) || x !== (FIELDS[name] ?? 0));
  return kept.map(([name, x]) => `${name}=${digits ? Number(x.toPrecision(digits)) : x}`).join(",");
}
