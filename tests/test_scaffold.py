"""A new paper works as it is made: it installs, computes, and everything in it holds."""

from __future__ import annotations

import importlib
import subprocess
import sys

import pytest

from replicate.errors import OutputError, PaperDefinitionError
from replicate.new_paper import new_paper
from replicate.run.outcome import recompute


def test_a_new_paper_holds(tmp_path, monkeypatch):
    folder = new_paper("demo", tmp_path)
    monkeypatch.syspath_prepend(folder)
    paper = importlib.import_module("replicate_demo").paper
    try:
        outcome = recompute([paper], jobs=1, cache_dir=None)
    finally:
        for name in [name for name in sys.modules if name.startswith("replicate_demo")]:
            del sys.modules[name]
    assert outcome.failures == []
    assert outcome.judgement.problems == []
    assert [v.verdict for v in outcome.judgement.verdicts] == ["reproduced", "reproduced", "holds"]


def test_a_new_paper_is_in_good_style(tmp_path):
    folder = new_paper("demo", tmp_path)
    options = ["--isolated", "--no-cache", "--select", "E,F,I", "--line-length", "120"]
    command = [sys.executable, "-m", "ruff", "check", *options]
    done = subprocess.run([*command, "."], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_entry_point_names_the_paper(tmp_path):
    text = (new_paper("demo", tmp_path) / "pyproject.toml").read_text()
    assert 'demo = "replicate_demo:paper"' in text
    assert "{{" not in text


@pytest.mark.parametrize("id", ["", "Demo", "1st", "a-b", "class", "../x"])
def test_ids_that_cannot_be_imported_are_refused(id, tmp_path):
    with pytest.raises(PaperDefinitionError, match="allowed: lower-case letters"):
        new_paper(id, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_an_existing_folder_is_left_alone(tmp_path):
    new_paper("demo", tmp_path)
    with pytest.raises(OutputError, match="exists already"):
        new_paper("demo", tmp_path)
