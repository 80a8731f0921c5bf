"""A run does not depend on how the user has set up matplotlib, and is not stopped by it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

CODE = """
from replicate.run.isolation import isolate_matplotlib
isolate_matplotlib()
import os
here = os.getcwd()
import matplotlib, matplotlib.pyplot
assert os.getcwd() == here
print(matplotlib.rcParams["font.size"], matplotlib.get_backend().lower(), matplotlib.__spec__.loader.__class__.__name__)
"""


def run(folder: Path, **variables: str) -> str:
    command = [sys.executable, "-c", CODE]
    variables = os.environ | variables
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=variables)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.mark.parametrize("content", [b"font.size: 30\n", b"\xff\xfe nothing one can read\n", b"no.such.key: 1\n"])
def test_a_configuration_of_the_user_does_not_matter(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "matplotlibrc").write_bytes(content)
    expected = "10.0 agg SourceFileLoader\n"
    assert run(tmp_path) == expected
    assert run(tmp_path, MATPLOTLIBRC=str(tmp_path / "matplotlibrc")) == expected


@pytest.mark.parametrize("backend", ["nonsense", "tkagg", "module://nowhere"])
def test_neither_does_a_backend(tmp_path: Path, backend: str) -> None:
    assert run(tmp_path, MPLBACKEND=backend) == "10.0 agg SourceFileLoader\n"


def test_a_folder_that_cannot_be_written_is_no_news(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert run(tmp_path, MPLCONFIGDIR=str(tmp_path / "file" / "below")) == "10.0 agg SourceFileLoader\n"
