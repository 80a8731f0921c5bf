"""Fixtures that several tests share: the command line, run in an empty folder on a small installed paper."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import installed_paper
import pytest

from replicate import cli

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    with installed_paper.installed(tmp_path / "site") as folder:
        yield folder


@pytest.fixture
def replicate(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run the command in an empty folder and return exit status, output and error output."""
    assert folder.is_dir()
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("NO_COLOR", "1")
    # The terminal is that of the tests, and the summary that of the job that runs them.
    for name in ("COLUMNS", "FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE", "GITHUB_STEP_SUMMARY"):
        monkeypatch.delenv(name, raising=False)

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["replicate", *arguments])
        capsys.readouterr()
        with pytest.raises(SystemExit) as exit_:
            cli.main()
        code = exit_.value.code
        assert isinstance(code, int)
        return code, *capsys.readouterr()

    return run
