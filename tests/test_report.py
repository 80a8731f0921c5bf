import re
import sys
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure as MatplotlibFigure

from replicate.display.markdown import MarkdownBatch
from replicate.display.numbers import aligned, shown
from replicate.errors import TemplateError
from replicate.exhibits import Figure, Finding, Paper
from replicate.exhibits.matching import Match
from replicate.exhibits.printed import PrintedValue
from replicate.exhibits.results import ClaimsResult, Results, TableResult
from replicate.report import build_report
from replicate.report.errata_sheet import Erratum
from replicate.resources import templates_dir
from replicate.run.drawing import capture
from replicate.verdicts.inputs import read_inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.rows import Computed, VerdictRow

Make = Callable[..., dict[str, str]]

VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}

NOTES = """Gains follow from $K_p = \\frac{0.9}{L}$; {{ count(verdict='misprint') }} misprint.

# The *story*

{{ exhibit('table-1') }}

See [the figure](#fig-1).
"""

LEDGER = """
[[entry]]
exhibit = "table-1"
rows = ["ZN"]
columns = ["Ti"]
cause = "misprint"
explanation = "Digits are *swapped*: {{ value('table-1', 'ZN', 'Ti') }}."

[[entry]]
exhibit = "table-1"
rows = ["CC"]
columns = ["Ti"]
cause = "unknown"
explanation = "Pad\u00e9 models of order 1 to 4 were tried."
"""


class Page(HTMLParser):
    """What a browser would see: elements in order, ids, references, text; elements that are not closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.unbalanced: list[str] = []
        self._open: list[str] = []
        self.feed(text)
        self.unbalanced += self._open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self._open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if self._open and self._open[-1] == tag:
            self._open.pop()
        else:
            self.unbalanced.append(f"/{tag}")

    def handle_data(self, data: str) -> None:
        self.text += data

    def values(self, attribute: str) -> list[str]:
        return [str(attrs[attribute]) for _, attrs in self.elements if attribute in attrs]


def check_table_1() -> pd.DataFrame:
    """Stands for a reading; its source is shown."""
    return pd.DataFrame({"k": [0.9, 0.98], "Ti": [3.14, 2.5]}, index=["ZN", "CC"])  # a < b


def check_claim() -> Finding:
    return Finding("fails", 2.25, "It is $2.25 < 2.5$.")


def draw(fig: MatplotlibFigure) -> None:
    axes = fig.subplots()
    axes.plot([0, 1], [0, 1], label="PA & ZN")
    axes.set(xlabel="time $t$", ylabel="output")
    axes.legend()


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Make:
    """Return a function that makes a paper with one exhibit of each kind and builds its report."""

    def build(
        notes: str = NOTES,
        ledger: str = LEDGER,
        out: Path = tmp_path / "report",
        prefix: str = "",
        **files: str,
    ) -> dict[str, str]:
        package = f"paper_{tmp_path.name.replace('-', '_')}"
        folder = tmp_path / package
        (folder / "printed").mkdir(parents=True, exist_ok=True)
        (folder / "__init__.py").write_text("")
        (folder / "notes.md").write_text(notes, encoding="utf-8")
        (folder / "ledger.toml").write_text(ledger.replace("table-1", f"{prefix}table-1"), encoding="utf-8")
        (folder / "printed" / f"{prefix}table-1.csv").write_text("row,k,Ti\nZN,0.9,3.41\nCC,0.9500,7.0\n")
        for name, text in files.items():
            (folder / f"{name.replace('_', '-')}.md").write_text(text, encoding="utf-8")
        monkeypatch.syspath_prepend(tmp_path)
        sys.modules.pop(package, None)
        paper = Paper(
            "synthetic",
            package,
            "A paper on <dead time>",
            ("A. Author",),
            "A. Author, 1999.",
            1999,
            (),
            (),
            "One *story*.",
        )
        table = paper.table(
            f"{prefix}table-1",
            "Gains",
            rows=["ZN", "CC"],
            columns=["k", "Ti"],
            labels={"Ti": "$T_i$"},
            units={"Ti": "s"},
        )
        table.reading("as-written", "As the text says", "With $L = 1$.")(check_table_1)
        table.reading("other", "Otherwise")(check_table_1)
        paper.figure(f"{prefix}fig-1", "Responses", caption="Of $y$.", stands_for="No data.")(draw)
        paper.claims().claim("margin", "The margin is above 2.5.", printed="2.5")(check_claim)
        paper.not_computable("fig-2", "Measured flow", "measured data")
        paper._loaded = True
        other = pd.DataFrame({"k": [0.9, 0.95], "Ti": [3.14, 2.5]}, index=["ZN", "CC"])
        figure = paper.exhibits[f"{prefix}fig-1"]
        assert isinstance(figure, Figure)
        results: Results = {
            ("synthetic", f"{prefix}table-1"): TableResult(
                "synthetic", f"{prefix}table-1", {"as-written": check_table_1(), "other": other}
            ),
            ("synthetic", f"{prefix}fig-1"): capture("synthetic", figure),
            ("synthetic", "claims"): ClaimsResult("synthetic", "claims", {"margin": check_claim()}),
        }
        judgement = judge(paper, results, read_inputs(paper))
        return {path.name: path.read_text("utf-8") for path in build_report([paper], results, judgement, out)}

    return build


def test_pages_are_well_formed_and_every_reference_has_its_target(make: Make) -> None:
    pages = {name: Page(text) for name, text in make().items()}
    assert set(pages) == {"index.html", "verdicts.html", "errata.html", "search.html", "synthetic.html"}
    for name, page in pages.items():
        assert page.unbalanced == []
        ids = page.values("id")
        assert len(ids) == len(set(ids))
        for target in page.values("popovertarget") + " ".join(page.values("aria-labelledby")).split():
            assert target in ids
        for address in page.values("href") + page.values("xlink:href"):
            file, _, fragment = address.partition("#")
            if not file.startswith("data/"):
                assert fragment in [*pages[file or name].values("id"), ""], address


def test_pages_stand_alone(make: Make) -> None:
    for text in make().values():
        page = Page(text)
        assert {"link", "img", "iframe"}.isdisjoint(tag for tag, _ in page.elements)
        assert page.values("src") == []
        assert "@import" not in text
        assert not re.search(r"url\((?!#|data:font/woff;base64,)", text)
        assert not [address for address in page.values("href") if ":" in address]
        assert not [attribute for _, attrs in page.elements for attribute in attrs if attribute.startswith("on")]


def test_every_printed_and_computed_value_stands_with_its_verdict(make: Make) -> None:
    text = make()["synthetic.html"]
    rows = dict(re.findall(r'<td id="table-1[\w.-]+" class="judged ([a-z-]+)">([\d.]+)', text))
    # 0.9 as written; 0.9500 under the other reading; 3.41 a misprint; 7.0 unexplained
    assert rows == {"reproduced": "0.9", "reconstructed": "0.9500", "misprint": "3.41", "unexplained": "7.0"}
    assert text.count('title="3.14"') == 1  # both readings agree in the row and share its line
    assert "as-written, other" in " ".join(Page(text).text.split())
    assert "<del>3.41</del> <ins>3.14</ins>" in text
    assert "Digits are <em>swapped</em>: 3.14." in text
    assert "Padé models of order 1 to 4 were tried." in text
    plain = Page(text).text
    assert "1 misprint." in plain
    assert "It is 2.25&lt;2.5" not in plain
    for word in ("What is wrong: 1 printed number and 1 sentence", "measured data"):
        assert word in plain


def test_figures_have_a_text_alternative_a_label_and_downloads(make: Make) -> None:
    text = make()["synthetic.html"]
    assert re.search(r'<svg id="svg-fig-1" role="img" aria-labelledby="svg-fig-1-title svg-fig-1-desc"', text)
    assert re.search(r'<desc id="svg-fig-1-desc">output from .* over time t from .*PA &amp; ZN', text)
    assert "standing in for a measurement" in text
    for suffix in ("svg", "png", "csv"):
        assert f'href="data/figures/synthetic/fig-1.{suffix}"' in text
    assert "#1b1f24" not in text.partition("<svg")[2].partition("</svg>")[0]


def test_sources_are_shown_escaped(make: Make) -> None:
    text = make()["synthetic.html"]
    assert "check_table_1() -&gt; pd.DataFrame:" in text
    assert "<i># a &lt; b</i>" in text


def test_prose_places_exhibits_and_titles_are_escaped(make: Make) -> None:
    text = make()["synthetic.html"]
    story, table, link = (text.index(part) for part in ('<h2 id="s-the-story">', 'id="table-1"', "See <a"))
    assert story < table < link < text.index('id="fig-1"')
    assert "The <em>story</em>" in text
    assert "<math" in text
    assert len(re.findall('<section class="exhibit[ "]', text)) == 4


def test_the_story_stands_before_contents_and_exhibits(make: Make) -> None:
    page = Page(make()["synthetic.html"])
    assert page.text.index("Gains follow from") < page.text.index("Contents") < page.text.index("The story")


def test_the_overview_of_parts_quotes_the_first_paragraph_of_each(make: Make) -> None:
    pages = make(prefix="II-", notes="", notes_II="# Part two\n\nIts *abstract*.\n\nMore of it.\n")
    assert "Its abstract." in Page(pages["synthetic.html"]).text
    assert "More of it." not in Page(pages["synthetic.html"]).text
    assert "More of it." in Page(pages["synthetic-II.html"]).text


def test_two_runs_give_the_same_bytes(make: Make, tmp_path: Path) -> None:
    assert make() == make(out=tmp_path / "again")


def test_a_part_with_notes_of_its_own_has_a_page(make: Make) -> None:
    pages = make(
        "Overview. {{ exhibit('I-table-1') }}",
        prefix="I-",
        notes_I="# First part\n\n{{ exhibit('I-table-1') }}",
    )
    assert list(pages) == [
        "index.html",
        "verdicts.html",
        "errata.html",
        "search.html",
        "synthetic.html",
        "synthetic-I.html",
    ]
    assert '<a href="synthetic-I.html#I-table-1">Table 1</a>' in pages["synthetic.html"]
    assert ' id="I-table-1">' in pages["synthetic-I.html"]
    assert '<section class="exhibit" id="I-table-1">' not in pages["synthetic.html"]
    assert "<h1>First part</h1>" in pages["synthetic-I.html"]
    assert 'href="synthetic-I.html#I-table-1"' in pages["index.html"]


@pytest.mark.parametrize(
    ("notes", "message"),
    [
        (
            "\n{{ exhibit('table-9') }}",
            r"notes\.md:2: exhibit\('table-9'\): no such exhibit; allowed: table-1, fig-1",
        ),
        ("{{ exhibit('fig-1') }}\n{{ exhibit('fig-1') }}", r"notes\.md:2: .*placed twice"),
        ("$\\nonsense{x}$", r"synthetic\.html: pandoc cannot convert .*: unexpected control sequence .*nonsense"),
    ],
)
def test_wrong_prose_is_named(make: Make, notes: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(TemplateError, match=message):
        make(notes)
    assert not (tmp_path / "report").exists()


def test_a_text_that_swallows_the_next_is_named() -> None:
    batch = MarkdownBatch("test")
    page = "".join(map(str, (batch.block("~~~\nopen"), batch.block("lost"), batch.block("~~~"))))
    with pytest.raises(TemplateError, match="test: a code fence is not closed in or before the text 'lost'"):
        batch.substitute(page)


def test_markup_in_texts_is_text() -> None:
    batch = MarkdownBatch("test")
    html = batch.substitute(str(batch.block("a<b> & <script>x</script>")))
    assert Page(html).text.strip() == "a<b> & <script>x</script>"


@pytest.mark.parametrize("text", ["(5) and (6) give it.", "5. is it", "- so", "# so", "> so", "+ so", "| so"])
def test_a_short_text_is_never_a_block(text: str) -> None:
    batch = MarkdownBatch("test")
    html = batch.substitute(str(batch.inline(text)))
    assert not html.startswith("<")
    assert Page(html).text == text


@pytest.mark.parametrize(
    ("tex", "shown"),
    [
        ("2\\ln 10", "2_ln_10"), ("d\\arg L/d\\ln x^2", "d_arg_L/d_ln_x2"), ("-\\cos m", "−cos_m"),
        ("\\frac{1}{p}\\sin(x)", "1p_sin(x)"), ("\\min_w f", "minw_f"), ("\\tfrac12\\ln x", "12_ln_x"),
        ("(a+b)\\ln|x|", "(a+b)_ln_|x|"), ("|a|\\ln\\sin x", "|a|_ln_sin_x"), ("2\\sin^2 x", "2_sin2_x"),
        ("\\bar a\\log_{10}\\tfrac12", "a‾_log10_12"), ("\\sqrt 2\\operatorname{Re} z", "2_Re_z"),
        ("a/\\ln x", "a/ln_x"), ("\\left(a\\right)\\ln\\left(b\\right)", "(a)_ln(b)"),
        ("\\frac{2\\ln x}{y}", "2_ln_xy"), ("|\\ln x|", "|ln_x|"),
    ],
)  # fmt: skip
def test_functions_stand_apart_in_formulas(tex: str, shown: str) -> None:
    """A browser puts no space between the name of a function and what is beside it."""
    batch = MarkdownBatch("test")
    html = batch.substitute(str(batch.inline(f"${tex}$"))).replace('<mspace width="0.167em"></mspace>', "_")
    assert re.sub("<[^>]*>|&#8289;", "", html) == shown


def test_columns_are_aligned_at_the_decimal_point() -> None:
    texts = aligned(["1.25", "−10", "3.4"]).values()
    assert len({len(text) - len(text.split(".")[0].rstrip("\u2007\u2008")) for text in texts}) == 1


@pytest.mark.parametrize(
    ("number", "printed", "text"),
    [
        (123.456, "100", "123.46"), (0.0, "0.00", "0"), (float("nan"), "1", ""), (2.0, "2.00000", "2"),
        (46.6, "0.43035", "46.6"), (1234567.0, None, "1234567"), (-float("inf"), None, "−∞"),
        (5e-7, "0", "5e−7"), (None, "1", ""),
    ],
)  # fmt: skip
def test_numbers_show_a_little_more_than_the_print(number: float | None, printed: str | None, text: str) -> None:
    assert shown(number, PrintedValue(printed) if printed else None) == text


def _luminance(colour: str) -> float:
    """WCAG 2.2, definition of relative luminance."""
    channels = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def _contrast(one: str, other: str) -> float:
    lighter, darker = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


@pytest.mark.parametrize("theme", [0, 1, 2], ids=["light", "dark", "paper"])
def test_text_has_the_contrast_of_wcag_aa(theme: int) -> None:
    style = (templates_dir() / "style.css").read_text("utf-8")
    block = re.findall(r":root \{(.*?)\}", style, re.DOTALL)[theme]
    colours = {name: code if len(code) == 7 else "#" + "".join(2 * c for c in code[1:])
               for name, code in re.findall(r"--([\w-]+): (#[0-9a-f]{3,6})\b", block)}  # fmt: skip
    words = [name.removesuffix("-bg") for name in colours if name.endswith("-bg")]
    assert len(words) == 7
    pairs = [(word, f"{word}-bg") for word in words] + [
        (ink, paper) for ink in ("ink", "soft", "link", *words) for paper in ("bg", "raised", "sunken")
    ]
    poor = {pair: _contrast(colours[pair[0]], colours[pair[1]]) for pair in pairs}
    assert {pair: ratio for pair, ratio in poor.items() if ratio < 4.5} == {}
    for word in words:  # graphical objects need 3 : 1
        assert _contrast(colours[f"{word}-bar"], colours["raised"]) >= 3


def test_the_errata_page_has_print_right_value_and_a_text_for_the_authors(make: Make) -> None:
    page = Page(make()["errata.html"])
    assert "printed 3.41, we find 3.14." in " ".join(page.text.split())
    assert "Dear authors" in page.text
    assert "The margin is above 2.5." in page.text
    assert "synthetic.html#table-1.ZN.Ti" in page.values("href")


def test_a_value_by_another_definition_is_not_called_the_right_one() -> None:
    value = PrintedValue("10.3", "A", "ts")
    one = Computed("authors", 9.9013, Match("near"))
    row = VerdictRow("toy", "table-1", "A", "ts", "10.3", "discrepant", "authors", "9.9013", value=value, values=(one,))
    by_definition, by_method = replace(row, cause="definition"), replace(row, cause="method")
    assert (Erratum.right(by_definition), Erratum.right(by_method)) == ("", "9.901")
    assert Erratum.ours(by_definition) == "9.901"


def test_how_far_off_a_print_is_agrees_with_what_it_should_be() -> None:
    """5.47 for 10 is off by -4.53, whatever else a reading gives; a corrected value that is ours has all our digits."""
    values = (Computed("authors", 12.558, Match("none")),)
    row = VerdictRow("toy", "table-1", "A", "ts", "5.47", "misprint", "authors", "12.558", "10", values=values)
    print_ = replace(row, value=PrintedValue("5.47"))
    assert Erratum.exact(print_) == 10.0
    assert Erratum.exact(replace(print_, corrected="12.6")) == 12.558
    assert Erratum.exact(replace(print_, corrected="")) == 12.558


def test_the_first_screen_counts_consequential_errors(make: Make) -> None:
    found = re.search(r"<li><b>(\d+)</b><span><a href=\"errata.html\">consequential", make()["index.html"])
    assert found is not None
    assert found[1] == "0"
