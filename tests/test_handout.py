"""Teaching handouts: what comes out, and what stops the build."""

from __future__ import annotations

import html
import os
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest
import synthetic
from kept_results import kept_results
from qti_schema import faults

import replicate
from replicate.errors import PaperDefinitionError, TemplateError
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.results import FigureResult, Results, TableResult
from replicate.handout import handouts, with_handout
from replicate.handout.edition import Document, edition
from replicate.handout.exercise_heads import check_sheet
from replicate.handout.formulas import convert
from replicate.handout.placing import exercises_of
from replicate.handout.printout import markup, pdf
from replicate.handout.qti import qti_package
from replicate.handout.questions import questions_of
from replicate.handout.row_heads import with_row_heads
from replicate.handout.sheet import Sheet
from replicate.handout.slides import slides
from replicate.handout.tree import elements
from replicate.handout.webpage import webpage
from replicate.run.library import Library
from replicate.run.outcome import recompute
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge
from replicate.verdicts.ledger import Ledger
from replicate.whatif import NAME as WHATIF

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

BUNDLED = Library(bundled=True).papers()


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
        judged = judge(paper, results, Inputs(synthetic.printed(), Ledger()))
        return edition(paper, results, judged.verdicts, solutions=solutions)

    return document


# What each handout asks for; computing the other exhibits of the papers would take minutes.
ASKED = {
    "ali": ("table-1", "table-2", "ms-count", "stability", "fig-1"),
    "bayhan": ("table-1", "table-2", "fig-2", "sample-grid", "match-count", "claims"),
    "khan": ("table-1", "table-2", "eq-7", "lost-zeros", "fig-8a"),
    "krajewski": ("table-1", "table-1-errors", "table-1-residuals", "fig-5", "fig-10-values", "fig-11-values"),
    "panagopoulos": ("I-table-1", "I-table-2", "I-settling", "I-fig-2"),
}
# A computed value that the text of each handout quotes: exhibit, row, column.
QUOTED = {
    "ali": ("table-1", "0.9", "Ms"),
    "bayhan": ("table-2", "ITAESPC", "settling_time"),
    "khan": ("table-1", "Bryant", "td"),
    "krajewski": ("table-1-residuals", "sum", "45"),
    "panagopoulos": ("I-settling", "G6 Ms=2.0", "within_5"),
}
COMPUTED = 98.765432  # in place of the value; no handout has a number like it


class Made:
    """A real paper with the results that its handout needs, and both editions of it."""

    def __init__(self, id: str) -> None:
        with kept_results() as kept:
            self.outcome = recompute([Library().paper(id)], [(id, exhibit) for exhibit in ASKED[id]], cache_dir=kept)
        shared: dict[str, Any] = {}
        self.documents = {solutions: self.edition(solutions=solutions, shared=shared) for solutions in (False, True)}
        self.pdfs = {solutions: pdf(document) for solutions, document in self.documents.items()}

    @cached_property
    def markups(self) -> dict[bool, str]:
        """What the editions are for the typesetter."""
        return {solutions: markup(document) for solutions, document in self.documents.items()}

    @cached_property
    def webpages(self) -> dict[bool, str]:
        return {solutions: webpage(document) for solutions, document in self.documents.items()}

    def edition(
        self, results: Results | None = None, *, solutions: bool, shared: dict[str, Any] | None = None
    ) -> Document:
        (paper,), verdicts = self.outcome.papers, self.outcome.judgement.verdicts
        return edition(paper, results or self.outcome.results, verdicts, solutions=solutions, shared=shared)


@pytest.fixture(scope="module", params=sorted(ASKED))
def made(request: pytest.FixtureRequest) -> Made:
    return Made(request.param)


def pages(content: bytes) -> int:
    return len(re.findall(rb"/Type\s*/Page\b", content))


# -------------------------------------------------------------------------------------------------- the real handouts


def test_every_paper_is_tested() -> None:
    assert set(ASKED) == set(QUOTED) == {paper.id for paper in BUNDLED}


def test_pages(made: Made) -> None:
    for content in made.pdfs.values():
        assert 2 <= pages(content) <= 9
        assert set(re.findall(rb"/MediaBox\s*\[([^]]*)\]", content)) == {b"0 0 595.2756 841.8898"}  # A4


def test_pdfs_are_accessible_and_say_where_they_come_from(made: Made) -> None:
    paper = made.outcome.papers[0]
    for solutions, content in made.pdfs.items():
        metadata = content.partition(b"<x:xmpmeta")[2].partition(b"</x:xmpmeta>")[0].decode()
        assert "<pdfuaid:part>1</pdfuaid:part>" in metadata
        assert ">en-GB<" in metadata
        assert f">{made.documents[solutions].title}{' (with solutions)' if solutions else ''}<" in metadata
        assert paper.citation in html.unescape(metadata)
        assert f"replicate {replicate.__version__}" in metadata
        assert b"/Marked true" in content
        fonts = re.findall(rb"/Type/FontDescriptor.*?>>", content, re.DOTALL)
        assert fonts
        assert all(re.search(rb"/FontFile[23]?\b", font) for font in fonts)
        spoken = re.findall(rb"/Type/StructElem/S/(?:Figure|Formula)\b.*?endobj", content, re.DOTALL)
        assert len(spoken) > 20
        assert all(re.search(rb"/Alt[(<]", element) for element in spoken)


def test_the_exercises_are_valid_questions_by_the_schema_of_qti(made: Made) -> None:
    exercises = exercises_of(made.outcome.papers[0])
    assert faults(qti_package(list(questions_of(made.documents[True], exercises, None)))) == []


def test_slides_tell_the_story_with_numbers_of_the_results(made: Made) -> None:
    outcome = made.outcome
    document = edition(outcome.papers[0], outcome.results, outcome.judgement.verdicts, solutions=False, kind="slides")
    content = slides(document)
    headings = [element for element in elements(document.blocks) if element["t"] == "Header"]
    assert pages(content) == 1 + len(headings) == len(document.drawings)
    assert b"<pdfuaid:part>1</pdfuaid:part>" in content
    assert all(drawing.alt for drawing in document.drawings.values())


def test_tables_have_heads_for_columns_and_rows(made: Made) -> None:
    tables = [element for element in elements(made.documents[False].blocks) if element["t"] == "Table"]
    content = made.pdfs[False]
    assert len(tables) >= 1
    assert content.count(b"/Scope/Row") == sum(len(table["c"][4][0][3]) for table in tables)
    assert content.count(b"/Scope/Column") == sum(len(row[1]) for table in tables for row in table["c"][3][1])
    update = content.rpartition(b"startxref\n")[2]
    assert content[int(update.split()[0]) :].startswith(b"xref\n")
    for number, place in re.findall(rb"^(\d+) 1\n(\d{10}) 00000 n $", content, re.MULTILINE):
        assert content[int(place) :].startswith(b"%d 0 obj\n" % int(number))


def test_the_same_results_are_the_same_bytes(made: Made) -> None:
    outcome = made.outcome
    verdicts = outcome.judgement.verdicts
    *data, (name, content) = handouts(outcome.papers, outcome.results, verdicts, solutions=[True])
    assert name == f"{outcome.papers[0].id}-solutions.pdf"
    assert {Path(name).suffix for name, _ in data} <= {".csv"}  # what exercises give to work with
    assert content == made.pdfs[True]
    for content in made.pdfs.values():
        assert b"CreationDate" not in content
        assert b"ModDate" not in content


def test_nothing_is_left_unresolved(made: Made) -> None:
    for solutions in made.documents:
        for text in (made.markups[solutions], made.webpages[solutions]):
            assert not re.search(r"\{\{|\{%|Undefined|\bnan\b|[\ue000-\uf8ff]", text)
            assert text.count("Exercise ") >= 5
        assert ("#solution[" in made.markups[solutions]) is solutions


def test_a_web_page_fetches_nothing(made: Made) -> None:
    for page in made.webpages.values():
        assert "<script" not in page
        assert not re.search(r"<(?:link|iframe|img|object)\b|@import|url\((?!#|data:)", page)
        # Places in the page, and loops in the page beside it.
        targets = re.findall(r"""(?:href|src)=["']([^"']*)""", page)
        assert not [target for target in targets if not target.startswith(("#", f"{WHATIF}#"))]


def test_a_changed_result_changes_the_handout(made: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    id = made.outcome.papers[0].id
    exhibit, row, column = QUOTED[id]
    table = made.outcome.results[id, exhibit]
    assert isinstance(table, TableResult)
    frame = table.frames["as-written"].copy()
    assert (row in frame.index, column in frame.columns) == (True, True)
    frame.loc[row, column] = COMPUTED
    frames = {**table.frames, "as-written": frame}
    changed: Results = {**made.outcome.results, (id, exhibit): replace(table, frames=frames)}
    drawing = next(result for result in made.outcome.results.values() if isinstance(result, FigureResult))
    # The figures are not what changes here.
    monkeypatch.setattr("replicate.run.drawing.drawn_as", lambda *_: (drawing.svg.encode(), drawing.png))
    before, after = made.markups[False], markup(made.edition(changed, solutions=False))
    assert not re.search(r"\b98\.[78]", before)
    assert re.search(r"\b98\.(?:8|77|765)\b", after)  # in the prose, with the digits of the sentence


@pytest.mark.parametrize("id", [paper.id for paper in BUNDLED])
def test_every_handout_has_exercises_with_solutions(id: str) -> None:
    text = (Library().paper(id).folder() / "handout.md").read_text(encoding="utf-8")
    exercises = text.split("::: exercise\n")[1:]
    assert len(exercises) >= 5
    for exercise in exercises:
        question, _, solution = exercise.partition("::: solution\n")
        assert solution
        assert "::: solution\n" not in solution
        assert ('{tool="Python' in question) == ("{.python .run}" in solution)  # programs are answered by programs
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
        r"\ln 10": "the natural logarithm of 10",
        r"\exp(x)": "e to the (x)",
        r"2\sin\omega": "2 sine of omega",
    }
    found = convert([(False, tex) for tex in said])
    assert {tex: found[False, tex].words for tex in said} == said


@pytest.mark.parametrize(
    ("tex", "spaces"),
    [(r"\ln 10", 1), (r"2\sin\omega", 2), (r"\cosh(x)", 0), (r"K\cosh(x)", 1), (r"\max_\omega S", 1), ("K h", 0)],
)
def test_names_of_functions_stand_apart(tex: str, spaces: int) -> None:
    ((_, found),) = convert([(False, tex)]).items()
    assert found.mathml.count("<mspace") == spaces


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


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"# Toy\n\ncaf\xe9\n", r"toy/handout\.md:3: is not UTF-8 text"), ("# Toy".encode("utf-16"), ":1: is not UTF-8")],
)
def test_a_text_that_cannot_be_read_is_named_before_anything_is_computed(
    tmp_path: Path, content: bytes, said: str
) -> None:
    (tmp_path / "handout.md").write_bytes(content)
    with pytest.raises(TemplateError, match=said):
        check_sheet(synthetic.paper(tmp_path), Sheet())


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
        (f"{{{{ table('table-1', labels={{'x': '{'m' * 99}'}}) }}}}\n", r"table\('table-1'\) is wider than the text"),
    ],
)  # fmt: skip
def test_errors_name_the_place(make: Make, text: str, message: str) -> None:
    with pytest.raises(TemplateError, match=message):
        pdf(make(HEAD + text))


@pytest.mark.parametrize(
    "text",
    [
        '`#read("/etc/passwd")`{=typst}',
        '```{=typst}\n#include "/etc/passwd"\n```',
        "`<script>`{=html}",
        "<script>alert(1)</script>",
        '<img src="file:///etc/passwd">',
        '<iframe src="/etc/passwd"></iframe>',
        "<!-- a comment -->",
        "\\input{/etc/passwd}",
        "\\begin{center}x\\end{center}",
        "![a picture](/etc/passwd)",
        "![a picture](main.typ)",
        "{% include '/etc/passwd' %}",
    ],
)
def test_what_could_read_files_or_be_raw_is_refused_by_its_line(make: Make, text: str) -> None:
    with pytest.raises(TemplateError, match=r"toy/handout\.md:1[01]: .*(is not allowed|is not available)"):
        make(f"{HEAD}A line.\n{text}\n")


@pytest.mark.parametrize("text", ['#read("/etc/passwd")', '#include "/etc/passwd"', '#image("/etc/passwd")'])
def test_words_of_typst_are_words(make: Make, text: str) -> None:
    made = markup(make(f"{HEAD}{text}\n"))
    assert f"\\{text}" in made.replace('\\"', '"')


def test_a_formula_reads_no_file(make: Make) -> None:
    with pytest.raises(TemplateError, match=r"toy/handout\.md:9: pandoc cannot convert"):
        make(f"{HEAD}$\\input{{/etc/passwd}}$\n")


@pytest.mark.parametrize("leave", ["import sys; sys.exit(0)", "raise SystemExit", "quit()"])
def test_a_program_that_leaves_is_named_by_its_line(make: Make, leave: str) -> None:
    with pytest.raises(TemplateError, match=r"toy/handout\.md:10: the program fails: "):
        make(f"{HEAD}```{{.python .run}}\n{leave}\n```\n")


def test_row_heads_that_are_not_found_are_an_error() -> None:
    with pytest.raises(ValueError, match="0 row heads in the tables of the PDF, expected: 3"):
        with_row_heads(b"%PDF-1.7\ntrailer\n<</Size 1>>\nstartxref\n9\n%%EOF", rows=3)


def test_a_handout_begins_with_its_title(make: Make) -> None:
    with pytest.raises(TemplateError, match=r"toy/handout\.md:1: a handout must begin with its title"):
        make("Hello.\n")


def test_the_command_line_refuses_an_unknown_format(replicate: Callable[..., tuple[int, str, str]]) -> None:
    status, _, err = replicate("handout", "bayhan", "--format", "pages")
    assert status == 2
    allowed = "pdf, html, ipynb, docx, tex, typ, slides, moodle, qti"
    assert err.strip().splitlines()[-1] == f"replicate: the format is 'pages', allowed: {allowed}"


@pytest.mark.parametrize("words", ["Нелинейные системы", "Nguyễn Văn Hiệu", "Παπαδόπουλος", "Łukasiewicz"])
def test_letters_of_other_scripts_are_set(make: Make, words: str) -> None:
    assert pdf(make(TEXT.replace("Why?", f"Why, {words}?"))).startswith(b"%PDF")


def test_a_letter_that_no_font_has_is_named_with_its_line(make: Make) -> None:
    document = make(TEXT.replace("Why?", "Why, 𓀀?"))
    with pytest.raises(TemplateError, match=r"toy/handout\.md:4: no font at hand has the letter '𓀀' \(U\+13000"):
        pdf(document)


@pytest.mark.parametrize(
    ("loop", "line"),
    [
        ("while True:\n    try:\n        number = 6\n    except BaseException:\n        pass", 1),
        ("number = 6\nsum(range(10**18))", 2),  # one call of C code that keeps the interpreter
        ("import re\nre.match(r'(a+)+$', 'a' * 64 + 'b')", 2),
        ("import time\n\ndef wait():\n    time.sleep(1e6)\n\nwait()", 4),
    ],
)
def test_a_program_that_does_not_end_is_stopped_and_named_by_its_line(
    make: Make, monkeypatch: pytest.MonkeyPatch, loop: str, line: int
) -> None:
    monkeypatch.setattr("replicate.handout.programs.LONGEST_RUN", 0.7)
    with pytest.raises(TemplateError) as raised:
        make(f"{HEAD}```{{.python .run}}\n{loop}\n```\n")
    stated = re.fullmatch(
        r"toy/handout\.md:(\d+): the program did not end within 0\.7 s; it was stopped in this line", str(raised.value)
    )
    assert stated
    assert line <= int(stated[1]) - 9 <= max(line, 5 if "while" in loop else line)  # the program begins in line 10


@pytest.mark.parametrize("leave", ["import os\nos._exit(0)", "import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)"])
def test_a_program_that_ends_its_process_is_named(make: Make, leave: str) -> None:
    with pytest.raises(TemplateError, match=r"toy/handout\.md:1[01]: the program fails: it has ended its process"):
        make(f"{HEAD}```{{.python .run}}\n{leave}\n```\n")


@pytest.mark.parametrize("written", [markup, webpage])
def test_what_steers_in_the_output_of_a_program_is_written_out(make: Make, written: Callable[[Document], str]) -> None:
    program = "print('<' + chr(0xD800) + chr(0x1B) + chr(0) + chr(0x202E) + '>')"
    made = written(make(f"{HEAD}```{{.python .run}}\n{program}\n```\n"))
    assert all(piece in made for piece in ("ud800", "x1b", "x00", "u202e"))
    assert not {"\x1b", "\x00", "\u202e"} & set(made)


def test_what_a_program_changes_around_it_is_left_in_its_process(make: Make) -> None:
    program = "import os, sys\nos.environ['TOY'] = '1'\nos.chdir('/')\nsys.path.clear()\nprint('done')"
    here = Path.cwd()
    assert "done" in markup(make(f"{HEAD}```{{.python .run}}\n{program}\n```\n"))
    assert ("TOY" in os.environ, Path.cwd(), bool(sys.path)) == (False, here, True)


@pytest.mark.parametrize(
    "joined", ["What is it?\n::: solution", "What is it?{% if true %} Say.{% endif %}\n\n::: solution"]
)
def test_a_solution_that_would_be_words_of_the_question_is_refused(make: Make, joined: str) -> None:
    text = f"# A toy\n\n## Exercises\n\n::: exercise\n## One\n{joined}\nIt is this.\n:::\n:::\n"
    with pytest.raises(TemplateError, match=r"toy/handout\.md:\d+: ':::' is part of a paragraph; leave a line blank"):
        make(text, solutions=False)
    make(text.replace("::: solution", "\n::: solution"), solutions=False)
