"""The report of the bundled papers in a real browser: accessible, light, quiet, usable on a phone and by keyboard.

The results come from the same cache as those of `make report` and `make check`.
"""

from __future__ import annotations

import csv
import io
import re
import sys
from pathlib import Path
from typing import Any

import pytest

from replicate import cli
from replicate.report.pages import INDEX, SEARCH

ROOT = Path(__file__).parents[2]
MOST_BYTES, MOST_ELEMENTS, MOST_SCRIPT = 2_000_000, 25_000, 30_000

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
  [...document.querySelectorAll("body *")]
    .filter((e) => e.getBoundingClientRect().right > innerWidth + 1 && !e.closest(".scroll, .drawing, pre, svg"))
    .slice(0, 5).map((e) => e.outerHTML.slice(0, 120))"""
STOPS = """() => [...document.querySelectorAll("[tabindex='0']")]
  .filter((e) => e.checkVisibility() && e.scrollWidth <= e.clientWidth + 1 && e.scrollHeight <= e.clientHeight + 1)
  .map((e) => e.outerHTML.slice(0, 120))"""


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory, browser: Any) -> Path:
    """Build the report of the bundled papers; without a browser nothing is built."""
    assert browser
    out = tmp_path_factory.mktemp("bundled")
    kept = ROOT / "build" / "cache"
    kept.mkdir(parents=True, exist_ok=True)
    (out / "cache").symlink_to(kept)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["replicate", "report", "--bundled", "--out", str(out)])
        with pytest.raises(SystemExit):
            cli.main()
    return out / "report"


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


def pages(report: Path) -> list[Path]:
    return sorted(report.glob("*.html"))


def violations(page: Any, axe: str, rules: list[str] | None = None) -> list[Any]:
    options: dict[str, Any] = {"resultTypes": ["violations"]}
    if rules:
        options["runOnly"] = {"type": "rule", "values": rules}
    if not page.evaluate("Boolean(window.axe)"):
        page.evaluate(axe)  # through the debugger: the page's policy allows its own script only
    found = page.evaluate("(options) => axe.run(document, options)", options)
    return [(v["id"], [node["html"][:160] for node in v["nodes"]][:5]) for v in found["violations"]]


def test_no_page_is_heavy(report: Path) -> None:
    names = {page.name for page in pages(report)}
    assert {INDEX, SEARCH, "errata.html", "methods.html", "whatif.html", "khan.html", "panagopoulos-I.html"} <= names
    for page in pages(report):
        text = page.read_text(encoding="utf-8")
        assert len(text.encode()) <= MOST_BYTES, page.name
        scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
        if page.name != "whatif.html":
            assert sum(len(script.encode()) for script in scripts) <= MOST_SCRIPT, page.name


def test_every_page_is_accessible_and_fits(report: Path, browser: Any, axe: str) -> None:
    found: dict[str, Any] = {}
    for path in pages(report):
        with Sight(browser, path, width=360) as page:
            if page.evaluate("document.querySelectorAll('*').length") > MOST_ELEMENTS:
                found[f"{path.name}: elements"] = page.evaluate("document.querySelectorAll('*').length")
            page.evaluate(UNFOLDED)
            page.evaluate(SETTLED)
            found[f"{path.name}: wider than a phone"] = page.evaluate(SIDEWAYS)
            found[f"{path.name}: tab stops that are none"] = page.evaluate(STOPS) if path.name != "whatif.html" else []
            page.evaluate(FOLD)
            page.emulate_media(color_scheme="dark")
            found[f"{path.name}: axe, 360 px, dark"] = violations(page, axe, BY_WIDTH + BY_COLOURS)
            page.set_viewport_size({"width": 1280, "height": 900})
            page.emulate_media(color_scheme="light")
            page.evaluate(SETTLED)
            found[f"{path.name}: axe, 1280 px, light"] = violations(page, axe)
    assert {name: what for name, what in found.items() if what} == {}


def test_every_exhibit_can_be_skipped(report: Path) -> None:
    for path in pages(report):
        text = path.read_text(encoding="utf-8")
        exhibits = re.findall(r'<section class="exhibit[^"]*" id="([^"]+)"', text)
        skips = re.findall(r'<a class="skip" href="#([^"]+)-end">', text)
        assert exhibits == skips
        assert all(f'id="{id}-end"' in text for id in skips)


def test_an_address_opens_a_card_with_and_without_script(report: Path, browser: Any) -> None:
    rows = list(csv.DictReader(io.StringIO((report / "data" / "verdicts.csv").read_text(encoding="utf-8"))))
    wrong = next(row for row in rows if row["paper"] == "khan" and row["verdict"] == "misprint")
    file, _, fragment = wrong["address"].partition("#")
    for scripted in (True, False):
        context = browser.new_context(java_script_enabled=scripted, viewport={"width": 1280, "height": 900})
        page = context.new_page()
        page.goto(f"{(report / file).as_uri()}#{fragment}")
        page.wait_for_load_state("load")
        card = page.locator(f"[id='{fragment}'] > .card")
        assert card.is_visible()
        assert wrong["printed"].replace("-", "−") in card.inner_text()
        assert wrong["corrected"].replace("-", "−") in card.inner_text()
        assert card.get_by_role("button", name="copy as TeX").count() == int(scripted)
        context.close()


def test_two_clicks_lead_to_the_wrong_numbers_of_a_table(report: Path, browser: Any) -> None:
    with Sight(browser, report / INDEX) as page:
        page.locator("table.glance a[href='khan.html']").click()
        ledger = page.locator(".wrong")
        row = ledger.locator("tr", has_text="Table 2").first
        assert row.locator(".number").count() == 2
        row.locator("a").first.click()
        assert page.locator("td:target > .card").is_visible()


def test_filters_need_no_script(report: Path, browser: Any) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto((report / "khan.html").as_uri())
    bodies = page.locator("#table-2 tbody")
    everything = bodies.count()
    page.locator("#show-misprint").check(force=True)
    shown = [bodies.nth(i) for i in range(everything) if bodies.nth(i).is_visible()]
    assert all(body.locator("td.misprint").count() for body in shown)
    assert len(shown) < everything
    page.locator("input[name=show]").first.check(force=True)
    choice = page.locator("#table-2 .pick select")
    lines = page.locator("#table-2 tr.by")
    before = sum(line.is_visible() for line in lines.all())
    choice.select_option(index=1)
    after = [line for line in lines.all() if line.is_visible()]
    assert 0 < len(after) < before
    assert all("2" in str(line.get_attribute("data-r")).split() for line in after)
    context.close()


def test_search_finds_across_papers(report: Path, browser: Any) -> None:
    with Sight(browser, report / SEARCH) as page:
        total = page.locator(".hits > li").count()
        page.fill("#q", "gain margin")
        hits = [hit for hit in page.locator(".hits > li").all() if hit.is_visible()]
        assert 0 < len(hits) < total
        said = [hit.inner_text().lower() + str(hit.get_attribute("data-t")).lower() for hit in hits]
        assert all("gain" in text and "margin" in text for text in said)
        assert len({text.splitlines()[-1] for text in said}) > 1
        assert page.evaluate("decodeURIComponent(location.hash)") == "#q=gain margin"


def test_curves_are_read_and_switched(report: Path, browser: Any) -> None:
    curves = (report / "data" / "figures" / "khan" / "fig-4.csv").read_text(encoding="utf-8")
    header, *points = csv.reader(io.StringIO(curves))
    assert header[:2] == ["panel", "curve"]
    with Sight(browser, report / "khan.html") as page:
        drawing = page.locator("#fig-4 .drawing")
        drawing.scroll_into_view_if_needed()
        line = page.locator("#fig-4 [data-curve]").first
        x, y = line.evaluate("""(line) => {
          const path = line.querySelector("path"), p = path.getPointAtLength(path.getTotalLength() / 2);
          const q = new DOMPoint(p.x, p.y).matrixTransform(path.getScreenCTM());
          return [q.x, q.y];
        }""")
        page.mouse.move(x, y)
        said = drawing.locator(".read-out").inner_text().replace("−", "-")
        match = re.search(r"(-?[\d.e-]+) at (-?[\d.e-]+)$", said)
        assert match is not None
        value, place = map(float, match.groups())
        # some curve passes there: the nearest stored points enclose the value
        near = sorted(points, key=lambda row: abs(float(row[2] or "inf") - place))[:40]
        assert min(float(row[3]) for row in near) - 0.05 <= value <= max(float(row[3]) for row in near) + 0.05
        toggle = page.locator("#fig-4 .curves button[aria-pressed]").first
        if toggle.count():
            toggle.click()
            assert page.locator("#fig-4 .off").count() >= 1
        page.locator("#fig-4").get_by_role("button", name="enlarge").click()
        assert page.locator("dialog[open] svg").bounding_box()["width"] > 1000
        page.keyboard.press("Escape")
        assert page.locator("dialog").count() == 0
        assert page.locator("#fig-4 .drawing svg").count() == 1


def test_tables_sort_and_copy(report: Path, browser: Any) -> None:
    with Sight(browser, report / "khan.html") as page:
        table = page.locator("#table-2 table.values").first
        if not table.locator(".sorter").count():
            table = page.locator("table.values:has(.sorter)").first
        table.locator(".sorter").first.click()
        column = table.locator("tr:first-child > td:nth-child(2)").all_text_contents()
        found = [float(m[0].replace("−", "-")) for text in column if (m := re.match(r"\s*[−]?[\d.]+", text))]
        assert found == sorted(found)
