"""A lecturer's own exercises: the example of the documentation, and what is said where one is wrong."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path

import pytest
import toy_class

from replicate.errors import ReplicateError
from replicate.handout import Form, Sheet, own_exercises, stressed
from replicate.handout.checking import Checker
from replicate.handout.edition import edition
from replicate.handout.printout import markup

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples" / "exercises"
TEXT = "## Title\nWhat is ${{ inputs['x'] }}$?\n\n::: solution\n${{ answer['answer'] }}$\n:::\n"
FIGURE = "from replicate.exhibits.variants import VariedFigure\n"
PROGRAM = """from replicate.exhibits.variants import Answer


def variant(rng):
    return {"x": rng.randint(20, 90)}


def answers(inputs):
    return Answer(inputs["x"] / 7, digits=3)
"""


def exercise(folder: Path, text: str = TEXT, program: str = PROGRAM) -> Path:
    home = folder / "mine"
    home.mkdir()
    (home / "exercise.md").write_text(text, encoding="utf-8")
    (home / "exercise.py").write_text(program, encoding="utf-8")
    return home


def test_the_example_of_the_documentation_is_the_one_that_is_tested() -> None:
    page = (ROOT / "docs" / "own-exercises.md").read_text(encoding="utf-8")
    for name in ("exercise.md", "exercise.py"):
        assert (EXAMPLE / "integral-gain" / name).read_text(encoding="utf-8").strip() in page


def test_the_example_is_on_the_sheets_and_in_the_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = tuple(own_exercises(EXAMPLE))
    assert [one.name for one in own] == ["integral-gain"]
    assert list(stressed(own[0].variation, 200))
    toy = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(own=own, select=(4,)))
    files = dict(toy.files(["Ada"], "1", "moodle"))
    (row,) = csv.DictReader(io.StringIO(files["toy-key.csv"].decode()))
    assert (row["exercise"], row["part"]) == ("integral-gain", "answer")
    sheet = edition(toy.paper, toy.results, (), solutions=True, form=Form.read(row["form"]), sheet=toy.sheet)
    source = markup(sheet)
    assert re.findall(r"Exercise (\d)", source) == ["4"]
    k, ti = (float(tex.split("=")[1]) for _, tex in sheet.formulas if re.fullmatch(r"(k|T_i) = [\d.]+", tex))
    assert float(row["answer"]) == pytest.approx(k / ti, rel=1e-6)
    assert f"{k / ti:.3g}" in source
    assert "The integral gain" in files["toy-moodle.xml"].decode()


def test_without_original_numbers_the_shared_handout_has_drawn_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tuple(own_exercises(exercise(tmp_path)))
    toy = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(own=own))
    document = edition(toy.paper, toy.results, (), solutions=True, sheet=toy.sheet)
    x = float(own[0].variation.original["x"])
    assert f"{x / 7}"[:5] in markup(document)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("def variant(rng):", "def variante(rng):"), r"mine/exercise\.py: defines no function 'variant'"),
        (("return Answer(", "return ("), r"mine/exercise\.py:9: the program fails: SyntaxError"),
        (
            ("digits=3", "digits=0"),
            r"mine/exercise\.py:9: answers\(inputs\) fails: .*'digits' of an answer is 0, allowed",
        ),
        (("digits=3", "digits=2.5"), r"mine/exercise\.py:9: .*'digits' of an answer is 2\.5, allowed: a whole number"),
        (("digits=3", "tolerance='x'"), r"mine/exercise\.py:9: .*'tolerance' of an answer is 'x', allowed: a number"),
        (("digits=3", "digits=3, mistakes=[1]"), r"mine/exercise\.py:9: .*'mistakes' of an answer is \[1\], allowed"),
        (("digits=3", "digits=3, carried=1.0"), r"mine/exercise\.py:9: .*'carried' of an answer is 1\.0, allowed"),
        (
            ("digits=3", r'digits=3, asked=r"$\frac{1$"'),
            r"mine/exercise\.py:8: .*'asked' of 'answer' holds the formula \$.*\$, which pandoc cannot convert: unexp",
        ),
        (("digits=3", 'digits=3, asked="$k$ and $T_i"'), r"mine/exercise\.py:8: .*'asked' of 'answer' .*between two"),
        (("digits=3", 'digits=3, asked="$$k$$"'), r"mine/exercise\.py:8: .*'asked' of 'answer' .*between two"),
        (
            ('Answer(inputs["x"] / 7, digits=3)', "{1: Answer(2.0, digits=3)}"),
            r"mine/exercise\.py:8: .*answer 1, all",
        ),
        (
            ("def variant", "figures = {'f': 1}\n\n\ndef variant"),
            r"mine/exercise\.py:4: .figures. is \{.f.: 1\}, all",
        ),
        (("digits=3", "digits=3, asked=3"), r"mine/exercise\.py:9: .*'asked' of an answer is 3, allowed: a text"),
        (("digits=3", "digits=3, mistakes={'a': 1e999}"), r"mine/exercise\.py:9: .*'mistakes' .*allowed: .* finite"),
        (
            ('inputs["x"] / 7', 'inputs.pop("x")'),
            r"mine/exercise\.py:9: .*'mappingproxy' object has no attribute 'pop'",
        ),
        (
            ('Answer(inputs["x"] / 7, digits=3)', "object()"),
            r"mine/exercise\.py:8: .*returns object, allowed: an Answer",
        ),
        (
            ("rng.randint(20, 90)", "__import__('random').random()"),
            r"mine/exercise\.py:4: variant\(rng\) draws other numbers for the same student and seed",
        ),
        (('inputs["x"] / 7', '"three"'), r"mine/exercise\.py:9: .*'value' of an answer is 'three', allowed: a number"),
        (('inputs["x"] / 7', 'float("nan")'), r"mine/exercise\.py:9: .*does not exist: \[nan"),
        (('{"x": rng.randint(20, 90)}', "None"), r"mine/exercise\.py:4: variant\(rng\) fails: .*returns None, allowed"),
        (
            ('{"x": rng.randint(20, 90)}', '{"x": 1e999}'),
            r"mine/exercise\.py:4: .*'x' is inf, allowed: a finite number",
        ),
        (('inputs["x"] / 7', 'inputs["y"]'), r"mine/exercise\.py:9: answers\(inputs\) fails: KeyError: 'y'"),
        (('{"x": rng.randint(20, 90)}', '{"x": [1]}'), r"mine/exercise\.py:4: variant\(rng\) fails: .*'x' is \[1\]"),
        (("Answer(inputs", "dict(ki=inputs"), r"mine/exercise\.py:8: answers\(inputs\) fails|mine/exercise\.py:9"),
        (("rng.randint(20, 90)", "1, 3: 4"), r"mine/exercise\.py:4: variant\(rng\) fails: .* names a field 3, allowed"),
        (
            ("def variant", "requires = {'a': print, 'b': 1}\n\n\ndef variant"),
            r"mine/exercise\.py:4: 'requires' is \{'a': <built-in function print>, 'b': 1\}, allowed",
        ),
        (
            ("def variant", "requires = {'a': lambda x: 1, 'b': 1}\n\n\ndef variant"),
            r"mine/exercise\.py:4: 'requires' is \{'a': <function <lambda>>, 'b': 1\}, allowed",
        ),
        (
            ("def variant", f"{FIGURE}figures = {{'f': VariedFigure('A', '', print)}}\n\n\ndef variant"),
            r"mine/exercise\.py:5: .* figure 'A': alt is empty",
        ),
        (
            ("def variant", f"{FIGURE}figures = {{'f': VariedFigure('A', 'B', print, (3,))}}\n\n\ndef variant"),
            r"mine/exercise\.py:5: .* figure 'A': size is \(3,\); expected",
        ),
        (
            ("def variant", "require = {}\n\n\ndef variant"),
            r"mine/exercise\.py:4: 'require' is used nowhere, and no name of a part of an exercise; write 'requires'",
        ),
        (("def variant", "originals = {'x': 3}\n\n\ndef variant"), r"mine/exercise\.py:4: .*; write 'original'"),
        (("def variant", "def show(inputs):\n    return {}\n\n\ndef variant"), r"mine/exercise\.py:4: .* 'shown'"),
        (("def variant", "stated = 3\n\n\ndef variant"), r"mine/exercise\.py:4: 'stated' is 3, allowed: a text"),
        (("def variant", "requires = 3\n\n\ndef variant"), r"mine/exercise\.py:4: 'requires' is 3, allowed: a dict"),
        (("def variant", "1 / 0\n\n\ndef variant"), r"mine/exercise\.py:4: the program fails: ZeroDivisionError"),
        (("def variant", "raise SystemExit\n\n\ndef variant"), r"mine/exercise\.py:4: the program fails: SystemExit"),
        (
            ("def variant", "requires = {'never': lambda x: False}\n\n\ndef variant"),
            r"mine/exercise\.py:4: .*no draw of 1000 .*1000 fail 'never'",
        ),
    ],
)
def test_what_is_wrong_in_the_program_is_one_line(tmp_path: Path, change: tuple[str, str], message: str) -> None:
    with pytest.raises(ReplicateError, match=message) as found:
        own_exercises(exercise(tmp_path, program=PROGRAM.replace(*change)))
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("No heading.\n", r"mine/exercise\.md:1: an exercise must begin with its title"),
        ("## T\n\nOf {{ inputs['y'] }}\n", r"mine/exercise\.md:3: .*'y'"),
        ("## T\n\n$\\unheardof{x}$\n", r"mine/exercise\.md:3: pandoc cannot convert"),
        ("## T\n\n::: other\nx\n:::\n", r"mine/exercise\.md:3: no block 'other'; allowed: exercise, key, lead, sol"),
        (
            "## T\n\nAs\n{{ figure('fig-1') }}\nshows\n",
            r"mine/exercise\.md:4: a figure or table must begin a paragraph",
        ),
        (
            "::: exercise\n## T\n\nx\n\n::: exercise\n## U\n:::\n:::\n",
            r"mine/exercise\.md:6: an exercise begins inside another; end that first",
        ),
        ("## T\n\nx\n\n::: {.exercise}\n## U\n:::\n", r"mine/exercise\.md:5: the file is one exercise; leave this"),
        ("::: exercise\n## T\n:::\n\nLost.\n", r"mine/exercise\.md:1: the file is one exercise; leave this begin"),
        ("## T\n\n- {{ figure('fig-1') }}\n", r"mine/exercise\.md:3: a figure or table must begin a paragraph"),
        (
            "## T\n\nx\n[y](javascript:z)\n",
            r"mine/exercise\.md:4: the link leads to javascript:z, allowed: http, https",
        ),
        ("## T {points=3}\n\nx\n", r"exercise 4 has points=\.\.\., allowed: tool, vary, fixed, plot"),
        ("## T\n\n<b>x</b>\n", r"mine/exercise\.md:3: raw text"),
        ("## T\n\n```{.python .run}\nx = 1\ny = 1 / 0\n```\n", r"mine/exercise\.md:5: the program fails"),
        ("## T\n\n::: solution\nx\n", r"mine/exercise\.md:\d: pandoc cannot read"),
    ],
)
def test_what_is_wrong_in_the_text_is_named_with_its_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, message: str
) -> None:
    own = tuple(own_exercises(exercise(tmp_path, text)))
    toy = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(own=own))
    with pytest.raises(ReplicateError, match=message):
        edition(toy.paper, toy.results, (), solutions=True, sheet=toy.sheet)


@pytest.mark.parametrize(
    "change",
    [
        ("return {", "file, state = 1, 2\n    return {"),  # of one function alone
        ("def variant", "figure = 7\nprint(figure, end='')\n\n\ndef variant"),
        ('inputs["x"] / 7, digits=3)', 'inputs["x"] / state(), digits=3)\n\n\ndef state():\n    return 7\n'),
        ("def variant", "stated, state = 'Three digits.', 'Bavaria'\n\n\ndef variant"),
        ("from replicate", "\N{BYTE ORDER MARK}from replicate"),
        ("def variant", "from os import stat as state\n_file = __file__\n\n\ndef variant"),
    ],
)
def test_other_names_of_a_program_are_its_own(tmp_path: Path, change: tuple[str, str]) -> None:
    (found,) = own_exercises(exercise(tmp_path, program=PROGRAM.replace(*change)))
    assert found.name == "mine"


def test_a_folder_that_is_none(tmp_path: Path) -> None:
    with pytest.raises(ReplicateError, match="there is no folder nowhere"):
        own_exercises(tmp_path / "nowhere")
    with pytest.raises(ReplicateError, match="holds no exercise"):
        own_exercises(tmp_path)
    (tmp_path / "exercise.md").write_text(TEXT, encoding="utf-8")
    with pytest.raises(ReplicateError, match=r"exercise\.py: there is no such file"):
        own_exercises(tmp_path)


def test_two_exercises_of_one_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = exercise(tmp_path)
    home.rename(tmp_path / "division")
    toy = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(own=tuple(own_exercises(tmp_path / "division"))))
    with pytest.raises(ReplicateError, match=r"division/exercise\.md: an exercise 'division' exists already"):
        list(toy.files(["Ada"], "1"))


def test_a_notebook_checks_answers_with_the_program_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    own = tuple(own_exercises(exercise(tmp_path)))
    toy = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(own=own), file_format="ipynb")
    files = dict(toy.files(["Ada"], "1"))
    assert files["exercises/mine/exercise.py"].decode() == PROGRAM
    cells = ["".join(cell["source"]) for cell in json.loads(files["toy-Ada.ipynb"])["cells"]]
    assert any(re.search(r"check = Checker\('toy', '.*', own=\('mine',\)\)", cell) for cell in cells)
    assert "check('mine', answers)" in cells[-1]

    form = Form.of("bayhan", "1", "Ada")
    check = Checker("bayhan", str(form), own=("mine",))
    x = float(own[0].variation.drawn(form.draw)["x"])
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ReplicateError, match=r"'mine' is checked with the file exercises/mine/exercise\.py, which is"):
        check("mine", {"answer": x / 7})
    (tmp_path / "exercises" / "mine").mkdir(parents=True)
    (tmp_path / "exercises" / "mine" / "exercise.py").write_bytes(files["exercises/mine/exercise.py"])
    check("mine", {"answer": float(f"{x / 7:.3g}")})
    check("mine", {"answer": 1.1 * x / 7})
    assert capsys.readouterr().out.splitlines() == ["answer: right", "answer: off by 10 %"]
