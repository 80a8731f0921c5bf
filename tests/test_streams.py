"""Output that cannot be written: one line or none, and never the status of a success."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import installed_paper
import pytest

from replicate.run.library import Library
from replicate.run.outcome import recompute

pytestmark = pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")

COMMANDS = [("--version",), ("report", "lab", "-j1"), ("check", "lab", "-j1", "--accepted", "accepted")]


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    with installed_paper.installed(tmp_path / "site"):
        pass
    (tmp_path / "here").mkdir()
    return tmp_path


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the results of the small paper."""
    here = tmp_path_factory.mktemp("results")
    with installed_paper.installed(tmp_path_factory.mktemp("site")):
        recompute([Library().paper("lab")], jobs=1, cache_dir=here / "build" / "cache")
    return here


@pytest.fixture
def computed(lab: Path, results: Path) -> Path:
    """Return what `lab` does, where nothing is left to compute: what is said at the end is the same."""
    shutil.copytree(results, lab / "here", dirs_exist_ok=True)
    return lab


def run(lab: Path, arguments: tuple[str, ...], redirection: str) -> subprocess.CompletedProcess[str]:
    """Run the command through a shell, and end with its own status."""
    command = f'"$0" -m replicate "$@" {redirection}; exit ${{PIPESTATUS[0]}}'
    return subprocess.run(
        ["bash", "-c", command, sys.executable, *arguments],
        capture_output=True,
        text=True,
        check=False,
        cwd=lab / "here",
        env={**os.environ, "PYTHONPATH": str(lab / "site")},
    )


def unexpected(text: str) -> list[str]:
    return [line for line in text.splitlines() if not re.match(r"computed \d|\d+ of \d+ results kept", line)]


@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: arguments[0])
def test_a_full_disk_is_one_line(computed: Path, arguments: tuple[str, ...]) -> None:
    done = run(computed, arguments, ">/dev/full")
    assert unexpected(done.stderr) == ["replicate: standard output: cannot be written: No space left on device"]
    assert done.returncode == 2


@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda arguments: arguments[0])
def test_a_closed_pipe_is_silent_and_no_success(computed: Path, arguments: tuple[str, ...]) -> None:
    done = run(computed, arguments, "| exec 0<&-")
    assert unexpected(done.stderr) == []
    assert done.returncode == 2


def test_a_pipe_that_takes_everything_is_a_success(computed: Path) -> None:
    done = run(computed, ("report", "lab", "-j1"), "| cat")
    assert done.returncode == 0
    assert done.stdout.endswith("report: build/report/index.html\n")


@pytest.mark.parametrize("redirection", [">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-"])
def test_closed_streams_do_not_matter(lab: Path, redirection: str) -> None:
    done = run(lab, ("report", "lab", "-j1"), redirection)
    assert done.returncode == 0
    assert "Traceback" not in done.stderr
    results = (lab / "here/build/results.csv").read_text()
    assert results.startswith("paper,exhibit,row")


def test_an_error_that_cannot_be_shown_has_its_status_all_the_same(lab: Path) -> None:
    assert run(lab, ("show", "lab", "table-9"), "2>/dev/full").returncode == 2
