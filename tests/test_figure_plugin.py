"""The pytest plugin, run by a pytest of its own on small projects."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from starter import Starter, starter

from replicate.baselines.outcomes import compared, draw
from replicate.baselines.store import Store, digest

TESTS = """
import pytest
from matplotlib.figure import Figure

def drawn(style="-"):
    figure = Figure()
    figure.subplots().plot([0, 1, 2], [0, 1, 0], style, label="ZN")
    return figure

def test_fixture(figure_diff):
    figure_diff(drawn(STYLE), "by-hand")

@pytest.mark.figure_diff
@pytest.mark.parametrize("gain", [0.5, 1.0])
def test_mark(gain):
    figure = drawn()
    figure.axes[0].set_title(f"gain {gain}")
    return figure
"""


class Project:
    def __init__(self, folder: Path, started: Starter) -> None:
        self.folder = folder
        self._started = started
        (folder / "pytest.ini").write_text("[pytest]\nfilterwarnings = error\n")
        (folder / "tests").mkdir()
        self.write(TESTS.replace("STYLE", '"-"'))

    def write(self, text: str, name: str = "test_figures.py") -> None:
        (self.folder / "tests" / name).write_text(text)

    def run(self, *arguments: str) -> tuple[int, str]:
        plugins = [
            part for name in ("replicate.baselines.plugin", "xdist", "no:cacheprovider") for part in ("-p", name)
        ]
        # what else is installed for pytest would be imported in each of these processes, and is no part of this
        environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        done = self._started.run("pytest", ["-q", *plugins, *arguments], self.folder, environment)
        return done.returncode, done.stdout

    def accepted(self) -> dict[str, bytes]:
        folder = self.folder / "tests" / "figures"
        return {path.name: path.read_bytes() for path in sorted(folder.glob("*.*"))} if folder.is_dir() else {}


@pytest.fixture(scope="module")
def started() -> Iterator[Starter]:
    """What the plugin imports when a figure is compared; the plugin itself is imported by each pytest."""
    with starter("pytest", "matplotlib.figure", "matplotlib.backends.backend_agg", "replicate.figures.record") as found:
        yield found


@pytest.fixture
def project(tmp_path: Path, started: Starter) -> Project:
    return Project(tmp_path, started)


def test_accept_compare_change(project: Project) -> None:
    status, said = project.run()
    assert status == 1
    assert "figure 'by-hand': has no accepted state" in said
    status, said = project.run("--accept-figures")
    assert (status, project.accepted()) == (4, {})
    assert "--accept-figures needs a reason" in said
    status, said = project.run("--accept-figures", "--reason", "first")
    assert status == 0, said
    names = ["by-hand", "test_figures-test_mark-0-5", "test_figures-test_mark-1-0"]
    assert [name for name in project.accepted() if name.endswith(".json")] == [f"{name}.json" for name in names]
    assert not any(str(project.folder).encode() in content for content in project.accepted().values())
    status, said = project.run()
    assert status == 0
    assert "nothing differs from the accepted state; figures compared: 3" in said

    project.write(TESTS.replace("STYLE", '"--"'))
    before = project.accepted()
    status, said = project.run("-n", "2")
    assert status == 1
    assert "curve 'ZN' is dashed now (was solid)" in said
    assert project.accepted() == before
    page = (project.folder / "build/figures-diff/index.html").read_text()
    digest = json.loads(before["by-hand.log"].decode())["accepted"]
    assert f"--accept-only by-hand={digest}" in page
    assert "3 figures" in said

    status, said = project.run("--accept-figures", "--reason", "stale", "--accept-only", "by-hand=0123456789abcdef")
    assert status == 1
    assert "is not accepted: its author looked at the difference from state 0123456789abcdef" in said
    assert project.accepted() == before
    status, said = project.run(
        "--accept-figures", "--reason", "dashed", "--accept-only", f"by-hand={digest}", "-n", "2"
    )
    assert status == 0, said
    last = json.loads(project.accepted()["by-hand.log"].decode().splitlines()[-1])
    assert (last["reason"], last["replaces"]) == ("dashed", digest)
    assert last["changes"] == ["curve 'ZN' is dashed now (was solid)"]
    assert project.run()[0] == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("def test_it(figure_diff): return drawn()", "the figure that it returns was never compared"),
        ("def test_it(figure_diff): pass", "nothing was compared, though 1 tests draw figures"),
        ("@pytest.mark.figure_diff\ndef test_it(): pass", "is marked figure_diff, but returns NoneType and no figure"),
        ("def test_it(figure_diff): figure_diff(drawn(), 'a/b')", "a figure cannot be called 'a/b'"),
        ("def test_it(figure_diff): figure_diff(drawn(), '..')", "a figure cannot be called '..'"),
        ("def test_it(figure_diff): figure_diff(None, 'a')", "a matplotlib figure is needed, not NoneType"),
        ("def test_it(figure_diff): figure_diff(Figure(), 'a')", "nothing is drawn on the figure"),
        (
            "def test_it(figure_diff): figure_diff(drawn(), 'a'); figure_diff(drawn(), 'a')",
            "two figures are called 'a'",
        ),
    ],
)
def test_what_cannot_be_compared_is_said(project: Project, text: str, said: str) -> None:
    head = TESTS.split("def test_fixture", maxsplit=1)[0]
    project.write(f"{head}\n{text}\n")
    status, out = project.run("--accept-figures", "--reason", "first")
    assert status == 1
    assert said in out
    assert "Traceback" not in out


def test_it_is_silent_unless_used(project: Project) -> None:
    project.write("def test_it(): pass\n")
    status, said = project.run()
    assert status == 0
    assert "figures" not in said
    assert not (project.folder / "build").exists()


def test_damage_and_merges_are_said(project: Project) -> None:
    project.run("--accept-figures", "--reason", "first")
    path = project.folder / "tests/figures/by-hand.json"
    whole = path.read_text()
    for text, said in (
        (whole[:-30], "by-hand.json:"),
        (whole.replace('"version": 2', '"version": 9'), "was written by a newer version"),
        (whole.replace("ZN", "PA"), "is not the state that was accepted last"),
    ):
        path.write_text(text)
        status, out = project.run("-k", "fixture")
        assert status == 1
        assert said in out
    status, out = project.run("-k", "fixture", "--accept-figures", "--reason", "mended")
    assert status == 0, out
    assert project.run()[0] == 0


def test_a_picture_that_is_not_the_accepted_one_is_said(tmp_path: Path) -> None:
    figure = Figure()
    figure.subplots().plot([0, 1])
    drawn, store = draw(figure), Store(tmp_path)
    store.write("step", drawn.record, drawn.picture, "first", [])
    assert compared(store, "step", drawn).status == "same"
    picture = store.path("step", ".png")
    picture.write_bytes(drawn.picture + b"more")
    outcome = compared(store, "step", drawn)
    assert (outcome.status, list(outcome.changes)) == (
        "failed",
        [f"{picture}: is not the picture that was accepted last, a merge or an edit changed it: accept it again"],
    )
    log = store.path("step", ".log")  # as an older version wrote it
    log.write_text(json.dumps({"accepted": digest(drawn.record)}) + "\n")
    assert compared(store, "step", drawn).status == "same"


CLASSES = """
import unittest
import pytest
from matplotlib.figure import Figure

def drawn(height):
    figure = Figure()
    figure.subplots().plot([0, height])
    return figure

class TestOne:
    @pytest.mark.figure_diff
    def test_it(self):
        return drawn(1)

class TestOther(unittest.TestCase):
    @pytest.mark.figure_diff
    def test_it(self):
        return drawn(HEIGHT)
"""


def test_methods_of_classes_are_compared_those_of_unittest_too(project: Project) -> None:
    (project.folder / "tests" / "test_figures.py").unlink()
    project.write(CLASSES.replace("HEIGHT", "2"), "test_c.py")
    assert project.run("--accept-figures", "--reason", "first")[0] == 0
    assert [name for name in project.accepted() if name.endswith(".json")] == [
        "test_c-TestOne-test_it.json",
        "test_c-TestOther-test_it.json",
    ]
    project.write(CLASSES.replace("HEIGHT", "3"), "test_c.py")
    status, said = project.run()
    assert status == 1
    assert "figure 'test_c-TestOther-test_it' differs from its accepted state" in said
    assert "1 failed, 1 passed" in said


def test_a_mark_takes_a_name_only(project: Project) -> None:
    project.write(TESTS.replace("STYLE", '"-"').replace("mark.figure_diff", 'mark.figure_diff(nam="x")'))
    status, said = project.run()
    assert status == 1
    assert "the mark figure_diff takes a name only: figure_diff(name='...')" in said


NAMES = """
import pytest
from matplotlib.figure import Figure

@pytest.mark.figure_diff
@pytest.mark.parametrize("gain", ["a/b", "a b", "a-b", "A_B", -0.5, 0.5, "ö"])
def test_it(gain):
    figure = Figure()
    figure.subplots().set_title(str(gain))
    return figure
"""


def test_no_two_parameters_share_a_name(project: Project) -> None:
    project.write(NAMES)
    status, said = project.run("--accept-figures", "--reason", "first")
    assert status == 0, said
    names = [name.removesuffix(".json") for name in project.accepted() if name.endswith(".json")]
    assert len({name.casefold() for name in names}) == 7
    assert {"test_figures-test_it-A_B", "test_figures-test_it-0-5", "test_figures-test_it-a-b"} <= set(names)
    assert project.run("-n", "2")[0] == 0


AWAITED = """
import pytest
from matplotlib.figure import Figure

class TestOuter:
    class TestInner:
        def test_it(self, figure_diff):
            figure = Figure()
            figure.subplots()
            figure_diff(figure)

async def test_awaited(figure_diff):
    raise ValueError

@pytest.mark.figure_diff
async def test_drawn():
    figure = Figure()
    figure.subplots()
    return figure
"""

UNITTEST = """
import unittest
import pytest
from matplotlib.figure import Figure

class TestLoop(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        self.figure = Figure()
        self.figure.subplots()

    @pytest.mark.figure_diff
    async def test_drawn(self):
        return self.figure

    @pytest.mark.figure_diff
    async def test_nothing(self):
        pass

    async def test_unmarked(self):
        pass
"""

#: As plugins for coroutines do, what a test returns is dropped.
LOOP = """
import asyncio

def pytest_pyfunc_call(pyfuncitem):
    if pyfuncitem.name == "test_drawn":
        asyncio.run(pyfuncitem.obj())
        return True
"""


def test_what_is_to_be_awaited_is_not_taken_as_passed(project: Project) -> None:
    project.write(AWAITED)
    project.write(LOOP, "conftest.py")
    status, said = project.run("--accept-figures", "--reason", "first")
    assert (status, "1 failed, 2 passed" in said) == (1, True), said
    assert {
        "test_figures-TestOuter-TestInner-test_it.json",
        "test_figures-test_drawn.json",
    } <= project.accepted().keys()


def test_what_a_coroutine_of_unittest_returns_is_compared(project: Project) -> None:
    project.write(UNITTEST)
    status, said = project.run("--accept-figures", "--reason", "first")
    assert (status, "1 failed, 2 passed" in said) == (1, True), said
    assert "TestLoop::test_nothing: is marked figure_diff, but returns NoneType" in said
    assert "test_figures-TestLoop-test_drawn.json" in project.accepted()
    assert "figures compared: 1" in project.run("-k", "drawn")[1]


SEVERAL = """
import pytest
from matplotlib.figure import Figure

def drawn(style):
    figure = Figure()
    figure.subplots().plot([0, 1], style, label="ZN")
    return figure

def test_three(figure_diff):
    for name in ("one", "two", "three"):
        figure_diff(drawn(STYLES[name]), name)
    assert GOOD, "the test itself"

def test_NAME(figure_diff):
    figure_diff(drawn("-"))
"""


def several(style: str, name: str, *, good: bool = True) -> str:
    styles = {"one": style, "two": "-", "three": style}
    return SEVERAL.replace("STYLES", str(styles)).replace("GOOD", str(good)).replace("NAME", name)


def test_all_figures_of_a_test_are_compared_and_what_no_test_draws_is_said(project: Project) -> None:
    project.write(several("-", "old"))
    assert project.run("--accept-figures", "--reason", "first")[0] == 0
    project.write(several("--", "old", good=False))
    status, said = project.run()
    assert status == 1
    assert "the test itself" in said
    assert all(f"figure '{name}' differs" in said for name in ("one", "three"))
    assert "2 of 4 figures differ" in said
    project.write(several("-", "new") + "\ndef test_other(): pass\n")
    assert "not drawn" not in project.run("-k", "three or other")[1]
    gone = "'test_figures-test_old' is accepted, but no test draws it"
    status, said = project.run("-n", "2", "--accept-figures", "--reason", "renamed")
    assert (status, gone in said) == (0, True), said
    status, said = project.run("tests", "--all-figures-drawn")
    assert (status, gone in said) == (1, True), said
    assert gone.partition("' ")[2] in (project.folder / "build/figures-diff/index.html").read_text()
