// Plant, controller and loop on the imaginary axis. A plant is {num, den, deadTime}, coefficients in descending powers of
// s; a controller is {k, ki, kd, b, c, filter, prefilter}: u = k (b r - y) + ki/s (r - y) + kd s/(1 + s filter) (c r - y),
// where the set-point passes 1/(1 + s prefilter) first.

import { add, divide, multiply, onAxis, roots, sizes, times, trimmed } from "./polynomials.js";

// A plant with what later steps ask of it; poles and zeros that are known better come along.
export function prepare(plant) {
  const [den, num] = [plant.den, plant.num].map((p) => trimmed(p).map((a) => a / trimmed(plant.den)[0]));
  return { poles: roots(den), zeros: roots(num), ...plant, num, den, order: den.length - 1, relativeDegree: den.length - num.length };
}

// P(i w), with the dead time.
export function plantAt({ num, den, deadTime }, w) {
  return times(divide(onAxis(num, w), onAxis(den, w)), [Math.cos(w * deadTime), -Math.sin(w * deadTime)]);
}

// C(i w) from the measurement to the control signal, sign reversed.
export function controllerAt({ k, ki, kd, filter }, w) {
  const [re, im] = kd ? divide([0, kd * w], [1, w * filter]) : [0, 0];
  return [k + re, ki ? im - ki / w : im];
}

export const loopAt = (plant, controller, w) => times(plantAt(plant, w), controllerAt(controller, w));

// The characteristic quasi-polynomial free(s) + delayed(s) exp(-s L).
export function characteristic(plant, { k, ki, kd, filter }) {
  const lag = kd ? [filter, 1] : [1], integrator = ki ? [1, 0] : [1];
  const feedback = add(add(multiply([k], multiply(integrator, lag)), multiply([ki], lag)), multiply([kd, 0], integrator));
  return {
    free: trimmed(multiply(plant.den, multiply(integrator, lag))),
    delayed: trimmed(multiply(plant.num, feedback)),
    corners: [...plant.poles, ...plant.zeros, ...roots(feedback), ...roots(lag)], // roots of both, the slow ones once
  };
}

// A controller with two of its gains given: those of a point of the gain plane.
export const named = (controller, plane, k, other) => ({ ...controller, k, [plane]: other });

// The frequency from which on something is no longer loud, near a guess.
export function quietFrom(loud, guess) {
  let w = guess;
  for (let i = 0; i < 200 && loud(w); i++) w *= 1.3;
  for (let i = 0; i < 200 && !loud(w / 1.3); i++) w /= 1.3;
  return w;
}

export const fastest = (poles) => Math.max(0, ...sizes(poles));
