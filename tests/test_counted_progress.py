"""Progress of what is counted: a bar on a terminal, plain lines elsewhere, no colour where none is wanted."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from replicate.terminal.counted_progress import counted_progress_on


@pytest.fixture
def seconds(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Return the time that a clock shows; tests move it on."""
    now = [0.0]
    monkeypatch.setattr("replicate.terminal.counted_progress.time.monotonic", lambda: now[0])
    return now


def lines_of(seconds: list[float], counts: list[tuple[int, int, int]], each: float) -> list[str]:
    out = io.StringIO()
    with counted_progress_on(Console(file=out, width=100), "sheets") as report:
        for count in counts:
            seconds[0] += each
            report(*count)
    return out.getvalue().splitlines()


def test_lines_elsewhere_say_how_long_it_takes(seconds: list[float]) -> None:
    found = lines_of(seconds, [(number, 6, 0) for number in range(1, 7)], each=6.0)
    assert found == ["2 of 6 sheets, about 24 s left", "4 of 6 sheets, about 12 s left", "6 of 6 sheets"]


def test_what_an_earlier_run_left_is_counted(seconds: list[float]) -> None:
    found = lines_of(seconds, [(2, 4, 2), (3, 4, 2), (4, 4, 2)], each=60.0)
    assert found == ["2 of 4 sheets kept from an earlier run", "3 of 4 sheets, about 2 min 0 s left", "4 of 4 sheets"]


@pytest.mark.parametrize("colour", [True, False])
def test_a_bar_on_a_terminal(monkeypatch: pytest.MonkeyPatch, *, colour: bool) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    if not colour:
        monkeypatch.setenv("NO_COLOR", "1")
    out = io.StringIO()
    terminal = Console(file=out, width=100, force_terminal=True, color_system="standard")
    with counted_progress_on(terminal, "sheets") as report:
        report(3, 6, 0)
    written = out.getvalue()
    assert "sheets" in written
    assert "3/6" in written
    assert ("\x1b[3" in written) is colour  # the colours of a terminal


def test_a_bar_estimates_the_end_of_what_goes_slowly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    now = [0.0]
    monkeypatch.setattr("rich.console.monotonic", lambda: now[0])
    out = io.StringIO()
    with counted_progress_on(Console(file=out, width=100, force_terminal=True), "loops") as report:
        for done in range(5):
            report(2 + done, 8, 2)
            now[0] += 100.0
        now[0] -= 100.0
    assert "0:03:20" in out.getvalue()  # two more of 100 s
