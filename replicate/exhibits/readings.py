"""A reading: one way to understand how an exhibit was computed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar, cast

from replicate.exhibits.definitions import check_count, check_function, check_id, check_lists, check_texts
from replicate.exhibits.exclusion import Rule
from replicate.exhibits.order import module_being_imported

AS_WRITTEN = "as-written"

Compute = TypeVar("Compute", bound=Callable[..., Any])
Numbers = Mapping[str, float]
Many = Callable[[Sequence[tuple[str, Numbers]]], Sequence[Numbers | None]]
"""From pairs of a case and its inputs to the quantities of each; ``None`` where it has none."""


@dataclass(frozen=True)
class Reading:
    """One way to understand how an exhibit was computed.

    Attributes
    ----------
    id
        ``as-written`` for the first reading of an exhibit, a short ASCII slug for every other.
    title
        One line for table headings and the terminal.
    compute
        Returns the whole exhibit; rows and columns carry the keys of the printed CSV. With `inputs`, returns the
        quantities of one case instead: ``compute(case, given)``, where `given` has a number for each input.
    note
        What is assumed and why, in Markdown; may be empty.
    inputs
        The places of the numbers that the reading takes from the print (`replicate.exhibits.rounded_inputs`). Each
        stands for all numbers that round to it.
    inputs_of
        Those of the cases that take others. A case without inputs is left out.
    tried
        How many alternatives were tried for each free choice of the reading, by what was chosen.
    rules_out
        For a reading with printed inputs, by quantity: says where it certainly is not while the inputs run through a
        box (`replicate.exhibits.exclusion`).
    many
        For a reading with printed inputs: what `compute` returns, for many pairs of a case and its inputs at once.
    module
        The module in which it is defined; set by itself.
    """

    id: str
    title: str
    compute: Callable[..., Any]
    note: str = ""
    inputs: tuple[str, ...] = ()
    inputs_of: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    tried: Mapping[str, int] = field(default_factory=dict)
    rules_out: Mapping[str, Rule] = field(default_factory=dict)
    many: Many | None = None
    module: str = field(default_factory=module_being_imported, compare=False, repr=False)

    @property
    def takes_inputs(self) -> bool:
        """Whether it takes numbers from the print, and gives a range."""
        return bool(self.inputs or self.inputs_of)

    def __post_init__(self) -> None:
        """Check the types that Python does not."""
        what = f"reading '{self.id}'"
        check_id("reading", self.id)
        check_texts(what, title=self.title, note=self.note)
        check_function(what, "what computes it", self.compute)
        check_lists(what, inputs=self.inputs)
        for case, inputs in self.inputs_of.items():
            check_lists(what, **{f"inputs_of of '{case}'": inputs})
        for choice, count in self.tried.items():
            check_count(what, f"tried of '{choice}'", count)
        for quantity, rule in self.rules_out.items():
            check_function(what, f"rules_out of '{quantity}'", rule)
        if self.many is not None:
            check_function(what, "what computes many cases at once", self.many)


def answers(reading: Reading, points: Sequence[tuple[str, Numbers]]) -> list[Numbers]:
    """Return the quantities of a reading with printed inputs, at pairs of a case and its inputs.

    Returns
    -------
    list
        Quantities by name for each pair, in the same order; empty where there are none, as where a loop is unstable.

    Raises
    ------
    ValueError
        If the reading computes many cases at once, and returns more or fewer than it was asked for.

    Examples
    --------
    >>> inverse = Reading("as-written", "Inverse", lambda case, given: {"y": 1.0 / given["x"]}, inputs=("x",))
    >>> answers(inverse, [("A", {"x": 4.0}), ("B", {"x": 0.0})])
    [{'y': 0.25}, {}]
    """
    if reading.many is None:
        return [_answer(reading, *point) for point in points]
    found = list(reading.many(points))
    if len(found) != len(points):
        msg = f"reading '{reading.id}' returns {len(found)} results for {len(points)} cases at once; expected: as many"
        raise ValueError(msg)
    return [{} if one is None else one for one in found]


def _answer(reading: Reading, case: str, given: Numbers) -> Numbers:
    try:
        return cast("Numbers", reading.compute(case, given))
    except Exception:  # noqa: BLE001  -- no such number there, as the overshoot of an unstable loop
        return {}


def is_elsewhere(place: str) -> bool:
    """Say whether an input is printed in another table, or in the text.

    Examples
    --------
    >>> is_elsewhere("eq-7:a:value"), is_elsewhere("p=1.6667"), is_elsewhere("w0@first")
    (True, True, False)
    """
    return ":" in place or "=" in place


def other_cell(place: str) -> tuple[str, str, str]:
    """Return exhibit, row and column of an input that is printed in another table.

    Examples
    --------
    >>> other_cell("eq-7:case a:value")
    ('eq-7', 'case a', 'value')
    """
    exhibit, _, cell = place.partition(":")
    row, _, column = cell.rpartition(":")
    return exhibit, row, column


def input_name(place: str) -> str:
    """Return an input's name where one knows which table is meant.

    Examples
    --------
    >>> input_name("k"), input_name("p=1.6667"), input_name("eq-7:a:value"), input_name("fits:rise A:x0")
    ('k', 'p', 'a', 'rise A x0')
    """
    if ":" not in place:
        return place.partition("=")[0]
    _, row, column = other_cell(place)
    return row if column == "value" else f"{row} {column}"
