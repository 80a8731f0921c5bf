"""Code of exercises that does not end, ends its process or floods the disk: one line with file and line, status 2."""

from __future__ import annotations

import errno
import os
import pickle
import re
import signal
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
import varied_handout
from conftest import Run

from replicate.errors import ReplicateError
from replicate.handout import Order, Sheet, check_order
from replicate.run import guarded
from replicate.run.guarded import GuardedProcess, Place, tell, watched

EXERCISE = """from replicate.exhibits.variants import Answer

{at_import}


def variant(rng):
    {in_variant}
    return {{"x": rng.randint(20, 90)}}


def answers(inputs):
    {in_answers}
    return Answer(inputs["x"] / 7, digits=3)


requires = {{"small": lambda inputs: {in_requires}}}
"""
NOTHING = {"at_import": "", "in_variant": "pass", "in_answers": "pass", "in_requires": "True"}
PYTHON, C, REGEX = "while True: pass", "sum(range(10**18))", "__import__('re').match('(a+)+$', 'a' * 64 + 'b')"
PIPE = "import os, time, replicate.run.guarded as g; pipe = g._watch.connection.fileno(); "
WRITTEN = "fails: it has written into the pipe of its process"


class _Bomb:
    def __reduce__(self) -> tuple[object, ...]:
        return Path.touch, (Path("exploded"),)


_BOMB = pickle.dumps(_Bomb())
PICKLE = len(_BOMB).to_bytes(4, "big") + _BOMB
STOPPED = r" did not end within 0\.7 s; it was stopped in this line"


@pytest.mark.parametrize(
    ("where", "code", "said"),
    [
        ("at_import", PYTHON, f":3: the program{STOPPED}"),
        ("at_import", C, f":3: the program{STOPPED}"),
        ("in_variant", PYTHON, rf":7: variant\(rng\){STOPPED}"),
        ("in_answers", PYTHON, rf":12: answers\(inputs\){STOPPED}"),
        ("in_answers", REGEX, rf":12: answers\(inputs\){STOPPED}"),
        ("in_requires", C, rf":16: requires\['small'\]{STOPPED}"),
        ("in_answers", "import time; time.sleep(1e6)", rf":12: answers\(inputs\){STOPPED}"),
        ("in_answers", "import faulthandler; faulthandler.cancel_dump_traceback_later(); " + C, ":12: .* 0.7 s"),
        ("in_answers", "import os; os._exit(0)", r":11: answers\(inputs\) fails: it has ended its process"),
        ("in_answers", "import os; os.kill(os.getpid(), 11)", r":12: .*has ended its process \(SIGSEGV\)"),
        ("in_answers", "raise SystemExit(0)", r":12: answers\(inputs\) fails: SystemExit: 0"),
        ("in_answers", f"{PIPE}os.write(pipe, b'garbage'); time.sleep(60)", rf":12: answers\(inputs\) {WRITTEN}"),
        ("in_answers", f"{PIPE}os.write(pipe, {PICKLE!r}); time.sleep(60)", rf":12: answers\(inputs\) {WRITTEN}"),
        ("in_answers", f"{PIPE}os.write(pipe, b'\\0\\0\\0\\x09p'); time.sleep(9)", rf":12: answers\(inputs\){STOPPED}"),
        ("in_answers", "while True: print('x' * 1000)", r":1[12]: answers\(inputs\) has written more than 1 MB"),
    ],
)
def test_a_lecturers_code_is_stopped_and_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str, code: str, said: str
) -> None:
    monkeypatch.setattr(guarded, "MOST_OUTPUT", 2**20)
    monkeypatch.setattr(guarded, "_PATIENCE", 1.0)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    home = tmp_path / "Übungen 演習" / "mine"  # letters that a fault handler cannot write
    home.mkdir(parents=True)
    (home / "exercise.md").write_text("## Title\nWhat?\n", encoding="utf-8")
    (home / "exercise.py").write_text(EXERCISE.format(**NOTHING | {where: code}), encoding="utf-8")
    floods = "written" in said
    with GuardedProcess(30.0 if floods else 0.7) as process, pytest.raises(ReplicateError) as raised:
        list(process.stream(check_order, Order((), Sheet(), (home,))))
    assert re.match(rf"mine/exercise\.py{said}", str(raised.value)), raised.value
    assert not list((tmp_path / "temporary").glob("replicate-*"))  # whatever has ended it
    assert not Path("exploded").exists()


SET = ("handout", "lab", "--variants", "2", "--format", "html")


@pytest.mark.usefixtures("lab_computed")  # what is computed has the same limit, and takes longer
@pytest.mark.parametrize(
    ("where", "code", "command", "said"),
    [
        ("in_answers", C, SET, r"lab/handout\.py:21: exercise 'division': answers\(inputs\) did not end within 3 s"),
        ("in_figure", C, SET, r"lab/handout\.py:8: exercise 'division': figures\['line'\] did not end within 3 s"),
        ("in_answers", "1 / 0", SET, r"lab/handout\.py:21: exercise 'division': .* fails: ZeroDivisionError"),
        ("file", "../../x.csv", SET, r"lab/handout\.py:13: .*files\(inputs\) fails: .*names a file '\.\./\.\./x\.csv'"),
        ("in_answers", PYTHON, ("handout", "lab", "--stress", "3"), r"lab/handout\.py:21: .* did not end within 3 s"),
        ("in_answers", PYTHON, ("check", "lab"), r"handout\.py:21: .* did not end within 3 s; it was stopped"),
    ],
)
def test_a_papers_handout_is_stopped_and_named(
    replicate: Run, folder: Path, where: str, code: str, command: tuple[str, ...], said: str
) -> None:
    varied_handout.write(folder, **{where: code})
    accepted = ("--accepted", "accepted")
    if command[0] == "check":
        replicate("accept", "lab", *accepted, "--reason", "first", "-j1")
        command += accepted
    status, _, errors = replicate(*command, "-j1", "--unit-timeout", "3")
    assert status == 2
    assert re.search(said, errors), errors
    assert "Traceback" not in errors
    assert not list(Path.cwd().rglob("*.html"))


@pytest.mark.parametrize("command", [SET, ("handout", "lab", "--stress", "3")])
def test_an_interrupt_while_exercises_are_checked_says_that_nothing_was_changed(
    replicate: Run, folder: Path, command: tuple[str, ...]
) -> None:
    interrupt = f"import os, time; os.kill({os.getpid()}, {int(signal.SIGINT)}); time.sleep(60)"
    varied_handout.write(folder)
    home = Path("mine")
    home.mkdir()
    (home / "exercise.md").write_text("## Title\nWhat?\n", encoding="utf-8")
    (home / "exercise.py").write_text(EXERCISE.format(**NOTHING | {"in_answers": interrupt}), encoding="utf-8")
    status, _, errors = replicate(*command, "-j1", "--exercises", "mine")
    assert status == 130
    assert errors == f"{Path('build')}: interrupted; nothing was changed there\n"
    assert not list(Path.cwd().rglob("*.html"))


def numbers(count: int) -> Iterator[int]:
    """Yield numbers, as a function that is streamed does; the last one is told."""
    yield from range(count - 1)
    tell(count - 1)


def ended_early() -> Iterator[int]:
    with watched(Place(__file__, "here.py", "it")):
        yield 1
        os._exit(3)


def forked() -> Iterator[str]:
    with watched(Place(__file__, "here.py", "it")):
        os.fork()
    yield "once"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a system that forks")
def test_what_a_child_of_the_code_would_send_is_not_sent() -> None:
    with GuardedProcess(5.0) as process:
        assert list(process.stream(forked)) == ["once"]
        assert list(process.stream(numbers, 1)) == [0]


def on_a_full_disk() -> list[int]:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_full_disk_for_temporary_files_is_one_line() -> None:
    with GuardedProcess(5.0) as process, pytest.raises(ReplicateError) as found:
        list(process.stream(on_a_full_disk))
    assert str(found.value) == f"a process of this run cannot go on: {os.strerror(errno.ENOSPC)}"


def test_what_a_function_yields_arrives_in_order_and_the_process_serves_again() -> None:
    with GuardedProcess(5.0) as process:
        assert list(process.stream(numbers, 3)) == [0, 1, 2]
        found = process.stream(ended_early)
        assert next(found) == 1
        with pytest.raises(ReplicateError, match=r"^here\.py:\d+: it fails: it has ended its process$"):
            next(found)
        assert list(process.stream(numbers, 1)) == [0]


@pytest.mark.parametrize(
    ("code", "said"),
    [
        (PYTHON, r"lab_paper/exhibits\.py:\d+: chart 'line' did not end within 2 s; it was stopped in this line"),
        (C, r"lab_paper/exhibits\.py:\d+: chart 'line' did not end within 2 s; it was stopped in this line"),
        ("os._exit(0)", r"lab_paper/exhibits\.py:\d+: chart 'line' fails: it has ended its process"),
    ],
)
def test_a_chart_is_stopped_and_named(
    replicate: Run, folder: Path, monkeypatch: pytest.MonkeyPatch, code: str, said: str
) -> None:
    monkeypatch.setattr("replicate.run.charts.CHART_TIMEOUT", 2.0)
    with (folder / "exhibits.py").open("a", encoding="utf-8") as file:
        file.write(
            f"\n\n@paper.chart('line', 'A line', parameters={{'slope': 'm'}})\ndef line(fig, slope):\n    {code}\n"
        )
    status, _, errors = replicate("chart", "lab", "--slope", "2", "--out", "x.svg")
    assert status == 2
    assert re.fullmatch(rf"replicate: {said}\n", errors), errors
    assert not Path("x.svg").exists()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs a system with alarms")
@pytest.mark.parametrize("code", [PYTHON, "import time; time.sleep(1e6)", REGEX])
def test_a_paper_that_is_imported_for_ever_takes_no_other_with_it(
    replicate: Run, folder: Path, monkeypatch: pytest.MonkeyPatch, code: str
) -> None:
    monkeypatch.setattr("replicate.run.discovery.IMPORT_TIMEOUT", 3.0)
    with (folder / "exhibits.py").open("a", encoding="utf-8") as file:
        file.write(f"\n\n{code}\n")
    replicate("init", "mine")
    monkeypatch.chdir("mine")
    replicate("new", "gauss")
    status, _, errors = replicate("report", "gauss", "lab", "-j1")
    assert status == 2
    assert re.search(
        r"entry point 'lab' cannot be loaded: lab_paper/exhibits\.py:\d+: it did not end within 3 s", errors
    )
    assert Path("build/report/gauss.html").is_file()
