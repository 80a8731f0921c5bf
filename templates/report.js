"use strict";
// What a page of the report can do beyond reading: nothing here is needed to read it.

// The contents are open where there is room beside the text; the style sheet does the same in newer browsers.
for (const contents of document.querySelectorAll("details.contents")) contents.open = matchMedia("(min-width: 76rem)").matches;

// ---------------------------------------------------------------------------------------------- copying

async function copy(text, button) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = Object.assign(document.createElement("textarea"), { value: text });
    button.after(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  const said = button.textContent;
  button.textContent = "copied";
  setTimeout(() => (button.textContent = said), 1200);
}

// What is written somewhere, formulas in one line, without the links that lead elsewhere.
function text(node) {
  const copy = node?.cloneNode(true);
  for (const part of copy?.querySelectorAll?.(".try, .cases, math[alttext]") ?? []) part.replaceWith(part.getAttribute("alttext") ?? "");
  const formula = copy?.getAttribute?.("alttext");
  return (formula ?? copy?.textContent ?? "").trim().replace(/\s+/g, " ");
}
const csvField = (value) => (/[",\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
const csv = (rows) => rows.map((row) => row.map((cell) => csvField(cell.replaceAll("−", "-"))).join(",")).join("\n");

const MATH = { "−": "-", "→": "\\to", "≈": "\\approx", "≠": "\\ne", "≤": "\\le", "≥": "\\ge", "∈": "\\in", "∞": "\\infty", "±": "\\pm", "×": "\\times", "⋅": "\\cdot", "√": "\\surd", "∑": "\\sum", "⋆": "\\star", "′": "'", "ϕ": "\\phi", "ϵ": "\\epsilon" };
const TEX = { "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "²": "\\textsuperscript{2}", "³": "\\textsuperscript{3}", "\u00a0": "~", "\u2061": " " };
const ACCENTS = { "\u0302": "hat", "\u0305": "overline" };
const letters = (first, names) => names.split(" ").forEach((name, place) => (MATH[String.fromCodePoint(first.codePointAt() + place)] = `\\${name}`));
letters("α", "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi mathrm{o} pi rho varsigma sigma tau upsilon phi chi psi omega");
letters("Γ", "Gamma Delta mathrm{E} mathrm{Z} mathrm{H} Theta mathrm{I} mathrm{K} Lambda mathrm{M} mathrm{N} Xi mathrm{O} Pi mathrm{P} mathrm{} Sigma mathrm{T} Upsilon Phi mathrm{X} Psi Omega");
const tex = (value) =>
  value.replace(/(.)([\u0302\u0305])|[\\~^&%#_{}$]|[^\0-~]/gu, (sign, base, accent) => {
    if (accent) return `$\\${ACCENTS[accent]}{${MATH[base] ?? base}}$`;
    return MATH[sign] ? `$${MATH[sign]}$` : (TEX[sign] ?? (sign > "~" ? sign : `\\${sign}`));
  });
const tabular = (rows) => {
  const lines = rows.map((row) => `  ${row.map(tex).join(" & ")} \\\\`);
  return [`\\begin{tabular}{l${"r".repeat(rows[0].length - 1)}}`, lines[0], "  \\hline", ...lines.slice(1), "\\end{tabular}"].join("\n");
};

function button(label, action) {
  const made = Object.assign(document.createElement("button"), { type: "button", textContent: label });
  made.addEventListener("click", () => action(made));
  return made;
}

// The rows of a card: where, and what is printed, computed and right; below a value stands what is said of it.
function cardRows(card) {
  const link = card.querySelector(".card-title");
  const rows = [["cell", "what", "value", "remark"]];
  for (const term of card.querySelectorAll("dt")) {
    const [value, ...remarks] = term.nextElementSibling.textContent.trim().split("\n");
    rows.push([text(link), text(term), value, remarks.join(" ")]);
  }
  rows.push([text(link), "verdict", text(card.querySelector(".badge")), ""]);
  return rows;
}

function cardTools(card) {
  if (card.querySelector(".tools")) return;
  const tools = Object.assign(document.createElement("p"), { className: "tools" });
  const address = card.querySelector(".card-title");
  tools.append(
    button("copy address", (self) => copy(address.href, self)),
    button("copy as CSV", (self) => copy(csv(cardRows(card)), self)),
    button("copy as TeX", (self) => copy(tabular(cardRows(card)), self)),
  );
  const close = button("×", () => {
    if (card.matches(":popover-open")) card.hidePopover();
    else location.hash = card.closest(".exhibit").id; // it was open because the address names its cell
  });
  close.className = "close";
  close.setAttribute("aria-label", "Close");
  card.append(tools, close);
}

for (const card of document.querySelectorAll(".card")) {
  card.addEventListener("toggle", () => cardTools(card));
}
function toolsOfTarget() {
  const card = document.querySelector("td:target > .card");
  if (card) cardTools(card);
}
for (const moment of ["load", "hashchange"]) addEventListener(moment, toolsOfTarget);

// The names of all columns; one under a common head has that in its name.
function headNames(table) {
  const names = [];
  let place = 0;
  for (const head of table.tHead.rows[0].cells) {
    for (let i = 0; i < head.colSpan; i += 1, place += 1) {
      const own = place && table.tHead.querySelector(`[data-c="${place}"]`);
      names.push(own && own !== head ? `${text(own.firstChild)}, ${text(head)}` : text((own || head).firstChild));
    }
  }
  return names;
}

// A table as it is seen: hidden rows, cards and signs are left out. What a reading computes is named with its row.
function tableRows(table) {
  const rows = [headNames(table)];
  for (const row of [...table.tBodies].flatMap((body) => [...body.rows])) {
    if (!row.checkVisibility()) continue;
    const [head, ...cells] = row.cells;
    const names = row.matches(".by") ? [row.parentElement.rows[0].cells[0], head] : [head];
    const values = cells.flatMap((cell) => {
      const own = [...cell.childNodes].filter((node) => node.nodeType === 3);
      return [own.map(text).join(" ").trim(), ...Array(cell.colSpan - 1).fill("")];
    });
    rows.push([names.map(text).join(", "), ...values]);
  }
  return rows;
}

for (const exhibit of document.querySelectorAll(".exhibit")) {
  const tables = exhibit.querySelectorAll("table.values");
  const files = exhibit.querySelector(".files");
  if (!tables.length || !files) continue;
  const banded = exhibit.querySelector(".bands"); // each band has columns, and so a head, of its own
  const rows = () => [...tables].flatMap((table, place) => tableRows(table).slice(place && !banded ? 1 : 0));
  files.append(
    button("copy as CSV", (self) => copy(csv(rows()), self)),
    button("copy as TeX", (self) => copy(tabular(rows()), self)),
  );
}

// ---------------------------------------------------------------------------------------------- sorting

const number = (cell) => Number.parseFloat(text(cell?.firstChild).replaceAll("−", "-"));

function sort(table, column, head) {
  const upward = head.getAttribute("aria-sort") !== "ascending";
  for (const other of table.tHead.querySelectorAll("th")) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", upward ? "ascending" : "descending");
  // The print decides; where nothing is printed, what is computed.
  const value = (body) => [...body.rows].map((row) => number(row.cells[column])).find((one) => !Number.isNaN(one));
  const keyed = [...table.tBodies].map((body, place) => ({ body, place, key: value(body) }));
  keyed.sort((a, b) => {
    if (a.key === undefined || b.key === undefined) return (a.key === undefined) - (b.key === undefined) || a.place - b.place;
    return (upward ? a.key - b.key : b.key - a.key) || a.place - b.place;
  });
  table.append(...keyed.map((entry) => entry.body));
}

for (const table of document.querySelectorAll(".bleed:not(.bands) > .scroll:not(.stretches) > table.values")) {
  if (table.tBodies.length < 6) continue;
  table.tHead.querySelectorAll("[data-c]").forEach((head) => {
    const column = Number(head.dataset.c);
    const sorter = button("", () => sort(table, column, head));
    sorter.className = "sorter";
    sorter.title = `sort by ${text(head.firstChild)}`;
    head.append(sorter);
  });
}

// ---------------------------------------------------------------------------------------------- figures

const REACH = 28; // pixels from a curve within which it is read

const limits = (element, axis) => {
  const [low, high, scale] = element.dataset[axis].split(" ");
  return { low: Number(low), high: Number(high), log: scale === "log" };
};

// From a place in the drawing to the value of an axis; `share` runs from 0 at the low limit to 1 at the high one.
function valueAt({ low, high, log }, share) {
  return log ? low * (high / low) ** share : low + (high - low) * share;
}

const shown = (value) => {
  const small = Math.abs(value);
  const said = small !== 0 && (small < 1e-3 || small >= 1e5) ? value.toExponential(3) : String(Number(value.toPrecision(4)));
  return said.replaceAll("-", "−");
};

// The pieces of a path that matplotlib wrote: "M x y L x y ..." with breaks.
function pieces(path) {
  const found = [];
  for (const part of path.getAttribute("d").split("M").slice(1)) {
    const numbers = part.match(/-?[\d.]+(?:e-?\d+)?/g)?.map(Number) ?? [];
    const points = [];
    for (let i = 0; i + 1 < numbers.length; i += 2) points.push([numbers[i], numbers[i + 1]]);
    if (points.length) found.push(points);
  }
  return found;
}

// The nearest point of polylines, in the drawing's own units.
function nearest(lines, [x, y]) {
  let best = { distance: Infinity };
  for (const points of lines) {
    for (let i = 0; i < points.length; i += 1) {
      const [ax, ay] = points[i];
      const [bx, by] = points[Math.min(i + 1, points.length - 1)];
      const [dx, dy] = [bx - ax, by - ay];
      const length = dx * dx + dy * dy;
      const along = length ? Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / length)) : 0;
      const point = [ax + along * dx, ay + along * dy];
      const distance = Math.hypot(point[0] - x, point[1] - y);
      if (distance < best.distance) best = { distance, point };
    }
  }
  return best;
}

// The names of curves as a page writes them, by what the drawing calls them.
function namesOf(drawing) {
  const names = drawing.parentElement.querySelectorAll(".names > li");
  return new Map([...names].map((one) => [one.dataset.name, one]));
}

function readOut(drawing, svg) {
  const box = Object.assign(document.createElement("div"), { className: "read-out", hidden: true });
  const dot = document.createElementNS(svg.namespaceURI, "circle");
  dot.setAttribute("r", "3");
  dot.setAttribute("visibility", "hidden");
  svg.append(dot);
  drawing.append(box);
  const lines = new Map();
  const names = namesOf(drawing);
  const away = () => {
    box.hidden = true;
    dot.setAttribute("visibility", "hidden");
  };
  svg.addEventListener("pointerleave", away);
  svg.addEventListener("pointermove", (event) => {
    const matrix = svg.getScreenCTM();
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    let best = { distance: REACH / matrix.a };
    for (const axes of svg.querySelectorAll("[data-box]")) {
      const [left, top, right, bottom] = axes.dataset.box.split(" ").map(Number);
      if (at.x < left || at.x > right || at.y < top || at.y > bottom) continue;
      for (const curve of axes.querySelectorAll("[data-curve]:not(.off)")) {
        if (!lines.has(curve)) lines.set(curve, pieces(curve.querySelector("path")));
        const found = nearest(lines.get(curve), [at.x, at.y]);
        if (found.distance < best.distance) best = { ...found, axes, name: curve.dataset.curve, edges: [left, top, right, bottom] };
      }
    }
    if (!best.point) return away();
    const [left, top, right, bottom] = best.edges;
    const x = valueAt(limits(best.axes, "x"), (best.point[0] - left) / (right - left));
    const y = valueAt(limits(best.axes, "y"), (bottom - best.point[1]) / (bottom - top));
    const name = names.get(best.name)?.cloneNode(true).childNodes ?? [best.name];
    box.replaceChildren(...name, `${best.name ? ": " : ""}${shown(y)} at ${shown(x)}`);
    dot.setAttribute("cx", best.point[0]);
    dot.setAttribute("cy", best.point[1]);
    dot.setAttribute("visibility", "visible");
    box.hidden = false;
    const frame = drawing.getBoundingClientRect();
    const place = event.clientX - frame.left + drawing.scrollLeft;
    box.style.left = `${Math.max(0, Math.min(place + 12, drawing.scrollLeft + frame.width - box.offsetWidth - 4))}px`;
    box.style.top = `${Math.max(0, event.clientY - frame.top - box.offsetHeight - 10)}px`;
  });
}

function curveTools(drawing, svg) {
  const tools = Object.assign(document.createElement("div"), { className: "curves" });
  const drawn = [...namesOf(drawing)].filter(([name]) => svg.querySelector(`[data-curve="${CSS.escape(name)}"]`));
  for (const [name, written] of drawn.length > 1 ? drawn : []) {
    const parts = svg.querySelectorAll(`[data-curve="${CSS.escape(name)}"], [data-legend="${CSS.escape(name)}"]`);
    const toggle = button("", () => {
      const on = toggle.getAttribute("aria-pressed") === "false";
      toggle.setAttribute("aria-pressed", String(on));
      for (const part of parts) part.classList.toggle("off", !on);
    });
    toggle.append(...written.cloneNode(true).childNodes);
    toggle.setAttribute("aria-label", text(written)); // a formula has no part in the name of what holds it
    toggle.setAttribute("aria-pressed", "true");
    for (const part of parts) if (part.dataset.legend) part.addEventListener("click", () => toggle.click());
    tools.append(toggle);
  }
  tools.append(
    button("enlarge", () => {
      const dialog = document.createElement("dialog");
      const place = document.createComment("drawing");
      drawing.before(place);
      dialog.setAttribute("aria-label", drawing.getAttribute("aria-label"));
      dialog.append(button("close", () => dialog.close()), drawing);
      dialog.addEventListener("close", () => {
        place.replaceWith(drawing);
        dialog.remove();
      });
      document.body.append(dialog);
      dialog.showModal();
    }),
  );
  drawing.after(tools);
}

for (const drawing of document.querySelectorAll(".drawing")) {
  const svg = drawing.querySelector("svg");
  if (!svg) continue;
  if (svg.querySelector("[data-box]")) readOut(drawing, svg);
  curveTools(drawing, svg);
}
