"""Fixtures that several tests share: the command line, run in an empty folder on a small installed paper."""

from __future__ import annotations

import importlib
import shutil
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import installed_paper
import pytest
from attack import attack, table
from command import status_of
from hypothesis import HealthCheck, settings
from surroundings import changed, surroundings

from replicate.run.library import Library
from replicate.run.parallel import run

__all__ = ["attack"]

# Hypothesis tries the same examples in every run, however slow the machine: a test that passes today passes tomorrow.
settings.register_profile(
    "reproducible", max_examples=25, derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("reproducible")

Run = Callable[..., tuple[int, str, str]]

#: Files whose tests take longest, by and large in that order. They are begun first, so that all processes end together;
#: what reads the results of the papers comes well after what computes them, for which it would wait.
LONGEST = (
    "test_mutations.py",
    "browser/test_whatif.py",
    "loops/test_function_plants.py",
    "test_figure_scripts.py",
    "test_standing.py",
    "test_handout.py",
    "browser/test_report.py",
    "test_figure_alarms.py",
    "torture/test_kills.py",
    "test_guarded_code.py",
    "test_units_that_leave.py",
    "test_wrong_answers.py",
    "test_streams.py",
    "test_figure_plugin.py",
    "test_examples.py",
    "test_cache.py",
    "loops/test_design_pid.py",
    "test_cluster.py",
    "test_figure_words.py",
    "test_diff_outputs.py",
    "test_figure_ci.py",
    "test_figure_records.py",
    "loops/test_step_response.py",
    "papers/test_krajewski_charts.py",
    "test_cli.py",
    "loops/test_sweep.py",
)


#: What tells of the terminal, which is that of the tests, and of the summary, which is that of the job that runs them.
_OUTSIDE = ("COLUMNS", "FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE", "GITHUB_STEP_SUMMARY")


@pytest.fixture(autouse=True, scope="session")
def _own_surroundings(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """What a run notes in the user's cache folder must not come from tests, nor change them; nor do terminals."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("user-cache")))
        for name in _OUTSIDE:
            patch.delenv(name, raising=False)
        yield


@pytest.fixture(autouse=True)
def _leaves_its_surroundings() -> Iterator[None]:
    """Which tests run before which in a process is chance: none may notice it."""
    before = surroundings()
    yield
    assert changed(before, surroundings()) == []


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--torture", action="store_true", help="try every case of every attack, not a few of each kind")


def pytest_configure() -> None:
    """Let Ctrl-C be noticed, which tests send: a shell starts what it runs in the background deaf to it."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the longest files first; ``--no-loadscope-reorder`` leaves them there."""
    places = {Path(__file__).parent / name: place for place, name in enumerate(LONGEST)}
    assert all(path.is_file() for path in places)
    items.sort(key=lambda item: places.get(item.path, len(places)))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Print the table of the attacks."""
    if config.getoption("--torture"):
        reports = [
            report
            for outcome in ("passed", "failed")
            for report in terminalreporter.getreports(outcome)
            if report.when == "call"
        ]
        terminalreporter.section("torture")
        for line in table(reports):
            terminalreporter.write_line(line)


@pytest.fixture(scope="session")
def _loaded() -> None:
    """Load what draws before the first worker starts: the others take it from there, and need not load it each."""
    importlib.import_module("replicate.run.drawing")


@pytest.fixture
def folder(tmp_path: Path, _loaded: None) -> Iterator[Path]:
    with installed_paper.installed(tmp_path / "site") as folder:
        yield folder


@pytest.fixture(scope="session")
def lab_results(tmp_path_factory: pytest.TempPathFactory, _loaded: None) -> Callable[[Path], Path]:
    """Return a function that writes the kept results of the small paper, computed once, into a folder of a test."""
    kept = tmp_path_factory.mktemp("lab") / "cache"
    with installed_paper.installed(tmp_path_factory.mktemp("site")):
        run([Library().paper("lab")], jobs=1, cache_dir=kept)
    return lambda folder: Path(shutil.copytree(kept, folder))


@pytest.fixture
def lab_computed(replicate: Run, lab_results: Callable[[Path], Path]) -> None:
    """Let `replicate` find the results of the small paper, for tests that ask for something else."""
    assert callable(replicate)
    lab_results(Path("build/cache"))


@pytest.fixture
def replicate(command_line: Run, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run the command in an empty folder, with a paper installed."""
    assert folder.is_dir()
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    return command_line


@pytest.fixture
def command_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run the command in this process and return exit status, output and error output."""
    monkeypatch.setenv("NO_COLOR", "1")

    def run(*arguments: str) -> tuple[int, str, str]:
        capsys.readouterr()
        return status_of(*arguments), *capsys.readouterr()

    return run
