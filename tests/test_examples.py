"""The example projects do what the documentation says: every command, with an installed wheel, in a copy elsewhere."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"
PROJECTS = sorted(file.parent for file in EXAMPLES.glob("*/replicate.toml"))


COMMANDS = """
import sys
import replicate.cli
site, *commands = sys.argv[1:]
assert replicate.cli.__file__.startswith(site)
for command in commands:
    sys.argv = ["replicate", command, "-j1"]
    try:
        replicate.cli.main()
    except SystemExit as end:
        if end.code:
            sys.exit(f"{command} ended with {end.code}")
print("all ended with 0")
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder in which the project's wheel is installed."""
    dist, site = tmp_path_factory.mktemp("dist"), tmp_path_factory.mktemp("site")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(dist)]
    subprocess.run(build, cwd=EXAMPLES.parent, capture_output=True, check=True)
    (wheel,) = dist.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    return site


def test_there_are_three_examples() -> None:
    assert [project.name for project in PROJECTS] == ["balmer", "simc", "student"]


@pytest.mark.parametrize("project", PROJECTS, ids=lambda project: project.name)
def test_report_check_diff_and_handout_succeed(project: Path, site: Path, tmp_path: Path) -> None:
    copy = tmp_path / project.name
    shutil.copytree(project, copy, ignore=shutil.ignore_patterns("build", "__pycache__"))
    done = _replicate(site, copy, "report", "check", "diff", "handout")
    assert done.stdout.splitlines()[-1:] == ["all ended with 0"], done.stdout + done.stderr

    papers = [folder.name for folder in (copy / "papers").iterdir() if (folder / "__init__.py").is_file()]
    made = {path.relative_to(copy / "build").as_posix() for path in (copy / "build").rglob("*") if path.is_file()}
    assert {f"report/{paper}.html" for paper in papers} <= made
    assert {f"handouts/{paper}{edition}.pdf" for paper in papers for edition in ("", "-solutions")} <= made


@pytest.mark.parametrize("project", PROJECTS, ids=lambda project: project.name)
def test_nothing_of_the_scaffold_is_left(project: Path) -> None:
    for file in project.rglob("*"):
        if file.is_file() and file.suffix in {".py", ".md", ".toml", ".csv"} and "build" not in file.parts:
            assert "TODO" not in file.read_text(encoding="utf-8"), file


@pytest.mark.parametrize("project", PROJECTS, ids=lambda project: project.name)
def test_its_own_tests_pass(project: Path) -> None:
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "papers"]
    environment = os.environ | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}  # each takes longer to import than these tests
    done = subprocess.run(command, cwd=project, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def _replicate(site: Path, folder: Path, *commands: str) -> subprocess.CompletedProcess[str]:
    """Run commands one after the other in one process, as far as they succeed."""
    environment = os.environ | {
        "NO_COLOR": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONPATH": str(site),
        "XDG_CACHE_HOME": str(folder.parent / "user-cache"),
    }
    return subprocess.run(
        [sys.executable, "-c", COMMANDS, str(site), *commands],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
