// What one takes away: the loop as Python lines, its curves as a table, its diagrams as one picture.

import { DATA } from "./data.js";
import { controllerText } from "./notation.js";
import { SVG } from "./charts.js";
import { $, everyone, say } from "./views.js";

export async function copy(text, done) {
  try { await navigator.clipboard.writeText(text); say("done", done); } catch { $("copied").hidden = false; $("copied").value = text; $("copied").select(); }
}

export function download(name, type, text) {
  const link = document.createElement("a");
  link.href = `data:${type};charset=utf-8,${encodeURIComponent(text)}`;
  link.download = name;
  link.click();
}

export const python = ({ plantText, controller }) => DATA.python.replace("PLANT", () => JSON.stringify(plantText)).replace("CONTROLLER", JSON.stringify(controllerText(controller)));

// Stable loops only.
export function curves(state) {
  const signals = everyone(state).filter(({ measured }) => measured.stable).flatMap(({ name, measured: { step, load } }) => {
    const before = name === "now" ? "" : `${name}_`;
    return [[`${before}y_setpoint`, step, step.output], [`${before}u_setpoint`, step, step.control], [`${before}y_load`, load, load.output], [`${before}u_load`, load, load.control]];
  });
  const end = Math.min(...signals.map(([, { end: its }]) => its)), lines = [["t", ...signals.map(([name]) => name)]];
  for (let i = 0; i <= 2000; i++) lines.push([end * i / 2000, ...signals.map(([, response, values]) => response.at(values, end * i / 2000))].map((x) => Number(x.toPrecision(12))));
  return lines.map((line) => `${line.join()}\n`).join("");
}

export function picture() {
  let y = 0;
  const parts = ["plane", "nyquist", "output", "control", "load"].map((id) => {
    const copyOf = $(id).cloneNode(true), { width, height } = $(id).viewBox.baseVal;
    for (const [name, value] of Object.entries({ x: 5, y, width, height, style: `width:${width}px;height:${height}px` })) copyOf.setAttribute(name, value);
    y += height + 10;
    return new XMLSerializer().serializeToString(copyOf);
  });
  const style = document.querySelector("style").textContent.replace(/[<&]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<svg xmlns="${SVG}" viewBox="0 0 470 ${y}" width="470" height="${y}"><style>${style}</style>${parts.join("")}</svg>`;
}
