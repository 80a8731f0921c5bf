"""The JSON Schemas: what they accept is what the package reads, and what it refuses they refuse."""

import csv
import json
import re
import tomllib
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import get_args

import jsonschema
import pytest
import toy_class

from replicate.errors import PaperDefinitionError
from replicate.exhibits.claims import ClaimVerdict
from replicate.exhibits.matching import MatchKind
from replicate.exhibits.variants import Answer
from replicate.handout import Sheet
from replicate.loops.sweep.axes import CONTROLLER_COLUMNS
from replicate.new_paper import new_paper
from replicate.new_project import new_project
from replicate.report import data
from replicate.report.columns import COLUMN_COLUMNS
from replicate.resources import schemas, templates_dir
from replicate.run import project as projects
from replicate.sweeps import sides, sweep_file
from replicate.verdicts import ledger as ledgers
from replicate.verdicts.causes import CAUSES, Cause
from replicate.verdicts.rows import ValueVerdict

ROOT = Path(__file__).parent.parent
LEDGERS = sorted([*ROOT.glob("replicate/papers/*/ledger*.toml"), *ROOT.glob("examples/*/papers/*/ledger*.toml")])
PRINTED = sorted([*ROOT.glob("replicate/papers/*/printed/*.csv"), *ROOT.glob("examples/*/papers/*/printed/*.csv")])
PROJECTS = sorted(ROOT.glob("examples/*/replicate.toml"))
ENTRY = {"exhibit": "table-1", "rows": ["A"], "columns": "*", "cause": "unknown", "explanation": "x"}

Run = Callable[..., tuple[int, str, str]]


def refused(name: str, data: object) -> str:
    validator = jsonschema.Draft202012Validator(json.loads(schemas()[name]))
    return "; ".join(error.message for error in validator.iter_errors(data))


@pytest.mark.parametrize("name", list(schemas()))
def test_a_schema_is_one(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(json.loads(schemas()[name]))


@pytest.mark.parametrize("file", LEDGERS, ids=lambda file: f"{file.parent.name}-{file.stem}")
def test_ledgers_fit(file: Path) -> None:
    assert not refused("ledger", tomllib.loads(file.read_text(encoding="utf-8")))


@pytest.mark.parametrize("file", PROJECTS, ids=lambda file: file.parent.name)
def test_project_files_fit(file: Path) -> None:
    assert not refused("project", tomllib.loads(file.read_text(encoding="utf-8")))


@pytest.mark.parametrize("file", PRINTED, ids=lambda file: f"{file.parent.parent.name}-{file.stem}")
def test_printed_values_fit(file: Path) -> None:
    lines = list(csv.DictReader(file.read_text(encoding="utf-8").splitlines()))
    assert lines
    name = "points" if "point" in lines[0] else "printed"
    assert not [why for line in lines if (why := refused(name, line))]


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("printed", {"mean": "3.8"}),
        ("printed", {"row": "A"}),
        ("printed", {"row": "", "mean": "3.8"}),
        ("points", {"point": "p", "curve": "c", "x": "1,5", "y": "1", "x_error": "0", "y_error": "0"}),
        ("points", {"point": "p", "curve": "c", "x": "1.5", "y": "1", "x_error": "-1", "y_error": "0"}),
    ],
)
def test_wrong_lines_do_not_fit(name: str, line: dict[str, str]) -> None:
    assert refused(name, line)


def test_the_columns_of_what_a_run_writes_are_those_of_their_schemas() -> None:
    written = {
        "results": data.RESULT_COLUMNS,
        "verdicts": (*data.VERDICT_COLUMNS, "address"),
        "errata": (*data.ERRATA_COLUMNS, "address"),
        "exhibits": data.EXHIBIT_COLUMNS,
        "ranges": data.RANGE_COLUMNS,
        "columns": COLUMN_COLUMNS,
    }
    for name, columns in written.items():
        schema = json.loads(schemas()[name])
        assert tuple(schema["properties"]) == columns == tuple(schema["required"])
    verdicts = json.loads(schemas()["verdicts"])["properties"]
    assert {*get_args(ValueVerdict), *get_args(ClaimVerdict)} == set(verdicts["verdict"]["enum"])
    assert {"", *get_args(Cause)} == set(verdicts["cause"]["enum"])
    assert set(get_args(MatchKind)) == set(json.loads(schemas()["results"])["properties"]["match"]["enum"])


def test_the_project_of_the_checkout_fits() -> None:
    assert not refused("project", tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["replicate"])


def test_the_sweep_of_the_guide_fits() -> None:
    guide = (ROOT / "docs" / "sweeps.md").read_text(encoding="utf-8")
    found = re.findall(r"^```toml\n(.*?)^```", guide, flags=re.MULTILINE | re.DOTALL)
    assert found
    assert not [refused("sweep", tomllib.loads(text)) for text in found if refused("sweep", tomllib.loads(text))]


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("ledger", {"entry": [{**ENTRY, "cause": "typo"}]}),
        ("ledger", {"entry": [{**ENTRY, "rows": []}]}),
        ("ledger", {"entry": [{**ENTRY, "rows": ["A", "A"]}]}),
        ("ledger", {"entry": [{**ENTRY, "corrected": 1.5}]}),
        ("ledger", {"entry": [{**ENTRY, "cause": "misprint", "columns": ["x", "y"], "corrected": "1.5"}]}),
        ("ledger", {"entry": [{**ENTRY, "consequence": "safety"}]}),
        ("ledger", {"entry": [{**ENTRY, "answer": "yes"}]}),
        ("ledger", {"entry": [{key: ENTRY[key] for key in ENTRY if key != "cause"}]}),
        ("ledger", {"entries": []}),
        ("project", {"titel": "x"}),
        ("project", {"papers": "papers"}),
        ("project", {"theme": {"accent": "red"}}),
        ("project", {"language": "English"}),
        ("sweep", {"plants": "1/(s+1)"}),
        ("sweep", {"plants": "1/(s+1)", "controllers": {"kp": 1}}),
        ("sweep", {"plants": "1/(s+1)", "controllers": {"k": {"from": 1, "to": 2}}}),
        ("sweep", {"plants": "1/(s+1)", "controllers": {"k": {"from": 1, "to": 2, "points": sides.MOST_POINTS + 1}}}),
        ("sweep", {"plants": "1/(s+1)", "controllers": "k=1", "block": sweep_file.MOST_IN_BLOCK + 1}),
    ],
)
def test_what_is_refused(name: str, data: dict[str, object]) -> None:
    assert refused(name, data)


def test_a_schema_knows_the_fields_that_are_read() -> None:
    entry = json.loads(schemas()["ledger"])["$defs"]["entry"]
    assert tuple(entry["properties"]) == ledgers._REQUIRED + ledgers._OPTIONAL
    assert tuple(entry["required"]) == ledgers._REQUIRED
    assert tuple(entry["properties"]["cause"]["enum"]) == tuple(CAUSES)
    assert tuple(json.loads(schemas()["project"])["properties"]) == projects._KEYS
    sweep = json.loads(schemas()["sweep"])["properties"]
    assert tuple(sweep) == sweep_file._KEYS
    (controllers,) = (kind["properties"] for kind in sweep["controllers"]["oneOf"] if "properties" in kind)
    assert tuple(controllers) == CONTROLLER_COLUMNS


def test_new_files_name_their_schema_and_fit(tmp_path: Path) -> None:
    new_project(tmp_path)
    new_paper("gauss", tmp_path / "papers", tmp_path / ".schemas")
    for file in (tmp_path / "replicate.toml", tmp_path / "papers" / "gauss" / "ledger.toml"):
        text = file.read_text(encoding="utf-8")
        named = re.match(r"#:schema (\S+)\n", text)
        assert named
        schema = (file.parent / named[1]).read_text(encoding="utf-8")
        assert not list(jsonschema.Draft202012Validator(json.loads(schema)).iter_errors(tomllib.loads(text)))


def test_the_schemas_of_the_examples_are_those_of_the_package() -> None:
    copies = sorted(ROOT.glob("examples/*/.schemas/*.json"))
    assert copies
    for copy in copies:
        assert copy.read_text(encoding="utf-8") == schemas()[copy.name.removesuffix(".schema.json")]


def test_the_command_prints_them(replicate: Run) -> None:
    status, out, _ = replicate("schema")
    assert status == 0
    assert [line.split()[0] for line in out.splitlines()] == list(schemas())
    assert json.loads(replicate("schema", "ledger")[1])["title"] == "ledger.toml"
    assert replicate("schema", "x")[0] == 2


# ---------------------------------------------------------------------------------- exercises, keys and languages

SOUND = {"value": 0.3, "digits": 3}


@pytest.mark.parametrize(
    "change",
    [
        {"value": "three"},
        {"value": True},
        {"digits": 0},
        {"digits": 16},
        {"digits": 2.5},
        {"tolerance": 0.1},
        {"digits": None, "tolerance": 0.0},
        {"digits": None, "tolerance": "x"},
        {"digits": None},
        {"carried": 1.0},
        {"carried": ["x"]},
        {"mistakes": [1.0]},
        {"mistakes": {"sign": "x"}},
        {"asked": 3},
        {"unit": 3},
        {},
        {"carried": (0.31,), "mistakes": {"sign": -0.3}, "asked": "$k$", "unit": "s"},
        {"digits": None, "tolerance": 0.5},
    ],
)
def test_the_schema_of_an_answer_refuses_what_the_program_does(change: dict[str, object]) -> None:
    given = {name: value for name, value in (SOUND | change).items() if value is not None}
    try:
        made = Answer(**given)  # type: ignore[arg-type]
    except PaperDefinitionError:
        made = None
    sent = json.loads(json.dumps(given))
    for answers in (sent, {"first": sent, "second": SOUND}):
        assert bool(refused("exercise", {"inputs": {"x": 1}, "answers": answers})) == (made is None)


def test_the_schema_of_an_answer_has_its_fields() -> None:
    answer = json.loads(schemas()["exercise"])["$defs"]["answer"]["properties"]
    assert list(answer) == [field.name for field in fields(Answer)]


@pytest.mark.parametrize(
    ("part", "value"),
    [
        ("inputs", {}),
        ("inputs", {"x": None}),
        ("inputs", {"x": [1]}),
        ("answers", {}),
        ("answers", {"first": 3}),
        ("files", {"../x.csv": "1"}),
        ("files", {"x.csv": 1}),
        ("stated", 3),
    ],
)
def test_what_no_exercise_may_return(part: str, value: object) -> None:
    assert not refused("exercise", {"inputs": {"x": 1}, "answers": SOUND, "files": {"x.csv": "1"}, "stated": "two"})
    assert refused("exercise", {"inputs": {"x": 1}, "answers": SOUND, part: value})


def test_keys_fit_their_schema(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for select in ((), (1,)):
        toy = toy_class.class_set(tmp_path, monkeypatch, sheet=Sheet(select=select))
        name, content = next(toy.files(["Ada", "Émile :2", "山田"], "2026 W:1"))
        assert name == "toy-key.csv"
        lines = list(csv.DictReader(content.decode().splitlines()))
        assert lines
        assert not [why for line in lines if (why := refused("key", line))]


def test_languages_fit_their_schema_which_says_each_word_in_english() -> None:
    folder = templates_dir() / "languages"
    for file in folder.glob("*.toml"):
        assert not refused("language", tomllib.loads(file.read_text(encoding="utf-8")))
    words = tomllib.loads((folder / "en.toml").read_text(encoding="utf-8"))["words"]
    schema = json.loads(schemas()["language"])["properties"]["words"]
    said = {name: word["description"].removesuffix(" ...") for name, word in schema["properties"].items()}
    assert (said, schema["required"]) == (words, list(words))
    assert refused("language", {"words": {name: words[name] for name in list(words)[1:]}})
