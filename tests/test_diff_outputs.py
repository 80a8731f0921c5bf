"""`replicate diff` as a user and a CI system see it: words, exit status, page, JSON, JUnit, summary."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import pytest
from installed_paper import contents, installed
from rich.console import Console

from replicate.diff.accept import accept
from replicate.diff.accepted import TableState
from replicate.diff.changes import Change
from replicate.diff.comparison import Comparison, ExhibitDiff
from replicate.run.library import Library
from replicate.run.outcome import recompute
from replicate.terminal.differences import print_changes

Run = Callable[..., tuple[int, str, str]]
VOID = {"br", "hr", "img", "input", "link", "meta"}


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the accepted state of the small paper, and with its kept results."""
    here = tmp_path_factory.mktemp("first")
    with installed(tmp_path_factory.mktemp("site")):
        outcome = recompute([Library().paper("lab")], jobs=1, cache_dir=here / "build" / "cache")
        accept(outcome, here / "accepted", "first", ["lab"])
    return here


@pytest.fixture
def diff(first: Path, replicate: Run) -> Run:
    """Return a function that compares the small paper with its accepted state, in a folder of its own."""
    shutil.copytree(first, Path.cwd(), dirs_exist_ok=True)
    return lambda *names: replicate("diff", *(names or ("lab",)), "--accepted", "accepted", "-j1")


def edit(name: str, change: Callable[[list[list[str]]], object]) -> None:
    """Change an accepted CSV, as if the state that was accepted had been another one."""
    path = Path("accepted/lab") / name
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    change(rows)
    path.write_text("".join(",".join(row) + "\n" for row in rows))


def lift(rows: list[list[str]]) -> None:
    for row in rows[1:]:
        row[3] = str(float(row[3]) + 0.05)


def other_value(rows: list[list[str]]) -> None:
    assert rows[1][:3] == ["2", "root", "as-written"]
    rows[1][3] = "1.5"


def other_verdict(rows: list[list[str]]) -> None:
    for row in rows[1:]:
        if row[:2] == ["3", "root"]:
            row[5] = "near"


class Page(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.attributes: list[tuple[str, str, str]] = []
        self.open: list[str] = []
        self.unbalanced: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value or "") for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value or "") for name, value in attrs]

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.unbalanced.append(tag)

    def values(self, name: str) -> list[str]:
        return [value for _, attribute, value in self.attributes if attribute == name]


def junit() -> ET.Element:
    return ET.parse("build/diff.junit.xml").getroot()  # noqa: S314  -- a file of our own


def index() -> str:
    return Path("build/diff/index.html").read_text(encoding="utf-8")


def test_nothing_differs(diff: Run) -> None:
    status, out, _ = diff()
    assert status == 0
    assert out == ("nothing differs from the accepted state; exhibits compared: 3\npictures: build/diff/index.html\n")
    assert "<svg" not in index()
    assert "3 exhibits unchanged" in index()
    assert json.loads(Path("build/diff.json").read_text())["changes"] == []
    assert [case.find("failure") for case in junit().iter("testcase")] == [None] * 3


def test_the_terminal_alone_says_what_and_how_much(diff: Run) -> None:
    edit("fig-1.csv", lift)
    edit("table-1.csv", other_value)
    status, out, _ = diff()
    assert status == 1
    value, curve, count, _ = out.splitlines()
    assert value == "lab/table-1: 2 root 1.5 -> 1.41421 (-5.7 %); 7 values unchanged"
    assert re.fullmatch(r"lab/fig-1: curve 'output' moved: at most 0.05 \(\d.\d % of the axis\) at time = .+", curve)
    assert count == "2 changes in 2 of 3 exhibits"


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        ("table-1.csv", other_verdict, "lab/table-1: 3 root verdict near -> reproduced; 7 values unchanged"),
        ("table-1.csv", lambda rows: rows.pop(1), "lab/table-1: 2 root is new; 7 values unchanged"),
        (
            "claims.csv",
            lambda rows: rows.append(["square", "holds", "1"]),
            "lab/claims: square is gone; 1 claim unchanged",
        ),
    ],
)
def test_cells(diff: Run, name: str, change: Callable[[list[list[str]]], object], said: str) -> None:
    edit(name, change)
    status, out, _ = diff()
    assert (status, out.splitlines()[0]) == (1, said)


@pytest.mark.parametrize("name", ["fig-1.csv", "fig-1.json", "table-1.csv", "claims.csv"])
def test_a_deleted_baseline(diff: Run, name: str) -> None:
    (Path("accepted/lab") / name).unlink()
    status, out, _ = diff()
    assert status == 1
    assert f"lab/{name.partition('.')[0]}: has no accepted state: lab/{name} is missing" in out


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        (
            "fig-1.csv",
            "panel,curve,x,y\na,b,1,2\na,b,1,two\n",
            "lab/fig-1.csv:3: x and y are 1,two; expected: two numbers",
        ),
        ("fig-1.csv", "panel,curve,x\n", "lab/fig-1.csv:1: the columns are panel,curve,x; expected: panel,curve,x,y"),
        ("fig-1.json", '[{"panel": "a"}]', "lab/fig-1.json: expected: a list of objects, each with panel, xlim, ylim"),
        ("table-1.csv", "row,column,reading,computed,printed,verdict\n1,2\n", "lab/table-1.csv:2: has 2 cells"),
    ],
)
def test_a_damaged_baseline(diff: Run, replicate: Run, name: str, text: str, said: str) -> None:
    (Path("accepted/lab") / name).write_text(text)
    edit("claims.csv", lambda rows: rows.pop())
    status, out, _ = diff()
    assert status == 2
    assert f"its accepted state is damaged: {said}" in out
    assert "lab/claims: root is new" in out  # damage to one file hides no change in another
    assert out.splitlines()[-2].endswith("; damaged in the accepted state: 1")
    assert said in next(junit().iter("error")).get("message", "")
    assert said.partition(":")[0] in index()
    assert replicate("check", "lab", "--accepted", "accepted", "-j1")[0] == 2
    assert replicate("accept", "lab", "--reason", "whole", "--accepted", "accepted", "-j1")[0] == 0
    assert diff()[0] == 0


def test_nothing_to_compare(diff: Run, replicate: Run) -> None:
    status, out, _ = diff("lab/fig-2")  # a photograph
    assert status == 2
    assert out.startswith("nothing was compared")
    status, out, _ = replicate("diff", "lab", "--accepted", "elsewhere", "-j1")
    assert status == 2
    assert "nothing was compared; 3 changes in 3 of 3 exhibits" in out


def test_an_exhibit_that_raises(diff: Run, replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LAB_BREAKS", "1")
    status, out, err = replicate("diff", "lab", "--accepted", "accepted", "-j1", "--no-cache")
    assert status == 2
    assert "lab/table-1: as-written: could not be computed: ValueError: the kettle is empty" in out
    assert "the kettle is empty" not in err  # once is enough
    assert diff("lab/fig-1")[0] == 0
    assert junit().find("testsuite/testcase") is not None


def test_one_exhibit_only(diff: Run) -> None:
    edit("fig-1.csv", lift)
    edit("table-1.csv", other_value)
    assert "fig-1" not in diff("lab/table-1")[1]
    assert "in 1 of 1 exhibit\n" in diff("lab/fig-1")[1]


def test_exhibits_and_papers_that_are_gone(diff: Run, replicate: Run) -> None:
    Path("accepted/lab/table-9.csv").write_text("row\n")
    Path("accepted/barn").mkdir()
    Path("accepted/barn/fig-1.csv").write_text("row\n")
    _, out, _ = diff()
    for name in ("lab/table-9", "barn/fig-1"):
        assert f"{name}: was accepted, but is no longer computed" in out
    assert replicate("accept", "lab", "--reason", "gone", "--accepted", "accepted", "-j1")[0] == 0
    assert diff()[0] == 0


def test_a_figure_that_is_new_or_gone_is_shown(diff: Run) -> None:
    for file in Path("accepted/lab").glob("fig-1.*"):
        file.with_stem("fig-8").write_bytes(file.read_bytes())
        file.unlink()
    diff()
    text = index()
    assert re.findall(r"<figcaption>(\w+), drawn from the data", text) == ["New", "Accepted"]
    assert text.count("<svg") == 2
    assert 'class="pair"' not in text


def test_a_figure_that_is_gone_and_damaged_is_named(diff: Run) -> None:
    for file in Path("accepted/lab").glob("fig-1.*"):
        file.with_stem("fig-8").write_bytes(file.read_bytes()[:50])
    status, out, _ = diff()
    assert status == 1
    assert "lab/fig-8: was accepted, but is no longer computed" in out
    assert "Accepted, drawn" not in index()


def test_the_page(diff: Run) -> None:
    edit("fig-1.csv", lift)
    edit("table-1.csv", other_value)
    diff()
    text = index()
    page = Page(text)
    assert (page.unbalanced, page.open) == ([], [])
    ids = page.values("id")
    assert len(ids) == len(set(ids))
    for address in page.values("href") + page.values("xlink:href"):
        if not address.startswith("../report/lab.html#"):  # the cell in the report that lies beside it
            assert address.startswith("#")
            assert address[1:] in ids
    assert set(re.findall(r"url\(#([^)]*)\)", text)) <= set(ids)
    # It stands alone: nothing is fetched, no address of another place but the names of the formats.
    assert page.values("src") == []
    assert set(re.findall(r"https?://[^\s\"'<)]+", text)) <= {
        "http://www.w3.org/2000/svg",
        "http://www.w3.org/1999/xlink",
        "http://www.w3.org/1998/Math/MathML",
    }
    assert [value for tag, name, value in page.attributes if (tag, name) == ("section", "id")] == [
        "lab-table-1",
        "lab-fig-1",
    ]
    # Without the script both pictures stand there; what the script adds is not in the text.
    assert text.count('<figure class="was">') == text.count('<figure class="now">') == 1
    assert re.findall(r"<label[^>]*><input[^>]*>", text) == [
        f"""<label hidden><input type="checkbox" class="accept" value='replicate accept {name} --reason "why"'>"""
        for name in ("lab/table-1", "lab/fig-1")
    ]
    assert '<a href="../report/lab.html#table-1.2.root">2, root</a>' in text
    assert "nearer to the print" in text
    assert text.count("<svg id=") == 4
    assert "1 exhibit unchanged" in text
    assert "<del>1.5</del>" in text
    assert "<b>1.41421356</b>" in text


def test_same_comparison_same_bytes(diff: Run) -> None:
    edit("fig-1.csv", lift)
    diff()
    before = contents(Path("build"))
    assert Path("build/diff/index.html") in before
    diff()
    assert contents(Path("build")) == before


def test_files_for_machines(diff: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    edit("fig-1.csv", lift)
    summary = Path("summary.md")
    summary.write_text("earlier\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(summary))
    diff()
    found = json.loads(Path("build/diff.json").read_text())
    assert (found["compared"], found["unchanged"], found["changed"]) == (
        3,
        ["lab/table-1", "lab/claims"],
        ["lab/fig-1"],
    )
    (change,) = found["changes"]
    assert (change["paper"], change["exhibit"], change["kind"]) == ("lab", "fig-1", "curve")
    limits = json.loads(Path("accepted/lab/fig-1.json").read_text())["panels"][0]["ylim"]
    assert change["size"] == pytest.approx(0.05 / (limits[1] - limits[0]), rel=5e-3)
    (failure,) = junit().iter("failure")
    assert failure.get("message") == change["text"]
    assert summary.read_text() == "earlier\n" + Path("build/diff.md").read_text()
    assert "### lab/fig-1\n\n- curve 'output' moved" in summary.read_text()


def test_words_are_there_when_the_summary_cannot_be_written(diff: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    edit("fig-1.csv", lift)
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "nowhere/summary.md")
    status, out, err = diff()
    assert status == 2
    assert out.startswith("lab/fig-1: curve 'output' moved")
    assert err.splitlines()[-1].startswith("replicate: GITHUB_STEP_SUMMARY: nowhere/summary.md: cannot be written")


def test_a_flood_of_changes_is_cut_short(diff: Run) -> None:
    def many(rows: list[list[str]]) -> None:
        rows += [["row", f"column-{number}", "as-written", "1", "", ""] for number in range(50)]

    edit("table-1.csv", many)
    _, out, _ = diff()
    *lines, count, _ = out.splitlines()
    assert len(lines) == 20
    assert lines[-1].endswith("; 30 more changes not listed here; 8 values unchanged")
    assert count.startswith("50 changes")
    assert len(json.loads(Path("build/diff.json").read_text())["changes"]) == 50


def screen(*exhibits: ExhibitDiff) -> list[str]:
    """Return the lines that the terminal shows."""
    console = Console(file=io.StringIO(), width=100)
    print_changes(Comparison(list(exhibits)), console)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue().splitlines()


def table(exhibit: str, changes: list[Change], paper: str = "lab") -> ExhibitDiff:
    return ExhibitDiff(paper, exhibit, "table", changes, 7, TableState({}), TableState({}))


def value(name: str, size: float, exhibit: str = "table-1") -> Change:
    return Change("lab", exhibit, "value", f"{name} moved", name, size=size)


def test_of_many_changes_the_screen_shows_those_that_matter_most() -> None:
    small = [value(f"small-{number}", 1e-5) for number in range(60)]
    verdict = Change("lab", "table-1", "verdict", "verdict near -> differs", size=1e-6)
    changes = [*small[:30], value("large", -0.4), *small[30:], verdict]
    lines = screen(table("table-1", changes), table("table-2", [value("alone", 1e-5, "table-2")]))
    assert len(lines) == 20
    assert "lab/table-1: large moved" in lines
    assert "lab/table-1: verdict near -> differs; 43 more changes not listed here; 7 values unchanged" in lines
    assert lines[-1] == "lab/table-2: alone moved; 7 values unchanged"


def test_of_many_exhibits_the_screen_shows_the_worst_and_counts_the_others() -> None:
    names = [f"table-{number}" for number in range(90)]
    lines = screen(*(table(name, [value("x", number / 100.0, name)]) for number, name in enumerate(names)))
    assert len(lines) == 20
    assert lines[0] == "lab/table-71: x moved; 7 values unchanged"
    assert lines[-1] == "further: 71 exhibits with smaller changes, not listed here: 71 of lab"


def test_a_paper_without_accepted_state_is_one_line() -> None:
    new = [
        ExhibitDiff(paper, f"fig-{number}", "figure", [Change(paper, f"fig-{number}", "new", "has no accepted state")])
        for paper in ("lab", "barn")
        for number in range(8 if paper == "lab" else 1)
    ]
    assert screen(*new) == [
        "lab: 8 exhibits have no accepted state: fig-0, fig-1, fig-2, fig-3, fig-4, fig-5 and 2 more",
        "barn/fig-0: has no accepted state",
    ]


def test_the_page_tells_a_verdict_once(diff: Run) -> None:
    edit("table-1.csv", other_verdict)
    edit("table-1.csv", lambda rows: [row.__setitem__(3, "1.6") for row in rows if row[:2] == ["3", "root"]])
    assert diff()[1].count("verdict near -> reproduced") == 1
    assert index().count(" → ") == 1


def test_the_page_names_the_commits_it_is_given(diff: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    edit("table-1.csv", other_value)
    monkeypatch.setenv("REPLICATE_HEAD_COMMIT", "0123456789abcdef")
    diff()
    assert "head <code>0123456789ab</code>" in index()
    assert "base <code>" not in index()


def test_the_page_strikes_out_only_what_changed(diff: Run) -> None:
    def other_print(rows: list[list[str]]) -> None:
        for row in rows:
            if row[:2] == ["2", "root"]:
                row[4] = "1.415"

    edit("table-1.csv", other_print)
    assert "lab/table-1: 2 root printed 1.415 -> 1.414" in diff()[1]
    assert "<del>" not in index()
    assert "printed 1.415 → 1.414" in index()


def test_the_page_draws_no_figure_for_a_missing_picture(diff: Run) -> None:
    (Path("accepted/lab") / "fig-1.png").unlink()
    assert "lab/fig-1: its picture, lab/fig-1.png, is missing; 1 curve unchanged" in diff()[1]
    assert "<svg" not in index()
    assert "No pictures here" not in index()


def test_the_page_says_where_one_figure_too_many_is_drawn(diff: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("replicate.diff.page.MOST_FIGURES", 0)
    edit("fig-1.csv", lift)
    diff()
    assert "<svg" not in index()
    assert "<code>replicate diff lab/fig-1</code> draws this one" in index()


def test_accepting_what_differs(diff: Run, replicate: Run) -> None:
    edit("fig-1.csv", lift)
    edit("table-1.csv", other_value)
    status, out, _ = replicate("accept", "lab/fig-1", "--reason", "less\n offset", "--accepted", "accepted", "-j1")
    assert status == 0
    assert out.startswith("lab/fig-1: curve 'output' moved")
    assert out.endswith("changes accepted: 1; in accepted\n")
    assert "## less offset\n\n- lab/fig-1: curve 'output' moved" in Path("accepted/CHANGES.md").read_text()
    assert "in 1 of 3 exhibits" in diff()[1]


def git(*command: str) -> str:
    options = ["-c", "user.name=n", "-c", "user.email=n@example.org", "-c", "commit.gpgsign=false"]
    return subprocess.run(["git", *options, *command], check=True, capture_output=True, text=True).stdout.strip()


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")
def test_the_page_names_the_commits_where_git_is(diff: Run) -> None:
    git("init", "-q")
    git("add", "accepted")
    git("commit", "-qm", "accepted")
    base = git("rev-parse", "HEAD")[:12]
    git("commit", "-qm", "something else", "--allow-empty")
    head = git("rev-parse", "HEAD")[:12]
    edit("table-1.csv", other_value)
    diff()
    assert f"base <code>{base}</code>" in index()
    assert f"head <code>{head} with changes</code>" in index()  # the accepted state was edited
    git("commit", "-qam", "edited")
    diff()
    assert "with changes" not in index()
    assert index().count(git("rev-parse", "HEAD")[:12]) == 2  # it is base and head


def test_the_page_shows_the_sentence_of_a_claim(diff: Run) -> None:
    edit("claims.csv", lambda rows: rows[1].__setitem__(1, "fails"))
    diff()
    row = index().partition('<table class="changed">')[2].partition("</table>")[0]
    assert "The root of two is below 1.5." in row
