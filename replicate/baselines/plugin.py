"""The pytest plugin: figures of tests are compared with their accepted state.

It does nothing unless a test asks for the fixture ``figure_diff`` or carries the mark of that name.
"""

from __future__ import annotations

import inspect
import re
import unittest
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, NoReturn

import pytest

from replicate.baselines.session import Session

KEY = pytest.StashKey[Session]()
_RETURNED = pytest.StashKey[list[object]]()
_WRONG = pytest.StashKey[list[str]]()

_FOLDER = "figures"

# Parameters in the name of a test, such as [PI], [0.5] or [PI-fast], that need no digest to be told apart: a dot stands
# between digits, a dash does not.
_PLAIN = re.compile(r"\[((?:\w|(?<=\d)\.(?=\d)|(?<=\w)-(?=[^\W\d])|(?<=[^\W\d])-(?=\w))+)\]\Z", re.ASCII)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options; pytest calls it."""
    group = parser.getgroup("figures", "figures compared in words")
    group.addoption("--accept-figures", action="store_true", help="make what the figures show the accepted state")
    group.addoption("--reason", default="", metavar="TEXT", help="why the new state of the figures is right")
    group.addoption(
        "--accept-only",
        action="append",
        metavar="NAME[=DIGEST]",
        help="accept this figure only, if its accepted state is still this one; may be given several times",
    )
    group.addoption(
        "--figures-page", default="build/figures-diff", metavar="DIR", help="folder for the page of the run"
    )
    group.addoption(
        "--all-figures-drawn", action="store_true", help="an accepted figure that no test draws any more is an error"
    )
    parser.addini("figure_diff_folder", "folder of the accepted figures, beside each test file", default=_FOLDER)


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark and begin the list of outcomes; pytest calls it."""
    config.addinivalue_line("markers", "figure_diff(name): compare the figure that the test returns")
    if config.getoption("--accept-figures") and not config.getoption("--reason").strip():
        msg = "--accept-figures needs a reason: --reason 'why the new state is right'"
        raise pytest.UsageError(msg)
    config.stash[KEY] = session = Session(config)
    config.pluginmanager.register(session.suite, "figure-diff-suite")


def _fail(message: str) -> NoReturn:
    pytest.fail(message, pytrace=False)


def _check(item: pytest.Item, figure: object, name: str) -> None:
    """Compare a figure; what is wrong is said at the end of the test, so that all of its figures are compared."""
    wrong = item.config.stash[KEY].check(item, figure, name)
    item.stash.setdefault(_WRONG, []).extend([wrong] if wrong else [])


def _fail_if_wrong(item: pytest.Item) -> None:
    wrong = item.stash.get(_WRONG, [])
    if wrong:
        item.stash[_WRONG] = []
        _fail("\n".join(wrong))


@pytest.fixture
def figure_diff(request: pytest.FixtureRequest) -> Iterator[Callable[..., None]]:
    """Compare figures with their accepted state: ``figure_diff(figure, "name")``; the test's own name by default."""
    compared: list[Any] = []

    def compare(figure: Any, name: str | None = None) -> None:
        compared.append(figure)
        _check(request.node, figure, _default_name(request.node) if name is None else name)

    yield compare
    _fail_if_wrong(request.node)  # what other fixtures compared after the test
    for figure in request.node.stash.get(_RETURNED, []):
        if _is_figure(figure) and not any(figure is one for one in compared):
            _fail(f"{request.node.nodeid}: the figure that it returns was never compared: figure_diff(figure, 'name')")


def _default_name(item: pytest.Item) -> str:
    from replicate.baselines.store import name_of

    owner = getattr(item, "cls", None)
    classes = owner.__qualname__.split(".") if owner else []
    names = "-".join((item.path.stem, *classes, item.name))
    plain = _PLAIN.search(names)
    return name_of(f"{names[: plain.start()]}-{plain[1].replace('.', '-')}" if plain else names)


def _is_figure(value: Any) -> bool:
    return any(kind.__name__ == "Figure" and kind.__module__ == "matplotlib.figure" for kind in type(value).__mro__)


def _mark(item: pytest.Item) -> pytest.Mark | None:
    return item.get_closest_marker("figure_diff")


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Begin a test, which may be run again; pytest calls it."""
    item.stash[_WRONG] = []
    item.config.stash[KEY].forget(item)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Fail a test at its end if one of its figures is not as accepted; pytest calls it."""
    try:
        with _returned(item) as returned:
            result = yield
        if isinstance(item, pytest.Function) and (mark := _mark(item)) is not None:
            _check_returned(item, mark, returned[0] if returned else None)
    except pytest.skip.Exception:
        _fail_if_wrong(item)
        raise
    except BaseException as error:
        for text in item.stash[_WRONG]:
            error.add_note(text)
        item.stash[_WRONG] = []
        raise
    _fail_if_wrong(item)
    return result


@contextmanager
def _returned(item: pytest.Item) -> Iterator[list[object]]:
    """Take what a test of figures returns, which methods of unittest and plugins for what is to be awaited do not."""
    returned: list[object] = []
    item.stash[_RETURNED] = returned
    if not isinstance(item, pytest.Function) or not _draws(item):
        yield returned
        return
    original = item.obj

    @wraps(original)
    def call(*arguments: Any, **options: Any) -> None:
        returned.append(original(*arguments, **options))

    @wraps(original)
    async def await_call(*arguments: Any, **options: Any) -> None:
        returned.append(await original(*arguments, **options))

    # What is to be awaited has to look so: else pytest would take it as passed.
    item.obj = await_call if inspect.iscoroutinefunction(original) else call
    # A coroutine of unittest is called by its name, and not as what pytest has collected.
    owner = getattr(original, "__self__", None)
    own = vars(owner) if isinstance(owner, unittest.TestCase) else {}
    own[item.name] = item.obj
    try:
        yield returned
    finally:
        item.obj = original
        own.pop(item.name, None)


def _check_returned(item: pytest.Item, mark: pytest.Mark, figure: object) -> None:
    """Compare the figure that a marked test has returned."""
    if len(mark.args) > 1 or mark.kwargs.keys() - {"name"}:
        _fail(f"{item.nodeid}: the mark figure_diff takes a name only: figure_diff(name='...')")
    if not _is_figure(figure):
        _fail(f"{item.nodeid}: is marked figure_diff, but returns {type(figure).__name__} and no figure")
    _check(item, figure, mark.kwargs.get("name", mark.args[0] if mark.args else _default_name(item)))


def pytest_collection_finish(session: pytest.Session) -> None:
    """See which tests draw figures; pytest calls it."""
    own = session.config.stash[KEY]
    for item in session.items:
        own.suite.add(item, own.folder(item), draws=_draws(item))


def _draws(item: pytest.Item) -> bool:
    return isinstance(item, pytest.Function) and (_mark(item) is not None or "figure_diff" in item.fixturenames)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: object) -> None:  # noqa: ARG001
    """Take what a worker of pytest-xdist compared; pytest-xdist calls it."""
    found = getattr(node, "workeroutput", {}).get("figure_diff")
    if found:
        node.config.stash[KEY].take(found)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write the page of the run, or hand what was compared to the process that does; pytest calls it."""
    own = session.config.stash[KEY]
    worker = getattr(session.config, "workeroutput", None)
    if worker is not None:
        worker["figure_diff"] = own.data()
    elif not session.config.option.collectonly and not own.end():
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Say how many figures were compared; pytest calls it."""
    own = config.stash.get(KEY, None)
    if own is None or config.option.collectonly or not (own.suite.tests or own.compared):
        return
    for text, wrong in own.summary():
        terminalreporter.write_line(f"figures: {text}", red=wrong)
