"""The command line: what it says, what it leaves behind, and its exit status."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from installed_paper import contents

from replicate.staging import stage
from replicate.staging.journal import throw_away

Run = Callable[..., tuple[int, str, str]]


def accepted(replicate: Run) -> str:
    """Accept the present state of the small paper in a folder of its own."""
    Path("accepted").mkdir()
    assert replicate("accept", "lab", "--reason", "first", "--accepted", "accepted", "-j1")[0] == 0
    return "accepted"


def test_help_and_import_load_nothing_heavy() -> None:
    heavy = ["numpy", "scipy", "control", "matplotlib", "pandas", "jinja2", "joblib", "schemdraw"]
    code = (
        "import sys; sys.argv = ['replicate', '--help']\n"
        "from replicate.cli import main\n"
        "try: main()\n"
        f"except SystemExit: print(sorted(set({heavy}) & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "show" in done.stdout
    assert done.stdout.endswith("[]\n")


def test_list(replicate: Run) -> None:
    status, out, _ = replicate("list", "lab")
    assert status == 0
    for part in ("table-1", "as-written, decimal", "1 claim ", "not computable"):
        assert part in out


def test_list_says_what_is_done_and_what_cannot_be_and_why(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """On the thesis, against the printed CSV and the definitions themselves."""
    from replicate.exhibits import NotComputable
    from replicate.resources import accepted_dir
    from replicate.run.library import Library
    from replicate.terminal.console import console
    from replicate.terminal.inventory import print_exhibits

    paper = Library().paper("panagopoulos")
    monkeypatch.setenv("COLUMNS", "100")
    print_exhibits(paper, console(), accepted_dir())
    inventory, _, missing = capsys.readouterr().out.partition("What cannot be computed, and why")
    lines = {line.split()[0]: line for line in inventory.splitlines() if line and not line.startswith(" ")}
    assert set(paper.numbered) <= set(lines)
    for exhibit in paper.exhibits.values():
        if isinstance(exhibit, NotComputable):
            assert "not computable" in lines[exhibit.id]
            assert exhibit.id in missing
            assert " ".join(exhibit.reason.replace("$", "").split()) in " ".join(missing.split())
    assert "done" in lines["I-table-1"]
    assert "partly" in lines["V-drying"]
    # V-drying prints two settling times and two mean squares that were measured
    assert "V-drying (4 of 9 printed values)" in missing
    assert "{{" not in missing


def test_show_a_table(replicate: Run) -> None:
    status, out, err = replicate("show", "lab", "table-1", "-j1")
    assert status == 0
    assert "computed 2/2  lab/table-1 (" in err  # the longest run comes first, so either may be the last
    lines = [line.split() for line in out.splitlines()]
    assert ["row", "printed", "as-written", "decimal", "verdict"] in lines
    assert ["2", "root", "1.414", "1.41421", "=", "1.41421", "=", "✓", "reproduced"] in lines
    assert ["log", "0.301", "0.69315", "≠", "0.30103", "=", "↻", "reconstructed"] in lines
    assert "✎ 3 log: misprint, should be 0.477" in out
    assert "The last digit is wrong: 0.477121" in out
    assert "Logarithms to base ten" in out
    assert max(map(len, out.splitlines())) <= 100
    assert "\x1b" not in out + err


@pytest.mark.usefixtures("lab_computed")
def test_show_one_reading(replicate: Run) -> None:
    _, out, _ = replicate("show", "lab", "table-1", "--reading", "decimal", "-j1")
    assert "decimal" in out
    assert "as-written" not in out
    status, _, err = replicate("show", "lab", "table-1", "--reading", "octal")
    assert status == 2
    assert "known: as-written, decimal" in err


@pytest.mark.usefixtures("lab_computed")
@pytest.mark.parametrize(
    ("exhibit", "said"),
    [
        ("fig-1", "output"),
        ("fig-2", "not computable: It shows the laboratory."),
        ("claims", "✓ holds  1.41421356"),
    ],
)
def test_show_everything_else(replicate: Run, exhibit: str, said: str) -> None:
    status, out, _ = replicate("show", "lab", exhibit, "-j1")
    assert status == 0
    assert said in out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("show", "lap", "table-1"), "replicate: there is no paper 'lap'; known: "),
        (
            ("show", "lab", "table-9"),
            "replicate: lab has no exhibit 'table-9'; known: table-1, fig-1, fig-2, claims",
        ),
        (("accept", "lab"), "replicate: accepting needs a reason"),
        (("accept", "lab/x", "--reason", "y"), "replicate: lab has no exhibit 'x'"),
    ],
)
def test_errors_are_one_line(replicate: Run, arguments: tuple[str, ...], said: str) -> None:
    status, out, err = replicate(*arguments)
    assert (status, out) == (2, "")
    assert err.startswith(said)
    assert err.count("\n") == 1


@pytest.mark.parametrize("arguments", [("report", "--colour"), ("nonsense",), ("check", "--jobs", "0")])
def test_bad_options(replicate: Run, arguments: tuple[str, ...]) -> None:
    status, out, err = replicate(*arguments)
    assert (status, out) == (2, "")
    assert re.fullmatch(r"replicate: .+ \(replicate [a-z ]*--help shows what is allowed\)\n", err)


def test_without_a_command_the_commands_are_listed(replicate: Run) -> None:
    status, out, err = replicate()
    assert (status, err) == (2, "")
    lines = out[out.index("Commands:") :].splitlines()[1:]
    named = {line.split()[0] for line in lines}
    assert {"list", "show", "report", "check", "diff", "accept", "handout", "init", "new", "printed"} <= named
    assert not any(line.endswith("...") for line in lines)


@pytest.mark.usefixtures("lab_computed")
def test_numbers_stay_whole_on_a_narrow_terminal(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    for exhibit in ("table-1", "fig-1"):
        out = replicate("show", "lab", exhibit, "-j1")[1]
        assert "…" not in out
    assert ["log", "0.301", "0.69315", "≠", "0.30103", "=", "↻", "reconstructed"] in [
        line.split() for line in replicate("show", "lab", "table-1", "-j1")[1].splitlines()
    ]


def test_a_list_on_a_narrow_terminal_is_whole(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.setattr("replicate.resources._PACKAGE", Path("nowhere"))  # no accepted state either
    status, out, _ = replicate("list", "panagopoulos")
    assert status == 0
    lines = out.partition("What cannot be computed")[0].splitlines()
    assert max(map(len, lines)) <= 60
    assert "…" not in out
    assert "Equation (7) and its correction" in " ".join(out.split())


def test_a_terminal_without_unicode(folder: Path, tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONPATH": str(folder.parent)}
    done = subprocess.run(
        [sys.executable, "-m", "replicate", "show", "lab", "table-1", "-j1", "--out", str(tmp_path)],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0
    assert "reproduced" in done.stdout


@pytest.mark.usefixtures("lab_computed")
def test_a_run_that_is_told_to_end_tidies_up(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(target: Path) -> None:
        os.kill(os.getpid(), signal.SIGTERM)
        throw_away(target)

    replicate("report", "lab", "-j1")
    before = contents(Path("build"))
    monkeypatch.setattr("replicate.report.pages.build_report", lambda *_, **__: os.kill(os.getpid(), signal.SIGTERM))
    monkeypatch.setattr(stage, "throw_away", interrupted)
    assert replicate("report", "lab", "-j1")[0] == 143
    assert contents(Path("build")) == before
    assert not [path for path in Path("build").rglob("*") if path.name in ("new", "journal.json", "lock")]


@pytest.mark.usefixtures("lab_computed")
def test_when_everything_fails_the_first_lines_tell(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    failures = [f"lab/table-{number}: ValueError: no" for number in range(40)]
    monkeypatch.setattr("replicate.run.outcome.failures", lambda _: failures)
    status, _, err = replicate("report", "lab", "-j1")
    told = [line for line in err.splitlines() if line.startswith("failed: ")]
    assert status == 2
    assert told == [*(f"failed: {failure}" for failure in failures[:12]), "failed: 28 more"]


def test_a_new_paper_needs_an_id_of_its_own(replicate: Run) -> None:
    status, _, err = replicate("new", "lab")
    assert (status, err) == (2, "replicate: the paper 'lab' already exists; choose another id\n")
    assert not Path("replicate-lab").exists()


def test_a_malformed_file_is_named(replicate: Run, folder: Path) -> None:
    (folder / "printed/table-1.csv").write_text("number,root,log\n2,1.414,0.3o1\n3,1.732,0.478\n")
    status, _, err = replicate("check", "lab", "-j1", "--accepted", "accepted")
    assert status == 2
    assert "printed/table-1.csv:2" in err
    assert "0.3o1" in err.splitlines()[-1]


def test_debug_shows_where(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(Exception, match="no paper 'lap'"):
        replicate("show", "lap", "table-1", "--debug")
    monkeypatch.setattr("replicate.run.library.Library.paper", lambda *_: 1 / 0)
    status, _, err = replicate("show", "lab", "table-1")
    assert status == 2
    assert err == "replicate: unexpected ZeroDivisionError: division by zero (--debug shows where)\n"


@pytest.mark.usefixtures("lab_computed")
def test_check(replicate: Run, folder: Path) -> None:
    check = ("check", "lab", "-j1", "--accepted", accepted(replicate))
    status, out, err = replicate(*check)
    assert (status, out) == (0, "problems: 0; comparisons: 9; exhibits: 3\n")
    assert "4 of 4 results kept from an earlier run" in err
    printed = folder / "printed/table-1.csv"
    printed.write_text(printed.read_text().replace("1.732", "1.742"))
    status, out, _ = replicate(*check)
    assert status == 1
    assert "3 root" in out
    assert "verdict reproduced -> near" in out


@pytest.mark.usefixtures("lab_computed")
def test_check_fails_without_accepted_state(replicate: Run, tmp_path: Path) -> None:
    status, out, _ = replicate("check", "lab", "-j1", "--accepted", str(tmp_path / "nothing"))
    assert status == 1
    assert "lab/table-1: has no accepted state: lab/table-1.csv is missing" in out


@pytest.mark.parametrize("command", [("diff", "lab"), ("check", "lab"), ("accept", "lab", "--reason", "x")])
def test_outside_a_project_the_accepted_folder_must_be_named(replicate: Run, command: tuple[str, ...]) -> None:
    status, out, err = replicate(*command, "-j1")
    assert (status, out) == (2, "")
    assert err == (
        "replicate: there is no project here: name the folder of the accepted state with --accepted, "
        "or see 'replicate init'\n"
    )


def test_a_damaged_installation(replicate: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("replicate.resources._PACKAGE", tmp_path / "nowhere")
    status, _, err = replicate("check", "khan", "-j1")
    assert status == 2
    assert err == ("replicate: the accepted state of the bundled papers is missing: name another folder: --accepted\n")


@pytest.mark.usefixtures("lab_computed")
def test_an_exhibit_that_raises_breaks_check(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    check = ("check", "lab", "-j1", "--no-cache", "--accepted", accepted(replicate))
    monkeypatch.setenv("LAB_BREAKS", "1")
    status, out, err = replicate(*check)
    assert status == 2
    assert "failed: lab/table-1 (as-written): ValueError: the kettle is empty" in err
    assert "the kettle is empty" in out


@pytest.mark.usefixtures("lab_computed")
def test_report(replicate: Run) -> None:
    status, out, _ = replicate("report", "lab", "-j1")
    assert status == 0
    assert Path("build/report/index.html").is_file()
    assert Path("build/report/lab.html").is_file()
    assert out.endswith("report: build/report/index.html\n")
    lines = [line.split() for line in out.splitlines()]
    assert ["printed", "values", "4", "4"] in lines
    assert ["✓", "reproduced", "2", "2"] in lines
    assert ["✎", "misprint", "1", "1"] in lines
    assert len(lines) < 24
    before = contents(Path("build"))
    assert replicate("report", "lab", "-j1", "--no-cache")[0] == 0
    assert contents(Path("build")) == before


@pytest.mark.usefixtures("lab_computed")
def test_an_interrupted_report_leaves_the_earlier_one(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    replicate("report", "lab", "-j1")
    before = contents(Path("build"))

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("replicate.report.pages.build_report", interrupted)
    status, _, err = replicate("report", "lab", "-j1")
    assert status == 130
    assert err.endswith("build: interrupted; nothing was changed there\n")
    assert contents(Path("build")) == before


def test_a_report_with_a_broken_exhibit_is_written_and_says_so(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LAB_BREAKS", "1")
    status, out, err = replicate("report", "lab", "-j1")
    assert status == 2
    assert "the kettle is empty" in err
    assert "report: build/report/index.html" in out
    assert "the kettle is empty" in Path("build/exhibits.csv").read_text() + Path("build/junit.xml").read_text()


def test_an_output_folder_that_cannot_be_written(replicate: Run) -> None:
    Path("file").write_text("")
    status, _, err = replicate("report", "lab", "--out", "file/build")
    assert status == 2
    assert err.startswith("replicate: file/build: cannot be written: ")


@pytest.mark.parametrize("command", [("report", "lab", "--out"), ("accept", "lab", "--reason", "x", "--accepted")])
def test_nothing_is_written_where_everything_lies(
    replicate: Run, command: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = tmp_path / "home"
    home.mkdir()
    monkeypatch.setenv("USERPROFILE" if os.name == "nt" else "HOME", str(home))
    for folder, what in ((home.anchor, "the root of a disk"), (home / ".." / "home", "the user's home")):
        status, _, said = replicate(*command, str(folder))
        assert status == 2
        assert f"is {what}, where nothing is written; name a folder in it, such as" in said
    assert list(home.iterdir()) == []


def test_a_date_of_a_build_that_is_no_number_stops_no_library(replicate: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "x")  # numpy's own f2py reads it on import
    assert replicate("list")[0] == 0
    assert "SOURCE_DATE_EPOCH" not in os.environ
