// The gain plane of a plant: where loops are stable, and what their sensitivity peak is.
"use strict";

const Plane = (() => {
const COLUMNS = 72, ROWS = 54; // cells of the map; only its curves between cells are interpolated

// Cells of a map: which corners are stable, and where they lie.
const cells = ({ box, stable }) => ({
  inside: (row, column) => stable[row * (COLUMNS + 1) + column],
  place: (row, column) => [box.left + (box.right - box.left) * column / COLUMNS, box.bottom + (box.top - box.bottom) * row / ROWS],
  ring: (row, column) => [[row, column], [row, column + 1], [row + 1, column + 1], [row + 1, column]],
});

// Gains with a pole on the imaginary axis.
function border(plant, controller, plane) {
  const corners = Kernel.sizes([...plant.poles, ...plant.zeros]);
  if (plant.deadTime) corners.push(1 / plant.deadTime);
  const points = [], end = Math.max(...corners, 1) * 40;
  for (let w = Math.min(...corners, 1) / 1e3; w < end; w *= 1.01) points.push(Kernel.boundary(plant, controller, plane, w));
  return points.filter((point) => point.every((gain) => Math.abs(gain) < 1e6));
}

const named = (controller, plane, x, y) => ({ ...controller, k: x, [plane]: y });

// The part of the plane that holds the stable gains that belong together with small ones, and the gains at hand.
function extent(plant, controller, plane) {
  const stable = border(plant, controller, plane);
  const kept = stable.filter(([x, y], i) => {
    const [nx, ny] = stable[Math.min(i + 1, stable.length - 1)], length = Math.hypot(nx - x, ny - y) || 1;
    const step = 0.02 * Math.hypot(x, y);
    return [1, -1].some((side) => {
      const point = named(controller, plane, x - side * step * (ny - y) / length, y + side * step * (nx - x) / length);
      return point[plane] >= 0 && i % 6 === 0 && Kernel.isStable(plant, point);
    });
  });
  const at = [controller.k, controller[plane]];
  const known = Kernel.isStable(plant, controller);
  if (!kept.length && !known) return null;
  const points = [...kept, ...(known ? [at] : []), [0, 0]];
  const xs = points.map(([x]) => x), ys = points.map(([, y]) => y);
  const box = { left: Math.min(...xs), right: Math.max(...xs), bottom: Math.min(0, ...ys), top: Math.max(...ys) };
  const wide = (box.right - box.left) || 1, tall = (box.top - box.bottom) || 1;
  return { left: box.left - 0.04 * wide, right: box.right + 0.06 * wide, bottom: box.bottom, top: box.top + 0.08 * tall };
}

// Stability and log Ms on a grid of the plane; the plant is evaluated once for each frequency.
function map(plant, controller, plane, box) {
  const w = Kernel.grid(plant, { ...controller, k: box.right, [plane]: box.top }, 0.2);
  const step = Math.max(1, Math.floor(w.length / 500)), table = [];
  for (let i = 0; i < w.length; i += step) {
    const [pr, pi] = Kernel.plantAt(plant, w[i]);
    const part = Kernel.controllerAt({ ...controller, k: 0, [plane]: 0 }, w[i]);
    const unit = Kernel.controllerAt({ ...controller, k: 0, ki: 0, kd: 0, [plane]: 1 }, w[i]);
    table.push([pr, pi, ...part, ...unit]);
  }
  const stable = [], level = [];
  for (let row = 0; row <= ROWS; row++) {
    for (let column = 0; column <= COLUMNS; column++) {
      const x = box.left + (box.right - box.left) * column / COLUMNS, y = box.bottom + (box.top - box.bottom) * row / ROWS;
      const here = Kernel.isStable(plant, named(controller, plane, x, y || 1e-9 * box.top));
      stable.push(here);
      if (!here) { level.push(Infinity); continue; }
      let least = Infinity;
      for (const [pr, pi, fr, fi, ur, ui] of table) {
        const cr = x + fr + y * ur, ci = fi + y * ui;
        const re = 1 + pr * cr - pi * ci, im = pr * ci + pi * cr;
        least = Math.min(least, re * re + im * im);
      }
      level.push(-Math.log(least) / 2);
    }
  }
  return { box, stable, level };
}

// Segments between cells where a field on the grid crosses a level: marching squares.
function contour(map, value) {
  const segments = [], { inside, place, ring: ringOf } = cells(map), at = (row, column) => map.level[row * (COLUMNS + 1) + column];
  for (let row = 0; row < ROWS; row++) {
    for (let column = 0; column < COLUMNS; column++) {
      const ring = ringOf(row, column);
      if (!ring.every(([r, c]) => inside(r, c))) continue;
      const cuts = [];
      for (let i = 0; i < 4; i++) {
        const [one, other] = [ring[i], ring[(i + 1) % 4]], a = at(...one) - value, b = at(...other) - value;
        if ((a < 0) !== (b < 0)) cuts.push(place(one[0] + (other[0] - one[0]) * a / (a - b), one[1] + (other[1] - one[1]) * a / (a - b)));
      }
      for (let i = 0; i + 1 < cuts.length; i += 2) segments.push([cuts[i], cuts[i + 1]]);
    }
  }
  return segments;
}

// The stable cells as polygons, their corners on the border found by bisection with the exact test.
function region(map, plant, controller, plane) {
  const polygons = [], { inside, place, ring: ringOf } = cells(map);
  const test = ([x, y]) => Kernel.isStable(plant, named(controller, plane, x, y || 1e-9 * map.box.top));
  const known = new Map();
  const between = (one, other) => {
    const key = [one, other].map(([r, c]) => r * (COLUMNS + 1) + c).sort((a, b) => a - b).join();
    if (!known.has(key)) {
      let a = place(...one), b = place(...other);
      const start = inside(...one);
      for (let i = 0; i < 7; i++) {
        const middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
        if (test(middle) === start) a = middle; else b = middle;
      }
      known.set(key, [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]);
    }
    return known.get(key);
  };
  for (let row = 0; row < ROWS; row++) {
    let run = -1; // whole cells side by side are one rectangle
    for (let column = 0; column <= COLUMNS; column++) {
      const ring = ringOf(row, column);
      const count = column < COLUMNS ? ring.filter(([r, c]) => inside(r, c)).length : 0;
      if (count === 4 && run < 0) run = column;
      if (count !== 4 && run >= 0) {
        polygons.push([place(row, run), place(row, column), place(row + 1, column), place(row + 1, run)]);
        run = -1;
      }
      if (count === 0 || count === 4) continue;
      const polygon = [];
      for (let i = 0; i < 4; i++) {
        const [one, other] = [ring[i], ring[(i + 1) % 4]];
        if (inside(...one)) polygon.push(place(...one));
        if (inside(...one) !== inside(...other)) polygon.push(between(one, other));
      }
      polygons.push(polygon);
    }
  }
  return polygons;
}

return { border, extent, map, contour, region };
})();
