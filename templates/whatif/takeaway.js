// What one takes away: the loop as Python lines, its curves as a table, its diagrams as one picture.

import { DATA } from "./data.js";
import { controllerText } from "./notation.js";
import { set, SVG } from "./charts.js";
import { $, everyone, say } from "./views.js";

export async function copy(text, done) {
  try { await navigator.clipboard.writeText(text); say("done", done); } catch { Object.assign($("copied"), { hidden: false, value: text }).select(); }
}

export function download(name, type, text) {
  const link = document.createElement("a");
  link.href = `data:${type};charset=utf-8,${encodeURIComponent(text)}`;
  link.download = name;
  link.click();
}

export const python = ({ plantText, controller }) => DATA.python.replace("PLANT", () => JSON.stringify(plantText)).replace("CONTROLLER", JSON.stringify(controllerText(controller)));

// The responses of all stable loops.
export function curves(state) {
  const signals = everyone(state).filter(({ measured }) => measured.stable).flatMap(({ name, measured }) => Array.from(document.querySelectorAll("[data-signal]"), ({ dataset }) => (
    { column: (name === "now" ? "" : `${name}_`) + dataset.column, response: measured[dataset.from], signal: dataset.signal }
  )));
  const end = Math.min(...signals.map(({ response }) => response.end)), lines = [["t", ...signals.map(({ column }) => column)]];
  for (let i = 0; i <= 2000; i++) lines.push([end * i / 2000, ...signals.map(({ response, signal }) => response.at(response[signal], end * i / 2000))].map((x) => Number(x.toPrecision(12))));
  return lines.map((line) => `${line.join()}\n`).join("");
}

export function picture() {
  let y = 0;
  const parts = Array.from(document.querySelectorAll("#main svg"), (svg) => {
    const copyOf = svg.cloneNode(true), { width, height } = svg.viewBox.baseVal;
    set(copyOf, { x: 5, y, width, height, style: `width:${width}px;height:${height}px` });
    y += height + 10;
    return new XMLSerializer().serializeToString(copyOf);
  });
  const style = document.querySelector("style").textContent.replace(/[<&]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<svg xmlns="${SVG}" viewBox="0 0 470 ${y}" width="470" height="${y}"><style>${style}</style>${parts.join("")}</svg>`;
}
