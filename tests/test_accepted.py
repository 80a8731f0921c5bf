"""The accepted state: the alarm rings for every kind of change, and only then."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import synthetic
from PIL import Image

from replicate.diff.accept import LOG, accept
from replicate.diff.check import check
from replicate.diff.checksums import SUMS
from replicate.diff.comparison import compare as compare_all
from replicate.errors import OutputError, ReplicateError
from replicate.exhibits import Finding
from replicate.exhibits.results import FigureResult, Results
from replicate.figures.record import REVISION
from replicate.run.library import Library
from replicate.run.outcome import Outcome
from replicate.verdicts.inputs import Inputs
from replicate.verdicts.judge import judge

AXES: list[dict[str, Any]] = [
    {
        "panel": "panel 1",
        "title": "",
        "xlabel": "time",
        "xscale": "linear",
        "yscale": "linear",
        "xlim": [0.0, 10.0],
        "ylim": [0.0, 2.0],
        "legend": ["output", "input"],
    }
]
FIGURES = Path(__file__).parent.parent / "figures"
T = np.linspace(0.0, 10.0, 201)


Curves = dict[str, tuple[Any, Any]]

OUTPUT, INPUT = (T, 1.0 - np.exp(-T)), (T, np.where(T < 3.0, 0.0, 1.0))
BOTH: Curves = {"output": OUTPUT, "input": INPUT}


def picture(colour: str) -> bytes:
    buffer = io.BytesIO()
    Image.new("RGB", (40, 20), colour).save(buffer, format="png")
    return buffer.getvalue()


BIG = synthetic.FINDINGS["big"]
PICTURE, OTHER_FONTS = picture("red"), picture("blue")


def figure(curves: Curves = BOTH, axes: list[dict[str, Any]] = AXES, png: bytes = PICTURE) -> FigureResult:
    frames = [pd.DataFrame({"panel": "panel 1", "curve": name, "x": x, "y": y}) for name, (x, y) in curves.items()]
    return FigureResult("toy", "fig-1", "<svg/>", png, pd.concat(frames), axes)


def outcome(folder: Path, drawn: FigureResult | None = None, **changes: Any) -> Outcome:
    folder.mkdir(exist_ok=True)
    toy = synthetic.paper(folder)
    results: Results = synthetic.results(**changes)
    results["toy", "fig-1"] = drawn or figure()
    return Outcome([toy], results, {"toy": judge(toy, results, Inputs(synthetic.printed()))})


def compare(present: Outcome, folder: Path) -> list[str]:
    return compare_all(present, folder).lines


def edit_json(path: Path, change: Callable[[dict[str, Any]], None]) -> None:
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content))


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return tmp_path / "data"


@pytest.fixture
def accepted(tmp_path: Path, data: Path) -> Path:
    folder = tmp_path / "figures"
    accept(outcome(data), folder, "first")
    return folder


def test_what_is_stored(accepted: Path) -> None:
    assert sorted(path.name for path in (accepted / "toy").iterdir()) == [
        "SHA256SUMS",
        "claims.csv",
        "claims.json",
        "fig-1.csv",
        "fig-1.json",
        "fig-1.png",
        "table-1.csv",
        "table-1.json",
    ]
    assert (accepted / "toy/table-1.csv").read_text().splitlines()[:2] == [
        "row,column,reading,computed,printed,verdict",
        "A,x,as-written,1,1.0,reproduced",
    ]
    assert (accepted / "toy/claims.csv").read_text() == "row,verdict,computed\nbig,holds,3.1\nsmooth,fails,0.2\n"


def test_nothing_differs_from_itself(accepted: Path, data: Path) -> None:
    assert compare(outcome(data), accepted) == []
    assert check(outcome(data), accepted) == []
    before = (accepted / LOG).read_bytes()
    assert accept(outcome(data), accepted, "again").changes == []
    assert (accepted / LOG).read_bytes() == before


def test_other_pictures_and_rounding_do_not_matter(accepted: Path, data: Path) -> None:
    noise = 1e-10 * np.sin(np.arange(len(T)))
    finer = np.sort(np.r_[np.linspace(0.0, 10.0, 6001), 3.0])
    resampled = {
        "output": (finer, 1.0 - np.exp(-finer)),
        "input": (np.array([0.0, 2.95, 3.0, 10.0]), np.array([0.0, 0.0, 1.0, 1.0])),
    }
    same = [
        outcome(data, figure(png=OTHER_FONTS)),
        outcome(data, figure({"output": (T, 1.0 - np.exp(-T) + noise), "input": (T, np.where(T < 3.0, 0.0, 1.0))})),
        outcome(data, figure(resampled)),
        outcome(data, as_written=synthetic.frame(ax=1.0 + 1e-10)),
    ]
    for present in same:
        assert compare(present, accepted) == []


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"as_written": synthetic.frame(ax=1.001)}, "toy/table-1: A x 1 -> 1.001 (+0.1 %); 7 values unchanged"),
        (
            {"as_written": synthetic.frame(ax=1.3)},
            "toy/table-1: A x 1 -> 1.3 (+30 %); verdict reproduced -> unexplained; 7 values unchanged",
        ),
        (
            {"findings": {"big": BIG, "smooth": Finding("holds-partly", 0.2, "It jumps once.")}},
            "toy/claims: smooth verdict fails -> holds-partly; 1 claim unchanged",
        ),
        ({"findings": {"big": BIG}}, "toy/claims: smooth is gone; 1 claim unchanged"),
        (
            {"errors": {"authors": "ValueError: no"}},
            "toy/table-1: authors: could not be computed: ValueError: no",
        ),
    ],
)
def test_changed_values_and_verdicts(accepted: Path, data: Path, changed: dict[str, Any], said: str) -> None:
    assert said in compare(outcome(data, **changed), accepted)


@pytest.mark.parametrize(
    ("curves", "said"),
    [
        (
            {"output": (T, OUTPUT[1] + 0.002), "input": INPUT},
            "curve 'output' moved: at most 0.002 (0.1 % of the axis) at time = ",
        ),
        (
            {"output": OUTPUT, "input": (T, np.where(T < 3.05, 0.0, 1.0))},
            "curve 'input' moved: at most 1 (50 % of the axis) at time = 3",
        ),
        (
            {"output": OUTPUT, "input": (T[:-1], INPUT[1][:-1])},
            "curve 'input' now ends at time = 9.95 (was 10); 1 curve unchanged",
        ),
        ({"output": INPUT, "input": OUTPUT}, "the labels of curves 'output' and 'input' are swapped"),
        ({"output": OUTPUT}, "curve 'input' is missing; 1 curve unchanged"),
        ({"output": OUTPUT, "input": INPUT, "noise": (T, T)}, "curve 'noise' is new; 2 curves unchanged"),
    ],
)
def test_changed_curves(accepted: Path, data: Path, curves: dict[str, tuple[Any, Any]], said: str) -> None:
    (first, *_) = compare(outcome(data, figure(curves)), accepted)
    assert first.startswith(f"toy/fig-1: {said}")


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"xlim": [0.0, 9.0]}, "x axis now ends at 9 (was 10)"),
        ({"legend": ["input", "output"]}, "legend entries 'output' and 'input' are swapped"),
        ({"xlabel": "t"}, "label of the x axis is now 't' (was 'time')"),
        ({"texts": [{"text": "peak", "x": 1.0, "y": 2.0}]}, "text 'peak' at (1, 2) is new"),
    ],
)
def test_changed_axes(accepted: Path, data: Path, changed: dict[str, Any], said: str) -> None:
    axes = [{**AXES[0], **changed}]
    assert compare(outcome(data, figure(axes=axes)), accepted) == [f"toy/fig-1: {said}; 2 curves unchanged"]


def test_missing_and_superfluous_files(accepted: Path, data: Path) -> None:
    (accepted / "toy/fig-1.json").unlink()
    (accepted / "toy/table-1.csv").unlink()
    (accepted / "toy/table-9.csv").write_text("row\n")
    present = outcome(data)
    assert compare(present, accepted) == [
        "toy/table-1: has no accepted state: toy/table-1.csv is missing",
        "toy/fig-1: has no accepted state: toy/fig-1.json is missing",
        "toy/table-9: was accepted, but is no longer computed",
    ]
    assert len(compare(replace(present, complete=False), accepted)) == 2
    assert accept(present, accepted, "clean up").changes
    assert compare(present, accepted) == []
    assert not (accepted / "toy/table-9.csv").exists()


def test_a_damaged_file_is_named(accepted: Path, data: Path) -> None:
    (accepted / "toy/fig-1.json").write_text("[{\n")
    present = outcome(data, as_written=synthetic.frame(ax=1.001))
    found = compare_all(present, accepted)
    assert found.broken
    changed, damaged = found.lines  # the damage hides no other change
    assert changed.startswith("toy/table-1: A x 1 -> 1.001")
    assert damaged.startswith("toy/fig-1: its accepted state is damaged: toy/fig-1.json:2: is not valid JSON")
    accept(present, accepted, "made whole")
    assert compare(present, accepted) == []


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"xlim": [0.0,', '"xlim": [NaN,', "toy/fig-1.json: is not valid JSON: NaN is not a number"),
        ('"xlim": [0.0, ', '"xlim": [', "xlim of panel 'panel 1' is [10.0]; expected: two different numbers"),
        ('"xlim": [0.0,', '"xlim": ["0",', "xlim of panel 'panel 1' is [\"0\", 10.0]; expected: two different"),
        ('"xlim": [0.0,', '"xlim": [10.0,', "xlim of panel 'panel 1' is [10.0, 10.0]; expected: two different"),
        ('"xscale": "linear"', '"xscale": "log"', "xlim of panel 'panel 1' is not positive on a logarithmic axis"),
        ('"title": ""', '"title": 5', "title of panel 'panel 1' is 5; expected: a text"),
        ('"title": ""', '"legend": [null]', "toy/fig-1.json"),
        ('"title": ""', '"points": "output"', "points of panel 'panel 1' is \"output\"; expected: a list of texts"),
        ('"title": ""', '"texts": [{"text": "peak"}]', "expected: a list of objects, each with text, x and y"),
        ('"title": ""', '"thinned": {"output": "x"}', "expected: numbers by name"),
        ('"title": ""', '"hidden": 1', "hidden of panel 'panel 1' is 1; expected: true or false"),
        ('"panel": "panel 1"', '"panel": "panel 2"', "does not describe panel 'panel 1', where curve 'output' is"),
        ('"panels": [', '"panels": [' + "[" * 5000, "toy/fig-1.json"),
        ('"version": 2', '"version": 3', "was written by a newer version: its format is 3, this one reads up to 2"),
        ('"version": 2', '"version": "2"', "is not a record of a figure"),
    ],
)
def test_a_description_that_no_figure_has_is_damage(accepted: Path, data: Path, old: str, new: str, said: str) -> None:
    path = accepted / "toy/fig-1.json"
    text = path.read_text()
    assert old in text
    path.write_text(text.replace('"legend"', '"was"') if "legend" in new else text)
    path.write_text(path.read_text().replace(old, new))
    (line,) = compare(outcome(data), accepted)
    assert line.startswith("toy/fig-1: its accepted state is damaged: toy/fig-1.json")
    assert said in line


def test_a_panel_described_twice_is_damage(accepted: Path, data: Path) -> None:
    path = accepted / "toy/fig-1.json"
    content = json.loads(path.read_text())
    path.write_text(json.dumps(content | {"panels": content["panels"] * 2}))
    (line,) = compare(outcome(data), accepted)
    assert "describes panel 'panel 1' twice" in line


@pytest.mark.parametrize(
    ("name", "cut", "said"),
    [
        ("fig-1.csv", lambda text: text[:-1], f":{2 * len(T) + 1}: ends in the middle of a line"),
        ("fig-1.csv", lambda text: text + "panel 1,input,10,1.2", "ends in the middle of a line"),
        ("fig-1.csv", lambda text: text[:-4], "has 3 cells; expected: 4"),
        ("fig-1.csv", lambda text: text.replace("panel 1,output,", "panel 1,output,nan", 1), "expected: two numbers"),
        ("fig-1.csv", lambda text: text + "panel 1,output,1,\n", "x and y are 1,; expected: two numbers, or nothing"),
        ("fig-1.csv", lambda text: text + "panel 1,output,1,inf\n", "x and y are 1,inf; expected: two numbers"),
        ("fig-1.csv", lambda text: text + '"panel 1,output,1,2\n', "is not valid CSV: unexpected end of data"),
        ("table-1.csv", lambda text: text + text.splitlines()[1] + "\n", "'A x as-written' already appears in line 2"),
        ("claims.csv", lambda _: "", ":1: the columns are missing; expected: row,verdict,computed"),
        ("claims.csv", lambda _: "row,verdict\n", ":1: the columns are row,verdict; expected: row,verdict,computed"),
    ],
)
def test_half_a_file_is_damage(accepted: Path, data: Path, name: str, cut: Callable[[str], str], said: str) -> None:
    path = accepted / "toy" / name
    path.write_text(cut(path.read_text()))
    (line,) = compare(outcome(data), accepted)
    assert f"its accepted state is damaged: toy/{name}" in line
    assert said in line


def test_bytes_that_are_no_text_are_damage(accepted: Path, data: Path) -> None:
    (accepted / "toy/claims.csv").write_bytes(b"row,verdict,computed\n\xff\xfe\x00\n")
    (line,) = compare(outcome(data), accepted)
    assert line.endswith("toy/claims.csv:2: is not UTF-8 text")


def test_a_missing_picture_is_told_and_put_back(accepted: Path, data: Path) -> None:
    (accepted / "toy/fig-1.png").unlink()
    (line,) = compare(outcome(data), accepted)
    assert line == "toy/fig-1: its picture, toy/fig-1.png, is missing; 2 curves unchanged"
    accept(outcome(data), accepted, "picture")
    assert (accepted / "toy/fig-1.png").is_file()


def test_accepting_touches_only_what_changed(accepted: Path, data: Path) -> None:
    present = outcome(data, figure(png=OTHER_FONTS), as_written=synthetic.frame(ax=1.001))
    (change,) = accept(present, accepted, "a better\n solver").changes
    assert change.exhibit == "table-1"
    with Image.open(accepted / "toy/fig-1.png") as kept:
        assert kept.size == (20, 10)
        assert kept.convert("RGB").getpixel((5, 5)) == (255, 0, 0)
    assert (
        (accepted / LOG)
        .read_text()
        .endswith("\n## a better solver\n\n- toy/table-1: A x 1 -> 1.001 (+0.1 %); 7 values unchanged\n")
    )
    assert "## first" in (accepted / LOG).read_text()
    assert compare(present, accepted) == []


def test_accepting_needs_a_reason_and_whole_results(accepted: Path, data: Path) -> None:
    with pytest.raises(ReplicateError, match="needs a reason"):
        accept(outcome(data), accepted, "  ")
    with pytest.raises(ReplicateError, match=r"nothing was accepted.*toy/table-1 \(authors\)"):
        accept(outcome(data, errors={"authors": "ValueError: no"}), accepted, "why not")


def test_accepting_is_all_or_nothing(accepted: Path, data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = {path: path.read_bytes() for path in accepted.rglob("*") if path.is_file()}
    write_bytes = Path.write_bytes

    def full_disk(self: Path, content: bytes) -> int:
        if self.suffix == ".png":
            raise OSError(28, "No space left on device", str(self))
        return write_bytes(self, content)

    monkeypatch.setattr(Path, "write_bytes", full_disk)
    changed = outcome(data, figure({"output": INPUT}), as_written=synthetic.frame(ax=1.5))
    with pytest.raises(OutputError, match="No space left"):
        accept(changed, accepted, "half")
    assert {path: path.read_bytes() for path in accepted.rglob("*") if path.is_file()} == before


def test_check_wants_explanations_and_comparisons(accepted: Path, data: Path) -> None:
    both = {"as_written": synthetic.frame(ax=7.0), "authors": synthetic.frame(ax=7.0)}
    problems = check(outcome(data, None, **both), accepted)
    assert any("has no ledger entry" in problem for problem in problems)
    assert any("verdict reproduced -> unexplained" in problem for problem in problems)
    assert check(Outcome([], {}, {}), data / "nothing") == ["no printed value was compared with a computed one"]


@pytest.mark.parametrize("content", [b"", b"\x89PNG\r\n\x1a\n", PICTURE[:40], b"<svg/>"])
def test_a_picture_that_cannot_be_shown_is_told_and_renewed(accepted: Path, data: Path, content: bytes) -> None:
    path = accepted / "toy/fig-1.png"
    good = path.read_bytes()
    path.write_bytes(content)
    assert compare(outcome(data), accepted) == ["toy/fig-1: its picture, toy/fig-1.png, is damaged; 2 curves unchanged"]
    accept(outcome(data), accepted, "drawn again")
    assert path.read_bytes() == good


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("thinned", {"output": 9}, "curve 'output' has less fine detail now"),
        ("loose", ["output"], "curve 'output' is accepted as one that labels interrupt, which it is not"),
    ],
)
def test_an_accepted_file_cannot_widen_what_it_tolerates(
    accepted: Path, data: Path, field: str, value: object, said: str
) -> None:
    path = accepted / "toy/fig-1.json"
    content = json.loads(path.read_text())
    content["panels"][0][field] = value
    path.write_text(json.dumps(content))
    (line,) = compare(outcome(data), accepted)
    assert said in line
    moved = {"output": (T, 1.01 - np.exp(-T)), "input": INPUT}
    assert any("curve 'output' moved" in line for line in compare(outcome(data, figure(moved)), accepted))


def test_the_order_of_panels_is_state(tmp_path: Path, data: Path) -> None:
    two = [{**AXES[0], "panel": name} for name in ("left", "right")]
    frames = [pd.DataFrame({"panel": name, "curve": "c", "x": T, "y": T / 10.0}) for name in ("left", "right")]
    drawn = FigureResult("toy", "fig-1", "<svg/>", PICTURE, pd.concat(frames), two)
    accept(outcome(data, drawn), tmp_path / "accepted", "first")
    turned = replace(drawn, axes=two[::-1])
    (line,) = compare(outcome(data, turned), tmp_path / "accepted")
    assert "the panels now stand in the order 'right', 'left' (was 'left', 'right')" in line
    edit_json(tmp_path / "accepted/toy/fig-1.json", lambda content: content["panels"].reverse())
    (line,) = compare(outcome(data, drawn), tmp_path / "accepted")
    assert "the panels now stand in the order 'left', 'right' (was 'right', 'left')" in line


def less_thinned(content: dict[str, Any]) -> None:
    content["panels"][0]["thinned"] = {"output": 9e-5}


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("fig-1.png", lambda path: path.write_bytes(OTHER_FONTS)),
        ("fig-1.json", lambda path: edit_json(path, less_thinned)),
        ("fig-1.csv", lambda path: path.write_text(path.read_text().replace("0.0487705754993", "0.0487705755"))),
        ("claims.csv", lambda path: path.write_text(path.read_text().replace("3.1", "3.10000001"))),
        ("claims.json", lambda path: edit_json(path, lambda content: content["evidence"].update(more="x"))),
    ],
)
def test_an_alteration_that_nothing_else_tells_is_told(
    accepted: Path, data: Path, name: str, change: Callable[[Path], object]
) -> None:
    path = accepted / "toy" / name
    good = path.read_bytes()
    change(path)
    assert path.read_bytes() != good
    (line,) = compare(outcome(data), accepted)
    assert f"toy/{name} is not as it was accepted: an edit or a merge altered it" in line
    accept(outcome(data), accepted, "as computed")
    assert path.read_bytes() == good
    assert compare(outcome(data), accepted) == []


def test_a_state_that_an_older_version_accepted_is_read_as_before(accepted: Path, data: Path) -> None:
    sums = accepted / "toy" / SUMS
    first = sums.read_bytes()
    sums.unlink()
    edit_json(accepted / "toy/claims.json", lambda content: content.pop("evidence"))
    (accepted / "toy/fig-1.png").write_bytes(OTHER_FONTS)
    assert compare(outcome(data), accepted) == []
    accept(outcome(data), accepted, "with checksums")
    assert (accepted / "toy/fig-1.png").read_bytes() == OTHER_FONTS
    assert sums.read_bytes().splitlines()[:2] == first.splitlines()[:2]  # of the claims, which say more now
    assert (accepted / LOG).read_text().splitlines()[-2:] == [
        "- written in the present format, which says more: toy/claims",
        "- checksums of what was accepted before: toy",
    ]


@pytest.mark.parametrize(
    ("field", "about"),
    [("title", "title"), ("caption", "caption"), ("alt", "alternative text"), ("stands_for", "stands for")],
)
def test_the_words_of_a_figure_are_state(accepted: Path, data: Path, field: str, about: str) -> None:
    present = outcome(data, figure(png=OTHER_FONTS))
    setattr(present.papers[0].exhibits["fig-1"], field, "Other\n  words")
    (change,) = compare_all(present, accepted).changes
    assert (change.kind, change.where, change.after) == ("words", about, "Other words")
    assert str(change).startswith(f"toy/fig-1: {about} ")
    files = {path: path.read_bytes() for path in sorted((accepted / "toy").iterdir())}
    accept(present, accepted, "in other words")
    altered = {path.name for path, content in files.items() if path.read_bytes() != content}
    assert altered == {"fig-1.json", SUMS}
    assert compare(present, accepted) == []
    assert len(compare(outcome(data), accepted)) == 1


def test_a_figure_that_was_accepted_without_words_is_read_as_before(accepted: Path, data: Path) -> None:
    path = accepted / "toy/fig-1.json"
    good = path.read_bytes()
    edit_json(path, lambda content: content["figure"].pop("words"))
    (accepted / "toy" / SUMS).unlink()
    found = compare_all(outcome(data), accepted)
    assert (found.lines, [diff.exhibit for diff in found.outdated]) == ([], ["fig-1"])
    accept(outcome(data), accepted, "with words")
    assert path.read_bytes() == good
    assert not compare_all(outcome(data), accepted).outdated


def test_a_figure_of_an_earlier_revision_is_outdated_until_it_is_accepted(accepted: Path, data: Path) -> None:
    present = outcome(data, replace(figure(png=OTHER_FONTS), figure={"revision": REVISION}))
    path = accepted / "toy/fig-1.json"
    setattr(present.papers[0].exhibits["fig-1"], "title", "Other words")  # noqa: B010  -- of any kind, to mypy
    accept(present, accepted, "in other words")  # and nothing else
    assert "revision" not in json.loads(path.read_text())["figure"]
    found = compare_all(present, accepted)
    assert (found.lines, [diff.exhibit for diff in found.outdated]) == ([], ["fig-1"])
    accept(present, accepted, "of this release")
    assert json.loads(path.read_text())["figure"]["revision"] == REVISION
    assert not compare_all(present, accepted).outdated


def test_accepting_words_accepts_no_alteration_beside_them(accepted: Path, data: Path) -> None:
    present = outcome(data)
    setattr(present.papers[0].exhibits["fig-1"], "title", "Other words")  # noqa: B010  -- of any kind, to mypy
    edit_json(accepted / "toy/fig-1.json", less_thinned)
    (accepted / "toy/fig-1.png").write_bytes(OTHER_FONTS)
    accept(present, accepted, "in other words")
    assert "thinned" not in (accepted / "toy/fig-1.json").read_text()
    assert (accepted / "toy/fig-1.png").read_bytes() != OTHER_FONTS
    assert compare(present, accepted) == []


@pytest.mark.parametrize("words", [None, [], "text", {"title": None}, {"title": ["text"]}])
def test_damaged_words_of_a_figure_are_named(accepted: Path, data: Path, words: object) -> None:
    edit_json(accepted / "toy/fig-1.json", lambda content: content["figure"].update(words=words))
    (line,) = compare(outcome(data), accepted)
    assert "its accepted state is damaged: toy/fig-1.json: 'words' of the figure are" in line
    assert line.endswith("; expected: texts by name")


def test_accepting_one_exhibit_accepts_no_alteration_of_another(accepted: Path, data: Path) -> None:
    (accepted / "toy/fig-1.png").write_bytes(OTHER_FONTS)
    present = outcome(data, as_written=synthetic.frame(ax=1.5))
    one = replace(present, results={("toy", "table-1"): present.results["toy", "table-1"]}, complete=False)
    accept(one, accepted, "only the table")
    (line,) = compare(present, accepted)
    assert "toy/fig-1.png is not as it was accepted" in line


@pytest.mark.parametrize("content", ["<<<<<<< ours\n", "0" * 64 + "  a\n" + "1" * 64 + "  a\n", "\xe9"])
def test_damaged_checksums_name_their_line(accepted: Path, data: Path, content: str) -> None:
    sums = accepted / "toy" / SUMS
    good = sums.read_bytes()
    sums.write_bytes(good + content.encode("latin-1"))
    for line in compare(outcome(data), accepted):
        assert f"its accepted state is damaged: toy/{SUMS}:" in line
    accept(outcome(data), accepted, "anew")
    assert sums.read_bytes() == good


def test_checksums_of_the_bundled_papers_are_those_of_their_files() -> None:
    folders = [sums.parent for sums in sorted(FIGURES.glob(f"*/{SUMS}"))]
    assert {folder.name for folder in folders} == {paper.id for paper in Library(bundled=True).papers()}
    for folder in folders:
        there = {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.name != SUMS}
        lines = [f"{hashlib.sha256(content).hexdigest()}  {name}\n" for name, content in there.items()]
        assert (folder / SUMS).read_text() == "".join(lines)


@pytest.mark.parametrize(
    ("evidence", "changes"),
    [("The smallest is 3.1.", 0), ("The largest is 3.1.", 1), ("The smallest is 3.2.", 1)],
)
def test_the_evidence_of_a_claim_is_state(accepted: Path, data: Path, evidence: str, changes: int) -> None:
    findings = synthetic.FINDINGS | {"big": Finding("holds", 3.1, evidence)}
    lines = compare(outcome(data, findings=findings), accepted)
    assert len(lines) == changes
    assert all(line.startswith("toy/claims: claim 'big': evidence 'The smallest is 3.1.' -> ") for line in lines)


@pytest.mark.parametrize(
    ("reason", "heading"),
    [
        ("less\n\n# offset", "## less # offset"),
        ("# loud", "## \\# loud"),
        ("a <b>tag</b> and [a link](x)", "## a \\<b>tag\\</b> and \\[a link](x)"),
    ],
)
def test_a_reason_is_one_line_of_plain_text(accepted: Path, data: Path, reason: str, heading: str) -> None:
    accept(outcome(data, as_written=synthetic.frame(ax=1.5)), accepted, reason)
    headings = [line for line in (accepted / LOG).read_text().splitlines() if line.startswith("#")]
    assert headings == ["# What was accepted, and why", "## first", heading]


@pytest.mark.parametrize("reason", ["a\x1b[2J", "1\u202e2", "\x00"])
def test_a_reason_cannot_steer_a_terminal(accepted: Path, data: Path, reason: str) -> None:
    with pytest.raises(ReplicateError, match="--reason holds the character U"):
        accept(outcome(data, as_written=synthetic.frame(ax=1.5)), accepted, reason)
