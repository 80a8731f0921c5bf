"""Attacks: many cases of one kind, of which `make test` tries a few and `make torture` all; pytest prints the table."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import pytest

_PROPERTY = "attack"
_MOST_SHOWN = 5


class Attack:
    """Tries cases of one kind, and fails with those that did not hold.

    Attributes
    ----------
    everything
        Whether all cases are to be tried, not a few of each kind.
    """

    def __init__(self, record: Callable[[str, object], None], *, everything: bool) -> None:
        self._record = record
        self.everything = everything

    def __call__(self, kind: str, cases: Sequence[Any], try_one: Callable[[Any], str], *, short: int = 6) -> None:
        """Try them; `try_one` returns what went wrong, an empty text if nothing did."""
        chosen = cases if self.everything else spread(cases, short)
        broken = [(case, why) for case in chosen if (why := _outcome(try_one, case))]
        self.report(kind, len(chosen), broken)

    def report(self, kind: str, tried: int, broken: Sequence[tuple[object, str]]) -> None:
        """Report cases that were tried elsewhere."""
        assert tried, f"{kind}: no cases"
        self._record(_PROPERTY, [kind, tried, tried - len(broken)])
        if broken:
            shown = "\n".join(f"  {case}: {why}" for case, why in broken[:_MOST_SHOWN])
            pytest.fail(f"{kind}: {len(broken)} of {tried} did not hold\n{shown}", pytrace=False)


@pytest.fixture
def attack(request: pytest.FixtureRequest, record_property: Callable[[str, object], None]) -> Attack:
    """Try cases of one kind, and fail with those that did not hold."""
    return Attack(record_property, everything=bool(request.config.getoption("--torture")))


def _outcome(try_one: Callable[[Any], str], case: object) -> str:
    try:
        return try_one(case)
    except Exception as error:  # noqa: BLE001  -- whatever it is, the case did not hold
        return f"{type(error).__name__}: {error}"


def spread(cases: Sequence[Any], number: int) -> list[Any]:
    """Return a few cases, evenly spread, the first and the last among them."""
    if len(cases) <= number:
        return list(cases)
    step = (len(cases) - 1) / max(1, number - 1)
    return [cases[place] for place in dict.fromkeys(round(k * step) for k in range(number))]


def table(reports: Sequence[pytest.TestReport]) -> list[str]:
    """Return the table of all attacks: kind, cases tried, held."""
    found: dict[str, list[int]] = {}
    for report in reports:
        for name, value in report.user_properties:
            if name == _PROPERTY and isinstance(value, list):
                kind, tried, held = value
                total = found.setdefault(str(kind), [0, 0])
                total[0] += tried
                total[1] += held
    if not found:
        return []
    rows = [("kind", "tried", "held"), *((kind, str(tried), str(held)) for kind, (tried, held) in found.items())]
    tried, held = (sum(numbers) for numbers in zip(*found.values(), strict=True))
    rows.append(("all", str(tried), str(held)))
    width = max(len(kind) for kind, _, _ in rows)
    return [f"{kind:{width}}  {tried:>6}  {held:>6}" for kind, tried, held in rows]
