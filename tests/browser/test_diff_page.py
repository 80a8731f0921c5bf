"""The page of what differs from the accepted state in a real browser: readable by everyone, on a phone, by keyboard."""

from __future__ import annotations

import csv
import io
import shutil
from pathlib import Path
from typing import Any

import pytest
from command import status_of
from kept_results import kept_results

from browser.sight import SEAM, SETTLED, SIDEWAYS, SMALL, STOPS, UNFOLDED, Sight, violations

ROOT = Path(__file__).parents[2]


def rewritten(path: Path, column: str, change: float, rows: int) -> None:
    """Change the first values of an accepted file, as if another state had been accepted."""
    text = list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))
    changed = [row for row in text if row[column]][:rows]
    assert len(changed) == rows
    for row in changed:
        row[column] = f"{float(row[column]) + change:.12g}"
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(text[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(text)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory, browser: Any) -> Path:
    """Compare a table and a figure with an accepted state that differs; without a browser nothing is compared."""
    assert browser
    out = tmp_path_factory.mktemp("diff")
    shutil.copytree(ROOT / "figures", out / "accepted")
    rewritten(out / "accepted" / "khan" / "table-2.csv", "computed", 0.25, 3)
    rewritten(out / "accepted" / "khan" / "fig-3.csv", "y", 0.02, 100)
    names = ["khan/table-2", "khan/fig-3"]
    with kept_results() as kept:
        (out / "cache").symlink_to(kept)
        assert status_of("diff", *names, "--accepted", str(out / "accepted"), "--out", str(out)) == 1
    return out / "diff" / "index.html"


def test_it_shows_cells_and_both_pictures(page: Path, browser: Any) -> None:
    with Sight(browser, page) as sight:
        assert sight.locator("table.changed tbody tr").count() == 3
        assert sight.locator(".pair svg").count() == 2
        assert sight.locator(".changed a").first.get_attribute("href").startswith("../report/khan.html#table-2.")


def test_it_is_accessible_and_fits(page: Path, browser: Any, axe: str) -> None:
    found: dict[str, Any] = {}
    for width in (360, 1280):
        for scheme in ("light", "dark"):
            with Sight(browser, page, width=width, color_scheme=scheme) as sight:
                sight.evaluate(UNFOLDED)
                sight.evaluate(SETTLED)
                found[f"{width} px, {scheme}: too wide"] = sight.evaluate(SIDEWAYS)
                found[f"{width} px, {scheme}: small letters"] = sight.evaluate(SMALL)
                found[f"{width} px, {scheme}: tab stops that are none"] = sight.evaluate(STOPS)
                found[f"{width} px, {scheme}: axe"] = violations(sight, axe)
    assert {name: what for name, what in found.items() if what} == {}


def test_the_thumb_is_on_the_seam(page: Path, browser: Any) -> None:
    for width in (1280, 800):
        with Sight(browser, page, width=width) as sight:
            assert max(map(abs, sight.evaluate(SEAM))) < 2.0


def test_the_slider_follows_the_keyboard(page: Path, browser: Any) -> None:
    with Sight(browser, page, width=360) as sight:
        slider = sight.locator(".pair input[type=range]")
        cut = "() => getComputedStyle(document.querySelector('.pair')).getPropertyValue('--cut')"
        before = sight.evaluate(cut)
        slider.focus()
        for _ in range(5):
            sight.keyboard.press("ArrowRight")
        assert sight.evaluate(cut) != before
