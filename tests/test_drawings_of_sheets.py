"""Figures of a class's sheets: one thread draws, and pictures for questions may be drawn elsewhere."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
import toy_class

from replicate.exhibits.exercises import Exercises
from replicate.exhibits.variants import Answer, Answers, Inputs, VariedFigure
from replicate.handout.drawings import Wanted

TEXT = """# A toy

## Exercises

::: exercise
## Read {vary="reading"}
Read the slope.

{{ figure('line') }}
A caption.

::: solution
${{ fixed(answer('reading')['slope'], 0) }}$
:::
:::
"""
DRAWN = {"svg": toy_class.SVG.encode(), "png": toy_class.PNG}
STUDENTS = ["Ada", "Bob", "Zoë", "Eve"]


def exercises() -> Exercises:
    found = Exercises()

    @found.vary(
        "reading",
        original={"a": 1},
        variant=lambda rng: {"a": rng.randint(2, 99)},
        requires={},
        figures={"line": VariedFigure("A line", "It rises.", lambda *_: None, (3.0, 2.0))},
    )
    def slope(inputs: Inputs) -> Answers:
        return {"slope": Answer(float(inputs["a"]), tolerance=0.5, mistakes={"sign": -float(inputs["a"])})}

    return found


class Elsewhere:
    """Draws the pictures that were ordered, and no others."""

    def order(self, wanted: Sequence[Wanted]) -> Callable[[Wanted], bytes]:
        return {one: DRAWN[one.kind] for one in wanted}.__getitem__


@pytest.mark.parametrize("artist", [None, Elsewhere()])
def test_only_the_thread_that_reports_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, artist: Elsewhere | None
) -> None:
    drawn: list[tuple[str, str]] = []

    def draw(wanted: Wanted, _: Exercises) -> bytes:
        drawn.append((wanted.kind, threading.current_thread().name))
        return DRAWN[wanted.kind]

    monkeypatch.setattr(Wanted, "drawn", draw)
    monkeypatch.setattr(toy_class, "exercises", exercises)
    made = dict(toy_class.class_set(tmp_path, monkeypatch, TEXT, artist=artist).files(STUDENTS, "1", "moodle"))
    assert [name for name in made if name.endswith(".pdf")] == [f"toy-{one}.pdf" for one in [*STUDENTS, "key"]]
    kinds = ["svg"] if artist else ["png", "svg"]
    here = threading.current_thread().name
    assert sorted(drawn) == [(kind, here) for kind in kinds for _ in STUDENTS]
