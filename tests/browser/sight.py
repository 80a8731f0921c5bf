"""What tests see of a page in a browser, and what they ask of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

# What depends on the width of the window, and on the colours; all other rules are tried once per page.
BY_WIDTH = ["target-size", "scrollable-region-focusable", "meta-viewport"]
BY_COLOURS = ["color-contrast", "link-in-text-block"]

# A drawing, a formula and a listing are one thing each to a reader, and of rows and entries built alike, of the
# same elements with the same classes, one stands for all: thousands of parts would take minutes and find nothing else.
FOLD = """() => {
  for (const part of document.querySelectorAll("svg[role=img] > :not(title, desc)")) part.remove();
  for (const one of document.querySelectorAll("math")) {
    const text = document.createElement("span");
    text.textContent = one.textContent;
    one.replaceWith(text);
  }
  for (const one of document.querySelectorAll("pre > code")) one.textContent = one.textContent;
  const seen = new Set();
  for (const one of document.querySelectorAll("tbody, tbody > tr, .claims > li, .notes > li, .hits > li, .exhibit")) {
    const parts = one.outerHTML.match(/<[a-z][^>]*>/g).map((tag) => {
      const names = tag.match(/ class="[^"]*"| role="[^"]*"| type="[^"]*"/g) ?? [];
      return tag.match(/<[a-z0-9]+/)[0] + names.join("");
    });
    const built = [...new Set(parts)].sort().join();
    if (seen.has(built)) one.remove();
    seen.add(built);
  }
}"""
UNFOLDED = """() => {
  const sheet = document.styleSheets[0];
  sheet.insertRule(".exhibit { content-visibility: visible !important; }", sheet.cssRules.length);
}"""
SETTLED = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 50))))"
# Where a page is wider than the window: what sticks out, and is in no region that scrolls by itself.
SIDEWAYS = """() => document.documentElement.scrollWidth <= innerWidth ? [] :
  [`${document.documentElement.scrollWidth} px`, ...[...document.querySelectorAll("body *")]
    .filter((e) => e.getBoundingClientRect().right > innerWidth + 1 && !e.closest(".scroll, .drawing, pre, svg"))
    .slice(0, 5).map((e) => e.outerHTML.slice(0, 120))]"""
# Drawings whose letters are smaller than 11 pixels: an index may be, at seven tenths of what it belongs to.
SMALL = """() => [...document.querySelectorAll("figure svg[role=img]")]
  .map((e) => [e.id, e.getBoundingClientRect().width / e.viewBox.baseVal.width * e.style.getPropertyValue("--type")])
  .filter(([, size]) => size && size < 10.99)"""
STOPS = """() => [...document.querySelectorAll("[tabindex='0']")]
  .filter((e) => e.checkVisibility() && e.scrollWidth <= e.clientWidth + 1 && e.scrollHeight <= e.clientHeight + 1)
  .map((e) => e.outerHTML.slice(0, 120))"""

# How many pixels the seam between two pictures is away from the middle of its slider's thumb, and the pictures from it.
SEAM = """() => {
  const pair = document.querySelector(".pair"), slider = pair.querySelector("input");
  slider.value = 25;
  slider.dispatchEvent(new Event("input"));
  const seam = getComputedStyle(pair, "::after").marginLeft, box = slider.getBoundingClientRect();
  const left = pair.getBoundingClientRect().left, thumb = box.left + 8 + (box.width - 16) / 4;
  const pictures = [...pair.querySelectorAll("img, svg[role=img]")].map((one) => one.getBoundingClientRect());
  return [left + parseFloat(seam) + 1 - thumb, ...pictures.map((one) => one.left + one.width / 4 - thumb)];
}"""


class Sight:
    """A page in a browser, and what went wrong in it."""

    def __init__(self, browser: Any, path: Path, width: int = 1280, **options: Any) -> None:
        self.page = browser.new_page(viewport={"width": width, "height": 900}, **options)
        self.wrong: list[str] = []
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("console", lambda message: self.wrong.append(message.text) if message.type == "error" else None)
        self.page.on("request", lambda one: None if one.url.startswith("file:") else self.wrong.append(one.url))
        self.page.goto(path.as_uri())

    def __enter__(self) -> Any:
        return self.page

    def __exit__(self, *_: object) -> None:
        self.page.close()
        assert self.wrong == []  # nothing raised, nothing was fetched, the policy was not violated


def violations(page: Any, axe: str, rules: list[str] | None = None) -> list[Any]:
    options: dict[str, Any] = {"resultTypes": ["violations"]}
    if rules:
        options["runOnly"] = {"type": "rule", "values": rules}
    if not page.evaluate("Boolean(window.axe)"):
        page.evaluate(axe)  # through the debugger: the page's policy allows its own script only
    found = page.evaluate("(options) => axe.run(document, options)", options)
    return [(v["id"], [node["html"][:160] for node in v["nodes"]][:5]) for v in found["violations"]]
