"""Class sets: exercises that take numbers, what a marker accepts, rosters, forms and the sheets themselves."""

from __future__ import annotations

import csv
import io
import math
import re
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
import toy_class
from typer.testing import CliRunner

from replicate.cli import app
from replicate.errors import PaperDefinitionError, ReplicateError, TemplateError
from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answer, Variation, rounded
from replicate.handout import ClassSet, Form, Sheet, stressed
from replicate.handout import class_set as class_set_module
from replicate.handout.edition import edition
from replicate.handout.key_figures import key_figures
from replicate.handout.letters import can_be_set
from replicate.handout.marking_key import KeyRow, key_pdf, key_rows, plain_decimals
from replicate.handout.printout import markup, pdf
from replicate.languages import language
from replicate.papers.bayhan import paper as bayhan_paper
from replicate.papers.bayhan.handout import exercises as bayhan

TEXT = """# A toy

## Exercises

::: exercise
## Divide {vary="division"}
Divide ${{ inputs('division')['a'] }}$ by ${{ inputs('division')['b'] }}$.{{ stated('division') }}

::: solution
It is ${{ fixed(answer('division')['quotient'], 4) }}$.
:::
:::
"""


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ClassSet:
    return toy_class.class_set(tmp_path, monkeypatch, TEXT)


def test_the_accepted_interval_covers_all_paths_and_their_rounding() -> None:
    answer = Answer(0.50689, digits=3, carried=(0.586 / 1.16,))
    lower, upper = answer.accepted
    assert (lower, upper) == pytest.approx((0.586 / 1.16 - 0.0005, 0.50689 + 0.0005), rel=1e-12)
    assert answer.accepts(0.505)
    assert answer.accepts(0.507)
    assert not answer.accepts(0.508)


@pytest.mark.parametrize(("value", "margin"), [(9.996, 0.005), (-120.0, 0.5), (0.00123, 0.000005)])
def test_digits_are_half_a_unit_of_the_last_one(value: float, margin: float) -> None:
    lower, upper = Answer(value, digits=3).accepted
    assert (value - lower, upper - value) == pytest.approx((margin, margin), rel=1e-6)


def test_what_is_rounded_as_asked_is_accepted() -> None:
    rng = Random(3)  # noqa: S311  -- numbers to try
    for _ in range(500):
        value, digits = rng.choice((-1, 1)) * 10 ** rng.uniform(-6, 6), rng.randint(1, 6)
        assert Answer(value, digits=digits).accepts(rounded(value, digits))


@pytest.mark.parametrize("number", [Fraction(1, 3), np.float32(1 / 3), np.int64(3), 3])
def test_an_answer_is_a_number_of_any_kind_and_can_be_written_in_decimals(number: Any) -> None:
    answer = Answer(number, digits=3, carried=(number,), mistakes={"minus": -number})
    assert answer == Answer(float(number), digits=3, carried=(float(number),), mistakes={"minus": -float(number)})
    assert [plain_decimals(value) for value in (answer.value, *answer.carried)] == [f"{float(number):.7g}"] * 2


@pytest.mark.parametrize(
    "arguments",
    [{"value": math.nan, "digits": 3}, {"value": 1.0}, {"value": 1.0, "digits": 2, "tolerance": 0.1},
     {"value": 1.0, "digits": 0}, {"value": 1.0, "tolerance": -1.0},
     {"value": 1.0, "digits": 2, "carried": (math.inf,)}],
)  # fmt: skip
def test_an_answer_that_does_not_exist_is_refused(arguments: dict[str, float]) -> None:
    with pytest.raises(PaperDefinitionError):
        Answer(**arguments)  # type: ignore[arg-type]


def test_a_draw_depends_on_key_and_exercise_only_and_meets_what_is_required() -> None:
    one, other = bayhan.variations["missing-factor"], bayhan.variations["pade-phase"]
    assert one.drawn("a") == one.drawn("a") != one.drawn("b")
    other.drawn("a")
    for number in range(30):
        inputs = one.drawn(str(number))
        assert all(holds(inputs) for holds in one.requires.values())


def test_a_seed_that_no_draw_satisfies_is_one_line() -> None:
    never = Variation("never", {}, lambda rng: {"x": rng.random()}, lambda _: {}, {"x above one": lambda _: False})
    with pytest.raises(
        PaperDefinitionError, match=r"no draw of 1000 .*1000 fail 'x above one'; use another seed"
    ) as found:
        never.drawn("a")
    assert "\n" not in str(found.value)


def test_the_missing_factor_by_hand() -> None:
    """Ziegler and Nichols: Kp = 0.9 tau/(K L), Ti = 3 L; ITAESPC as the exercise prints it."""
    variation = bayhan.variations["missing-factor"]
    for inputs in (variation.original, variation.drawn("x"), variation.drawn("y")):
        K, tau, L = (float(inputs[name]) for name in ("K", "tau", "L"))
        found = variation.answers(inputs)
        assert found["ZN Kp/Ti"].value == pytest.approx(0.9 * tau / (K * L) / (3 * L), rel=1e-12)
        assert found["ZN 1/Ti"].value == pytest.approx(1 / (3 * L), rel=1e-12)
        kp, ti = 0.586 * (L / tau) ** -0.916 / K, tau / (1.03 - 0.165 * L / tau)
        assert found["ITAESPC Kp/Ti"].value == pytest.approx(kp / ti, rel=1e-12)
        by_hand = float(f"{float(f'{kp:.3g}') / float(f'{ti:.3g}'):.3g}")
        assert found["ITAESPC Kp/Ti"].accepts(by_hand)


def test_the_error_of_pade_by_hand() -> None:
    variation = bayhan.variations["pade-phase"]
    inputs = variation.drawn("x")
    for name, answer in variation.answers(inputs).items():
        x = float(inputs[name])
        by_formula = math.degrees(x - 2 * math.atan2(6 * x, 12 - x * x))
        assert answer.value == pytest.approx(by_formula, abs=1e-9)
        assert answer.accepts(round(by_formula, 2))


def test_a_paper_without_exercises_that_vary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    toy = toy_class.class_set(tmp_path, monkeypatch, TEXT)
    monkeypatch.setattr(class_set_module, "exercises_of", lambda _: Exercises())
    with pytest.raises(TemplateError, match=r"toy/handout\.py: no exercise has numbers that vary"):
        list(toy.files(["Ada"], "1"))


def test_stress_finds_a_mistake_that_is_accepted() -> None:
    wrong = Variation("w", {}, lambda _: {"x": 1}, lambda _: {"y": Answer(1.0, digits=2, mistakes={"slip": 1.04})})
    with pytest.raises(PaperDefinitionError, match=r"'slip'.* is accepted"):
        list(stressed(wrong, 3))
    guessed = Variation("g", {}, lambda _: {"x": 1}, lambda _: {"y": Answer(1.0, digits=2)})
    with pytest.raises(PaperDefinitionError, match="100% of the forms"):
        list(stressed(guessed, 100))


def test_a_form_is_read_back_and_names_nobody() -> None:
    form = Form.of("bayhan", "2026 W: ä/2", "Ada Lovelace")
    assert Form.read(str(form)) == form
    assert "Ada" not in str(form)
    with pytest.raises(ReplicateError, match="allowed: PAPER:KEY:SEED"):
        Form.read("bayhan:short:1")


def test_an_id_with_a_wrong_letter_is_refused() -> None:
    """One of 256 ids with mistakes has check digits that fit."""
    right = str(Form.of("bayhan", "2026W", "Ada", (2, 4)))
    wrong = [
        right[:place] + letter + right[place + 1 :]
        for place in range(len(right))
        for letter in "0123456789abcdef"
        if letter != right[place]
    ]
    passed = 0
    for text in wrong:
        with suppress(ReplicateError):
            passed += Form.read(text) is not None
    assert passed < len(wrong) / 50
    for text in (right.replace(":2.4", ""), right.replace(":2.4", ":2"), right.replace("bayhan", "khan")):
        with pytest.raises(ReplicateError, match="which no sheet has: a letter or a digit of it is wrong"):
            Form.read(text)


def test_a_sheet_made_again_has_the_same_bytes_if_what_is_set_is_given_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = Sheet("A quiz", "1 May", (2.0, 3.0), (1, 3), language("de"))
    first = toy_class.class_set(tmp_path, monkeypatch, sheet=settings)
    files = dict(first.files(["Ada"], "2026 W"))
    row, *_ = csv.DictReader(io.StringIO(files["toy-key.csv"].decode()))
    form = Form.read(row["form"])
    assert str(form) == f"toy:{form.key}:2026%20W:1.3"  # paper, key, seed, selection: nobody's name
    chosen = toy_class.class_set(tmp_path, monkeypatch, sheet=replace(settings, select=form.select))
    assert dict(chosen.again(form)) == {f"toy-{form.key}.pdf": files["toy-Ada.pdf"]}
    bare = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(select=form.select))
    (other,) = dict(bare.again(form)).values()
    assert other != files["toy-Ada.pdf"]  # title, date, points and language are not in the form


def test_the_key_shows_the_curves_that_students_were_to_sketch() -> None:
    students = ["Ada", "$a_b$", "山田"]
    forms = {student: Form.of("bayhan", "1", student) for student in students}
    figures = list(key_figures(bayhan.variations, forms, "bayhan"))
    assert [(figure.heading, figure.student) for figure in figures] == [
        ("sketch: The response", student) for student in students
    ]
    assert len({figure.drawing.svg for figure in figures}) == len(students)
    rows = [row for student, form in forms.items() for row in key_rows(bayhan.variations, student, form)]
    without, together = (key_pdf(rows, bayhan_paper, "1", some) for some in ((), figures))
    assert together.count(b"/S/Figure") == without.count(b"/S/Figure") + len(students)
    assert b"<pdfuaid:part>1</pdfuaid:part>" in together


@pytest.mark.parametrize(
    ("name", "font"),
    [("Łukasz Žižka", "Libertinus"), ("Nguyễn Văn Ánh", "Libertinus"), ("Иван Щербаков", "Libertinus"),
     ("Αθηνά", "Libertinus"), ("محمد حسن", "DejaVuSans"), ("Անի", "DejaVuSans"), ("ნინო", "DejaVuSans"),
     ("山田太郎", "NotoSansCJK"), ("王小明", "NotoSansCJK"), ("김철수", "NotoSansCJK"), ("สมชาย", "NotoSansThai"),
     ("अनिता", "NotoSansDevanagari"), ("கவிதா", "NotoSansTamil"), ("లక్ష్మి", "NotoSansTelugu"), ("សុខា", "NotoSansKhmer")],
)  # fmt: skip
def test_the_key_shows_names_of_many_scripts(name: str, font: str) -> None:
    row = KeyRow(name, "e", "p", "1", "0.9", "1.1", "", "toy:0123456789ab:1")
    made = key_pdf([row], bayhan_paper, "1")
    assert re.search(rb"/BaseFont/[A-Z]{6}\+" + font.encode(), made), re.findall(rb"/BaseFont/\S+", made)
    assert can_be_set(name)


def test_a_name_that_no_font_has_is_replaced_by_the_key_of_its_form() -> None:
    row = KeyRow("\U00012000", "e", "p", "1", "0.9", "1.1", "", "toy:0123456789ab:1")  # cuneiform
    assert key_pdf([row], bayhan_paper, "1") == key_pdf([replace(row, student="0123456789ab")], bayhan_paper, "1")


def test_progress_counts_the_sheets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    steps: list[tuple[int, int]] = []
    toy = toy_class.class_set(tmp_path, monkeypatch, progress=lambda done, total: steps.append((done, total)))
    dict(toy.files(["Ada", "Bob", "Eve"], "1"))
    assert steps == [(1, 3), (2, 3), (3, 3)]


def test_sheets_do_not_depend_on_the_rest_of_the_class(toy: ClassSet) -> None:
    small, large = dict(toy.files(["Ada", "山田"], "1")), dict(toy.files(["Bob", "Ada", "山田"], "1"))
    assert set(small) == {"toy-key.csv", "toy-key.pdf", "toy-Ada.pdf", "toy-山田.pdf"}
    assert {name: large[name] for name in small if "key" not in name} == {
        name: content for name, content in small.items() if "key" not in name
    }
    assert small == dict(toy.files(["Ada", "山田"], "1"))
    assert small["toy-Ada.pdf"] != dict(toy.files(["Ada"], "2"))["toy-Ada.pdf"]


def test_sheet_and_key_are_of_one_variant_and_the_form_makes_it_again(toy: ClassSet) -> None:
    files = dict(toy.files(["Ada"], "1"))
    row, *_ = csv.DictReader(io.StringIO(files["toy-key.csv"].decode()))
    form = Form.read(row["form"])
    sheet = edition(toy.paper, {}, (), solutions=False, form=form)
    source = markup(sheet)
    assert pdf(sheet) == files["toy-Ada.pdf"]
    assert row["form"] in source
    a, b = (float(tex) for displayed, tex in sheet.formulas)
    assert float(row["lower"]) <= float(f"{a / b:.3g}") <= float(row["upper"])
    assert not float(row["lower"]) <= float(f"{b / a:.3g}") <= float(row["upper"])
    assert "State three digits." in source
    assert "Ada" not in source
    assert list(toy.again(form)) == [(f"toy-{form.key}.pdf", files["toy-Ada.pdf"])]


def test_the_handout_that_all_share_has_the_original_numbers(toy: ClassSet) -> None:
    shared = edition(toy.paper, {}, (), solutions=True)
    assert [tex for _, tex in shared.formulas] == ["1", "4", "0.2500"]
    assert "form:" not in markup(shared)
    assert "State three digits." not in markup(shared)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["bayhan", "--variants", "2", "--form", str(Form.of("bayhan", "1", "Ada"))], "do not go together"),
        (["bayhan", "khan", "--variants", "2"], "about one paper"),
        (["--form", str(Form.of("bayhan", "1", "Ada")), "--format", "moodle"], "about a class"),
        (["--form", str(Form.of("bayhan", "1", "Ada")), "--select", "2"], "--select differs from the form"),
        (["bayhan", "--variants", "2", "--select", "9"], "no exercise 9; allowed: 1 to 8"),
        (["bayhan", "--variants", "2", "--select", "2,2"], "--select is '2,2', allowed"),
        (["bayhan", "--points", "4,five"], "--points is '4,five', allowed: positive numbers"),
        (["bayhan", "--points", "4,5"], "--points has 2 numbers, the sheet has 8 exercises; give one, or 8"),
        (["bayhan", "--language", "xx"], "--language is 'xx', allowed: de, en"),
        (["bayhan", "--variants", "1", "--seed", "\udcff"], "--seed holds the character U+DCFF, which sheets must not"),
        (["bayhan", "--title", "a\u202eb"], "--title holds the character U+202E"),
        (["bayhan", "--date", "a\x1bb"], "--date holds the character U+001B"),
        (["bayhan", "--language", "../de"], "--language is '../de', allowed: de, en"),
        (["bayhan", "--roster-id", "mail"], "--roster-id is 'mail', a column of a roster, and there is none"),
        (["bayhan", "--roster", "nobody.csv"], "nobody.csv: cannot be read"),
    ],
)
def test_options_that_cannot_be_met_are_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: list[str], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    outcome = CliRunner().invoke(app, ["handout", "--bundled", *options])
    assert outcome.exit_code != 0
    assert message in (str(outcome.exception) + outcome.output)
    assert not list(tmp_path.iterdir())
