// The gain plane of a plant: where loops are stable, and what their sensitivity peak is.

import { root } from "./chebyshev.js";
import { divide, sizes } from "./polynomials.js";
import { controllerAt, named, plantAt } from "./loop.js";
import { isStable } from "./poles.js";
import { grid } from "./margins.js";

const COLUMNS = 72, ROWS = 54; // cells of the map; only its curves between cells are interpolated

const at = (field, [row, column]) => field[row * (COLUMNS + 1) + column];
// All [row, column]; the cells, each as its corners with the next ones.
const CORNERS = Array.from({ length: (ROWS + 1) * (COLUMNS + 1) }, (_, i) => [Math.floor(i / (COLUMNS + 1)), i % (COLUMNS + 1)]);
const CELLS = CORNERS.filter(([row, column]) => row < ROWS && column < COLUMNS).map(([row, column]) => {
  const ring = [[row, column], [row, column + 1], [row + 1, column + 1], [row + 1, column]];
  return ring.map((corner, i) => [corner, ring[(i + 1) % 4]]);
});

// Two of the three gains at which a closed-loop pole lies at i w; `plane` is "ki" (kd fixed) or "kd" (ki fixed).
function boundary(plant, controller, plane, w) {
  const [re, im] = divide([-1, 0], plantAt(plant, w)); // C(i w) must be this
  const [dr, di] = divide([0, w], [1, w * controller.filter]); // the derivative part for kd = 1
  const kd = plane === "ki" ? controller.kd : (im + controller.ki / w) / di;
  return [re - kd * dr, plane === "ki" ? (kd * di - im) * w : kd];
}

// Gains with a pole on the imaginary axis.
export function border(plant, controller, plane) {
  const scales = [1 / (plant.deadTime || 1), ...sizes([...plant.poles, ...plant.zeros])];
  const points = [], end = Math.max(...scales) * 40;
  for (let w = Math.min(...scales) / 1e3; w < end; w *= 1.01) points.push(boundary(plant, controller, plane, w));
  return points.filter((point) => point.every((gain) => Math.abs(gain) < 1e6));
}

// The part of the plane with the stable gains next to small ones and the gains at hand.
export function extent(plant, controller, plane) {
  const curve = border(plant, controller, plane), sign = Math.sign(plant.num.at(-1)) || 1; // the integral gain has the plant's
  const points = curve.filter(([x, y], i) => {
    if (i % 6) return false;
    const [nx, ny] = curve[Math.min(i + 1, curve.length - 1)], length = Math.hypot(nx - x, ny - y) || 1, step = 0.02 * Math.hypot(x, y) / length;
    return [step, -step].some((side) => {
      const point = named(controller, plane, x - side * (ny - y), y + side * (nx - x));
      return sign * point[plane] >= 0 && isStable(plant, point);
    });
  });
  if (isStable(plant, controller)) points.push([controller.k, controller[plane]]);
  if (!points.length) return null;
  points.push([0, 0]);
  const [[left, right], [bottom, top]] = [0, 1].map((i) => [Math.min, Math.max].map((end) => end(...points.map((point) => point[i]))));
  const wide = (right - left) || 1, tall = 0.08 * ((top - bottom) || 1);
  return { left: left - 0.04 * wide, right: right + 0.06 * wide, bottom: bottom < 0 ? bottom - tall : 0, top: top > 0 || !bottom ? top + tall : 0 };
}

// Stability and log Ms on a grid of the plane; the plant is evaluated once for each frequency.
export function gainMap(plant, controller, plane, box) {
  const { w } = grid(plant, named(controller, plane, box.right, box.top || box.bottom), 0.2), table = [];
  for (let i = 0; i < w.length; i += Math.max(1, Math.floor(w.length / 500))) {
    const fixed = controllerAt(named(controller, plane, 0, 0), w[i]), unit = controllerAt(named({ ki: 0, kd: 0, filter: controller.filter }, plane, 0, 1), w[i]);
    table.push([...plantAt(plant, w[i]), ...fixed, ...unit]);
  }
  const logMs = ([x, y]) => {
    let least = Infinity;
    for (const [pr, pi, fr, fi, ur, ui] of table) {
      const cr = x + fr + y * ur, ci = fi + y * ui, re = 1 + pr * cr - pi * ci, im = pr * ci + pi * cr;
      least = Math.min(least, re * re + im * im);
    }
    return -Math.log(least) / 2;
  };
  const place = ([row, column]) => [box.left + (box.right - box.left) * column / COLUMNS, box.bottom + (box.top - box.bottom) * row / ROWS];
  const stableAt = ([x, y]) => isStable(plant, named(controller, plane, x, y || 1e-9 * (box.top + box.bottom)));
  const points = CORNERS.map(place), stable = points.map(stableAt), level = points.map((point, i) => (stable[i] ? logMs(point) : Infinity));
  return { place, stable, level, stableAt, logMs };
}

// Segments where log Ms crosses a level: marching squares, ends found exactly.
export function contour({ place, stable, level, logMs }, value) {
  return CELLS.filter((cell) => cell.every(([corner]) => at(stable, corner))).flatMap((cell) => {
    const cut = cell.filter(([one, other]) => (at(level, one) < value) !== (at(level, other) < value)).map(([one, other]) => {
      const between = (part) => place(one.map((index, i) => index + (other[i] - index) * part));
      return between(root((part) => logMs(between(part)) - value, 0, 1));
    });
    return [cut.slice(0, 2), cut.slice(2)].filter((segment) => segment.length);
  });
}

// The stable cells as polygons, their corners on the border found by bisection, to a fifth of a pixel.
export function region({ place, stable, stableAt }) {
  const between = (one, other) => {
    let a = place(one), b = place(other);
    for (let i = 0; i < 5; i++) {
      const middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
      if (stableAt(middle) === at(stable, one)) a = middle; else b = middle;
    }
    return a;
  };
  return CELLS.map((cell) => cell.flatMap(([one, other]) => {
    const here = at(stable, one);
    return [...(here ? [place(one)] : []), ...(here === at(stable, other) ? [] : [between(one, other)])];
  })).filter((polygon) => polygon.length);
}
