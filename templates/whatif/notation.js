// Plants and controllers as text, in the notation of replicate.loops.notation: e^{-1.5s}/(s+1)^3 and k=0.6,ki=0.5,b=1.
"use strict";

const Notation = (() => {
class NotationError extends Error {}

const fail = (column, reason) => { throw new NotationError(`column ${column}: ${reason}`); };
const CLOSING = { "(": ")", "{": "}", "[": "]" };

function tokens(text) {
  const found = [], pattern = /\s+|\\left|\\right|\\[,;!:]|(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|(\*\*|\\cdot|\\frac|[-+*/^(){}[\]−–·⋅×])|(exp|s|e)|([⁰¹²³⁴⁵⁶⁷⁸⁹]+)/y;
  const same = { "**": "^", "\\cdot": "*", "−": "-", "–": "-", "·": "*", "⋅": "*", "×": "*" };
  while (pattern.lastIndex < text.length) {
    const column = pattern.lastIndex + 1, match = pattern.exec(text);
    if (!match) {
      const letters = /^[\p{L}]+/u.exec(text.slice(column - 1));
      fail(column, letters ? `'${letters[0]}' is not known here; allowed are s, numbers, e^{...} and exp(...)` : text[column - 1] === "," ? "a decimal point is written '.', not ','" : `'${text[column - 1]}' is not understood`);
    }
    const [, number, symbol, name, superscript] = match;
    if (number) found.push({ kind: "number", value: Number(number), column });
    else if (symbol) found.push({ kind: same[symbol] || symbol, column });
    else if (name) found.push({ kind: name === "exp" ? "exp" : name, column });
    else if (superscript) {
      found.push({ kind: "^", column });
      found.push({ kind: "number", value: Number([...superscript].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c)).join("")), column });
    }
  }
  found.push({ kind: "end", column: text.length + 1 });
  return found;
}

// Values are quotients of polynomials with a dead time: {num, den, delay}.
const poly = (...p) => ({ num: p, den: [1], delay: 0 });
const { multiply, add, trimmed: trim } = Kernel;
const isZero = (p) => p.every((x) => x === 0);
const same = (a, b) => a.length === b.length && a.every((x, i) => x === b[i]);

function plus(a, b, sign, column) {
  if (isZero(b.num)) return a;
  if (isZero(a.num)) return { ...b, num: b.num.map((x) => sign * x) };
  if (a.delay !== b.delay) fail(column, "a sum of different dead times is not drawn here; replicate.loops computes it");
  if (same(a.den, b.den)) return { num: trim(add(a.num, b.num.map((x) => sign * x))), den: a.den, delay: a.delay };
  return { num: trim(add(multiply(a.num, b.den), multiply(b.num, a.den).map((x) => sign * x))), den: multiply(a.den, b.den), delay: a.delay };
}
const times = (a, b) => ({ num: multiply(a.num, b.num), den: multiply(a.den, b.den), delay: a.delay + b.delay });
function over(a, b, column) {
  if (isZero(b.num)) fail(column, "division by zero");
  return { num: multiply(a.num, b.den), den: multiply(a.den, b.num), delay: a.delay - b.delay };
}
const constant = (a) => (a.num.length === 1 && a.den.length === 1 && !a.delay ? a.num[0] / a.den[0] : null);

function power(base, exponent, column) {
  const n = constant(exponent);
  if (n === null || !Number.isInteger(n) || Math.abs(n) > 40) fail(column, "an exponent is a whole number here");
  let result = poly(1);
  for (let i = 0; i < Math.abs(n); i++) result = times(result, base);
  return n < 0 ? over(poly(1), result, column) : result;
}

function evaluate(text) {
  const list = tokens(text);
  let at = 0, depth = 0;
  const next = () => list[at], take = () => list[at].kind === "end" ? list[at] : list[at++];
  const shown = (token) => (token.kind === "number" ? String(token.value) : token.kind);

  function sum() {
    if (++depth > 40) fail(next().column, "too many parentheses inside each other");
    const sign = next().kind === "+" || next().kind === "-" ? take().kind : "+";
    let value = product();
    if (sign === "-") value = { ...value, num: value.num.map((x) => -x) };
    while (next().kind === "+" || next().kind === "-") {
      const operation = take();
      value = plus(value, product(), operation.kind === "-" ? -1 : 1, operation.column);
    }
    depth--;
    return value;
  }
  function product() {
    let value = factor(), divided = false;
    for (;;) {
      const token = next();
      if (token.kind === "*") { take(); value = times(value, factor()); divided = false; }
      else if (token.kind === "/") { take(); value = over(value, factor(), token.column); divided = true; }
      else if (token.kind === "number") fail(token.column, "a number stands before what it multiplies, and a power is written ^");
      else if (token.kind in CLOSING || ["s", "e", "exp", "\\frac"].includes(token.kind)) {
        if (divided && token.kind !== "e" && token.kind !== "exp") fail(token.column, "is this above or below the division? Write a/(b c) or a/b*c");
        value = times(value, raised());
      } else return value;
    }
  }
  function factor() {
    if (next().kind !== "-") return raised();
    take();
    const value = raised();
    return { ...value, num: value.num.map((x) => -x) };
  }
  function raised() {
    const base = primary();
    if (next().kind !== "^") return base;
    const column = take().column;
    if (next().kind in CLOSING) return power(base, group(), column);
    const negative = next().kind === "-" && take();
    const token = take();
    if (token.kind !== "number") fail(token.column, "an exponent is a number, or stands in braces");
    return power(base, poly(negative ? -token.value : token.value), column);
  }
  function primary() {
    const token = next();
    if (token.kind === "number") { take(); if (!Number.isFinite(token.value)) fail(token.column, "the number is too large"); return poly(token.value); }
    if (token.kind in CLOSING) return group();
    if (token.kind === "s") { take(); return poly(1, 0); }
    if (token.kind === "\\frac") { take(); const above = group(); return over(above, group(), token.column); }
    if (token.kind === "e") {
      take();
      if (next().kind !== "^" || !(list[at + 1].kind in CLOSING)) fail(token.column, "e needs an exponent in braces, as in e^{-2s}");
      take();
      return exponential(token.column);
    }
    if (token.kind === "exp") { take(); return exponential(token.column); }
    return fail(token.column, token.kind === "end" ? "the text ends too early" : `'${shown(token)}' is not expected here`);
  }
  function exponential(column) {
    const value = group(), p = trim(value.num);
    if (value.delay || value.den.length > 1 || p.length > 2 || (p.length === 2 && p[1] !== 0)) fail(column, "the exponent of e is a number times s");
    if (p.length === 1) return poly(Math.exp(p[0] / value.den[0]));
    return { num: [1], den: [1], delay: -p[0] / value.den[0] };
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
  if (next().kind !== "end") fail(next().column, `'${shown(next())}' is not expected here`);
  return value;
}

function parsePlant(text) {
  const value = evaluate(text), num = trim(value.num), den = trim(value.den);
  if (isZero(num)) fail(1, "the plant is zero");
  if (value.delay < 0) fail(1, "the plant predicts; the dead time must not be negative");
  if (num.length >= den.length) fail(1, num.length > den.length ? "the plant is improper: its numerator has the higher degree" : "a plant that answers at once is not drawn here");
  if (den.length > 16) fail(1, "at most order 15 is drawn here");
  const numbers = [...num, ...den, value.delay];
  if (!numbers.every(Number.isFinite)) fail(1, "a coefficient is beyond any limit");
  return { num, den, deadTime: value.delay };
}

const NAMES = { k: "k", kp: "k", gain: "k", ki: "ki", kd: "kd", ti: "ti", integral_time: "ti", td: "td", derivative_time: "td", b: "b", derivative_filter: "filter" };

function parseController(text) {
  const given = {};
  let start = 1;
  for (const part of text.split(",")) {
    const [left, ...right] = part.split("="), name = NAMES[left.trim().toLowerCase()];
    if (!name) fail(start, `'${left.trim()}' is not known; allowed are k, ki, kd, ti, td, b, derivative_filter`);
    if (!right.length) fail(start, `a value is missing: ${name}=...`);
    if (name in given) fail(start, `${name} is given twice`);
    const plain = right.join("=").trim();
    const value = plain === "inf" && name === "ti" ? Infinity : constant(evaluate(plain));
    if (value === null || Number.isNaN(value) || (!Number.isFinite(value) && name !== "ti")) fail(start, `${name} must be a number`);
    given[name] = value;
    start += part.length + 1;
  }
  if (!("k" in given)) fail(1, "the gain is missing: k=...");
  if ("ki" in given && "ti" in given) fail(1, "ki and ti cannot both be given");
  if ("kd" in given && "td" in given) fail(1, "kd and td cannot both be given");
  if (given.filter < 0) fail(1, "derivative_filter must not be negative");
  const k = given.k;
  return {
    k, ki: "ti" in given ? k / given.ti : given.ki || 0, kd: "td" in given ? k * given.td : given.kd || 0,
    b: "b" in given ? given.b : 1, filter: given.filter || 0,
  };
}

// The controller as text; `digits` significant ones, all if not given.
function controllerText(controller, digits) {
  const text = (x) => (digits ? String(Number(x.toPrecision(digits))) : String(x));
  const parts = [`k=${text(controller.k)}`, `ki=${text(controller.ki)}`];
  if (controller.kd) parts.push(`kd=${text(controller.kd)}`, `derivative_filter=${text(controller.filter)}`);
  if (controller.b !== 1) parts.push(`b=${text(controller.b)}`);
  return parts.join(",");
}

return { parsePlant, parseController, controllerText, NotationError };
})();
