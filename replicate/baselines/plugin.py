"""The pytest plugin: figures of tests are compared with their accepted state.

It does nothing unless a test asks for the fixture ``figure_diff`` or carries the mark of that name.
"""

from __future__ import annotations

import inspect
import re
import shlex
import unittest
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NoReturn

import pytest

KEY = pytest.StashKey["Session"]()
_RETURNED = pytest.StashKey[list[object]]()

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
    parser.addini("figure_diff_folder", "folder of the accepted figures, beside each test file", default=_FOLDER)


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark and begin the list of outcomes; pytest calls it."""
    config.addinivalue_line("markers", "figure_diff(name): compare the figure that the test returns")
    if config.getoption("--accept-figures") and not config.getoption("--reason").strip():
        msg = "--accept-figures needs a reason: --reason 'why the new state is right'"
        raise pytest.UsageError(msg)
    config.stash[KEY] = Session(config)


class Session:
    """What became of the figures of one run, in this process and, in the end, in all of its workers."""

    def __init__(self, config: pytest.Config) -> None:
        self.config = config
        self.outcomes: list[dict[str, Any]] = []
        self.used = 0
        self.reason = str(config.getoption("--reason")) if config.getoption("--accept-figures") else ""
        only = config.getoption("--accept-only")
        self.only: dict[str, str | None] | None = None
        if only is not None:
            from replicate.baselines.store import chosen_figure

            self.only = dict(map(chosen_figure, only))

    def check(self, item: pytest.Item, figure: Any, name: str) -> None:
        """Compare or accept one figure of a test.

        Raises
        ------
        Failed
            If it differs, or cannot be compared.
        """
        from replicate.baselines.outcomes import Outcome, accept, compared, draw
        from replicate.baselines.store import Store, checked_name
        from replicate.errors import FigureError, ReplicateError

        folder = item.path.parent / str(self.config.getini("figure_diff_folder"))
        where = item.nodeid
        try:
            checked_name(name)
            twin = next((one for one in self.outcomes if (one["name"], one["folder"]) == (name, str(folder))), None)
            if twin is not None:
                msg = f"two figures are called '{name}': that of {twin['where']} and that of {where}"
                raise FigureError(msg)
            drawn = draw(figure)
            outcome = compared(Store(folder), name, drawn, where)
            if self.reason and (self.only is None or name in self.only):
                replaces = None if self.only is None else self.only[name]
                outcome = accept(Store(folder), outcome, drawn, self.reason, replaces)
        except ReplicateError as error:
            why = " ".join(str(error).split())
            outcome = Outcome(str(name), "failed", where, [why], ["named"])
        self._keep(outcome, folder)
        if outcome.differs or outcome.status == "failed":
            _fail(said(outcome))

    def _keep(self, outcome: Any, folder: Path) -> None:
        self.outcomes.append(outcome.to_dict() | {"folder": str(folder)})

    def twins(self) -> list[str]:
        """Say which names are used twice, also in different workers."""
        seen: dict[tuple[str, str], str] = {}
        found = []
        for one in self.outcomes:
            key = one["folder"], one["name"]
            if key in seen and seen[key] != one["where"]:
                found.append(f"two figures are called '{one['name']}': that of {seen[key]} and that of {one['where']}")
            seen.setdefault(key, one["where"])
        return found


def said(outcome: Any) -> str:
    """Return the message of a test whose figure differs."""
    if outcome.status == "failed":
        return f"figure '{outcome.name}': {outcome.changes[0]}"
    if outcome.status != "changed":
        return f"figure '{outcome.name}': {outcome.changes[0]}; to accept it: --accept-figures --reason 'why'"
    changes = (f"- {text}" for text in outcome.changes)
    return "\n".join([f"figure '{outcome.name}' differs from its accepted state:", *changes])


def _fail(message: str) -> NoReturn:
    pytest.fail(message, pytrace=False)


@pytest.fixture
def figure_diff(request: pytest.FixtureRequest) -> Iterator[Callable[..., None]]:
    """Compare figures with their accepted state: ``figure_diff(figure, "name")``; the test's own name by default."""
    session = request.config.stash[KEY]
    compared: list[Any] = []

    def compare(figure: Any, name: str | None = None) -> None:
        compared.append(figure)
        session.check(request.node, figure, _default_name(request.node) if name is None else name)

    yield compare
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


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Iterator[None]:
    """Take what a test returns, if it is a test of figures; pytest calls it."""
    mark = _mark(pyfuncitem)
    if mark is None and "figure_diff" not in pyfuncitem.fixturenames:
        return (yield)
    returned: list[object] = []
    original = pyfuncitem.obj

    def call(*arguments: Any, **options: Any) -> None:
        returned.append(original(*arguments, **options))

    async def await_call(*arguments: Any, **options: Any) -> None:
        returned.append(await original(*arguments, **options))

    # What is to be awaited has to look so: else pytest would take it as passed.
    pyfuncitem.obj = await_call if inspect.iscoroutinefunction(original) else call
    try:
        result = yield
    finally:
        pyfuncitem.obj = original
    pyfuncitem.stash[_RETURNED] = returned
    if mark is not None:
        _check_returned(pyfuncitem, mark, returned[0] if returned else None)
    return result


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Take what a method of a unittest class returns, which pytest itself does not; pytest calls it."""
    mark = _mark(item)
    if mark is None or not isinstance(item, pytest.Function) or not issubclass(item.cls or object, unittest.TestCase):
        return (yield)
    original = item.obj

    def call(*arguments: Any, **options: Any) -> None:
        _check_returned(item, mark, original(*arguments, **options))

    item.obj = call
    try:
        return (yield)
    finally:
        item.obj = original


def _check_returned(item: pytest.Item, mark: pytest.Mark, figure: object) -> None:
    """Compare the figure that a marked test has returned."""
    if len(mark.args) > 1 or mark.kwargs.keys() - {"name"}:
        _fail(f"{item.nodeid}: the mark figure_diff takes a name only: figure_diff(name='...')")
    if not _is_figure(figure):
        _fail(f"{item.nodeid}: is marked figure_diff, but returns {type(figure).__name__} and no figure")
    name = mark.kwargs.get("name", mark.args[0] if mark.args else _default_name(item))
    item.config.stash[KEY].check(item, figure, name)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Count the tests that draw figures; pytest calls it."""
    items = (item for item in session.items if isinstance(item, pytest.Function))
    session.config.stash[KEY].used = sum(
        _mark(item) is not None or "figure_diff" in item.fixturenames for item in items
    )


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: object) -> None:  # noqa: ARG001
    """Take what a worker of pytest-xdist compared; pytest-xdist calls it."""
    found = getattr(node, "workeroutput", {}).get("figure_diff")
    if found:
        session = node.config.stash[KEY]
        session.outcomes += found["outcomes"]
        session.used = max(session.used, found["used"])


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write the page of the run, or hand what was compared to the process that does; pytest calls it."""
    own = session.config.stash[KEY]
    worker = getattr(session.config, "workeroutput", None)
    if worker is not None:
        worker["figure_diff"] = {"outcomes": own.outcomes, "used": own.used}
        return
    if own.used and not session.config.option.collectonly and (not own.outcomes or own.twins()):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
    if own.outcomes:
        write_page(own)


def write_page(session: Session) -> Path:
    """Write the page of a run, with the commands that accept its figures."""
    from replicate.baselines.outcomes import Outcome
    from replicate.baselines.outputs import write_outputs

    def command(outcome: Outcome) -> str:
        words = ["pytest", outcome.where, "--accept-figures", "--accept-only", f"{outcome.name}={outcome.digest}"]
        return f"{shlex.join(words)} --reason 'why'"

    outcomes = [Outcome(**{key: value for key, value in one.items() if key != "folder"}) for one in session.outcomes]
    outcomes.sort(key=lambda one: (one.name, one.where))
    folder = session.config.rootpath / str(session.config.getoption("--figures-page"))
    return write_outputs(outcomes, folder, command)


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Say how many figures were compared; pytest calls it."""
    own = config.stash.get(KEY, None)
    if own is None or not own.used or hasattr(config, "workerinput"):
        return
    for text in own.twins():
        terminalreporter.write_line(f"figures: {text}", red=True)
    if not own.outcomes:
        terminalreporter.write_line(f"figures: nothing was compared, though {own.used} tests draw figures", red=True)
        return
    from replicate.baselines.outcomes import Outcome
    from replicate.baselines.outputs import counted

    told = [Outcome(**{key: value for key, value in one.items() if key != "folder"}) for one in own.outcomes]
    page = Path(str(config.getoption("--figures-page"))) / "index.html"
    terminalreporter.write_line(f"figures: {counted(told)}; page: {page}")
