"""What became of the figures of one run of pytest, in this process and, in the end, in all of its workers."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from replicate.baselines.suite import Suite

if TYPE_CHECKING:
    from replicate.baselines.outcomes import Outcome


class Session:
    """The figures of one run.

    Attributes
    ----------
    suite
        The tests of the run.
    compared
        Every figure that a test asked for, as plain data: an outcome with its ``folder``.
    undrawn
        The accepted figures that no test asked for.
    """

    def __init__(self, config: pytest.Config) -> None:
        self.config = config
        self.suite = Suite(config)
        self.compared: list[dict[str, Any]] = []
        self.undrawn: list[Outcome] = []
        self.reason = str(config.getoption("--reason")) if config.getoption("--accept-figures") else ""
        only = config.getoption("--accept-only")
        self.only: dict[str, str | None] | None = None
        if only is not None:
            from replicate.baselines.store import chosen_figure

            self.only = dict(map(chosen_figure, only))

    def folder(self, item: pytest.Item) -> Path:
        """Return the folder of the accepted figures of a test."""
        return (item.path.parent / str(self.config.getini("figure_diff_folder"))).resolve()

    def forget(self, item: pytest.Item) -> None:
        """Forget what became of a test, which is run again."""
        self.compared = [one for one in self.compared if one["where"] != item.nodeid]

    def check(self, item: pytest.Item, figure: Any, name: str) -> str:
        """Compare or accept one figure of a test; return what is wrong with it, if something is."""
        from replicate.baselines.outcomes import Outcome, accept, compared, draw
        from replicate.baselines.store import Store, checked_name
        from replicate.errors import FigureError, ReplicateError

        folder, where = self.folder(item), item.nodeid
        try:
            checked_name(name)
            twin = next((one for one in self.compared if (one["name"], one["folder"]) == (name, str(folder))), None)
            if twin is not None:
                raise FigureError(_twins(name, twin["where"], where))
            drawn = draw(figure)
            outcome = compared(Store(folder), name, drawn, where)
            if self.reason and (self.only is None or name in self.only):
                replaces = None if self.only is None else self.only[name]
                outcome = accept(Store(folder), outcome, drawn, self.reason, replaces)
        except ReplicateError as error:
            why = " ".join(str(error).split())
            outcome = Outcome(str(name), "failed", where, [why], ["named"])
        self.compared.append(outcome.to_dict() | {"folder": str(folder)})
        return _said(outcome)

    def data(self) -> dict[str, Any]:
        """Return plain data, for the process that gathers them."""
        return {"compared": self.compared, "suite": self.suite.data()}

    def take(self, data: dict[str, Any]) -> None:
        """Add what a worker did."""
        self.compared += data["compared"]
        self.suite.take(data["suite"])

    def end(self) -> bool:
        """See which accepted figures were not drawn, and write the page; return whether the run is as it should be."""
        nothing = bool(self.suite.tests) and not self.compared
        error = bool(self.config.getoption("--all-figures-drawn"))
        if self.compared:
            self.undrawn = list(self.suite.undrawn(self.compared, "failed" if error else "not drawn"))
            self._write_page()
        return not (nothing or self.twins() or (error and self.undrawn))

    def twins(self) -> list[str]:
        """Say which names are used twice, also in different workers."""
        seen: dict[tuple[str, str], str] = {}
        found = []
        for one in self.compared:
            key = one["folder"], one["name"]
            if key in seen and seen[key] != one["where"]:
                found.append(_twins(one["name"], seen[key], one["where"]))
            seen.setdefault(key, one["where"])
        return found

    def outcomes(self) -> list[Outcome]:
        """Return what became of all figures, in order."""
        from replicate.baselines.outcomes import Outcome

        found = [Outcome(**{key: value for key, value in one.items() if key != "folder"}) for one in self.compared]
        return sorted([*found, *self.undrawn], key=lambda one: (one.name, one.where))

    @property
    def page_folder(self) -> Path:
        """Where the page is written."""
        return Path(str(self.config.getoption("--figures-page")))

    def _write_page(self) -> None:
        from replicate.baselines.outputs import write_outputs

        write_outputs(self.outcomes(), self.config.rootpath / self.page_folder, _command)

    def summary(self) -> Iterator[tuple[str, bool]]:
        """Yield the last lines of the run, and whether each is an error."""
        from replicate.baselines.outputs import counted

        yield from ((text, True) for text in self.twins())
        if not self.compared:
            yield f"nothing was compared, though {self.suite.tests} tests draw figures", True
            return
        yield f"{counted(self.outcomes())}; page: {self.page_folder / 'index.html'}", False
        for one in self.undrawn:
            yield f"'{one.name}' {one.changes[0]}", one.status == "failed"


def _command(outcome: Outcome) -> str:
    """Return the command that accepts one figure."""
    words = ["pytest", outcome.where, "--accept-figures", "--accept-only", f"{outcome.name}={outcome.digest}"]
    return f"{shlex.join(words)} --reason 'why'"


def _twins(name: str, one: str, other: str) -> str:
    return f"two figures are called '{name}': that of {one} and that of {other}"


def _said(outcome: Outcome) -> str:
    """Return the message of a test whose figure differs; empty if it does not."""
    if outcome.status == "failed":
        return f"figure '{outcome.name}': {outcome.changes[0]}"
    if outcome.status == "new":
        return f"figure '{outcome.name}': {outcome.changes[0]}; to accept it: --accept-figures --reason 'why'"
    if outcome.status != "changed":
        return ""
    changes = (f"- {text}" for text in outcome.changes)
    return "\n".join([f"figure '{outcome.name}' differs from its accepted state:", *changes])
