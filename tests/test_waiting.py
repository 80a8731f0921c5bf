"""Which unit a worker does next: what it has done before decides, then what nobody is at, then what is most."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from replicate.exhibits import Figure
from replicate.run.units import Unit
from replicate.run.waiting import Waiting

FOLDERS = ("lab.part_1", "lab.part_2", "field.part_1")


def _waiting(folders: Iterable[str]) -> tuple[Waiting, list[Unit]]:
    figure = Figure("fig-1", "figure", "Title", lambda _: None)
    units = {
        Unit("lab", "lab", f"fig-{place}"): replace(figure, module=f"{folder}.module_{place}")
        for place, folder in enumerate(folders)
    }
    return Waiting(units), list(units)


def _number(waiting: Waiting, known: Iterable[str] = (), taken: Iterable[str] = ()) -> int:
    return int(waiting.take(list(known), list(taken)).unit.exhibit.removeprefix("fig-"))


def test_the_first_worker_stays_in_the_folder_of_the_first_unit() -> None:
    waiting, _ = _waiting([FOLDERS[0], FOLDERS[1], FOLDERS[0]])
    assert _number(waiting) == 0
    assert _number(waiting, known=[FOLDERS[0]]) == 2


def test_the_latest_of_several_folders_goes_first() -> None:
    waiting, _ = _waiting([FOLDERS[0], FOLDERS[1]])
    assert _number(waiting, known=[FOLDERS[0], FOLDERS[1]]) == 1


def test_a_new_worker_begins_where_nobody_is() -> None:
    waiting, _ = _waiting([FOLDERS[0], FOLDERS[0], FOLDERS[1]])
    assert _number(waiting, taken=[FOLDERS[0]]) == 2


def test_a_worker_with_nothing_of_its_own_helps_where_most_is_left() -> None:
    waiting, _ = _waiting([FOLDERS[0], FOLDERS[1], FOLDERS[1]])
    assert _number(waiting, known=[FOLDERS[2]], taken=FOLDERS[:2]) == 1


def test_what_is_put_back_comes_next() -> None:
    waiting, _ = _waiting([FOLDERS[0], FOLDERS[0]])
    first = waiting.take([], [])
    waiting.put_back(first)
    assert waiting.take([], []) is first


@given(st.lists(st.sampled_from(FOLDERS), min_size=1, max_size=20), st.data())
def test_every_unit_is_done_once_and_those_of_a_folder_in_order(folders: list[str], data: st.DataObject) -> None:
    waiting, units = _waiting(folders)
    some = st.lists(st.sampled_from(FOLDERS), max_size=3)
    done = [waiting.take(data.draw(some), data.draw(some)) for _ in units]
    assert len(waiting) == 0
    assert {task.unit for task in done} == set(units)
    for folder in FOLDERS:
        numbers = [units.index(task.unit) for task in done if waiting.folder(task) == folder]
        assert numbers == sorted(numbers)


def test_nothing_waits_without_units() -> None:
    waiting, _ = _waiting([])
    assert not waiting
    with pytest.raises(ValueError, match="empty"):
        waiting.take([], [])
