"""What is wrong in a paper of one's own is said by every command, with file and line, and never with status 0.

Each case breaks one thing in a project that was as accepted.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from replicate.diff.accept import accept
from replicate.new_paper import new_paper
from replicate.new_project import new_project
from replicate.run.library import Library
from replicate.run.outcome import recompute
from replicate.run.project import find_project

Run = Callable[..., tuple[int, str, str]]

FRAME = "return table_1.frame(rows)"
CALL = "return _rows(statistics.stdev)"
INPUTS = '"sample standard deviation, divided by $n - 1$"'
SUBPLOTS = "axes = fig.subplots()"
ENTRY = '\n[[entry]]\nexhibit = "{}"\nrows = ["{}"]\ncolumns = ["mean"]\ncause = "{}"\nexplanation = "x"\n'


@pytest.fixture(scope="module")
def accepted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a project with one paper in which nothing is left to do and nothing differs."""
    root = tmp_path_factory.mktemp("wrong") / "mine"
    new_project(root)
    new_paper("gauss", root / "papers")
    for file in (root / "papers" / "gauss").iterdir():
        if file.is_file():
            file.write_text(file.read_text(encoding="utf-8").replace("TODO: ", ""), encoding="utf-8")
    outcome = recompute(Library(find_project(root)).papers(), jobs=1, cache_dir=root / "build" / "cache")
    accept(outcome, root / "accepted", "first", ["gauss"])
    return root


@pytest.fixture
def project(accepted: Path, replicate: Run, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the paper's folder in a copy of the project, which is the current folder."""
    assert callable(replicate)
    shutil.copytree(accepted, "mine", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.chdir("mine")
    return Path("papers/gauss")


def replaced(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        (
            "table_1.py", FRAME, f"{FRAME}.rename(index={{'A': 'Z'}})",
            "failed: gauss/table-1 (as-written): gauss/table_1.py:20: the reading returns the row 'Z'; allowed: 'A', '",
        ),
        (
            "table_1.py", FRAME, f"{FRAME}.drop(columns='sd')",
            "gauss/table_1.py:20: the reading does not return the column 'sd'; it returns: 'mean'",
        ),
        (
            "table_1.py", FRAME, f"{FRAME}.astype(str)",
            "gauss/table_1.py:20: the reading returns a wrong cell: row 'A', column 'mean' holds text ('3.8000",
        ),
        ("table_1.py", INPUTS, f'{INPUTS}, inputs=("mean",)', "takes 0 positional arguments but 2 were given (gauss/"),
        (
            "table_1.py", f"{INPUTS})\ndef as_written()", f'{INPUTS}, inputs=("mean",))\ndef as_written(*_)',
            "reading 'as-written' returns DataFrame for 'A'; expected: numbers by quantity (gauss/table_1.py:20)",
        ),
        ("table_1.py", FRAME, "return rows", "gauss/table_1.py:20: the reading returns dict; expected: a pandas DataF"),
        ("table_1.py", FRAME, "return pd.concat(2 * [table_1.frame(rows)])", "the reading returns the row 'A' twice"),
        (
            "table_1.py", "rows = {name: (", "rows = {name.lower(): (",
            "table-1: row 'a' is not one of the table's; allowed: A, B, C (gauss/table_1.py:34)",
        ),
        ("table_1.py", CALL, "raise ValueError('no data')", "(as-written): ValueError: no data (gauss/table_1.py:23)"),
        (
            "fig_1.py", SUBPLOTS, "import matplotlib.pyplot as plt\n    axes = plt.figure().subplots()",
            "failed: gauss/fig-1: gauss/fig_1.py:9: the figure is empty, and pyplot has one of its own: draw on the",
        ),
        ("fig_1.py", SUBPLOTS, "return", "gauss/fig_1.py:9: the figure is empty; expected: something drawn"),
        ("fig_1.py", SUBPLOTS, f"{SUBPLOTS}\n    return", "gauss/fig_1.py:9: the figure is empty; expected: something"),
        (
            "claims.py", "return Finding(", "return True or (",
            "failed: gauss/claims (largest): claim 'largest' (gauss/claims.py:13): the check returns bool; expected: a",
        ),
        (
            "claims.py", '"holds" if', '"yes" if',
            "(gauss/claims.py:13): the verdict is 'yes'; allowed: holds, fails, holds-partly, undecided",
        ),
        ("table_1.py", "as_written()", "as_written(x)", "positional argument: 'x' (gauss/table_1.py:20)"),
        ("table_1.py", "def as_written", "async def as_written", "the reading returns coroutine; expected: a pandas D"),
        ("table_1.py", FRAME, "yield rows", "gauss/table_1.py:20: the reading returns generator; expected: a pandas "),
        ("table_1.py", FRAME, f'{FRAME}["mean"]', "gauss/table_1.py:20: the reading returns Series; expected: a panda"),
        ("table_1.py", FRAME, f"{FRAME}.T", "gauss/table_1.py:20: the reading returns the row 'mean'; allowed: 'A', '"),
        ("table_1.py", FRAME, f"{FRAME}.reset_index(drop=True)", "the reading returns the row '0'; allowed: 'A', 'B',"),
        (
            "table_1.py", FRAME, f"f = {FRAME[7:]}\n    return pd.concat([f, f], axis=1)",
            "gauss/table_1.py:20: the reading returns the column 'mean' twice",
        ),
        ("table_1.py", FRAME, f'return pd.concat({{"x": {FRAME[7:]}}})', "the reading returns the row '('x', 'A')'; a"),
        ("table_1.py", FRAME, f"{FRAME} > 0", "row 'A', column 'mean' holds bool (True); expected: a number"),
        ("table_1.py", FRAME, f"{FRAME}.map(lambda x: (None, x))", "row 'A', column 'mean' holds tuple ((None, 3.80"),
        ("table_1.py", FRAME, f"{FRAME} / [0, 1]", "a wrong cell: row 'A', column 'mean' holds the number inf; exp"),
        ("fig_1.py", "fig: Figure", "", "TypeError: fig_1() takes 0 positional arguments but 1 was given (gauss/fig_1"),
        ("fig_1.py", "def fig_1", "async def fig_1", "gauss/fig_1.py:9: the function is asynchronous, so nothing was "),
        ("fig_1.py", SUBPLOTS, f"{SUBPLOTS}\n    yield", "gauss/fig_1.py:9: the function is a generator, so nothing "),
        (
            "fig_1.py", 'axes.set_xlabel("value")', 'axes.set_xlabel("value")\n    return Figure()',
            "gauss/fig_1.py:9: the function returns a figure of its own; expected: something drawn on the figure given",
        ),
        ("claims.py", "def largest", "async def largest", "the check returns coroutine; expected: a Finding"),
        ("claims.py", "verdict, means[found]", "verdict, float('nan')", "the value is nan; expected: the number that "),
        ("claims.py", "verdict, means[found]", 'verdict, "3"', "(gauss/claims.py:13): the value is text ('3'); expect"),
        (
            "notes.md", "{{ printed(", "{{ prnted(",
            "gauss/notes.md:2: 'prnted' is undefined; known: claim, count, exhibit, lower, number, printed, upper, val",
        ),
        ("notes.md", "digits=6", "reading='n'", "gauss/notes.md:2: value('table-1', 'A', 'sd', 'n'): no such reading;"),
        ("notes.md", "{{ exhibit(", r"$\frac{a}{b$ {{ exhibit(", r"gauss/notes.md:4: pandoc cannot convert $\frac{a}{"),
        ("table_1.py", r"\bar x", r"\bar{x", r"gauss/table_1.py:16: pandoc cannot convert $\bar{x$: unexpected"),
        (
            "ledger.toml", "value('table-1'", "valeu('table-1'",
            "gauss/ledger.toml:3: 'valeu' is undefined; known: claim, column, count, lower, number, printed, row, uppe",
        ),
    ],
)  # fmt: skip
def test_a_wrong_answer_is_a_broken_run(
    file: str, old: str, new: str, message: str, project: Path, replicate: Run
) -> None:
    replaced(project / file, old, new)
    status, out, err = replicate("check", "-j1")
    assert status == 2
    assert message in err
    assert "Traceback" not in err + out


@pytest.mark.parametrize("command", ["show gauss table-1", "report", "diff", "accept --reason x", "handout"])
def test_every_command_says_so(command: str, project: Path, replicate: Run) -> None:
    accepted = {path: path.read_bytes() for path in Path("accepted").rglob("*") if path.is_file()}
    replaced(project / "table_1.py", FRAME, f"{FRAME}.rename(index={{'A': 'Z'}})")
    status, out, err = replicate(*command.split(), "-j1")
    assert status == 2
    assert "gauss/table_1.py:20: the reading returns the row 'Z'" in (err + out).replace("\n", " ")
    assert {path: path.read_bytes() for path in Path("accepted").rglob("*") if path.is_file()} == accepted


def test_where_the_first_reading_failed_there_is_no_verdict(project: Path, replicate: Run) -> None:
    replaced(project / "table_1.py", CALL, "raise ValueError('no data')")
    (project / "notes.md").unlink()  # which quotes the table
    status, _, err = replicate("report", "-j1")
    assert status == 2
    assert "failed: gauss/table-1 (as-written): ValueError: no data" in err
    assert "table-1" not in Path("build/verdicts.csv").read_text(encoding="utf-8")
    assert "gauss,table-1,table,Mean and standard" in Path("build/exhibits.csv").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("file", "added", "message"),
    [
        ("ledger.toml", ENTRY.format("table-1", "A", "rounding"), "gauss/ledger.toml:10: table-1 row 'A', column 'mea"),
        ("printed/table-9.csv", "row,a\nA,1\n", "gauss/printed/table-9.csv: belongs to no exhibit with printed values"),
    ],
)  # fmt: skip
def test_what_says_nothing_is_named_by_every_command(
    file: str, added: str, message: str, project: Path, replicate: Run
) -> None:
    with (project / file).open("a", encoding="utf-8") as opened:
        opened.write(added)
    status, out, _ = replicate("check", "-j1")
    assert status == 1
    assert message in out
    for command in ("report", "diff"):
        _, _, err = replicate(command, "-j1")
        assert f"unused: {message}" in err, command


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        ("ledger.toml", 'rows = ["C"]', 'rows = ["Q"]', "gauss/ledger.toml:3: rows: 'Q' is not in the exhibit; allowe"),
        ("ledger.toml", '"rounding"', '"typo"', "gauss/ledger.toml:3: cause 'typo' is unknown; allowed: misprint, pri"),
        ("ledger.toml", '["C"]', '["C"', "gauss/ledger.toml:6: is not readable TOML: "),
        ("table_1.py", '"sd": "standard', '"s": "standard', "gauss/table_1.py:11: table-1: there is no row or column "),
        ("table_1.py", '"as-written"', '"written"', "gauss/table_1.py:20: table-1: the first reading must be 'as-writ"),
        ("table_1.py", '"population"', '"as-written"', "gauss/table_1.py:26: reading of table-1 'as-written' is defin"),
        ("fig_1.py", '"fig-1"', '"table-1"', "gauss/fig_1.py:9: exhibit 'table-1' is defined twice"),
        ("__init__.py", '"claims")', '"claims", "more")', "gauss/__init__.py:12: ModuleNotFoundError: No module named"),
        ("__init__.py", "year=", "jear=", "gauss/__init__.py:5: TypeError: "),
        ("notes.md", "'sd')", "'sd'", "gauss/notes.md:2: "),
        ("printed/table-1.csv", ",", ";", "gauss/printed/table-1.csv:1: cells are separated by semicolons; allowed: c"),
        ("printed/table-1.csv", "3.8", '"3,8"', """'3,8' is not a number; allowed: digits with an optional sign, de"""),
        ("printed/table-1.csv", "3.8", '"3,8"', """notation=Notation(decimal=",") would accept it"""),
        ("printed/table-1.csv", "1.93", "<1.93", "notation=Notation(bounds=True) would accept it"),
        ("printed/table-1.csv", ",", "\t", "gauss/printed/table-1.csv:1: cells are separated by tabs; allowed: commas"),
        ("printed/table-1.csv", "row,", "# by me\nrow,", "gauss/printed/table-1.csv:1: '# by me' is not a row; a CSV "),
        ("printed/table-1.csv", "row,", "sep=,\nrow,", "gauss/printed/table-1.csv:1: 'sep=' is not a row; a CSV has n"),
        ("printed/table-1.csv", "\n", ",\n", "gauss/printed/table-1.csv:1: column 4 has no name; remove the comma too"),
        ("printed/table-1.csv", "1.93\n", "1.93,\n", "gauss/printed/table-1.csv:2: row 'A' has 4 cells, the header ha"),
        ("printed/table-1.csv", "A,", "A,3.8,1.93\nA,", "gauss/printed/table-1.csv:3: row 'A' appears twice (first in"),
        ("printed/table-1.csv", "2.5", "2.O", "gauss/printed/table-1.csv:3: column 'mean': '2.O' is not a number; all"),
        ("printed/table-1.csv", "2.5", "nan", "gauss/printed/table-1.csv:3: column 'mean': 'nan' is not a number; all"),
        ("printed/table-1.csv", "row,", "PK\x03\x04", "table-1.csv: is a spreadsheet or an archive; expected: text"),
    ],
)  # fmt: skip
def test_a_wrong_definition_has_file_and_line(
    file: str, old: str, new: str, message: str, project: Path, replicate: Run
) -> None:
    replaced(project / file, old, new)
    status, _, err = replicate("report", "-j1")
    assert status == 2
    assert message in err


@pytest.mark.parametrize("change", ["bom", "crlf", "cr", "quoted", "spaces"])
def test_a_csv_as_a_spreadsheet_writes_it_is_read(change: str, project: Path, replicate: Run) -> None:
    file = project / "printed" / "table-1.csv"
    lines = [line.split(",") for line in file.read_text(encoding="utf-8").splitlines()]
    end = {"crlf": "\r\n", "cr": "\r"}.get(change, "\n")
    quote, comma = ('"' if change == "quoted" else ""), (" , " if change == "spaces" else ",")
    text = end.join(comma.join(f"{quote}{cell}{quote}" for cell in line) for line in lines) + end
    file.write_bytes(("\ufeff" if change == "bom" else "").encode() + text.encode())
    status, out, err = replicate("check", "-j1")
    assert (status, "problems: 0; comparisons: 12" in out) == (0, True), err


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'out = "build"',
            'out = "papers"',
            "out is 'papers', inside papers/; allowed: a folder of its own",
        ),
        (
            'out = "build"',
            'out = "."',
            "replicate.toml:10: out is '.', which holds the project itself; allowed: a folder ",
        ),
        ('out = "build"', 'out = "accepted/x"', "out is 'accepted/x', inside accepted/; allowed: a folder of its own"),
        (
            "papers =",
            "paper =",
            "replicate.toml:8: 'paper' is unknown; allowed: title, intro, methods, papers, bundled",
        ),
    ],
)
def test_a_wrong_project_file_has_file_and_line(
    old: str, new: str, message: str, project: Path, replicate: Run
) -> None:
    assert project.is_dir()
    replaced(Path("replicate.toml"), old, new)
    status, _, err = replicate("check", "-j1")
    assert status == 2
    assert message in err


@pytest.mark.parametrize(
    ("said", "message"),
    [
        (r"intro = 'Well: $\frac{1$'", r"replicate.toml:4: pandoc cannot convert $\frac{1$: unexpected"),
        ('methods = "how.md"', r"how.md:3: pandoc cannot convert $\sqrt{x$: unexpected"),
    ],
)
def test_a_formula_of_the_project_has_file_and_line(said: str, message: str, project: Path, replicate: Run) -> None:
    assert project.is_dir()
    Path("how.md").write_text("# How\n\nBy $\\sqrt{x$.\n", encoding="utf-8")
    file = Path("replicate.toml")
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if "=" in line and "intro" not in line]
    file.write_text("\n".join([*lines[:1], "", "", said, *lines[1:]]), encoding="utf-8")
    status, _, err = replicate("report", "-j1")
    assert status == 2
    assert message in err


def test_two_project_files_in_one_folder_are_too_many(project: Path, replicate: Run) -> None:
    assert project.is_dir()
    Path("pyproject.toml").write_text('[tool.replicate]\ntitle = "Other"\n', encoding="utf-8")
    status, _, err = replicate("check", "-j1")
    assert status == 2
    assert "pyproject.toml:1: [tool.replicate] beside replicate.toml: there are two project files; allowed: one" in err


def test_a_project_in_a_folder_of_any_name(project: Path, replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    assert project.is_dir()
    other = Path.cwd().parent / "mein Prøjekt (2)"
    shutil.copytree(Path.cwd(), other)
    (other.parent / "link").symlink_to(other)
    monkeypatch.chdir(other.parent / "link")
    assert replicate("check", "-j1")[:2] == (0, "problems: 0; comparisons: 12; exhibits: 3\n")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("'A', 'sd'", "'A', 'se'", "gauss/handout.md:15: "),
        ("# ", "", "gauss/handout.md:1: a handout must begin with its title"),
    ],
)
def test_check_reads_the_handout(old: str, new: str, message: str, project: Path, replicate: Run) -> None:
    replaced(project / "handout.md", old, new)
    status, _, err = replicate("check", "-j1")
    assert status == 2
    assert f"broken: {message}" in err


def test_one_text_that_cannot_be_shown_breaks_no_other_paper(project: Path, replicate: Run) -> None:
    shutil.copytree(project, project.parent / "euler")
    for file in (project.parent / "euler").glob("*.py"):
        file.write_text(file.read_text(encoding="utf-8").replace("gauss", "euler"), encoding="utf-8")
    replaced(project / "notes.md", "{{ printed(", "{{ prnted(")
    status, _, err = replicate("report", "-j1")
    assert status == 2
    assert "broken: gauss/notes.md:2: 'prnted' is undefined" in err
    assert Path("build/report/euler.html").is_file()
    assert not Path("build/report/gauss.html").exists()
    assert "gauss" not in Path("build/report/index.html").read_text(encoding="utf-8")


def test_a_changed_project_file_makes_a_kept_result_stale(project: Path, replicate: Run) -> None:
    assert project.is_dir()
    assert "4 of 4 results kept" in replicate("report", "-j1")[2]
    replaced(Path("replicate.toml"), 'title = "Mine"', 'title = "Ours"  # of both')
    assert "kept from an earlier run" not in replicate("report", "-j1")[2]
    replaced(Path("replicate.toml"), "# of both", "# another comment")
    assert "4 of 4 results kept" in replicate("report", "-j1")[2]


def test_options_of_pandas_do_not_reach_the_next_unit(project: Path, replicate: Run) -> None:
    replaced(project / "table_1.py", CALL, f'pd.set_option("display.precision", 2)\n    {CALL}')
    assert "left changed: pandas' options" in replicate("report", "-j1", "-v")[2]
