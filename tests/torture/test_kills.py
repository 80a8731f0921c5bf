"""Kill, interrupt and tear: whatever happens to a run, what it replaces is the earlier state or the new one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import installed_paper
import pytest
import varied_handout
from attack import Attack
from command import status_of

from replicate.staging import replace_files

HERE = Path(__file__).parent

# Nothing here depends on what the disk flushes; in memory, flushing takes no time.
MEMORY = Path("/dev/shm")  # noqa: S108  -- a folder of its own is made inside

SCENARIOS = ("report", "report behind a link", "accept")


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    if not os.access(MEMORY, os.W_OK):
        yield tmp_path_factory.mktemp("quick")
        return
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        yield Path(folder)


def environment() -> dict[str, str]:
    """Return the environment of a process in which the modules of this folder are found."""
    return {**os.environ, "PYTHONPATH": str(HERE), "NO_COLOR": "1"}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a system with fork")
@pytest.mark.parametrize("scenario", SCENARIOS)
@pytest.mark.parametrize(("kind", "words", "every"), [("killed", "killed twice", 9), ("signalled", "two signals", 13)])
def test_swaps(attack: Attack, quick: Path, kind: str, words: str, every: int, scenario: str) -> None:
    build = quick / f"{kind} {scenario}" / "build"
    build.parent.mkdir()
    script = (sys.executable, str(HERE / "killed_swaps.py"))
    arguments = (kind, scenario, str(build), "1" if attack.everything else str(every))
    done = subprocess.run([*script, *arguments], capture_output=True, text=True, check=False, env=environment())
    assert done.returncode == 0, done.stderr
    cases = json.loads(done.stdout)
    attack.report(f"{words} at any file operation: {scenario}", len(cases), [(case, why) for case, why in cases if why])


COMMANDS = {
    "report": ["report", "lab"],
    "diff": ["diff", "lab", "--accepted", "accepted"],
    "accept": ["accept", "lab", "--accepted", "accepted", "--reason", "moved"],
    "handout": ["handout", "lab", "--format", "html"],
    "class set": ["handout", "lab", "--roster", "roster.csv", "--seed", "{}", "--format", "html"],
    "chart": ["chart", "krajewski", "--tau", "{}", "--chart", "design", "--out", "charts/mine.svg"],
    "whatif": ["whatif", "--plant", "1/(s+1)", "--controller", "k={},ki=0.5", "--out", "pages/mine.html"],
    "new": ["new", "another"],
}


def edit(site: Path, replacement: str) -> None:
    """Change the paper, so that the next run writes other files."""
    exhibits = site / "lab_paper/exhibits.py"
    exhibits.write_text(exhibits.read_text().replace("2**0.5, 3**0.5", replacement).replace("math.log(", "math.log1p("))


@pytest.fixture(scope="module")
def left(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Return the folder that a command has left behind after its first run, the same for all attacks on it."""

    @cache
    def left(command: str) -> Path:
        folder = tmp_path_factory.mktemp("left")
        here, site = folder / "here", folder / "site"
        (here / "build/report").mkdir(parents=True)
        (here / "build/report/main.tex").write_text("thesis")
        (here / "roster.csv").write_text("student,name\n1,Ada\n2,Emil\n", encoding="utf-8")
        with installed_paper.installed(site) as paper, pytest.MonkeyPatch.context() as patch:
            patch.chdir(here)
            patch.setenv("NO_COLOR", "1")
            if command == "class set":
                varied_handout.write(paper)
            for earlier in {"diff": ["accept", "diff"], "new": []}.get(command, [command]):
                assert status_of(*asked(earlier, "0.3")) in (0, 1)
        return folder

    return left


def asked(command: str, value: str) -> list[str]:
    """Return the arguments of a command, with a value where it takes one."""
    jobs = ["-j1"] if command not in ("chart", "whatif", "new") else []
    return [*(part.format(value) for part in COMMANDS[command]), *jobs]


@dataclass(frozen=True)
class Attacked:
    """What became of a folder in which a command ran again after its paper had changed.

    Attributes
    ----------
    here
        The folder; beside it ``states/<number>`` are copies of it before each file operation.
    old, new
        What it held before and after.
    cases
        For each way in which operations failed: which failed, and what went wrong.
    """

    here: Path
    old: dict[str, bytes]
    new: dict[str, bytes]
    cases: dict[str, list[tuple[str, str]]]


#: How operations fail, and which commands are tried so without ``--torture``.
WAYS = {"once": {"report", "accept"}, "full": set(COMMANDS)}


@pytest.fixture(scope="module")
def failing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., dict[str, list[tuple[str, str]]]]]:
    """Return a function that asks one process for all attacks; see `failing_steps`."""
    if not hasattr(os, "fork"):
        pytest.skip("needs a system with fork")
    said = tmp_path_factory.mktemp("said") / "said"
    with said.open("w") as errors:
        process = subprocess.Popen(
            [sys.executable, str(HERE / "failing_steps.py")],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, text=True, env=environment(),
        )  # fmt: skip

    def ask(*request: object) -> dict[str, list[tuple[str, str]]]:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(f"{json.dumps(request)}\n")
        process.stdin.flush()
        answer = process.stdout.readline()
        assert answer, said.read_text(encoding="utf-8")
        cases: dict[str, list[tuple[str, str]]] = json.loads(answer)
        return cases

    with process:
        yield ask


@pytest.fixture(scope="module")
def attacked(
    request: pytest.FixtureRequest,
    quick: Path,
    left: Callable[[str], Path],
    failing: Callable[..., dict[str, list[tuple[str, str]]]],
) -> Callable[[str], Attacked]:
    """Run a command that writes something else than before, once for all attacks on it."""
    everything = request.config.getoption("--torture")

    @cache
    def attacked(command: str) -> Attacked:
        folder = quick / command
        here, site = folder / "here", folder / "site"
        shutil.copytree(left(command), folder, symlinks=True)
        edit(site, "2**0.5, 3**0.51")
        ways = [how for how, commands in WAYS.items() if hasattr(os, "fork") and (everything or command in commands)]
        old = tree(here)
        cases = failing(ways, str(here), str(site), 1 if everything else 17, asked(command, "0.4"))
        return Attacked(here, old, tree(folder / "new"), cases)

    return attacked


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_that_are_killed(attack: Attack, attacked: Callable[[str], Attacked], command: str) -> None:
    found = attacked(command)
    states, old, new = found.here.with_name("states"), found.old, found.new
    assert old != new

    def held(number: int) -> str:
        state = states / str(number)
        torn = [name for name, content in tree(state).items() if content not in (old.get(name), new.get(name))]
        if torn:
            return f"half written: {', '.join(torn)}"
        for target in {path.parent for path in state.rglob(".replicate")}:
            replace_files(target, {})
        left = [path.name for path in state.rglob(".replicate/*") if path.name != "manifest.json"]
        if left:
            return f"left behind: {', '.join(left)}"
        return "" if tree(state) in (old, new) else "a mixture of the earlier and the new state"

    numbers = range(1, len(list(states.iterdir())) + 1)
    attack(f"killed at any file operation: {command}", numbers, held, short=12)
    shutil.rmtree(states)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a system with fork")
@pytest.mark.parametrize("how", WAYS)
@pytest.mark.parametrize("command", COMMANDS)
def test_commands_whose_disk_fails(attack: Attack, attacked: Callable[[str], Attacked], command: str, how: str) -> None:
    if not attack.everything and command not in WAYS[how]:
        pytest.skip("in the long form only")
    cases = attacked(command).cases[how]
    words = {"once": "one file operation fails", "full": "the disk is full from any operation on"}[how]
    attack.report(f"{words}: {command}", len(cases), [(case, why) for case, why in cases if why])


def tree(folder: Path) -> dict[str, bytes]:
    """Return what a user sees of a folder, without what is kept for the next run."""
    hidden = {"cache", ".replicate"}
    files = (path for path in folder.rglob("*") if path.is_file() and not hidden & {*path.relative_to(folder).parts})
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
