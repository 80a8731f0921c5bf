"""Editions that can be edited or run: Word, LaTeX, Typst, notebooks, each read, set or run by others."""

from __future__ import annotations

import base64
import io
import re
import xml.etree.ElementTree as ET
import zipfile
from dataclasses import replace
from pathlib import Path

import nbclient
import nbformat
import pytest
import synthetic
import toy_class
import typst
from matplotlib.figure import Figure

from replicate.display.words import MATCHES, VERDICTS
from replicate.errors import ReplicateError
from replicate.exhibits.variants import rounded
from replicate.handout import Form
from replicate.handout.checking import Checker
from replicate.handout.editable import docx, tex, typ
from replicate.handout.edition import Document, edition, without_solutions
from replicate.handout.letters import fonts
from replicate.handout.notebook import notebook
from replicate.handout.printout import pdf
from replicate.handout.tree import string
from replicate.papers.bayhan.handout import exercises as bayhan

W = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
M = "{http://schemas.openxmlformats.org/officeDocument/2006/math}"
FORM = Form.of("bayhan", "1", "Ada")


@pytest.fixture
def sheet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Document:
    toy = toy_class.class_set(tmp_path, monkeypatch)
    return edition(toy.paper, toy.results, (), solutions=True, form=Form.of("toy", "1", "Ada"))


def test_a_word_document_has_equations_of_word_and_a_described_figure(sheet: Document) -> None:
    content = docx(without_solutions(sheet))
    with zipfile.ZipFile(io.BytesIO(content)) as package:
        body = ET.fromstring(package.read("word/document.xml"))  # noqa: S314  -- what pandoc has just written
        pictures = [package.read(name) for name in package.namelist() if name.startswith("word/media/")]
    words = " ".join(node.text or "" for node in body.iter(f"{W}t"))
    assert len(list(body.iter(f"{M}oMath"))) == len(without_solutions(sheet).formulas) == 6
    assert len(list(body.iter(f"{M}f"))) == 1  # the fraction
    assert pictures == [toy_class.PNG]
    described = {node.get("descr") for node in body.iter() if node.tag.endswith("}docPr")}
    assert described == {"y from 0 to 1 over t from 0 to 1."}
    assert sheet.form in words
    assert "42" not in words
    assert content == docx(without_solutions(sheet))
    assert "Solution" in docx_words(docx(sheet))


def docx_words(content: bytes) -> str:
    with zipfile.ZipFile(io.BytesIO(content)) as package:
        return package.read("word/document.xml").decode()


def test_a_latex_document_asks_for_the_figures_beside_it(sheet: Document) -> None:
    files = tex(sheet)
    picture = f"toy-{Form.of('toy', '1', 'Ada').key}-fig-1.pdf"
    assert set(files) == {".tex", picture}
    source = files[".tex"].decode()
    assert re.findall(r"\\includegraphics\[[^]]*\]\{([^}]*)\}", source) == [picture]
    assert r"\[\frac{1}{1 + s}\]" in source
    assert source.index(r"\begin{document}") < source.index("Exercise 1") < source.index(r"\end{document}")
    opened, closed = (re.findall(rf"\\{word}\{{(\w+)\}}", source) for word in ("begin", "end"))
    assert sorted(opened) == sorted(closed)
    assert files[picture].startswith(b"%PDF-")
    assert files == tex(sheet)


def test_signs_of_tables_are_commands_of_latex(sheet: Document) -> None:
    signs = "".join(word.symbol for word in VERDICTS.values()) + "".join(sign for sign, _ in MATCHES.values())
    row = {"t": "Para", "c": [string(f"{signs}\N{FIGURE SPACE}\N{PUNCTUATION SPACE}\N{MINUS SIGN}1")]}
    source = tex(replace(sheet, blocks=[row]))[".tex"].decode()
    assert {letter for letter in source if not letter.isascii()} == set()


def test_a_typst_document_is_one_file_that_typst_sets(sheet: Document) -> None:
    source = typ(sheet)
    made = typst.compile(source, font_paths=fonts(), pdf_standards=["ua-1"])
    assert isinstance(made, bytes)
    assert b'image("' not in source
    assert b"#import" not in source
    assert pages(made) == pages(pdf(sheet))
    assert source == typ(sheet)


def pages(content: bytes) -> int:
    return len(re.findall(rb"/Type\s*/Page\b", content))


# ------------------------------------------------------------------------------------------------------- notebooks

TEXT = """# A short one

It is $x$ < 1.

::: exercise
## How good is Padé? {vary="pade-phase" plot="settling-over-a"}
At ${{ inputs('pade-phase')['low'] }}$?

{{ figure('fig-1') }}

```{.python .run}
start = 6
```

::: solution
It is ${{ fixed(answer('pade-phase')['high'], 2) }}$.

```{.python .run}
print(7 * start)
```
:::
:::

::: exercise
## The missing factor {vary="missing-factor"}
Take ${{ answer('missing-factor')['process'] }}$.
:::
"""


@pytest.fixture
def short(tmp_path: Path) -> Document:
    """Make a sheet with exercises of a bundled paper, around a text that needs nothing of it computed."""
    (tmp_path / "handout.md").write_text(TEXT, encoding="utf-8")
    (tmp_path / "handout.py").touch()
    paper = synthetic.FolderPaper(
        "bayhan", "replicate.papers.bayhan", "B", ("N. N.",), "B (2007)", 2007, (), ("fig-1",)
    )
    paper.data_folder = tmp_path
    toy = synthetic.paper(tmp_path)
    paper.exhibits.update({"fig-1": toy.exhibits["fig-1"]})
    results = {("bayhan", exhibit): result for (_, exhibit), result in toy_class.results().items()}
    return edition(paper, results, (), solutions=True, form=FORM)


def executed(content: bytes, answers: dict[str, dict[str, float]]) -> list[str]:
    """Return what the check cells write when a student has filled in answers."""
    made = nbformat.reads(content.decode(), as_version=4)  # type: ignore[no-untyped-call]
    for cell in made.cells:
        for exercise, values in answers.items():
            if f"check({exercise!r}" in cell.source:
                for name, value in values.items():
                    assert f"{name!r}: None" in cell.source
                    cell.source = cell.source.replace(f"{name!r}: None", f"{name!r}: {value!r}")
    nbclient.NotebookClient(made, timeout=120).execute()
    # A kernel may send what one cell prints in several parts.
    return ["".join(output.text for output in cell.outputs) for cell in made.cells if "check(" in cell.source]


def test_a_students_notebook_is_valid_and_holds_no_answer(short: Document) -> None:
    content = notebook(without_solutions(short))
    made = nbformat.reads(content.decode(), as_version=4)  # type: ignore[no-untyped-call]
    nbformat.validate(made)
    text = content.decode()
    for name in ("pade-phase", "missing-factor"):
        for answer in bayhan.variations[name].answers(bayhan.variations[name].drawn(FORM.draw)).values():
            assert f"{answer.value:.3g}" not in re.findall(r"-?\d+\.\d+", text)
    assert "Solution" not in text
    assert "print(7 * start)" not in text
    assert [cell.source for cell in made.cells if "start" in cell.source and cell.cell_type == "code"] == ["start = 6"]
    (pictured,) = [cell for cell in made.cells if "attachments" in cell]
    ((name, picture),) = pictured.attachments.items()
    assert f'<img src="attachment:{name}" alt="y from 0 to 1' in pictured.source
    assert base64.b64decode(picture["image/png"]) == toy_class.PNG
    assert "$x$" in made.cells[2].source
    assert content == notebook(without_solutions(short))


def test_a_notebook_runs_and_says_what_an_answer_deserves(short: Document) -> None:
    pade = bayhan.variations["pade-phase"].answers(bayhan.variations["pade-phase"].drawn(FORM.draw))
    factor = bayhan.variations["missing-factor"].answers(bayhan.variations["missing-factor"].drawn(FORM.draw))
    early = factor["ZN Kp/Ti"]
    worst = max(early.carried, key=lambda value: abs(value - early.value))
    beyond = early.accepted[1 if worst > early.value else 0]
    answers = {
        "pade-phase": {"low": round(pade["low"].value, 2), "middle": 1.031 * pade["middle"].value},
        "missing-factor": {"ZN Kp/Ti": beyond, "ZN 1/Ti": rounded(factor["ZN 1/Ti"].value, 3)},
    }
    said = executed(notebook(without_solutions(short)), answers)
    assert said == [
        "low: right\nmiddle: off by 3.1 %\nhigh: not answered yet\n",
        "ZN Kp/Ti: right but rounded too early\nZN 1/Ti: right\n"
        + "".join(f"ITAESPC {part}: not answered yet\n" for part in ("Kp/Ti", "1/Ti")),
    ]


def test_the_notebook_with_solutions_runs(short: Document) -> None:
    content = notebook(short)
    assert "print(7 * start)" in content.decode()
    assert executed(content, {})[0].startswith("low: not answered yet")


def test_a_plot_is_checked_by_its_curves(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def drawn(factor: float, points: int) -> Figure:
        figure = Figure()
        x = [step / points for step in range(points + 1)]
        figure.subplots().plot(x, [factor * value**2 for value in x], label="parabola")
        return figure

    solution = type(bayhan.figures["settling-over-a"])("parabola", "figure", "A parabola", _draw_parabola)
    check = Checker("bayhan")
    monkeypatch.setitem(check.exercises.figures, "parabola", solution)
    check.plot("parabola", drawn(1.0, 150))
    check.plot("parabola", drawn(1.2, 150))
    check.plot("parabola", Figure())
    right, moved, empty = capsys.readouterr().out.splitlines()
    assert right == "right"
    assert moved.startswith("curve 'parabola'")
    assert empty == "the figure has no axes"


def _draw_parabola(figure: Figure) -> None:
    x = [step / 200 for step in range(201)]
    figure.subplots().plot(x, [value**2 for value in x], label="parabola")


def test_what_cannot_be_checked_is_one_line() -> None:
    with pytest.raises(ReplicateError, match="is of the paper 'bayhan', not of 'khan'"):
        Checker("khan", str(FORM))
    check = Checker("bayhan", str(FORM))
    with pytest.raises(ReplicateError, match=r"no exercise 'pade'.*allowed: missing-factor, pade-phase"):
        check("pade", {})
    with pytest.raises(ReplicateError, match="no answer 'lo'; allowed: low, middle, high"):
        check("pade-phase", {"lo": 1.0})
    with pytest.raises(ReplicateError, match="no figure 'x'; allowed: settling-over-a"):
        check.plot("x", None)  # type: ignore[arg-type]
