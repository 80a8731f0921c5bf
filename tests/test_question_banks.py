"""Questions for learning platforms: what was written is read again by other code, and each answer computed anew."""

from __future__ import annotations

import base64
import csv
import io
import re
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
import toy_class
from qti_schema import faults

from replicate.handout import ClassSet, Sheet, handouts

STUDENTS = ["Ada", "山田", "Bob"]


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ClassSet:
    return toy_class.class_set(tmp_path, monkeypatch, file_format="moodle")


def parsed(content: bytes) -> ET.Element:
    return ET.fromstring(content)  # noqa: S314  -- what the test has just written


def moodle(toy: ClassSet) -> ET.Element:
    *_, (name, content) = toy.files(STUDENTS, "1", "moodle")
    assert name == "toy-moodle.xml"
    return parsed(content)


def questions(quiz: ET.Element, kind: str) -> list[ET.Element]:
    return [question for question in quiz.iter("question") if question.get("type") == kind]


def text(node: ET.Element, path: str) -> str:
    return node.findtext(path) or ""


Band = tuple[float, float, float, str]  # lower end, upper end, per cent, feedback


def cloze_parts(source: str) -> Iterator[tuple[int, list[Band]]]:
    """Read embedded answers: {WEIGHT:NUMERICAL:=VALUE:TOLERANCE~%PER CENT%VALUE:TOLERANCE#FEEDBACK}."""
    for weight, body in re.findall(r"\{(\d*):NUMERICAL:((?:[^}\\]|\\.)*)\}", source):
        bands = []
        for one in re.split(r"(?<!\\)~", body):
            found = re.split(r"(?<!\\)#", one, maxsplit=1)
            answer, feedback = found[0], found[1] if len(found) > 1 else ""
            per_cent = 100.0 if answer.startswith("=") else float(re.match(r"%(\d+)%", answer)[1])  # type: ignore[index]
            value, tolerance = (float(part) for part in re.sub(r"^(=|%\d+%)", "", answer).split(":"))
            bands.append((value - tolerance, value + tolerance, per_cent, re.sub(r"\\(.)", r"\1", feedback)))
        yield int(weight), bands


def grade(bands: list[Band], value: float) -> float:
    """Grade as Moodle does: the first answer that fits counts."""
    return next((per_cent for lower, upper, per_cent, _ in bands if lower <= value <= upper), 0.0)


def test_one_category_per_exercise_and_in_it_one_question_per_form(toy: ClassSet) -> None:
    quiz = moodle(toy)
    kinds = [question.get("type") for question in quiz]
    assert kinds == ["category", *["numerical"] * 3, "category", "essay", "category", *["cloze"] * 3]
    categories = [text(question, "category/text") for question in questions(quiz, "category")]
    assert categories == [f"$course$/top/A toy/{name}" for name in ("1 Divide", "2 Why x < y?", "3 Two parts")]
    ids = [text(question, "idnumber") for question in quiz if question.get("type") != "category"]
    assert len(set(ids)) == len(ids) == 7
    assert "Ada" not in ET.tostring(quiz, encoding="unicode")


def test_a_numerical_question_accepts_what_the_key_accepts(toy: ClassSet) -> None:
    for question in questions(moodle(toy), "numerical"):
        a, b = (float(found) for found in re.findall(r"\\\((\d+)\\\)", text(question, "questiontext/text")))
        bands = [
            (value - tolerance, value + tolerance, float(answer.get("fraction", "")), text(answer, "feedback/text"))
            for answer in question.iter("answer")
            for value, tolerance in [(float(text(answer, "text")), float(text(answer, "tolerance")))]
        ]
        unit = 10.0 ** (len(str(int(a / b))) - 3) if a >= b else 0.01
        early = a * float(f"{1 / b:.3g}")
        for right in (a / b, float(f"{a / b:.3g}"), early, early + 0.499 * unit * (1 if early > a / b else -1)):
            assert grade(bands, right) == 100
        for wrong in (b / a, max(early, a / b) + 0.51 * unit, min(early, a / b) - 0.51 * unit, -a / b):
            assert grade(bands, wrong) == 0
        assert [feedback for lower, upper, _, feedback in bands if lower <= b / a <= upper] == ["upside down?"]


def test_a_numerical_question_accepts_the_ends_that_the_key_gives_and_nothing_beyond(toy: ClassSet) -> None:
    files = dict(toy.files([f"{number:03}" for number in range(20)], "2", "moodle"))
    asked = {
        text(question, "idnumber"): question for question in questions(parsed(files["toy-moodle.xml"]), "numerical")
    }
    rows = [row for row in csv.DictReader(io.StringIO(files["toy-key.csv"].decode())) if row["exercise"] == "division"]
    assert len(rows) == len(asked) == 20
    for row in rows:
        bands = [
            (float(text(answer, "text")), float(text(answer, "tolerance")), answer.get("fraction"))
            for answer in asked[f"toy-division-{row['form'].split(':')[1]}"].iter("answer")
        ]
        lower, upper = float(row["lower"]), float(row["upper"])
        for value, per_cent in ((lower, "100"), (upper, "100"), (0.9999 * lower, None), (1.0001 * upper, None)):
            fitting = (share for centre, tolerance, share in bands if abs(value - centre) <= tolerance)
            assert next(fitting, None) == per_cent


def test_a_cloze_question_has_a_field_for_each_answer(toy: ClassSet) -> None:
    for question in questions(moodle(toy), "cloze"):
        source = text(question, "questiontext/text")
        a, b = (float(found) for found in re.findall(r"\\\((-?\d+)\\\)", source)[:2])
        (_, added), (_, multiplied) = cloze_parts(source)
        assert [grade(added, value) for value in (a + b, a + b + 0.49, a + b + 0.51, a - b)] == [100, 100, 0, 0]
        assert [grade(multiplied, value) for value in (a * b, a * b - 0.99, a * b - 1.01, -a * b)] == [100, 100, 0, 0]
        assert added[1][3] == "sign # of b / ~?"
        assert "the sum" in source
        assert r"\(a + b\)" in source
        assert "} kg" in source


def test_an_essay_has_its_figure_inside_and_the_solution_for_those_who_grade(toy: ClassSet) -> None:
    (question,) = questions(moodle(toy), "essay")
    asked = text(question, "questiontext/text")
    assert re.search(r'src="@@PLUGINFILE@@/fig-1-\w{12}\.png" alt="y from 0 to 1 over t from 0 to 1\."', asked)
    assert r"\[\frac{1}{1 + s}\]" in asked
    assert "figure &amp; say" in asked
    assert "<pre>number = 6</pre>" in asked
    (embedded,) = question.iter("file")
    assert base64.b64decode(embedded.text or "") == toy_class.PNG
    assert f'src="@@PLUGINFILE@@/{embedded.get("name")}"' in asked
    assert "print(7 * number)" in text(question, "graderinfo/text")
    assert "42" in text(question, "generalfeedback/text")
    assert "42" not in asked


@pytest.mark.parametrize(("points", "weights", "grades"), [((4.0, 6.0, 2.0), [1, 1], ["4", "6"]),
                                                           ((3.0,), [1, 1], ["3", "3"])])  # fmt: skip
def test_points_are_grades(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, points: tuple[float, ...], weights: list[int], grades: list[str]
) -> None:
    quiz = moodle(toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(points=points), file_format="moodle"))
    (cloze, *_), (numerical, *_), (essay,) = (questions(quiz, kind) for kind in ("cloze", "numerical", "essay"))
    assert [weight for weight, _ in cloze_parts(text(cloze, "questiontext/text"))] == weights
    assert [text(question, "defaultgrade") for question in (numerical, essay)] == grades


def test_a_handout_that_all_share_has_its_questions_too(toy: ClassSet) -> None:
    ((_, content),) = handouts([toy.paper], toy.results, (), file_format="moodle")
    quiz = parsed(content)
    (question,) = questions(quiz, "numerical")
    assert text(question, "idnumber") == "toy-division-0"
    assert float(text(question, "answer/text")) == pytest.approx(1 / 4)


def test_the_same_class_has_the_same_bytes(toy: ClassSet) -> None:
    assert list(toy.files(STUDENTS, "1", "moodle"))[-1] == list(toy.files(STUDENTS[::-1], "1", "moodle"))[-1]


# --------------------------------------------------------------------------------------------------------------- QTI

Q = "{http://www.imsglobal.org/xsd/imsqti_v2p1}"
CP = "{http://www.imsglobal.org/xsd/imscp_v1p1}"
M = "{http://www.w3.org/1998/Math/MathML}"


def package(toy: ClassSet) -> zipfile.ZipFile:
    *_, (name, content) = toy.files(STUDENTS, "1", "qti")
    assert name == "toy-qti.zip"
    return zipfile.ZipFile(io.BytesIO(content))


def items(made: zipfile.ZipFile) -> dict[str, ET.Element]:
    found = [parsed(made.read(name)) for name in made.namelist() if name.startswith("items/")]
    return {str(item.get("identifier")): item for item in found}


def score(item: ET.Element, responses: dict[str, float]) -> float:
    """Interpret the item's own rules, as a platform does."""
    total = 0.0
    processing = item.find(f"{Q}responseProcessing")
    assert processing is not None
    for condition in processing:
        (rule,) = condition
        both, outcome = rule
        assert [both.tag, outcome.tag, outcome.get("identifier")] == [f"{Q}and", f"{Q}setOutcomeValue", "SCORE"]
        holds = True
        for relation in both:
            variable, constant = relation
            value, end = responses[str(variable.get("identifier"))], float(constant.text or "")
            holds &= value >= end if relation.tag == f"{Q}gte" else value <= end
        (added,) = outcome
        kept, share = added
        assert (added.tag, kept.get("identifier")) == (f"{Q}sum", "SCORE")
        total += float(share.text or "") if holds else 0.0
    return total


def test_the_manifest_lists_every_file_and_nothing_else(toy: ClassSet) -> None:
    made = package(toy)
    manifest = parsed(made.read("imsmanifest.xml"))
    assert manifest.tag == f"{CP}manifest"
    assert [child.tag for child in manifest] == [f"{CP}metadata", f"{CP}organizations", f"{CP}resources"]
    assert [node.text for node in manifest[0]] == ["QTIv2.1 Package", "1.0.0"]
    listed = {str(file.get("href")) for file in manifest.iter(f"{CP}file")}
    assert listed | {"imsmanifest.xml"} == set(made.namelist())
    resources = {str(resource.get("identifier")): resource for resource in manifest.iter(f"{CP}resource")}
    assert {resource.get("type") for resource in resources.values()} == {"imsqti_item_xmlv2p1", "imsqti_test_xmlv2p1"}
    for resource in resources.values():
        assert resource.get("href") in {file.get("href") for file in resource}
    assert {dependency.get("identifierref") for dependency in manifest.iter(f"{CP}dependency")} == set(items(made))
    (picture,) = [name for name in made.namelist() if name.startswith("images/fig-1-")]
    assert made.read(picture) == toy_class.PNG


def test_the_test_selects_one_form_of_each_exercise(toy: ClassSet) -> None:
    made = package(toy)
    test = parsed(made.read("test.xml"))
    sections = list(test.iter(f"{Q}assessmentSection"))
    assert [section.get("title") for section in sections] == ["Divide", "Why x < y?", "Two parts"]
    references = [[str(ref.get("href")) for ref in section.iter(f"{Q}assessmentItemRef")] for section in sections]
    assert [len(found) for found in references] == [3, 1, 3]
    assert {href for found in references for href in found} == {
        name for name in made.namelist() if name.startswith("items/")
    }
    assert all(selection.get("select") == "1" for selection in test.iter(f"{Q}selection"))


def test_an_item_has_the_parts_of_the_standard_in_its_order(toy: ClassSet) -> None:
    order = ["responseDeclaration", "outcomeDeclaration", "itemBody", "responseProcessing"]
    names = set()
    for id, item in items(package(toy)).items():
        assert item.tag == f"{Q}assessmentItem"
        assert re.fullmatch(r"[A-Za-z_][A-Za-z0-9_.-]*", id)  # an identifier of QTI
        assert (item.get("adaptive"), item.get("timeDependent")) == ("false", "false")
        places = [order.index(child.tag.removeprefix(Q)) for child in item]
        assert places == sorted(places)
        declared = {str(node.get("identifier")) for node in item.iter(f"{Q}responseDeclaration")}
        interactions = [*item.iter(f"{Q}textEntryInteraction"), *item.iter(f"{Q}extendedTextInteraction")]
        assert {node.get("responseIdentifier") for node in interactions} == declared
        body = item.find(f"{Q}itemBody")
        assert body is not None
        names |= {node.tag for node in body.iter() if not node.tag.startswith(M)}
        attributes = {key for node in body.iter() if not node.tag.startswith(M) for key in node.attrib}
        assert "style" not in attributes
        assert all(formula.get("alttext") for formula in body.iter(f"{M}math"))
    blocks = {"itemBody", "div", "p", "pre", "rubricBlock", "extendedTextInteraction", "textEntryInteraction", "img"}
    assert names == {f"{Q}{name}" for name in blocks}


def test_a_package_is_valid_by_the_published_schema(toy: ClassSet) -> None:
    *_, (_, content) = toy.files(STUDENTS, "1", "qti")
    assert faults(content) == []
    broken = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as good, zipfile.ZipFile(broken, "w") as bad:
        for name in good.namelist():
            text = good.read(name)
            bad.writestr(name, text.replace(b"<itemBody", b"<itemBody colour='red'"))
    assert len(faults(broken.getvalue())) == len(items(package(toy)))  # the schema sees what is not of the standard


def test_an_item_scores_what_the_key_accepts(toy: ClassSet) -> None:
    made = items(package(toy))
    numerical = [item for id, item in made.items() if "-division-" in id]
    for item in numerical:
        a, b = formulas(item)[:2]
        assert score(item, {"RESPONSE_1": float(f"{a / b:.3g}")}) == 1.0
        assert score(item, {"RESPONSE_1": b / a}) == 0.0
        correct = float(item.findtext(f"{Q}responseDeclaration/{Q}correctResponse/{Q}value") or "")
        assert correct == pytest.approx(a / b, rel=1e-6)
    for item in (item for id, item in made.items() if "-sums-" in id):
        a, b = formulas(item)[:2]
        assert score(item, {"RESPONSE_1": a + b, "RESPONSE_2": a * b}) == 2.0
        assert score(item, {"RESPONSE_1": a - b, "RESPONSE_2": a * b}) == 1.0
        assert score(item, {"RESPONSE_1": a + b + 0.51, "RESPONSE_2": a * b + 1.01}) == 0.0


def formulas(item: ET.Element) -> list[float]:
    """Return the numbers that are whole formulas, in the order of the text."""
    said = (str(formula.get("alttext")).replace("minus ", "-") for formula in item.iter(f"{M}math"))
    return [float(words) for words in said if re.fullmatch(r"-?[\d.]+", words)]


def test_the_same_class_has_the_same_package(toy: ClassSet) -> None:
    assert list(toy.files(STUDENTS, "1", "qti"))[-1] == list(toy.files(STUDENTS[::-1], "1", "qti"))[-1]
