"""Teaching handouts: what comes out, and what stops the build."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import synthetic

from replicate.discovery import find_paper, known_papers
from replicate.errors import PaperDefinitionError, TemplateError
from replicate.exercises import Exercises
from replicate.handout import build_handouts, with_handout
from replicate.handout.edition import Document, edition
from replicate.handout.formulas import convert
from replicate.handout.printout import markup, pdf
from replicate.handout.webpage import webpage
from replicate.ledger import Ledger
from replicate.outcome import Outcome, recompute
from replicate.records import FigureResult, Results, TableResult
from replicate.verdicts import judge

SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 50" width="100" height="50">'
    '<path d="M 0 50 L 100 0" stroke="#000" fill="none"/></svg>'
)
TEXT = """# A *toy*

::: lead
Why?
:::

## The idea

It is $x_1 = {{ value('table-1', 'A', 'y', digits=3) }}$, as

$$G(s) = \\frac{e^{-s}}{1 + s}.$$

{{ table('table-1', readings={'as-written': 'exact'}) }}
**A table** of numbers.

{{ figure('fig-1', width=0.5) }}
**A figure.**

## Exercises

::: exercise
## First {tool="by hand"}
What is it?

```{.python .run}
number = 6
```

::: solution
```{.python .run}
print(7 * number)
```
:::
:::
"""

Make = Callable[..., Document]


def run(**cells: float) -> Results:
    results = synthetic.results(as_written=synthetic.frame(**cells))
    figure = results["toy", "fig-1"]
    assert isinstance(figure, FigureResult)
    results["toy", "fig-1"] = replace(figure, svg=SVG, axes=[{"title": "", "xlabel": "t", "ylabel": "y",
                                                            "xlim": [0, 1], "ylim": [0, 1], "legend": []}])  # fmt: skip
    return results


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Make an edition of a handout for a small paper, by default with solutions."""

    def document(text: str = TEXT, *, solutions: bool = True, **cells: float) -> Document:
        (tmp_path / "toy").mkdir(exist_ok=True)
        (tmp_path / "toy" / "handout.md").write_text(text, encoding="utf-8")
        paper = synthetic.paper(tmp_path / "toy")
        results = run(**cells)
        judged = judge(paper, results, printed=synthetic.printed(), ledger=Ledger("toy/ledger.toml", ()))
        return edition(paper, results, judged.verdicts, solutions=solutions)

    return document


@pytest.fixture(scope="module")
def bayhan() -> Outcome:
    paper = find_paper("bayhan")
    asked = [("bayhan", id) for id in ("table-2", "fig-2", "sample-grid", "match-count", "claims")]
    return recompute([paper], asked, jobs=1, cache_dir=None)


def pages(content: bytes) -> int:
    return len(re.findall(rb"/Type\s*/Page\b", content))


# --------------------------------------------------------------------------------------------------- a real handout


def test_a_real_handout(bayhan: Outcome, tmp_path: Path) -> None:
    verdicts = bayhan.judgement.verdicts
    first = build_handouts(bayhan.papers, bayhan.results, verdicts, tmp_path / "first")
    assert [path.name for path in first] == ["bayhan.pdf", "bayhan-solutions.pdf"]
    again = build_handouts(bayhan.papers, bayhan.results, verdicts, tmp_path / "second")
    for path, other in zip(first, again, strict=True):
        content = path.read_bytes()
        assert content == other.read_bytes()
        assert 2 <= pages(content) <= 6
        assert set(re.findall(rb"/MediaBox\s*\[([^]]*)\]", content)) == {b"0 0 595.2756 841.8898"}  # A4
        assert b"<pdfuaid:part>1</pdfuaid:part>" in content
        assert b"CreationDate" not in content
        assert b"ModDate" not in content


def test_nothing_is_left_unresolved(bayhan: Outcome) -> None:
    for solutions in (False, True):
        document = edition(bayhan.papers[0], bayhan.results, bayhan.judgement.verdicts, solutions=solutions)
        for text in (markup(document), webpage(document)):
            assert not re.search(r"\{\{|\{%|Undefined|\bnan\b|[\ue000-\uf8ff]", text)
            assert text.count("Exercise ") >= 5
        assert ("#solution[" in markup(document)) is solutions


def test_a_changed_result_changes_the_handout(bayhan: Outcome) -> None:
    def text(results: Results) -> str:
        return markup(edition(bayhan.papers[0], results, bayhan.judgement.verdicts, solutions=True))

    table = bayhan.results["bayhan", "table-2"]
    assert isinstance(table, TableResult)
    frame = table.frames["as-written"].copy()
    frame.loc["ITAESPC", "settling_time"] = 98.765432
    changed: Results = {
        **bayhan.results,
        ("bayhan", "table-2"): replace(table, frames={**table.frames, "as-written": frame}),
    }
    assert "98.8" not in text(bayhan.results)
    assert "98.8" in text(changed)  # in the prose, with three digits
    assert "98.76543" in text(changed)  # in the table, with one digit more than the print


@pytest.mark.parametrize("id", sorted(known_papers()))
def test_every_handout_has_exercises_with_solutions(id: str) -> None:
    text = (known_papers()[id].folder() / "handout.md").read_text(encoding="utf-8")
    exercises = text.split("::: exercise\n")[1:]
    assert len(exercises) >= 5
    assert all(exercise.count("::: solution\n") == 1 for exercise in exercises)
    assert "from replicate.loops import" in text
    assert "## What the paper got wrong, and how we know" in text


# ------------------------------------------------------------------------------------------------------ small ones


def test_editions_differ_in_the_solutions(make: Make) -> None:
    plain, solved = markup(make(solutions=False)), markup(make())
    assert "42" in solved  # what the program of the solution prints, with the name of the exercise's
    assert "42" not in plain
    assert "print(7" not in plain
    assert "number = 6" in plain
    assert plain.count("Exercise 1") == solved.count("Exercise 1") == 1


def test_a_page_with_everything(make: Make) -> None:
    document = make()
    assert document.title == "A toy"
    content = pdf(document)
    assert content.startswith(b"%PDF-")
    assert pages(content) >= 1
    page = webpage(document)
    for part in ("<math", 'role="img"', "<h1>A toy</h1>", "<h3><span", "<table", "reproduced", "replicate "):
        assert part in page
    assert "<script" not in page
    assert "http" not in re.sub(r"http://www\.w3\.org/\S+", "", page)


def test_formulas_are_said_in_words() -> None:
    said = {
        r"K_i = K_p/T_i": "K sub i equals K sub p over T sub i",
        r"\frac{e^{-sL}}{1+s\tau}": "the fraction e to the power minus s L, over 1 plus s tau, end of fraction",
        r"\sqrt{x^2 + 1}": "the square root of x squared plus 1, end of root",
        r"\int_0^\infty e\,dt": "the integral from 0 to infinity of e d t",
        r"\max_\omega S": "the maximum over omega of S",
        r"a \le b < c": "a is at most b is less than c",
        r"\hat{y}": "y hat",
    }
    found = convert([(False, tex) for tex in said])
    assert {tex: found[False, tex].words for tex in said} == said


def test_names_are_given_once() -> None:
    exercises = Exercises()
    exercises.answer("one")(dict)
    with pytest.raises(PaperDefinitionError, match="answer 'one' is defined twice"):
        exercises.answer("one")(dict)
    exercises.figure("one", "One", alt="One.")(lambda _: None)
    with pytest.raises(PaperDefinitionError, match="figure 'one' is defined twice"):
        exercises.figure("one", "One", alt="One.")(lambda _: None)


def test_a_paper_without_handout(tmp_path: Path) -> None:
    paper = synthetic.paper(tmp_path)
    with pytest.raises(TemplateError, match=r"toy/handout\.md: the paper has no handout"):
        with_handout([paper])


# ------------------------------------------------------------------------------------------- what stops the build

HEAD = "# Toy\n\n{% for i in [1, 2] %}\nA line.\n\n{% endfor %}\n{{ table('table-1') }}\n\n"  # eight lines


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{{ nothing }}\n", r"toy/handout\.md:9: 'nothing' is undefined"),
        ("{{ value('table-9', 'A', 'x') }}\n", r"toy/handout\.md:9: .*'table-9' is not an exhibit"),
        ("{{ table('fig-1') }}\n", r"toy/handout\.md:9: table\('fig-1'\): no such table"),
        ("{{ table('table-1', rows=['C']) }}\n", r"toy/handout\.md:9: .*there is no row 'C'; allowed: A, B"),
        ("{{ figure('fig-9') }}\n", r"toy/handout\.md:9: figure\('fig-9'\): no such figure; allowed: 'fig-1'"),
        ("{{ answer('one') }}\n", r"toy/handout\.md:9: answer\('one'\): no such answer"),
        ("Well:\n$\\unheardof{x}$\n", r"toy/handout\.md:10: pandoc cannot convert \$\\unheardof\{x\}\$: unexpected"),
        ("$$\na\n\\foo b\n$$\n", r"toy/handout\.md:10: pandoc cannot convert"),
        ("::: key\nNever closed.\n", r"toy/handout\.md:\d+: pandoc cannot read the text: Div at"),
        ("::: kye\nMisspelt.\n:::\n", r"no block 'kye'; allowed: exercise, key, lead, solution"),
        ("::: exercise\nNo heading.\n:::\n", r"exercise 1 does not begin with a heading"),
        ("```{.python .run}\nx = 1\ny = x / 0\n```\n", r"toy/handout\.md:11: the program fails: ZeroDivisionError"),
        ("```{.python .run}\nx = = 1\n```\n", r"toy/handout\.md:10: the program fails: SyntaxError"),
        ("```python\n" + "x" * 89 + "\n```\n", r"toy/handout\.md:10: a line has 89 characters, allowed: 88"),
        ("$$" + " + ".join(["x_{long}"] * 60) + "$$\n", r"cannot be typeset: .*a formula is wider than the text"),
    ],
)  # fmt: skip
def test_errors_name_the_place(make: Make, text: str, message: str) -> None:
    with pytest.raises(TemplateError, match=message):
        pdf(make(HEAD + text))


def test_a_handout_begins_with_its_title(make: Make) -> None:
    with pytest.raises(TemplateError, match=r"toy/handout\.md:1: a handout begins with its title"):
        make("Hello.\n")


def test_the_command_line_refuses_an_unknown_format(replicate: Callable[..., tuple[int, str, str]]) -> None:
    status, _, err = replicate("handout", "bayhan", "--format", "docx")
    assert status == 2
    assert err.strip().splitlines()[-1] == "replicate: the format is 'docx', allowed: pdf, html"
