"""Accepted figures that no test draws any more, where a run can know that: one of all tests beside their folder.

A test that was deselected, skipped, or ended early may be the one that draws them; then nothing is said.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from replicate.baselines.outcomes import Outcome, Status

#: Options by which a run leaves out files that it would otherwise collect.
_LEAVE_OUT = ("lf", "ignore", "ignore_glob")


class Suite:
    """The tests that a run has collected, by the folder of their accepted figures; a plugin of pytest itself.

    Attributes
    ----------
    folders
        The tests that draw figures, by the folder in which they are accepted; every folder beside a test is here.
    whole
        Whether no test was left out.
    """

    def __init__(self, config: pytest.Config) -> None:
        self.config = config
        self.folders: dict[str, list[str]] = {}
        self.whole = not any(config.getoption(name, None) for name in _LEAVE_OUT)
        self._found = 0
        self._passed: set[str] = set()

    @property
    def tests(self) -> int:
        """The number of tests that draw figures."""
        return sum(map(len, self.folders.values()))

    def add(self, item: pytest.Item, folder: Path, *, draws: bool) -> None:
        """Add a test that will run."""
        self.folders.setdefault(str(folder), []).extend([item.nodeid] * draws)

    def pytest_itemcollected(self) -> None:
        """Count the tests, before any is left out; pytest calls it."""
        self._found += 1

    @pytest.hookimpl(trylast=True)
    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """See whether tests were left out; pytest calls it."""
        self.whole = self.whole and len(session.items) >= self._found

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """See whether a file could not be read, or was skipped; pytest calls it."""
        self.whole = self.whole and report.passed

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Remember which tests ran to their end; pytest calls it."""
        if report.when == "call" and report.passed:
            self._passed.add(report.nodeid)

    def data(self) -> dict[str, Any]:
        """Return plain data, for another process."""
        return {"folders": self.folders, "whole": self.whole}

    def take(self, data: dict[str, Any]) -> None:
        """Take what a worker has collected, each of which collects all."""
        self.folders, self.whole = data["folders"], self.whole and data["whole"]

    def undrawn(self, outcomes: Sequence[dict[str, Any]], status: Status) -> Iterator[Outcome]:
        """Yield the accepted figures that nothing asked for.

        Parameters
        ----------
        outcomes
            Of the figures that were compared, with their ``folder``.
        status
            Whether that is to be told, or an error.
        """
        from replicate.baselines.outcomes import Outcome
        from replicate.baselines.store import Store

        if not self.whole:
            return
        asked = {(one["folder"], one["name"]) for one in outcomes}
        ended = self._passed | {one["where"] for one in outcomes if one["status"] != "same"}
        for folder, tests in self.folders.items():
            if not self._covers(Path(folder)) or not ended.issuperset(tests):
                continue
            store = Store(Path(folder))
            for name in store.names():
                # What lies in folders below, or was never accepted, is not ours.
                if (folder, name) not in asked and "/" not in name and store.path(name, ".log").is_file():
                    said = "is accepted, but no test draws it: delete its files with the test"
                    yield Outcome(name, status, changes=[said], layers=["named"])

    def _covers(self, folder: Path) -> bool:
        """Whether all tests beside or below which a folder lies were collected."""
        start = self.config.invocation_params.dir
        return any((start / argument).resolve() in folder.parents for argument in self.config.args)
