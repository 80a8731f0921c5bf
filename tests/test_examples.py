"""The example projects do what the documentation says: every command, in a copy of the project."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"
PROJECTS = sorted(file.parent for file in EXAMPLES.glob("*/replicate.toml"))


def test_there_are_examples() -> None:
    assert PROJECTS


@pytest.mark.parametrize("project", PROJECTS, ids=lambda project: project.name)
def test_report_check_diff_and_handout_succeed(project: Path, tmp_path: Path) -> None:
    copy = tmp_path / project.name
    shutil.copytree(project, copy, ignore=shutil.ignore_patterns("build", "__pycache__"))
    for command in ("report", "check", "diff", "handout"):
        done = _replicate(copy, command, "-j1")
        assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"

    papers = [folder.name for folder in (copy / "papers").iterdir() if (folder / "__init__.py").is_file()]
    made = {path.relative_to(copy / "build").as_posix() for path in (copy / "build").rglob("*") if path.is_file()}
    assert {f"report/{paper}.html" for paper in papers} <= made
    assert {f"handouts/{paper}{edition}.pdf" for paper in papers for edition in ("", "-solutions")} <= made


@pytest.mark.parametrize("project", PROJECTS, ids=lambda project: project.name)
def test_nothing_of_the_scaffold_is_left(project: Path) -> None:
    for file in project.rglob("*"):
        if file.is_file() and file.suffix in {".py", ".md", ".toml", ".csv"} and "build" not in file.parts:
            assert "TODO" not in file.read_text(encoding="utf-8"), file


def _replicate(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"NO_COLOR": "1", "XDG_CACHE_HOME": str(folder.parent / "user-cache")}
    return subprocess.run(
        [sys.executable, "-m", "replicate", *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
