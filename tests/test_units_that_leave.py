"""Whatever a unit does is reported by its name, takes nothing else down, and does not decide the exit status."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import rogue

from replicate.exhibits.results import ClaimsResult, Results, TableResult
from replicate.run.library import Library
from replicate.run.parallel import Progress, failures, run

#: What is said about each reading that does not return; the word that names what it did.
SAID = {
    "exit-0": "tries to end the program, with status 0 (rogue_paper/exhibits.py:",
    "exit-3": "tries to end the program, with status 3 (rogue_paper/exhibits.py:",
    "os-exit": "ended its worker process with status 0",
    "base-exception": "Odd: odd (rogue_paper/exhibits.py",
    "interrupt": "KeyboardInterrupt (rogue_paper/exhibits.py",
    "crash": "ended by SIGSEGV (rogue_paper/exhibits.py:",
    "abort": "ended by SIGABRT (rogue_paper/exhibits.py:",
    "killed": "ended by SIGKILL",
    "recursion": "RecursionError",
    "memory": "MemoryError",
    "lambda": "row 'a', column 'x' holds function",
    "huge-integer": "row 'a', column 'x' holds an integer beyond the largest",
    "complex": "row 'a', column 'x' holds complex (1j); expected: a number",
    "text-of-error": "Bad: (its text raises ValueError)",
    "long-error": "ValueError: xxx",
    "escape": "ValueError: a [2Jb (",
    "generator-exit": "GeneratorExit",
    "closes-everything": "ended its worker process",
    "stop-iteration": "StopIteration",
    "pipe": "it has written into the pipe of its process",
}

CLAIMS = """
claims = paper.claims()

@claims.claim("first", "One is one.")
def _first():
    return Finding("holds", 1.0, "It is.")

@claims.claim("leaves", "It stays.")
def _leaves():
    os._exit(0)

@claims.claim("word", "A number decides.")
def _word():
    return Finding("holds", "much", "It is.")

@claims.claim("unknown", "It is known.")
def _unknown():
    return Finding("perhaps", 1.0, "It may be.")

@claims.claim("silent", "It speaks.")
def _silent():
    return Finding("holds", 1.0, None)

@claims.claim("last", "Two is two.")
def _last():
    return Finding("holds", 2.0, "It is.")
"""

#: All but the one that writes into every open file: that ends the process which watches over workers, too, so that of a
#: unit which leaves at this moment nobody knows with which status.
BESIDE = {name: body for name, body in rogue.READINGS.items() if name != "pipe"}

#: Below the command: the two of the standard library that watch over workers, and two workers.
_PROCESSES = 4

POSIX = pytest.mark.skipif(not hasattr(os, "killpg"), reason="groups of processes are of POSIX")


@pytest.fixture(scope="module", params=[1, 3], ids=["one job", "three jobs"])
def outcome(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Results, list[Progress]]:
    steps: list[Progress] = []
    with rogue.installed(tmp_path_factory.mktemp("site"), {**BESIDE, **rogue.HARMLESS}, CLAIMS):
        paper = Library().paper("rogue")
        results = run([paper], jobs=request.param, cache_dir=None, progress=steps.append)
    return results, steps


def table(outcome: tuple[Results, list[Progress]]) -> TableResult:
    result = outcome[0]["rogue", "table-1"]
    assert isinstance(result, TableResult)
    return result


@pytest.mark.parametrize("reading", BESIDE)
def test_a_reading_that_does_not_return_is_named_with_what_it_did(
    outcome: tuple[Results, list[Progress]], reading: str
) -> None:
    why = table(outcome).errors[reading]
    assert SAID[reading] in why
    assert why.isprintable()
    assert len(why) < 600


@pytest.mark.parametrize("reading", ["as-written", *rogue.HARMLESS])
def test_the_others_are_computed_as_if_they_were_alone(outcome: tuple[Results, list[Progress]], reading: str) -> None:
    assert table(outcome).frames[reading].shape == (1, 1)


def test_everything_is_reported_once(outcome: tuple[Results, list[Progress]]) -> None:
    steps = outcome[1]
    assert len({step.unit for step in steps}) == len(steps) == len(BESIDE) + len(rogue.HARMLESS) + 2
    assert [step.done for step in steps] == list(range(1, len(steps) + 1))


def test_what_a_unit_leaves_changed_is_named(outcome: tuple[Results, list[Progress]]) -> None:
    changed = {step.unit.reading: step.changed for step in outcome[1] if step.changed}
    assert changed == {
        "changes-folder": ("the current folder",),
        "thread": ("a thread that still runs (sleeper)",),
        "environment": ("environment variables",),
        "random": ("numpy's random state",),
        "signals": ("handlers of signals",),
    }


def test_output_is_captured(outcome: tuple[Results, list[Progress]], capfd: pytest.CaptureFixture[str]) -> None:
    output = {step.unit.reading: step.output for step in outcome[1]}
    assert set(output["prints"].splitlines()) == {"hello from a unit", "raw", "error"}
    assert "careful" in output["warns"]
    assert "Segmentation fault" in output["crash"]
    assert "hello" not in "".join(capfd.readouterr())


def test_of_claims_only_the_one_that_leaves_is_lost(outcome: tuple[Results, list[Progress]]) -> None:
    claims = outcome[0]["rogue", "claims"]
    assert isinstance(claims, ClaimsResult)
    assert list(claims.findings) == ["first", "last"]
    said = {id: why.replace("rogue_paper/exhibits.py:", "") for id, why in claims.errors.items()}
    assert "ended its worker process with status 0" in said["leaves"]
    assert "the value is text ('much'); expected: a number" in said["word"]
    assert "the verdict is 'perhaps'; allowed: holds, fails, holds-partly" in said["unknown"]
    assert "the evidence is NoneType; expected: text" in said["silent"]
    assert all(f"claim '{id}' (" in said[id] for id in ("word", "unknown", "silent"))


def test_a_reading_that_writes_into_every_open_file_hurts_no_other(tmp_path: Path) -> None:
    with rogue.installed(tmp_path, {"pipe": rogue.READINGS["pipe"], **rogue.HARMLESS}):
        result = run([Library().paper("rogue")], jobs=3, cache_dir=None)["rogue", "table-1"]
    assert isinstance(result, TableResult)
    assert list(result.errors) == ["pipe"]
    assert SAID["pipe"] in result.errors["pipe"]
    assert list(result.frames) == ["as-written", *rogue.HARMLESS]


def test_no_process_is_left(tmp_path: Path) -> None:
    sleep = f"sleep 4321.{os.getpid()}"
    with rogue.installed(tmp_path, {"child": f"import subprocess\nsubprocess.Popen({sleep.split()})\nreturn good()"}):
        run([Library().paper("rogue")], jobs=1, cache_dir=None)
    assert until(lambda: sleep not in {command for _, command in processes().values()})


@POSIX
def test_a_unit_that_kills_the_process_which_starts_workers_hurts_no_other(tmp_path: Path) -> None:
    kill = "import signal\nos.kill(os.getppid(), signal.SIGKILL)\nreturn good()"
    fork = "sys.exit(0)"  # after it, another worker must be started
    with rogue.installed(tmp_path, {"first": kill, "second": fork, "third": kill, "fourth": "return good()"}):
        results = run([Library().paper("rogue")], jobs=2, cache_dir=None)
    result = results["rogue", "table-1"]
    assert isinstance(result, TableResult)
    assert list(result.frames) == ["as-written", "first", "third", "fourth"]
    assert "tries to end the program" in result.errors["second"]


@pytest.mark.parametrize("body", [rogue.LOOP, rogue.HELD_LOOP], ids=["loop", "loop that holds the lock"])
def test_an_endless_unit_is_stopped_by_name(tmp_path: Path, body: str) -> None:
    with rogue.installed(tmp_path, {"endless": body}):
        results = run([Library().paper("rogue")], jobs=2, cache_dir=None, unit_timeout=4)
    result = results["rogue", "table-1"]
    assert isinstance(result, TableResult)
    assert list(result.frames) == ["as-written"]
    said = "stopped after 4 s (--unit-timeout allows more) (rogue_paper/exhibits.py"
    assert result.errors["endless"].startswith(said)


#: What listing the loops of a table does, and what is said about it.
TRIALS = {
    "exits": ("sys.exit(0)", "trials: it tries to end the program, with status 0 (rogue_paper/exhibits.py:"),
    "raises": ("return 1 / 0", "trials: ZeroDivisionError: division by zero (rogue_paper/exhibits.py:"),
    "a-list": ("return []", ": trials returns list; expected: plant and controller by row"),
    "other-row": ("return {'b': ('1/s', 'k=1')}", ": trials has ('1/s', 'k=1') for 'b'; expected: the texts of"),
    "no-loop": ("return {'a': '1/s'}", ": trials has '1/s' for 'a'; expected: the texts of"),
    "prints": ("print('lost')\nreturn {'a': ('1/s', 'k=1')}", ""),
}
#: Those after which nothing is left of the unit.
FATAL_TRIALS = {
    "dies": ("os._exit(0)", "it has ended its worker process with status 0"),
    "endless": (rogue.HELD_LOOP, "stopped after 4 s (--unit-timeout allows more) (rogue_paper/exhibits.py:"),
}


def trials(name: str, body: str) -> str:
    """Return a table with one reading, whose trials do something."""
    lines = "\n".join(f"    {line}" for line in body.splitlines())
    return f"""
table = paper.table("{name}", "Gains", rows=("a",), columns=("x",), printed=False)
table.reading("as-written", "As written")(good)

def _trials():
{lines}

table.trials = _trials
"""


def test_what_listing_loops_does_is_reported_and_takes_nothing_else_down(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    tables = "".join(trials(name, body) for name, (body, _) in {**TRIALS, **FATAL_TRIALS}.items())
    with rogue.installed(tmp_path, {}, tables):
        results = run([Library().paper("rogue")], jobs=2, cache_dir=None, unit_timeout=4)
    for name, (_, said) in TRIALS.items():
        result = results["rogue", name]
        assert isinstance(result, TableResult)
        assert list(result.frames) == ["as-written"]
        assert said in result.trials.error
        assert bool(said) != bool(result.trials.declared)
    lines = {line.partition(": ")[0]: line for line in failures(results)}
    assert lines.keys() == {f"rogue/{name}" for name, (_, said) in TRIALS.items() if said} | {
        f"rogue/{name} (as-written)" for name in FATAL_TRIALS
    }
    for name, (_, said) in FATAL_TRIALS.items():
        assert said in lines[f"rogue/{name} (as-written)"]
    assert "lost" not in "".join(capfd.readouterr())


# ------------------------------------------------------------------------------------------- the command line


@pytest.fixture
def command(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """The command on a paper with one endless reading, running in an empty folder."""
    with rogue.installed(tmp_path / "site", {"endless": rogue.HELD_LOOP}):
        process = start(tmp_path, "check", "rogue", "--jobs", "2", "--accepted", str(tmp_path))
        yield process
        process.kill()
        process.communicate()


def start(tmp_path: Path, *arguments: str) -> subprocess.Popen[str]:
    here = tmp_path / "here"
    here.mkdir(exist_ok=True)
    return subprocess.Popen(
        [sys.executable, "-m", "replicate", *arguments],
        cwd=here,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "site"), "NO_COLOR": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def processes() -> dict[int, tuple[int, str]]:
    """Return parent and command line of every process."""
    listed = subprocess.run(["ps", "-eo", "pid=,ppid=,args="], capture_output=True, text=True, check=True).stdout
    fields = (line.split(None, 2) for line in listed.splitlines())
    return {int(pid): (int(parent), rest[0] if rest else "") for pid, parent, *rest in fields}


def descendants(pid: int) -> dict[int, str]:
    """Return the command lines of all processes below one."""
    there, found = processes(), set[int]()
    while new := {child for child, (parent, _) in there.items() if parent in found | {pid}} - found:
        found |= new
    return {child: there[child][1] for child in found}


def until(holds: Callable[[], bool]) -> bool:
    """Wait until something holds; return whether it does."""
    limit = time.monotonic() + 120
    while not (found := holds()) and time.monotonic() < limit:
        time.sleep(0.1)
    return found


def busy(process: subprocess.Popen[str]) -> dict[int, str]:
    """Wait until the command's workers are there; return all its processes with their command lines."""
    assert process.stderr is not None
    assert "as-written" in process.stderr.readline()  # the other reading is at work now
    found: dict[int, str] = {}

    def are_there() -> bool:
        found.clear()
        found.update(descendants(process.pid))
        return len(found) == _PROCESSES

    assert until(are_there)
    return found


def all_gone(workers: dict[int, str]) -> bool:
    """Wait until processes have ended; their numbers may be those of others by then."""
    return until(lambda: not workers.items() & {pid: command for pid, (_, command) in processes().items()}.items())


@POSIX
def test_no_worker_outlives_a_main_process_that_is_killed(command: subprocess.Popen[str]) -> None:
    workers = busy(command)
    command.send_signal(signal.SIGKILL)
    command.wait()
    assert all_gone(workers)


@POSIX
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_that_is_told_to_end_ends_with_its_workers(command: subprocess.Popen[str], number: int) -> None:
    workers = busy(command)
    command.send_signal(number)
    command.wait(timeout=120)
    assert command.returncode != 0
    assert all_gone(workers)


@POSIX
def test_a_worker_that_is_killed_ends_the_run_at_once_with_its_name(command: subprocess.Popen[str]) -> None:
    below = busy(command)
    workers = [pid for pid, (parent, _) in processes().items() if parent in below]
    assert len(workers) == 2
    for pid in workers:
        os.kill(pid, signal.SIGKILL)
    _, errors = command.communicate(timeout=120)
    assert command.returncode == 2
    assert "rogue/table-1 (endless): its worker process was ended by SIGKILL" in errors


@pytest.mark.parametrize("reading", ["exit-0", "os-exit"])
def test_a_unit_that_leaves_makes_no_run_green(tmp_path: Path, reading: str) -> None:
    with rogue.installed(tmp_path / "site", {reading: rogue.READINGS[reading]}):
        for command in (["check", "--accepted", str(tmp_path)], ["report"]):
            process = start(tmp_path, command[0], "rogue", *command[1:], "--jobs", "1")
            _, errors = process.communicate(timeout=120)
            assert process.returncode == 2
            assert f"failed: rogue/table-1 ({reading}): " in errors


@pytest.mark.parametrize("leave", ["import sys; sys.exit(0)", "import os; os._exit(0)", "raise KeyboardInterrupt()"])
def test_an_import_that_leaves_makes_no_run_green(tmp_path: Path, leave: str) -> None:
    with rogue.installed(tmp_path / "site", {}, init=f"{leave}\n"):
        process = start(tmp_path, "check", "rogue", "--accepted", str(tmp_path))
        _, errors = process.communicate(timeout=120)
    assert process.returncode not in {0, 1}
    if "Keyboard" not in leave:
        assert process.returncode == 2
        (line,) = errors.splitlines()
        assert "rogue_paper/__init__.py:1: it tries to end the program, with status 0" in line


def test_an_import_that_leaves_does_not_end_the_run_of_other_papers(tmp_path: Path) -> None:
    with rogue.installed(tmp_path / "site", {}, init="import os; os._exit(0)\n"):
        process = start(tmp_path, "list", "khan")
        output, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    assert "table-1" in output
