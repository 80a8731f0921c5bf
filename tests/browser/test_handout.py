"""The web pages of the bundled papers' handouts in a real browser: formulas as set, tables whole, on a phone, too."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from kept_results import kept_results

from browser.sight import BY_COLOURS, SETTLED, Sight, violations
from replicate import cli
from replicate.whatif import NAME as WHATIF

A4 = 612  # pixels between the margins
# Where a page is wider than the window, and what of it is in nothing that scrolls by itself.
SIDEWAYS = """() => document.documentElement.scrollWidth <= innerWidth ? [] :
  [...document.querySelectorAll("body *")].filter((e) => e.getBoundingClientRect().right > innerWidth + 1
    && !e.closest(".exhibit, pre, svg, math[display=block]")).map((e) => e.outerHTML.slice(0, 120))"""
# Of programs, tables and formulas, those of which a part is behind a scroll bar; programs may be, but not on paper.
HIDDEN = """(kinds) => [...document.querySelectorAll(kinds)]
  .filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.outerHTML.slice(0, 120))"""
FONTS = """async () => { await document.fonts.ready;
  return [...document.fonts].filter((font) => font.status === "loaded").map((font) => font.family); }"""
# From the last digit of a number to the sign after it, where they are closest.
GAP = """() => Math.min(...[...document.querySelectorAll(".sign:not(.bare)")].filter((e) => e.textContent).map((e) => {
  const [digits, sign] = [e.previousElementSibling, e].map((part) => {
    const range = document.createRange();
    range.selectNodeContents(part);
    return range.getBoundingClientRect();
  });
  return sign.left - digits.right;
}))"""


@pytest.fixture(scope="module")
def handouts(tmp_path_factory: pytest.TempPathFactory, browser: Any) -> list[Path]:
    """Build the handouts with solutions; without a browser nothing is built."""
    assert browser
    out = tmp_path_factory.mktemp("handouts")
    with kept_results() as kept, pytest.MonkeyPatch.context() as patch:
        (out / "cache").symlink_to(kept)
        asked = ["handout", "--bundled", "--solutions", "--format", "html", "--out", str(out)]
        patch.setattr(sys, "argv", ["replicate", *asked])
        with pytest.raises(SystemExit):
            cli.main()
    return sorted(path for path in (out / "handouts").glob("*.html") if path.name != WHATIF)


def test_handouts_are_whole_and_accessible(handouts: list[Path], browser: Any, axe: str) -> None:
    assert len(handouts) == 5
    found: dict[str, Any] = {}
    for path in handouts:
        with Sight(browser, path) as page:
            found[f"{path.name}: fonts"] = {"Replicate Math"} - set(page.evaluate(FONTS))
            found[f"{path.name}: behind a scroll bar at 1280 px"] = page.evaluate(
                HIDDEN, ".exhibit, math[display=block]"
            )
            found[f"{path.name}: signs at the numbers before them"] = page.evaluate(GAP) < 4
            found[f"{path.name}: axe, light"] = violations(page, axe)
            page.emulate_media(color_scheme="dark")
            found[f"{path.name}: axe, dark"] = violations(page, axe, BY_COLOURS)
            for width in (360, 320):
                page.set_viewport_size({"width": width, "height": 900})
                page.evaluate(SETTLED)
                found[f"{path.name}: wider than {width} px"] = page.evaluate(SIDEWAYS)
            page.emulate_media(media="print", color_scheme="light")
            page.set_viewport_size({"width": A4, "height": 900})
            page.evaluate(SETTLED)
            found[f"{path.name}: cut on paper"] = page.evaluate(HIDDEN, ".exhibit, math[display=block], pre")
    assert {name: what for name, what in found.items() if what} == {}
