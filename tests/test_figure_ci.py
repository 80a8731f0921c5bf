"""The action, the workflows and the example: against their schemas, and every shell step run as a script."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from gallery import GALLERY
from matplotlib.figure import Figure
from ruamel.yaml import YAML

from replicate.baselines.outcomes import Outcome
from replicate.baselines.outputs import MARKER, comment_text, summary_text
from replicate.figures import capture

ROOT = Path(__file__).parent.parent
EXAMPLE = ROOT / "examples" / "figures"
WORKFLOWS = sorted((EXAMPLE / ".github/workflows").glob("*.yml"))


def steps(path: Path) -> dict[str, Any]:
    content: dict[str, Any] = YAML(typ="safe").load(path)
    jobs = [content["runs"]] if "runs" in content else content["jobs"].values()
    return {step["name"]: step for job in jobs for step in job["steps"] if "name" in step}


def shell(script: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script],
        cwd=folder, capture_output=True, text=True, check=False,
        env={**os.environ, "PATH": path, "GITHUB_STEP_SUMMARY": "", **environment},
    )  # fmt: skip


@pytest.mark.parametrize(
    ("schema", "paths"), [("github-actions", [ROOT / "action.yml"]), ("github-workflows", WORKFLOWS)]
)
def test_action_and_workflows_fit_their_schemas(schema: str, paths: list[Path]) -> None:
    assert paths
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}", *map(str, paths)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("path", [ROOT / "action.yml", *WORKFLOWS], ids=lambda path: path.name)
def test_actions_are_pinned_and_inputs_reach_scripts_as_variables_only(path: Path) -> None:
    for step in steps(path).values():
        assert "${{" not in step.get("run", "")
        assert "uses" not in step or len(step["uses"].split("@")[1]) == 40


@pytest.fixture
def example(tmp_path: Path) -> Path:
    shutil.copytree(EXAMPLE, tmp_path / "example")
    return tmp_path / "example"


def test_the_example_is_as_accepted_and_its_steps_run(example: Path) -> None:
    found = steps(EXAMPLE / ".github/workflows/figures.yml")
    done = shell(found["Compare"]["run"], example)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "nothing differs from the accepted state; figures compared: 6" in done.stdout
    assert shell(found["For the comment"]["run"], example, PULL_REQUEST="7").returncode == 0
    assert (example / "build/figures-diff/pull-request").read_text() == "7\n"
    shutil.rmtree(example / "build")
    assert shell(found["For the comment"]["run"], example, PULL_REQUEST="7").returncode == 0
    assert (example / "build/figures-diff/comment.md").read_text().startswith(f"{MARKER}\n## 🔴 Figures\n")


def test_the_action_is_green_red_and_broken(example: Path) -> None:
    found = steps(ROOT / "action.yml")
    output = example / "output"

    def compare(scripts: str, pytest_: str = "") -> tuple[str, str]:
        output.write_text("")
        done = shell(
            found["Compare"]["run"], example, SCRIPTS=scripts, PYTEST=pytest_, ACCEPTED="figures", OUT="out",
            PULL_REQUEST="7", GITHUB_OUTPUT=str(output),
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        status = dict(line.split("=", 1) for line in output.read_text().splitlines())["status"]
        assert str(shell(found["Red if something differs"]["run"], example, STATUS=status).returncode) == status
        return status, (example / "out/comment.md").read_text()

    status, comment = compare("plots/plot_step.py plots/plot_rules.py")
    assert (status, comment.splitlines()[:2]) == ("0", [MARKER, "## 🟢 Figures"])
    script = example / "plots/plot_rules.py"
    script.write_text(script.read_text().replace("1.4", "1.5"))
    status, comment = compare("plots/plot_rules.py")
    assert (status, comment.splitlines()[:2]) == ("1", [MARKER, "## 🔴 Figures"])
    script.write_text("raise SystemExit(1)\n")
    assert compare("plots/plot_rules.py")[0] == "2"
    status, comment = compare("")
    assert status == "2"
    assert "nothing was compared" in comment


def test_one_comment_is_made_and_then_replaced(example: Path) -> None:
    script = steps(EXAMPLE / ".github/workflows/figures-comment.yml")["Comment"]["run"]
    (example / "figures-diff").mkdir()
    (example / "figures-diff/pull-request").write_text("7; rm -rf /\n")
    (example / "figures-diff/comment.md").write_text(MARKER)
    tools = example / "tools"
    tools.mkdir()
    (tools / "gh").write_text(
        '#!/bin/sh\necho "$*" >> calls\ncase "$*" in\n*/pulls/7*) echo "$ANSWER";;\n*--paginate*) echo "$ID";;\nesac\n'
    )
    (tools / "gh").chmod(0o755)

    def run(answer: str, id: str = "") -> tuple[int, str]:
        (example / "calls").write_text("")
        path = f"{tools}:{os.environ['PATH']}"
        done = subprocess.run(
            ["bash", "-eo", "pipefail", "-c", script], cwd=example, check=False, capture_output=True,
            env={"PATH": path, "REPOSITORY": "o/r", "HEAD_SHA": "abc", "ANSWER": answer, "ID": id},
        )  # fmt: skip
        return done.returncode, (example / "calls").read_text().splitlines()[-1]

    assert run("abc") == (0, "api --method POST repos/o/r/issues/7/comments -F body=@figures-diff/comment.md")
    assert run("abc", "42") == (0, "api --method PATCH repos/o/r/issues/comments/42 -F body=@figures-diff/comment.md")
    assert run("other") == (1, "api repos/o/r/pulls/7 --jq .head.sha")


def test_summary_and_comment_stay_below_what_is_taken() -> None:
    many = [
        Outcome(f"figure-{number}", "changed", "t.py", ["curve 'é' moved " * 30] * 40, ["named"] * 40, number / 5000.0)
        for number in range(4000)
    ]
    assert len(summary_text(many).encode()) < 1024 * 1024
    comment = comment_text(many)
    assert len(comment) < 65_536
    assert comment.startswith(MARKER)
    assert "### figure-3999: changed" in comment  # the worst first
    assert "more figures, on the page." in comment


def test_records_fit_the_documented_schema(tmp_path: Path) -> None:
    paths = []
    for name in (
        "lines",
        "noise",
        "scatter_many",
        "image",
        "polar",
        "solid_lines",
        "tight",
        "symlog",
        "dates",
        "table",
    ):
        figure = Figure()
        GALLERY[name](figure)
        paths.append(tmp_path / f"{name}.json")
        paths[-1].write_text(capture(figure).to_json())
    done = fits(paths)
    assert done.returncode == 0, done.stdout
    (tmp_path / "wrong.json").write_text('{"format": "figure record", "version": 1, "figure": {}, "panels": []}')
    assert fits([tmp_path / "wrong.json"]).returncode == 1


def fits(paths: list[Path]) -> subprocess.CompletedProcess[str]:
    schema = ROOT / "replicate/schemas/figure-record.schema.json"
    command = [sys.executable, "-m", "check_jsonschema", "--schemafile", str(schema), *map(str, paths)]
    return subprocess.run(command, capture_output=True, text=True, check=False)
