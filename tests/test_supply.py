"""What the project is built from: pinned actions, a dated lock, a wheel that is the same bytes each time."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import installed_paper
import pytest

ROOT = Path(__file__).parent.parent
WORKFLOWS = [*sorted((ROOT / ".github/workflows").glob("*.yml")), ROOT / "templates/new_project/workflow.yml.jinja"]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_workflows_take_nothing_on_trust(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    uses = re.findall(r"uses: *(\S.*)", text)
    assert uses
    for use in uses:  # a tag can be moved, a commit cannot
        assert re.fullmatch(r"[\w-]+/[\w-]+@[0-9a-f]{40} # v\d+(\.\d+)+", use)
    steps = re.split(r"\n *- (?=uses|name|run|if)", text)
    for step in steps:
        assert "actions/checkout@" not in step or "persist-credentials: false" in step
        # What others write (titles, branch names) would be run as code.
        assert not re.search(r"run:.*\$\{\{(?! *(matrix|cancelled|!cancelled))", step, re.DOTALL)
    assert re.search(r"^permissions:\n  contents: read$", text, re.MULTILINE)


def test_newest_versions_and_vulnerabilities_are_looked_at_on_a_schedule() -> None:
    text = (ROOT / ".github/workflows/newest.yml").read_text(encoding="utf-8")
    assert "schedule:" in text
    assert "pip-audit" in text


@pytest.mark.parametrize("name", ["requirements.lock", "requirements-dev.lock"])
def test_the_locks_say_how_old_they_are_and_every_file_has_its_digest(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    assert re.search(r"^# newest file published: \d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ\n\Z", text, re.MULTILINE)
    entries = re.split(r"\n(?=\S)", re.sub(r"^#.*\n", "", text, flags=re.MULTILINE).strip())
    assert len(entries) > 30
    assert all("--hash=sha256:" in entry for entry in entries if not entry.startswith("#"))


@pytest.fixture(scope="module")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    made: list[Path] = []
    for name in ("one", "other"):
        folder = tmp_path_factory.mktemp(name)
        build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
        subprocess.run(build, cwd=ROOT, capture_output=True, check=True)
        made += folder.glob("*.whl")
    return made


def test_two_builds_are_the_same_bytes(wheels: list[Path]) -> None:
    one, other = wheels
    assert one.name == other.name
    assert one.read_bytes() == other.read_bytes()


def test_an_installed_wheel_needs_to_write_nothing_where_it_lies(wheels: list[Path], tmp_path: Path) -> None:
    site, here = tmp_path / "site", tmp_path / "here"
    here.mkdir()
    with zipfile.ZipFile(wheels[0]) as wheel:
        wheel.extractall(site)
    with installed_paper.installed(site):
        pass  # a paper beside it; its files stay
    before = {path: path.stat().st_mtime_ns for path in site.rglob("*")}
    for path in before:
        path.chmod(0o555 if path.is_dir() else 0o444)  # root writes all the same: then the comparison decides
    environment = {**os.environ, "PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1"}
    environment.pop("GITHUB_STEP_SUMMARY", None)
    for arguments in (["report", "lab"], ["accept", "lab", "--accepted", "state", "--reason", "first"]):
        code = f"import replicate.cli as c, sys; assert c.__file__.startswith({str(site)!r}); c.main()"
        command = [sys.executable, "-c", code, *arguments, "-j1"]
        done = subprocess.run(command, cwd=here, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    assert {path: path.stat().st_mtime_ns for path in site.rglob("*")} == before
    for path in before:
        path.chmod(0o755 if path.is_dir() else 0o644)
