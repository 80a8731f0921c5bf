"""What a reading computes for many cases at once is what it computes for each alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from replicate.exhibits import Table
from replicate.exhibits.readings import Reading
from replicate.papers.khan import paper as khan
from replicate.papers.panagopoulos import paper as panagopoulos
from replicate.run.units import Unit, compute

PAPERS = {"khan": khan, "panagopoulos": panagopoulos}
ALL = [
    (paper, table, reading)
    for paper, made in PAPERS.items()
    for table in made.load().exhibits.values()
    if isinstance(table, Table)
    for reading in table.readings.values()
    if reading.many is not None
]


def test_there_are_such_readings() -> None:
    assert len(ALL) >= 10


@pytest.mark.parametrize(
    ("paper", "table", "reading"), ALL, ids=[f"{paper}-{table.id}-{reading.id}" for paper, table, reading in ALL]
)
def test_many_are_what_one_is(paper: str, table: Table, reading: Reading) -> None:
    result: Any = compute(Unit(paper, f"replicate.papers.{paper}", table.id, reading.id))
    points = result.ranges[reading.id].points
    rng = np.random.default_rng(5)
    asked = [
        (case, {name: number * (1.0 + 1e-3 * float(rng.uniform(-1.0, 1.0))) for name, number in inputs.items()})
        for case, inputs in points.items()
        for _ in range(2)
    ]
    # in the middle of the others a loop that is certainly unstable, or none at all
    asked.insert(3, (asked[3][0], dict.fromkeys(asked[3][1], 1e3)))
    assert reading.many is not None
    found = reading.many(asked)
    assert len(found) == len(asked)
    for place, (point, many) in enumerate(zip(asked, found, strict=True)):
        if many is None:
            assert place == 3
            continue
        one = reading.compute(*point)
        assert many.keys() == one.keys()
        for quantity, number in one.items():
            assert many[quantity] == pytest.approx(number, rel=1e-11, abs=1e-13), (point, quantity)
