"""The report of the bundled papers in a real browser: accessible, light, quiet, usable on a phone and by keyboard.

The results come from the same cache as those of `make report` and `make check`.
"""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path
from typing import Any

import pytest
from command import status_of
from kept_results import kept_results

from browser.sight import BY_COLOURS, BY_WIDTH, FOLD, SETTLED, SIDEWAYS, SMALL, STOPS, UNFOLDED, Sight, violations
from replicate.report.pages import SEARCH
from replicate.report.site import INDEX

MOST_BYTES, MOST_ELEMENTS, MOST_SCRIPT = 2_000_000, 25_000, 30_000
WRONG = {"misprint", "damaged", "discrepant", "unexplained"}


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory, browser: Any) -> Path:
    """Build the report of the bundled papers; without a browser nothing is built."""
    assert browser
    out = tmp_path_factory.mktemp("bundled")
    with kept_results() as kept:
        (out / "cache").symlink_to(kept)
        status_of("report", "--bundled", "--out", str(out))
    return out / "report"


def read(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))


def plain(text: str) -> str:
    """Return how a text begins, up to its first formula or emphasis."""
    return re.split(r"[$*`]", text)[0]


def pages(report: Path) -> list[Path]:
    return sorted(report.glob("*.html"))


def copied(page: Any, button: Any) -> str:
    """Press a button that copies, and return what it has copied."""
    page.evaluate("window.setTimeout = () => 0")  # so that it goes on saying what it says for a moment
    button.click()
    page.get_by_role("button", name="copied").wait_for()
    text: str = page.evaluate("navigator.clipboard.readText()")
    return text


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
            page.set_viewport_size({"width": 320, "height": 900})
            page.evaluate(SETTLED)
            found[f"{path.name}: wider than the smallest phone"] = page.evaluate(SIDEWAYS)
            page.set_viewport_size({"width": 360, "height": 900})
            page.evaluate(SETTLED)
            found[f"{path.name}: small letters in drawings"] = page.evaluate(SMALL)
            found[f"{path.name}: tab stops that are none"] = page.evaluate(STOPS) if path.name != "whatif.html" else []
            if path.name != "whatif.html":  # whose script writes into the rows that this would remove
                page.evaluate(FOLD)
            page.emulate_media(color_scheme="dark")
            found[f"{path.name}: axe, 360 px, dark"] = violations(page, axe, BY_WIDTH + BY_COLOURS)
            page.set_viewport_size({"width": 1280, "height": 900})
            page.emulate_media(color_scheme="light")
            page.evaluate(SETTLED)
            stops = page.evaluate(STOPS) if path.name != "whatif.html" else []
            found[f"{path.name}: tab stops that are none at 1280 px"] = stops
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
    wrong = next(
        row for row in read(report / "data" / "verdicts.csv") if row["paper"] == "khan" and row["verdict"] == "misprint"
    )
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


def test_no_card_covers_its_cell(report: Path, browser: Any) -> None:
    with Sight(browser, report / "khan.html") as page:
        for fragment in ("example-2-1.A2.value", "example-3-1.Haalman_ts.value", "table-2.ITAE.ph1_ts"):
            page.goto(f"{(report / 'khan.html').as_uri()}#{fragment}")
            page.evaluate(SETTLED)
            cell, card = (page.locator(f"[id='{fragment}']{part}").bounding_box() for part in ("", " > .card"))
            beside = cell["x"] + cell["width"] <= card["x"] + 1
            assert beside or cell["y"] + cell["height"] <= card["y"] + 1, fragment
            assert cell["y"] >= 0


def test_two_clicks_lead_a_newcomer_to_what_is_wrong_in_a_table(report: Path, browser: Any) -> None:
    """From the overview: which numbers of Khan's Table II are wrong, why, by how much; and the address of one."""
    wrong = [
        row
        for row in read(report / "data" / "verdicts.csv")
        if (row["paper"], row["exhibit"]) == ("khan", "table-2") and row["verdict"] in WRONG
    ]
    assert len(wrong) > 3
    clicks = 0

    def click(what: Any) -> None:
        nonlocal clicks
        assert what.is_visible()
        what.click()
        clicks += 1

    with Sight(browser, report / INDEX) as page:
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        click(page.locator("table.glance a[href='khan.html']"))
        listed = page.locator(".wrong tr")
        for row in wrong:
            line = listed.filter(has=page.locator(f"a[href='#{row['address'].partition('#')[2]}']"))
            assert line.count() == 1, row["address"]
            said = line.inner_text().replace("−", "-")
            assert row["printed"] in said
            assert re.search(r"[\d.]+ ?%|digits?|units?", said), said  # how far off
            if row["corrected"]:
                assert row["corrected"] in said.replace("\u0305", "")
        one = next(row for row in wrong if row["corrected"])
        click(page.locator(f".wrong a[href='#{one['address'].partition('#')[2]}']"))
        card = page.locator("td:target > .card")
        assert card.is_visible()
        said = card.inner_text()
        for part in ("printed", one["printed"], "off by", plain(one["explanation"])[:30]):
            assert part in said
        assert clicks == 2
        assert page.url.endswith(one["address"])
        assert copied(page, card.get_by_role("button", name="copy address")) == page.url


def test_every_cell_claim_and_error_has_one_address(report: Path) -> None:
    addresses = [row["address"] for row in read(report / "data" / "verdicts.csv")]
    assert len(set(addresses)) == len(addresses) > 1000
    errors = [row["address"] for row in read(report / "data" / "errata.csv")]
    assert set(errors) <= set(addresses)
    ids = {page.name: re.findall(r' id="([^"]*)"', page.read_text(encoding="utf-8")) for page in pages(report)}
    for names in ids.values():
        assert len(set(names)) == len(names)
    known = {name: set(names) for name, names in ids.items()}
    for address in addresses:
        file, _, fragment = address.partition("#")
        assert fragment in known[file], address
        assert re.fullmatch(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+){2}", fragment)
    assert "khan.html#table-2.CC.ph1_Mp" in addresses


def test_no_markup_is_left_where_only_characters_can_stand(report: Path) -> None:
    """Titles and descriptions of drawings, names of parts for assistive technology, panels and curves as data."""
    said = r' (?:aria-label|title|alt)="([^"]*)"|<(?:title|desc)\b[^>]*>([^<]*)<'
    found = [(page.name, "".join(one)) for page in pages(report) for one in re.findall(said, page.read_text("utf-8"))]
    for path in (report / "data" / "figures").rglob("*.*"):
        if path.suffix == ".csv":
            found += {(path.name, row[key]) for row in read(path) for key in ("panel", "curve")}
        elif path.suffix == ".svg":
            found += [(path.name, one) for one in re.findall(r"title>([^<]*)<", path.read_text("utf-8"))]
    assert len(found) > 1000
    assert [one for one in found if re.search(r"[$\\]|\*\w", one[1])] == []


def test_exhibits_of_several_parts_are_told_apart(report: Path) -> None:
    """Four tables of the thesis are called Table 1: wherever parts meet, the part is named."""
    overview = (report / INDEX).read_text(encoding="utf-8")
    advice = re.findall(r"<dd>(?:Part (\w+): )?(.*?)</dd>", overview, re.DOTALL)
    listed = [(part, file) for part, links in advice for file in re.findall(r'href="(panagopoulos[^#"]*)', links)]
    assert len({part for part, _ in listed}) > 3
    assert all(file == f"panagopoulos-{part}.html" for part, file in listed)
    errata = (report / "errata.html").read_text(encoding="utf-8")
    named = re.findall(r'<a href="panagopoulos-(\w+)\.html#[^"]*">(Part (\w+), )?', errata)
    assert all(part == said for part, there, said in named if there)
    assert {part for part, there, _ in named if there} >= {"I", "II", "IIs"}


def test_in_forced_colours_no_formula_hides_the_line_above(report: Path, browser: Any) -> None:
    """A browser lays a plate behind text, as high as its font: that of formulas is several lines high."""
    with Sight(browser, report / "khan.html", forced_colors="active") as page:
        assert (
            page.locator(".wrong math").first.evaluate("(math) => getComputedStyle(math).forcedColorAdjust") == "none"
        )


def test_what_is_wrong_is_read_on_a_phone_without_scrolling_sideways(report: Path, browser: Any) -> None:
    for name in ("khan.html", "panagopoulos-II.html"):
        with Sight(browser, report / name, width=360) as page:
            assert page.locator(".wrong .scroll").evaluate("(region) => region.scrollWidth <= region.clientWidth")


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
        page.evaluate(SETTLED)
        line = page.locator("#fig-4 [data-curve]").first
        x, y = line.evaluate("""(line) => {
          const path = line.querySelector("path"), p = path.getPointAtLength(path.getTotalLength() / 2);
          const q = new DOMPoint(p.x, p.y).matrixTransform(path.getScreenCTM());
          return [q.x, q.y];
        }""")
        page.mouse.move(x, y, steps=5)  # as a hand does
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


def test_a_drawing_enlarged_on_a_phone_is_larger_than_the_screen(report: Path, browser: Any) -> None:
    with Sight(browser, report / "khan.html", width=360) as page:
        drawing = page.locator("#fig-4 .drawing")
        drawing.scroll_into_view_if_needed()
        before = drawing.locator("svg").bounding_box()["width"]
        page.locator("#fig-4").get_by_role("button", name="enlarge").click()
        large = page.locator("dialog[open] .drawing")
        assert large.locator("svg").bounding_box()["width"] > 1.2 * before > 400
        assert large.evaluate("(region) => region.scrollWidth > region.clientWidth")


def test_tables_have_heads_over_groups_and_are_copied_with_whole_names(report: Path, browser: Any) -> None:
    with Sight(browser, report / "khan.html") as page:
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        heads = page.locator("#table-2 thead th.over")
        assert [head.get_attribute("colspan") for head in heads.all()] == ["4", "4"]
        assert page.locator("#table-2 h3 .label").text_content() == "Table II"  # as the paper numbers it
        button = page.locator("#table-2 .files").get_by_role("button", name="copy as CSV")
        names, *rows = csv.reader(io.StringIO(copied(page, button)))
        assert len(set(names)) == len(names) == 9
        assert [name.endswith("ph=1") for name in names[1:]] == [True] * 4 + [False] * 4
        assert {len(row) for row in rows} == {9}
        assert rows[0][0] == "Proposed (7)"  # not what else stands there, such as links to loops
        assert rows[1][0] == "Proposed (7), as-written"
        assert page.locator("#table-2 .scroll").evaluate("(region) => region.scrollWidth <= region.clientWidth")
        # what the line above says already is written only once, but copied, and shown where that line is not
        again = page.locator("#table-2 td.again").first
        assert again.evaluate("(cell) => getComputedStyle(cell).visibility") == "hidden"
        page.locator("#table-2 .pick select").select_option(index=2)
        assert again.evaluate("(cell) => getComputedStyle(cell).visibility") == "visible"


def test_formulas_are_copied_in_one_line(report: Path, browser: Any) -> None:
    with Sight(browser, report / "bayhan.html") as page:
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        button = page.locator("#table-1 .files").get_by_role("button", name="copy as CSV")
        rows = list(csv.reader(io.StringIO(copied(page, button))))
        names = [row[0] for row in rows]
        assert {len(row) for row in rows} == {5}
        assert "IAE for load disturbance (IAE): Kp=(0.984/K)(L/τ)^(-0.986), Ti=(τ/0.608)(L/τ)^0.707" in names


def test_heads_are_repeated_on_printed_pages(report: Path, browser: Any) -> None:
    """Chromium repeats the head of a table on every page, but shows no button in the copies."""
    with Sight(browser, report / "khan.html") as page:
        buttons = page.locator("table.values thead button")
        assert buttons.count() > 3
        page.emulate_media(media="print")
        assert not any(button.is_visible() for button in buttons.all())
        assert page.locator("table.values thead:has(button) .label").first.is_visible()
    with Sight(browser, report / "ali.html") as page:  # a heading turns with the wide table that follows it
        page.emulate_media(media="print")
        sheets = (
            "(heads) => heads.map((head) => [head, head.nextElementSibling].map((one) => getComputedStyle(one).page))"
        )
        pairs = page.locator("h2:has(+ .exhibit)").evaluate_all(sheets)
        assert ["wide", "wide"] in pairs
        assert all(head == exhibit for head, exhibit in pairs)


def test_curves_are_called_what_the_legend_calls_them(report: Path, browser: Any) -> None:
    with Sight(browser, report / "bayhan.html") as page:
        names = page.locator("#fig-2 .curves button[aria-pressed]")  # its legend is beside the axes
        assert names.count() == 11
        names.first.click()
        assert page.locator("#fig-2 [data-curve].off").count() == 2  # one in each panel
    with Sight(browser, report / "panagopoulos-IV.html") as page:
        assert page.locator("#IV-fig-2 .curves button math").count() == 4
        assert not re.search(r"tau|[$\\_]", page.locator("#IV-fig-2 .curves").inner_text())


def test_a_name_holds_its_formulas(report: Path, browser: Any) -> None:
    """Browsers leave formulas out of what a link, a heading or a button is called."""
    with Sight(browser, report / "khan.html") as page:
        assert page.locator(":is(a, h2, h3, th, summary) math:not([aria-label])").count() == 0
        assert page.locator(".wrong").get_by_role("link", name=re.compile(r"\(7a\), KP ?: a")).count() == 1
    with Sight(browser, report / "panagopoulos-IV.html") as page:
        assert page.get_by_role("button", name="τg/τe=0.5").count() == 1


def test_tables_sort_and_copy(report: Path, browser: Any) -> None:
    with Sight(browser, report / "khan.html") as page:
        table = page.locator("#table-2 table.values").first
        if not table.locator(".sorter").count():
            table = page.locator("table.values:has(.sorter)").first
        table.locator(".sorter").first.click()
        column = table.locator("tr:first-child > td:nth-child(2)").all_text_contents()
        found = [float(m[0].replace("−", "-")) for text in column if (m := re.match(r"\s*[−]?[\d.]+", text))]
        assert found == sorted(found)
